/* SPDX-License-Identifier: Apache-2.0 */
/* symbol_fixture.h -- a picture that is drawn by shares of light, and the panel that shows it.
 *
 * Memory   easel_open is a group's setup, easel_close its end.
 */
#pragma once
#include "fixture.h"

#include "image/image.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_open.h"

typedef struct Easel {
    Arena arena, fresh; /* as it is, and as a test finds it */
    Panel *panel;
} Easel;

static Easel the_easel;

static int easel_open(void **state) {
    the_easel.arena = arena_reserve((size_t)2 << 30);
    assert_done(panel_open(PROJECT_DIR "/assets/panels/ips_cluster.panel", &the_easel.arena,
                           &the_easel.panel, &err));
    the_easel.fresh = the_easel.arena;
    *state = &the_easel;
    return 0;
}

static int easel_close(void **state) {
    Easel *easel = *state;
    panel_close(easel->panel);
    arena_release(&easel->arena);
    return 0;
}

static inline Easel *fresh_easel(void) {
    the_easel.arena = the_easel.fresh;
    return &the_easel;
}

/* A case with `Easel *easel`, all of its memory free. */
#define EASEL_TEST(name) TEST_ON(name, NULL, NULL, Easel *easel, fresh_easel())

/* On axis, cd m^-2. */
static inline double easel_luminance(const Easel *easel, double code) {
    float xyz[3], c = (float)code;
    panel_emission_xyz(easel->panel, vec3(0, 0, 1), (float[3]){c, c, c}, xyz);
    return (double)xyz[1];
}

/* The 16-bit grey whose luminance lies at `share` between black's and white's. */
static inline uint16_t easel_code(const Easel *easel, double share) {
    double black = easel_luminance(easel, 0), white = easel_luminance(easel, 255);
    double wanted = black + share * (white - black);
    int low = 0, high = 65535;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (easel_luminance(easel, middle / 257.0) > wanted) high = middle;
        else low = middle;
    }
    return (uint16_t)(share <= 0 ? 0 : high);
}

/* How much of the pixel's square is drawn on, 0..1. */
typedef double Coverage(const void *drawing, int x, int y);

/* A picture of light `ink` on `ground` (shares of white's luminance). */
static inline Image easel_draw(Easel *easel, int width, int height, const double ink_ground[2],
                               Coverage *coverage, const void *drawing) {
    uint16_t *pixels = ARENA_NEW(&easel->arena, uint16_t, 4 * width * height);
    uint16_t of_share[257]; /* to 1 / 256 */
    for (int k = 0; k <= 256; k++)
        of_share[k] =
            easel_code(easel, ink_ground[1] + k / 256.0 * (ink_ground[0] - ink_ground[1]));
    for (int i = 0; i < width * height; i++) {
        double share = coverage(drawing, i % width, i / width);
        uint16_t code = of_share[(int)(256 * share + 0.5)];
        pixels[4 * i] = pixels[4 * i + 1] = pixels[4 * i + 2] = code;
        pixels[4 * i + 3] = 65535;
    }
    return (Image){width, height, IMAGE_RGBA16, pixels};
}

/* ---- drawings ---------------------------------------------------------------------------- */

/* Upright rectangles that do not overlap: left, top, right, bottom, in pixels. */
typedef struct Boxes {
    int count;
    double box[32][4];
} Boxes;

static inline double shared_length(double a0, double a1, double b0, double b1) {
    double length = fmin(a1, b1) - fmax(a0, b0);
    return length > 0 ? length : 0;
}

static inline double boxes_coverage(const void *drawing, int x, int y) {
    const Boxes *boxes = drawing;
    double sum = 0;
    for (int i = 0; i < boxes->count; i++) {
        const double *b = boxes->box[i];
        sum += shared_length(b[0], b[2], x, x + 1) * shared_length(b[1], b[3], y, y + 1);
    }
    return fmin(sum, 1);
}

/* A straight stroke about the picture's middle. */
typedef struct Stroke {
    double middle[2], angle, length, width; /* pixels, radians */
} Stroke;

static inline double stroke_coverage(const void *drawing, int x, int y) {
    const Stroke *s = drawing;
    const int side = 16;
    int inside = 0;
    for (int i = 0; i < side * side; i++) {
        double dx = x + (i % side + 0.5) / side - s->middle[0];
        double dy = y + ((int)(i / side) + 0.5) / side - s->middle[1];
        double along = dx * cos(s->angle) + dy * sin(s->angle);
        double across = dy * cos(s->angle) - dx * sin(s->angle);
        inside += fabs(along) <= s->length / 2 && fabs(across) <= s->width / 2;
    }
    return (double)inside / (side * side);
}
