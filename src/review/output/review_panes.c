/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_panes.h"

#include <math.h>
#include <string.h>

#include "page/page.h"
#include "review/output/review_words.h"
#include "text/text.h"

/* ---- words ------------------------------------------------------------------------------- */

static const char *where_of(const PaneFinding *f, Arena *arena) {
    return arena_format(arena, "%.1f° %s, %.1f° %s", fabs(f->up_deg), f->up_deg < 0 ? "down" : "up",
                        fabs(f->right_deg), f->right_deg < 0 ? "left" : "right");
}

static const char *figure(double value, MeanInterval range, Arena *arena) {
    return words_within(value, range.low, range.high, arena);
}

static const char *range_words(MeanInterval range, Arena *arena) {
    return words_interval(range.low, range.high, arena);
}

const char *review_pane_words(const PaneFinding *f, Arena *arena) {
    if (f->none) return arena_format(arena, "%s in %s: no image, %s", f->display, f->pane, f->none);
    const char *light = arena_format(
        arena, "%s in %s, %s: %s cd/m² against %s, contrast %s (%s)", f->display, f->pane,
        where_of(f, arena), figure(f->image, f->image_range, arena),
        figure(f->against, f->against_range, arena), figure(f->contrast, f->contrast_range, arena),
        range_words(f->contrast_range, arena));
    if (!f->has_limit) return light;
    return arena_format(arena, "%s, at most %s towards %s", light,
                        words_number(f->limit.value, arena), f->area);
}

const char *review_pane_name(const PaneFinding *f, Arena *arena) {
    return arena_format(arena, "%s in %s, seen by %s, %s", f->display, f->pane, f->eye,
                        f->condition);
}

/* ---- the map ----------------------------------------------------------------------------- */

#define MAP_RIGHT 90 /* degrees to either side, up and down */
#define MAP_UP 40
#define MAP_LINE 10

static void add_axes(Text *svg) {
    text_format(svg,
                "<svg class=\"panes\" viewBox=\"%d %d %d %d\" role=\"img\" "
                "aria-label=\"where displays stand in glass\"><path class=\"axis\" d=\"",
                -MAP_RIGHT, -MAP_UP, 2 * MAP_RIGHT, 2 * MAP_UP);
    for (int x = -MAP_RIGHT; x <= MAP_RIGHT; x += MAP_LINE)
        text_format(svg, "M%d,%dv%d", x, -MAP_UP, 2 * MAP_UP);
    for (int y = -MAP_UP; y <= MAP_UP; y += MAP_LINE)
        text_format(svg, "M%d,%dh%d", -MAP_RIGHT, y, 2 * MAP_RIGHT);
    text_format(svg, "\"/><path class=\"axis\" style=\"stroke-opacity:.8\" d=\"M-2,0h4M0,-2v4"
                     "\"/><text class=\"tick\" x=\"0\" y=\"-2.6\">ahead</text>");
    for (int x = 30; x < MAP_RIGHT; x += 30)
        text_format(svg,
                    "<text class=\"tick\" x=\"%d\" y=\"%d\">%d° left</text>"
                    "<text class=\"tick\" x=\"%d\" y=\"%d\">%d° right</text>",
                    -x, MAP_UP - 1, x, x, MAP_UP - 1, x);
}

static const char *class_of(const PaneFinding *f) {
    return f->has_limit ? words_class(f->limit.verdict) : "none";
}

static void add_outline(Text *svg, const PaneFinding *f, int number) {
    text_format(svg, "<polygon class=\"%s\" points=\"", class_of(f));
    for (int i = 0; i + 1 < f->outline_count; i += 2)
        text_format(svg, "%s%.2f,%.2f", i ? " " : "", f->outline_deg[i], -f->outline_deg[i + 1]);
    text_format(svg, "\"/><text x=\"%.2f\" y=\"%.2f\">%d</text>", f->right_deg, 1 - f->up_deg,
                number);
}

static bool is_on_map(const PaneFinding *f) {
    return fabs(f->right_deg) < MAP_RIGHT && fabs(f->up_deg) < MAP_UP;
}

/* ---- values ------------------------------------------------------------------------------ */

/* An eye in a condition. */
static bool is_of_view(const PaneFinding *f, const PaneFinding *first) {
    return !strcmp(f->eye, first->eye) && !strcmp(f->condition, first->condition);
}

static void set_image(json_t *to, const PaneFinding *f, int number, Arena *arena) {
    page_set_count(to, "number", number);
    page_set(to, "where", where_of(f, arena));
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
    Text svg = {.arena = v->arena};
    int number = 0;
    page_set(view, "eye", review->pane_images[first].eye);
    page_set(view, "condition", review->pane_images[first].condition);
    add_axes(&svg);
    for (int i = first; i < review->pane_image_count; i++) {
        const PaneFinding *f = &review->pane_images[i];
        json_t *of = json_array_get(all, (size_t)i);
        if (!is_of_view(f, &review->pane_images[first])) continue;
        json_array_append(f->none ? hidden : images, of);
        if (f->none) continue;
        set_image(of, f, ++number, v->arena);
        if (is_on_map(f)) add_outline(&svg, f, number);
    }
    text_add(&svg, "</svg>");
    page_set(view, "svg", number ? svg.data : NULL);
    page_set_flag(view, "has_images", number > 0);
    page_set_flag(view, "has_hidden", json_array_size(hidden) > 0);
    page_set_count(view, "hidden_count", (int)json_array_size(hidden));
}

void values_add_panes(const PageValues *v) {
    const Review *review = v->review;
    const PaneFinding *worst = review_worst_pane(review);
    page_set_flag(v->doc, "has_panes", review->pane_image_count > 0);
    if (!review->pane_image_count) return;
    json_t *views = values_list(v->doc, "pane_views");
    for (int i = 0; i < review->pane_image_count; i++) {
        int k = 0;
        while (!is_of_view(&review->pane_images[k], &review->pane_images[i])) k++;
        if (k == i) add_view(v, views, i);
    }
    if (!worst) return;
    json_t *to = values_object(v->doc, "pane_worst");
    page_set(to, "eye", worst->eye);
    page_set(to, "condition", worst->condition);
    page_set(to, "words", review_pane_words(worst, v->arena));
}
