/* SPDX-License-Identifier: Apache-2.0 */
/* state_options.h -- which of the things that a scene's files can be it is: --variant, --time
 * and --animation, wherever a scene is loaded.
 *
 * Memory   the command's arena, and argv.
 * Fails    ERROR_USAGE with the option; what no file has is reported as the scene is loaded.
 */
#pragma once
#include "cli/options/cli.h"
#include "scene/scene.h"

/* As typed. */
typedef struct StateWords {
    CliTexts variants, animations;
    double   time_s;
    bool     has_time;
} StateWords;

/* Rows of an option table: StateWords *. */
#define STATE_OPTIONS(words)                                                                   \
    {"--variant", OPTION_TEXTS, "NAME", "wears the materials of that variant (default: none)", \
     &(words)->variants},                                                                      \
    {"--time", OPTION_NUMBER, "S",                                                             \
     "plays animations up to S seconds, 0 is their first frame (default: at rest)",            \
     &(words)->time_s, .low = 0, .high = 1e6, .given = &(words)->has_time},                    \
    {"--animation", OPTION_TEXTS, "NAME", "plays that one (default: all there are)",           \
     &(words)->animations}

bool state_options_read(const StateWords *words, SceneState *out, Error *err);

/* The same as on a command line, each option with a blank before it; "" where none is given. */
const char *state_options_text(const SceneState *state, Arena *arena);
