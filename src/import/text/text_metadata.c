/* SPDX-License-Identifier: Apache-2.0 */
#include "import/text/text_metadata.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "import/set/import.h"

#define KEY_LENGTH 48

typedef struct KeyValue {
    char     key[KEY_LENGTH]; /* lower case; blanks and underscores left out */
    TextLine value;
} KeyValue;

/* "Sample;blue 127", "Unit: cd/m2", "level = 255". No separator: the key is empty. */
static KeyValue cut_key(TextLine line)
{
    KeyValue pair = {.value = line};
    int      i = 0, n = 0;
    while (i < line.length && !strchr(":;=,\t", line.text[i])) i++;
    if (i == line.length) return pair;
    for (int k = 0; k < i && n < KEY_LENGTH - 1; k++)
        if (!strchr(" _-[]\"", line.text[k]))
            pair.key[n++] = (char)tolower((unsigned char)line.text[k]);
    while (i < line.length && strchr(":;=,\t \"", line.text[i])) i++;
    pair.value = (TextLine){line.text + i, line.length - i};
    while (pair.value.length && strchr(";,\t \"", pair.value.text[pair.value.length - 1]))
        pair.value.length--;
    return pair;
}

static bool key_is(const KeyValue *pair, const char *const *names)
{
    return import_word_find(names, pair->key) >= 0;
}

/* The number at the value's beginning, with a decimal point or comma. */
static bool value_number(const KeyValue *pair, double *out)
{
    char digits[32] = {0}, *after;
    for (int i = 0; i < pair->value.length && i < 31; i++)
        digits[i] = pair->value.text[i] == ',' ? '.' : pair->value.text[i];
    *out = strtod(digits, &after);
    return after != digits && *out >= -1e6 && *out <= 1e6;
}

static void read_azimuth(TextMetadata *metadata, TextLine line, int index)
{
    bool about = line_has(line, "azim") || line_has(line, "phi") ||
                 line_has(line, "clockwise") || line_has(line, "orientation");
    if (!about) return;
    AzimuthWords words = azimuth_words(line);
    if (words.has_zero) {
        metadata->azimuth.has_zero = true;
        metadata->azimuth.zero_deg = words.zero_deg;
        metadata->zero_line = index;
    }
    if (words.has_sense) {
        metadata->azimuth.has_sense = true;
        metadata->azimuth.sense = words.sense;
        metadata->sense_line = index;
    }
    if (words.has_side) {
        metadata->azimuth.has_side = true;
        metadata->azimuth.is_behind = words.is_behind;
        metadata->side_line = index;
    }
}

static void read_units(TextMetadata *metadata, const KeyValue *pair, int index)
{
    static const char *const unit_keys[] = {"unit", "units", "einheit", "valueunit",
                                            "luminanceunit", NULL};
    static const char *const angle_keys[] = {"angleunit", "angleunits", "angles", "angle",
                                             "winkel", NULL};
    if (key_is(pair, unit_keys) || !pair->key[0]) { /* or the unit alone */
        ValueUnit unit = value_unit((TextCell){pair->value.text, pair->value.length});
        if (unit != UNIT_AUTO) {
            metadata->unit = unit;
            metadata->unit_line = index;
        }
    }
    if (key_is(pair, angle_keys)) {
        AngleUnit unit = line_has(pair->value, "rad") ? ANGLE_RADIANS
                         : line_has(pair->value, "deg") ? ANGLE_DEGREES : ANGLE_AUTO;
        if (unit != ANGLE_AUTO) {
            metadata->angle = unit;
            metadata->angle_line = index;
        }
    }
}

static void read_pattern(TextMetadata *metadata, const KeyValue *pair, int index)
{
    static const char *const keys[] = {"sample", "pattern", "testpattern", "colour", "color",
        "farbe", "muster", "stimulus", "content", "image", "primary", "level", "greylevel",
        "graylevel", "grey", "gray", "code", "rgb", NULL};
    if (!key_is(pair, keys)) return;
    size_t length = strlen(metadata->words);
    snprintf(metadata->words + length, sizeof metadata->words - length, "%s%.*s",
             length ? " " : "", pair->value.length, pair->value.text);
    metadata->words_line = index;
}

static void read_light(TextMetadata *metadata, const KeyValue *pair)
{
    static const char *const incidence[] = {"incidence", "angleofincidence", "incidenceangle",
        "thetai", "aoi", "thetain", "incidencedeg", NULL};
    static const char *const wavelength[] = {"wavelength", "wavelengthnm", "lambda", NULL};
    double number;
    if (key_is(pair, incidence) && value_number(pair, &number)) {
        metadata->has_incidence = true;
        metadata->incidence_deg = number;
    }
    if (key_is(pair, wavelength) && value_number(pair, &number) &&
        number >= 100 && number <= 20000)
        metadata->wavelength_nm = number;
}

static void read_names(TextMetadata *metadata, const KeyValue *pair, Arena *arena)
{
    static const char *const panel[] = {"panel", "display", "device", "dut", "model", NULL};
    static const char *const instrument[] = {"instrument", "messger\xC3\xA4t", "conoscope",
                                             NULL};
    static const char *const date[] = {"date", "datum", "measurementdate", "messdatum", NULL};
    static const char *const person[] = {"operator", "bediener", "measuredby", NULL};
    if (pair->value.length < 1 || pair->value.length > 200) return;
    char *value = arena_string(arena, pair->value.text, (size_t)pair->value.length);
    if (key_is(pair, panel) && !metadata->panel) metadata->panel = value;
    if (key_is(pair, instrument) && !metadata->instrument) metadata->instrument = value;
    if (key_is(pair, date) && !metadata->date) metadata->date = value;
    if (key_is(pair, person) && !metadata->operator_name) metadata->operator_name = value;
}

TextMetadata text_metadata(void)
{
    return (TextMetadata){.zero_line = -1, .sense_line = -1, .side_line = -1, .unit_line = -1,
                          .angle_line = -1, .words_line = -1};
}

void text_metadata_read_line(TextMetadata *metadata, TextLine line, int index, Arena *arena)
{
    KeyValue pair = cut_key(line);
    read_azimuth(metadata, line, index);
    read_units(metadata, &pair, index);
    if (!pair.key[0]) return;
    read_pattern(metadata, &pair, index);
    read_light(metadata, &pair);
    read_names(metadata, &pair, arena);
}
