#include "import/luminaire/luminaire_scan.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "spectrum/illuminant.h"

bool luminaire_scan_open(const char *file, const FileBytes *bytes, LuminaireNumber *number,
                         ImportSet *set, LuminaireScan *out, Error *err)
{
    *out = (LuminaireScan){.number = number, .line = -1, .arena = set->arena, .err = err};
    if (bytes)
        return text_file_decode(file, *bytes, ENCODING_AUTO, set->arena, &out->text, err);
    return text_file_read(file, ENCODING_AUTO, set->arena, &out->text, err);
}

bool luminaire_scan_count(LuminaireScan *scan, const char *what, int low, int high, int *out)
{
    double value;
    if (!scan->number(scan, what, low, high, &value)) return false;
    *out = (int)value;
    return value == floor(value) ||
           luminaire_scan_fail(scan, "%s is %g, wanted a whole number", what, value);
}

bool luminaire_scan_angles(LuminaireScan *scan, const char *what, int count, double most,
                           double *angle)
{
    for (int i = 0; i < count; i++) {
        if (!scan->number(scan, what, 0, most, &angle[i])) return false;
        if (i && !(angle[i] > angle[i - 1]))
            return luminaire_scan_fail(scan, "%s %g follows %g, wanted rising angles", what,
                                       angle[i], angle[i - 1]);
    }
    return true;
}

bool luminaire_scan_intensities(LuminaireScan *scan, double scale, Luminaire *out)
{
    size_t total = (size_t)out->planes * (size_t)out->gammas;
    out->intensity_cd = ARENA_NEW(scan->arena, double, total);
    for (size_t i = 0; i < total; i++) {
        if (!scan->number(scan, "an intensity", -1e9, 1e9, &out->intensity_cd[i])) return false;
        out->intensity_cd[i] *= scale;
    }
    return true;
}

double luminaire_scan_cct(const char *text, int length)
{
    char  words[24], *after;
    if (length >= (int)sizeof words) return 0;
    snprintf(words, sizeof words, "%.*s", length, text);
    double kelvin = strtod(words, &after);
    bool   is_plain = after != words;
    after += strspn(after, " \t");
    if (*after == 'K' || *after == 'k') after++;
    after += strspn(after, " \t\r");
    return is_plain && !*after && kelvin >= CCT_LEAST_K && kelvin <= CCT_MOST_K ? kelvin : 0;
}

bool luminaire_scan_fail(const LuminaireScan *scan, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    error_at_list(scan->err, ERROR_INPUT, scan->text.file,
                  text_place(scan->line, scan->arena), format, list);
    va_end(list);
    return false;
}
