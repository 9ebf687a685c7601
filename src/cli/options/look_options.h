/* SPDX-License-Identifier: Apache-2.0 */
/* look_options.h -- the options for how a frame becomes a picture, for the commands that
 * develop one.
 *
 * The rows only name where the words go; develop.h defines and checks them. What
 * they ask for is done here, since a frame is denoised, and seen by an eye, before it is
 * developed.
 */
#pragma once
#include <jansson.h>

#include "cli/options/cli.h"
#include "cli/options/eye_option.h"
#include "denoise/denoise.h"
#include "image/develop.h"

/* Rows of an option table; `look` is a DevelopOptions *. */
#define LOOK_OPTIONS(look)                                                                     \
    {"--exposure", OPTION_TEXT, "auto|EV|white:CD_M2",                                         \
     "auto (default: the cabin looks well), an exposure value at ISO 100 (15: full sun; "      \
     "one more is half as bright), or the luminance that becomes white",                       \
     .out = &(look)->exposure},                                                                \
    {"--display", OPTION_TEXT, "NAME", "sRGB (default), Display P3, Rec.1886",                 \
     .out = &(look)->display},                                                                 \
    {"--view", OPTION_TEXT, "NAME", "photographic (default), ACES SDR, untonemapped, raw",     \
     .out = &(look)->view},                                                                    \
    {"--config", OPTION_TEXT, "FILE",                                                          \
     "OpenColorIO configuration; else $OCIO, else the program's own", .out = &(look)->config}, \
    {"--adapt", OPTION_CHOICE, "none|local",                                                   \
     "local: keeps a dark cabin and a bright street in one picture (default none)",            \
     .out = &(look)->adapt},                                                                   \
    {"--denoise", OPTION_FLAG, NULL,                                                           \
     "filters the noise of few samples away: a preview, not for figures",                      \
     .out = &(look)->is_denoised}

/* The report on a picture, with develop.h's. */
typedef struct LookReport {
    DevelopReport develop;
    DenoiseReport denoise; /* when develop.is_denoised */
    HumanEye      eye;     /* when develop.eye is not "" */
} LookReport;

typedef struct LookRequest {
    const FrameImage     *frame;
    const DevelopOptions *look;
    const char           *path;
    int                   threads;
    const EyeOption      *eye; /* NULL: the command has no such option */
} LookRequest;

/* develop_frame, of the denoised frame if that is asked for, as an eye sees it if that is. */
bool look_options_develop(const LookRequest *request, Arena scratch, LookReport *report,
                          Error *err);

/* The words behind the line of a picture: "", or ", denoised (...), locally adapted, light as
 * in an eye of ...". */
const char *look_options_words(const LookReport *report, Arena *arena);

/* Adds "denoised", {"halves","fireflies","energy_ratio"} or null, "adapt", "local" or null, and
 * "eye", {"age_years","pigment"} or null. */
void look_options_json(const LookReport *report, json_t *answer);
