/* text_find.h -- proposes where a display's content shows text: lines of characters.
 *
 * Edges of the luminance are split blockwise, so that white on black, black on white and text on
 * a slow gradient are each found by their own threshold; connected parts of like height and
 * stroke that stand beside each other become lines. What a person reads as text is not known to
 * it: needles and icons may be among the proposals, and a person edits them.
 *
 * Units    uv of the content, v down; pixels of the content.
 * Memory   from the arena.  Threads  pure function: the same content gives the same list.
 */
#pragma once
#include "review/symbol/content_light.h"

typedef struct TextProposal {
    double uv[4];            /* left, top, right, bottom, with a margin of ground around */
    bool   is_light_on_dark;
    double height_px;        /* of its tallest character */
    int    part_count;       /* characters or pieces of them */
} TextProposal;

/* The `most` with the tallest characters, tallest first (equal ones: from the top, then from the
 * left). Returns how many. */
int text_find(const ContentLight *light, int most, Arena *arena, TextProposal **out);
