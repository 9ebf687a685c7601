/* SPDX-License-Identifier: Apache-2.0 */
/* render.h -- makes a film of a scene: passes, tiles, threads, stopping rule.
 *
 * A pass adds a few samples to every pixel: 1, 1, 2, 4 ... up to a number that depends on the
 * count of pixels alone; of some, a pixel may take a fixed share (favour.h, pilot.h).
 * Only between passes is anything decided (stop, snapshot), so that the frame is the same for
 * any number of threads. How many samples a relative error takes is settled before the first
 * one by others (noise_stop.h), so that no sample decides about another.
 *
 * Memory   film and lights come from the arena; Embree's memory is gone on return.
 * Threads  starts `threads` of its own for every pass.
 * Signals  from the first pass to the end of the process INT and TERM stop after the pass in
 *          hand, and USR1 requests a snapshot (signals.h).
 */
#pragma once
#include "base/progress.h"
#include "camera/camera.h"
#include "film/film.h"
#include "film/sample_shares.h"
#include "path/path.h"
#include "render/checkpoint.h"
#include "render/noise_stop.h"
#include "render/tiles.h"
#include "kernel/kernel.h"

typedef struct RenderResult RenderResult;

typedef struct RenderOptions {
    int width, height; /* pixels of the whole frame */
    FilmRect crop;     /* what is rendered of it */
    uint32_t seed;
    uint32_t first_sample, end_sample; /* half-open; the end is the most that is done */
    double noise;                      /* as few samples as leave so much relative error; 0: all.
                                          How many is found beforehand (noise_stop.h) */
    FilmArea noise_area;               /* whose error decides */
    const FilmArea *favoured;  /* only its pixels take all samples (favour.h); NULL: all do */
    bool favours_noise;        /* pixels take samples as a pilot found noise (pilot.h) */
    bool is_reading;           /* the context is one of readings (path_context_build) */
    bool no_guiding;           /* does not first train a guide of where light comes from */
    uint32_t guided_samples;   /* of a pixel, for which the guide is trained; 0: as for many */
    const char *field;         /* the trained guide: read from this file if it is there, else
                                  kept there; NULL: neither */
    int max_bounces;           /* 0: emission only, 1: plus direct light */
    const PolarisedEye *eye;   /* how light is polarised counts for it (its directions are
                                  replaced by the camera's); NULL: unpolarised */
    bool no_mirrors;           /* sunlight via mirrors is left to chance */
    unsigned layers;           /* FilmLayer bits; */
    const LightGroups *lights; /* of LAYER_LIGHT; NULL: none */
    int threads;               /* at least 1 */
    const char *isa;           /* kernel.h's names; NULL: the best there is */
    bool stops_at_once;        /* not after the pass in hand: the film is no frame then */
    ProgressMode progress;
    Progress *within;     /* the frame is a part of that and shows nothing of its own; */
    double within_weight; /* of this weight. NULL: it is by itself */
    /* As soon as every second pixel has a sample, like the squares of one colour of a chess board.
     * NULL: nobody looks */
    void (*first_look)(void *user, const RenderResult *so_far, const Progress *shown);
    void (*snapshot)(void *user, const RenderResult *so_far);   /* NULL: none */
    void (*checkpoint)(void *user, const RenderResult *so_far); /* NULL: none */
    double checkpoint_interval_s; /* at least this between two, after the pass in hand */
    /* After a pass that is not the last; `shown` is to be cleared before a line is printed.
     * NULL: none */
    void (*pass_ended)(void *user, const RenderResult *so_far, const Progress *shown);
    void *user;               /* of all */
    const Checkpoint *resume; /* what was done before; NULL: nothing. It fits these options */
} RenderOptions;

/* The layers without those that this scene can have nothing for: display.second of a scene of
 * one display or none. */
unsigned render_layers(const Scene *scene, unsigned layers);

/* Twelve hexadecimal digits that change with every source file that decides a pixel: they
 * distinguish builds of one version. Made by hash_sources.cmake. */
extern const char SOURCES_HASH[];

struct RenderResult {
    Film *film;
    const Kernel *kernel;     /* the one that was used */
    SampleShares shares;      /* of the pixels in all samples */
    uint32_t samples;         /* of the frame, with those done before */
    uint32_t resumed_samples; /* done before this session; 0: it began */
    bool has_features;        /* the samples' first surfaces were looked at */
    double seconds;           /* of rendering alone, over all sessions */
    double build_seconds;     /* of the ray tracer's and the lights' structures, now */
    uint64_t field_hash;      /* of the guide; 0: none */
    double training_seconds;  /* that it took now */
    uint64_t training_paths;
    double build_peak_bytes; /* the most memory of the process until they stood */
    PathStatistics statistics;
    FilmError error;
    NoiseStop stop;     /* of options' noise; */
    double noise;       /* the error over its area in the end; NaN where it is empty */
    double noise_doubt; /* the error that there may be, if light is rare; or NaN */
    double rare_error;  /* of the frame in the end (film.h), from NOISE_LEAST_SAMPLES on; or NaN */
    bool complete;      /* all samples, or those that leave the noise */
    int stopped_by;     /* SIGINT, SIGTERM, SIGHUP or 0 */
};

/* All that is ready before the first sample. */
typedef struct RenderSetup {
    const Kernel *kernel;
    Bvh *bvh;
    PathContext context;
    Camera camera;
    uint64_t field_hash; /* 0: no field guides the paths */
    double build_seconds, training_seconds;
    PathStatistics training;
    double build_peak_bytes;
} RenderSetup;

/* The options' samples, layers and checkpoint do not matter yet. Ended by render_setup_end;
 * the scene must outlive it. */
bool render_prepare(const Scene *scene, const SceneCamera *camera, const RenderOptions *options,
                    Arena *arena, RenderSetup *out, Error *err);

bool render_prepared(const RenderSetup *setup, const RenderOptions *options, Arena *arena,
                     RenderResult *out, Error *err);

/* Where a checkpoint is kept, and what decides its samples (identity.h). */
typedef struct CheckpointName {
    const char *path, *identity;
} CheckpointName;

/* Writes what is done so far, in place of the checkpoint before. */
bool render_write_checkpoint(const CheckpointName *name, const RenderOptions *options,
                             const RenderResult *so_far, Arena scratch, Error *err);

void render_setup_end(RenderSetup *setup);

/* Of a finished one with noise: whether its error is much less than may be. */
bool render_noise_is_rare(const RenderResult *result);
