/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_variants.h"

#include <ctype.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "page/page.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "text/effect_text.h"

/* ---- the order --------------------------------------------------------------------------- */

/* The greatest failed share of all sweeps; -1: there is none. */
static double most_failed(const Review *review)
{
    double most = -1;
    for (int i = 0; i < review->sweep_count; i++)
        most = fmax(most, review->sweeps[i].failed_share);
    return most;
}

static double least_margin(const ReviewVariantFound *v)
{
    return v->worst.after ? v->worst.after->margin : (double)INFINITY;
}

static int compare(const void *a, const void *b)
{
    const ReviewVariantFound *one = *(const ReviewVariantFound *const *)a;
    const ReviewVariantFound *other = *(const ReviewVariantFound *const *)b;
    int verdicts = verdict_rank(review_verdict(one->review)) -
                   verdict_rank(review_verdict(other->review));
    if (verdicts) return verdicts;
    double margins = least_margin(other) - least_margin(one);
    if (margins != 0 && !isnan(margins)) return margins > 0 ? 1 : -1;
    double failed = most_failed(one->review) - most_failed(other->review);
    if (failed != 0) return failed > 0 ? 1 : -1;
    return one < other ? -1 : 1; /* they lie in one list */
}

/* By verdict, then by worst margin, then by how much of the time they fail. */
static const ReviewVariantFound **rank(const Review *review, Arena *arena)
{
    int count = review->variant_count;
    const ReviewVariantFound **out = ARENA_NEW(arena, const ReviewVariantFound *, count);
    for (int i = 0; i < count; i++) out[i] = &review->variants[i];
    if (count > 0) qsort(out, (size_t)count, sizeof *out, compare);
    return out;
}

/* ---- words ------------------------------------------------------------------------------- */

#define SHOWN_SHARE 0.001 /* of a limit: the least that is told */

static const char *difference_words(const ReviewDifference *d, Arena *arena)
{
    return effect_text(d->margin, d->margin_range, SHOWN_SHARE, arena);
}

static const char *difference_class(const ReviewDifference *d)
{
    if (effect_is_none(d->margin, d->margin_range, SHOWN_SHARE)) return "n";
    if (d->margin_range.low > 0) return "n good";
    return d->margin_range.high < 0 ? "n bad" : "n";
}

static const char *changes_words(const ReviewVariantFound *v, Arena *arena)
{
    Text text = {.arena = arena};
    for (int i = 0; i < v->word_count; i++)
        text_format(&text, "%s%s", i ? "; " : "", v->words[i]);
    return text.data ? text.data : "";
}

static const char *counts_words(const Review *review, Arena *arena)
{
    ReviewCounts counts = review_count(review);
    int open = counts.of[VERDICT_TOO_CLOSE] + counts.of[VERDICT_UNJUDGED];
    if (!open) return arena_format(arena, "%d of %d", counts.of[VERDICT_FAIL], counts.total);
    return arena_format(arena, "%d of %d, %d open", counts.of[VERDICT_FAIL], counts.total,
                        open);
}

/* The sweep that fails most, of those with times or of those over directions alone; NULL: none
 * of them fails for sure. */
static const ReviewSweep *failing_most(const Review *review, bool has_times)
{
    const ReviewSweep *most = NULL;
    for (int i = 0; i < review->sweep_count; i++) {
        const ReviewSweep *s = &review->sweeps[i];
        bool is_kind = isnan(s->longest_failure_minutes) != has_times;
        if (is_kind && sweep_verdict(s) == VERDICT_FAIL &&
            (!most || s->failed_share > most->failed_share))
            most = s;
    }
    return most;
}

/* Of none that fails: the worst outcome. */
static const char *unfailed_words(const Review *review, Arena *arena)
{
    const ReviewSweep *worst = NULL;
    for (int i = 0; i < review->sweep_count; i++) {
        const ReviewSweep *s = &review->sweeps[i];
        if (!worst || verdict_rank(sweep_verdict(s)) > verdict_rank(sweep_verdict(worst)))
            worst = s;
    }
    return worst ? words_often(worst, arena) : "–";
}

static const char *share_words(const ReviewSweep *s, Arena *arena)
{
    return arena_format(arena, "%s %s", words_share(s->failed_share, arena), words_of_what(s));
}

/* "3.2 % of the sun's directions"; a share of time and one of directions are two. */
static const char *failed_words(const Review *review, Arena *arena)
{
    Text text = {.arena = arena};
    for (int i = 0; i < 2; i++) {
        const ReviewSweep *s = failing_most(review, i == 0);
        if (!s) continue;
        bool is_bare = sweep_has_box(s) && s->failed_share > 0;
        text_format(&text, "%s%s%s", text.data ? "; " : "",
                    is_bare ? share_words(s, arena) : words_how_often(s, arena),
                    is_bare ? " for the middle eye" : "");
    }
    return text.data ? text.data : unfailed_words(review, arena);
}

/* In the quantity of its limit of contrast. */
static const char *figure_words(const ReviewCase *c, Arena *arena)
{
    bool has_limit = c->limit_id >= 0 && c->limit_id < c->limit_count;
    if (c->unjudged) return words_judged(c, arena);
    return has_limit ? words_quantity(&c->limits[c->limit_id], arena)
                     : words_contrast(c, arena);
}

/* Letters of the words that stand before both figures: "luminance contrast ". */
static size_t name_length(const char *before, const char *after)
{
    size_t name = 0;
    for (size_t i = 0; before[i] && before[i] == after[i] && !isdigit((unsigned char)before[i]);
         i++)
        if (before[i] == ' ') name = i + 1;
    bool are_figures = isdigit((unsigned char)before[name]) &&
                       isdigit((unsigned char)after[name]);
    return are_figures ? name : 0;
}

/* "24 → 114 : 1": a unit or name that both have stands once. */
static const char *change_words(const char *before, const char *after, Arena *arena)
{
    static const char UNIT[] = " : 1";
    size_t size = strlen(before), unit = strlen(UNIT), end = strlen(after);
    bool   is_ratio = size > unit && end > unit && !strcmp(before + size - unit, UNIT) &&
                    !strcmp(after + end - unit, UNIT);
    if (is_ratio) before = arena_string(arena, before, size - unit);
    after += name_length(before, after);
    return arena_format(arena, "%s → %s", before, after);
}

static const char *moved_words(const ReviewDifference *d, Arena *arena)
{
    const char *after = figure_words(d->after, arena);
    return d->before ? change_words(figure_words(d->before, arena), after, arena) : after;
}

/* How far a case moves: first what is judged in one of both alone, then by the margin. */
static double distance_of(const ReviewDifference *d)
{
    if (!d->before || !d->after) return -1;
    if (!d->before->unjudged != !d->after->unjudged) return (double)INFINITY;
    return isnan(d->margin) ? -1 : fabs(d->margin);
}

/* NULL: of none is it known, or none moves. */
static const ReviewDifference *moving_most(const ReviewVariantFound *v)
{
    const ReviewDifference *most = NULL;
    for (int i = 0; i < v->difference_count; i++)
        if (distance_of(&v->differences[i]) > (most ? distance_of(most) : -1))
            most = &v->differences[i];
    bool moves = most && (isnan(most->margin) ||
                          !effect_is_none(most->margin, most->margin_range, SHOWN_SHARE));
    return moves ? most : NULL;
}

/* ---- the table of all -------------------------------------------------------------------- */

static void add_verdict_cell(Text *html, Verdict verdict)
{
    text_add(html, "<td>");
    review_card_add_chip(html, verdict);
    text_add(html, "</td>");
}

static void add_name_cell(Text *html, const char *name, const char *below)
{
    text_add(html, "<td>");
    page_element(html, "b", name);
    page_element(html, "small", below);
    text_add(html, "</td>");
}

/* A figure, and below it its margin and whose it is. */
static void add_figure_cell(Text *html, const char *kind, const char *figure,
                            const char *margins, const char *where)
{
    text_format(html, "<td class=\"%s\">", kind);
    page_element(html, "b", figure);
    if (margins[0]) page_element(html, "small", margins);
    page_element(html, "small", where);
    text_add(html, "</td>");
}

#define NO_LIMIT "nothing has a limit of contrast"

/* Whose the least margin is, before and after. */
static const char *least_where(const ReviewDifference *d, Arena *arena)
{
    const ReviewCase *b = d->before, *a = d->after;
    bool is_same = !b || (words_same(b->symbol, a->symbol) && words_same(b->eye, a->eye) &&
                          words_same(b->condition, a->condition));
    if (is_same) return words_case(a, arena);
    return arena_format(arena, "before %s; now %s", words_case(b, arena), words_case(a, arena));
}

static const char *margins_words(const ReviewDifference *d, Arena *arena)
{
    const char *after = words_margin(d->after->margin, arena);
    if (!d->before) return arena_format(arena, "margin %s", after);
    return arena_format(arena, "margin %s → %s, difference %s",
                        words_margin(d->before->margin, arena), after,
                        difference_words(d, arena));
}

const char *review_variants_words(const ReviewVariantFound *v, Arena *arena)
{
    const ReviewDifference *least = &v->worst, *most = moving_most(v);
    Text text = {.arena = arena};
    if (!least->after) return NO_LIMIT;
    text_format(&text, "least margin %s, %s: %s", moved_words(least, arena),
                margins_words(least, arena), least_where(least, arena));
    if (!most) text_add(&text, "; nothing moves");
    else if (!words_same(words_case(most->after, arena), words_case(least->after, arena)))
        text_format(&text, "; moves most %s, %s: %s", moved_words(most, arena),
                    margins_words(most, arena), words_case(most->after, arena));
    return text.data;
}

static void add_change_cell(Text *html, const ReviewDifference *d, const char *where,
                            Arena *arena)
{
    add_figure_cell(html, difference_class(d), moved_words(d, arena), margins_words(d, arena),
                    where);
}

static void add_base_row(Text *html, const Review *review, const ReviewCase *least,
                         Arena *arena)
{
    page_row_begin(html, "same");
    add_name_cell(html, "as it stands", "the review itself");
    add_verdict_cell(html, review_verdict(review));
    if (least) {
        const char *margin = words_margin(least->margin, arena);
        add_figure_cell(html, "n", figure_words(least, arena),
                        arena_format(arena, "margin %s", margin), words_case(least, arena));
    } else {
        page_cell(html, "", NO_LIMIT);
    }
    page_cell(html, "n", "");
    page_cell(html, "n", counts_words(review, arena));
    page_cell(html, "n", failed_words(review, arena));
    page_row_end(html);
}

static void add_row(Text *html, const ReviewVariantFound *v, Arena *arena)
{
    const ReviewDifference *most = moving_most(v);
    page_row_begin(html, "");
    add_name_cell(html, v->name, changes_words(v, arena));
    add_verdict_cell(html, review_verdict(v->review));
    if (v->worst.after)
        add_change_cell(html, &v->worst, least_where(&v->worst, arena), arena);
    else page_cell(html, "", NO_LIMIT);
    if (most) add_change_cell(html, most, words_case(most->after, arena), arena);
    else page_cell(html, "n", "nothing");
    page_cell(html, "n", counts_words(v->review, arena));
    page_cell(html, "n", failed_words(v->review, arena));
    page_row_end(html);
}

static void add_table(Text *html, const Review *review, const ReviewVariantFound **ranked,
                      Arena *arena)
{
    static const PageColumn COLUMNS[] = {
        {"Variant", false, NULL}, {"Verdict", false, NULL},
        {"Least margin", true, "the contrast that is nearest to its limit, or farthest below, "
                               "before and after; the difference with its 95 % interval"},
        {"Moves most", true, "the case whose margin changes most, up or down, before and "
                             "after"},
        {"Fail", true, "verdicts"},
        {"Fails at most", true, "the sweep over time, and that over the sun's directions, that "
                                "fail most"}};
    page_table_begin(html, "", "variants", COLUMNS, 6);
    add_base_row(html, review, ranked[0]->worst.before, arena);
    for (int i = 0; i < review->variant_count; i++) add_row(html, ranked[i], arena);
    page_table_end(html);
}

/* ---- each by itself ---------------------------------------------------------------------- */

static int compare_change(const void *a, const void *b)
{
    const ReviewDifference *one = *(const ReviewDifference *const *)a;
    const ReviewDifference *other = *(const ReviewDifference *const *)b;
    double x = distance_of(one), y = distance_of(other);
    return x != y ? (x < y ? 1 : -1) : one < other ? -1 : 1;
}

static void add_difference(Text *html, const ReviewDifference *d, Arena *arena)
{
    const ReviewCase *c = d->after;
    page_row_begin(html, "");
    page_cell(html, "", words_case(c, arena));
    add_verdict_cell(html, c->verdict);
    page_cell(html, "n", moved_words(d, arena));
    page_cell(html, "n", d->before ? words_margin(d->before->margin, arena) : "–");
    page_cell(html, "n", words_margin(c->margin, arena));
    page_cell(html, difference_class(d), difference_words(d, arena));
    page_row_end(html);
}

static bool add_picture(Text *html, const ReviewPicture *p, Arena scratch, Error *err)
{
    text_add(html, "<figure>");
    page_element(html, "h4", p->title);
    if (!review_card_add_picture(html, p, scratch, err)) return false;
    page_element(html, "figcaption", p->caption);
    text_add(html, "</figure>\n");
    return true;
}

static bool add_pair(Text *html, const ReviewPicture pair[2], Arena scratch, Error *err)
{
    if (!pair[1].file) return true;
    text_add(html, "<div class=\"figures\">\n");
    for (int i = 0; i < 2; i++)
        if (!add_picture(html, &pair[i], scratch, err)) return false;
    text_add(html, "</div>\n");
    return true;
}

/* Those that change most first. */
static void add_cases(Text *html, const ReviewVariantFound *v, Arena *arena)
{
    static const PageColumn COLUMNS[] = {{"Case", false, NULL}, {"Verdict", false, NULL},
                                         {"Before → after", true, NULL},
                                         {"Margin before", true, NULL},
                                         {"With the change", true, NULL},
                                         {"Difference", true, NULL}};
    const ReviewDifference **list =
        ARENA_NEW(arena, const ReviewDifference *, v->difference_count);
    for (int i = 0; i < v->difference_count; i++) list[i] = &v->differences[i];
    if (v->difference_count > 0)
        qsort(list, (size_t)v->difference_count, sizeof *list, compare_change);
    page_table_begin(html, "", "", COLUMNS, 6);
    for (int i = 0; i < v->difference_count; i++) add_difference(html, list[i], arena);
    page_table_end(html);
}

static bool add_variants(Text *html, const Review *review, const ReviewPicture *pairs,
                         Arena *arena, Error *err)
{
    if (!review->variant_count) return true;
    const ReviewVariantFound **ranked = rank(review, arena);
    add_table(html, review, ranked, arena);
    page_more_begin(html, "Every variant, case by case");
    page_element(html, "p class=\"sub\"",
                 "The same review with something changed, the best first. Both are traced by "
                 "the same random numbers, so that a difference is known better than either "
                 "margin.");
    for (int i = 0; i < review->variant_count; i++) {
        int number = (int)(ranked[i] - review->variants);
        page_element(html, "h3", ranked[i]->name);
        if (pairs && !add_pair(html, &pairs[2 * number], *arena, err)) return false;
        add_cases(html, ranked[i], arena);
    }
    page_more_end(html);
    return true;
}

/* ---- sensitivity ------------------------------------------------------------------------- */

#define BAR_WIDTH 300
#define BAR_HEIGHT 22

/* The effect of one step, in percent of the limit. */
static double effect(const ReviewSensitivity *s, const ReviewSlope *slope)
{
    return 100 * s->step * slope->slope;
}

static double greatest_effect(const Review *review)
{
    double most = 0;
    for (int i = 0; i < review->sensitivity_count; i++)
        for (int k = 0; k < review->sensitivities[i].slope_count; k++) {
            const ReviewSensitivity *s = &review->sensitivities[i];
            const ReviewSlope       *slope = &s->slopes[k];
            if (isnan(slope->slope)) continue;
            most = fmax(most, fabs(effect(s, slope)));
        }
    return most;
}

/* A bar to the right gains; the line in it is the interval. */
static void add_effect_bar(Text *html, const ReviewSensitivity *s, const ReviewSlope *slope,
                           double most)
{
    double scale = most > 0 ? 0.46 * BAR_WIDTH / most : 0, middle = 0.5 * BAR_WIDTH;
    double value = effect(s, slope), x = scale * value;
    double low = middle + scale * 100 * s->step * slope->range.low;
    double high = middle + scale * 100 * s->step * slope->range.high;
    text_format(html, "<td><svg class=\"margin\" width=\"%d\" height=\"%d\" role=\"img\" "
                "aria-label=\"%+.2g percent of the limit by a step\">", BAR_WIDTH, BAR_HEIGHT,
                value);
    text_format(html, "<rect class=\"%s\" x=\"%.1f\" y=\"4\" width=\"%.1f\" height=\"14\"/>",
                value < 0 ? "bad" : "good", x < 0 ? middle + x : middle, fabs(x));
    text_format(html, "<path d=\"M%.1f 0V%d\"/><path class=\"whisker\" d=\"M%.1f 11H%.1f\"/>"
                "</svg></td>", middle, BAR_HEIGHT, fmax(low, 0), fmin(high, BAR_WIDTH));
}

/* "+1.03 ± 0.01 % per mm"; "none" below what a step shows. */
static const char *slope_words(const ReviewSensitivity *s, const ReviewSlope *slope,
                               Arena *arena)
{
    const char *effect = effect_text(slope->slope, slope->range, SHOWN_SHARE / s->step, arena);
    if (words_same(effect, EFFECT_NONE)) return effect;
    return arena_format(arena, "%s per %s", effect, s->unit);
}

static void add_slope(Text *html, const ReviewSensitivity *s, int place, double most,
                      Arena *arena)
{
    const ReviewSlope *slope = &s->slopes[place];
    page_row_begin(html, "");
    page_cell(html, "", place > 1 ? "" : s->name); /* the first of its table */
    page_cell(html, "", words_case(slope->of, arena));
    page_cell(html, "n", words_margin(slope->of->margin, arena));
    if (isnan(slope->slope)) {
        page_cell(html, "n", "–");
        page_cell(html, "", "");
    } else {
        page_cell(html, "n", slope_words(s, slope, arena));
        add_effect_bar(html, s, slope, most);
    }
    page_row_end(html);
}

static int compare_parameters(const void *a, const void *b)
{
    const ReviewSensitivity *one = *(const ReviewSensitivity *const *)a;
    const ReviewSensitivity *other = *(const ReviewSensitivity *const *)b;
    double x = one->slope_count ? fabs(effect(one, &one->slopes[0])) : 0;
    double y = other->slope_count ? fabs(effect(other, &other->slopes[0])) : 0;
    if (isnan(x)) x = 0;
    if (isnan(y)) y = 0;
    return x != y ? (x < y ? 1 : -1) : one < other ? -1 : 1;
}

/* Symbols [first, end) of each parameter. */
static void add_slopes(Text *html, const Review *review, const ReviewSensitivity *const *list,
                       const int from_to[2], Arena *arena)
{
    static const PageColumn COLUMNS[] = {
        {"Parameter", false, NULL}, {"Where its margin is least", false, NULL},
        {"Margin", true, NULL}, {"Slope", true, "in percent of the limit, with its interval"},
        {"One step", false, "what a step up does to the margin: right gains"}};
    double most = greatest_effect(review);
    page_table_begin(html, "", "variants", COLUMNS, 5);
    for (int i = 0; i < review->sensitivity_count; i++)
        for (int k = from_to[0]; k < list[i]->slope_count && k < from_to[1]; k++)
            add_slope(html, list[i], k, most, arena);
    page_table_end(html);
}

/* The parameter that moves the least margin most comes first; symbols whose margin is not the
 * least are folded. */
static void add_sensitivities(Text *html, const Review *review, Arena *arena)
{
    static const int LEAST[2] = {0, 1}, OTHERS[2] = {1, INT_MAX};
    int count = review->sensitivity_count, others = 0;
    if (!count) return;
    const ReviewSensitivity **list = ARENA_NEW(arena, const ReviewSensitivity *, count);
    for (int i = 0; i < count; i++) list[i] = &review->sensitivities[i];
    for (int i = 0; i < count; i++) others += list[i]->slope_count > 1;
    qsort(list, (size_t)count, sizeof *list, compare_parameters);
    page_element(html, "h3", "What the margins hang on");
    add_slopes(html, review, list, LEAST, arena);
    if (!others) return;
    page_more_begin(html, "The same of the other symbols");
    add_slopes(html, review, list, OTHERS, arena);
    page_more_end(html);
}

/* ---- places of an eye -------------------------------------------------------------------- */

static void add_place(Text *html, const ReviewPlaces *p, Arena *arena)
{
    page_row_begin(html, "");
    page_cell(html, "", p->at->eye);
    page_cell(html, "", p->at->symbol);
    page_cell(html, "n", words_share(p->read_share, arena));
    page_cell(html, "", p->at->condition);
    page_row_end(html);
}

static void add_places(Text *html, const Review *review, Arena *arena)
{
    static const PageColumn COLUMNS[] = {{"Eye", false, NULL}, {"Symbol", false, NULL},
                                         {"Places that can read", true,
                                          "of the points of its box or ellipse, where fewest"},
                                         {"Where they are fewest", false, NULL}};
    int           count;
    ReviewPlaces *list = review_places(review, &count, arena);
    if (!count) return;
    page_more_begin(html, "From how many of an eye's places a symbol can be read");
    page_table_begin(html, "", "", COLUMNS, 4);
    for (int i = 0; i < count; i++) add_place(html, &list[i], arena);
    page_table_end(html);
    page_more_end(html);
}

/* ---- what would mend it ------------------------------------------------------------------ */

static void add_trials(Text *html, const ReviewMend *mend, Arena *arena)
{
    static const PageColumn COLUMNS[] = {{"Value", true, NULL}, {"Verdict", false, NULL},
                                         {"Least margin", true, NULL}, {"Of", false, NULL},
                                         {"Paths", false, NULL}};
    page_more_begin(html, arena_format(arena, "What was tried: %d values", mend->trial_count));
    page_table_begin(html, "", "", COLUMNS, 5);
    for (int i = 0; i < mend->trial_count; i++) {
        const ReviewTrial *t = &mend->trials[i];
        page_row_begin(html, "");
        page_cell_format(html, "n", "%.4g %s", t->value, mend->unit);
        page_cell(html, "", words_verdict(t->verdict));
        page_cell(html, "n", words_margin(t->margin, arena));
        page_cell(html, "", t->worst ? t->worst : "–");
        page_cell(html, "", t->is_fresh ? "fresh" : "the review's");
        page_row_end(html);
    }
    page_table_end(html);
    page_more_end(html);
}

static void add_mends(Text *html, const Review *review, Arena *arena)
{
    for (int i = 0; i < review->mend_count; i++) {
        const ReviewMend *mend = &review->mends[i];
        page_element(html, "h3", mend->is_found ? "The smallest change that passes"
                                                : "No change passes");
        page_element(html, "p class=\"reason\"", words_mend(mend, arena));
        add_trials(html, mend, arena);
    }
}

bool review_variants_add(Text *html, const Review *review, const ReviewPicture *pairs,
                         Arena *arena, Error *err)
{
    if (!review->variant_count && !review->sensitivity_count && !review->mend_count)
        return true;
    page_element(html, "h2", "What if");
    if (!add_variants(html, review, pairs, arena, err)) return false;
    add_sensitivities(html, review, arena);
    add_places(html, review, arena);
    add_mends(html, review, arena);
    return true;
}
