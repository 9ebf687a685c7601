/* SPDX-License-Identifier: Apache-2.0 */
/* plot_data.h -- a panel with what charts and tables ask of it first.
 *
 * Frame    the display's: phi 0 right, 90 up.
 * Units    radians, cd m^-2, sr^-1, nm.
 * Memory   the arena's but the file's report. Threads: const once made.
 */
#pragma once
#include <jansson.h>
#include <stdbool.h>

#include "base/error.h"
#include "panel/figures/panel_figure.h"
#include "panel/query/panel_info.h"
#include "panel/set/measurement.h"

typedef enum Pattern {
    PATTERN_WHITE,
    PATTERN_RED,
    PATTERN_GREEN,
    PATTERN_BLUE,
    PATTERN_BLACK,
    PATTERN_COUNT
} Pattern;

typedef struct PlotInput {
    const Panel *panel;
    const char *file;            /* the panel's, as the user named it */
    const Measurement *measured; /* NULL: none; its samples stand beside the curves */
    const char *reading;         /* how the panel is read, for headings; NULL: as it is */
    double incidence_phi;        /* azimuth of the light, radians; PI: from the left */
} PlotInput;

typedef struct PlotData {
    const Panel *panel;
    const char *file;
    const Measurement *measured;
    double incidence_phi;
    json_t *report;        /* of the file; plot_data_free releases it */
    const char *name;      /* of the panel */
    const char *file_name; /* without folders; and how it is read, where that is said */
    bool emits, has_black, reflects;
    bool is_white_only;   /* its primaries and levels are assumed, not measured */
    bool has_gamma_table; /* of these: levels measured on the axis */
    double cone;          /* emission is measured up to this theta */
    const char *azimuths; /* "measured at φ 0°, 90° alone", where they are few; or NULL */
    double nm;            /* of the reflection's measured wavelengths the one nearest to 550 */
    int wavelength_count, incidence_count;
    double incidence[PANEL_INFO_INCIDENCES_MAX], last_incidence; /* of the light, rising */
    bool is_anisotropic; /* reflection depends on the light's azimuth */
    Arena *arena;
} PlotData;

/* NULL: the file's report cannot be read, *err has the reason. */
PlotData *plot_data_new(const PlotInput *input, Arena *arena, Error *err);
void plot_data_free(PlotData *data);

const char *pattern_name(Pattern pattern); /* "White" */
const float *pattern_codes(Pattern pattern);

/* BRDF, sr^-1, weighted over wavelength as the eye weighs equal-energy light (nm 0) or at a
 * wavelength; the leaving direction's phi counts from the mirror direction. Is it measured? */
double plot_data_brdf(const PlotData *data, double incidence, double theta, double phi, double nm);
bool plot_data_brdf_is_measured(const PlotData *data, double incidence, double theta, double phi);
