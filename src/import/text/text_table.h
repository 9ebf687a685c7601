/* SPDX-License-Identifier: Apache-2.0 */
/* text_table.h -- a text file's rows as tables of the set.
 *
 * Memory   the set's arena. Threads: one set per thread.
 * Fails    with the file, the line, what was found and what was required.
 */
#pragma once
#include "import/text/text_conventions.h"

/* One table for each pattern or light; the conventions are found already. */
bool text_table_add(TextReader *in);
