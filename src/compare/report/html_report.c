/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/report/html_report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/count.h"
#include "base/file.h"
#include "compare/comparison.h"
#include "compare/report/comparison_json.h"
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

/* ---- metrics ----------------------------------------------------------------------------- */

#define KEYS_OF_DISPLAYS 6

/* A metric as people read it: "0.0123", "1.2 %", "12.3 cd/m²". */
static const char *value_text(const Comparison *c, Metric metric, double value, char text[64]) {
    const MetricInfo *info = metric_info(metric);
    bool is_frame = c->reference.kind == INPUT_FRAME;
    const char *sign = info->is_change && value > 0 ? "+" : "";
    if (isnan(value)) snprintf(text, 64, "–");
    else if (isinf(value)) snprintf(text, 64, "∞");
    else if (metric == METRIC_P_VALUE) snprintf(text, 64, "%.2g", value);
    else if (!strcmp(info->unit, "%")) snprintf(text, 64, "%s%.4g %%", sign, 100 * value);
    else if (!strcmp(info->unit, "light"))
        snprintf(text, 64, "%.4g%s", value, is_frame ? " cd/m²" : "");
    else if (!strcmp(info->unit, "light^2"))
        snprintf(text, 64, "%.4g%s", value, is_frame ? " (cd/m²)²" : "");
    else snprintf(text, 64, "%.4g%s%s", value, info->unit[0] ? " " : "", info->unit);
    return text;
}

static const Threshold *limit_of(const CompareOptions *options, Metric metric) {
    for (int i = 0; i < options->threshold_count; i++)
        if (options->thresholds[i].metric == metric) return &options->thresholds[i];
    return NULL;
}

/* Nothing of one that was not computed, unless it has a limit. */
static void add_metric(json_t *list, const Comparison *c, const CompareOptions *options,
                       Metric metric) {
    char text[64];
    const Threshold *limit = limit_of(options, metric);
    const MetricInfo *info = metric_info(metric);
    double value = c->value[metric];
    if (isnan(value) && !limit) return;
    json_t *to = page_add(list);
    page_set(to, "label", info->label);
    page_set(to, "value", value_text(c, metric, value, text));
    page_set(to, "limit", limit ? value_text(c, metric, limit->limit, text) : NULL);
    page_set_flag(to, "is_min", info->is_min);
    page_set_flag(to, "is_over", limit && !threshold_holds(*limit, value));
}

/* All of them, and the few that are looked at first. */
static void set_metrics(json_t *to, const Comparison *c, const CompareOptions *options) {
    static const Metric KEYS[] = {METRIC_MEAN_SHIFT,  METRIC_P_VALUE, METRIC_FLIP,
                                  METRIC_DELTAE_MEAN, METRIC_PSNR,    METRIC_SSIM};
    json_t *keys = json_array(), *rows = json_array();
    for (int i = 0; i < COUNT_OF(KEYS); i++) add_metric(keys, c, options, KEYS[i]);
    for (int i = 0; i < METRIC_COUNT; i++) add_metric(rows, c, options, (Metric)i);
    json_object_set_new(to, "keys", keys);
    json_object_set_new(to, "metric_rows", rows);
}

static void change_text(Measured ratio, char text[64]) {
    double change = 100 * (ratio.value - 1);
    if (!isfinite(ratio.low)) snprintf(text, 64, "%+.3g %%", change);
    else snprintf(text, 64, "%+.3g ± %.2g %%", change, 100 * measured_half_width(ratio));
}

static void set_contrasts(json_t *to, const Comparison *c, const CompareOptions *options) {
    const Threshold *limit = limit_of(options, METRIC_CONTRAST_CHANGE);
    json_t *list = json_array();
    for (int i = 0; i < c->contrast_count; i++) {
        char change[64];
        const ContrastChange *d = &c->contrasts[i];
        bool is_over = limit && !threshold_holds(*limit, d->ratio.value - 1);
        json_t *item = page_add(list);
        change_text(d->ratio, change);
        page_set(item, "display", d->display);
        page_set(item, "change", change);
        page_set_flag(item, "is_key", i < KEYS_OF_DISPLAYS);
        page_set_flag(item, "is_over", is_over);
        json_object_set_new(item, "before", json_figure(d->reference.contrast.value));
        json_object_set_new(item, "after", json_figure(d->test.contrast.value));
        json_object_set_new(item, "reflected_before", json_figure(d->reference.reflected));
        json_object_set_new(item, "reflected_after", json_figure(d->test.reflected));
    }
    json_object_set_new(to, "contrasts", list);
    page_set_flag(to, "has_contrasts", c->contrast_count > 0);
}

/* Half a 95 % interval is 1.96 standard errors. */
static void set_change(json_t *to, const char *name, double change, double sigma) {
    char text[64];
    snprintf(text, sizeof text, "%+.2g ± %.2g %%", 100 * change, 196 * sigma);
    page_set(to, name, text);
}

static void set_regions(json_t *to, const StatisticResult *s) {
    json_t *list = json_array();
    for (int i = 0; i < s->region_count; i++) {
        const StatisticRegion *r = &s->regions[i];
        json_t *item = page_add(list);
        page_set(item, "name", r->name);
        json_object_set_new(item, "reference", json_figure(r->reference));
        json_object_set_new(item, "test", json_figure(r->test));
        json_object_set_new(item, "p", json_figure(r->p_value));
        page_set_flag(item, "moved", r->moved);
        set_change(item, "shift", r->shift, r->shift_sigma);
        set_change(item, "change", r->change, r->change_sigma);
    }
    json_object_set_new(to, "regions", list);
    page_set_flag(to, "has_regions", s->region_count > 0);
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
    page_set_flag(to, "has_notes", c->notes.count > 0);
    page_set_flag(to, "has_differing", json_array_size(json_object_get(to, "metadata")) > 0);
    page_set_flag(to, "has_alike", json_array_size(alike) > 0);
    json_object_set_new(to, "alike", alike);
    /* The verdict states the first reason. */
    page_set_flag(to, "has_more_reasons", c->reasons.count > 1);
    json_array_remove(json_object_get(to, "reasons"), 0);
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

static json_t *pair_values(const HtmlReport *report, const char *name, const Comparison *c,
                           const CompareOptions *options) {
    char id[32];
    json_t *to = comparison_json(c, options);
    snprintf(id, sizeof id, "pair-%d", report->count);
    page_set(to, "id", id);
    page_set(to, "name", name);
    page_set_flag(to, "failed", false);
    page_set_flag(to, "is_folder", report->is_folder);
    page_set_flag(to, "is_open", report->shown == 0);
    page_set_flag(to, "has_pixels", c->has_pixels);
    set_notes(to, c);
    if (!c->has_pixels) return to;
    set_metrics(to, c, options);
    set_contrasts(to, c, options);
    set_channels(to, &c->channels);
    page_set_flag(to, "has_regions", false);
    if (c->has_stat) set_regions(to, &c->stat);
    return to;
}

/* In the index of a folder. */
static bool add_card(HtmlReport *report, json_t *values, const Comparison *c, Arena scratch,
                     Error *err) {
    ShotKind kind = c->same ? SHOT_REFERENCE : SHOT_TEST;
    json_object_set_new(values, "flip", json_figure(c->value[METRIC_FLIP]));
    if (has_planes(c)) {
        Picture small = shot_thumbnail(c, kind, THUMBNAIL, &scratch);
        json_t *picture = page_picture(&small, true, scratch, err);
        if (!picture) return false;
        json_object_set_new(values, "picture", picture);
    }
    return page_render(&report->index, "compare_card.html", values, NULL, scratch, err);
}

bool html_report_add(HtmlReport *report, const char *name, const Comparison *c,
                     const CompareOptions *options, Arena scratch, Error *err) {
    json_t *values = pair_values(report, name, c, options);
    bool is_shown = !report->is_folder || !c->same;
    long most = report->is_folder ? FOLDER_PIXELS : PAIR_PIXELS;
    bool ok = (!report->is_folder || add_card(report, values, c, scratch, err)) &&
              (!is_shown || (set_shots(values, c, most, scratch, err) &&
                             page_render(&report->pairs, "pair.html", values, NULL, scratch, err)));
    json_decref(values);
    report->shown += is_shown;
    report->count++;
    report->different += !c->same;
    return ok;
}

void html_report_add_failure(HtmlReport *report, const char *name, const char *why) {
    char id[32];
    Error none; /* its template has no format that could fail */
    json_t *values = json_object();
    snprintf(id, sizeof id, "pair-%d", report->count++);
    report->different++;
    page_set(values, "id", id);
    page_set(values, "name", name);
    page_set(values, "why", why);
    page_set_flag(values, "failed", true);
    page_render(&report->index, "compare_card.html", values, NULL, (Arena){0}, &none);
    json_decref(values);
}

/* ---- the page ---------------------------------------------------------------------------- */

/* Where cards and pairs come in: they may be large, and are not copied. */
#define CARDS "<!-- cards -->"
#define PAIRS "<!-- pairs -->"

static bool set_page(json_t *to, const HtmlReport *report, const char *reference, const char *test,
                     Arena *arena, Error *err) {
    Text ramps[2] = {{.arena = arena}, {.arena = arena}};
    const char *title = arena_format(arena, "%s against %s", path_name(test), path_name(reference));
    for (int i = 0; i < 2; i++) shot_ramp_digits(&ramps[i], i == 1);
    page_set(to, "reference", reference);
    page_set(to, "test", test);
    page_set(to, "cards", CARDS);
    page_set(to, "pairs", PAIRS);
    page_set(to, "plain_ramp", ramps[0].data);
    page_set(to, "signed_ramp", ramps[1].data);
    page_set_flag(to, "is_folder", report->is_folder);
    page_set_flag(to, "is_one", report->count == 1);
    page_set_count(to, "count", report->count);
    page_set_count(to, "different", report->different);
    return page_set_head(to, &(PageHead){.title = title, .command = "compare --report"}, err);
}

/* Cuts off what stands before the mark. */
static Text cut_at(const char **rest, const char *mark) {
    const char *at = *rest, *end = strstr(at, mark);
    if (!end) return (Text){0};
    *rest = end + strlen(mark);
    return (Text){.data = (char *)(size_t)at, .size = (size_t)(end - at)};
}

bool html_report_write(const HtmlReport *report, const char *reference, const char *test,
                       const char *path, Error *err) {
    Arena arena = arena_reserve(FRAME_BYTES), scratch = arena_reserve(FRAME_BYTES);
    Text page = {.arena = &arena};
    json_t *values = json_object();
    bool ok = set_page(values, report, reference, test, &scratch, err) &&
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
