/* SPDX-License-Identifier: Apache-2.0 */
/* measure_glare.h -- `parhelion measure FRAME --glare`: options, answer.
 *
 * Fails    as frame_glare.h, with the frame's name.
 */
#pragma once
#include "cli/options/cli.h"
#include "vision/frame/frame_glare.h"

extern const TableKind measure_glare_kind; /* of the answer */

typedef struct GlareWords {
    bool given; /* --glare */
    GlareRequest request;
    bool no_low_light;
    bool has_threshold, has_task, has_task_deg, has_peak; /* as typed */
} GlareWords;

#define GLARE_WORDS_DEFAULT \
    { \
        .request = {.settings = GLARE_SETTINGS_DEFAULT } \
    }

/* Rows of an option table; `words` is a GlareWords *. */
#define GLARE_OPTIONS(words) \
    {"--glare", OPTION_FLAG, NULL, \
     "UGR, DGP, DGI, illuminance at the eye, background and sources of a fisheye frame", \
     &(words)->given}, \
        {"--threshold", \
         OPTION_NUMBER, \
         "CD_M2", \
         "with --glare: what is brighter is a source (default 2000)", \
         &(words)->request.settings.threshold_cd_m2, \
         .low = 1e-3, \
         .high = 1e12, \
         .given = &(words)->has_threshold}, \
        {"--task-factor", \
         OPTION_NUMBER, \
         "K", \
         "with --glare: the threshold is K times the task's mean luminance instead", \
         &(words)->request.settings.task_factor, \
         .low = 1e-3, \
         .high = 1e6, \
         .given = &(words)->has_task}, \
        {"--task-deg", \
         OPTION_NUMBER, \
         "DEG", \
         "with --task-factor: full width of the task about the line of sight (default 40)", \
         &(words)->request.settings.task_deg, \
         .low = 0.1, \
         .high = 180, \
         .given = &(words)->has_task_deg}, \
        {"--peak", \
         OPTION_NUMBER, \
         "CD_M2", \
         "with --glare: what is brighter is a source apart (default 50000)", \
         &(words)->request.settings.peak_cd_m2, \
         .low = 1e-3, \
         .high = 1e12, \
         .given = &(words)->has_peak}, \
        {"--no-low-light", OPTION_FLAG, NULL, \
         "with --glare: DGP without its factor for less than 1000 lx at the eye", \
         &(words)->no_low_light}, \
    { \
        "--vertical-lux", OPTION_NUMBER, "LX", \
            "with --glare: the illuminance at the eye, for a frame that does not see half the space", \
            &(words)->request.vertical_lx, .low = 1e-6, .high = 1e9, \
            .given = &(words)->request.has_lux \
    }

/* Options that need another one are refused without it. */
bool glare_words_check(GlareWords *words, Error *err);

bool measure_glare(const Cli *cli, const FrameImage *frame, const GlareWords *words, Arena *arena,
                   Error *err);
