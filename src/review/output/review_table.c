/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_table.h"

#include <math.h>
#include <string.h>

#include "page/page.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "text/json_text.h"
#include "text/text.h"

#define MATRIX_COLUMNS 10
#define MATRIX_ROWS 60

/* ---- matrices ---------------------------------------------------------------------------- */

/* Names from left to right and down, and the cell where two meet. */
typedef struct Matrix {
    const char *of; /* what all cells have in common: the eye, or the sweep's condition */
    WordList    across, down;
    bool        is_turned;
    void      (*add_cell)(const PageValues *v, json_t *cells, const struct Matrix *m,
                          const char *across, const char *down);
} Matrix;

/* Nothing where there are too many. */
static void add_matrix(const PageValues *v, json_t *list, const Matrix *m)
{
    if (m->across.count > MATRIX_COLUMNS || m->down.count > MATRIX_ROWS) return;
    json_t *to = page_add(list), *rows = values_list(to, "rows");
    page_set(to, "of", m->of);
    page_set_flag(to, "turned", m->is_turned);
    json_object_set_new(to, "across", json_texts(m->across.list, m->across.count));
    for (int i = 0; i < m->down.count; i++) {
        json_t *row = page_add(rows), *cells = values_list(row, "cells");
        page_set(row, "name", m->down.list[i]);
        for (int k = 0; k < m->across.count; k++)
            m->add_cell(v, cells, m, m->across.list[k], m->down.list[i]);
    }
}

static void add_case_cell(const PageValues *v, json_t *cells, const Matrix *m,
                          const char *across, const char *down)
{
    values_add_case(v, cells, review_case_named(v->review, m->is_turned ? down : across, m->of,
                                                m->is_turned ? across : down));
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
    bool is_turned = conditions.count > symbols.count;
    return (Matrix){eye, is_turned ? symbols : conditions, is_turned ? conditions : symbols,
                    is_turned, add_case_cell};
}

static void add_sweep_cell(const PageValues *v, json_t *cells, const Matrix *m,
                           const char *across, const char *down)
{
    const ReviewSweep *s = review_sweep_named(v->review, m->of, across, down);
    json_t            *sweeps = json_object_get(v->doc, "sweeps");
    if (s) json_array_append(cells, json_array_get(sweeps, (size_t)(s - v->review->sweeps)));
    else page_set(page_add(cells), "often", NULL);
}

static Matrix matrix_of_sweeps(const Review *review, const char *condition, Arena *arena)
{
    Matrix out = {condition, words_list(review->sweep_count, arena),
                  words_list(review->sweep_count, arena), false, add_sweep_cell};
    for (int i = 0; i < review->sweep_count; i++) {
        if (!words_same(review->sweeps[i].condition, condition)) continue;
        words_list_add(&out.across, review->sweeps[i].eye);
        words_list_add(&out.down, review->sweeps[i].symbol);
    }
    return out;
}

void values_add_matrices(const PageValues *v)
{
    const Review *review = v->review;
    WordList      eyes = words_list(review->case_count, v->arena);
    WordList      conditions = words_list(review->sweep_count, v->arena);
    json_t       *of_eyes = values_list(v->doc, "matrices");
    json_t       *of_sweeps = values_list(v->doc, "sweep_matrices");
    for (int i = 0; i < review->case_count; i++) words_list_add(&eyes, review->cases[i].eye);
    for (int i = 0; i < review->sweep_count; i++)
        words_list_add(&conditions, review->sweeps[i].condition);
    for (int i = 0; i < eyes.count; i++) {
        Matrix m = matrix_of_eye(review, eyes.list[i], v->arena);
        add_matrix(v, of_eyes, &m);
    }
    for (int i = 0; i < conditions.count; i++) {
        Matrix m = matrix_of_sweeps(review, conditions.list[i], v->arena);
        add_matrix(v, of_sweeps, &m);
    }
}

/* ---- the list ---------------------------------------------------------------------------- */

void values_add_list(const PageValues *v, int most)
{
    const ReviewCase **ranked = review_rank(v->review, v->arena);
    int     all = review_case_count(v->review);
    int     listed = most && most < all ? most : all;
    json_t *list = values_list(v->doc, "listed");
    for (int i = 0; i < listed; i++) values_add_case(v, list, ranked[i]);
    page_set_count(v->doc, "listed_count", listed);
    page_set_count(v->doc, "unlisted", listed < all ? all : 0);
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

static void set_limit_row(json_t *to, const LimitRow *row, Arena *arena)
{
    LimitVerdict low = *row->limit;
    low.value = row->low;
    page_set(to, "name", row->limit->name);
    page_set(to, "source", row->limit->source);
    page_set(to, "required", words_required(&low, arena));
    page_set(to, "to", row->high > row->low ? words_number(row->high, arena) : NULL);
    page_set_flag(to, "is_read", row->limit->read_in_the_standard);
}

void values_add_limits(const PageValues *v)
{
    LimitRows rows = {NULL, 0, 0};
    json_t   *list = values_list(v->doc, "limit_rows");
    for (int i = 0; i < review_case_count(v->review); i++)
        gather_limits(&rows, review_case_at(v->review, i), v->arena);
    for (int i = 0; i < rows.count; i++)
        set_limit_row(page_add(list), &rows.list[i], v->arena);
    page_set_flag(v->doc, "has_limit_rows", rows.count > 0);
}

/* ---- what changed ------------------------------------------------------------------------ */

/* Its kind, and the names of what is compared: symbol or gaze, condition, eye. */
static json_t *add_change(json_t *list, DiffKind kind, bool is_sweep,
                          const char *const names[3])
{
    static const char *const CLASSES[7] = {"chip bad", "chip good", "bad", "good",
                                           "sub",      "sub",       "sub"};
    static const char *const WORDS[7] = {"worse verdict", "better verdict", "less contrast",
                                         "more contrast", "only before",    "only now",
                                         "same"};
    json_t     *to = page_add(list);
    const char *words = WORDS[kind];
    if (is_sweep && kind == DIFF_WORSE) words = "fails more often";
    if (is_sweep && kind == DIFF_BETTER) words = "fails less often";
    page_set(to, "class", CLASSES[kind]);
    page_set(to, "change", words);
    page_set(to, "of", names[0]);
    page_set(to, "condition", names[1]);
    page_set(to, "eye", names[2]);
    return to;
}

/* "a → b" */
static void set_change(json_t *to, const char *name, const char *before, const char *after,
                       Arena *arena)
{
    bool is_same = !strcmp(before, after);
    page_set(to, name, is_same ? after : arena_format(arena, "%s → %s", before, after));
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

static void add_case_change(json_t *list, const CaseDiff *d, Arena *arena)
{
    const ReviewCase *either = d->after ? d->after : d->before, *b = d->before, *a = d->after;
    json_t           *to = add_change(
        list, d->kind, false,
        (const char *const[3]){either->symbol, either->condition, either->eye});
    set_change(to, "verdict", verdict_of(b), verdict_of(a), arena);
    set_change(to, "figure", figure_of(b, arena), figure_of(a, arena), arena);
    set_change(to, "margin", margin_of(b, arena), margin_of(a, arena), arena);
}

static void add_sweep_change(json_t *list, const SweepDiff *d, Arena *arena)
{
    const ReviewSweep *b = d->before, *a = d->after, *either = a ? a : b;
    json_t            *to = add_change(
        list, d->kind, true,
        (const char *const[3]){either->symbol, either->condition, either->eye});
    set_change(to, "failed", words_share(b ? b->failed_share : NAN, arena),
               words_share(a ? a->failed_share : NAN, arena), arena);
    set_change(to, "longest", words_minutes(b ? b->longest_failure_minutes : NAN, arena),
               words_minutes(a ? a->longest_failure_minutes : NAN, arena), arena);
}

static const char *figure_change(double before, double after, Arena *arena)
{
    return arena_format(arena, "%s → %s", words_figure(before, arena),
                        words_figure(after, arena));
}

static void add_gaze_change(json_t *list, const GazeDiff *d, Arena *arena)
{
    const GazeFinding *either = d->after ? d->after : d->before;
    const GazeFinding *b = d->before ? d->before : &diff_no_gaze;
    const GazeFinding *a = d->after ? d->after : &diff_no_gaze;
    json_t            *to = add_change(
        list, d->kind, false,
        (const char *const[3]){either->gaze, either->condition, either->eye});
    set_change(to, "left", words_share(b->contrast_left, arena),
               words_share(a->contrast_left, arena), arena);
    page_set(to, "mirrored", figure_change(b->mirrored, a->mirrored, arena));
    page_set(to, "veil", figure_change(b->veil, a->veil, arena));
}

/* All sweeps, and of the others those that are not the same: these come last. */
void values_add_diff(const PageValues *v)
{
    const ReviewDiff *diff = v->page->diff;
    if (!diff) return;
    json_t *to = values_object(v->doc, "diff"), *cases = values_list(to, "cases");
    json_t *sweeps = values_list(to, "sweeps"), *gazes = values_list(to, "gazes");
    page_set(to, "before", diff->before_name);
    page_set(to, "now", diff->after_name);
    for (int kind = 0; kind < 7; kind++)
        if (kind != DIFF_GONE && kind != DIFF_NEW)
            page_set_count(to, diff_names[kind], diff->count[kind]);
    for (int i = 0; i < diff->case_count; i++)
        if (diff->cases[i].kind != DIFF_SAME) add_case_change(cases, &diff->cases[i], v->arena);
    for (int i = 0; i < diff->sweep_count; i++)
        add_sweep_change(sweeps, &diff->sweeps[i], v->arena);
    for (int i = 0; i < diff->gaze_count; i++)
        if (diff->gazes[i].kind != DIFF_SAME) add_gaze_change(gazes, &diff->gazes[i], v->arena);
    page_set_flag(to, "has_cases", json_array_size(cases) > 0);
    page_set_flag(to, "has_sweeps", json_array_size(sweeps) > 0);
    page_set_flag(to, "has_gazes", json_array_size(gazes) > 0);
}
