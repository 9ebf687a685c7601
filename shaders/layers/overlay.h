/* SPDX-License-Identifier: Apache-2.0 */
/* overlay.h -- a layer that scatters light over the base of a surface: its lobe, and how much
 * it leaves to what lies beneath.
 *
 * Local frame, +z the normal; shares of light in [0, 1]. A white layer has a lobe and, by that,
 * an albedo. A coloured one sends that times its colour; what lies beneath is scaled as under a
 * grey one of its strongest primary, so that both never send more than they get.
 *
 * OverlayShare holds what a white one sends, and what it takes from GGX facets beneath: a
 * facet's light is scaled by 1 - c max(albedo(wo), albedo(wi)), c the strongest primary. Over
 * all of the facets' light from wo that is 1 - c `all`; `shape` is the same where each facet
 * reflects as the exact Fresnel curve's shape does (energy.h).
 *
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include "base/mathf.h"
#include "base/vec.h"
#include "shaders/facets/energy.h"
#include "spectrum/wavelengths.h"

typedef struct Overlay {
    float color[3]; /* linear Rec.709, [0, 1]; 0: there is none */
    float alpha;    /* of its lobe, as overlay_alpha gives it */
} Overlay;

/* alpha of a glTF roughness in [0, 1]: its square, but not below the least that has a lobe. */
float overlay_alpha(float roughness);

/* Its colour per lane, at most overlay_most. */
Spectrum overlay_tint(const Overlay *overlay, const Wavelengths *wavelengths);

/* Of a white one: albedo along a cosine, [0, 1]; lobe, sr^-1, 0 unless both are above the
 * surface. */
float overlay_albedo(const Overlay *overlay, float cosine);
float overlay_lobe(const Overlay *overlay, Vec3 wo, Vec3 wi);

/* Over facets of GGX alpha `base`, [0, 1], along a cosine and over the hemisphere (weighted by
 * the cosine); of a smooth face all and shape are the albedo. */
OverlayShare overlay_share(const Overlay *overlay, float cosine, float base);
OverlayShare overlay_mean(const Overlay *overlay, float base);

/* Energies that facets send through it, of which it takes that share. */
Energy overlay_passes(const Overlay *overlay, Energy e, OverlayShare share);

/* Share of the light that it sends, of that from one direction, which a lacquer (coat.h) over
 * it lets out. */
float overlay_open(const Overlay *overlay, float cosine, float coat_alpha);

/* The strongest primary. */
static inline float overlay_most(const Overlay *overlay) {
    return max_f(max_f(overlay->color[0], overlay->color[1]), overlay->color[2]);
}
