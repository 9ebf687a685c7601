/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion develop: from a frame to a picture that people look at. */
#include <stdio.h>

#include "base/count.h"
#include "print/print.h"
#include "cli/commands.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/look_options.h"
#include "image/develop.h"
#include "image/light/light_file.h"
#include "image/exposure.h"
#include "text/json_text.h"
#include "text/removed.h"

typedef struct DevelopWords {
    const char *frame, *output;
    DevelopOptions options;
    EyeOption eye;
    Cli cli;
} DevelopWords;

static bool parse(int argc, char **argv, Arena *arena, DevelopWords *out, Error *err) {
    DevelopOptions *o = &out->options;
    int kind = -1;
    long bits = 8;
    const Option options[] = {
        {"-o", OPTION_TEXT, "FILE", "the picture: .png, .jpg or .tif", .out = &out->output,
         .file = OPTION_OUTPUT},
        LOOK_OPTIONS(o),
        EYE_OPTIONS(&out->eye),
        {"--false-colour", OPTION_CHOICE, "luminance", "luminance as colours, with the scale",
         .out = &kind},
        {"--range", OPTION_NUMBERS, "LOW,HIGH",
         "ends of the scale of false colours, to compare frames (default: what fits)",
         .out = o->range, .count = 2},
        {"--layer", OPTION_TEXT, "NAME",
         "another layer or channel: normal, depth.Z, display.emitted, display.contrast",
         .out = &o->layer},
        {"--bits", OPTION_INTEGER, "8|16", "of a PNG or TIFF (default 8)", .out = &bits, .low = 8,
         .high = 16},
    };
    const CliCommand command = {
        "develop",
        command_develop.summary,
        "FRAME.exr -o FRAME.png",
        "parhelion develop frame.exr -o frame.png --view \"ACES SDR\" --exposure 12",
        options,
        COUNT_OF(options),
        1,
        1};
    if (!cli_parse(&command, argc, argv, arena, &out->cli, err)) return false;
    if (out->cli.help_shown) return true;
    out->frame = out->cli.arguments[0];
    o->frame_name = out->frame;
    o->false_colour = kind == 0;
    o->bits = (int)bits;
    if (!out->output) return error_set(err, ERROR_USAGE, "no output is named — add -o FRAME.png");
    const char *instead = o->layer ? removed_instead("--layer", o->layer) : NULL;
    if (instead)
        return error_set(err, ERROR_USAGE, "--layer %s was removed: %s", o->layer, instead);
    ExposureRequest unused;
    return picture_check_name(out->output, o->bits, err) && eye_option_check(&out->eye, err) &&
           (!o->exposure || exposure_parse(o->exposure, &unused, err));
}

static bool print_json(const DevelopWords *typed, const LookReport *look, Error *err) {
    const DevelopReport *r = &look->develop;
    json_t *answer =
        json_pack("{s:o, s:[i,i], s:I}", "output", json_text(typed->output), "size", r->width,
                  r->height, "nonfinite_pixels", (json_int_t)r->nonfinite_pixels);
    if (r->is_developed) {
        json_object_set_new(answer, "config", json_text(r->config));
        json_object_set_new(answer, "display", json_text(r->display));
        json_object_set_new(answer, "view", json_text(r->view));
        json_object_set_new(answer, "exposure_ev", json_real(r->ev));
        json_object_set_new(answer, "middle_grey_cd_m2", json_real(r->grey_cd_m2));
    } else if (r->scale[0]) {
        json_object_set_new(answer, "scale", json_text(r->scale));
    }
    look_options_json(look, answer);
    return cli_print_json(answer, err);
}

static void print_text(const DevelopWords *typed, const LookReport *look, Arena scratch) {
    const DevelopReport *r = &look->develop;
    if (r->is_developed)
        print("%s: %s, %s, middle grey %.4g cd/m2 (EV %.2f), %s%s\n", typed->output, r->display,
              r->view, r->grey_cd_m2, r->ev, r->config, look_options_words(look, &scratch));
    else
        print("%s%s%s%s\n", typed->output, r->scale[0] ? ": " : "", r->scale,
              look_options_words(look, &scratch));
}

static bool develop(DevelopWords *typed, Arena *arena, Error *err) {
    LightFile file;
    LookReport look;
    Problems problems = problems_start(arena);
    if (!light_file_read(typed->frame, arena, &problems, &file, err)) return false;
    cli_print_warnings(&problems);
    const LookRequest request = {&file.frame, &typed->options, typed->output, typed->cli.threads,
                                 &typed->eye};
    if (!look_options_develop(&request, *arena, &look, err)) return false;
    if (look.develop.is_developed && look.develop.nonfinite_pixels > 0)
        print_to(stderr,
                 "parhelion: warning: %s: %ld pixels are not finite: NaN is shown black, "
                 "infinity white\n",
                 typed->frame, look.develop.nonfinite_pixels);
    if (typed->cli.json) return print_json(typed, &look, err);
    print_text(typed, &look, *arena);
    return true;
}

static Outcome run_develop(int argc, char **argv, Arena *arena, Error *err) {
    DevelopWords typed = {0};
    return outcome_of(parse(argc, argv, arena, &typed, err) &&
                      (typed.cli.help_shown || develop(&typed, arena, err)));
}

const Command command_develop = {"develop", "make a picture of a frame", run_develop};
