/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/glare_table.h"

#include <math.h>

#include "base/count.h"
#include "base/units.h"

GlareTally *glare_table_add(GlareTable *table, Arena *arena)
{
    size_t size = sizeof *table->list, count = (size_t)table->count;
    table->list = arena_grow(arena, table->list, count * size, (count + 1) * size,
                             _Alignof(GlareTally));
    return &table->list[table->count++];
}

/* ---- sums -------------------------------------------------------------------------------- */

static void add(GlareSum *to, const GlareSum *sum, double times)
{
    to->sr += times * sum->sr;
    to->cd_sr_m2 += times * sum->cd_sr_m2;
    to->lx += times * sum->lx;
    to->weight_sr += times * sum->weight_sr;
}

#define NO_GROUP (-1)

/* The others stand for the group that is left out. */
static double times_of(int group, int left_out)
{
    if (left_out == NO_GROUP) return 1;
    return group == left_out ? 0 : (double)GLARE_GROUPS / (GLARE_GROUPS - 1);
}

static GlareFigures figures_without(const GlareTable *table, const GlareSettings *settings,
                                    int left_out, GlareSource *sources)
{
    GlareView view = {.sources = sources};
    for (int i = 0; i < table->count; i++) {
        GlareSum sum = {0};
        for (int g = 0; g < GLARE_GROUPS; g++)
            add(&sum, &table->list[i].group[g], times_of(g, left_out));
        if (!(sum.sr > 0)) continue;
        sources[view.count++] = glare_sum_source(&sum, table->list[i].area_m2);
        view.source_lx += sum.lx;
    }
    for (int g = 0; g < GLARE_GROUPS; g++)
        view.background_lx += times_of(g, left_out) * table->background_lx[g];
    return discomfort_figures(settings, &view);
}

/* ---- how sure ---------------------------------------------------------------------------- */

static MeanInterval interval_of(double value, const double without[GLARE_GROUPS])
{
    double mean = 0, squares = 0;
    for (int g = 0; g < GLARE_GROUPS; g++) mean += without[g] / GLARE_GROUPS;
    for (int g = 0; g < GLARE_GROUPS; g++)
        squares += (without[g] - mean) * (without[g] - mean);
    double error = sqrt(squares * (GLARE_GROUPS - 1) / GLARE_GROUPS);
    double half = student_quantile(GLARE_GROUPS - 1) * error;
    if (!isfinite(half) || !isfinite(value)) return (MeanInterval){(double)NAN, (double)NAN};
    return (MeanInterval){value - half, value + half};
}

static void describe(const GlareSource *sources, GlareReading *out)
{
    out->smallest_sr = out->largest_sr = (double)NAN;
    for (int i = 0; i < out->source_count; i++) {
        out->smallest_sr = fmin(sources[i].solid_angle_sr, out->smallest_sr);
        out->largest_sr = fmax(sources[i].solid_angle_sr, out->largest_sr);
    }
}

static int seen_count(const GlareTable *table, double *lux)
{
    int count = 0;
    *lux = 0;
    for (int i = 0; i < table->count; i++) {
        GlareSum sum = {0};
        for (int g = 0; g < GLARE_GROUPS; g++) add(&sum, &table->list[i].group[g], 1);
        count += sum.sr > 0;
        *lux += sum.lx;
    }
    return count;
}

GlareReading glare_table_read(const GlareTable *table, const GlareSettings *settings,
                              double threshold_cd_m2, Arena scratch)
{
    double       ugr[GLARE_GROUPS], dgp[GLARE_GROUPS], dgi[GLARE_GROUPS];
    GlareSource *sources = ARENA_NEW(&scratch, GlareSource, table->count);
    GlareReading out = {.threshold_cd_m2 = threshold_cd_m2};
    for (int g = 0; g < GLARE_GROUPS; g++) {
        GlareFigures without = figures_without(table, settings, g, sources);
        ugr[g] = without.ugr;
        dgp[g] = without.dgp;
        dgi[g] = without.dgi;
    }
    out.figures = figures_without(table, settings, NO_GROUP, sources);
    out.source_count = seen_count(table, &out.source_lx);
    describe(sources, &out);
    out.ugr = interval_of(out.figures.ugr, ugr);
    out.dgi = interval_of(out.figures.dgi, dgi);
    out.dgp = interval_of(out.figures.dgp, dgp);
    out.dgp = (MeanInterval){fmax(out.dgp.low, 0), fmin(out.dgp.high, 1)};
    if (isnan(out.figures.dgp)) out.dgp = (MeanInterval){(double)NAN, (double)NAN};
    return out;
}

/* ---- x ----------------------------------------------------------------------------------- */

#define PATHS_A_CELL 16 /* of the smallest cells, about */
#define PATHS_LEAST 8   /* below, an error means nothing */
#define SMALL_ERROR 0.1 /* of the threshold */
#define SURE_ERRORS 3.5 /* a mean of so many standard errors is there */

/* Sums over a cell; solid angles are the weights. */
typedef struct RestSums {
    double sr, light, squares, paths;
} RestSums;

Vec3 glare_head_direction(const GlareHead *head, double x, double y)
{
    double t = hypot(x, y), s = t > 0 ? sin(t) / t : 1;
    Vec3   d = vec3_add(vec3_scale(head->right, (float)(s * x)),
                        vec3_scale(head->up, (float)(s * y)));
    return vec3_normalize(vec3_add(d, vec3_scale(head->gaze, (float)cos(t))));
}

static int cell_of(const GlareRest *rest, Vec3 d)
{
    const GlareHead *head = &rest->head;
    double x = (double)vec3_dot(d, head->right), y = (double)vec3_dot(d, head->up);
    double t = degrees_from_radians(atan2(hypot(x, y), (double)vec3_dot(d, head->gaze)));
    double ring = log(fmax(t, GLARE_REST_FROM_DEG) / GLARE_REST_FROM_DEG) /
                  log(GLARE_REST_TO_DEG / GLARE_REST_FROM_DEG);
    double about = atan2(y, x) / (2 * PI) + 0.5;
    int    last = rest->side - 1;
    int    row = (int)fmin(ring * rest->side, last), column = (int)(about * rest->side);
    return row * rest->side + (column < last ? column : last);
}

double glare_rest_at(const GlareRest *rest, Vec3 d)
{
    return (double)rest->mean[cell_of(rest, d)];
}

static int side_for(int paths)
{
    int side = 1;
    while (4 * side * side * PATHS_A_CELL <= paths) side *= 2;
    return side;
}

static double mean_of(const RestSums *sums)
{
    return sums->sr > 0 ? sums->light / sums->sr : 0;
}

static bool counts(const RestSums *sums, double threshold)
{
    double mean = mean_of(sums);
    if (sums->paths < PATHS_LEAST) return false;
    double variance = fmax(sums->squares / sums->sr - mean * mean, 0) / (sums->paths - 1);
    double error = sqrt(variance);
    return error <= SMALL_ERROR * threshold || mean > SURE_ERRORS * error;
}

/* At work: which cells have no mean yet, and the sums of these over ever larger squares. */
typedef struct RestWork {
    GlareRest *rest;
    bool      *is_open; /* [ring][cell] */
    double     threshold;
} RestWork;

/* Sets the open cells of a square of `size` cells, whose sums those are. */
static void settle(const RestWork *work, int square, int size, const RestSums *sums)
{
    GlareRest *rest = work->rest;
    int        squares = rest->side / size;
    int        row = square / squares * size, column = square % squares * size;
    for (int i = 0; i < size * size; i++) {
        int cell = (row + i / size) * rest->side + column + i % size;
        if (work->is_open[cell]) rest->mean[cell] = (float)mean_of(sums);
        work->is_open[cell] = false;
    }
}

/* Settles what squares of `size` cells show surely; the sums of all others stay. */
static void settle_all(const RestWork *work, int size, RestSums *sums)
{
    int squares = work->rest->side / size;
    for (int i = 0; i < squares * squares; i++) {
        if (squares > 1 && !counts(&sums[i], work->threshold)) continue;
        settle(work, i, size, &sums[i]);
        sums[i] = (RestSums){0};
    }
}

static void add_rest(RestSums *to, const RestSums *sums)
{
    to->sr += sums->sr;
    to->light += sums->light;
    to->squares += sums->squares;
    to->paths += sums->paths;
}

/* Four squares to one. */
static RestSums *join(const RestSums *sums, int squares, Arena *scratch)
{
    int       half = squares / 2;
    RestSums *out = ARENA_NEW(scratch, RestSums, half * half);
    for (int i = 0; i < squares * squares; i++)
        add_rest(&out[i / squares / 2 * half + i % squares / 2], &sums[i]);
    return out;
}

GlareRest glare_rest_build(const GlareHead *head, const GlarePaths *paths,
                           double threshold_cd_m2, Arena *arena)
{
    GlareRest rest = {.head = *head, .side = side_for(paths->count)};
    int       cells = rest.side * rest.side;
    rest.mean = ARENA_NEW(arena, float, cells);
    Arena     scratch = *arena;
    RestSums *sums = ARENA_NEW(&scratch, RestSums, cells);
    RestWork  work = {&rest, ARENA_NEW(&scratch, bool, cells), threshold_cd_m2};
    for (int i = 0; i < cells; i++) work.is_open[i] = true;
    for (int i = 0; i < paths->count; i++) {
        double   light = paths->cd_m2[i], sr = paths->sr[i];
        RestSums one = {sr, light * sr, light * light * sr, 1};
        add_rest(&sums[cell_of(&rest, paths->towards[i])], &one);
    }
    for (int size = 1; size <= rest.side; size *= 2) {
        settle_all(&work, size, sums);
        if (size < rest.side) sums = join(sums, rest.side / size, &scratch);
    }
    return rest;
}
