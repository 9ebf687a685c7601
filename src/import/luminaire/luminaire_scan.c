/* SPDX-License-Identifier: Apache-2.0 */
#include "import/luminaire/luminaire_scan.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>
#include <strings.h>

#include "base/count.h"
#include "base/number.h"
#include "spectrum/illuminant.h"

#define INTENSITY_MOST_CD 1e12
#define XML_LINES 16 /* in which a document says what it is */
#define TM33 "IESTM33"

bool luminaire_scan_open(const char *file, const FileBytes *bytes, LuminaireNumber *number,
                         ImportSet *set, LuminaireScan *out, Error *err) {
    *out = (LuminaireScan){
        .number = number, .line = -1, .arena = set->arena, .err = err, .comma = -1, .unit = -1};
    bool ok = bytes ? text_file_decode(file, *bytes, ENCODING_AUTO, set->arena, &out->text, err)
                    : text_file_read(file, ENCODING_AUTO, set->arena, &out->text, err);
    bool is_xml = ok && out->text.count && out->text.line[0].text[0] == '<';
    for (int i = 0; is_xml && i < out->text.count && i < XML_LINES; i++)
        if (memmem(out->text.line[i].text, (size_t)out->text.line[i].length, TM33, strlen(TM33)))
            return error_at(err, ERROR_INPUT, file, "",
                            "is of IES TM-33 (XML), required: IES LM-63 (.ies) or EULUMDAT (.ldt)");
    return ok;
}

bool luminaire_scan_is_tm33(const char *head, size_t size) {
    return memmem(head, size, "<" TM33, strlen("<" TM33));
}

bool luminaire_scan_count(LuminaireScan *scan, const char *what, int low, int high, int *out) {
    double value;
    if (!scan->number(scan, what, low, high, &value)) return false;
    *out = (int)value;
    return value == floor(value) ||
           luminaire_scan_fail(scan, "%s is %g, required: a whole number", what, value);
}

bool luminaire_scan_angles(LuminaireScan *scan, const char *what, int count, const double range[2],
                           double *angle) {
    for (int i = 0; i < count; i++) {
        if (!scan->number(scan, what, range[0], range[1], &angle[i])) return false;
        if (i && !(angle[i] > angle[i - 1]))
            return luminaire_scan_fail(scan, "%s %g follows %g, required: rising angles", what,
                                       angle[i], angle[i - 1]);
    }
    return true;
}

bool luminaire_scan_intensities(LuminaireScan *scan, double scale, Luminaire *out) {
    size_t total = (size_t)out->planes * (size_t)out->gammas;
    out->intensity_cd = ARENA_NEW(scan->arena, double, total);
    for (size_t i = 0; i < total; i++) {
        double *cd = &out->intensity_cd[i];
        if (!scan->number(scan, "an intensity", 0, 1e9, cd)) return false;
        *cd *= scale;
        if (*cd > INTENSITY_MOST_CD)
            return luminaire_scan_fail(scan,
                                       "an intensity is %g cd with the factors of the "
                                       "head, required: at most %g",
                                       *cd, INTENSITY_MOST_CD);
    }
    return true;
}

/* 840: Ra of the eighties, 4000 K. Codes that lamps are sold with. */
static double kelvins_of_code(double code) {
    static const int hundreds[] = {18, 20, 22, 25, 27, 30, 35, 40, 45, 50, 57, 60, 65, 80};
    if (!(code >= 600 && code < 1000)) return 0; /* Ra below 60 is sold under no code */
    int whole = (int)code;
    bool is_known = false;
    for (int i = 0; i < COUNT_OF(hundreds); i++) is_known |= whole % 100 == hundreds[i];
    return whole == code && is_known ? whole % 100 * 100.0 : 0;
}

static bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/* Stands there the unit of something else? Letters close behind the number are one. */
static bool is_other_unit(const char *after, const char *word) {
    static const char *const units[] = {"lm", "lumen", "lumens", "W", "watt", "h", "mA", "V"};
    size_t length = 0;
    while (is_letter(word[length])) length++;
    if (*word == '%' || (length && word == after)) return true;
    for (int i = 0; i < COUNT_OF(units); i++)
        if (length == strlen(units[i]) && !strncasecmp(word, units[i], length)) return true;
    return false;
}

/* Kelvins of a number with `before` in front of it and `after` behind; 0: it is none. */
static double kelvins_of(double number, char before, const char *after, CctSource source) {
    const char *word = after + strspn(after, " \t");
    bool is_kelvin = (*word == 'K' || *word == 'k') && !is_letter(word[1]);
    bool in_range = number >= CCT_LEAST_K && number <= CCT_MOST_K;
    if (is_kelvin) return in_range ? number : 0;
    if (is_letter(before) || is_other_unit(after, word)) return 0;
    if (source == CCT_OF_LAMP) return before == '/' ? kelvins_of_code(number) : 0;
    return in_range ? number : kelvins_of_code(number);
}

/* The one temperature that the text names; 0: none, or several. */
static double kelvins_in(const char *text, CctSource source) {
    double found = 0;
    for (const char *at = text; *at;) {
        if (*at < '0' || *at > '9') {
            at++;
            continue;
        }
        double number;
        const char *after = number_read(at, &number);
        if (!after) { /* of a size that is no temperature */
            at++;
            continue;
        }
        double kelvin = kelvins_of(number, at > text ? at[-1] : ' ', after, source);
        if (kelvin > 0 && found > 0 && kelvin != found) return 0;
        if (kelvin > 0) found = kelvin;
        at = after;
    }
    return found;
}

void luminaire_scan_cct(const char *text, CctSource source, Luminaire *out) {
    if (!text || out->cct_k > 0) return;
    out->cct_k = kelvins_in(text, source);
    bool says_nothing = !out->cct_text[0] && source == CCT_OF_COLOUR;
    if (out->cct_k > 0 || says_nothing) out->cct_text = text;
}

bool luminaire_scan_fail(const LuminaireScan *scan, const char *format, ...) {
    va_list list;
    va_start(list, format);
    error_at_list(scan->err, ERROR_INPUT, scan->text.file, text_place(scan->line, scan->arena),
                  format, list);
    va_end(list);
    return false;
}
