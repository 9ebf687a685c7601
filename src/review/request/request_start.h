/* SPDX-License-Identifier: Apache-2.0 */
/* request_start.h -- a REVIEW.json to start from: a scene's displays and eyes, a noon, a night
 * and a year.
 *
 * Every perspective camera is an eye. Every display that shows something has one symbol,
 * "find": "text" over what it shows of its content; one whose material several nodes wear has
 * one a node.
 *
 * Memory   the arena's. Threads: one at a time.
 * Fails    ERROR_INPUT when the scene has no such display or camera, or lies where the file may
 *          not name it (base/reference.h); ERROR_OUTPUT when there is a file already, or it
 *          cannot be written.
 */
#pragma once
#include "scene/scene.h"

typedef struct ReviewStart {
    const char *const *scenes; /* the scene's files, as the user named them */
    int                scene_count;
    const char        *output;
    const char        *root; /* --root: a folder whose files may be named too; NULL: none */
} ReviewStart;

bool review_request_start(const ReviewStart *start, const Scene *scene, Arena *arena,
                          Error *err);
