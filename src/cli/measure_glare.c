/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/measure_glare.h"

#include <math.h>

#include "base/count.h"
#include "print/print.h"
#include "cli/options/answer.h"
#include "text/interval_text.h"
#include "text/json_text.h"

bool glare_words_check(GlareWords *words, Error *err) {
    const struct {
        const char *option;
        bool is_given;
    } of_glare[] = {
        {"--threshold", words->has_threshold},   {"--task-factor", words->has_task},
        {"--task-deg", words->has_task_deg},     {"--peak", words->has_peak},
        {"--no-low-light", words->no_low_light}, {"--vertical-lux", words->request.has_lux}};
    for (int i = 0; i < COUNT_OF(of_glare) && !words->given; i++)
        if (of_glare[i].is_given)
            return error_set(err, ERROR_USAGE, "%s: of which glare? — add --glare",
                             of_glare[i].option);
    if (words->has_task && words->has_threshold)
        return error_set(err, ERROR_USAGE, "--threshold and --task-factor exclude each other");
    if (words->has_task_deg && !words->has_task)
        return error_set(err, ERROR_USAGE,
                         "--task-deg: add --task-factor K, which makes the "
                         "task's luminance a threshold");
    words->request.settings.low_light = !words->no_low_light;
    return true;
}

/* ---- what people read -------------------------------------------------------------------- */

static const Column SOURCES[] = {COLUMN_DIGITS("luminance_cd_m2", "luminance", "cd/m2", 4),
                                 COLUMN_DIGITS("solid_angle_sr", "size", "sr", 3),
                                 COLUMN_DIGITS("position_index", "position index", NULL, 3),
                                 COLUMN_FIXED("right_deg", "right", "deg", 1),
                                 COLUMN_FIXED("up_deg", "up", "deg", 1),
                                 COLUMN_DIGITS("illuminance_lx", "at the eye", "lx", 4),
                                 COLUMN_TEXT("pixels", "pixels"),
                                 {.key = "pixel", .words = "about pixel", .is_fixed = true},
                                 COLUMN_KEY("luminance_max_cd_m2", "of its pixels"),
                                 COLUMN_KEY("has_core", "false: too small for the frame")};
static const TableKind SOURCES_KIND = TABLE_KIND("sources", "Sources", SOURCES);

static const Column FIGURES[] = {
    COLUMN_MEASURED("vertical_illuminance_lx", "at the eye", "lx", "vertical_illuminance_interval"),
    COLUMN_TEXT("vertical_illuminance_given", "of these lx, as given"),
    COLUMN_MEASURED("background_cd_m2", "background", "cd/m2", "background_interval"),
    COLUMN_TEXT("missing", "no UGR"),
    COLUMN_MEASURED("ugr", "UGR", NULL, "ugr_interval"),
    COLUMN_MEASURED("dgp", "DGP", NULL, "dgp_interval"),
    COLUMN_TEXT("settings.low_light", "DGP's factor for less than 1000 lx"),
    COLUMN_MEASURED("dgi", "DGI", NULL, "dgi_interval"),
    COLUMN_DIGITS("settings.threshold_cd_m2", "sources brighter than", "cd/m2", 0),
    COLUMN_TEXT("source_count", "sources"),
    {.key = "sources_without_core",
     .words = "too small for the frame, dimmed by it",
     .hides_zero = true},
    {.key = "areas_of_noise",
     .words = "above it by noise, not counted",
     .none = "not known: no layers of noise (--layers halves,variance)"},
    {.key = "sources", .of = &SOURCES_KIND},
    COLUMN_KEY("frame", "the file"),
    COLUMN_KEY("settings", "as requested; `task_cd_m2` as found"),
    COLUMN_KEY("half_space_seen", "the share of it, by the cosine"),
    COLUMN_KEY("solid_angle_sr", "of what is seen")};
const TableKind measure_glare_kind = TABLE_KIND("glare", NULL, FIGURES);

/* ---- the answer --------------------------------------------------------------------------- */

static long count_small(const FrameGlare *g) {
    long count = 0;
    for (int i = 0; i < g->source_count; i++) count += !g->sources[i].has_core;
    return count;
}

static void set_figure(json_t *object, const char *key, const char *interval_key, Measured figure) {
    json_object_set_new(object, key, json_figure(figure.value));
    json_object_set_new(object, interval_key,
                        isfinite(figure.low) && isfinite(figure.value)
                            ? json_pack("[o,o]", json_figure(figure.low), json_figure(figure.high))
                            : json_null());
}

static json_t *json_source(const FrameSource *s) {
    json_t *out = json_pack("{s:f, s:f, s:f, s:f, s:f}", "luminance_cd_m2",
                            s->source.luminance_cd_m2, "luminance_max_cd_m2", s->greatest_cd_m2,
                            "solid_angle_sr", s->source.solid_angle_sr, "position_index",
                            s->source.position_index, "illuminance_lx", s->lx);
    json_object_set_new(out, "right_deg", json_real(s->right_deg));
    json_object_set_new(out, "up_deg", json_real(s->up_deg));
    json_object_set_new(out, "pixel", json_pack("[f,f]", s->x, s->y));
    json_object_set_new(out, "pixels", json_integer(s->pixels));
    json_object_set_new(out, "has_core", json_boolean(s->has_core));
    return out;
}

static json_t *json_settings(const FrameGlare *g, const GlareSettings *s) {
    json_t *out = json_pack("{s:f, s:f, s:b}", "threshold_cd_m2", g->threshold_cd_m2, "peak_cd_m2",
                            s->peak_cd_m2, "low_light", s->low_light);
    json_object_set_new(out, "task_factor",
                        s->task_factor > 0 ? json_real(s->task_factor) : json_null());
    json_object_set_new(out, "task_deg", s->task_factor > 0 ? json_real(s->task_deg) : json_null());
    json_object_set_new(out, "task_cd_m2", json_figure(g->task_cd_m2));
    return out;
}

static bool print_answer(const char *name, const FrameGlare *g, const GlareWords *words,
                         bool as_json, Error *err) {
    json_t *sources = json_array();
    for (int i = 0; i < g->source_count; i++)
        json_array_append_new(sources, json_source(&g->sources[i]));
    json_t *out = json_pack("{s:o, s:o, s:b, s:f, s:f}", "frame", json_text(name), "settings",
                            json_settings(g, &words->request.settings),
                            "vertical_illuminance_given", words->request.has_lux, "half_space_seen",
                            g->seen, "solid_angle_sr", g->solid_angle_sr);
    set_figure(out, "vertical_illuminance_lx", "vertical_illuminance_interval", g->vertical_lx);
    set_figure(out, "background_cd_m2", "background_interval", g->background_cd_m2);
    set_figure(out, "ugr", "ugr_interval", g->ugr);
    set_figure(out, "dgp", "dgp_interval", g->dgp);
    set_figure(out, "dgi", "dgi_interval", g->dgi);
    json_object_set_new(out, "missing", json_text_or_null(discomfort_none_words(g->none)));
    json_object_set_new(out, "source_count", json_integer(g->source_count));
    json_object_set_new(out, "sources", sources);
    json_object_set_new(out, "sources_without_core", json_integer(count_small(g)));
    json_object_set_new(out, "areas_of_noise",
                        g->has_noise ? json_integer(g->doubtful) : json_null());
    return cli_print_answer(&measure_glare_kind, out, as_json, err);
}

bool measure_glare(const Cli *cli, const FrameImage *frame, const GlareWords *words, Arena *arena,
                   Error *err) {
    const char *name = cli->arguments[0];
    FrameGlare glare;
    if (!frame_glare_measure(frame, &words->request, arena, &glare, err))
        return error_in_file(err, name);
    return print_answer(name, &glare, words, cli->json, err);
}
