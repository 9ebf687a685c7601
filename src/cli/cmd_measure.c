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

/* ---- what people read -------------------------------------------------------------------- */

static const Column LIGHTS[] = {
    COLUMN_TEXT("name", "light"), COLUMN_DIGITS("cd_m2", "luminance", "cd/m2", 6),
    COLUMN_SHARE("share", "share"), COLUMN_KEY("layer", "of the frame")};
static const TableKind LIGHTS_KIND = TABLE_KIND("lights", NULL, LIGHTS);

static const Column FIGURES[] = {
    COLUMN_TEXT("pixels", "pixels"),
    {.key = "rim",
     .words = "pixels at the rim",
     .about = "how they count: `by coverage`; of frames without the layers of displays `left out`, "
              "or `whole`, with what is around"},
    {.key = "area_pixels", .words = "pixels by their part", .about = "the parts added up"},
    COLUMN_TEXT("rim_pixels", "at the rim"),
    {.key = "shared_pixels", .words = "of two displays, not in the contrast", .hides_zero = true},
    {.key = "unknown_pixels", .words = "of more displays, left out", .hides_zero = true},
    {.key = "nonfinite_pixels", .words = "not finite, left out", .hides_zero = true},
    {.key = "luminance_cd_m2",
     .words = "luminance",
     .unit = "cd/m2",
     .interval = "luminance_interval"},
    COLUMN_DIGITS("luminance_min_cd_m2", "least pixel", "cd/m2", 0),
    COLUMN_DIGITS("luminance_max_cd_m2", "greatest pixel", "cd/m2", 0),
    {.key = "xy.0",
     .words = "x",
     .interval = "xy_interval.0",
     .none = "undefined: there is no light"},
    COLUMN_MEASURED("xy.1", "y", NULL, "xy_interval.1"),
    COLUMN_MEASURED("uv.0", "u'", NULL, "uv_interval.0"),
    COLUMN_MEASURED("uv.1", "v'", NULL, "uv_interval.1"),
    {.key = "contrast.value",
     .words = "contrast",
     .unit = ": 1",
     .interval = "contrast.interval",
     .none = "missing: no pixel of a display, or no layers of it (--layers display)"},
    COLUMN_DIGITS("contrast.white_cd_m2", "white", "cd/m2", 0),
    COLUMN_DIGITS("contrast.black_cd_m2", "black", "cd/m2", 0),
    COLUMN_DIGITS("contrast.reflected_cd_m2", "reflected", "cd/m2", 0),
    COLUMN_DIGITS("contrast.mirror_cd_m2", "by the mirror", "cd/m2", 0),
    COLUMN_DIGITS("contrast.haze_cd_m2", "by haze", "cd/m2", 0),
    COLUMN_DIGITS("contrast.lambertian_cd_m2", "lambertian", "cd/m2", 0),
    COLUMN_DIGITS("contrast.shown_cd_m2", "shown", "cd/m2", 0),
    {.key = "contrast.extrapolated_share",
     .words = "reflected, by extrapolation",
     .unit = "%",
     .places = 3,
     .times = 100,
     .hides_zero = true},
    {.key = "contrast.extrapolated_emitted_share",
     .words = "emitted, by extrapolation",
     .unit = "%",
     .places = 3,
     .times = 100,
     .hides_zero = true},
    COLUMN_TEXT("content.missing", "no contrast of content"),
    COLUMN_MEASURED("content.ratio", "content, contrast", ": 1", "content.ratio_interval"),
    COLUMN_MEASURED("content.characters_cd_m2", "characters", "cd/m2",
                    "content.characters_interval"),
    COLUMN_MEASURED("content.ground_cd_m2", "ground", "cd/m2", "content.ground_interval"),
    COLUMN_MEASURED("content.michelson", "Michelson", NULL, "content.michelson_interval"),
    COLUMN_MEASURED("content.weber", "Weber", NULL, "content.weber_interval"),
    {.key = "content.edges_left_out",
     .words = "edges of strokes left out",
     .about = "false: strokes are too thin, and the contrast is at least this"},
    {.key = "may_miss", .words = "may miss light", .about = "`parhelion:mayMiss` of the frame"},
    {.key = "rare_error",
     .words = "rare light, error at most",
     .unit = "%",
     .places = 3,
     .times = 100,
     .hides_zero = true},
    COLUMN_TEXT("missing_layers", "missing (render --layers)"),
    {.key = "lights", .of = &LIGHTS_KIND},
    COLUMN_KEY("lights_pixels", "pixels that those luminances, which add up to `luminance_cd_m2`, "
                                "are shared out by; of a display those that show it alone"),
    COLUMN_KEY("frame", "the file"),
    COLUMN_KEY("display", "as requested, as `region`; else absent"),
    COLUMN_KEY("region", "X0, Y0, X1, Y1"),
    COLUMN_KEY("XYZ", "CIE 1931, Y in cd/m2"),
    COLUMN_KEY("contrast", "of the means over the display's parts: `value` = (white + reflected) / "
                           "(black + reflected); an interval's upper end of null: there is none, "
                           "since black with nothing reflected lies within the noise"),
    COLUMN_KEY("contrast.scattered_cd_m2", "haze and lambertian; null: not in the frame"),
    COLUMN_KEY("contrast.pixels", NULL),
    COLUMN_KEY(
        "content",
        "of a region or a display: what is shown there, split in two luminances, "
        "`characters_cd_m2` the smaller part; `ratio` brighter by darker, `weber` characters "
        "less ground, by ground"),
    COLUMN_KEY("content.separability",
               "the share of the variance, less the noise's, that the split "
               "explains"),
    COLUMN_KEY("content.noise_sigmas", "the distance of the two in standard errors of a pixel"),
    COLUMN_KEY("content.character_pixels", NULL),
    COLUMN_KEY("content.ground_pixels", NULL),
};
static const TableKind FIGURES_KIND = TABLE_KIND("measure", NULL, FIGURES);

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
        -1,
        .answers = (const Answer[]){{"", &FIGURES_KIND},
                                    {"--glare", &measure_glare_kind},
                                    {"--illuminance", &luxmeter_kind},
                                    {0}}};
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

/* ---- the answer --------------------------------------------------------------------------- */

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

static bool print_answer(const MeasureWords *typed, const FrameImage *frame,
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
    return cli_print_answer(&FIGURES_KIND, answer, typed->cli.json, err);
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
    return print_answer(typed, &file.frame, &measured, &lights, err);
}

static Outcome run_measure(int argc, char **argv, Arena *arena, Error *err) {
    MeasureWords typed = {.luxmeter = {.samples = 1 << 18}, .glare = GLARE_WORDS_DEFAULT};
    return outcome_of(parse(argc, argv, arena, &typed, err) &&
                      (typed.cli.help_shown || measure(&typed, arena, err)));
}

const Command command_measure = {
    "measure", "luminance, colour and contrast of a part of a frame, with 95 % intervals",
    run_measure};
