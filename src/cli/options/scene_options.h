/* SPDX-License-Identifier: Apache-2.0 */
/* scene_options.h -- the command line's options for a scene besides its files: for the commands
 * that put light into one, as render and measure --illuminance; and, wherever one is loaded,
 * which of the things that its files can be it is (--variant, --time and --animation).
 *
 * Memory   the command's arena, and argv.
 * Fails    ERROR_USAGE with the option, or as scene_load and environment_change do.
 */
#pragma once
#include "cli/options/cli.h"
#include "cli/options/environment_options.h"

/* As typed. */
typedef struct StateWords {
    CliTexts variants, animations;
    double time_s;
    bool has_time;
} StateWords;

/* Rows of an option table: StateWords *. */
#define STATE_OPTIONS(words) \
    {"--variant", OPTION_TEXTS, "NAME", "wears the materials of that variant (default: none)", \
     &(words)->variants}, \
        {"--time", \
         OPTION_NUMBER, \
         "S", \
         "plays animations up to S seconds, 0 is their first frame (default: at rest)", \
         &(words)->time_s, \
         .low = 0, \
         .high = 1e6, \
         .given = &(words)->has_time}, \
    { \
        "--animation", OPTION_TEXTS, "NAME", "plays that one (default: all there are)", \
            &(words)->animations \
    }

/* As typed, NAME=VALUE each. */
typedef struct SceneWords {
    CliTexts contents, panels, levels, lights, light_levels, light_ccts;
    StateWords state;
} SceneWords;

/* Rows of an option table: luminaire files as lamps. */
#define LAMP_OPTIONS(words) \
    {"--light", OPTION_TEXTS, "NODE=FILE.ies|.ldt", "makes a node a lamp, along its -Z", \
     &(words)->lights}, \
        {"--light-level", OPTION_TEXTS, "NODE|*=PERCENT", "dims such a lamp (*: all)", \
         &(words)->light_levels}, \
    { \
        "--light-cct", OPTION_TEXTS, "NODE|*=KELVIN", "gives it a colour temperature", \
            &(words)->light_ccts \
    }

/* Rows of an option table: SceneWords *, SceneOptions *, EnvironmentChange *. */
#define SCENE_OPTIONS(words, options, change) \
    ENVIRONMENT_OPTIONS(change), \
        {"--content", OPTION_TEXTS, "MATERIAL=IMAGE", "what a display shows", &(words)->contents}, \
        {"--panel", OPTION_TEXTS, "MATERIAL=FILE.panel", "makes a material a display", \
         &(words)->panels}, \
        {"--display-level", OPTION_TEXTS, "MATERIAL|*=PERCENT", \
         "how bright a display is set (*: all)", &(words)->levels}, \
        LAMP_OPTIONS(words), STATE_OPTIONS(&(words)->state), { \
        "--root", OPTION_TEXT, "DIR", ROOT_HELP, &(options)->root \
    }

/* The words, and cli's arguments as the scene's files, become options. */
bool scene_options_read(const SceneWords *words, const Cli *cli, Arena *arena,
                        SceneOptions *options, Error *err);

typedef struct SceneAsked {
    const SceneOptions *options;
    const EnvironmentChange *change;
    ProgressMode progress;  /* of its loading */
    const Outputs *outputs; /* which spare the scene's files */
} SceneAsked;

/* The scene with the surroundings that are requested. Warnings go to *problems. */
bool scene_options_load(const SceneAsked *asked, Arena *arena, Problems *problems, Scene **out,
                        Error *err);

/* Something about the scene's light was said: the first such option's name, or NULL. */
const char *scene_options_given(const SceneWords *words, const EnvironmentChange *change);

bool state_options_read(const StateWords *words, SceneState *out, Error *err);

/* The same as on a command line, each option with a blank before it; "" where none is given. */
const char *state_options_text(const SceneState *state, Arena *arena);
