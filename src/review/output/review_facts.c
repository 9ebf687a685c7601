/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_facts.h"

#include <math.h>
#include <string.h>

#include "review/output/review_todo.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "review/road_verdict.h"
#include "text/text.h"

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

static void add_why(ReviewFacts *facts, const Review *review, const ReviewCase *c, Arena *arena) {
    static const char *const NAMES[CAUSE_GROUPS] = {"Source", "Path", "Last surface"};
    const char *whole = words_whole(c, arena);
    add(facts, "Seen through", glasses_words(c, arena));
    const LimitVerdict *limit = case_worst_limit(c);
    bool is_read = c->must_not_be_read && c->verdict == VERDICT_FAIL;
    if (is_read) /* what the display reflects hides it, if anything does */
        add(facts, "Source",
            limit && limit->by_pane
                ? arena_format(arena, "the display itself, mirrored by %s", limit->by_pane)
                : "the display itself, seen straight");
    const char *source = words_group(&c->groups[GROUP_LIGHT], SHARES_LISTED, arena);
    for (int g = 0; g < CAUSE_GROUPS && !is_read; g++) {
        const char *group = words_group(&c->groups[g], SHARES_LISTED, arena);
        bool is_told = g != GROUP_LIGHT && !strcmp(group, source); /* it comes straight */
        if (!is_told) add(facts, NAMES[g], group);
    }
    if (!c->groups[GROUP_LIGHT].count && c->cause_count && !is_read)
        add(facts, "Source",
            arena_format(arena, "%s of the reflected light by %s",
                         words_share(c->causes[0].share, arena),
                         words_chain(&c->causes[0], arena)));
    if (whole[0]) add(facts, "Judged by", arena_format(arena, "worst part; %s", whole));
    add(facts, "No data", words_without_data(review, c, arena));
    add(facts, "Empty seat", words_empty_seat(c, arena));
}

/* ---- what to do -------------------------------------------------------------------------- */

/* A variant of the whole review goes before what is reckoned for this finding alone. */
static void add_todo(ReviewFacts *facts, const Review *review, const Finding *f, Arena *arena) {
    Text text = {.arena = arena};
    for (int i = 0; i < review->variant_count && !text.size; i++)
        if (review_verdict(review->variants[i].review) == VERDICT_PASS)
            text_format(&text, "variant '%s': everything passes", review->variants[i].name);
    const char *todo = todo_of_finding(f, arena);
    if (todo[0]) text_format(&text, "%s%s", text.size ? "; or " : "", todo);
    add(facts, "What to do", text.data ? text.data : "");
}

ReviewFacts review_facts_of(const Review *review, const Finding *f, const char *const *directions,
                            Arena *arena) {
    ReviewFacts facts = {.count = 0};
    const ReviewCase *c = f->c;
    if (c && c->unjudged) {
        add(&facts, "Not judged", words_case(c, arena));
        add(&facts, "Why", words_unjudged(c, arena));
    }
    if (c) add_when(&facts, review, c, directions, arena);
    else add(&facts, "When", f->condition ? f->condition : "?");
    if (f->verdict != VERDICT_PASS) add_todo(&facts, review, f, arena);
    if (c) add_why(&facts, review, c, arena);
    return facts;
}

/* ---- the outcome ------------------------------------------------------------------------- */

/* By light, and all: cases to which limits apply, those with the review's own verdict of them,
 * and those to which none applies. */
typedef struct Covered {
    int judged[5], so[5], unlimited[5];
} Covered;

static Covered covered_by_limits(const Review *review) {
    Covered out = {0};
    Verdict verdict = review_verdict(review);
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewCase *c = review_case_at(review, i);
        const int at[2] = {(int)c->ambient, 4};
        for (int k = 0; k < 2; k++) {
            out.unlimited[at[k]] += c->unjudged == UNJUDGED_LIMIT;
            out.judged[at[k]] += review_case_counts(c);
            out.so[at[k]] += review_case_counts(c) && c->verdict == verdict;
        }
    }
    return out;
}

const char *review_outcome_words(const Review *review, Arena *arena) {
    Text text = {.arena = arena};
    Covered by = covered_by_limits(review);
    bool has_road = false;
    text_add(&text, words_verdict(review_verdict(review)));
    for (int i = 0, listed = 0; i < 4 && by.unlimited[4]; i++)
        if (by.so[i])
            text_format(&text, "%s %s", listed++ ? " and" : "", words_ambient((Ambient)i));
    int bare = 0;
    for (int i = 0; i < 4; i++)
        if (by.unlimited[i] && !by.judged[i])
            text_format(&text, "%s %s", bare++ ? " and" : ";", ambient_names[i]);
    if (bare) text_format(&text, " %s no limit in this profile", bare == 1 ? "has" : "have");
    for (int i = 0; i < 4; i++)
        if (by.unlimited[i] && by.judged[i])
            text_format(&text, "; %d of %d cases %s %s no limit in this profile", by.unlimited[i],
                        by.unlimited[i] + by.judged[i], words_ambient((Ambient)i),
                        by.unlimited[i] == 1 ? "has" : "have");
    for (int i = 0; i < review->gaze_count; i++)
        has_road |= review->gazes[i].road && !review->gazes[i].road->left_out &&
                    !road_has_limit(review->gazes[i].road);
    if (has_road) text_add(&text, "; glare on the road has no limit in this profile");
    return text.data;
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
    int listed = 0, more = 0;
    for (int i = 0; i < review->rests_on_count; i++) {
        const ReviewRest *r = &review->rests_on[i];
        if (r->kind != kind || r->basis != basis) continue;
        if (listed == NAMES_LISTED) more++;
        else text_format(&text, "%s%s", listed++ ? ", " : "", r->name ? r->name : "?");
    }
    if (more) text_format(&text, " and %d more", more);
    return text.data ? text.data : "";
}

static const char *plural(long count) {
    return count == 1 ? "" : "s";
}

/* ---- panels ------------------------------------------------------------------------------ */

#define EXTRAPOLATED_LEAST 0.01 /* of the reflected light that is worth a word */

/* What its file says of itself (panel/query/panel_stated.h); why it is not usable is reported
 * of every case of it. Of a display's cases the most that was not measured. */
static void add_stated(Text *text, const Review *review, const char *display, Arena *arena) {
    const CasePanel *panel = NULL;
    double most = 0;
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewCase *c = review_case_at(review, i);
        if (!words_same(c->display, display)) continue;
        if (!panel) panel = &c->panel;
        most = fmax(most, c->extrapolated_share);
    }
    if (!panel) return;
    text_format(text, ", %s", panel->verdict ? panel->verdict : "no verdict of its own");
    if (panel->is_coarse && !panel->is_unusable) text_add(text, ", coarse");
    if (panel->reason && !panel->is_unusable) text_format(text, " (%s)", panel->reason);
    if (panel->emission_error > 0 || panel->reflection_error > 0)
        text_format(text, ", fit error %s in emission, %s in reflection",
                    words_share(panel->emission_error, arena),
                    words_share(panel->reflection_error, arena));
    if (panel->assumed) text_format(text, ", %s", panel->assumed);
    if (most >= EXTRAPOLATED_LEAST)
        text_format(text, ", up to %s of its reflected light extrapolated",
                    words_share(most, arena));
}

static RestWords panel_words(const Review *review, Arena *arena) {
    static const char *const BASES[] = {"measured", "synthetic", "no measurement stated"};
    Text chip = {.arena = arena}, words = {.arena = arena};
    for (int b = REST_MEASURED; b <= REST_NOT_STATED; b++) {
        long count = count_of(review, REST_PANEL, (RestBasis)b);
        if (count)
            text_format(&chip, "%s%ld panel%s: %s", chip.size ? ", " : "", count, plural(count),
                        BASES[b]);
    }
    for (int i = 0; i < review->rests_on_count; i++) {
        const ReviewRest *r = &review->rests_on[i];
        if (r->kind != REST_PANEL) continue;
        text_format(&words, "%s%s: %s", words.size ? "; " : "panel of ", r->name ? r->name : "?",
                    BASES[r->basis]);
        if (r->basis == REST_MEASURED) text_format(&words, " (%s)", r->words);
        add_stated(&words, review, r->name, arena);
    }
    return (RestWords){"panels", chip.data, words.data};
}

/* ---- materials, eyes, occupants, limits -------------------------------------------------- */

static double greatest_share(const Review *review, RestBasis basis) {
    double most = 0;
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewCase *c = review_case_at(review, i);
        most = fmax(most, basis == REST_GUESSED ? c->guessed_share : c->without_data_share);
    }
    return most;
}

static RestWords material_words(const Review *review, Arena *arena) {
    static const RestBasis BASES[] = {REST_GUESSED, REST_WITHOUT_DATA};
    Text chip = {.arena = arena}, words = {.arena = arena};
    for (int b = 0; b < 2; b++) {
        long count = count_of(review, REST_MATERIAL, BASES[b]);
        const char *gap = words.size ? "; " : "";
        if (!count) continue;
        text_format(&chip, b ? "%s%ld material%s without data" : "%s%ld guessed material%s",
                    chip.size ? ", " : "", count, plural(count));
        text_format(&words,
                    b ? "%s%ld material%s without optical data, taken as white (up to %s of the "
                        "light on a symbol)"
                      : "%s%ld guessed material%s (up to %s of the light on a symbol)",
                    gap, count, plural(count),
                    words_share(greatest_share(review, BASES[b]), arena));
    }
    return chip.size ? (RestWords){"materials", chip.data, words.data}
                     : (RestWords){"materials", "materials as modelled",
                                   "materials as the model states them"};
}

static RestWords eye_words(const Review *review, Arena *arena) {
    long given = count_of(review, REST_EYE, REST_GIVEN);
    long proposed = count_of(review, REST_EYE, REST_PROPOSED);
    if (!proposed) return (RestWords){"eyes", "eyes as given", "eyes as given"};
    return (RestWords){"eyes",
                       arena_format(arena, "%ld proposed eye%s", proposed, plural(proposed)),
                       arena_format(arena, "proposed eye%s (%s)%s", plural(proposed),
                                    names_of(review, REST_EYE, REST_PROPOSED, arena),
                                    given ? ", the others as given" : "")};
}

/* Empty seats are known by their backs, where much light comes off them. */
static RestWords occupant_words(const Review *review, Arena *arena) {
    const ReviewRest *first = first_of(review, REST_OCCUPANT);
    long empty = count_of(review, REST_OCCUPANT, REST_NOBODY);
    int count = review_case_count(review);
    WordList seats = words_list(count, arena);
    Text words = {.arena = arena};
    if (!first) return (RestWords){"occupants", NULL, NULL};
    if (empty < first->of) {
        const char *names = names_of(review, REST_OCCUPANT, REST_PRESENT, arena);
        const char *rest =
            empty ? arena_format(arena, " (none under %ld of %ld conditions)", empty, first->of)
                  : "";
        return (RestWords){"occupants",
                           empty ? arena_format(arena, "occupants in %ld of %ld conditions",
                                                first->of - empty, first->of)
                                 : "with occupants",
                           arena_format(arena, "occupants: %s%s", names, rest)};
    }
    for (int i = 0; i < count; i++)
        if (review_case_at(review, i)->empty_seat)
            words_list_add(&seats, review_case_at(review, i)->eye);
    text_add(&words, "no occupant named, unless the model itself has somebody");
    for (int i = 0; i < seats.count; i++)
        text_format(&words, "%s%s", i ? ", " : "; empty seats: ", seats.list[i]);
    return (RestWords){"occupants", "no occupant", words.data};
}

static RestWords limit_words(const Review *review, Arena *arena) {
    const ReviewRest *limits = first_of(review, REST_LIMITS);
    if (!limits) return (RestWords){"limits", NULL, NULL};
    if (!limits->of) return (RestWords){"limits", "no limits", "a profile that sets no limit"};
    if (limits->count == limits->of)
        return (RestWords){"limits", "limits read in the standard",
                           "limits as read in the standard"};
    return (RestWords){"limits",
                       limits->count ? arena_format(arena, "limits: %ld read, %ld quoted",
                                                    limits->count, limits->of - limits->count)
                                     : "limits as quoted",
                       arena_format(arena, "limits as quoted, %ld of %ld read in the standard",
                                    limits->count, limits->of)};
}

int review_rests(const Review *review, RestWords out[REST_KINDS], Arena *arena) {
    const RestWords all[REST_KINDS] = {panel_words(review, arena), material_words(review, arena),
                                       eye_words(review, arena), occupant_words(review, arena),
                                       limit_words(review, arena)};
    int count = 0;
    for (int i = 0; i < REST_KINDS && review->rests_on_count; i++)
        if (all[i].chip) out[count++] = all[i];
    return count;
}

const char *review_rests_words(const Review *review, bool is_short, Arena *arena) {
    Text line = {.arena = arena};
    RestWords list[REST_KINDS];
    int count = review_rests(review, list, arena);
    for (int i = 0; i < count; i++)
        text_format(&line, "%s%s", i ? "; " : "", is_short ? list[i].chip : list[i].words);
    return line.data ? line.data : "";
}
