/* SPDX-License-Identifier: Apache-2.0 */
/* junit.h -- the answer of a comparison as JUnit XML, which every CI service shows.
 *
 * Well-formed for any names: assets/pages/compare_junit.xml.
 *
 * Memory   its cases are jansson's, until junit_release. Threads: one thread at a time.
 * Fails    when the file cannot be written.
 */
#pragma once
#include <jansson.h>

#include "compare/comparison.h"

typedef struct Junit {
    json_t *cases;
    int failures, errors;
    double seconds;
} Junit;

void junit_start(Junit *junit);
void junit_release(Junit *junit);

/* A pair that was compared: a test case with its metrics, and a failure when it differs. */
void junit_add(Junit *junit, const char *name, const Comparison *c);

/* A pair that was not: is_error for an input that cannot be read, else a failure. */
void junit_add_failure(Junit *junit, const char *name, const char *why, bool is_error);

bool junit_write(const Junit *junit, const char *suite, const char *path, Error *err);
