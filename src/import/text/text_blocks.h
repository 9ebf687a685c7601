/* text_blocks.h -- matrices over one polar grid, one a quantity, as rows of a table.
 *
 * Memory   the arena's. Threads: one scan each.
 */
#pragma once
#include "import/text/import_text.h"

#define TEXT_BLOCKS_MAX 512

typedef struct TextBlock {
    ColumnName  name;  /* QUANTITY_NONE: no label */
    const char *label;
    const char *corner;
    int         line;  /* index of its head */
    int         down, capacity;
    double     *angle; /* of the head: across */
    double     *cell;  /* down x (1 + across) */
    int        *row_line;
} TextBlock;

typedef struct TextBlocks {
    const TextFile        *text;
    const TextDeclaration *declared;
    Arena      *arena;
    TextBlock  *block; /* TEXT_BLOCKS_MAX of them once there is one */
    int         count, across;
    int         header_cells; /* of a list: the cells that a row has */
    ColumnName  label;        /* for the block to come */
    const char *label_text;
} TextBlocks;

/* "[X]", "Luminance (cd/m2)", "Component;X": the label of the next block. */
bool text_blocks_label(TextBlocks *blocks, const TextCell *cell, int count);

/* A matrix begins: its corner and the angles across. */
bool text_blocks_begin(TextBlocks *blocks, const TextCell *cell, int count, char decimal,
                       int line, Error *err);

/* Room for the next row of the current block: its angle and its values. NULL: too many. */
double *text_blocks_row(TextBlocks *blocks, int line, Error *err);

/* Checks that all blocks have one grid and makes rows of them: theta, phi, quantities. */
struct RawTable;
bool text_blocks_finish(TextBlocks *blocks, struct RawTable *out, Error *err);
