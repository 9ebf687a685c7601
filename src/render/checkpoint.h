/* SPDX-License-Identifier: Apache-2.0 */
/* checkpoint.h -- keeps what a render has done in a file, from which it goes on bit for bit.
 *
 * File     one that is kept (keep/kept.h). Its facts: which pixels and samples of which film,
 *          what they cost, which samples were dropped. Its identity: what decides a sample
 *          (cli/render/render_identity.h). Its body: one block a row, its size, 4 bytes, and
 *          the packed sums (film_state.h).
 *          Only the program version that wrote it, on a machine of the same byte order, reads
 *          it: it is for going on, not for keeping.
 * Memory   the arena's; a row of the film at a time.
 * Threads  one at a time.
 * Fails    as keep/kept.h.
 */
#pragma once
#include "film/film_part.h"

#define CHECKPOINT_VERSION 1

/* A checkpoint's description of the sums that it holds. */
typedef struct Checkpoint {
    const char *path;
    const char *identity;
    FilmPart done;     /* samples [first_sample, end_sample) of the crop's pixels */
    double seconds;    /* of rendering, over all sessions */
    bool has_features; /* the samples' first surfaces were looked at */
} Checkpoint;

/* True when a file stands there that begins as a checkpoint does. */
bool checkpoint_is_there(const char *path);

/* what->done and the film are of the same pixels, layers and samples. */
bool checkpoint_write(const Checkpoint *what, const Film *film, Arena scratch, Error *err);

/* Reads everything but the sums. The whole file is checked: a truncated or damaged one is
 * refused here. */
bool checkpoint_open(const char *path, Arena *arena, Checkpoint *out, Error *err);

/* Whether a render of these pixels and samples can go on from it; `wanted`: crop, first_sample
 * and end_sample count. */
bool checkpoint_fits(const Checkpoint *checkpoint, const FilmPart *wanted, Error *err);

/* Fills an empty film of the checkpoint's crop and layers. After a failure the film is worth
 * nothing. */
bool checkpoint_load(const Checkpoint *checkpoint, Film *film, Arena scratch, Error *err);
