/* SPDX-License-Identifier: Apache-2.0 */
/* html_report.h -- a comparison as one self-contained HTML file, for those who look at it.
 *
 * It needs no network, and shows its pictures without script too. A report of two files holds
 * one pair; a report of folders begins with an index of all pairs and shows those that differ.
 *
 * Memory   a report owns the address space of its text: html_report_release gives it back.
 * Threads  one thread at a time.
 * Fails    when the file cannot be written; nothing is left of it then.
 */
#pragma once
#include <jansson.h>

#include "compare/comparison.h"
#include "text/text.h"

typedef struct HtmlReport {
    bool is_folder;
    Arena own[2];      /* of the two texts */
    Text index, pairs; /* cards, and what stands below them */
    int count, shown;  /* pairs; of these, below the index */
} HtmlReport;

/* The report must stay where it is until it is released. */
void html_report_start(HtmlReport *report, bool is_folder);
void html_report_release(HtmlReport *report);

/* pair: its document (answer.h). The comparison is not kept. */
bool html_report_add(HtmlReport *report, const json_t *pair, const Comparison *c, Arena scratch,
                     Error *err);

/* A pair that could not be compared: a file is missing or unreadable. */
void html_report_add_failure(HtmlReport *report, const json_t *pair);

/* folders: the document of both (answer.h), NULL of two files. sides: reference, test. */
bool html_report_write(const HtmlReport *report, const json_t *folders, const char *const sides[2],
                       const char *path, Error *err);

/* False for a name that is no HTML file's: to be checked before long work. */
bool html_report_check_name(const char *path, Error *err);
