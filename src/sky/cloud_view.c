/* SPDX-License-Identifier: Apache-2.0 */
/* Not hot: every instruction set has the same table. */
#include "sky/cloud_view.h"

#include <math.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/parallel.h"
#include "base/units.h"
#include "sky/air/air.h"
#include "sky/cloud_field.h"

#define ROWS CLOUD_RELIEF_ROWS
#define COLUMNS CLOUD_RELIEF_COLUMNS
#define FIRST (4 * PI / 180) /* rows are even in angle for so much, then widen */
#define FADE 4.0f            /* rows at the horizon over which the relief grows from none */
#define STRIDE 1.6           /* of a step, in widths of what it averages */
#define STEPS_MAX 6000
#define ORDERS 4
#define TERMS (2 * ORDERS + 1) /* of the mean's Fourier series in the azimuth */
#define SMOOTH 40              /* rows to each side over which means are taken */

/* A step outwards from the observer's foot, the same in every azimuth. */
typedef struct Stride {
    float distance, level, sine, versed; /* of the angle at the Earth's centre */
} Stride;

typedef struct ViewBuild {
    const CloudViewInput *input;
    CloudRelief *out;
    CloudField field;
    Stride *stride;
    int count;
    float *seen;            /* [column][row] */
    float (*term)[COLUMNS]; /* of the series, at every column */
    double (*mean)[TERMS];  /* of each row */
    double *sum;            /* of each row, once divided, times its cells' solid angle */
    double whole;
} ViewBuild;

/* About one texel of the field, or one column of the table, whichever is wider. */
static void place_strides(ViewBuild *b) {
    double edge = -b->input->horizon * AIR_EARTH_M, at = 0;
    b->count = 0;
    while (at < edge && b->count < STEPS_MAX) {
        double across = fmax(CLOUD_FIELD_TEXEL_M, at * 2 * PI / COLUMNS);
        at += STRIDE * across;
        double angle = at / AIR_EARTH_M, half = sin_d(angle / 2);
        b->stride[b->count++] =
            (Stride){(float)at, (float)log2_d(across / (double)CLOUD_FIELD_TEXEL_M),
                     (float)sin_d(angle), (float)(2 * half * half)};
    }
}

/* Adds what fills the rows from `low` up to `high` (towards the horizon: row numbers fall). */
static void cover(float *seen, float low, float high, float shade) {
    for (int i = (int)high; i < ROWS && (float)i < low; i++) {
        float share = fminf(low, (float)(i + 1)) - fmaxf(high, (float)i);
        seen[i] += share * shade;
    }
}

/* One azimuth, from below the observer to the horizon. */
static void fill_column(void *context, int column, int worker) {
    ViewBuild *b = context;
    double azimuth = b->input->azimuth + 2 * PI * column / COLUMNS;
    float east = (float)sin_d(azimuth), north = (float)cos_d(azimuth), row = ROWS;
    float height = (float)b->input->height_m, earth = (float)AIR_EARTH_M;
    float *seen = b->seen + (size_t)column * ROWS;
    CloudSample before = cloud_field_at(&b->field, 0, 0, 0);
    (void)worker;
    for (int i = 0; i < b->count; i++) {
        const Stride *s = &b->stride[i];
        CloudSample at =
            cloud_field_at(&b->field, s->distance * east, s->distance * north, s->level);
        float up = at.height - height - (earth + at.height) * s->versed;
        float elevation = atan2_f(up, (earth + at.height) * s->sine);
        float now = elevation < b->out->horizon ? cloud_relief_row(b->out, elevation) : 0;
        if (now < row) {
            cover(seen, row, now, 0.5f * (before.shade + at.shade));
            row = now;
        }
        before = at;
    }
    cover(seen, row, 0, before.shade);
}

/* ---- means ------------------------------------------------------------------------------- */

static void fill_terms(ViewBuild *b) {
    for (int k = 0; k < TERMS; k++)
        for (int j = 0; j < COLUMNS; j++) {
            double angle = 2 * PI * ((k + 1) / 2) * j / COLUMNS;
            b->term[k][j] = (float)(k % 2 ? sin_d(angle) : cos_d(angle));
        }
}

static void row_means(void *context, int row, int worker) {
    ViewBuild *b = context;
    (void)worker;
    for (int k = 0; k < TERMS; k++) {
        double sum = 0;
        for (int j = 0; j < COLUMNS; j++)
            sum += (double)(b->seen[(size_t)j * ROWS + (size_t)row] * b->term[k][j]);
        b->mean[row][k] = sum * (k ? 2 : 1) / COLUMNS;
    }
}

static double row_elevation(const CloudRelief *out, double row) {
    double root = row / (double)out->rows + sqrt((double)out->first);
    return (double)out->horizon - (root * root - (double)out->first);
}

/* Solid angle of a cell of a row. */
static double row_area(const CloudRelief *out, int row) {
    return (sin_d(row_elevation(out, row)) - sin_d(row_elevation(out, row + 1))) * 2 * PI / COLUMNS;
}

/* Of the rows around one, by their solid angles: a ring at the foot has few cells, whose own
 * mean would be no mean. */
static void smooth_mean(const ViewBuild *b, int row, double out[TERMS]) {
    double weight = 0;
    for (int k = 0; k < TERMS; k++) out[k] = 0;
    for (int i = row - SMOOTH; i <= row + SMOOTH; i++) {
        if (i < 0 || i >= ROWS) continue;
        double w = (SMOOTH + 1 - fabs((double)(i - row))) * row_area(b->out, i);
        for (int k = 0; k < TERMS; k++) out[k] += w * b->mean[i][k];
        weight += w;
    }
    for (int k = 0; k < TERMS; k++) out[k] /= weight;
}

/* At the foot all azimuths are one place: there the series is drawn in to its first term. */
static void divide_row(void *context, int row, int worker) {
    ViewBuild *b = context;
    double mean[TERMS], sum = 0, level = cos_d(row_elevation(b->out, row + 0.5));
    double drawn = fmin(1, 4 * level * level);
    float strength = clampf((float)row / FADE, 0, 1);
    (void)worker;
    smooth_mean(b, row, mean);
    for (int j = 0; j < COLUMNS; j++) {
        float *seen = &b->seen[(size_t)j * ROWS + (size_t)row];
        double by = mean[0];
        for (int k = 1; k < TERMS; k++) by += drawn * mean[k] * (double)b->term[k][j];
        *seen = 1 + (*seen / (float)fmax(by, 0.3 * mean[0]) - 1) * strength;
        sum += (double)*seen;
    }
    b->sum[row] = sum * row_area(b->out, row);
}

static void store_row(void *context, int row, int worker) {
    ViewBuild *b = context;
    (void)worker;
    for (int j = 0; j < COLUMNS; j++) {
        float value = b->seen[(size_t)j * ROWS + (size_t)row] / (float)b->whole;
        b->out->factor[(size_t)row * COLUMNS + (size_t)j] =
            (uint16_t)(clampf(value * CLOUD_RELIEF_ONE, 0, 65534) + 0.5f);
    }
}

/* ---- the whole --------------------------------------------------------------------------- */

/* The sky's light comes from everywhere by day, so that it has less relief; in twilight it is
 * all there is, and comes from the side of the sun. */
static float diffuse_share(double elevation) {
    double t = fmax(0, fmin(1, (elevation * 180 / PI + 3) / 6));
    return (float)(1 - 0.25 * t * t * (3 - 2 * t));
}

static void take_scratch(ViewBuild *b, Arena *scratch) {
    b->stride = ARENA_NEW(scratch, Stride, STEPS_MAX);
    b->seen = ARENA_NEW(scratch, float, ROWS *COLUMNS);
    b->term = arena_alloc(scratch, sizeof *b->term, 64, TERMS);
    b->mean = arena_alloc(scratch, sizeof *b->mean, 64, ROWS);
    b->sum = ARENA_NEW(scratch, double, ROWS);
}

/* Exactly: the sums of all rows over the solid angle below the horizon. */
static void find_whole(ViewBuild *b) {
    double sum = 0, area = 0;
    for (int i = 0; i < ROWS; i++) {
        sum += b->sum[i];
        area += row_area(b->out, i) * COLUMNS;
    }
    b->whole = sum / area;
}

static void build(const CloudViewInput *in, CloudRelief *out, Arena scratch) {
    ViewBuild b = {.input = in, .out = out};
    CloudFieldInput field = {fmin(in->relief_m, 0.5 * in->height_m), in->azimuth, in->elevation,
                             in->threads};
    take_scratch(&b, &scratch);
    cloud_field_build(&field, &scratch, &b.field);
    place_strides(&b);
    fill_terms(&b);
    parallel_for(in->threads, COLUMNS, fill_column, &b);
    parallel_for(in->threads, ROWS, row_means, &b);
    parallel_for(in->threads, ROWS, divide_row, &b);
    find_whole(&b);
    parallel_for(in->threads, ROWS, store_row, &b);
}

void cloud_view_build(const CloudViewInput *input, Arena *arena, CloudRelief *out) {
    double reach = PI / 2 + input->horizon; /* from the horizon to the foot */
    *out = (CloudRelief){.horizon = (float)input->horizon,
                         .first = (float)FIRST,
                         .rows = (float)(ROWS / (sqrt(FIRST + reach) - sqrt(FIRST))),
                         .diffuse = diffuse_share(input->elevation)};
    out->factor = ARENA_NEW(arena, uint16_t, ROWS *COLUMNS);
    build(input, out, *arena);
}
