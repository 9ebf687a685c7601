/* SPDX-License-Identifier: Apache-2.0 */
#include "import/import_request.h"

#include <fnmatch.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "import/importers.h"
#include "import/set/import.h"
#include "import/set/import_complete.h"
#include "import/text/text_options.h"
#include "panel/set/angle_table.h"
#include "panel/set/level_table.h"
#include "panel/set/primary_bands.h"
#include "panel/set/primary_spectra.h"
#include "record/rows.h"

/* ---- primaries -------------------------------------------------------------------------- */

static bool check_reach(ImportSet *set, const char *file, Error *err) {
    const ImportSpectra *spectra = &set->spectra;
    double beyond = 0;
    for (int p = 0; p < 3; p++)
        if (!primary_spectrum_reaches(&(PrimaryColumn){file, primary_names[p], spectra->nm,
                                                       spectra->value[p], spectra->rows},
                                      &beyond, err))
            return false;
    if (beyond > 0)
        import_note(set,
                    "%s: %.2g %% of V(lambda) lies beyond the primaries' spectra, which "
                    "end in light: dark is taken",
                    path_name(file), 100 * beyond);
    return true;
}

bool primaries_read(const char *file, ImportSet *set, Error *err) {
    CsvTable csv;
    int column[PRIMARY_COLUMNS];
    double *value[PRIMARY_COLUMNS] = {NULL};
    if (!primary_columns_read(file, set->arena, &csv, column, err)) return false;
    if (csv.rows < 2)
        return error_at(err, ERROR_INPUT, file, "", "has %d wavelengths, required: more", csv.rows);
    for (int k = 0; k < PRIMARY_COLUMNS; k++) {
        if (column[k] < 0) continue;
        value[k] = ARENA_NEW(set->arena, double, csv.rows);
        for (int i = 0; i < csv.rows; i++)
            value[k][i] = (double)csv.cell[(size_t)i * (size_t)csv.columns + (size_t)column[k]];
    }
    set->spectra = (ImportSpectra){.file = file, .rows = csv.rows, .nm = value[0]};
    for (int k = 1; k < PRIMARY_COLUMNS; k++) set->spectra.value[k - 1] = value[k];
    return check_reach(set, file, err);
}

/* ---- a gamma table ----------------------------------------------------------------------- */

#define NORMAL_DEG 10.0 /* white nearer to the normal than this is compared */

/* Mean luminance of the innermost directions, which lie at *theta_deg. */
static double white_at_normal(const ImportTable *white, double *theta_deg) {
    double sum = 0;
    int count = 0;
    *theta_deg = 90;
    for (int i = 0; i < white->rows; i++)
        if (white->theta_deg[i] < *theta_deg) *theta_deg = white->theta_deg[i];
    for (int i = 0; i < white->rows; i++) {
        if (white->theta_deg[i] > *theta_deg + SAME_ANGLE_DEG) continue;
        sum += white->value[3 * (size_t)i + 1];
        count++;
    }
    return sum / (count > 0 ? count : 1);
}

/* Reads the gamma table of white, holds it against the set's white and keeps it in the set.
 * level_max: the highest code, 0: not stated. */
static bool import_beside_levels(const char *file, double level_max, ImportSet *set, Error *err) {
    const ImportTable *white = import_first(set, IMPORT_WHITE);
    LevelTable *levels = ARENA_NEW(set->arena, LevelTable, 1);
    double theta_deg;
    if (!white)
        return error_at(err, ERROR_INPUT, file, "",
                        "is a level table for a set of white "
                        "alone, but the files to import hold no white pattern alone");
    if (!level_table_read(file, level_max, set->arena, levels, err)) return false;
    double full = white_at_normal(white, &theta_deg);
    if (theta_deg > NORMAL_DEG)
        import_note(set,
                    "white is measured from %.3g degrees on: the level table's full level "
                    "is not compared with it",
                    theta_deg);
    else if (!level_table_check_white(levels, full, white->file, err)) return false;
    import_note(set, "%s", level_table_note(levels, set->arena));
    set->levels = levels;
    return true;
}

/* ---- a mirror's reflectance -------------------------------------------------------------- */

static bool check_specular(const ImportSpecular *asked, const ImportSet *set, Error *err) {
    if (asked->file && asked->gloss.count)
        return error_set(err, ERROR_USAGE,
                         "both a specular table and gloss are given, "
                         "required: one of them: the table says more");
    if (!asked->file && asked->aperture_deg > 0)
        return error_set(err, ERROR_USAGE,
                         "the aperture is a specular table's, required: "
                         "one (--specular)");
    return import_first(set, IMPORT_REFLECTION) || (!asked->file && !asked->gloss.count) ||
           error_set(err, ERROR_INPUT,
                     "a specular measurement belongs to a reflection, but "
                     "the files to import hold none");
}

static bool import_beside_specular(const ImportSpecular *asked, ImportSet *set, Error *err) {
    if (!check_specular(asked, set, err)) return false;
    if (asked->gloss.count) {
        set->gloss = &asked->gloss;
        import_note(set, "gloss is taken as the specular reflectance within a round aperture, "
                         "the same at all wavelengths: an approximation");
    }
    if (!asked->file) return true;
    SpecularTable *table = ARENA_NEW(set->arena, SpecularTable, 1);
    if (!specular_table_read_file(asked->file, asked->aperture_deg, set->arena, table, err))
        return false;
    set->specular = table;
    set->specular_aperture_deg = asked->aperture_deg;
    if (!(asked->aperture_deg > 0))
        import_note(set, "the specular table is taken as the mirror alone: no aperture is "
                         "given");
    return true;
}

#define TEXT_OR_NUMBER "{'type': ['string', 'number']}"
#define WORDS(list) "{'enum': [" list "]}"
#define NUMBER_FROM(bottom, top) "{'type': 'number', 'minimum': " bottom ", 'maximum': " top "}"
/* One of them, or a list. */
#define ENTRIES \
    "{'oneOf': [" TEXT_OR_NUMBER ", {'type': 'array', 'items': " TEXT_OR_NUMBER \
    ", 'maxItems': 256}]}"

/* A text or a number as the text that the command line would have. */
static const char *plain_text(const JsonView *view, const json_t *value) {
    if (json_is_string(value)) {
        const char *text = json_string_value(value);
        return arena_string(view->arena, text, strlen(text));
    }
    return json_is_number(value) ? arena_format(view->arena, "%.15g", json_number_value(value))
                                 : NULL;
}

static bool set_one(const JsonView *view, const char *key, const json_t *value, TextOptions *text,
                    Error *err) {
    Error why;
    const char *plain = plain_text(view, value);
    if (!plain) return record_fails(view, key, err, "required: a text or a number");
    return text_options_set(text, key, plain, &why) || record_fails(view, key, err, "%s", why.text);
}

/* "columns": ["theta", "phi"] is as good as "theta,phi"; other lists add entry by entry. */
static bool set_list(const JsonView *view, const char *key, const json_t *list, TextOptions *text,
                     Error *err) {
    size_t i;
    json_t *value;
    const char *joined = "";
    bool is_columns = !strcmp(key, "columns");
    json_array_foreach((json_t *)list, i, value) {
        const char *plain = plain_text(view, value);
        if (!plain) return record_fails(view, key, err, "required: texts or numbers");
        if (is_columns) joined = arena_format(view->arena, "%s%s%s", joined, i ? "," : "", plain);
        else if (!set_one(view, key, value, text, err)) return false;
    }
    return !is_columns || text_options_set(text, key, joined, err) ||
           error_in_file(err, view->file);
}

/* A key that is a line of a text declaration, and an option, as well. */
static bool read_line(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    TextOptions *text = &((ImportRequest *)item)->text;
    const json_t *value = json_object_get(view->object, row->key);
    return json_is_array(value) ? set_list(view, row->key, value, text, err)
                                : set_one(view, row->key, value, text, err);
}

static bool read_roles(const JsonView *root, const RecordRow *row, void *item, Error *err) {
    TextOptions *text = &((ImportRequest *)item)->text;
    JsonView view;
    const char *pattern;
    json_t *value;
    if (!json_view_child(root, row->key, &view, err)) return false;
    json_object_foreach(view.object, pattern, value) {
        const char *role = plain_text(&view, value);
        Role parsed;
        Error why;
        if (!role) return record_fails(&view, pattern, err, "required: a role");
        if (!role_parse(role, text_options_level_max(text), &parsed, &why))
            return record_fails(&view, pattern, err, "%s", why.text);
        if (text->role_count == TEXT_ENTRIES_MAX)
            return record_fails(root, row->key, err, "required: fewer roles");
        text->role[text->role_count++] =
            (RoleRow){arena_string(view.arena, pattern, strlen(pattern)), role};
    }
    return true;
}

static bool read_skip(const JsonView *root, const RecordRow *row, void *item, Error *err) {
    TextList *skip = &((ImportRequest *)item)->skip;
    size_t i;
    json_t *value, *list = json_object_get(root->object, row->key);
    bool ok = json_is_array(list);
    json_array_foreach(list, i, value) {
        const char *plain = plain_text(root, value);
        ok = ok && plain && skip->count < TEXT_ENTRIES_MAX;
        if (ok) skip->text[skip->count++] = plain;
    }
    return ok || record_fails(root, row->key, err, "required: a list of patterns");
}

/* Whatever it is. */
static bool read_remark(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    (void)view, (void)row, (void)item, (void)err;
    return true;
}

static const char *const SYMMETRIES[] = {"none", "left-right", "up-down",
                                         "both", "half-turn",  NULL};

#define OWNER ImportRequest
#define LINE(key, json, words) {key, RECORD_OWN, .read = read_line, .schema = json, .doc = words}

static const RecordRow DECLARATION[] = {
    LINE("table",
         WORDS("'list', 'theta-down', 'phi-down', 'horizontal-down', "
               "'vertical-down'"),
         "A direction a row, or a matrix and what runs down."),
    LINE("columns",
         "{'oneOf': [" TEXT_OR_NUMBER ", {'type': 'array', 'minItems': 1, 'items': " TEXT_OR_NUMBER
         "}]}",
         "What each column is; - skips one."),
    LINE("quantity", "{'type': 'string'}",
         "What a matrix without a label holds: X, Y, Z, L, brdf, 550nm."),
    LINE("delimiter", WORDS("'comma', 'semicolon', 'tab', 'blank'"), NULL),
    LINE("decimal", WORDS("'point', 'comma'"), NULL),
    LINE("encoding", WORDS("'utf-8', 'latin-1', 'utf-16le', 'utf-16be'"), NULL),
    LINE("skip_lines", "{'type': 'integer', 'minimum': 0, 'maximum': 1000000}",
         "Lines to pass over at the file's beginning."),
    LINE("comment", ENTRIES, "What begins a comment besides # ! % //."),
    LINE("mask", ENTRIES, "Values that mean: not measured."),
    LINE("section", ENTRIES, "PATTERN=DEG: azimuth of files that have theta alone."),
    LINE("angle_unit", WORDS("'deg', 'rad'"), NULL),
    LINE("angles",
         WORDS("'polar', 'projected', 'equidistant', 'north-polar', "
               "'east-polar'"),
         "Which two angles a direction has."),
    LINE("unit",
         WORDS("'cd/m2', 'nit', 'fL', 'kcd/m2', 'cd/ft2', 'brdf', "
               "'brdf-cos', 'factor'"),
         "Of the values."),
    LINE("azimuth_zero",
         "{'oneOf': [" WORDS("'right', 'top', 'left', 'bottom'") ", " NUMBER_FROM("-360",
                                                                                  "360") "]}",
         "Where the file's azimuth 0 points."),
    LINE("azimuth_sense", WORDS("'ccw', 'cw'"), NULL),
    LINE("azimuth_seen_from", WORDS("'viewer', 'behind'"), NULL),
    LINE("light_azimuth", NUMBER_FROM("-360", "360"), "In the file's azimuths."),
    LINE("white_reflectance", NUMBER_FROM("1e-6", "1.5"), NULL),
    LINE("level_max", NUMBER_FROM("1", "65535"), "The panel's highest code."),
    {"roles", RECORD_OWN, .read = read_roles,
     .schema = "{'type': 'object', 'additionalProperties': {'type': 'string'}}",
     .doc = "Pattern of files to a role."},
    {"skip", RECORD_OWN, .read = read_skip,
     .schema = "{'type': 'array', 'items': " TEXT_OR_NUMBER "}",
     .doc = "Patterns of files to leave out."},
    TEXT("format", 0, options.format, "As --format."),
    NUMBER("wavelength_nm", 0, options.wavelength_nm, 360, 830, NULL),
    VECTOR("area_mm", 0, options.area_mm, 2, 1e-3, 1e6, "Luminous area of a luminaire file."),
    TEXT("panel", 0, panel, "Name for the manifest."),
    TEXT("instrument", 0, instrument, "Name for the manifest."),
    TEXT("date", 0, date, "Of the measurement, for the manifest."),
    TEXT("operator", 0, operator_name, "Who measured, for the manifest."),
    TEXT("conditions", 0, conditions, "Under which it was measured, for the manifest."),
    PATH("primaries", 0, primaries, "A file beside the declaration: columns nm, red, green, blue."),
    PATH("levels", 0, levels, "A gamma table beside the declaration, for a set of white alone."),
    PATH("specular", 0, specular.file,
         "A table beside the declaration: incidence, wavelength, reflectance."),
    NUMBER("specular_aperture_deg", 0, specular.aperture_deg, 0, SPECULAR_APERTURE_MOST_DEG,
           "Full angle that it was measured in; 0: the mirror alone."),
    NUMBER("instrument_fwhm_deg", 0, instrument_fwhm_deg, INSTRUMENT_FWHM_LEAST,
           INSTRUMENT_FWHM_MOST, "As --instrument-fwhm, for the manifest."),
    LIST("gloss", 0, gloss, gloss_count, 1, GLOSS_METERS, gloss_format,
         "What gloss meters read, one value a geometry."),
    FLAG("isotropic", 0, is_isotropic, NULL),
    CHOICE("symmetry", 0, symmetry, SYMMETRIES, NULL),
    FLAG("no_black", 0, black_is_zero, NULL),
    {"backlight", RECORD_WORD, RECORD_AT(OWNER, backlight), .words = primary_backlights,
     .doc = "Of primaries without spectra: the kind whose bands are assumed."},
    VECTOR("peaks_nm", 0, peaks_nm, 3, 380, 780,
           "Peak wavelengths of red, green and blue without spectra."),
    FLAG("accept", 0, accepts_repeats,
         "Take means also where repeated directions or runs contradict each other."),
    {"note", RECORD_OWN, .read = read_remark, .schema = "{}", .doc = "A remark that is not read."},
    {0}};
#undef OWNER

static bool check(const JsonView *view, void *item, Error *err) {
    ImportRequest *request = item;
    return !request->gloss_count ||
           specular_gloss_collect(view, request->gloss, request->gloss_count,
                                  &request->specular.gloss, err);
}

const RecordFormat import_format = {
    "import_declaration", sizeof(ImportRequest), DECLARATION, .check = check,
    .doc = "What a laboratory says once about its files; every key but the last is an option "
           "as well."};

bool import_symmetry_named(const char *name, ImportSymmetry *out, Error *err) {
    for (int i = 0; SYMMETRIES[i]; i++)
        if (!strcmp(SYMMETRIES[i], name)) {
            *out = (ImportSymmetry)i;
            return true;
        }
    return error_set(err, ERROR_USAGE,
                     "symmetry is '%s', required: none, left-right, up-down, both or half-turn",
                     name);
}

bool import_request_read(const char *file, Arena *arena, ImportRequest *request, Error *err) {
    JsonView root;
    if (!json_view_open(file, arena, &root, err)) return false;
    root.root = request->root;
    bool ok = record_read(&root, &import_format, request, err);
    json_view_close(&root);
    return ok;
}

/* ---- the import -------------------------------------------------------------------------- */

bool import_request_skips(const ImportRequest *request, const char *file) {
    const char *role = text_options_role(&request->text, file);
    if (role && !strcmp(role, "skip")) return true;
    for (int i = 0; i < request->skip.count; i++)
        if (!fnmatch(request->skip.text[i], file, 0) ||
            !fnmatch(request->skip.text[i], path_name(file), 0))
            return true;
    return false;
}

/* Reads on when a file is refused, so that the message can count them. */
static bool read_files(const char *const *file, int count, const ImportRequest *request,
                       ImportSet *set, Error *err) {
    ImportOptions options = request->options;
    Error one = {.code = ERROR_NONE};
    int refused = 0, skipped = 0;
    options.text = &request->text;
    for (int i = 0; i < count; i++) {
        bool is_skipped = import_request_skips(request, file[i]);
        skipped += is_skipped;
        if (!is_skipped && !import_file(file[i], &options, set, &one) && !refused++) *err = one;
        if (refused && one.code != ERROR_INPUT) break;
        if (request->step) request->step(request->context, i + 1);
    }
    if (skipped) import_note(set, "%d files were left out as asked", skipped);
    size_t length = strlen(err->text);
    if (refused > 1)
        snprintf(err->text + length, sizeof err->text - length, "; %d more file%s refused",
                 refused - 1, refused == 2 ? " is" : "s are");
    return !refused;
}

/* The set takes them in place of spectra. */
static bool check_bands(const ImportRequest *request, Arena *arena, Error *err) {
    const double *nm = request->peaks_nm;
    bool has_peaks = nm[0] > 0;
    if (request->primaries && (request->backlight || has_peaks))
        return error_set(err, ERROR_USAGE,
                         "both spectra of the primaries and a backlight or "
                         "peaks are given, required: one of them: spectra say more");
    if (request->backlight && !primary_backlight_named(request->backlight))
        return error_set(err, ERROR_USAGE, "the backlight is '%s', required: one of %s",
                         request->backlight, primary_backlight_names(arena));
    return !has_peaks || (nm[0] > nm[1] && nm[1] > nm[2]) ||
           error_set(err, ERROR_USAGE,
                     "the peaks are %g, %g, %g nm, required: those of "
                     "red, green and blue, which fall",
                     nm[0], nm[1], nm[2]);
}

/* What a request says of a set, and the spectra of the primaries, before any file is read. */
static bool begin(const char *const *file, int count, const ImportRequest *request, ImportSet *set,
                  Error *err) {
    set->panel = request->panel;
    set->instrument = request->instrument;
    set->date = request->date;
    set->operator_name = request->operator_name;
    set->conditions = request->conditions;
    set->backlight = request->backlight;
    memcpy(set->peaks_nm, request->peaks_nm, sizeof set->peaks_nm);
    set->instrument_fwhm_deg = request->instrument_fwhm_deg;
    set->is_isotropic = request->is_isotropic;
    set->symmetry = request->symmetry;
    set->black_is_zero = request->black_is_zero;
    set->accepts_repeats = request->accepts_repeats;
    const char *const beside[] = {request->primaries, request->levels, request->specular.file};
    for (int i = 0; i < COUNT_OF(beside); i++)
        if (beside[i]) lines_put(&set->inputs, beside[i]);
    for (int i = 0; i < count; i++) lines_put(&set->inputs, file[i]);
    return check_bands(request, set->arena, err) &&
           (!request->primaries || primaries_read(request->primaries, set, err));
}

bool import_run(const char *const *file, int count, const ImportRequest *request, ImportSet *set,
                Error *err) {
    return begin(file, count, request, set, err) && read_files(file, count, request, set, err) &&
           import_complete(set, err) &&
           (!request->levels ||
            import_beside_levels(request->levels, request->text.level_max, set, err)) &&
           import_beside_specular(&request->specular, set, err);
}
