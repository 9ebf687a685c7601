/* SPDX-License-Identifier: Apache-2.0 */
/* plot_choice.h -- what a user may have drawn of a panel: kinds of charts, lines at values,
 * contrast in some light.
 *
 * Units    lux; a contour in the chart's own unit (cd m^-2, or a ratio), or in percent of the
 *          chart's value on the axis.
 * Threads  pure functions.
 * Fails    with the option, what was found and what was required.
 */
#pragma once
#include <stdbool.h>

#include "base/error.h"

typedef enum PlotKind {
    PLOT_ALL, PLOT_LUMINANCE, PLOT_CONTRAST, PLOT_COLOUR_SHIFT, PLOT_GREY_INVERSION,
    PLOT_GREY_LEVELS, PLOT_SECTIONS, PLOT_CHROMATICITY, PLOT_SPECTRA, PLOT_BRDF,
    PLOT_BRDF_SPECTRUM, PLOT_BRDF_MAP, PLOT_MIRROR,
    PLOT_FIT, PLOT_UNIFORMITY, PLOT_KIND_COUNT
} PlotKind;

/* The names of the kinds in their order, as one types them: "all|luminance|...". */
#define PLOT_KINDS                                                                             \
    "all|luminance|contrast|colour-shift|grey-inversion|grey-levels|sections|chromaticity|"    \
    "spectra|brdf|brdf-spectrum|brdf-map|mirror|fit|uniformity"

const char *plot_kind_name(PlotKind kind);

#define PLOT_CONTOURS_MAX 16
#define PLOT_AMBIENT_MAX 8

typedef struct PlotContours {
    int    count;
    double value[PLOT_CONTOURS_MAX]; /* above 0 */
    bool   is_percent[PLOT_CONTOURS_MAX];
} PlotContours;

/* Light on the panel: an even surround, and a directed source at an angle to the normal. */
typedef struct PlotLight {
    double lux;            /* of the surround; 0: none */
    double directed_lux;   /* on the panel's plane; 0: none */
    double directed_theta; /* radians; its azimuth is PlotSource's */
} PlotLight;

typedef struct PlotAmbient {
    int       count;
    PlotLight light[PLOT_AMBIENT_MAX];
} PlotAmbient;

/* "200,50%": numbers above 0 with commas. */
bool plot_contours_read(const char *text, PlotContours *out, Error *err);

/* The light of --ambient LUX[,LUX...], and of --directed LUX[,DEG], which adds to each of them
 * or stands alone. Either text may be NULL. */
bool plot_ambient_read(const char *ambient, const char *directed, PlotAmbient *out,
                       Error *err);

#define AMBIENT_HELP "contrast also in even diffuse light of this illuminance"
#define DIRECTED_HELP                                                                          \
    "to it a directed source: its illuminance on the panel and its angle to the normal "       \
    "(default 45); alone without --ambient"

/* The i-th value in the chart's unit, from that on the axis. */
double plot_contours_level(const PlotContours *contours, int i, double on_axis);
