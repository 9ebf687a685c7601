/* SPDX-License-Identifier: Apache-2.0 */
#include "import/text/text_blocks.h"

#include <math.h>
#include <string.h>

/* ---- labels ------------------------------------------------------------------------------ */

static TextCell without_brackets(TextCell cell) {
    if (cell.length > 2 && cell.text[0] == '[' && cell.text[cell.length - 1] == ']')
        cell = (TextCell){cell.text + 1, cell.length - 2};
    if (cell.length > 1 && strchr(":=", cell.text[cell.length - 1])) cell.length--;
    return cell;
}

bool text_blocks_label(TextBlocks *blocks, const TextCell *cell, int count) {
    while (count > 1 && !cell[count - 1].length) count--;
    if (count > 1) return false;
    TextCell text = without_brackets(cell[0]);
    ColumnName name = column_name(text);
    if (name.quantity < QUANTITY_X) return false;
    blocks->label = name;
    blocks->label_text = arena_string(blocks->arena, text.text, (size_t)text.length);
    return true;
}

/* ---- rows -------------------------------------------------------------------------------- */

bool text_blocks_begin(TextBlocks *blocks, const TextCell *cell, int count, char decimal, int line,
                       Error *err) {
    const char *file = blocks->text->file;
    while (count > 2 && !cell[count - 1].length) count--;
    if (!blocks->block) blocks->block = ARENA_NEW(blocks->arena, TextBlock, TEXT_BLOCKS_MAX);
    if (blocks->count == TEXT_BLOCKS_MAX)
        return error_at(err, ERROR_INPUT, file, text_place(line, blocks->arena),
                        "is one matrix too many, required: at most %d", TEXT_BLOCKS_MAX);
    if (blocks->count && count - 1 != blocks->across)
        return error_at(err, ERROR_INPUT, file, text_place(line, blocks->arena),
                        "has %d angles across, required: the %d of the matrix "
                        "before",
                        count - 1, blocks->across);
    blocks->across = count - 1;
    TextBlock *block = &blocks->block[blocks->count++];
    *block =
        (TextBlock){.name = blocks->label,
                    .label = blocks->label_text,
                    .line = line,
                    .corner = arena_string(blocks->arena, cell[0].text, (size_t)cell[0].length),
                    .angle = ARENA_NEW(blocks->arena, double, count)};
    for (int i = 1; i < count; i++)
        if (!text_number(cell[i], decimal, &block->angle[i - 1]))
            return error_at(err, ERROR_INPUT, file, text_place(line, blocks->arena),
                            "'%.*s' is no angle", cell[i].length < 40 ? cell[i].length : 40,
                            cell[i].text);
    blocks->label = (ColumnName){.quantity = QUANTITY_NONE};
    blocks->label_text = NULL;
    return true;
}

double *text_blocks_row(TextBlocks *blocks, int line, Error *err) {
    TextBlock *block = &blocks->block[blocks->count - 1];
    if ((double)block->down.count * (double)blocks->across >= IMPORT_ROWS_MAX) {
        error_at(err, ERROR_INPUT, blocks->text->file, text_place(line, blocks->arena),
                 "is one row too many, required: at most %d directions", IMPORT_ROWS_MAX);
        return NULL;
    }
    block->down.width = blocks->across + 1;
    return text_rows_add(&block->down, line, blocks->arena);
}

/* ---- which angle runs down --------------------------------------------------------------- */

/* The names of the first column and the first row in the corner: "Incl\Azim". */
static void corner_names(const char *corner, ColumnName name[2]) {
    size_t first = strcspn(corner, "\\/|,;");
    const char *rest = corner + first + (corner[first] != 0);
    name[0] = column_name((TextCell){corner, (int)first});
    name[1] = column_name((TextCell){rest, (int)strlen(rest)});
}

static TableLayout corner_layout(const ColumnName name[2]) {
    if (name[0].quantity == QUANTITY_THETA || name[1].quantity == QUANTITY_PHI)
        return LAYOUT_THETA_DOWN;
    if (name[0].quantity == QUANTITY_PHI || name[1].quantity == QUANTITY_THETA)
        return LAYOUT_PHI_DOWN;
    if (name[0].quantity == QUANTITY_HORIZONTAL || name[1].quantity == QUANTITY_VERTICAL)
        return LAYOUT_HORIZONTAL_DOWN;
    if (name[0].quantity == QUANTITY_VERTICAL || name[1].quantity == QUANTITY_HORIZONTAL)
        return LAYOUT_VERTICAL_DOWN;
    return LAYOUT_AUTO;
}

static const char *name_of_down(TableLayout layout) {
    static const char *const names[] = {
        "", "", "theta", "phi", "the horizontal angle", "the vertical angle"};
    return names[layout];
}

static bool choose_layout(const TextBlocks *blocks, const ColumnName name[2], TableLayout *out,
                          Error *err) {
    const TextBlock *block = &blocks->block[0];
    const char *at = text_place(block->line, blocks->arena);
    TableLayout given = blocks->options->layout, found = corner_layout(name);
    if (given != LAYOUT_AUTO && found != LAYOUT_AUTO && given != found)
        return error_at(err, ERROR_INPUT, blocks->text->file, at,
                        "the corner '%s' says that %s runs down, and --table says the other",
                        block->corner, name_of_down(found));
    *out = given != LAYOUT_AUTO ? given : found;
    if (*out != LAYOUT_AUTO) return true;
    return error_at(err, ERROR_INPUT, blocks->text->file, at,
                    "does not tell whether theta runs down or across — say --table theta-down "
                    "or phi-down");
}

/* ---- to rows ----------------------------------------------------------------------------- */

static bool same_grid(const TextBlocks *blocks, const TextBlock *block, Error *err) {
    const TextBlock *first = &blocks->block[0];
    size_t width = (size_t)blocks->across + 1;
    bool same = block->down.count == first->down.count &&
                !memcmp(block->angle, first->angle, sizeof(double) * (width - 1));
    for (size_t i = 0; same && i < (size_t)block->down.count; i++)
        same = block->down.cell[i * width] == first->down.cell[i * width];
    return same ||
           error_at(err, ERROR_INPUT, blocks->text->file, text_place(block->line, blocks->arena),
                    "begins a matrix over other angles than the one of %s, required: "
                    "one grid in a file",
                    text_place(first->line, blocks->arena));
}

static bool add_quantities(const TextBlocks *blocks, NamedRows *out, Error *err) {
    for (int b = 0; b < blocks->count; b++) {
        const TextBlock *block = &blocks->block[b];
        if (!same_grid(blocks, block, err)) return false;
        for (int k = 0; k < b; k++)
            if (blocks->block[k].name.quantity == block->name.quantity &&
                blocks->block[k].name.wavelength_nm == block->name.wavelength_nm)
                return error_at(err, ERROR_INPUT, blocks->text->file,
                                text_place(block->line, blocks->arena),
                                "begins a matrix of the same quantity (%s) as %s — label each, "
                                "as [X], [Y], [Z] or [550 nm]",
                                block->label ? block->label : "no label",
                                text_place(blocks->block[k].line, blocks->arena));
        out->column[out->rows.width++] =
            (NamedColumn){block->name, block->label ? block->label : "", 0};
    }
    return true;
}

static void fill_rows(const TextBlocks *blocks, bool first_down, NamedRows *out) {
    const TextBlock *first = &blocks->block[0];
    size_t width = (size_t)blocks->across + 1, columns = (size_t)out->rows.width;
    for (int i = 0; i < first->down.count; i++)
        for (int k = 0; k < blocks->across; k++) {
            size_t at = (size_t)i * width;
            double *row = out->rows.cell + (size_t)out->rows.count * columns;
            row[first_down ? 0 : 1] = first->down.cell[at];
            row[first_down ? 1 : 0] = first->angle[k];
            for (int b = 0; b < blocks->count; b++)
                row[2 + b] = blocks->block[b].down.cell[at + 1 + (size_t)k];
            out->rows.line[out->rows.count++] = first->down.line[i];
        }
}

bool text_blocks_finish(TextBlocks *blocks, NamedRows *out, Error *err) {
    ColumnName corner[2];
    TableLayout layout;
    const TextBlock *first = &blocks->block[0];
    corner_names(first->corner, corner);
    if (!first->down.count)
        return error_at(err, ERROR_INPUT, blocks->text->file,
                        text_place(first->line, blocks->arena), "is a matrix without rows");
    if (!choose_layout(blocks, corner, &layout, err)) return false;
    bool is_pair = layout >= LAYOUT_HORIZONTAL_DOWN;
    bool first_down = layout == LAYOUT_THETA_DOWN || layout == LAYOUT_HORIZONTAL_DOWN;
    AngleUnit angle = corner[0].angle != ANGLE_AUTO ? corner[0].angle : corner[1].angle;
    out->rows.width = 2;
    ColumnName name[2] = {
        {.quantity = is_pair ? QUANTITY_HORIZONTAL : QUANTITY_THETA, .angle = angle},
        {.quantity = is_pair ? QUANTITY_VERTICAL : QUANTITY_PHI, .angle = angle}};
    for (int i = 0; i < 2; i++) out->column[i] = (NamedColumn){name[i], "angle", 0};
    if (!add_quantities(blocks, out, err)) return false;
    size_t rows = (size_t)first->down.count * (size_t)blocks->across;
    if (rows > IMPORT_ROWS_MAX)
        return error_at(err, ERROR_INPUT, blocks->text->file, "",
                        "has %zu directions, required: at most %d", rows, IMPORT_ROWS_MAX);
    out->rows.cell = ARENA_NEW(blocks->arena, double, rows *(size_t)out->rows.width);
    out->rows.line = ARENA_NEW(blocks->arena, int, rows);
    fill_rows(blocks, first_down, out);
    return true;
}
