/* SPDX-License-Identifier: Apache-2.0 */
#include "review/review_decide.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "print/utf8.h"

#define FINDINGS_BYTES ((size_t)1 << 32) /* address space: what is not touched costs nothing */

Verdict sweep_verdict(const ReviewSweep *sweep) {
    return sweep->worst.verdict;
}

ReviewCounts review_count(const Review *review) {
    Arena scratch = arena_reserve(FINDINGS_BYTES);
    Findings all = review_findings(review, &scratch);
    ReviewCounts counts = {.total = all.count};
    for (int i = 0; i < all.count; i++) {
        if (all.list[i].counts) counts.of[all.list[i].verdict]++;
        else counts.not_asked++;
    }
    arena_release(&scratch);
    return counts;
}

/* Of cases of which none counts: does each require something that need not be seen, or nothing?
 * Where no limit applies nothing is known of it. */
static bool has_optional(const Review *review) {
    for (int i = 0; i < review_case_count(review); i++)
        if (review_case_at(review, i)->unjudged == UNJUDGED_HIDDEN) return true;
    return false;
}

/* The worst of all that count. */
static Verdict found_verdict(const Review *review) {
    static const Verdict ORDER[] = {VERDICT_FAIL, VERDICT_UNJUDGED, VERDICT_TOO_CLOSE};
    ReviewCounts counts = review_count(review);
    for (int i = 0; i < COUNT_OF(ORDER); i++)
        if (counts.of[ORDER[i]]) return ORDER[i];
    bool is_nothing = counts.total > 0 && counts.not_asked == counts.total;
    return is_nothing && !has_optional(review) ? VERDICT_UNJUDGED : VERDICT_PASS;
}

Verdict review_verdict(const Review *review) {
    Verdict found = found_verdict(review);
    return review->pass || found == VERDICT_UNJUDGED ? found : VERDICT_FAIL;
}

bool review_decide(Review *review) {
    Verdict found = found_verdict(review);
    bool is_clear = found == VERDICT_PASS && !review->without_data_count;
    review->pass =
        review->is_strict ? is_clear : found == VERDICT_PASS || found == VERDICT_TOO_CLOSE;
    return review->pass;
}

/* ---- the worst -------------------------------------------------------------------------- */

const ReviewCase **review_rank(const Review *review, Arena *arena) {
    Findings ranked = review_ranked(review, arena);
    const ReviewCase **out = ARENA_NEW(arena, const ReviewCase *, ranked.count);
    int count = 0;
    for (int i = 0; i < ranked.count; i++)
        if (ranked.list[i].c) out[count++] = ranked.list[i].c;
    return out;
}

const ReviewCase *review_worst(const Review *review, Arena scratch) {
    return review_case_count(review) > 0 ? review_rank(review, &scratch)[0] : NULL;
}

/* ---- by names --------------------------------------------------------------------------- */

static bool is_name(const char *a, const char *b) {
    return !strcmp(a ? a : "", b ? b : "");
}

const ReviewCase *review_case_named(const Review *review, const char *condition, const char *eye,
                                    const char *symbol) {
    for (int i = 0; i < review->case_count; i++) {
        const ReviewCase *c = &review->cases[i];
        if (is_name(c->condition, condition) && is_name(c->eye, eye) && is_name(c->symbol, symbol))
            return c;
    }
    return NULL;
}

static const ReviewSweep *review_sweep_named(const Review *review, const char *condition,
                                             const char *eye, const char *symbol) {
    for (int i = 0; i < review->sweep_count; i++) {
        const ReviewSweep *s = &review->sweeps[i];
        if (is_name(s->condition, condition) && is_name(s->eye, eye) && is_name(s->symbol, symbol))
            return s;
    }
    return NULL;
}

const ReviewCase **review_displays(const Review *review, int *count, Arena *arena) {
    int all = review_case_count(review);
    const ReviewCase **list = ARENA_NEW(arena, const ReviewCase *, all);
    *count = 0;
    for (int i = 0; i < all; i++) {
        const ReviewCase *c = review_case_at(review, i);
        int k = 0;
        while (k < *count && !is_name(list[k]->display, c->display)) k++;
        if (k == *count) list[(*count)++] = c;
    }
    return list;
}

const ReviewCase *review_case_like(const Review *review, const ReviewCase *like) {
    const ReviewCase *c = review_case_named(review, like->condition, like->eye, like->symbol);
    if (c) return c;
    const ReviewSweep *s = review_sweep_named(review, like->condition, like->eye, like->symbol);
    return s ? &s->worst : NULL;
}

bool review_has_privacy(const Review *review) {
    for (int i = 0; i < review_case_count(review); i++)
        if (review_case_at(review, i)->must_not_be_read) return true;
    return false;
}

static void add_places(const ReviewCase *c, ReviewPlaces *list, int *count) {
    int i = 0;
    if (isnan(c->eye_failed_share) || !c->eye || !c->symbol) return;
    while (i < *count &&
           (strcmp(list[i].at->eye, c->eye) != 0 || strcmp(list[i].at->symbol, c->symbol) != 0))
        i++;
    double share = 1 - c->eye_failed_share;
    if (i == *count) ++*count;
    else if (list[i].passing_share <= share) return;
    list[i] = (ReviewPlaces){c, share};
}

ReviewPlaces *review_places(const Review *review, int *count, Arena *arena) {
    int all = review_case_count(review);
    ReviewPlaces *list = ARENA_NEW(arena, ReviewPlaces, all + 1);
    *count = 0;
    for (int i = 0; i < all; i++) add_places(review_case_at(review, i), list, count);
    return list;
}

/* ---- names ------------------------------------------------------------------------------- */

const char *words_named(const char *subject, const char *eye, const char *condition, Arena *arena) {
    return arena_format(arena, "%s, seen by %s, %s", subject ? subject : "?", eye ? eye : "?",
                        condition ? condition : "?");
}

const char *words_case(const ReviewCase *c, Arena *arena) {
    return words_named(c->symbol, c->eye, c->condition, arena);
}

const char *words_file_name(const char *text, Arena *arena) {
    char *name = ARENA_NEW(arena, char, WORDS_FILE_NAME_MOST + 1);
    for (int length = 0; *text && length < WORDS_FILE_NAME_MOST; text++) {
        bool is_plain = (*text >= 'a' && *text <= 'z') || (*text >= 'A' && *text <= 'Z') ||
                        (*text >= '0' && *text <= '9') || *text == '_';
        if (!utf8_continues(*text)) name[length++] = is_plain ? *text : '-';
    }
    return name;
}
