/* SPDX-License-Identifier: Apache-2.0 */
/* request_check.h -- what a review's request names, found in its scene.
 *
 * Memory   the arena's. Threads: const data.
 * Fails    as stated; places are the file and the JSON path of the request.
 */
#pragma once
#include "base/problems.h"
#include "review/request/request.h"

/* The display of that name ("cluster", "node:NAME"). Errors name no place: no such display
 * (and which there are), no panel, several nodes share it. */
bool review_display_find(const Scene *scene, const char *name, Arena *arena, ReviewDisplay *out,
                         Error *err);

/* The camera of an eye of that kind. Errors name no place. */
bool review_camera_find(const Scene *scene, const ReviewEye *eye, Arena scratch, int *camera_id,
                        Error *err);

/* Everything that the request names of the scene is there: cameras and displays of eyes,
 * symbols, levels and contents. All that is not goes to *problems, with file and path; false
 * when there was any. Besides, what cannot be meant: displays that are read and are smaller or
 * larger than any that is built are errors; warned of are a vehicle that points elsewhere than
 * an eye looks, an eye far from all that it reads, pictures that stand upside down for it. */
bool review_request_check(const ReviewRequest *request, const Scene *scene, Problems *problems);
