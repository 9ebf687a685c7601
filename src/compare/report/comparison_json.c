/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/report/comparison_json.h"

#include <math.h>

#include "compare/headline.h"
#include "compare/metrics.h"
#include "text/json_text.h"

/* ---- metrics ----------------------------------------------------------------------------- */

static json_t *stat_json(const StatisticResult *s) {
    static const char *const VERDICTS[] = {[STATISTIC_EQUAL] = "equal",
                                           [STATISTIC_SAME] = "same",
                                           [STATISTIC_DIFFERENT] = "different",
                                           [STATISTIC_UNKNOWN] = "unknown"};
    return json_pack("{s:o, s:o, s:o, s:s, s:o, s:o, s:o, s:b, s:i, s:o}", "p_value",
                     json_figure(s->p_value), "fraction_failed", json_figure(s->fraction_failed),
                     "mean_shift", json_figure(s->mean_shift), "verdict", VERDICTS[s->verdict],
                     "p_blocks", json_figure(s->p_blocks), "p_histogram",
                     json_figure(s->p_histogram), "p_regions", json_figure(s->p_regions),
                     "shares_noise", s->shares_noise, "block_side", s->block_side, "reason",
                     json_text(s->reason));
}

static json_t *metrics_json(const Comparison *c) {
    json_t *metrics = json_object();
    for (int i = 0; i < METRIC_COUNT; i++) {
        bool is_stat = metric_info((Metric)i)->group == GROUP_STAT;
        if (!isnan(c->value[i]) && !is_stat)
            json_object_set_new(metrics, metric_info((Metric)i)->name, json_figure(c->value[i]));
    }
    if (!isnan(c->value[METRIC_PSNR]))
        json_object_set_new(metrics, "psnr_peak", json_figure(c->psnr_peak));
    if (c->flip_map && c->reference.kind == INPUT_FRAME)
        json_object_set_new(metrics, "flip_exposures",
                            json_pack("{s:o, s:o, s:i}", "low_ev",
                                      json_figure(ev_of_stops(c->exposures.stop_ev)), "high_ev",
                                      json_figure(ev_of_stops(c->exposures.start_ev)), "count",
                                      c->exposures.count));
    if (c->has_stat) json_object_set_new(metrics, "stat", stat_json(&c->stat));
    return metrics;
}

/* ---- the rest ---------------------------------------------------------------------------- */

static json_t *rows_json(const Comparison *c) {
    json_t *list = json_array();
    for (int i = 0; i < c->row_count; i++) {
        const CompareRow *r = &c->rows[i];
        json_t *row = json_pack("{s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:s, s:s, s:b}", "figure",
                                r->figure, "of", json_text(r->of), "label", json_text(r->label),
                                "reference", json_figure(r->reference), "test",
                                json_figure(r->test), "value", json_figure(r->value), "half_width",
                                json_figure(r->half_width), "p", json_figure(r->p), "verdict",
                                r->verdict, "text", r->text, "is_key", r->is_key);
        json_object_set_new(row, "change", json_text(r->change));
        json_object_set_new(row, "limit", json_text_or_null(r->limit_text));
        json_array_append_new(list, row);
    }
    return list;
}

static json_t *limits_json(const Comparison *c) {
    json_t *list = json_array();
    for (int i = 0; i < c->row_count; i++) {
        const CompareRow *r = &c->rows[i];
        if (r->table == TABLE_METRIC && r->has_limit)
            json_array_append_new(list, json_pack("{s:s, s:s, s:f, s:o, s:b}", "metric", r->figure,
                                                  "kind", r->is_min ? "min" : "max", "limit",
                                                  r->limit, "value", json_figure(r->value), "holds",
                                                  !r->is_beyond));
    }
    return list;
}

/* A pixel that stands out; null: none does. */
static json_t *pixel_json(const Standout *s) {
    if (!s->count) return json_null();
    return json_pack("{s:i, s:i, s:f, s:f, s:I, s:b}", "x", s->most.x, "y", s->most.y,
                     "reference_cd_m2", s->most.luminance[0], "test_cd_m2", s->most.luminance[1],
                     "count", (json_int_t)s->count, "is_explained", s->is_explained);
}

static json_t *channels_json(const ChannelDifferences *channels) {
    json_t *list = json_array();
    for (int i = 0; i < channels->count; i++) {
        const ChannelDifference *c = &channels->list[i];
        json_array_append_new(
            list, json_pack("{s:o, s:I, s:o, s:o, s:[I,I], s:I}", "name", json_text(c->name),
                            "differing", (json_int_t)c->differing, "mean", json_figure(c->mean),
                            "max", json_figure(c->max), "nonfinite", (json_int_t)c->nonfinite[0],
                            (json_int_t)c->nonfinite[1], "gaps", (json_int_t)c->gaps));
    }
    return list;
}

static json_t *metadata_json(const Structure *structure) {
    json_t *list = json_array();
    for (int i = 0; i < structure->metadata_count; i++) {
        const MetadataRow *row = &structure->metadata[i];
        if (!row->differs) continue;
        json_array_append_new(
            list, json_pack("{s:o, s:o, s:o, s:b, s:b}", "name", json_text(row->name), "reference",
                            json_text_or_null(row->reference), "test", json_text_or_null(row->test),
                            "decides", row->decides, "ignored", row->is_ignored));
    }
    return list;
}

json_t *comparison_json(const Comparison *c, const char *name) {
    static const char *const JUDGES[] = {[JUDGED_BY_LIMITS] = "limits",
                                         [JUDGED_BY_STATISTIC] = "stat",
                                         [JUDGED_BY_EQUALITY] = "equality"};
    json_t *out = json_pack(
        "{s:o, s:b, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "name", json_text(name), "same",
        c->same, "outcome", compare_outcome_names[c->outcome], "verdict", json_text(c->verdict),
        "reference", json_text(c->reference.name), "test", json_text(c->test.name), "metrics",
        metrics_json(c), "limits", limits_json(c), "rows", rows_json(c), "reasons",
        json_texts(c->reasons.list, c->reasons.count), "notes",
        json_texts(c->notes.list, c->notes.count));
    json_object_set_new(out, "kind",
                        json_string(c->reference.kind == INPUT_FRAME ? "frame" : "picture"));
    json_object_set_new(out, "metadata", metadata_json(&c->structure));
    json_object_set_new(out, "inputs_changed",
                        c->structure.knows_inputs
                            ? json_texts(c->structure.inputs.list, c->structure.inputs.count)
                            : json_null());
    json_object_set_new(out, "settings_changed",
                        json_texts(c->structure.settings.list, c->structure.settings.count));
    json_object_set_new(out, "seconds", json_real(c->seconds));
    if (!c->has_pixels) return out;
    json_object_set_new(out, "judged_by", json_string(JUDGES[c->judged_by]));
    json_object_set_new(out, "stands_out", pixel_json(&c->standout));
    json_object_set_new(out, "size",
                        json_pack("[i,i]", c->reference.light.width, c->reference.light.height));
    json_object_set_new(out, "pixels", json_integer((json_int_t)c->selection.pixels));
    json_object_set_new(out, "differing_pixels", json_integer((json_int_t)c->channels.differing));
    json_object_set_new(out, "channels", channels_json(&c->channels));
    if (c->reference.kind == INPUT_FRAME) {
        json_object_set_new(out, "shown_ev", json_figure(c->shown_ev));
        json_object_set_new(out, "shown_with", json_text(c->shown_with));
    }
    return out;
}
