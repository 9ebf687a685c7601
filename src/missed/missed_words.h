/* SPDX-License-Identifier: Apache-2.0 */
/* missed_words.h -- light that may be missed, in words.
 *
 * Memory   texts lie in the arena. */
#pragma once
#include "missed/missed_light.h"

#define MISSED_LINES 4 /* of pairs; then "and N more" */

/* `lamp "left" shines through solid "lens", then "visor": this light is not followed (0.4 lx on
 * display "cluster" are missing, 12 % of what is there)`; of the sun and emitters, that chance
 * alone finds it. */
const char *missed_pair_words(const Scene *scene, const MissedLight *missed, int pair,
                              Arena *arena);

/* What is missed in all, and of which pairs the most; NULL: less than MISSED_SHARE. */
const char *missed_words(const Scene *scene, const MissedLight *missed, Arena *arena);

/* "sun", "lamp", "emitter"; and what the light is called, "" of the sun. */
const char *missed_kind(ChainLight from);
const char *missed_name(const Scene *scene, const MissedPair *pair);
