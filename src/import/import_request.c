/* SPDX-License-Identifier: Apache-2.0 */
#include "import/import_request.h"

#include <fnmatch.h>
#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "import/importers.h"
#include "import/primaries.h"
#include "import/set/import_complete.h"
#include "panel/set/primary_bands.h"
#include "text/json_view.h"

#define KEYS_MAX 64

/* Keys besides those of the text tables. */
static const char *const other_keys[] = {"roles", "skip", "format", "wavelength_nm", "area_mm",
    "panel", "instrument", "date", "operator", "conditions", "primaries", "levels", "specular",
    "specular_aperture_deg", "gloss", "isotropic", "symmetry", "no_black", "accept",
    "backlight", "peaks_nm", "note"};

static bool wrong_kind(const JsonView *view, const char *key, const char *wanted, Error *err)
{
    return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key), "required: %s",
                    wanted);
}

/* A text or a number as the text that the command line would have. */
static const char *plain_text(const JsonView *view, const json_t *value)
{
    if (json_is_string(value)) {
        const char *text = json_string_value(value);
        return arena_string(view->arena, text, strlen(text));
    }
    return json_is_number(value) ? arena_format(view->arena, "%.15g", json_number_value(value))
                                 : NULL;
}

static bool set_one(const JsonView *view, const char *key, const json_t *value,
                        TextOptions *text, Error *err)
{
    const char *plain = plain_text(view, value);
    if (!plain) return wrong_kind(view, key, "a text or a number", err);
    return text_options_set(text, key, plain, err) ||
           error_at(err, ERROR_INPUT, view->file, json_view_path(view, key), "%s",
                    arena_string(view->arena, err->text, strlen(err->text)));
}

/* "columns": ["theta", "phi"] is as good as "theta,phi"; other lists add entry by entry. */
static bool set_list(const JsonView *view, const char *key, const json_t *list,
                         TextOptions *text, Error *err)
{
    size_t      i;
    json_t     *value;
    const char *joined = "";
    bool        is_columns = !strcmp(key, "columns");
    json_array_foreach((json_t *)list, i, value) {
        const char *plain = plain_text(view, value);
        if (!plain) return wrong_kind(view, key, "texts or numbers", err);
        if (is_columns)
            joined = arena_format(view->arena, "%s%s%s", joined, i ? "," : "", plain);
        else if (!set_one(view, key, value, text, err)) return false;
    }
    return !is_columns || text_options_set(text, key, joined, err) ||
           error_in_file(err, view->file);
}

static bool read_text_keys(const JsonView *view, TextOptions *text, Error *err)
{
    for (int i = 0; i < text_key_count; i++) {
        const char   *key = text_keys[i].key;
        const json_t *value = json_object_get(view->object, key);
        if (!value) continue;
        if (json_is_array(value) ? !set_list(view, key, value, text, err)
                                 : !set_one(view, key, value, text, err))
            return false;
    }
    return true;
}

static bool read_roles(const JsonView *root, TextOptions *text, Error *err)
{
    JsonView    view;
    const char *pattern;
    json_t     *value;
    if (!json_view_child(root, "roles", false, &view, err)) return false;
    if (!view.object) return true;
    json_object_foreach(view.object, pattern, value) {
        const char *role = plain_text(&view, value);
        Role        parsed;
        double      most = text_options_level_max(text);
        if (!role) return wrong_kind(&view, pattern, "a role", err);
        if (!role_parse(role, most, &parsed, err))
            return error_at(err, ERROR_INPUT, view.file, json_view_path(&view, pattern), "%s",
                            arena_string(view.arena, err->text, strlen(err->text)));
        if (text->role_count == TEXT_ENTRIES_MAX)
            return wrong_kind(root, "roles", "fewer roles", err);
        text->role[text->role_count++] =
            (RoleRow){arena_string(view.arena, pattern, strlen(pattern)), role};
    }
    return true;
}

static bool read_skip(const JsonView *root, TextList *skip, Error *err)
{
    size_t  i;
    json_t *value, *list = json_object_get(root->object, "skip");
    if (!list) return true;
    if (!json_is_array(list)) return wrong_kind(root, "skip", "a list of patterns", err);
    json_array_foreach(list, i, value) {
        const char *plain = plain_text(root, value);
        if (!plain || skip->count == TEXT_ENTRIES_MAX)
            return wrong_kind(root, "skip", "a list of patterns", err);
        skip->text[skip->count++] = plain;
    }
    return true;
}

static bool read_flag(const JsonView *root, const char *key, bool *out, Error *err)
{
    const json_t *value = json_object_get(root->object, key);
    if (value && !json_is_boolean(value)) return wrong_kind(root, key, "true or false", err);
    if (value) *out = json_is_true(value);
    return true;
}

bool import_symmetry_named(const char *name, ImportSymmetry *out, Error *err)
{
    static const char *const names[] = {"none", "left-right", "up-down", "both", "half-turn"};
    for (int i = 0; i < COUNT_OF(names); i++)
        if (!strcmp(names[i], name)) {
            *out = (ImportSymmetry)i;
            return true;
        }
    return error_set(err, ERROR_USAGE,
                     "symmetry is '%s', required: none, left-right, up-down, both or half-turn",
                     name);
}

static bool read_symmetry(const JsonView *root, ImportSymmetry *out, Error *err)
{
    const char *name = "none";
    return json_view_text(root, "symmetry", &name, err) &&
           (import_symmetry_named(name, out, err) || error_in_file(err, root->file));
}

static bool read_specular(const JsonView *root, ImportSpecular *out, Error *err)
{
    if (!json_view_text(root, "specular", &out->file, err) ||
        !json_view_number(root, "specular_aperture_deg", 0, SPECULAR_APERTURE_MOST_DEG,
                          &out->aperture_deg, err))
        return false;
    if (out->file && !json_view_file(root, "specular", out->file, &out->file, err))
        return false;
    return !json_object_get(root->object, "gloss") ||
           specular_gloss_read(root, &out->gloss, err);
}

static bool read_others(const JsonView *root, ImportRequest *request, Error *err)
{
    int  peaks = 0;
    bool ok = read_roles(root, &request->text, err) && read_skip(root, &request->skip, err) &&
              json_view_text(root, "format", &request->options.format, err) &&
              json_view_number(root, "wavelength_nm", 360, 830, &request->options.wavelength_nm,
                               err) &&
              json_view_pair(root, "area_mm", 1e-3, 1e6, request->options.area_mm, err) &&
              json_view_text(root, "panel", &request->panel, err) &&
              json_view_text(root, "instrument", &request->instrument, err) &&
              json_view_text(root, "date", &request->date, err) &&
              json_view_text(root, "operator", &request->operator_name, err) &&
              json_view_text(root, "conditions", &request->conditions, err) &&
              json_view_text(root, "backlight", &request->backlight, err) &&
              json_view_numbers(root, "peaks_nm", (JsonRange){380, 780, 3}, request->peaks_nm,
                                &peaks, err) &&
              json_view_text(root, "primaries", &request->primaries, err) &&
              json_view_text(root, "levels", &request->levels, err) &&
              read_specular(root, &request->specular, err) &&
              read_flag(root, "isotropic", &request->is_isotropic, err) &&
              read_symmetry(root, &request->symmetry, err) &&
              read_flag(root, "no_black", &request->black_is_zero, err) &&
              read_flag(root, "accept", &request->accepts_repeats, err);
    if (!ok) return false;
    if (peaks && peaks < 3) return wrong_kind(root, "peaks_nm", "three wavelengths", err);
    return (!request->primaries || json_view_file(root, "primaries", request->primaries,
                                                  &request->primaries, err)) &&
           (!request->levels || json_view_file(root, "levels", request->levels,
                                               &request->levels, err));
}

bool import_request_read(const char *file, Arena *arena, ImportRequest *request, Error *err)
{
    JsonView    root;
    const char *known[KEYS_MAX];
    int         count = 0;
    for (int i = 0; i < text_key_count; i++) known[count++] = text_keys[i].key;
    for (int i = 0; i < COUNT_OF(other_keys); i++) known[count++] = other_keys[i];
    if (!json_view_open(file, arena, &root, err)) return false;
    root.root = request->root;
    bool ok = json_view_check_keys(&root, known, count, err) &&
              read_text_keys(&root, &request->text, err) && read_others(&root, request, err);
    json_view_close(&root);
    return ok;
}

/* ---- the import -------------------------------------------------------------------------- */

bool import_request_skips(const ImportRequest *request, const char *file)
{
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
                       ImportSet *set, Error *err)
{
    ImportOptions options = request->options;
    Error         one = {.code = ERROR_NONE};
    int           refused = 0, skipped = 0;
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
static bool check_bands(const ImportRequest *request, Arena *arena, Error *err)
{
    const double *nm = request->peaks_nm;
    bool has_peaks = nm[0] > 0;
    if (request->primaries && (request->backlight || has_peaks))
        return error_set(err, ERROR_USAGE, "both spectra of the primaries and a backlight or "
                         "peaks are given, required: one of them: spectra say more");
    if (request->backlight && !primary_backlight_named(request->backlight))
        return error_set(err, ERROR_USAGE, "the backlight is '%s', required: one of %s",
                         request->backlight, primary_backlight_names(arena));
    return !has_peaks || (nm[0] > nm[1] && nm[1] > nm[2]) ||
           error_set(err, ERROR_USAGE, "the peaks are %g, %g, %g nm, required: those of "
                     "red, green and blue, which fall", nm[0], nm[1], nm[2]);
}

bool import_run(const char *const *file, int count, const ImportRequest *request,
                ImportSet *set, Error *err)
{
    set->panel = request->panel;
    set->instrument = request->instrument;
    set->date = request->date;
    set->operator_name = request->operator_name;
    set->conditions = request->conditions;
    set->backlight = request->backlight;
    memcpy(set->peaks_nm, request->peaks_nm, sizeof set->peaks_nm);
    set->is_isotropic = request->is_isotropic;
    set->symmetry = request->symmetry;
    set->black_is_zero = request->black_is_zero;
    set->accepts_repeats = request->accepts_repeats;
    if (request->text.white_reflectance > 0)
        set->white_reflectance = request->text.white_reflectance;
    const char *const beside[] = {request->primaries, request->levels, request->specular.file};
    for (int i = 0; i < COUNT_OF(beside); i++)
        if (beside[i]) lines_put(&set->inputs, beside[i]);
    for (int i = 0; i < count; i++) lines_put(&set->inputs, file[i]);
    if (!check_bands(request, set->arena, err)) return false;
    if (request->primaries && !primaries_read(request->primaries, &request->text, set, err))
        return false;
    return read_files(file, count, request, set, err) && import_complete(set, err) &&
           (!request->levels || import_beside_levels(request->levels, request->text.level_max,
                                                     set, err)) &&
           import_beside_specular(&request->specular, set, err);
}
