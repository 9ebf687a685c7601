/* SPDX-License-Identifier: Apache-2.0 */
/* explain_place.h -- the same for a display or a part of a picture, without a review.
 *
 * Units    explain.h's.  Memory  the answer lives in the arena.
 * Threads  starts its own; the same figures for any count.
 */
#pragma once
#include "review/run/explain.h"

/* A scene that is lit, and what is looked at in it. */
typedef struct ExplainPlace {
    const ReadingTools *tools;
    ProbeAim            aim; /* along its targets the eye looks; a path each, and again */
    long                paths;
    bool                with_outlook;
} ExplainPlace;

/* Where at least half of the targets show a display, those of them count and the light is what
 * it reflects, its contrast that of white and black as the display sends them; else all that
 * comes to the eye. */
void explain_place(const ExplainPlace *place, Arena *arena, Explained *out);
