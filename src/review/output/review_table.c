/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "page/page.h"
#include "review/output/review_bar.h"
#include "review/output/review_card.h"
#include "review/output/review_decide.h"
#include "review/output/review_words.h"
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

typedef struct MatrixNames {
    const char **list;
    int          count;
} MatrixNames;

static void add_name(MatrixNames *names, const char *name)
{
    for (int i = 0; i < names->count; i++)
        if (words_same(names->list[i], name)) return;
    names->list[names->count++] = name ? name : "";
}

typedef struct Matrix {
    const Review *review;
    const char   *eye;
    MatrixNames         symbols, conditions;
} Matrix;

static Matrix make_matrix(const Review *review, const char *eye, Arena *arena)
{
    Matrix out = {review, eye, {NULL, 0}, {NULL, 0}};
    out.symbols.list = ARENA_NEW(arena, const char *, review->case_count);
    out.conditions.list = ARENA_NEW(arena, const char *, review->case_count);
    for (int i = 0; i < review->case_count; i++) {
        if (!words_same(review->cases[i].eye, eye)) continue;
        add_name(&out.symbols, review->cases[i].symbol);
        add_name(&out.conditions, review->cases[i].condition);
    }
    return out;
}

static const ReviewCase *case_of(const Matrix *m, const char *symbol, const char *condition)
{
    for (int i = 0; i < m->review->case_count; i++) {
        const ReviewCase *c = &m->review->cases[i];
        if (words_same(c->eye, m->eye) && words_same(c->symbol, symbol) &&
            words_same(c->condition, condition))
            return c;
    }
    return NULL;
}

/* The limit that a case is shown with: that of the contrast, else the worst. */
static const LimitVerdict *shown_limit(const ReviewCase *c)
{
    bool has_contrast = c->limit_id >= 0 && c->limit_id < c->limit_count;
    return has_contrast ? &c->limits[c->limit_id] : case_worst_limit(c);
}

static void add_cell_limit(Text *html, const LimitVerdict *limit, Arena *arena)
{
    review_bar_add_margin(html, limit);
    page_element(html, "small", arena_format(arena, "%s · %s %s",
                                             words_interval(limit->low, limit->high, arena),
                                             limit->is_upper ? "≤" : "≥",
                                             words_limit(limit, arena)));
}

static void add_matrix_cell(Text *html, const Matrix *m, const ReviewCase *c, Arena *arena)
{
    if (!c) {
        page_cell(html, "none", "–");
        return;
    }
    const LimitVerdict *limit = c->verdict == VERDICT_NOT_VISIBLE ? NULL : shown_limit(c);
    text_format(html, "<td class=\"%s\"><a href=\"%s\" title=\"", words_class(c->verdict),
                review_card_link(m->review, c, arena));
    escape_markup(html, arena_format(arena, "%s: %s", words_verdict(c->verdict),
                                     words_reason(c, arena)));
    text_format(html, "\"><div><b>%s %s</b>", words_mark(c->verdict),
                c->verdict == VERDICT_NOT_VISIBLE ? "not visible"
                                                  : words_contrast(c, arena));
    if (limit) text_format(html, "<em>%s</em>", words_margin(limit->margin, arena));
    text_add(html, "</div>");
    if (limit) add_cell_limit(html, limit, arena);
    text_add(html, "</a></td>");
}

/* Conditions from left to right, unless there are more of them than symbols. */
static void add_matrix(Text *html, const Matrix *m, Arena *arena)
{
    bool  turned = m->conditions.count > m->symbols.count;
    MatrixNames across = turned ? m->symbols : m->conditions;
    MatrixNames down = turned ? m->conditions : m->symbols;
    if (across.count > MATRIX_COLUMNS || down.count > MATRIX_ROWS) return;
    PageColumn columns[MATRIX_COLUMNS + 1] = {{turned ? "condition" : "symbol", false, NULL}};
    for (int i = 0; i < across.count; i++)
        columns[i + 1] = (PageColumn){across.list[i], false, NULL};
    text_add(html, "<div>");
    page_table_begin(html, arena_format(arena, "Seen by %s", m->eye), "matrix", columns,
                     across.count + 1);
    for (int row = 0; row < down.count; row++) {
        page_row_begin(html, "");
        page_cell(html, "", down.list[row]);
        for (int i = 0; i < across.count; i++) {
            const char *symbol = turned ? across.list[i] : down.list[row];
            const char *condition = turned ? down.list[row] : across.list[i];
            add_matrix_cell(html, m, case_of(m, symbol, condition), arena);
        }
        page_row_end(html);
    }
    page_table_end(html);
    text_add(html, "</div>\n");
}

void review_table_add_matrix(Text *html, const Review *review, Arena *arena)
{
    MatrixNames eyes = {ARENA_NEW(arena, const char *, review->case_count), 0};
    for (int i = 0; i < review->case_count; i++) add_name(&eyes, review->cases[i].eye);
    text_add(html, "<div class=\"eyes\">\n");
    for (int i = 0; i < eyes.count; i++) {
        Matrix matrix = make_matrix(review, eyes.list[i], arena);
        add_matrix(html, &matrix, arena);
    }
    text_add(html, "</div>\n");
}

/* ---- sweeps at a glance ----------------------------------------------------------------- */

static const ReviewSweep *sweep_of(const Review *review, const char *condition,
                                   const char *symbol, const char *eye)
{
    for (int i = 0; i < review->sweep_count; i++) {
        const ReviewSweep *s = &review->sweeps[i];
        if (words_same(s->condition, condition) && words_same(s->symbol, symbol) &&
            words_same(s->eye, eye))
            return s;
    }
    return NULL;
}

static void add_sweep_cell(Text *html, const Review *review, const ReviewSweep *s,
                           Arena *arena)
{
    if (!s) {
        page_cell(html, "none", "–");
        return;
    }
    Verdict             verdict = sweep_verdict(s);
    const LimitVerdict *limit = shown_limit(&s->worst);
    text_format(html, "<td class=\"%s\"><a href=\"%s\"><b>%s %s</b>", words_class(verdict),
                review_card_link(review, &s->worst, arena), words_mark(verdict),
                words_often(s, arena));
    page_element(html, "small",
                 arena_format(arena, "%s%s%s", words_contrast(&s->worst, arena),
                              limit ? limit->is_upper ? " · ≤ " : " · ≥ " : "",
                              limit ? words_limit(limit, arena) : ""));
    text_add(html, "</a></td>");
}

static void add_sweep_matrix(Text *html, const Review *review, const char *condition,
                             Arena *arena)
{
    MatrixNames symbols = {ARENA_NEW(arena, const char *, review->sweep_count), 0};
    MatrixNames eyes = {ARENA_NEW(arena, const char *, review->sweep_count), 0};
    for (int i = 0; i < review->sweep_count; i++) {
        if (!words_same(review->sweeps[i].condition, condition)) continue;
        add_name(&symbols, review->sweeps[i].symbol);
        add_name(&eyes, review->sweeps[i].eye);
    }
    if (eyes.count > MATRIX_COLUMNS || symbols.count > MATRIX_ROWS) return;
    PageColumn columns[MATRIX_COLUMNS + 1] = {{"symbol", false, NULL}};
    for (int i = 0; i < eyes.count; i++)
        columns[i + 1] = (PageColumn){eyes.list[i], false, NULL};
    text_add(html, "<div>");
    page_table_begin(html, condition, "matrix", columns, eyes.count + 1);
    for (int row = 0; row < symbols.count; row++) {
        page_row_begin(html, "");
        page_cell(html, "", symbols.list[row]);
        for (int i = 0; i < eyes.count; i++)
            add_sweep_cell(html, review,
                           sweep_of(review, condition, symbols.list[row], eyes.list[i]),
                           arena);
        page_row_end(html);
    }
    page_table_end(html);
    text_add(html, "</div>\n");
}

void review_table_add_sweeps(Text *html, const Review *review, Arena *arena)
{
    MatrixNames conditions = {ARENA_NEW(arena, const char *, review->sweep_count), 0};
    for (int i = 0; i < review->sweep_count; i++)
        add_name(&conditions, review->sweeps[i].condition);
    text_add(html, "<div class=\"eyes\">\n");
    for (int i = 0; i < conditions.count; i++)
        add_sweep_matrix(html, review, conditions.list[i], arena);
    text_add(html, "</div>\n");
}

/* ---- the list --------------------------------------------------------------------------- */

static void add_limit_cells(Text *html, const ReviewCase *c, Arena *arena)
{
    const LimitVerdict *l = shown_limit(c);
    if (!l) {
        page_cell(html, "n", "–");
        page_cell(html, "n", "–");
        page_cell(html, "", "");
        return;
    }
    page_cell(html, "n", words_wanted(l, arena));
    page_cell(html, arena_format(arena, "n %s", words_class(l->verdict)),
              words_margin(l->margin, arena));
    text_add(html, "<td>");
    review_bar_add_margin(html, l);
    text_add(html, "</td>");
}

static void add_list_row(Text *html, const Review *review, const ReviewCase *c, Arena *arena)
{
    const char *id = review_card_id(review, c, arena);
    bool        is_worst = id[0] == 's'; /* a sweep's */
    Verdict     verdict = is_worst ? sweep_verdict(&review->sweeps[atoi(id + 1)]) : c->verdict;
    page_row_begin(html, "");
    text_format(html, "<td><span class=\"chip %s\">%s</span></td><td>", words_class(verdict),
                words_verdict(verdict));
    add_link(html, review, c, c->symbol && c->symbol[0] ? c->symbol : "?", arena);
    if (c->verdict == VERDICT_NOT_VISIBLE && c->hider_count)
        page_element(html, "small", words_hiders(c, arena));
    text_add(html, "</td>");
    page_cell(html, "", is_worst ? arena_format(arena, "%s (worst)",
                                                c->condition ? c->condition : "?")
                                 : c->condition);
    page_cell(html, "", c->eye);
    page_cell(html, "n", words_contrast(c, arena));
    page_cell(html, "n", words_interval(c->contrast_low, c->contrast_high, arena));
    add_limit_cells(html, c, arena);
    page_row_end(html);
}

void review_table_add_list(Text *html, const Review *review, int most, Arena *arena)
{
    static const PageColumn COLUMNS[] = {
        {"Verdict", false, NULL}, {"Symbol", false, NULL}, {"Condition", false, NULL},
        {"Eye", false, NULL},
        {"Contrast", true, "how many times brighter the bright part is than the dark part, "
                           "reflections included"},
        {"95 % interval", true, "holds what endless samples would give, with 95 % certainty"},
        {"Wanted", true, "the limit of the profile"},
        {"Margin", true, "how far above or below the limit"},
        {"half ← limit → twice", false, NULL}};
    const ReviewCase **ranked = review_rank(review, arena);
    int all = review->case_count + review->sweep_count;
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
    const char *wanted = words_wanted(&low, arena);
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
    static const PageColumn COLUMNS[] = {{"Limit", false, NULL}, {"Wanted", true, NULL},
                                         {"Read in the standard", false, NULL},
                                         {"Where the value comes from", false, NULL}};
    LimitRows rows = {NULL, 0, 0};
    for (int i = 0; i < review->case_count; i++)
        gather_limits(&rows, &review->cases[i], arena);
    for (int i = 0; i < review->sweep_count; i++)
        gather_limits(&rows, &review->sweeps[i].worst, arena);
    if (rows.count == 0) {
        page_element(html, "p", "No limit was asked: nothing could fail.");
        return;
    }
    page_table_begin(html, "", "", COLUMNS, 4);
    for (int i = 0; i < rows.count; i++) add_limit_row(html, &rows.list[i], arena);
    page_table_end(html);
}

/* ---- what changed ----------------------------------------------------------------------- */

static const char *diff_words(DiffKind kind)
{
    static const char *const WORDS[7] = {"worse verdict", "better verdict", "less contrast",
                                         "more contrast", "only before",    "only now",
                                         "same"};
    return WORDS[kind];
}

static const char *diff_class(DiffKind kind)
{
    static const char *const CLASSES[7] = {"chip bad", "chip good", "bad", "good",
                                           "sub",      "sub",       "sub"};
    return CLASSES[kind];
}

static void add_kind(Text *html, DiffKind kind, bool is_sweep)
{
    const char *words = diff_words(kind);
    if (is_sweep && kind == DIFF_WORSE) words = "fails more often";
    if (is_sweep && kind == DIFF_BETTER) words = "fails less often";
    text_format(html, "<td><span class=\"%s\">%s</span></td>", diff_class(kind), words);
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

static const char *ratio_of(const ReviewCase *c, Arena *arena)
{
    return c ? words_contrast(c, arena) : "–";
}

static void add_diff_row(Text *html, const CaseDiff *d, Arena *arena)
{
    const ReviewCase *either = d->after ? d->after : d->before;
    page_row_begin(html, "");
    add_kind(html, d->kind, false);
    page_cell(html, "", either->symbol);
    page_cell(html, "", either->condition);
    page_cell(html, "", either->eye);
    add_change(html, verdict_of(d->before), verdict_of(d->after), arena);
    add_change(html, ratio_of(d->before, arena), ratio_of(d->after, arena), arena);
    add_change(html, d->before ? words_margin(d->before->margin, arena) : "–",
               d->after ? words_margin(d->after->margin, arena) : "–", arena);
    page_row_end(html);
}

static void add_diff_cases(Text *html, const ReviewDiff *diff, Arena *arena)
{
    static const PageColumn COLUMNS[] = {
        {"Change", false, NULL}, {"Symbol", false, NULL}, {"Condition", false, NULL},
        {"Eye", false, NULL},    {"Verdict", true, NULL}, {"Contrast", true, NULL},
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
        page_row_begin(html, "");
        add_kind(html, d->kind, true);
        page_cell(html, "", either->symbol);
        page_cell(html, "", either->condition);
        page_cell(html, "", either->eye);
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
    static const GazeFinding NONE = {.contrast_left = NAN, .mirrored = NAN, .veil = NAN};
    const GazeFinding *either = d->after ? d->after : d->before;
    const GazeFinding *b = d->before ? d->before : &NONE, *a = d->after ? d->after : &NONE;
    page_row_begin(html, "");
    add_kind(html, d->kind, false);
    page_cell(html, "", either->gaze);
    page_cell(html, "", either->condition);
    page_cell(html, "", either->eye);
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
