/* SPDX-License-Identifier: Apache-2.0 */
/* review_gaze.h -- eyes that look elsewhere than at symbols: what blinds them, what the glass
 * before them mirrors, and what is left to be seen; where mirrors throw the sun into an eye.
 *
 * Memory   the document's (jansson) and the arena's. Threads: one at a time. Fails: never.
 */
#pragma once
#include "review/output/review_values.h"

/* Displays in glass, too (review_panes.h). */
void values_add_gazes(const PageValues *v);

/* cd m^-2 that glass mirrors over the gaze, and that the eye's own veil lays over it, with no
 * more digits than their intervals allow. */
const char *review_gaze_mirrored(const GazeFinding *g, Arena *arena);
const char *review_gaze_veil(const GazeFinding *g, Arena *arena);
