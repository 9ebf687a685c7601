#include "scene/check/check.h"

#include <stdarg.h>
#include <stdio.h>

#include "scene/gltf/document.h"

static void report(const DocumentCheck *check, Severity severity, const GltfValue *at,
                   const char *format, va_list args)
{
    char message[1024];
    vsnprintf(message, sizeof message, format, args);
    if (severity == SEVERITY_ERROR)
        file_error(check->file, at, "%s", message);
    else
        file_warning(check->file, at, "%s", message);
}

void check_fails(const DocumentCheck *check, const GltfValue *at, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    report(check, check->severity, at, format, args);
    va_end(args);
}

void check_warns(const DocumentCheck *check, const GltfValue *at, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    report(check, SEVERITY_WARNING, at, format, args);
    va_end(args);
}
