/* SPDX-License-Identifier: Apache-2.0 */
/* ask_colour.h -- the colour of a symbol as an eye sees it: how far it is from the symbol's
 * own in the dark, and from other symbols that it must not be taken for.
 *
 * What is seen is what its brighter part, foreground or background, sends to the eye, with the
 * light that is reflected there, and with the veil in the eye where the profile counts that:
 * their XYZ add up. The difference of two colours is Delta u'v' of CIE 1976.
 *
 * Memory   from the arena.
 * Threads  pure functions.
 * Fails    never: what is not known is NaN.
 */
#pragma once
#include "base/arena.h"
#include "review/verdict.h"

/* The colours of a case with their differences and intervals, from its luminances as they are
 * now: the chromaticities, and the light of other symbols, are those that were read. A display
 * that is set brighter takes the other symbols on it along.
 *
 * The interval is that of what sampling leaves open and of what each panel states of its own
 * errors, which are independent: of what it reflects, and of the X, Y and Z that it emits, all
 * together and each by itself. Each moves the difference in the plane of u' and v'; the squares
 * of what they move it along itself add up, and of what they move it across. That of sampling is
 * a jackknife of batches which are common to both colours, or, where that is wider, what the
 * interval of the reflected light makes of it: bright paths may be missing. */
const CaseColour *case_colours(const ReviewCase *c, Arena *arena);
