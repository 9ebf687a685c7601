/* SPDX-License-Identifier: Apache-2.0 */
/* closed_form.h -- the exact values of a synthetic panel, by the formulas of synthetic_panel.h.
 *
 * Frame    the display's: theta from the normal, phi 0 right, 90 up (radians).
 * Units    XYZ with Y in cd m^-2; BRDF in sr^-1 without the cosine; nm; codes 0 to 255.
 * Threads  pure functions. Fails: never.
 */
#pragma once
#include "panel/set/synthetic_panel.h"

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
double closed_form_specular(const SyntheticPanel *panel, double theta, double aperture,
                            double nm);
