/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/state_options.h"

bool state_options_read(const StateWords *words, SceneState *out, Error *err)
{
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
                             int count, Arena *arena)
{
    for (int i = 0; i < count; i++)
        before = arena_format(arena, "%s %s '%s'", before, option, list[i]);
    return before;
}

const char *state_options_text(const SceneState *state, Arena *arena)
{
    const char *text = add_texts("", "--variant", state->variants, state->variant_count, arena);
    if (state->has_time) text = arena_format(arena, "%s --time %.17g", text, state->time_s);
    return add_texts(text, "--animation", state->animations, state->animation_count, arena);
}
