/* SPDX-License-Identifier: Apache-2.0 */
/* text_find.h -- proposes where a content shows text: lines of two characters or more.
 *
 * The content is cut at 15 levels of lightness; at each, the connected parts that are lighter,
 * and those that are darker, and are shaped like characters are gathered into lines. Of lines
 * that lie over each other the one with more, larger and sharper characters stays: so each text
 * is found by a level of its own, on any ground.
 *
 * Not found: a single letter; characters below 7 pixels or above a third of the rectangle's
 * height, or that touch its border, or whose pieces are apart (seven segments). What a person
 * reads as text is not known to it: marks and meshes of lines may be among the proposals.
 *
 * Units    uv of the content, v down; pixels of the content; lightness 0..1.
 * Memory   from the arena.  Threads  pure function: the same content gives the same list.
 */
#pragma once
#include "review/symbol/content_light.h"

typedef struct TextProposal {
    double uv[4]; /* left, top, right, bottom, with a margin of ground around */
    bool is_light_on_dark;
    int height_px;  /* of its tallest character */
    int characters; /* or pieces of them, without dots */
} TextProposal;

/* The `most` with the tallest characters, tallest first (of equal ones: the topmost, then the
 * leftmost). Returns how many. */
int text_find(const ContentLight *light, int most, Arena *arena, TextProposal **out);
