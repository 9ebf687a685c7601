/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/tables/lobe_facets_build.h"

#include <stddef.h>

#include "shaders/facets/brushed.h"
#include "shaders/facets/brushed_axes.h"

/* Points of the midpoint rule over the unit square of facets; as energy.c they crowd where the
 * facets lie that send light below the horizon. */
#define TURNS 48
#define HEIGHTS 32
#define POINTS (TURNS * HEIGHTS)
/* Directions of the mean, over cosine and over a quarter of a turn. */
#define MEAN_COSINES 96
#define MEAN_TURNS 12

/* ---- lobes ------------------------------------------------------------------------------- */

static LobeFacets facets_of_lobe(Vec3 wo, Vec2 alpha)
{
    LobeFacets out;
    double     sum[LOBE_FACETS] = {0}, at[LOBE_FACETS];
    for (int i = 0; i < POINTS; i++) {
        int   row = i / TURNS;
        float rest = ((float)row + 0.5f) / HEIGHTS, shift = (float)row * 0.618034f;
        float turn = ((float)(i % TURNS) + shift - (float)(int)shift) / TURNS;
        Vec3  wi = brushed_sample_reflection(wo, alpha, turn, 1 - rest * rest);
        if (!(wi.z > 0)) continue;
        Vec3  half = vec3_normalize(vec3_add(wo, wi));
        float weight = 2 * rest * brushed_reflection(wo, wi, half, alpha) * wi.z /
                       brushed_reflection_pdf(wo, half, alpha);
        facet_polynomials((double)vec3_dot(wo, half), at);
        for (int k = 0; k < LOBE_FACETS; k++) sum[k] += (double)weight / POINTS * at[k];
    }
    for (int k = 0; k < LOBE_FACETS; k++) out.weight[k] = (float)sum[k];
    return out;
}

static float fourth_power(int row, int count)
{
    float root = lerpf(FACET_LEAST, 1, (float)row / (float)(count - 1));
    return root * root * root * root;
}

static void fill_lobes(Vec2 alpha, LobeFacets (*rows)[FACET_COSINES])
{
    for (int t = 0; t < FACET_AZIMUTHS; t++)
        for (int c = 0; c < FACET_COSINES; c++) {
            float turn = (float)t / (FACET_AZIMUTHS - 1);
            float own = lerpf(alpha.y, alpha.x, turn * turn);
            float cosine = facet_axis_cosine((float)c / (FACET_COSINES - 1), own);
            rows[t][c] = facets_of_lobe(facet_direction(cosine, own, alpha), alpha);
        }
}

/* Evenly in the cosine's fourth root: what narrow lobes lose they lose at grazing. */
static LobeFacets mean_of(const FacetTable *table, Vec2 alpha)
{
    LobeFacets sum = {{0}};
    float      all = 0;
    for (int i = 0; i < MEAN_COSINES * MEAN_TURNS; i++) {
        float root = ((float)(i % MEAN_COSINES) + 0.5f) / MEAN_COSINES, sine, cosine;
        float root3 = root * root * root, z = root3 * root, side = safe_sqrtf(1 - z * z);
        float share = root3 * z;
        all += share;
        sincos_turns(((float)(i / MEAN_COSINES) + 0.5f) / (4 * MEAN_TURNS), &sine, &cosine);
        LobeFacets lobe = lobe_facets(table, vec3(side * cosine, side * sine, z), alpha);
        for (int k = 0; k < LOBE_FACETS; k++) sum.weight[k] += share * lobe.weight[k];
    }
    for (int k = 0; k < LOBE_FACETS; k++) sum.weight[k] /= all;
    return sum;
}

const FacetTable *facet_table_build(Arena *arena)
{
    FacetTable *table = ARENA_NEW(arena, FacetTable, 1);
    for (int a = 0; a < FACET_ALPHAS; a++)
        for (int r = 0; r < FACET_RATIOS; r++) {
            float high = fourth_power(a, FACET_ALPHAS);
            fill_lobes((Vec2){high, high * fourth_power(r, FACET_RATIOS)}, table->lobe[a][r]);
        }
    for (int a = 0; a < MEAN_ALPHAS; a++)
        for (int r = 0; r < MEAN_RATIOS; r++) {
            float high = fourth_power(a, MEAN_ALPHAS);
            table->mean[a][r] =
                mean_of(table, (Vec2){high, high * fourth_power(r, MEAN_RATIOS)});
        }
    return table;
}
