/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/common/scatter_surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
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
    int row;
} Point;

struct ScatterSurface {
    int channels;
    double noise; /* of the values */
    double share; /* of the noise in a patch's matrix */
    /* a cut: both halves between low and high along an axis */
    const ScatterSurface *half[2];
    int axis;
    double low, high;
    /* a patch: points about its centre, over its size, with one weight a channel */
    int count;
    double centre[2], scale;
    Point *point;
    double *weight; /* (points + 3 of the plane) x channels */
};

static Point point_of(Vec3 d) {
    double z = 1 + fmax(0, (double)d.z);
    return (Point){(double)d.x / z, (double)d.y / z, 0};
}

static double along(const Point *p, int axis) {
    return axis ? p->y : p->x;
}

/* ---- one patch --------------------------------------------------------------------------- */

static double kernel(double x, double y) {
    double square = x * x + y * y;
    return square * sqrt(square);
}

static void place_patch(ScatterSurface *s, const Point *from, int count, const double box[4],
                        Arena *arena) {
    s->count = count;
    s->centre[0] = 0.5 * (box[0] + box[2]), s->centre[1] = 0.5 * (box[1] + box[3]);
    s->scale = 2 / fmax(1e-6, fmax(box[2] - box[0], box[3] - box[1]));
    s->point = ARENA_NEW(arena, Point, count);
    for (int i = 0; i < count; i++)
        s->point[i] = (Point){(from[i].x - s->centre[0]) * s->scale,
                              (from[i].y - s->centre[1]) * s->scale, from[i].row};
}

/* The plane stands in the matrix as a covariance: it is positive definite by that. */
static void factor_patch(const ScatterSurface *s, double noise, double *matrix) {
    size_t n = (size_t)s->count;
    for (size_t i = 0; i < n; i++) {
        const Point *a = &s->point[i];
        for (size_t j = 0; j <= i; j++) {
            const Point *b = &s->point[j];
            matrix[i * n + j] =
                kernel(a->x - b->x, a->y - b->y) + PLANE * (1 + a->x * b->x + a->y * b->y);
        }
        matrix[i * n + i] += noise;
    }
    least_squares_factor(matrix, n);
}

static void take_channel(const ScatterSurface *s, const float *value, int channel, double *right) {
    for (int i = 0; i < s->count; i++)
        right[i] = (double)value[(size_t)s->point[i].row * (size_t)s->channels + (size_t)channel];
}

/* How much noise there is beside the surface: what makes the values of the middle channel most
 * likely. Sets the noise; returns its share. */
static double choose_noise(ScatterSurface *s, const float *value, double *matrix, double *right) {
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

static void fit_patch(ScatterSurface *s, const float *value, Arena *arena) {
    size_t n = (size_t)s->count, channels = (size_t)s->channels;
    s->weight = ARENA_NEW(arena, double, (n + 3) * channels);
    Arena scratch = *arena;
    double *matrix = ARENA_NEW(&scratch, double, n *n);
    double *right = ARENA_NEW(&scratch, double, n);
    s->share = choose_noise(s, value, matrix, right);
    factor_patch(s, s->share, matrix);
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

static void read_patch(const ScatterSurface *s, Point at, double share, double *out) {
    size_t channels = (size_t)s->channels, n = (size_t)s->count;
    double x = (at.x - s->centre[0]) * s->scale, y = (at.y - s->centre[1]) * s->scale;
    double *plane = s->weight + n * channels;
    for (size_t k = 0; k < channels; k++)
        out[k] += share * (plane[k] + x * plane[channels + k] + y * plane[2 * channels + k]);
    for (size_t i = 0; i < n; i++) {
        double term = share * kernel(x - s->point[i].x, y - s->point[i].y);
        for (size_t k = 0; k < channels; k++) out[k] += term * s->weight[i * channels + k];
    }
}

/* ---- what a patch leaves open ------------------------------------------------------------ */

#define NEAR 10          /* samples around a direction that say how rough the values are there */
#define NOISE_BESIDE 2.0 /* times its variance: so far ten misses of noise alone may reach */
#define TURNS 36         /* around a direction; */
#define EDGE 14          /* so many of them without a sample: it lies at the edge or outside */

/* A point's value as the others predict it: its miss, squared, less what noise explains, and
 * the variance of such a prediction. Both follow from the inverse's diagonal (Dubrule, Math.
 * Geol. 15, 1983). */
typedef struct LeftOut {
    double miss, open;
    double value; /* of the point itself */
} LeftOut;

static void leave_out(const ScatterSurface *s, const double *factor, double *column,
                      LeftOut *left) {
    size_t n = (size_t)s->count, channels = (size_t)s->channels;
    for (size_t i = 0; i < n; i++) {
        double diagonal = 0, weight = s->weight[i * channels + channels / 2];
        for (size_t j = i; j < n; j++) {
            double sum = j == i;
            for (size_t k = i; k < j; k++) sum -= factor[j * n + k] * column[k];
            column[j] = sum / factor[j * n + j];
            diagonal += column[j] * column[j];
        }
        double miss = weight / diagonal;
        left[i].miss = miss * miss - NOISE_BESIDE * s->noise * s->noise;
        left[i].open = 1 / diagonal;
    }
    for (size_t k = 0; k < n; k++) { /* L L^T weights */
        column[k] = 0;
        for (size_t i = k; i < n; i++)
            column[k] += factor[i * n + k] * s->weight[i * channels + channels / 2];
    }
    for (size_t i = 0; i < n; i++) {
        left[i].value = 0;
        for (size_t k = 0; k <= i; k++) left[i].value += factor[i * n + k] * column[k];
    }
}

/* Variance of the surface there, of unit roughness. */
static double open_at(const ScatterSurface *s, const double *factor, Point at, double *column) {
    size_t n = (size_t)s->count;
    double open = PLANE * (1 + at.x * at.x + at.y * at.y);
    for (size_t i = 0; i < n; i++) {
        const Point *p = &s->point[i];
        double sum = kernel(at.x - p->x, at.y - p->y) + PLANE * (1 + at.x * p->x + at.y * p->y);
        for (size_t k = 0; k < i; k++) sum -= factor[i * n + k] * column[k];
        column[i] = sum / factor[i * n + i];
        open -= column[i] * column[i];
    }
    return fmax(0, open);
}

/* What the nearest points miss over what they might, how much their values differ, and how far
 * the nearest one is. */
static ScatterDoubt doubt_of_nearest(const ScatterSurface *s, const LeftOut *left, Point at) {
    double far[NEAR] = {0}, open = 0, miss = 0, low = INFINITY, high = -INFINITY;
    LeftOut near[NEAR] = {0};
    int count = 0;
    for (int i = 0; i < s->count; i++) {
        double x = s->point[i].x - at.x, y = s->point[i].y - at.y, square = x * x + y * y;
        int k = count < NEAR ? count++ : NEAR;
        for (; k > 0 && far[k - 1] > square; k--)
            if (k < NEAR) far[k] = far[k - 1], near[k] = near[k - 1];
        if (k < NEAR) far[k] = square, near[k] = left[i];
    }
    for (int k = 0; k < count; k++) {
        miss += near[k].miss, open += near[k].open;
        low = fmin(low, near[k].value), high = fmax(high, near[k].value);
    }
    return (ScatterDoubt){
        .roughness = sqrt(fmax(0, miss / open)), .spread = high - low, .gap = sqrt(far[0])};
}

/* Do points stand all round? */
static bool is_surrounded(const ScatterSurface *s, Point at) {
    bool is_taken[TURNS] = {false};
    int empty = 0, most = 0;
    for (int i = 0; i < s->count; i++) {
        double turn = atan2_d(s->point[i].y - at.y, s->point[i].x - at.x) / (2 * PI) + 1;
        is_taken[(int)(turn * TURNS) % TURNS] = true;
    }
    for (int i = 0; i < 2 * TURNS; i++) {
        empty = is_taken[i % TURNS] ? 0 : empty + 1;
        if (empty > most) most = empty;
    }
    return most < EDGE;
}

/* Units of values and of the plane: the kernel is a third power of the patch's scale. */
static ScatterDoubt doubt_at(const ScatterSurface *s, const double *factor, const LeftOut *left,
                             Point whole, double *column) {
    double scale = s->scale * sqrt(s->scale), flat = whole.x * whole.x + whole.y * whole.y;
    Point at = {(whole.x - s->centre[0]) * s->scale, (whole.y - s->centre[1]) * s->scale, 0};
    ScatterDoubt out = doubt_of_nearest(s, left, at);
    out.roughness *= scale;
    out.open = sqrt(open_at(s, factor, at, column)) / scale;
    out.gap *= 2 / (s->scale * (1 + flat));
    out.is_between = is_surrounded(s, at);
    return out;
}

/* ---- cuts -------------------------------------------------------------------------------- */

static int order_by(const void *a, const void *b, int axis) {
    const Point *p = a, *q = b;
    double first = along(p, axis) - along(q, axis);
    double second = along(p, 1 - axis) - along(q, 1 - axis);
    double rise = first != 0 ? first : second;
    return (rise > 0) - (rise < 0);
}

static int order_x(const void *a, const void *b) {
    return order_by(a, b, 0);
}
static int order_y(const void *a, const void *b) {
    return order_by(a, b, 1);
}

static void find_box(const Point *point, int count, double box[4]) {
    box[0] = box[1] = INFINITY, box[2] = box[3] = -INFINITY;
    for (int i = 0; i < count; i++) {
        box[0] = fmin(box[0], point[i].x), box[2] = fmax(box[2], point[i].x);
        box[1] = fmin(box[1], point[i].y), box[3] = fmax(box[3], point[i].y);
    }
}

/* Sorts the points. */
static const ScatterSurface *make(Point *point, int count, const float *value, int channels,
                                  Arena *arena) {
    ScatterSurface *s = ARENA_NEW(arena, ScatterSurface, 1);
    double box[4];
    s->channels = channels;
    find_box(point, count, box);
    if (count <= PATCH_MOST) {
        place_patch(s, point, count, box, arena);
        fit_patch(s, value, arena);
        return s;
    }
    s->axis = box[3] - box[1] > box[2] - box[0];
    qsort(point, (size_t)count, sizeof *point, s->axis ? order_y : order_x);
    int middle = count / 2, first = middle - 2 * SHARED;
    int left = middle + 2 * SHARED, right = count - first;
    Point *copy = ARENA_NEW(arena, Point, left);
    s->low = along(&point[middle - SHARED], s->axis);
    s->high = along(&point[middle + SHARED], s->axis);
    memcpy(copy, point, sizeof *copy * (size_t)left);
    s->half[1] = make(point + first, right, value, channels, arena);
    s->half[0] = make(copy, left, value, channels, arena);
    s->noise =
        sqrt(0.5 * (s->half[0]->noise * s->half[0]->noise + s->half[1]->noise * s->half[1]->noise));
    return s;
}

static void read_part(const ScatterSurface *s, Point at, double share, double *out) {
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

/* The patch that says most at a place. */
static const ScatterSurface *patch_at(const ScatterSurface *s, Point at) {
    while (s->half[0]) s = s->half[along(&at, s->axis) > 0.5 * (s->low + s->high)];
    return s;
}

static void doubt_patches(const ScatterSurface *root, const ScatterSurface *s, const Vec3 *at,
                          int count, ScatterDoubt *out, Arena scratch) {
    for (int h = 0; h < 2 && s->half[0]; h++)
        doubt_patches(root, s->half[h], at, count, out, scratch);
    if (s->half[0]) return;
    size_t n = (size_t)s->count;
    double *factor = ARENA_NEW(&scratch, double, n *n);
    double *column = ARENA_NEW(&scratch, double, n);
    LeftOut *left = ARENA_NEW(&scratch, LeftOut, n);
    bool is_made = false;
    for (int i = 0; i < count; i++) {
        Point place = point_of(at[i]);
        if (patch_at(root, place) != s) continue;
        if (!is_made) {
            factor_patch(s, s->share, factor);
            leave_out(s, factor, column, left);
            is_made = true;
        }
        out[i] = doubt_at(s, factor, left, place, column);
    }
}

/* ---- the whole --------------------------------------------------------------------------- */

const ScatterSurface *scatter_surface_make(const AngleTable *table, bool mirrored,
                                           const float *value, int channels, Arena *arena) {
    Point *point = ARENA_NEW(arena, Point, 2 * table->rows);
    int count = 0;
    for (int i = 0; i < table->rows; i++) {
        Point one = point_of(table_row_direction(table, i));
        one.row = i;
        point[count++] = one;
        one.y = -one.y;
        if (mirrored && fabs(one.y) > SAME_PLACE) point[count++] = one;
    }
    return make(point, count, value, channels, arena);
}

void scatter_surface_read(const ScatterSurface *surface, Vec3 at, float *out) {
    double sum[MEASUREMENT_WAVELENGTHS_MAX] = {0};
    read_part(surface, point_of(at), 1, sum);
    for (int k = 0; k < surface->channels; k++) out[k] = (float)sum[k];
}

#define NOISE_ROWS 2000      /* at most about so many show a table's noise */
#define LEAST_LOG_SHARE 1e-6 /* of the largest value, where logarithms are taken */

double scatter_surface_table_noise(const AngleTable *table, int channel, bool in_logs,
                                   Arena scratch) {
    AngleTable some = *table;
    int stride = 1 + table->rows / NOISE_ROWS, rows = table->rows / stride;
    size_t channels = (size_t)table->channels;
    float *theta = ARENA_NEW(&scratch, float, rows);
    float *phi = ARENA_NEW(&scratch, float, rows);
    float *value = ARENA_NEW(&scratch, float, rows), most = 1e-30f;
    for (int i = 0; i < rows; i++) {
        theta[i] = table->theta[i * stride], phi[i] = table->phi[i * stride];
        value[i] = table->value[(size_t)(i * stride) * channels + (size_t)channel];
        most = fmaxf(most, value[i]);
    }
    for (int i = 0; i < rows && in_logs; i++)
        value[i] = (float)log_d(fmax((double)value[i], LEAST_LOG_SHARE * (double)most));
    some.rows = rows, some.channels = 1;
    some.theta = theta, some.phi = phi, some.value = value;
    return scatter_surface_noise(scatter_surface_make(&some, false, value, 1, &scratch));
}

double scatter_surface_noise(const ScatterSurface *surface) {
    return surface->noise;
}

void scatter_surface_doubt(const ScatterSurface *surface, const Vec3 *at, int count,
                           ScatterDoubt *out, Arena scratch) {
    doubt_patches(surface, surface, at, count, out, scratch);
}

double scatter_doubt_sigma(const ScatterDoubt *doubt) {
    return fmin(doubt->open * doubt->roughness, doubt->spread);
}
