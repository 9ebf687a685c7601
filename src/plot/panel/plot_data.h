/* SPDX-License-Identifier: Apache-2.0 */
/* plot_data.h -- the panel that is drawn, asked once for everything that several charts need.
 *
 * Frame    the display's: phi 0 right, 90 up. A polar map's rim is the horizon.
 * Units    radians, cd m^-2, sr^-1, nm.
 * Memory   the arena's. Threads: the sampling uses `threads`; then const.
 */
#pragma once
#include <jansson.h>

#include "panel/set/measurement.h"
#include "panel/query/panel.h"
#include "panel/query/panel_info.h"
#include "plot/draw/field.h"
#include "plot/panel/plot_lists.h"

typedef enum Pattern {
    PATTERN_WHITE, PATTERN_RED, PATTERN_GREEN, PATTERN_BLUE, PATTERN_BLACK, PATTERN_COUNT
} Pattern;

#define PLOT_REFLECTANCES 91

/* The panel and what is drawn of it. */
typedef struct PlotSource {
    const Panel       *panel;
    const char        *file;     /* as the user named it */
    const json_t      *report;   /* panel_report's */
    const Measurement *measured; /* NULL: none given */
    double             incidence_phi; /* azimuth of the light, radians; PI: from the left */
    bool               wants_maps;    /* samples emission over the hemisphere */
    int                threads;
    PlotContours       contours;      /* lines that the user wants in place of ours */
    PlotAmbient        ambient;       /* light in which contrast is asked besides the dark */
} PlotSource;

typedef struct PlotData {
    PlotSource source;
    const char *name, *file_name; /* of the panel, and of its file without folders */
    bool   emits, has_black, reflects, has_mirror;
    bool   has_gamma_table;     /* white only, with levels measured on the axis */
    bool   is_white_only;       /* its primaries and levels are assumed, not measured */
    double cone;                /* emission is measured up to this theta */
    float  normal[PATTERN_COUNT][3];  /* XYZ at the normal */
    Field  xyz[PATTERN_COUNT][3];     /* over the hemisphere; without maps empty */
    int    wavelength_count;    /* of the measured reflection */
    float  wavelength_nm[PANEL_INFO_WAVELENGTHS_MAX];
    int    incidence_count;     /* of the light, measured, rising */
    double incidence[PANEL_INFO_INCIDENCES_MAX], last_incidence;
    bool   is_anisotropic;      /* reflection depends on the light's azimuth */
    double diffuse_reflectance[PLOT_REFLECTANCES]; /* where contrast is asked in the light:
                                   haze and lambertian part, at 0, 1 ... 90 degrees */
    double brdf_cone;           /* leaving theta measured up to here */
    Arena *arena;
} PlotData;

PlotData *plot_data_new(const PlotSource *source, Arena *arena);

const char *pattern_name(Pattern pattern);
void pattern_codes(Pattern pattern, float rgb[3]);

/* ---- emission --------------------------------------------------------------------------- */

/* XYZ at an angle; true where measured. Negative theta: the opposite azimuth. */
bool plot_data_xyz(const PlotData *data, double theta, double phi, const float rgb[3],
                 double xyz[3]);

/* Luminance of white over that of black; NaN where black is nothing. */
Field plot_data_contrast(const PlotData *data, Arena *arena);

/* Distance in the u'v' plane from the colour at the normal. */
Field plot_data_shift(const PlotData *data, Pattern pattern, Arena *arena);

void uv_of(const double xyz[3], double uv[2]);

/* ---- reflection ------------------------------------------------------------------------- */

/* BRDF, sr^-1, weighted over wavelength as the eye weighs equal-energy light; the leaving
 * direction's phi counts from the mirror direction. */
double plot_data_brdf(const PlotData *data, double incidence, double theta, double phi);

/* At one wavelength. */
double plot_data_brdf_at(const PlotData *data, double incidence, double theta, double phi,
                       double nm);

/* The same over the hemisphere. */
Field plot_data_brdf_field(const PlotData *data, double incidence, Arena *arena);

/* Mirror reflectance, weighted by the eye (nm 0) or at a wavelength. */
double plot_data_mirror(const PlotData *data, double theta, double nm);
