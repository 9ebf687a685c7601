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

/* Of one that a limit is held against. */
static const char *pane_reason(const PaneFinding *f, Arena *arena) {
    return arena_format(arena, "contrast %s (" TERM_MAXIMUM " towards %s); %s cd/m² against %s, %s",
                        figure(f->contrast, f->contrast_range, arena),
                        words_number(f->limit.value, arena), f->area,
                        figure(f->image, f->image_range, arena),
                        figure(f->against, f->against_range, arena), words_pane_where(f, arena));
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
    if (f->pane) return pane_reason(f->pane, arena);
    if (limit_kind_named(worst->kind) == LIMIT_THRESHOLD_INCREMENT)
        return road_words(f->gaze, arena);
    return arena_format(arena, "%s (%s)", words_quantity(worst, arena), words_bound(worst, arena));
}
