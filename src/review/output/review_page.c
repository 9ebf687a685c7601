/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_page.h"

#include <math.h>
#include <string.h>

#include "page/page.h"
#include "review/output/review_values.h"
#include "review/output/review_facts.h"
#include "review/output/review_gaze.h"
#include "review/output/review_json.h"
#include "review/output/review_link.h"
#include "review/output/review_variants.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "text/json_text.h"
#include "text/text.h"

/* The tables of a review's page: all verdicts, the limits, what changed.
 *
 * Memory   the document's (jansson) and the arena's. Threads: one at a time. Fails: never. */

/* ---- the list ---------------------------------------------------------------------------- */

/* The worst first, by verdict; what does not count is with what passes. most: so many in all, 0:
 * no end. */
static void values_add_list(const PageValues *v, int most) {
    static const char *const NAMES[] = {[VERDICT_PASS] = "others",
                                        [VERDICT_FAIL] = "failing",
                                        [VERDICT_TOO_CLOSE] = "close",
                                        [VERDICT_UNJUDGED] = "unjudged",
                                        "all"};
    Findings ranked = review_ranked(v->review, v->arena);
    int listed = most && most < ranked.count ? most : ranked.count;
    json_t *verdicts = values_object(v->doc, "verdicts"), *lists[5];
    for (int i = 0; i < 5; i++) lists[i] = values_list(values_object(verdicts, NAMES[i]), "listed");
    for (int i = 0; i < listed; i++) {
        const Finding *f = &ranked.list[i];
        values_add_finding(v, lists[f->counts ? f->verdict : VERDICT_PASS], f);
        values_add_finding(v, lists[4], f);
    }
    page_set_count(verdicts, "unlisted", listed < ranked.count ? ranked.count : 0);
}

/* ---- limits ----------------------------------------------------------------------------- */

static bool is_same_limit(const LimitVerdict *a, const LimitVerdict *b) {
    return words_same(a->name, b->name) && words_same(a->kind, b->kind) &&
           words_same(a->unit, b->unit) && words_same(a->source, b->source);
}

/* Every limit that was held against something, once, with where its value was read; one that
 * hangs on the height of the characters from low to high. */
static void values_add_limits(const PageValues *v) {
    Findings all = review_findings(v->review, v->arena);
    int most = 0, count = 0;
    for (int i = 0; i < all.count; i++) most += all.list[i].limit_count;
    LimitVerdict *rows = ARENA_NEW(v->arena, LimitVerdict, most);
    double *high = ARENA_NEW(v->arena, double, most);
    for (int i = 0; i < all.count; i++)
        for (int k = 0; k < all.list[i].limit_count; k++) {
            const LimitVerdict *limit = &all.list[i].limits[k];
            int at = 0;
            while (at < count && !is_same_limit(&rows[at], limit)) at++;
            if (at == count) {
                rows[count++] = *limit;
                high[at] = limit->value;
            }
            rows[at].value = fmin(rows[at].value, limit->value);
            high[at] = fmax(high[at], limit->value);
        }
    json_t *list = values_list(v->doc, "limit_rows");
    for (int i = 0; i < count; i++) {
        json_t *to = page_add(list);
        page_set(to, "name", rows[i].name);
        page_set(to, "source", rows[i].source);
        page_set(to, "required", words_required(&rows[i], v->arena));
        page_set(to, "to", high[i] > rows[i].value ? words_number(high[i], v->arena) : NULL);
        page_set_flag(to, "is_read", rows[i].read_in_the_standard);
    }
}

/* ---- what changed ------------------------------------------------------------------------ */

/* "a → b" */
static const char *change_words(const char *before, const char *after, Arena *arena) {
    return !strcmp(before, after) ? after : arena_format(arena, "%s → %s", before, after);
}

/* A sweep's is how often it fails. */
static const char *diff_figure(const Finding *f, const LimitVerdict *line, Arena *arena) {
    if (!f || (!line && !f->sweep)) return "–";
    if (!f->sweep) return words_quantity(line, arena);
    return words_failing(f->sweep, arena);
}

static void add_change(json_t *list, const FindingDiff *d, Arena *arena) {
    static const char *const CLASSES[DIFF_COUNT] = {"chip bad", "chip good", "bad", "good",
                                                    "sub",      "sub",       "sub"};
    static const char *const WORDS[DIFF_COUNT] = {
        "worse verdict", "better verdict", "worse", "better", "only before", "only now", "same"};
    const Finding *either = d->after ? d->after : d->before;
    json_t *to = page_add(list);
    page_set(to, "class", CLASSES[d->kind]);
    page_set(to, "change", WORDS[d->kind]);
    page_set(to, "of", either->subject);
    page_set(to, "condition", either->condition);
    page_set(to, "eye", either->viewer);
    page_set(to, "verdict",
             change_words(d->before ? verdict_names[d->before->verdict] : "–",
                          d->after ? verdict_names[d->after->verdict] : "–", arena));
    page_set(to, "figure",
             change_words(diff_figure(d->before, d->line[0], arena),
                          diff_figure(d->after, d->line[1], arena), arena));
    page_set(to, "margin",
             change_words(words_from_limit(d->line[0], arena), words_from_limit(d->line[1], arena),
                          arena));
}

/* What is the same is counted. */
static void values_add_diff(const PageValues *v) {
    const ReviewDiff *diff = v->page->diff;
    if (!diff) return;
    json_t *to = values_object(v->doc, "diff"), *changes = values_list(to, "changes");
    page_set(to, "before", diff->before_name);
    page_set(to, "now", diff->after_name);
    for (int kind = 0; kind < DIFF_COUNT; kind++)
        if (kind != DIFF_GONE && kind != DIFF_NEW)
            page_set_count(to, diff_names[kind], diff->count[kind]);
    for (int i = 0; i < diff->list_count; i++)
        if (diff->list[i].kind != DIFF_SAME) add_change(changes, &diff->list[i], v->arena);
}

#define WORDS_BYTES ((size_t)1 << 34) /* address space */

#define SUMMARY_ROWS 5 /* verdicts that fit on one page of paper */

static const char *size_words(double bytes, Arena *arena) {
    return bytes < 1e6 ? arena_format(arena, "%s kB", words_figure(bytes / 1e3, arena))
                       : arena_format(arena, "%s MB", words_figure(bytes / 1e6, arena));
}

const PageFormat review_formats[] = {{"figure", words_figure},
                                     {"share", words_share},
                                     {"minutes", words_minutes},
                                     {"bytes", size_words},
                                     {NULL, NULL}};

/* ---- the document ----------------------------------------------------------------------- */

/* What a page about one symbol alone is about; NULL: it is about all. */
static const char *only_symbol(const Review *review) {
    if (!review->whole) return NULL;
    return review->case_count    ? review->cases[0].symbol
           : review->sweep_count ? review->sweeps[0].symbol
                                 : NULL;
}

static bool set_head(const PageValues *v, Error *err) {
    const Review *review = v->review;
    const char *symbol = only_symbol(review);
    const char *title = review->title && *review->title ? review->title : "Glare review";
    json_t *elsewhere = values_object(v->doc, "elsewhere");
    page_set(v->doc, "title", title);
    page_set(elsewhere, "href", review->is_beside ? "index.html" : REVIEW_PAGE_BESIDE);
    page_set(elsewhere, "what", review->is_beside ? "the worst" : "a page of their own");
    return page_set_head(v->doc, symbol ? symbol : title, "review", err);
}

/* ---- cards ------------------------------------------------------------------------------ */

/* Cards of moments, or of sweeps, on the page in hand, the worst first, which is open: others that
 * do not pass, and those that do, are folded. */
static void set_folds(const PageValues *v, const char *name, bool of_sweeps) {
    const Review *review = v->review;
    const ReviewCase **ranked = review_rank(review, v->arena);
    json_t *to = values_object(v->doc, name), *open = values_list(to, "open");
    json_t *more = values_list(to, "more"), *passing = values_list(to, "passing");
    int here = 0, elsewhere = 0;
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewSweep *sweep = review_sweep_of(review, ranked[i]);
        if ((sweep != NULL) != of_sweeps) continue;
        if (review->main_cards && (i < review->main_cards) == review->is_beside) {
            elsewhere++;
            continue;
        }
        json_t *card = sweep ? values_of_sweep(v, sweep) : values_of_case(v, ranked[i]);
        page_set_flag(card, "is_open", here == 0);
        if (sweep) page_set_flag(json_object_get(card, "worst"), "is_open", false);
        json_array_append(!here++                              ? open
                          : ranked[i]->verdict == VERDICT_PASS ? passing
                                                               : more,
                          card);
    }
    page_set_count(to, "all", here + elsewhere);
    page_set_count(to, "elsewhere", elsewhere);
}

/* ---- sweeps ----------------------------------------------------------------------------- */

static bool set_drawings(const PageValues *v, json_t *to, const ReviewSweep *s, Error *err) {
    const ReviewPage *page = v->page;
    json_t *maps = values_list(to, "maps"), *calendars = values_list(to, "calendars");
    bool ok = true;
    for (int i = 0; i < page->map_count && ok; i++)
        if (page->maps[i].of == s)
            ok = !json_array_append_new(
                maps, review_map_values(&page->maps[i], !v->review->whole, *v->arena, err));
    for (int i = 0; i < page->calendar_count && ok; i++)
        if (page->calendars[i].of == s)
            ok = !json_array_append_new(
                calendars, review_calendar_values(&page->calendars[i], *v->arena, err));
    return ok;
}

static bool set_sweep(const PageValues *v, const ReviewSweep *s, Error *err) {
    static const char *const NAMES[] = {"symbol", "eye", "condition", NULL};
    json_t *to = values_of_sweep(v, s);
    Arena *arena = v->arena;
    values_set_names(to, NAMES);
    values_set_verdict(to, sweep_verdict(s));
    page_set(to, "how_often", words_how_often(s, arena));
    page_set(to, "failing", words_failing(s, arena));
    page_set(to, "colour", words_sweep_colour(s));
    page_set_flag(to, "is_unsure", sweep_verdict(s) != VERDICT_FAIL && s->failed_share > 0);
    return set_drawings(v, to, s, err);
}

static bool set_sweeps(const PageValues *v, Error *err) {
    for (int i = 0; i < v->review->sweep_count; i++)
        if (!set_sweep(v, &v->review->sweeps[i], err)) return false;
    set_folds(v, "swept", true);
    return true;
}

/* ---- all of it -------------------------------------------------------------------------- */

/* most: verdicts that are listed; 0: all. */
static bool set_all(const PageValues *v, int most, Error *err) {
    if (!set_head(v, err) || !values_add_cases(v, err) || !values_add_answer(v, err) ||
        !set_sweeps(v, err))
        return false;
    set_folds(v, "cards", false);
    values_add_list(v, most);
    values_add_limits(v);
    values_add_diff(v);
    values_add_gazes(v);
    page_set(v->doc, "sources", v->page->sources);
    page_set(v->doc, "made_by", v->page->command);
    return values_add_variants(v, err);
}

/* ---- one symbol alone ------------------------------------------------------------------- */

/* The review of one symbol alone. */
static Review part_of(const Review *whole, const char *symbol, Arena *arena) {
    Review part = *whole;
    part.whole = whole;
    part.main_cards = part.case_count = part.sweep_count = part.gaze_count = 0;
    part.variant_count = 0;
    part.cases = ARENA_NEW(arena, ReviewCase, whole->case_count);
    part.sweeps = ARENA_NEW(arena, ReviewSweep, whole->sweep_count);
    for (int i = 0; i < whole->case_count; i++)
        if (words_same(whole->cases[i].symbol, symbol))
            part.cases[part.case_count++] = whole->cases[i];
    for (int i = 0; i < whole->sweep_count; i++)
        if (words_same(whole->sweeps[i].symbol, symbol))
            part.sweeps[part.sweep_count++] = whole->sweeps[i];
    review_decide(&part);
    return part;
}

/* The part's own of a case or sweep of the whole; NULL: it is another symbol's. */
static const ReviewCase *case_of_part(const Review *part, const ReviewCase *of) {
    const ReviewCase *like = review_case_like(part, of);
    return like && words_same(like->symbol, of->symbol) ? like : NULL;
}

static ReviewPage page_of_part(const ReviewPage *page, const Review *part, Arena *arena) {
    ReviewPage out = {.review = part};
    ReviewPicture *pictures = ARENA_NEW(arena, ReviewPicture, page->picture_count);
    ReviewMap *maps = ARENA_NEW(arena, ReviewMap, page->map_count);
    for (int i = 0; i < page->picture_count; i++) {
        const ReviewCase *of = case_of_part(part, page->pictures[i].of);
        if (!of) continue;
        ReviewPicture *p = &pictures[out.picture_count++];
        *p = page->pictures[i];
        p->of = of;
        p->id = NULL; /* nothing else of this page shows it */
        p->is_again = false;
    }
    for (int i = 0; i < page->map_count; i++) {
        const ReviewCase *of = case_of_part(part, &page->maps[i].of->worst);
        if (!of) continue;
        maps[out.map_count] = page->maps[i];
        maps[out.map_count++].of = review_sweep_of(part, of);
    }
    out.pictures = pictures;
    out.maps = maps;
    return out;
}

/* ---- as a file -------------------------------------------------------------------------- */

json_t *review_page_values(const ReviewPage *page, int most, Arena *arena, Error *err) {
    PageValues v = {review_json(page->review), page, page->review, arena};
    if (set_all(&v, most, err)) return v.doc;
    json_decref(v.doc);
    return NULL;
}

static bool write_page(const ReviewPage *page, const char *template, int most, Arena *words,
                       const char *path, Error *err) {
    json_t *values = review_page_values(page, most, words, err);
    return values && page_write_values(template, values, review_formats, path, err);
}

bool review_page_write_summary(const ReviewPage *page, const char *symbol, const char *path,
                               Error *err) {
    Arena words = arena_reserve(WORDS_BYTES);
    Review part = part_of(page->review, symbol, &words);
    ReviewPage alone = page_of_part(page, &part, &words);
    bool ok = write_page(&alone, "summary.html", SUMMARY_ROWS, &words, path, err);
    arena_release(&words);
    return ok;
}

bool review_page_write(const ReviewPage *page, const char *path, Error *err) {
    Arena words = arena_reserve(WORDS_BYTES);
    const char *template = page->review->is_beside ? "cases.html" : "review.html";
    bool ok = write_page(page, template, 0, &words, path, err);
    arena_release(&words);
    return ok;
}
