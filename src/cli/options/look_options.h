/* SPDX-License-Identifier: Apache-2.0 */
/* look_options.h -- the options for how a frame becomes a picture, for the commands that
 * develop one.
 *
 * The rows only name where the words go; develop.h defines and checks them. What they request
 * is done here, since a frame is denoised, and seen by an eye (--eye: as it arrives on the
 * retina, vision/eye_filter.h), before it is developed.
 *
 * Memory   the filtered frame's planes come from the arena.
 * Threads  one at a time; the filters have their own.
 * Fails    for a word that is no eye, a frame without R, G, B, and one whose field of view is
 *          not known: its metadata have it (parhelion:yfov_deg), else --fov has it.
 */
#pragma once
#include <jansson.h>

#include "cli/options/cli.h"
#include "denoise/denoise.h"
#include "image/develop.h"
#include "vision/human_eye.h"

/* Rows of an option table; `look` is a DevelopOptions *. */
#define LOOK_OPTIONS(look) \
    {"--exposure", OPTION_TEXT, "auto|EV|white:CD_M2", \
     "auto (default: the cabin looks well), an exposure value at ISO 100 (15: full sun; " \
     "one more is half as bright), or the luminance that becomes white, by the view " \
     "untonemapped unless --view names one: others show it as light grey", \
     .out = &(look)->exposure}, \
        {"--display", OPTION_TEXT, "NAME", "sRGB (default), Display P3, Rec.1886", \
         .out = &(look)->display}, \
        {"--view", OPTION_TEXT, "NAME", "photographic (default), ACES SDR, untonemapped, raw", \
         .out = &(look)->view}, \
        {"--config", OPTION_TEXT, "FILE", \
         "OpenColorIO configuration; else $OCIO, else the program's own", .out = &(look)->config}, \
        {"--adapt", OPTION_CHOICE, "auto|none|local", \
         "local: keeps a dark cabin and a bright street in one picture; auto (default): where " \
         "the street would burn out and --exposure is auto", \
         .out = &(look)->adapt}, \
    { \
        "--denoise", OPTION_FLAG, NULL, \
            "filters the noise of few samples away: a preview, not for figures", \
            .out = &(look)->is_denoised \
    }

typedef struct EyeOption {
    const char *words; /* of --eye; NULL: not requested */
    double fov_deg;    /* of --fov: the display window's height as an angle; 0: not given */
    HumanEye eye;      /* by eye_option_check */
} EyeOption;

/* Rows of an option table; `option` is an EyeOption *. */
#define EYE_OPTIONS(option) \
    {"--eye", OPTION_TEXT, "AGE[,PIGMENT]", \
     "light spread as in the eye of somebody so old, iris 0 (dark) to 1.2 (light blue; " \
     "default 0.5, brown), by the CIE's point spread", \
     .out = &(option)->words}, \
        {"--fov", \
         OPTION_NUMBER, \
         "DEG", \
         "with --eye, of a frame that does not say it: the picture's height as an angle", \
         .out = &(option)->fov_deg, \
         .low = 0.01, \
         .high = 170}

/* The report on a picture, with develop.h's. */
typedef struct LookReport {
    DevelopReport develop;
    DenoiseReport denoise; /* when develop.is_denoised */
    HumanEye eye;          /* when develop.eye is not "" */
} LookReport;

typedef struct LookRequest {
    const FrameImage *frame;
    const DevelopOptions *look;
    const char *path;
    int threads;
    const EyeOption *eye; /* NULL: the command has no such option */
} LookRequest;

/* Before anything is read. */
bool eye_option_check(EyeOption *option, Error *err);

/* develop_frame, of the denoised frame if that is requested, as an eye sees it if that is. */
bool look_options_develop(const LookRequest *request, Arena scratch, LookReport *report,
                          Error *err);

/* How the picture `output` came out, but for the eye, and its columns. */
json_t *look_options_json(const char *output, const LookReport *report);
#define LOOK_COLUMNS \
    COLUMN_TEXT("output", "picture"), COLUMN_TEXT("size", "pixels"), \
        {.key = "nonfinite_pixels", .words = "not finite", .hides_zero = true}, \
        {.key = "scale", .words = "scale", .about = "of numbers; of light the next five"}, \
        COLUMN_TEXT("display", "display"), COLUMN_TEXT("view", "view"), \
        COLUMN_DIGITS("middle_grey_cd_m2", "middle grey", "cd/m2", 4), \
        COLUMN_FIXED("exposure_ev", "EV", NULL, 2), \
        {.key = "denoised.energy_ratio", \
         .words = "denoised, of the light", \
         .unit = "%", \
         .places = 4, \
         .times = 100, \
         .hides_zero = true, \
         .about = "`denoised` is null without the filter"}, \
        COLUMN_KEY("denoised.block_error", NULL), COLUMN_KEY("denoised.left_share", NULL), \
        {.key = "adapt", .words = "adapted", .hides_zero = true, .about = "`local`; null: not"}, \
        COLUMN_TEXT("config", "configuration")
