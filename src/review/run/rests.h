/* SPDX-License-Identifier: Apache-2.0 */
/* rests.h -- what a review's verdicts rest on besides its light, and the files that were read:
 * facts that are gathered while it runs (Review.rests_on, Review.inputs).
 *
 * Lists stand in the order of RestKind, and of when each was met; nothing stands there twice.
 * A file that changed between two readings stands there with both hashes.
 *
 * Memory   lists and texts live in the arena.
 * Threads  one at a time.
 * Fails    never.
 */
#pragma once
#include "review/profile.h"
#include "review/run/symbols.h"
#include "review/verdict.h"

/* Eyes, occupants, limits; the request's own files and the profile's. */
void rests_add_request(const ReviewRequest *request, const Profile *profile, Review *review,
                       Arena *arena);

/* Panels of the displays that are read, materials that nobody described. */
void rests_add_scene(const ReviewRequest *request, const Scene *scene, Review *review,
                     Arena *arena);

/* Files: of a scene, of symbols' masks, of another review such as a variant. */
void rests_add_scene_files(const Scene *scene, Review *review, Arena *arena);
void rests_add_masks(const SetupSymbol *symbols, int count, Review *review, Arena *arena);
void rests_add_files_of(const Review *of, Review *review, Arena *arena);

/* The facts of another part of the review. */
void rests_add_of(const Review *of, Review *review, Arena *arena);
