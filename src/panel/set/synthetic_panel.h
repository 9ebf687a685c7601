/* SPDX-License-Identifier: Apache-2.0 */
/* synthetic_panel.h -- a synthetic panel whose every value is known in closed form.
 *
 * It stands where a laboratory's panel would stand: `panel simulate` measures it with a
 * virtual instrument, and tests compare a fit with its closed form (closed_form.h).
 *
 * Frame    the display's: theta from the normal, phi 0 right, 90 up (radians here).
 * Units    XYZ with Y in cd m^-2; BRDF in sr^-1 without the cosine; angles in files in degrees.
 * Threads  const once it is read.
 *
 * Emission, primary p, level g, tristimulus component j (s = sin^2 theta):
 *   E_pj = W_pj (g/255)^(gamma - gamma_drop s) A exp(shift_pj s)
 *   A    = cos(theta)^(n_h cos^2 phi + n_v sin^2 phi) T(theta)/T(0) (1 + lobe)
 *   lobe = gain exp(-d^2 / (2 width^2)), d the angle to the lobe's direction
 *   M_black = B white_j/white_Y A (1 + leak s^2 sin^2(2 phi))
 * T = 1 - F, F the unpolarised Fresnel reflectance for the cover's refractive index. W_p is
 * the primary's spectrum (a sum of Gaussians) seen by the CIE 1931 observer, scaled to its
 * luminance at full level.
 *
 * Reflection, beta the projection of a unit direction on the panel's plane (Harvey's
 * shift-invariant scatter, in the ABC form of Church and Takacs):
 *   R(theta, l) = F (c + (1 - c) F), c = coating + coating_blue ((l - 550 nm) / 150 nm)^2
 *   haze   = share sqrt(R(theta_i) R(theta_o)) K(|beta_o - beta_mirror|)
 *   K(b)   = (s - 1) / (pi w^2) (1 + (b/w)^2)^-s      (its integral over the plane is one)
 *   mirror = (1 - share) R(theta)                      (the delta part)
 *   lambertian = rho / pi (1 - F(theta_i)) (1 - F(theta_o))
 * Reciprocal, and never more than R + rho.
 *
 * Places (u from 0 at the left to 1 at the right, v from 0 at the top to 1 at the bottom; x = u
 * - 1/2, y = v - 1/2): a backlight that is not even, its mura, and a bend.
 *   even  = (1 + slope_u x + slope_v y) (1 + mura cos(2 pi cycles_u x) cos(2 pi cycles_v y))
 *   W_pj is multiplied by even tint_j, tint = (1 + tint x, 1, 1 - tint x)
 *   B    by even (1 + clouding (4 x y)^2), and its colour is white's there
 *   gain by 1 + lobe_slope x, share by 1 + haze_slope x (at most 1 at both edges)
 * A bend turns the local normal from -bend/2 at the left edge to bend/2 at the right one about
 * the vertical axis; all angles count from the local normal, and the instrument is set square
 * on every spot. The camera that makes the map is distant, in front of the middle, and sees
 * each place under the angle of its bend.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "panel/set/display_traits.h"

#define SYNTHETIC_PEAKS_MAX 8
#define SYNTHETIC_LEVELS_MAX 32
#define SYNTHETIC_INCIDENCES_MAX 24
#define SYNTHETIC_WAVELENGTHS_MAX 128
#define SYNTHETIC_SPOTS_MAX 49

typedef struct SyntheticPrimary {
    double luminance_cd_m2;                   /* of this primary alone at level 255 on the axis */
    double shift[3];                          /* exponents of X, Y, Z over sin^2 theta */
    int peak_count, fwhm_count, weight_count; /* equal */
    double peak_nm[SYNTHETIC_PEAKS_MAX], fwhm_nm[SYNTHETIC_PEAKS_MAX];
    double weight[SYNTHETIC_PEAKS_MAX];
    double white_xyz[3]; /* W_p above, cd m^-2 */
} SyntheticPrimary;

typedef struct SyntheticEmission {
    SyntheticPrimary primary[3];
    double gamma, gamma_drop;
    double cosine_power[2]; /* n_h, n_v */
    double black_cd_m2, leak;
    double lobe_theta, lobe_phi, lobe_width, lobe_gain; /* radians; gain 0: none */
    int level_count;
    double level[SYNTHETIC_LEVELS_MAX]; /* measured codes, rising, without 0 */
} SyntheticEmission;

typedef struct SyntheticReflection {
    bool exists;
    double coating, coating_blue;
    double haze_share, haze_width, haze_power; /* w without unit, s above 1 */
    double lambertian_albedo;
    int incidence_count, wavelength_count;
    double incidence_deg[SYNTHETIC_INCIDENCES_MAX];
    double wavelength_nm[SYNTHETIC_WAVELENGTHS_MAX];
} SyntheticReflection;

/* The virtual instrument. Noise: value (1 + relative n) + absolute n', n normal. */
typedef struct SyntheticInstrument {
    double theta_max_deg, theta_step_deg, phi_step_deg;
    double brdf_theta_step_deg, brdf_phi_step_deg;
    double fwhm_deg; /* how wide a mirror image of a point looks */
    double noise_relative, noise_cd_m2, noise_brdf_sr;
    double seed;
} SyntheticInstrument;

typedef struct SyntheticPlaces {
    double u[SYNTHETIC_SPOTS_MAX], v[SYNTHETIC_SPOTS_MAX];
    int spots, rows; /* equal; 0: one measurement, of the middle */
    double map[2];   /* pixels, whole; 0: no map */
    double slope[2], mura, mura_cycles[2], tint, clouding, lobe_slope, haze_slope;
    double bend; /* radians; above 0: concave */
} SyntheticPlaces;

typedef struct SyntheticPanel {
    const char *file; /* that it was read from; NULL: none */
    const char *name, *note;
    double pixels[2], size_mm[2];
    double refractive_index;
    SyntheticEmission emission;
    SyntheticReflection reflection;
    SyntheticInstrument instrument;
    SyntheticPlaces places; /* all 0: the same everywhere */
    DisplayTraits traits;   /* no formula above depends on them */
} SyntheticPanel;

/* Spectral shape of a primary, relative. */
double synthetic_panel_spectrum(const SyntheticPrimary *primary, double nm);

/* ---- the exact values, by the formulas above ----------------------------------------------
 *
 * Frame    the display's: theta from the normal, phi 0 right, 90 up (radians).
 * Units    XYZ with Y in cd m^-2; BRDF in sr^-1 without the cosine; nm; codes 0 to 255.
 * Threads  pure functions. Fails: never. */

/* The panel as it is at a place {u, v}, for all that follows. */
SyntheticPanel closed_form_at(const SyntheticPanel *panel, const double place[2]);

/* E_p: what level `code` of primary 0..2 adds to the black pattern. */
void closed_form_emission_xyz(const SyntheticPanel *panel, int primary, double code,
                              const double angles[2], double xyz[3]);

/* M_black. angles: theta, phi. */
void closed_form_black_xyz(const SyntheticPanel *panel, const double angles[2], double xyz[3]);

/* Haze and lambertian part. The light comes from azimuth pi, phi is the leaving azimuth. */
double closed_form_brdf(const SyntheticPanel *panel, double theta_i, double theta_o, double phi,
                        double nm);

/* The delta part's reflectance. */
double closed_form_mirror(const SyntheticPanel *panel, double theta, double nm);

/* The instrument's reading: closed_form_brdf plus the mirror's image, as wide as the
 * instrument. */
double closed_form_instrument_brdf(const SyntheticPanel *panel, double theta_i, double theta_o,
                                   double phi, double nm);

/* Reflectance within a round aperture (full angle) around the mirror direction: the mirror
 * part, and the haze and lambertian part there. */
double closed_form_specular(const SyntheticPanel *panel, double theta, double aperture, double nm);
