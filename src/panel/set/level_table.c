/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/level_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/count.h"
#include "base/file.h"
#include "text/csv_table.h"
#include "text/text.h"

#define LUMINANCE_MOST 1e9 /* cd/m2: more than the sun's disc at noon is no display */

/* Places of the columns that count; -1: none. */
typedef enum Place {
    PLACE_LEVEL,
    PLACE_RED,
    PLACE_GREEN,
    PLACE_BLUE,
    PLACE_WHITE,
    PLACE_COUNT
} Place;

typedef struct Columns {
    int at[PLACE_COUNT];
} Columns;

/* ---- columns ---------------------------------------------------------------------------- */

/* The Place of a column, by its name up to a unit: "luminance_cd_m2", "L (cd/m2)"; -1: none. */
static int column_place(const char *name) {
    static const struct {
        const char *word;
        Place place;
    } words[] = {{"level", PLACE_LEVEL},     {"code", PLACE_LEVEL},  {"grey", PLACE_LEVEL},
                 {"gray", PLACE_LEVEL},      {"red", PLACE_RED},     {"r", PLACE_RED},
                 {"green", PLACE_GREEN},     {"g", PLACE_GREEN},     {"blue", PLACE_BLUE},
                 {"b", PLACE_BLUE},          {"white", PLACE_WHITE}, {"w", PLACE_WHITE},
                 {"luminance", PLACE_WHITE}, {"l", PLACE_WHITE},     {"lv", PLACE_WHITE},
                 {"relative", PLACE_WHITE}};
    if (!strncasecmp(name, "relative_", 9)) name += 9; /* as level_table_text writes them */
    size_t length = strcspn(name, " _([/");
    if (!strcmp(name, "Y")) return PLACE_WHITE; /* y is a chromaticity */
    for (int i = 0; i < COUNT_OF(words); i++)
        if (strlen(words[i].word) == length && !strncasecmp(words[i].word, name, length))
            return (int)words[i].place;
    return -1;
}

static bool has_primary(const Columns *columns, bool all) {
    int count = (columns->at[PLACE_RED] >= 0) + (columns->at[PLACE_GREEN] >= 0) +
                (columns->at[PLACE_BLUE] >= 0);
    return all ? count == 3 : count > 0;
}

static bool find_columns(const CsvTable *csv, Columns *out, Error *err) {
    for (int p = 0; p < PLACE_COUNT; p++) out->at[p] = -1;
    for (int c = 0; c < csv->columns; c++) {
        int place = column_place(csv->name[c]);
        if (place < 0) continue;
        if (out->at[place] >= 0)
            return error_at(err, ERROR_INPUT, csv->file, "header line",
                            "columns '%s' and '%s' hold the same, required: one of them",
                            csv->name[out->at[place]], csv->name[c]);
        out->at[place] = c;
    }
    if (out->at[PLACE_LEVEL] < 0)
        return error_at(err, ERROR_INPUT, csv->file, "header line",
                        "has no column of levels, required: one named 'level' or 'code'");
    if (has_primary(out, false) && !has_primary(out, true))
        return error_at(err, ERROR_INPUT, csv->file, "header line",
                        "has not all of 'red', 'green' and 'blue', required: all three or "
                        "'white' alone");
    if (out->at[PLACE_WHITE] < 0 && !has_primary(out, true))
        return error_at(err, ERROR_INPUT, csv->file, "header line",
                        "has no column of luminance, required: 'luminance' or 'white', or "
                        "'red', 'green' and 'blue' (cd/m2)");
    return true;
}

/* ---- rows ------------------------------------------------------------------------------- */

static double cell_of(const CsvTable *csv, int row, int column) {
    return (double)csv->cell[(size_t)row * (size_t)csv->columns + (size_t)column];
}

typedef struct LevelRow {
    double level;
    int row;
} LevelRow;

static int by_level(const void *a, const void *b) {
    double p = ((const LevelRow *)a)->level, q = ((const LevelRow *)b)->level;
    return p < q ? -1 : p > q;
}

static bool has_between(const LevelRow *row, int count) {
    for (int i = 0; i < count; i++)
        if (row[i].level > 0 && row[i].level < 1) return true;
    return false;
}

/* The level that is full, or 0 with an error. Levels 0 and 1 alone may be codes or shares.
 * level_max: the highest code (0: that of 8, 10, 12 or 16 bits). */
static double full_level(const CsvTable *csv, const LevelRow *row, double level_max, Error *err) {
    static const double codes[] = {255, 1023, 4095, 65535};
    const LevelRow *last = row + csv->rows - 1;
    double most = last->level;
    if (most == 1 && has_between(row, csv->rows)) return 1;
    if (level_max > 0 && most == level_max) return most;
    for (int i = 0; i < COUNT_OF(codes) && !(level_max > 0); i++)
        if (most == codes[i]) return most;
    char where[32];
    snprintf(where, sizeof where, "line %d", csv->line[last->row]);
    if (level_max > 0)
        error_at(err, ERROR_INPUT, csv->file, where,
                 "the highest level is %g, required: rows "
                 "up to the highest code, %g as stated",
                 most, level_max);
    else
        error_at(err, ERROR_INPUT, csv->file, where,
                 "the highest level is %g, so the full "
                 "level is %s: required are rows up to 255, 1023, 4095 or 65535 (codes), or up to "
                 "1 with levels between (shares); --level-max N states another highest code",
                 most, most == 1 || most == 100 || most > 255 ? "unclear" : "not there");
    return 0;
}

static bool bad_row(const CsvTable *csv, int row, Error *err, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

static bool bad_row(const CsvTable *csv, int row, Error *err, const char *format, ...) {
    va_list list;
    va_start(list, format);
    error_at_count(err, csv->file, "line", csv->line[row], format, list);
    va_end(list);
    return false;
}

static bool check_levels(const CsvTable *csv, const LevelRow *row, Error *err) {
    if (csv->rows < 2 || csv->rows > LEVEL_TABLE_ROWS_MAX)
        return error_at(err, ERROR_INPUT, csv->file, "",
                        "has %d row%s, required: 2 or more (up to %d)", csv->rows,
                        csv->rows == 1 ? "" : "s", LEVEL_TABLE_ROWS_MAX);
    if (row[0].level < 0)
        return bad_row(csv, row[0].row, err, "level %g is below zero", row[0].level);
    for (int i = 1; i < csv->rows; i++)
        if (row[i].level == row[i - 1].level)
            return bad_row(csv, row[i].row, err,
                           "level %g stands in line %d already, "
                           "required: each level "
                           "once",
                           row[i].level, csv->line[row[i - 1].row]);
    return true;
}

/* Noise makes neighbours fall: such rows become their mean (the least change that lets nothing
 * fall; Barlow and others 1972, pool adjacent violators). Below zero is zero. */
static int pool_falls(double *value, int count, Arena scratch) {
    int *size = ARENA_NEW(&scratch, int, count), blocks = 0, pooled = 0;
    for (int i = 0; i < count; i++) {
        value[blocks] = value[i];
        size[blocks++] = 1;
        for (; blocks > 1 && value[blocks - 1] < value[blocks - 2]; blocks--) {
            int *a = &size[blocks - 2], b = size[blocks - 1];
            value[blocks - 2] = (*a * value[blocks - 2] + b * value[blocks - 1]) / (*a + b);
            *a += b;
        }
    }
    for (int i = count; blocks-- > 0;) {
        pooled += size[blocks] > 1 ? size[blocks] : 0;
        for (int k = 0; k < size[blocks]; k++) value[--i] = fmax(value[blocks], 0);
    }
    return pooled;
}

/* How far a row may lie below another, or below zero; a neighbour, which has about the same
 * light, further. */
static double noise_of(double cd_m2, double full_cd_m2, bool is_near) {
    return fmax((is_near ? LEVEL_NOISE_NEAR : LEVEL_NOISE_SHARE) * cd_m2,
                LEVEL_NOISE_FULL * full_cd_m2);
}

/* A column in the order of the levels, which does not fall but by noise. */
static bool take_luminance(const CsvTable *csv, const LevelRow *row, int column, double *out,
                           Error *err) {
    const char *name = csv->name[column];
    int top = 0, last = csv->rows - 1;
    double full = cell_of(csv, row[last].row, column);
    for (int i = 0; i <= last; i++) {
        out[i] = cell_of(csv, row[i].row, column);
        if (out[i] < 0 && !(-out[i] <= noise_of(0, full, false)))
            return bad_row(csv, row[i].row, err,
                           "column '%s' holds %g cd/m2, required: no "
                           "luminance below zero",
                           name, out[i]);
        if (out[i] > LUMINANCE_MOST)
            return bad_row(csv, row[i].row, err,
                           "column '%s' holds %g cd/m2, required: at "
                           "most %g",
                           name, out[i], LUMINANCE_MOST);
        bool is_near = row[i].level < LEVEL_NEAR * row[top].level;
        if (out[top] - out[i] > noise_of(out[top], full, is_near))
            return bad_row(csv, row[i].row, err,
                           "column '%s': %g cd/m2 at level %g is less "
                           "than the %g of level %g (line %d), required: luminance that does "
                           "not fall by more than noise (%g %% of it; %g %% within %g %% of "
                           "the level; %g %% of full level)",
                           name, out[i], row[i].level, out[top], row[top].level,
                           csv->line[row[top].row], 100 * LEVEL_NOISE_SHARE, 100 * LEVEL_NOISE_NEAR,
                           100 * (LEVEL_NEAR - 1), 100 * LEVEL_NOISE_FULL);
        if (out[i] > out[top]) top = i;
    }
    return true;
}

static bool check_light(const CsvTable *csv, const LevelRow *row, int column, const double *value,
                        Error *err) {
    int last = csv->rows - 1;
    return value[last] > (row[0].level > 0 ? 0 : value[0]) ||
           bad_row(csv, row[last].row, err,
                   "column '%s': full level has no more light than "
                   "level 0",
                   csv->name[column]);
}

/* Black is in each primary, in white once. Each primary relative to its own full level: with
 * black B it is B / r(0), and white the sum less 2 B. */
static double black_share_of(const LevelTable *table) {
    const double *white = table->white_cd_m2;
    double parts = 0;
    if (!table->has_black) return 0;
    if (table->has_white || !table->is_relative) return white[0] / white[table->rows - 1];
    for (int p = 0; p < 3; p++) {
        const double *of = table->primary_cd_m2[p];
        if (!(of[0] > 0)) return 0;
        parts += of[table->rows - 1] / of[0];
    }
    return 1 / (parts - 2);
}

/* Values that all end at 1 are relative. */
static bool ends_at_one(const LevelTable *table) {
    int last = table->rows - 1;
    for (int p = 0; p < 3 && !table->has_white; p++)
        if (table->primary_cd_m2[p][last] != 1) return false;
    return !table->has_white || table->white_cd_m2[last] == 1;
}

static bool take_columns(const CsvTable *csv, const Columns *columns, const LevelRow *row,
                         LevelTable *out, Arena scratch, Error *err) {
    for (int p = PLACE_RED; p < PLACE_COUNT; p++) {
        bool is_white = p == PLACE_WHITE;
        double *value = is_white ? out->white_cd_m2 : out->primary_cd_m2[p - PLACE_RED];
        if (!(is_white ? out->has_white : out->has_primaries)) continue;
        if (!take_luminance(csv, row, columns->at[p], value, err)) return false;
        int pooled = pool_falls(value, csv->rows, scratch);
        if (pooled > out->noise_rows) out->noise_rows = pooled;
        if (!check_light(csv, row, columns->at[p], value, err)) return false;
    }
    for (int i = 0; i < out->rows && !out->has_white; i++) {
        double black = 0;
        for (int p = 0; p < 3; p++) {
            out->white_cd_m2[i] += out->primary_cd_m2[p][i];
            black += out->has_black ? out->primary_cd_m2[p][0] : 0;
        }
        out->white_cd_m2[i] -= black * 2 / 3;
    }
    out->is_relative = ends_at_one(out);
    out->black_share = black_share_of(out);
    return true;
}

/* ---- the table --------------------------------------------------------------------------- */

static void take_curves(LevelTable *table, Arena scratch) {
    for (int p = 0; p < 3; p++) {
        const double *of = table->has_primaries ? table->primary_cd_m2[p] : table->white_cd_m2;
        int dark = level_curve_choose(table->level, of, table->rows, table->has_black, scratch,
                                      &table->curve[p]);
        if (dark > table->dark_rows) table->dark_rows = dark;
    }
}

bool level_table_read(const char *file, double level_max, Arena *arena, LevelTable *out,
                      Error *err) {
    CsvTable csv;
    Columns columns;
    LevelTable table = {.file = arena_string(arena, file, strlen(file))};
    if (!csv_table_read(table.file, arena, &csv, err) || !find_columns(&csv, &columns, err))
        return false;
    LevelRow *row = ARENA_NEW(arena, LevelRow, csv.rows);
    for (int i = 0; i < csv.rows; i++)
        row[i] = (LevelRow){cell_of(&csv, i, columns.at[PLACE_LEVEL]), i};
    qsort(row, (size_t)csv.rows, sizeof *row, by_level);
    double full = 0;
    if (!check_levels(&csv, row, err) || !((full = full_level(&csv, row, level_max, err)) > 0))
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
    if (!take_columns(&csv, &columns, row, &table, *arena, err)) return false;
    take_curves(&table, *arena);
    *out = table;
    return true;
}

bool level_table_check_white(const LevelTable *table, double white_cd_m2, const char *source,
                             Error *err) {
    char where[32];
    double full = table->white_cd_m2[table->rows - 1];
    if (table->is_relative || fabs(full - white_cd_m2) <= LEVEL_TABLE_FULL_MISS * white_cd_m2)
        return true;
    snprintf(where, sizeof where, "line %d", table->line[table->rows - 1]);
    return error_at(err, ERROR_INPUT, table->file, where,
                    "full level has %g cd/m2, but the set's white on the axis %g (%s): %.3g %% "
                    "apart, required: within %g %%; do both belong to one panel, one "
                    "backlight? (a column of relative luminance is named so: 'relative')",
                    full, white_cd_m2, source, 100 * fabs(full - white_cd_m2) / white_cd_m2,
                    100 * LEVEL_TABLE_FULL_MISS);
}

const char *level_table_text(const LevelTable *table, Arena *arena) {
    Text text = {.arena = arena};
    const char *as = table->is_relative ? "relative_" : "";
    text_format(&text, "# from %s; level 0 to 255, %s on the axis, black in it\nlevel",
                path_name(table->file), *as ? "relative luminance" : "cd/m2");
    if (table->has_primaries) text_format(&text, ",%sred,%sgreen,%sblue", as, as, as);
    if (table->has_white) text_format(&text, ",%swhite", as);
    text_add(&text, "\n");
    for (int i = 0; i < table->rows; i++) {
        text_format(&text, "%.7g", table->level[i]);
        for (int p = 0; p < 3 && table->has_primaries; p++)
            text_format(&text, ",%.7g", table->primary_cd_m2[p][i]);
        if (table->has_white) text_format(&text, ",%.7g", table->white_cd_m2[i]);
        text_add(&text, "\n");
    }
    return text.data;
}

const char *level_table_note(const LevelTable *table, Arena *arena) {
    const LevelCurve *most = &table->curve[0];
    for (int p = 1; p < 3; p++)
        if (table->curve[p].count > most->count) most = &table->curve[p];
    const char *noise = !table->noise_rows ? ""
                                           : arena_format(arena,
                                                          "; %d rows that fall by "
                                                          "noise have their neighbours' mean",
                                                          table->noise_rows);
    const char *fit =
        most->is_smooth
            ? arena_format(arena,
                           "of which %d levels are made through the noise, %.2g %% (rms) "
                           "and at most %.2g %%",
                           most->count, 100 * most->rms, 100 * most->miss)
            : arena_format(arena, "of which %d keep all within %.2g %%", most->count,
                           100 * fmax(LEVEL_CURVE_MISS, most->miss));
    return arena_format(
        arena,
        "levels from %s: %d rows%s, %s (of their luminance and %g %% of "
        "full level); black is %.3g of white%s%s%s; the angular shape of white serves every "
        "level and black, an approximation",
        path_name(table->file), table->rows, table->is_relative ? " of relative luminance" : "",
        fit, 100 * LEVEL_CURVE_FLOOR, table->black_share,
        table->has_black ? "" : " (no row of level 0)",
        most->count > 1 ? "" : "; no level between, so a power of 2.2 is taken", noise);
}
