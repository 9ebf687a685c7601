/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/level_table.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/count.h"
#include "base/file.h"
#include "base/mathd.h"
#include "panel/shape/panel_levels.h"
#include "text/csv_table.h"
#include "text/text.h"

#define LUMINANCE_MOST 1e9 /* cd/m2: more than the sun's disc at noon is no display */

/* Places of the columns that count; -1: none. */
typedef enum Place { PLACE_LEVEL, PLACE_RED, PLACE_GREEN, PLACE_BLUE, PLACE_WHITE, PLACE_COUNT
} Place;

typedef struct Columns {
    int  at[PLACE_COUNT];
    bool is_percent; /* of the levels */
} Columns;

typedef struct PlaceWord {
    const char *word;
    Place       place;
    bool        has_case; /* y is a chromaticity, Y a luminance */
} PlaceWord;

static const PlaceWord words[] = {
    {"level", PLACE_LEVEL, false},  {"code", PLACE_LEVEL, false},
    {"grey", PLACE_LEVEL, false},   {"gray", PLACE_LEVEL, false},
    {"input", PLACE_LEVEL, false},  {"signal", PLACE_LEVEL, false},
    {"drive", PLACE_LEVEL, false},  {"digital", PLACE_LEVEL, false},
    {"red", PLACE_RED, false},      {"r", PLACE_RED, false},
    {"green", PLACE_GREEN, false},  {"g", PLACE_GREEN, false},
    {"blue", PLACE_BLUE, false},    {"b", PLACE_BLUE, false},
    {"white", PLACE_WHITE, false},  {"w", PLACE_WHITE, false},
};

/* Words that a colour may follow: "luminance", "L_red". */
static const PlaceWord luminance_words[] = {
    {"luminance", PLACE_WHITE, false}, {"lum", PLACE_WHITE, false},
    {"lv", PLACE_WHITE, false},        {"l", PLACE_WHITE, false},
    {"Y", PLACE_WHITE, true},
};

/* ---- columns ---------------------------------------------------------------------------- */

/* The next run of letters at or behind *at; its length, 0 at the end. */
static int next_word(const char **at)
{
    int length = 0;
    while (**at && !isalpha((unsigned char)**at)) (*at)++;
    while (isalpha((unsigned char)(*at)[length])) length++;
    return length;
}

static bool is_word(const PlaceWord *known, const char *word, int length)
{
    return (int)strlen(known->word) == length &&
           !(known->has_case ? strncmp(known->word, word, (size_t)length)
                             : strncasecmp(known->word, word, (size_t)length));
}

static int place_of(const PlaceWord *known, int count, const char *word, int length)
{
    for (int i = 0; i < count; i++)
        if (is_word(&known[i], word, length)) return (int)known[i].place;
    return -1;
}

/* The Place of a column of that name; -1: none. */
static int column_place(const char *name)
{
    int length = next_word(&name);
    int place = place_of(words, COUNT_OF(words), name, length);
    if (place >= 0 || place_of(luminance_words, COUNT_OF(luminance_words), name, length) < 0)
        return place;
    const char *behind = name + length;
    length = next_word(&behind);
    place = place_of(words, COUNT_OF(words), behind, length);
    return place > PLACE_LEVEL ? place : PLACE_WHITE;
}

static bool has_primary(const Columns *columns, bool all)
{
    int count = (columns->at[PLACE_RED] >= 0) + (columns->at[PLACE_GREEN] >= 0) +
                (columns->at[PLACE_BLUE] >= 0);
    return all ? count == 3 : count > 0;
}

static bool find_columns(const CsvTable *csv, Columns *out, Error *err)
{
    for (int p = 0; p < PLACE_COUNT; p++) out->at[p] = -1;
    for (int c = 0; c < csv->columns; c++) {
        int place = column_place(csv->name[c]);
        if (place < 0) continue;
        if (out->at[place] >= 0)
            return error_at(err, ERROR_INPUT, csv->file, "header line",
                            "columns '%s' and '%s' hold the same, wanted one of them",
                            csv->name[out->at[place]], csv->name[c]);
        out->at[place] = c;
    }
    if (out->at[PLACE_LEVEL] < 0)
        return error_at(err, ERROR_INPUT, csv->file, "header line",
                        "has no column of levels, wanted one named 'level' or 'code'");
    if (has_primary(out, false) && !has_primary(out, true))
        return error_at(err, ERROR_INPUT, csv->file, "header line",
                        "has not all of 'red', 'green' and 'blue', wanted all three or "
                        "'white' alone");
    if (out->at[PLACE_WHITE] < 0 && !has_primary(out, true))
        return error_at(err, ERROR_INPUT, csv->file, "header line",
                        "has no column of luminance, wanted 'luminance' or 'white', or 'red', "
                        "'green' and 'blue' (cd/m2)");
    out->is_percent = strchr(csv->name[out->at[PLACE_LEVEL]], '%') != NULL;
    return true;
}

/* ---- rows ------------------------------------------------------------------------------- */

static double cell_of(const CsvTable *csv, int row, int column)
{
    return (double)csv->cell[(size_t)row * (size_t)csv->columns + (size_t)column];
}

typedef struct LevelRow {
    double level;
    int    row;
} LevelRow;

static int by_level(const void *a, const void *b)
{
    double p = ((const LevelRow *)a)->level, q = ((const LevelRow *)b)->level;
    return p < q ? -1 : p > q;
}

/* The level that is full, or 0 with an error. Levels 0 and 1 alone may be codes or shares. */
static double full_level(const CsvTable *csv, const Columns *columns, const LevelRow *row,
                         Error *err)
{
    const LevelRow *last = row + csv->rows - 1;
    if (columns->is_percent && last->level == 100) return 100;
    if (!columns->is_percent && last->level == 255) return 255;
    if (!columns->is_percent && last->level == 1)
        for (int i = 0; i < csv->rows; i++)
            if (row[i].level > 0 && row[i].level < 1) return 1;
    char where[32];
    snprintf(where, sizeof where, "line %d", csv->line[last->row]);
    error_at(err, ERROR_INPUT, csv->file, where, "the highest level is %g, so the full level "
             "is %s: wanted rows up to 255 (codes), up to 1 with levels between (shares), or "
             "up to 100 in a column with %% in its name", last->level,
             last->level == 1 || last->level == 100 || last->level > 255 ? "unclear"
                                                                          : "not there");
    return 0;
}

static bool bad_row(const CsvTable *csv, int row, Error *err, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

static bool bad_row(const CsvTable *csv, int row, Error *err, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    error_at_count(err, csv->file, "line", csv->line[row], format, list);
    va_end(list);
    return false;
}

static bool check_levels(const CsvTable *csv, const LevelRow *row, Error *err)
{
    if (csv->rows < 2 || csv->rows > LEVEL_TABLE_ROWS_MAX)
        return error_at(err, ERROR_INPUT, csv->file, "",
                        "has %d row%s, wanted 2 or more (up to %d)", csv->rows,
                        csv->rows == 1 ? "" : "s", LEVEL_TABLE_ROWS_MAX);
    if (row[0].level < 0)
        return bad_row(csv, row[0].row, err, "level %g is below zero", row[0].level);
    for (int i = 1; i < csv->rows; i++)
        if (row[i].level == row[i - 1].level)
            return bad_row(csv, row[i].row, err, "level %g stands in line %d already, wanted "
                           "each level once", row[i].level, csv->line[row[i - 1].row]);
    return true;
}

/* A column in the order of the levels, which may not fall. */
static bool take_luminance(const CsvTable *csv, const LevelRow *row, int column, double *out,
                           Error *err)
{
    const char *name = csv->name[column];
    for (int i = 0; i < csv->rows; i++) {
        out[i] = cell_of(csv, row[i].row, column);
        if (out[i] < 0)
            return bad_row(csv, row[i].row, err, "column '%s' holds %g cd/m2, wanted no "
                           "luminance below zero", name, out[i]);
        if (out[i] > LUMINANCE_MOST)
            return bad_row(csv, row[i].row, err, "column '%s' holds %g cd/m2, required at most "
                           "%g", name, out[i], LUMINANCE_MOST);
        if (i && out[i] < out[i - 1])
            return bad_row(csv, row[i].row, err, "column '%s': %g cd/m2 at level %g is less "
                           "than the %g of level %g (line %d), wanted luminance that does not "
                           "fall; leave out what the instrument cannot tell from black",
                           name, out[i], row[i].level, out[i - 1], row[i - 1].level,
                           csv->line[row[i - 1].row]);
    }
    if (!(out[csv->rows - 1] > (row[0].level > 0 ? 0 : out[0])))
        return bad_row(csv, row[csv->rows - 1].row, err, "column '%s': full level has no more "
                       "light than level 0", name);
    return true;
}

static bool take_columns(const CsvTable *csv, const Columns *columns, const LevelRow *row,
                         LevelTable *out, Error *err)
{
    for (int p = 0; p < 3 && out->has_primaries; p++)
        if (!take_luminance(csv, row, columns->at[PLACE_RED + p], out->primary_cd_m2[p], err))
            return false;
    if (out->has_white)
        return take_luminance(csv, row, columns->at[PLACE_WHITE], out->white_cd_m2, err);
    for (int i = 0; i < out->rows; i++) { /* black is in each of them, in white once */
        double black = 0;
        for (int p = 0; p < 3; p++) {
            out->white_cd_m2[i] += out->primary_cd_m2[p][i];
            black += out->has_black ? out->primary_cd_m2[p][0] : 0;
        }
        out->white_cd_m2[i] -= black * 2 / 3;
    }
    return true;
}

/* ---- the rows that a level curve needs --------------------------------------------------- */

#define LEVEL_STEP (1.0 / 256) /* of levels in a panel file */
#define LEVEL_POWER 2.2f       /* of a single level, as in a panel file */

/* The rows that shine, as logarithms, and which of them are kept. */
typedef struct CurveRows {
    const double *level, *cd_m2; /* the first that shines */
    int           count;
    double        black_cd_m2, full_cd_m2; /* full without black */
    float        *log_level, *log_share;
    bool         *is_kept;
} CurveRows;

static double share_of(const CurveRows *rows, int i)
{
    return (rows->cd_m2[i] - rows->black_cd_m2) / rows->full_cd_m2;
}

/* The kept rows' levels and logarithms. */
static int kept_rows(const CurveRows *rows, float x[LEVEL_CURVE_MAX], float y[LEVEL_CURVE_MAX])
{
    int count = 0;
    for (int i = 0; i < rows->count; i++) {
        if (!rows->is_kept[i]) continue;
        x[count] = rows->log_level[i];
        y[count++] = rows->log_share[i];
    }
    return count;
}

/* How far the kept rows' curve misses a row, of its luminance. */
static double miss_of(const CurveRows *rows, int i, const float *x, const float *y, int count)
{
    PanelLevelWeights w = panel_level_weights(x, y, count, LEVEL_POWER, rows->log_level[i]);
    double log_share = (double)w.offset;
    for (int k = 0; k < 4 && w.first + k < count; k++)
        log_share += (double)w.weight[k] * (double)y[w.first + k];
    double found = exp_d(log_share) * rows->full_cd_m2 + rows->black_cd_m2;
    return fabs(found / rows->cd_m2[i] - 1);
}

/* Levels nearer than the file's steps are one. */
static bool is_beside_kept(const CurveRows *rows, int i)
{
    for (int k = i - 1; k >= 0 && rows->level[i] - rows->level[k] < 2 * LEVEL_STEP; k--)
        if (rows->is_kept[k]) return true;
    for (int k = i + 1; k < rows->count; k++) {
        if (!(rows->level[k] - rows->level[i] < 2 * LEVEL_STEP)) break;
        if (rows->is_kept[k]) return true;
    }
    return false;
}

/* The row that is missed most, or -1; *miss of it. */
static int worst_row(const CurveRows *rows, double *miss)
{
    float x[LEVEL_CURVE_MAX], y[LEVEL_CURVE_MAX];
    int   count = kept_rows(rows, x, y), worst = -1;
    *miss = 0;
    for (int i = 0; i < rows->count; i++) {
        double one = rows->is_kept[i] ? 0 : miss_of(rows, i, x, y, count);
        if (!(one > *miss) || is_beside_kept(rows, i)) continue;
        *miss = one;
        worst = i;
    }
    return worst;
}

static CurveRows shining_rows(const double *level, const double *cd_m2, int rows,
                              bool has_black, Arena *scratch)
{
    double black = has_black ? cd_m2[0] : 0;
    int    first = has_black;
    while (first < rows - 1 && (!(cd_m2[first] > black) || level[first] < LEVEL_STEP)) first++;
    CurveRows out = {.level = level + first, .cd_m2 = cd_m2 + first, .count = rows - first,
                     .black_cd_m2 = black, .full_cd_m2 = cd_m2[rows - 1] - black};
    out.log_level = ARENA_NEW(scratch, float, out.count);
    out.log_share = ARENA_NEW(scratch, float, out.count);
    out.is_kept = ARENA_NEW(scratch, bool, out.count);
    for (int i = 0; i < out.count; i++) {
        out.log_level[i] = (float)log_d(out.level[i]);
        out.log_share[i] = (float)log_d(share_of(&out, i));
    }
    out.is_kept[0] = out.is_kept[out.count - 1] = true;
    return out;
}

/* level: codes, rising to 255; cd_m2: their luminance, which does not fall, and more at the
 * last row than at the first. has_black: row 0 is of level 0. Returns the number of rows above
 * level 0 that have no more light than black. */
static int choose_curve(const double *level, const double *cd_m2, int rows, bool has_black,
                        Arena scratch, LevelCurve *out)
{
    CurveRows of = shining_rows(level, cd_m2, rows, has_black, &scratch);
    int       count = of.count > 1 ? 2 : 1;
    *out = (LevelCurve){0};
    for (;;) {
        int worst = worst_row(&of, &out->miss);
        if (worst < 0 || out->miss <= LEVEL_CURVE_MISS || count == LEVEL_CURVE_MAX) break;
        of.is_kept[worst] = true;
        count++;
    }
    for (int i = 0; i < of.count; i++) {
        if (!of.is_kept[i]) continue;
        out->level[out->count] = of.level[i];
        out->share[out->count++] = share_of(&of, i);
    }
    return rows - of.count - has_black;
}

/* ---- the table --------------------------------------------------------------------------- */

static void take_curves(LevelTable *table, Arena scratch)
{
    int last = table->rows - 1;
    table->black_share =
        table->has_black ? table->white_cd_m2[0] / table->white_cd_m2[last] : 0;
    for (int p = 0; p < 3; p++) {
        const double *of = table->has_primaries ? table->primary_cd_m2[p] : table->white_cd_m2;
        int dark = choose_curve(table->level, of, table->rows, table->has_black, scratch,
                                &table->curve[p]);
        if (dark > table->dark_rows) table->dark_rows = dark;
    }
}

bool level_table_read(const char *file, Arena *arena, LevelTable *out, Error *err)
{
    CsvTable   csv;
    Columns    columns = {.is_percent = false};
    LevelTable table = {.file = arena_string(arena, file, strlen(file))};
    if (!csv_table_read(table.file, arena, &csv, err) || !find_columns(&csv, &columns, err))
        return false;
    LevelRow *row = ARENA_NEW(arena, LevelRow, csv.rows);
    for (int i = 0; i < csv.rows; i++)
        row[i] = (LevelRow){cell_of(&csv, i, columns.at[PLACE_LEVEL]), i};
    qsort(row, (size_t)csv.rows, sizeof *row, by_level);
    double full = 0;
    if (!check_levels(&csv, row, err) || !((full = full_level(&csv, &columns, row, err)) > 0))
        return false;
    table.rows = csv.rows;
    table.level = ARENA_NEW(arena, double, csv.rows);
    table.line = ARENA_NEW(arena, int, csv.rows);
    table.white_cd_m2 = ARENA_NEW(arena, double, csv.rows);
    for (int p = 0; p < 3; p++) table.primary_cd_m2[p] = ARENA_NEW(arena, double, csv.rows);
    for (int i = 0; i < csv.rows; i++) {
        table.level[i] = row[i].level / full * 255;
        table.line[i] = csv.line[row[i].row];
    }
    table.has_white = columns.at[PLACE_WHITE] >= 0;
    table.has_primaries = has_primary(&columns, true);
    table.has_black = row[0].level == 0;
    if (!take_columns(&csv, &columns, row, &table, err)) return false;
    take_curves(&table, *arena);
    *out = table;
    return true;
}

bool level_table_check_white(const LevelTable *table, double white_cd_m2, const char *source,
                             Error *err)
{
    char   where[32];
    double full = table->white_cd_m2[table->rows - 1];
    if (fabs(full - white_cd_m2) <= LEVEL_TABLE_FULL_MISS * white_cd_m2) return true;
    snprintf(where, sizeof where, "line %d", table->line[table->rows - 1]);
    return error_at(err, ERROR_INPUT, table->file, where,
                    "full level has %g cd/m2, but the set's white on the axis %g (%s): %.3g %% "
                    "apart, wanted within %g %%; do both belong to one panel, one backlight?",
                    full, white_cd_m2, source,
                    100 * fabs(full - white_cd_m2) / white_cd_m2, 100 * LEVEL_TABLE_FULL_MISS);
}

const char *level_table_text(const LevelTable *table, Arena *arena)
{
    Text text = {.arena = arena};
    text_format(&text, "# from %s; level 0 to 255, cd/m2 on the axis, black in it\nlevel",
                path_name(table->file));
    if (table->has_primaries) text_add(&text, ",red,green,blue");
    text_add(&text, table->has_white ? ",white\n" : "\n");
    for (int i = 0; i < table->rows; i++) {
        text_format(&text, "%.7g", table->level[i]);
        for (int p = 0; p < 3 && table->has_primaries; p++)
            text_format(&text, ",%.7g", table->primary_cd_m2[p][i]);
        if (table->has_white) text_format(&text, ",%.7g", table->white_cd_m2[i]);
        text_add(&text, "\n");
    }
    return text.data;
}

const char *level_table_note(const LevelTable *table, Arena *arena)
{
    const LevelCurve *most = &table->curve[0];
    for (int p = 1; p < 3; p++)
        if (table->curve[p].count > most->count) most = &table->curve[p];
    return arena_format(arena, "levels from %s: %d rows, of which %d keep all within %.2g %%; "
        "black is %.3g of white%s%s; the angular shape of white serves every level and black, "
        "an approximation", path_name(table->file), table->rows, most->count,
        100 * fmax(LEVEL_CURVE_MISS, most->miss), table->black_share,
        table->has_black ? "" : " (no row of level 0)",
        most->count > 1 ? "" : "; no level between, so a power of 2.2 is taken");
}
