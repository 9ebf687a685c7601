/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/finding_words.h"

#include <math.h>

#include "review/output/review_road.h"
#include "review/output/review_words.h"
#include "review/terms.h"

/* ---- words ------------------------------------------------------------------------------- */

const char *words_pane_where(const PaneFinding *f, Arena *arena) {
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
        words_pane_where(f, arena), figure(f->image, f->image_range, arena),
        figure(f->against, f->against_range, arena), figure(f->contrast, f->contrast_range, arena),
        range_words(f->contrast_range, arena));
    if (!f->has_limit) return light;
    return arena_format(arena, "%s (" TERM_MAXIMUM " towards %s)", light,
                        words_number(f->limit.value, arena), f->area);
}

/* ---- findings ----------------------------------------------------------------------------- */

const char *finding_name(const Finding *f, Arena *arena) {
    const char *name = words_named(f->subject, f->viewer, f->condition, arena);
    const ReviewSweep *s = f->sweep;
    if (!s) return name;
    return arena_format(arena, "%s (worst of %ld, fails: %s%s)", name, s->cases,
                        words_failing(s, arena), sweep_has_box(s) ? ", middle eye" : "");
}

const char *finding_reason(const Finding *f, Arena *arena) {
    const LimitVerdict *worst = f->worst;
    if (f->c) return words_reason(f->c, arena);
    if (f->pane) return review_pane_words(f->pane, arena);
    if (limit_kind_named(worst->kind) == LIMIT_THRESHOLD_INCREMENT)
        return road_words(f->gaze, arena);
    return arena_format(arena, "%s (%s)", words_quantity(worst, arena), words_bound(worst, arena));
}
