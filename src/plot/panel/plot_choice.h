/* SPDX-License-Identifier: Apache-2.0 */
/* plot_choice.h -- what a user may want drawn of a panel: kinds of charts, lines at values,
 * contrast in some light.
 *
 * Units    lux; a contour in the chart's own unit (cd m^-2, or a ratio), or in percent of the
 *          chart's value on the axis.
 * Threads  pure functions.
 * Fails    with the option, what was found and what was wanted.
 */
#pragma once
#include <stdbool.h>

#include "base/error.h"

typedef enum PlotKind {
    PLOT_ALL, PLOT_LUMINANCE, PLOT_CONTRAST, PLOT_COLOUR_SHIFT, PLOT_GREY_LEVELS, PLOT_SECTIONS,
    PLOT_CHROMATICITY, PLOT_SPECTRA, PLOT_BRDF, PLOT_BRDF_SPECTRUM, PLOT_BRDF_MAP, PLOT_MIRROR,
    PLOT_FIT, PLOT_UNIFORMITY, PLOT_KIND_COUNT
} PlotKind;

/* The names of the kinds in their order, as one types them: "all|luminance|...". */
#define PLOT_KINDS                                                                             \
    "all|luminance|contrast|colour-shift|grey-levels|sections|chromaticity|spectra|brdf|"      \
    "brdf-spectrum|brdf-map|mirror|fit|uniformity"

const char *plot_kind_name(PlotKind kind);

#define PLOT_CONTOURS_MAX 16
#define PLOT_AMBIENT_MAX 8

typedef struct PlotContours {
    int    count;
    double value[PLOT_CONTOURS_MAX]; /* above 0 */
    bool   is_percent[PLOT_CONTOURS_MAX];
} PlotContours;

typedef struct PlotAmbient {
    int    count;
    double lux[PLOT_AMBIENT_MAX]; /* above 0 */
} PlotAmbient;

/* "200,50%": numbers above 0 with commas. */
bool plot_contours_read(const char *text, PlotContours *out, Error *err);
bool plot_ambient_read(const char *text, PlotAmbient *out, Error *err);

/* The i-th value in the chart's unit, from that on the axis. */
double plot_contours_level(const PlotContours *contours, int i, double on_axis);
