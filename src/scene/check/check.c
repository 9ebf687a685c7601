/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/check.h"

#include <stdarg.h>

#include "scene/gltf/document.h"

void check_fails(const DocumentCheck *check, const GltfValue *at, const char *format, ...) {
    va_list args;
    va_start(args, format);
    file_report(check->file, check->severity, at, format, args);
    va_end(args);
}

void check_warns(const DocumentCheck *check, const GltfValue *at, const char *format, ...) {
    va_list args;
    va_start(args, format);
    file_report(check->file, SEVERITY_WARNING, at, format, args);
    va_end(args);
}
