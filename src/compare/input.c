/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/input.h"

#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "image/image.h"
#include "image/layer_view.h"
#include "image/srgb.h"

#define MAX_FILE_BYTES ((size_t)4 << 30)

static const char *const ENDINGS[] = {".exr", ".png", ".jpg",  ".jpeg", ".hdr",
                                      ".pic", ".tif", ".tiff", ".webp", ".bmp",
                                      ".tga", ".gif", ".dpx",  ".pgm",  ".ppm"};

bool input_has_known_ending(const char *path) {
    for (size_t i = 0; i < sizeof ENDINGS / sizeof *ENDINGS; i++)
        if (!strcasecmp(path_ending(path), ENDINGS[i])) return true;
    return false;
}

/* ---- light ------------------------------------------------------------------------------- */

bool input_view_light(CompareInput *input, Arena *arena, Error *err) {
    LayerView view;
    if (!layer_view_find(&input->frame, NULL, arena, &view, err))
        return error_in_file(err, input->name);
    input->light =
        (Planes){view.width, view.height, {view.planes[0], view.planes[1], view.planes[2]}};
    return true;
}

static bool read_parts(FileBytes bytes, Arena *arena, CompareInput *input, Error *err) {
    ExrReader *reader;
    bool ok = true;
    if (!input->frame.more_parts) return true;
    if (!exr_reader_create(input->name, bytes.data, bytes.size, &reader, err))
        return error_in_file(err, input->name);
    input->parts = ARENA_NEW(arena, ExrPart, input->frame.more_parts);
    for (int i = 0; i < input->frame.more_parts && ok; i++) {
        ExrPart *part = &input->parts[i];
        ok = exr_reader_part(reader, i, part, err);
        if (ok) part->name = arena_string(arena, part->name, strlen(part->name));
    }
    exr_reader_destroy(reader);
    return ok || error_in_file(err, input->name);
}

static bool take_light(const LightFile *file, Arena *arena, CompareInput *input, Error *err) {
    input->kind = INPUT_FRAME;
    input->file = file->format;
    input->frame = file->frame;
    return input_view_light(input, arena, err);
}

static bool read_frame(FileBytes bytes, Arena *arena, CompareInput *input, Error *err) {
    LightFile file;
    return light_file_read_memory(bytes, input->name, arena, &input->problems, &file, err) &&
           take_light(&file, arena, input, err) && read_parts(bytes, arena, input, err);
}

/* ---- pictures ---------------------------------------------------------------------------- */

static unsigned raw_at(const Image *image, size_t index) {
    return image->format == IMAGE_RGBA8 ? ((const uint8_t *)image->pixels)[index]
                                        : ((const uint16_t *)image->pixels)[index];
}

static float most_code(const Image *image) {
    return image->format == IMAGE_RGBA8 ? 255.0f : 65535.0f;
}

/* Negative codes for negative light, which other primaries can have. */
static float extended_srgb(float light) {
    return light < 0 ? -srgb_from_linear(-light) : srgb_from_linear(light);
}

/* Codes that are sRGB's stay as they are. */
static void unpack_pixel(const CompareInput *input, size_t at, float codes[3], float light[3]) {
    const Image *image = &input->packed;
    bool is_srgb = input->tags.is_srgb || !input->tags.is_known;
    for (size_t c = 0; c < 3; c++) {
        unsigned raw = raw_at(image, at + c);
        codes[c] = (float)raw / most_code(image);
        light[c] = input->lights[c][raw];
    }
    if (is_srgb) return;
    colour_apply(&input->tags.light.rec709, light, light);
    for (int c = 0; c < 3; c++) codes[c] = extended_srgb(light[c]);
}

CodeRows input_unpack(const CompareInput *input, int y0, int y1, Arena *arena) {
    const Image *image = &input->packed;
    size_t first = (size_t)y0 * (size_t)image->width;
    size_t count = (size_t)(y1 - y0) * (size_t)image->width;
    CodeRows rows = {.codes = {image->width, y1 - y0, {NULL}}};
    float *planes[6], *alpha = input->has_alpha ? ARENA_NEW(arena, float, count) : NULL;
    rows.light = rows.codes;
    rows.alpha = alpha;
    for (int k = 0; k < 6; k++) planes[k] = ARENA_NEW(arena, float, count);
    for (int c = 0; c < 3; c++) {
        rows.codes.rgb[c] = planes[c];
        rows.light.rgb[c] = planes[3 + c];
    }
    for (size_t i = 0; i < count; i++) {
        float values[6];
        unpack_pixel(input, 4 * (first + i), values, values + 3);
        for (int k = 0; k < 6; k++) planes[k][i] = values[k];
        if (alpha) alpha[i] = (float)raw_at(image, 4 * (first + i) + 3) / most_code(image);
    }
    return rows;
}

static bool has_alpha(const Image *image) {
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++)
        if ((float)raw_at(image, 4 * i + 3) != most_code(image)) return true;
    return false;
}

/* The light of each code. */
static void set_lights(Arena *arena, CompareInput *input) {
    int count = input->bits == 8 ? 256 : 65536;
    bool is_srgb = input->tags.is_srgb || !input->tags.is_known;
    for (int c = 0; c < 3; c++) {
        float *table = ARENA_NEW(arena, float, count);
        for (int i = 0; i < count; i++)
            table[i] = is_srgb
                           ? linear_from_srgb((float)i / (float)(count - 1))
                           : (float)code_curve_at(&input->tags.light.curve[c], i / (count - 1.0));
        input->lights[c] = table;
    }
}

static void read_codes(const Image *image, long whole_pixels, Arena *arena, CompareInput *input) {
    input->kind = INPUT_PICTURE;
    input->bits = image->format == IMAGE_RGBA8 ? 8 : 16;
    input->packed = picture_upright(image, input->tags.orientation, arena);
    image = &input->packed;
    set_lights(arena, input);
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
                         Error *err) {
    Image image;
    if (!image_read_first(bytes.data, bytes.size, input->name, arena, &image, err)) return false;
    input->pages = picture_pages(bytes.data, bytes.size);
    if (image.format == IMAGE_RGBA32F) {
        LightFile file = light_file_of_floats(&image, arena);
        return take_light(&file, arena, input, err);
    }
    input->tags = picture_tags_read(bytes.data, bytes.size, arena);
    read_codes(&image, whole_pixels, arena, input);
    return true;
}

/* ---- both -------------------------------------------------------------------------------- */

bool input_read(const char *path, long whole_pixels, Arena *arena, CompareInput *out, Error *err) {
    Arena file = arena_reserve(MAX_FILE_BYTES + 4096);
    FileBytes bytes;
    CompareInput input = {.name = path, .problems = problems_start(arena)};
    bool ok = file_read(path, MAX_FILE_BYTES, &file, &bytes, err);
    if (ok && light_file_recognise(bytes.data, bytes.size))
        ok = read_frame(bytes, arena, &input, err);
    else if (ok) ok = read_picture(bytes, whole_pixels, arena, &input, err);
    arena_release(&file);
    if (ok) *out = input;
    return ok;
}

bool input_check_kinds(const CompareInput *reference, const CompareInput *test, Error *err) {
    if (reference->kind == test->kind) return true;
    const CompareInput *frame = reference->kind == INPUT_FRAME ? reference : test;
    const CompareInput *picture = frame == reference ? test : reference;
    return error_at(err, ERROR_INPUT, picture->name, "",
                    "is a picture of display codes, but %s is light in cd/m2: they have no "
                    "scale in common — compare frame with frame, or develop the frame first: "
                    "parhelion develop %s -o FRAME.png",
                    frame->name, frame->name);
}
