/* SPDX-License-Identifier: Apache-2.0 */
/* svg_text.h -- makes cairo's SVG the same every time, and fit to stand inside a page.
 *
 * Cairo numbers its elements by counters of the whole process; here every id gets a number by
 * its first appearance, behind a prefix that keeps several drawings of one page apart.
 *
 * Memory   the arena's. Threads: pure functions. Fails: never.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>

#include "base/arena.h"

typedef struct PlotBytes {
    unsigned char *data; /* data[size] is 0 */
    size_t         size;
} PlotBytes;

/* A copy with the ids renamed and the coordinates of paths cut to thousandths. is_inline:
 * without the XML declaration. */
PlotBytes svg_with_ids(PlotBytes svg, const char *prefix, bool is_inline, Arena *arena);
