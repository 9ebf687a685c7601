/* SPDX-License-Identifier: Apache-2.0 */
/* distant_probe.h -- a probe's readings for many suns, in clear skies or those of a weather
 * file, without a path for each.
 *
 * A response (response.h) is traced once. Clear skies of a table of the sun's elevations are
 * summed over it for every azimuth of the sun; what lies between is interpolated. Skies of a
 * weather file are summed one by one (hour_sky.h). The first vertex's answer to the sun itself
 * is sampled for each of the suns.
 *
 * Frame    azimuths of the vehicle: 0 ahead, 90 right; elevations apparent; degrees.
 * Units    cd m^-2 (a luxmeter: lx).
 * Memory   from the arena: 6.3 KB a probe and elevation, 128 bytes a probe and sun, 1 MB a
 *          response.
 * Threads  starts its own; the same numbers for any count.
 */
#pragma once
#include "review/light/hour_sky.h"
#include "review/light/light_parts.h"
#include "review/light/setup.h"
#include "review/light/sky_table.h"

/* ---- probes ------------------------------------------------------------------------------ */

typedef struct DistantProbe {
    ProbeAim aim;
    Response response;
    const LightParts *parts;         /* of what is looked at: the sun itself counts by the part that
                                        gets most of it; NULL: by all of it, or by a luxmeter */
    const float *scattered, *mirror; /* the first vertex's: [sun][band], by lx */
    double *sky;                     /* [elevation of the table][SKY_AZIMUTHS]; by hours [sun] */
    float *sky_without;              /* the same without each of the response's groups:
                                        [...][group]; by hours [group], as a share of any sky */
    BrightSamples *sky_bright;       /* samples of each; by hours one, of a sky of 1 */
} DistantProbe;

typedef struct DistantSuns {
    const DistantSun *list; /* relative to the vehicle */
    int count;
} DistantSuns;

typedef struct DistantTools {
    const Setup *setup;
    SkyTable *table;
    DistantSuns suns;
    int paths;              /* the response's, at most, */
    double precision;       /* and when it ends before */
    int sun_paths;          /* the first vertex's */
    bool has_mirror;        /* it may be one: that is sampled by paths of its own */
    const HourSkies *hours; /* a weather file's, read instead of the table; or NULL */
} DistantTools;

/* probe->aim is set: its response is made, for any table and suns. */
void distant_probe_respond(DistantProbe *probe, const DistantTools *tools, Arena *arena);

/* After that: what the tools' skies give them, and the table's suns. All at once, since a sky
 * is made and looked up but once for all of them. No probes: its suns alone. Fails as
 * daylight_build. */
bool distant_probes_sample_skies(DistantProbe *const *probes, int count, const DistantTools *tools,
                                 Arena *arena, Error *err);

/* The first vertex's answers to the tools' suns: after that the probe may be read; once more
 * for other suns of the same clear skies. */
void distant_probe_sample_suns(DistantProbe *probe, const DistantTools *tools, Arena *arena);

typedef struct DistantReading {
    double sky, sun_first, sun_rest; /* they add up */
    double mirror;                   /* part of sun_first: the worst part by scattering has it
                                        added, whichever part that lies in */
    MeanInterval interval;           /* 95 %, of their sum */
} DistantReading;

static inline double distant_reading_sum(DistantReading reading) {
    return reading.sky + reading.sun_first + reading.sun_rest;
}

DistantReading distant_probe_read(const DistantProbe *probe, const DistantTools *tools, int sun);

/* What a luxmeter reads under suns, kept so that none is sampled twice.
 *
 * Symbols are evaluated for suns between the steps of a year, and many for the same: a sensor
 * reads the same for all of them, the face of a display for all eyes. A reading does not depend
 * on the others that are requested beside it.
 *
 * Frame    angles as those of distant_probe.h; a sun is known by their bits and by those of its
 *          light: two dates share a direction, and differ in the earth's distance.
 * Units    lx.
 * Memory   from the arena of the start, which others may use, too: 64 to 256 bytes a sun.
 * Threads  one at a time. */

typedef struct KeptReading {
    DistantSun sun;
    double lux;
    bool is_taken;
} KeptReading;

typedef struct SunReadings {
    Arena *arena;
    KeptReading *places;
    int count, room; /* a power of two, half of it or more free */
} SunReadings;

/* None yet. */
SunReadings sun_readings_start(Arena *arena);

/* NULL: that sun has not been read. */
const double *sun_readings_find(const SunReadings *readings, DistantSun sun);

/* The sun must not be there yet. */
void sun_readings_add(SunReadings *readings, DistantSun sun, double lux);
