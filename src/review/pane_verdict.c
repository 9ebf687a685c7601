/* SPDX-License-Identifier: Apache-2.0 */
#include "review/pane_verdict.h"

#include <math.h>

#include "review/quantity.h"

static double over(double image, double against) {
    return image > 0 ? image / against : 0;
}

/* Of a quotient of two figures: what moving each to an end of its interval moves it by,
 * together as if by chance (Zou and Donner, Stat. Med. 27 (2008) 1693-1702). */
void pane_set_contrast(PaneFinding *f) {
    double c = f->contrast = over(f->image, f->against);
    double low[2] = {c - over(f->image_range.low, f->against),
                     c - over(f->image, f->against_range.high)};
    double high[2] = {over(f->image_range.high, f->against) - c,
                      over(f->image, f->against_range.low) - c};
    if (!isfinite(c)) {
        f->contrast_range = (MeanInterval){over(f->image_range.low, f->against_range.high), c};
        return;
    }
    f->contrast_range = (MeanInterval){fmax(c - sqrt(low[0] * low[0] + low[1] * low[1]), 0),
                                       c + sqrt(high[0] * high[0] + high[1] * high[1])};
}

void pane_judge(PaneFinding *f, const char *area, double contrast_most) {
    const LimitKindFacts *kind = &limit_kinds[LIMIT_LUMINANCE_CONTRAST];
    f->has_limit = true;
    f->limit = (LimitVerdict){.name = area,
                              .kind = kind->name,
                              .unit = kind->unit,
                              .source = "the request's pane_images",
                              .value = contrast_most,
                              .is_upper = true,
                              .found = f->contrast,
                              .low = f->contrast_range.low,
                              .high = f->contrast_range.high};
    f->limit.margin = quantity_margin(LIMIT_LUMINANCE_CONTRAST, true, f->contrast, contrast_most);
    f->limit.verdict = quantity_verdict(&f->limit);
}

bool pane_counts(const PaneFinding *f) {
    return f->has_limit && !f->none;
}

static bool is_worse(const LimitVerdict *a, const LimitVerdict *b) {
    int more = verdict_rank(a->verdict) - verdict_rank(b->verdict);
    return more > 0 || (more == 0 && a->margin < b->margin);
}

const PaneFinding *review_worst_pane(const Review *review) {
    const PaneFinding *worst = NULL;
    for (int i = 0; i < review->pane_image_count; i++) {
        const PaneFinding *f = &review->pane_images[i];
        if (pane_counts(f) && (!worst || is_worse(&f->limit, &worst->limit))) worst = f;
    }
    return worst;
}
