/* SPDX-License-Identifier: Apache-2.0 */
#include "import/text/text_names.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

#include "base/count.h"
#include "base/number.h"

#define NAME_LENGTH 64

/* A name in its parts: "Theta [deg]" is "Theta" and "deg"; "400nm" is "", "nm" and 400. */
typedef struct Parts {
    char base[NAME_LENGTH], unit[NAME_LENGTH]; /* base keeps its case */
    bool has_number;
    double number;
} Parts;

/* ---- units ------------------------------------------------------------------------------- */

/* One quantity or unit, and what files call it. */
typedef struct WordMeaning {
    int meaning;
    const char *word[8]; /* up to NULL */
} WordMeaning;

/* 0: the word stands in no row. */
static int meaning_of(const WordMeaning *table, int count, const char *word) {
    for (int i = 0; i < count; i++)
        for (const char *const *one = table[i].word; *one; one++)
            if (!strcmp(*one, word)) return table[i].meaning;
    return 0;
}

/* In lower case without blanks, ^, brackets. */
static const WordMeaning unit_names[] = {
    {UNIT_CD_M2, {"cd/m2", "cdm-2", "cdm2"}},
    {UNIT_NIT, {"nit", "nits", "nt"}},
    {UNIT_FOOT_LAMBERT, {"fl", "ftl", "ft-l", "footlambert", "footlamberts"}},
    {UNIT_KCD_M2, {"kcd/m2"}},
    {UNIT_CD_FT2, {"cd/ft2"}},
    {UNIT_BRDF, {"1/sr", "sr-1", "/sr", "sr", "brdf", "bsdf"}},
    {UNIT_BRDF_COS, {"brdf*cos", "bsdf*cos", "brdfcos", "ccbrdf", "ccbsdf"}},
    {UNIT_FACTOR, {"brf", "factor", "radiancefactor", "reflectancefactor"}},
};

ValueUnit value_unit(TextCell cell) {
    char plain[NAME_LENGTH];
    int n = 0;
    for (int i = 0; i < cell.length && n < NAME_LENGTH - 3; i++) {
        unsigned char c = (unsigned char)cell.text[i];
        if (c == 0xC2 && i + 1 < cell.length) { /* superscripts two, three, one; the dot */
            unsigned char next = (unsigned char)cell.text[++i];
            if (next == 0xB2) plain[n++] = '2';
            if (next == 0xB7) plain[n++] = '*';
        } else if (!strchr(" ^[]()_.", c)) {
            plain[n++] = (char)tolower(c);
        }
    }
    plain[n] = 0;
    return (ValueUnit)meaning_of(unit_names, COUNT_OF(unit_names), plain);
}

const char *value_unit_name(ValueUnit unit) {
    static const char *const names[] = {"not told", "cd/m2", "nit",      "fL",    "kcd/m2",
                                        "cd/ft2",   "brdf",  "brdf-cos", "factor"};
    return names[unit];
}

/* One foot-lambert is 1/pi candela a square foot, 3.4262591 cd m^-2. */
double value_unit_cd_m2(ValueUnit unit) {
    static const double factors[] = {0, 1, 1, 3.4262590996353905, 1000, 10.763910416709722,
                                     0, 0, 0};
    return factors[unit];
}

/* ---- columns ----------------------------------------------------------------------------- */

static int digits_at(TextCell cell, int i) {
    int count = 0;
    while (i + count < cell.length && isdigit((unsigned char)cell.text[i + count])) count++;
    return count;
}

/* The name ends before a bracket, a number that can be a wavelength, or the stroke of a unit
 * ("theta/deg", but not the one inside "cd/m2" or "1/sr"). */
static bool ends_base(TextCell cell, int i) {
    char c = cell.text[i];
    if (strchr("([=", c)) return true;
    if (isdigit((unsigned char)c)) return digits_at(cell, i) >= 3;
    return c == '/' && !(i && strchr("dD1", cell.text[i - 1]));
}

static int read_number(TextCell cell, int i, Parts *parts) {
    char digits[NAME_LENGTH];
    int count = 0;
    while (i < cell.length && count < NAME_LENGTH - 1 &&
           (isdigit((unsigned char)cell.text[i]) || strchr(".,", cell.text[i]))) {
        digits[count++] = cell.text[i] == ',' ? '.' : cell.text[i];
        i++;
    }
    digits[count] = 0;
    parts->has_number = number_read(digits, &parts->number) != NULL;
    return i;
}

static Parts name_parts(TextCell cell) {
    Parts parts = {.has_number = false};
    int i = 0, n = 0;
    while (i < cell.length && n < NAME_LENGTH - 1 && !ends_base(cell, i))
        parts.base[n++] = cell.text[i++];
    while (n && strchr(" _-.", parts.base[n - 1])) n--;
    parts.base[n] = 0;
    if (i < cell.length && isdigit((unsigned char)cell.text[i])) i = read_number(cell, i, &parts);
    n = 0;
    for (; i < cell.length && n < NAME_LENGTH - 1; i++)
        if (!strchr(" ([])_=", cell.text[i])) parts.unit[n++] = cell.text[i];
    parts.unit[n] = 0;
    if (parts.unit[0] == '/') memmove(parts.unit, parts.unit + 1, (size_t)n);
    return parts;
}

AngleUnit angle_unit(const char *unit) {
    if (!strncasecmp(unit, "deg", 3) || !strcmp(unit, "\xC2\xB0")) return ANGLE_DEGREES;
    return !strncasecmp(unit, "rad", 3) ? ANGLE_RADIANS : ANGLE_AUTO;
}

static bool is_unit(const char *text) {
    return angle_unit(text) != ANGLE_AUTO ||
           value_unit((TextCell){text, (int)strlen(text)}) != UNIT_AUTO;
}

/* "theta_deg", "L_cd_m2": a unit behind the last underscores or blanks of the base. */
static void split_unit(Parts *parts) {
    if (parts->has_number || is_unit(parts->unit)) return;
    for (char *at = parts->base; *at; at++) {
        if (at == parts->base || !strchr("_ ", *at) || !is_unit(at + 1)) continue;
        memmove(parts->unit, at + 1, strlen(at + 1) + 1);
        *at = 0;
        return;
    }
}

/* In any case, with blanks, underscores and hyphens left out. */
static const WordMeaning loose_names[] = {
    {QUANTITY_THETA, {"theta", "inclination", "incl", "polar", "zenith", "thetaout", "thetas"}},
    {QUANTITY_PHI, {"phi", "azimuth", "azim", "az", "phiout", "phis"}},
    {QUANTITY_HORIZONTAL, {"thetah", "horizontal"}},
    {QUANTITY_VERTICAL, {"thetav", "vertical"}},
    {QUANTITY_INCIDENCE, {"thetai", "thetain", "incidence", "aoi"}},
    {QUANTITY_LIGHT_PHI, {"phii", "phiin"}},
    {QUANTITY_WAVELENGTH, {"wavelength", "lambda", "wavelengthnm"}},
    {QUANTITY_LUMINANCE, {"luminance", "lv"}},
    {QUANTITY_REFLECTION, {"brdf", "bsdf", "brf", "reflectance", "reflectancefactor", "fr"}},
};

/* Where the case counts: X is no x. */
static const WordMeaning exact_names[] = {
    {QUANTITY_X, {"X"}},
    {QUANTITY_Y, {"Y"}},
    {QUANTITY_Z, {"Z"}},
    {QUANTITY_LUMINANCE, {"L"}},
    {QUANTITY_CHROMA_X, {"x"}},
    {QUANTITY_CHROMA_Y, {"y"}},
    {QUANTITY_UPRIME, {"u'", "u\xE2\x80\x99", "u\xE2\x80\xB2", "u_prime", "uprime"}},
    {QUANTITY_VPRIME, {"v'", "v\xE2\x80\x99", "v\xE2\x80\xB2", "v_prime", "vprime"}},
    {QUANTITY_CODE_R, {"R"}},
    {QUANTITY_CODE_G, {"G"}},
    {QUANTITY_CODE_B, {"B"}},
};

static Quantity named_quantity(const char *base) {
    char loose[NAME_LENGTH];
    int n = 0;
    int exact = meaning_of(exact_names, COUNT_OF(exact_names), base);
    if (exact) return (Quantity)exact;
    for (const char *c = base; *c; c++)
        if (!strchr(" _-", *c)) loose[n++] = (char)tolower((unsigned char)*c);
    loose[n] = 0;
    return (Quantity)meaning_of(loose_names, COUNT_OF(loose_names), loose);
}

/* "400", "400 nm", "R_400nm", "brdf 550": a wavelength with words that may stand before it. */
static bool is_wavelength(const Parts *parts) {
    static const char *const before[] = {"",     "w",    "wl",     "r",   "f",    "fr",
                                         "brdf", "bsdf", "lambda", "brf", "refl", "reflectance"};
    if (!parts->has_number || parts->number < 100 || parts->number > 20000) return false;
    if (parts->unit[0] && strcasecmp(parts->unit, "nm") != 0) return false;
    for (int i = 0; i < COUNT_OF(before); i++)
        if (!strcasecmp(parts->base, before[i])) return true;
    return false;
}

ColumnName column_name(TextCell cell) {
    ColumnName name = {.quantity = QUANTITY_NONE};
    Parts parts = name_parts(cell);
    if (is_wavelength(&parts)) {
        name.quantity = QUANTITY_REFLECTION;
        name.wavelength_nm = parts.number;
        if (!strcasecmp(parts.base, "brf")) name.unit = UNIT_FACTOR;
        return name;
    }
    if (parts.has_number) return name;
    split_unit(&parts);
    name.is_ambiguous = !strcmp(parts.base, "u") || !strcmp(parts.base, "v");
    name.quantity = named_quantity(parts.base);
    name.angle = angle_unit(parts.unit);
    name.unit = value_unit((TextCell){parts.unit, (int)strlen(parts.unit)});
    if (name.quantity == QUANTITY_REFLECTION && name.unit == UNIT_AUTO)
        name.unit = value_unit((TextCell){parts.base, (int)strlen(parts.base)});
    return name;
}

/* ---- azimuths ---------------------------------------------------------------------------- */

bool line_has(TextLine line, const char *words) {
    int length = (int)strlen(words);
    for (int i = 0; i + length <= line.length; i++)
        if (!strncasecmp(line.text + i, words, (size_t)length)) return true;
    return false;
}

/* A word of its own: "cw" is not in "ccw". */
static bool has_word(TextLine line, const char *word) {
    int length = (int)strlen(word);
    for (int i = 0; i + length <= line.length; i++) {
        bool begins = !i || !isalpha((unsigned char)line.text[i - 1]);
        bool ends = i + length == line.length || !isalpha((unsigned char)line.text[i + length]);
        if (begins && ends && !strncasecmp(line.text + i, word, (size_t)length)) return true;
    }
    return false;
}

AzimuthWords azimuth_words(TextLine line) {
    static const struct {
        const char *word;
        double zero_deg;
    } zeros[] = {{"12 o", 90},  {"12 oclock", 90}, {"3 o", 0},   {"3 oclock", 0},
                 {"6 o", 270},  {"6 oclock", 270}, {"9 o", 180}, {"9 oclock", 180},
                 {"top", 90},   {"up", 90},        {"right", 0}, {"bottom", 270},
                 {"down", 270}, {"left", 180}};
    AzimuthWords words = {.sense = 1};
    for (int i = 0; i < COUNT_OF(zeros) && !words.has_zero; i++)
        if (has_word(line, zeros[i].word)) {
            words.has_zero = true;
            words.zero_deg = zeros[i].zero_deg;
        }
    bool is_left = line_has(line, "counter-clockwise") || line_has(line, "counterclockwise") ||
                   line_has(line, "counter clockwise") || line_has(line, "anticlockwise") ||
                   line_has(line, "anti-clockwise") || has_word(line, "ccw");
    bool is_right = !is_left && (line_has(line, "clockwise") || has_word(line, "cw"));
    words.has_sense = is_left || is_right;
    words.sense = is_right ? -1 : 1;
    words.is_behind = line_has(line, "from behind") || line_has(line, "from the back");
    words.has_side = words.is_behind || line_has(line, "from the front") ||
                     line_has(line, "by the viewer") || line_has(line, "by the instrument");
    return words;
}
