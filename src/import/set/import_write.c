/* The set as MANIFEST.json and its tables: all of them under temporary names first, then all
 * renamed, the manifest last. */
#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/file_write.h"
#include "import/set/import.h"
#include "import/set/import_parts.h"
#include "text/json_text.h"

#define SCRATCH_BYTES ((size_t)256 << 20)

typedef struct Output {
    const ImportSet *set;
    const char      *manifest;
    Arena            scratch;
    const char     **path, **temporary; /* of what is written so far */
    int              count;
    const char      *folder[3]; /* made here: removed again on failure when empty */
    int              folder_count;
    Error           *err;
} Output;

const char *import_table_file(const ImportSet *set, const ImportTable *table, Arena *arena)
{
    const char *name = import_source_name(table->source);
    if (table->source == IMPORT_BLACK || table->source == IMPORT_WHITE)
        return arena_format(arena, "emission/%s.csv", name);
    if (table->source != IMPORT_REFLECTION)
        return arena_format(arena, "emission/%s_%03.10g.csv", name, table->level);
    if (set->is_anisotropic)
        return arena_format(arena, "brdf/i%.10g_a%.10g.csv", table->incidence_deg,
                            table->incidence_phi_deg);
    return arena_format(arena, "brdf/i%.10g.csv", table->incidence_deg);
}

/* ---- files ------------------------------------------------------------------------------- */

static bool make_folder(Output *out, const char *path)
{
    if (!mkdir(path, 0777)) {
        out->folder[out->folder_count++] = path;
        return true;
    }
    return errno == EEXIST || error_at(out->err, ERROR_OUTPUT, path, "", "cannot be made: %s",
                                       strerror(errno));
}

/* The manifest's own folder, when it is not there, and those of its tables. */
static bool make_folders(Output *out, bool emission, bool reflection)
{
    const char *name = path_name(out->manifest);
    size_t      length = (size_t)(name - out->manifest);
    if (length > 1 &&
        !make_folder(out, arena_string(&out->scratch, out->manifest, length - 1)))
        return false;
    return (!emission || make_folder(out, path_beside(out->manifest, "emission",
                                                      &out->scratch))) &&
           (!reflection || make_folder(out, path_beside(out->manifest, "brdf", &out->scratch)));
}

static FILE *begin_file(Output *out, const char *path)
{
    const char *temporary = file_temporary_name(path, &out->scratch);
    FILE       *stream = fopen(temporary, "wb");
    if (!stream) {
        error_at(out->err, ERROR_OUTPUT, path, "", "cannot be written: %s", strerror(errno));
        return NULL;
    }
    out->path[out->count] = path;
    out->temporary[out->count++] = temporary;
    return stream;
}

static bool end_file(Output *out, FILE *stream)
{
    bool ok = !ferror(stream);
    ok = !fclose(stream) && ok;
    return ok || error_at(out->err, ERROR_OUTPUT, out->path[out->count - 1], "",
                          "cannot be written: %s", strerror(errno));
}

static void undo(Output *out)
{
    for (int i = 0; i < out->count; i++) file_discard(out->temporary[i]);
    for (int i = out->folder_count - 1; i >= 0; i--) rmdir(out->folder[i]);
}

static bool commit_all(Output *out)
{
    for (int i = 0; i < out->count; i++)
        if (!file_commit(out->temporary[i], out->path[i], out->err)) return false;
    return true;
}

/* A laboratory's own file is never written over, and what cannot be is found out before the
 * first file is. */
static bool spares_sources(Output *out)
{
    struct stat source, target;
    if (!stat(out->manifest, &target) && !file_check_writable(out->manifest, out->err))
        return false;
    for (int i = 0; i < out->set->count; i++) {
        const char *name = import_table_file(out->set, &out->set->table[i], &out->scratch);
        const char *path = path_beside(out->manifest, name, &out->scratch);
        if (stat(path, &target)) continue;
        if (!file_check_writable(path, out->err)) return false;
        for (int k = 0; k < out->set->count; k++)
            if (!stat(out->set->table[k].file, &source) && source.st_dev == target.st_dev &&
                source.st_ino == target.st_ino)
                return error_at(out->err, ERROR_OUTPUT, path, "",
                                "is one of the files to import and would be written over — "
                                "choose another folder for the manifest");
    }
    return true;
}

/* ---- tables ------------------------------------------------------------------------------ */

/* The fewest of 6 to 9 digits that give the same float again. */
static void print_value(FILE *stream, double value)
{
    char  text[40];
    float wanted = (float)value;
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)wanted);
        if (digits == 9 || strtof(text, NULL) == wanted) break;
    }
    fprintf(stream, ",%s", text);
}

static double wrapped(double phi_deg)
{
    double phi = fmod(phi_deg, 360);
    return phi < 0 ? phi + 360 : phi + 0; /* no negative zero */
}

static void print_rows(FILE *stream, const ImportTable *table)
{
    size_t size = (size_t)table->channels;
    for (int i = 0; i < table->rows; i++) {
        fprintf(stream, "%.9g,%.9g", table->theta_deg[i], wrapped(table->phi_deg[i]));
        for (size_t c = 0; c < size; c++)
            print_value(stream, table->value[(size_t)i * size + c]);
        fputc('\n', stream);
    }
}

static void print_masked(FILE *stream, const ImportTable *table)
{
    if (table->masked)
        fprintf(stream, "# %d directions are marked as not measured\n", table->masked);
    for (int i = 0; table->masked_theta_deg && i < table->masked; i++)
        fprintf(stream, "# not measured: theta %.9g phi %.9g\n", table->masked_theta_deg[i],
                wrapped(table->masked_phi_deg[i]));
}

static bool write_table(Output *out, const ImportTable *table)
{
    const char *name = import_table_file(out->set, table, &out->scratch);
    FILE       *stream = begin_file(out, path_beside(out->manifest, name, &out->scratch));
    if (!stream) return false;
    if (table->source == IMPORT_REFLECTION) {
        fputs("theta,phi", stream);
        for (int c = 0; c < table->channels; c++)
            fprintf(stream, ",%.9g", (double)table->wavelength_nm[c]);
        fputc('\n', stream);
    } else {
        fputs("theta,phi,X,Y,Z\n", stream);
    }
    fprintf(stream, "# from %s\n", path_name(table->file));
    print_masked(stream, table);
    print_rows(stream, table);
    return end_file(out, stream);
}

static bool write_spectra(Output *out)
{
    const ImportSpectra *spectra = &out->set->spectra;
    if (!spectra->rows) return true;
    FILE *stream = begin_file(out, path_beside(out->manifest, "primaries.csv", &out->scratch));
    if (!stream) return false;
    fprintf(stream, "nm,red,green,blue%s\n", spectra->value[3] ? ",black" : "");
    for (int i = 0; i < spectra->rows; i++) {
        fprintf(stream, "%.9g", spectra->nm[i]);
        for (int p = 0; p < 4 && spectra->value[p]; p++)
            print_value(stream, spectra->value[p][i]);
        fputc('\n', stream);
    }
    return end_file(out, stream);
}

/* ---- the manifest ------------------------------------------------------------------------ */

static json_t *emission_object(Output *out)
{
    json_t *emission = json_object();
    for (int i = 0; i < out->set->count; i++) {
        const ImportTable *table = &out->set->table[i];
        const char *name = import_source_name(table->source);
        json_t     *file = json_string(import_table_file(out->set, table, &out->scratch));
        if (table->source == IMPORT_REFLECTION) {
            json_decref(file);
        } else if (table->source == IMPORT_BLACK || table->source == IMPORT_WHITE) {
            json_object_set_new(emission, name, file);
        } else {
            if (!json_object_get(emission, name))
                json_object_set_new(emission, name, json_object());
            json_object_set_new(json_object_get(emission, name),
                                arena_format(&out->scratch, "%.10g", table->level), file);
        }
    }
    return emission;
}

static json_t *number(double value)
{
    return value == floor(value) ? json_integer((json_int_t)value) : json_real(value);
}

static void append_once(json_t *list, double value)
{
    size_t  i;
    json_t *known;
    json_array_foreach(list, i, known)
        if (fabs(json_number_value(known) - value) < SAME_ANGLE_DEG) return;
    for (i = 0; i < json_array_size(list); i++)
        if (json_number_value(json_array_get(list, i)) > value) break;
    json_array_insert_new(list, i, number(value));
}

static json_t *reflection_object(const ImportSet *set)
{
    json_t *object = NULL, *nm = json_array(), *incidence = json_array(),
           *azimuth = json_array();
    for (int i = 0; i < set->count; i++) {
        const ImportTable *table = &set->table[i];
        if (table->source != IMPORT_REFLECTION) continue;
        for (int c = 0; c < table->channels && !object; c++)
            json_array_append_new(nm,
                                  number(round((double)table->wavelength_nm[c] * 1e4) / 1e4));
        if (!object) object = json_object();
        append_once(incidence, table->incidence_deg);
        append_once(azimuth, table->incidence_phi_deg);
    }
    if (object) {
        json_object_set(object, "wavelengths_nm", nm);
        json_object_set(object, "incidence_deg", incidence);
        if (set->is_anisotropic) json_object_set(object, "incidence_phi_deg", azimuth);
        json_object_set_new(object, "files",
                            json_string(set->is_anisotropic ? "brdf/i{incidence}_a{azimuth}.csv"
                                                            : "brdf/i{incidence}.csv"));
    }
    json_decref(nm);
    json_decref(incidence);
    json_decref(azimuth);
    return object;
}

/* What the files say; else the name of the folder they come from, or of the only file. */
static const char *panel_name(Output *out)
{
    const char *file = out->set->table[0].file, *name = path_name(file);
    if (out->set->panel) return out->set->panel;
    if (out->set->count == 1 || name - file < 2) return name;
    char *folder = arena_string(&out->scratch, file, (size_t)(name - file) - 1);
    name = path_name(folder);
    return *name && *name != '.' ? name : path_name(file);
}

static json_t *manifest_object(Output *out)
{
    const ImportSet *set = out->set;
    const char *note = "";
    for (int i = 0; i < set->note_count; i++)
        note = arena_format(&out->scratch, "%s%s%s", note, i ? "; " : "", set->note[i]);
    json_t *root = json_object(), *emission = emission_object(out);
    json_object_set_new(root, "panel", json_text(panel_name(out)));
    if (set->instrument)
        json_object_set_new(root, "instrument", json_text(set->instrument));
    if (*note) json_object_set_new(root, "note", json_text(note));
    if (json_object_size(emission)) json_object_set(root, "emission", emission);
    json_decref(emission);
    if (set->spectra.rows)
        json_object_set_new(root, "primaries", json_string("primaries.csv"));
    json_t *reflection = reflection_object(set);
    if (reflection) json_object_set_new(root, "reflection", reflection);
    return root;
}

static bool write_manifest(Output *out)
{
    FILE *stream = begin_file(out, out->manifest);
    if (!stream) return false;
    json_t *root = manifest_object(out);
    bool    ok = !json_dumpf(root, stream, JSON_INDENT(2) | JSON_REAL_PRECISION(12));
    fputc('\n', stream);
    json_decref(root);
    return end_file(out, stream) && (ok || error_at(out->err, ERROR_OUTPUT, out->manifest, "",
                                                    "cannot be written"));
}

static bool has_source(const ImportSet *set, bool reflection)
{
    for (int i = 0; i < set->count; i++)
        if ((set->table[i].source == IMPORT_REFLECTION) == reflection) return true;
    return false;
}

bool import_write(const ImportSet *set, const char *manifest, Error *err)
{
    Arena  arena = arena_reserve(SCRATCH_BYTES);
    Output out = {.set = set, .manifest = manifest, .err = err};
    out.path = ARENA_NEW(&arena, const char *, set->count + 2);
    out.temporary = ARENA_NEW(&arena, const char *, set->count + 2);
    out.scratch = arena;
    bool ok = spares_sources(&out) &&
              make_folders(&out, has_source(set, false), has_source(set, true));
    for (int i = 0; i < set->count && ok; i++) ok = write_table(&out, &set->table[i]);
    ok = ok && write_spectra(&out) && write_manifest(&out) && commit_all(&out);
    if (!ok) undo(&out);
    arena_release(&arena);
    return ok;
}
