/* SPDX-License-Identifier: Apache-2.0 */
/* format_table.h -- every format of JSON that is read by rows (record/record.h). */
#pragma once
#include "record/record.h"

typedef struct NamedFormat {
    const char *name, *title;
    const RecordFormat *format;
} NamedFormat;

extern const NamedFormat format_table[];
extern const int format_count;
extern const int schema_count; /* with our extensions of glTF behind them, whose rows a
                                  document is checked by (scene/check) */
