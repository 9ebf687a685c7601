/* SPDX-License-Identifier: Apache-2.0 */
/* panel_figure.h -- what data sheets and standards state of a display, from an opened panel:
 * each figure is one function, which all that prints or draws it calls.
 *
 * Frame    the display's (panel.h): theta from the normal, phi 0 right, 90 degrees up; a theta
 *          below 0 is the opposite azimuth, one of 90 degrees stands for just below it.
 * Units    radians, cd m^-2, sr^-1, nm, codes of 255; ratios and reflectances have none.
 * Precise  as the panel's 32-bit values are, relative 1e-6; angles to 1e-5 degrees.
 * NaN      the panel does not have that figure; each function says when.
 * Threads  pure functions. Fails: never.
 * Sources  IDMS: SID, Information Display Measurements Standard, by its chapters: 5 contrast and
 *          gamut, 6 grey scale, 8 uniformity, 9 viewing angle, 11 reflection. CIE 15,
 *          Colorimetry: chromaticity, reflectances and their geometries.
 *          Named by subject; the standards' own texts were not read for this.
 */
#pragma once
#include "base/vec.h"
#include "panel/query/panel.h"
#include "spectrum/gamut.h"

static const float PANEL_WHITE[3] = {255, 255, 255}, PANEL_BLACK[3] = {0, 0, 0};

Vec3 panel_figure_direction(double theta, double phi);

/* ---- light ------------------------------------------------------------------------------- */

double panel_figure_luminance(const Panel *panel, double theta, double phi, const float rgb[3]);

/* White's luminance over that of black in the dark (IDMS 5). NaN: black gives no light. */
double panel_figure_contrast(const Panel *panel, double theta, double phi);

/* CIE 15: x = X / (X + Y + Z); u' = 4 X / (X + 15 Y + 3 Z), v' = 9 Y / (the same). NaN: no
 * light. The colour temperature is colour_temperature of uv (gamut.h). */
typedef struct PanelColour {
    double xyz[3], xy[2], uv[2];
} PanelColour;

PanelColour panel_figure_colour(const Panel *panel, double theta, double phi, const float rgb[3]);

/* Distance in u'v' from the same pattern at the normal (CIE 1976; IDMS 9). NaN: no light. */
double panel_figure_shift(const Panel *panel, double theta, double phi, const float rgb[3]);

/* In xy, at the normal, each alone at full drive with the black that leaks (IDMS 5). */
GamutTriangle panel_figure_primaries(const Panel *panel);

/* The exponent g of (L(c) - L(0)) / (L(255) - L(0)) = (c / 255)^g by least squares of the
 * logarithms over the measured codes c, the line held at full drive: the power law of IDMS 6.
 * channel 0..2: that primary alone; PANEL_GREY: all three at one code. NaN: one level. */
#define PANEL_GREY 3
double panel_figure_gamma(const Panel *panel, int channel, double theta, double phi);

/* ---- viewing angle ----------------------------------------------------------------------- */

/* What has to hold within the angle. */
typedef struct PanelLimit {
    enum {
        PANEL_LEAST_CONTRAST,  /* white over black is value or more */
        PANEL_LEAST_LUMINANCE, /* white over white at the normal is value or more */
        PANEL_MOST_SHIFT       /* white's panel_figure_shift is value or less */
    } kind;
    double value;
} PanelLimit;

/* The first theta at which the limit is crossed along phi, from the normal outwards (IDMS 9,
 * threshold-based). 0: not even held at the normal. NaN: held as far as was measured. place: of
 * the active area (panel_place.h); NULL: where the file's own panel was measured. What crosses
 * the limit and comes back within a quarter of a degree is not seen. */
double panel_figure_viewing_angle(const Panel *panel, const float place[2], PanelLimit limit,
                                  double phi);

/* ---- grey inversion ----------------------------------------------------------------------- */

/* Where a higher grey level gives less light than a lower one, and by how much: grey is red,
 * green and blue at one code. At a direction the pair of measured levels that is wrong the most
 * counts: share = 1 - L(higher) / L(lower), black included. What is below PANEL_INVERSION_LEAST
 * counts as none: no eye sees it between two levels. */
#define PANEL_INVERSION_LEAST 0.01

typedef struct PanelInversion {
    double share;      /* 0: none */
    double low, high;  /* codes: the lower one is brighter */
    double theta, phi; /* where it is largest */
    double first;      /* theta at which it begins; NaN: none */
} PanelInversion;

/* The largest along an azimuth, by half degrees up to the measured cone. Fewer than two levels
 * were measured: none. */
PanelInversion panel_figure_inversion(const Panel *panel, double phi);

/* ---- reflection --------------------------------------------------------------------------
 *
 * At a wavelength, or (nm 0) as the eye weighs equal-energy light: the sum of V(lambda) R over
 * that of V(lambda), from 380 to 780 nm by tens (CIE 15; the interval of ASTM E308). wi to the
 * light, wo to the eye. All are 0 where nothing was measured. */

/* Without the mirror part. */
double panel_figure_brdf(const Panel *panel, Vec3 wo, Vec3 wi, double nm);

/* Of it the floor that is the same into every direction, luminous. */
double panel_figure_lambertian(const Panel *panel, Vec3 wo, Vec3 wi);

/* The mirror part's reflectance for light from theta. */
double panel_figure_mirror(const Panel *panel, double theta, double nm);

/* Directional-hemispherical reflectance without the mirror part, luminous: of 8 degrees CIE
 * 15's 8:de. With the mirror part, 8:di. */
double panel_figure_diffuse(const Panel *panel, double theta);

/* Hemispherical-directional: what a uniform surround sends into theta, over what a perfect white
 * diffuser would send,
 *   R = integral of f cos theta_w over the hemisphere of w, plus the mirror part,
 * by 2048 directions drawn like f, to about 0.3 %; light from beyond the last measured incidence
 * (beyond 70 degrees 12 % of it) is extrapolated. Of an anisotropic panel the mean over eight
 * azimuths. */
double panel_figure_reflectance(const Panel *panel, double theta);

/* The haze's peak in the mirror direction of light from theta at the left, and its width where
 * it is halfway between the peak and what is left 60 degrees further out, in the plane of
 * incidence (IDMS 11). */
typedef struct PanelHaze {
    double peak_sr, fwhm; /* fwhm NaN: no peak, less than a fifth above what is left */
} PanelHaze;

PanelHaze panel_figure_haze(const Panel *panel, double theta);

/* ---- evenness over the active area --------------------------------------------------------
 *
 * Nine points stand at a tenth, a half and nine tenths of width and height, row by row from the
 * upper left corner (IDMS 8). */

#define PANEL_NINE 9

/* Luminance along the local normal. */
typedef struct PanelEvenness {
    double nine[PANEL_NINE];
    double nine_least, nine_most, nine_mean;
    double least, most, mean; /* over 96 x 54 places */
} PanelEvenness;

/* The place {u, v} of one of the nine. */
void panel_nine_place(int index, float place[2]);

PanelEvenness panel_figure_evenness(const Panel *panel, const float rgb[3]);

/* By how much least is less than most, 1 - least / most (IDMS 8); 0 where there is no light. */
static inline double panel_non_uniformity(double least, double most) {
    return most > 0 ? 1 - least / most : 0;
}
