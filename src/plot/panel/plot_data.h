/* SPDX-License-Identifier: Apache-2.0 */
/* plot_data.h -- the panel that is drawn, evaluated once for everything that several charts
 * need.
 *
 * Frame    the display's: phi 0 right, 90 up. A polar map's rim is the horizon.
 * Units    radians, cd m^-2, sr^-1, nm, lux.
 * Memory   the arena's. Threads: the sampling uses `threads`; then const.
 */
#pragma once
#include <jansson.h>
#include <stdbool.h>

#include "base/error.h"
#include "panel/set/measurement.h"
#include "panel/figures/panel_figure.h"
#include "panel/query/panel_info.h"
#include "plot/draw/field.h"

/* ---- what is chosen --------------------------------------------------------------------- */

/* What a user may have drawn of a panel: kinds of charts, lines at values,
 * contrast in some light.
 *
 * Units    lux; a contour in the chart's own unit (cd m^-2, or a ratio), or in percent of the
 *          chart's value on the axis.
 * Threads  pure functions.
 * Fails    with the option, what was found and what was required. */

typedef enum PlotKind {
    PLOT_ALL,
    PLOT_LUMINANCE,
    PLOT_CONTRAST,
    PLOT_COLOUR_SHIFT,
    PLOT_GREY_INVERSION,
    PLOT_GREY_LEVELS,
    PLOT_SECTIONS,
    PLOT_CHROMATICITY,
    PLOT_SPECTRA,
    PLOT_BRDF,
    PLOT_BRDF_SPECTRUM,
    PLOT_BRDF_MAP,
    PLOT_MIRROR,
    PLOT_FIT,
    PLOT_UNIFORMITY,
    PLOT_HALO,
    PLOT_KIND_COUNT
} PlotKind;

/* The names of the kinds in their order, as one types them: "all|luminance|...". */
#define PLOT_KINDS \
    "all|luminance|contrast|colour-shift|grey-inversion|grey-levels|sections|chromaticity|" \
    "spectra|brdf|brdf-spectrum|brdf-map|mirror|fit|uniformity|halo"

const char *plot_kind_name(PlotKind kind);

#define PLOT_CONTOURS_MAX 16
#define PLOT_AMBIENT_MAX 8

typedef struct PlotContours {
    int count;
    double value[PLOT_CONTOURS_MAX]; /* above 0 */
    bool is_percent[PLOT_CONTOURS_MAX];
} PlotContours;

/* Light on the panel: an even surround, and a directed source at an angle to the normal. */
typedef struct PlotLight {
    double lux;            /* of the surround; 0: none */
    double directed_lux;   /* on the panel's plane; 0: none */
    double directed_theta; /* radians; its azimuth is PlotSource's */
} PlotLight;

typedef struct PlotAmbient {
    int count;
    PlotLight light[PLOT_AMBIENT_MAX];
} PlotAmbient;

/* "200,50%": numbers above 0 with commas. */
bool plot_contours_read(const char *text, PlotContours *out, Error *err);

/* The light of --ambient LUX[,LUX...], and of --directed LUX[,DEG], which adds to each of them
 * or stands alone. Either text may be NULL. */
bool plot_ambient_read(const char *ambient, const char *directed, PlotAmbient *out, Error *err);

#define AMBIENT_HELP "contrast also in even diffuse light of this illuminance"
#define DIRECTED_HELP \
    "to it a directed source: its illuminance on the panel and its angle to the normal " \
    "(default 45); alone without --ambient"

/* The i-th value in the chart's unit, from that on the axis. */
double plot_contours_level(const PlotContours *contours, int i, double on_axis);

typedef enum Pattern {
    PATTERN_WHITE,
    PATTERN_RED,
    PATTERN_GREEN,
    PATTERN_BLUE,
    PATTERN_BLACK,
    PATTERN_COUNT
} Pattern;

#define PLOT_REFLECTANCES 91

/* The panel and what is drawn of it. */
typedef struct PlotSource {
    const Panel *panel;
    const char *file;            /* as the user named it */
    const char *reading;         /* how the panel is read, for headings; NULL: as it is */
    const json_t *report;        /* panel_report's */
    const Measurement *measured; /* NULL: none given */
    double incidence_phi;        /* azimuth of the light, radians; PI: from the left */
    bool wants_maps;             /* samples emission over the hemisphere */
    bool wants_reflectance;      /* into every angle, though no ambient is given */
    int threads;
    PlotContours contours; /* lines that the user requests in place of ours */
    PlotAmbient ambient;   /* light in which contrast is computed besides the dark */
} PlotSource;

typedef struct PlotData {
    PlotSource source;
    const char *name;      /* of the panel */
    const char *file_name; /* without folders; and how it is read, where that is said */
    bool emits, has_black, reflects, has_mirror;
    bool has_gamma_table;           /* white only, with levels measured on the axis */
    bool is_white_only;             /* its primaries and levels are assumed, not measured */
    double cone;                    /* emission is measured up to this theta */
    const char *azimuths;           /* "measured at φ 0°, 90° alone", where they are few; or NULL */
    float normal[PATTERN_COUNT][3]; /* XYZ at the normal */
    Field xyz[PATTERN_COUNT][3];    /* over the hemisphere; without maps empty */
    int wavelength_count;           /* of the measured reflection */
    float wavelength_nm[PANEL_INFO_WAVELENGTHS_MAX];
    int incidence_count; /* of the light, measured, rising */
    double incidence[PANEL_INFO_INCIDENCES_MAX], last_incidence;
    bool is_anisotropic;                           /* reflection depends on the light's azimuth */
    double diffuse_reflectance[PLOT_REFLECTANCES]; /* where contrast is computed in the light:
                                   haze and lambertian part, at 0, 1 ... 90 degrees */
    double brdf_cone;                              /* leaving theta measured up to here */
    Arena *arena;
} PlotData;

PlotData *plot_data_new(const PlotSource *source, Arena *arena);

const char *pattern_name(Pattern pattern); /* "White" */
const char *pattern_word(Pattern pattern); /* "white" */
void pattern_codes(Pattern pattern, float rgb[3]);

/* ---- emission --------------------------------------------------------------------------- */

/* Of a pattern at the normal. */
PanelColour plot_data_normal(const PlotData *data, Pattern pattern);

/* Distance in the u'v' plane from the colour at the normal. */
Field plot_data_shift(const PlotData *data, Pattern pattern, Arena *arena);

/* ---- reflection ------------------------------------------------------------------------- */

/* BRDF, sr^-1, weighted over wavelength as the eye weighs equal-energy light (nm 0) or at a
 * wavelength; the leaving direction's phi counts from the mirror direction. */
double plot_data_brdf(const PlotData *data, double incidence, double theta, double phi, double nm);

/* Is it measured? */
bool plot_data_brdf_is_measured(const PlotData *data, double incidence, double theta, double phi);

/* 1 where it is, over the hemisphere; NULL: in the whole cone. */
const Field *plot_data_brdf_measured(const PlotData *data, double incidence, Arena *arena);

/* The weighted one over the hemisphere. */
Field plot_data_brdf_field(const PlotData *data, double incidence, Arena *arena);

/* ---- contrast in ambient light --------------------------------------------------------------
 *
 *   C(d) = (L_white(d) + L_r(d)) / (L_black(d) + L_r(d)),  L_r(d) = R(d) E / pi + f(d, s) E_s
 *
 * E the illuminance of a uniform surround on the panel, E / pi its luminance. R(d) is the
 * panel's hemispherical-directional luminous reflectance: what it sends into direction d from a
 * uniform surround, over what a perfect white diffuser would send,
 *   R(d) = integral of f(d, w) cos theta_w over the hemisphere of w, plus the mirror part,
 * f the panel's own BRDF (haze and lambertian part, as a renderer evaluates it), by 2048
 * directions drawn like it, to about 0.3 %; light from beyond the last measured incidence
 * (beyond 70 degrees 12 % of it) is extrapolated. The mirror part counts, since a uniform
 * surround is mirrored too (specular included). Of an anisotropic panel the mean over eight
 * azimuths of d. E_s is the illuminance on the panel of a small directed source (sun, lamp)
 * that stands at s; pi f(d, s) is the panel's luminance factor in that geometry. The source's
 * image in the mirror part is seen in one direction only, which a render shows, and counts in
 * none here. Weighted by V(lambda) for equal-energy light: lamps of other spectra change R and
 * f where they depend on the wavelength. Source: E. F. Kelley, M. Lindfors, J. Penczek, Display
 * daylight ambient contrast measurement methods and daylight readability, J. Soc. Inf. Display
 * 14 (2006): sky as a uniform surround and sun as a directed source are measured apart, scaled
 * to the illuminances and added; also SID's Information Display Measurements Standard. */

#define AMBIENT_FORMULA \
    "(Lw + Lr) / (Lb + Lr), Lr = R E/π + f Es: white and black at an angle, E the " \
    "illuminance of an even diffuse surround, R the panel's hemispherical-directional " \
    "reflectance into that angle, mirror included, Es the illuminance of a directed source " \
    "on the panel, f the BRDF from it into that angle (Kelley, Lindfors, Penczek 2006)"

/* The lights in which contrast is shown: 0 is the dark, where black is measured, then those of
 * the source. */
PlotLight ambient_light(const PlotData *data, int index);

/* R above, at theta. */
double ambient_reflectance(const PlotData *data, double theta);

/* L_r above at an angle, cd m^-2. */
double ambient_reflected(const PlotData *data, double theta, double phi, const PlotLight *light);

/* C above at an angle; NaN: black and what is reflected are nothing. */
double ambient_contrast(const PlotData *data, double theta, double phi, const PlotLight *light);

/* The same over the hemisphere. */
Field ambient_contrast_field(const PlotData *data, const PlotLight *light, Arena *arena);

/* "500 lx", "15000 lx and 65000 lx from 45°". */
const char *ambient_text(const PlotLight *light, Arena *arena);
