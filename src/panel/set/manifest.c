/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/manifest.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/count.h"
#include "base/number.h"
#include "panel/set/primary_bands.h"
#include "record/rows.h"

/* ---- emission ---------------------------------------------------------------------------- */

#define OWNER ManifestLevel
static const RecordRow LEVEL_TABLE = PATH("table", RECORD_FILLED, table, NULL);
#undef OWNER

static bool check_level(const JsonView *view, void *item, Error *err) {
    ManifestLevel *level = item;
    return (number_is(level->name, &level->level) && level->level > 0 && level->level <= 255) ||
           record_fails(view, level->name, err,
                        "is no grey level, required: a number above 0 "
                        "and up to 255");
}

static const RecordFormat level_format = {"level", sizeof(ManifestLevel), .check = check_level,
                                          .value = &LEVEL_TABLE};

#define OWNER ManifestEmission
#define LEVELS(key, which) \
    {key, \
     RECORD_MAP, \
     RECORD_MANY(OWNER, primary[which], level_count[which]), \
     RECORD_COUNT(0, MEASUREMENT_LEVELS_MAX), \
     .of = &level_format, \
     .doc = "Grey level (above 0, up to 255) to the table of it."}

static const RecordRow EMISSION[] = {
    PATH("black", RECORD_FILLED, black, NULL),
    LEVELS("red", 0),
    LEVELS("green", 1),
    LEVELS("blue", 2),
    PATH("white", RECORD_FILLED, white, NULL),
    PATH("levels", RECORD_FILLED, levels,
         "Of white alone: path of a gamma table, level and luminance (or red, green, blue) in "
         "cd/m2 on the axis, black in it."),
    {0}};
#undef OWNER

static int by_level(const void *a, const void *b) {
    double p = ((const ManifestLevel *)a)->level, q = ((const ManifestLevel *)b)->level;
    return p < q ? -1 : p > q;
}

static bool sort_levels(const JsonView *view, const char *primary, ManifestLevel *levels, int count,
                        Error *err) {
    qsort(levels, (size_t)count, sizeof *levels, by_level);
    for (int i = 1; i < count; i++)
        if (levels[i].level == levels[i - 1].level)
            return record_fails(view, arena_format(view->arena, "%s/%s", primary, levels[i].name),
                                err, "is the same grey level as '%s'", levels[i - 1].name);
    return count > 0 || record_fails(view, primary, err,
                                     "has no grey levels, required: at "
                                     "least \"255\"");
}

static bool check_white(const JsonView *view, Error *err) {
    for (int p = 0; p < 3; p++)
        if (record_has(view, primary_names[p]))
            return error_at(err, ERROR_INPUT, view->file, view->path,
                            "has both 'white' and '%s', required: either the white table or "
                            "the three primaries",
                            primary_names[p]);
    return !record_has(view, "black") ||
           error_at(err, ERROR_INPUT, view->file, view->path,
                    "has both 'white' and 'black'; a white-only set has a black of 0, or that "
                    "of its 'levels'");
}

static bool check_emission(const JsonView *view, void *item, Error *err) {
    ManifestEmission *emission = item;
    if (record_has(view, "white")) return check_white(view, err);
    if (record_has(view, "levels"))
        return record_fails(view, "levels", err,
                            "is for a set of 'white' alone; these "
                            "primaries' levels are measured");
    if (!record_has(view, "black"))
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "key 'black' is missing: the black pattern's table");
    for (int p = 0; p < 3; p++) {
        if (!record_has(view, primary_names[p])) return record_misses(view, primary_names[p], err);
        if (!sort_levels(view, primary_names[p], emission->primary[p], emission->level_count[p],
                         err))
            return false;
    }
    return true;
}

#define GREY_LEVELS \
    "{'minProperties': 1, 'propertyNames': {'pattern': '^(?!0*\\\\.?0*$)(0*([0-9]{1,2}|" \
    "1[0-9]{2}|2[0-4][0-9]|25[0-4])?(\\\\.[0-9]*)?|0*255(\\\\.0*)?)$'}}"

static const RecordFormat emission_format = {
    "emission",
    sizeof(ManifestEmission),
    EMISSION,
    .check = check_emission,
    .rules = "{'dependentRequired': {'levels': ['white']}, 'oneOf': ["
             "{'required': ['black', 'red', 'green', 'blue'], "
             "'properties': {'white': false}}, "
             "{'required': ['white'], 'properties': {'black': false, 'red': false, "
             "'green': false, 'blue': false}}], "
             "'allOf': [{'properties': {'red': " GREY_LEVELS ", 'green': " GREY_LEVELS
             ", 'blue': " GREY_LEVELS "}}]}",
    .doc = "XYZ of the patterns, cd/m2, black not subtracted; or of the white pattern alone."};

/* ---- reflection -------------------------------------------------------------------------- */

#define OWNER ManifestReflection
static const RecordRow REFLECTION[] = {
    FIGURES("wavelengths_nm", MUST, wavelength_nm, wavelength_count, 1, 256, 360, 830,
            "Wavelengths, rising, nm."),
    FIGURES("incidence_deg", MUST, incidence_deg, incidence_count, 1, 32, 0, 89,
            "Angles of the light from the normal, rising, degrees."),
    FIGURES("incidence_phi_deg", 0, azimuth_deg, azimuth_count, 2, 72, 0, 359.999,
            "Azimuths of the light, rising, degrees: of an anisotropic panel only."),
    TEXT("files", MUST, files,
         "Path of a table with {incidence} and {azimuth} for the numbers of the lists above."),
    {"specular", RECORD_EITHER, RECORD_AT(OWNER, specular), .forms = specular_forms,
     .doc = "Table of the specular reflectance: incidence, wavelength, reflectance."},
    LIST("gloss", 0, gloss, gloss_count, 1, GLOSS_METERS, gloss_format,
         "What gloss meters read, one value a geometry."),
    {0}};
#undef OWNER

static bool check_rising(const JsonView *view, const char *key, const double *value, int count,
                         Error *err) {
    for (int i = 1; i < count; i++)
        if (!(value[i] > value[i - 1]))
            return record_fails(view, key, err, "%g follows %g, required: rising values", value[i],
                                value[i - 1]);
    return true;
}

static bool check_reflection(const JsonView *view, void *item, Error *err) {
    ManifestReflection *r = item;
    r->path = view->path;
    if (!check_rising(view, "wavelengths_nm", r->wavelength_nm, r->wavelength_count, err) ||
        !check_rising(view, "incidence_deg", r->incidence_deg, r->incidence_count, err) ||
        !check_rising(view, "incidence_phi_deg", r->azimuth_deg, r->azimuth_count, err))
        return false;
    if (!strstr(r->files, "{incidence}"))
        return record_fails(view, "files", err, "required: a pattern that holds {incidence}");
    if (r->azimuth_count && !strstr(r->files, "{azimuth}"))
        return record_fails(view, "files", err,
                            "required: a pattern that holds {azimuth}, "
                            "because incidence_phi_deg is there");
    return !record_has(view, "specular") || !record_has(view, "gloss") ||
           error_at(err, ERROR_INPUT, view->file, view->path,
                    "has both 'specular' and "
                    "'gloss', required: one of them: a specular table says more");
}

static const RecordFormat reflection_format = {
    "reflection",
    sizeof(ManifestReflection),
    REFLECTION,
    .check = check_reflection,
    .rules = "{'not': {'required': ['specular', 'gloss']}, "
             "'allOf': [{'properties': {'files': {'pattern': '\\\\{incidence\\\\}'}}}],"
             "'if': {'required': ['incidence_phi_deg']}, "
             "'then': {'properties': {'files': {'pattern': '\\\\{azimuth\\\\}'}}}}",
    .doc = "BRDF without the cosine, sr^-1. phi counts from the mirror direction: the light is "
           "at 180."};

/* ---- spots ------------------------------------------------------------------------------- */

#define PARTS \
    PART("emission", emission, emission.is_there, emission_format, NULL), \
        PART("reflection", reflection, reflection.is_there, reflection_format, NULL)

#define OWNER ManifestSpot
static const RecordRow SPOT[] = {
    VECTOR("position", MUST, position, 2, 0, 1,
           "Shares of width and height, right and down from the upper left corner."),
    PARTS,
    {0}};
#undef OWNER

static bool check_spot(const JsonView *view, void *item, Error *err) {
    ManifestSpot *spot = item;
    spot->path = view->path;
    return spot->emission.is_there || spot->reflection.is_there ||
           error_at(err, ERROR_INPUT, view->file, view->path,
                    "has neither 'emission' nor 'reflection'");
}

static const RecordFormat spot_format = {
    "spot", sizeof(ManifestSpot), SPOT, .check = check_spot,
    .rules = "{'anyOf': [{'required': ['emission']}, {'required': ['reflection']}]}"};

/* What a spot lacks the manifest has; no two are at one place. */
static bool check_spots(const JsonView *root, const Manifest *m, Error *err) {
    for (int i = 0; i < m->spot_count; i++) {
        const ManifestSpot *spot = &m->spot[i];
        bool lacks_emission =
            m->set.spots_emit && !spot->emission.is_there && !m->emission.is_there;
        bool lacks_reflection =
            m->set.spots_reflect && !spot->reflection.is_there && !m->reflection.is_there;
        if (lacks_emission || lacks_reflection)
            return error_at(err, ERROR_INPUT, root->file, spot->path,
                            "has no '%s' as other "
                            "spots have, and the manifest has none that would serve",
                            lacks_emission ? "emission" : "reflection");
        for (int k = 0; k < i; k++)
            if ((float)m->spot[k].position[0] == (float)spot->position[0] &&
                (float)m->spot[k].position[1] == (float)spot->position[1])
                return error_at(err, ERROR_INPUT, root->file, spot->path,
                                "is at the same place as spot %d: %g, %g", k,
                                m->spot[k].position[0], m->spot[k].position[1]);
    }
    return true;
}

/* ---- the whole --------------------------------------------------------------------------- */

#define OWNER Manifest
static const RecordRow MANIFEST[] = {
    TEXT("panel", 0, set.panel, "Name of the panel."),
    TEXT("instrument", 0, set.instrument, "What measured it."),
    TEXT("date", 0, set.date, "Of the measurement, best as 2026-03-14."),
    TEXT("operator", 0, set.operator_name, "Who measured."),
    TEXT("conditions", 0, set.conditions,
         "Under which it was measured: room, temperature, warm-up, drive."),
    TEXT("note", 0, set.note, "Anything else."),
    VECTOR("pixels", 0, set.pixels, 2, 1, 65536, "Width and height."),
    VECTOR("size_mm", 0, set.size_mm, 2, 1, 1e5, "Width and height of the active area, mm."),
    NUMBER("instrument_fwhm_deg", 0, set.instrument_fwhm_deg, INSTRUMENT_FWHM_LEAST,
           INSTRUMENT_FWHM_MOST,
           "How wide the instrument sees a mirror image of a point, full width at half "
           "maximum, degrees; separates the mirror from the haze."),
    DISPLAY_TRAITS_ROWS(OWNER, set.traits),
    PARTS,
    LIST("spots", 0, spot, spot_count, 1, MEASUREMENT_SPOTS_MAX, spot_format,
         "Places of the active area that were measured, each once. What a spot leaves out, the "
         "manifest's own emission or reflection says there."),
    OBJECT("uniformity", 0, uniformity, uniformity_format,
           "Relative XYZ of white and black over the active area, from an imaging colorimeter; "
           "ratios alone count."),
    PATH("primaries", 0, primaries,
         "Table of the primaries' spectra: nm, red, green, blue and maybe black; relative."),
    VECTOR("white_apart", 0, set.white_apart, 2, 0, 1,
           "By how much white, measured beside the primaries, and the sum of these are apart "
           "along the normal: share of the luminance, delta u'v'."),
    CHOICE("backlight", RECORD_OPEN, set.backlight, primary_backlights,
           "Without primaries: the kind whose bands are assumed for their spectra."),
    VECTOR("peaks_nm", 0, set.peaks_nm, 3, 380, 780,
           "Without primaries: where the spectra of red, green and blue peak."),
    {0}};
#undef OWNER

static void start(void *item) {
    Manifest *manifest = item;
    *manifest = (Manifest){.set = {.panel = "",
                                   .instrument = "",
                                   .date = "",
                                   .operator_name = "",
                                   .conditions = "",
                                   .note = "",
                                   .traits = {.zones.compensates = true}}};
}

/* Keys that say something of the emitted light; two of them in place of its spectra. */
static bool check_emitted(const JsonView *root, bool emits, Error *err) {
    static const char *const keys[] = {"polarisation", "local_dimming", "backlight", "peaks_nm"};
    for (int i = 0; i < COUNT_OF(keys); i++) {
        if (!record_has(root, keys[i])) continue;
        if (!emits)
            return record_fails(root, keys[i], err,
                                "tells of the emitted light, but the set "
                                "has no 'emission'");
        if (i >= 2 && record_has(root, "primaries"))
            return record_fails(root, keys[i], err,
                                "is for a set without 'primaries': their "
                                "spectra are measured");
    }
    return emits || !record_has(root, "uniformity") ||
           record_fails(root, "uniformity", err,
                        "says how even the emission is, but the set "
                        "has none");
}

static bool check(const JsonView *root, void *item, Error *err) {
    Manifest *m = item;
    Measurement *set = &m->set;
    const double *peak = set->peaks_nm;
    set->backlight += record_has(root, "backlight");
    for (int i = 0; i < m->spot_count; i++) {
        set->spots_emit |= m->spot[i].emission.is_there;
        set->spots_reflect |= m->spot[i].reflection.is_there;
    }
    if (!m->emission.is_there && !m->reflection.is_there && !m->spot_count)
        return record_misses(root, "emission", err);
    if (!display_traits_check(root, set->size_mm, &set->traits, err) ||
        !check_spots(root, m, err) ||
        !check_emitted(root, m->emission.is_there || set->spots_emit, err))
        return false;
    if (m->uniformity.camera_mm > 0 && !(set->size_mm[0] > 0))
        return record_fails(root, "uniformity/camera_mm", err,
                            "is there, but the manifest has "
                            "no 'size_mm' to compare it with");
    return !(peak[0] > 0) || (peak[0] > peak[1] && peak[1] > peak[2]) ||
           record_fails(root, "peaks_nm", err,
                        "required are three wavelengths that fall: of "
                        "red, green and blue");
}

const RecordFormat manifest_format = {
    "measurement_set",
    sizeof(Manifest),
    MANIFEST,
    start,
    check,
    .rules = "{'anyOf': [{'required': ['spots']}, {'required': ['emission']}, "
             "{'required': ['reflection']}], "
             "'allOf': [{'if': {'anyOf': [{'required': ['polarisation']}, "
             "{'required': ['local_dimming']}, {'required': ['uniformity']}]}, "
             "'then': {'anyOf': [{'required': ['emission']}, "
             "{'required': ['spots']}]}}], "
             "'dependentRequired': {'local_dimming': ['size_mm']}}",
    .doc = "Which tables of one panel there are: what panel import and panel simulate write "
           "and panel fit reads."};
