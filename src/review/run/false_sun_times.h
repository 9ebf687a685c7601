/* SPDX-License-Identifier: Apache-2.0 */
/* false_sun_times.h -- when in a sweep a mirror throws the sun into an eye.
 *
 * The sun moves its own width in two minutes: a sweep of hours would miss most of what it does
 * in a mirror. Here it is tested minute by minute (a sweep without times: every quarter of a
 * degree), which costs a look into a table (eye/false_suns.h).
 *
 * What counts  images that lay a veil of FALSE_SUN_VEIL_CD_M2 at least over what the eye looks
 *              at: the symbols, and the request's gazes.
 * Approximate  as eye/false_suns.h; skies are clear in any weather; an eye box counts by its
 *              middle; mirrors take colours as those of a sun at 30 degrees are.
 * Memory       from the arena. Threads: the same figures for any count.
 */
#pragma once
#include "review/eye/false_suns.h"
#include "review/run/sweep_probes.h"

#define FALSE_SUN_VEIL_CD_M2 10.0
/* nearer to the gaze it is looked at: it veils as if it stood there */
#define FALSE_SUN_NEAR_DEG 1.0

/* Adds what was found: of each eye the worst mirrors, FALSE_SUNS_LISTED at most. */
#define FALSE_SUNS_LISTED 12

void false_sun_times(const Sweep *sweep, Arena scratch, Arena *arena, Review *out);
