/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/emission/emission_between.h"

#include <math.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "panel/shape/least_squares.h"

#define NEIGHBOURS_MAX 64 /* rows of four cells */

/* ---- what the samples have --------------------------------------------------------------- */

static void find_bright(EmissionBetween *o) {
    const EmissionSamples *s = o->model->samples;
    float most = -1;
    for (int c = 1; c < s->channels; c += 3)
        for (int i = 0; i < s->rows; i++) {
            float y = s->total[(size_t)i * (size_t)s->channels + (size_t)c];
            if (y > most) most = y, o->bright = c;
        }
}

/* ln of a channel over the bright one, of components; what the cosine does cancels. */
static float ratio_of(const EmissionBetween *o, const float *components, int channel) {
    const EmissionRank *rank = o->model->rank;
    const float *a = rank->loading + channel * rank->components;
    const float *b = rank->loading + o->bright * rank->components;
    float sum = rank->mean[channel] - rank->mean[o->bright];
    for (int k = 0; k < rank->components; k++) sum += (a[k] - b[k]) * components[k];
    return sum;
}

/* What a row says of the ratios. Not measured (sigma is INFINITY): anything. */
static void find_row(EmissionBetween *o, int row) {
    const EmissionSamples *s = o->model->samples;
    const EmissionRank *rank = o->model->rank;
    const float *sigma = s->sigma + (size_t)row * (size_t)s->channels;
    float *ratio = o->ratio + (size_t)row * (size_t)s->channels;
    float *slack = o->slack + (size_t)row * (size_t)s->channels;
    float logs[3 * EMISSION_TABLES_MAX];
    emission_rank_logs(rank, s->channels, rank->score + row * rank->components,
                       emission_rank_fall(rank->cosine_power, s->direction[row]), logs);
    float bright = sigma[o->bright] / exp_f(logs[o->bright]);
    o->light[row] = logs[o->bright];
    for (int c = 0; c < s->channels; c++) {
        ratio[c] = logs[c] - logs[o->bright];
        slack[c] = BETWEEN_SIGMAS * (bright + sigma[c] / exp_f(logs[c]));
    }
}

/* The least-squares answer to "all channels by 1", scaled to be so for the bright one. */
static void find_raise(EmissionBetween *o, Arena scratch) {
    const EmissionRank *rank = o->model->rank;
    int n = rank->components;
    double *normal = ARENA_NEW(&scratch, double, n *n);
    double *right = ARENA_NEW(&scratch, double, n);
    double bright = 0;
    for (int c = 0; c < o->model->samples->channels; c++)
        for (int i = 0; i < n; i++) {
            double l = (double)rank->loading[c * n + i];
            right[i] += l;
            for (int k = 0; k <= i; k++) normal[i * n + k] += l * (double)rank->loading[c * n + k];
        }
    for (int i = 0; i < n; i++) normal[i * (n + 1)] += 1e-9;
    least_squares_factor(normal, (size_t)n);
    least_squares_solve(normal, right, (size_t)n);
    for (int k = 0; k < n; k++) bright += (double)rank->loading[o->bright * n + k] * right[k];
    for (int k = 0; k < n; k++) o->raise[k] = bright > 0.5 ? (float)(right[k] / bright) : 0;
}

void emission_between_make(const EmissionModel *model, Arena *arena, EmissionBetween *out) {
    const EmissionSamples *s = model->samples;
    size_t numbers = (size_t)s->rows * (size_t)s->channels;
    *out = (EmissionBetween){.model = model,
                             .light = ARENA_NEW(arena, float, s->rows),
                             .ratio = ARENA_NEW(arena, float, numbers),
                             .slack = ARENA_NEW(arena, float, numbers),
                             .raise = ARENA_NEW(arena, float, model->rank->components)};
    direction_grid_build(s->master, false, arena, &out->grid);
    find_bright(out);
    find_raise(out, *arena);
    for (int i = 0; i < s->rows; i++) find_row(out, i);
}

/* ---- around a direction ------------------------------------------------------------------ */

/* Rows and their weights, which sum to 1, none below 0. */
typedef struct NearRows {
    int count, row[NEIGHBOURS_MAX];
    float weight[NEIGHBOURS_MAX];
} NearRows;

static void add_cell(const DirectionGrid *g, int ring, int azimuth, float weight, NearRows *out) {
    int cell = ring * g->phis + azimuth;
    float sum = 0;
    for (int i = g->start[cell]; i < g->start[cell + 1]; i++) sum += fmaxf(0, g->weight[i]);
    for (int i = g->start[cell]; i < g->start[cell + 1] && out->count < NEIGHBOURS_MAX; i++) {
        out->row[out->count] = g->row[i];
        out->weight[out->count++] = weight * fmaxf(0, g->weight[i]) / sum;
    }
}

/* Last index whose value is not above `at`; -1: all are. */
static int last_below(const float *rising, int count, float at) {
    int i = -1;
    while (i + 1 < count && rising[i + 1] <= at) i++;
    return i;
}

/* The ends of the intervals of rings and of azimuths. */
static NearRows rows_around(const DirectionGrid *g, Vec3 d) {
    NearRows out = {0};
    float theta = acos_f(fminf(1, d.z)), phi = atan2_f(d.y, d.x);
    phi -= 2 * PI_F * floorf(phi / (2 * PI_F));
    int low = last_below(g->phi, g->phis, phi), high = (low + 1) % g->phis;
    float turn = low < 0 ? 2 * PI_F : 0;
    if (low < 0) low = g->phis - 1;
    float gap = g->phi[high] - g->phi[low], far = phi + turn - g->phi[low];
    if (gap <= 0) gap += 2 * PI_F;
    int inner = last_below(g->theta, g->thetas, theta), outer = inner + 1;
    float t = fminf(1, far / gap), u = 1;
    if (outer < g->thetas && inner >= 0)
        u = (theta - g->theta[inner]) / (g->theta[outer] - g->theta[inner]);
    if (outer >= g->thetas) outer = g->thetas - 1, inner = -1;
    add_cell(g, outer, low, u * (1 - t), &out);
    add_cell(g, outer, high, u * t, &out);
    if (inner >= 0) {
        add_cell(g, inner, low, (1 - u) * (1 - t), &out);
        add_cell(g, inner, high, (1 - u) * t, &out);
    }
    return out;
}

/* How far from `base`, which is in the range of the rows, a ratio may go to `value`: 0 to 1. */
static float share_within(const EmissionBetween *o, const NearRows *rows, int channel, float base,
                          float value) {
    int channels = o->model->samples->channels;
    float low = INFINITY, high = -INFINITY;
    for (int i = 0; i < rows->count; i++) {
        size_t at = (size_t)rows->row[i] * (size_t)channels + (size_t)channel;
        low = fminf(low, o->ratio[at] - o->slack[at]);
        high = fmaxf(high, o->ratio[at] + o->slack[at]);
    }
    float width = fmaxf(BETWEEN_LEAST, BETWEEN_SHARE * (high - low));
    low -= width, high += width;
    return value > high  ? (high - base) / (value - base)
           : value < low ? (base - low) / (base - value)
                         : 1;
}

/* The ratios stay in their ranges; from `base`, the samples' linear interpolation. */
static float colour_share(const EmissionBetween *o, const NearRows *rows, const float *base,
                          const float *components) {
    float share = 1;
    for (int c = 0; c < o->model->samples->channels; c++)
        share = fminf(share,
                      share_within(o, rows, c, ratio_of(o, base, c), ratio_of(o, components, c)));
    return share;
}

void emission_between_hold(const EmissionBetween *o, Vec3 direction, float *components) {
    if ((double)direction.z < cos_d(o->model->samples->cone)) return;
    const EmissionRank *rank = o->model->rank;
    const float *bright = rank->loading + o->bright * rank->components;
    NearRows rows = rows_around(&o->grid, direction);
    float base[PANEL_COMPONENTS_MAX] = {0}, light = 0, raised = 0;
    for (int i = 0; i < rows.count; i++) {
        light += rows.weight[i] * exp_f(o->light[rows.row[i]]);
        for (int k = 0; k < rank->components; k++)
            base[k] += rows.weight[i] * rank->score[rows.row[i] * rank->components + k];
    }
    float share = o->model->has_edges ? 0 : colour_share(o, &rows, base, components);
    if (!(share < 1)) return;
    for (int k = 0; k < rank->components; k++) {
        float moved = (1 - share) * (base[k] - components[k]);
        raised -= bright[k] * moved;
        components[k] += moved;
    }
    if (o->model->has_edges) {
        raised = log_f(light) - rank->mean[o->bright] -
                 emission_rank_fall(rank->cosine_power, direction);
        for (int k = 0; k < rank->components; k++) raised -= bright[k] * components[k];
    }
    for (int k = 0; k < rank->components; k++) components[k] += raised * o->raise[k];
}
