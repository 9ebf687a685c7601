/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/air/beam_table.h"

#include <math.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/parallel.h"
#include "sky/air/bent_ray.h"

#define SUN_RADIUS 0.00465
#define COLUMN_HEIGHTS 96
#define COLUMN_COSINES 192
#define DENSITY_NODES 2048

/* ---- building ---------------------------------------------------------------------------- */

/* Cosine of the floor's edge as seen from an altitude. */
static double edge_cosine(double altitude_m, double floor_m) {
    double ratio = (AIR_EARTH_M + floor_m) / (AIR_EARTH_M + fmax(altitude_m, floor_m));
    return -sqrt(fmax(0, 1 - ratio * ratio));
}

static double table_height(const BeamTable *b, int i) {
    double share = i / (COLUMN_HEIGHTS - 1.0);
    return b->floor_m + (b->optics.top_m - b->floor_m) * share * share;
}

static void fill_columns(void *context, int item, int worker) {
    const BeamTable *b = context;
    double height = table_height(b, item), edge = edge_cosine(height, b->floor_m);
    AirShells over = air_shells(&b->optics, height);
    (void)worker;
    for (int j = 0; j < COLUMN_COSINES; j++) {
        double share = j / (COLUMN_COSINES - 1.0), column[AIR_PARTS];
        double cosine = edge + (1 - edge) * share * share + 1e-9;
        air_column_over(&b->optics, &over, cosine, b->floor_m - 1, column);
        for (int p = 0; p < AIR_PARTS; p++)
            b->column[(item * COLUMN_COSINES + j) * AIR_PARTS + p] = (float)column[p];
    }
}

static void fill_density(BeamTable *b) {
    for (int i = 0; i < DENSITY_NODES; i++) {
        double share = i / (DENSITY_NODES - 1.0), z = b->optics.top_m * share * share;
        for (int p = 0; p < AIR_PARTS; p++)
            b->density[i * AIR_PARTS + p] = (float)air_density(&b->optics, (AirPart)p, z);
    }
}

void beam_table_build(const AirOptics *optics, double floor_m, int threads, Arena *arena,
                      BeamTable *out) {
    *out = (BeamTable){.optics = *optics, .floor_m = floor_m};
    out->column = ARENA_NEW(arena, float, COLUMN_HEIGHTS *COLUMN_COSINES *AIR_PARTS);
    out->density = ARENA_NEW(arena, float, DENSITY_NODES *AIR_PARTS);
    fill_density(out);
    parallel_for(threads, COLUMN_HEIGHTS, fill_columns, out);
}

/* ---- with bent rays ---------------------------------------------------------------------- */

typedef struct BentBuild {
    BeamTable *table;
    BentAir air;
} BentBuild;

/* Rays from one height, even steps of the root from the floor's edge to the zenith. */
typedef struct BentFan {
    double angle[COLUMN_COSINES], turned[COLUMN_COSINES]; /* as seen; outside the air */
    double column[COLUMN_COSINES][AIR_PARTS];
} BentFan;

static void follow_fan(const BentBuild *build, double height, BentFan *fan) {
    double edge = bent_ray_edge_cosine(&build->air, height, build->table->floor_m);
    for (int j = 0; j < COLUMN_COSINES; j++) {
        double share = j / (COLUMN_COSINES - 1.0);
        double cosine = fmin(1, edge + (1 - edge) * share * share);
        fan->angle[j] = acos_d(cosine);
        fan->turned[j] =
            fan->angle[j] + bent_ray_column(&build->air, height, cosine, fan->column[j]);
    }
}

/* Optical depth that thins light as bending does between two neighbouring rays. */
static double spreading(const BentFan *fan, int j) {
    return log_d((fan->turned[j + 1] - fan->turned[j]) / (fan->angle[j + 1] - fan->angle[j]));
}

/* The fan at even steps of the true angle's cosine. */
static void fill_bent(void *context, int item, int worker) {
    const BentBuild *build = context;
    BeamTable *b = build->table;
    BentFan fan;
    (void)worker;
    follow_fan(build, table_height(b, item), &fan);
    double edge = cos_d(fan.turned[0]);
    b->edge[item] = (float)fan.turned[0];
    for (int j = 0, k = 0; j < COLUMN_COSINES; j++) {
        double share = j / (COLUMN_COSINES - 1.0);
        double angle = acos_d(fmin(1, edge + (1 - edge) * share * share));
        while (k < COLUMN_COSINES - 2 && fan.turned[k + 1] > angle) k++;
        double t = (angle - fan.turned[k]) / (fan.turned[k + 1] - fan.turned[k]);
        int at = item * COLUMN_COSINES + j;
        t = fmax(0, fmin(1, t));
        for (int p = 0; p < AIR_PARTS; p++)
            b->column[at * AIR_PARTS + p] =
                (float)(fan.column[k][p] + t * (fan.column[k + 1][p] - fan.column[k][p]));
        b->thinned[at] = (float)spreading(&fan, k);
    }
}

void beam_table_build_bent(const AirOptics *optics, double floor_m, int threads, Arena *arena,
                           BeamTable *out) {
    *out = (BeamTable){.optics = *optics, .floor_m = floor_m};
    out->column = ARENA_NEW(arena, float, COLUMN_HEIGHTS *COLUMN_COSINES *AIR_PARTS);
    out->density = ARENA_NEW(arena, float, DENSITY_NODES *AIR_PARTS);
    out->thinned = ARENA_NEW(arena, float, COLUMN_HEIGHTS *COLUMN_COSINES);
    out->edge = ARENA_NEW(arena, float, COLUMN_HEIGHTS);
    fill_density(out);
    Arena scratch = *arena;
    BentBuild build = {out, bent_air_build(&out->optics, &scratch)};
    parallel_for(threads, COLUMN_HEIGHTS, fill_bent, &build);
}

/* ---- reading ----------------------------------------------------------------------------- */

BeamHeight beam_table_height(const BeamTable *b, double altitude) {
    double y = sqrt(fmax(0, altitude - b->floor_m) / (b->optics.top_m - b->floor_m)) *
               (COLUMN_HEIGHTS - 1);
    BeamHeight at = {.row = (int)fmin(y, COLUMN_HEIGHTS - 1.001)};
    at.share = (float)(y - at.row);
    if (!b->edge) at.edge = edge_cosine(altitude, b->floor_m);
    else at.edge = cos_d((double)lerpf(b->edge[at.row], b->edge[at.row + 1], at.share));
    return at;
}

void beam_table_passing(const BeamTable *b, const BeamHeight *height, double cosine,
                        Spectrum *out) {
    double edge = height->edge;
    double x = sqrt(fmax(0, fmin(1, (cosine - edge) / (1 - edge)))) * (COLUMN_COSINES - 1);
    int j = (int)fmin(x, COLUMN_COSINES - 1.001), at = height->row * COLUMN_COSINES + j;
    float t = height->share, u = (float)(x - j);
    const float *low = b->column + at * AIR_PARTS, *high = low + COLUMN_COSINES * AIR_PARTS;
    Spectrum depth = spectrum_all(0);
    for (int p = 0; p < AIR_PARTS; p++) {
        float column =
            lerpf(lerpf(low[p], low[p + AIR_PARTS], u), lerpf(high[p], high[p + AIR_PARTS], u), t);
        depth += b->optics.depth[p] * spectrum_all(column);
    }
    if (b->thinned) {
        const float *near = b->thinned + at, *far = near + COLUMN_COSINES;
        depth += spectrum_all(lerpf(lerpf(near[0], near[1], u), lerpf(far[0], far[1], u), t));
    }
    *out = spectrum_exp(-depth);
}

/* The share of the disc over the edge, taken as a bar. Angles differ by more than their
 * cosines: clear of the edge, where nearly all suns stand, these will do. */
static double disc_seen(double edge, double cosine) {
    if (cosine - edge > SUN_RADIUS) return 1;
    if (cosine - edge < -SUN_RADIUS) return 0;
    double over = acos_d(edge) - acos_d(fmax(-1, fmin(1, cosine)));
    return fmax(0, fmin(1, 0.5 + over / (2 * SUN_RADIUS)));
}

void beam_table_sun(const BeamTable *b, const BeamHeight *at, double cosine, Spectrum *out) {
    double seen = disc_seen(at->edge, cosine);
    *out = spectrum_all(0);
    if (seen <= 0) return;
    beam_table_passing(b, at, cosine, out);
    *out *= spectrum_all((float)seen);
}

void beam_table_density(const BeamTable *b, double altitude, float density[AIR_PARTS]) {
    double x = sqrt(fmax(0, altitude) / b->optics.top_m) * (DENSITY_NODES - 1);
    int i = (int)fmin(x, DENSITY_NODES - 1.001);
    for (int p = 0; p < AIR_PARTS; p++)
        density[p] = lerpf(b->density[i * AIR_PARTS + p], b->density[(i + 1) * AIR_PARTS + p],
                           (float)(x - i));
}
