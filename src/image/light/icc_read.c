/* SPDX-License-Identifier: Apache-2.0 */
#include "image/light/icc_read.h"

#include <math.h>
#include <string.h>

#include "image/icc_profile.h"
#include "image/srgb.h"

enum { TAGS_AT = 128, TAGS_MOST = 256 };

static uint32_t number(const unsigned char *at, int width) {
    uint32_t value = 0;
    for (int i = 0; i < width; i++) value = value << 8 | at[i];
    return value;
}

/* s15Fixed16Number */
static double fixed(const unsigned char *at) {
    return (double)(int32_t)number(at, 4) / 65536;
}

/* One tag's data, of at least `least` bytes; NULL: it has none such. */
typedef struct IccData {
    const unsigned char *at;
    size_t size;
} IccData;

static IccData find(const unsigned char *bytes, size_t size, const char *name, size_t least) {
    uint32_t count = size < TAGS_AT + 4 ? 0 : number(bytes + TAGS_AT, 4);
    for (uint32_t i = 0; i < count && i < TAGS_MOST; i++) {
        size_t at = TAGS_AT + 4 + 12 * (size_t)i;
        if (at + 12 > size) break;
        uint32_t from = number(bytes + at + 4, 4), length = number(bytes + at + 8, 4);
        if (memcmp(bytes + at, name, 4) != 0 || from > size || length > size - from) continue;
        return length < least ? (IccData){NULL, 0} : (IccData){bytes + from, length};
    }
    return (IccData){NULL, 0};
}

/* ---- curves ------------------------------------------------------------------------------ */

static const CodeCurve SRGB_CURVE = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045,
                                     0,   0,         NULL,          0};

static CodeCurve power(double gamma) {
    return (CodeCurve){.gamma = gamma, .a = 1};
}

double code_curve_at(const CodeCurve *curve, double code) {
    if (!curve->table) {
        double base = curve->a * code + curve->b;
        if (code < curve->d) return curve->c * code + curve->f;
        return (base > 0 ? pow(base, curve->gamma) : 0) + curve->e;
    }
    double place = code * (curve->count - 1);
    uint32_t at = place < curve->count - 2 ? (uint32_t)place : curve->count - 2;
    double low = number(curve->table + 2 * (size_t)at, 2);
    double high = number(curve->table + 2 * (size_t)at + 2, 2);
    return (low + (place - at) * (high - low)) / 65535;
}

/* curveType: no number, gamma, or a table. */
static bool read_table(IccData data, CodeCurve *out) {
    uint32_t count = number(data.at + 8, 4);
    if (count > (data.size - 12) / 2) return false;
    *out = power(count == 1 ? number(data.at + 12, 2) / 256.0 : 1);
    if (count < 2) return true;
    out->table = data.at + 12;
    out->count = count;
    return true;
}

/* parametricCurveType, the five functions of the standard's table 68: which number is which of
 * gamma, a, b, c, d, e, f. */
static bool read_function(IccData data, CodeCurve *out) {
    static const int counts[5] = {1, 3, 4, 5, 7};
    unsigned kind = number(data.at + 8, 2);
    double p[7] = {0};
    if (kind > 4 || data.size < 12 + 4 * (size_t)counts[kind]) return false;
    for (int i = 0; i < counts[kind]; i++) p[i] = fixed(data.at + 12 + 4 * (size_t)i);
    *out = power(p[0]);
    if (kind == 0) return true;
    out->a = p[1];
    out->b = p[2];
    if (kind == 1 || kind == 2) {
        out->d = -p[2] / p[1];
        out->e = out->f = kind == 2 ? p[3] : 0;
    } else {
        out->c = p[3];
        out->d = p[4];
        out->e = p[5];
        out->f = p[6];
    }
    return true;
}

static bool read_curve(const unsigned char *bytes, size_t size, const char *name, CodeCurve *out) {
    IccData data = find(bytes, size, name, 12);
    if (!data.at) return false;
    if (!memcmp(data.at, "curv", 4)) return read_table(data, out);
    return !memcmp(data.at, "para", 4) && read_function(data, out);
}

/* ---- profiles ---------------------------------------------------------------------------- */

/* From XYZ of D50 to Rec.709: the way back of its own adapted primaries. */
static ColourMatrix rec709_from_d50(const ColourMatrix *d50) {
    ColourMatrix own = icc_d50_from_primaries(REC709_CHROMATICITIES);
    ColourMatrix back = colour_inverse(&own);
    return colour_product(&back, d50);
}

static bool read_matrix(const unsigned char *bytes, size_t size, ColourMatrix *out) {
    static const char *const names[3] = {"rXYZ", "gXYZ", "bXYZ"};
    ColourMatrix d50;
    for (int k = 0; k < 3; k++) {
        IccData data = find(bytes, size, names[k], 20);
        if (!data.at) return false;
        for (size_t i = 0; i < 3; i++) d50.m[i][k] = fixed(data.at + 8 + 4 * i);
    }
    *out = rec709_from_d50(&d50);
    return true;
}

bool icc_read(const unsigned char *bytes, size_t size, IccLight *out) {
    static const char *const names[3] = {"rTRC", "gTRC", "bTRC"};
    IccLight made = {.rec709 = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    bool is_grey = size > TAGS_AT && !memcmp(bytes + 16, "GRAY", 4);
    if (size <= TAGS_AT || (!is_grey && memcmp(bytes + 16, "RGB ", 4) != 0)) return false;
    if (!is_grey && !read_matrix(bytes, size, &made.rec709)) return false;
    for (int c = 0; c < 3; c++)
        if (!read_curve(bytes, size, is_grey ? "kTRC" : names[c], &made.curve[c])) return false;
    *out = made;
    return true;
}

/* Bytes that can be printed, of text in 8 or 16 bits; the rest is left out. */
static const char *plain_text(IccData data, size_t from, Arena *arena) {
    char *text = ARENA_NEW(arena, char, 64);
    size_t length = 0;
    for (size_t i = from; i < data.size && length < 60; i++)
        if (data.at[i] >= ' ' && data.at[i] < 127) text[length++] = (char)data.at[i];
    return text;
}

/* textDescriptionType: a count, and as many letters. multiLocalizedUnicodeType: of its first
 * record the length and place of a text in 16 bits. */
const char *icc_name(const unsigned char *bytes, size_t size, Arena *arena) {
    IccData data = find(bytes, size, "desc", 12);
    if (!data.at) return "without a name";
    if (!memcmp(data.at, "desc", 4)) {
        uint32_t count = number(data.at + 8, 4);
        if (count < data.size - 12) data.size = 12 + (size_t)count;
        return plain_text(data, 12, arena);
    }
    if (data.size < 28) return "without a name";
    uint32_t length = number(data.at + 20, 4), from = number(data.at + 24, 4);
    if (from > data.size) from = 28;
    if (length < data.size - from) data.size = from + (size_t)length;
    return plain_text(data, from, arena);
}

IccLight icc_light_of(const double chromaticities[8], double gamma) {
    ColourMatrix d50 = icc_d50_from_primaries(chromaticities);
    IccLight out = {.rec709 = rec709_from_d50(&d50)};
    for (int c = 0; c < 3; c++) out.curve[c] = gamma > 0 ? power(gamma) : SRGB_CURVE;
    return out;
}

#define MATRIX_ROUNDING 0.002
#define CURVE_ROUNDING 0.001 /* a quarter of a step of 8 bits */

bool icc_light_is_srgb(const IccLight *light) {
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            if (!(fabs(light->rec709.m[i][k] - (i == k)) <= MATRIX_ROUNDING)) return false;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i <= 32; i++) {
            double found = code_curve_at(&light->curve[c], i / 32.0);
            if (!(fabs(found - linear_from_srgb_d(i / 32.0)) <= CURVE_ROUNDING)) return false;
        }
    return true;
}
