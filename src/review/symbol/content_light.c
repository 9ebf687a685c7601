/* SPDX-License-Identifier: Apache-2.0 */
#include "review/symbol/content_light.h"

#include <math.h>
#include <stddef.h>

#include "base/vec.h"
#include "image/texture.h"
#include "panel/query/panel_emission.h"

void content_codes(const Image *content, int x, int y, float rgb[3]) {
    rgb[0] = rgb[1] = rgb[2] = 255;
    if (!content) return;
    Texture texture = {*content, WRAP_CLAMP, WRAP_CLAMP, true};
    texture_codes(&texture, ((float)x + 0.5f) / (float)content->width,
                  ((float)y + 0.5f) / (float)content->height, rgb);
}

/* The first of `size` pixels whose centre is not before the edge. */
static int first_centre(double edge, int size) {
    return (int)ceil(edge * size - 0.5);
}

static bool rectangle_is_fine(const double uv[4], Error *err) {
    for (int k = 0; k < 4; k++)
        if (!(uv[k] >= 0 && uv[k] <= 1))
            return error_set(err, ERROR_INPUT,
                             "uv [%g, %g, %g, %g]: the rectangle leaves its content, 0 to 1", uv[0],
                             uv[1], uv[2], uv[3]);
    if (uv[0] < uv[2] && uv[1] < uv[3]) return true;
    return error_set(err, ERROR_INPUT,
                     "uv [%g, %g, %g, %g]: the rectangle is empty; left < right and "
                     "top < bottom are required",
                     uv[0], uv[1], uv[2], uv[3]);
}

static bool place_pixels(const double uv[4], ContentLight *light, Error *err) {
    int w = light->content_width, h = light->content_height;
    light->x = first_centre(uv[0], w);
    light->y = first_centre(uv[1], h);
    light->width = first_centre(uv[2], w) - light->x;
    light->height = first_centre(uv[3], h) - light->y;
    if (light->width > 0 && light->height > 0) return true;
    return error_set(err, ERROR_INPUT,
                     "uv [%g, %g, %g, %g]: the rectangle holds no pixel of its content of "
                     "%d x %d",
                     uv[0], uv[1], uv[2], uv[3], w, h);
}

/* Neighbours mostly show the same: then the panel is not evaluated again. */
static void fill(const Panel *panel, ContentLight *light) {
    float last[3] = {-1, -1, -1}, xyz[3] = {0};
    for (int y = 0; y < light->height; y++) {
        for (int x = 0; x < light->width; x++) {
            float codes[3];
            content_codes(light->content, light->x + x, light->y + y, codes);
            if (codes[0] != last[0] || codes[1] != last[1] || codes[2] != last[2])
                panel_emission_xyz(panel, vec3(0, 0, 1), codes, xyz);
            for (int k = 0; k < 3; k++) last[k] = codes[k];
            light->cd_m2[(size_t)y * (size_t)light->width + (size_t)x] = xyz[1];
        }
    }
}

bool content_light(const Panel *panel, const Image *content, const double uv[4], Arena *arena,
                   ContentLight *out, Error *err) {
    ContentLight light = {.content = content,
                          .content_width = content ? content->width : 1,
                          .content_height = content ? content->height : 1};
    if (!rectangle_is_fine(uv, err) || !place_pixels(uv, &light, err)) return false;
    light.cd_m2 = ARENA_NEW(arena, float, (size_t)light.width *(size_t)light.height);
    fill(panel, &light);
    *out = light;
    return true;
}

/* ---- connected pixels -------------------------------------------------------------------- */

typedef struct PartSearch {
    const uint8_t *set;
    int width, height;
    int32_t *part_of, *stack; /* pixels whose neighbours are still to be visited */
    size_t waiting;
} PartSearch;

static void take(PartSearch *f, int x, int y, int32_t id, ConnectedPart *part) {
    size_t at = (size_t)y * (size_t)f->width + (size_t)x;
    f->part_of[at] = id;
    f->stack[f->waiting++] = (int32_t)at;
    if (x < part->left) part->left = x;
    if (x > part->right) part->right = x;
    if (y < part->top) part->top = y;
    if (y > part->bottom) part->bottom = y;
    part->pixels++;
}

static bool is_free(const PartSearch *f, int x, int y) {
    if (x < 0 || y < 0 || x >= f->width || y >= f->height) return false;
    size_t at = (size_t)y * (size_t)f->width + (size_t)x;
    return f->set[at] && f->part_of[at] < 0;
}

static ConnectedPart fill_from(PartSearch *f, int x, int y, int32_t id) {
    ConnectedPart part = {x, y, x, y, 0};
    take(f, x, y, id, &part);
    while (f->waiting > 0) {
        int32_t at = f->stack[--f->waiting];
        int px = at % f->width, py = at / f->width;
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++)
                if (is_free(f, px + i, py + j)) take(f, px + i, py + j, id, &part);
    }
    return part;
}

static int count_parts(const PartSearch *f) {
    int most = 0; /* no more than pixels that begin a run */
    size_t all = (size_t)f->width * (size_t)f->height;
    for (size_t i = 0; i < all; i++)
        most += f->set[i] && (i % (size_t)f->width == 0 || !f->set[i - 1]);
    return most;
}

ConnectedParts connected_parts(const uint8_t *set, int width, int height, Arena *arena) {
    size_t all = (size_t)width * (size_t)height;
    PartSearch f = {.set = set, .width = width, .height = height};
    ConnectedParts out = {.part_of = ARENA_NEW(arena, int32_t, all)};
    out.part = ARENA_NEW(arena, ConnectedPart, count_parts(&f));
    Arena scratch = *arena;
    f.part_of = out.part_of;
    f.stack = ARENA_NEW(&scratch, int32_t, all);
    for (size_t i = 0; i < all; i++) f.part_of[i] = -1;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            if (is_free(&f, x, y)) {
                out.part[out.count] = fill_from(&f, x, y, out.count);
                out.count++;
            }
    return out;
}
