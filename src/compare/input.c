/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/input.h"

#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "image/image.h"
#include "image/layer_view.h"
#include "image/srgb.h"

#define MAX_FILE_BYTES ((size_t)4 << 30)

static const char *const ENDINGS[] = {".exr", ".png",  ".jpg", ".jpeg", ".hdr", ".pic", ".tif",
                                      ".tiff", ".webp", ".bmp", ".tga",  ".gif", ".dpx", ".pgm",
                                      ".ppm"};

bool input_has_known_ending(const char *path)
{
    for (size_t i = 0; i < sizeof ENDINGS / sizeof *ENDINGS; i++)
        if (!strcasecmp(path_ending(path), ENDINGS[i])) return true;
    return false;
}

/* ---- light ------------------------------------------------------------------------------- */

bool input_view_light(CompareInput *input, Arena *arena, Error *err)
{
    LayerView view;
    if (!layer_view_find(&input->frame, NULL, arena, &view, err))
        return error_in_file(err, input->name);
    input->light = (Planes){view.width, view.height,
                              {view.planes[0], view.planes[1], view.planes[2]}};
    return true;
}

static bool read_frame(FileBytes bytes, Arena *arena, CompareInput *input, Error *err)
{
    input->kind = INPUT_FRAME;
    input->has_metadata = true;
    return frame_read_memory(bytes.data, bytes.size, input->name, arena, &input->frame,
                             err) &&
           input_view_light(input, arena, err);
}

/* Floats without metadata become a frame of R, G, B, and A where it is not 1 everywhere. */
static bool frame_from_floats(const Image *image, Arena *arena, CompareInput *input, Error *err)
{
    const float *rgba = image->pixels;
    size_t       count = (size_t)image->width * (size_t)image->height;
    bool         has_alpha = false;
    for (size_t i = 0; i < count && !has_alpha; i++) has_alpha = rgba[4 * i + 3] != 1;
    input->kind = INPUT_FRAME;
    input->frame = frame_create(image->width, image->height,
                                  (ExrWindow){0, 0, image->width, image->height}, 4, 0, arena);
    for (size_t c = 0; c < (has_alpha ? 4u : 3u); c++) {
        const char name[2] = {"RGBA"[c], 0};
        float     *plane = frame_add_channel(&input->frame, name, false, arena);
        for (size_t i = 0; i < count; i++) plane[i] = rgba[4 * i + c];
    }
    return input_view_light(input, arena, err);
}

/* ---- pictures ---------------------------------------------------------------------------- */

static float code_at(const Image *image, size_t index)
{
    if (image->format == IMAGE_RGBA8)
        return (float)((const uint8_t *)image->pixels)[index] / 255.0f;
    return (float)((const uint16_t *)image->pixels)[index] / 65535.0f;
}

/* count values of one channel from the first on, as codes and as light. */
static void unpack_8(const uint8_t *packed, size_t count, float *codes, float *light)
{
    float table[256];
    for (int i = 0; i < 256; i++) table[i] = linear_from_srgb((float)i / 255.0f);
    for (size_t i = 0; i < count; i++) {
        codes[i] = (float)packed[4 * i] / 255.0f;
        light[i] = table[packed[4 * i]];
    }
}

static void unpack_16(const uint16_t *packed, size_t count, float *codes, float *light)
{
    for (size_t i = 0; i < count; i++) {
        codes[i] = (float)packed[4 * i] / 65535.0f;
        light[i] = linear_from_srgb(codes[i]);
    }
}

CodeRows input_unpack(const CompareInput *input, int y0, int y1, Arena *arena)
{
    const Image *image = &input->packed;
    size_t       first = (size_t)y0 * (size_t)image->width;
    size_t       count = (size_t)(y1 - y0) * (size_t)image->width;
    CodeRows     rows = {.codes = {image->width, y1 - y0, {NULL}}};
    rows.light = rows.codes;
    for (size_t c = 0; c < 3; c++) {
        float *codes = ARENA_NEW(arena, float, count), *light = ARENA_NEW(arena, float, count);
        if (image->format == IMAGE_RGBA8)
            unpack_8((const uint8_t *)image->pixels + 4 * first + c, count, codes, light);
        else
            unpack_16((const uint16_t *)image->pixels + 4 * first + c, count, codes, light);
        rows.codes.rgb[c] = codes;
        rows.light.rgb[c] = light;
    }
    if (!input->has_alpha) return rows;
    float *alpha = ARENA_NEW(arena, float, count);
    for (size_t i = 0; i < count; i++) alpha[i] = code_at(image, 4 * (first + i) + 3);
    rows.alpha = alpha;
    return rows;
}

static bool has_alpha(const Image *image)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++)
        if (code_at(image, 4 * i + 3) != 1) return true;
    return false;
}

static void read_codes(const Image *image, long whole_pixels, Arena *arena, CompareInput *input)
{
    input->kind = INPUT_PICTURE;
    input->bits = image->format == IMAGE_RGBA8 ? 8 : 16;
    input->packed = *image;
    input->has_alpha = has_alpha(image);
    input->light = input->codes = (Planes){image->width, image->height, {NULL}};
    if ((long)image->width * image->height > (whole_pixels ? whole_pixels : INPUT_WHOLE_PIXELS))
        return;
    CodeRows rows = input_unpack(input, 0, image->height, arena);
    input->codes = rows.codes;
    input->light = rows.light;
    input->alpha = rows.alpha;
}

static bool read_picture(FileBytes bytes, long whole_pixels, Arena *arena, CompareInput *input,
                         Error *err)
{
    Image image;
    if (!image_read_memory(bytes.data, bytes.size, input->name, arena, &image, err))
        return false;
    if (image.format == IMAGE_RGBA32F) return frame_from_floats(&image, arena, input, err);
    read_codes(&image, whole_pixels, arena, input);
    return true;
}

/* ---- both -------------------------------------------------------------------------------- */

bool input_read(const char *path, long whole_pixels, Arena *arena, CompareInput *out,
                Error *err)
{
    static const unsigned char EXR[4] = {0x76, 0x2f, 0x31, 0x01};
    Arena                      file = arena_reserve(MAX_FILE_BYTES + 4096);
    FileBytes                  bytes;
    CompareInput               input = {.name = path};
    bool                       ok = file_read(path, MAX_FILE_BYTES, &file, &bytes, err);
    if (ok && bytes.size >= sizeof EXR && !memcmp(bytes.data, EXR, sizeof EXR))
        ok = read_frame(bytes, arena, &input, err);
    else if (ok)
        ok = read_picture(bytes, whole_pixels, arena, &input, err);
    arena_release(&file);
    if (ok) *out = input;
    return ok;
}

bool input_check_kinds(const CompareInput *reference, const CompareInput *test, Error *err)
{
    if (reference->kind == test->kind) return true;
    const CompareInput *frame = reference->kind == INPUT_FRAME ? reference : test;
    const CompareInput *picture = frame == reference ? test : reference;
    return error_at(err, ERROR_INPUT, picture->name, "",
                    "is a picture of display codes, but %s is light in cd/m2: they have no "
                    "scale in common — compare frame with frame, or develop the frame first: "
                    "parhelion develop %s -o FRAME.png",
                    frame->name, frame->name);
}
