/* SPDX-License-Identifier: Apache-2.0 */
#include "review/private_image.h"

#include <math.h>
#include <string.h>

#include "review/quantity.h"
#include "vision/privacy.h"

/* ---- its image in glass ------------------------------------------------------------------ */

enum { REFLECTANCE, AGAINST, BRIGHTER, DARKER, INPUTS };

static double ratio_at(const double *at, const void *user) {
    const CaseImage *i = user;
    double high = fmax(i->sent_foreground, i->sent_background) * at[BRIGHTER];
    double low = fmin(i->sent_foreground, i->sent_background) * at[DARKER];
    if (isnan(i->sent_foreground) || isnan(i->sent_background)) return (double)NAN;
    return luminance_contrast(at[REFLECTANCE] * high, at[REFLECTANCE] * low, at[AGAINST]);
}

void case_image_set_contrast(CaseImage *i, double emission_error) {
    double off = INTERVAL_SIGMAS * emission_error;
    const IntervalInput in[INPUTS] = {
        [REFLECTANCE] = {i->reflectance, i->reflectance_range.low, i->reflectance_range.high},
        [AGAINST] = {i->against, i->against_range.high, i->against_range.low},
        [BRIGHTER] = {1, fmax(1 - off, 0), 1 + off},
        [DARKER] = {1, 1 + off, fmax(1 - off, 0)}};
    FigureInterval range = interval_of(ratio_at, i, in, INPUTS);
    i->foreground = i->reflectance * i->sent_foreground;
    i->background = i->reflectance * i->sent_background;
    i->contrast_ratio = ratio_at((double[INPUTS]){i->reflectance, i->against, 1, 1}, i);
    i->contrast_low = range.low < 1 ? 1 : range.low; /* NaN stays */
    i->contrast_high = range.high;
}

const CaseImage *case_images_scaled(const ReviewCase *c, double factor, Arena *arena) {
    CaseImage *out = ARENA_NEW(arena, CaseImage, c->image_count);
    for (int k = 0; k < c->image_count; k++) {
        out[k] = c->images[k];
        out[k].sent_foreground *= factor;
        out[k].sent_background *= factor;
        case_image_set_contrast(&out[k], c->panel.emission_error);
    }
    return out;
}

const CaseImage *case_image_of(const ReviewCase *c, const LimitVerdict *limit) {
    for (int k = 0; limit && limit->by_pane && k < c->image_count; k++)
        if (!strcmp(c->images[k].pane, limit->by_pane)) return &c->images[k];
    return NULL;
}

/* ---- the quantity ------------------------------------------------------------------------ */

static Figure find(const Evidence *e, bool is_upper) {
    const ReviewCase *c = e->c;
    (void)is_upper;
    return (Figure){.found = privacy_s_of_contrast(c->contrast_ratio),
                    .low = privacy_s_of_contrast(c->contrast_high),
                    .high = privacy_s_of_contrast(c->contrast_low),
                    .sampling = {c->sampling_share[1], c->sampling_share[0]}};
}

const ReviewQuantity quantity_visual_security = {.unit = "1",
                                                 .words = "visual security S",
                                                 .of = OF_PRIVATE,
                                                 .is_of_light = true,
                                                 .falls = true,
                                                 .has_one_bound = true,
                                                 .find = find,
                                                 .from_ratio = privacy_s_of_contrast,
                                                 .to_ratio = privacy_contrast_of_s};
