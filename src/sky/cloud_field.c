/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/cloud_field.h"

#include <math.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/parallel.h"
#include "base/units.h"

#define SIZE CLOUD_FIELD_SIZE
#define HALF (SIZE / 2)
#define STREETS (25 * PI / 180)     /* the field's own x axis, from east to north */
#define LOWEST_LIGHT (7 * PI / 180) /* below, light comes from a glow as high as this */
#define WRAP 0.12f                  /* how far light reaches round a cloud's edge: cosine */
#define THIN 0.12f /* of the thinnest cloud over that of the thickest: light sent back */
#define SHADOW_STEPS 11
#define SHADOW_FIRST 1.0f /* texels of level 1 */
#define SHADOW_GROWTH 1.4f

/* Points of a lattice that repeats over the square: each cell has one, and a dome over it. */
typedef struct Lattice {
    int period[2];
    float (*point)[3]; /* of each cell: where in it, and its dome's height squared */
} Lattice;

/* What changes slowly: two displacements and the swell, on a coarser square. */
typedef struct Slow {
    float bend[2], swell;
} Slow;

#define SLOW_SIZE 256
#define LATTICES 3

typedef struct FieldBuild {
    const CloudFieldInput *input;
    CloudField *field;
    Lattice lattice[LATTICES];
    Slow *slow;
    float *half;          /* at the places of level 1: the larger puffs; then what passes */
    float towards[2];     /* the light, in the field's axes, unit */
    float sine, cosine;   /* of its elevation */
    double *sum, *square; /* of each row */
    float mean, scale;
    int at; /* the level that is made */
} FieldBuild;

/* ---- noise ------------------------------------------------------------------------------- */

/* From a place near [0, period) into it. */
static int around(int i, int period) {
    return i < 0 ? i + period : i >= period ? i - period : i;
}

static uint32_t hash_of(int x, int y, uint32_t seed) {
    uint32_t h = (uint32_t)x * 0x9e3779b1u ^ (uint32_t)y * 0x85ebca77u ^ seed * 0xc2b2ae3du;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return h ^ (h >> 15);
}

/* Ten bits of a hash from one on, in [-1, 1). */
static float part_of(uint32_t hash, int first) {
    return (float)((hash >> first) & 1023) * (1 / 512.0f) - 1;
}

static float corner(const int at[2], float dx, float dy, const int period[2], uint32_t seed) {
    uint32_t hash = hash_of(around(at[0], period[0]), around(at[1], period[1]), seed);
    return part_of(hash, 0) * dx + part_of(hash, 10) * dy;
}

static float fade(float t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}

/* Gradient noise at u, v in [0, 1) of the square, `period` cells a side: about -0.7 to 0.7. */
static float noise(float u, float v, const int period[2], uint32_t seed) {
    float x = u * (float)period[0], y = v * (float)period[1];
    float fx = floorf(x), fy = floorf(y), a = x - fx, b = y - fy;
    int i = (int)fx, j = (int)fy;
    float low = lerpf(corner((int[2]){i, j}, a, b, period, seed),
                      corner((int[2]){i + 1, j}, a - 1, b, period, seed), fade(a));
    float high = lerpf(corner((int[2]){i, j + 1}, a, b - 1, period, seed),
                       corner((int[2]){i + 1, j + 1}, a - 1, b - 1, period, seed), fade(a));
    return lerpf(low, high, fade(b));
}

static void make_lattice(const int period[2], uint32_t seed, Arena *scratch, Lattice *out) {
    out->period[0] = period[0];
    out->period[1] = period[1];
    out->point = arena_alloc(scratch, sizeof *out->point, 16, (size_t)(period[0] * period[1]));
    for (int j = 0; j < period[1]; j++)
        for (int i = 0; i < period[0]; i++) {
            uint32_t hash = hash_of(i, j, seed);
            float *point = out->point[j * period[0] + i];
            point[0] = 0.5f + 0.42f * part_of(hash, 0);
            point[1] = 0.5f + 0.42f * part_of(hash, 10);
            float height = 0.8f + 0.2f * part_of(hash, 20);
            point[2] = height * height;
        }
}

/* The highest of the domes around: 0.6 to 1 at a top, 0 where there is none. */
static float puff(const Lattice *lattice, float u, float v) {
    const int *period = lattice->period;
    float x = u * (float)period[0], y = v * (float)period[1], highest = 0;
    int i = (int)floorf(x), j = (int)floorf(y);
    const int column[3] = {around(i - 1, period[0]), around(i, period[0]),
                           around(i + 1, period[0])};
    for (int b = -1; b <= 1; b++) {
        float(*row)[3] = lattice->point + around(j + b, period[1]) * period[0];
        for (int a = -1; a <= 1; a++) {
            const float *point = row[column[a + 1]];
            float dx = (float)(i + a) + point[0] - x, dy = (float)(j + b) + point[1] - y;
            float dome = point[2] * (1 - dx * dx - dy * dy);
            highest = dome > highest ? dome : highest;
        }
    }
    return sqrtf(highest);
}

/* ---- heights ----------------------------------------------------------------------------- */

static void fill_slow(void *context, int row, int worker) {
    static const int BEND[2] = {20, 26}, WIDE[2] = {6, 8}, MIDDLE[2] = {14, 19};
    FieldBuild *b = context;
    (void)worker;
    for (int i = 0; i < SLOW_SIZE; i++) {
        float u = (float)i / SLOW_SIZE, v = (float)row / SLOW_SIZE;
        b->slow[row * SLOW_SIZE + i] =
            (Slow){{0.008f * noise(u, v, BEND, 11), 0.008f * noise(u, v, BEND, 12)},
                   noise(u, v, WIDE, 1) + 0.7f * noise(u, v, MIDDLE, 2)};
    }
}

static Slow mixed(Slow a, Slow b, float t) {
    return (Slow){{lerpf(a.bend[0], b.bend[0], t), lerpf(a.bend[1], b.bend[1], t)},
                  lerpf(a.swell, b.swell, t)};
}

/* At a place of level 1. */
static Slow slow_at(const FieldBuild *b, int x, int y) {
    const int coarse = SIZE / 2 / SLOW_SIZE;
    int i = x / coarse, j = y / coarse, i1 = (i + 1) % SLOW_SIZE, j1 = (j + 1) % SLOW_SIZE;
    float s = (float)(x % coarse) / (float)coarse, t = (float)(y % coarse) / (float)coarse;
    const Slow *low = b->slow + j * SLOW_SIZE, *high = b->slow + j1 * SLOW_SIZE;
    return mixed(mixed(low[i], low[i1], s), mixed(high[i], high[i1], s), t);
}

/* Relative: puffs on larger puffs, on a swell that also makes them higher. */
static float broad_height(const FieldBuild *b, int x, int y) {
    Slow slow = slow_at(b, x, y);
    float u = (float)x / HALF + slow.bend[0], v = (float)y / HALF + slow.bend[1];
    float large = puff(&b->lattice[0], u, v);
    return large * (0.9f + 0.7f * slow.swell) + 1.1f * slow.swell +
           (0.15f + 0.4f * large) * puff(&b->lattice[1], u, v);
}

static void fill_broad(void *context, int row, int worker) {
    FieldBuild *b = context;
    (void)worker;
    for (int i = 0; i < HALF; i++)
        b->half[(size_t)row * HALF + (size_t)i] = broad_height(b, i, row);
}

/* At a place of the finest level, from values at those of level 1, whose middles lie between.
 */
static float half_at(const FieldBuild *b, int x, int y) {
    int i = (x + (x & 1)) / 2 - 1, j = (y + (y & 1)) / 2 - 1; /* the place before */
    float s = x & 1 ? 0.25f : 0.75f, t = y & 1 ? 0.25f : 0.75f;
    const float *low = b->half + (size_t)(j & (HALF - 1)) * HALF;
    const float *high = b->half + (size_t)((j + 1) & (HALF - 1)) * HALF;
    int i0 = i & (HALF - 1), i1 = (i + 1) & (HALF - 1);
    return lerpf(lerpf(low[i0], low[i1], s), lerpf(high[i0], high[i1], s), t);
}

/* The smallest puffs on those. */
static float height_of(const FieldBuild *b, int x, int y) {
    return half_at(b, x, y) + 0.14f * puff(&b->lattice[2], (float)x / SIZE, (float)y / SIZE);
}

static void fill_heights(void *context, int row, int worker) {
    FieldBuild *b = context;
    CloudSample *out = b->field->level[0] + (size_t)row * SIZE;
    double sum = 0, square = 0;
    (void)worker;
    for (int i = 0; i < SIZE; i++) {
        out[i].height = height_of(b, i, row);
        sum += (double)out[i].height;
        square += (double)out[i].height * (double)out[i].height;
    }
    b->sum[row] = sum;
    b->square[row] = square;
}

static void scale_heights(void *context, int row, int worker) {
    FieldBuild *b = context;
    CloudSample *out = b->field->level[0] + (size_t)row * SIZE;
    (void)worker;
    for (int i = 0; i < SIZE; i++) out[i].height = (out[i].height - b->mean) * b->scale;
}

/* ---- light ------------------------------------------------------------------------------- */

static CloudSample *texel(const CloudField *field, int level, int x, int y) {
    int size = SIZE >> level;
    return &field->level[level][(size_t)(y & (size - 1)) * (size_t)size + (size_t)(x & (size - 1))];
}

/* Bilinear; x and y in texels of the level. */
static CloudSample between(const CloudField *field, int level, float x, float y) {
    float fx = floorf(x), fy = floorf(y), a = x - fx, b = y - fy;
    int i = (int)fx, j = (int)fy;
    const CloudSample *p = texel(field, level, i, j), *q = texel(field, level, i + 1, j);
    const CloudSample *r = texel(field, level, i, j + 1);
    const CloudSample *s = texel(field, level, i + 1, j + 1);
    return (CloudSample){lerpf(lerpf(p->height, q->height, a), lerpf(r->height, s->height, a), b),
                         lerpf(lerpf(p->shade, q->shade, a), lerpf(r->shade, s->shade, a), b)};
}

/* The same of the height alone. */
static float height_between(const CloudField *field, int level, float x, float y) {
    float fx = floorf(x), fy = floorf(y), a = x - fx, b = y - fy;
    int i = (int)fx, j = (int)fy;
    return lerpf(
        lerpf(texel(field, level, i, j)->height, texel(field, level, i + 1, j)->height, a),
        lerpf(texel(field, level, i, j + 1)->height, texel(field, level, i + 1, j + 1)->height, a),
        b);
}

/* How much of the light passes what stands towards it: the steepest rise on the way, against
 * the light's own, with a wide half-shadow. x, y: of level 1. */
static float passing(const FieldBuild *b, int x, int y) {
    float rise = -1, step = SHADOW_FIRST, tangent = b->sine / b->cosine;
    float height = texel(b->field, 1, x, y)->height;
    for (int i = 0; i < SHADOW_STEPS; i++, step *= SHADOW_GROWTH) {
        int level = step < 4 ? 1 : step < 10 ? 2 : 3;
        float shrink = 1 / (float)(1 << (level - 1)), shift = 0.5f * shrink - 0.5f;
        float there =
            height_between(b->field, level, ((float)x + step * b->towards[0]) * shrink + shift,
                           ((float)y + step * b->towards[1]) * shrink + shift);
        float slope = (there - height) / (2 * step * CLOUD_FIELD_TEXEL_M);
        rise = slope > rise ? slope : rise;
    }
    float soft = 0.06f + 0.35f * tangent;
    float t = clampf(0.5f + (tangent - rise) / (2 * soft), 0, 1);
    return t * t * (3 - 2 * t);
}

static void fill_passing(void *context, int row, int worker) {
    FieldBuild *b = context;
    (void)worker;
    for (int i = 0; i < HALF; i++) b->half[(size_t)row * HALF + (size_t)i] = passing(b, i, row);
}

/* Thin cloud between the banks is darker than their tops, and so are creases, from which less
 * light finds its way out. */
static float thickness(const FieldBuild *b, int x, int y, float height) {
    float coarse = height_between(b->field, 4, ((float)x - 7.5f) / 16, ((float)y - 7.5f) / 16);
    float relief = (float)b->input->relief_m;
    float crease = clampf(1 + 2.2f * (height - coarse) / relief, 0.3f, 1.5f);
    float t = clampf(1.2f * (0.4f * height + 0.6f * coarse) / relief + 0.5f, 0, 1);
    return crease * (THIN + (1 - THIN) * t);
}

static float lit(const FieldBuild *b, int x, int y) {
    const CloudField *field = b->field;
    float height = texel(field, 0, x, y)->height, run = 2 * CLOUD_FIELD_TEXEL_M;
    float sx = (texel(field, 0, x + 1, y)->height - texel(field, 0, x - 1, y)->height) / run;
    float sy = (texel(field, 0, x, y + 1)->height - texel(field, 0, x, y - 1)->height) / run;
    float facing = (b->sine - b->cosine * (sx * b->towards[0] + sy * b->towards[1])) /
                   sqrtf(1 + sx * sx + sy * sy);
    float matte = facing > -WRAP ? (facing + WRAP) / (b->sine + WRAP) : 0;
    return thickness(b, x, y, height) * (0.1f + matte * (0.1f + 0.9f * half_at(b, x, y)));
}

static void fill_shades(void *context, int row, int worker) {
    FieldBuild *b = context;
    double sum = 0;
    (void)worker;
    for (int i = 0; i < SIZE; i++) {
        float shade = lit(b, i, row);
        texel(b->field, 0, i, row)->shade = shade;
        sum += (double)shade;
    }
    b->sum[row] = sum;
}

static void scale_shades(void *context, int row, int worker) {
    FieldBuild *b = context;
    (void)worker;
    for (int i = 0; i < SIZE; i++) texel(b->field, 0, i, row)->shade *= b->scale;
}

/* ---- levels ------------------------------------------------------------------------------ */

static void fill_level(void *context, int row, int worker) {
    const FieldBuild *b = context;
    int k = b->at, size = SIZE >> k;
    (void)worker;
    for (int i = 0; i < size; i++) {
        const CloudSample *p = texel(b->field, k - 1, 2 * i, 2 * row), *q = p + 1,
                          *r = texel(b->field, k - 1, 2 * i, 2 * row + 1), *s = r + 1;
        *texel(b->field, k, i, row) =
            (CloudSample){0.25f * (p->height + q->height + r->height + s->height),
                          0.25f * (p->shade + q->shade + r->shade + s->shade)};
    }
}

static void fill_levels(FieldBuild *b) {
    for (b->at = 1; b->at < CLOUD_FIELD_LEVELS; b->at++)
        parallel_for(b->input->threads, SIZE >> b->at, fill_level, b);
}

static double total(const double *row) {
    double sum = 0;
    for (int i = 0; i < SIZE; i++) sum += row[i];
    return sum / ((double)SIZE * SIZE);
}

static void start(const CloudFieldInput *input, CloudField *field, FieldBuild *b) {
    double elevation = fmax(input->elevation, LOWEST_LIGHT);
    double turn = PI / 2 - input->azimuth - STREETS; /* from the field's x axis */
    b->input = input;
    b->field = field;
    b->towards[0] = (float)cos_d(turn);
    b->towards[1] = (float)sin_d(turn);
    b->sine = (float)sin_d(elevation);
    b->cosine = (float)cos_d(elevation);
}

static void take_scratch(FieldBuild *b, Arena *scratch) {
    static const int LARGE[2] = {34, 48}, SMALL[2] = {96, 126}, TINY[2] = {270, 330};
    b->sum = ARENA_NEW(scratch, double, SIZE);
    b->square = ARENA_NEW(scratch, double, SIZE);
    b->slow = ARENA_NEW(scratch, Slow, SLOW_SIZE * SLOW_SIZE);
    b->half = ARENA_NEW(scratch, float, HALF *HALF);
    make_lattice(LARGE, 3, scratch, &b->lattice[0]);
    make_lattice(SMALL, 4, scratch, &b->lattice[1]);
    make_lattice(TINY, 5, scratch, &b->lattice[2]);
}

void cloud_field_build(const CloudFieldInput *input, Arena *arena, CloudField *out) {
    Arena scratch;
    FieldBuild b = {0};
    int threads = input->threads;
    for (int k = 0; k < CLOUD_FIELD_LEVELS; k++)
        out->level[k] = ARENA_NEW(arena, CloudSample, (SIZE >> k) * (SIZE >> k));
    scratch = *arena;
    take_scratch(&b, &scratch);
    start(input, out, &b);
    parallel_for(threads, SLOW_SIZE, fill_slow, &b);
    parallel_for(threads, HALF, fill_broad, &b);
    parallel_for(threads, SIZE, fill_heights, &b);
    double mean = total(b.sum), spread = sqrt(total(b.square) - mean * mean);
    b.mean = (float)mean;
    b.scale = (float)(input->relief_m / (4 * spread));
    parallel_for(threads, SIZE, scale_heights, &b);
    fill_levels(&b); /* the light reads heights of coarse levels */
    parallel_for(threads, HALF, fill_passing, &b);
    parallel_for(threads, SIZE, fill_shades, &b);
    b.scale = (float)(1 / total(b.sum));
    parallel_for(threads, SIZE, scale_shades, &b);
    fill_levels(&b);
}

CloudSample cloud_field_at(const CloudField *field, float x_m, float y_m, float level) {
    static const float C = 0.906307787f, S = 0.422618262f; /* of STREETS */
    float x = (C * x_m + S * y_m) / CLOUD_FIELD_TEXEL_M;
    float y = (C * y_m - S * x_m) / CLOUD_FIELD_TEXEL_M;
    float k = clampf(level, 0, CLOUD_FIELD_LEVELS - 1.001f), share = k - floorf(k);
    int fine = (int)k;
    float s = 1 / (float)(1 << fine), shift = 0.5f * s - 0.5f;
    CloudSample near = between(field, fine, x * s + shift, y * s + shift);
    if (share <= 0) return near;
    shift = 0.25f * s - 0.5f;
    CloudSample far = between(field, fine + 1, 0.5f * s * x + shift, 0.5f * s * y + shift);
    return (CloudSample){lerpf(near.height, far.height, share),
                         lerpf(near.shade, far.shade, share)};
}
