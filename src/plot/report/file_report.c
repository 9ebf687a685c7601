/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/report/file_report.h"

#include "base/count.h"

/* All that the report holds is shown: known words get readable names and units, unknown ones
 * stand as they are. */
static const Column WORDS[] = {
    COLUMN_TEXT("name", "table"),
    COLUMN_FIXED("source_bytes_text", "text", "bytes", 0),
    {.key = "source_bytes_float32"},
    COLUMN_FIXED("stored_values", "values", NULL, 0),
    COLUMN_FIXED("bytes", "bytes", NULL, 0),
    COLUMN_DIGITS("ratio", "ratio", NULL, 4),
    {.key = "ratio_text"},
    COLUMN_SHARE("max_error", "largest error"),
    COLUMN_FIXED("outliers", "outliers left out", NULL, 0),
    COLUMN_SHARE("outliers_max_error", "of outliers, largest"),
    COLUMN_SHARE("rms_error", "rms error"),
    COLUMN_SHARE("integral_error", "integral error"),
    COLUMN_SHARE("albedo_error", "albedo error"),
    COLUMN_SHARE("noise", "noise"),
    COLUMN_SHARE("tolerance", "bound required"),
    COLUMN_SHARE("bound", "bound met"),
    COLUMN_SHARE("extrapolated_share", "extrapolated"),
};

Table *panel_file_table(const json_t *report, Arena *arena) {
    const json_t *total = json_object_get(report, "total");
    Table *table =
        table_of_objects(WORDS, COUNT_OF(WORDS), json_object_get(report, "tables"), arena);
    if (!table || !total) return table;
    table->total_row = table->row_count;
    table_add_object(table, total);
    return table;
}
