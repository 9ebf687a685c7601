/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/data_warning.h"

#include "scene/load/material_data.h"

void data_warn(const Scene *scene, Severity severity, Problems *problems)
{
    int         count;
    Arena       scratch = *problems->arena;
    const int  *list = scene_without_data(scene, &count, &scratch);
    const char *names = scene_names_of(scene, list, count, &scratch);
    if (!count) return;
    Arena own = arena_reserve((size_t)1 << 16); /* problems grow where the names lie */
    names = arena_format(&own, "%s", names);
    problems_add(problems, severity, scene->input_count ? scene->inputs[0] : "", "",
                 "%d of %d materials carr%s no optical data and %s taken as perfectly white: "
                 "%.900s — give each a base colour, a texture or a measured spectrum",
                 count, scene->material_count, count == 1 ? "ies" : "y",
                 count == 1 ? "is" : "are", names);
    arena_release(&own);
}
