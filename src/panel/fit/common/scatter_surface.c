/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/common/scatter_surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathd.h"
#include "panel/shape/least_squares.h"
#include "panel/fit/common/table_rows.h"
#include "panel/set/measurement.h"

#define PATCH_MOST 220 /* points of one sum */
#define SHARED 28      /* points on either side of a cut where both halves count */
#define PLANE 1e3      /* weight of the plane beside the sum: as good as free */
#define NO_NOISE 1e-10 /* of the noise beside the sum, for coincident points */
#define SAME_PLACE 1e-5

typedef struct Point {
    double x, y;
    int    row;
} Point;

struct ScatterSurface {
    int    channels;
    double noise; /* of the values */
    /* a cut: both halves between low and high along an axis */
    const ScatterSurface *half[2];
    int    axis;
    double low, high;
    /* a patch: points about its centre, over its size, with one weight a channel */
    int     count;
    double  centre[2], scale;
    Point  *point;
    double *weight; /* (points + 3 of the plane) x channels */
};

static Point point_of(Vec3 d)
{
    double z = 1 + fmax(0, (double)d.z);
    return (Point){(double)d.x / z, (double)d.y / z, 0};
}

static double along(const Point *p, int axis)
{
    return axis ? p->y : p->x;
}

/* ---- one patch --------------------------------------------------------------------------- */

static double kernel(double x, double y)
{
    double square = x * x + y * y;
    return square * sqrt(square);
}

static void place_patch(ScatterSurface *s, const Point *from, int count, const double box[4],
                        Arena *arena)
{
    s->count = count;
    s->centre[0] = 0.5 * (box[0] + box[2]), s->centre[1] = 0.5 * (box[1] + box[3]);
    s->scale = 2 / fmax(1e-6, fmax(box[2] - box[0], box[3] - box[1]));
    s->point = ARENA_NEW(arena, Point, count);
    for (int i = 0; i < count; i++)
        s->point[i] = (Point){(from[i].x - s->centre[0]) * s->scale,
                              (from[i].y - s->centre[1]) * s->scale, from[i].row};
}

/* The plane stands in the matrix as a covariance: it is positive definite by that. */
static void factor_patch(const ScatterSurface *s, double noise, double *matrix)
{
    size_t n = (size_t)s->count;
    for (size_t i = 0; i < n; i++) {
        const Point *a = &s->point[i];
        for (size_t j = 0; j <= i; j++) {
            const Point *b = &s->point[j];
            matrix[i * n + j] = kernel(a->x - b->x, a->y - b->y) +
                                PLANE * (1 + a->x * b->x + a->y * b->y);
        }
        matrix[i * n + i] += noise;
    }
    least_squares_factor(matrix, n);
}

static void take_channel(const ScatterSurface *s, const float *value, int channel,
                         double *right)
{
    for (int i = 0; i < s->count; i++)
        right[i] = (double)value[(size_t)s->point[i].row * (size_t)s->channels +
                                 (size_t)channel];
}

/* How much noise there is beside the surface: what makes the values of the middle channel most
 * likely. Sets the noise; returns its share. */
static double choose_noise(ScatterSurface *s, const float *value, double *matrix, double *right)
{
    static const double shares[] = {NO_NOISE, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1};
    double best = INFINITY, share = NO_NOISE;
    size_t n = (size_t)s->count;
    for (size_t k = 0; k < sizeof shares / sizeof *shares; k++) {
        double determinant = 0, squares;
        factor_patch(s, shares[k], matrix);
        for (size_t i = 0; i < n; i++) determinant += 2 * log_d(matrix[i * n + i]);
        take_channel(s, value, s->channels / 2, right);
        squares = least_squares_solve(matrix, right, n) / (double)n;
        double unlikely = (double)n * log_d(fmax(squares, 1e-30)) + determinant;
        if (unlikely > best) break;
        best = unlikely;
        share = shares[k];
        s->noise = k ? sqrt(share * squares) : 0;
    }
    return share;
}

static void fit_patch(ScatterSurface *s, const float *value, Arena *arena)
{
    size_t  n = (size_t)s->count, channels = (size_t)s->channels;
    s->weight = ARENA_NEW(arena, double, (n + 3) * channels);
    Arena   scratch = *arena;
    double *matrix = ARENA_NEW(&scratch, double, n * n);
    double *right = ARENA_NEW(&scratch, double, n);
    double  share = choose_noise(s, value, matrix, right);
    factor_patch(s, share, matrix);
    for (size_t k = 0; k < channels; k++) {
        double *plane = s->weight + n * channels + k;
        take_channel(s, value, (int)k, right);
        least_squares_solve(matrix, right, n);
        for (size_t i = 0; i < n; i++) {
            s->weight[i * channels + k] = right[i];
            plane[0] += PLANE * right[i];
            plane[channels] += PLANE * right[i] * s->point[i].x;
            plane[2 * channels] += PLANE * right[i] * s->point[i].y;
        }
    }
}

static void read_patch(const ScatterSurface *s, Point at, double share, double *out)
{
    size_t  channels = (size_t)s->channels, n = (size_t)s->count;
    double  x = (at.x - s->centre[0]) * s->scale, y = (at.y - s->centre[1]) * s->scale;
    double *plane = s->weight + n * channels;
    for (size_t k = 0; k < channels; k++)
        out[k] += share * (plane[k] + x * plane[channels + k] + y * plane[2 * channels + k]);
    for (size_t i = 0; i < n; i++) {
        double term = share * kernel(x - s->point[i].x, y - s->point[i].y);
        for (size_t k = 0; k < channels; k++) out[k] += term * s->weight[i * channels + k];
    }
}

/* ---- cuts -------------------------------------------------------------------------------- */

static int order_by(const void *a, const void *b, int axis)
{
    const Point *p = a, *q = b;
    double       first = along(p, axis) - along(q, axis);
    double       second = along(p, 1 - axis) - along(q, 1 - axis);
    double       rise = first != 0 ? first : second;
    return (rise > 0) - (rise < 0);
}

static int order_x(const void *a, const void *b) { return order_by(a, b, 0); }
static int order_y(const void *a, const void *b) { return order_by(a, b, 1); }

static void find_box(const Point *point, int count, double box[4])
{
    box[0] = box[1] = INFINITY, box[2] = box[3] = -INFINITY;
    for (int i = 0; i < count; i++) {
        box[0] = fmin(box[0], point[i].x), box[2] = fmax(box[2], point[i].x);
        box[1] = fmin(box[1], point[i].y), box[3] = fmax(box[3], point[i].y);
    }
}

/* Sorts the points. */
static const ScatterSurface *make(Point *point, int count, const float *value, int channels,
                                  Arena *arena)
{
    ScatterSurface *s = ARENA_NEW(arena, ScatterSurface, 1);
    double          box[4];
    s->channels = channels;
    find_box(point, count, box);
    if (count <= PATCH_MOST) {
        place_patch(s, point, count, box, arena);
        fit_patch(s, value, arena);
        return s;
    }
    s->axis = box[3] - box[1] > box[2] - box[0];
    qsort(point, (size_t)count, sizeof *point, s->axis ? order_y : order_x);
    int    middle = count / 2, first = middle - 2 * SHARED;
    int    left = middle + 2 * SHARED, right = count - first;
    Point *copy = ARENA_NEW(arena, Point, left);
    s->low = along(&point[middle - SHARED], s->axis);
    s->high = along(&point[middle + SHARED], s->axis);
    memcpy(copy, point, sizeof *copy * (size_t)left);
    s->half[1] = make(point + first, right, value, channels, arena);
    s->half[0] = make(copy, left, value, channels, arena);
    s->noise = sqrt(0.5 * (s->half[0]->noise * s->half[0]->noise +
                           s->half[1]->noise * s->half[1]->noise));
    return s;
}

static void read_part(const ScatterSurface *s, Point at, double share, double *out)
{
    if (!s->half[0]) {
        read_patch(s, at, share, out);
        return;
    }
    double width = s->high - s->low, place = along(&at, s->axis) - s->low;
    double t = width > 0 ? fmin(1, fmax(0, place / width)) : place > 0;
    double right = t * t * (3 - 2 * t);
    if (right < 1) read_part(s->half[0], at, share * (1 - right), out);
    if (right > 0) read_part(s->half[1], at, share * right, out);
}

/* ---- the whole --------------------------------------------------------------------------- */

const ScatterSurface *scatter_surface_make(const AngleTable *table, bool mirrored,
                                           const float *value, int channels, Arena *arena)
{
    Point *point = ARENA_NEW(arena, Point, 2 * table->rows);
    int    count = 0;
    for (int i = 0; i < table->rows; i++) {
        Point one = point_of(table_row_direction(table, i));
        one.row = i;
        point[count++] = one;
        one.y = -one.y;
        if (mirrored && fabs(one.y) > SAME_PLACE) point[count++] = one;
    }
    return make(point, count, value, channels, arena);
}

void scatter_surface_read(const ScatterSurface *surface, Vec3 at, float *out)
{
    double sum[MEASUREMENT_WAVELENGTHS_MAX] = {0};
    read_part(surface, point_of(at), 1, sum);
    for (int k = 0; k < surface->channels; k++) out[k] = (float)sum[k];
}

double scatter_surface_noise(const ScatterSurface *surface)
{
    return surface->noise;
}
