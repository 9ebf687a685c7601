/* SPDX-License-Identifier: Apache-2.0 */
#include "image/light/light_picture.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "image/layer_view.h"
#include "image/light/light_file.h"
#include "openexr/exr_cube.h"

/* ---- cube maps --------------------------------------------------------------------------- */

enum { ACROSS = 4 }; /* places of a pixel along a side whose mean it is */

/* Of the parts of a pixel, each in proportion to its solid angle. */
static void mean_over_pixel(const Image *cube, int x, int y, int width, float rgba[4]) {
    const float *from = cube->pixels;
    double sum[4] = {0, 0, 0, 0};
    for (int i = 0; i < ACROSS * ACROSS; i++) {
        double azimuth = 2 * PI * (0.5 - (x + (i % ACROSS + 0.5) / ACROSS) / width);
        double zenith = 2 * PI * (y + (i / ACROSS + 0.5) / ACROSS) / width;
        double sine = sin_d(zenith);
        double d[3] = {sine * sin_d(azimuth), cos_d(zenith), sine * cos_d(azimuth)};
        size_t at = 4 * exr_cube_pixel(d, cube->width);
        for (int c = 0; c < 3; c++) sum[c] += sine * (double)from[at + (size_t)c];
        sum[3] += sine;
    }
    for (int c = 0; c < 4; c++) rgba[c] = (float)(sum[c] / sum[3]);
}

static bool unfold_cube(const char *name, Arena *arena, Image *image, Error *err) {
    Image out = {4 * image->width, 2 * image->width, IMAGE_RGBA32F, NULL};
    if (image->height != 6 * image->width || image->width > 8192)
        return error_at(err, ERROR_INPUT, name, "envmap",
                        "is a cube map of %dx%d pixels, required: six square faces of at most "
                        "8192 below each other",
                        image->width, image->height);
    float *rgba = ARENA_NEW(arena, float, 4 * (size_t)out.width * (size_t)out.height);
    for (int y = 0; y < out.height; y++)
        for (int x = 0; x < out.width; x++)
            mean_over_pixel(image, x, y, out.width,
                            rgba + 4 * ((size_t)y * (size_t)out.width + (size_t)x));
    out.pixels = rgba;
    *image = out;
    return true;
}

/* ---- any --------------------------------------------------------------------------------- */

static bool has_text(const FrameImage *frame, const char *name, const char *text) {
    const ExrAttribute *a = frame_attribute(frame, name);
    return a && a->kind == EXR_OTHER && !strcmp(a->text, text);
}

/* Over the display window; what is not covered is black. */
static bool take_pixels(const FrameImage *frame, const char *name, Arena *arena, Image *out,
                        Error *err) {
    LayerView view;
    const ExrWindow w = frame->display, d = frame->data;
    if (!layer_view_find(frame, NULL, arena, &view, err)) return error_in_file(err, name);
    size_t count = (size_t)view.width * (size_t)view.height;
    float *rgba = ARENA_NEW(arena, float, 4 * count);
    for (size_t i = 0; i < count; i++) {
        int x = w.x0 + (int)(i % (size_t)view.width), y = w.y0 + (int)(i / (size_t)view.width);
        bool has = x >= d.x0 && x < d.x1 && y >= d.y0 && y < d.y1;
        for (size_t c = 0; c < 3; c++) rgba[4 * i + c] = has ? view.planes[c][i] : 0;
        rgba[4 * i + 3] = 1;
    }
    *out = (Image){view.width, view.height, IMAGE_RGBA32F, rgba};
    return true;
}

static void clean_pixels(const char *name, const Image *image, Problems *problems) {
    float *values = (float *)image->pixels;
    size_t count = (size_t)image->width * (size_t)image->height, negative = 0, broken = 0;
    for (size_t i = 0; i < 4 * count; i++) {
        if (values[i] >= 0 && isfinite(values[i])) continue;
        if (isfinite(values[i])) negative++;
        else broken++;
        values[i] = 0;
    }
    if (negative)
        problems_add(problems, SEVERITY_WARNING, name, "", "%zu negative values count as 0",
                     negative);
    if (broken)
        problems_add(problems, SEVERITY_WARNING, name, "",
                     "%zu values that are not finite count as 0", broken);
}

bool light_picture_read(FileBytes bytes, const char *name, Arena *arena, Problems *problems,
                        LightPicture *out, Error *err) {
    LightFile file;
    Image image;
    if (!light_file_read_memory(bytes, name, arena, problems, &file, err) ||
        !take_pixels(&file.frame, name, arena, &image, err))
        return false;
    clean_pixels(name, &image, problems);
    if (has_text(&file.frame, "envmap", "envmap 01") && !unfold_cube(name, arena, &image, err))
        return false;
    if (image.width != 2 * image.height)
        problems_add(problems, SEVERITY_WARNING, name, "",
                     "has %dx%d pixels; an equirectangular picture is twice as wide as high",
                     image.width, image.height);
    if (frame_string(&file.frame, "VIEW"))
        problems_add(problems, SEVERITY_WARNING, name, "VIEW",
                     "'%.60s' is the view of a camera; the picture is taken for an "
                     "equirectangular one of all surroundings",
                     frame_string(&file.frame, "VIEW"));
    *out = (LightPicture){image, file.unit_cd_m2};
    return true;
}
