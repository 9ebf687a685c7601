/* SPDX-License-Identifier: Apache-2.0 */
#include "import/primaries.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "panel/set/angle_table.h"
#include "panel/set/primary_spectra.h"

#define VALUE_MOST 1e12
#define COLUMNS 5 /* wavelength, red, green, blue, black */

typedef struct PrimariesFile {
    const TextFile *text;
    TextDialect     dialect;
    ImportSet      *set;
    Error          *err;
    TextCell       *cell;
    int             column[COLUMNS]; /* -1: not there */
    int             cells;           /* of the header */
    double         *value[COLUMNS];
    int             rows;
} PrimariesFile;

static int column_of(TextCell cell)
{
    static const char *const names[COLUMNS][6] = {
        {"nm", "wavelength", "wavelength_nm", "lambda", "wavelength (nm)", NULL},
        {"red", "r", "rot", "rouge", NULL}, {"green", "g", "gruen", "vert", NULL},
        {"blue", "b", "blau", "bleu", NULL}, {"black", "k", "schwarz", "noir", NULL}};
    for (int c = 0; c < COLUMNS; c++)
        if (text_cell_find(names[c], cell) >= 0) return c;
    return -1;
}

static bool is_comment(TextLine line)
{
    return !line.length || strchr("#!%", line.text[0]);
}

/* The first line that names wavelengths and the three primaries. */
static bool find_header(PrimariesFile *in, int *at)
{
    for (*at = 0; *at < in->text->count; (*at)++) {
        if (is_comment(in->text->line[*at])) continue;
        in->cells = text_cells(in->text->line[*at], in->dialect.delimiter, in->cell);
        for (int c = 0; c < COLUMNS; c++) in->column[c] = -1;
        for (int i = 0; i < in->cells; i++) {
            int c = column_of(in->cell[i]);
            if (c >= 0) in->column[c] = i;
        }
        if (in->column[0] >= 0 && in->column[1] >= 0 && in->column[2] >= 0 &&
            in->column[3] >= 0)
            return true;
    }
    return error_at(in->err, ERROR_INPUT, in->text->file, "header line",
                    "has no columns of wavelength, red, green and blue");
}

static bool read_row(PrimariesFile *in, int at)
{
    const char *place = text_place(at, in->set->arena);
    if (text_cells(in->text->line[at], in->dialect.delimiter, in->cell) != in->cells)
        return error_at(in->err, ERROR_INPUT, in->text->file, place,
                        "has not the %d cells of the header", in->cells);
    for (int c = 0; c < COLUMNS; c++) {
        if (in->column[c] < 0) continue;
        TextCell cell = in->cell[in->column[c]];
        double *value = &in->value[c][in->rows];
        if (!text_number(cell, in->dialect.decimal, value) || fabs(*value) > VALUE_MOST)
            return error_at(in->err, ERROR_INPUT, in->text->file, place,
                            "holds '%.*s', required: a number",
                            cell.length < 40 ? cell.length : 40, cell.text);
    }
    double nm = in->value[0][in->rows];
    if (!(nm >= 100 && nm <= 20000))
        return error_at(in->err, ERROR_INPUT, in->text->file, place,
                        "has a wavelength of %g, required: nanometres", nm);
    if (in->rows && !(nm > in->value[0][in->rows - 1]))
        return error_at(in->err, ERROR_INPUT, in->text->file, place,
                        "wavelength %g follows %g, required: rising wavelengths", nm,
                        in->value[0][in->rows - 1]);
    in->rows++;
    return true;
}

static bool check_reach(ImportSet *set, const char *file, Error *err)
{
    const ImportSpectra *spectra = &set->spectra;
    double beyond = 0;
    for (int p = 0; p < 3; p++)
        if (!primary_spectrum_reaches(&(PrimaryColumn){file, primary_names[p], spectra->nm,
                                                       spectra->value[p], spectra->rows},
                                      &beyond, err))
            return false;
    if (beyond > 0)
        import_note(set, "%s: %.2g %% of V(lambda) lies beyond the primaries' spectra, which "
                    "end in light: dark is taken", path_name(file), 100 * beyond);
    return true;
}

bool primaries_read(const char *file, const TextOptions *options, ImportSet *set, Error *err)
{
    TextFile text;
    int      at;
    if (!text_file_read(file, options->encoding, set->arena, &text, err)) return false;
    PrimariesFile in = {.text = &text, .dialect = options->dialect, .set = set, .err = err,
                  .cell = ARENA_NEW(set->arena, TextCell, TEXT_CELLS_MAX)};
    if (!text_find_dialect(&text, 0, *set->arena, &in.dialect, err)) return false;
    if (!find_header(&in, &at)) return false;
    for (int c = 0; c < COLUMNS; c++)
        if (in.column[c] >= 0) in.value[c] = ARENA_NEW(set->arena, double, text.count);
    for (at++; at < text.count; at++)
        if (!is_comment(text.line[at]) && !read_row(&in, at)) return false;
    if (in.rows < 2)
        return error_at(err, ERROR_INPUT, file, "", "has %d wavelengths, required: "
                                                    "more", in.rows);
    set->spectra = (ImportSpectra){.rows = in.rows, .nm = in.value[0]};
    for (int c = 1; c < COLUMNS; c++) set->spectra.value[c - 1] = in.value[c];
    return check_reach(set, file, err);
}
