/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/fit_states.h"

#include "base/file_write.h"
#include "panel/fit/panel_states.h"

/* A report of a state that fails stays only where it says why. */
static bool fit_one(const MeasuredState *state, const FitOptions *options, const char *path,
                    Arena *arena, FileBytes *out, json_t **report, Error *err)
{
    *report = NULL;
    if (panel_fit_bytes(state->set, options, path, arena, out, report, err)) return true;
    if (*report) json_object_set_new(*report, "state", json_string(state->name));
    return error_prefix(err, "the state '%s'", state->name);
}

bool fit_states(const Measurement *measurement, const FitOptions *options, const char *path,
                Arena *arena, json_t **report, Error *err)
{
    int              count = measurement->state_count;
    PanelStateBytes *states = ARENA_NEW(arena, PanelStateBytes, count);
    if (!count) return panel_fit(measurement, options, path, arena, report, err);
    if (!file_check_writable(path, err)) return false;
    for (int i = 0; i < count; i++) {
        json_t *own;
        states[i].name = measurement->state[i].name;
        bool ok = fit_one(&measurement->state[i], options, path, arena, &states[i].file, &own,
                          err);
        if (ok && i) {
            json_decref(own);
            continue;
        }
        if (i) json_decref(*report);
        *report = own;
        if (!ok) return false;
    }
    if (panel_states_write(states, count, path, arena, err)) return true;
    json_decref(*report);
    *report = NULL;
    return false;
}
