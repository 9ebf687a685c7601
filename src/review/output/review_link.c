/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_link.h"

#include <strings.h>

#include "review/output/review_words.h"
#include "review/review_decide.h"

/* ---- where its card is ------------------------------------------------------------------ */

const char *review_card_id(const Review *review, const ReviewCase *c, Arena *arena) {
    for (int i = 0; i < review->sweep_count; i++)
        if (c == &review->sweeps[i].worst) return arena_format(arena, "s%d", i);
    return arena_format(arena, "c%td", c - review->cases);
}

bool review_card_is_here(const Review *review, const ReviewCase *c, Arena scratch) {
    const ReviewCase **ranked = review_rank(review, &scratch);
    for (int i = 0; review->main_cards && i < review_case_count(review); i++)
        if (ranked[i] == c) return (i < review->main_cards) != review->is_beside;
    return true;
}

const char *review_card_link(const Review *review, const ReviewCase *c, Arena *arena) {
    const char *page = "";
    if (review->whole) {
        const ReviewCase *same = review_case_like(review->whole, c);
        const char *link = review_card_link(review->whole, same, arena);
        return link[0] == '#' ? arena_format(arena, "index.html%s", link) : link;
    }
    if (!review_card_is_here(review, c, *arena))
        page = review->is_beside ? "index.html" : REVIEW_PAGE_BESIDE;
    return arena_format(arena, "%s#%s", page, review_card_id(review, c, arena));
}

/* ---- files ------------------------------------------------------------------------------ */

/* Symbols of other names whose files would have this one's, with large letters for small ones
 * too, are numbered in the review's order; the point stands in no name that has no number. */
const char *review_summary_name(const Review *review, const char *symbol, Arena *arena) {
    const char *name = words_file_name(symbol ? symbol : "", arena);
    int all = review->case_count + review->sweep_count;
    WordList alike = words_list(all, arena);
    for (int i = 0; i < all; i++) {
        const char *other = i < review->case_count ? review->cases[i].symbol
                                                   : review->sweeps[i - review->case_count].symbol;
        Arena scratch = *arena;
        if (words_same(other, symbol)) break;
        if (!strcasecmp(words_file_name(other ? other : "", &scratch), name))
            words_list_add(&alike, other);
    }
    if (!alike.count) return arena_format(arena, "summary-%s.html", name);
    return arena_format(arena, "summary-%s.%d.html", name, alike.count + 1);
}
