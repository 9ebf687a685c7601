/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_answer.h"

#include <math.h>
#include <strings.h>

#include "page/page.h"
#include "review/output/review_bar.h"
#include "review/output/review_facts.h"
#include "review/output/review_rays.h"
#include "review/output/review_rests.h"
#include "review/output/review_words.h"
#include "review/quantity.h"
#include "review/review_decide.h"
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
    if (!review_case_counts(worst)) return "nothing is required to be read; ";
    if (!review->pass) return worst->verdict == VERDICT_PASS ? "the worst is " : "";
    return worst->verdict == VERDICT_PASS ? "closest to its limit is "
                                          : "nothing fails; the worst is ";
}

static void add_line(Text *html, const Review *review, const ReviewCase *worst, Arena *arena)
{
    static const char *const CLASSES[4] = {
        [VERDICT_PASS] = " same", [VERDICT_FAIL] = "", [VERDICT_TOO_CLOSE] = " open",
        [VERDICT_UNJUDGED] = " unknown"};
    Verdict verdict = review_verdict(review);
    text_format(html, "<div class=\"verdict%s\"><h1><b>%s</b>: ", CLASSES[verdict],
                words_verdict(verdict));
    if (!worst) {
        text_add(html, "nothing is required, so nothing can fail.</h1></div>\n");
        return;
    }
    text_add(html, answer_words(review, worst));
    escape_markup(html, words_case(worst, arena));
    text_add(html, ": ");
    escape_markup(html, words_headline(worst, arena));
    text_add(html, ".</h1></div>\n");
}

static void add_rests(Text *html, const Review *review, Arena *arena)
{
    const char *words = review_rests_words(review, arena);
    if (!words[0]) return;
    text_add(html, "<p class=\"rests\"><b>Rests on</b> ");
    escape_markup(html, words);
    text_add(html, ".</p>\n");
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
    if (c->unjudged || !limit || isnan(limit->margin)) return condition;
    return arena_format(arena, "%s · %s", words_margin(limit->margin, arena), condition);
}

/* Of a case that another limit decides: its contrast, too; "": it is decided by that. */
static const char *contrast_words(const ReviewCase *c, Arena *arena)
{
    const LimitVerdict *limit = case_worst_limit(c);
    LimitKind           kind = limit ? limit_kind_named(limit->kind) : LIMIT_KIND_COUNT;
    bool is_contrast = !limit || (kind < LIMIT_KIND_COUNT && limit_kinds[kind].is_contrast);
    if (c->unjudged || is_contrast || isnan(c->contrast_ratio)) return "";
    bool has_limit = c->limit_id >= 0 && c->limit_id < c->limit_count;
    const LimitVerdict *of = has_limit ? &c->limits[c->limit_id] : NULL;
    return of ? arena_format(arena, "%s %s", words_kind(of), words_found(of, arena))
              : arena_format(arena, "contrast %s", words_contrast(c, arena));
}

static void add_cell(Text *html, const Review *review, const ReviewCase *c, Arena *arena)
{
    if (!c) {
        page_cell(html, "none", "–");
        return;
    }
    review_card_begin_cell(html, review, c, arena);
    page_element(html, "i", c->eye); /* where a telephone has no heads of columns */
    text_add(html, "<b>");
    escape_markup(html, arena_format(arena, "%s %s", words_mark(c->verdict),
                                     words_judged(c, arena)));
    text_add(html, "</b>");
    const char *contrast = contrast_words(c, arena);
    if (contrast[0]) page_element(html, "em", contrast);
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

static void add_grid(Text *html, const Review *review, Arena *arena)
{
    Grid        grid = make_grid(review, arena);
    PageColumn  columns[GRID_EYES + 1] = {{"at its worst", false, NULL}};
    int         eyes = grid.eyes.count < GRID_EYES ? grid.eyes.count : GRID_EYES;
    int         rows = grid.symbols.count < GRID_ROWS ? grid.symbols.count : GRID_ROWS;
    while (eyes > 1 && grid_width(&grid, rows, eyes) > GRID_WIDTH) eyes--;
    for (int i = 0; i < eyes; i++)
        columns[i + 1] = (PageColumn){grid.eyes.list[i], false, NULL};
    text_format(html, "<div class=\"grid%s%s\">",
                grid_width(&grid, rows, eyes) > GRID_WIDTH ? " breaks" : "",
                fits_phone(&grid, eyes) ? "" : " stacked");
    page_table_begin(html, "", "matrix", columns, eyes + 1);
    add_rows(html, review, &grid, rows, eyes, arena);
    page_table_end(html);
    if (eyes < grid.eyes.count)
        page_element(html, "p class=\"sub\"",
                     arena_format(arena, "The worst %d of %d symbols, as the worst %d of %d "
                                  "eyes see them; all stand below.", rows, grid.symbols.count,
                                  eyes, grid.eyes.count));
    else if (rows < grid.symbols.count)
        page_element(html, "p class=\"sub\"",
                     arena_format(arena, "The worst %d of %d symbols; all stand below.", rows,
                                  grid.symbols.count));
    page_element(html, "p class=\"sub\"", count_words(review, arena));
    text_add(html, "</div>\n");
}

/* ---- the worst case --------------------------------------------------------------------- */

static const ReviewPicture *frame_of(const ReviewAnswer *answer, const ReviewCase *c)
{
    for (int i = 0; i < answer->picture_count; i++) {
        const ReviewPicture *p = &answer->pictures[i];
        if (p->of == c && p->is_frame) return p;
    }
    return NULL;
}

/* The part of the frame about the symbol, larger; of a frame that stands elsewhere. */
static void add_close_up(Text *html, const ReviewPicture *frame)
{
    const CaseView *view = frame->of->view;
    double          box[4];
    if (!(frame->beside || frame->id) || !review_rays_close_up(frame->of, box)) return;
    text_format(html, "<svg class=\"close-up\" viewBox=\"%.1f %.1f %.1f %.1f\" role=\"img\" "
                "preserveAspectRatio=\"xMidYMid slice\" aria-label=\"close-up: ", box[0],
                box[1], box[2], box[3]);
    escape_markup(html, frame->of->symbol);
    if (frame->beside) {
        text_format(html, "\"><image width=\"%d\" height=\"%d\" href=\"", view->width,
                    view->height);
        escape_markup(html, frame->beside);
        text_add(html, "\"/>");
    } else {
        text_format(html, "\"><use href=\"#%s\"/>", frame->id);
    }
    review_rays_add_line(html, frame->of);
    text_add(html, "</svg>");
}

/* The case's card has it, too: there it stands. */
static bool add_frame(Text *html, const ReviewPicture *frame, Arena scratch, Error *err)
{
    ReviewPicture shown = *frame;
    shown.is_again = shown.id != NULL;
    text_add(html, "<div class=\"views\"><div class=\"shown\">");
    if (!review_card_add_picture(html, &shown, scratch, err)) return false;
    review_rays_add_rim(html, shown.of);
    text_add(html, "</div>");
    add_close_up(html, &shown);
    text_add(html, "</div>\n");
    return true;
}

static void add_facts(Text *html, const ReviewAnswer *answer, const ReviewCase *c, Arena *arena)
{
    ReviewFacts facts = review_facts_of(
        answer->review, c, review_answer_directions(answer, c, arena), arena);
    text_add(html, "<dl class=\"facts\">\n");
    for (int i = 0; i < facts.count; i++)
        page_fact(html, facts.list[i].name, facts.list[i].value);
    text_add(html, "</dl>\n");
}

static bool add_worst(Text *html, const ReviewAnswer *answer, const ReviewCase *c, Arena *arena,
                      Error *err)
{
    const ReviewPicture *frame = frame_of(answer, c);
    text_add(html, "<section class=\"worst\" aria-label=\"The worst case\">\n");
    if (frame && !add_frame(html, frame, *arena, err)) return false;
    if (!frame && c->verdict != VERDICT_UNJUDGED) review_bar_add_luminances(html, c, arena);
    add_facts(html, answer, c, arena);
    text_add(html, "</section>\n");
    return true;
}

bool review_answer_add(Text *html, const ReviewAnswer *answer, Arena *arena, Error *err)
{
    const ReviewCase *worst = review_worst(answer->review, *arena);
    add_line(html, answer->review, worst, arena);
    add_rests(html, answer->review, arena);
    if (!worst) return true;
    text_add(html, "<div class=\"first\">\n");
    add_grid(html, answer->review, arena);
    if (!add_worst(html, answer, worst, arena, err)) return false;
    text_add(html, "</div>\n");
    return true;
}
