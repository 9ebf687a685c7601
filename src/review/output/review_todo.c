/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_todo.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "review/output/review_words.h"
#include "review/pane_verdict.h"
#include "review/quantity.h"
#include "review/review_decide.h"
#include "review/road_verdict.h"
#include "review/terms.h"
#include "text/text.h"

#define LEAST_LEVEL 1e-3

static void part(Text *text, const char *words) {
    if (words[0] && !(text->data && strstr(text->data, words)))
        text_format(text, "%s%s", text->size ? "; " : "", words);
}

/* To three digits; away: -1 down, 1 up, so that a limit is kept as it is printed. */
static const char *figure_away(double value, int away, Arena *arena) {
    double digit = value > 0 ? pow_d(10, floor(log10_d(value)) - 2) : 1;
    double whole = away > 0 ? ceil(value / digit - 1e-9) : floor(value / digit + 1e-9);
    return arena_format(arena, "%.4g", whole * digit);
}

static const char *percent(double level, int away, Arena *arena) {
    return arena_format(arena, "%s %%", figure_away(100 * level, away, arena));
}

/* ---- a case ------------------------------------------------------------------------------ */

/* Of (H f + R)/(L f + R) = C, at the greatest level, the reflected light R, and the veil where the
 * limit's figure has it. */
static const char *reflect_less(const ReviewCase *c, const LimitVerdict *limit, Arena *arena) {
    const CaseLuminances *l = &c->luminance_cd_m2;
    double needed = ratio_from_contrast(limit_kind_named(limit->kind), limit->value);
    double veil = limit->has_veil ? l->veil : 0;
    double level = fmax(c->level, 1), times = level / c->level;
    double high = fmax(l->foreground, l->background), low = fmin(l->foreground, l->background);
    double most = times * (high - needed * low) / (needed - 1) - veil;
    if (!(high > needed * low))
        return arena_format(arena, TERM_CONTENT, words_figure(high / low, arena));
    if (!(most > 0 && most < l->reflected))
        return arena_format(arena, TERM_LESS_LIGHT, percent(level, 1, arena));
    return arena_format(arena, TERM_REFLECT_LESS, percent(level, 1, arena),
                        figure_away(most, -1, arena), words_figure(l->reflected, arena));
}

static const char *todo_of_light(const ReviewCase *c, const LimitVerdict *limit, Arena *arena) {
    const CaseRemedy *remedy = c->remedy_count ? &c->remedies[0] : NULL;
    if (remedy && remedy->then.verdict == VERDICT_PASS &&
        (words_same(remedy->then.name, limit->name) || remedy->verdict == VERDICT_PASS))
        return arena_format(arena, "%s: %s", remedy->what, words_remedy(remedy, arena));
    if (c->must_not_be_read) return TERM_NO_LEVEL_HIDES;
    if (!quantity_is_contrast(limit_kind_named(limit->kind))) return TERM_PURER;
    return limit_wants_less(limit) ? TERM_SOFTER : reflect_less(c, limit, arena);
}

static const char *todo_of_limit(const ReviewCase *c, const LimitVerdict *limit, Arena *arena) {
    LimitKind kind = limit_kind_named(limit->kind);
    const ReviewQuantity *of = quantity_of(limit);
    double times = limit->value / limit->found;
    const char *figure = figure_away(times, limit->is_upper ? -1 : 1, arena);
    if (of && of->is_of_light) return todo_of_light(c, limit, arena);
    if (kind == LIMIT_STROKE_RATIO) return arena_format(arena, TERM_STROKES, figure);
    if (kind != LIMIT_CHARACTER_HEIGHT) return "";
    return limit->is_upper ? arena_format(arena, TERM_SMALLER, figure)
                           : arena_format(arena, TERM_TALLER, figure);
}

/* Why the visibility level that a case hangs on is not known is the observer's age. */
static bool lacks_age(const ReviewCase *c) {
    const LimitVerdict *limit = case_worst_limit(c);
    bool is_level = limit && limit_kind_named(limit->kind) == LIMIT_VISIBILITY_LEVEL;
    for (int i = 0; is_level && i < c->visibility_count; i++)
        if (isnan(c->visibilities[i].level) && c->visibilities[i].doubts) return true;
    return false;
}

const char *todo_of_case(const ReviewCase *c, Arena *arena) {
    static const char *const TO_JUDGE[UNJUDGED_COUNT] = {[UNJUDGED_HIDDEN] = TERM_MOVE_HIDER,
                                                         [UNJUDGED_PANEL] = TERM_USABLE_PANEL,
                                                         [UNJUDGED_DATA] = TERM_GIVE_DATA,
                                                         [UNJUDGED_LIMIT] = TERM_GIVE_LIMIT,
                                                         [UNJUDGED_FIGURE] = TERM_GIVE_BACKGROUND};
    Text text = {.arena = arena};
    if (c->verdict == VERDICT_UNJUDGED) {
        if (c->is_optional || !TO_JUDGE[c->unjudged]) return "";
        return c->unjudged == UNJUDGED_FIGURE && lacks_age(c) ? TERM_GIVE_AGE
                                                              : TO_JUDGE[c->unjudged];
    }
    if (c->verdict == VERDICT_TOO_CLOSE) part(&text, words_decide(c, arena));
    for (int i = 0; i < c->limit_count; i++) {
        const LimitVerdict *limit = &c->limits[i];
        bool is_open = limit->verdict == VERDICT_TOO_CLOSE && c->remedy_count;
        if (!limit->is_advice && (limit->verdict == VERDICT_FAIL || is_open))
            part(&text, todo_of_limit(c, limit, arena));
    }
    return text.data ? text.data : "";
}

/* ---- a road ------------------------------------------------------------------------------ */

/* Of the road itself. display NULL: all by one factor. */
static const RoadDimming *dimming_of(const GazeRoad *road, const char *display, double age) {
    for (int i = 0; i < road->dimming_count; i++) {
        const RoadDimming *row = &road->dimming[i];
        bool is_road = fabs(row->road_cd_m2 - road->luminance_cd_m2) <= 1e-5 * row->road_cd_m2;
        if (row->age_years == age && is_road && !row->display == !display &&
            words_same(row->display, display))
            return row;
    }
    return NULL;
}

static const char *dim_words(const RoadDimming *row, Arena *arena) {
    const char *to = percent(row->level_most_range.low, -1, arena);
    if (row->level_least_sure > row->level_most_range.low)
        return arena_format(
            arena, TERM_NO_LEVEL_DOES_BOTH, row->display ? row->display : "the displays", to,
            row->symbol ? row->symbol : "what is read",
            isfinite(row->level_least_sure) ? percent(row->level_least_sure, 1, arena)
                                            : "more than it has");
    return row->display ? arena_format(arena, TERM_DIM_DISPLAY, row->display,
                                       percent(row->level, 0, arena), to)
                        : arena_format(arena, TERM_DIM_ALL, to);
}

static bool is_dimmable(const RoadDimming *row) {
    return row && row->level_most_range.low >= LEAST_LEVEL &&
           row->level_most_range.low < row->level;
}

/* By the one that makes most; else by all; else no display helps. */
static const char *todo_of_road(const GazeFinding *gaze, Arena *arena) {
    const GazeRoad *road = gaze->road;
    const RoadAge *age = gaze_worst_age(gaze);
    double share = 0;
    const RoadDimming *all = dimming_of(road, NULL, age->age_years);
    for (int i = 0; i < age->display_count; i++) {
        const RoadDimming *row = dimming_of(road, age->displays[i].display, age->age_years);
        share += age->displays[i].share;
        if (is_dimmable(row)) return dim_words(row, arena);
    }
    if (is_dimmable(all)) return dim_words(all, arena);
    LimitVerdict rest = age->limit;
    double left = fmax(1 - share, 0);
    rest.found = left * age->increment_pct;
    rest.low = left * age->increment_range.low;
    rest.high = left * age->increment_range.high;
    rest.age_years = 0;
    return arena_format(arena, TERM_NOTHING_HERE, words_found(&rest, arena),
                        words_bound(&rest, arena));
}

/* ---- the others -------------------------------------------------------------------------- */

static const char *todo_of_pane(const PaneFinding *f, Arena *arena) {
    double share = pane_level_share(f);
    return isnan(share)
               ? arena_format(arena, TERM_NO_LEVEL_DIMS, f->display)
               : arena_format(arena, TERM_DIM_IMAGE "%s", f->display, percent(share, -1, arena),
                              words_breaks(f->breaks, f->break_count, arena));
}

static const char *todo_of_gaze(const Finding *f, Arena *arena) {
    const GazeFinding *gaze = f->gaze;
    if (limit_kind_named(f->worst->kind) == LIMIT_THRESHOLD_INCREMENT)
        return todo_of_road(gaze, arena);
    return gaze->mirrored_by
               ? arena_format(arena, TERM_DARKER, gaze->mirrored_from, gaze->mirrored_by)
               : TERM_SHADE;
}

const char *todo_of_finding(const Finding *f, Arena *arena) {
    if (f->c) return todo_of_case(f->c, arena);
    if (f->verdict == VERDICT_PASS || !f->worst) return "";
    if (f->verdict == VERDICT_UNJUDGED) return TERM_GIVE_DATA;
    if (f->pane) return todo_of_pane(f->pane, arena);
    return f->gaze ? todo_of_gaze(f, arena) : arena_format(arena, TERM_MATT, f->subject);
}
