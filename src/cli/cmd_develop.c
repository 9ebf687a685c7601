/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion develop: from a frame to a picture that people look at. */
#include "base/count.h"
#include "print/print.h"
#include "cli/commands.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/look_options.h"
#include "image/develop.h"
#include "image/light/light_file.h"
#include "image/exposure.h"
#include "text/removed.h"

typedef struct DevelopWords {
    const char *frame, *output;
    DevelopOptions options;
    EyeOption eye;
    Cli cli;
} DevelopWords;

static const Column DEVELOPED[] = {
    LOOK_COLUMNS,
    {.key = "eye.words", .words = "eye", .about = "`eye` is null without one"},
    COLUMN_KEY("eye.age_years", NULL),
    COLUMN_KEY("eye.pigment", NULL),
};
static const TableKind DEVELOPED_KIND = TABLE_KIND("develop", NULL, DEVELOPED);

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
        1,
        .answers = (const Answer[]){{"", &DEVELOPED_KIND}, {0}}};
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

static json_t *answer_of(const char *output, const LookReport *look) {
    json_t *answer = look_options_json(output, look), *eye = json_null();
    if (look->develop.eye[0])
        eye = json_pack("{s:f, s:f, s:s}", "age_years", look->eye.age_years, "pigment",
                        look->eye.pigment, "words", look->develop.eye);
    json_object_set_new(answer, "eye", eye);
    return answer;
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
    return cli_print_answer(&DEVELOPED_KIND, answer_of(typed->output, &look), typed->cli.json, err);
}

static Outcome run_develop(int argc, char **argv, Arena *arena, Error *err) {
    DevelopWords typed = {0};
    return outcome_of(parse(argc, argv, arena, &typed, err) &&
                      (typed.cli.help_shown || develop(&typed, arena, err)));
}

const Command command_develop = {"develop", "make a picture of a frame", run_develop};
