/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/scene_options.h"

#include <string.h>

#include "base/count.h"
#include "base/reference.h"
#include "cli/options/scene_warnings.h"
#include "cli/options/outputs.h"
#include "scene/check/display_frame.h"
#include "scene/load/scene_load.h"

/* They apply in their order: what a later one would undo is refused. */
static bool undoes_none(const char *option, const SceneOverride *list, int i, Error *err) {
    bool is_for_all = !strcmp(list[i].material, "*");
    for (int k = 0; k < i; k++) {
        if (!strcmp(list[k].material, list[i].material))
            return error_set(err, ERROR_USAGE,
                             "%s: %.100s is given twice, %.200s and %.200s: required at most "
                             "once",
                             option, list[i].material, list[k].value, list[i].value);
        if (is_for_all)
            return error_set(err, ERROR_USAGE,
                             "%s: *=%.100s would undo %.100s=%.100s before it — put * first",
                             option, list[i].value, list[k].material, list[k].value);
    }
    return true;
}

static bool parse_overrides(const char *option, const CliTexts *texts, Arena *arena,
                            const SceneOverride **out, Error *err) {
    SceneOverride *list = ARENA_NEW(arena, SceneOverride, texts->count);
    for (int i = 0; i < texts->count; i++)
        if (!cli_name_value(option, texts->list[i], arena, &list[i].material, &list[i].value,
                            err) ||
            !undoes_none(option, list, i, err))
            return false;
    *out = list;
    return true;
}

bool scene_options_read(const SceneWords *words, const Cli *cli, Arena *arena,
                        SceneOptions *options, Error *err) {
    options->paths = cli->arguments;
    options->path_count = cli->argument_count;
    options->content_count = words->contents.count;
    options->panel_count = words->panels.count;
    options->level_count = words->levels.count;
    options->light_count = words->lights.count;
    options->light_level_count = words->light_levels.count;
    options->light_cct_count = words->light_ccts.count;
    return reference_check_root(options->root, err) &&
           state_options_read(&words->state, &options->state, err) &&
           parse_overrides("--content", &words->contents, arena, &options->contents, err) &&
           parse_overrides("--panel", &words->panels, arena, &options->panels, err) &&
           parse_overrides("--display-level", &words->levels, arena, &options->levels, err) &&
           parse_overrides("--light", &words->lights, arena, &options->lights, err) &&
           parse_overrides("--light-level", &words->light_levels, arena, &options->light_levels,
                           err) &&
           parse_overrides("--light-cct", &words->light_ccts, arena, &options->light_ccts, err);
}

#define TWILIGHT_DEG 10.0
#define FAINT_TWILIGHT \
    " — from about 10 degrees on the sky is darker than a real twilight (by a third at 12, " \
    "by half at 15)"

/* A sky whose sun is down is no error, but the frame may be darker than was meant. */
static void warn_of_night(const Environment *environment, Problems *problems) {
    if (environment->kind != ENVIRONMENT_SKY) return;
    DaylightInput input = environment->daylight;
    input.has_sun = environment->has_sun;
    input.sun_elevation = (double)environment->sun_elevation;
    double clearance = daylight_sun_clearance_deg(&input);
    if (clearance < 0)
        problems_add(problems, SEVERITY_WARNING, "", "",
                     "the sun is down: its upper rim stands %.2f degrees below the horizon%s",
                     -clearance, clearance < -TWILIGHT_DEG ? FAINT_TWILIGHT : "");
}

bool scene_options_load(const SceneAsked *asked, Arena *arena, Problems *problems, Scene **out,
                        Error *err) {
    Scene *scene;
    if (!scene_load_shown(asked->options, asked->progress, arena, problems, &scene, err))
        return false;
    if (!outputs_spare(asked->outputs, scene->inputs, scene->input_count, err) ||
        !environment_change(asked->change, scene, arena, problems, err)) {
        scene_close(scene);
        return false;
    }
    warn_of_night(&scene->environment, problems);
    hdri_warn(&scene->environment, problems);
    data_warn(scene, SEVERITY_WARNING, problems);
    forward_doubt(scene, problems);
    panels_warn(scene, SEVERITY_WARNING, problems);
    *out = scene;
    return true;
}

const char *scene_options_given(const SceneWords *words, const EnvironmentChange *change) {
    const struct {
        bool is_given;
        const char *name;
    } all[] = {{change->environment != NULL, "--environment"},
               {change->sun != NULL, "--sun"},
               {change->when != NULL, "--when"},
               {change->where != NULL, "--where"},
               {change->weather != NULL, "--weather"},
               {change->ground != NULL, "--ground"},
               {change->has_hdri_lux, "--hdri-lux"},
               {change->has_forward, "--forward"},
               {change->has_weather_offset, "--weather-offset"},
               {change->has_weather_lux, "--weather-lux"},
               {change->has_heading, "--heading"},
               {change->has_turbidity, "--turbidity"},
               {change->no_moon, "--no-moon"},
               {change->has_visibility, "--visibility"},
               {words->contents.count > 0, "--content"},
               {words->panels.count > 0, "--panel"},
               {words->levels.count > 0, "--display-level"},
               {words->lights.count > 0, "--light"},
               {words->light_levels.count > 0, "--light-level"},
               {words->light_ccts.count > 0, "--light-cct"},
               {words->state.variants.count > 0, "--variant"},
               {words->state.has_time, "--time"}};
    for (int i = 0; i < COUNT_OF(all); i++)
        if (all[i].is_given) return all[i].name;
    return NULL;
}

bool state_options_read(const StateWords *words, SceneState *out, Error *err) {
    if (words->animations.count && !words->has_time)
        return error_set(err, ERROR_USAGE, "--animation %s: at which --time?",
                         words->animations.list[0]);
    *out = (SceneState){.variants = words->variants.list,
                        .variant_count = words->variants.count,
                        .has_time = words->has_time,
                        .time_s = words->time_s,
                        .animations = words->animations.list,
                        .animation_count = words->animations.count};
    return true;
}

static const char *add_texts(const char *before, const char *option, const char *const *list,
                             int count, Arena *arena) {
    for (int i = 0; i < count; i++)
        before = arena_format(arena, "%s %s '%s'", before, option, list[i]);
    return before;
}

const char *state_options_text(const SceneState *state, Arena *arena) {
    const char *text = add_texts("", "--variant", state->variants, state->variant_count, arena);
    if (state->has_time) text = arena_format(arena, "%s --time %.17g", text, state->time_s);
    return add_texts(text, "--animation", state->animations, state->animation_count, arena);
}
