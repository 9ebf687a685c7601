/* SPDX-License-Identifier: Apache-2.0 */
#include "image/image.h"

#include <ctype.h>
#include <stddef.h>
#include <string.h>
#include <strings.h>
#include <webp/decode.h>
#include <zlib.h>

#include "base/count.h"
#include "base/error.h"
#include "base/file.h"
#include "image/frame.h"
#include "image/picture_pages.h"
#include "image/plain/plain_jpeg.h"
#include "image/plain/plain_png.h"
#include "image/radiance_file.h"
#include "image/tiff_directory.h"
#include "openexr/exr_file.h"
#include "openimageio/image_file.h"

enum {
    MAX_SIDE = 65536,     /* texels along one side */
    MAX_PIXELS = 1 << 28, /* 16384 x 16384 */
};
#define MAX_FILE_BYTES ((size_t)1 << 30)

/* A format is recognised by its first bytes; the name's ending decides only where there are
 * none. */
typedef struct Signature {
    const char *format, *bytes;
    size_t offset, length;
} Signature;

static const Signature SIGNATURES[] = {
    {"png", "\x89PNG\r\n\x1a\n", 0, 8},
    {"jpeg", "\xff\xd8\xff", 0, 3},
    {"openexr", "\x76\x2f\x31\x01", 0, 4},
    {"hdr", "#?", 0, 2},
    {"tiff", "II*\0", 0, 4},
    {"tiff", "MM\0*", 0, 4},
    {"tiff", "II+\0", 0, 4},
    {"tiff", "MM\0+", 0, 4},
    {"webp", "WEBP", 8, 4},
    {"bmp", "BM", 0, 2},
    {"gif", "GIF8", 0, 4},
    {"dpx", "SDPX", 0, 4},
    {"dpx", "XPDS", 0, 4},
    {"pnm", "P5", 0, 2},
    {"pnm", "P6", 0, 2},
};

static size_t u16_at(const unsigned char *p) {
    return p[0] | (size_t)p[1] << 8;
}

/* TGA has no mark before its pixels: a mark at its end, or a head that can be one and asks for no
 * more than the file holds. */
static bool is_targa(const unsigned char *bytes, size_t size) {
    if (size >= 44 && !memcmp(bytes + size - 18, "TRUEVISION-XFILE.", 18)) return true;
    if (size < 19 || (bytes[2] & ~0x0b) || bytes[17] >= 0x40) return false;
    unsigned kind = bytes[2] & 3u, depth = bytes[16]; /* by a table, colours, greys */
    size_t row = u16_at(bytes + 12) * ((depth + 7) / 8), rows = u16_at(bytes + 14);
    size_t table = u16_at(bytes + 5) * ((bytes[7] + 7u) / 8);
    bool has_depth =
        kind == 2 ? depth == 15 || depth == 16 || depth == 24 || depth == 32 : depth == 8;
    return kind && has_depth && bytes[1] == (kind == 1) && (kind == 1) == (table > 0) && row &&
           rows && 18 + bytes[0] + table + (bytes[2] & 8 ? 1 : row * rows) <= size;
}

static const char *format_of(const unsigned char *bytes, size_t size, const char *name) {
    for (int i = 0; i < COUNT_OF(SIGNATURES); i++) {
        const Signature *s = &SIGNATURES[i];
        if (size >= s->offset + s->length && !memcmp(bytes + s->offset, s->bytes, s->length))
            return s->format;
    }
    size_t length = strlen(name);
    bool is_named = length > 4 && !strcasecmp(name + length - 4, ".tga");
    return is_named || is_targa(bytes, size) ? "targa" : NULL;
}

static uint32_t u32_at(const unsigned char *p) {
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

/* A part that the picture can do without (its name begins with a small letter) may be. */
static bool is_damaged(const unsigned char *type, size_t length) {
    for (int i = 0; i < 4; i++)
        if (!isalpha(type[i])) return true;
    return isupper(type[0]) && crc32(0, type, (uInt)(length + 4)) != u32_at(type + 4 + length);
}

/* The first part is a head that PNG allows (ISO/IEC 15948, 11.2.2): a size, and a depth that
 * its kind of colour may have. */
static bool is_png_head(const unsigned char *part) {
    static const unsigned char depths[] = {
        1 | 2 | 4 | 8 | 16, 0, 8 | 16, 1 | 2 | 4 | 8, 8 | 16, 0, 8 | 16};
    const unsigned char *head = part + 8;
    unsigned depth = head[8], colour = head[9];
    return u32_at(part) == 13 && !memcmp(part + 4, "IHDR", 4) && u32_at(head) && u32_at(head + 4) &&
           colour < sizeof depths && (depths[colour] & depth) && !(depth & (depth - 1)) &&
           !head[10] && !head[11] && head[12] < 2;
}

/* The library stops at the last row, so that a picture cut behind it would pass as whole; and
 * it prints what is damaged to stderr as well. */
static bool check_png(const unsigned char *bytes, size_t size, Error *err) {
    for (size_t at = 8; size - at >= 12;) {
        size_t length = u32_at(bytes + at);
        if (length > size - at - 12) break;
        const unsigned char *type = bytes + at + 4; /* and the data, then their CRC */
        if (is_damaged(type, length))
            return error_set(err, ERROR_INPUT,
                             "damaged png picture: wrong checksum of the part at byte %zu", at);
        if (at == 8 && (size < 33 || !is_png_head(bytes + at)))
            return error_set(err, ERROR_INPUT,
                             "damaged png picture: its head has no size, or "
                             "a depth or way of packing that PNG does not have");
        if (!memcmp(type, "IEND", 4)) return true;
        at += 12 + length;
    }
    return error_set(err, ERROR_INPUT, "damaged png picture: cut off, the end is missing");
}

/* A decoder fills what is missing of a JPEG with grey. The end marker must come behind the
 * last start of pixels; neither occurs inside pixels (ITU-T T.81, B.1.1.5). */
static bool check_jpeg(const unsigned char *bytes, size_t size, Error *err) {
    for (size_t at = size; at >= 2; at--) {
        if (bytes[at - 2] != 0xff) continue;
        if (bytes[at - 1] == 0xd9) return true;
        if (bytes[at - 1] == 0xda) break;
    }
    return error_set(err, ERROR_INPUT, "damaged jpeg picture: cut off, the end is missing");
}

/* The library takes memory for as many bytes of user data as the header states (SMPTE 268M, at
 * byte 32, in the byte order of the first four; all ones: not stated). */
static bool check_dpx(const unsigned char *bytes, size_t size, Error *err) {
    enum { USER_BYTES_AT = 32 };
    if (size < USER_BYTES_AT + 4)
        return error_set(err, ERROR_INPUT, "damaged dpx picture: cut off in its header");
    uint32_t user = u32_at(bytes + USER_BYTES_AT);
    if (bytes[0] == 'X') user = __builtin_bswap32(user);
    return user == UINT32_MAX || user <= size ||
           error_set(err, ERROR_INPUT,
                     "damaged dpx picture: %u bytes of user data are stated, "
                     "the file has %zu",
                     user, size);
}

/* The library takes strips and tiles behind the end of the bytes for black (TIFF 6.0, sections
 * 2, 8 and 15). */
static bool check_tiff(const unsigned char *bytes, size_t size, Error *err) {
    static const unsigned tags[2][2] = {{273, 279}, {324, 325}}; /* where, how many bytes */
    const Tiff tiff = tiff_open(bytes, size);
    for (int k = 0; k < 2; k++) {
        TiffList where = tiff_list(&tiff, tags[k][0]), length = tiff_list(&tiff, tags[k][1]);
        for (uint64_t i = 0; i < where.count && i < length.count && i < size; i++) {
            uint64_t from = tiff_number(&tiff, where.at + i * where.width, where.width);
            uint64_t part = tiff_number(&tiff, length.at + i * length.width, length.width);
            if (from > size || part > size - from)
                return error_set(err, ERROR_INPUT,
                                 "damaged tiff picture: cut off, pixels are missing");
        }
    }
    return true;
}

/* Refuses damage that the libraries let pass. */
static bool check_whole(const char *format, const void *bytes, size_t size, Error *err) {
    if (!strcmp(format, "png")) return check_png(bytes, size, err);
    if (!strcmp(format, "dpx")) return check_dpx(bytes, size, err);
    if (!strcmp(format, "tiff")) return check_tiff(bytes, size, err);
    return strcmp(format, "jpeg") != 0 || check_jpeg(bytes, size, err);
}

static size_t format_bytes(ImageFormat format) {
    return format == IMAGE_RGBA8 ? 4 : format == IMAGE_RGBA16 ? 8 : 16;
}

/* Refuses a picture before any pixel is decoded: a small file can announce a huge one. */
static bool check_size(int width, int height, size_t pixel_bytes, size_t more_bytes,
                       const Arena *arena, Error *err) {
    if (width < 1 || height < 1)
        return error_set(err, ERROR_INPUT, "%d x %d pixels, at least 1 x 1 required", width,
                         height);
    size_t pixels = (size_t)width * (size_t)height;
    if (width > MAX_SIDE || height > MAX_SIDE || pixels > MAX_PIXELS) {
        return error_set(err, ERROR_INPUT,
                         "%d x %d pixels; at most %d along a side and %d in all are supported",
                         width, height, MAX_SIDE, MAX_PIXELS);
    }
    size_t left = (size_t)(arena->end - arena->next), margin = 1 << 16;
    size_t wanted = pixels * pixel_bytes + more_bytes + margin;
    if (wanted > left) {
        return error_set(err, ERROR_MEMORY, "%d x %d pixels need %zu MB, %zu MB are left", width,
                         height, wanted >> 20, left >> 20);
    }
    return true;
}

/* For one pixel: which of its channels are red, green, blue and alpha; alpha -1 = full. */
typedef struct Swizzle {
    int stride, index[4];
} Swizzle;

static Swizzle swizzle_of(int channels, int alpha) {
    bool grey = channels - (alpha >= 0) < 3;
    return (Swizzle){channels, {0, grey ? 0 : 1, grey ? 0 : 2, alpha}};
}

static void spread_u8(const unsigned char *from, Swizzle s, size_t count, unsigned char *to) {
    for (size_t i = 0; i < count; i++, from += s.stride, to += 4)
        for (int c = 0; c < 4; c++) to[c] = s.index[c] < 0 ? 255 : from[s.index[c]];
}

static void spread_u16(const uint16_t *from, Swizzle s, size_t count, uint16_t *to) {
    for (size_t i = 0; i < count; i++, from += s.stride, to += 4)
        for (int c = 0; c < 4; c++) to[c] = s.index[c] < 0 ? 65535 : from[s.index[c]];
}

static void spread_f32(const float *from, Swizzle s, size_t count, float *to) {
    for (size_t i = 0; i < count; i++, from += s.stride, to += 4)
        for (int c = 0; c < 4; c++) to[c] = s.index[c] < 0 ? 1.0f : from[s.index[c]];
}

static void spread(ImageFormat format, const void *from, Swizzle s, size_t count, void *to) {
    switch (format) {
    case IMAGE_RGBA8: spread_u8(from, s, count, to); break;
    case IMAGE_RGBA16: spread_u16(from, s, count, to); break;
    case IMAGE_RGBA32F: spread_f32(from, s, count, to); break;
    }
}

/* A file in memory. */
typedef struct Encoded {
    const char *format, *name;
    const unsigned char *bytes;
    size_t size;
} Encoded;

/* Whether the file says that its colours are multiplied by alpha: ExtraSamples of a TIFF (6.0,
 * section 18), the attributes type of a TGA 2.0. */
static bool is_associated(const Encoded *file) {
    const unsigned char *end = file->bytes + file->size;
    if (!strcmp(file->format, "tiff")) {
        const Tiff tiff = tiff_open(file->bytes, file->size);
        TiffList kind = tiff_list(&tiff, 338);
        return kind.count && tiff_number(&tiff, kind.at, kind.width) == 1;
    }
    if (strcmp(file->format, "targa") != 0 || file->size < 44 ||
        memcmp(end - 18, "TRUEVISION-XFILE.", 18) != 0)
        return false;
    size_t at = __builtin_bswap32(u32_at(end - 26));
    return at && at + 494 < file->size && file->bytes[at + 494] == 4;
}

/* Colours of codes once more without their alpha, rounded. */
static void straighten_codes(ImageFormat format, size_t count, void *pixels) {
    const double full = format == IMAGE_RGBA8 ? 255 : 65535;
    for (size_t i = 0; i < 4 * count; i++) {
        uint8_t *bytes = pixels;
        uint16_t *words = pixels;
        size_t alpha = i | 3;
        double own = format == IMAGE_RGBA8 ? bytes[i] : words[i];
        double share = (format == IMAGE_RGBA8 ? bytes[alpha] : words[alpha]) / full;
        double code = share > 0 && i != alpha ? fmin(own / share, full) : own;
        if (format == IMAGE_RGBA8) bytes[i] = (uint8_t)(code + 0.5);
        else words[i] = (uint16_t)(code + 0.5);
    }
}

static void straighten(float rgba[4]);

static bool decode_pixels(const Encoded *file, ImageDecoder *decoder, Arena *arena, Image *out,
                          Error *err) {
    static const ImageFormat FORMATS[] = {
        [PIXEL_U8] = IMAGE_RGBA8, [PIXEL_U16] = IMAGE_RGBA16, [PIXEL_F32] = IMAGE_RGBA32F};
    ImageFileInfo info = image_decoder_info(decoder);
    Image image = {info.width, info.height, FORMATS[info.type], NULL};
    size_t bytes = format_bytes(image.format), value = bytes / 4;
    size_t raw_bytes = info.channels == 4 ? 0 : value * (size_t)info.channels;
    if (!check_size(info.width, info.height, bytes + raw_bytes, 0, arena, err)) return false;

    size_t count = (size_t)info.width * (size_t)info.height;
    Arena kept = *arena;
    void *pixels = arena_alloc(&kept, bytes, 16, count);
    Arena scratch = kept;
    void *raw = raw_bytes ? arena_alloc(&scratch, raw_bytes, 16, count) : pixels;
    if (!image_decoder_read(decoder, raw, err)) return false;
    if (raw != pixels)
        spread(image.format, raw, swizzle_of(info.channels, info.alpha_channel), count, pixels);
    if (info.alpha_channel >= 0 && is_associated(file)) {
        if (image.format != IMAGE_RGBA32F) straighten_codes(image.format, count, pixels);
        for (size_t i = 0; i < count && image.format == IMAGE_RGBA32F; i++)
            straighten((float *)pixels + 4 * i);
    }
    *arena = kept;
    image.pixels = pixels;
    *out = image;
    return true;
}

static bool decode_other(const Encoded *file, Arena *arena, Image *out, Error *err) {
    ImageDecoder *decoder;
    char why[PNG_WHY_BYTES];
    double room = (double)(arena->end - arena->next) / 4; /* pixels that fit */
    double most = fmin(MAX_PIXELS, room);
    if (!strcmp(file->format, "png") && !png_is_sound(file->bytes, file->size, most, why))
        return error_set(err, ERROR_INPUT, "damaged png picture: %s", why);
    if (!image_decoder_create(file->format, file->name, file->bytes, file->size, &decoder, err))
        return false;
    bool ok = decode_pixels(file, decoder, arena, out, err);
    image_decoder_destroy(decoder);
    return ok;
}

static bool decode_radiance(const Encoded *file, Arena *arena, Image *out, Error *err) {
    RadianceFile radiance;
    Arena scratch = *arena;
    if (!radiance_open(file->bytes, file->size, file->name, &scratch, &radiance, err)) return false;
    size_t line = 4 * (size_t)radiance.length;
    if (!check_size(radiance.width, radiance.height, 4 * sizeof(float), line, arena, err))
        return false;
    Arena kept = *arena;
    float *rgba = ARENA_NEW(&kept, float, 4 * (size_t)radiance.width * (size_t)radiance.height);
    if (!radiance_read(&radiance, kept, rgba, err)) return false;
    *arena = kept;
    *out = (Image){radiance.width, radiance.height, IMAGE_RGBA32F, rgba};
    return true;
}

/* A PNG or JPEG without the library. */
typedef struct PlainPicture {
    PlainPng png;
    PlainJpeg jpeg;
    int width, height;
    bool is_jpeg;
} PlainPicture;

/* False: it is for the library. */
static bool open_plain(const Encoded *file, PlainPicture *out) {
    PlainPicture made = {.is_jpeg = !strcmp(file->format, "jpeg")};
    if (made.is_jpeg ? !plain_jpeg_open(file->bytes, file->size, &made.jpeg)
                     : strcmp(file->format, "png") != 0 ||
                           !plain_png_open(file->bytes, file->size, &made.png))
        return false;
    made.width = made.is_jpeg ? made.jpeg.width : made.png.width;
    made.height = made.is_jpeg ? made.jpeg.height : made.png.height;
    *out = made;
    return true;
}

static bool decode_plain(const Encoded *file, Arena *arena, Image *out) {
    PlainPicture plain;
    Error ignored;
    if (!open_plain(file, &plain) || !check_size(plain.width, plain.height, 4, 0, arena, &ignored))
        return false;
    Arena kept = *arena;
    uint8_t *pixels = arena_alloc(&kept, 4, 16, (size_t)plain.width * (size_t)plain.height);
    if (plain.is_jpeg ? !plain_jpeg_read(&plain.jpeg, pixels) : !plain_png_read(&plain.png, pixels))
        return false;
    *arena = kept;
    *out = (Image){plain.width, plain.height, IMAGE_RGBA8, pixels};
    return true;
}

/* ---- WebP, lossy and lossless, not animated ---------------------------------------------- */

/* By libwebp: the library for all pictures (openimageio/image_file.h) would multiply colours by
 * alpha and round them, which cannot be undone. */

/* width, height: 1 to 16384 each. Only the file's beginning is looked at. */
static bool webp_size(const void *bytes, size_t size, int *width, int *height, Error *err) {
    WebPBitstreamFeatures found;
    if (WebPGetFeatures(bytes, size, &found) != VP8_STATUS_OK || found.width < 1 ||
        found.height < 1)
        return error_set(err, ERROR_INPUT, "damaged webp picture: its beginning is wrong");
    if (found.has_animation)
        return error_set(err, ERROR_INPUT,
                         "a webp picture that moves; one that stands still "
                         "is required");
    *width = found.width;
    *height = found.height;
    return true;
}

/* rgba: 4 * width * height bytes, from the top, alpha straight. */
static bool webp_read(const void *bytes, size_t size, unsigned char *rgba, Error *err) {
    int width, height;
    if (!webp_size(bytes, size, &width, &height, err)) return false;
    size_t row = 4 * (size_t)width;
    return WebPDecodeRGBAInto(bytes, size, rgba, row * (size_t)height, (int)row) ||
           error_set(err, ERROR_INPUT, "damaged webp picture: its pixels cannot be decoded");
}

static bool decode_webp(const Encoded *file, Arena *arena, Image *out, Error *err) {
    int width, height;
    if (!webp_size(file->bytes, file->size, &width, &height, err) ||
        !check_size(width, height, 4, 0, arena, err))
        return false;
    Arena kept = *arena;
    uint8_t *pixels = arena_alloc(&kept, 4, 16, (size_t)width * (size_t)height);
    if (!webp_read(file->bytes, file->size, pixels, err)) return false;
    *arena = kept;
    *out = (Image){width, height, IMAGE_RGBA8, pixels};
    return true;
}

/* ---- OpenEXR ------------------------------------------------------------------------- */

enum { RED, GREEN, BLUE, ALPHA };

/* The pixels of a file's data window that a picture of its display window shows. */
typedef struct ExrPlanes {
    const ExrPicture *picture;
    float *rgba[4]; /* alpha may be NULL; a grey picture has one plane thrice */
    bool is_xyz;
} ExrPlanes;

static int channel_index(const ExrPicture *picture, const char *name) {
    for (int i = 0; i < picture->channel_count; i++)
        if (!strcmp(picture->channels[i].name, name)) return i;
    return -1;
}

/* Reads R, G, B (or X, Y, Z, or Y) and A only. */
static bool read_planes(ExrReader *reader, Arena *arena, ExrPlanes *out, Error *err) {
    static const char *const NAMES[4] = {"R", "G", "B", "A"}, *const XYZ[3] = {"X", "Y", "Z"};
    const ExrPicture *picture = exr_reader_picture(reader);
    size_t count = (size_t)(picture->data.x1 - picture->data.x0) *
                   (size_t)(picture->data.y1 - picture->data.y0);
    float **planes = ARENA_NEW(arena, float *, picture->channel_count);
    bool grey = channel_index(picture, "R") < 0 && channel_index(picture, "Y") >= 0;
    out->picture = picture;
    out->is_xyz = grey && channel_index(picture, "X") >= 0 && channel_index(picture, "Z") >= 0;
    for (int c = 0; c < 4; c++) {
        const char *name = c == ALPHA || !grey ? NAMES[c] : out->is_xyz ? XYZ[c] : "Y";
        int i = channel_index(picture, name);
        out->rgba[c] = NULL;
        if (i < 0 && c == ALPHA) continue;
        if (i < 0)
            return error_set(err, ERROR_INPUT, "no channel %s; R, G, B or Y are required",
                             NAMES[c]);
        if (!planes[i]) planes[i] = ARENA_NEW(arena, float, count);
        out->rgba[c] = planes[i];
    }
    return exr_reader_read(reader, planes, err);
}

/* OpenEXR's colours are multiplied by alpha; where alpha is 0 they glow and stay. */
static void straighten(float rgba[4]) {
    if (!(rgba[ALPHA] > 0) || rgba[ALPHA] == 1) return;
    for (int c = 0; c < 3; c++) rgba[c] /= rgba[ALPHA];
}

/* to_rec709 may be NULL. What the data window does not reach is black. */
static void place_pixels(const ExrPlanes *from, const ColourMatrix *to_rec709, float *rgba) {
    const ExrWindow data = from->picture->data, display = from->picture->display;
    for (int y = display.y0; y < display.y1; y++) {
        for (int x = display.x0; x < display.x1; x++, rgba += 4) {
            rgba[ALPHA] = 1;
            if (x < data.x0 || x >= data.x1 || y < data.y0 || y >= data.y1) continue;
            size_t at = (size_t)(y - data.y0) * (size_t)(data.x1 - data.x0) + (size_t)(x - data.x0);
            for (int c = 0; c < 4; c++)
                if (from->rgba[c]) rgba[c] = from->rgba[c][at];
            straighten(rgba);
            if (to_rec709) colour_apply(to_rec709, rgba, rgba);
        }
    }
}

static bool decode_exr(ExrReader *reader, Arena *arena, Image *out, Error *err) {
    const ExrPicture *picture = exr_reader_picture(reader);
    ExrWindow w = picture->display, d = picture->data;
    size_t planes = (size_t)(d.x1 - d.x0) * (size_t)(d.y1 - d.y0) * 4 * sizeof(float);
    Image image = {w.x1 - w.x0, w.y1 - w.y0, IMAGE_RGBA32F, NULL};
    if (!check_size(image.width, image.height, 4 * sizeof(float), planes, arena, err)) return false;

    Arena kept = *arena;
    size_t count = (size_t)image.width * (size_t)image.height;
    float *pixels = ARENA_NEW(&kept, float, count * 4);
    Arena scratch = kept;
    ExrPlanes from;
    ColourMatrix matrix;
    if (!read_planes(reader, &scratch, &from, err)) return false;
    bool has_matrix = frame_needs_rec709(picture, &matrix) || from.is_xyz;
    if (from.is_xyz) matrix = rec709_from_primaries(XYZ_CHROMATICITIES);
    place_pixels(&from, has_matrix ? &matrix : NULL, pixels);
    *arena = kept;
    image.pixels = pixels;
    *out = image;
    return true;
}

static bool decode(const Encoded *file, Arena *arena, Image *out, Error *err) {
    ExrReader *reader;
    if (decode_plain(file, arena, out)) return true;
    if (strcmp(file->format, "webp") == 0) return decode_webp(file, arena, out, err);
    if (strcmp(file->format, "hdr") == 0) return decode_radiance(file, arena, out, err);
    if (strcmp(file->format, "openexr") != 0) return decode_other(file, arena, out, err);
    if (!exr_reader_create(file->name, file->bytes, file->size, &reader, err)) return false;
    bool ok = decode_exr(reader, arena, out, err);
    exr_reader_destroy(reader);
    return ok;
}

/* ---- any picture ---------------------------------------------------------------------- */

bool image_read_first(const void *bytes, size_t size, const char *name, Arena *arena, Image *out,
                      Error *err) {
    const Encoded file = {format_of(bytes, size, name), name, bytes, size};
    bool ok;
    if (!file.format) {
        ok = error_set(err, ERROR_INPUT,
                       "not a picture that can be read (PNG, JPEG, OpenEXR, Radiance HDR, "
                       "TIFF, WebP, BMP, TGA, GIF, DPX or PNM)");
    } else {
        ok = check_whole(file.format, bytes, size, err) && decode(&file, arena, out, err);
    }
    return ok || error_in_file(err, name);
}

bool image_read_memory(const void *bytes, size_t size, const char *name, Arena *arena, Image *out,
                       Error *err) {
    return picture_pages_check(bytes, size, name, err) &&
           image_read_first(bytes, size, name, arena, out, err);
}

bool image_read(const char *path, Arena *arena, Image *out, Error *err) {
    Arena file = arena_reserve(MAX_FILE_BYTES + 4096);
    FileBytes bytes;
    bool ok = file_read(path, MAX_FILE_BYTES, &file, &bytes, err) &&
              image_read_memory(bytes.data, bytes.size, path, arena, out, err);
    arena_release(&file);
    return ok;
}
