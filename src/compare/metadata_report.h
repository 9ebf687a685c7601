/* SPDX-License-Identifier: Apache-2.0 */
/* metadata_report.h -- differences of metadata in words: one line, however many they are.
 *
 * Memory   the lines' arena. Threads: one at a time. Fails: never.
 */
#pragma once
#include "compare/lines.h"
#include "compare/metadata.h"

/* One reason for all rows that decide what the picture shows, one note (with `strict` a
 * reason) for all that explain it. A single row is reported with both values; of several, the
 * names, some values and their number. */
void metadata_report(const MetadataRow *rows, int count, bool strict, Lines *reasons,
                     Lines *notes);
