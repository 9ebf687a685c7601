/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_table.h"

#include <math.h>
#include <string.h>

#include "page/page.h"
#include "review/output/review_bar.h"
#include "review/output/review_card.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "text/text.h"

#define MATRIX_COLUMNS 10
#define MATRIX_ROWS 60

/* <a href="#c3">text</a> */
static void add_link(Text *html, const Review *review, const ReviewCase *c, const char *text,
                     Arena *arena)
{
    text_format(html, "<a href=\"%s\">", review_card_link(review, c, arena));
    escape_markup(html, text);
    text_add(html, "</a>");
}

/* ---- the matrix ------------------------------------------------------------------------- */

/* Names from left to right and down, and the cell where two meet. */
typedef struct Matrix {
    const Review *review;
    const char   *title, *corner;
    const char   *of; /* what all cells have in common: the eye, or the sweep's condition */
    WordList      across, down;
    bool          turned;
    void        (*add_cell)(Text *html, const struct Matrix *m, const char *across,
                            const char *down, Arena *arena);
} Matrix;

/* Nothing where there are too many. */
static void add_matrix(Text *html, const Matrix *m, Arena *arena)
{
    PageColumn columns[MATRIX_COLUMNS + 1] = {{m->corner, false, NULL}};
    if (m->across.count > MATRIX_COLUMNS || m->down.count > MATRIX_ROWS) return;
    for (int i = 0; i < m->across.count; i++)
        columns[i + 1] = (PageColumn){m->across.list[i], false, NULL};
    text_add(html, "<div>");
    page_table_begin(html, m->title, "matrix", columns, m->across.count + 1);
    for (int row = 0; row < m->down.count; row++) {
        page_row_begin(html, "");
        page_cell(html, "", m->down.list[row]);
        for (int i = 0; i < m->across.count; i++)
            m->add_cell(html, m, m->across.list[i], m->down.list[row], arena);
        page_row_end(html);
    }
    page_table_end(html);
    text_add(html, "</div>\n");
}

static void add_cell_limit(Text *html, const LimitVerdict *limit, Arena *arena)
{
    review_bar_add_margin(html, limit);
    page_element(html, "small", arena_format(arena, "%s · %s %s",
                                             words_interval(limit->low, limit->high, arena),
                                             limit->is_upper ? "≤" : "≥",
                                             words_limit(limit, arena)));
}

static void add_case_cell(Text *html, const Matrix *m, const char *across, const char *down,
                          Arena *arena)
{
    const ReviewCase *c = review_case_named(m->review, m->turned ? down : across, m->of,
                                            m->turned ? across : down);
    if (!c) {
        page_cell(html, "none", "–");
        return;
    }
    const LimitVerdict *limit = c->verdict == VERDICT_UNJUDGED ? NULL : case_worst_limit(c);
    review_card_begin_cell(html, m->review, c, arena);
    text_format(html, "<div><b>%s %s</b>", words_mark(c->verdict), words_judged(c, arena));
    if (limit) text_format(html, "<em>%s</em>", words_margin(limit->margin, arena));
    text_add(html, "</div>");
    if (limit) add_cell_limit(html, limit, arena);
    text_add(html, "</a></td>");
}

/* Conditions from left to right, unless there are more of them than symbols. */
static Matrix matrix_of_eye(const Review *review, const char *eye, Arena *arena)
{
    WordList symbols = words_list(review->case_count, arena);
    WordList conditions = words_list(review->case_count, arena);
    for (int i = 0; i < review->case_count; i++) {
        if (!words_same(review->cases[i].eye, eye)) continue;
        words_list_add(&symbols, review->cases[i].symbol);
        words_list_add(&conditions, review->cases[i].condition);
    }
    bool turned = conditions.count > symbols.count;
    return (Matrix){review, arena_format(arena, "Seen by %s", eye),
                    turned ? "condition" : "symbol", eye, turned ? symbols : conditions,
                    turned ? conditions : symbols, turned, add_case_cell};
}

void review_table_add_matrix(Text *html, const Review *review, Arena *arena)
{
    WordList eyes = words_list(review->case_count, arena);
    for (int i = 0; i < review->case_count; i++) words_list_add(&eyes, review->cases[i].eye);
    text_add(html, "<div class=\"eyes\">\n");
    for (int i = 0; i < eyes.count; i++) {
        Matrix matrix = matrix_of_eye(review, eyes.list[i], arena);
        add_matrix(html, &matrix, arena);
    }
    text_add(html, "</div>\n");
}

/* ---- sweeps at a glance ----------------------------------------------------------------- */

/* Of what the share is that stands above it; "": there is none. */
static const char *share_words(const ReviewSweep *s, Arena *arena)
{
    bool fails = sweep_verdict(s) == VERDICT_FAIL, is_share = fails && s->failed_share > 0;
    if (fails && sweep_has_box(s))
        return arena_format(arena, "%s · worst eye ", words_middle(s, arena));
    return is_share ? arena_format(arena, "%s · worst ", words_of_what(s)) : "";
}

static void add_sweep_cell(Text *html, const Matrix *m, const char *across, const char *down,
                           Arena *arena)
{
    const ReviewSweep *s = review_sweep_named(m->review, m->of, across, down);
    if (!s) {
        page_cell(html, "none", "–");
        return;
    }
    Verdict             verdict = sweep_verdict(s);
    const LimitVerdict *limit = case_worst_limit(&s->worst);
    text_format(html, "<td class=\"%s\"><a href=\"%s\"><b>%s %s</b>", words_class(verdict),
                review_card_link(m->review, &s->worst, arena), words_mark(verdict),
                words_often(s, arena));
    const char *required = !limit ? "" : arena_format(arena, " · %s %s",
                                                      limit->is_upper ? "≤" : "≥",
                                                      words_limit(limit, arena));
    page_element(html, "small", arena_format(arena, "%s%s%s", share_words(s, arena),
                                             words_judged(&s->worst, arena), required));
    text_add(html, "</a></td>");
}

static Matrix matrix_of_sweeps(const Review *review, const char *condition, Arena *arena)
{
    Matrix out = {review, condition, "symbol", condition,
                  words_list(review->sweep_count, arena),
                  words_list(review->sweep_count, arena), false, add_sweep_cell};
    for (int i = 0; i < review->sweep_count; i++) {
        if (!words_same(review->sweeps[i].condition, condition)) continue;
        words_list_add(&out.across, review->sweeps[i].eye);
        words_list_add(&out.down, review->sweeps[i].symbol);
    }
    return out;
}

void review_table_add_sweeps(Text *html, const Review *review, Arena *arena)
{
    WordList conditions = words_list(review->sweep_count, arena);
    for (int i = 0; i < review->sweep_count; i++)
        words_list_add(&conditions, review->sweeps[i].condition);
    text_add(html, "<div class=\"eyes\">\n");
    for (int i = 0; i < conditions.count; i++) {
        Matrix matrix = matrix_of_sweeps(review, conditions.list[i], arena);
        add_matrix(html, &matrix, arena);
    }
    text_add(html, "</div>\n");
}

/* ---- the list --------------------------------------------------------------------------- */

static void add_limit_cells(Text *html, const LimitVerdict *l, Arena *arena)
{
    if (!l) {
        page_cell(html, "n", "–");
        page_cell(html, "n", "–");
        page_cell(html, "", "");
        return;
    }
    page_cell(html, "n", words_required(l, arena));
    page_cell(html, arena_format(arena, "n %s", words_class(l->verdict)),
              words_margin(l->margin, arena));
    text_add(html, "<td>");
    review_bar_add_margin(html, l);
    text_add(html, "</td>");
}

static void add_list_row(Text *html, const Review *review, const ReviewCase *c, Arena *arena)
{
    bool is_worst = review_sweep_of(review, c) != NULL;
    page_row_begin(html, "");
    text_add(html, "<td>");
    review_card_add_chip(html, c->verdict);
    text_add(html, "</td><td>");
    add_link(html, review, c, c->symbol && c->symbol[0] ? c->symbol : "?", arena);
    if (c->verdict == VERDICT_UNJUDGED)
        page_element(html, "small", words_unjudged(c, arena));
    text_add(html, "</td>");
    page_cell(html, "", is_worst ? arena_format(arena, "%s (worst)",
                                                c->condition ? c->condition : "?")
                                 : c->condition);
    page_cell(html, "", c->eye);
    const LimitVerdict *l = c->unjudged ? NULL : case_worst_limit(c);
    page_cell(html, "n", words_judged(c, arena));
    page_cell(html, "n", l ? words_interval(l->low, l->high, arena) : "–");
    add_limit_cells(html, l, arena);
    page_row_end(html);
}

void review_table_add_list(Text *html, const Review *review, int most, Arena *arena)
{
    static const PageColumn COLUMNS[] = {
        {"Verdict", false, NULL}, {"Symbol", false, NULL}, {"Condition", false, NULL},
        {"Eye", false, NULL},
        {"Figure", true, "what decides the verdict, in the quantity of its limit"},
        {"95 % interval", true, "holds what endless samples would give, with 95 % certainty"},
        {"Required", true, "the limit of the profile"},
        {"Margin", true, "how far above or below the limit; −100 % is full wash-out"},
        {"−100 % ← limit → +100 %", false, NULL}};
    const ReviewCase **ranked = review_rank(review, arena);
    int all = review_case_count(review);
    int listed = most && most < all ? most : all;
    page_table_begin(html, "", "list", COLUMNS, 9);
    for (int i = 0; i < listed; i++) add_list_row(html, review, ranked[i], arena);
    page_table_end(html);
    if (listed < all)
        page_element(html, "p class=\"sub\"",
                     arena_format(arena, "The worst %d of %d.", listed, all));
}

/* ---- limits ----------------------------------------------------------------------------- */

/* Some limits depend on the height of the characters: one row, from low to high. */
typedef struct LimitRow {
    const LimitVerdict *limit;
    double              low, high;
} LimitRow;

typedef struct LimitRows {
    LimitRow *list;
    int       count, capacity;
} LimitRows;

static bool is_same_limit(const LimitVerdict *a, const LimitVerdict *b)
{
    return words_same(a->name, b->name) && words_same(a->kind, b->kind) &&
           words_same(a->unit, b->unit) && words_same(a->source, b->source);
}

static LimitRow *row_of(LimitRows *rows, const LimitVerdict *limit, Arena *arena)
{
    for (int i = 0; i < rows->count; i++)
        if (is_same_limit(rows->list[i].limit, limit)) return &rows->list[i];
    if (rows->count == rows->capacity) {
        rows->capacity = 2 * rows->count + 16;
        rows->list = ARENA_GROW(arena, LimitRow, rows->list, rows->count, rows->capacity);
    }
    rows->list[rows->count] = (LimitRow){limit, limit->value, limit->value};
    return &rows->list[rows->count++];
}

static void gather_limits(LimitRows *rows, const ReviewCase *c, Arena *arena)
{
    for (int i = 0; i < c->limit_count; i++) {
        LimitRow *row = row_of(rows, &c->limits[i], arena);
        row->low = fmin(row->low, c->limits[i].value);
        row->high = fmax(row->high, c->limits[i].value);
    }
}

static void add_limit_row(Text *html, const LimitRow *row, Arena *arena)
{
    LimitVerdict low = *row->limit;
    low.value = row->low;
    const char *wanted = words_required(&low, arena);
    if (row->high > row->low)
        wanted = arena_format(arena, "%s … %s, by height", wanted,
                              words_number(row->high, arena));
    page_row_begin(html, "");
    page_cell(html, "", row->limit->name);
    page_cell(html, "n", wanted);
    page_cell(html, row->limit->read_in_the_standard ? "" : "unread",
              row->limit->read_in_the_standard ? "yes" : "not read in the standard");
    page_cell(html, "", row->limit->source);
    page_row_end(html);
}

void review_table_add_limits(Text *html, const Review *review, Arena *arena)
{
    static const PageColumn COLUMNS[] = {{"Limit", false, NULL}, {"Required", true, NULL},
                                         {"Read in the standard", false, NULL},
                                         {"Where the value comes from", false, NULL}};
    LimitRows rows = {NULL, 0, 0};
    for (int i = 0; i < review_case_count(review); i++)
        gather_limits(&rows, review_case_at(review, i), arena);
    if (rows.count == 0) {
        page_element(html, "p", "No limit applies: nothing can fail.");
        return;
    }
    page_table_begin(html, "", "", COLUMNS, 4);
    for (int i = 0; i < rows.count; i++) add_limit_row(html, &rows.list[i], arena);
    page_table_end(html);
}

/* ---- what changed ----------------------------------------------------------------------- */

/* Its kind, and the names of what is compared: symbol or gaze, condition, eye. */
static void begin_diff_row(Text *html, DiffKind kind, bool is_sweep, const char *const names[3])
{
    static const char *const CLASSES[7] = {"chip bad", "chip good", "bad", "good",
                                           "sub",      "sub",       "sub"};
    static const char *const WORDS[7] = {"worse verdict", "better verdict", "less contrast",
                                         "more contrast", "only before",    "only now",
                                         "same"};
    const char *words = WORDS[kind];
    if (is_sweep && kind == DIFF_WORSE) words = "fails more often";
    if (is_sweep && kind == DIFF_BETTER) words = "fails less often";
    page_row_begin(html, "");
    text_format(html, "<td><span class=\"%s\">%s</span></td>", CLASSES[kind], words);
    for (int i = 0; i < 3; i++) page_cell(html, "", names[i]);
}

/* "a → b" */
static void add_change(Text *html, const char *before, const char *after, Arena *arena)
{
    page_cell(html, "n", strcmp(before, after) != 0
                             ? arena_format(arena, "%s → %s", before, after) : after);
}

static const char *verdict_of(const ReviewCase *c)
{
    return c ? verdict_names[c->verdict] : "–";
}

static const char *figure_of(const ReviewCase *c, Arena *arena)
{
    return c ? words_judged(c, arena) : "–";
}

static const char *margin_of(const ReviewCase *c, Arena *arena)
{
    const LimitVerdict *limit = c ? case_worst_limit(c) : NULL;
    return limit ? words_margin(limit->margin, arena) : "–";
}

static void add_diff_row(Text *html, const CaseDiff *d, Arena *arena)
{
    const ReviewCase *either = d->after ? d->after : d->before;
    begin_diff_row(html, d->kind, false,
                   (const char *const[3]){either->symbol, either->condition, either->eye});
    add_change(html, verdict_of(d->before), verdict_of(d->after), arena);
    add_change(html, figure_of(d->before, arena), figure_of(d->after, arena), arena);
    add_change(html, margin_of(d->before, arena), margin_of(d->after, arena), arena);
    page_row_end(html);
}

static void add_diff_cases(Text *html, const ReviewDiff *diff, Arena *arena)
{
    static const PageColumn COLUMNS[] = {
        {"Change", false, NULL}, {"Symbol", false, NULL}, {"Condition", false, NULL},
        {"Eye", false, NULL},    {"Verdict", true, NULL}, {"Figure", true, NULL},
        {"Margin", true, NULL}};
    bool has_rows = diff->case_count > 0 && diff->cases[0].kind != DIFF_SAME;
    if (!has_rows) return;
    page_table_begin(html, "", "diff", COLUMNS, 7);
    for (int i = 0; i < diff->case_count; i++)
        if (diff->cases[i].kind != DIFF_SAME) add_diff_row(html, &diff->cases[i], arena);
    page_table_end(html);
}

static void add_diff_sweeps(Text *html, const ReviewDiff *diff, Arena *arena)
{
    static const PageColumn COLUMNS[] = {
        {"Change", false, NULL}, {"Symbol", false, NULL}, {"Sweep", false, NULL},
        {"Eye", false, NULL},    {"Time failed", true, NULL}, {"Longest", true, NULL}};
    if (diff->sweep_count == 0) return;
    page_table_begin(html, "", "diff", COLUMNS, 6);
    for (int i = 0; i < diff->sweep_count; i++) {
        const SweepDiff   *d = &diff->sweeps[i];
        const ReviewSweep *b = d->before, *a = d->after, *either = a ? a : b;
        begin_diff_row(html, d->kind, true,
                       (const char *const[3]){either->symbol, either->condition, either->eye});
        add_change(html, words_share(b ? b->failed_share : NAN, arena),
                   words_share(a ? a->failed_share : NAN, arena), arena);
        add_change(html, words_minutes(b ? b->longest_failure_minutes : NAN, arena),
                   words_minutes(a ? a->longest_failure_minutes : NAN, arena), arena);
        page_row_end(html);
    }
    page_table_end(html);
}

static const char *figure_change(double before, double after, Arena *arena)
{
    return arena_format(arena, "%s → %s", words_figure(before, arena),
                        words_figure(after, arena));
}

static void add_gaze_row(Text *html, const GazeDiff *d, Arena *arena)
{
    const GazeFinding *either = d->after ? d->after : d->before;
    const GazeFinding *b = d->before ? d->before : &diff_no_gaze;
    const GazeFinding *a = d->after ? d->after : &diff_no_gaze;
    begin_diff_row(html, d->kind, false,
                   (const char *const[3]){either->gaze, either->condition, either->eye});
    add_change(html, words_share(b->contrast_left, arena), words_share(a->contrast_left, arena),
               arena);
    page_cell(html, "n", figure_change(b->mirrored, a->mirrored, arena));
    page_cell(html, "n", figure_change(b->veil, a->veil, arena));
    page_row_end(html);
}

static void add_diff_gazes(Text *html, const ReviewDiff *diff, Arena *arena)
{
    static const PageColumn COLUMNS[] = {
        {"Change", false, NULL}, {"Looking at", false, NULL}, {"Condition", false, NULL},
        {"Eye", false, NULL},    {"Contrast left", true, NULL},
        {"Mirrored by glass, cd/m²", true, NULL}, {"Veil in the eye, cd/m²", true, NULL}};
    int changed = 0;
    for (int i = 0; i < diff->gaze_count; i++) changed += diff->gazes[i].kind != DIFF_SAME;
    if (!changed) return;
    page_table_begin(html, "", "diff", COLUMNS, 7);
    for (int i = 0; i < diff->gaze_count; i++)
        if (diff->gazes[i].kind != DIFF_SAME) add_gaze_row(html, &diff->gazes[i], arena);
    page_table_end(html);
}

void review_table_add_diff(Text *html, const ReviewDiff *diff, Arena *arena)
{
    text_add(html, "<p>");
    escape_markup(html, arena_format(arena, "Before: %s. Now: %s.", diff->before_name,
                                     diff->after_name));
    escape_markup(html, arena_format(
        arena, " %d became better by verdict, %d worse; contrast alone moved up in %d and down "
        "in %d; %d are the same within their intervals.", diff->count[DIFF_MENDED],
        diff->count[DIFF_BROKEN], diff->count[DIFF_BETTER], diff->count[DIFF_WORSE],
        diff->count[DIFF_SAME]));
    text_add(html, "</p>\n");
    add_diff_cases(html, diff, arena);
    add_diff_sweeps(html, diff, arena);
    add_diff_gazes(html, diff, arena);
}
