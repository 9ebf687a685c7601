/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/measurement.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "base/units.h"
#include "panel/set/primary_bands.h"
#include "panel/set/primary_spectra.h"
#include "panel/set/white_split.h"
#include "text/json_view.h"

/* Reads the table that `value` names: a CSV's path, or {"X": ..., "Y": ..., "Z": ...}. */
static bool read_emission_table(const JsonView *view, const char *key, const char *name,
                                AngleTable *out, Error *err)
{
    static const char *const components[3] = {"X", "Y", "Z"};
    json_t *value = json_object_get(view->object, key);
    const char *file[3];
    if (json_is_string(value))
        return json_view_file(view, key, json_string_value(value), &file[0], err) &&
               angle_table_read_xyz(file[0], name, view->arena, out, err);
    if (!json_is_object(value))
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                        "required: a table's path, or an object with X, Y and Z paths");
    JsonView grid;
    if (!json_view_child(view, key, true, &grid, err) ||
        !json_view_check_keys(&grid, components, 3, err))
        return false;
    for (int j = 0; j < 3; j++) {
        json_t *text = json_object_get(grid.object, components[j]);
        if (!json_is_string(text))
            return error_at(err, ERROR_INPUT, view->file, grid.path,
                            "key '%s' is missing or no text", components[j]);
        if (!json_view_file(&grid, components[j], json_string_value(text), &file[j], err))
            return false;
    }
    return angle_table_read_grid(file, name, view->arena, out, err);
}

typedef struct LevelKey {
    double      level;
    const char *key;
} LevelKey;

static int by_level(const void *a, const void *b)
{
    double p = ((const LevelKey *)a)->level, q = ((const LevelKey *)b)->level;
    return p < q ? -1 : p > q;
}

static bool read_level_keys(const JsonView *view, LevelKey *keys, int *count, Error *err)
{
    const char *key;
    json_t     *value;
    *count = 0;
    json_object_foreach(view->object, key, value) {
        char  *after;
        double level = strtod(key, &after);
        if (after == key || *after || !(level > 0 && level <= 255))
            return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                            "is no grey level, required: a number above 0 and up to 255");
        if (*count == MEASUREMENT_LEVELS_MAX)
            return error_at(err, ERROR_INPUT, view->file, view->path,
                            "has more than %d levels", MEASUREMENT_LEVELS_MAX);
        keys[(*count)++] = (LevelKey){level, key};
    }
    qsort(keys, (size_t)*count, sizeof *keys, by_level);
    return *count || error_at(err, ERROR_INPUT, view->file, view->path,
                              "has no grey levels, required: at least \"255\"");
}

static bool read_primary(const JsonView *emission, int index, MeasuredPrimary *out, Error *err)
{
    JsonView view;
    LevelKey keys[MEASUREMENT_LEVELS_MAX];
    int      count;
    if (!json_view_child(emission, primary_names[index], true, &view, err) ||
        !read_level_keys(&view, keys, &count, err))
        return false;
    for (int i = 0; i < count; i++) {
        const char *name = arena_format(view.arena, "%s %03g", primary_names[index],
                                        keys[i].level);
        if (i && keys[i].level == keys[i - 1].level)
            return error_at(err, ERROR_INPUT, view.file, json_view_path(&view, keys[i].key),
                            "is the same grey level as '%s'", keys[i - 1].key);
        if (!read_emission_table(&view, keys[i].key, name, &out->table[i], err)) return false;
        out->level[i] = keys[i].level;
    }
    out->level_count = count;
    return true;
}

/* ---- white-only tables ---------------------------------------------------------------- */

/* Makes the primaries and black of the set's white. */
static void split_white(const LevelTable *levels, Arena *arena, Measurement *set)
{
    set->white_miss = white_split(&set->white, levels, arena, set->primary, &set->black);
    set->has_black = set->black.rows > 0;
    set->levels = levels;
    set->is_white_only = true;
}

/* Luminance of white nearest to the normal: of the innermost ring, where it is within 10
 * degrees; else there is nothing to compare. */
static bool check_full_level(const Measurement *set, const LevelTable *levels, Error *err)
{
    const AngleTable *white = &set->white;
    double sum = 0;
    int    count = 0;
    while (count < white->rows && white->theta[count] == white->theta[0])
        sum += (double)white->value[3 * count++ + 1];
    return (double)white->theta[0] > radians_from_degrees(10) ||
           level_table_check_white(levels, sum / count, set->file, err);
}

bool measurement_read_levels(Measurement *set, const char *file, double level_max,
                             Arena *arena, Error *err)
{
    LevelTable *levels = ARENA_NEW(arena, LevelTable, 1);
    if (set->spot_count)
        return error_at(err, ERROR_INPUT, set->file, "/spots", "has spots, each with tables of "
                        "its own: name '%s' as 'levels' in the emission of each", file);
    if (!set->is_white_only)
        return error_at(err, ERROR_INPUT, set->file, "", "has no white table alone, so that "
                        "the level table '%s' has nothing to give levels to: %s", file,
                        set->primary[0].level_count ? "its primaries' levels are measured"
                                                    : "it has no emission");
    if (!level_table_read(file, level_max, arena, levels, err) ||
        !check_full_level(set, levels, err))
        return false;
    split_white(levels, arena, set);
    return true;
}

static bool read_white(const JsonView *emission, Measurement *out, Error *err)
{
    const char *levels = NULL;
    for (int p = 0; p < 3; p++)
        if (json_object_get(emission->object, primary_names[p]))
            return error_at(err, ERROR_INPUT, emission->file, emission->path,
                            "has both 'white' and '%s', required: either the white table or "
                            "the three primaries", primary_names[p]);
    if (json_object_get(emission->object, "black"))
        return error_at(err, ERROR_INPUT, emission->file, emission->path,
                        "has both 'white' and 'black'; a white-only set has a black of 0, or "
                        "that of its 'levels'");
    if (!read_emission_table(emission, "white", "white", &out->white, err)) return false;
    split_white(NULL, emission->arena, out);
    if (!json_view_text(emission, "levels", &levels, err)) return false;
    if (!levels) return true;
    return json_view_file(emission, "levels", levels, &levels, err) &&
           measurement_read_levels(out, levels, 0, emission->arena, err);
}

static bool read_emission(const JsonView *root, Measurement *out, Error *err)
{
    static const char *const keys[] = {"black", "red", "green", "blue", "white", "levels"};
    JsonView view;
    bool needed = !json_object_get(root->object, "reflection") &&
                  !json_object_get(root->object, "spots");
    if (!json_view_child(root, "emission", needed, &view, err)) return false;
    if (!view.object) return true; /* a surface that only reflects */
    if (!json_view_check_keys(&view, keys, COUNT_OF(keys), err)) return false;
    if (json_object_get(view.object, "white")) return read_white(&view, out, err);
    if (json_object_get(view.object, "levels"))
        return error_at(err, ERROR_INPUT, view.file, json_view_path(&view, "levels"),
                        "is for a set of 'white' alone; these primaries' levels are measured");
    if (!json_object_get(view.object, "black"))
        return error_at(err, ERROR_INPUT, view.file, view.path,
                        "key 'black' is missing: the black pattern's table");
    if (!read_emission_table(&view, "black", "black", &out->black, err)) return false;
    out->has_black = true;
    for (int p = 0; p < 3; p++)
        if (!read_primary(&view, p, &out->primary[p], err)) return false;
    return true;
}

/* ---- reflection ------------------------------------------------------------------------ */

/* Numbers in a file's name; nm negative: all wavelengths in one file. */
typedef struct SlicePlace {
    double incidence, azimuth, nm; /* degrees, degrees, nm */
} SlicePlace;

/* The pattern with {incidence}, {azimuth} and {wavelength} replaced. */
static const char *fill_pattern(const char *pattern, SlicePlace place, Arena *arena)
{
    const struct {
        const char *word;
        double      value;
    } known[] = {{"{incidence}", place.incidence}, {"{azimuth}", place.azimuth},
                 {"{wavelength}", place.nm}};
    const char *text = "";
    while (*pattern) {
        int k = 0;
        while (k < COUNT_OF(known) && strncmp(pattern, known[k].word, strlen(known[k].word)))
            k++;
        if (k == COUNT_OF(known)) {
            text = arena_format(arena, "%s%c", text, *pattern++);
            continue;
        }
        text = arena_format(arena, "%s%.10g", text, known[k].value);
        pattern += strlen(known[k].word);
    }
    return text;
}

/* One file a wavelength becomes one table. */
static bool join_wavelengths(const JsonView *view, const char *pattern, SlicePlace place,
                             const Measurement *set, AngleTable *out, Error *err)
{
    Arena *arena = view->arena;
    float *value = NULL;
    size_t count = (size_t)set->wavelength_count;
    for (size_t w = 0; w < count; w++) {
        AngleTable one;
        place.nm = (double)set->wavelength_nm[w];
        const char *file;
        if (!json_view_file(view, "files", fill_pattern(pattern, place, arena), &file, err) ||
            !angle_table_read_brdf(file, &set->wavelength_nm[w], 1, arena, &one, err))
            return false;
        if (!w) {
            *out = one;
            out->text_bytes = 0;
            value = ARENA_NEW(arena, float, count * (size_t)one.rows);
        } else if (!angle_table_same_rows(out, &one)) {
            return error_at(err, ERROR_INPUT, file, "", "has other directions than the table "
                            "of %g nm, required: the same at every wavelength",
                            (double)set->wavelength_nm[0]);
        }
        out->text_bytes += one.text_bytes;
        for (size_t i = 0; i < (size_t)one.rows; i++) value[i * count + w] = one.value[i];
    }
    out->value = value;
    out->channels = set->wavelength_count;
    return true;
}

static double whole_degrees(double radians)
{
    return round(degrees_from_radians(radians) * 1e9) / 1e9;
}

static bool read_slice(const JsonView *view, const char *pattern, int index, Measurement *out,
                       Error *err)
{
    Arena      *arena = view->arena;
    AngleTable *table = &out->brdf[index];
    SlicePlace  place = {whole_degrees(out->incidence[index % out->incidence_count]),
                         whole_degrees(out->azimuth[index / out->incidence_count]), -1};
    const char *name = out->azimuth_count > 1
        ? arena_format(arena, "brdf %g deg, light from %g deg", place.incidence, place.azimuth)
        : arena_format(arena, "brdf %g deg", place.incidence);
    const char *file;
    if (!json_view_file(view, "files", fill_pattern(pattern, place, arena), &file, err))
        return false;
    if (strstr(pattern, "{wavelength}")
            ? !join_wavelengths(view, pattern, place, out, table, err)
            : !angle_table_read_brdf(file, out->wavelength_nm, out->wavelength_count, arena,
                                     table, err))
        return false;
    table->name = name;
    return true;
}

static bool read_slices(const JsonView *view, const char *pattern, Measurement *out, Error *err)
{
    int count = out->incidence_count * out->azimuth_count;
    if (count > MEASUREMENT_TABLES_MAX)
        return error_at(err, ERROR_INPUT, view->file, view->path, "%d incidences times "
                        "azimuths, required: at most %d", count, MEASUREMENT_TABLES_MAX);
    out->brdf = ARENA_NEW(view->arena, AngleTable, count);
    for (int i = 0; i < count; i++)
        if (!read_slice(view, pattern, i, out, err)) return false;
    return true;
}

static bool check_rising(const JsonView *view, const char *key, const double *value, int count,
                         Error *err)
{
    for (int i = 1; i < count; i++)
        if (!(value[i] > value[i - 1]))
            return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                            "%g follows %g, required: rising values", value[i], value[i - 1]);
    return count > 0 || error_at(err, ERROR_INPUT, view->file, view->path,
                                 "key '%s' is missing", key);
}

/* Azimuths of the light of an anisotropic panel, all around it; absent: isotropic. */
static bool read_azimuths(const JsonView *view, const char *pattern, Measurement *out,
                          Error *err)
{
    double degrees[MEASUREMENT_AZIMUTHS_MAX];
    int    count = 0;
    out->azimuth_count = 1;
    out->azimuth[0] = 0;
    if (!json_view_numbers(view, "incidence_phi_deg",
                           (JsonRange){0, 359.999, COUNT_OF(degrees)}, degrees, &count, err))
        return false;
    if (!count) return true;
    if (!check_rising(view, "incidence_phi_deg", degrees, count, err)) return false;
    if (count < 2)
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, "incidence_phi_deg"),
                        "holds one azimuth, required: several, or none for an isotropic panel");
    if (!strstr(pattern, "{azimuth}"))
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, "files"),
                        "required: a pattern that holds {azimuth}, because incidence_phi_deg "
                        "is there");
    out->azimuth_count = count;
    for (int i = 0; i < count; i++) out->azimuth[i] = radians_from_degrees(degrees[i]);
    return true;
}

static bool read_reflection(const JsonView *root, Measurement *out, Error *err)
{
    static const char *const keys[] = {"wavelengths_nm", "incidence_deg", "incidence_phi_deg",
                                       "files", "specular", "gloss"};
    JsonView    view;
    const char *pattern = NULL;
    double      nm[MEASUREMENT_WAVELENGTHS_MAX], degrees[MEASUREMENT_INCIDENCES_MAX];
    int         nm_count = 0, count = 0;
    if (!json_view_child(root, "reflection", false, &view, err)) return false;
    if (!view.object) return true;
    if (!json_view_check_keys(&view, keys, COUNT_OF(keys), err) ||
        !json_view_numbers(&view, "wavelengths_nm", (JsonRange){360, 830, COUNT_OF(nm)},
                           nm, &nm_count, err) ||
        !json_view_numbers(&view, "incidence_deg", (JsonRange){0, 89, COUNT_OF(degrees)},
                           degrees, &count, err) ||
        !json_view_text(&view, "files", &pattern, err) ||
        !check_rising(&view, "wavelengths_nm", nm, nm_count, err) ||
        !check_rising(&view, "incidence_deg", degrees, count, err))
        return false;
    if (!pattern || !strstr(pattern, "{incidence}"))
        return error_at(err, ERROR_INPUT, view.file, json_view_path(&view, "files"),
                        "required: a pattern that holds {incidence}");
    out->incidence_count = count;
    out->wavelength_count = nm_count;
    for (int i = 0; i < nm_count; i++) out->wavelength_nm[i] = (float)nm[i];
    for (int i = 0; i < count; i++) out->incidence[i] = radians_from_degrees(degrees[i]);
    return read_azimuths(&view, pattern, out, err) &&
           specular_table_read(&view, view.arena, &out->specular, err) &&
           read_slices(&view, pattern, out, err);
}

/* ---- spots ------------------------------------------------------------------------------- */

static bool missing_position(const JsonView *view, Error *err)
{
    bool has_both = json_object_get(view->object, "position") != NULL;
    return error_at(err, ERROR_INPUT, view->file, view->path, has_both
        ? "has both 'position' and 'position_mm', required: one of them"
        : "key 'position' is missing (or 'position_mm')");
}

/* From the upper left corner of the active area, right and down; shares of its size. */
static bool read_position(const JsonView *view, const double size_mm[2], double at[2],
                          Error *err)
{
    bool        is_mm = json_object_get(view->object, "position_mm") != NULL;
    const char *key = is_mm ? "position_mm" : "position";
    if (is_mm == (json_object_get(view->object, "position") != NULL))
        return missing_position(view, err);
    if (is_mm && !(size_mm[0] > 0 && size_mm[1] > 0))
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                        "is there, but the manifest has no 'size_mm'");
    if (!json_view_pair(view, key, 0, is_mm ? 1e5 : 1, at, err)) return false;
    for (int k = 0; k < 2 && is_mm; k++) {
        if (at[k] > size_mm[k])
            return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                            "is %g, required: 0 to %g mm, the active area", at[k], size_mm[k]);
        at[k] /= size_mm[k];
    }
    return true;
}

static bool has_part(const JsonView *view, const char *key)
{
    return json_object_get(view->object, key) != NULL;
}

/* A spot with what the manifest has for it. */
static bool read_spot(const JsonView *root, const JsonView *view, const Measurement *whole,
                      MeasuredSpot *out, Error *err)
{
    static const char *const keys[] = {"position", "position_mm", "emission", "reflection"};
    if (!json_view_check_keys(view, keys, COUNT_OF(keys), err) ||
        !read_position(view, whole->size_mm, out->at, err))
        return false;
    out->has_emission = has_part(view, "emission");
    out->has_reflection = has_part(view, "reflection");
    if (!out->has_emission && !out->has_reflection)
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "has neither 'emission' nor 'reflection'");
    for (int k = 0; k < 2; k++) {
        const char *key = k ? "reflection" : "emission";
        bool is_elsewhere = k ? whole->spots_reflect : whole->spots_emit;
        if (!has_part(view, key) && is_elsewhere && !has_part(root, key))
            return error_at(err, ERROR_INPUT, view->file, view->path, "has no '%s' as other "
                            "spots have, and the manifest has none that would serve", key);
    }
    out->set = ARENA_NEW(view->arena, Measurement, 1);
    *out->set = (Measurement){.file = whole->file, .panel = whole->panel,
        .instrument = whole->instrument, .note = "", .pixels = {whole->pixels[0],
        whole->pixels[1]}, .size_mm = {whole->size_mm[0], whole->size_mm[1]},
        .instrument_fwhm_deg = whole->instrument_fwhm_deg};
    return read_emission(view, out->set, err) && read_reflection(view, out->set, err);
}

static bool check_apart(const JsonView *view, const MeasuredSpot *spot, int index, Error *err)
{
    for (int k = 0; k < index; k++)
        if ((float)spot[k].at[0] == (float)spot[index].at[0] &&
            (float)spot[k].at[1] == (float)spot[index].at[1])
            return error_at(err, ERROR_INPUT, view->file, view->path,
                            "is at the same place as spot %d: %g, %g", k, spot[k].at[0],
                            spot[k].at[1]);
    return true;
}

/* Does any of the manifest's spots have this part? */
static bool spots_have(const JsonView *root, const char *key)
{
    size_t  i;
    json_t *spot;
    json_array_foreach(json_object_get(root->object, "spots"), i, spot)
        if (json_object_get(spot, key)) return true;
    return false;
}

static bool read_spots(const JsonView *root, Measurement *out, Error *err)
{
    json_t *list = json_object_get(root->object, "spots"), *spot;
    size_t  i, count = json_array_size(list);
    if (!list) return true;
    if (!json_is_array(list)) return json_view_wrong_kind(root, "spots", list, "a list", err);
    if (count < 1 || count > MEASUREMENT_SPOTS_MAX)
        return error_at(err, ERROR_INPUT, root->file, json_view_path(root, "spots"),
                        "holds %zu spots, required: 1 to %d", count, MEASUREMENT_SPOTS_MAX);
    out->spot = ARENA_NEW(root->arena, MeasuredSpot, count);
    out->spots_emit = spots_have(root, "emission");
    out->spots_reflect = spots_have(root, "reflection");
    json_array_foreach(list, i, spot) {
        JsonView view = *root;
        view.object = spot;
        view.path = arena_format(root->arena, "%s/spots/%zu", root->path, i);
        if (!json_is_object(spot))
            return error_at(err, ERROR_INPUT, view.file, view.path, "required: an object");
        if (!read_spot(root, &view, out, &out->spot[i], err) ||
            !check_apart(&view, out->spot, (int)i, err))
            return false;
    }
    out->spot_count = (int)count;
    return true;
}

/* Spots have the spectra of the one panel, or what is known in their place. */
static void share_spectra(Measurement *out)
{
    for (int i = 0; i < out->spot_count; i++) {
        Measurement *set = out->spot[i].set;
        set->has_spectra = out->has_spectra;
        set->backlight = out->backlight;
        memcpy(set->peaks_nm, out->peaks_nm, sizeof out->peaks_nm);
        memcpy(set->spectrum, out->spectrum, sizeof out->spectrum);
    }
}

static bool needless_key(const JsonView *root, const char *key, const char *why, Error *err)
{
    return !json_object_get(root->object, key) ||
           error_at(err, ERROR_INPUT, root->file, json_view_path(root, key), "%s", why);
}

/* What is known of primaries without spectra. */
static bool read_backlight(const JsonView *root, Measurement *out, Error *err)
{
    static const char *const keys[] = {"backlight", "peaks_nm"};
    const char *name = NULL;
    int         count = 0;
    for (int i = 0; i < COUNT_OF(keys); i++)
        if ((json_object_get(root->object, "primaries") &&
             !needless_key(root, keys[i], "is for a set without 'primaries': their spectra are "
                           "measured", err)) ||
            (!json_object_get(root->object, "emission") && !out->spots_emit &&
             !needless_key(root, keys[i], "tells of the emitted light, but the set has no "
                           "'emission'", err)))
            return false;
    if (!json_view_text(root, "backlight", &name, err) ||
        !json_view_numbers(root, "peaks_nm", (JsonRange){380, 780, 3}, out->peaks_nm, &count,
                           err))
        return false;
    if (count && (count < 3 || out->peaks_nm[0] <= out->peaks_nm[1] ||
                  out->peaks_nm[1] <= out->peaks_nm[2]))
        return error_at(err, ERROR_INPUT, root->file, json_view_path(root, "peaks_nm"),
                        "required are three wavelengths that fall: of red, green and blue");
    if (name && !(out->backlight = primary_backlight_named(name)))
        return error_at(err, ERROR_INPUT, root->file, json_view_path(root, "backlight"),
                        "is \"%.40s\", required: one of %s", name,
                        primary_backlight_names(root->arena));
    share_spectra(out);
    return true;
}

static bool read_map(const JsonView *root, Measurement *out, Error *err)
{
    JsonView view;
    if (!json_view_child(root, "uniformity", false, &view, err)) return false;
    if (view.object && !json_object_get(root->object, "emission") && !out->spots_emit)
        return error_at(err, ERROR_INPUT, view.file, view.path, "says how even the emission "
                        "is, but the set has none");
    return uniformity_map_read(&view, out->size_mm, &out->map, err);
}

static bool check_traits(const JsonView *root, const Measurement *out, Error *err)
{
    const char *key = display_traits_key(root);
    if (!key || has_part(root, "emission") || out->spots_emit) return true;
    return error_at(err, ERROR_INPUT, root->file, json_view_path(root, key),
                    "tells of the emitted light, but the set has no 'emission'");
}

/* Read before the tables, which take a while; that spots emit is known after them. */
static bool read_traits(const JsonView *root, Measurement *out, Error *err)
{
    return display_traits_read(root, out->pixels, &out->traits, err) &&
           (has_part(root, "spots") || check_traits(root, out, err));
}

static bool read_members(const JsonView *root, Measurement *out, Error *err)
{
    static const char *const keys[] = {"panel", "instrument", "date", "operator", "conditions",
        "note", "pixels", "size_mm",
        "instrument_fwhm_deg", "emission", "primaries", "reflection", "polarisation",
        "subpixels", "spots", "uniformity", "backlight", "peaks_nm"};
    const char *primaries = NULL;
    bool ok = json_view_check_keys(root, keys, COUNT_OF(keys), err) &&
        json_view_text(root, "panel", &out->panel, err) &&
        json_view_text(root, "instrument", &out->instrument, err) &&
        json_view_text(root, "date", &out->date, err) &&
        json_view_text(root, "operator", &out->operator_name, err) &&
        json_view_text(root, "conditions", &out->conditions, err) &&
        json_view_text(root, "note", &out->note, err) &&
        json_view_text(root, "primaries", &primaries, err) &&
        json_view_pair(root, "pixels", 1, 65536, out->pixels, err) &&
        json_view_pair(root, "size_mm", 1, 1e5, out->size_mm, err) &&
        json_view_number(root, "instrument_fwhm_deg", 0.05, 15, &out->instrument_fwhm_deg,
                         err) &&
        read_traits(root, out, err) && read_emission(root, out, err) &&
        read_reflection(root, out, err) && read_spots(root, out, err) &&
         check_traits(root, out, err) &&
        read_map(root, out, err) && read_backlight(root, out, err);
    if (!ok || !primaries) return ok;
    out->has_spectra = json_view_file(root, "primaries", primaries, &primaries, err) &&
                       primary_spectra_read(primaries, root->arena, out->spectrum,
                                            &out->spectra_beyond, err);
    share_spectra(out);
    return out->has_spectra;
}

/* A lone CSV: white only. */
static bool read_lone_table(const char *path, Arena *arena, Measurement *out, Error *err)
{
    if (!angle_table_read_xyz(path, "white", arena, &out->white, err)) return false;
    split_white(NULL, arena, out);
    out->panel = path_name(path);
    return true;
}

bool measurement_read(const char *path, Arena *arena, Measurement *out, Error *err)
{
    return measurement_read_below(path, NULL, arena, out, err);
}

bool measurement_read_below(const char *path, const char *folder, Arena *arena,
                            Measurement *out, Error *err)
{
    JsonView     root;
    Measurement *set = ARENA_NEW(arena, Measurement, 1);
    *set = (Measurement){.file = arena_string(arena, path, strlen(path)), .panel = "",
                         .instrument = "", .date = "", .operator_name = "",
                         .conditions = "", .note = "", .inputs = {.arena = arena}};
    bool ok;
    lines_put(&set->inputs, set->file);
    if (!strcmp(path_ending(path), ".csv")) {
        ok = read_lone_table(path, arena, set, err);
    } else {
        if (!json_view_open(path, arena, &root, err)) return false;
        root.root = folder;
        root.named = &set->inputs;
        ok = read_members(&root, set, err);
        json_view_close(&root);
    }
    if (ok) *out = *set;
    return ok;
}
