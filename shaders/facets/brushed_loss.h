/* SPDX-License-Identifier: Apache-2.0 */
/* brushed_loss.h -- what the facets of a brushed solid's boundary pass to one another.
 *
 * solid_energy.h's shares where both alphas differ: by the alphas, cosine and azimuth, on the
 * axes of lobe_facets.h. A table covers a range of alphas; of one pair it is a table over
 * directions alone.
 *
 * Interpolated by cubics. Of one pair, lost is within 1.3e-3 where no alpha is below 0.01, in
 * the mean 1e-4; below, where light meets the critical angle in a narrow ridge, to 7e-3 inside.
 * Over a range it is 3e-4 outside and 9e-4 inside in the mean; at most 6e-3 outside, and 4e-2
 * at such ridges inside.
 *
 * Memory   76 KiB of one pair in the caller's arena, at most 1.5 MiB; with facets 9 times that.
 *          A pair takes a tenth of a second, a range half a second, with facets 3 times that.
 * Threads  const once built.  Fails  never.
 */
#pragma once
#include "base/arena.h"
#include "base/vec.h"
#include "shaders/facets/lobe_facets.h"

/* Bounds in [SMOOTH_ALPHA, 1] of the greater alpha, and of the lesser over the greater. */
typedef struct BrushedRange {
    float least, most, least_ratio, most_ratio;
} BrushedRange;

typedef struct BrushedLoss BrushedLoss;

/* ior: as solid_energy_build. has_facets: for boundaries that are not bare, too. */
const BrushedLoss *brushed_loss_build(float ior, BrushedRange range, bool has_facets, Arena *arena);

/* As solid_lost, solid_lost_facets and solid_mean_facets (solid_energy.h). w: a unit direction
 * with z > 0; alpha: of x and y, within the table's range. */
SolidLost brushed_lost(const BrushedLoss *table, bool is_inside, Vec3 w, Vec2 alpha);
LostFacets brushed_lost_facets(const BrushedLoss *table, bool is_inside, Vec3 w, Vec2 alpha);
LostFacets brushed_mean_facets(const BrushedLoss *table, bool is_inside, Vec2 alpha);
