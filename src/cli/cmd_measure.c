/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion measure: figures of a part of a frame, or the illuminance at points of a scene,
 * with their 95 % intervals. */
#include <math.h>
#include <stdio.h>

#include "base/count.h"
#include "print/print.h"
#include "cli/commands.h"
#include "cli/luxmeter.h"
#include "cli/measure_glare.h"
#include "cli/options/answer.h"
#include "image/light/light_file.h"
#include "measure/light_shares.h"
#include "text/interval_text.h"
#include "text/json_text.h"

/* ---- the command line -------------------------------------------------------------------- */

typedef struct MeasureWords {
    MeasureRequest request;
    LuxmeterRequest luxmeter;
    GlareWords glare;
    SceneWords scene; /* of the luxmeter */
    bool has_samples;
    Cli cli;
} MeasureWords;

static bool read_frame_request(const double region[4], MeasureWords *out, Error *err) {
    MeasureRequest *r = &out->request;
    const char *of_scene = scene_options_given(&out->scene, &out->luxmeter.environment);
    if (of_scene)
        return error_set(err, ERROR_USAGE,
                         "%s changes the light of a scene, which is measured "
                         "with --illuminance; a frame has its light",
                         of_scene);
    const char *of_points = out->luxmeter.wants_csv    ? "--csv"
                            : out->has_samples         ? "--samples"
                            : out->luxmeter.scene.root ? "--root"
                                                       : NULL;
    if (of_points)
        return error_set(err, ERROR_USAGE,
                         "%s goes with --illuminance: a frame has been "
                         "rendered",
                         of_points);
    if (out->cli.argument_count > 1)
        return error_set(err, ERROR_USAGE, "%s: one frame at a time is measured",
                         out->cli.arguments[1]);
    for (int i = 0; i < 4 && r->has_region; i++)
        if (region[i] != floor(region[i]))
            return error_set(err, ERROR_USAGE, "--region: %g is no whole number of pixels",
                             region[i]);
    if (r->has_region)
        r->region = (ExrWindow){(int)region[0], (int)region[1], (int)region[2], (int)region[3]};
    r->frame_name = out->cli.arguments[0];
    return true;
}

static bool read_luxmeter(MeasureWords *out, Arena *arena, Error *err) {
    const MeasureRequest *r = &out->request;
    if (r->has_region || r->display)
        return error_set(err, ERROR_USAGE, "%s is of a frame, --illuminance of a scene",
                         r->display ? "--display" : "--region");
    return scene_options_read(&out->scene, &out->cli, arena, &out->luxmeter.scene, err);
}

static bool parse(int argc, char **argv, Arena *arena, MeasureWords *out, Error *err) {
    MeasureRequest *r = &out->request;
    double region[4] = {0};
    const Option options[] = {
        {"--region", OPTION_NUMBERS, "X0,Y0,X1,Y1",
         "pixels, half-open, the origin at the top left (default: all)", .out = region,
         .low = -65536, .high = 65536, .count = 4, .given = &r->has_region},
        {"--display", OPTION_TEXT, "NAME",
         "what this display sends (its material's name); pixels at its rim count by their part",
         .out = &r->display},
        {"--illuminance", OPTION_TEXTS, "X,Y,Z,NX,NY,NZ|FILE.csv",
         "of a scene: lx at a point (m) on a plane that faces N; a file has such a row a line, "
         "with blanks or commas",
         .out = &out->luxmeter.places},
        {"--csv", OPTION_FLAG, NULL, "illuminances as comma-separated rows",
         .out = &out->luxmeter.wants_csv},
        {"--samples", OPTION_INTEGER, "N", "paths for --illuminance (default 262144)",
         .out = &out->luxmeter.samples, .low = 2, .high = 1 << 30, .given = &out->has_samples},
        GLARE_OPTIONS(&out->glare),
        SCENE_OPTIONS(&out->scene, &out->luxmeter.scene, &out->luxmeter.environment),
    };
    const CliCommand command = {
        "measure",
        command_measure.summary,
        "FRAME.exr|.hdr [--region X0,Y0,X1,Y1] [--display NAME] | FRAME.exr|.hdr --glare | "
        "SCENE... --illuminance ...",
        "parhelion measure frame.exr --display cluster --json",
        options,
        COUNT_OF(options),
        1,
        -1};
    if (!cli_parse(&command, argc, argv, arena, &out->cli, err)) return false;
    if (out->cli.help_shown) return true;
    if (!glare_words_check(&out->glare, err)) return false;
    if (out->glare.given && (out->luxmeter.places.count || r->has_region || r->display))
        return error_set(err, ERROR_USAGE, "--glare is of all that an eye sees: leave out %s",
                         out->luxmeter.places.count ? "--illuminance"
                         : r->display               ? "--display"
                                                    : "--region");
    return out->luxmeter.places.count ? read_luxmeter(out, arena, err)
                                      : read_frame_request(region, out, err);
}

/* ---- as text ----------------------------------------------------------------------------- */

#define INTERVAL_BYTES 4096 /* of its words */

static void print_figure(const char *name, Measured figure, const char *unit) {
    if (isnan(figure.value)) {
        print("%-12s undefined: there is no light\n", name);
        return;
    }
    if (isnan(figure.low)) {
        print("%-12s %.6g%s\n", name, figure.value, unit);
        return;
    }
    Arena scratch = arena_reserve(INTERVAL_BYTES);
    print("%-12s %s%s\n", name, interval_text(figure.value, figure.low, figure.high, &scratch),
          unit);
    arena_release(&scratch);
}

/* Why there is no contrast of the content. */
static const char *content_reason(ContentVerdict verdict) {
    switch (verdict) {
    case CONTENT_FOUND: break;
    case CONTENT_TOO_SMALL: return "fewer than 16 pixels, or all alike";
    case CONTENT_NOT_TWO: return "no two luminances stand out";
    case CONTENT_NOISY: return "no two luminances stand out from the noise";
    }
    return NULL;
}

static void print_content(const ContentContrast *c) {
    const char *reason = content_reason(c->verdict);
    if (reason) {
        print("%-12s missing: %s\n", "content", reason);
        return;
    }
    print_figure("content", c->ratio, " : 1");
    print_figure("  characters", c->characters, " cd/m2");
    print_figure("  ground", c->ground, " cd/m2");
    print_figure("  Michelson", c->michelson, "");
    print_figure("  Weber", c->weber, "");
    if (!c->edges_left_out)
        print("  strokes are too thin to leave their edges out: the contrast is at least "
              "this\n");
}

/* Of frames with the layer. */
static void print_extrapolated(const FrameMeasurement *m) {
    if (isnan(m->extrapolated_reflected)) return;
    print("  %.1f %% of the light that it reflects", 100 * m->extrapolated_reflected);
    if (!isnan(m->extrapolated_shown))
        print(" and %.1f %% of what it emits", 100 * m->extrapolated_shown);
    print(" by directions that were not measured\n");
}

static void print_display(const FrameMeasurement *m) {
    print("  white %.6g, black %.6g, reflected %.6g cd/m2", m->white, m->black, m->reflected);
    if (!isnan(m->mirror)) print(": %.6g by the mirror", m->mirror);
    if (!isnan(m->lambertian)) print(", %.6g lambertian", m->lambertian);
    print("\n");
    print_extrapolated(m);
    if (!isnan(m->shown)) print("  shown %.6g cd/m2\n", m->shown);
}

/* How a display's rim counts. */
static void print_rim(const FrameMeasurement *m) {
    switch (m->rim) {
    case RIM_BY_COVERAGE:
        print("%-12s %ld of them, by their part: %.6g pixels in all\n", "  at the rim",
              m->rim_pixels, m->area);
        break;
    case RIM_LEFT_OUT:
        print("%-12s %ld more are left out: their part is not known (--layers display)\n",
              "  at the rim", m->rim_pixels);
        break;
    case RIM_WHOLE:
        print("%-12s whole, with what is around: their part is not known (--layers "
              "display)\n",
              "  at the rim");
    }
    if (m->shared_pixels)
        print("%-12s %ld show two displays: they have no part in the contrast\n", "",
              m->shared_pixels);
    if (m->unknown_pixels)
        print("%-12s %ld show more displays, and are left out\n", "", m->unknown_pixels);
}

static void print_text(const FrameMeasurement *m, bool is_display) {
    print("%-12s %ld\n", "pixels", m->pixels);
    if (is_display) print_rim(m);
    if (m->nonfinite) print("%-12s %ld\n", "left out", m->nonfinite);
    print_figure("luminance", m->luminance, " cd/m2");
    print("%-12s %.6g to %.6g cd/m2\n", "  of pixels", m->least, m->greatest);
    print_figure("x", m->x, "");
    print_figure("y", m->y, "");
    print_figure("u'", m->u, "");
    print_figure("v'", m->v, "");
    if (m->has_contrast) {
        print_figure("contrast", m->contrast, " : 1");
        print_display(m);
    } else {
        print("%-12s missing: no pixel of a display, or no layers of it (--layers display)\n",
              "contrast");
    }
    if (m->has_content) print_content(&m->content);
    if (!m->has_variance)
        print("%-12s missing: no layer variance (--layers variance)\n", "intervals");
}

/* What render found out about the frame. */
static void print_missed(const FrameImage *frame) {
    const char *missed = frame_string(frame, "parhelion:mayMiss");
    const ExrAttribute *rare = frame_attribute(frame, "parhelion:rareError");
    char error[32];
    if (missed) print("%-12s light: %s\n", "may miss", missed);
    if (rare)
        print("%-12s " RARE_WORDS "\n", "of the frame",
              cli_relative_error(rare->values[0], error, sizeof error));
}

static void print_lights(const LightShares *lights, bool is_display) {
    if (lights->count && is_display && !lights->pixels) {
        print("%-12s missing: no pixel shows the display alone\n", "by light");
        return;
    }
    for (int i = 0; i < lights->count; i++)
        print("%-12s %.6g cd/m2 (%.1f %%) of %s\n", i ? "" : "by light", lights->list[i].cd_m2,
              100 * lights->list[i].share, lights->list[i].name);
}

/* ---- as JSON ----------------------------------------------------------------------------- */

/* One without an upper end: of a contrast where nothing may be reflected on black. */
static json_t *interval(Measured figure) {
    if (!isfinite(figure.low) || !isfinite(figure.value)) return json_null();
    return json_pack("[o,o]", json_figure(figure.low), json_figure(figure.high));
}

static void set_pair(json_t *answer, const char *key, json_t *first, json_t *second) {
    json_object_set_new(answer, key, json_pack("[o,o]", first, second));
}

static void set_display(json_t *answer, const char *display, const FrameMeasurement *m) {
    static const char *const RIMS[] = {
        [RIM_BY_COVERAGE] = "by coverage", [RIM_LEFT_OUT] = "left out", [RIM_WHOLE] = "whole"};
    json_object_set_new(answer, "display", json_text(display));
    json_object_set_new(answer, "rim", json_string(RIMS[m->rim]));
    json_object_set_new(answer, "area_pixels", json_figure(m->area));
    json_object_set_new(answer, "rim_pixels", json_integer(m->rim_pixels));
    json_object_set_new(answer, "shared_pixels", json_integer(m->shared_pixels));
    json_object_set_new(answer, "unknown_pixels", json_integer(m->unknown_pixels));
}

static json_t *missing(const FrameMeasurement *m) {
    json_t *list = json_array();
    if (!m->has_variance) json_array_append_new(list, json_string("variance"));
    if (!m->has_contrast) json_array_append_new(list, json_string("display"));
    return list;
}

static void set_figure(json_t *object, const char *key, const char *interval_key, Measured figure) {
    json_object_set_new(object, key, json_figure(figure.value));
    json_object_set_new(object, interval_key, interval(figure));
}

static json_t *json_contrast(const FrameMeasurement *m) {
    if (!m->has_contrast) return json_null();
    json_t *out =
        json_pack("{s:o, s:o, s:o, s:o, s:o, s:I}", "value", json_figure(m->contrast.value),
                  "interval", interval(m->contrast), "white_cd_m2", json_figure(m->white),
                  "black_cd_m2", json_figure(m->black), "reflected_cd_m2",
                  json_figure(m->reflected), "pixels", (json_int_t)m->display_pixels);
    json_object_set_new(out, "mirror_cd_m2", json_figure(m->mirror));
    json_object_set_new(out, "scattered_cd_m2", json_figure(m->reflected - m->mirror));
    json_object_set_new(out, "haze_cd_m2", json_figure(m->reflected - m->mirror - m->lambertian));
    json_object_set_new(out, "lambertian_cd_m2", json_figure(m->lambertian));
    if (!isnan(m->extrapolated_reflected))
        json_object_set_new(out, "extrapolated_share", json_real(m->extrapolated_reflected));
    if (!isnan(m->extrapolated_shown))
        json_object_set_new(out, "extrapolated_emitted_share", json_real(m->extrapolated_shown));
    if (!isnan(m->shown)) json_object_set_new(out, "shown_cd_m2", json_figure(m->shown));
    return out;
}

static json_t *json_content(const ContentContrast *c) {
    const char *reason = content_reason(c->verdict);
    json_t *out =
        json_pack("{s:s?, s:o, s:o}", "missing", reason, "separability",
                  json_figure(c->separability), "noise_sigmas", json_figure(c->noise_sigmas));
    if (reason) return out;
    set_figure(out, "ratio", "ratio_interval", c->ratio);
    set_figure(out, "michelson", "michelson_interval", c->michelson);
    set_figure(out, "weber", "weber_interval", c->weber);
    set_figure(out, "characters_cd_m2", "characters_interval", c->characters);
    set_figure(out, "ground_cd_m2", "ground_interval", c->ground);
    json_object_set_new(out, "character_pixels", json_integer(c->character_pixels));
    json_object_set_new(out, "ground_pixels", json_integer(c->ground_pixels));
    json_object_set_new(out, "edges_left_out", json_boolean(c->edges_left_out));
    return out;
}

static json_t *json_lights(const LightShares *lights) {
    json_t *out = json_array();
    for (int i = 0; i < lights->count; i++) {
        const LightShare *light = &lights->list[i];
        json_array_append_new(out, json_pack("{s:o, s:o, s:o, s:o}", "name", json_text(light->name),
                                             "layer", json_text(light->layer), "cd_m2",
                                             json_figure(light->cd_m2), "share",
                                             json_figure(light->share)));
    }
    return out;
}

static bool print_json(const MeasureWords *typed, const FrameImage *frame,
                       const FrameMeasurement *m, const LightShares *lights, Error *err) {
    const MeasureRequest *r = &typed->request;
    json_t *answer =
        json_pack("{s:o, s:I, s:I, s:[o,o,o], s:o, s:o, s:o, s:o}", "frame",
                  json_text(r->frame_name), "pixels", (json_int_t)m->pixels, "nonfinite_pixels",
                  (json_int_t)m->nonfinite, "XYZ", json_figure(m->xyz[0]), json_figure(m->xyz[1]),
                  json_figure(m->xyz[2]), "luminance_cd_m2", json_figure(m->luminance.value),
                  "luminance_interval", interval(m->luminance), "luminance_min_cd_m2",
                  json_figure(m->least), "luminance_max_cd_m2", json_figure(m->greatest));
    set_pair(answer, "xy", json_figure(m->x.value), json_figure(m->y.value));
    set_pair(answer, "xy_interval", interval(m->x), interval(m->y));
    set_pair(answer, "uv", json_figure(m->u.value), json_figure(m->v.value));
    set_pair(answer, "uv_interval", interval(m->u), interval(m->v));
    json_object_set_new(answer, "contrast", json_contrast(m));
    if (m->has_content) json_object_set_new(answer, "content", json_content(&m->content));
    if (lights->count && lights->pixels) {
        json_object_set_new(answer, "lights", json_lights(lights));
        json_object_set_new(answer, "lights_pixels", json_integer(lights->pixels));
    }
    const ExrAttribute *rare = frame_attribute(frame, "parhelion:rareError");
    json_object_set_new(answer, "rare_error", rare ? json_real(rare->values[0]) : json_null());
    json_object_set_new(answer, "may_miss",
                        json_text_or_null(frame_string(frame, "parhelion:mayMiss")));
    json_object_set_new(answer, "missing_layers", missing(m));
    if (r->display) set_display(answer, r->display, m);
    if (r->has_region)
        json_object_set_new(
            answer, "region",
            json_pack("[i,i,i,i]", r->region.x0, r->region.y0, r->region.x1, r->region.y1));
    return cli_print_json(answer, err);
}

/* ---- the command ------------------------------------------------------------------------- */

static bool measure(const MeasureWords *typed, Arena *arena, Error *err) {
    LightFile file;
    FrameMeasurement measured;
    Problems problems = problems_start(arena);
    if (typed->luxmeter.places.count)
        return luxmeter_run(&typed->cli, &typed->luxmeter, arena, err);
    const char *name = typed->request.frame_name;
    if (!light_file_read(name, arena, &problems, &file, err)) return false;
    cli_print_warnings(&problems);
    if (typed->glare.given)
        return measure_glare(&typed->cli, &file.frame, &typed->glare, arena, err);
    if (!measure_frame(&file.frame, &typed->request, *arena, &measured, err)) return false;
    LightShares lights =
        light_shares_measure(&file.frame, &typed->request, measured.luminance.value, arena);
    if (typed->cli.json) return print_json(typed, &file.frame, &measured, &lights, err);
    print_text(&measured, typed->request.display != NULL);
    print_lights(&lights, typed->request.display != NULL);
    print_missed(&file.frame);
    return true;
}

static Outcome run_measure(int argc, char **argv, Arena *arena, Error *err) {
    MeasureWords typed = {.luxmeter = {.samples = 1 << 18}, .glare = GLARE_WORDS_DEFAULT};
    return outcome_of(parse(argc, argv, arena, &typed, err) &&
                      (typed.cli.help_shown || measure(&typed, arena, err)));
}

const Command command_measure = {
    "measure", "luminance, colour and contrast of a part of a frame, with 95 % intervals",
    run_measure};
