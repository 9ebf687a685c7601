/* SPDX-License-Identifier: Apache-2.0 */
/* sweep_probes.h -- the probes of a scene's sweeps: each symbol as each eye sees it, its face,
 * the sensors of the levels.
 *
 * Memory   from the arena that is passed in; the setup must outlive them.
 * Threads  starts its own; the same figures for any count.
 */
#pragma once
#include "review/eye/false_suns.h"
#include "review/light/distant_probe.h"
#include "review/light/response_file.h"
#include "review/run/cases.h"
#include "review/run/review_run.h"

/* The responses of a sweep's probes, and what they read of the scene's own
 * light: of files of an earlier review, or traced and then kept in files.
 *
 * A file that is damaged, or of something else under that name, is a warning; the response is
 * traced again and the file replaced.
 *
 * Memory   from the arena that is passed in.
 * Threads  starts its own; the same numbers for any count.
 * Fails    when a file cannot be written, or the user stops it. */

/* A probe whose aim is set, with room for its answers. */
typedef struct ResponseArgs {
    const char *name; /* for people: "driver, speed" */
    DistantProbe *probe;
    OwnLight *own;
    int paths;        /* at most */
    double precision; /* 0: all paths */
    ResponseFile file;
    const char *shown; /* the file's name as review.json has it */
    bool is_kept;      /* it was read, not traced */
} ResponseArgs;

typedef struct SweepMeter {
    LitPoint head;
    DistantProbe probe;
    OwnLight own;
    const double *lux; /* [sun of the condition in hand] all of its light but its own */
    SunReadings *kept; /* of other suns of that condition; NULL: none are kept */
} SweepMeter;

typedef struct Sight {
    const ReviewEye *eye;
    const SetupSymbol *symbol;
    Vec3 from;
    SymbolVisibility seen;
    CaseLuminances shown; /* foreground and background at level 1 */
    double height_arcmin;
    DistantProbe probe;
    OwnLight own;
    const SweepMeter *face;
    int twin;        /* an earlier sight from the same place, as an eye box about an
                        eye is: what is sampled there holds for both; NO_ID: none */
    bool has_twin;   /* a later one has this for its twin */
    bool is_private; /* the eye must not read it */
} Sight;

/* Is enough of it seen to judge it (case_is_seen)? */
bool sight_is_seen(const Sight *sight);

typedef struct Sweep {
    const ReviewRun *run;
    Setup *setup;
    SetupSymbol *symbols;
    int symbol_count;
    SweepMeter *faces;   /* one a symbol */
    SweepMeter *sensors; /* one a level of the request; those of curves are used */
    Sight *sights;
    int sight_count;
    FalseSuns *false_suns; /* one an eye */
    ResponseArgs *calls;   /* of all of them that are used */
    int call_count;
    /* of the condition in hand: */
    SweepSuns suns;
    SkyTable table;
    HourSkies hours;
    bool has_hours;           /* of a weather file: probes do not use the table */
    const ReviewLevel *level; /* NULL: the scene's */
    SweepMeter *sensor;       /* of the level; NULL: it is fixed */
    Arena figures;            /* scratch for the figures of a condition */
    Arena between;            /* for what meters read between its suns */
} Sweep;

/* The scene without sky and sun, its displays at one level. */
bool sweep_light_dark(Setup *setup, float level, Arena *arena, Error *err);

/* Probes of the scene, and those of their responses that are kept. */
bool sweep_place_probes(Sweep *sweep, Arena *arena, Error *err);

/* Then all other responses, in the dark but for the scene's own light; all displays have
 * level 1 then. */
bool sweep_make_probes(Sweep *sweep, Arena *arena, Error *err);

/* Everything for the skies of a condition, and the meters for its suns; what they read between
 * them is kept in sweep->between. */
bool sweep_sample_light(Sweep *sweep, Arena *arena, Error *err);

/* One sight, for these suns: some 150 bytes a sun, so that they are sampled one by one. */
Sight sweep_sample_sight(Sweep *sweep, const Sight *sight, Arena *arena);

/* The meter's readings under each of the tools' suns, sampled where they are not kept. */
const double *sweep_meter_read(const SweepMeter *meter, const DistantTools *tools, Arena *arena);

/* For the skies and suns of the condition in hand. */
DistantTools sweep_tools(Sweep *sweep);
