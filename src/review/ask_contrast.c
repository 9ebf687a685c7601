/* SPDX-License-Identifier: Apache-2.0 */
/* The contrasts of a symbol: a ratio, and what other standards make of it; and that of a display
 * as glass shows it. */
#include <math.h>

#include "review/pane_verdict.h"
#include "review/profile.h"
#include "review/quantity.h"

static double same(double ratio) {
    return ratio;
}

static double weber_from_ratio(double ratio) {
    return ratio - 1;
}

static double weber_to_ratio(double contrast) {
    return contrast + 1;
}

static double michelson_from_ratio(double ratio) {
    return isinf(ratio) ? 1 : (ratio - 1) / (ratio + 1);
}

static double michelson_to_ratio(double contrast) {
    return contrast < 1 ? (1 + contrast) / (1 - contrast) : (double)INFINITY;
}

/* A contrast ratio is 1 + d/(k + r): d between the two luminances, k the darker, r reflected; a
 * veil v makes it 1 + d/(k + r + v). So 1/(ratio - 1) grows by v/d, and by as much at the ends
 * of an interval as for the case's own ratio. Rising with the ratio, so that ends stay ends. */
static double below_veil(const ReviewCase *c, double ratio) {
    if (!(ratio > 1 && c->contrast_ratio > 1 && c->contrast_with_veil > 1)) return ratio;
    double veil = 1 / (c->contrast_with_veil - 1) - 1 / (c->contrast_ratio - 1);
    return 1 + 1 / (1 / (ratio - 1) + veil);
}

static Figure find(const Evidence *e, double (*from_ratio)(double)) {
    const ReviewCase *c = e->c;
    bool has_veil = e->profile->uses_veil;
    double found = has_veil ? c->contrast_with_veil : c->contrast_ratio;
    double low = has_veil ? below_veil(c, c->contrast_low) : c->contrast_low;
    double high = has_veil ? below_veil(c, c->contrast_high) : c->contrast_high;
    return (Figure){.found = from_ratio(found),
                    .low = from_ratio(low > found ? found : low), /* by rounding */
                    .high = from_ratio(high < found ? found : high),
                    .sampling = {c->sampling_share[0], c->sampling_share[1]},
                    .has_veil = has_veil};
}

static Figure find_ratio(const Evidence *e, bool is_upper) {
    (void)is_upper;
    return find(e, same);
}

static Figure find_weber(const Evidence *e, bool is_upper) {
    (void)is_upper;
    return find(e, weber_from_ratio);
}

static Figure find_michelson(const Evidence *e, bool is_upper) {
    (void)is_upper;
    return find(e, michelson_from_ratio);
}

static Figure find_image(const Evidence *e, bool is_upper) {
    const PaneFinding *f = e->pane;
    (void)is_upper;
    return (Figure){
        .found = f->contrast, .low = f->contrast_range.low, .high = f->contrast_range.high};
}

const ReviewQuantity quantity_contrast_ratio = {.unit = "1",
                                                .words = "contrast",
                                                .sign = ": 1",
                                                .is_of_light = true,
                                                .find = find_ratio,
                                                .from_ratio = same,
                                                .to_ratio = same};

const ReviewQuantity quantity_luminance_contrast = {.unit = "1",
                                                    .words = "luminance contrast",
                                                    .is_of_light = true,
                                                    .find = find_weber,
                                                    .from_ratio = weber_from_ratio,
                                                    .to_ratio = weber_to_ratio};

const ReviewQuantity quantity_modulation = {.unit = "1",
                                            .words = "modulation",
                                            .is_of_light = true,
                                            .below = 1,
                                            .find = find_michelson,
                                            .from_ratio = michelson_from_ratio,
                                            .to_ratio = michelson_to_ratio};

const ReviewQuantity quantity_image_contrast = {.unit = "1",
                                                .words = "contrast of the image",
                                                .of = OF_PANE,
                                                .is_of_light = true,
                                                .has_one_bound = true,
                                                .is_upper = true,
                                                .find = find_image,
                                                .from_ratio = weber_from_ratio,
                                                .to_ratio = weber_to_ratio};
