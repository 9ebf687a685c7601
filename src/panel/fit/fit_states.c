/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/fit_states.h"

#include "base/file_write.h"
#include "panel/fit/panel_states.h"

/* What it leaves of a state that fails: a report that says why, or none. */
static bool fit_one(const MeasuredState *state, const FitOptions *options, const char *path,
                    Arena *arena, FittedPanel *out, Error *err)
{
    if (panel_fit_bytes(state->set, options, path, arena, out, err)) return true;
    if (out->report) json_object_set_new(out->report, "state", json_string(state->name));
    return error_prefix(err, "the state '%s'", state->name);
}

bool fit_states(const Measurement *measurement, const FitOptions *options, const char *path,
                Arena *arena, json_t **report, Error *err)
{
    int              count = measurement->state_count;
    PanelStateBytes *states = ARENA_NEW(arena, PanelStateBytes, count);
    FittedPanel      first = {.report = NULL}, one;
    if (!count) return panel_fit(measurement, options, path, arena, report, err);
    if (!file_check_writable(path, err)) return false; /* a fit takes a while */
    for (int i = 0; i < count; i++) {
        bool ok = fit_one(&measurement->state[i], options, path, arena, &one, err);
        states[i] = (PanelStateBytes){measurement->state[i].name, one.file};
        if (ok && i) {
            json_decref(one.report);
            continue;
        }
        json_decref(first.report);
        first = one;
        *report = first.report;
        if (!ok) return false;
    }
    if (panel_states_write(states, count, path, arena, err)) return true;
    json_decref(*report);
    *report = NULL;
    return false;
}
