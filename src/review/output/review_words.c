/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_words.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mathd.h"
#include "base/number.h"
#include "plot/draw/ticks.h"
#include "review/private_image.h"
#include "review/quantity.h"
#include "review/review_decide.h"
#include "review/terms.h"
#include "text/interval_text.h"
#include "text/text.h"
#include "vision/visibility.h"

bool words_same(const char *a, const char *b) {
    return !strcmp(a ? a : "", b ? b : "");
}

WordList words_list(int most, Arena *arena) {
    return (WordList){ARENA_NEW(arena, const char *, most), 0};
}

void words_list_add(WordList *names, const char *name) {
    for (int i = 0; i < names->count; i++)
        if (words_same(names->list[i], name)) return;
    names->list[names->count++] = name ? name : "";
}

const char *words_figure(double value, Arena *arena) {
    char text[32];
    if (isnan(value)) return "–";
    if (isinf(value)) return value > 0 ? "∞" : "−∞";
    if (fabs(value) < 1 && fabs(value) >= 1e-4) return arena_format(arena, "%.3g", value);
    if (fabs(value) >= 1e4 && fabs(value) < 1e15) {
        double unit = pow_d(10, floor(log10_d(fabs(value))) - 3);
        return arena_format(arena, "%.0f", unit * floor(value / unit + 0.5));
    }
    return arena_format(arena, "%s", figure_text(value, text));
}

const char *words_within(double value, double low, double high, Arena *arena) {
    bool has_interval = isfinite(value) && isfinite(low) && isfinite(high) && low < high;
    return has_interval ? interval_value_text(value, low, high, arena) : words_figure(value, arena);
}

const char *words_contrast(const ReviewCase *c, Arena *arena) {
    if (isnan(c->contrast_ratio)) return "–";
    return arena_format(arena, "%s : 1",
                        words_within(c->contrast_ratio, c->contrast_low, c->contrast_high, arena));
}

const char *words_interval(double low, double high, Arena *arena) {
    if (isnan(low) || isnan(high)) return "–";
    if (low == high) return "exact";
    return arena_format(arena, "%s to %s", words_within(low, low, high, arena),
                        words_within(high, low, high, arena));
}

const char *words_share(double share, Arena *arena) {
    double percent = 100 * share;
    if (isnan(share)) return "–";
    if (percent > 0 && percent < 0.1) return "less than 0.1 %";
    if (percent > 99.9 && percent < 100) return "more than 99.9 %";
    bool is_near_an_end = (percent > 0 && percent < 10) || (percent > 99 && percent < 100);
    return arena_format(arena, "%.*f %%", is_near_an_end ? 1 : 0, percent);
}

const char *words_margin(double margin, Arena *arena) {
    if (isnan(margin)) return "–";
    if (isinf(margin)) return "∞";
    double percent = 100 * margin, size = fabs(percent);
    const char *sign = margin < 0 ? "−" : margin > 0 ? "+" : "±";
    return arena_format(arena, "%s%.*f %%", sign, size < 10 ? 1 : 0, size);
}

/* A figure that was written already, with the unit of the limit behind it. */
static const char *with_unit(const LimitVerdict *limit, const char *figure, Arena *arena) {
    const ReviewQuantity *of = quantity_of(limit);
    const char *unit = of && of->sign ? of->sign : limit->unit ? limit->unit : "";
    if (!strcmp(unit, "arcmin")) unit = "arc min";
    if (!strcmp(unit, "cd/m2")) unit = "cd/m²";
    return unit[0] && strcmp(unit, "1") != 0 ? arena_format(arena, "%s %s", figure, unit) : figure;
}

/* Rounded to the limit's other side, or onto it, a figure would belie its verdict. */
static bool is_belied(const LimitVerdict *limit, const char *figure) {
    double shown = 0;
    number_read(figure, &shown);
    double is = limit->found - limit->value, looks = shown - limit->value;
    return isfinite(limit->found) && is != 0 && !(is * looks > 0);
}

/* Whose it is, where it is somebody's; where, where glass shows it; from what. */
static const char *with_age(const LimitVerdict *limit, const char *figure, Arena *arena) {
    if (limit->by_pane) return arena_format(arena, "%s in %s", figure, limit->by_pane);
    if (limit->beside) return arena_format(arena, "%s from %s", figure, limit->beside);
    if (!(limit->age_years > 0)) return figure;
    return arena_format(arena, "%s at %g years", figure, limit->age_years);
}

/* The figure as people read it, without its unit. */
static const char *shown_figure(const LimitVerdict *limit, Arena *arena) {
    const char *figure = words_within(limit->found, limit->low, limit->high, arena);
    for (int digits = 4; digits <= 9 && is_belied(limit, figure); digits++)
        figure = arena_format(arena, "%.*g", digits, limit->found);
    return figure;
}

const char *words_found(const LimitVerdict *limit, Arena *arena) {
    if (isnan(limit->found)) return "–";
    return with_age(limit, with_unit(limit, shown_figure(limit, arena), arena), arena);
}

/* Of the figure as it is shown: whoever divides the two gets this. */
const char *words_from_limit(const LimitVerdict *limit, Arena *arena) {
    double found = limit ? limit->found : (double)NAN;
    if (isfinite(found)) number_read(shown_figure(limit, arena), &found);
    double times = limit ? found / limit->value : (double)NAN;
    double percent = 100 * fabs(times - 1);
    if (isnan(times)) return "–";
    const char *bound = limit->is_upper ? "maximum" : "minimum";
    if (isinf(times)) return arena_format(arena, TERM_FAR_ABOVE, bound);
    if (times < 0) return arena_format(arena, TERM_FAR_BELOW, bound); /* of a logarithm */
    if (times >= 2) return arena_format(arena, TERM_TIMES, words_figure(times, arena), bound);
    if (!(percent > 0)) return arena_format(arena, TERM_ON, bound);
    const char *by = percent < 0.1 ? "less than 0.1"
                                   : arena_format(arena, "%.*f", percent < 10 ? 1 : 0, percent);
    return arena_format(arena, times > 1 ? TERM_ABOVE : TERM_BELOW, by, bound);
}

const char *words_kind(const LimitVerdict *limit) {
    const ReviewQuantity *of = quantity_of(limit);
    return of ? of->words : limit->name ? limit->name : "";
}

const char *words_measured(const LimitVerdict *limit, Arena *arena) {
    const char *figure = interval_text(limit->found, limit->low, limit->high, arena);
    if (is_belied(limit, figure)) figure = arena_format(arena, "%.9g", limit->found);
    return with_age(limit, with_unit(limit, figure, arena), arena);
}

const char *words_quantity(const LimitVerdict *limit, Arena *arena) {
    const char *found = words_found(limit, arena);
    LimitKind kind = limit_kind_named(limit->kind);
    if (kind == LIMIT_CONTRAST_RATIO) return found;
    if (kind == LIMIT_CHARACTER_HEIGHT) return arena_format(arena, "%s high", found);
    return arena_format(arena, "%s %s", words_kind(limit), found);
}

const char *words_ratio_as(const ReviewCase *c, double ratio, Arena *arena) {
    bool has_limit = c->limit_id >= 0 && c->limit_id < c->limit_count;
    LimitVerdict as = {.kind = limit_kind_names[LIMIT_CONTRAST_RATIO]};
    if (has_limit) as = c->limits[c->limit_id];
    as.found = as.low = as.high = contrast_from_ratio(limit_kind_named(as.kind), ratio);
    return words_quantity(&as, arena);
}

const char *words_judged(const ReviewCase *c, Arena *arena) {
    const LimitVerdict *limit = case_worst_limit(c);
    if (case_kept_by(c) == KEPT_HIDDEN) return "hidden";
    if (c->unjudged == UNJUDGED_HIDDEN && c->visible_share > 0) return "mostly hidden";
    if (c->unjudged) return unjudged_names[c->unjudged];
    return limit ? words_quantity(limit, arena) : words_contrast(c, arena);
}

const char *words_number(double value, Arena *arena) {
    return isfinite(value) ? arena_format(arena, "%.4g", value) : words_figure(value, arena);
}

const char *words_minutes(double minutes, Arena *arena) {
    if (isnan(minutes)) return "–";
    if (minutes < 60) return arena_format(arena, "%.*g min", minutes < 1 ? 1 : 2, minutes);
    long whole = lround(minutes);
    return whole % 60 ? arena_format(arena, "%ld h %ld min", whole / 60, whole % 60)
                      : arena_format(arena, "%ld h", whole / 60);
}

static const char *words_limit(const LimitVerdict *limit, Arena *arena) {
    return with_unit(limit, words_number(limit->value, arena), arena);
}

const char *words_required(const LimitVerdict *limit, Arena *arena) {
    return arena_format(arena, "%s %s%s", limit->is_upper ? "<=" : ">=", words_limit(limit, arena),
                        limit->is_advice ? " (advice)" : "");
}

const char *words_bound(const LimitVerdict *limit, Arena *arena) {
    const char *of = words_limit(limit, arena);
    return arena_format(arena, "%s%s",
                        limit->is_upper ? arena_format(arena, TERM_MAXIMUM, of)
                                        : arena_format(arena, TERM_MINIMUM, of),
                        limit->is_advice ? ", advice" : "");
}

const char *words_verdict(Verdict verdict) {
    static const char *const WORDS[4] = {"Passes", "Fails", "Too close to call",
                                         "Cannot be judged"};
    return WORDS[verdict];
}

bool sweep_has_box(const ReviewSweep *sweep) {
    return !isnan(sweep->worst.eye_failed_share);
}

static const char *share_words(const ReviewSweep *sweep, Arena *arena) {
    double minutes = sweep->failed_minutes;
    const char *of = sweep->headings ? arena_format(arena, " (%s)", sweep->headings) : "";
    if (minutes >= 600)
        return arena_format(arena, "%s hours a year%s", words_figure(minutes / 60, arena), of);
    if (minutes > 0)
        return arena_format(arena, "%s minutes a year%s", words_figure(minutes, arena), of);
    if (!isnan(sweep->longest_failure_minutes))
        return arena_format(arena, "%s of the time", words_share(sweep->failed_share, arena));
    return arena_format(arena, "%ld of %ld tested sun positions",
                        lround(sweep->failed_share * (double)sweep->cases), sweep->cases);
}

const char *words_failing(const ReviewSweep *sweep, Arena *arena) {
    if (!(sweep->failed_share > 0)) return "never";
    const char *share = share_words(sweep, arena);
    if (!(sweep->longest_failure_minutes > 0)) return share;
    return arena_format(arena, "%s, %s at a stretch", share,
                        words_minutes(sweep->longest_failure_minutes, arena));
}

/* "middle eye: 340 minutes a year, at its worst 1.69 : 1". */
static const char *words_middle(const ReviewSweep *sweep, Arena *arena) {
    const char *often = words_failing(sweep, arena);
    if (!(sweep->middle_contrast > 0)) return arena_format(arena, "middle eye: %s", often);
    return arena_format(arena, "middle eye: %s, at its worst %s", often,
                        words_ratio_as(&sweep->worst, sweep->middle_contrast, arena));
}

const char *words_sweep_colour(const ReviewSweep *sweep) {
    return sweep->worst.colour_count ? TERM_COLOUR_AT_WORST : "";
}

const char *words_how_often(const ReviewSweep *sweep, Arena *arena) {
    static const char *const NAMES[4] = {"never", "at its worst", "too close", "cannot be judged"};
    Verdict verdict = sweep_verdict(sweep);
    if (verdict == VERDICT_FAIL && sweep_has_box(sweep))
        return arena_format(arena, "%s of eyes at its worst; %s",
                            words_share(sweep->worst.eye_failed_share, arena),
                            words_middle(sweep, arena));
    bool is_share = verdict == VERDICT_FAIL && sweep->failed_share > 0;
    return is_share ? words_failing(sweep, arena) : NAMES[verdict];
}

const char *words_mark(Verdict verdict) {
    static const char *const MARKS[4] = {"✓", "✗", "≈", "∅"};
    return MARKS[verdict];
}

const char *words_class(Verdict verdict) {
    static const char *const CLASSES[4] = {"good", "bad", "close", "hidden"};
    return CLASSES[verdict];
}

const char *words_ambient(Ambient ambient) {
    static const char *const WORDS[4] = {"at night", "in twilight", "by day", "in direct sun"};
    return WORDS[ambient];
}

int words_eighth(double azimuth_deg) {
    double turns = azimuth_deg / 360;
    return (int)floor((turns - floor(turns)) * 8 + 0.5) % 8;
}

const char *const *words_directions(bool is_of_vehicle) {
    static const char *const WORDS[2][8] = {
        {"in the north", "in the north-east", "in the east", "in the south-east", "in the south",
         "in the south-west", "in the west", "in the north-west"},
        {"ahead", "ahead on the right", "on the right", "behind on the right", "behind",
         "behind on the left", "on the left", "ahead on the left"}};
    return WORDS[is_of_vehicle];
}

const char *words_sun(const ReviewCase *c, const char *const *directions, Arena *arena) {
    if (!c->has_sun) return "no sun above the horizon";
    if (!isfinite(c->sun_azimuth_deg) || !isfinite(c->sun_elevation_deg)) return "sun is up";
    const char *where = directions ? directions[words_eighth(c->sun_azimuth_deg)] : "";
    return arena_format(arena, "sun %.1f° high, %s%sazimuth %.1f°", c->sun_elevation_deg, where,
                        where[0] ? ", " : "", c->sun_azimuth_deg);
}

const char *words_decide(const ReviewCase *c, Arena *arena) {
    static const char *const WITHIN[OPEN_COUNT] = {
        [OPEN_BY_PANEL] = "the panel's own stated error",
        [OPEN_BY_SUN] = "what is known of the sun's image in the display",
        [OPEN_BY_VEIL] = "what is known of the veil in the eye",
        [OPEN_BY_IMAGE] = "what is known of its image in the glass"};
    if (case_is_undecidable(c)) return arena_format(arena, TERM_NO_PATHS, WITHIN[c->open_by]);
    return c->open_by == OPEN_BY_PATHS ? TERM_MORE_PATHS : "";
}

#define HIDERS_LISTED 3

const char *words_hiders(const ReviewCase *c, Arena *arena) {
    Text text = {.arena = arena};
    double rest = 0;
    for (int i = 0; i < c->hider_count; i++) {
        const CaseHider *hider = &c->hiders[i];
        if (i >= HIDERS_LISTED) rest += hider->share;
        else
            text_format(&text, "%s%s %s", i ? ", " : "", hider->what,
                        words_share(hider->share, arena));
    }
    if (rest > 0) text_format(&text, ", others %s", words_share(rest, arena));
    return text.data ? text.data : "";
}

const char *words_precision(const ReviewCase *c, Arena *arena) {
    if (!(c->precision_reached > c->precision_asked)) return "";
    return arena_format(arena, TERM_KNOWN_WITHIN, words_share(c->precision_reached, arena),
                        words_share(c->precision_asked, arena));
}

static const char *words_seen(const ReviewCase *c, Arena *arena) {
    if (!(c->visible_share > 0)) return c->must_not_be_read ? TERM_UNSEEN_BY_MIDDLE : TERM_UNSEEN;
    return arena_format(arena, TERM_SEEN, words_share(c->visible_share, arena),
                        words_share(SEEN_LEAST, arena));
}

/* Of a case whose verdict hangs on a visibility level that is not known: why there is none;
 * NULL: it hangs on something else, or nobody knows. */
static const char *level_doubted(const ReviewCase *c) {
    const LimitVerdict *limit = case_worst_limit(c);
    if (!limit || limit_kind_named(limit->kind) != LIMIT_VISIBILITY_LEVEL) return NULL;
    for (int i = 0; i < c->visibility_count; i++)
        if (isnan(c->visibilities[i].level)) return c->visibilities[i].doubts;
    return NULL;
}

const char *words_unjudged(const ReviewCase *c, Arena *arena) {
    const LimitVerdict *limit = case_worst_limit(c);
    switch (c->unjudged) {
    case UNJUDGED_HIDDEN:
        return arena_format(arena, "%s%s%s%s", words_seen(c, arena),
                            c->hider_count ? TERM_HIDDEN_BY : "", words_hiders(c, arena),
                            c->is_optional ? "; this eye need not see it" : "");
    case UNJUDGED_PANEL:
        return arena_format(arena, TERM_PANEL_UNUSABLE "%s%s", c->panel.reason ? ": " : "",
                            c->panel.reason ? c->panel.reason : "");
    case UNJUDGED_DATA:
        return arena_format(arena, TERM_WITHOUT_DATA, words_share(c->without_data_share, arena),
                            words_share(UNJUDGED_DATA_SHARE, arena));
    case UNJUDGED_LIMIT: return arena_format(arena, TERM_NO_LIMIT, words_ambient(c->ambient));
    case UNJUDGED_FIGURE:
        return arena_format(arena, TERM_UNKNOWN "%s%s",
                            limit && limit->name ? limit->name : "its figure",
                            level_doubted(c) ? ": " : "", level_doubted(c) ? level_doubted(c) : "");
    default: return "nothing of it is known";
    }
}

#define EDGE_SEEN 0.005 /* of a symbol: less than that of it is none of it */

/* In the unit of the limit that decides, where that is of a contrast. */
static const char *mean_words(const ReviewCase *c, Arena *arena) {
    const LimitVerdict *limit = case_worst_limit(c);
    LimitKind kind = limit ? limit_kind_named(limit->kind) : LIMIT_KIND_COUNT;
    LimitVerdict mean = limit ? *limit : (LimitVerdict){0};
    if (!quantity_is_contrast(kind))
        return arena_format(arena, "%s : 1", words_figure(c->whole.contrast_ratio, arena));
    mean.found = contrast_from_ratio(kind, c->whole.contrast_ratio);
    return words_found(&mean, arena);
}

const char *words_whole(const ReviewCase *c, Arena *arena) {
    const CaseWhole *whole = &c->whole;
    bool differs = whole->reflected > 0 && /* older reviews have none */
                   (whole->reflected_range.high < c->reflected_range.low ||
                    whole->reflected_range.low > c->reflected_range.high);
    bool is_edged = whole->lit_share > EDGE_SEEN && whole->lit_share < 1 - EDGE_SEEN;
    const char *lit = is_edged ? arena_format(arena, "%s of it is in the sun",
                                              words_share(whole->lit_share, arena))
                               : "";
    if (!differs)
        return is_edged ? arena_format(arena, "%s of the symbol is in the sun",
                                       words_share(whole->lit_share, arena))
                        : "";
    return arena_format(arena, "mean of the symbol %s%s%s", mean_words(c, arena),
                        is_edged ? "; " : "", lit);
}

/* Sizes are the same in any light. */
static const char *light_words(const ReviewCase *c, const LimitVerdict *limit) {
    const ReviewQuantity *of = quantity_of(limit);
    return of && of->is_of_light ? words_ambient(c->ambient) : "";
}

static const char *reason_of(const ReviewCase *c, Arena *arena) {
    const LimitVerdict *limit = case_worst_limit(c);
    if (case_kept_by(c) == KEPT_HIDDEN)
        return arena_format(arena, TERM_UNSEEN "%s%s", c->hider_count ? TERM_HIDDEN_BY : "",
                            words_hiders(c, arena));
    if (c->verdict == VERDICT_UNJUDGED) return words_unjudged(c, arena);
    if (!limit) return arena_format(arena, TERM_NO_LIMIT, words_ambient(c->ambient));
    const char *name = words_kind(limit), *found = words_found(limit, arena);
    const char *light = light_words(c, limit), *bound = words_bound(limit, arena);
    const char *gap = light[0] ? " " : "";
    const char *said =
        c->verdict == VERDICT_TOO_CLOSE
            ? arena_format(arena, TERM_OPEN, name, found, gap, light,
                           words_within(limit->low, limit->low, limit->high, arena),
                           words_within(limit->high, limit->low, limit->high, arena), bound)
            : arena_format(arena, TERM_FOUND, name, found, gap, light, bound);
    return arena_format(arena, "%s%s", said, words_precision(c, arena));
}

const char *words_reason(const ReviewCase *c, Arena *arena) {
    static const char *const SO[4] = {[VERDICT_PASS] = "and surely cannot",
                                      [VERDICT_FAIL] = "but can",
                                      [VERDICT_TOO_CLOSE] = "and perhaps can",
                                      [VERDICT_UNJUDGED] = "unknown"};
    const char *reason = reason_of(c, arena);
    if (!c->must_not_be_read) return reason;
    const CaseImage *image = case_image_of(c, case_worst_limit(c));
    ReviewCase as = *c;
    if (image) {
        as.contrast_ratio = image->contrast_ratio;
        as.contrast_low = image->contrast_low;
        as.contrast_high = image->contrast_high;
    }
    bool has_contrast = !isnan(as.contrast_ratio);
    return arena_format(arena, TERM_MUST_NOT ", %s: %s%s%s%s", SO[c->verdict], reason,
                        has_contrast ? "; contrast " : "",
                        has_contrast ? words_contrast(&as, arena) : "",
                        image ? ", reversed left to right" : "");
}

const char *words_headline(const ReviewCase *c, Arena *arena) {
    return c->unjudged == UNJUDGED_PANEL ? TERM_PANEL_UNUSABLE : words_reason(c, arena);
}

const char *words_remedy(const CaseRemedy *r, Arena *arena) {
    bool is_another = r->then.verdict == VERDICT_PASS && r->verdict != VERDICT_PASS;
    return arena_format(arena, "%s %s (%s)%s%s", words_kind(&r->then), words_found(&r->then, arena),
                        words_bound(&r->then, arena),
                        is_another ? "; another limit is not kept" : "",
                        words_breaks(r->breaks, r->break_count, arena));
}

const char *words_breaks(const RemedyBreak *breaks, int count, Arena *arena) {
    const RemedyBreak *worst = breaks;
    for (int i = 1; i < count; i++)
        if (limit_is_worse(&breaks[i].line, &worst->line)) worst = &breaks[i];
    if (!count) return "";
    return arena_format(arena, TERM_THEN, worst->subject, worst->viewer,
                        worst->line.verdict == VERDICT_FAIL ? "fails"
                                                            : verdict_names[worst->line.verdict],
                        words_kind(&worst->line), words_found(&worst->line, arena),
                        words_bound(&worst->line, arena),
                        count > 1 ? arena_format(arena, "; and %d more", count - 1) : "");
}

const char *words_chain(const CaseCause *cause, Arena *arena) {
    Text text = {.arena = arena};
    for (int i = 0; i < cause->links; i++) {
        if (i > 0) text_add(&text, " → ");
        text_add(&text, cause->chain[i] ? cause->chain[i] : "?");
    }
    return text.data ? text.data : "";
}

/* In the field's words. */
static const char *origin_words(const char *what) {
    static const char *const WORDS[][2] = {{"sun", "direct sunlight"},
                                           {"the sun itself", "direct sunlight"},
                                           {"the sky itself", "sky"}};
    for (int i = 0; i < 3; i++)
        if (words_same(what, WORDS[i][0])) return WORDS[i][1];
    return what;
}

const char *words_group(const CaseGroup *group, int most, Arena *arena) {
    Text text = {.arena = arena};
    int listed = group->count > most + 1 ? most : group->count, left = 100;
    bool has_rest = listed < group->count;
    for (int i = 0; i < listed; i++) {
        bool is_last = i == listed - 1 && !has_rest;
        int percent = is_last ? left : (int)lrint(100 * group->list[i].share);
        left -= percent;
        const char *share = percent > 0 ? arena_format(arena, "%d", percent) : "<1";
        text_format(&text, "%s%s, %s %%", i ? " · " : "", origin_words(group->list[i].what), share);
    }
    if (has_rest) text_format(&text, " · others, %d %%", left > 0 ? left : 0);
    return text.data ? text.data : "";
}

const char *words_without_data(const Review *review, const ReviewCase *c, Arena *arena) {
    int count = review->without_data_count;
    if (!count) return "";
    return arena_format(arena,
                        "%s of it came via %d material%s without optical data "
                        "(taken as perfectly white): %s",
                        words_share(c->without_data_share, arena), count, count == 1 ? "" : "s",
                        review->without_data);
}

const char *words_empty_seat(const ReviewCase *c, Arena *arena) {
    return c->empty_seat ? arena_format(arena, TERM_EMPTY_SEAT, c->empty_seat,
                                        words_share(c->empty_seat_share, arena))
                         : "";
}

/* ---- visibility levels ------------------------------------------------------------------- */

const char *words_levels(const ReviewCase *c, Arena *arena) {
    Text text = {.arena = arena};
    for (int i = 0; i < c->visibility_count; i++) {
        const CaseVisibility *v = &c->visibilities[i];
        if (isnan(v->level)) continue;
        text_format(&text, "%s%s at %g%s", text.size ? ", " : "visibility level ",
                    words_within(v->level, v->low, v->high, arena), v->age_years,
                    text.size ? "" : " years");
    }
    return text.data ? text.data : "";
}

const char *words_level(const CaseVisibility *v, Arena *arena) {
    const char *doubt = v->doubts ? arena_format(arena, "; doubtful: %s", v->doubts) : "";
    if (isnan(v->level)) return arena_format(arena, "–%s", doubt);
    if (v->low == v->high) return arena_format(arena, "%s%s", words_figure(v->level, arena), doubt);
    return arena_format(arena, "%s, 95 %% interval %s to %s%s",
                        words_within(v->level, v->low, v->high, arena),
                        words_within(v->low, v->low, v->high, arena),
                        words_within(v->high, v->low, v->high, arena), doubt);
}

const char *words_target(const CaseVisibility *v, Arena *arena) {
    const char *glance = v->glance_s < VISIBILITY_GLANCE_LONG
                             ? arena_format(arena, "in a glance of %g s", v->glance_s)
                             : "for as long as it takes";
    return arena_format(arena,
                        "one of its strokes, %s arc minutes wide, looked at %s; the eye "
                        "adapted to %s cd/m²: background, reflected light and veil",
                        words_figure(v->size_arcmin, arena), glance,
                        words_figure(v->adapted_cd_m2, arena));
}

bool review_has_levels(const Review *review) {
    bool has = false;
    for (int i = 0; i < review_case_count(review); i++)
        has = has || review_case_at(review, i)->visibility_count > 0;
    return has;
}
