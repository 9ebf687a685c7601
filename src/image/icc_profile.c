/* SPDX-License-Identifier: Apache-2.0 */
#include "image/icc_profile.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "image/colour.h"

enum { HEADER_BYTES = 128, TAG_COUNT = 10, MAX_BYTES = 1400 };

static const double D50[3] = {0.9642, 1.0, 0.8249}; /* ICC.1, 7.2.16 */

/* Cone responses of XYZ (Lam 1985, as ICC.1 annex E has it). */
static const ColourMatrix BRADFORD = {
    {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};

typedef struct ProfileWriter {
    unsigned char *bytes;
    size_t size;
    int tags;
} ProfileWriter;

static void put_u16(ProfileWriter *w, unsigned value) {
    w->bytes[w->size++] = (unsigned char)(value >> 8);
    w->bytes[w->size++] = (unsigned char)value;
}

static void put_u32(ProfileWriter *w, uint32_t value) {
    put_u16(w, value >> 16);
    put_u16(w, value & 0xffff);
}

static void put_name(ProfileWriter *w, const char *four) {
    memcpy(w->bytes + w->size, four, 4);
    w->size += 4;
}

/* s15Fixed16Number */
static void put_fixed(ProfileWriter *w, double value) {
    put_u32(w, (uint32_t)(int32_t)floor(value * 65536 + 0.5));
}

static void put_header(ProfileWriter *w) {
    put_u32(w, 0); /* the size, set last */
    put_u32(w, 0);
    put_u32(w, 0x04300000);
    put_name(w, "mntr");
    put_name(w, "RGB ");
    put_name(w, "XYZ ");
    for (int i = 0; i < 6; i++) put_u16(w, i == 0 ? 2026 : i < 3); /* a fixed date */
    put_name(w, "acsp");
    w->size = 68;
    for (int c = 0; c < 3; c++) put_fixed(w, D50[c]);
    w->size = HEADER_BYTES;
    put_u32(w, TAG_COUNT);
    w->size += TAG_COUNT * 12;
}

/* An entry of the tag table for data from `start` to here, and the padding behind them. */
static void end_tag(ProfileWriter *w, const char *name, size_t start) {
    ProfileWriter entry = {w->bytes, HEADER_BYTES + 4 + (size_t)w->tags++ * 12, 0};
    put_name(&entry, name);
    put_u32(&entry, (uint32_t)start);
    put_u32(&entry, (uint32_t)(w->size - start));
    w->size = (w->size + 3) / 4 * 4;
}

static void put_text(ProfileWriter *w, const char *name, const char *text) {
    size_t start = w->size, length = strlen(text);
    put_name(w, "mluc");
    put_u32(w, 0);
    put_u32(w, 1);
    put_u32(w, 12);
    put_name(w, "enUS");
    put_u32(w, (uint32_t)(2 * length));
    put_u32(w, 28);
    for (size_t i = 0; i < length; i++) put_u16(w, (unsigned char)text[i]);
    end_tag(w, name, start);
}

static void put_xyz(ProfileWriter *w, const char *name, double x, double y, double z) {
    size_t start = w->size;
    put_name(w, "XYZ ");
    put_u32(w, 0);
    put_fixed(w, x);
    put_fixed(w, y);
    put_fixed(w, z);
    end_tag(w, name, start);
}

static void put_adaptation(ProfileWriter *w, const ColourMatrix *matrix) {
    size_t start = w->size;
    put_name(w, "sf32");
    put_u32(w, 0);
    for (int i = 0; i < 9; i++) put_fixed(w, matrix->m[i / 3][i % 3]);
    end_tag(w, "chad", start);
}

/* parametricCurveType: one curve that all three tags point to. */
static void put_curves(ProfileWriter *w, IccCurve curve) {
    static const double SRGB[5] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
    static const char *const NAMES[3] = {"rTRC", "gTRC", "bTRC"};
    size_t start = w->size, end;
    put_name(w, "para");
    put_u32(w, 0);
    put_u16(w, curve == ICC_CURVE_SRGB ? 3 : 0);
    put_u16(w, 0);
    for (int i = 0; i < (curve == ICC_CURVE_SRGB ? 5 : 1); i++) put_fixed(w, SRGB[i]);
    end = w->size;
    for (int c = 0; c < 3; c++) {
        w->size = end;
        end_tag(w, NAMES[c], start);
    }
}

/* Bradford: the cone responses of one white are scaled to those of D50. */
static ColourMatrix adaptation_to_d50(const double white[3]) {
    ColourMatrix scale = {{{0}}}, back = colour_inverse(&BRADFORD);
    for (int i = 0; i < 3; i++) {
        double from = 0, to = 0;
        for (int k = 0; k < 3; k++) {
            from += BRADFORD.m[i][k] * white[k];
            to += BRADFORD.m[i][k] * D50[k];
        }
        scale.m[i][i] = to / from;
    }
    ColourMatrix scaled = colour_product(&scale, &BRADFORD);
    return colour_product(&back, &scaled);
}

ColourMatrix icc_d50_from_primaries(const double c[8]) {
    const double white[3] = {c[6] / c[7], 1, (1 - c[6] - c[7]) / c[7]};
    ColourMatrix adaptation = adaptation_to_d50(white), xyz = xyz_from_primaries(c);
    return colour_product(&adaptation, &xyz);
}

IccProfile icc_profile_create(const double c[8], IccCurve curve, const char *description,
                              Arena *arena) {
    static const char *const NAMES[3] = {"rXYZ", "gXYZ", "bXYZ"};
    ProfileWriter w = {ARENA_NEW(arena, unsigned char, MAX_BYTES), 0, 0};
    const double white[3] = {c[6] / c[7], 1, (1 - c[6] - c[7]) / c[7]};
    ColourMatrix adaptation = adaptation_to_d50(white), primaries = icc_d50_from_primaries(c);
    put_header(&w);
    put_text(&w, "desc", description);
    put_text(&w, "cprt", "No copyright, use freely");
    put_xyz(&w, "wtpt", D50[0], D50[1], D50[2]);
    put_adaptation(&w, &adaptation);
    for (int k = 0; k < 3; k++)
        put_xyz(&w, NAMES[k], primaries.m[0][k], primaries.m[1][k], primaries.m[2][k]);
    put_curves(&w, curve);
    ProfileWriter start = {w.bytes, 0, 0};
    put_u32(&start, (uint32_t)w.size);
    return (IccProfile){w.bytes, w.size};
}
