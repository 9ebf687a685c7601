/* SPDX-License-Identifier: Apache-2.0 */
/* chains.h -- by which chains of objects light comes to an eye from what it looks at.
 *
 * A chain is what the eye's ray meets, by node and material, and what each does with light: the
 * first CHAIN_STEPS of it, the panes between, and where the light began. Parts of one node and
 * material count as one. Light is added path by path (path/collect/history.h); the greatest
 * chains are kept with some of their rays, all others are one figure, and they add up to what
 * was seen. Those count as greatest that are so for sure: by their figure less one standard
 * error, so that a lucky path is no cause.
 *
 * Errors and 95 % intervals come from the means of CHAIN_BATCHES independent batches of paths,
 * as all do (estimate/estimate.h); of a pixel, whose paths are its samples, they are parts
 * of these, and errors what they would be if the parts were independent.
 *
 * Units    cd m^-2; metres, scene.
 * Memory   what is kept lives in the arena.
 * Threads  starts its own; the same figures and rays for any count.
 */
#pragma once
#include "review/chain/seat.h"
#include "review/light/reading.h"

#define CHAIN_CHUNK 64                 /* paths of a chunk */
#define CHAIN_BATCHES ESTIMATE_BATCHES /* fewer where there are fewer chunks */
#define CHAIN_STEPS 4
#define CHAIN_RAYS 8
#define CHAIN_POINTS (PATH_STEPS_MAX + 2)

typedef struct ChainLink {
    int part_id; /* the first of those that count as one */
    int event;   /* PathEvent */
    int pane_id; /* the last pane before it; NO_ID: none; at the first link only if requested */
} ChainLink;

/* Plain numbers, zero behind count: keys are compared as bytes. */
typedef struct ChainKey {
    ChainLink link[CHAIN_STEPS];
    int count;     /* 0: the source is seen by itself */
    int is_longer; /* there are further surfaces */
    int pane_id;   /* the last pane before the source; NO_ID: none */
    int source;    /* LightSet */
    int source_id; /* as a PathHistory's */
} ChainKey;

/* From the eye over the surfaces to where the light began; for a distant source it ends some
 * way towards it. */
typedef struct ChainRay {
    Vec3 point[CHAIN_POINTS];
    int count;
    int is_cut; /* its further surfaces are left out */
} ChainRay;

typedef struct ChainFigure {
    double cd_m2, sigma; /* and its standard error */
    double low, high;    /* 95 % interval */
} ChainFigure;

typedef struct Chain {
    ChainKey key;
    ChainFigure figure;
    ChainRay rays[CHAIN_RAYS]; /* drawn with a chance that goes with their light */
    int ray_count;             /* one of a chunk of paths at most */
} Chain;

/* cd m^-2 of `all` by one thing of each path: each kind adds up to it. Parts that count as one
 * at their first. */
typedef struct ChainGroups {
    double by_set[LIGHT_SETS];   /* where the light began; emitters and lamps one by one: */
    double *by_emitter;          /* [part] */
    double *by_lamp;             /* [light] */
    double *by_pane;             /* [part], by the last pane that it passed; */
    double by_no_pane;           /* and past none */
    double *by_surface;          /* [part], by what is met next behind what is seen first, an
                                    emitter among it; */
    double straight[LIGHT_SETS]; /* and what shines there by itself */
    double without_data;         /* via any material without data (material_data.h), each
                                    path once */
    double guessed;              /* via any that was guessed (Material.guessed_as), or
                                    through one: likewise */
    double extrapolated;         /* as the panel of the display that is seen first extrapolates
                                    its reflection */
} ChainGroups;

typedef struct Chains {
    const Scene *scene;
    Chain *list; /* the greatest, greatest first */
    int count;
    int others;              /* how many more there are */
    ChainFigure rest;        /* theirs */
    ChainFigure all, mirror; /* mirror: via the mirror of a display that is seen first */
    ChainFigure reflected;   /* all that does not come straight from its source */
    double own;              /* cd m^-2 of `all` that began at the display that is seen first */
    ChainGroups groups;
    double *by_seat;  /* [part] cd m^-2 that came to a display straight off the seat's back; of
                         parts that count as one at their first; NULL: none was asked for */
    const int *alike; /* [part] the first of those that count as one */
    long paths;
} Chains;

typedef struct ChainArgs {
    const ProbeAim *aim; /* not a luxmeter */
    const ProbeTools *tools;
    long paths;              /* at least CHAIN_PATHS_LEAST; rounded up to a chunk */
    int most;                /* chains that are kept */
    bool with_direct;        /* sources that the eye sees by themselves count, too */
    const ChainSeat *seat;   /* light off its back is kept apart; NULL: none */
    bool with_first_pane;    /* a pane before the first surface is in the key */
    const ProbeFold *beside; /* takes the light of the same paths, lanes too, in chunks of
                                CHAIN_CHUNK; or NULL */
} ChainArgs;

#define CHAIN_PATHS_LEAST (2 * CHAIN_CHUNK) /* an error takes two batches */

Chains chains_find(const ChainArgs *args, Arena *arena);

/* A chain in words, in the order in which the eye's ray meets it: "display cluster: reflects",
 * "Window_FL (glass): through", "sky". Texts and list live in the arena. */
const char *const *chain_words(const Scene *scene, const ChainKey *key, int *links, Arena *arena);

/* "FrontSeat_L (leather)" */
const char *chain_part_words(const Scene *scene, int part_id, Arena *arena);

/* "sky", "sun", "lamp NAME", or a part's words. */
const char *chain_source_words(const Scene *scene, int source, int source_id, Arena *arena);
