/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_answer.h"

#include <math.h>
#include <strings.h>

#include "page/page.h"
#include "review/output/review_card.h"
#include "review/output/review_facts.h"
#include "review/output/review_link.h"
#include "review/output/review_rays.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "text/json_text.h"
#include "text/text.h"

#define GRID_ROWS 7
#define GRID_EYES 4
#define GRID_WIDTH 790   /* pixels, of a screen of 1280, beside the worst case (review.css) */
#define LETTER 8.7       /* pixels: bold letters of 13 pixels, wide ones */
#define SMALL_LETTER 6.8
#define LEAST_CELL 90
#define CELL_MARGIN 22
#define PHONE_WIDTH 355  /* of a telephone of 390 pixels, likewise: letters of 11 and 9.5 */
#define PHONE_MARGIN 14
#define PHONE_LETTER 7.4
#define PHONE_SMALL 5.8

/* ---- the verdict ------------------------------------------------------------------------ */

/* Words before the worst case; "": none. */
static const char *answer_words(const Review *review, const ReviewCase *worst)
{
    if (!review_case_counts(worst)) return "nothing is required to be read; ";
    if (!review->pass) return worst->verdict == VERDICT_PASS ? "the worst is " : "";
    return worst->verdict == VERDICT_PASS ? "closest to its limit is "
                                          : "nothing fails; the worst is ";
}

static void set_verdict(json_t *to, const Review *review, const ReviewCase *worst)
{
    static const char *const CLASSES[4] = {
        [VERDICT_PASS] = " same", [VERDICT_FAIL] = "", [VERDICT_TOO_CLOSE] = " open",
        [VERDICT_UNJUDGED] = " unknown"};
    Verdict verdict = review_verdict(review);
    page_set(to, "class", CLASSES[verdict]);
    page_set(to, "outcome", words_verdict(verdict));
    page_set(to, "lead", worst ? answer_words(review, worst) : "");
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

static json_t *row_values(const PageValues *v, const Grid *grid, int row, int eyes)
{
    json_t     *to = json_object(), *cells = values_list(to, "cells");
    const char *symbol = grid->symbols.list[row];
    bool        has_summary = v->review->has_summaries && !v->review->whole;
    page_set(to, "name", symbol);
    page_set(to, "summary", has_summary ? review_summary_name(v->review, symbol, v->arena)
                                        : NULL);
    for (int i = 0; i < eyes; i++)
        values_add_case(v, cells, worst_of(grid, symbol, grid->eyes.list[i]));
    return to;
}

/* Of those that do not count. */
static int count_unlimited(const Review *review)
{
    int count = 0;
    for (int i = 0; i < review_case_count(review); i++)
        count += review_case_at(review, i)->unjudged == UNJUDGED_LIMIT;
    return count;
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
    int unlimited = count_unlimited(review), optional = counts.not_asked - unlimited;
    if (unlimited)
        text_format(&text, "%s %d to which no limit applies", before, unlimited);
    if (optional)
        text_format(&text, "%s %d hidden that need not be seen", unlimited ? "," : before,
                    optional);
    return text.data;
}

/* Letters of its longest word. Text in letters that need no space between words, as in
 * Chinese, breaks anywhere. */
static int longest_word(const char *text)
{
    int most = 0, letters = 0;
    for (const unsigned char *at = (const unsigned char *)(text ? text : ""); *at; at++) {
        bool is_end = *at == ' ' || *at == '-' || *at >= 0xe3;
        letters = is_end ? 0 : letters + ((*at & 0xc0) != 0x80);
        if (letters > most) most = letters;
    }
    return most;
}

/* So that no word breaks and none is cut off, in pixels: about what letters of 13 and 11
 * pixels take, and what is around them. */
static double grid_width(const Grid *grid, int rows, int eyes)
{
    double symbol = 0, below = LEAST_CELL, width = 0;
    for (int i = 0; i < rows; i++)
        symbol = fmax(symbol, LETTER * longest_word(grid->symbols.list[i]));
    for (int i = 0; i < grid->count; i++)
        below = fmax(below, SMALL_LETTER * longest_word(grid->ranked[i]->condition));
    for (int i = 0; i < eyes; i++)
        width += fmax(below, LETTER * longest_word(grid->eyes.list[i])) + CELL_MARGIN;
    return width + symbol + CELL_MARGIN;
}

/* Do the columns of a telephone hold the longest words? */
static bool fits_phone(const Grid *grid, int eyes)
{
    double room = (double)PHONE_WIDTH / eyes - PHONE_MARGIN;
    int    eye = 0, condition = 0;
    for (int i = 0; i < eyes; i++) {
        int word = longest_word(grid->eyes.list[i]);
        if (word > eye) eye = word;
    }
    for (int i = 0; i < grid->count; i++) {
        int word = longest_word(grid->ranked[i]->condition);
        if (word > condition) condition = word;
    }
    return PHONE_LETTER * eye <= room && PHONE_SMALL * condition <= room;
}

static void set_grid(const PageValues *v, json_t *to)
{
    Grid grid = make_grid(v->review, v->arena);
    int  eyes = grid.eyes.count < GRID_EYES ? grid.eyes.count : GRID_EYES;
    int  symbols = grid.symbols.count, rows = symbols < GRID_ROWS ? symbols : GRID_ROWS;
    while (eyes > 1 && grid_width(&grid, rows, eyes) > GRID_WIDTH) eyes--;
    bool    has_all_eyes = eyes == grid.eyes.count;
    json_t *list = values_list(to, "rows");
    json_object_set_new(to, "eyes", json_texts(grid.eyes.list, eyes));
    for (int row = 0; row < rows; row++)
        json_array_append_new(list, row_values(v, &grid, row, eyes));
    page_set_flag(to, "breaks", grid_width(&grid, rows, eyes) > GRID_WIDTH);
    page_set_flag(to, "stacked", !fits_phone(&grid, eyes));
    page_set_count(to, "shown", rows);
    page_set_count(to, "shown_eyes", eyes);
    page_set_count(to, "symbols", symbols);
    page_set_count(to, "of_eyes", has_all_eyes ? 0 : grid.eyes.count);
    page_set_flag(to, "of_symbols", has_all_eyes && rows < symbols);
    page_set(to, "counts", count_words(v->review, v->arena));
}

/* ---- the worst case --------------------------------------------------------------------- */

static const ReviewPicture *frame_of(const ReviewPage *page, const ReviewCase *c)
{
    for (int i = 0; i < page->picture_count; i++) {
        const ReviewPicture *p = &page->pictures[i];
        if (p->of == c && p->is_frame) return p;
    }
    return NULL;
}

/* The part of the frame about the symbol, larger; of a frame that stands elsewhere. */
static void set_close_up(json_t *to, const ReviewPicture *frame, Arena scratch)
{
    const CaseView *view = frame->of->view;
    double          box[4];
    if (!(frame->beside || frame->id) || !review_rays_close_up(frame->of, box)) return;
    json_t *close_up = values_object(to, "close_up");
    page_set(close_up, "box", arena_format(&scratch, "%.1f %.1f %.1f %.1f", box[0], box[1],
                                           box[2], box[3]));
    page_set_count(close_up, "view_width", view->width);
    page_set_count(close_up, "view_height", view->height);
    page_set(close_up, "line", review_rays_line(frame->of, &scratch));
}

/* The case's card has it, too: there it stands. */
static bool set_frame(const PageValues *v, const ReviewPicture *frame, Error *err)
{
    json_t       *to = values_object(v->doc, "first_frame");
    ReviewPicture shown = *frame;
    Arena         scratch = *v->arena;
    shown.is_again = shown.id != NULL;
    page_set(to, "rim", review_rays_rim(shown.of, &scratch));
    set_close_up(to, &shown, scratch);
    return values_add_picture(to, &shown, scratch, err);
}

static void set_facts(const PageValues *v, const ReviewCase *c)
{
    json_t     *list = values_list(v->doc, "facts");
    ReviewFacts facts = review_facts_of(v->review, c, values_directions(v, c), v->arena);
    for (int i = 0; i < facts.count; i++) {
        json_t *fact = page_add(list);
        page_set(fact, "name", facts.list[i].name);
        page_set(fact, "value", facts.list[i].value);
    }
}

bool values_add_answer(const PageValues *v, Error *err)
{
    const ReviewCase    *worst = review_worst(v->review, *v->arena);
    const ReviewPicture *frame = worst ? frame_of(v->page, worst) : NULL;
    set_verdict(values_object(v->doc, "answer"), v->review, worst);
    if (!worst) return true;
    json_object_set(v->doc, "worst", values_of_case(v, worst));
    set_grid(v, values_object(v->doc, "grid"));
    set_facts(v, worst);
    return !frame || set_frame(v, frame, err);
}
