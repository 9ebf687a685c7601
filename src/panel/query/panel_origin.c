/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/query/panel_origin.h"

#include <ctype.h>
#include <string.h>

#include "panel/query/panel_report.h"

#define SIMULATED "simulated" /* what begins the instrument's name (panel/set/simulate.c) */
#define SYNTHETIC "synthetic"

/* A word of ASCII, in small or capital letters. */
static bool has_word(const char *text, const char *word)
{
    size_t length = strlen(word);
    for (; *text; text++) {
        size_t i = 0;
        while (i < length && tolower((unsigned char)text[i]) == word[i]) i++;
        if (i == length) return true;
    }
    return false;
}

static const char *text_of(const json_t *report, const char *key, Arena *arena)
{
    const char *text = json_string_value(json_object_get(report, key));
    return text ? arena_string(arena, text, strlen(text)) : "";
}

PanelOrigin panel_origin(const Panel *panel, Arena *arena)
{
    json_t *report = NULL;
    Error   ignored;
    if (!panel_report(panel, &report, &ignored)) return (PanelOrigin){"", "", false};
    PanelOrigin out = {text_of(report, "panel", arena), text_of(report, "instrument", arena),
                       false};
    const char *note = text_of(report, "note", arena);
    out.is_synthetic = !strncmp(out.instrument, SIMULATED, strlen(SIMULATED)) ||
                       has_word(out.name, SYNTHETIC) || has_word(note, SYNTHETIC);
    json_decref(report);
    return out;
}
