#include "image/image.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "openimageio/image_file.h"

enum {
    MAX_SIDE = 65536,           /* texels along one side */
    MAX_PIXELS = 1 << 28,       /* 16384 x 16384 */
    MAX_FILE_BYTES = 1 << 30
};

/* A format is told by its first bytes; the name's ending decides only where there are none. */
typedef struct Signature {
    const char *format, *bytes;
    size_t      offset, length;
} Signature;

static const Signature SIGNATURES[] = {
    {"png", "\x89PNG\r\n\x1a\n", 0, 8}, {"jpeg", "\xff\xd8\xff", 0, 3},
    {"openexr", "\x76\x2f\x31\x01", 0, 4}, {"hdr", "#?", 0, 2},
    {"tiff", "II*\0", 0, 4}, {"tiff", "MM\0*", 0, 4},
    {"tiff", "II+\0", 0, 4}, {"tiff", "MM\0+", 0, 4},
    {"webp", "WEBP", 8, 4}, {"bmp", "BM", 0, 2},
    {"gif", "GIF8", 0, 4}, {"dpx", "SDPX", 0, 4},
    {"dpx", "XPDS", 0, 4}, {"pnm", "P5", 0, 2},
    {"pnm", "P6", 0, 2},
};

static const char *format_of(const unsigned char *bytes, size_t size, const char *name)
{
    for (size_t i = 0; i < sizeof SIGNATURES / sizeof *SIGNATURES; i++) {
        const Signature *s = &SIGNATURES[i];
        if (size >= s->offset + s->length && !memcmp(bytes + s->offset, s->bytes, s->length))
            return s->format;
    }
    size_t length = strlen(name);
    return length > 4 && !strcmp(name + length - 4, ".tga") ? "targa" : NULL;
}

/* The library stops at the last row; a picture cut behind it would pass as whole. */
static bool png_is_whole(const unsigned char *bytes, size_t size)
{
    size_t at = 8;
    while (size - at >= 12) {
        size_t length = (size_t)bytes[at] << 24 | (size_t)bytes[at + 1] << 16 |
                        (size_t)bytes[at + 2] << 8 | bytes[at + 3];
        if (length > size - at - 12) return false;
        if (!memcmp(bytes + at + 4, "IEND", 4)) return true;
        at += 12 + length;
    }
    return false;
}

static size_t format_bytes(ImageFormat format)
{
    return format == IMAGE_RGBA8 ? 4 : format == IMAGE_RGBA16 ? 8 : 16;
}

/* Refuses a picture before any pixel is decoded: a small file can announce a huge one. */
static bool check_size(int width, int height, size_t pixel_bytes, const Arena *arena,
                       Error *err)
{
    if (width < 1 || height < 1)
        return error_set(err, ERROR_INPUT, "%d x %d pixels, at least 1 x 1 wanted", width,
                         height);
    size_t pixels = (size_t)width * (size_t)height;
    if (width > MAX_SIDE || height > MAX_SIDE || pixels > MAX_PIXELS) {
        return error_set(err, ERROR_INPUT,
                         "%d x %d pixels; at most %d along a side and %d in all are supported",
                         width, height, MAX_SIDE, MAX_PIXELS);
    }
    size_t left = (size_t)(arena->end - arena->next);
    if (pixels * pixel_bytes > left) {
        return error_set(err, ERROR_MEMORY, "%d x %d pixels need %zu MB, %zu MB are left",
                         width, height, pixels * pixel_bytes >> 20, left >> 20);
    }
    return true;
}

/* For one pixel: which of its channels are red, green, blue and alpha; alpha -1 = full. */
typedef struct Swizzle {
    int stride, index[4];
} Swizzle;

static Swizzle swizzle_of(int channels, int alpha)
{
    bool grey = channels - (alpha >= 0) < 3;
    return (Swizzle){channels, {0, grey ? 0 : 1, grey ? 0 : 2, alpha}};
}

static void spread_u8(const unsigned char *from, Swizzle s, size_t count, unsigned char *to)
{
    for (size_t i = 0; i < count; i++, from += s.stride, to += 4)
        for (int c = 0; c < 4; c++) to[c] = s.index[c] < 0 ? 255 : from[s.index[c]];
}

static void spread_u16(const uint16_t *from, Swizzle s, size_t count, uint16_t *to)
{
    for (size_t i = 0; i < count; i++, from += s.stride, to += 4)
        for (int c = 0; c < 4; c++) to[c] = s.index[c] < 0 ? 65535 : from[s.index[c]];
}

static void spread_f32(const float *from, Swizzle s, size_t count, float *to)
{
    for (size_t i = 0; i < count; i++, from += s.stride, to += 4)
        for (int c = 0; c < 4; c++) to[c] = s.index[c] < 0 ? 1.0f : from[s.index[c]];
}

static void spread(ImageFormat format, const void *from, Swizzle s, size_t count, void *to)
{
    switch (format) {
    case IMAGE_RGBA8: spread_u8(from, s, count, to); break;
    case IMAGE_RGBA16: spread_u16(from, s, count, to); break;
    case IMAGE_RGBA32F: spread_f32(from, s, count, to); break;
    }
}

static bool decode_pixels(ImageDecoder *decoder, Arena *arena, Image *out, Error *err)
{
    static const ImageFormat FORMATS[] = {[PIXEL_U8] = IMAGE_RGBA8, [PIXEL_U16] = IMAGE_RGBA16,
                                          [PIXEL_F32] = IMAGE_RGBA32F};
    ImageFileInfo info = image_decoder_info(decoder);
    Image  image = {info.width, info.height, FORMATS[info.type], NULL};
    size_t bytes = format_bytes(image.format), value = bytes / 4;
    size_t raw_bytes = info.channels == 4 ? 0 : value * (size_t)info.channels;
    if (!check_size(info.width, info.height, bytes + raw_bytes, arena, err)) return false;

    size_t count = (size_t)info.width * (size_t)info.height;
    Arena  kept = *arena;
    void  *pixels = arena_alloc(&kept, bytes, 16, count);
    Arena  scratch = kept;
    void  *raw = raw_bytes ? arena_alloc(&scratch, raw_bytes, 16, count) : pixels;
    if (!image_decoder_read(decoder, raw, err)) return false;
    if (raw != pixels)
        spread(image.format, raw, swizzle_of(info.channels, info.alpha_channel), count, pixels);
    *arena = kept;
    image.pixels = pixels;
    *out = image;
    return true;
}

static bool decode(const char *format, const void *bytes, size_t size, const char *name,
                   Arena *arena, Image *out, Error *err)
{
    ImageDecoder *decoder;
    if (!image_decoder_create(format, name, bytes, size, &decoder, err)) return false;
    bool ok = decode_pixels(decoder, arena, out, err);
    image_decoder_destroy(decoder);
    return ok;
}

bool image_read_memory(const void *bytes, size_t size, const char *name, Arena *arena,
                       Image *out, Error *err)
{
    const char *format = format_of(bytes, size, name);
    bool        ok;
    if (!format) {
        ok = error_set(err, ERROR_INPUT,
                       "not a picture that can be read (PNG, JPEG, OpenEXR, Radiance HDR, "
                       "TIFF, WebP, BMP, TGA, GIF, DPX or PNM)");
    } else if (!strcmp(format, "png") && !png_is_whole(bytes, size)) {
        ok = error_set(err, ERROR_INPUT, "damaged png picture: cut off, the end is missing");
    } else {
        ok = decode(format, bytes, size, name, arena, out, err);
    }
    return ok || error_in_file(err, name);
}

static bool read_file(const char *path, unsigned char *bytes, size_t size, Error *err)
{
    FILE *file = fopen(path, "rb");
    if (!file) return error_set(err, ERROR_INPUT, "cannot be opened: %s", strerror(errno));
    bool ok = fread(bytes, 1, size, file) == size;
    if (!ok) error_set(err, ERROR_INPUT, "cannot be read: %s", strerror(errno));
    fclose(file);
    return ok;
}

bool image_read(const char *path, Arena *arena, Image *out, Error *err)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return error_at(err, ERROR_INPUT, path, "", "cannot be opened: %s", strerror(errno));
    if (!S_ISREG(status.st_mode))
        return error_at(err, ERROR_INPUT, path, "", "not a regular file");
    if (status.st_size > MAX_FILE_BYTES)
        return error_at(err, ERROR_INPUT, path, "", "%lld bytes, at most %d are supported",
                        (long long)status.st_size, MAX_FILE_BYTES);
    size_t size = (size_t)status.st_size;
    Arena  file = arena_reserve(size + 1);
    unsigned char *bytes = ARENA_NEW(&file, unsigned char, size);
    bool ok = (read_file(path, bytes, size, err) || error_in_file(err, path)) &&
              image_read_memory(bytes, size, path, arena, out, err);
    arena_release(&file);
    return ok;
}
