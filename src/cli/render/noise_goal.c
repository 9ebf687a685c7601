/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/noise_goal.h"

#include <string.h>

#include "cli/options/cli.h"

bool noise_goal_parse(const char *text, FilmRect crop, Arena *arena, NoiseGoal *out, Error *err) {
    const char *colon = strrchr(text, ':');
    NoiseGoal goal = {.of = frame_area_all(crop)};
    goal.of.option = "--noise";
    if (!cli_numbers(colon ? colon + 1 : text, 1, &goal.error) ||
        !(goal.error > 0 && goal.error < 1))
        return error_set(err, ERROR_USAGE,
                         "--noise %s: required: a relative error above 0 and below 1, such as "
                         "0.05, display:0.01, display:NAME:0.01 or X0,Y0,X1,Y1:0.02",
                         text);
    *out = goal;
    return !colon ||
           frame_area_parse(arena_string(arena, text, (size_t)(colon - text)), ":R", &out->of, err);
}
