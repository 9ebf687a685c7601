/* SPDX-License-Identifier: Apache-2.0 */
/* film_samples.h -- for tests of a film's pixels: samples of it, and what its frame says. */
#pragma once
#include "film_fixture.h"

#include "film/film_frame.h"

#define WIDTH 3
#define HEIGHT 2

static const FilmRect whole = {0, 0, WIDTH, HEIGHT};

/* A film of one colour for one pixel. */
static inline void add_grey(Film *film, int x, int y, uint32_t index, float luminance) {
    FilmSample s = {.sample_index = index, .display_id = -1};
    for (int i = 0; i < 3; i++) s.xyz[i] = luminance;
    film_add_sample(film, x, y, &s);
}

/* A coin that is the same for every machine: 1 or 3 times the value. */
static inline float coin(int pixel, uint32_t index, float value) {
    return value * (hash_combine((uint32_t)pixel, index) & 1 ? 1.0f : 3.0f);
}

static inline double at(const FrameImage *frame, const char *channel, int index) {
    const float *values = frame_channel(frame, channel);
    if (!values) fail_msg("no channel %s", channel);
    return (double)values[index];
}

static inline FilmSample display_sample(uint32_t index, float theta, float phi) {
    return (FilmSample){.sample_index = index,
                        .xyz = {110, 120, 130},
                        .hit = true,
                        .depth = 2,
                        .normal = {0, 0, 1},
                        .albedo = {0.5f, 0.5f, 0.5f},
                        .part_id = 3,
                        .display_id = 1,
                        .emitted = {100, 100, 100},
                        .white = {380, 380, 380},
                        .black = {0, 0, 0},
                        .theta = theta,
                        .phi = phi};
}
