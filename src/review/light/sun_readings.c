/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/sun_readings.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#define ROOM_FIRST 1024

SunReadings sun_readings_start(Arena *arena)
{
    SunReadings readings = {.arena = arena, .room = ROOM_FIRST};
    readings.places = ARENA_NEW(arena, KeptReading, ROOM_FIRST);
    return readings;
}

/* Where the sun is, or would be. */
static KeptReading *place_of(const SunReadings *readings, DistantSun sun)
{
    size_t last = (size_t)readings->room - 1;
    size_t place = (size_t)XXH3_64bits(&sun, sizeof sun) & last;
    for (;; place = (place + 1) & last) {
        KeptReading *kept = &readings->places[place];
        if (!kept->is_taken || (kept->sun.at.azimuth_deg == sun.at.azimuth_deg &&
                                kept->sun.at.elevation_deg == sun.at.elevation_deg &&
                                kept->sun.light == sun.light))
            return kept;
    }
}

const double *sun_readings_find(const SunReadings *readings, DistantSun sun)
{
    const KeptReading *kept = place_of(readings, sun);
    return kept->is_taken ? &kept->lux : NULL;
}

static void make_room(SunReadings *readings)
{
    SunReadings wider = {.arena = readings->arena, .count = readings->count,
                         .room = 2 * readings->room};
    wider.places = ARENA_NEW(wider.arena, KeptReading, wider.room);
    for (int i = 0; i < readings->room; i++) {
        const KeptReading *kept = &readings->places[i];
        if (kept->is_taken) *place_of(&wider, kept->sun) = *kept;
    }
    *readings = wider;
}

void sun_readings_add(SunReadings *readings, DistantSun sun, double lux)
{
    if (2 * (readings->count + 1) > readings->room) make_room(readings);
    *place_of(readings, sun) = (KeptReading){sun, lux, true};
    readings->count++;
}
