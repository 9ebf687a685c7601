/* SPDX-License-Identifier: Apache-2.0 */
/* setup.h -- the scene as a condition has it: its files, contents, light and levels, ready for
 * paths. A cloud deck's relief (sky/cloud_relief.h) is left out: it is synthetic.
 *
 * Memory   scene and lights come from the arena; Embree's memory and the panels are gone after
 *          setup_close.
 * Threads  const once lit.
 * Fails    as scene_load and lights_build do.
 */
#pragma once
#include "base/problems.h"
#include "guide/guide_file.h"
#include "review/light/sky_table.h"
#include "review/light/reading.h"
#include "review/request/request.h"

#define SETUP_BOUNCES 64

/* What a condition's variants take over: the skies of its sweep, or the guide of its moment: a
 * guide directs paths and biases no reading, and readings with one guide have more of their noise
 * in common, so that their difference is sharper than they are. */
typedef struct MomentGuide {
    Arena room;
    SkiesKept skies;              /* of room */
    const ReviewRequest *request; /* NULL: there is none yet */
    const LightGuide *guide;
    GuideScene scene;
} MomentGuide;

/* Scenes that stay loaded, with all that their surfaces need and as they are lit, for other
 * conditions and pictures that have them: what is found in one does not hang on what was lit in
 * it before. */
typedef struct KeptScene KeptScene;
typedef struct ScenesKept {
    KeptScene *first;
} ScenesKept;

typedef struct Setup {
    const ReviewRequest *request;
    const ReviewCondition *condition;
    ProbeTools tools;
    Scene *scene;
    Bvh *bvh;
    PathContext context;
    double sensor_lux;         /* NaN: no level follows the light */
    double *scene_levels;      /* the displays', before the condition's */
    const char *identity;      /* program and scene (render/identity.h), not its light */
    const char *files;         /* hashes of those that the request names besides */
    MomentGuide *moment_guide; /* NULL: nobody takes it over */
    KeptScene *kept;           /* of which the scene is; NULL: its own */
} Setup;

/* By what means: the same for all setups of a review. */
typedef struct SetupMeans {
    const char *root; /* --root, or NULL */
    SceneState state; /* scene.h's */
    int threads;
    const char *isa;           /* kernel.h's; NULL: the best */
    MomentGuide *moment_guide; /* of a condition with variants; NULL: of its own each time */
    ScenesKept *scenes;        /* NULL: each setup loads its own */
} SetupMeans;

typedef struct SetupOptions {
    const ReviewRequest *request;
    const ReviewCondition *condition; /* NULL: the request's own files, no light but theirs */
    SetupMeans means;
} SetupOptions;

/* The scene with the condition's files, contents and occupants, in the dark. Warnings go to
 * *problems. */
bool setup_open(const SetupOptions *options, Arena *arena, Problems *problems, Setup *out,
                Error *err);

/* Its scene alone, to be checked; scene_close closes it. */
bool setup_scene(const SetupOptions *options, Arena *arena, Problems *problems, Scene **out,
                 Error *err);

/* Lights it: the environment (NULL: the condition's, or else the scene's), then the levels, which
 * may follow the light on a sensor. A scene that stays holds its light until it is lit by another
 * sky, in memory of its own: whoever lights it so again, or with other levels, takes over what is
 * found, to the same bits. */
bool setup_light(Setup *setup, const Environment *environment, Arena *arena, Error *err);

/* For the scene as it is now, its environment and levels set otherwise. What was built for its
 * surfaces, and the lights before, stay in their arenas: these must not end before the
 * setup's. */
bool setup_relight(Setup *setup, Arena *arena, Error *err);

/* What a luxmeter reads there, lx. */
Reading setup_meter(const Setup *setup, LitPoint head, uint32_t seed, const ReadingGoal *goal,
                    Arena scratch);

void setup_close(Setup *setup);

/* Closes those that setups of that condition used last; NO_ID: all of them. None may be open. */
void scenes_kept_close(ScenesKept *scenes, int condition_id);

/* Where the sun stands, unit, world, and what its bands give, lx on a plane that faces it.
 * False: the scene has none, or the moon in its place. bands NULL: nobody asks. */
bool setup_sun(const Setup *setup, Vec3 *towards, float bands[LIGHT_BANDS]);

/* As glasses of that colour weigh it (NULL: none); bands[1] of X, Y and Z are those. */
bool setup_sun_xyz(const Setup *setup, const Curve *colour, Vec3 *towards,
                   float bands[3][LIGHT_BANDS]);

/* Azimuth from north over east, or of the vehicle (0 ahead, 90 right) where the environment has
 * no heading; elevation; degrees. */
typedef struct SunAngles {
    double azimuth_deg, elevation_deg;
} SunAngles;

/* A sun of many: where it stands, and its light over that at 1 au, by the earth's distance. */
typedef struct DistantSun {
    SunAngles at;
    double light;
} DistantSun;

SunAngles setup_angles(const Setup *setup, Vec3 towards);

/* The other way round. */
Vec3 setup_direction(const Setup *setup, SunAngles angles);

/* The level by one of the request (NULL: the scene's own), times a variant's brightness.
 * name: as the review calls it; sensor_lux: counts for a curve only. */
double setup_level_of(const Setup *setup, const ReviewLevel *level, int display_id,
                      const char *name, double sensor_lux);

/* Where the eyes of a request are in a setup's scene.
 *
 * Units    m, in the coordinates of the scene.
 * Errors   an eye's camera is missing: with the request's file.
 * Threads  pure functions. */

/* The points of an eye, m, as many as it has; in the arena. NULL: its camera is missing. */
Vec3 *setup_eye_points(const Setup *setup, const ReviewEye *eye, int *count, Arena *arena,
                       Error *err);

/* The point of an eye that is one; of a box its centre. */
bool setup_eye_middle(const Setup *setup, const ReviewEye *eye, Arena scratch, Vec3 *out,
                      Error *err);

/* Trains a guide for a setup's paths on a condition's light, before any of
 * them counts; a variant takes over that of the review's moment where both are of the same files
 * and lights, and the vehicle is not mirrored.
 *
 * Memory   the guide comes from the arena, or lies in the moment's room.
 * Threads  starts its own; the same guide for any count. */

/* For an eye, m, that looks towards what is judged. */
void trained_guide_take(Setup *setup, Vec3 eye, Vec3 towards, Arena *arena);
