/* SPDX-License-Identifier: Apache-2.0 */
#include "image/false_colour.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mathf.h"
#include "base/sort.h"
#include "image/srgb.h"
#include "image/stroke_font.h"

static const float NOTHING[3] = {0.10f, 0.10f, 0.11f}; /* pixels without a value */
static const float GROUND[3] = {0.05f, 0.05f, 0.055f}; /* behind the scale */
static const float INK[3] = {0.92f, 0.92f, 0.92f};

/* ---- colours ------------------------------------------------------------------------- */

/* OKLab to linear sRGB: the cube of the cone responses, then Ottosson's matrix. */
static void linear_from_oklab(float l, float a, float b, float rgb[3]) {
    float p = l + 0.3963377774f * a + 0.2158037573f * b;
    float q = l - 0.1055613458f * a - 0.0638541728f * b;
    float r = l - 0.0894841775f * a - 1.2914855480f * b;
    p *= p * p;
    q *= q * q;
    r *= r * r;
    rgb[0] = 4.0767416621f * p - 3.3077115913f * q + 0.2309699292f * r;
    rgb[1] = -1.2684380046f * p + 2.6097574011f * q - 0.3413193965f * r;
    rgb[2] = -0.0041960863f * p - 0.7034186147f * q + 1.7076147010f * r;
}

static bool is_inside(const float rgb[3]) {
    for (int c = 0; c < 3; c++)
        if (!(rgb[c] >= 0 && rgb[c] <= 1)) return false;
    return true;
}

/* CIE 1976 lightness L* above 8 to luminance. */
static float luminance_from_lightness(float lightness) {
    float f = (lightness + 16) / 116;
    return f * f * f;
}

/* Finds the colour of this luminance among those of one hue (its cosine and sine) and
 * chroma. */
static void colour_of_luminance(float luminance, float cosine, float sine, float chroma,
                                float rgb[3]) {
    float low = 0, high = 1;
    for (int i = 0; i < 22; i++) {
        float l = (low + high) / 2;
        linear_from_oklab(l, chroma * cosine, chroma * sine, rgb);
        float y = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
        if (y < luminance) low = l;
        else high = l;
    }
}

void false_colour_of(float t, float srgb[3]) {
    float luminance = luminance_from_lightness(8 + 88 * t), sine, cosine, rgb[3];
    sincos_turns((200 + 265 * t) / 360, &sine, &cosine); /* teal, blue .. red .. yellow */
    for (float chroma = 0.20f; chroma > 0; chroma -= 0.004f) {
        colour_of_luminance(luminance, cosine, sine, chroma, rgb);
        if (is_inside(rgb)) break;
    }
    for (int c = 0; c < 3; c++) srgb[c] = srgb_from_linear(clampf(rgb[c], 0, 1));
}

/* ---- the range ----------------------------------------------------------------------- */

/* 1, 2 or 5 times a power of ten, the next one at or above (below) value > 0. */
static float round_number(float value, bool up) {
    static const double STEPS[] = {1, 2, 5, 10};
    double decade = pow(10, floor(log10((double)value) + 1e-6)), best = decade;
    for (int i = 0; i < 4; i++) {
        double step = STEPS[i] * decade;
        if (up && step >= (double)value * 0.9999) return (float)step;
        if (!up && step <= (double)value * 1.0001) best = step;
    }
    return (float)(up ? 10 * decade : best);
}

static ScaleRange log_range(const float *sorted, size_t count) {
    if (count == 0) return (ScaleRange){0.1f, 1000, true};
    float high = round_number(sorted[(size_t)((double)(count - 1) * 0.999)], true);
    float low = round_number(sorted[(size_t)((double)(count - 1) * 0.05)], false);
    if (low > high / 100) low = high / 100;
    if (low < high / 1e6f) low = high / 1e6f;
    return (ScaleRange){low, high, true};
}

static ScaleRange linear_range(const float *sorted, size_t count) {
    if (count == 0) return (ScaleRange){0, 1, false};
    float low = sorted[0], high = sorted[(size_t)((double)(count - 1) * 0.999)];
    if (low > 0 && low < high / 2) low = 0;
    if (low < 0) low = -round_number(-low, true);
    if (high > 0) high = round_number(high, true);
    if (!(high > low)) high = low + 1;
    return (ScaleRange){low, high, false};
}

ScaleRange scale_range_of(const float *values, size_t count, bool is_log, Arena scratch) {
    float *sorted = ARENA_NEW(&scratch, float, count);
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (isfinite(values[i]) && (!is_log || values[i] > 1e-30f)) sorted[kept++] = values[i];
    sort_floats(sorted, (long)kept);
    return is_log ? log_range(sorted, kept) : linear_range(sorted, kept);
}

float scale_position(ScaleRange range, float value) {
    float t = range.is_log ? log_f(value / range.low) / log_f(range.high / range.low)
                           : (value - range.low) / (range.high - range.low);
    return t > 0 ? (t < 1 ? t : 1.0f) : 0.0f;
}

/* ---- the picture --------------------------------------------------------------------- */

typedef struct ScaleLayout {
    StrokeFont font;
    int left, right, top, bottom; /* the coloured bar, half-open */
    int width;                    /* of the whole strip beside the values */
} ScaleLayout;

static ScaleLayout lay_out(int width, int height) {
    float letter = clampf((float)height / 45, 8, 40);
    int margin = (int)(letter * 1.2f);
    return (ScaleLayout){
        .font = {letter, {INK[0], INK[1], INK[2]}},
        .left = width + margin,
        .right = width + margin + (int)(letter * 1.8f),
        .top = (int)(letter * 3.4f),
        .bottom = height - (int)(letter * 1.5f),
        .width = margin + (int)(letter * 8.2f),
    };
}

static void fill(Picture *picture, int x0, int y0, int x1, int y1, const float colour[3]) {
    for (int y = y0 < 0 ? 0 : y0; y < y1 && y < picture->height; y++)
        for (int x = x0 < 0 ? 0 : x0; x < x1 && x < picture->width; x++)
            memcpy(picture_pixel(picture, x, y), colour, 3 * sizeof *colour);
}

static void draw_bar(Picture *picture, const ScaleLayout *s) {
    for (int y = s->top; y < s->bottom; y++) {
        float colour[3];
        false_colour_of(1 - ((float)(y - s->top) + 0.5f) / (float)(s->bottom - s->top), colour);
        fill(picture, s->left, y, s->right, y + 1, colour);
    }
}

static float position_y(const ScaleLayout *s, ScaleRange range, float value) {
    float t = scale_position(range, value);
    return (float)s->bottom - t * (float)(s->bottom - s->top);
}

static void draw_tick(Picture *picture, const ScaleLayout *s, float y, bool is_labelled,
                      float value) {
    float letter = s->font.height;
    int thick = letter > 14 ? 2 : 1, row = (int)(y - (float)thick * 0.5f + 0.5f);
    int length = (int)(letter * (is_labelled ? 0.7f : 0.4f));
    fill(picture, s->right, row, s->right + length, row + thick, INK);
    if (!is_labelled) return;
    char text[32];
    int decade = value > 0 ? (int)floor(log10((double)value) + 1e-4) : 0;
    bool is_long = decade > 5 || decade < -4;
    if (is_long) snprintf(text, sizeof text, "%.0fe%d", (double)value / pow(10, decade), decade);
    else snprintf(text, sizeof text, decade > 3 ? "%.0f" : "%.4g", (double)value);
    stroke_font_draw(picture, s->font, (float)s->right + letter, y, text);
}

/* Decades are labelled; 2 and 5 as well where there is room; 3 to 9 are marked. */
static void draw_log_ticks(Picture *picture, const ScaleLayout *s, ScaleRange range) {
    float decades = log_f(range.high / range.low) / 2.302585f;
    float room = (float)(s->bottom - s->top) / decades; /* pixels a decade */
    bool all = room > 8 * s->font.height;
    int first = (int)floor(log10((double)range.low) - 0.01);
    for (int e = first; e < first + 9; e++) {
        for (int m = 1; m < 10; m++) {
            float value = (float)(m * pow(10, e));
            if (value < range.low * 0.999f || value > range.high * 1.001f) continue;
            if (m != 1 && room < 4 * s->font.height) continue;
            draw_tick(picture, s, position_y(s, range, value),
                      m == 1 || (all && (m == 2 || m == 5)), value);
        }
    }
}

static void draw_linear_ticks(Picture *picture, const ScaleLayout *s, ScaleRange range) {
    float span = range.high - range.low;
    float step = round_number(span / 6, true);
    int first = (int)ceilf(range.low / step - 1e-3f);
    for (int i = first; (float)i * step <= range.high + 1e-3f * step; i++)
        draw_tick(picture, s, position_y(s, range, (float)i * step), true, (float)i * step);
}

static void draw_scale(Picture *picture, int width, ScaleRange range, const char *unit) {
    ScaleLayout s = lay_out(width, picture->height);
    fill(picture, width, 0, picture->width, picture->height, GROUND);
    stroke_font_draw(picture, s.font, (float)s.left, s.font.height * 1.7f, unit);
    if (s.bottom - s.top < 2) return;
    draw_bar(picture, &s);
    if (range.is_log) draw_log_ticks(picture, &s, range);
    else draw_linear_ticks(picture, &s, range);
}

Picture false_colour_picture(const float *values, int width, int height, ScaleRange range,
                             const char *unit, Arena *arena) {
    enum { STEPS = 512 };
    float table[STEPS + 1][3];
    for (int i = 0; i <= STEPS; i++) false_colour_of((float)i / STEPS, table[i]);
    Picture picture = picture_create(width + lay_out(width, height).width, height, arena);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            float value = values[(size_t)y * (size_t)width + (size_t)x];
            float t = isnan(value) ? 0 : scale_position(range, value);
            memcpy(picture_pixel(&picture, x, y),
                   isnan(value) ? NOTHING : table[(int)(t * STEPS + 0.5f)], 3 * sizeof(float));
        }
    }
    draw_scale(&picture, width, range, unit);
    return picture;
}
