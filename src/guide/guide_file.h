/* SPDX-License-Identifier: Apache-2.0 */
/* guide_file.h -- a guide as a file, and its hash.
 *
 * The file is one that is kept (keep/kept.h): its facts are the counts, its body the tree's
 * nodes, then every cell's bins, probabilities and lamps. A reader takes nothing on trust: a
 * tree that does not part its box, or a number out of its range, is refused.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "guide/guide.h"

#define GUIDE_VERSION 5u

/* A hash of all that decides a guide's choices; never 0. */
uint64_t guide_hash(const LightGuide *guide);

bool guide_write(const char *path, const LightGuide *guide, Arena scratch, Error *err);

/* Lights of the scene: cells must sample them now and then. */
typedef struct GuideScene {
    bool has[GUIDE_LIGHTS]; /* lights of the set */
    int light_count;        /* ids of lamps are below this, */
    int lamp_count;         /* and so many of them give any light */
} GuideScene;

bool guide_read(const char *path, const GuideScene *scene, Arena *arena, const LightGuide **out,
                Error *err);
