/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/primary_spectra.h"

#include <math.h>
#include <strings.h>

#include "panel/set/angle_table.h"
#include "panel/shape/spectral_warp.h"
#include "spectrum/curve.h"

#define NOISE_MOST 0.02 /* below zero, of a column's largest */

/* Linear between measured wavelengths, zero outside them. */
static void resample_spectrum(const CsvTable *csv, int nm_column, int column, float *out) {
    size_t width = (size_t)csv->columns;
    int last = 0;
    for (int i = 0; i < SPECTRAL_COUNT; i++) {
        float nm = (float)(SPECTRAL_FIRST_NM + i);
        while (last + 2 < csv->rows &&
               csv->cell[(size_t)(last + 1) * width + (size_t)nm_column] <= nm)
            last++;
        const float *a = csv->cell + (size_t)last * width;
        const float *b = csv->rows > 1 ? a + width : a;
        float t =
            b[nm_column] > a[nm_column] ? (nm - a[nm_column]) / (b[nm_column] - a[nm_column]) : 0;
        float value = a[column] + (b[column] - a[column]) * t;
        out[i] = t >= 0 && t <= 1 && value > 0 ? value : 0;
    }
}

/* The column of a primary's or the wavelength's name, in any case; -1: none. */
static int column_of(const CsvTable *csv, int which) {
    static const char *const names[PRIMARY_COLUMNS][3] = {{"nm", "wavelength", "wavelength_nm"},
                                                          {"red", "R", "red"},
                                                          {"green", "G", "green"},
                                                          {"blue", "B", "blue"},
                                                          {"black", "K", "black"}};
    for (int c = 0; c < csv->columns; c++)
        for (int k = 0; k < 3; k++)
            if (!strcasecmp(csv->name[c], names[which][k])) return c;
    return -1;
}

bool primary_columns_read(const char *file, Arena *arena, CsvTable *csv,
                          int column[PRIMARY_COLUMNS], Error *err) {
    static const char *const names[] = {"nm", "red", "green", "blue"};
    if (!csv_table_read(file, arena, csv, err)) return false;
    int found = 0;
    for (int k = 0; k < PRIMARY_COLUMNS; k++) {
        column[k] = column_of(csv, k);
        found += column[k] >= 0;
        if (column[k] < 0 && k < 4)
            return error_at(err, ERROR_INPUT, file, "header line", "has no column '%s'", names[k]);
    }
    if (found < csv->columns)
        return error_at(err, ERROR_INPUT, file, "header line",
                        "has %d columns, required: nm, red, green, blue and maybe black, each once",
                        csv->columns);
    for (int i = 1; i < csv->rows; i++) {
        const float *nm = csv->cell + (size_t)i * (size_t)csv->columns + column[0];
        if (!(*nm > nm[-csv->columns]))
            return error_at(err, ERROR_INPUT, file, csv_table_place(csv, i, arena),
                            "wavelength %g follows %g, required: rising wavelengths", (double)*nm,
                            (double)nm[-csv->columns]);
    }
    return true;
}

bool primary_spectrum_reaches(const PrimaryColumn *column, double *beyond, Error *err) {
    double first_nm = column->nm[0], last_nm = column->nm[column->count - 1];
    CurveEnds dark = curve_dark_ends(column->value, column->count, NOISE_MOST);
    *beyond = fmax(*beyond, curve_beyond(first_nm, last_nm, dark));
    return curve_reaches(first_nm, last_nm, dark) ||
           error_at(err, ERROR_INPUT, column->file, "",
                    "column '%s' goes from %g to %g nm and "
                    "ends in light, required: %d to %d nm or beyond",
                    column->name, first_nm, last_nm, CURVE_SEEN_FIRST_NM, CURVE_SEEN_LAST_NM);
}

/* Noise below zero is left out; more is no light. Wavelengths that are not measured count as
 * dark. */
static bool check_light(const CsvTable *csv, int nm_column, int column, Arena scratch,
                        double *beyond, Error *err) {
    double *nm = ARENA_NEW(&scratch, double, csv->rows);
    double *value = ARENA_NEW(&scratch, double, csv->rows), least = 0, most = 0;
    int darkest = 0;
    for (int i = 0; i < csv->rows; i++) {
        const float *row = csv->cell + (size_t)i * (size_t)csv->columns;
        nm[i] = (double)row[nm_column];
        value[i] = (double)row[column];
        if (value[i] < least) least = value[i], darkest = i;
        most = fmax(most, value[i]);
    }
    if (-least > NOISE_MOST * most)
        return error_at(err, ERROR_INPUT, csv->file, csv_table_place(csv, darkest, &scratch),
                        "column '%s' holds %g, required: 0 or more (noise up to %g %% of its "
                        "largest, %g)",
                        csv->name[column], least, 100 * NOISE_MOST, most);
    return primary_spectrum_reaches(
        &(PrimaryColumn){csv->file, csv->name[column], nm, value, csv->rows}, beyond, err);
}

static bool spectrum_has_light(const float *spectrum) {
    for (int i = 0; i < SPECTRAL_COUNT; i++)
        if (spectrum[i] > 0 && spectral_table[i].y > 0) return true;
    return false;
}

bool primary_spectra_read(const char *file, Arena *arena, float spectrum[3][SPECTRAL_COUNT],
                          double *beyond, Error *err) {
    CsvTable csv;
    int column[PRIMARY_COLUMNS];
    if (!primary_columns_read(file, arena, &csv, column, err)) return false;
    for (int p = 0; p < 3; p++) {
        if (!check_light(&csv, column[0], column[1 + p], *arena, beyond, err)) return false;
        resample_spectrum(&csv, column[0], column[1 + p], spectrum[p]);
        if (!spectrum_has_light(spectrum[p]))
            return error_at(err, ERROR_INPUT, file, "",
                            "column '%s' holds no light between "
                            "360 and 830 nm",
                            primary_names[p]);
    }
    return true;
}

/* ---- measured twice ---------------------------------------------------------------------- */

/* The table that a spectrum is nearest to. Primaries of one colour (of a monochrome display)
 * cannot be told apart: its own. */
static int nearest_table(const PrimaryColours *colours, int p) {
    int nearest = p;
    double own = twice_colour(colours->spectrum[p], colours->table[p]), least = own;
    for (int q = 0; q < 3 && own > PRIMARY_APART_UV; q++) {
        double apart = twice_colour(colours->spectrum[p], colours->table[q]);
        bool is_told = twice_colour(colours->table[p], colours->table[q]) > PRIMARY_APART_UV &&
                       twice_colour(colours->spectrum[p], colours->spectrum[q]) > PRIMARY_APART_UV;
        if (is_told && apart < least) nearest = q, least = apart;
    }
    return nearest;
}

bool primary_colours_check(const PrimaryColours *colours, Error *err) {
    for (int p = 0; p < 3; p++) {
        int q = nearest_table(colours, p);
        if (q == p) continue;
        return error_at(err, ERROR_INPUT, colours->file, "",
                        "column '%s' is %.2g in u'v' from what was measured of %s and %.2g from "
                        "%s, required: nearest to its own: are columns, or tables, exchanged?",
                        primary_names[p], twice_colour(colours->spectrum[p], colours->table[q]),
                        primary_names[q], twice_colour(colours->spectrum[p], colours->table[p]),
                        primary_names[p]);
    }
    return true;
}

bool primary_colour(const Measurement *set, int p, int level, double xyz[3]) {
    const AngleTable *const of[2] = {&set->primary[p].table[level], &set->black};
    for (int b = 0; b < 1 + set->has_black; b++) {
        int rows = 0;
        double sum[3] = {0, 0, 0};
        for (; rows < of[b]->rows && of[b]->theta[rows] == of[b]->theta[0]; rows++)
            for (int j = 0; j < 3; j++) sum[j] += (double)of[b]->value[3 * rows + j];
        for (int j = 0; j < 3; j++) xyz[j] = b ? fmax(0, xyz[j] - sum[j] / rows) : sum[j] / rows;
    }
    bool has_light = xyz[0] >= 0 && xyz[1] > 0 && xyz[2] >= 0;
    for (int j = 0; j < 3 && !has_light; j++) xyz[j] = (double)xyz_from_rgb_matrix[3 * j + p];
    return has_light;
}

/* White that is no mixture of Rec.709's has shares of its own colour as primaries. */
bool primary_spectra_check(const Measurement *set, const char *file, Error *err) {
    PrimaryColours colours = {.file = file};
    if (!set->has_spectra || !set->primary[0].level_count || set->white_miss > 0) return true;
    for (int p = 0; p < 3; p++) {
        panel_spectrum_xyz(set->spectrum[p], colours.spectrum[p]);
        if (!primary_colour(set, p, set->primary[p].level_count - 1, colours.table[p])) return true;
    }
    return primary_colours_check(&colours, err);
}

bool primary_twice(const Measurement *set, Twice *worst) {
    *worst = (Twice){.apart = -1};
    if (!set->has_spectra || set->is_white_only || !set->primary[0].level_count) return false;
    for (int p = 0; p < 3; p++) {
        double spectrum[3], table[3];
        panel_spectrum_xyz(set->spectrum[p], spectrum);
        if (!primary_colour(set, p, set->primary[p].level_count - 1, table)) return false;
        Twice one = {primary_names[p],
                     {"its spectrum", "its XYZ along the normal"},
                     twice_colour(spectrum, table),
                     PRIMARY_APART_UV,
                     " in u'v'"};
        if (!(one.apart <= worst->apart)) *worst = one;
    }
    return true;
}
