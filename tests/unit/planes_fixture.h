/* SPDX-License-Identifier: Apache-2.0 */
/* planes_fixture.h -- pictures for the tests of src/compare. */
#pragma once
#include <stdint.h>

#include "base/arena.h"
#include "compare/metrics/planes.h"

enum { FIXTURE_ARENA_BYTES = 1 << 28 };

/* A Planes that one may write to. */
typedef struct Canvas {
    Planes planes;
    float *rgb[3];
} Canvas;

static inline Canvas canvas_create(int width, int height, Arena *arena) {
    Canvas canvas = {.planes = {.width = width, .height = height}};
    for (int c = 0; c < 3; c++) {
        canvas.rgb[c] = ARENA_NEW(arena, float, (size_t)width *(size_t)height);
        canvas.planes.rgb[c] = canvas.rgb[c];
    }
    return canvas;
}

static inline void canvas_fill(const Canvas *canvas, float r, float g, float b) {
    for (size_t i = 0; i < planes_pixel_count(&canvas->planes); i++) {
        canvas->rgb[0][i] = r;
        canvas->rgb[1][i] = g;
        canvas->rgb[2][i] = b;
    }
}

static inline Canvas canvas_uniform(float r, float g, float b, Arena *arena) {
    Canvas canvas = canvas_create(12, 9, arena);
    canvas_fill(&canvas, r, g, b);
    return canvas;
}

/* 0 <= u < 1 */
static inline double fixture_random(uint64_t *seed) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 40) / (1 << 24);
}

/* Smooth colours, a bright disc and dark lines, with noise between -noise and noise on it,
 * clamped to 0 .. 1. */
static inline Canvas canvas_scene(int width, int height, double noise, uint64_t seed,
                                  Arena *arena) {
    Canvas canvas = canvas_create(width, height, arena);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double dx = x - 0.6 * width, dy = y - 0.4 * height;
            int in_disc = dx * dx + dy * dy < 0.04 * width * width;
            for (int c = 0; c < 3; c++) {
                double value = 0.45 + 0.4 * (double)((x * (c + 1) + y * (3 - c)) % 50) / 50;
                if (in_disc) value = c == 1 ? 1 : 0.05;
                if (x % 17 == 3 || y % 23 == 5) value *= 0.1;
                value += noise * (2 * fixture_random(&seed) - 1);
                value = value < 0 ? 0 : value > 1 ? 1 : value;
                canvas.rgb[c][y * width + x] = (float)value;
            }
        }
    return canvas;
}

static inline Canvas canvas_scaled(const Canvas *source, double factor, Arena *arena) {
    Canvas canvas = canvas_create(source->planes.width, source->planes.height, arena);
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < planes_pixel_count(&source->planes); i++)
            canvas.rgb[c][i] = (float)((double)source->rgb[c][i] * factor);
    return canvas;
}
