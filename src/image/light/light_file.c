/* SPDX-License-Identifier: Apache-2.0 */
#include "image/light/light_file.h"

#include <string.h>

#include "base/count.h"
#include "image/picture_pages.h"
#include "image/radiance_file.h"

#define MAX_FILE_BYTES ((size_t)4 << 30)

static bool is_openexr(const void *bytes, size_t size) {
    return size >= 4 && !memcmp(bytes, "\x76\x2f\x31\x01", 4);
}

bool light_file_recognise(const void *bytes, size_t size) {
    return is_openexr(bytes, size) || radiance_recognise(bytes, size);
}

/* ---- OpenEXR ----------------------------------------------------------------------------- */

/* Attributes that name a colour space, which only its own program knows for certain. */
static void warn_of_colour_space(const FrameImage *frame, const char *name, Problems *problems) {
    static const char *const keys[] = {"oiio:ColorSpace", "colorInteropID"};
    static const char *const ours[] = {
        "", "linear", "Linear", "lin_rec709", "lin_rec709_scene", "scene_linear", "lin_srgb"};
    for (int i = 0; i < COUNT_OF(keys); i++) {
        const char *text = frame_string(frame, keys[i]);
        bool is_ours = !text || frame_attribute(frame, "parhelion:chromaticities");
        for (int k = 0; k < COUNT_OF(ours) && !is_ours; k++) is_ours = !strcmp(text, ours[k]);
        if (!is_ours)
            problems_add(problems, SEVERITY_WARNING, name, keys[i],
                         "'%.60s' is not read: without other chromaticities the light is taken "
                         "for linear Rec.709",
                         text);
    }
}

static bool read_exr(FileBytes bytes, const char *name, Arena *arena, Problems *problems,
                     LightFile *out, Error *err) {
    if (!frame_read_memory(bytes.data, bytes.size, name, arena, &out->frame, err)) return false;
    const ExrAttribute *white = frame_attribute(&out->frame, "parhelion:whiteLuminance");
    out->unit_cd_m2 = white ? white->values[0] : 1;
    if (out->frame.more_parts)
        problems_add(problems, SEVERITY_WARNING, name, "",
                     "has %d parts: the first one alone is read", out->frame.more_parts + 1);
    if (frame_attribute(&out->frame, "multiView"))
        problems_add(problems, SEVERITY_WARNING, name, "multiView",
                     "has several views: R, G and B are the first one's, the others are layers");
    warn_of_colour_space(&out->frame, name, problems);
    return true;
}

/* ---- others ------------------------------------------------------------------------------ */

static bool has_alpha(const Image *image) {
    const float *rgba = image->pixels;
    size_t count = (size_t)image->width * (size_t)image->height, i = 0;
    while (i < count && rgba[4 * i + 3] == 1) i++;
    return i < count;
}

/* scale and rec709 (may be NULL) take what is stored to cd/m2 of Rec.709. A is there where it
 * is not 1 everywhere. */
static FrameImage frame_of(const Image *image, const double scale[3], const ColourMatrix *rec709,
                           Arena *arena) {
    const ExrWindow window = {0, 0, image->width, image->height};
    FrameImage frame = frame_create(image->width, image->height, window, 4, 1, arena);
    const float *rgba = image->pixels;
    float *plane[4];
    int channels = has_alpha(image) ? 4 : 3;
    for (int c = 0; c < channels; c++)
        plane[c] = frame_add_channel(&frame, (const char[2]){"RGBA"[c], 0}, false, arena);
    for (size_t i = 0; i < frame_pixel_count(&frame); i++, rgba += 4) {
        float light[4] = {0, 0, 0, rgba[3]};
        for (int c = 0; c < 3; c++) light[c] = (float)((double)rgba[c] * scale[c]);
        if (rec709) colour_apply(rec709, light, light);
        for (int c = 0; c < channels; c++) plane[c][i] = light[c];
    }
    return frame;
}

/* The decoded picture stays where it is: the frame's planes follow it. */
static bool read_radiance(FileBytes bytes, const char *name, Arena *arena, LightFile *out,
                          Error *err) {
    RadianceFile file;
    Image image;
    if (!radiance_open(bytes.data, bytes.size, name, arena, &file, err) ||
        !image_read_memory(bytes.data, bytes.size, name, arena, &image, err))
        return false;
    out->format = LIGHT_FILE_RADIANCE;
    out->frame = frame_of(&image, file.scale, file.has_matrix ? &file.rec709 : NULL, arena);
    out->unit_cd_m2 = file.unit_cd_m2;
    if (file.view) frame_set_string(&out->frame, "VIEW", file.view, arena);
    return true;
}

LightFile light_file_of_floats(const Image *image, Arena *arena) {
    static const double ones[3] = {1, 1, 1};
    return (LightFile){LIGHT_FILE_FLOATS, frame_of(image, ones, NULL, arena), 1};
}

static bool is_no_light(const char *name, size_t size, Error *err) {
    return error_at(err, ERROR_INPUT, name, "",
                    "%s, required: an OpenEXR file or a Radiance picture (.hdr)",
                    size ? "is neither by its first bytes" : "is empty");
}

static bool read_floats(FileBytes bytes, const char *name, Arena *arena, LightFile *out,
                        Error *err) {
    Image image;
    Error why;
    if (!image_read_first(bytes.data, bytes.size, name, arena, &image, &why))
        return is_no_light(name, bytes.size, err);
    if (image.format != IMAGE_RGBA32F)
        return error_at(err, ERROR_INPUT, name, "",
                        "holds display codes, required: linear light — an OpenEXR or Radiance "
                        "HDR picture");
    if (!picture_pages_check(bytes.data, bytes.size, name, err)) return false;
    *out = light_file_of_floats(&image, arena);
    return true;
}

/* ---- any --------------------------------------------------------------------------------- */

bool light_file_read_memory(FileBytes bytes, const char *name, Arena *arena, Problems *problems,
                            LightFile *out, Error *err) {
    LightFile made = {LIGHT_FILE_OPENEXR, {.channel_count = 0}, 1};
    bool ok;
    if (is_openexr(bytes.data, bytes.size)) ok = read_exr(bytes, name, arena, problems, &made, err);
    else if (radiance_recognise(bytes.data, bytes.size))
        ok = read_radiance(bytes, name, arena, &made, err);
    else ok = read_floats(bytes, name, arena, &made, err);
    if (ok) *out = made;
    return ok;
}

bool light_file_read(const char *path, Arena *arena, Problems *problems, LightFile *out,
                     Error *err) {
    Arena file = arena_reserve(MAX_FILE_BYTES + 4096);
    FileBytes bytes;
    bool ok = file_read(path, MAX_FILE_BYTES, &file, &bytes, err) &&
              light_file_read_memory(bytes, path, arena, problems, out, err);
    arena_release(&file);
    return ok;
}
