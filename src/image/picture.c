/* SPDX-License-Identifier: Apache-2.0 */
#include "base/count.h"
#include "image/picture.h"

#include <stdint.h>
#include <string.h>
#include <strings.h>

#include "base/file_write.h"
#include "base/mathf.h"
#include "image/plain/picture_png.h"
#include "openimageio/image_file.h"

typedef struct Ending {
    const char *ending, *format;
    int max_bits;
} Ending;

static const Ending ENDINGS[] = {
    {".png", "png", 16},  {".jpg", "jpeg", 8},   {".jpeg", "jpeg", 8},
    {".tif", "tiff", 16}, {".tiff", "tiff", 16},
};

static const Ending *ending_of(const char *path) {
    const char *ending = path_ending(path);
    for (int i = 0; i < COUNT_OF(ENDINGS); i++)
        if (!strcasecmp(ending, ENDINGS[i].ending)) return &ENDINGS[i];
    return NULL;
}

bool picture_check_name(const char *path, int bits, Error *err) {
    const Ending *ending = ending_of(path);
    if (!ending)
        return error_at(err, ERROR_USAGE, path, "",
                        "a picture's name ends in .png, .jpg, .jpeg, .tif or .tiff");
    if (bits != 8 && bits != 16)
        return error_at(err, ERROR_USAGE, path, "", "%d bits, 8 or 16 are required", bits);
    if (bits > ending->max_bits)
        return error_at(err, ERROR_USAGE, path, "", "%d bits; a JPEG holds 8, PNG and TIFF 16",
                        bits);
    return true;
}

Picture picture_create(int width, int height, Arena *arena) {
    size_t count = (size_t)width * (size_t)height * 3;
    return (Picture){width, height, ARENA_NEW(arena, float, count)};
}

static void *quantised(const Picture *picture, int bits, Arena *arena) {
    size_t count = (size_t)picture->width * (size_t)picture->height * 3;
    uint8_t *u8 = bits == 8 ? ARENA_NEW(arena, uint8_t, count) : NULL;
    uint16_t *u16 = bits == 16 ? ARENA_NEW(arena, uint16_t, count) : NULL;
    for (size_t i = 0; i < count; i++) {
        float code = picture->rgb[i] > 0 ? clampf(picture->rgb[i], 0, 1) : 0.0f;
        if (u8) u8[i] = (uint8_t)(code * 255 + 0.5f);
        else u16[i] = (uint16_t)(code * 65535 + 0.5f);
    }
    return bits == 8 ? (void *)u8 : (void *)u16;
}

/* room: behind the picture's codes. */
static bool encode_png(const ImageToEncode *image, Arena room, Arena *arena, FileBytes *out,
                       Error *err) {
    FileBytes made;
    if (!picture_png_encode(image, &room, &made, err)) return false;
    *out = (FileBytes){arena_keep(arena, made.data, made.size + 1, 1), made.size};
    return true;
}

static bool encode_other(const char *format, const ImageToEncode *image, Arena *arena,
                         FileBytes *out, Error *err) {
    EncodedImage *encoded;
    if (!image_encode(format, image, &encoded, err)) return false;
    size_t size;
    const void *bytes = encoded_image_bytes(encoded, &size);
    unsigned char *copy = ARENA_NEW(arena, unsigned char, size + 1);
    memcpy(copy, bytes, size);
    encoded_image_destroy(encoded);
    *out = (FileBytes){copy, size};
    return true;
}

bool picture_encode(const char *path, const Picture *picture, PictureFile file, Arena *arena,
                    FileBytes *out, Error *err) {
    if (!picture_check_name(path, file.bits, err)) return false;
    const char *format = ending_of(path)->format;
    Arena scratch = *arena;
    ImageToEncode image = {
        .width = picture->width,
        .height = picture->height,
        .channels = 3,
        .type = file.bits == 8 ? PIXEL_U8 : PIXEL_U16,
        .pixels = quantised(picture, file.bits, &scratch),
        .jpeg_quality = !strcmp(format, "jpeg") ? 95 : 0,
        .is_srgb = file.is_srgb,
        .icc_profile = file.icc.bytes,
        .icc_profile_size = file.icc.size,
        .description = file.description,
    };
    bool ok = !strcmp(format, "png") ? encode_png(&image, scratch, arena, out, err)
                                     : encode_other(format, &image, arena, out, err);
    return ok || error_in_file(err, path);
}

bool picture_encode_small(const Picture *picture, Arena *arena, FileBytes *out, const char **kind,
                          Error *err) {
    const PictureFile file = {.bits = 8, .is_srgb = true};
    bool is_jpeg = picture_encode("a.jpg", picture, file, arena, out, err);
    *kind = is_jpeg ? "jpeg" : "png";
    return is_jpeg || picture_encode("a.png", picture, file, arena, out, err);
}

bool picture_write(const char *path, const Picture *picture, PictureFile file, Arena scratch,
                   Error *err) {
    FileBytes bytes;
    return picture_encode(path, picture, file, &scratch, &bytes, err) &&
           file_write(path, bytes.data, bytes.size, err);
}
