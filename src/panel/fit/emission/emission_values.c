/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/emission/emission_values.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "hemisphere/vertex/vertex.h"
#include "hemisphere/vertex/vertex_fit.h"
#include "panel/fit/common/scatter_surface.h"

/* The ridge: noise^2 / (rows * the rest's expected curvature^2) is where a detail's own
 * evidence and the expectation that it is small weigh the same. */
static double ridge_of(const EmissionModel *model, const float *rest, int component)
{
    const EmissionSamples *s = model->samples;
    int    n = model->rank->components;
    double sum = 0, area = 0, noise = (double)model->score_noise[component];
    for (int i = 0; i < s->rows; i++) {
        double r = (double)rest[i * n + component];
        sum += s->area[i] * r * r;
        area += s->area[i];
    }
    double variance = fmax(sum / area - noise * noise, 0.01 * noise * noise + 1e-12);
    return noise * noise / (s->rows * 6 * variance);
}

/* rms of what vertex values leave of the samples, weighted as they are. */
static double rest_of_fit(const EmissionValues *on, const VertexSamples *samples,
                          const float *values)
{
    double sum = 0, total = 0;
    for (int i = 0; i < samples->count; i++) {
        VertexPoint at = vertex_find(on->geodesic, on->lattice, samples->direction[i]);
        double rest = (double)samples->value[i], w = (double)samples->weight[i];
        for (int q = 0; q < 3; q++)
            rest -= (double)at.weight[q] * (double)values[at.vertex[q]];
        sum += w * rest * rest;
        total += w;
    }
    return sqrt(sum / total);
}

#define RIDGE_STEP 32.0
#define LEAST_RIDGE 1e-12
#define WEAK_RIDGE 1e-9 /* weaker than this they hardly smooth; then */
#define WORTH 0.7       /* the next must leave so much less */

/* Where a component's fit begins and what it may leave. */
typedef struct FitGoal {
    double ridge, enough;
} FitGoal;

/* The noise, or nothing that matters. */
static FitGoal goal_of(const EmissionValues *on, const float *rest, int component)
{
    return (FitGoal){ridge_of(on->model, rest, component),
                     fmax(1.2 * (double)on->model->score_noise[component],
                          0.1 * (double)on->model->step[component])};
}

/* The strongest ridge that leaves no more than the goal, or hardly more than a weaker one. */
static bool fit_values(const EmissionValues *on, const VertexSamples *samples, FitGoal goal,
                       Arena scratch, float *values, Error *err)
{
    double before = INFINITY, ridge = goal.ridge;
    float *trial = ARENA_NEW(&scratch, float, on->vertices);
    for (;; ridge /= RIDGE_STEP) {
        Arena work = scratch;
        ridge = fmax(ridge, LEAST_RIDGE);
        if (!vertex_fit(on->lattice, samples, ridge, &work, trial, err))
            return false;
        double rest = rest_of_fit(on, samples, trial);
        if (ridge < WEAK_RIDGE && rest > WORTH * before) return true;
        memcpy(values, trial, on->vertices * sizeof *values);
        if (ridge == LEAST_RIDGE || rest <= goal.enough) return true;
        before = rest;
    }
}

/* What the surface through scattered rows says; beyond the cone what it says at its edge. */
static void read_surface(const EmissionValues *on, const float *one, Arena scratch,
                         float *values)
{
    const EmissionSamples *s = on->model->samples;
    const ScatterSurface  *surface = scatter_surface_make(s->master, false, one, 1, &scratch);
    Vec3  *at = ARENA_NEW(&scratch, Vec3, on->vertices);
    double low = cos_d(s->cone), across = sin_d(s->cone);
    vertex_directions(on->lattice, at);
    for (uint32_t v = 0; v < on->vertices; v++) {
        double r = sqrt((double)(at[v].x * at[v].x + at[v].y * at[v].y));
        if ((double)at[v].z < low)
            at[v] = vec3((float)(at[v].x * across / r), (float)(at[v].y * across / r),
                         (float)low);
        scatter_surface_read(surface, at[v], &values[v]);
    }
}

bool emission_values_fit(const EmissionValues *on, const float *rest, int component,
                         Arena scratch, Error *err)
{
    const EmissionSamples *s = on->model->samples;
    int    n = on->model->rank->components;
    float *one = ARENA_NEW(&scratch, float, s->rows);
    float *weight = ARENA_NEW(&scratch, float, s->rows);
    float *values = ARENA_NEW(&scratch, float, on->vertices), low = INFINITY, high = -low;
    for (int i = 0; i < s->rows; i++) {
        one[i] = rest[i * n + component];
        weight[i] = on->model->rank->belief[i] * (float)s->area[i];
        low = fminf(low, one[i]), high = fmaxf(high, one[i]);
    }
    if (on->model->is_scattered) read_surface(on, one, scratch, values);
    VertexSamples samples = {s->rows, 1, s->direction, one, weight};
    if (!on->model->is_scattered &&
        !fit_values(on, &samples, goal_of(on, rest, component), scratch, values, err))
        return false;
    for (uint32_t v = 0; v < on->vertices; v++) /* what nothing measures cannot run away */
        on->value[v * (uint32_t)n + (uint32_t)component] = clampf(values[v], low, high);
    return true;
}
