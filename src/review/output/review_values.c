/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_values.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "image/plain/plain_png.h"
#include "page/page.h"
#include "review/output/review_map.h"
#include "review/output/review_facts.h"
#include "review/output/review_link.h"
#include "review/output/review_rays.h"
#include "review/output/review_road.h"
#include "review/output/review_todo.h"
#include "review/output/review_privacy.h"
#include "review/output/review_words.h"
#include "review/finding.h"
#include "review/output/finding_words.h"
#include "review/review_decide.h"
#include "text/json_text.h"
#include "text/text.h"

json_t *values_list(json_t *to, const char *name) {
    json_t *list = json_array();
    json_object_set_new(to, name, list);
    return list;
}

json_t *values_object(json_t *to, const char *name) {
    json_t *object = json_object();
    json_object_set_new(to, name, object);
    return object;
}

json_t *values_of_sweep(const PageValues *v, const ReviewSweep *s) {
    return json_array_get(json_object_get(v->doc, "sweeps"), (size_t)(s - v->review->sweeps));
}

json_t *values_of_case(const PageValues *v, const ReviewCase *c) {
    const ReviewSweep *sweep = review_sweep_of(v->review, c);
    if (sweep) return json_object_get(values_of_sweep(v, sweep), "worst");
    return json_array_get(json_object_get(v->doc, "cases"), (size_t)(c - v->review->cases));
}

void values_set_verdict(json_t *to, Verdict verdict) {
    page_set(to, "class", words_class(verdict));
    page_set(to, "mark", words_mark(verdict));
    page_set(to, "outcome", words_verdict(verdict));
}

void values_set_names(json_t *to, const char *const *keys) {
    for (; *keys; keys++) {
        const char *name = json_string_value(json_object_get(to, *keys));
        if (!name || !*name) page_set(to, *keys, "?");
    }
}

#define FIRST_CAUSES 4
#define PICTURE_BYTES_MAX ((size_t)64 << 20)

/* ---- limits ------------------------------------------------------------------------------ */

static void set_limit(json_t *to, const LimitVerdict *limit, Arena *arena) {
    values_set_verdict(to, limit->verdict);
    page_set_flag(to, "passes", limit->verdict == VERDICT_PASS);
    page_set(to, "found", isnan(limit->found) ? NULL : words_found(limit, arena));
    page_set(to, "range", words_interval(limit->low, limit->high, arena));
    page_set(to, "required", words_required(limit, arena));
    page_set(to, "margin", words_from_limit(limit, arena));
    page_set_flag(to, "has_margin", !isnan(limit->margin));
    page_set(to, "bar", review_bar_margin(limit, arena));
}

/* What decides; NULL: nothing is judged. */
static void set_held(json_t *to, const LimitVerdict *limit, Arena *arena) {
    if (limit) set_limit(values_object(to, "held"), limit, arena);
    else page_set(to, "held", NULL);
}

/* Where more stands of what is no case. */
static const char *link_of(const Finding *f) {
    return f->pane ? "#panes" : f->sun ? "#suns" : f->gaze->road ? "#roads" : "#gazes";
}

/* As a case's own: what lists, the grid and the first screen show of it. */
static json_t *finding_values(const PageValues *v, const Finding *f) {
    Arena *arena = v->arena;
    const char *reason = finding_reason(f, arena);
    json_t *to = json_object();
    values_set_verdict(to, f->verdict);
    page_set(to, "symbol", f->subject);
    page_set(to, "eye", f->viewer ? f->viewer : "?");
    page_set(to, "condition", f->condition ? f->condition : "?");
    page_set(to, "case", words_named(f->subject, f->viewer, f->condition, arena));
    page_set(to, "link", link_of(f));
    page_set(to, "reason", reason);
    page_set(to, "headline", reason);
    page_set(to, "unjudged", reason);
    page_set(to, "todo", todo_of_finding(f, arena));
    page_set(to, "figure", f->why ? unjudged_names[f->why] : words_quantity(f->worst, arena));
    page_set(to, "other_contrast", NULL);
    page_set_flag(to, "is_judged", !f->why);
    page_set_flag(to, "is_worst", false);
    page_set(to, "bars", NULL);
    set_held(to, f->why ? NULL : f->worst, arena);
    return to;
}

void values_add_finding(const PageValues *v, json_t *list, const Finding *f) {
    if (!f) page_set(page_add(list), "link", NULL);
    else if (f->c) json_array_append(list, values_of_case(v, f->c));
    else json_array_append_new(list, finding_values(v, f));
}

/* Limits without a figure are named behind the table. */
static void set_limits(json_t *to, const ReviewCase *c, Arena *arena) {
    Text missing = {.arena = arena};
    int missing_count = 0;
    for (int i = 0; i < c->limit_count; i++) {
        const LimitVerdict *limit = &c->limits[i];
        set_limit(json_array_get(json_object_get(to, "limits"), (size_t)i), limit, arena);
        if (!isnan(limit->found)) continue;
        text_format(&missing, "%s%s", missing_count++ ? "; " : "", limit->name);
    }
    page_set(to, "missing", missing.data);
    page_set_flag(to, "has_found", missing_count < c->limit_count);
    set_held(to, c->unjudged ? NULL : case_worst_limit(c), arena);
}

/* ---- causes and remedies ----------------------------------------------------------------- */

static void set_cause(json_t *to, const char *card, const ReviewCase *c, int i, Arena *arena) {
    const CaseCause *cause = &c->causes[i];
    double low = cause->low, high = cause->high, without = cause->contrast_without;
    page_set(to, "rays", review_rays_has(c, i) ? review_rays_id(card, i, arena) : NULL);
    page_set(to, "chain", words_chain(cause, arena));
    page_set(to, "percent", review_bar_percent(cause->share, arena));
    page_set(to, "cd_m2", words_within(cause->cd_m2, low, high, arena));
    page_set(to, "low", words_within(low, low, high, arena));
    page_set(to, "high", words_within(high, low, high, arena));
    page_set(to, "without", isnan(without) ? NULL : words_ratio_as(c, without, arena));
}

static void set_causes(json_t *to, const ReviewCase *c, Arena *arena) {
    static const char *const GROUPS[CAUSE_GROUPS] = {"light", "opening", "surface"};
    json_t *causes = json_object_get(to, "causes"), *more = values_list(to, "more_causes");
    int first = c->cause_count > FIRST_CAUSES + 1 ? FIRST_CAUSES : c->cause_count;
    double left = 1;
    const char *card = json_string_value(json_object_get(to, "id"));
    for (int i = 0; i < c->cause_count; i++) {
        set_cause(json_array_get(causes, (size_t)i), card, c, i, arena);
        left -= c->causes[i].share;
    }
    for (int i = first; i < c->cause_count; i++) {
        json_array_append(more, json_array_get(causes, (size_t)first));
        json_array_remove(causes, (size_t)first);
    }
    json_object_set_new(to, "other_ways", left >= 0.001 ? json_real(left) : json_null());
    page_set(to, "seat", words_empty_seat(c, arena));
    json_t *groups = values_object(to, "groups");
    for (int g = 0; g < CAUSE_GROUPS; g++)
        page_set(groups, GROUPS[g],
                 c->groups[g].count ? words_group(&c->groups[g], c->groups[g].count, arena) : NULL);
}

/* ---- figures ----------------------------------------------------------------------------- */

/* Of a case that another limit decides: its contrast, too; NULL: it is decided by that. */
static const char *other_contrast(const ReviewCase *c, Arena *arena) {
    const LimitVerdict *limit = case_worst_limit(c);
    bool is_contrast = !limit || quantity_is_contrast(limit_kind_named(limit->kind));
    if (c->unjudged || is_contrast || isnan(c->contrast_ratio)) return NULL;
    bool has_limit = c->limit_id >= 0 && c->limit_id < c->limit_count;
    const LimitVerdict *of = has_limit ? &c->limits[c->limit_id] : NULL;
    return of ? arena_format(arena, "%s %s", words_kind(of), words_found(of, arena))
              : arena_format(arena, "contrast %s", words_contrast(c, arena));
}

static void set_contrast(json_t *to, const ReviewCase *c, Arena *arena) {
    double low = c->contrast_low, high = c->contrast_high;
    page_set(to, "contrast", isnan(c->contrast_ratio) ? NULL : words_contrast(c, arena));
    page_set(to, "contrast_from", words_within(low, low, high, arena));
    page_set(to, "contrast_to", words_within(high, low, high, arena));
    if (isinf(c->contrast_with_veil)) /* which no number of JSON is */
        page_set(to, "contrast_with_veil", words_figure(c->contrast_with_veil, arena));
    page_set(to, "whole", words_whole(c, arena));
    page_set(to, "other_contrast", other_contrast(c, arena));
}

static void set_levels(json_t *to, const ReviewCase *c, Arena *arena) {
    json_t *list = values_list(to, "levels");
    page_set(to, "target", NULL);
    for (int i = 0; i < c->visibility_count; i++) {
        const CaseVisibility *v = &c->visibilities[i];
        const char *whose = v->is_observer ? ", the observer" : "";
        if (isnan(c->contrast_ratio)) continue; /* it is not seen */
        json_t *level = page_add(list);
        page_set(level, "who", arena_format(arena, "%g years%s", v->age_years, whose));
        page_set(level, "told", words_level(v, arena));
        if (v->is_observer) page_set(to, "target", words_target(v, arena));
    }
}

/* ---- pictures ---------------------------------------------------------------------------- */

/* The bytes of its file, as they stand, or its size. */
bool values_add_picture(json_t *to, const ReviewPicture *p, Arena scratch, Error *err) {
    FileBytes bytes;
    PlainPng png;
    page_set(to, "title", p->title ? p->title : "");
    page_set(to, "caption", p->caption);
    page_set(to, "label", p->label);
    page_set(to, "beside", p->beside);
    page_set(to, "data", NULL);
    if (!file_read(p->file, PICTURE_BYTES_MAX, &scratch, &bytes, err)) return false;
    bool is_plain = plain_png_open(bytes.data, bytes.size, &png);
    bool is_shared = p->id && is_plain && !p->beside;
    page_set_count(to, "width", is_plain ? png.width : 0);
    page_set_count(to, "height", is_plain ? png.height : 0);
    page_set(to, "id", is_shared ? p->id : NULL);
    if (!p->beside && !(is_shared && p->is_again))
        json_object_set_new(to, "data", page_bytes("png", bytes.data, bytes.size, scratch));
    return true;
}

/* The causes' rays, and displays in glass. */
static const char *drawn_over(const Review *review, const ReviewCase *c, const char *card,
                              Arena *arena) {
    const char *rays = review_rays_drawn(c, card, arena);
    const char *panes = review_panes_drawn(review, c, arena);
    return rays && panes ? arena_format(arena, "%s%s", rays, panes) : panes ? panes : rays;
}

static bool set_pictures(const PageValues *v, json_t *to, const ReviewCase *c, Error *err) {
    json_t *list = values_list(to, "pictures");
    for (int i = 0; i < v->page->picture_count; i++) {
        const ReviewPicture *p = &v->page->pictures[i];
        Arena scratch = *v->arena;
        const char *card = json_string_value(json_object_get(to, "id"));
        if (p->of != c) continue;
        json_t *picture = page_add(list);
        page_set_flag(picture, "is_frame", p->is_frame);
        page_set(picture, "rays", p->view ? drawn_over(v->review, c, card, &scratch) : NULL);
        if (!values_add_picture(picture, p, scratch, err)) return false;
    }
    return true;
}

/* ---- the case ---------------------------------------------------------------------------- */

static bool add_case(const PageValues *v, json_t *to, const ReviewCase *c, Error *err) {
    static const char *const NAMES[] = {"symbol", "eye", "condition", NULL};
    Arena *arena = v->arena;
    bool has_veil;
    values_set_names(to, NAMES);
    values_set_verdict(to, c->verdict);
    page_set(to, "id", review_card_id(v->review, c, arena));
    page_set(to, "link", review_card_link(v->review, c, arena));
    page_set(to, "case",
             review_sweep_of(v->review, c)
                 ? words_named(c->symbol, c->eye, arena_format(arena, "worst of %s", c->condition),
                               arena)
                 : words_case(c, arena));
    page_set(to, "figure", words_judged(c, arena));
    page_set(to, "reason", words_reason(c, arena));
    page_set(to, "headline", words_headline(c, arena));
    page_set(to, "todo", todo_of_case(c, arena));
    page_set(to, "unjudged", words_unjudged(c, arena));
    page_set(to, "light", words_ambient(c->ambient));
    page_set(to, "sun_words",
             words_sun(c, words_directions(review_sweep_of(v->review, c) != NULL), arena));
    page_set(to, "hiders", words_hiders(c, arena));
    page_set(to, "bars", review_bar_luminances(c, &has_veil, arena));
    page_set_flag(to, "has_veil", has_veil);
    page_set_flag(to, "is_judged", c->verdict != VERDICT_UNJUDGED);
    page_set_flag(to, "is_worst", review_sweep_of(v->review, c) != NULL);
    set_contrast(to, c, arena);
    set_levels(to, c, arena);
    privacy_set_values(to, c, arena);
    set_limits(to, c, arena);
    set_causes(to, c, arena);
    return set_pictures(v, to, c, err);
}

bool values_add_cases(const PageValues *v, Error *err) {
    page_set_flag(v->doc, "has_private", review_has_privacy(v->review));
    page_set_flag(v->doc, "has_levels", review_has_levels(v->review));
    for (int i = 0; i < review_case_count(v->review); i++) {
        const ReviewCase *c = review_case_at(v->review, i);
        if (!add_case(v, values_of_case(v, c), c, err)) return false;
    }
    return true;
}

/* ---- the answer -------------------------------------------------------------------------- */

#define GRID_ROWS 24
#define GRID_EYES 4
#define GRID_WIDTH 790 /* pixels, of a screen of 1280, beside the worst case (review.css) */
#define LETTER 8.7     /* pixels: bold letters of 13 pixels, wide ones */
#define SMALL_LETTER 6.8
#define LEAST_CELL 90
#define CELL_MARGIN 22
#define PHONE_WIDTH 355 /* of a telephone of 390 pixels, likewise: letters of 11 and 9.5 */
#define PHONE_MARGIN 14
#define PHONE_LETTER 7.4
#define PHONE_SMALL 5.8

/* ---- the verdict ------------------------------------------------------------------------ */

/* Words before the worst; "": none. */
static const char *lead_words(const Review *review, const Finding *worst) {
    if (!worst->counts) return "nothing is required to be read; ";
    if (!review->pass) return worst->verdict == VERDICT_PASS ? "the worst is " : "";
    return worst->verdict == VERDICT_PASS ? "closest to its limit is "
                                          : "nothing fails; the worst is ";
}

static void set_verdict(json_t *to, const Review *review, const Finding *worst, Arena *arena) {
    static const char *const CLASSES[4] = {[VERDICT_PASS] = " same",
                                           [VERDICT_FAIL] = "",
                                           [VERDICT_TOO_CLOSE] = " open",
                                           [VERDICT_UNJUDGED] = " unknown"};
    Verdict verdict = review_verdict(review);
    page_set(to, "class", CLASSES[verdict]);
    page_set(to, "outcome", review_outcome_words(review, arena));
    page_set(to, "lead", worst ? lead_words(review, worst) : "");
}

/* ---- every symbol and eye --------------------------------------------------------------- */

typedef struct Grid {
    Findings ranked;         /* the worst first */
    WordList subjects, eyes; /* in the order of their worst */
} Grid;

static Grid make_grid(const Review *review, Arena *arena) {
    Findings ranked = review_ranked(review, arena);
    Grid grid = {ranked, words_list(ranked.count, arena), words_list(ranked.count, arena)};
    for (int i = 0; i < ranked.count; i++) {
        words_list_add(&grid.subjects, ranked.list[i].subject);
        words_list_add(&grid.eyes, ranked.list[i].viewer);
    }
    return grid;
}

static const Finding *worst_of(const Grid *grid, const char *subject, const char *eye) {
    for (int i = 0; i < grid->ranked.count; i++)
        if (words_same(grid->ranked.list[i].subject, subject) &&
            words_same(grid->ranked.list[i].viewer, eye))
            return &grid->ranked.list[i];
    return NULL;
}

static json_t *row_values(const PageValues *v, const Grid *grid, int row, int eyes) {
    json_t *to = json_object(), *cells = values_list(to, "cells");
    const char *subject = grid->subjects.list[row];
    bool has_summary = false;
    for (int i = 0; i < review_case_count(v->review); i++)
        has_summary |= words_same(review_case_at(v->review, i)->symbol, subject);
    has_summary &= v->review->has_summaries && !v->review->whole;
    page_set(to, "name", subject);
    page_set(to, "summary", has_summary ? review_summary_name(v->review, subject, v->arena) : NULL);
    for (int i = 0; i < eyes; i++)
        values_add_finding(v, cells, worst_of(grid, subject, grid->eyes.list[i]));
    return to;
}

/* Of those that do not count. */
static int count_unlimited(const Review *review) {
    int count = 0;
    for (int i = 0; i < review_case_count(review); i++)
        count += review_case_at(review, i)->unjudged == UNJUDGED_LIMIT;
    return count;
}

static const char *count_words(const Review *review, Arena *arena) {
    static const char *const NAMES[4] = {"pass", "fail", "too close to call", "cannot be judged"};
    static const Verdict ORDER[4] = {VERDICT_FAIL, VERDICT_UNJUDGED, VERDICT_TOO_CLOSE,
                                     VERDICT_PASS};
    ReviewCounts counts = review_count(review);
    Text text = {.arena = arena};
    const char *before = ":";
    text_format(&text, "%d verdict%s", counts.total, counts.total == 1 ? "" : "s");
    for (int i = 0; i < 4; i++) {
        if (!counts.of[ORDER[i]]) continue;
        text_format(&text, "%s %d %s", before, counts.of[ORDER[i]], NAMES[ORDER[i]]);
        before = ",";
    }
    int unlimited = count_unlimited(review), optional = counts.not_asked - unlimited;
    if (unlimited) text_format(&text, "%s %d to which no limit applies", before, unlimited);
    if (optional)
        text_format(&text, "%s %d hidden that need not be seen", unlimited ? "," : before,
                    optional);
    return text.data;
}

/* Letters of its longest word. Text in letters that need no space between words, as in
 * Chinese, breaks anywhere. */
static int longest_word(const char *text) {
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
static double grid_width(const Grid *grid, int rows, int eyes) {
    double symbol = 0, below = LEAST_CELL, width = 0;
    for (int i = 0; i < rows; i++)
        symbol = fmax(symbol, LETTER * longest_word(grid->subjects.list[i]));
    for (int i = 0; i < grid->ranked.count; i++)
        below = fmax(below, SMALL_LETTER * longest_word(grid->ranked.list[i].condition));
    for (int i = 0; i < eyes; i++)
        width += fmax(below, LETTER * longest_word(grid->eyes.list[i])) + CELL_MARGIN;
    return width + symbol + CELL_MARGIN;
}

/* Do the columns of a telephone hold the longest words? */
static bool fits_phone(const Grid *grid, int eyes) {
    double room = (double)PHONE_WIDTH / eyes - PHONE_MARGIN;
    int eye = 0, condition = 0;
    for (int i = 0; i < eyes; i++) {
        int word = longest_word(grid->eyes.list[i]);
        if (word > eye) eye = word;
    }
    for (int i = 0; i < grid->ranked.count; i++) {
        int word = longest_word(grid->ranked.list[i].condition);
        if (word > condition) condition = word;
    }
    return PHONE_LETTER * eye <= room && PHONE_SMALL * condition <= room;
}

static void set_grid(const PageValues *v, json_t *to) {
    Grid grid = make_grid(v->review, v->arena);
    int eyes = grid.eyes.count < GRID_EYES ? grid.eyes.count : GRID_EYES;
    int subjects = grid.subjects.count, rows = subjects < GRID_ROWS ? subjects : GRID_ROWS;
    while (eyes > 1 && grid_width(&grid, rows, eyes) > GRID_WIDTH) eyes--;
    bool has_all_eyes = eyes == grid.eyes.count;
    json_t *list = values_list(to, "rows");
    json_object_set_new(to, "eyes", json_texts(grid.eyes.list, eyes));
    for (int row = 0; row < rows; row++)
        json_array_append_new(list, row_values(v, &grid, row, eyes));
    page_set_flag(to, "breaks", grid_width(&grid, rows, eyes) > GRID_WIDTH);
    page_set_flag(to, "stacked", !fits_phone(&grid, eyes));
    page_set_count(to, "shown", rows);
    page_set_count(to, "shown_eyes", eyes);
    page_set_count(to, "subjects", subjects);
    page_set_count(to, "of_eyes", has_all_eyes ? 0 : grid.eyes.count);
    page_set_flag(to, "of_subjects", has_all_eyes && rows < subjects);
    page_set(to, "counts", count_words(v->review, v->arena));
}

/* ---- the worst case --------------------------------------------------------------------- */

/* Its own; else one that the same eye has under the same condition. */
static const ReviewPicture *frame_of(const ReviewPage *page, const Finding *f) {
    const ReviewPicture *like = NULL;
    for (int i = 0; i < page->picture_count; i++) {
        const ReviewPicture *p = &page->pictures[i];
        if (!p->is_frame) continue;
        if (p->of == f->c) return p;
        if (!like && words_same(p->of->eye, f->viewer) &&
            words_same(p->of->condition, f->condition))
            like = p;
    }
    return like;
}

/* The part of the frame about the symbol, larger; of a frame that stands elsewhere. */
static void set_close_up(json_t *to, const ReviewPicture *frame, Arena scratch) {
    const CaseView *view = frame->of->view;
    double box[4];
    if (!(frame->beside || frame->id) || !review_rays_close_up(frame->of, box)) return;
    json_t *close_up = values_object(to, "close_up");
    page_set(close_up, "box",
             arena_format(&scratch, "%.1f %.1f %.1f %.1f", box[0], box[1], box[2], box[3]));
    page_set_count(close_up, "view_width", view->width);
    page_set_count(close_up, "view_height", view->height);
    page_set(close_up, "line", review_rays_line(frame->of, &scratch));
}

/* The case's card has it, too: there it stands. */
static bool set_frame(const PageValues *v, const ReviewPicture *frame, Error *err) {
    json_t *to = values_object(v->doc, "first_frame");
    ReviewPicture shown = *frame;
    Arena scratch = *v->arena;
    shown.is_again = shown.id != NULL;
    page_set(to, "rim", review_rays_rim(shown.of, &scratch));
    set_close_up(to, &shown, scratch);
    return values_add_picture(to, &shown, scratch, err);
}

static void set_rests(const PageValues *v) {
    RestWords list[REST_KINDS];
    int count = review_rests(v->review, list, v->arena);
    json_t *rests = values_list(v->doc, "rests");
    for (int i = 0; i < count; i++) {
        json_t *rest = page_add(rests);
        page_set(rest, "id", list[i].id);
        page_set(rest, "at", v->review->whole ? "index.html" : "");
        page_set(rest, "chip", list[i].chip);
        page_set(rest, "words", list[i].words);
    }
}

static void set_facts(const PageValues *v, const Finding *f) {
    json_t *list = values_list(v->doc, "facts");
    const char *const *directions =
        f->c ? words_directions(review_sweep_of(v->review, f->c) != NULL) : NULL;
    ReviewFacts facts = review_facts_of(v->review, f, directions, v->arena);
    for (int i = 0; i < facts.count; i++) {
        json_t *fact = page_add(list);
        page_set(fact, "name", facts.list[i].name);
        page_set(fact, "value", facts.list[i].value);
    }
}

bool values_add_answer(const PageValues *v, Error *err) {
    Findings ranked = review_ranked(v->review, v->arena);
    const Finding *worst = ranked.count ? &ranked.list[0] : NULL;
    const ReviewPicture *frame = worst ? frame_of(v->page, worst) : NULL;
    set_verdict(values_object(v->doc, "answer"), v->review, worst, v->arena);
    set_rests(v);
    if (!worst) return true;
    json_t *first = json_array();
    values_add_finding(v, first, worst);
    json_object_set(v->doc, "worst", json_array_get(first, 0));
    json_decref(first);
    set_grid(v, values_object(v->doc, "grid"));
    set_facts(v, worst);
    return !frame || set_frame(v, frame, err);
}
