/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_facts.h"

#include <math.h>

#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "text/text.h"

#define MENDS_LISTED 2
#define SHARES_LISTED 3

static void add(ReviewFacts *facts, const char *name, const char *value)
{
    if (value[0] && facts->count < REVIEW_FACTS_MOST)
        facts->list[facts->count++] = (ReviewFact){name, value};
}

/* ---- when -------------------------------------------------------------------------------- */

static void add_when(ReviewFacts *facts, const Review *review, const ReviewCase *c,
                     const char *const *directions, Arena *arena)
{
    const ReviewSweep *sweep = review_sweep_of(review, c);
    const char *light = c->has_sun ? words_sun(c, directions, arena)
                                   : words_ambient(c->ambient);
    const char *when = c->when ? c->when : c->condition ? c->condition : "?";
    add(facts, "When", arena_format(arena, "%s: %s", when, light));
    if (sweep && !c->unjudged) add(facts, "How often", words_how_often(sweep, arena));
}

/* ---- why --------------------------------------------------------------------------------- */

#define LOSS_LEAST 0.1 /* of the display's own light: what else glasses do leaves contrasts */

/* Were its own light let through as any other. */
static double contrast_without_loss(const ReviewCase *c)
{
    const CaseLuminances *l = &c->luminance_cd_m2;
    double share = 1 - c->glasses_display_loss;
    return luminance_contrast(l->foreground / share, l->background / share, l->reflected);
}

static const char *glasses_words(const ReviewCase *c, Arena *arena)
{
    if (!c->glasses) return "";
    if (!(c->glasses_display_loss >= LOSS_LEAST && c->glasses_display_loss < 1))
        return c->glasses;
    return arena_format(arena, "%s; they pass %s as much of the display's own light as of any "
                               "other, passed alike it has %s", c->glasses,
                        words_share(1 - c->glasses_display_loss, arena),
                        words_ratio_as(c, contrast_without_loss(c), arena));
}

/* All of it in whole percent that add up to 100, the small ones together. */
static const char *group_words(const CaseGroup *group, Arena *arena)
{
    Text text = {.arena = arena};
    int  listed = group->count > SHARES_LISTED + 1 ? SHARES_LISTED : group->count, left = 100;
    bool has_rest = listed < group->count;
    for (int i = 0; i < listed; i++) {
        bool is_last = i == listed - 1 && !has_rest;
        int  percent = is_last ? left : (int)lrint(100 * group->list[i].share);
        left -= percent;
        const char *share = percent > 0 ? arena_format(arena, "%d", percent) : "<1";
        text_format(&text, "%s%s %% %s", i ? " · " : "", share, group->list[i].what);
    }
    if (has_rest) text_format(&text, " · %d %% others", left > 0 ? left : 0);
    return text.data ? text.data : "";
}

static void add_why(ReviewFacts *facts, const Review *review, const ReviewCase *c, Arena *arena)
{
    static const char *const NAMES[CAUSE_GROUPS] = {"Light from", "… in through", "… off"};
    const char *whole = words_whole(c, arena);
    add(facts, "Seen through", glasses_words(c, arena));
    if (whole[0])
        add(facts, "Judged by", arena_format(arena, "its worst part; %s", whole));
    for (int g = 0; g < CAUSE_GROUPS; g++)
        if (c->groups[g].count) add(facts, NAMES[g], group_words(&c->groups[g], arena));
    if (!c->groups[GROUP_LIGHT].count && c->cause_count)
        add(facts, "Why", arena_format(arena, "%s of what the display reflects comes by: %s",
                                       words_share(c->causes[0].share, arena),
                                       words_chain(&c->causes[0], arena)));
    add(facts, "No data", words_without_data(review, c, arena));
    add(facts, "Empty seat", words_empty_seat(c, arena));
}

/* With how many others that cannot be judged either. */
static const char *unjudged_words(const Review *review, const ReviewCase *of, Arena *arena)
{
    const char *name = words_case(of, arena);
    int         count = 0, same = 0;
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewCase *c = review_case_at(review, i);
        if (c == of || c->verdict != VERDICT_UNJUDGED || !review_case_counts(c)) continue;
        count++;
        same += c->unjudged == of->unjudged;
    }
    if (!count) return name;
    const char *others = arena_format(arena, "%s, and %d other%s", name, count,
                                      count == 1 ? "" : "s");
    return same == count ? arena_format(arena, "%s for the same reason", others)
                         : arena_format(arena, "%s, of which %d for the same reason", others,
                                        same);
}

static void add_unjudged(ReviewFacts *facts, const Review *review, const ReviewCase *c,
                         Arena *arena)
{
    add(facts, "Not judged", unjudged_words(review, c, arena));
    add(facts, "Why", words_unjudged(c, arena));
    add(facts, "To judge it", words_to_judge(c));
}

/* ---- the remedy -------------------------------------------------------------------------- */

/* Those with which the case passes first, each in their order. */
static const CaseRemedy *next_mend(const ReviewCase *c, const bool *is_listed)
{
    const CaseRemedy *best = NULL;
    int               least = 2;
    for (int i = 0; i < c->remedy_count; i++) {
        const CaseRemedy *r = &c->remedies[i];
        int rank = r->verdict == VERDICT_PASS ? 0 : 1;
        if (is_listed[i] || rank >= least) continue;
        best = r;
        least = rank;
    }
    return best;
}

static void add_mend(ReviewFacts *facts, int *listed, bool mends, const char *words)
{
    const char *name = *listed ? "… or" : mends ? "Remedy" : "What helps";
    add(facts, name, words);
    ++*listed;
}

/* Changes tried on the whole review go before those estimated for this case alone. */
static void add_tried(ReviewFacts *facts, const Review *review, int *listed, Arena *arena)
{
    for (int i = 0; i < review->mend_count; i++)
        if (review->mends[i].is_found)
            add_mend(facts, listed, true, words_mend(&review->mends[i], arena));
    for (int i = 0; i < review->variant_count && *listed < MENDS_LISTED; i++) {
        const ReviewVariantFound *v = &review->variants[i];
        if (review_verdict(v->review) == VERDICT_PASS)
            add_mend(facts, listed, true,
                     arena_format(arena, "the variant '%s': everything passes", v->name));
    }
}

static void add_mends(ReviewFacts *facts, const Review *review, const ReviewCase *c,
                      Arena *arena)
{
    bool *is_listed = ARENA_NEW(arena, bool, c->remedy_count + 1);
    int   listed = 0;
    add_tried(facts, review, &listed, arena);
    while (listed < MENDS_LISTED) {
        const CaseRemedy *r = next_mend(c, is_listed);
        if (!r) return;
        is_listed[r - c->remedies] = true;
        add_mend(facts, &listed, r->verdict == VERDICT_PASS,
                 arena_format(arena, "%s: %s", r->what, words_remedy(r, arena)));
    }
}

ReviewFacts review_facts_of(const Review *review, const ReviewCase *c,
                            const char *const *directions, Arena *arena)
{
    ReviewFacts facts = {.count = 0};
    if (c->unjudged) add_unjudged(&facts, review, c, arena);
    add_when(&facts, review, c, directions, arena);
    add_why(&facts, review, c, arena);
    if (c->verdict != VERDICT_PASS) add_mends(&facts, review, c, arena);
    return facts;
}
