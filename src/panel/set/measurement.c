/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/measurement.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "base/units.h"
#include "panel/set/angle_table.h"
#include "panel/set/level_table.h"
#include "panel/set/manifest.h"
#include "panel/set/primary_spectra.h"
#include "spectrum/spectral_table.h"

/* ---- white split into primaries --------------------------------------------------------- */

/* A set of white alone as primaries, at full level or at a gamma table's.
 *
 * White's XYZ at each angle is split into non-negative amounts of the Rec.709 primaries, or,
 * where those cannot carry the table, into constant shares of its own colour. With a table of
 * levels (level_table.h), w(d) white's XYZ and w_p(d) the part of primary p:
 *   black(d)  = b w(d)                              b = black_share
 *   M_p(g, d) = black(d) + (1 - b) w_p(d) share_p(g)
 * An approximation: real panels change their angular shape with the level. White stays w(d).
 *
 * Units    XYZ with Y in cd m^-2. Memory: the arena's. Threads: pure. Fails: never.
 * XYZ as non-negative amounts of the Rec.709 primaries: amounts below zero become zero and
 * the luminance is kept. */

static void white_amounts(const float xyz[3], float amount[3]) {
    float before = 0, after = 0;
    for (int p = 0; p < 3; p++) {
        amount[p] = 0;
        for (int j = 0; j < 3; j++) amount[p] += rgb_from_xyz_matrix[3 * p + j] * xyz[j];
        float weight = xyz_from_rgb_matrix[3 + p];
        before += amount[p] * weight;
        amount[p] = amount[p] > 0 ? amount[p] : 0;
        after += amount[p] * weight;
    }
    for (int p = 0; p < 3; p++) amount[p] *= after > 0 ? before / after : 0;
}

/* How far Rec.709 misses a colour, share of X + Y + Z. */
static double white_miss(const float xyz[3]) {
    float amount[3];
    double off = 0, sum = 0;
    white_amounts(xyz, amount);
    for (int j = 0; j < 3; j++) {
        double again = 0;
        for (int p = 0; p < 3; p++) again += (double)(amount[p] * xyz_from_rgb_matrix[3 * j + p]);
        off += fabs(again - (double)xyz[j]);
        sum += fabs((double)xyz[j]);
    }
    return sum > 0 ? off / sum : 0;
}

static const float *brightest_row(const AngleTable *table) {
    const float *brightest = table->value;
    for (int i = 1; i < table->rows; i++)
        if (table->value[3 * i + 1] > brightest[1]) brightest = table->value + 3 * i;
    return brightest;
}

#define OUTSIDE 0.002     /* what a miss may be, where there is light */
#define LEAST_SHARE 0.01f /* of a primary in a colour outside of Rec.709 */

/* Every colour that shines is one of Rec.709? */
static bool is_inside(const AngleTable *table) {
    float least = 1e-3f * brightest_row(table)[1];
    for (int i = 0; i < table->rows; i++)
        if (table->value[3 * i + 1] > least && white_miss(table->value + 3 * i) > OUTSIDE)
            return false;
    return true;
}

/* Luminous shares of the primaries in the colour nearest to the brightest direction's. */
static void nearest_shares(const AngleTable *table, float share[3]) {
    float sum = 0;
    white_amounts(brightest_row(table), share);
    for (int p = 0; p < 3; p++) sum += share[p] *= xyz_from_rgb_matrix[3 + p];
    for (int p = 0; p < 3; p++) share[p] = fmaxf(sum > 0 ? share[p] / sum : 1, LEAST_SHARE);
    sum = share[0] + share[1] + share[2];
    for (int p = 0; p < 3; p++) share[p] /= sum;
}

/* Primary p's part of a direction's XYZ: in Rec.709's colours; where those cannot carry the
 * table (as of a saturated primary) a constant share of the table's own colour. */
static void part_of_white(const float xyz[3], const float *share, int p, float part[3]) {
    float amount[3];
    white_amounts(xyz, amount);
    for (int j = 0; j < 3; j++)
        part[j] = share ? share[p] * xyz[j] : amount[p] * xyz_from_rgb_matrix[3 * j + p];
}

/* ---- levels ----------------------------------------------------------------------------- */

/* Without a table of levels: full level alone, and no black. */
static const LevelCurve full_level = {.count = 1, .level = {255}, .share = {1}};

/* Inputs of a table of the split. */
typedef struct WhiteSplit {
    const AngleTable *white;
    const float *share; /* of the primaries; NULL: amounts of Rec.709's */
    float black;        /* of white */
    Arena *arena;
} WhiteSplit;

static AngleTable like_white(const WhiteSplit *split, const char *name, float **value) {
    AngleTable out = *split->white;
    *value = ARENA_NEW(split->arena, float, 3 * (size_t)out.rows);
    out.name = name;
    out.value = *value;
    out.text_bytes = 0;
    return out;
}

/* Primary p alone at a share of its full level, black in it once. */
static AngleTable level_of_primary(const WhiteSplit *split, int p, double level, double share) {
    float *value, part[3];
    AngleTable out =
        like_white(split, arena_format(split->arena, "%s %03g", primary_names[p], level), &value);
    for (int i = 0; i < out.rows; i++) {
        const float *white = split->white->value + 3 * i;
        part_of_white(white, split->share, p, part);
        for (int j = 0; j < 3; j++)
            value[3 * i + j] =
                part[j] * (1 - split->black) * (float)share + white[j] * split->black;
    }
    return out;
}

static AngleTable black_of(const WhiteSplit *split) {
    float *value;
    AngleTable out = like_white(split, "black", &value);
    for (int i = 0; i < 3 * out.rows; i++) value[i] = split->white->value[i] * split->black;
    return out;
}

static void split_levels(const WhiteSplit *split, int p, const LevelCurve *curve,
                         MeasuredPrimary *out) {
    out->level_count = curve->count;
    for (int i = 0; i < curve->count; i++) {
        out->level[i] = curve->level[i];
        out->table[i] = level_of_primary(split, p, curve->level[i], curve->share[i]);
    }
}

/* levels: NULL for full level alone and no black, whose `rows` are then 0. Returns 0 where
 * Rec.709 carries every colour, else the share of the brightest one that it cannot. */
static double white_split(const AngleTable *white, const LevelTable *levels, Arena *arena,
                          MeasuredPrimary primary[3], AngleTable *black) {
    float share[3];
    bool inside = is_inside(white);
    nearest_shares(white, share);
    WhiteSplit split = {.white = white,
                        .share = inside ? NULL : share,
                        .arena = arena,
                        .black = levels ? (float)levels->black_share : 0};
    for (int p = 0; p < 3; p++)
        split_levels(&split, p, levels ? &levels->curve[p] : &full_level, &primary[p]);
    primary[0].table[0].text_bytes = white->text_bytes; /* the source counts once */
    *black = split.black > 0 ? black_of(&split) : (AngleTable){.rows = 0};
    return inside ? 0 : white_miss(brightest_row(white));
}

static bool read_primary(const ManifestEmission *from, int index, Arena *arena,
                         MeasuredPrimary *out, Error *err) {
    const ManifestLevel *levels = from->primary[index];
    out->level_count = from->level_count[index];
    for (int i = 0; i < out->level_count; i++) {
        const char *name = arena_format(arena, "%s %03g", primary_names[index], levels[i].level);
        if (!angle_table_read_xyz(levels[i].table, name, arena, &out->table[i], err)) return false;
        out->level[i] = levels[i].level;
    }
    return true;
}

/* ---- white-only tables ---------------------------------------------------------------- */

/* Makes the primaries and black of the set's white. */
static void split_white(const LevelTable *levels, Arena *arena, Measurement *set) {
    set->white_miss = white_split(&set->white, levels, arena, set->primary, &set->black);
    set->has_black = set->black.rows > 0;
    set->levels = levels;
    set->is_white_only = true;
}

/* Luminance of white nearest to the normal: of the innermost ring, where it is within 10
 * degrees; else there is nothing to compare. */
static bool check_full_level(const Measurement *set, const LevelTable *levels, Error *err) {
    const AngleTable *white = &set->white;
    double sum = 0;
    int count = 0;
    while (count < white->rows && white->theta[count] == white->theta[0])
        sum += (double)white->value[3 * count++ + 1];
    return (double)white->theta[0] > radians_from_degrees(10) ||
           level_table_check_white(levels, sum / count, set->file, err);
}

bool measurement_read_levels(Measurement *set, const char *file, double level_max, Arena *arena,
                             Error *err) {
    LevelTable *levels = ARENA_NEW(arena, LevelTable, 1);
    if (set->spot_count)
        return error_at(err, ERROR_INPUT, set->file, "/spots",
                        "has spots, each with tables of "
                        "its own: name '%s' as 'levels' in the emission of each",
                        file);
    if (!set->is_white_only)
        return error_at(err, ERROR_INPUT, set->file, "",
                        "has no white table alone, so that "
                        "the level table '%s' has nothing to give levels to: %s",
                        file,
                        set->primary[0].level_count ? "its primaries' levels are measured"
                                                    : "it has no emission");
    if (!level_table_read(file, level_max, arena, levels, err) ||
        !check_full_level(set, levels, err))
        return false;
    split_white(levels, arena, set);
    return true;
}

static bool read_emission(const ManifestEmission *from, Arena *arena, Measurement *out,
                          Error *err) {
    if (!from->is_there) return true; /* a surface that only reflects */
    if (from->white) {
        if (!angle_table_read_xyz(from->white, "white", arena, &out->white, err)) return false;
        split_white(NULL, arena, out);
        return !from->levels || measurement_read_levels(out, from->levels, 0, arena, err);
    }
    if (!angle_table_read_xyz(from->black, "black", arena, &out->black, err)) return false;
    out->has_black = true;
    for (int p = 0; p < 3; p++)
        if (!read_primary(from, p, arena, &out->primary[p], err)) return false;
    return true;
}

/* ---- reflection ------------------------------------------------------------------------ */

/* Numbers in a file's name, degrees. */
typedef struct SlicePlace {
    double incidence, azimuth;
} SlicePlace;

/* The pattern with {incidence} and {azimuth} replaced. */
static const char *fill_pattern(const char *pattern, SlicePlace place, Arena *arena) {
    const struct {
        const char *word;
        double value;
    } known[] = {{"{incidence}", place.incidence}, {"{azimuth}", place.azimuth}};
    const char *text = "";
    while (*pattern) {
        int k = 0;
        while (k < COUNT_OF(known) && strncmp(pattern, known[k].word, strlen(known[k].word))) k++;
        if (k == COUNT_OF(known)) {
            text = arena_format(arena, "%s%c", text, *pattern++);
            continue;
        }
        text = arena_format(arena, "%s%.10g", text, known[k].value);
        pattern += strlen(known[k].word);
    }
    return text;
}

static double whole_degrees(double radians) {
    return round(degrees_from_radians(radians) * 1e9) / 1e9;
}

static bool read_slice(const JsonView *view, const char *pattern, int index, Measurement *out,
                       Error *err) {
    Arena *arena = view->arena;
    AngleTable *table = &out->brdf[index];
    SlicePlace place = {whole_degrees(out->incidence[index % out->incidence_count]),
                        whole_degrees(out->azimuth[index / out->incidence_count])};
    const char *name =
        out->azimuth_count > 1
            ? arena_format(arena, "brdf %g deg, light from %g deg", place.incidence, place.azimuth)
            : arena_format(arena, "brdf %g deg", place.incidence);
    const char *file;
    if (!json_view_file(view, "files", fill_pattern(pattern, place, arena), &file, err) ||
        !angle_table_read_brdf(file, out->wavelength_nm, out->wavelength_count, arena, table, err))
        return false;
    table->name = name;
    return true;
}

static bool read_slices(const JsonView *view, const char *pattern, Measurement *out, Error *err) {
    int count = out->incidence_count * out->azimuth_count;
    if (count > MEASUREMENT_TABLES_MAX)
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "%d incidences times "
                        "azimuths, required: at most %d",
                        count, MEASUREMENT_TABLES_MAX);
    out->brdf = ARENA_NEW(view->arena, AngleTable, count);
    for (int i = 0; i < count; i++)
        if (!read_slice(view, pattern, i, out, err)) return false;
    return true;
}

static bool read_mirror(const ManifestReflection *from, const JsonView *view,
                        const SpecularTable **out, Error *err) {
    Gloss gloss;
    if (!from->specular.file && !from->gloss_count) return true;
    SpecularTable *table = ARENA_NEW(view->arena, SpecularTable, 1);
    *out = table;
    if (from->specular.file)
        return specular_table_read_file(from->specular.file, from->specular.aperture_deg,
                                        view->arena, table, err);
    if (!specular_gloss_collect(view, from->gloss, from->gloss_count, &gloss, err)) return false;
    specular_table_from_gloss(&gloss, view->file, view->arena, table);
    return true;
}

static bool read_reflection(const ManifestReflection *from, const JsonView *root, Measurement *out,
                            Error *err) {
    JsonView view = *root;
    if (!from->is_there) return true;
    view.path = from->path;
    out->incidence_count = from->incidence_count;
    out->wavelength_count = from->wavelength_count;
    out->azimuth_count = from->azimuth_count ? from->azimuth_count : 1;
    for (int i = 0; i < from->wavelength_count; i++)
        out->wavelength_nm[i] = (float)from->wavelength_nm[i];
    for (int i = 0; i < from->incidence_count; i++)
        out->incidence[i] = radians_from_degrees(from->incidence_deg[i]);
    for (int i = 0; i < from->azimuth_count; i++)
        out->azimuth[i] = radians_from_degrees(from->azimuth_deg[i]);
    return read_mirror(from, &view, &out->specular, err) &&
           read_slices(&view, from->files, out, err);
}

/* ---- the whole --------------------------------------------------------------------------- */

/* A spot with what the manifest has for it. */
static bool read_spot(const ManifestSpot *from, const JsonView *root, const Measurement *whole,
                      MeasuredSpot *out, Error *err) {
    *out = (MeasuredSpot){.at = {from->position[0], from->position[1]},
                          .has_emission = from->emission.is_there,
                          .has_reflection = from->reflection.is_there,
                          .set = ARENA_NEW(root->arena, Measurement, 1)};
    *out->set = (Measurement){.file = whole->file,
                              .panel = whole->panel,
                              .instrument = whole->instrument,
                              .note = "",
                              .pixels = {whole->pixels[0], whole->pixels[1]},
                              .size_mm = {whole->size_mm[0], whole->size_mm[1]},
                              .instrument_fwhm_deg = whole->instrument_fwhm_deg};
    return read_emission(&from->emission, root->arena, out->set, err) &&
           read_reflection(&from->reflection, root, out->set, err);
}

/* Spots have the spectra of the one panel, or what is known in their place. */
static void share_spectra(Measurement *out) {
    for (int i = 0; i < out->spot_count; i++) {
        Measurement *set = out->spot[i].set;
        set->has_spectra = out->has_spectra;
        set->backlight = out->backlight;
        memcpy(set->peaks_nm, out->peaks_nm, sizeof out->peaks_nm);
        memcpy(set->spectrum, out->spectrum, sizeof out->spectrum);
    }
}

/* The tables that the manifest names. */
static bool read_tables(const JsonView *root, Manifest *from, Error *err) {
    Measurement *out = &from->set;
    if (!read_emission(&from->emission, root->arena, out, err) ||
        !read_reflection(&from->reflection, root, out, err))
        return false;
    out->spot = ARENA_NEW(root->arena, MeasuredSpot, from->spot_count);
    out->spot_count = from->spot_count;
    for (int i = 0; i < from->spot_count; i++)
        if (!read_spot(&from->spot[i], root, out, &out->spot[i], err)) return false;
    if (!uniformity_map_read(&from->uniformity, root->file, root->arena, &out->map, err))
        return false;
    if (from->primaries && !primary_spectra_read(from->primaries, root->arena, out->spectrum,
                                                 &out->spectra_beyond, err))
        return false;
    out->has_spectra = from->primaries != NULL;
    share_spectra(out);
    for (int i = 0; i < out->spot_count; i++)
        if (!primary_spectra_check(out->spot[i].set, from->primaries, err)) return false;
    return primary_spectra_check(out, from->primaries, err);
}

/* ---- a file ------------------------------------------------------------------------------ */

/* A lone CSV: white only. */
static bool read_lone_table(const char *path, Arena *arena, Measurement *out, Error *err) {
    if (!angle_table_read_xyz(path, "white", arena, &out->white, err)) return false;
    split_white(NULL, arena, out);
    out->panel = path_name(path);
    return true;
}

bool measurement_read(const char *path, Arena *arena, Measurement *out, Error *err) {
    return measurement_read_below(path, NULL, arena, out, err);
}

bool measurement_read_below(const char *path, const char *folder, Arena *arena, Measurement *out,
                            Error *err) {
    JsonView root;
    Manifest *manifest = ARENA_NEW(arena, Manifest, 1);
    Measurement *set = &manifest->set;
    bool ok;
    manifest_format.start(manifest);
    set->file = arena_string(arena, path, strlen(path));
    set->inputs.arena = arena;
    lines_put(&set->inputs, set->file);
    if (!strcmp(path_ending(path), ".csv")) {
        ok = read_lone_table(path, arena, set, err);
    } else {
        if (!json_view_open(path, arena, &root, err)) return false;
        root.root = folder;
        root.named = &set->inputs;
        ok = record_read(&root, &manifest_format, manifest, err) &&
             read_tables(&root, manifest, err);
        json_view_close(&root);
    }
    if (ok) *out = *set;
    return ok;
}
