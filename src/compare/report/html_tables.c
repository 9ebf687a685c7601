#include "compare/report/html_tables.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A figure as people read it: "0.0123", "1.2 %", "12.3 cd/m²". */
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

/* ---- first figures ----------------------------------------------------------------------- */

static void add_key(Markup *html, const Comparison *c, const CompareOptions *options,
                    Metric metric)
{
    char             text[64];
    const Threshold *limit = limit_of(options, metric);
    double           value = c->value[metric];
    if (isnan(value) && !limit) return;
    bool is_over = limit && !threshold_holds(*limit, value);
    markup_format(html, "<div%s><b>", is_over ? " class=\"over\"" : "");
    markup_escape(html, value_text(c, metric, value, text));
    markup_add(html, "</b><span>");
    markup_escape(html, metric_info(metric)->label);
    if (limit) {
        markup_add(html, metric_info(metric)->is_min ? ", at least " : ", at most ");
        markup_escape(html, value_text(c, metric, limit->limit, text));
    }
    markup_add(html, "</span></div>\n");
}

void html_add_keys(Markup *html, const Comparison *c, const CompareOptions *options)
{
    static const Metric KEYS[] = {METRIC_MEAN_SHIFT,  METRIC_P_VALUE, METRIC_FLIP,
                                  METRIC_DELTAE_MEAN, METRIC_PSNR,    METRIC_SSIM,
                                  METRIC_CONTRAST_CHANGE};
    if (!c->has_pixels) return;
    markup_add(html, "<div class=\"key\">\n");
    for (size_t i = 0; i < sizeof KEYS / sizeof *KEYS; i++) add_key(html, c, options, KEYS[i]);
    markup_add(html, "</div>\n");
}

/* ---- tables ------------------------------------------------------------------------------ */

static void add_cell(Markup *html, const char *text)
{
    markup_add(html, "<td>");
    markup_escape(html, text);
    markup_add(html, "</td>");
}

static void begin_table(Markup *html, const char *title, const char *header)
{
    if (title[0]) markup_format(html, "<h3>%s</h3>", title);
    markup_format(html, "<div class=\"wide\"><table><thead><tr>%s</tr></thead><tbody>\n",
                  header);
}

static void end_table(Markup *html)
{
    markup_add(html, "</tbody></table></div>\n");
}

static void add_figures(Markup *html, const Comparison *c, const CompareOptions *options)
{
    begin_table(html, "Figures", "<th>figure</th><th class=\"n\">value</th>"
                "<th class=\"n\">limit</th><th></th>");
    for (int i = 0; i < METRIC_COUNT; i++) {
        char             value[64], wanted[64];
        const Threshold *limit = limit_of(options, (Metric)i);
        const MetricInfo *info = metric_info((Metric)i);
        if (isnan(c->value[i]) && !limit) continue;
        bool holds = !limit || threshold_holds(*limit, c->value[i]);
        markup_add(html, "<tr><td>");
        markup_escape(html, info->label);
        markup_format(html, "</td><td class=\"n%s\">", holds ? "" : " bad");
        markup_escape(html, value_text(c, (Metric)i, c->value[i], value));
        markup_add(html, "</td><td class=\"n\">");
        if (limit) {
            markup_add(html, info->is_min ? "≥ " : "≤ ");
            markup_escape(html, value_text(c, (Metric)i, limit->limit, wanted));
        }
        markup_format(html, "</td><td class=\"%s\">%s</td></tr>\n", holds ? "good" : "bad",
                      limit ? holds ? "within" : "beyond" : "");
    }
    end_table(html);
}

static void add_regions(Markup *html, const StatisticResult *s)
{
    begin_table(html, "Means in cd/m², tested one by one",
                "<th>region</th><th class=\"n\">reference</th><th class=\"n\">test</th>"
                "<th class=\"n\">change</th><th class=\"n\" title=\"one factor for all pixels: "
                "the surer count more\">in proportion</th><th class=\"n\">p</th><th></th>");
    for (int i = 0; i < s->region_count; i++) {
        const StatisticRegion *r = &s->regions[i];
        markup_add(html, "<tr>");
        add_cell(html, r->name);
        markup_format(html, "<td class=\"n\">%.4g</td><td class=\"n\">%.4g</td>"
                      "<td class=\"n\">%+.2g ± %.2g %%</td><td class=\"n\">%+.2g ± %.2g %%</td>"
                      "<td class=\"n\">%.2g</td><td class=\"%s\">%s</td></tr>\n",
                      r->reference, r->test, 100 * r->shift, 196 * r->shift_sigma,
                      100 * r->change, 196 * r->change_sigma, r->p_value,
                      r->moved ? "bad" : "good", r->moved ? "moved" : "noise");
    }
    end_table(html);
}

static void add_displays(Markup *html, const Comparison *c)
{
    begin_table(html, "Contrast of the displays",
                "<th>display</th><th class=\"n\">reference</th><th class=\"n\">test</th>"
                "<th class=\"n\">change</th><th class=\"n\">reflected, cd/m²</th>");
    for (int i = 0; i < c->contrast_count; i++) {
        const ContrastChange *d = &c->contrasts[i];
        markup_add(html, "<tr>");
        add_cell(html, d->display);
        markup_format(html, "<td class=\"n\">%.4g : 1</td><td class=\"n\">%.4g : 1</td>",
                      d->reference.contrast.value, d->test.contrast.value);
        markup_format(html, "<td class=\"n\">%+.3g", 100 * (d->ratio.value - 1));
        if (!isnan(d->ratio.half_width))
            markup_format(html, " ± %.2g", 100 * d->ratio.half_width);
        markup_format(html, " %%</td><td class=\"n\">%.4g → %.4g</td></tr>\n",
                      d->reference.reflected, d->test.reflected);
    }
    end_table(html);
}

static void add_channels(Markup *html, const ChannelDifferences *channels)
{
    begin_table(html, "",
                "<th>channel</th><th class=\"n\">pixels</th><th class=\"n\">mean</th>"
                "<th class=\"n\">greatest</th><th class=\"n\">not finite</th>");
    for (int i = 0; i < channels->count; i++) {
        const ChannelDifference *c = &channels->list[i];
        long wrong = c->nonfinite[0] + c->nonfinite[1] + c->gaps;
        if (c->differing == 0) continue;
        markup_add(html, "<tr>");
        add_cell(html, c->name);
        markup_format(html, "<td class=\"n\">%ld</td><td class=\"n\">%.4g</td>"
                      "<td class=\"n\">%.4g</td><td class=\"n%s\">%ld</td></tr>\n",
                      c->differing, c->mean, c->max, wrong ? " bad" : "", wrong);
    }
    end_table(html);
}

void html_add_tables(Markup *html, const Comparison *c, const CompareOptions *options)
{
    if (!c->has_pixels) return;
    markup_add(html, "<div class=\"tables\"><div>\n");
    add_figures(html, c, options);
    markup_add(html, "</div><div>\n");
    if (c->has_stat && c->stat.region_count > 0) add_regions(html, &c->stat);
    if (c->contrast_count > 0) add_displays(html, c);
    markup_add(html, "</div></div>\n");
    if (c->channels.differing == 0) return;
    markup_add(html, "<details><summary>channels that differ</summary>\n");
    add_channels(html, &c->channels);
    markup_add(html, "</details>\n");
}

/* ---- notes and metadata ------------------------------------------------------------------ */

/* Of any length: it scrolls in its cell. NULL: there is none. */
static void add_value(Markup *html, const char *value)
{
    markup_add(html, "<td><div class=\"long\">");
    markup_escape(html, value ? value : "–");
    markup_add(html, "</div></td>");
}

static void add_metadata_rows(Markup *html, const Structure *structure, bool differing)
{
    for (int i = 0; i < structure->metadata_count; i++) {
        const MetadataRow *row = &structure->metadata[i];
        if (row->differs != differing) continue;
        markup_format(html, "<tr%s>", differing ? "" : " class=\"same\"");
        add_cell(html, strncmp(row->name, "parhelion:", 10) ? row->name : row->name + 10);
        add_value(html, row->reference);
        add_value(html, row->test);
        add_cell(html, !differing ? "" : row->is_ignored ? "ignored"
                                       : row->decides    ? "decides" : "explains");
        markup_add(html, "</tr>\n");
    }
}

static int differing_rows(const Structure *structure)
{
    int count = 0;
    for (int i = 0; i < structure->metadata_count; i++) count += structure->metadata[i].differs;
    return count;
}

static void add_metadata_table(Markup *html, const Structure *structure, bool differing)
{
    markup_add(html, "<div class=\"wide\"><table class=\"meta\"><thead><tr><th>metadata</th>"
               "<th>reference</th><th>test</th><th></th></tr></thead><tbody>\n");
    add_metadata_rows(html, structure, differing);
    markup_add(html, "</tbody></table></div>\n");
}

static void add_metadata(Markup *html, const Structure *structure)
{
    int differing = differing_rows(structure);
    if (differing > 0) add_metadata_table(html, structure, true);
    if (differing == structure->metadata_count) return;
    markup_add(html, "<details><summary>metadata that is the same</summary>\n");
    add_metadata_table(html, structure, false);
    markup_add(html, "</details>\n");
}

void html_add_notes(Markup *html, const Comparison *c)
{
    if (c->notes.count > 0) {
        markup_add(html, "<h3>Notes</h3>\n<ul class=\"notes\">\n");
        for (int i = 0; i < c->notes.count; i++) {
            markup_add(html, "<li>");
            markup_escape(html, c->notes.list[i]);
            markup_add(html, "</li>\n");
        }
        markup_add(html, "</ul>\n");
    }
    if (c->structure.metadata_count > 0) add_metadata(html, &c->structure);
}
