/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_words.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "plot/draw/ticks.h"
#include "review/private_image.h"
#include "review/quantity.h"
#include "review/review_decide.h"
#include "text/interval_text.h"
#include "text/text.h"

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
    const char *unit = limit->unit ? limit->unit : "";
    if (limit->kind && !strcmp(limit->kind, "contrast_ratio"))
        return arena_format(arena, "%s : 1", figure);
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

/* Whose it is, where it is somebody's; where, where glass shows it. */
static const char *with_age(const LimitVerdict *limit, const char *figure, Arena *arena) {
    if (limit->by_pane) return arena_format(arena, "%s in %s", figure, limit->by_pane);
    if (!(limit->age_years > 0)) return figure;
    return arena_format(arena, "%s at %g years", figure, limit->age_years);
}

const char *words_found(const LimitVerdict *limit, Arena *arena) {
    if (isnan(limit->found)) return "–";
    const char *figure = words_within(limit->found, limit->low, limit->high, arena);
    for (int digits = 4; digits <= 9 && is_belied(limit, figure); digits++)
        figure = arena_format(arena, "%.*g", digits, limit->found);
    return with_age(limit, with_unit(limit, figure, arena), arena);
}

const char *words_kind(const LimitVerdict *limit) {
    static const char *const WORDS[LIMIT_KIND_COUNT] = {
        [LIMIT_CONTRAST_RATIO] = "contrast",
        [LIMIT_LUMINANCE_CONTRAST] = "luminance contrast",
        [LIMIT_MODULATION] = "modulation",
        [LIMIT_CHARACTER_HEIGHT] = "height",
        [LIMIT_STROKE_RATIO] = "stroke ratio",
        [LIMIT_WIDTH_RATIO] = "width ratio",
        [LIMIT_VISIBILITY_LEVEL] = "visibility level",
        [LIMIT_VISUAL_SECURITY] = "visual security S"};
    LimitKind kind = limit_kind_named(limit->kind);
    if (kind < LIMIT_KIND_COUNT) return WORDS[kind];
    return limit->name ? limit->name : "";
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
    LimitVerdict as = {.kind = limit_kinds[LIMIT_CONTRAST_RATIO].name};
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
    if (minutes < 60) return arena_format(arena, "%s min", words_figure(minutes, arena));
    long whole = lround(minutes);
    return whole % 60 ? arena_format(arena, "%ld h %ld min", whole / 60, whole % 60)
                      : arena_format(arena, "%ld h", whole / 60);
}

const char *words_limit(const LimitVerdict *limit, Arena *arena) {
    return with_unit(limit, words_number(limit->value, arena), arena);
}

const char *words_required(const LimitVerdict *limit, Arena *arena) {
    return arena_format(arena, "%s %s%s", limit->is_upper ? "<=" : ">=", words_limit(limit, arena),
                        limit->is_advice ? " (advice)" : "");
}

const char *words_verdict(Verdict verdict) {
    static const char *const WORDS[4] = {"Passes", "Fails", "Too close to call",
                                         "Cannot be judged"};
    return WORDS[verdict];
}

bool sweep_has_box(const ReviewSweep *sweep) {
    return !isnan(sweep->worst.eye_failed_share);
}

const char *words_often(const ReviewSweep *sweep, Arena *arena) {
    static const char *const NAMES[4] = {"never", "at worst", "too close", "cannot be judged"};
    Verdict verdict = sweep_verdict(sweep);
    bool fails = verdict == VERDICT_FAIL && sweep->failed_share > 0;
    if (verdict == VERDICT_FAIL && sweep_has_box(sweep))
        return arena_format(arena, "%s of eyes", words_share(sweep->worst.eye_failed_share, arena));
    return fails ? words_share(sweep->failed_share, arena) : NAMES[verdict];
}

const char *words_of_what(const ReviewSweep *sweep) {
    return isnan(sweep->longest_failure_minutes) ? "of the sun's directions" : "of the time";
}

const char *words_middle(const ReviewSweep *sweep, Arena *arena) {
    const char *often = "never";
    if (sweep->failed_share > 0)
        often = arena_format(arena, "%s %s", words_share(sweep->failed_share, arena),
                             words_of_what(sweep));
    if (!(sweep->middle_contrast > 0)) return arena_format(arena, "the middle eye %s", often);
    return arena_format(arena, "the middle eye %s, at its own worst %s", often,
                        words_ratio_as(&sweep->worst, sweep->middle_contrast, arena));
}

const char *words_how_often(const ReviewSweep *sweep, Arena *arena) {
    bool is_share = sweep_verdict(sweep) == VERDICT_FAIL && sweep->failed_share > 0;
    const char *often = words_often(sweep, arena);
    if (sweep_has_box(sweep) && sweep_verdict(sweep) == VERDICT_FAIL)
        return arena_format(arena, "%s at its worst, %s", often, words_middle(sweep, arena));
    return is_share ? arena_format(arena, "%s %s", often, words_of_what(sweep)) : often;
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

/* The eighth of the circle that an azimuth lies in. */
static int eighth_of(double azimuth_deg) {
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
    const char *where = directions ? directions[eighth_of(c->sun_azimuth_deg)] : "";
    return arena_format(arena, "sun %.1f° high, %s%sazimuth %.1f°", c->sun_elevation_deg, where,
                        where[0] ? ", " : "", c->sun_azimuth_deg);
}

/* Why no paths decide it, and what would: "the limit lies within ...; what helps: ...". */
static const char *words_undecidable(const ReviewCase *c, Arena *arena) {
    static const char *const WITHIN[OPEN_COUNT] = {
        [OPEN_BY_PANEL] = "the panel's own stated error",
        [OPEN_BY_SUN] = "what is known of the sun's image in the display",
        [OPEN_BY_VEIL] = "what is known of the veil in the eye"};
    const char *brighter = "", *helps = "";
    if (c->open_by == OPEN_BY_IMAGE)
        return "; the limit lies within what is known of its image in the glass, which is not "
               "read by more paths";
    for (int i = 0; i < c->remedy_count; i++) brighter = c->remedies[i].what;
    if (c->open_by == OPEN_BY_PANEL)
        helps = arena_format(arena, "; what helps: the panel measured more exactly%s%s",
                             *brighter ? ", or " : "", brighter);
    else if (*brighter) helps = arena_format(arena, "; what helps: %s", brighter);
    return arena_format(arena, "; no number of paths decides it: the limit lies within %s%s",
                        WITHIN[c->open_by], helps);
}

const char *words_decide(const ReviewCase *c, Arena *arena) {
    if (case_is_undecidable(c)) return words_undecidable(c, arena);
    if (c->open_by != OPEN_BY_PATHS) return "";
    return "; more paths decide it: a lower \"contrast\" and more \"paths\" of \"precision\"";
}

#define HIDERS_LISTED 3

const char *words_hiders(const ReviewCase *c, Arena *arena) {
    Text text = {.arena = arena};
    double rest = 0;
    for (int i = 0; i < c->hider_count; i++) {
        const CaseHider *hider = &c->hiders[i];
        if (i >= HIDERS_LISTED) rest += hider->share;
        else
            text_format(&text, "%s%s hides %s", i ? ", " : "", hider->what,
                        words_share(hider->share, arena));
    }
    if (rest > 0) text_format(&text, ", others %s", words_share(rest, arena));
    return text.data ? text.data : "";
}

const char *words_precision(const ReviewCase *c, Arena *arena) {
    if (!(c->precision_reached > c->precision_asked)) return "";
    return arena_format(arena, "; known within %s, %s was required",
                        words_share(c->precision_reached, arena),
                        words_share(c->precision_asked, arena));
}

static const char *words_seen(const ReviewCase *c, Arena *arena) {
    if (!(c->visible_share > 0) && c->must_not_be_read)
        return "the middle of the eye's places sees nothing of it, but others do, and a sweep "
               "counts by its middle";
    if (!(c->visible_share > 0)) return "nothing of it is seen";
    return arena_format(arena, "%s of it is seen, more than %s is required",
                        words_share(c->visible_share, arena), words_share(SEEN_LEAST, arena));
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
        return arena_format(arena, "%s%s%s%s", words_seen(c, arena), c->hider_count ? ": " : "",
                            words_hiders(c, arena),
                            c->is_optional ? "; this eye need not see it" : "");
    case UNJUDGED_PANEL:
        return arena_format(arena,
                            "the panel of its display says of itself that it is not "
                            "usable%s%s",
                            c->panel.reason ? ": " : "", c->panel.reason ? c->panel.reason : "");
    case UNJUDGED_DATA:
        return arena_format(arena,
                            "%s of the light that its display reflects comes via "
                            "materials without optical data, at most %s is accepted",
                            words_share(c->without_data_share, arena),
                            words_share(UNJUDGED_DATA_SHARE, arena));
    case UNJUDGED_LIMIT:
        return arena_format(arena, "no limit that counts applies to it %s",
                            words_ambient(c->ambient));
    case UNJUDGED_FIGURE:
        return arena_format(arena, "%s could not be found out%s%s",
                            limit && limit->name ? limit->name : "its figure",
                            level_doubted(c) ? ": " : "", level_doubted(c) ? level_doubted(c) : "");
    default: return "nothing of it is known";
    }
}

const char *words_to_judge(const ReviewCase *c) {
    static const char *const WORDS[UNJUDGED_COUNT] = {
        [UNJUDGED_HIDDEN] = "move what hides it, the display or the eye; or say \"visible\": "
                            "\"optional\" of the symbol, if this eye need not see it",
        [UNJUDGED_PANEL] = "a panel file that is usable: measured anew, or fitted anew from "
                           "finer data (`parhelion panel info` says what this one lacks)",
        [UNJUDGED_DATA] = "give these materials colours or spectra in the model, or by "
                          "`equip`; `parhelion check` names them",
        [UNJUDGED_LIMIT] = "a profile with a limit that applies in this light",
        [UNJUDGED_FIGURE] = "a rectangle of the content that holds the symbol and its "
                            "background"};
    if (c->unjudged == UNJUDGED_FIGURE && level_doubted(c))
        return "an observer of an age for which the visibility level is published";
    return WORDS[c->unjudged] && !c->is_optional ? WORDS[c->unjudged] : "";
}

/* A contrast that is no ratio says so: a name such as "contrast" alone would not. */
static const char *name_of(const LimitVerdict *limit, Arena *arena) {
    LimitKind kind = limit_kind_named(limit->kind);
    const char *name = limit->name ? limit->name : "limit";
    bool is_other = kind == LIMIT_LUMINANCE_CONTRAST || kind == LIMIT_MODULATION;
    if (!is_other || strstr(name, words_kind(limit))) return name;
    return arena_format(arena, "%s (%s)", name, words_kind(limit));
}

#define EDGE_SEEN 0.005 /* of a symbol: less than that of it is none of it */

/* In the unit of the limit that decides, where that is of a contrast. */
static const char *mean_words(const ReviewCase *c, Arena *arena) {
    const LimitVerdict *limit = case_worst_limit(c);
    LimitKind kind = limit ? limit_kind_named(limit->kind) : LIMIT_KIND_COUNT;
    LimitVerdict mean = limit ? *limit : (LimitVerdict){0};
    if (kind == LIMIT_KIND_COUNT || !limit_kinds[kind].is_contrast)
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

static const char *reason_of(const ReviewCase *c, Arena *arena) {
    const LimitVerdict *limit = case_worst_limit(c);
    if (case_kept_by(c) == KEPT_HIDDEN)
        return arena_format(arena, "nothing of it is seen%s%s", c->hider_count ? ": " : "",
                            words_hiders(c, arena));
    if (c->verdict == VERDICT_UNJUDGED) return words_unjudged(c, arena);
    if (!limit) return "no limit applies to it";
    const char *name = name_of(limit, arena);
    const char *found = words_found(limit, arena);
    const char *required = words_required(limit, arena);
    if (c->verdict == VERDICT_TOO_CLOSE)
        return arena_format(arena, "%s %s, but anything between %s and %s, required %s%s%s", name,
                            found, words_within(limit->low, limit->low, limit->high, arena),
                            words_within(limit->high, limit->low, limit->high, arena), required,
                            words_precision(c, arena), words_decide(c, arena));
    return arena_format(arena, "%s %s, required %s%s", name, found, required,
                        words_precision(c, arena));
}

/* Of what must not be read, before the reason. */
static const char *const FORBIDDEN[4] = {[VERDICT_PASS] = "must not be read, and surely cannot be",
                                         [VERDICT_FAIL] = "must not be read, but can be",
                                         [VERDICT_TOO_CLOSE] =
                                             "must not be read, and perhaps can be",
                                         [VERDICT_UNJUDGED] = "must not be read"};

const char *words_reason(const ReviewCase *c, Arena *arena) {
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
    return arena_format(
        arena, "%s: %s%s%s%s", FORBIDDEN[c->verdict], reason, has_contrast ? "; contrast " : "",
        has_contrast ? words_contrast(&as, arena) : "", image ? ", reversed left to right" : "");
}

const char *words_headline(const ReviewCase *c, Arena *arena) {
    return c->unjudged == UNJUDGED_PANEL ? "the panel of its display says of itself that it is "
                                           "not usable"
                                         : words_reason(c, arena);
}

const char *words_remedy(const CaseRemedy *r, Arena *arena) {
    static const char *const THEN[4] = {"passes", "still fails", "too close to call",
                                        "cannot be judged"};
    bool is_another = r->then.verdict == VERDICT_PASS && r->verdict != VERDICT_PASS;
    return arena_format(arena, "%s, required %s: %s", words_quantity(&r->then, arena),
                        words_required(&r->then, arena),
                        is_another ? "passes, another limit does not" : THEN[r->verdict]);
}

const char *words_chain(const CaseCause *cause, Arena *arena) {
    Text text = {.arena = arena};
    for (int i = 0; i < cause->links; i++) {
        if (i > 0) text_add(&text, " → ");
        text_add(&text, cause->chain[i] ? cause->chain[i] : "?");
    }
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
    if (!c->empty_seat) return "";
    return arena_format(arena,
                        "nobody sits in the %s's seat: its back, %s, causes %s of what "
                        "is reflected; add an occupant: `equip`, or \"with\" in the "
                        "request",
                        c->eye ? c->eye : "driver", c->empty_seat,
                        words_share(c->empty_seat_share, arena));
}
