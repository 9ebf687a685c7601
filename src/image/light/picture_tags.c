/* SPDX-License-Identifier: Apache-2.0 */
#include "image/light/picture_tags.h"

#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>
#include <zlib.h>

#include "base/count.h"
#include "image/tiff_directory.h"

#define PROFILE_BYTES_MAX ((size_t)16 << 20)

/* What was found, as it stands in the file. */
typedef struct Statements {
    int orientation;
    const unsigned char *icc;
    size_t icc_size;
    bool has_icc, has_srgb, has_primaries, has_cicp;
    double gamma, chromaticities[8];
    unsigned char cicp[4]; /* ITU-T H.273, of a DPX what means the same */
    int dpx_transfer;      /* 0: none is stated */
    Arena *arena;
} Statements;

static uint32_t u32_at(const unsigned char *p) {
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

/* ---- where it stands --------------------------------------------------------------------- */

static void read_exif(const unsigned char *bytes, size_t size, Statements *out) {
    if (size < 8 || (memcmp(bytes, "II", 2) != 0 && memcmp(bytes, "MM", 2) != 0)) return;
    Tiff exif = tiff_open(bytes, size);
    TiffList list = tiff_list(&exif, 274);
    uint64_t found = list.count ? tiff_number(&exif, list.at, list.width) : 1;
    out->orientation = found >= 1 && found <= 8 ? (int)found : 1;
}

/* A name, a zero, the method 0, and the profile packed by zlib. */
static void read_packed_profile(const unsigned char *data, size_t size, Statements *out) {
    const unsigned char *end = memchr(data, 0, size < 80 ? size : 80);
    out->has_icc = true;
    if (!end || (size_t)(end - data) + 2 > size) return;
    for (size_t room = 1 << 16; room <= PROFILE_BYTES_MAX; room *= 4) {
        Arena kept = *out->arena;
        unsigned char *profile = ARENA_NEW(&kept, unsigned char, room);
        uLongf length = room;
        size_t head = (size_t)(end - data) + 2;
        int done = uncompress(profile, &length, data + head, (uLong)(size - head));
        if (done == Z_BUF_ERROR && length == room) continue;
        if (done != Z_OK) return;
        *out->arena = kept;
        out->icc = profile;
        out->icc_size = length;
        return;
    }
}

/* Order in the file: white, red, green, blue. */
static void read_primaries(const unsigned char *data, Statements *out) {
    out->has_primaries = true;
    for (int i = 0; i < 8; i++)
        out->chromaticities[(i + 6) % 8] = u32_at(data + 4 * (size_t)i) / 1e5;
}

static void read_png(const unsigned char *bytes, size_t size, Statements *out) {
    for (size_t at = 8; at + 12 <= size;) {
        size_t length = u32_at(bytes + at);
        const unsigned char *name = bytes + at + 4, *data = name + 4;
        if (length > size - at - 12) return;
        if (!memcmp(name, "iCCP", 4)) read_packed_profile(data, length, out);
        if (!memcmp(name, "eXIf", 4)) read_exif(data, length, out);
        if (!memcmp(name, "sRGB", 4)) out->has_srgb = true;
        if (!memcmp(name, "gAMA", 4) && length == 4) out->gamma = u32_at(data) / 1e5;
        if (!memcmp(name, "cHRM", 4) && length == 32) read_primaries(data, out);
        if (!memcmp(name, "cICP", 4) && length == 4) {
            out->has_cicp = true;
            memcpy(out->cicp, data, 4);
        }
        at += 12 + length;
    }
}

/* Parts of a profile, each with its number: they are taken in the file's order. */
static void add_profile(const unsigned char *data, size_t size, Statements *out) {
    unsigned char *whole = ARENA_NEW(out->arena, unsigned char, out->icc_size + size);
    if (out->icc_size) memcpy(whole, out->icc, out->icc_size);
    memcpy(whole + out->icc_size, data, size);
    out->has_icc = true;
    out->icc = whole;
    out->icc_size += size;
}

/* Segments up to the first pixels (ITU-T T.81, B.1.1). */
static void read_jpeg(const unsigned char *bytes, size_t size, Statements *out) {
    for (size_t at = 2; at + 4 <= size && bytes[at] == 0xff;) {
        unsigned marker = bytes[at + 1];
        size_t length = (size_t)bytes[at + 2] << 8 | bytes[at + 3];
        const unsigned char *data = bytes + at + 4;
        if (marker == 0xff) {
            at++;
            continue;
        }
        if (marker == 0xda || length < 2 || length > size - at - 2) return;
        if (marker == 0xe1 && length > 8 && !memcmp(data, "Exif\0", 6))
            read_exif(data + 6, length - 8, out);
        if (marker == 0xe2 && length > 16 && !memcmp(data, "ICC_PROFILE", 12))
            add_profile(data + 14, length - 16, out);
        at += 2 + length;
    }
}

static void read_tiff(const unsigned char *bytes, size_t size, Statements *out) {
    Tiff tiff = tiff_open(bytes, size);
    TiffList profile = tiff_list(&tiff, 34675);
    read_exif(bytes, size, out);
    if (!profile.count) return;
    out->has_icc = true;
    if (profile.at > size || profile.count > size - profile.at) return;
    out->icc = bytes + profile.at;
    out->icc_size = (size_t)profile.count;
}

/* RIFF: a name, a length with the low byte first, data that ends evenly. */
static void read_webp(const unsigned char *bytes, size_t size, Statements *out) {
    for (size_t at = 12; at + 8 <= size;) {
        size_t length = __builtin_bswap32(u32_at(bytes + at + 4));
        const unsigned char *data = bytes + at + 8;
        if (length > size - at - 8) return;
        if (!memcmp(bytes + at, "ICCP", 4)) add_profile(data, length, out);
        if (!memcmp(bytes + at, "EXIF", 4)) {
            bool has_head = length > 6 && !memcmp(data, "Exif\0", 6);
            read_exif(data + (has_head ? 6 : 0), length - (has_head ? 6 : 0), out);
        }
        at += 8 + length + length % 2;
    }
}

/* SMPTE 268M, of the first element: what its codes are of light, and of which primaries (bytes
 * 801, 802). 0, 4 and 255 state nothing. */
static void read_dpx(const unsigned char *bytes, size_t size, Statements *out) {
    static const unsigned char PRIMARIES[] = {[6] = 1, [7] = 5, [8] = 6, [9] = 6, [10] = 5};
    static const unsigned char CURVES[] = {
        [2] = 8, [5] = 1, [6] = 1, [7] = 6, [8] = 6, [9] = 6, [10] = 6};
    unsigned transfer = size > 803 ? bytes[801] : 0, primaries = size > 803 ? bytes[802] : 0;
    if (transfer == 0 || transfer == 4 || transfer == 255) return;
    out->dpx_transfer = (int)transfer;
    out->has_cicp = true;
    out->cicp[0] = primaries < sizeof PRIMARIES && PRIMARIES[primaries] ? PRIMARIES[primaries] : 1;
    bool is_read = transfer < sizeof CURVES && CURVES[transfer];
    out->cicp[1] = is_read ? CURVES[transfer] : (unsigned char)(128 | transfer); /* no code's */
    out->cicp[2] = 0;
    out->cicp[3] = 1;
}

static Statements find_statements(const unsigned char *bytes, size_t size, Arena *arena) {
    Statements out = {.orientation = 1, .arena = arena};
    if (size < 16) return out;
    if (!memcmp(bytes, "\x89PNG\r\n\x1a\n", 8)) read_png(bytes, size, &out);
    if (!memcmp(bytes, "\xff\xd8\xff", 3)) read_jpeg(bytes, size, &out);
    if (!memcmp(bytes, "SDPX", 4) || !memcmp(bytes, "XPDS", 4)) read_dpx(bytes, size, &out);
    if (!memcmp(bytes, "II", 2) || !memcmp(bytes, "MM", 2)) read_tiff(bytes, size, &out);
    bool is_webp = !memcmp(bytes, "RIFF", 4) && !memcmp(bytes + 8, "WEBP", 4);
    if (is_webp) read_webp(bytes, size, &out);
    return out;
}

/* ---- what it means ----------------------------------------------------------------------- */

/* ITU-T H.273, table 2; x, y of red, green, blue, white. */
static const struct CicpPrimaries {
    int code;
    double chromaticities[8];
} CICP_PRIMARIES[] = {
    {1, {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290}},
    {4, {0.67, 0.33, 0.21, 0.71, 0.14, 0.08, 0.310, 0.316}},
    {5, {0.64, 0.33, 0.29, 0.60, 0.15, 0.06, 0.3127, 0.3290}},
    {6, {0.630, 0.340, 0.310, 0.595, 0.155, 0.070, 0.3127, 0.3290}},
    {7, {0.630, 0.340, 0.310, 0.595, 0.155, 0.070, 0.3127, 0.3290}},
    {8, {0.681, 0.319, 0.243, 0.692, 0.145, 0.049, 0.310, 0.316}},
    {9, {0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290}},
    {10, {1, 0, 0, 1, 0, 0, 1.0 / 3, 1.0 / 3}},
    {11, {0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.314, 0.351}},
    {12, {0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290}},
    {22, {0.630, 0.340, 0.295, 0.605, 0.155, 0.077, 0.3127, 0.3290}},
};

/* Table 3, as a display shows it: television's curves by BT.1886 with a black of 0. NaN: a
 * curve that is not read; 0: sRGB's. */
static double cicp_gamma(int code) {
    switch (code) {
    case 1:
    case 6:
    case 14:
    case 15: return 2.4;
    case 4: return 2.2;
    case 5: return 2.8;
    case 8: return 1;
    case 13: return 0;
    default: return (double)NAN;
    }
}

/* Codes of red, green and blue themselves, over their full range. */
static bool cicp_light(const unsigned char cicp[4], IccLight *out) {
    double gamma = cicp_gamma(cicp[1]);
    if (isnan(gamma) || cicp[2] != 0 || cicp[3] != 1) return false;
    for (int i = 0; i < COUNT_OF(CICP_PRIMARIES); i++)
        if (CICP_PRIMARIES[i].code == cicp[0]) {
            *out = icc_light_of(CICP_PRIMARIES[i].chromaticities, gamma);
            return true;
        }
    return false;
}

#define USUAL_GAMMA (1 / 2.2) /* of a PNG for sRGB; libpng takes 5 % for none */

/* What gAMA and cHRM mean; without one of them it is sRGB's. */
static bool plain_light(const Statements *in, IccLight *out) {
    bool is_usual = in->gamma == 0 || fabs(in->gamma / USUAL_GAMMA - 1) < 0.05;
    const double *xy = in->has_primaries ? in->chromaticities : REC709_CHROMATICITIES;
    if (!(in->gamma >= 0) || !chromaticities_are_usable(xy)) return false;
    *out = icc_light_of(xy, is_usual ? 0 : 1 / in->gamma);
    return true;
}

static const char *dpx_words(int transfer, Arena *arena) {
    static const char *const NAMES[] = {
        "", " (printing density)", " (linear)", " (logarithmic)", "", "", " (BT.709)"};
    return arena_format(arena, "DPX transfer %d%s", transfer,
                        transfer < COUNT_OF(NAMES) ? NAMES[transfer] : "");
}

PictureTags picture_tags_read(const void *bytes, size_t size, Arena *arena) {
    const Statements in = find_statements(bytes, size, arena);
    const unsigned char *c = in.cicp;
    PictureTags out = {
        .orientation = in.orientation, .words = "", .is_srgb = true, .is_known = true};
    if (in.has_cicp) {
        out.is_known = cicp_light(c, &out.light);
        out.words = in.dpx_transfer
                        ? dpx_words(in.dpx_transfer, arena)
                        : arena_format(arena, "cICP %d/%d/%d/%d", c[0], c[1], c[2], c[3]);
    } else if (in.has_icc) {
        out.is_known = in.icc && icc_read(in.icc, in.icc_size, &out.light);
        out.words = arena_format(arena, "an ICC profile (%s)",
                                 in.icc ? icc_name(in.icc, in.icc_size, arena) : "damaged");
    } else if (!in.has_srgb && (in.gamma != 0 || in.has_primaries)) {
        out.is_known = plain_light(&in, &out.light);
        out.words = arena_format(arena, "%s%s%s", in.gamma != 0 ? "gAMA" : "",
                                 in.gamma != 0 && in.has_primaries ? " and " : "",
                                 in.has_primaries ? "cHRM" : "");
    } else {
        return out;
    }
    out.digest = in.has_cicp ? XXH3_64bits(c, 4) + 1
                 : in.icc    ? XXH3_64bits(in.icc, in.icc_size) + 1
                             : 1;
    out.is_srgb = out.is_known && icc_light_is_srgb(&out.light);
    if (out.is_srgb) out.words = "";
    return out;
}

const char *picture_tags_text(const PictureTags *tags, Arena *arena) {
    if (tags->orientation == 1) return tags->words;
    return arena_format(arena, "orientation %d%s%s", tags->orientation, tags->words[0] ? ", " : "",
                        tags->words);
}

/* ---- orientation ------------------------------------------------------------------------- */

/* Exif, table 6: which edges of the picture the first row and column are. From 5 on rows are
 * columns. */
Image picture_upright(const Image *image, int orientation, Arena *arena) {
    bool turns = orientation >= 5;
    bool from_right = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
    bool from_below = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
    size_t pixel = image->format == IMAGE_RGBA8 ? 4 : image->format == IMAGE_RGBA16 ? 8 : 16;
    Image out = *image;
    if (orientation == 1) return out;
    out.width = turns ? image->height : image->width;
    out.height = turns ? image->width : image->height;
    size_t count = (size_t)out.width * (size_t)out.height;
    char *to = arena_alloc(arena, pixel, 16, count);
    for (size_t i = 0; i < count; i++) {
        size_t row = i / (size_t)image->width, column = i % (size_t)image->width;
        size_t x = turns ? row : column, y = turns ? column : row;
        if (from_right) x = (size_t)out.width - 1 - x;
        if (from_below) y = (size_t)out.height - 1 - y;
        memcpy(to + pixel * (y * (size_t)out.width + x), (const char *)image->pixels + pixel * i,
               pixel);
    }
    out.pixels = to;
    return out;
}
