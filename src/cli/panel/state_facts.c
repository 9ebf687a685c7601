/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/panel/state_facts.h"

#include "base/count.h"
#include "cli/panel/panel_facts.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_report.h"

/* One state's entry of the list. */
static bool add_state(const char *file, const char *name, json_t *list, Arena *arena,
                      Error *err)
{
    static const char *const kept[] = {"verdict", "reasons", "total", "tables", "display"};
    Panel       *panel;
    json_auto_t *report = NULL, *one = json_pack("{s:s}", "state", name);
    if (!panel_open_named(file, name, arena, &panel, err)) return false;
    bool ok = panel_report(panel, &report, err) || error_in_file(err, file);
    if (ok) panel_facts_add(panel, report);
    panel_close(panel);
    for (int i = 0; i < COUNT_OF(kept) && ok; i++) {
        json_t *value = json_object_get(report, kept[i]);
        if (value) json_object_set(one, kept[i], value);
    }
    if (ok) json_array_append(list, one);
    return ok;
}

bool state_facts_add(const Panel *panel, const char *path, json_t *report, Arena *arena,
                     Error *err)
{
    int          state, count = panel_info_states(panel, &state);
    const char  *file = panel_open_file(path, arena);
    json_auto_t *list = json_array();
    for (int i = 0; i < count; i++)
        if (!add_state(file, panel_info_state_name(panel, i), list, arena, err)) return false;
    if (count) json_object_set(report, "states", list);
    return true;
}

const char *state_facts_name(const Panel *panel, Arena *arena)
{
    int state, count = panel_info_states(panel, &state);
    return count ? arena_format(arena, "%s", panel_info_state_name(panel, state)) : NULL;
}

bool state_facts_take(const Panel *panel, Measurement *measured, Error *err)
{
    int state, count = panel_info_states(panel, &state);
    return !measured->state_count ||
           measurement_take_state(measured, count ? panel_info_state_name(panel, state) : NULL,
                                  err);
}

bool state_facts_open(const Panel *panel, const char *path, const PanelLevel *level,
                      Arena *arena, StatePanels *out, Error *err)
{
    int         state, count = panel_info_states(panel, &state);
    const char *file = panel_open_file(path, arena);
    for (out->count = 0; out->count < count; out->count++) {
        const char *name = panel_info_state_name(panel, out->count);
        Panel      *one;
        if (!panel_open_named(file, name, arena, &one, err)) {
            state_facts_close(out);
            return false;
        }
        if (level->is_asked) panel_coarsen(one, (int)level->asked, level->parts, arena);
        out->one[out->count] = (PlotState){name, one};
    }
    return true;
}

void state_facts_close(StatePanels *states)
{
    while (states->count > 0) panel_close((Panel *)states->one[--states->count].panel);
}
