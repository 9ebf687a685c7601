/* SPDX-License-Identifier: Apache-2.0 */
/* headline.h -- the answer of a comparison in one line, the same on console, page, JSON, JUnit:
 * "Night: 2 % darker, everywhere. Inputs changed: night.gltf, centre.png".
 *
 * First what changed, by how much and where; then one pixel that stands out, contrasts, limits,
 * and what explains it by the frames' own metadata. A change has as many digits as its interval
 * allows, two at most.
 *
 * Memory   texts come from the arena that is passed in. Threads: pure. Fails: never.
 */
#pragma once
#include "compare/comparison.h"

/* "same", "same light", "within noise", "within limits", "different". */
extern const char *const compare_outcome_names[];

/* Fills outcome, verdict and finding of what is complete otherwise. */
void headline_make(const CompareOptions *options, Arena *arena, Comparison *out);

/* "Night" of "sub/night.exr"; with a folder's name before it where the path has one. */
const char *headline_name(const char *path, Arena *arena);

/* "pixel 24,13: 12, now 20000 cd/m2" */
const char *headline_pixel(const Comparison *c, const ChangedPixel *pixel, Arena *arena);
