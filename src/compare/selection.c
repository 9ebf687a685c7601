/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/selection.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "measure/display_part.h"
#include "image/image.h"
#include "image/layer_view.h"

#define MASK_BYTES_MAX ((size_t)1 << 30)

/* The pixels that the input has, as a window with its origin at the display window's. */
static ExrWindow extent_of(const CompareInput *input) {
    ExrWindow whole = {0, 0, input->light.width, input->light.height};
    if (input->kind != INPUT_FRAME) return whole;
    const ExrWindow w = input->frame.display, d = input->frame.data;
    return (ExrWindow){d.x0 > w.x0 ? d.x0 - w.x0 : 0, d.y0 > w.y0 ? d.y0 - w.y0 : 0,
                       d.x1 < w.x1 ? d.x1 - w.x0 : whole.x1, d.y1 < w.y1 ? d.y1 - w.y0 : whole.y1};
}

static void leave_out(const Planes *planes, ExrWindow inside, unsigned char *counts) {
    for (int y = 0; y < planes->height; y++)
        for (int x = 0; x < planes->width; x++)
            if (x < inside.x0 || x >= inside.x1 || y < inside.y0 || y >= inside.y1)
                counts[(size_t)y * (size_t)planes->width + (size_t)x] = 0;
}

static bool mark_region(const CompareInput *input, ExrWindow r, unsigned char *is_inside,
                        Error *err) {
    ExrWindow e = extent_of(input);
    int left = 0, top = 0;
    if (input->kind == INPUT_FRAME) {
        left = input->frame.display.x0;
        top = input->frame.display.y0;
    }
    const ExrWindow in = {r.x0 - left, r.y0 - top, r.x1 - left, r.y1 - top};
    if (in.x0 < e.x0 || in.y0 < e.y0 || in.x1 > e.x1 || in.y1 > e.y1 || r.x0 >= r.x1 ||
        r.y0 >= r.y1)
        return error_set(err, ERROR_USAGE,
                         "--region %d,%d,%d,%d: required: X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1 "
                         "inside the pixels %d,%d,%d,%d of %s",
                         r.x0, r.y0, r.x1, r.y1, e.x0 + left, e.y0 + top, e.x1 + left, e.y1 + top,
                         input->name);
    for (int y = in.y0; y < in.y1; y++)
        memset(is_inside + (size_t)y * (size_t)input->light.width + in.x0, 1,
               (size_t)(in.x1 - in.x0));
    return true;
}

static bool apply_regions(const CompareInput *input, const SelectionRequest *request, Arena scratch,
                          unsigned char *counts, Error *err) {
    size_t count = planes_pixel_count(&input->light);
    unsigned char *is_inside = ARENA_NEW(&scratch, unsigned char, count);
    for (int i = 0; i < request->region_count; i++)
        if (!mark_region(input, request->regions[i], is_inside, err)) return false;
    for (size_t i = 0; i < count; i++) counts[i] = counts[i] && is_inside[i];
    return true;
}

static float code_of(const Image *image, size_t i) {
    return image->format == IMAGE_RGBA8    ? (float)((const uint8_t *)image->pixels)[i] / 255
           : image->format == IMAGE_RGBA16 ? (float)((const uint16_t *)image->pixels)[i] / 65535
                                           : ((const float *)image->pixels)[i];
}

/* Any code above 0 in red, green or blue. */
static bool is_lit(const Image *image, size_t i) {
    return code_of(image, 4 * i) > 0 || code_of(image, 4 * i + 1) > 0 ||
           code_of(image, 4 * i + 2) > 0;
}

/* What says in two ways whether a pixel counts: colour and alpha, or a code that a JPEG has
 * rounded. */
static bool check_mask(const Image *image, bool is_jpeg, const char *path, Error *err) {
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++) {
        int x = (int)(i % (size_t)image->width), y = (int)(i / (size_t)image->width);
        float red = code_of(image, 4 * i), green = code_of(image, 4 * i + 1);
        float blue = code_of(image, 4 * i + 2), alpha = code_of(image, 4 * i + 3);
        float most = fmaxf(red, fmaxf(green, blue));
        if (is_jpeg && most > 0 && most < 1)
            return error_at(err, ERROR_INPUT, path, "",
                            "the mask is a JPEG, which rounds its codes (%.0f at pixel %d,%d), "
                            "required: black and white, as a PNG has them",
                            (double)most * 255, x, y);
        if (most > 0 && alpha < 1)
            return error_at(err, ERROR_INPUT, path, "",
                            "the mask is transparent where it is not black (pixel %d,%d), "
                            "required: black and white without alpha",
                            x, y);
    }
    return true;
}

static bool apply_mask(const CompareInput *input, const char *path, Arena scratch,
                       unsigned char *counts, Error *err) {
    Image image;
    FileBytes bytes;
    const Planes *planes = &input->light;
    if (!file_read(path, MASK_BYTES_MAX, &scratch, &bytes, err) ||
        !image_read_memory(bytes.data, bytes.size, path, &scratch, &image, err) ||
        !check_mask(&image, bytes.size > 3 && !memcmp(bytes.data, "\xff\xd8\xff", 3), path, err))
        return false;
    if (image.width != planes->width || image.height != planes->height)
        return error_at(err, ERROR_INPUT, path, "", "the mask has %d x %d pixels, %s has %d x %d",
                        image.width, image.height, input->name, planes->width, planes->height);
    for (size_t i = 0; i < planes_pixel_count(planes); i++)
        if (!is_lit(&image, i)) counts[i] = 0;
    return true;
}

/* ---- displays ---------------------------------------------------------------------------- */

/* Parts of the display in a frame. */
typedef struct DisplayParts {
    DisplayLayers layers;
    int id;
} DisplayParts;

static bool find_parts(const CompareInput *input, const char *display, DisplayParts *out) {
    if (input->kind != INPUT_FRAME) return false;
    out->id = frame_id_of(&input->frame, "display", display);
    return out->id >= 0 && display_layers_find(&input->frame, &out->layers);
}

/* Of the values of a channel, pixels in which either side sees some of it count. */
static void leave_out_others(const FrameImage *frame, const DisplayParts parts[2],
                             unsigned char *counts) {
    for (size_t i = 0; i < frame_pixel_count(frame); i++) {
        long place = selection_place(frame, i);
        if (place >= 0 && !(display_part(&parts[0].layers, i, parts[0].id).coverage > 0) &&
            !(display_part(&parts[1].layers, i, parts[1].id).coverage > 0))
            counts[place] = 0;
    }
}

static bool apply_display(const CompareInput *const sides[2], const char *display, Arena scratch,
                          unsigned char *counts, Error *err) {
    const CompareInput *reference = sides[0];
    DisplayParts parts[2];
    LayerView view;
    if (reference->kind != INPUT_FRAME)
        return error_set(err, ERROR_USAGE, "--display %s: a picture does not tell its displays",
                         display);
    int id = frame_id_of(&reference->frame, "display", display);
    if (id < 0)
        return error_at(err, ERROR_USAGE, reference->name, "",
                        "has no display \"%s\"; its displays: %s", display,
                        frame_display_names(&reference->frame, &scratch));
    if (!frame_channel(&reference->frame, "id.display"))
        return error_at(err, ERROR_INPUT, reference->name, "",
                        "has no layer id, which tells the pixels of a display; render it with "
                        "--layers id,display");
    if (find_parts(sides[0], display, &parts[0]) && find_parts(sides[1], display, &parts[1])) {
        leave_out_others(&reference->frame, parts, counts);
        return true;
    }
    if (!layer_view_find(&reference->frame, "id.display", &scratch, &view, err)) return false;
    for (size_t i = 0; i < planes_pixel_count(&reference->light); i++)
        if (view.planes[0][i] != (float)id) counts[i] = 0;
    return true;
}

bool selection_take_display(CompareInput *const sides[2], const char *display, Arena *arena,
                            Error *err) {
    DisplayParts parts[2];
    for (int s = 0; s < 2; s++)
        if (!find_parts(sides[s], display, &parts[s]))
            return error_at(err, ERROR_INPUT, sides[s]->name, "",
                            "has no layers of display %.80s: its pixels count whole, with what "
                            "is around it at the rim (--layers display tells its part)",
                            display);
    for (int s = 0; s < 2; s++) {
        sides[s]->frame =
            display_part_frame(&sides[s]->frame, &parts[s].layers, parts[s].id, arena);
        if (!input_view_light(sides[s], arena, err)) return false;
    }
    return true;
}

bool selection_make(const CompareInput *const sides[2], const SelectionRequest *request,
                    Arena *arena, Selection *out, Error *err) {
    const CompareInput *reference = sides[0];
    Arena kept = *arena;
    size_t count = planes_pixel_count(&reference->light);
    Selection made = {.counts = ARENA_NEW(&kept, unsigned char, count)};
    made.is_part = request->mask || request->region_count || request->display;
    memset(made.counts, 1, count);
    leave_out(&reference->light, extent_of(reference), made.counts);
    if (request->region_count && !apply_regions(reference, request, kept, made.counts, err))
        return false;
    if (request->mask && !apply_mask(reference, request->mask, kept, made.counts, err))
        return false;
    if (request->display && !apply_display(sides, request->display, kept, made.counts, err))
        return false;
    for (size_t i = 0; i < count; i++) made.pixels += made.counts[i];
    if (made.pixels == 0)
        return error_at(err, ERROR_INPUT, reference->name, "",
                        made.is_part ? "no pixel is left to compare: mask, region and display "
                                       "have none in common"
                                     : "no pixel to compare: the data window lies outside the "
                                       "display window");
    *arena = kept;
    *out = made;
    return true;
}
