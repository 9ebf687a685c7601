/* text_scan.h -- a text file's numbers as rows of named columns, and what it says of itself.
 *
 * Lists and matrices (one or more labelled blocks over one grid) both become one table of rows.
 *
 * Memory   the arena's. Threads: no shared state.
 * Fails    with the file, the line, what was found and what was wanted.
 */
#pragma once
#include "import/text/import_text.h"

typedef struct RawColumn {
    ColumnName  name;
    const char *text; /* as the file or the user writes it */
    int         from; /* cell of a row */
} RawColumn;

typedef struct RawTable {
    const char *file;
    RawColumn   column[TEXT_COLUMNS_MAX];
    int         columns, rows, capacity;
    double     *cell;    /* rows x columns; NAN: marked as not measured */
    int        *line;    /* index of each row's line */
} RawTable;

/* What stands beside the numbers; a line index is -1 when nothing was said. */
typedef struct TextSaid {
    AzimuthWords azimuth;
    int          zero_line, sense_line, side_line;
    ValueUnit    unit;
    int          unit_line;
    AngleUnit    angle;
    int          angle_line;
    double       wavelength_nm;  /* 0: not said */
    bool         has_incidence;
    double       incidence_deg;
    char         words[256];     /* of pattern, colour and level */
    int          words_line;
    const char  *panel, *instrument; /* NULL: not said */
    int          unused_columns;
} TextSaid;

/* `out` and `said` are filled; there is at least one row. */
bool text_scan(const char *file, const TextDeclaration *declared, Arena *arena, RawTable *out,
               TextSaid *said, Error *err);

/* What a line that is no row of numbers says; its index is for messages. */
void text_said_line(TextSaid *said, TextLine line, int index, Arena *arena);
