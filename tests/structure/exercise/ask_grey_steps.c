/* SPDX-License-Identifier: Apache-2.0 */
/* The steps of DICOM's grey scale between a symbol and its background. */
#include "review/quantity.h"

static Figure find(const Evidence *e, bool is_upper) {
    (void)is_upper;
    return figure_exact(e->c->jnd);
}

const ReviewQuantity quantity_grey_steps = {
    .unit = "1", .words = "grey steps", .is_of_light = true, .find = find};
