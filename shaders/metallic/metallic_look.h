/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_look.h -- metallic_roughness as one eye sees it, made ready for all that is asked.
 *
 * Threads  a view belongs to one thread.  Fails  never.
 */
#pragma once
#include "shaders/metallic/metallic_view.h"

/* Filled where it stands: it is large, and a plain surface needs little of it. */
void metallic_look(MetallicView *view, const MetallicRoughness *m, Vec3 wo);

/* The view that was kept, if it is of this eye; else one made now in *own. A copy of the
 * material may still point at the view of the first. */
static inline const MetallicView *metallic_seen(const MetallicRoughness *m, Vec3 wo,
                                                MetallicView *own)
{
    const MetallicView *seen = m->seen;
    if (seen && seen->m == m && seen->wo.x == wo.x && seen->wo.y == wo.y && seen->wo.z == wo.z)
        return seen;
    metallic_look(own, m, wo);
    return own;
}
