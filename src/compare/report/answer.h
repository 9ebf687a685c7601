/* SPDX-License-Identifier: Apache-2.0 */
/* answer.h -- the answers of all pairs as one document, of which JSON, JUnit XML and the lines of
 * folders are made.
 *
 * Memory   documents are jansson's, until answer_release. Threads: one thread at a time.
 * Fails    when the file cannot be written.
 */
#pragma once
#include <jansson.h>

#include "base/lines.h"
#include "compare/comparison.h"

typedef struct CompareAnswer {
    json_t *pairs; /* each as comparison_json's, or a line that says why there is none */
    int count, failed, different;
} CompareAnswer;

void answer_start(CompareAnswer *answer);
void answer_release(CompareAnswer *answer);

/* Each returns the pair's document, which stays the answer's. name: of the pair. */
json_t *answer_add(CompareAnswer *answer, const char *name, const Comparison *c);

/* A file that is on one side only. */
json_t *answer_add_missing(CompareAnswer *answer, const char *name, bool is_in_test);

/* A pair that cannot be compared; line: the error in words. */
json_t *answer_add_failed(CompareAnswer *answer, const char *name, const char *line,
                          const Error *error);

/* The document of two folders. The caller releases it. */
json_t *answer_json(const CompareAnswer *answer, Arena scratch);

/* Well-formed for any names: assets/pages/compare_junit.xml. */
bool answer_write_junit(const CompareAnswer *answer, const char *path, Error *err);
