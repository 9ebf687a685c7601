/* SPDX-License-Identifier: Apache-2.0 */
#include "review/private_image.h"

#include <math.h>
#include <string.h>

#include "base/count.h"

/* With R, B, and factors on what the brighter and the darker part send. */
static double ratio_at(const CaseImage *i, double r, double b, const double factors[2]) {
    double high = fmax(i->sent_foreground, i->sent_background) * factors[0];
    double low = fmin(i->sent_foreground, i->sent_background) * factors[1];
    if (isnan(i->sent_foreground) || isnan(i->sent_background)) return (double)NAN;
    return luminance_contrast(r * high, r * low, b);
}

static double end_of(const CaseImage *i, double emission_error, double sign) {
    static const double AS_THEY_ARE[2] = {1, 1};
    bool is_low = sign < 0;
    double r = is_low ? i->reflectance_range.low : i->reflectance_range.high;
    double b = is_low ? i->against_range.high : i->against_range.low;
    double off = sign * INTERVAL_SIGMAS * emission_error, squares = 0;
    const double bright[2] = {fmax(1 + off, 0), 1}, dark[2] = {1, fmax(1 - off, 0)};
    double middle = i->contrast_ratio;
    const double ends[] = {ratio_at(i, r, i->against, AS_THEY_ARE),
                           ratio_at(i, i->reflectance, b, AS_THEY_ARE),
                           ratio_at(i, i->reflectance, i->against, bright),
                           ratio_at(i, i->reflectance, i->against, dark)};
    if (!isfinite(middle)) return ratio_at(i, r, b, AS_THEY_ARE);
    for (int k = 0; k < COUNT_OF(ends); k++) squares += (ends[k] - middle) * (ends[k] - middle);
    return is_low ? fmax(middle - sqrt(squares), 1) : middle + sqrt(squares);
}

void case_image_set_contrast(CaseImage *i, double emission_error) {
    static const double AS_THEY_ARE[2] = {1, 1};
    i->foreground = i->reflectance * i->sent_foreground;
    i->background = i->reflectance * i->sent_background;
    i->contrast_ratio = ratio_at(i, i->reflectance, i->against, AS_THEY_ARE);
    i->contrast_low = end_of(i, emission_error, -1);
    i->contrast_high = end_of(i, emission_error, 1);
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
