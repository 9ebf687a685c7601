/* SPDX-License-Identifier: Apache-2.0 */
/* record_write.h -- a struct as JSON, by the rows of its format.
 *
 * Members stand in the order of the rows. A number that is not finite is null, and so is a text
 * that is NULL; of a row that is RECORD_BRIEF both are left out. Files and names of other items
 * are not written: nobody reads them back.
 *
 * Memory   the caller releases the document. Threads: pure. Fails: NULL without memory.
 */
#pragma once
#include "record/record.h"

json_t *record_write(const RecordFormat *format, const void *item);
json_t *record_write_list(const RecordFormat *format, const void *items, int count);

/* For the program itself, which gets the same again to the last bit: with the rows that are
 * RECORD_KEPT, and what is infinite or no UTF-8. */
json_t *record_keep(const RecordFormat *format, const void *item);

/* One member; item: what the row's offset counts from. NULL: it is left out. */
json_t *record_write_value(const RecordRow *row, const void *item);
