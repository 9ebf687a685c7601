#include "panel/fit/common/fit_note.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void fit_note(FitNotes *notes, const char *format, ...)
{
    char    text[512];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if (notes->count < FIT_NOTES_MAX)
        notes->text[notes->count++] = arena_string(notes->arena, text, strlen(text));
}
