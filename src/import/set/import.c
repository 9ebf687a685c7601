/* SPDX-License-Identifier: Apache-2.0 */
#include "import/set/import.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"

const char *import_source_name(ImportSource source) {
    static const char *const names[] = {"red", "green", "blue", "black", "white", "reflection"};
    return names[source];
}

int import_word_find(const char *const *list, const char *word) {
    for (int i = 0; list[i]; i++)
        if (!strcasecmp(list[i], word)) return i;
    return -1;
}

ImportSet import_set(Arena *arena) {
    return (ImportSet){.arena = arena,
                       .inputs = {.arena = arena},
                       .table = ARENA_NEW(arena, ImportTable, IMPORT_TABLES_MAX)};
}

const ImportTable *import_first(const ImportSet *set, ImportSource source) {
    for (int i = 0; i < set->count; i++)
        if (set->table[i].source == source) return &set->table[i];
    return NULL;
}

void import_note(ImportSet *set, const char *format, ...) {
    va_list list;
    va_start(list, format);
    char *text = arena_printable(set->arena, arena_format_list(set->arena, 1023, format, list));
    va_end(list);
    for (int i = 0; i < set->note_count; i++)
        if (!strcmp(set->note[i], text)) return;
    if (set->note_count == IMPORT_NOTES_MAX) {
        set->note[IMPORT_NOTES_MAX - 1] = "there were more notes than can be kept";
        return;
    }
    set->note[set->note_count++] = text;
}

/* ---- what a table must be ---------------------------------------------------------------- */

static bool refuse(const ImportTable *table, Error *err, const char *what, double found,
                   const char *wanted) {
    return error_at(err, ERROR_INPUT, table->file, "", "%s is %g, required: %s", what, found,
                    wanted);
}

static bool check_emission(const ImportTable *table, Error *err) {
    int channels = table->component ? 1 : 3;
    if (table->component && !strchr("XYZ", table->component))
        return error_at(err, ERROR_INPUT, table->file, "",
                        "component '%c' is unknown, required: X, Y or Z", table->component);
    if (table->channels != channels)
        return refuse(table, err, "the number of values a direction", table->channels,
                      table->component ? "1" : "3: X, Y and Z");
    bool has_level = table->source <= IMPORT_BLUE;
    if (has_level && !(table->level > 0 && table->level <= 255))
        return refuse(table, err, "the grey level", table->level, "above 0 and up to 255");
    return true;
}

static bool check_reflection(const ImportTable *table, Error *err) {
    if (!(table->incidence_deg >= 0 && table->incidence_deg < 90))
        return refuse(table, err, "the angle of incidence", table->incidence_deg,
                      "0 to below 90 degrees");
    if (!(table->incidence_phi_deg >= 0 && table->incidence_phi_deg < 360))
        return refuse(table, err, "the light's azimuth", table->incidence_phi_deg,
                      "0 to below 360 degrees");
    if (table->channels < 1 || !table->wavelength_nm)
        return error_at(err, ERROR_INPUT, table->file, "",
                        "names no wavelength — give one as "
                        "--wavelength NM");
    for (int c = 0; c < table->channels; c++) {
        double nm = (double)table->wavelength_nm[c];
        if (!(nm > 0 && nm < 1e6)) return refuse(table, err, "a wavelength", nm, "nanometres");
        if (c && !(nm > (double)table->wavelength_nm[c - 1]))
            return refuse(table, err, "a wavelength", nm, "rising wavelengths");
    }
    return true;
}

static bool check_directions(const ImportTable *table, Error *err) {
    for (int i = 0; i < table->rows; i++) {
        if (!(table->theta_deg[i] >= 0 && table->theta_deg[i] <= 90))
            return refuse(table, err, "theta", table->theta_deg[i], "0 to 90 degrees");
        if (!(fabs(table->phi_deg[i]) <= 1e6))
            return refuse(table, err, "phi", table->phi_deg[i], "degrees");
    }
    size_t total = (size_t)table->rows * (size_t)table->channels;
    for (size_t i = 0; i < total; i++)
        if (!(fabs(table->value[i]) <= 1e30))
            return refuse(table, err, "a value", table->value[i], "a finite number");
    return true;
}

bool import_add(ImportSet *set, const ImportTable *table, Error *err) {
    if (set->count == IMPORT_TABLES_MAX)
        return error_at(err, ERROR_INPUT, table->file, "",
                        "is one table too many, required: at most %d", IMPORT_TABLES_MAX);
    if (table->rows < 1)
        return error_at(err, ERROR_INPUT, table->file, "", "has no measured direction");
    if (table->rows > IMPORT_ROWS_MAX)
        return refuse(table, err, "the number of directions", table->rows, "at most 8000000");
    bool ok = table->source == IMPORT_REFLECTION ? check_reflection(table, err)
                                                 : check_emission(table, err);
    if (!ok || !check_directions(table, err)) return false;
    ImportTable *added = &set->table[set->count++];
    *added = *table; /* angles in steps that a file's name can hold */
    added->incidence_deg = round(table->incidence_deg * 1e6) / 1e6;
    added->incidence_phi_deg = fmod(round(table->incidence_phi_deg * 1e6) / 1e6, 360);
    return true;
}
