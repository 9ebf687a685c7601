/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_eval.h -- metallic_roughness as one eye sees it, made ready for all evaluations,
 * and how much light it sends from a direction to that eye.
 *
 * Values are sr^-1 (bsdf.h's frame), pdf sr^-1, of choosing wi by MetallicChoices.
 *
 * Threads  pure functions; a view belongs to one thread.  Fails  never.
 */
#pragma once
#include "shaders/metallic/metallic_base.h"

/* The base's facets alone, below the coat where it is (below: of wi). */
Spectrum eval_facets(const MetallicView *view, Vec3 wi, const ThroughCoat *below);

/* The mirror image of a smooth base: a share of light. */
Spectrum eval_smooth(const MetallicView *view, Vec3 wi);

/* All of it but mirror images. */
Spectrum eval_all(const MetallicView *view, Vec3 wi, float *pdf);

/* Does a sheet send light to the other side, elsewhere than straight on? A smooth one does with
 * what its coats hold back of the light that the overlay spreads. */
static inline bool sends_below(const MetallicRoughness *m) {
    return m->transmission > 0 && (!is_smooth(m->alpha) || (m->clearcoat > 0 && has_overlay(m)));
}

/* Filled where it stands: it is large, and a plain surface needs little of it. */
void metallic_look(MetallicView *view, const MetallicRoughness *m, Vec3 wo);

/* The view that was kept, if it is of this eye; else one made now in *own. A copy of the
 * material may still point at the view of the first. */
static inline const MetallicView *metallic_seen(const MetallicRoughness *m, Vec3 wo,
                                                MetallicView *own) {
    const MetallicView *seen = m->seen;
    if (seen && seen->m == m && seen->wo.x == wo.x && seen->wo.y == wo.y && seen->wo.z == wo.z)
        return seen;
    metallic_look(own, m, wo);
    return own;
}
