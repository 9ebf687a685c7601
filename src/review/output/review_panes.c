/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_panes.h"

#include <math.h>
#include <string.h>

#include "page/page.h"
#include "review/finding.h"
#include "review/output/finding_words.h"
#include "review/output/review_words.h"
#include "review/terms.h"
#include "text/text.h"

static const char *figure(double value, MeanInterval range, Arena *arena) {
    return words_within(value, range.low, range.high, arena);
}

static const char *range_words(MeanInterval range, Arena *arena) {
    return words_interval(range.low, range.high, arena);
}

/* ---- values ------------------------------------------------------------------------------ */

/* An eye in a condition. */
static bool is_of_view(const PaneFinding *f, const PaneFinding *first) {
    return !strcmp(f->eye, first->eye) && !strcmp(f->condition, first->condition);
}

static void set_image(json_t *to, const PaneFinding *f, Arena *arena) {
    page_set(to, "where", words_pane_where(f, arena));
    page_set(to, "size", arena_format(arena, "%.1f° × %.1f°", f->width_deg, f->height_deg));
    page_set(to, "ghost",
             isnan(f->ghost_arcmin) ? NULL : arena_format(arena, "ghost %.1f′", f->ghost_arcmin));
    page_set(to, "image_words", figure(f->image, f->image_range, arena));
    page_set(to, "image_range", range_words(f->image_range, arena));
    page_set(to, "behind_words", figure(f->behind, f->behind_range, arena));
    page_set(to, "against_words", figure(f->against, f->against_range, arena));
    page_set(to, "contrast_words", figure(f->contrast, f->contrast_range, arena));
    page_set(to, "contrast_range", range_words(f->contrast_range, arena));
    if (!f->has_limit) return;
    values_set_verdict(to, f->limit.verdict);
    page_set(to, "most", words_number(f->limit.value, arena));
}

/* Of the findings from `first` on those that the same eye has in the same condition. */
static void add_view(const PageValues *v, json_t *list, int first) {
    const Review *review = v->review;
    json_t *view = page_add(list), *all = json_object_get(v->doc, "pane_images");
    json_t *images = values_list(view, "images"), *hidden = values_list(view, "hidden");
    page_set(view, "eye", review->pane_images[first].eye);
    page_set(view, "condition", review->pane_images[first].condition);
    for (int i = first; i < review->pane_image_count; i++) {
        const PaneFinding *f = &review->pane_images[i];
        json_t *of = json_array_get(all, (size_t)i);
        if (!is_of_view(f, &review->pane_images[first])) continue;
        json_array_append(f->none ? hidden : images, of);
        if (f->none) continue;
        set_image(of, f, v->arena);
    }
}

void values_add_panes(const PageValues *v) {
    const Review *review = v->review;
    json_t *views = values_list(v->doc, "pane_views");
    for (int i = 0; i < review->pane_image_count; i++) {
        int k = 0;
        while (!is_of_view(&review->pane_images[k], &review->pane_images[i])) k++;
        if (k == i) add_view(v, views, i);
    }
}
