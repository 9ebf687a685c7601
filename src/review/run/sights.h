/* SPDX-License-Identifier: Apache-2.0 */
/* sights.h -- what is drawn beside a rendered case: where its causes' rays lie in the frame,
 * and what the display sees from the symbol.
 *
 * The picture goes to FOLDER/frames/NAME-outlook.png.
 *
 * Memory   names and views live in the arena.
 * Threads  starts its own; the same picture for any count.
 * Fails    when the picture cannot be written.
 */
#pragma once
#include "review/run/frames.h"
#include "review/verdict.h"

/* Sets view, outlook and outlook_words of the case whose frame the ask was. */
bool case_sights(const FrameAsk *ask, ReviewCase *c, Arena *arena, Error *err);
