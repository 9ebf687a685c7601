/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/common/fit_options.h"

#include <math.h>
#include <stdarg.h>

float fit_haar_share(const FitOptions *options, double numbers, double leaves, int components) {
    double rows = FIT_HAAR_SOURCE * sizeof(float) * numbers / (2 * components + 8);
    return options->keep_share > 0 ? options->keep_share : (float)fmin(1, rows / leaves);
}

void fit_note(FitNotes *notes, const char *format, ...) {
    if (notes->count == FIT_NOTES_MAX) return;
    va_list args;
    va_start(args, format);
    notes->text[notes->count++] = arena_format_list(notes->arena, 511, format, args);
    va_end(args);
}
