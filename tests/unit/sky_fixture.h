/* SPDX-License-Identifier: Apache-2.0 */
/* sky_fixture.h -- moments, daylight, and numbers for tests of skies. */
#pragma once
#include "fixture.h"

#include "base/units.h"
#include "sky/daylight.h"

/* In [0, 1), the next of one stream. */
static inline double random_unit(void) {
    static uint32_t seed = 7;
    seed = seed * 1664525u + 1013904223u;
    return (double)(seed >> 8) / 16777216.0;
}

static inline SkyTime moment(const char *text) {
    SkyTime time;
    assert_done(sky_time_parse(text, "", &time, &err));
    return time;
}

/* A clear sky under a sun that stands so high. */
static inline DaylightInput sun_at_deg(double elevation_deg) {
    DaylightInput input = daylight_input_default(DAYLIGHT_CLEAR);
    input.has_sun = true;
    input.threads = 2;
    input.sun_elevation = radians_from_degrees(elevation_deg);
    return input;
}

static inline const Daylight *daylight_of(const DaylightInput *input, Arena *arena) {
    Daylight *out = arena_alloc(arena, sizeof *out, 64, 1);
    assert_done(daylight_build(input, arena, out, &err));
    return out;
}
