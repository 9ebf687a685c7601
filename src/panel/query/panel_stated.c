/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/query/panel_stated.h"

#include <ctype.h>
#include <jansson.h>
#include <math.h>
#include <string.h>

#include "panel/query/panel_report.h"

#define SIMULATED "simulated" /* what begins the instrument's name (panel/set/simulate.c) */
#define SYNTHETIC "synthetic"

/* A word in small or capital letters. */
static bool has_word(const char *text, const char *word) {
    for (size_t length = strlen(word); text && *text; text++) {
        size_t i = 0;
        while (i < length && tolower((unsigned char)text[i]) == word[i]) i++;
        if (i == length) return true;
    }
    return false;
}

/* NULL where it is empty, too. */
static const char *kept_text(const json_t *text, Arena *arena) {
    return json_string_length(text)
               ? arena_string(arena, json_string_value(text), json_string_length(text))
               : NULL;
}

PanelPartError panel_part_error(const json_t *report, bool of_reflection) {
    PanelPartError out = {.worst = ""};
    double squares = 0;
    size_t i;
    const json_t *table;
    json_array_foreach(json_object_get(report, "tables"), i, table) {
        const char *name = json_string_value(json_object_get(table, "name"));
        if (!name || !strncmp(name, "brdf", 4) != of_reflection) continue;
        double largest = json_number_value(json_object_get(table, "max_error"));
        double rms = json_number_value(json_object_get(table, "rms_error"));
        if (largest >= out.largest) out.largest = largest, out.worst = name;
        squares += rms * rms;
        out.outliers += json_number_value(json_object_get(table, "outliers"));
        out.outlier_largest = fmax(out.outlier_largest,
                                   json_number_value(json_object_get(table, "outliers_max_error")));
        out.tables++;
    }
    if (out.tables) out.rms = sqrt(squares / out.tables);
    return out;
}

PanelStated panel_stated(const Panel *panel, Arena *arena) {
    PanelStated out = {0};
    Error ignored;
    json_t *report;
    if (!panel_report(panel, &report, &ignored)) return out;
    out.verdict = kept_text(json_object_get(report, "verdict"), arena);
    out.reason = kept_text(json_array_get(json_object_get(report, "reasons"), 0), arena);
    out.is_coarse = json_is_true(json_object_get(report, "coarse"));
    out.is_unusable = out.verdict && !strcmp(out.verdict, "not usable");
    out.emission_error = panel_part_error(report, false).rms;
    out.reflection_error = panel_part_error(report, true).rms;
    out.name = kept_text(json_object_get(report, "panel"), arena);
    out.instrument = kept_text(json_object_get(report, "instrument"), arena);
    out.assumed =
        kept_text(json_object_get(json_object_get(report, "emission"), "spectra_assumed"), arena);
    const char *note = kept_text(json_object_get(report, "note"), arena);
    out.is_synthetic = (out.instrument && !strncmp(out.instrument, SIMULATED, strlen(SIMULATED))) ||
                       has_word(out.name, SYNTHETIC) || has_word(note, SYNTHETIC);
    json_decref(report);
    return out;
}
