/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_facts.h"

#include <math.h>
#include <string.h>

#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "text/text.h"

#define MENDS_LISTED 2
#define SHARES_LISTED 3

static void add(ReviewFacts *facts, const char *name, const char *value) {
    if (value[0] && facts->count < REVIEW_FACTS_MOST)
        facts->list[facts->count++] = (ReviewFact){name, value};
}

/* ---- when -------------------------------------------------------------------------------- */

static void add_when(ReviewFacts *facts, const Review *review, const ReviewCase *c,
                     const char *const *directions, Arena *arena) {
    const ReviewSweep *sweep = review_sweep_of(review, c);
    const char *light = c->has_sun ? words_sun(c, directions, arena) : words_ambient(c->ambient);
    const char *when = c->when ? c->when : c->condition ? c->condition : "?";
    add(facts, "When", arena_format(arena, "%s: %s", when, light));
    if (sweep && !c->unjudged) add(facts, "How often", words_how_often(sweep, arena));
}

/* ---- why --------------------------------------------------------------------------------- */

#define LOSS_LEAST 0.1 /* of the display's own light: what else glasses do leaves contrasts */

/* Were its own light let through as any other. */
static double contrast_without_loss(const ReviewCase *c) {
    const CaseLuminances *l = &c->luminance_cd_m2;
    double share = 1 - c->glasses_display_loss;
    return luminance_contrast(l->foreground / share, l->background / share, l->reflected);
}

static const char *glasses_words(const ReviewCase *c, Arena *arena) {
    if (!c->glasses) return "";
    if (!(c->glasses_display_loss >= LOSS_LEAST && c->glasses_display_loss < 1)) return c->glasses;
    return arena_format(arena,
                        "%s; they pass %s as much of the display's own light as of any "
                        "other, passed alike it has %s",
                        c->glasses, words_share(1 - c->glasses_display_loss, arena),
                        words_ratio_as(c, contrast_without_loss(c), arena));
}

/* All of it in whole percent that add up to 100, the small ones together. */
static const char *group_words(const CaseGroup *group, Arena *arena) {
    Text text = {.arena = arena};
    int listed = group->count > SHARES_LISTED + 1 ? SHARES_LISTED : group->count, left = 100;
    bool has_rest = listed < group->count;
    for (int i = 0; i < listed; i++) {
        bool is_last = i == listed - 1 && !has_rest;
        int percent = is_last ? left : (int)lrint(100 * group->list[i].share);
        left -= percent;
        const char *share = percent > 0 ? arena_format(arena, "%d", percent) : "<1";
        text_format(&text, "%s%s %% %s", i ? " · " : "", share, group->list[i].what);
    }
    if (has_rest) text_format(&text, " · %d %% others", left > 0 ? left : 0);
    return text.data ? text.data : "";
}

static void add_why(ReviewFacts *facts, const Review *review, const ReviewCase *c, Arena *arena) {
    static const char *const NAMES[CAUSE_GROUPS] = {"Light from", "… in through", "… off"};
    const char *whole = words_whole(c, arena);
    add(facts, "Seen through", glasses_words(c, arena));
    if (whole[0]) add(facts, "Judged by", arena_format(arena, "its worst part; %s", whole));
    for (int g = 0; g < CAUSE_GROUPS; g++)
        if (c->groups[g].count) add(facts, NAMES[g], group_words(&c->groups[g], arena));
    if (!c->groups[GROUP_LIGHT].count && c->cause_count)
        add(facts, "Why",
            arena_format(arena, "%s of what the display reflects comes by: %s",
                         words_share(c->causes[0].share, arena),
                         words_chain(&c->causes[0], arena)));
    add(facts, "No data", words_without_data(review, c, arena));
    add(facts, "Empty seat", words_empty_seat(c, arena));
}

/* With how many others that cannot be judged either. */
static const char *unjudged_words(const Review *review, const ReviewCase *of, Arena *arena) {
    const char *name = words_case(of, arena);
    int count = 0, same = 0;
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewCase *c = review_case_at(review, i);
        if (c == of || c->verdict != VERDICT_UNJUDGED || !review_case_counts(c)) continue;
        count++;
        same += c->unjudged == of->unjudged;
    }
    if (!count) return name;
    const char *others =
        arena_format(arena, "%s, and %d other%s", name, count, count == 1 ? "" : "s");
    return same == count ? arena_format(arena, "%s for the same reason", others)
                         : arena_format(arena, "%s, of which %d for the same reason", others, same);
}

static void add_unjudged(ReviewFacts *facts, const Review *review, const ReviewCase *c,
                         Arena *arena) {
    add(facts, "Not judged", unjudged_words(review, c, arena));
    add(facts, "Why", words_unjudged(c, arena));
    add(facts, "To judge it", words_to_judge(c));
}

/* ---- the remedy -------------------------------------------------------------------------- */

static void add_mend(ReviewFacts *facts, int *listed, bool mends, const char *words) {
    const char *name = *listed ? "… or" : mends ? "Remedy" : "What helps";
    add(facts, name, words);
    ++*listed;
}

/* Variants of the whole review go before what is estimated for this case alone. */
static void add_tried(ReviewFacts *facts, const Review *review, int *listed, Arena *arena) {
    for (int i = 0; i < review->variant_count && *listed < MENDS_LISTED; i++) {
        const ReviewVariantFound *v = &review->variants[i];
        if (review_verdict(v->review) == VERDICT_PASS)
            add_mend(facts, listed, true,
                     arena_format(arena, "the variant '%s': everything passes", v->name));
    }
}

static void add_mends(ReviewFacts *facts, const Review *review, const ReviewCase *c, Arena *arena) {
    int listed = 0;
    add_tried(facts, review, &listed, arena);
    for (int i = 0; i < c->remedy_count && listed < MENDS_LISTED; i++) {
        const CaseRemedy *r = &c->remedies[i];
        add_mend(facts, &listed, r->verdict == VERDICT_PASS,
                 arena_format(arena, "%s: %s", r->what, words_remedy(r, arena)));
    }
}

ReviewFacts review_facts_of(const Review *review, const ReviewCase *c,
                            const char *const *directions, Arena *arena) {
    ReviewFacts facts = {.count = 0};
    if (c->unjudged) add_unjudged(&facts, review, c, arena);
    add_when(&facts, review, c, directions, arena);
    add_why(&facts, review, c, arena);
    if (c->verdict != VERDICT_PASS) add_mends(&facts, review, c, arena);
    return facts;
}

/* ---- counting ---------------------------------------------------------------------------- */

#define NAMES_LISTED 3

/* Of one kind and basis. */
static long count_of(const Review *review, RestKind kind, RestBasis basis) {
    long count = 0;
    for (int i = 0; i < review->rests_on_count; i++) {
        const ReviewRest *r = &review->rests_on[i];
        if (r->kind == kind && r->basis == basis) count += r->count;
    }
    return count;
}

static const ReviewRest *first_of(const Review *review, RestKind kind) {
    for (int i = 0; i < review->rests_on_count; i++)
        if (review->rests_on[i].kind == kind) return &review->rests_on[i];
    return NULL;
}

/* "speed, centre and 3 more" */
static const char *names_of(const Review *review, RestKind kind, RestBasis basis, Arena *arena) {
    Text text = {.arena = arena};
    int all = 0, listed = 0;
    for (int i = 0; i < review->rests_on_count; i++)
        all += review->rests_on[i].kind == kind && review->rests_on[i].basis == basis;
    for (int i = 0; i < review->rests_on_count && listed < NAMES_LISTED; i++) {
        const ReviewRest *r = &review->rests_on[i];
        if (r->kind != kind || r->basis != basis) continue;
        text_format(&text, "%s%s", listed ? ", " : "", r->name ? r->name : "?");
        listed++;
    }
    if (listed < all) text_format(&text, " and %d more", all - listed);
    return text.data ? text.data : "";
}

static void part(Text *line, const char *words) {
    if (words[0]) text_format(line, "%s%s", line->size ? "; " : "", words);
}

/* ---- panels ------------------------------------------------------------------------------ */

static const CasePanel *panel_of(const Review *review, const char *display) {
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewCase *c = review_case_at(review, i);
        if (words_same(c->display, display)) return &c->panel;
    }
    return NULL;
}

/* What its file says of itself (panel/query/panel_stated.h); why it is not usable is reported
 * of every case of it. */
static void add_stated(Text *text, const CasePanel *panel, Arena *arena) {
    text_format(text, ", %s", panel->verdict ? panel->verdict : "no verdict of its own");
    if (panel->is_coarse && !panel->is_unusable) text_add(text, ", coarse");
    if (panel->reason && !panel->is_unusable) text_format(text, " (%s)", panel->reason);
    if (panel->emission_error > 0 || panel->reflection_error > 0)
        text_format(text, ", within %s of its tables of emission and %s of those of reflection",
                    words_share(panel->emission_error, arena),
                    words_share(panel->reflection_error, arena));
    if (panel->assumed) text_format(text, ", %s", panel->assumed);
}

#define EXTRAPOLATED_LEAST 0.01 /* of the reflected light that is worth a word */

/* Of a display's cases, the most. */
static void add_extrapolated(Text *text, const Review *review, const char *display, Arena *arena) {
    double most = 0;
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewCase *c = review_case_at(review, i);
        if (words_same(c->display, display)) most = fmax(most, c->extrapolated_share);
    }
    if (most >= EXTRAPOLATED_LEAST)
        text_format(text,
                    ", up to %s of the light that it reflects by directions that were "
                    "not measured",
                    words_share(most, arena));
}

static const char *stated_words(const Review *review, const ReviewRest *r, Arena *arena) {
    const CasePanel *panel = panel_of(review, r->name);
    Text text = {.arena = arena};
    if (r->basis == REST_MEASURED) text_format(&text, "measured (%s)", r->words);
    else text_add(&text, r->basis == REST_SYNTHETIC ? "synthetic" : "no measurement stated");
    if (panel) add_stated(&text, panel, arena);
    add_extrapolated(&text, review, r->name, arena);
    return text.data;
}

/* Displays whose panels state the same stand together. */
static void add_panels(Text *line, const Review *review, Arena *arena) {
    int count = review->rests_on_count;
    const char **stated = ARENA_NEW(arena, const char *, count); /* NULL: none, or reported */
    for (int i = 0; i < count; i++)
        if (review->rests_on[i].kind == REST_PANEL)
            stated[i] = stated_words(review, &review->rests_on[i], arena);
    for (int i = 0; i < count; i++) {
        const char *words = stated[i];
        Text names = {.arena = arena};
        for (int k = i; words && k < count; k++) {
            const char *name = review->rests_on[k].name;
            if (!stated[k] || strcmp(stated[k], words) != 0) continue;
            text_format(&names, "%s%s", k > i ? ", " : "", name ? name : "?");
            stated[k] = NULL;
        }
        if (words) part(line, arena_format(arena, "panel of %s: %s", names.data, words));
    }
}

/* ---- materials --------------------------------------------------------------------------- */

static double greatest_share(const Review *review, RestBasis basis) {
    double most = 0;
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewCase *c = review_case_at(review, i);
        most = fmax(most, basis == REST_GUESSED ? c->guessed_share : c->without_data_share);
    }
    return most;
}

static void add_materials(Text *line, const Review *review, RestBasis basis, Arena *arena) {
    long count = count_of(review, REST_MATERIAL, basis);
    const char *share = words_share(greatest_share(review, basis), arena);
    const char *plural = count == 1 ? "" : "s";
    if (!count) return;
    part(line, basis == REST_GUESSED
                   ? arena_format(arena,
                                  "%ld guessed material%s (up to %s of the light on a "
                                  "symbol)",
                                  count, plural, share)
                   : arena_format(arena,
                                  "%ld material%s without optical data, taken as "
                                  "perfectly white (up to %s of the light on a symbol)",
                                  count, plural, share));
}

static void add_all_materials(Text *line, const Review *review, Arena *arena) {
    add_materials(line, review, REST_GUESSED, arena);
    add_materials(line, review, REST_WITHOUT_DATA, arena);
    if (!first_of(review, REST_MATERIAL)) part(line, "materials as the model states them");
}

/* ---- eyes, occupants, limits ------------------------------------------------------------- */

static void add_eyes(Text *line, const Review *review, Arena *arena) {
    long given = count_of(review, REST_EYE, REST_GIVEN);
    long proposed = count_of(review, REST_EYE, REST_PROPOSED);
    if (!proposed) {
        part(line, given == 1 ? "the eye as given" : "eyes as given");
        return;
    }
    const char *names = names_of(review, REST_EYE, REST_PROPOSED, arena);
    part(line, arena_format(arena, "proposed eye%s (%s)%s", proposed == 1 ? "" : "s", names,
                            given ? ", the others as given" : ""));
}

/* Seats are known by their backs, where much light comes off them. */
static const char *nobody_words(const Review *review, Arena *arena) {
    static const char UNLESS[] = "unless the model itself has somebody";
    int count = review_case_count(review);
    WordList eyes = words_list(count, arena), empty = words_list(count, arena);
    Text seats = {.arena = arena};
    for (int i = 0; i < count; i++) {
        const ReviewCase *c = review_case_at(review, i);
        words_list_add(&eyes, c->eye);
        if (c->empty_seat) words_list_add(&empty, c->eye);
    }
    for (int i = 0; i < empty.count; i++)
        text_format(&seats, "%s%s's", i ? " and " : "", empty.list[i]);
    if (!empty.count)
        return arena_format(arena, "no occupant named: nobody sits there, %s", UNLESS);
    if (empty.count == eyes.count)
        return arena_format(arena, "no occupant named: nobody sits in the %s seat", seats.data);
    return arena_format(arena,
                        "no occupant named: nobody sits in the %s seat, nor in another "
                        "%s",
                        seats.data, UNLESS);
}

static void add_occupants(Text *line, const Review *review, Arena *arena) {
    const ReviewRest *first = first_of(review, REST_OCCUPANT);
    long empty = count_of(review, REST_OCCUPANT, REST_NOBODY);
    if (!first) return;
    if (empty == first->of) {
        part(line, nobody_words(review, arena));
        return;
    }
    const char *names = names_of(review, REST_OCCUPANT, REST_PRESENT, arena);
    part(line, empty ? arena_format(arena,
                                    "occupants: %s (none under %ld of %ld "
                                    "conditions)",
                                    names, empty, first->of)
                     : arena_format(arena, "occupants: %s", names));
}

static void add_limits(Text *line, const Review *review, Arena *arena) {
    const ReviewRest *limits = first_of(review, REST_LIMITS);
    if (!limits) return;
    if (!limits->of) part(line, "a profile that sets no limit");
    else if (limits->count == limits->of) part(line, "limits as read in the standard");
    else if (!limits->count) part(line, "limits as quoted, none read in the standard");
    else
        part(line, arena_format(arena, "limits as quoted, %ld of %ld read in the standard",
                                limits->count, limits->of));
}

const char *review_rests_words(const Review *review, Arena *arena) {
    Text line = {.arena = arena};
    if (!review->rests_on_count) return "";
    add_panels(&line, review, arena);
    add_all_materials(&line, review, arena);
    add_eyes(&line, review, arena);
    add_occupants(&line, review, arena);
    add_limits(&line, review, arena);
    return line.data;
}
