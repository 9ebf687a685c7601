/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/measure_glare.h"

#include <math.h>

#include "base/count.h"
#include "print/print.h"
#include "cli/options/answer.h"
#include "text/interval_text.h"
#include "text/json_text.h"

#define SOURCES_TOLD 10

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

/* ---- as text ----------------------------------------------------------------------------- */

static void print_figure(const char *name, Measured figure, const char *unit, Arena scratch) {
    const char *text = isnan(figure.low)
                           ? arena_format(&scratch, "%.6g", figure.value)
                           : interval_text(figure.value, figure.low, figure.high, &scratch);
    print("%-12s %s%s\n", name, text, unit);
}

static void print_index(const char *name, Measured figure, GlareNone none, Arena scratch) {
    if (isnan(figure.value)) print("%-12s none: %s\n", name, discomfort_none_words(none));
    else print_figure(name, figure, "", scratch);
}

static void print_sources(const FrameGlare *g) {
    print("%-12s %d brighter than %.6g cd/m2\n", "sources", g->source_count, g->threshold_cd_m2);
    for (int i = 0; i < g->source_count && i < SOURCES_TOLD; i++) {
        const FrameSource *s = &g->sources[i];
        print("  %.4g cd/m2, %.3g sr, position index %.3g, at %.1f deg right, %.1f deg up, "
              "%.4g lx (%ld pixels about %.0f,%.0f)\n",
              s->source.luminance_cd_m2, s->source.solid_angle_sr, s->source.position_index,
              s->right_deg, s->up_deg, s->lx, s->pixels, s->x, s->y);
    }
    if (g->source_count > SOURCES_TOLD) print("  and %d more\n", g->source_count - SOURCES_TOLD);
}

static long count_small(const FrameGlare *g) {
    long count = 0;
    for (int i = 0; i < g->source_count; i++) count += !g->sources[i].has_core;
    return count;
}

static void print_doubts(const FrameGlare *g) {
    long small = count_small(g);
    if (small)
        print("%-12s %ld sources are too small for the frame: their pixels show their "
              "surroundings, too, and dim them; a larger frame tells\n",
              "size", small);
    if (g->doubtful)
        print("%-12s %ld areas are above the threshold by noise alone, as two halves of the "
              "samples tell: not counted\n",
              "noise", g->doubtful);
    if (!g->has_noise)
        print("%-12s not looked for, without layers of it (--layers halves,variance): "
              "bright pixels of few samples count as sources\n",
              "noise");
    if (!g->has_intervals)
        print("%-12s missing: no layers halves or variance (--layers halves,variance)\n",
              "intervals");
}

static void print_text(const FrameGlare *g, const GlareWords *words, Arena scratch) {
    print_figure("at the eye", g->vertical_lx, words->request.has_lux ? " lx, as given" : " lx",
                 scratch);
    print_figure("background", g->background_cd_m2, " cd/m2", scratch);
    print_index("UGR", g->ugr, g->none, scratch);
    print_index("DGP", g->dgp, g->none, scratch);
    print("%-12s its factor for less than 1000 lx is %s\n", "",
          words->request.settings.low_light ? "in it (--no-low-light)" : "left out");
    print_index("DGI", g->dgi, g->none, scratch);
    print_sources(g);
    print_doubts(g);
}

/* ---- as JSON ----------------------------------------------------------------------------- */

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

static bool print_json(const char *name, const FrameGlare *g, const GlareWords *words, Error *err) {
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
    return cli_print_json(out, err);
}

bool measure_glare(const Cli *cli, const FrameImage *frame, const GlareWords *words, Arena *arena,
                   Error *err) {
    const char *name = cli->arguments[0];
    FrameGlare glare;
    if (!frame_glare_measure(frame, &words->request, arena, &glare, err))
        return error_in_file(err, name);
    if (cli->json) return print_json(name, &glare, words, err);
    print_text(&glare, words, *arena);
    return true;
}
