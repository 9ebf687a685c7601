/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/report/html_tables.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "page/page.h"

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

void html_add_keys(Text *html, const Comparison *c, const CompareOptions *options)
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

void html_add_tables(Text *html, const Comparison *c, const CompareOptions *options)
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

void html_add_notes(Text *html, const Comparison *c)
{
    if (c->notes.count > 0) {
        page_element(html, "h3", "Notes");
        page_list(html, "notes", c->notes.list, c->notes.count);
    }
    if (c->structure.metadata_count > 0) add_metadata(html, &c->structure);
}
