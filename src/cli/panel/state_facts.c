/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/panel/state_facts.h"

#include <string.h>

#include "base/count.h"
#include "cli/panel/panel_facts.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_report.h"
#include "print/print.h"

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

/* ---- as text ----------------------------------------------------------------------------- */

static double number(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

static void print_cone(const json_t *list)
{
    static const char *const side[] = {"right", "up", "left", "down"};
    for (size_t i = 0; i < COUNT_OF(side); i++) {
        const json_t *angle = json_array_get(list, i);
        print("%s%s ", i ? ", " : "; half of it at ", side[i]);
        if (json_is_number(angle)) print("%.1f", json_number_value(angle));
        else print("-");
    }
    print(" degrees");
}

/* Reasons of the state that the report is of stand in it. */
static void print_state(const json_t *one, const char *shown)
{
    const json_t *display = json_object_get(one, "display"), *reason;
    const json_t *total = json_object_get(one, "total");
    const char   *verdict = json_string_value(json_object_get(one, "verdict"));
    const char   *name = json_string_value(json_object_get(one, "state"));
    size_t        i;
    print("state      %s: white %.4g cd/m2", name, number(display, "white_cd_m2"));
    if (json_is_number(json_object_get(display, "contrast")))
        print(", contrast %.4g : 1", number(display, "contrast"));
    print_cone(json_object_get(display, "half_luminance_deg"));
    print("; errors at most %.3g %%, rms %.3g %%; %s\n", 100 * number(total, "max_error"),
          100 * number(total, "rms_error"), verdict ? verdict : "no verdict");
    if (shown && !strcmp(name, shown)) return;
    json_array_foreach(json_object_get(one, "reasons"), i, reason)
        print("           %s: %s\n", name, json_string_value(reason));
}

void state_facts_print(const json_t *report)
{
    size_t        i;
    const json_t *one, *display = json_object_get(report, "display");
    const char   *shown = json_string_value(json_object_get(display, "state"));
    json_array_foreach(json_object_get(report, "states"), i, one) print_state(one, shown);
}
