/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/common/fit_options.h"

#include <stdarg.h>

void fit_note(FitNotes *notes, const char *format, ...)
{
    if (notes->count == FIT_NOTES_MAX) return;
    va_list args;
    va_start(args, format);
    notes->text[notes->count++] = arena_format_list(notes->arena, 511, format, args);
    va_end(args);
}
