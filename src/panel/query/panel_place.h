/* SPDX-License-Identifier: Apache-2.0 */
/* panel_place.h -- what a panel emits and reflects at a place of its active area. HOT.
 *
 * A display was measured at several spots, or has a uniformity map, or both. The panels of the
 * spots around a place count with the weights of spot_ground.h: the light of all adds up, so do
 * their BRDFs and mirror parts, and directions are drawn from the mixture of their densities.
 * A sum of weights one of panels that reflect no more than they get reflects no more either.
 * The map scales what each panel emits: by its value there over its value where that panel
 * was measured, white by white's and the black pattern by black's; what the codes add is
 * white less black. Colours of the map turn the primaries' spectra as angles do.
 *
 * Frame    places: u from 0 at the left to 1 at the right, v from 0 at the top to 1 at the
 *          bottom, as someone facing the display sees it; held in there. Directions: panel.h.
 * Threads  any number. Fails: never.
 */
#pragma once
#include <stdbool.h>

#include "base/vec.h"
#include "panel/query/panel.h"
#include "spectrum/wavelengths.h"

#define PANEL_MIX_MAX 4

/* Panels that count at a place, and how much; weights add up to one. */
typedef struct PanelMix {
    int count;
    const Panel *panel[PANEL_MIX_MAX];
    float weight[PANEL_MIX_MAX];
} PanelMix;

/* False: it is the same everywhere; panel_emission.h and panel_reflection.h suffice. */
bool panel_varies(const Panel *panel);

PanelMix panel_place_reflection(const Panel *panel, const float place[2]);

/* As panel_emission_xyz and panel_emission_spectrum, at a place. */
bool panel_place_emission_xyz(const Panel *panel, const float place[2], Vec3 direction,
                              const float rgb[3], float xyz[3]);
Spectrum panel_place_emission_spectrum(const Panel *panel, const float place[2], Vec3 direction,
                                       const float rgb[3], const Wavelengths *wavelengths);

/* Is that direction within the measured cone, of all panels that count at the place? */
bool panel_place_emission_is_measured(const Panel *panel, const float place[2], Vec3 direction);

/* As the functions of panel_reflection.h and panel_sampling.h. brdf: what panel_mix_brdf
 * returned for wi. */
Spectrum panel_mix_brdf(const PanelMix *mix, Vec3 wo, Vec3 wi, const Wavelengths *wavelengths);
Spectrum panel_mix_lambertian(const PanelMix *mix, Spectrum brdf, Vec3 wi,
                              const Wavelengths *wavelengths);
Spectrum panel_mix_mirror(const PanelMix *mix, float cos_theta, const Wavelengths *wavelengths);
float panel_mix_haze_albedo(const PanelMix *mix, float cos_theta);
float panel_mix_pdf(const PanelMix *mix, Vec3 wo, Vec3 wi);
bool panel_mix_sample(const PanelMix *mix, Vec3 wo, const float u[3], Vec3 *wi, float *pdf);

/* Is there an image in the display's glass, of light that falls straight on it, anywhere? */
bool panel_has_mirror(const Panel *panel);

/* The map at a place, bilinear between the middles of its pixels: X, Y, Z of white and black,
 * relative. Private to src/panel. */
struct PanelMap;
void panel_map_at(const struct PanelMap *map, const float place[2], float white[3], float black[3]);
