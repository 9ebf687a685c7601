/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_answer.h"

#include <math.h>
#include <strings.h>

#include "page/page.h"
#include "review/output/review_bar.h"
#include "review/output/review_decide.h"
#include "review/output/review_rays.h"
#include "review/output/review_words.h"
#include "text/text.h"

#define GRID_ROWS 7
#define GRID_EYES 4
#define MENDS_LISTED 2
#define SHARES_LISTED 3

const char *const *review_answer_directions(const ReviewAnswer *answer, const ReviewCase *c,
                                            Arena *arena)
{
    if (review_card_id(answer->review, c, arena)[0] == 'c') return words_directions(false);
    for (int i = 0; i < answer->map_count; i++)
        if (c == &answer->maps[i].of->worst)
            return words_directions(answer->maps[i].is_of_vehicle);
    return NULL;
}

/* Symbols of other names whose files would have this one's, with large letters for small ones
 * too, are numbered in the review's order; the point stands in no name that has no number. */
const char *review_summary_name(const Review *review, const char *symbol, Arena *arena)
{
    const char *name = words_file_name(symbol ? symbol : "", arena);
    int         all = review->case_count + review->sweep_count;
    WordList    alike = words_list(all, arena);
    for (int i = 0; i < all; i++) {
        const char *other = i < review->case_count
                                ? review->cases[i].symbol
                                : review->sweeps[i - review->case_count].symbol;
        Arena scratch = *arena;
        if (words_same(other, symbol)) break;
        if (!strcasecmp(words_file_name(other ? other : "", &scratch), name))
            words_list_add(&alike, other);
    }
    if (!alike.count) return arena_format(arena, "summary-%s.html", name);
    return arena_format(arena, "summary-%s.%d.html", name, alike.count + 1);
}

/* ---- the line --------------------------------------------------------------------------- */

/* Words before the worst case; "": none. */
static const char *answer_words(const Review *review, const ReviewCase *worst)
{
    if (!review_case_counts(worst)) return "nothing that must be read was asked; ";
    if (!review->pass) return worst->verdict == VERDICT_PASS ? "the worst is " : "";
    return worst->verdict == VERDICT_PASS ? "closest to its limit is "
                                          : "nothing fails; the worst is ";
}

static void add_line(Text *html, const Review *review, const ReviewCase *worst, Arena *arena)
{
    Verdict verdict = review_verdict(review);
    text_format(html, "<div class=\"verdict%s\"><h1><b>%s</b>: ",
                verdict == VERDICT_PASS ? " same" : "", words_verdict(verdict));
    if (!worst) {
        text_add(html, "nothing was asked, so nothing can fail.</h1></div>\n");
        return;
    }
    text_add(html, answer_words(review, worst));
    escape_markup(html, words_case(worst, arena));
    text_add(html, ": ");
    escape_markup(html, words_reason(worst, arena));
    text_add(html, ".</h1></div>\n");
    page_element(html, "p class=\"sub rests\"",
                 arena_format(arena, "Rests on: %s.", words_rests_on(review, arena)));
}

/* ---- every symbol and eye --------------------------------------------------------------- */

typedef struct Grid {
    const ReviewCase **ranked; /* the worst first */
    int                count;
    WordList           symbols, eyes; /* in the order of their worst */
} Grid;

static Grid make_grid(const Review *review, Arena *arena)
{
    int  count = review_case_count(review);
    Grid grid = {review_rank(review, arena), count, words_list(count, arena),
                 words_list(count, arena)};
    for (int i = 0; i < count; i++) {
        words_list_add(&grid.symbols, grid.ranked[i]->symbol);
        words_list_add(&grid.eyes, grid.ranked[i]->eye);
    }
    return grid;
}

static const ReviewCase *worst_of(const Grid *grid, const char *symbol, const char *eye)
{
    for (int i = 0; i < grid->count; i++)
        if (words_same(grid->ranked[i]->symbol, symbol) &&
            words_same(grid->ranked[i]->eye, eye))
            return grid->ranked[i];
    return NULL;
}

static const char *below_words(const ReviewCase *c, Arena *arena)
{
    const LimitVerdict *limit = case_worst_limit(c);
    const char *condition = c->condition ? c->condition : "?";
    if (!limit || isnan(limit->margin)) return condition;
    return arena_format(arena, "%s · %s", words_margin(limit->margin, arena), condition);
}

static void add_cell(Text *html, const Review *review, const ReviewCase *c, Arena *arena)
{
    if (!c) {
        page_cell(html, "none", "–");
        return;
    }
    review_card_begin_cell(html, review, c, arena);
    text_add(html, "<b>");
    escape_markup(html, arena_format(arena, "%s %s", words_mark(c->verdict),
                                     words_judged(c, arena)));
    text_add(html, "</b>");
    page_element(html, "small", below_words(c, arena));
    text_add(html, "</a></td>");
}

/* Links to the symbol's summary, which fits on one page of paper. */
static void add_symbol(Text *html, const Review *review, const char *symbol, Arena *arena)
{
    if (!review->has_summaries || review->whole) {
        page_cell(html, "", symbol);
        return;
    }
    text_format(html, "<td><a class=\"symbol\" href=\"%s\">",
                review_summary_name(review, symbol, arena));
    escape_markup(html, symbol);
    text_add(html, "</a></td>");
}

static void add_rows(Text *html, const Review *review, const Grid *grid, int rows, int eyes,
                     Arena *arena)
{
    for (int row = 0; row < rows; row++) {
        page_row_begin(html, "");
        add_symbol(html, review, grid->symbols.list[row], arena);
        for (int i = 0; i < eyes; i++)
            add_cell(html, review,
                     worst_of(grid, grid->symbols.list[row], grid->eyes.list[i]), arena);
        page_row_end(html);
    }
}

static const char *count_words(const Review *review, Arena *arena)
{
    static const char *const NAMES[4] = {"pass", "fail", "too close to call",
                                         "cannot be judged"};
    static const Verdict ORDER[4] = {VERDICT_FAIL, VERDICT_UNJUDGED, VERDICT_TOO_CLOSE,
                                     VERDICT_PASS};
    ReviewCounts counts = review_count(review);
    Text         text = {.arena = arena};
    const char  *before = ":";
    text_format(&text, "%d verdict%s", counts.total, counts.total == 1 ? "" : "s");
    for (int i = 0; i < 4; i++) {
        if (!counts.of[ORDER[i]]) continue;
        text_format(&text, "%s %d %s", before, counts.of[ORDER[i]], NAMES[ORDER[i]]);
        before = ",";
    }
    if (counts.not_asked)
        text_format(&text, "%s %d that do%s not count", before, counts.not_asked,
                    counts.not_asked == 1 ? "es" : "");
    return text.data;
}

static void add_grid(Text *html, const Review *review, Arena *arena)
{
    Grid        grid = make_grid(review, arena);
    PageColumn  columns[GRID_EYES + 1] = {{"at its worst", false, NULL}};
    int         eyes = grid.eyes.count < GRID_EYES ? grid.eyes.count : GRID_EYES;
    int         rows = grid.symbols.count < GRID_ROWS ? grid.symbols.count : GRID_ROWS;
    for (int i = 0; i < eyes; i++)
        columns[i + 1] = (PageColumn){grid.eyes.list[i], false, NULL};
    text_add(html, "<div class=\"grid\">");
    page_table_begin(html, "", "matrix", columns, eyes + 1);
    add_rows(html, review, &grid, rows, eyes, arena);
    page_table_end(html);
    if (rows < grid.symbols.count || eyes < grid.eyes.count)
        page_element(html, "p class=\"sub\"",
                     arena_format(arena, "The worst %d of %d symbols, as the worst %d of %d "
                                  "eyes see them; all stand below.", rows, grid.symbols.count,
                                  eyes, grid.eyes.count));
    page_element(html, "p class=\"sub\"", count_words(review, arena));
    text_add(html, "</div>\n");
}

/* ---- the worst case --------------------------------------------------------------------- */

static void add_when(Text *html, const ReviewAnswer *answer, const ReviewCase *c, Arena *arena)
{
    const ReviewSweep *sweep = review_sweep_of(answer->review, c);
    const char *sun = words_sun(c, review_answer_directions(answer, c, arena), arena);
    const char *when = c->when ? c->when : c->condition ? c->condition : "?";
    page_fact(html, "When", arena_format(arena, "%s: %s", when,
                                         c->has_sun ? sun : words_ambient(c->ambient)));
    if (sweep) page_fact(html, "How often", words_how_often(sweep, arena));
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

static void add_why(Text *html, const ReviewAnswer *answer, const ReviewCase *c, Arena *arena)
{
    static const char *const NAMES[CAUSE_GROUPS] = {"Light from", "… in through", "… off"};
    for (int g = 0; g < CAUSE_GROUPS; g++)
        if (c->groups[g].count) page_fact(html, NAMES[g], group_words(&c->groups[g], arena));
    if (!c->groups[GROUP_LIGHT].count && c->cause_count)
        page_fact(html, "Why",
                  arena_format(arena, "%s of what the display reflects comes by: %s",
                               words_share(c->causes[0].share, arena),
                               words_chain(&c->causes[0], arena)));
    const char *without = words_without_data(answer->review, c, arena);
    if (without[0]) page_fact(html, "No data", without);
}

/* The one that leads farthest first. */
static const CaseRemedy *next_mend(const ReviewCase *c, const bool *is_listed)
{
    const CaseRemedy *best = NULL;
    for (int i = 0; i < c->remedy_count; i++) {
        const CaseRemedy *r = &c->remedies[i];
        bool is_more = !best || !(best->then.margin >= r->then.margin);
        if (!is_listed[i] && is_more) best = r;
    }
    return best;
}

static void add_mend(Text *html, int *listed, const char *words)
{
    page_fact(html, *listed ? "… or" : "What mends it", words);
    ++*listed;
}

/* Changes tried on the whole review go before those estimated for this case alone. */
static void add_tried(Text *html, const Review *review, int *listed, Arena *arena)
{
    for (int i = 0; i < review->mend_count; i++)
        if (review->mends[i].is_found)
            add_mend(html, listed, words_mend(&review->mends[i], arena));
    for (int i = 0; i < review->variant_count && *listed < MENDS_LISTED; i++) {
        const ReviewVariantFound *v = &review->variants[i];
        if (review_verdict(v->review) == VERDICT_PASS)
            add_mend(html, listed, arena_format(arena, "the variant '%s': everything passes",
                                                v->name));
    }
}

static void add_mends(Text *html, const Review *review, const ReviewCase *c, Arena *arena)
{
    bool *is_listed = ARENA_NEW(arena, bool, c->remedy_count + 1);
    int   listed = 0;
    add_tried(html, review, &listed, arena);
    while (listed < MENDS_LISTED) {
        const CaseRemedy *r = next_mend(c, is_listed);
        if (!r) return;
        is_listed[r - c->remedies] = true;
        add_mend(html, &listed,
                 arena_format(arena, "%s: %s", r->what, words_remedy(r, arena)));
    }
}

static const ReviewPicture *frame_of(const ReviewAnswer *answer, const ReviewCase *c)
{
    for (int i = 0; i < answer->picture_count; i++) {
        const ReviewPicture *p = &answer->pictures[i];
        if (p->of == c && p->is_frame) return p;
    }
    return NULL;
}

/* The case's card has it, too: there it stands. */
static bool add_frame(Text *html, const ReviewPicture *frame, Arena scratch, Error *err)
{
    ReviewPicture shown = *frame;
    shown.is_again = shown.id != NULL;
    text_add(html, "<div class=\"shown\">");
    if (!review_card_add_picture(html, &shown, scratch, err)) return false;
    review_rays_add_rim(html, shown.of);
    text_add(html, "</div>\n");
    return true;
}

static bool add_worst(Text *html, const ReviewAnswer *answer, const ReviewCase *c, Arena *arena,
                      Error *err)
{
    const ReviewPicture *frame = frame_of(answer, c);
    text_add(html, "<section class=\"worst\" aria-label=\"The worst case\">\n");
    if (frame && !add_frame(html, frame, *arena, err)) return false;
    if (!frame && c->verdict != VERDICT_UNJUDGED) review_bar_add_luminances(html, c, arena);
    text_add(html, "<dl class=\"facts\">\n");
    add_when(html, answer, c, arena);
    add_why(html, answer, c, arena);
    if (c->verdict != VERDICT_PASS) add_mends(html, answer->review, c, arena);
    text_add(html, "</dl></section>\n");
    return true;
}

bool review_answer_add(Text *html, const ReviewAnswer *answer, Arena *arena, Error *err)
{
    const ReviewCase *worst = review_worst(answer->review, *arena);
    add_line(html, answer->review, worst, arena);
    if (!worst) return true;
    text_add(html, "<div class=\"first\">\n");
    add_grid(html, answer->review, arena);
    if (!add_worst(html, answer, worst, arena, err)) return false;
    text_add(html, "</div>\n");
    return true;
}
