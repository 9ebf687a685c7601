/* SPDX-License-Identifier: Apache-2.0 */
/* A symbol's shape as an eye sees it, whatever the light. */
#include "review/quantity.h"

static Figure find_height(const Evidence *e, bool is_upper) {
    (void)is_upper;
    return figure_exact(e->c->height_arcmin);
}

static Figure find_stroke(const Evidence *e, bool is_upper) {
    (void)is_upper;
    return figure_exact(e->c->stroke_ratio);
}

const ReviewQuantity quantity_character_height = {
    .unit = "arcmin", .words = "height", .find = find_height};

const ReviewQuantity quantity_stroke_ratio = {
    .unit = "1", .words = "stroke ratio", .may_be_missing = true, .find = find_stroke};

const ReviewQuantity quantity_width_ratio = {
    .unit = "1", .words = "width ratio", .may_be_missing = true};
