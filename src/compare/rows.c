/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/rows.h"

#include <math.h>
#include <string.h>

#include "compare/metrics.h"

#define LEAST_SAID 1e-3    /* of a change that has no interval */
#define KEYS_OF_DISPLAYS 6 /* that are looked at first */

/* Whether a change is a finding: its interval is narrower than itself, and holds no 0. Without
 * an interval what three digits show. */
static bool is_finding(double change, double half_width) {
    return fabs(change) > (isnan(half_width) ? LEAST_SAID : 2 * half_width); /* false for NaN */
}

/* As many digits as half of the 95 % interval allows: "-16.3 +- 7.2 %"; NaN: none is known. */
static const char *change_text(double change, double half_width, Arena *arena) {
    if (isinf(half_width)) return arena_format(arena, "%+.3g %%, not sure", 100 * change + 0.0);
    if (!(half_width > 0) || !isfinite(change))
        return arena_format(arena, "%+.3g %%", 100 * change + 0.0);
    int decimals = (int)fmin(fmax(1 - floor(log10(100 * half_width)), 0), 9);
    double unit = pow(10, decimals);
    return arena_format(arena, "%+.*f +- %.*f %%", decimals,
                        round(100 * change * unit) / unit + 0.0, /* no -0 */
                        decimals, 100 * half_width);
}

/* A metric as people read it: "0.0123", "1.2 %", "12.3 cd/m2". */
static const char *value_text(const Comparison *c, const MetricInfo *info, double value,
                              Arena *arena) {
    bool is_frame = c->reference.kind == INPUT_FRAME;
    const char *unit = info->unit;
    if (!strncmp(unit, "light", 5)) unit = !is_frame ? "" : unit[5] ? "(cd/m2)^2" : "cd/m2";
    if (isnan(value)) return "not known";
    if (isinf(value)) return value > 0 ? "infinite" : "-infinite";
    if (info->group == GROUP_STAT && info->is_min) return arena_format(arena, "%.2g", value);
    return arena_format(arena, info->is_change ? "%+.4g%s%s" : "%.4g%s%s",
                        (!strcmp(unit, "%") ? 100 * value : value) + 0.0, unit[0] ? " " : "", unit);
}

static const Threshold *limit_of(const CompareOptions *options, Metric metric) {
    for (int i = 0; i < options->threshold_count; i++)
        if (options->thresholds[i].metric == metric) return &options->thresholds[i];
    return NULL;
}

static CompareRow *add_row(Comparison *out, CompareTable table, const char *figure,
                           const char *label) {
    CompareRow *row = &out->rows[out->row_count++];
    *row = (CompareRow){.table = table,
                        .figure = figure,
                        .of = "",
                        .label = label,
                        .reference = NAN,
                        .test = NAN,
                        .half_width = NAN,
                        .p = NAN,
                        .change = "",
                        .verdict = ""};
    return row;
}

static void set_limit(const CompareOptions *options, Metric metric, Arena *arena, Comparison *out,
                      CompareRow *row) {
    const Threshold *limit = limit_of(options, metric);
    const MetricInfo *info = metric_info(metric);
    if (!limit) return;
    row->has_limit = true;
    row->limit = limit->limit;
    row->is_min = info->is_min;
    row->is_beyond = !threshold_holds(*limit, row->value);
    row->verdict = row->is_beyond ? "beyond" : "within";
    const char *text = value_text(out, info, limit->limit, arena);
    row->limit_text =
        arena_format(arena, "%s %s", info->is_min ? "at least" : "at most", text + (*text == '+'));
}

static void add_contrasts(const CompareOptions *options, Arena *arena, Comparison *out) {
    for (int i = 0; i < out->contrast_count; i++) {
        const ContrastChange *d = &out->contrasts[i];
        CompareRow *row = add_row(out, TABLE_CONTRAST, "contrast",
                                  arena_format(arena, "contrast of %s", d->display));
        row->of = d->display;
        row->reference = d->reference.contrast.value;
        row->test = d->test.contrast.value;
        row->value = d->ratio.value - 1;
        row->half_width = measured_half_width(d->ratio);
        row->is_finding = is_finding(row->value, row->half_width);
        if (!isnan(row->half_width)) row->verdict = row->is_finding ? "moved" : "below the noise";
        set_limit(options, METRIC_CONTRAST_CHANGE, arena, out, row);
        row->is_key = (row->is_finding || row->is_beyond) && i < KEYS_OF_DISPLAYS;
        row->change = change_text(row->value, row->half_width, arena);
        row->text = arena_format(arena, "%.4g : 1, now %.4g : 1 (%s)", row->reference, row->test,
                                 row->change);
    }
}

/* Of the plain mean and the change in proportion the plain one, unless the other alone is sure. */
static void add_means(Arena *arena, Comparison *out) {
    for (int i = 0; i < out->stat.region_count; i++) {
        const StatisticRegion *r = &out->stat.regions[i];
        bool is_plain =
            regions_shift_is_sure(r) || !regions_excludes_none(r->change, r->change_sigma);
        CompareRow *row =
            add_row(out, TABLE_MEAN, "mean", arena_format(arena, "mean luminance of %s", r->words));
        row->of = i == 0 ? "" : r->words;
        row->reference = r->reference;
        row->test = r->test;
        row->value = is_plain ? r->shift : r->change;
        row->half_width = 1.96 * (is_plain ? r->shift_sigma : r->change_sigma);
        row->p = r->p_value;
        row->is_finding = r->moved;
        row->verdict = r->moved ? "moved" : "below the noise";
        row->is_key = r->moved && i == 0 && is_finding(row->value, row->half_width);
        row->change = change_text(row->value, row->half_width, arena);
        row->text = arena_format(arena, "%.4g cd/m2, now %.4g cd/m2 (%s%s)", r->reference, r->test,
                                 row->change, is_plain ? "" : " in proportion");
    }
}

/* Nothing of one that was not computed, unless it has a limit. */
static void add_metrics(const CompareOptions *options, Arena *arena, Comparison *out) {
    static const bool IS_KEY[METRIC_COUNT] = {[METRIC_P_VALUE] = true,
                                              [METRIC_FLIP] = true,
                                              [METRIC_DELTAE_MEAN] = true,
                                              [METRIC_PSNR] = true,
                                              [METRIC_SSIM] = true};
    for (int i = 0; i < METRIC_COUNT; i++) {
        const MetricInfo *info = metric_info((Metric)i);
        if (isnan(out->value[i]) && !limit_of(options, (Metric)i)) continue;
        CompareRow *row = add_row(out, TABLE_METRIC, info->name, info->label);
        row->value = out->value[i];
        set_limit(options, (Metric)i, arena, out, row);
        row->is_key = IS_KEY[i] || row->has_limit;
        row->text = value_text(out, info, row->value, arena);
    }
}

void rows_make(const CompareOptions *options, Arena *arena, Comparison *out) {
    int most = out->contrast_count + out->stat.region_count + METRIC_COUNT;
    out->rows = ARENA_NEW(arena, CompareRow, most);
    add_contrasts(options, arena, out);
    if (out->has_stat) add_means(arena, out);
    add_metrics(options, arena, out);
}
