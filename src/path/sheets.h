/* SPDX-License-Identifier: Apache-2.0 */
/* sheets.h -- sheets that lie in one plane: which of them a ray meets first.
 *
 * A sheet is a triangle that may let light through (MASK, BLEND, thin windows). Modellers lay
 * legends, films and masks exactly onto one another and onto what carries them, and a ray
 * tracer then reports any of them. The rule here: where depths can be distinguished, the nearer
 * comes first; else what comes later in the file is seen over what comes earlier, from either
 * side, and every sheet over what is opaque. A rasteriser that draws in the file's order shows
 * the same.
 *
 * Threads  const arguments.
 */
#pragma once
#include "bvh/bvh.h"

#define SHEETS_MAX 16 /* at one place; of more, those that come last in the file count */

/* The hits of a ray at one place, in this order. */
typedef struct SheetStack {
    Hit hit[SHEETS_MAX];
    int count, next; /* next: the first that the ray has not come to */
} SheetStack;

static inline void sheets_none(SheetStack *stack) {
    stack->count = stack->next = 0;
}

/* For shadow rays that no sheet stops, whatever its colour. */
static inline bool sheets_let_pass(void *user, const Hit *hit) {
    (void)user, (void)hit;
    return true;
}

/* Do hits of a ray at one depth mean one sheet: its triangles share the edge that was met? */
bool sheets_are_one(const Scene *scene, uint32_t triangle, uint32_t other);

/* All that a ray along `direction` (unit) meets where it met `met`: within the distance by
 * which rays start off a surface, which they would otherwise never see. Ends with `met` where
 * that is opaque. bvh_has_sheets(bvh) holds. The hits' t is met's. */
void sheets_at(const Scene *scene, const Bvh *bvh, const Hit *met, Vec3 direction, SheetStack *out);
