/* SPDX-License-Identifier: Apache-2.0 */
/* scene_options.h -- the command line's options for a scene besides its files, for the commands
 * that put light into one: render, and measure --illuminance.
 *
 * Memory   the command's arena.
 * Fails    ERROR_USAGE with the option, or as scene_load and environment_change do.
 */
#pragma once
#include "cli/options/cli.h"
#include "cli/options/environment_options.h"
#include "cli/options/state_options.h"

/* As typed, NAME=VALUE each. */
typedef struct SceneWords {
    CliTexts contents, panels, levels, lights, light_levels, light_ccts;
    StateWords state;
} SceneWords;

/* Rows of an option table: luminaire files as lamps. */
#define LAMP_OPTIONS(words)                                                                    \
    {"--light", OPTION_TEXTS, "NODE=FILE.ies|.ldt", "makes a node a lamp, along its -Z",       \
     &(words)->lights},                                                                        \
    {"--light-level", OPTION_TEXTS, "NODE|*=PERCENT", "dims such a lamp (*: all)",             \
     &(words)->light_levels},                                                                  \
    {"--light-cct", OPTION_TEXTS, "NODE|*=KELVIN", "gives it a colour temperature",            \
     &(words)->light_ccts}

/* Rows of an option table: SceneWords *, SceneOptions *, EnvironmentChange *. */
#define SCENE_OPTIONS(words, options, change)                                                  \
    ENVIRONMENT_OPTIONS(change),                                                               \
    {"--content", OPTION_TEXTS, "MATERIAL=IMAGE", "what a display shows", &(words)->contents}, \
    {"--panel", OPTION_TEXTS, "MATERIAL=FILE.panel", "makes a material a display",             \
     &(words)->panels},                                                                        \
    {"--display-level", OPTION_TEXTS, "MATERIAL|*=PERCENT",                                    \
     "how bright a display is set (*: all)", &(words)->levels},                                \
    LAMP_OPTIONS(words),                                                                       \
    STATE_OPTIONS(&(words)->state),                                                            \
    {"--root", OPTION_TEXT, "DIR", ROOT_HELP, &(options)->root}

/* The words, and cli's arguments as the scene's files, become options. */
bool scene_options_read(const SceneWords *words, const Cli *cli, Arena *arena,
                        SceneOptions *options, Error *err);

typedef struct SceneAsked {
    const SceneOptions      *options;
    const EnvironmentChange *change;
    ProgressMode             progress; /* of its loading */
} SceneAsked;

/* The scene with the surroundings that are asked for. Warnings go to *problems. */
bool scene_options_load(const SceneAsked *asked, Arena *arena, Problems *problems, Scene **out,
                        Error *err);

/* Something about the scene's light was said: the first such option's name, or NULL. */
const char *scene_options_given(const SceneWords *words, const EnvironmentChange *change);
