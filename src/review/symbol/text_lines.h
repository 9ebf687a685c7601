/* SPDX-License-Identifier: Apache-2.0 */
/* text_lines.h -- characters that stand beside each other are a line.
 *
 * Units    pixels.  Memory  from the arena.  Threads  pure function.
 */
#pragma once
#include "review/symbol/text_parts.h"

typedef struct ProposedLine {
    int    left, top, right, bottom; /* of characters and their dots, first and last */
    int    height;      /* of its tallest character */
    int    characters;  /* at least 2 */
    double weight;      /* sum of the characters' steps squared, times the root of height */
    bool   is_light;
} ProposedLine;

/* parts: from left to right. Returns how many. */
int text_lines(const TextPart *parts, int count, bool is_light, Arena *arena,
               ProposedLine **out);
