/* The set of tables while files are read, and which importer reads which file. */
#include "import/import.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "panel/json_view.h"

#define HEAD_BYTES 4096
#define FORMATS_MAX 64

ImportSet import_set(Arena *arena)
{
    return (ImportSet){.arena = arena, .white_reflectance = 1,
                       .table = ARENA_NEW(arena, ImportTable, IMPORT_TABLES_MAX)};
}

void import_note(ImportSet *set, const char *format, ...)
{
    char    text[1024];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    error_make_plain(text);
    for (int i = 0; i < set->note_count; i++)
        if (!strcmp(set->note[i], text)) return;
    if (set->note_count == IMPORT_NOTES_MAX) {
        set->note[IMPORT_NOTES_MAX - 1] = "there were more notes than can be kept";
        return;
    }
    set->note[set->note_count++] = arena_string(set->arena, text, strlen(text));
}

/* ---- what a table must be ---------------------------------------------------------------- */

static bool refuse(const ImportTable *table, Error *err, const char *what, double found,
                   const char *wanted)
{
    return error_at(err, ERROR_INPUT, table->file, "", "%s is %g, wanted %s", what, found,
                    wanted);
}

static bool check_emission(const ImportTable *table, Error *err)
{
    int channels = table->component ? 1 : 3;
    if (table->component && !strchr("XYZ", table->component))
        return error_at(err, ERROR_INPUT, table->file, "",
                        "component '%c' is unknown, wanted X, Y or Z", table->component);
    if (table->channels != channels)
        return refuse(table, err, "the number of values a direction", table->channels,
                      table->component ? "1" : "3: X, Y and Z");
    bool has_level = table->source <= IMPORT_BLUE;
    if (has_level && !(table->level > 0 && table->level <= 255))
        return refuse(table, err, "the grey level", table->level, "above 0 and up to 255");
    return true;
}

static bool check_reflection(const ImportTable *table, Error *err)
{
    if (!(table->incidence_deg >= 0 && table->incidence_deg < 90))
        return refuse(table, err, "the angle of incidence", table->incidence_deg,
                      "0 to below 90 degrees");
    if (!(table->incidence_phi_deg >= 0 && table->incidence_phi_deg < 360))
        return refuse(table, err, "the light's azimuth", table->incidence_phi_deg,
                      "0 to below 360 degrees");
    if (table->channels < 1 || !table->wavelength_nm)
        return error_at(err, ERROR_INPUT, table->file, "", "names no wavelength — give one as "
                        "--wavelength NM");
    for (int c = 0; c < table->channels; c++) {
        double nm = (double)table->wavelength_nm[c];
        if (!(nm > 0 && nm < 1e6))
            return refuse(table, err, "a wavelength", nm, "nanometres");
        if (c && !(nm > (double)table->wavelength_nm[c - 1]))
            return refuse(table, err, "a wavelength", nm, "rising wavelengths");
    }
    return true;
}

static bool check_directions(const ImportTable *table, Error *err)
{
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

bool import_add(ImportSet *set, const ImportTable *table, Error *err)
{
    if (set->count == IMPORT_TABLES_MAX)
        return error_at(err, ERROR_INPUT, table->file, "",
                        "is one table too many, wanted at most %d", IMPORT_TABLES_MAX);
    if (table->rows < 1)
        return error_at(err, ERROR_INPUT, table->file, "", "has no measured direction");
    if (table->rows > IMPORT_ROWS_MAX)
        return refuse(table, err, "the number of directions", table->rows, "at most 8000000");
    bool is_light = table->source == IMPORT_REFLECTION || table->source == IMPORT_REFERENCE;
    bool ok = is_light ? check_reflection(table, err)
                       : table->source == IMPORT_DARK || check_emission(table, err);
    if (!ok || !check_directions(table, err)) return false;
    ImportTable *added = &set->table[set->count++];
    *added = *table; /* angles in steps that a file's name can hold */
    added->incidence_deg = round(table->incidence_deg * 1e6) / 1e6;
    added->incidence_phi_deg = fmod(round(table->incidence_phi_deg * 1e6) / 1e6, 360);
    return true;
}

/* ---- which importer ---------------------------------------------------------------------- */

static const Importer *importer_named(const char *name, Error *err)
{
    const char *names[FORMATS_MAX];
    int         count = 0;
    for (int i = 0; importers[i] && i < FORMATS_MAX; i++) {
        if (!strcmp(importers[i]->name, name)) return importers[i];
        names[count++] = importers[i]->name;
    }
    error_set(err, ERROR_USAGE, "--format '%s' is unknown; the nearest one is '%s'", name,
              nearest_word(name, names, count));
    return NULL;
}

static bool read_head(const char *file, char *head, size_t *size, Error *err)
{
    struct stat info; /* a pipe would be waited for */
    if (!stat(file, &info) && !S_ISREG(info.st_mode))
        return error_at(err, ERROR_INPUT, file, "", "is %s, a file is wanted",
                        S_ISDIR(info.st_mode) ? "a folder" : "not a regular file");
    FILE *stream = fopen(file, "rb");
    if (!stream)
        return error_at(err, ERROR_INPUT, file, "", "cannot be opened: %s", strerror(errno));
    *size = fread(head, 1, HEAD_BYTES, stream);
    head[*size] = 0;
    bool ok = !ferror(stream);
    fclose(stream);
    return ok || error_at(err, ERROR_INPUT, file, "", "cannot be read");
}

bool import_file(const char *file, const ImportOptions *options, ImportSet *set, Error *err)
{
    char   head[HEAD_BYTES + 1];
    size_t size = 0;
    if (!read_head(file, head, &size, err)) return false;
    if (!size) return error_at(err, ERROR_INPUT, file, "", "is empty");
    if (options->format) {
        const Importer *importer = importer_named(options->format, err);
        return importer && importer->read(file, options, set, err);
    }
    for (int i = 0; importers[i]; i++)
        if (importers[i]->recognises(file, head, size))
            return importers[i]->read(file, options, set, err);
    return error_at(err, ERROR_INPUT, file, "",
                    "is of no format that is known here — name one with --format");
}
