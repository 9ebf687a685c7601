/* SPDX-License-Identifier: Apache-2.0 */
/* checkpoint.h -- keeps what a render has done in a file, from which it goes on bit for bit.
 *
 * File     all numbers little endian:
 *            a head of fixed size   magic, version, sizes; which pixels and samples of which
 *                                   film; what they cost; which samples were dropped
 *            the identity           what decides a sample (cli/render/render_identity.h)
 *            one block a row        its size, 4 bytes, and the packed sums (film_state.h)
 *            a checksum             XXH3, 64 bits, of everything before
 *          Only the program version that wrote it, on a machine of the same byte order, reads
 *          it: it is for going on, not for keeping.
 * Memory   the arena's; a row of the film at a time.
 * Threads  one at a time.
 * Writing  a checkpoint replaces the one before when it is whole and on the disk: a process
 *          that is killed, or a full disk, leaves the old one as it was.
 * Fails    every fault of a file is reported in one line that names it.
 */
#pragma once
#include "film/film_part.h"

#define CHECKPOINT_VERSION 1

/* A checkpoint's description of the sums that it holds. */
typedef struct Checkpoint {
    const char *path;
    const char *identity;
    FilmPart    done;         /* samples [first_sample, end_sample) of the crop's pixels */
    double      seconds;      /* of rendering, over all sessions */
    bool        has_features; /* the samples' first surfaces were looked at */
    uint64_t    body;         /* offset of the first row in the file */
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
