/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_eval.h -- how much light metallic_roughness sends from a direction to the eye.
 *
 * Values are sr^-1 (bsdf.h's frame), pdf sr^-1, of choosing wi by metallic_choices.
 *
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include "shaders/metallic/metallic_view.h"
#include "shaders/metallic/metallic_coat.h"

/* The base's facets alone, below the coat where it is (below: of wi). */
Spectrum eval_facets(const MetallicView *view, Vec3 wi, const ThroughCoat *below);

/* The mirror image of a smooth base: a share of light. */
Spectrum eval_smooth(const MetallicView *view, Vec3 wi);

/* All of it but mirror images. */
Spectrum eval_all(const MetallicView *view, Vec3 wi, float *pdf);

/* Does a sheet send light to the other side, elsewhere than straight on? A smooth one does with
 * what its coats hold back of the light that fibres spread. */
static inline bool sends_below(const MetallicRoughness *m)
{
    return m->transmission > 0 &&
           (!is_smooth(m->alpha) || (m->clearcoat > 0 && has_sheen(m)));
}
