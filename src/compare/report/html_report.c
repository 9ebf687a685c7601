/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/report/html_report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/count.h"
#include "base/file.h"
#include "compare/comparison.h"
#include "compare/report/html_pictures.h"
#include "page/page.h"
#include "text/text.h"

#define PAIR_PIXELS 4000000L   /* of a picture in a report of two files */
#define FOLDER_PIXELS 1500000L /* of one among many */
#define THUMBNAIL 240
#define MOST_BYTES ((size_t)16 << 30) /* of address space for each text */
#define FRAME_BYTES ((size_t)1 << 28) /* for what stands around the pairs */

/* report.css and report.js beside this file; the build embeds them. */
extern const char COMPARE_STYLE[], COMPARE_SCRIPT[];

/* The index and the pairs grow side by side, each in an arena of its own. */
void html_report_start(HtmlReport *report, bool is_folder)
{
    *report = (HtmlReport){.is_folder = is_folder};
    for (int i = 0; i < 2; i++) report->own[i] = arena_reserve(MOST_BYTES);
    report->index.arena = &report->own[0];
    report->pairs.arena = &report->own[1];
}

void html_report_release(HtmlReport *report)
{
    for (int i = 0; i < 2; i++) arena_release(&report->own[i]);
    *report = (HtmlReport){0};
}

bool html_report_check_name(const char *path, Error *err)
{
    const char *ending = path_ending(path);
    if (!strcasecmp(ending, ".html") || !strcasecmp(ending, ".htm")) return true;
    return error_set(err, ERROR_USAGE, "--report %s: required: a name that ends in "
                                       ".html", path);
}

/* ---- tables of metrics, regions, displays and metadata ----------------------------------- */

#define KEYS_OF_DISPLAYS 6

/* A metric as people read it: "0.0123", "1.2 %", "12.3 cd/m²". */
static const char *value_text(const Comparison *c, Metric metric, double value, char text[64])
{
    const MetricInfo *info = metric_info(metric);
    bool              is_frame = c->reference.kind == INPUT_FRAME;
    const char       *sign = info->is_change && value > 0 ? "+" : "";
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

static const Threshold *limit_of(const CompareOptions *options, Metric metric)
{
    for (int i = 0; i < options->threshold_count; i++)
        if (options->thresholds[i].metric == metric) return &options->thresholds[i];
    return NULL;
}

/* ---- what is looked at first ------------------------------------------------------------- */

static void add_key(Text *html, const Comparison *c, const CompareOptions *options,
                    Metric metric)
{
    char              text[64], wanted[64], name[192];
    const Threshold  *limit = limit_of(options, metric);
    const MetricInfo *info = metric_info(metric);
    double            value = c->value[metric];
    if (isnan(value) && !limit) return;
    snprintf(name, sizeof name, "%s%s%s", info->label,
             !limit ? "" : info->is_min ? ", at least " : ", at most ",
             limit ? value_text(c, metric, limit->limit, wanted) : "");
    page_key(html, value_text(c, metric, value, text), name,
             limit && !threshold_holds(*limit, value));
}

static void change_text(Measured ratio, char text[64])
{
    double change = 100 * (ratio.value - 1);
    if (!isfinite(ratio.low)) snprintf(text, 64, "%+.3g %%", change);
    else snprintf(text, 64, "%+.3g ± %.2g %%", change, 100 * measured_half_width(ratio));
}

static void add_contrast_key(Text *html, const ContrastChange *d, const Threshold *limit)
{
    char value[64], change[64], name[256];
    change_text(d->ratio, change);
    snprintf(value, sizeof value, "%.3g → %.3g", d->reference.contrast.value,
             d->test.contrast.value);
    snprintf(name, sizeof name, "contrast of %.120s, %s", d->display, change);
    page_key(html, value, name, limit && !threshold_holds(*limit, d->ratio.value - 1));
}

/* The few metrics that are looked at first. */
static void html_add_keys(Text *html, const Comparison *c, const CompareOptions *options)
{
    static const Metric KEYS[] = {METRIC_MEAN_SHIFT,  METRIC_P_VALUE, METRIC_FLIP,
                                  METRIC_DELTAE_MEAN, METRIC_PSNR,    METRIC_SSIM};
    if (!c->has_pixels) return;
    page_keys_begin(html);
    for (int i = 0; i < c->contrast_count && i < KEYS_OF_DISPLAYS; i++)
        add_contrast_key(html, &c->contrasts[i], limit_of(options, METRIC_CONTRAST_CHANGE));
    for (int i = 0; i < COUNT_OF(KEYS); i++) add_key(html, c, options, KEYS[i]);
    page_keys_end(html);
}

/* ---- tables ------------------------------------------------------------------------------ */

static void add_metrics(Text *html, const Comparison *c, const CompareOptions *options)
{
    static const PageColumn COLUMNS[] = {
        {"metric", false, NULL}, {"value", true, NULL}, {"limit", true, NULL},
        {"", false, NULL}};
    page_table_begin(html, "Metrics", "", COLUMNS, COUNT_OF(COLUMNS));
    for (int i = 0; i < METRIC_COUNT; i++) {
        char             text[64];
        const Threshold *limit = limit_of(options, (Metric)i);
        const MetricInfo *info = metric_info((Metric)i);
        if (isnan(c->value[i]) && !limit) continue;
        bool holds = !limit || threshold_holds(*limit, c->value[i]);
        page_row_begin(html, "");
        page_cell(html, "", info->label);
        page_cell(html, holds ? "n" : "n bad", value_text(c, (Metric)i, c->value[i], text));
        if (limit)
            page_cell_format(html, "n", "%s %s", info->is_min ? "≥" : "≤",
                             value_text(c, (Metric)i, limit->limit, text));
        else
            page_cell(html, "", "");
        page_cell(html, holds ? "good" : "bad", !limit ? "" : holds ? "within" : "beyond");
        page_row_end(html);
    }
    page_table_end(html);
}

static void add_regions(Text *html, const StatisticResult *s)
{
    static const PageColumn COLUMNS[] = {
        {"region", false, NULL}, {"reference", true, NULL}, {"test", true, NULL},
        {"change", true, NULL},
        {"in proportion", true, "one factor for all pixels: the surer count more"},
        {"p", true, NULL}, {"", false, NULL}};
    page_table_begin(html, "Means in cd/m², tested one by one", "", COLUMNS, COUNT_OF(COLUMNS));
    for (int i = 0; i < s->region_count; i++) {
        const StatisticRegion *r = &s->regions[i];
        page_row_begin(html, "");
        page_cell(html, "", r->name);
        page_cell_format(html, "n", "%.4g", r->reference);
        page_cell_format(html, "n", "%.4g", r->test);
        page_cell_format(html, "n", "%+.2g ± %.2g %%", 100 * r->shift, 196 * r->shift_sigma);
        page_cell_format(html, "n", "%+.2g ± %.2g %%", 100 * r->change, 196 * r->change_sigma);
        page_cell_format(html, "n", "%.2g", r->p_value);
        page_cell(html, r->moved ? "bad" : "good", r->moved ? "moved" : "noise");
        page_row_end(html);
    }
    page_table_end(html);
}

static void add_displays(Text *html, const Comparison *c)
{
    static const PageColumn COLUMNS[] = {
        {"display", false, NULL}, {"reference", true, NULL}, {"test", true, NULL},
        {"change", true, NULL}, {"reflected, cd/m²", true, NULL}};
    page_table_begin(html, "Contrast of the displays", "", COLUMNS, COUNT_OF(COLUMNS));
    for (int i = 0; i < c->contrast_count; i++) {
        char                  change[64];
        const ContrastChange *d = &c->contrasts[i];
        change_text(d->ratio, change);
        page_row_begin(html, "");
        page_cell(html, "", d->display);
        page_cell_format(html, "n", "%.4g : 1", d->reference.contrast.value);
        page_cell_format(html, "n", "%.4g : 1", d->test.contrast.value);
        page_cell(html, "n", change);
        page_cell_format(html, "n", "%.4g → %.4g", d->reference.reflected, d->test.reflected);
        page_row_end(html);
    }
    page_table_end(html);
}

static void add_channels(Text *html, const ChannelDifferences *channels)
{
    static const PageColumn COLUMNS[] = {
        {"channel", false, NULL}, {"pixels", true, NULL}, {"mean", true, NULL},
        {"greatest", true, NULL}, {"not finite", true, NULL}};
    page_table_begin(html, "", "", COLUMNS, COUNT_OF(COLUMNS));
    for (int i = 0; i < channels->count; i++) {
        const ChannelDifference *c = &channels->list[i];
        long wrong = c->nonfinite[0] + c->nonfinite[1] + c->gaps;
        if (c->differing == 0) continue;
        page_row_begin(html, "");
        page_cell(html, "", c->name);
        page_cell_format(html, "n", "%ld", c->differing);
        page_cell_format(html, "n", "%.4g", c->mean);
        page_cell_format(html, "n", "%.4g", c->max);
        page_cell_format(html, wrong ? "n bad" : "n", "%ld", wrong);
        page_row_end(html);
    }
    page_table_end(html);
}

/* All metrics with their limits; regions; displays; channels. */
static void html_add_tables(Text *html, const Comparison *c, const CompareOptions *options)
{
    if (!c->has_pixels) return;
    if (c->has_stat && c->stat.region_count > 0) add_regions(html, &c->stat);
    text_add(html, "<div class=\"tables\"><div>\n");
    if (c->contrast_count > 0) {
        add_displays(html, c);
        text_add(html, "</div><div>\n");
    }
    add_metrics(html, c, options);
    text_add(html, "</div></div>\n");
    if (c->channels.differing == 0) return;
    page_more_begin(html, "channels that differ");
    add_channels(html, &c->channels);
    page_more_end(html);
}

/* ---- notes and metadata ------------------------------------------------------------------ */

static void add_metadata_row(Text *html, const MetadataRow *row)
{
    page_row_begin(html, row->differs ? "" : "same");
    page_cell(html, "", strncmp(row->name, "parhelion:", 10) ? row->name : row->name + 10);
    page_cell_long(html, row->reference ? row->reference : "–");
    page_cell_long(html, row->test ? row->test : "–");
    page_cell(html, "", !row->differs    ? ""
                        : row->is_ignored ? "ignored"
                        : row->decides    ? "decides"
                                          : "explains");
    page_row_end(html);
}

/* Either the rows that differ or those that do not. */
static void add_metadata_table(Text *html, const Structure *structure, bool differing)
{
    static const PageColumn COLUMNS[] = {
        {"metadata", false, NULL}, {"reference", false, NULL}, {"test", false, NULL},
        {"", false, NULL}};
    page_table_begin(html, "", "meta", COLUMNS, COUNT_OF(COLUMNS));
    for (int i = 0; i < structure->metadata_count; i++)
        if (structure->metadata[i].differs == differing)
            add_metadata_row(html, &structure->metadata[i]);
    page_table_end(html);
}

static void add_metadata(Text *html, const Structure *structure)
{
    int differing = 0;
    for (int i = 0; i < structure->metadata_count; i++)
        differing += structure->metadata[i].differs;
    if (differing > 0) add_metadata_table(html, structure, true);
    if (differing == structure->metadata_count) return;
    page_more_begin(html, "metadata that is the same");
    add_metadata_table(html, structure, false);
    page_more_end(html);
}

/* Notes, and the metadata of both sides: what differs first. */
static void html_add_notes(Text *html, const Comparison *c)
{
    if (c->notes.count > 0) {
        page_element(html, "h3", "Notes");
        page_list(html, "notes", c->notes.list, c->notes.count);
    }
    if (c->structure.metadata_count > 0) add_metadata(html, &c->structure);
}

/* ---- one pair ---------------------------------------------------------------------------- */

static void add_scale(Text *html, const ShotScale *scale)
{
    bool names_unit = scale->is_signed && scale->unit[0];
    text_add(html, "<div class=\"scale\"><i ");
    shot_ramp_gradient(html, scale->is_signed);
    text_add(html, "></i><div>");
    for (int i = 0; i < 5; i++) {
        text_add(html, "<span>");
        escape_markup(html, scale->ticks[i]);
        text_add(html, i == 4 && names_unit ? " " : "");
        escape_markup(html, i == 4 && names_unit ? scale->unit : "");
        text_add(html, "</span>");
    }
    text_add(html, "</div>");
    if (scale->also) page_element(html, "div", scale->also);
    text_add(html, "</div>");
}

static bool add_shot(Text *html, const Shot *shot, Arena scratch, Error *err)
{
    static const char *const KINDS[SHOT_COUNT] = {
        [SHOT_REFERENCE] = "reference", [SHOT_TEST] = "test", [SHOT_DIFFERENCE] = "difference",
        [SHOT_BLOCKS] = "blocks",       [SHOT_P_VALUE] = "p", [SHOT_FLIP] = "flip",
        [SHOT_DELTAE] = "deltae"};
    text_format(html, "<figure class=\"shot\" data-kind=\"%s\"", KINDS[shot->kind]);
    if (shot->has_scale)
        text_format(html, " data-ramp=\"%s\" data-low=\"%.9g\" data-high=\"%.9g\" "
                    "data-unit=\"%s\"", shot->scale.is_signed ? "signed" : "plain",
                    shot->scale.low, shot->scale.high, shot->scale.unit);
    text_add(html, ">");
    page_element(html, "h3", shot->title);
    if (!page_picture(html, shot->title, &shot->picture, false, scratch, err)) return false;
    if (shot->has_scale) add_scale(html, &shot->scale);
    page_element(html, "figcaption", shot->caption);
    text_add(html, "</figure>\n");
    return true;
}

static bool add_shots(Text *html, const Comparison *c, long most_pixels, Arena scratch,
                      Error *err)
{
    int factor = shot_factor(&c->light[0], most_pixels);
    text_format(html, "<div class=\"shots\" data-factor=\"%d\">\n", factor);
    for (int kind = 0; kind < SHOT_COUNT; kind++) {
        Shot  shot;
        Arena arena = scratch;
        if (!shot_make(c, (ShotKind)kind, factor, &arena, &shot)) continue;
        if (!add_shot(html, &shot, arena, err)) return false;
    }
    text_add(html, "</div>\n");
    if (factor > 1)
        text_format(html, "<p class=\"sub\">The pictures are reduced to 1 : %d; the metrics "
                    "are of all pixels.</p>\n", factor);
    return true;
}

/* Sides that have no pixels in common, for those who wonder why. */
static bool add_both_sides(Text *html, const Comparison *c, long most_pixels, Arena scratch,
                           Error *err)
{
    text_add(html, "<div class=\"shots\">\n");
    for (int kind = SHOT_REFERENCE; kind <= SHOT_TEST; kind++) {
        Shot          shot;
        Arena         arena = scratch;
        const Planes *codes = kind == SHOT_TEST ? &c->test.codes : &c->reference.codes;
        shot_make(c, (ShotKind)kind, shot_factor(codes, most_pixels), &arena, &shot);
        if (!add_shot(html, &shot, arena, err)) return false;
    }
    text_add(html, "</div>\n");
    return true;
}

/* <h1> begins: what follows is the verdict's sentence. */
static void begin_verdict(Text *html, bool is_same)
{
    text_format(html, "<div class=\"verdict %s\"><h1><b>%s</b>: ",
                is_same ? "same" : "different", is_same ? "Same" : "Different");
}

static void add_verdict(Text *html, const Comparison *c)
{
    begin_verdict(html, c->same);
    escape_markup(html, c->verdict);
    text_add(html, "</h1>\n");
    if (c->mean[0]) page_element(html, "p class=\"mean\"", c->mean);
    if (c->reasons.count > 1) /* the verdict states the first */
        page_list(html, "reasons", c->reasons.list + 1, c->reasons.count - 1);
    text_add(html, "</div>\n");
}

static void add_sides(Text *html, const char *reference, const char *test)
{
    text_add(html, "<p class=\"sub\">reference ");
    escape_markup(html, reference);
    text_add(html, " · test ");
    escape_markup(html, test);
    text_add(html, "</p>\n");
}

static bool has_planes(const Comparison *c)
{
    return !input_is_packed(&c->reference) && !input_is_packed(&c->test);
}

static bool add_pair(Text *html, const Comparison *c, const CompareOptions *options,
                     long most_pixels, Arena scratch, Error *err)
{
    add_verdict(html, c);
    add_sides(html, c->reference.name, c->test.name);
    html_add_keys(html, c, options);
    if (!has_planes(c))
        text_add(html, "<p class=\"sub\">Too large to be shown.</p>\n");
    else if (c->has_pixels ? !add_shots(html, c, most_pixels, scratch, err)
                      : !add_both_sides(html, c, most_pixels, scratch, err))
        return false;
    html_add_tables(html, c, options);
    html_add_notes(html, c);
    return true;
}

/* ---- folders ----------------------------------------------------------------------------- */

/* The text below a card's picture; `more` is markup. */
static void add_card_text(Text *html, const char *name, const char *answer, const char *why,
                          const char *more)
{
    text_add(html, "<div><strong>");
    escape_markup(html, name);
    text_format(html, "</strong><em>%s</em>: ", answer);
    escape_markup(html, why);
    text_format(html, "%s</div>", more);
}

static bool add_card(HtmlReport *report, const char *name, const Comparison *c, Arena scratch,
                     Error *err)
{
    char     flip[64] = "";
    Text    *html = &report->index;
    ShotKind kind = c->same ? SHOT_REFERENCE : SHOT_TEST;
    text_format(html, c->same ? "<div class=\"card same\">"
                              : "<a class=\"card\" href=\"#pair-%d\">", report->count);
    if (has_planes(c)) {
        Picture small = shot_thumbnail(c, kind, THUMBNAIL, &scratch);
        if (!page_picture(html, "", &small, true, scratch, err)) return false;
    }
    if (!isnan(c->value[METRIC_FLIP]))
        snprintf(flip, sizeof flip, "<br>FLIP %.3g", c->value[METRIC_FLIP]);
    add_card_text(html, name, c->same ? "same" : "different", c->verdict, flip);
    text_add(html, c->same ? "</div>\n" : "</a>\n");
    return true;
}

static void begin_pair(HtmlReport *report, const char *name)
{
    text_format(&report->pairs, "<details class=\"pair\" id=\"pair-%d\"%s>", report->count,
                report->shown++ == 0 ? " open" : "");
    page_element(&report->pairs, "summary", name);
}

bool html_report_add(HtmlReport *report, const char *name, const Comparison *c,
                     const CompareOptions *options, Arena scratch, Error *err)
{
    bool ok = true;
    if (!report->is_folder) {
        text_add(&report->pairs, "<section class=\"pair\">\n");
        ok = add_pair(&report->pairs, c, options, PAIR_PIXELS, scratch, err);
        text_add(&report->pairs, "</section>\n");
    } else {
        ok = add_card(report, name, c, scratch, err);
        if (ok && !c->same) {
            begin_pair(report, name);
            ok = add_pair(&report->pairs, c, options, FOLDER_PIXELS, scratch, err);
            text_add(&report->pairs, "</details>\n");
        }
    }
    report->count++;
    report->different += !c->same;
    return ok;
}

void html_report_add_failure(HtmlReport *report, const char *name, const char *why)
{
    text_format(&report->index, "<div class=\"card\" id=\"pair-%d\">", report->count);
    add_card_text(&report->index, name, "failed", why, "");
    text_add(&report->index, "</div>\n");
    report->count++;
    report->different++;
}

/* ---- the page ---------------------------------------------------------------------------- */

static void begin_page(Text *html, const char *reference, const char *test)
{
    page_begin(html, &(PageHead){.title = arena_format(html->arena, "%s against %s",
                                                       path_name(test), path_name(reference)),
                                 .style = COMPARE_STYLE});
}

static void begin_index(Text *html, const HtmlReport *report, const char *reference,
                        const char *test)
{
    begin_verdict(html, report->different == 0);
    if (report->different)
        text_format(html, "%d of %d pairs differ", report->different, report->count);
    else
        text_format(html, "%s %d pair%s", report->count == 1 ? "the" : "all", report->count,
                    report->count == 1 ? "" : "s");
    text_add(html, "</h1></div>\n");
    add_sides(html, reference, test);
    text_add(html, "<p class=\"sub only-differing\" hidden><label>"
             "<input type=\"checkbox\" id=\"only\"> only what differs</label></p>\n"
             "<div class=\"cards\">\n");
}

static void end_page(Text *html)
{
    Text ramps = {.arena = html->arena};
    text_add(&ramps, "var ramps={\"signed\":\"");
    shot_ramp_digits(&ramps, true);
    text_add(&ramps, "\",\"plain\":\"");
    shot_ramp_digits(&ramps, false);
    text_add(&ramps, "\"};\n");
    page_end(html, "compare --report", (const char *const[]){ramps.data, COMPARE_SCRIPT, NULL});
}

bool html_report_write(const HtmlReport *report, const char *reference, const char *test,
                       const char *path, Error *err)
{
    Arena arena = arena_reserve(FRAME_BYTES);
    Text  begin = {.arena = &arena}, between = {.arena = &arena}, end = {.arena = &arena};
    begin_page(&begin, reference, test);
    if (report->is_folder) {
        begin_index(&begin, report, reference, test);
        text_add(&between, "</div>\n");
    }
    end_page(&end);
    const Text *const parts[] = {&begin, &report->index, &between, &report->pairs, &end};
    bool ok = page_write(parts, 5, path, err);
    arena_release(&arena);
    return ok;
}
