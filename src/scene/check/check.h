/* SPDX-License-Identifier: Apache-2.0 */
/* check.h -- what a check of a glTF document finds, and where.
 *
 * An error is what makes the picture undefined or wrong; what breaks the specification but
 * leaves no doubt about the picture is a warning. Parts that are skipped (animations,
 * extensions that are not shown) warn only.
 */
#pragma once
#include "scene/gltf/loader.h"

typedef struct DocumentCheck {
    GltfFile *file;
    Severity severity; /* of what is found here */
} DocumentCheck;

/* A problem of the check's severity. */
void check_fails(const DocumentCheck *check, const GltfValue *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void check_warns(const DocumentCheck *check, const GltfValue *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
