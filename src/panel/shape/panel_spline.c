/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/shape/panel_spline.h"

#include <math.h>
#include <string.h>

#include "base/mathf.h"
#include "base/units.h"

#define INTERVALS (PANEL_SPLINE_COEFFICIENTS - 2)
#define COARSE_DEG 5.0
#define FINE_DEG 2.5
#define COARSE_COUNT 14 /* intervals of 5 degrees, up to 70 */

/* Knot i, degrees; 0 stands at the pole, negative ones mirror, those beyond 90 go on. */
static double knot(int i) {
    return i <= COARSE_COUNT ? COARSE_DEG * i
                             : COARSE_DEG * COARSE_COUNT + FINE_DEG * (i - COARSE_COUNT);
}

/* The four cubic B-splines over interval i, by Cox and de Boor; the first begins at knot
 * i - 3. */
static void cubic_basis(int i, double x, double value[4]) {
    double left[4], right[4];
    value[0] = 1;
    for (int d = 1; d <= 3; d++) {
        double saved = 0;
        left[d] = x - knot(i + 1 - d);
        right[d] = knot(i + d) - x;
        for (int r = 0; r < d; r++) {
            double part = value[r] / (right[r + 1] + left[d - r]);
            value[r] = saved + right[r + 1] * part;
            saved = left[d - r] * part;
        }
        value[d] = saved;
    }
}

/* Stored coefficient j belongs to the spline around knot j. Around the pole the spline before
 * it has the coefficient of the one behind it (times -1 for odd harmonics), and all but
 * harmonic 0 vanish there: c_0 = -c_1 / 2 (even), 0 (odd). */
PanelSplineTaps panel_spline_taps(int harmonic, double theta) {
    double x = degrees_from_radians(theta), value[4];
    int i = x < COARSE_DEG * COARSE_COUNT
                ? (int)(x / COARSE_DEG)
                : COARSE_COUNT + (int)((x - COARSE_DEG * COARSE_COUNT) / FINE_DEG);
    if (i < 0) i = 0;
    if (i > INTERVALS - 1) i = INTERVALS - 1;
    cubic_basis(i, x, value);
    PanelSplineTaps taps = {.first = i > 0 ? i - 1 : 0};
    bool is_odd = harmonic % 2;
    for (int k = 0; k < 4; k++) {
        int j = i - 1 + k;
        double w = value[k];
        if (j == -1) taps.weight[1] += (float)(is_odd ? -w : w);
        else if (j == 0 && harmonic) taps.weight[1 - taps.first] += (float)(is_odd ? 0 : -w / 2);
        else taps.weight[j - taps.first] += (float)w;
    }
    return taps;
}

static size_t number_at(int components, int term, int component) {
    return PANEL_SPLINE_NUMBERS * ((size_t)term * (size_t)components + (size_t)component);
}

void panel_spline_expand(const uint8_t *term, int terms, int components, const float *numbers,
                         Arena *arena, PanelSpline *out) {
    int stride = (components + 3) / 4 * 4;
    size_t row = (size_t)(terms * stride);
    float *table = ARENA_NEW(arena, float, PANEL_SPLINE_ANGLES *row + 4);
    float *power = ARENA_NEW(arena, float, row + 4);
    *out = (PanelSpline){.terms = terms,
                         .stride = stride,
                         .harmonics = terms ? panel_spline_harmonic(term[terms - 1]) : 0,
                         .table = table,
                         .power = power};
    for (int t = 0; t < terms; t++) {
        out->term[t] = term[t];
        for (int k = 0; k < components; k++)
            power[t * stride + k] =
                numbers[number_at(components, t, k) + PANEL_SPLINE_COEFFICIENTS];
        for (int a = 0; a < PANEL_SPLINE_ANGLES; a++) {
            PanelSplineTaps taps =
                panel_spline_taps(panel_spline_harmonic(term[t]),
                                  2 * (double)atan2_f((float)a, PANEL_SPLINE_ANGLES - 1));
            for (int k = 0; k < components; k++) {
                const float *c = numbers + number_at(components, t, k) + taps.first;
                float sum = 0;
                for (int i = 0; i < 4; i++) sum += taps.weight[i] * c[i];
                table[(size_t)a * row + (size_t)(t * stride + k)] = sum;
            }
        }
    }
}

/* ---- the stored form ------------------------------------------------------------------- */

typedef struct SplineHead {
    uint8_t terms, components;
} SplineHead;

#define EXPONENT_MOST 24

/* e of the step 2^-e that is at most `step`, coarser where a number would not fit 16 bits. */
static int step_exponent(float step, float most) {
    int exponent = 0;
    frexpf(step, &exponent); /* step = m 2^exponent, m in [0.5, 1) */
    int e = 1 - exponent;
    e = e < 0 ? 0 : e > EXPONENT_MOST ? EXPONENT_MOST : e;
    while (e > 0 && most > ldexpf(32767, -e)) e--;
    return e;
}

/* The largest number of a component. */
static float largest(const float *numbers, int terms, int components, int component) {
    float most = 0;
    for (int t = 0; t < terms; t++)
        for (int i = 0; i < PANEL_SPLINE_NUMBERS; i++)
            most = fmaxf(most, fabsf(numbers[number_at(components, t, component) + (size_t)i]));
    return most;
}

/* Bytes that every number of a block needs, 0 when all are less than half a step. */
static int block_width(const float *numbers, float scale) {
    float most = 0;
    for (int i = 0; i < PANEL_SPLINE_NUMBERS; i++)
        most = fmaxf(most, fabsf(rintf(numbers[i] * scale)));
    return most == 0 ? 0 : most <= 127 ? 1 : 2;
}

static void put_block(unsigned char **to, const float *numbers, float scale, int width) {
    for (int i = 0; i < PANEL_SPLINE_NUMBERS; i++) {
        float value = fminf(32767, fmaxf(-32767, rintf(numbers[i] * scale)));
        int16_t wide = (int16_t)value;
        int8_t narrow = (int8_t)(width == 1 ? wide : 0);
        memcpy(*to, width == 2 ? (const void *)&wide : (const void *)&narrow, (size_t)width);
        *to += width;
    }
}

size_t panel_spline_pack(const PanelSplineNumbers *in, Arena *arena, const void **bytes) {
    const uint8_t *term = in->term;
    const float *numbers = in->numbers, *step = in->step;
    int terms = in->terms, components = in->components;
    unsigned char *out =
        ARENA_NEW(arena, unsigned char,
                  16 + (size_t)components +
                      (size_t)terms * (1 + (size_t)components * (1 + 2 * PANEL_SPLINE_NUMBERS)));
    unsigned char *at = out + sizeof(SplineHead);
    int exponent[256], width[PANEL_SPLINE_TERMS_MAX][256], kept[PANEL_SPLINE_TERMS_MAX];
    int count = 0;
    for (int k = 0; k < components; k++) {
        exponent[k] = step_exponent(step[k], largest(numbers, terms, components, k));
        *at++ = (unsigned char)exponent[k];
    }
    for (int t = 0; t < terms; t++) {
        bool is_present = false;
        for (int k = 0; k < components; k++) {
            width[t][k] =
                block_width(numbers + number_at(components, t, k), ldexpf(1, exponent[k]));
            is_present |= width[t][k] > 0;
        }
        if (!is_present) continue;
        kept[count++] = t;
        *at++ = term[t];
    }
    *(SplineHead *)out = (SplineHead){(uint8_t)count, (uint8_t)components};
    for (int i = 0; i < count; i++)
        for (int k = 0; k < components; k++) *at++ = (unsigned char)width[kept[i]][k];
    for (int pass = 2; pass >= 1; pass--)
        for (int i = 0; i < count; i++)
            for (int k = 0; k < components; k++)
                if (width[kept[i]][k] == pass)
                    put_block(&at, numbers + number_at(components, kept[i], k),
                              ldexpf(1, exponent[k]), pass);
    *bytes = out;
    return (size_t)(at - out);
}

static bool terms_rise(const uint8_t *term, int terms) {
    for (int t = 0; t < terms; t++)
        if (term[t] >= PANEL_SPLINE_TERMS_MAX || (t && term[t] <= term[t - 1])) return false;
    return true;
}

static void get_block(const unsigned char *from, float scale, int width, float *numbers) {
    for (int i = 0; i < PANEL_SPLINE_NUMBERS; i++) {
        int16_t wide = width == 1 ? (int8_t)from[i] : 0;
        if (width == 2) memcpy(&wide, from + 2 * i, sizeof wide);
        numbers[i] = scale * (float)wide;
    }
}

bool panel_spline_open(const void *bytes, size_t size, int components, Arena *arena,
                       PanelSpline *out, size_t *used) {
    const unsigned char *at = bytes, *end = at + size;
    if (size < 2 || at[1] != components || at[0] > PANEL_SPLINE_TERMS_MAX) return false;
    int terms = at[0];
    const uint8_t *exponent = at + 2, *term = exponent + components, *width = term + terms;
    size_t blocks = (size_t)(terms * components);
    at = width + blocks;
    if (2 + (size_t)components + (size_t)terms + blocks > size || !terms_rise(term, terms))
        return false;
    for (int k = 0; k < components; k++)
        if (exponent[k] > EXPONENT_MOST) return false;
    float *numbers = ARENA_NEW(arena, float, PANEL_SPLINE_NUMBERS *blocks + 1);
    for (int pass = 2; pass >= 1; pass--)
        for (size_t b = 0; b < blocks; b++) {
            if (width[b] > 2) return false;
            if (width[b] != pass) continue;
            if ((size_t)(end - at) < (size_t)pass * PANEL_SPLINE_NUMBERS) return false;
            get_block(at, ldexpf(1, -exponent[b % (size_t)components]), pass,
                      numbers + PANEL_SPLINE_NUMBERS * b);
            at += pass * PANEL_SPLINE_NUMBERS;
        }
    panel_spline_expand(term, terms, components, numbers, arena, out);
    *used = (size_t)(at - (const unsigned char *)bytes);
    return true;
}
