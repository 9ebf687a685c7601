/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/report/html_report.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/count.h"
#include "base/file.h"
#include "compare/report/html_pictures.h"
#include "page/page.h"
#include "text/json_text.h"
#include "text/text.h"

#define PAIR_PIXELS 4000000L   /* of a picture in a report of two files */
#define FOLDER_PIXELS 1500000L /* of one among many */
#define THUMBNAIL 240
#define MOST_BYTES ((size_t)16 << 30) /* of address space for each text */
#define FRAME_BYTES ((size_t)1 << 28) /* for what stands around the pairs */

/* The index and the pairs grow side by side, each in an arena of its own. */
void html_report_start(HtmlReport *report, bool is_folder) {
    *report = (HtmlReport){.is_folder = is_folder};
    for (int i = 0; i < 2; i++) report->own[i] = arena_reserve(MOST_BYTES);
    report->index.arena = &report->own[0];
    report->pairs.arena = &report->own[1];
}

void html_report_release(HtmlReport *report) {
    for (int i = 0; i < 2; i++) arena_release(&report->own[i]);
    *report = (HtmlReport){0};
}

bool html_report_check_name(const char *path, Error *err) {
    const char *ending = path_ending(path);
    if (!strcasecmp(ending, ".html") || !strcasecmp(ending, ".htm")) return true;
    return error_set(err, ERROR_USAGE,
                     "--report %s: required: a name that ends in "
                     ".html",
                     path);
}

/* ---- rows -------------------------------------------------------------------------------- */

/* As pages write it: "±", "cd/m²". */
static json_t *typeset(const char *text, Arena scratch) {
    static const char *const SIGNS[][2] = {{"+-", "±"}, {"m2", "m²"}, {")^2", ")²"}};
    Text out = {.arena = &scratch};
    while (*text) {
        int k = 0;
        while (k < COUNT_OF(SIGNS) && strncmp(text, SIGNS[k][0], strlen(SIGNS[k][0])) != 0) k++;
        if (k < COUNT_OF(SIGNS)) text_add(&out, SIGNS[k][1]);
        else text_add_bytes(&out, text, 1);
        text += k < COUNT_OF(SIGNS) ? strlen(SIGNS[k][0]) : 1;
    }
    return json_text(out.data ? out.data : "");
}

/* A table of each kind, and the few that are looked at first. */
static void set_rows(json_t *to, const Comparison *c, Arena scratch) {
    static const char *const NAMES[] = {
        [TABLE_CONTRAST] = "contrasts", [TABLE_MEAN] = "means", [TABLE_METRIC] = "figures"};
    json_t *lists[COUNT_OF(NAMES)], *keys = json_array();
    for (int t = 0; t < COUNT_OF(NAMES); t++) {
        lists[t] = json_array();
        json_object_set_new(to, NAMES[t], lists[t]);
    }
    json_object_set_new(to, "keys", keys);
    for (int i = 0; i < c->row_count; i++) {
        const CompareRow *r = &c->rows[i];
        json_t *row = json_array_get(json_object_get(to, "rows"), (size_t)i);
        json_object_set_new(row, "text", typeset(r->text, scratch));
        json_object_set_new(row, "change", typeset(r->change, scratch));
        if (r->limit_text) json_object_set_new(row, "limit", typeset(r->limit_text, scratch));
        page_set_flag(row, "is_bad", r->is_beyond || (r->table == TABLE_MEAN && r->is_finding));
        json_array_append(lists[r->table], row);
        if (r->is_key) json_array_append(keys, row);
    }
}

static void set_channels(json_t *to, const ChannelDifferences *channels) {
    json_t *list = json_object_get(to, "channels");
    for (int i = 0; i < channels->count; i++) {
        const ChannelDifference *c = &channels->list[i];
        page_set_count(json_array_get(list, (size_t)i), "wrong",
                       c->nonfinite[0] + c->nonfinite[1] + c->gaps);
    }
}

/* ---- notes and metadata ------------------------------------------------------------------ */

/* What differs is in the answer already; what does not is folded. */
static void set_notes(json_t *to, const Comparison *c) {
    const Structure *structure = &c->structure;
    json_t *alike = json_array(), *row;
    size_t i;
    json_array_foreach(json_object_get(to, "metadata"), i, row) {
        const char *name = json_string_value(json_object_get(row, "name"));
        if (!strncmp(name, "parhelion:", 10)) page_set(row, "name", name + 10);
    }
    for (int k = 0; k < structure->metadata_count; k++) {
        const MetadataRow *m = &structure->metadata[k];
        if (m->differs) continue;
        row = page_add(alike);
        page_set(row, "name", strncmp(m->name, "parhelion:", 10) ? m->name : m->name + 10);
        page_set(row, "reference", m->reference ? m->reference : "–");
        page_set(row, "test", m->test ? m->test : "–");
    }
    json_object_set_new(to, "alike", alike);
}

/* ---- pictures ---------------------------------------------------------------------------- */

static json_t *scale_values(const ShotScale *scale, Arena scratch) {
    Text gradient = {.arena = &scratch};
    const char *ticks[5];
    bool names_unit = scale->is_signed && scale->unit[0];
    shot_ramp_gradient(&gradient, scale->is_signed);
    for (int i = 0; i < 5; i++)
        ticks[i] = i == 4 && names_unit
                       ? arena_format(&scratch, "%s %s", scale->ticks[i], scale->unit)
                       : scale->ticks[i];
    json_t *to = json_pack("{s:b, s:f, s:f, s:o}", "is_signed", scale->is_signed, "low", scale->low,
                           "high", scale->high, "ticks", json_texts(ticks, 5));
    page_set(to, "unit", scale->unit);
    page_set(to, "also", scale->also);
    page_set(to, "gradient", gradient.data);
    return to;
}

static bool add_shot(json_t *list, const Shot *shot, Arena scratch, Error *err) {
    static const char *const KINDS[SHOT_COUNT] = {
        [SHOT_REFERENCE] = "reference", [SHOT_TEST] = "test", [SHOT_DIFFERENCE] = "difference",
        [SHOT_BLOCKS] = "blocks",       [SHOT_P_VALUE] = "p", [SHOT_FLIP] = "flip",
        [SHOT_DELTAE] = "deltae"};
    json_t *to = page_add(list);
    page_set(to, "kind", KINDS[shot->kind]);
    page_set(to, "title", shot->title);
    page_set(to, "caption", shot->caption);
    json_object_set_new(to, "scale",
                        shot->has_scale ? scale_values(&shot->scale, scratch) : json_null());
    json_t *picture = page_picture(&shot->picture, false, scratch, err);
    return picture && !json_object_set_new(to, "picture", picture);
}

static bool has_planes(const Comparison *c) {
    return !input_is_packed(&c->reference) && !input_is_packed(&c->test);
}

/* Sides that have no pixels in common are shown all the same, for those who wonder why. */
static bool set_shots(json_t *to, const Comparison *c, long most_pixels, Arena scratch,
                      Error *err) {
    json_t *list = json_array();
    bool is_common = c->has_pixels && has_planes(c);
    int common = is_common ? shot_factor(&c->light[0], most_pixels) : 0;
    int kinds = !has_planes(c) ? 0 : c->has_pixels ? SHOT_COUNT : SHOT_TEST + 1;
    bool ok = true;
    json_object_set_new(to, "shots", list);
    page_set_flag(to, "is_packed", !has_planes(c));
    page_set_count(to, "factor", common);
    page_set_flag(to, "is_reduced", common > 1);
    for (int kind = 0; kind < kinds && ok; kind++) {
        Shot shot;
        Arena arena = scratch;
        const Planes *codes = kind == SHOT_TEST ? &c->test.codes : &c->reference.codes;
        int factor = common ? common : shot_factor(codes, most_pixels);
        if (shot_make(c, (ShotKind)kind, factor, &arena, &shot))
            ok = add_shot(list, &shot, arena, err);
    }
    return ok;
}

/* ---- a pair ------------------------------------------------------------------------------ */

/* Of the pair's document. */
static json_t *pair_values(const HtmlReport *report, const json_t *pair, const Comparison *c,
                           Arena scratch) {
    char id[32];
    json_t *to = json_deep_copy(pair);
    snprintf(id, sizeof id, "pair-%d", report->count);
    page_set(to, "id", id);
    page_set_flag(to, "is_folder", report->is_folder);
    page_set_flag(to, "is_open", report->shown == 0);
    page_set_flag(to, "has_pixels", c->has_pixels);
    set_notes(to, c);
    if (!c->has_pixels) return to;
    set_rows(to, c, scratch);
    set_channels(to, &c->channels);
    return to;
}

/* In the index of a folder. */
static bool add_card(HtmlReport *report, json_t *values, const Comparison *c, Arena scratch,
                     Error *err) {
    ShotKind kind = c->same ? SHOT_REFERENCE : SHOT_TEST;
    if (has_planes(c)) {
        Picture small = shot_thumbnail(c, kind, THUMBNAIL, &scratch);
        json_t *picture = page_picture(&small, true, scratch, err);
        if (!picture) return false;
        json_object_set_new(values, "picture", picture);
    }
    return page_render(&report->index, "compare_card.html", values, NULL, scratch, err);
}

bool html_report_add(HtmlReport *report, const json_t *pair, const Comparison *c, Arena scratch,
                     Error *err) {
    json_t *values = pair_values(report, pair, c, scratch);
    bool is_shown = !report->is_folder || !c->same;
    long most = report->is_folder ? FOLDER_PIXELS : PAIR_PIXELS;
    bool ok = (!report->is_folder || add_card(report, values, c, scratch, err)) &&
              (!is_shown || (set_shots(values, c, most, scratch, err) &&
                             page_render(&report->pairs, "pair.html", values, NULL, scratch, err)));
    json_decref(values);
    report->shown += is_shown;
    report->count++;
    return ok;
}

void html_report_add_failure(HtmlReport *report, const json_t *pair) {
    char id[32];
    Error none; /* its template has no format that could fail */
    json_t *values = json_copy((json_t *)(size_t)pair);
    snprintf(id, sizeof id, "pair-%d", report->count++);
    page_set(values, "id", id);
    page_render(&report->index, "compare_card.html", values, NULL, (Arena){0}, &none);
    json_decref(values);
}

/* ---- the page ---------------------------------------------------------------------------- */

/* Where cards and pairs come in: they may be large, and are not copied. */
#define CARDS "<!-- cards -->"
#define PAIRS "<!-- pairs -->"

static bool set_page(json_t *to, const HtmlReport *report, const json_t *folders,
                     const char *const sides[2], Arena *arena, Error *err) {
    Text ramps[2] = {{.arena = arena}, {.arena = arena}};
    const char *title =
        arena_format(arena, "%s against %s", path_name(sides[1]), path_name(sides[0]));
    for (int i = 0; i < 2; i++) shot_ramp_digits(&ramps[i], i == 1);
    page_set(to, "reference", sides[0]);
    page_set(to, "test", sides[1]);
    page_set(to, "cards", CARDS);
    page_set(to, "pairs", PAIRS);
    page_set(to, "plain_ramp", ramps[0].data);
    page_set(to, "signed_ramp", ramps[1].data);
    page_set_flag(to, "is_folder", report->is_folder);
    if (folders) json_object_update_missing(to, (json_t *)(size_t)folders);
    return page_set_head(to, title, "compare --report", err);
}

/* Cuts off what stands before the mark. */
static Text cut_at(const char **rest, const char *mark) {
    const char *at = *rest, *end = strstr(at, mark);
    if (!end) return (Text){0};
    *rest = end + strlen(mark);
    return (Text){.data = (char *)(size_t)at, .size = (size_t)(end - at)};
}

bool html_report_write(const HtmlReport *report, const json_t *folders, const char *const sides[2],
                       const char *path, Error *err) {
    Arena arena = arena_reserve(FRAME_BYTES), scratch = arena_reserve(FRAME_BYTES);
    Text page = {.arena = &arena};
    json_t *values = json_object();
    bool ok = set_page(values, report, folders, sides, &scratch, err) &&
              page_render(&page, "compare.html", values, NULL, scratch, err);
    if (ok) {
        const char *rest = page.data;
        Text begin = cut_at(&rest, CARDS), between = cut_at(&rest, PAIRS);
        Text end = {.data = (char *)(size_t)rest, .size = strlen(rest)};
        ok = page_write(
            (const Text *const[]){&begin, &report->index, &between, &report->pairs, &end}, 5, path,
            err);
    }
    json_decref(values);
    arena_release(&scratch);
    arena_release(&arena);
    return ok;
}
