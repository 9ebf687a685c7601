/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/report/html_pictures.h"

#include <math.h>
#include <string.h>

#include "compare/metrics.h"
#include "compare/metrics/rank.h"
#include "image/false_colour.h"

#define RAMP_COLOURS 256
#define LEFT_OUT 0.5f /* the grey of pixels that do not count */

/* ---- ramps ------------------------------------------------------------------------------- */

typedef struct Ramp {
    float colour[RAMP_COLOURS][3]; /* sRGB codes */
} Ramp;

/* Blue over light grey to red, as even in lightness on both sides as five stops make it. */
static void signed_colour(float t, float srgb[3]) {
    static const float STOPS[5][3] = {{0.04f, 0.21f, 0.46f},
                                      {0.33f, 0.60f, 0.81f},
                                      {0.95f, 0.95f, 0.94f},
                                      {0.92f, 0.58f, 0.40f},
                                      {0.54f, 0.08f, 0.09f}};
    int stop = t < 1 ? (int)(t * 4) : 3;
    float part = t * 4 - (float)stop;
    for (int c = 0; c < 3; c++)
        srgb[c] = STOPS[stop][c] + part * (STOPS[stop + 1][c] - STOPS[stop][c]);
}

static void make_ramp(bool is_signed, Ramp *out) {
    for (int i = 0; i < RAMP_COLOURS; i++) {
        float t = (float)i / (RAMP_COLOURS - 1);
        if (is_signed) signed_colour(t, out->colour[i]);
        else false_colour_of(t, out->colour[i]);
    }
}

static int code_of(float value) {
    return (int)(value * 255 + 0.5f);
}

static void add_colour(Text *text, const char *before, const float srgb[3]) {
    text_format(text, "%s%02x%02x%02x", before, code_of(srgb[0]), code_of(srgb[1]),
                code_of(srgb[2]));
}

void shot_ramp_digits(Text *text, bool is_signed) {
    Ramp ramp;
    make_ramp(is_signed, &ramp);
    for (int i = 0; i < RAMP_COLOURS; i++) add_colour(text, "", ramp.colour[i]);
}

void shot_ramp_gradient(Text *html, bool is_signed) {
    enum { STOPS = 16 };
    Ramp ramp;
    make_ramp(is_signed, &ramp);
    for (int i = 0; i <= STOPS; i++)
        add_colour(html, ",#", ramp.colour[i * (RAMP_COLOURS - 1) / STOPS]);
}

/* ---- smaller ----------------------------------------------------------------------------- */

int shot_factor(const Planes *planes, long most) {
    int factor = 1;
    double pixels = (double)planes_pixel_count(planes);
    while (pixels / ((double)factor * factor) > (double)most) factor++;
    return factor;
}

/* One picture's pixel and the pixels that become it. */
typedef struct PixelBlock {
    int x0, y0, x1, y1;
} PixelBlock;

static PixelBlock block_of(const Planes *planes, int factor, size_t i) {
    int row = (planes->width + factor - 1) / factor;
    int x = (int)(i % (size_t)row) * factor, y = (int)(i / (size_t)row) * factor;
    return (PixelBlock){x, y, x + factor < planes->width ? x + factor : planes->width,
                        y + factor < planes->height ? y + factor : planes->height};
}

static Picture small_picture(const Planes *planes, int factor, Arena *arena) {
    return picture_create((planes->width + factor - 1) / factor,
                          (planes->height + factor - 1) / factor, arena);
}

static size_t picture_pixels(const Picture *picture) {
    return (size_t)picture->width * (size_t)picture->height;
}

static Picture side_picture(const Planes *codes, int factor, Arena *arena) {
    Picture out = small_picture(codes, factor, arena);
    for (size_t i = 0; i < picture_pixels(&out); i++) {
        PixelBlock b = block_of(codes, factor, i);
        for (size_t c = 0; c < 3; c++) {
            float sum = 0;
            for (int y = b.y0; y < b.y1; y++)
                for (int x = b.x0; x < b.x1; x++)
                    sum += codes->rgb[c][(size_t)y * (size_t)codes->width + (size_t)x];
            out.rgb[3 * i + c] = sum / (float)((b.x1 - b.x0) * (b.y1 - b.y0));
        }
    }
    return out;
}

Picture shot_thumbnail(const Comparison *c, ShotKind kind, int side, Arena *arena) {
    const Planes *codes = kind == SHOT_TEST ? &c->test.codes : &c->reference.codes;
    int factor = (codes->width + side - 1) / side;
    return side_picture(codes, factor > 0 ? factor : 1, arena);
}

/* The value of greatest magnitude in a block; NaN when none counts there. */
static float extreme_of(const Planes *planes, const float *map, PixelMask mask, PixelBlock b) {
    float extreme = NAN;
    for (int y = b.y0; y < b.y1; y++)
        for (int x = b.x0; x < b.x1; x++) {
            size_t i = (size_t)y * (size_t)planes->width + (size_t)x;
            if (mask[i] && !(fabsf(map[i]) <= fabsf(extreme))) extreme = map[i];
        }
    return extreme;
}

static Picture map_picture(const Comparison *c, const float *map, const ShotScale *scale,
                           int factor, Arena *arena) {
    const Planes *planes = &c->light[0];
    Picture out = small_picture(planes, factor, arena);
    Ramp ramp;
    make_ramp(scale->is_signed, &ramp);
    for (size_t i = 0; i < picture_pixels(&out); i++) {
        double value = (double)extreme_of(planes, map, c->mask, block_of(planes, factor, i));
        double t = (value - scale->low) / (scale->high - scale->low);
        if (isnan(value)) {
            for (size_t k = 0; k < 3; k++) out.rgb[3 * i + k] = LEFT_OUT;
            continue;
        }
        t = t < 0 ? 0 : t > 1 ? 1 : t;
        memcpy(out.rgb + 3 * i, ramp.colour[(int)(t * (RAMP_COLOURS - 1) + 0.5)],
               sizeof ramp.colour[0]);
    }
    return out;
}

/* ---- scales ------------------------------------------------------------------------------ */

/* 1, 2 or 5 times a power of ten, not below the value. */
static double round_up(double value) {
    double power = pow(10, floor(log10(value)));
    double head = value / power;
    return power * (head <= 1 ? 1 : head <= 2 ? 2 : head <= 5 ? 5 : 10);
}

static void set_ticks(ShotScale *scale, const char *beyond, Arena *arena) {
    for (int i = 0; i < 5; i++) {
        double value = scale->low + (scale->high - scale->low) * i / 4;
        scale->ticks[i] =
            arena_format(arena, "%s%.3g", value > 0 && scale->is_signed ? "+" : "", value);
    }
    scale->ticks[4] = arena_format(arena, "%s%s", scale->ticks[4], beyond);
}

static float luminance_at(const Planes *planes, size_t i) {
    return 0.2126f * planes->rgb[0][i] + 0.7152f * planes->rgb[1][i] + 0.0722f * planes->rgb[2][i];
}

/* Of what counts of the reference. */
static double mean_luminance(const Comparison *c) {
    return rgb_luminance(c->change.all.light[0]) / c->change.all.pixels;
}

static const float *make_difference(const Comparison *c, Arena *arena, Shot *out) {
    const Planes *a = &c->light[0], *b = &c->light[1];
    size_t count = planes_pixel_count(a);
    float *difference = ARENA_NEW(arena, float, count), *size = ARENA_NEW(arena, float, count);
    bool is_frame = c->reference.kind == INPUT_FRAME;
    for (size_t i = 0; i < count; i++) {
        difference[i] = luminance_at(b, i) - luminance_at(a, i);
        if (!is_frame) difference[i] *= 100;
        size[i] = fabsf(difference[i]);
    }
    double most = (double)rank_value(size, count, c->mask, 0.995);
    if (!(most > 0)) most = (double)rank_value(size, count, c->mask, 1);
    double limit = most > 0 ? round_up(most) : 1;
    double mean = mean_luminance(c);
    out->title = "Difference";
    out->caption = "Luminance of the test less that of the reference: red is brighter, blue "
                   "darker.";
    out->scale = (ShotScale){
        .is_signed = true, .low = -limit, .high = limit, .unit = is_frame ? "cd/m²" : "% of white"};
    set_ticks(&out->scale, "", arena);
    if (is_frame && mean > 0)
        out->scale.also = arena_format(arena,
                                       "±%.3g %% of the reference's mean luminance, "
                                       "%.4g cd/m²",
                                       100 * limit / mean, mean);
    return difference;
}

#define DARK 0.01 /* of the mean luminance: darker blocks are taken relative to this */

/* Every pixel gets the change of its cell's mean luminance, in percent. */
static const float *make_blocks(const Comparison *c, Arena *arena, Shot *out) {
    const ChangeGrid *grid = &c->grid;
    size_t count = planes_pixel_count(&c->light[0]);
    float *change = ARENA_NEW(arena, float, count), *size = ARENA_NEW(arena, float, count);
    double dark = DARK * mean_luminance(c);
    for (size_t i = 0; i < count; i++) {
        int x = (int)(i % (size_t)grid->width), y = (int)(i / (size_t)grid->width);
        const ChangeSum *cell = &grid->cells[y / grid->side * grid->columns + x / grid->side];
        double before = rgb_luminance(cell->light[0]), after = rgb_luminance(cell->light[1]);
        double least = (dark > 0 ? dark : 1) * cell->pixels;
        change[i] = cell->pixels > 0 ? (float)(100 * (after - before) / (before + least)) : 0;
        size[i] = fabsf(change[i]);
    }
    double most = (double)rank_value(size, count, c->mask, 0.95);
    double limit = most > 0 ? round_up(most) : 1;
    out->title = "Blocks";
    out->caption = arena_format(
        arena,
        "Change of the mean luminance of blocks of %d x %d pixels. Noise is a mix of both colours; "
        "where the mean moved, one of them fills a region.",
        grid->side, grid->side);
    out->scale = (ShotScale){.is_signed = true, .low = -limit, .high = limit, .unit = "%"};
    set_ticks(&out->scale, "", arena);
    return change;
}

static const float *make_flip(const Comparison *c, Arena *arena, Shot *out) {
    bool is_frame = c->reference.kind == INPUT_FRAME;
    out->title = "FLIP";
    out->caption = "What an eye notices when one picture is flipped for the other.";
    if (is_frame)
        out->caption =
            arena_format(arena,
                         "What an eye notices when one picture is flipped for the other: the worst "
                         "of %d exposures, EV %.1f to %.1f.",
                         c->exposures.count, ev_of_stops(c->exposures.stop_ev),
                         ev_of_stops(c->exposures.start_ev));
    out->scale = (ShotScale){.low = 0, .high = 1, .unit = ""};
    set_ticks(&out->scale, "", arena);
    return c->flip_map;
}

static const float *make_deltae(const Comparison *c, Arena *arena, Shot *out) {
    size_t count = planes_pixel_count(&c->light[0]);
    double most = (double)rank_value(c->deltae_map, count, c->mask, 0.995);
    out->title = "ΔE2000";
    out->caption = "CIEDE2000 of the displayed colours; 1 is about what can just be seen.";
    out->scale = (ShotScale){.low = 0, .high = most > 2 ? round_up(most) : 2, .unit = ""};
    set_ticks(&out->scale, " or more", arena);
    return c->deltae_map;
}

#define P_DECADES 6

/* -log10 p of the block that each pixel lies in. */
static const float *make_p_values(const Comparison *c, Arena *arena, Shot *out) {
    static const char *const TICKS[5] = {"p = 1", "0.03", "0.001", "3e-5", "1e-6 or less"};
    const StatisticResult *s = &c->stat;
    const Planes *planes = &c->light[0];
    const ExrWindow w = c->reference.frame.display, d = c->reference.frame.data;
    float *map = ARENA_NEW(arena, float, planes_pixel_count(planes));
    for (int y = 0; y < planes->height; y++)
        for (int x = 0; x < planes->width; x++) {
            int u = (x + w.x0 - d.x0) / s->block_side, v = (y + w.y0 - d.y0) / s->block_side;
            bool inside = u >= 0 && v >= 0 && u < s->blocks_x && v < s->blocks_y;
            float p = inside ? s->block_p[(size_t)v * (size_t)s->blocks_x + (size_t)u] : NAN;
            size_t i = (size_t)y * (size_t)planes->width + (size_t)x;
            map[i] = p > 0 ? -log10f(p) : p == 0 ? P_DECADES : 0;
        }
    out->title = "p-values";
    out->caption =
        arena_format(arena,
                     "How likely the noise alone makes blocks of %d x %d pixels differ by so much. "
                     "Noise gives every p as often as any other: bright patches are a change.",
                     s->block_side, s->block_side);
    out->scale = (ShotScale){.low = 0, .high = P_DECADES, .unit = "decades below 1"};
    memcpy(out->scale.ticks, TICKS, sizeof TICKS);
    return map;
}

/* ---- the shots --------------------------------------------------------------------------- */

static void make_side(const Comparison *c, ShotKind kind, int factor, Arena *arena, Shot *out) {
    bool is_reference = kind == SHOT_REFERENCE;
    const CompareInput *side = is_reference ? &c->reference : &c->test;
    out->title = is_reference ? "Reference" : "Test";
    out->caption = c->reference.kind == INPUT_PICTURE
                       ? arena_format(arena, "%s, %d bits", side->name, side->bits)
                       : arena_format(arena, "%s, developed at EV %.2f", side->name, c->shown_ev);
    out->picture = side_picture(&side->codes, factor, arena);
}

/* Fills title, caption and scale; NULL when this comparison has no such map. */
static const float *make_map(const Comparison *c, ShotKind kind, Arena *arena, Shot *out) {
    bool has_p = c->has_stat && c->stat.block_p && c->stat.block_side >= 1;
    bool is_frame = c->reference.kind == INPUT_FRAME;
    switch (kind) {
    case SHOT_DIFFERENCE: return make_difference(c, arena, out);
    case SHOT_BLOCKS: return is_frame ? make_blocks(c, arena, out) : NULL;
    case SHOT_FLIP: return c->flip_map ? make_flip(c, arena, out) : NULL;
    case SHOT_DELTAE: return c->deltae_map ? make_deltae(c, arena, out) : NULL;
    case SHOT_P_VALUE: return has_p ? make_p_values(c, arena, out) : NULL;
    default: return NULL;
    }
}

bool shot_make(const Comparison *c, ShotKind kind, int factor, Arena *arena, Shot *out) {
    *out = (Shot){.kind = kind};
    if (kind == SHOT_REFERENCE || kind == SHOT_TEST) {
        make_side(c, kind, factor, arena, out);
        return true;
    }
    const float *map = make_map(c, kind, arena, out);
    if (!map) return false;
    out->has_scale = true;
    out->picture = map_picture(c, map, &out->scale, factor, arena);
    return true;
}
