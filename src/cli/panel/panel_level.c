/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/panel/panel_level.h"

#include "panel/query/panel_open.h"

bool panel_level_open(const char *path, long level, Arena *arena, Panel **out,
                      PanelCoarse *coarse, Error *err)
{
    int least, most;
    *coarse = (PanelCoarse){.level = -1};
    if (!panel_open(path, arena, out, err)) return false;
    if (level < 0) return true;
    panel_coarse_range(*out, &least, &most);
    if (level < least || level > most) {
        panel_close(*out);
        *out = NULL;
        return error_at(err, ERROR_USAGE, path, "", "--level is %ld, wanted %d to %d", level,
                        least, most);
    }
    panel_coarsen(*out, (int)level, *arena, coarse);
    return true;
}

static void print_part(const PanelCoarse *c, const char *name, double most, double rms,
                       FILE *to)
{
    fprintf(to, "level %d: %s at most %.3g %% off the whole panel's, rms %.3g %%\n", c->level,
            name, 100 * most, 100 * rms);
}

void panel_level_print(const PanelCoarse *c, FILE *to)
{
    if (c->has_emission) print_part(c, "emission", c->emission_max, c->emission_rms, to);
    if (c->has_reflection)
        print_part(c, "reflection", c->reflection_max, c->reflection_rms, to);
}

json_t *panel_level_json(const PanelCoarse *c)
{
    json_t *level = json_pack("{s:i}", "level", c->level);
    if (c->has_emission)
        json_object_set_new(level, "emission", json_pack("{s:f, s:f}", "max_error",
                            c->emission_max, "rms_error", c->emission_rms));
    if (c->has_reflection)
        json_object_set_new(level, "reflection", json_pack("{s:f, s:f}", "max_error",
                            c->reflection_max, "rms_error", c->reflection_rms));
    return level;
}
