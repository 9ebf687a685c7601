/* SPDX-License-Identifier: Apache-2.0 */
#include "import/text/text_options.h"

#include <fnmatch.h>
#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "base/number.h"
#include "text/nearest_word.h"

const TextKey text_keys[] = {
    {"table", "list|theta-down|phi-down|horizontal-down|vertical-down",
     "a direction a row, or a matrix and what runs down"},
    {"columns", "NAME,NAME,...",
     "what each column is: theta, phi, X, Y, Z, L, x, y, u', v', 550nm, ...; - skips one"},
    {"quantity", "X|Y|Z|L|brdf|550nm|...", "what a matrix without a label holds"},
    {"delimiter", "comma|semicolon|tab|blank", "between cells"},
    {"decimal", "point|comma", "of numbers"},
    {"encoding", "utf-8|latin-1|utf-16le|utf-16be", "of the text"},
    {"skip_lines", "N", "lines to pass over at the file's beginning"},
    {"comment", "PREFIX", "what begins a comment, besides # ! % //"},
    {"mask", "VALUE", "a number that means: not measured (--- NaN n/a are known)"},
    {"section", "PATTERN=DEG", "the azimuth of files that have theta alone"},
    {"angle_unit", "deg|rad", "of all angles"},
    {"angles", "polar|projected|equidistant|north-polar|east-polar",
     "which two angles a direction has"},
    {"unit", "cd/m2|nit|fL|kcd/m2|cd/ft2|brdf|brdf-cos|factor", "of the values"},
    {"azimuth_zero", "right|top|left|bottom|DEG", "where the file's azimuth 0 points"},
    {"azimuth_sense", "ccw|cw", "how its azimuths run"},
    {"azimuth_seen_from", "viewer|behind", "from which side left and right are meant"},
    {"light_azimuth", "DEG", "where the light comes from, in the file's azimuths"},
    {"white_reflectance", "R", "of the white reference, 0 to 1"},
    {"level_max", "N", "the panel's highest code (default 255)"},
};
const int text_key_count = COUNT_OF(text_keys);

/* The index of a value among "a|b|c", or -1. */
static int choice_of(const char *choices, const char *value) {
    size_t length = strlen(value);
    for (int i = 0; choices; i++) {
        const char *bar = strchr(choices, '|');
        size_t size = bar ? (size_t)(bar - choices) : strlen(choices);
        if (size == length && !strncmp(choices, value, size)) return i;
        choices = bar ? bar + 1 : NULL;
    }
    return -1;
}

static const TextKey *key_named(const char *key, Error *err) {
    const char *names[COUNT_OF(text_keys)];
    char advice[700];
    for (int i = 0; i < text_key_count; i++) {
        if (!strcmp(text_keys[i].key, key)) return &text_keys[i];
        names[i] = text_keys[i].key;
    }
    error_set(err, ERROR_USAGE, "'%s' is no key of a declaration — %s", key,
              nearest_word_advice(key, names, text_key_count, advice, (int)sizeof advice));
    return NULL;
}

static bool bad_value(const TextKey *key, const char *value, Error *err) {
    return error_set(err, ERROR_USAGE,
                     "%s is '%s', required: "
                     "%s",
                     key->key, value, key->values);
}

static bool number_of(const char *value, double low, double high, double *out) {
    double number;
    if (!number_is(value, &number) || !(number >= low && number <= high)) return false;
    *out = number;
    return true;
}

static bool add_entry(TextList *list, const char *value) {
    if (list->count == TEXT_ENTRIES_MAX) return false;
    list->text[list->count++] = value;
    return true;
}

/* A pattern, '=' and an azimuth. */
static bool section_azimuth(const char *value, size_t *pattern_length, double *phi) {
    const char *equals = strrchr(value, '=');
    if (!equals || equals == value || !number_of(equals + 1, -360, 360, phi)) return false;
    *pattern_length = (size_t)(equals - value);
    return true;
}

bool text_options_section(const TextOptions *options, const char *file, double *phi) {
    for (int i = options->section.count - 1; i >= 0; i--) {
        char pattern[512];
        size_t length = 0;
        if (!section_azimuth(options->section.text[i], &length, phi)) continue;
        snprintf(pattern, sizeof pattern, "%.*s", (int)length, options->section.text[i]);
        if (!fnmatch(pattern, file, 0) || !fnmatch(pattern, path_name(file), 0)) return true;
    }
    return false;
}

static bool set_section(TextOptions *d, const char *value) {
    size_t length;
    double phi;
    return section_azimuth(value, &length, &phi) && add_entry(&d->section, value);
}

static bool set_azimuth_zero(TextOptions *d, const char *value) {
    static const double sides[] = {0, 90, 180, 270};
    int side = choice_of("right|top|left|bottom", value);
    if (side >= 0) d->azimuth_zero_deg = sides[side];
    d->has_azimuth_zero = side >= 0 || number_of(value, -360, 360, &d->azimuth_zero_deg);
    return d->has_azimuth_zero;
}

static bool set_unit(TextOptions *d, const char *value) {
    d->unit = value_unit((TextCell){value, (int)strlen(value)});
    if (!strcmp(value, "brdf-cos")) d->unit = UNIT_BRDF_COS;
    return d->unit != UNIT_AUTO;
}

static bool set_quantity(TextOptions *d, const char *value) {
    ColumnName name = column_name((TextCell){value, (int)strlen(value)});
    d->quantity = value;
    return name.quantity >= QUANTITY_X && !name.is_ambiguous;
}

static bool set_count(int *out, const char *value, double most) {
    double number;
    if (!number_of(value, 0, most, &number) || number != (double)(int)number) return false;
    *out = (int)number;
    return true;
}

/* Keys with a choice: 0 when the value is none of them. */
static bool set_choice(TextOptions *d, const TextKey *key, const char *value) {
    static const char delimiters[] = ",;\t ", decimals[] = ".,";
    int choice = choice_of(key->values, value);
    if (choice < 0) return false;
    if (!strcmp(key->key, "table")) d->layout = (TableLayout)(choice + 1);
    if (!strcmp(key->key, "delimiter")) d->dialect.delimiter = delimiters[choice];
    if (!strcmp(key->key, "decimal")) d->dialect.decimal = decimals[choice];
    if (!strcmp(key->key, "encoding")) d->encoding = (TextEncoding)(choice + 1);
    if (!strcmp(key->key, "angle_unit")) d->angle_unit = (AngleUnit)(choice + 1);
    if (!strcmp(key->key, "angles")) d->angles = (AnglePair)(choice + 1);
    if (!strcmp(key->key, "azimuth_sense")) d->azimuth_sense = choice ? -1 : 1;
    if (!strcmp(key->key, "azimuth_seen_from")) d->seen_from = choice ? -1 : 1;
    return true;
}

static bool set_key(TextOptions *d, const TextKey *key, const char *value) {
    const char *name = key->key;
    if (!strcmp(name, "columns")) return d->columns = value, *value != 0;
    if (!strcmp(name, "quantity")) return set_quantity(d, value);
    if (!strcmp(name, "skip_lines")) return set_count(&d->skip_lines, value, 1e6);
    if (!strcmp(name, "comment")) return *value && add_entry(&d->comment, value);
    if (!strcmp(name, "section")) return set_section(d, value);
    if (!strcmp(name, "mask")) return *value && add_entry(&d->mask, value);
    if (!strcmp(name, "unit")) return set_unit(d, value);
    if (!strcmp(name, "azimuth_zero")) return set_azimuth_zero(d, value);
    if (!strcmp(name, "light_azimuth"))
        return d->has_light_azimuth = number_of(value, -360, 360, &d->light_azimuth_deg);
    if (!strcmp(name, "white_reflectance"))
        return number_of(value, 1e-6, 1.5, &d->white_reflectance);
    if (!strcmp(name, "level_max")) return number_of(value, 1, 65535, &d->level_max);
    return set_choice(d, key, value);
}

bool text_options_set(TextOptions *options, const char *key, const char *value, Error *err) {
    const TextKey *row = key_named(key, err);
    return row && (set_key(options, row, value) || bad_value(row, value, err));
}

const char *text_options_role(const TextOptions *options, const char *file) {
    for (int i = options->role_count - 1; i >= 0; i--) {
        const RoleRow *row = &options->role[i];
        if (!fnmatch(row->pattern, file, 0) || !fnmatch(row->pattern, path_name(file), 0))
            return row->role;
    }
    return NULL;
}
