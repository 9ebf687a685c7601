/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/glare_rest.h"

#include <math.h>

#include "base/units.h"

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

static void add(RestSums *to, const RestSums *sums)
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
        add(&out[i / squares / 2 * half + i % squares / 2], &sums[i]);
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
        add(&sums[cell_of(&rest, paths->towards[i])], &one);
    }
    for (int size = 1; size <= rest.side; size *= 2) {
        settle_all(&work, size, sums);
        if (size < rest.side) sums = join(sums, rest.side / size, &scratch);
    }
    return rest;
}
