/* SPDX-License-Identifier: Apache-2.0 */
/* junit.h -- the answer of a comparison as JUnit XML, which every CI service shows.
 *
 * Well-formed for any names. Memory: owns the address space of its text until
 * junit_release. Threads: one thread at a time.
 * Fails    when the file cannot be written.
 */
#pragma once
#include "compare/comparison.h"
#include "text/text.h"

typedef struct Junit {
    Arena  own; /* of the text */
    Text   cases;
    int    count, failures, errors;
    double seconds;
} Junit;

/* It must stay where it is until it is released. */
void junit_start(Junit *junit);
void junit_release(Junit *junit);

/* A pair that was compared: a test case with its metrics, and a failure when it differs. */
void junit_add(Junit *junit, const char *name, const Comparison *c);

/* A pair that was not: is_error for an input that cannot be read, else a failure. */
void junit_add_failure(Junit *junit, const char *name, const char *why, bool is_error);

bool junit_write(const Junit *junit, const char *suite, const char *path, Error *err);
