/* SPDX-License-Identifier: Apache-2.0 */
#include "import/text/text_names.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/count.h"

#define NAME_LENGTH 64

/* A name in its parts: "Theta [deg]" is "Theta" and "deg"; "400nm" is "", "nm" and 400. */
typedef struct Parts {
    char   base[NAME_LENGTH], unit[NAME_LENGTH]; /* base keeps its case */
    bool   has_number;
    double number;
} Parts;

/* ---- units ------------------------------------------------------------------------------- */

typedef struct UnitName {
    const char *name; /* lower case without blanks, ^, brackets */
    ValueUnit   unit;
} UnitName;

static const UnitName unit_names[] = {
    {"cd/m2", UNIT_CD_M2}, {"cdm-2", UNIT_CD_M2}, {"cdm2", UNIT_CD_M2}, {"nit", UNIT_NIT},
    {"nits", UNIT_NIT}, {"nt", UNIT_NIT}, {"fl", UNIT_FOOT_LAMBERT},
    {"ftl", UNIT_FOOT_LAMBERT}, {"ft-l", UNIT_FOOT_LAMBERT},
    {"footlambert", UNIT_FOOT_LAMBERT}, {"footlamberts", UNIT_FOOT_LAMBERT},
    {"kcd/m2", UNIT_KCD_M2}, {"cd/ft2", UNIT_CD_FT2}, {"1/sr", UNIT_BRDF},
    {"sr-1", UNIT_BRDF}, {"/sr", UNIT_BRDF}, {"sr", UNIT_BRDF}, {"brdf", UNIT_BRDF},
    {"bsdf", UNIT_BRDF}, {"brdf*cos", UNIT_BRDF_COS}, {"bsdf*cos", UNIT_BRDF_COS},
    {"brdfcos", UNIT_BRDF_COS}, {"ccbrdf", UNIT_BRDF_COS}, {"ccbsdf", UNIT_BRDF_COS},
    {"brf", UNIT_FACTOR}, {"factor", UNIT_FACTOR}, {"radiancefactor", UNIT_FACTOR},
    {"reflectancefactor", UNIT_FACTOR}, {"signal", UNIT_SIGNAL}, {"counts", UNIT_SIGNAL},
};

ValueUnit value_unit(TextCell cell)
{
    char plain[NAME_LENGTH];
    int  n = 0;
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
    for (int i = 0; i < COUNT_OF(unit_names); i++)
        if (!strcmp(unit_names[i].name, plain)) return unit_names[i].unit;
    return UNIT_AUTO;
}

const char *value_unit_name(ValueUnit unit)
{
    static const char *const names[] = {"not told", "cd/m2", "nit", "fL", "kcd/m2", "cd/ft2",
                                        "brdf", "brdf-cos", "factor", "signal"};
    return names[unit];
}

/* One foot-lambert is 1/pi candela a square foot, 3.4262591 cd m^-2. */
double value_unit_cd_m2(ValueUnit unit)
{
    static const double factors[] = {0, 1, 1, 3.4262590996353905, 1000, 10.763910416709722, 0,
                                     0, 0, 0};
    return factors[unit];
}

/* ---- columns ----------------------------------------------------------------------------- */

static int digits_at(TextCell cell, int i)
{
    int count = 0;
    while (i + count < cell.length && isdigit((unsigned char)cell.text[i + count])) count++;
    return count;
}

/* The name ends before a bracket, a number that can be a wavelength, or the stroke of a unit
 * ("theta/deg", but not the one inside "cd/m2" or "1/sr"). */
static bool ends_base(TextCell cell, int i)
{
    char c = cell.text[i];
    if (strchr("([=", c)) return true;
    if (isdigit((unsigned char)c)) return digits_at(cell, i) >= 3;
    return c == '/' && !(i && strchr("dD1", cell.text[i - 1]));
}

static int read_number(TextCell cell, int i, Parts *parts)
{
    char digits[NAME_LENGTH];
    int  count = 0;
    while (i < cell.length && count < NAME_LENGTH - 1 &&
           (isdigit((unsigned char)cell.text[i]) || strchr(".,", cell.text[i]))) {
        digits[count++] = cell.text[i] == ',' ? '.' : cell.text[i];
        i++;
    }
    digits[count] = 0;
    parts->number = strtod(digits, NULL);
    parts->has_number = true;
    return i;
}

static Parts name_parts(TextCell cell)
{
    Parts parts = {.has_number = false};
    int   i = 0, n = 0;
    while (i < cell.length && n < NAME_LENGTH - 1 && !ends_base(cell, i))
        parts.base[n++] = cell.text[i++];
    while (n && strchr(" _-.", parts.base[n - 1])) n--;
    parts.base[n] = 0;
    if (i < cell.length && isdigit((unsigned char)cell.text[i]))
        i = read_number(cell, i, &parts);
    n = 0;
    for (; i < cell.length && n < NAME_LENGTH - 1; i++)
        if (!strchr(" ([])_=", cell.text[i])) parts.unit[n++] = cell.text[i];
    parts.unit[n] = 0;
    if (parts.unit[0] == '/') memmove(parts.unit, parts.unit + 1, (size_t)n);
    return parts;
}

AngleUnit angle_unit(const char *unit)
{
    if (!strncasecmp(unit, "deg", 3) || !strcmp(unit, "\xC2\xB0")) return ANGLE_DEGREES;
    return !strncasecmp(unit, "rad", 3) ? ANGLE_RADIANS : ANGLE_AUTO;
}

static bool is_unit(const char *text)
{
    return angle_unit(text) != ANGLE_AUTO ||
           value_unit((TextCell){text, (int)strlen(text)}) != UNIT_AUTO;
}

/* "theta_deg", "L_cd_m2": a unit behind the last underscores or blanks of the base. */
static void split_unit(Parts *parts)
{
    if (parts->has_number || is_unit(parts->unit)) return;
    for (char *at = parts->base; *at; at++) {
        if (at == parts->base || !strchr("_ ", *at) || !is_unit(at + 1)) continue;
        memmove(parts->unit, at + 1, strlen(at + 1) + 1);
        *at = 0;
        return;
    }
}

typedef struct QuantityName {
    const char *name;
    Quantity    quantity;
} QuantityName;

/* In any case, with blanks, underscores and hyphens left out. */
static const QuantityName loose_names[] = {
    {"theta", QUANTITY_THETA}, {"inclination", QUANTITY_THETA}, {"incl", QUANTITY_THETA},
    {"inclin", QUANTITY_THETA}, {"polar", QUANTITY_THETA}, {"polarangle", QUANTITY_THETA},
    {"zenith", QUANTITY_THETA}, {"\xCE\xB8", QUANTITY_THETA}, {"thetao", QUANTITY_THETA},
    {"thetaout", QUANTITY_THETA}, {"thetas", QUANTITY_THETA}, {"thetar", QUANTITY_THETA},
    {"neigung", QUANTITY_THETA},
    {"inclinaison", QUANTITY_THETA}, {"viewz", QUANTITY_THETA},
    {"viewtheta", QUANTITY_THETA}, {"thetaview", QUANTITY_THETA},
    {"phi", QUANTITY_PHI}, {"azimuth", QUANTITY_PHI}, {"azim", QUANTITY_PHI},
    {"azimut", QUANTITY_PHI}, {"azi", QUANTITY_PHI}, {"az", QUANTITY_PHI},
    {"\xCF\x86", QUANTITY_PHI},
    {"\xCF\x95", QUANTITY_PHI}, {"phio", QUANTITY_PHI}, {"phiout", QUANTITY_PHI},
    {"phis", QUANTITY_PHI}, {"phir", QUANTITY_PHI}, {"viewa", QUANTITY_PHI},
    {"viewphi", QUANTITY_PHI}, {"phiview", QUANTITY_PHI}, {"azimuthangle", QUANTITY_PHI},
    {"thetah", QUANTITY_HORIZONTAL}, {"horizontal", QUANTITY_HORIZONTAL},
    {"horizontalangle", QUANTITY_HORIZONTAL}, {"hangle", QUANTITY_HORIZONTAL},
    {"thetav", QUANTITY_VERTICAL}, {"vertical", QUANTITY_VERTICAL},
    {"verticalangle", QUANTITY_VERTICAL}, {"vangle", QUANTITY_VERTICAL},
    {"thetai", QUANTITY_INCIDENCE}, {"thetain", QUANTITY_INCIDENCE},
    {"incidence", QUANTITY_INCIDENCE}, {"incidenceangle", QUANTITY_INCIDENCE},
    {"angleofincidence", QUANTITY_INCIDENCE}, {"aoi", QUANTITY_INCIDENCE},
    {"thetainc", QUANTITY_INCIDENCE}, {"srcz", QUANTITY_INCIDENCE},
    {"phii", QUANTITY_LIGHT_PHI}, {"phiin", QUANTITY_LIGHT_PHI},
    {"phiinc", QUANTITY_LIGHT_PHI}, {"incidencephi", QUANTITY_LIGHT_PHI},
    {"incidenceazimuth", QUANTITY_LIGHT_PHI}, {"srca", QUANTITY_LIGHT_PHI},
    {"wavelength", QUANTITY_WAVELENGTH}, {"lambda", QUANTITY_WAVELENGTH},
    {"wavelengthnm", QUANTITY_WAVELENGTH}, {"wl", QUANTITY_WAVELENGTH},
    {"luminance", QUANTITY_LUMINANCE}, {"lum", QUANTITY_LUMINANCE},
    {"lv", QUANTITY_LUMINANCE}, {"leuchtdichte", QUANTITY_LUMINANCE},
    {"tristimulusx", QUANTITY_X}, {"tristimulusy", QUANTITY_Y}, {"tristimulusz", QUANTITY_Z},
    {"ciex", QUANTITY_CHROMA_X}, {"ciey", QUANTITY_CHROMA_Y},
    {"brdf", QUANTITY_REFLECTION}, {"bsdf", QUANTITY_REFLECTION},
    {"brf", QUANTITY_REFLECTION}, {"reflectance", QUANTITY_REFLECTION},
    {"reflectancefactor", QUANTITY_REFLECTION}, {"fr", QUANTITY_REFLECTION},
};

/* Where the case counts: X is no x. */
static const QuantityName exact_names[] = {
    {"X", QUANTITY_X}, {"Y", QUANTITY_Y}, {"Z", QUANTITY_Z}, {"L", QUANTITY_LUMINANCE},
    {"x", QUANTITY_CHROMA_X}, {"y", QUANTITY_CHROMA_Y}, {"u'", QUANTITY_UPRIME},
    {"v'", QUANTITY_VPRIME}, {"u\xE2\x80\x99", QUANTITY_UPRIME},
    {"v\xE2\x80\x99", QUANTITY_VPRIME}, {"u\xE2\x80\xB2", QUANTITY_UPRIME},
    {"v\xE2\x80\xB2", QUANTITY_VPRIME}, {"u_prime", QUANTITY_UPRIME},
    {"v_prime", QUANTITY_VPRIME}, {"uprime", QUANTITY_UPRIME}, {"vprime", QUANTITY_VPRIME},
    {"R", QUANTITY_CODE_R}, {"G", QUANTITY_CODE_G}, {"B", QUANTITY_CODE_B},
};

static Quantity named_quantity(const char *base)
{
    char loose[NAME_LENGTH];
    int  n = 0;
    for (int i = 0; i < COUNT_OF(exact_names); i++)
        if (!strcmp(exact_names[i].name, base)) return exact_names[i].quantity;
    for (const char *c = base; *c; c++)
        if (!strchr(" _-", *c)) loose[n++] = (char)tolower((unsigned char)*c);
    loose[n] = 0;
    for (int i = 0; i < COUNT_OF(loose_names); i++)
        if (!strcmp(loose_names[i].name, loose)) return loose_names[i].quantity;
    return QUANTITY_NONE;
}

/* "400", "400 nm", "R_400nm", "brdf 550": a wavelength with words that may stand before it. */
static bool is_wavelength(const Parts *parts)
{
    static const char *const before[] = {"",       "w",   "wl",   "r",
                                         "f",      "fr",  "brdf", "bsdf",
                                         "lambda", "brf", "refl", "reflectance"};
    if (!parts->has_number || parts->number < 100 || parts->number > 20000) return false;
    if (parts->unit[0] && strcasecmp(parts->unit, "nm") != 0) return false;
    for (int i = 0; i < COUNT_OF(before); i++)
        if (!strcasecmp(parts->base, before[i])) return true;
    return false;
}

ColumnName column_name(TextCell cell)
{
    ColumnName name = {.quantity = QUANTITY_NONE};
    Parts      parts = name_parts(cell);
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

bool line_has(TextLine line, const char *words)
{
    int length = (int)strlen(words);
    for (int i = 0; i + length <= line.length; i++)
        if (!strncasecmp(line.text + i, words, (size_t)length)) return true;
    return false;
}

/* A word of its own: "cw" is not in "ccw". */
static bool has_word(TextLine line, const char *word)
{
    int length = (int)strlen(word);
    for (int i = 0; i + length <= line.length; i++) {
        bool begins = !i || !isalpha((unsigned char)line.text[i - 1]);
        bool ends = i + length == line.length || !isalpha((unsigned char)line.text[i + length]);
        if (begins && ends && !strncasecmp(line.text + i, word, (size_t)length)) return true;
    }
    return false;
}

AzimuthWords azimuth_words(TextLine line)
{
    static const struct { const char *word; double zero_deg; } zeros[] = {
        {"12 o", 90}, {"12 oclock", 90}, {"3 o", 0}, {"3 oclock", 0}, {"6 o", 270},
        {"6 oclock", 270}, {"9 o", 180}, {"9 oclock", 180}, {"top", 90}, {"up", 90},
        {"right", 0}, {"bottom", 270}, {"down", 270}, {"left", 180}};
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
