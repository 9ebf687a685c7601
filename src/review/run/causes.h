/* causes.h -- by which ways light comes to a symbol, and what would mend it.
 *
 * A way is what the eye's ray meets behind the display, by node and material, up to CAUSE_STEPS
 * of it, the pane that the light came through, and where it began. Light that the display
 * itself emits straight to the eye is none of it.
 *
 * Units    cd m^-2.
 * Memory   texts and lists live in the arena.
 * Threads  one; the same figures each time.
 */
#pragma once
#include "review/light/stage.h"
#include "review/verdict.h"

#define CAUSE_STEPS 3
#define CAUSES_MOST 10

/* Sets the case's causes: the greatest CAUSES_MOST, and "all other ways", which add up to the
 * reflected light as these paths tell it. */
void case_causes(const Stage *stage, const ProbeAim *aim, ReviewCase *c, Arena *arena);

/* Sets its remedies, from its figures and causes: nothing is traced. Where its limit is kept
 * there are none. */
void case_remedies(ReviewCase *c, Arena *arena);
