/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_variants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "page/page.h"
#include "review/output/review_values.h"
#include "review/output/review_diff.h"
#include "review/output/review_words.h"
#include "review/quantity.h"
#include "review/review_decide.h"
#include "review/terms.h"
#include "text/effect_text.h"

/* ---- the order --------------------------------------------------------------------------- */

/* The greatest failed share of all sweeps; -1: there is none. */
static double most_failed(const Review *review) {
    double most = -1;
    for (int i = 0; i < review->sweep_count; i++) most = fmax(most, review->sweeps[i].failed_share);
    return most;
}

static double least_margin(const ReviewVariantFound *v) {
    return v->worst.after ? v->worst.after->margin : (double)INFINITY;
}

static int compare(const void *a, const void *b) {
    const ReviewVariantFound *one = *(const ReviewVariantFound *const *)a;
    const ReviewVariantFound *other = *(const ReviewVariantFound *const *)b;
    int verdicts =
        verdict_rank(review_verdict(one->review)) - verdict_rank(review_verdict(other->review));
    if (verdicts) return verdicts;
    double margins = least_margin(other) - least_margin(one);
    if (margins != 0 && !isnan(margins)) return margins > 0 ? 1 : -1;
    double failed = most_failed(one->review) - most_failed(other->review);
    if (failed != 0) return failed > 0 ? 1 : -1;
    return one < other ? -1 : 1; /* they lie in one list */
}

/* ---- words ------------------------------------------------------------------------------- */

#define SHOWN_SHARE 0.001 /* of a limit: the least that is reported */

static const char *difference_words(const ReviewDifference *d, Arena *arena) {
    return effect_text(d->margin, d->margin_range, SHOWN_SHARE, arena);
}

static const char *other_part(const ReviewDifference *d, Arena *arena) {
    const CaseBox *p = &d->after->whole.part;
    if (!d->is_other_part) return "";
    return arena_format(arena, TERM_OTHER_PART, 100 * p->left, 100 * p->right, 100 * p->top,
                        100 * p->bottom);
}

/* How it was read, where that is to be said. Rounded up: what is shown holds. */
static const char *read_words(const ReviewDifference *d, Arena *arena) {
    double percent = 100 * d->after->alike_within;
    if (isnan(percent)) return other_part(d, arena);
    if (percent > 0) {
        double digit = pow(10, floor(log10(percent)));
        percent = digit * ceil(percent / digit);
    }
    return arena_format(arena, "light of the review, within %.1g %%", percent);
}

static const char *difference_class(const ReviewDifference *d) {
    if (effect_is_none(d->margin, d->margin_range, SHOWN_SHARE)) return "n";
    if (d->margin_range.low > 0) return "n good";
    return d->margin_range.high < 0 ? "n bad" : "n";
}

static const char *changes_words(const ReviewVariantFound *v, Arena *arena) {
    Text text = {.arena = arena};
    for (int i = 0; i < v->word_count; i++) text_format(&text, "%s%s", i ? "; " : "", v->words[i]);
    return text.data ? text.data : "";
}

static const char *counts_words(const Review *review, Arena *arena) {
    ReviewCounts counts = review_count(review);
    int open = counts.of[VERDICT_TOO_CLOSE] + counts.of[VERDICT_UNJUDGED];
    if (!open) return arena_format(arena, "%d of %d", counts.of[VERDICT_FAIL], counts.total);
    return arena_format(arena, "%d of %d, %d open", counts.of[VERDICT_FAIL], counts.total, open);
}

/* Of its worst sweep. */
static const char *failed_words(const Review *review, Arena *arena) {
    Findings ranked = review_ranked(review, arena);
    for (int i = 0; i < ranked.count; i++)
        if (ranked.list[i].sweep) return words_how_often(ranked.list[i].sweep, arena);
    return "–";
}

/* In the quantity of its limit of contrast; NULL: there is none. */
static const LimitVerdict *limit_of(const ReviewCase *c) {
    bool has_limit = c && !c->unjudged && c->limit_id >= 0 && c->limit_id < c->limit_count;
    return has_limit ? &c->limits[c->limit_id] : NULL;
}

static const char *figure_words(const ReviewCase *c, Arena *arena) {
    const LimitVerdict *limit = limit_of(c);
    return limit ? words_quantity(limit, arena) : words_judged(c, arena);
}

/* "24 → 114 : 1": a unit that both have stands once. */
static const char *moved_words(const ReviewDifference *d, Arena *arena) {
    const LimitVerdict *before = limit_of(d->before), *after = limit_of(d->after);
    const char *now = figure_words(d->after, arena);
    if (!d->before) return now;
    if (!before || !after || !words_same(before->kind, after->kind))
        return arena_format(arena, "%s → %s", figure_words(d->before, arena), now);
    const char *was = words_within(before->found, before->low, before->high, arena);
    return limit_kind_named(after->kind) == LIMIT_CONTRAST_RATIO
               ? arena_format(arena, "%s → %s", was, now)
               : arena_format(arena, "%s %s → %s", words_kind(after), was,
                              words_within(after->found, after->low, after->high, arena));
}

/* How far a case moves: first what is judged in one of both alone, then by the margin. */
static double distance_of(const ReviewDifference *d) {
    if (!d->before || !d->after) return -1;
    if (!d->before->unjudged != !d->after->unjudged) return (double)INFINITY;
    return isnan(d->margin) ? -1 : fabs(d->margin);
}

/* Whose the least margin is, before and after. */
static const char *least_where(const ReviewDifference *d, Arena *arena) {
    const ReviewCase *b = d->before, *a = d->after;
    bool is_same = !b || (words_same(b->symbol, a->symbol) && words_same(b->eye, a->eye) &&
                          words_same(b->condition, a->condition));
    if (is_same) return words_case(a, arena);
    return arena_format(arena, "before %s; now %s", words_case(b, arena), words_case(a, arena));
}

static const char *from_limit(const ReviewCase *c, Arena *arena) {
    const LimitVerdict *limit = limit_of(c);
    return limit ? words_from_limit(limit, arena)
                 : arena_format(arena, "margin %s", words_margin(c->margin, arena));
}

static const char *margins_words(const ReviewDifference *d, Arena *arena) {
    const char *after = from_limit(d->after, arena);
    if (!d->before) return after;
    const char *moved = effect_is_none(d->margin, d->margin_range, SHOWN_SHARE) ? "no difference"
                        : d->margin_range.low > 0                               ? "better"
                        : d->margin_range.high < 0                              ? "worse"
                                                   : "not surely different";
    return arena_format(arena, "%s → %s, %s%s%s", from_limit(d->before, arena), after, moved,
                        d->is_other_part ? ", " : "", other_part(d, arena));
}

const char *review_variants_words(const ReviewVariantFound *v, Arena *arena) {
    const ReviewDifference *least = &v->worst;
    if (!least->after) return "nothing has a limit of contrast";
    return arena_format(arena, "least margin %s, %s: %s", moved_words(least, arena),
                        margins_words(least, arena), least_where(least, arena));
}

/* ---- the table of all -------------------------------------------------------------------- */

/* A figure, and below it its margin and whose it is. */
static void set_figure(json_t *to, const ReviewDifference *d, const char *where, Arena *arena) {
    page_set(to, "kind", difference_class(d));
    page_set(to, "figure", moved_words(d, arena));
    page_set(to, "margins", margins_words(d, arena));
    page_set(to, "where", where);
}

static json_t *add_row(json_t *list, const char *name, const char *changes, const Review *review,
                       Arena *arena) {
    json_t *to = page_add(list);
    page_set(to, "name", name);
    page_set(to, "changes", changes);
    page_set(to, "least", NULL);
    values_set_verdict(to, review_verdict(review));
    page_set(to, "counts", counts_words(review, arena));
    page_set(to, "failed", failed_words(review, arena));
    return to;
}

static void add_base_row(const PageValues *v, json_t *list, const ReviewCase *least) {
    ReviewDifference none = {.after = least, .margin = NAN, .margin_range = {NAN, NAN}};
    json_t *to = add_row(list, "as it stands", "the review itself", v->review, v->arena);
    page_set_flag(to, "is_base", true);
    if (!least) return;
    set_figure(values_object(to, "least"), &none, words_case(least, v->arena), v->arena);
}

/* ---- each by itself ---------------------------------------------------------------------- */

static int compare_change(const void *a, const void *b) {
    const ReviewDifference *one = *(const ReviewDifference *const *)a;
    const ReviewDifference *other = *(const ReviewDifference *const *)b;
    double x = distance_of(one), y = distance_of(other);
    return x != y ? (x < y ? 1 : -1) : one < other ? -1 : 1;
}

static void add_difference(json_t *list, const ReviewDifference *d, Arena *arena) {
    json_t *to = page_add(list);
    const char *before = d->before ? words_margin(d->before->margin, arena) : "–";
    values_set_verdict(to, d->after->verdict);
    page_set(to, "case", words_case(d->after, arena));
    page_set(to, "moved", moved_words(d, arena));
    page_set(to, "before", before);
    page_set(to, "after", words_margin(d->after->margin, arena));
    page_set(to, "kind", difference_class(d));
    page_set(to, "difference", difference_words(d, arena));
    page_set(to, "alike", read_words(d, arena));
}

/* Those that change most first. */
static void add_differences(json_t *to, const ReviewVariantFound *v, Arena *arena) {
    size_t count = (size_t)v->difference_count;
    json_t *list = values_list(to, "changed");
    const ReviewDifference **sorted = ARENA_NEW(arena, const ReviewDifference *, count + 1);
    for (size_t i = 0; i < count; i++) sorted[i] = &v->differences[i];
    qsort(sorted, count, sizeof *sorted, compare_change);
    for (size_t i = 0; i < count; i++) add_difference(list, sorted[i], arena);
}

static void add_beside(json_t *to, const Review *review, const Review *variant, Arena *arena) {
    json_t *list = values_list(to, "beside");
    int count;
    const FindingDiff *beside = review_diff_beside(review, variant, &count, arena);
    for (int i = 0; i < count; i++)
        json_array_append_new(list, json_string(review_diff_words(&beside[i], arena)));
}

static bool add_pair(json_t *to, const ReviewPicture pair[2], Arena scratch, Error *err) {
    json_t *list = values_list(to, "pair");
    for (int i = 0; pair && pair[1].file && i < 2; i++)
        if (!values_add_picture(page_add(list), &pair[i], scratch, err)) return false;
    return true;
}

static bool add_variant(const PageValues *v, json_t *list, const ReviewVariantFound *variant,
                        Error *err) {
    const ReviewDifference *least = &variant->worst;
    const ReviewPicture *pairs = v->page->pairs;
    Arena *arena = v->arena;
    json_t *to =
        add_row(list, variant->name, changes_words(variant, arena), variant->review, arena);
    page_set_flag(to, "is_base", false);
    if (least->after)
        set_figure(values_object(to, "least"), least, least_where(least, arena), arena);
    add_differences(to, variant, arena);
    add_beside(to, v->review, variant->review, arena);
    return add_pair(to, pairs ? &pairs[2 * (variant - v->review->variants)] : NULL, *arena, err);
}

static bool add_variants(const PageValues *v, Error *err) {
    int count = v->review->variant_count;
    json_t *list = values_list(v->doc, "variant_rows");
    const ReviewVariantFound **ranked = ARENA_NEW(v->arena, const ReviewVariantFound *, count + 1);
    for (int i = 0; i < count; i++) ranked[i] = &v->review->variants[i];
    qsort(ranked, (size_t)count, sizeof *ranked, compare);
    if (count) add_base_row(v, list, ranked[0]->worst.before);
    for (int i = 0; i < count; i++)
        if (!add_variant(v, list, ranked[i], err)) return false;
    return true;
}

/* Those of what must not be read say so. */
static void add_places(const PageValues *v) {
    json_t *places = json_object_get(v->doc, "eye_places"), *place;
    size_t i;
    json_array_foreach(places, i, place)
        page_set_flag(place, "is_private", json_object_get(place, "must_not_be_read") != NULL);
}

bool values_add_variants(const PageValues *v, Error *err) {
    add_places(v);
    return add_variants(v, err);
}
