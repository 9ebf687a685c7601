/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/angle_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/number.h"
#include "base/sort.h"
#include "base/units.h"
#include "text/csv_table.h"
#include "text/nearest_word.h"

const char *const primary_names[3] = {"red", "green", "blue"};

/* Directions nearer than this are the same one. */
#define SAME_DEG 1e-4f

/* How far below zero noise may reach: an absolute part and a share of the table's maximum. */
typedef struct NoiseAllowance {
    float absolute, share;
    const char *unit;
} NoiseAllowance;

static const NoiseAllowance emission_noise = {ANGLE_TABLE_NOISE_CD_M2,
                                              ANGLE_TABLE_NOISE_CD_M2_SHARE, "cd/m2"};
static const NoiseAllowance brdf_noise = {ANGLE_TABLE_NOISE_BRDF, ANGLE_TABLE_NOISE_BRDF_SHARE,
                                          "sr^-1"};

/* One row while it is sorted: where it came from and where it looks. */
typedef struct Row {
    float theta_deg, phi_deg;
    int line, source;
} Row;

typedef struct RawTable {
    const char *file, *name;
    Row *row;
    int rows, channels;
    const float *value; /* rows x channels in the file's order */
    size_t bytes;
    bool is_emission; /* X, Y, Z */
} RawTable;

static int by_direction(const void *a, const void *b) {
    const Row *p = a, *q = b;
    if (p->theta_deg != q->theta_deg) return p->theta_deg < q->theta_deg ? -1 : 1;
    if (p->phi_deg != q->phi_deg) return p->phi_deg < q->phi_deg ? -1 : 1;
    return p->line - q->line;
}

/* "line 12" in the arena. */
static const char *place_of(int line, Arena *arena) {
    return arena_format(arena, "line %d", line);
}

/* Brings theta to [0, 90] and phi to [0, 360); a negative theta is the other side. */
static bool place_row(const RawTable *raw, Row *row, Arena *arena, Error *err) {
    if (!(fabsf(row->theta_deg) <= 90))
        return error_at(err, ERROR_INPUT, raw->file, place_of(row->line, arena),
                        "theta is %g, required: 0 to 90 degrees", (double)row->theta_deg);
    if (!(fabsf(row->phi_deg) <= 360))
        return error_at(err, ERROR_INPUT, raw->file, place_of(row->line, arena),
                        "phi is %g, required: -360 to 360 degrees", (double)row->phi_deg);
    if (row->theta_deg < 0) {
        row->theta_deg = -row->theta_deg;
        row->phi_deg += 180;
    }
    while (row->phi_deg < 0) row->phi_deg += 360;
    while (row->phi_deg >= 360 - SAME_DEG) row->phi_deg -= 360;
    if (row->phi_deg < 0) row->phi_deg = 0;
    if (row->theta_deg < SAME_DEG) row->theta_deg = 0;
    return true;
}

static bool check_signs(const RawTable *raw, NoiseAllowance noise, Arena *arena, Error *err) {
    size_t total = (size_t)raw->rows * (size_t)raw->channels;
    float most = 0;
    for (size_t i = 0; i < total; i++) most = raw->value[i] > most ? raw->value[i] : most;
    float allowed = fmaxf(noise.absolute, noise.share * most);
    for (size_t i = 0; i < total; i++)
        if (raw->value[i] < -allowed)
            return error_at(err, ERROR_INPUT, raw->file,
                            place_of(raw->row[i / (size_t)raw->channels].line, arena),
                            "a value is %g, required: at least %g %s (noise below zero)",
                            (double)raw->value[i], -(double)allowed, noise.unit);
    return true;
}

static bool same_values(const RawTable *raw, const Row *a, const Row *b) {
    size_t size = (size_t)raw->channels;
    return !memcmp(raw->value + (size_t)a->source * size, raw->value + (size_t)b->source * size,
                   sizeof *raw->value * size);
}

static bool same_direction(const Row *a, const Row *b) {
    return fabsf(a->theta_deg - b->theta_deg) < SAME_DEG &&
           fabsf(a->phi_deg - b->phi_deg) < SAME_DEG;
}

static void keep_row(const RawTable *raw, const Row *row, AngleTable *table, float *theta,
                     float *phi, float *value) {
    size_t size = (size_t)raw->channels;
    theta[table->rows] = (float)radians_from_degrees((double)row->theta_deg);
    phi[table->rows] = (float)radians_from_degrees((double)row->phi_deg);
    memcpy(value + (size_t)table->rows * size, raw->value + (size_t)row->source * size,
           sizeof *value * size);
    table->rows++;
}

#define POLE_ROWS 4       /* so many show which of them is wrong */
#define POLE_LIMIT 0.284f /* e^0.25 - 1: further from the median is a hot or dead pixel */

static float pole_median(const RawTable *raw, int count, size_t channel, Arena scratch) {
    float *list = ARENA_NEW(&scratch, float, count);
    for (int i = 0; i < count; i++)
        list[i] = raw->value[(size_t)raw->row[i].source * (size_t)raw->channels + channel];
    sort_floats(list, count);
    return list[count / 2];
}

/* Emission at theta 0: rows that are off the median in any component. */
static void find_pole_outliers(const RawTable *raw, int count, AngleTable *table, Arena *arena) {
    float median[3];
    if (!raw->is_emission || count < POLE_ROWS) return;
    AngleOutlier *list = ARENA_NEW(arena, AngleOutlier, count);
    for (size_t c = 0; c < 3; c++) median[c] = pole_median(raw, count, c, *arena);
    table->pole_outlier = list;
    for (int i = 0; i < count; i++) {
        const float *at = raw->value + 3 * (size_t)raw->row[i].source;
        bool is_far = false;
        for (int c = 0; c < 3; c++)
            is_far |= fabsf(at[c] - median[c]) > POLE_LIMIT * fmaxf(median[c], 0.05f);
        if (is_far)
            list[table->pole_outliers++] = (AngleOutlier){
                i, (float)radians_from_degrees((double)raw->row[i].phi_deg), at[1], median[1]};
    }
    if (2 * table->pole_outliers > count) table->pole_outliers = 0; /* none is right */
}

static bool is_pole_outlier(const AngleTable *table, int row) {
    for (int i = 0; i < table->pole_outliers; i++)
        if (table->pole_outlier[i].row == row) return true;
    return false;
}

/* All rows at theta 0 are one direction: the mean of those that do not stand out. Returns how
 * many there are. */
static int keep_pole(const RawTable *raw, AngleTable *table, float *theta, float *phi, float *value,
                     Arena *arena) {
    int count = 0;
    size_t size = (size_t)raw->channels;
    while (count < raw->rows && raw->row[count].theta_deg == 0) count++;
    if (!count) return 0;
    keep_row(raw, &raw->row[0], table, theta, phi, value);
    phi[0] = 0;
    find_pole_outliers(raw, count, table, arena);
    for (size_t c = 0; c < size; c++) {
        double sum = 0, kept = 0;
        for (int i = 0; i < count; i++) {
            if (is_pole_outlier(table, i)) continue;
            sum += (double)raw->value[(size_t)raw->row[i].source * size + c];
            kept++;
        }
        value[c] = (float)(sum / kept);
    }
    return count;
}

static bool finish_table(RawTable *raw, NoiseAllowance noise, Arena *arena, AngleTable *out,
                         Error *err) {
    for (int i = 0; i < raw->rows; i++)
        if (!place_row(raw, &raw->row[i], arena, err)) return false;
    if (!check_signs(raw, noise, arena, err)) return false;
    qsort(raw->row, (size_t)raw->rows, sizeof *raw->row, by_direction);
    float *theta = ARENA_NEW(arena, float, raw->rows);
    float *phi = ARENA_NEW(arena, float, raw->rows);
    float *value = ARENA_NEW(arena, float, (size_t)raw->rows *(size_t)raw->channels);
    AngleTable table = {.name = raw->name,
                        .channels = raw->channels,
                        .theta = theta,
                        .phi = phi,
                        .value = value,
                        .text_bytes = raw->bytes};
    for (int i = keep_pole(raw, &table, theta, phi, value, arena); i < raw->rows; i++) {
        const Row *row = &raw->row[i], *last = &raw->row[i - 1];
        if (!i || !same_direction(row, last)) {
            keep_row(raw, row, &table, theta, phi, value);
        } else if (!same_values(raw, row, last)) {
            return error_at(err, ERROR_INPUT, raw->file, place_of(row->line, arena),
                            "theta %g, phi %g stands here and in line %d with different "
                            "values, required: every direction once",
                            (double)row->theta_deg, (double)row->phi_deg, last->line);
        }
    }
    table.theta_max = theta[table.rows - 1];
    *out = table;
    return true;
}

/* ---- columns ------------------------------------------------------------------------- */

static int angle_column(const CsvTable *csv, const char *name) {
    for (int c = 0; c < csv->columns; c++)
        if (!strcasecmp(csv->name[c], name)) return c;
    return -1;
}

static bool missing_column(const CsvTable *csv, const char *wanted, Error *err) {
    return error_at(err, ERROR_INPUT, csv->file, "header line",
                    "has no column '%s'; the nearest one is '%s'", wanted,
                    nearest_word(wanted, csv->name, csv->columns));
}

static bool start_rows(const CsvTable *csv, const char *name, Arena *arena, RawTable *raw,
                       Error *err) {
    int theta = angle_column(csv, "theta"), phi = angle_column(csv, "phi");
    if (theta < 0) return missing_column(csv, "theta", err);
    if (phi < 0) return missing_column(csv, "phi", err);
    *raw = (RawTable){.file = csv->file,
                      .name = name,
                      .rows = csv->rows,
                      .bytes = csv->bytes,
                      .row = ARENA_NEW(arena, Row, csv->rows)};
    for (int i = 0; i < csv->rows; i++) {
        const float *cell = csv->cell + (size_t)i * (size_t)csv->columns;
        raw->row[i] = (Row){cell[theta], cell[phi], csv->line[i], i};
    }
    return true;
}

static bool reject_other_columns(const CsvTable *csv, const char *const *wanted, int count,
                                 Error *err) {
    for (int c = 0; c < csv->columns; c++) {
        bool known = false;
        for (int i = 0; i < count && !known; i++)
            known = i < 2 ? !strcasecmp(csv->name[c], wanted[i]) : !strcmp(csv->name[c], wanted[i]);
        if (!known)
            return error_at(err, ERROR_INPUT, csv->file, "header line",
                            "column '%s' is unknown; the nearest known one is '%s'", csv->name[c],
                            nearest_word(csv->name[c], wanted, count));
    }
    return true;
}

/* X and Z from luminance and chromaticity; a row without light may have any chromaticity. */
static bool xyz_from_yxy(const RawTable *raw, float *value, int line, Arena *arena, Error *err) {
    float y_cd_m2 = value[0], x = value[1], y = value[2];
    if (!(x >= 0) || !(y >= 0) || !(x + y <= 1) || (y == 0 && y_cd_m2 != 0)) {
        return error_at(err, ERROR_INPUT, raw->file, place_of(line, arena),
                        "chromaticity is x %g, y %g, required: a point of the CIE 1931 diagram",
                        (double)x, (double)y);
    }
    float scale = y > 0 ? y_cd_m2 / y : 0;
    value[0] = scale * x;
    value[1] = y_cd_m2;
    value[2] = scale * (1 - x - y);
    return true;
}

/* Address space for the text of one file and its numbers; given back when they are sorted. */
#define SCRATCH_BYTES ((size_t)64 << 30)

static bool read_xyz(const char *file, const char *name, Arena *scratch, RawTable *out,
                     Error *err) {
    static const char *const xyz[] = {"theta", "phi", "X", "Y", "Z"};
    static const char *const yxy[] = {"theta", "phi", "Y", "x", "y"};
    CsvTable csv;
    RawTable raw;
    if (!csv_table_read(file, scratch, &csv, err)) return false;
    bool is_yxy = csv_table_column(&csv, "x") >= 0 && csv_table_column(&csv, "X") < 0;
    const char *const *wanted = is_yxy ? yxy : xyz;
    if (!start_rows(&csv, name, scratch, &raw, err) || !reject_other_columns(&csv, wanted, 5, err))
        return false;
    float *value = ARENA_NEW(scratch, float, 3 * (size_t)csv.rows);
    for (int j = 0; j < 3; j++) {
        int column = csv_table_column(&csv, wanted[2 + j]);
        if (column < 0) return missing_column(&csv, wanted[2 + j], err);
        for (int i = 0; i < csv.rows; i++)
            value[3 * i + j] = csv.cell[(size_t)i * (size_t)csv.columns + (size_t)column];
    }
    for (int i = 0; i < csv.rows && is_yxy; i++)
        if (!xyz_from_yxy(&raw, value + 3 * i, csv.line[i], scratch, err)) return false;
    raw.value = value;
    raw.channels = 3;
    raw.is_emission = true;
    *out = raw;
    return true;
}

bool angle_table_read_xyz(const char *file, const char *name, Arena *arena, AngleTable *out,
                          Error *err) {
    RawTable raw;
    Arena scratch = arena_reserve(SCRATCH_BYTES);
    bool ok = read_xyz(file, name, &scratch, &raw, err) &&
              finish_table(&raw, emission_noise, arena, out, err);
    arena_release(&scratch);
    return ok;
}

static bool is_wavelength_column(const CsvTable *csv, int column, const float *wavelength_nm,
                                 int count) {
    float nm;
    if (!number_read_float(csv->name[column], &nm)) return false;
    for (int w = 0; w < count; w++)
        if (fabsf(nm - wavelength_nm[w]) < 1e-3f) return true;
    return false;
}

/* Column of a wavelength: its number, with or without "nm" behind it; or "brdf". */
static int wavelength_column(const CsvTable *csv, float nm, int count) {
    for (int c = 0; c < csv->columns; c++) {
        float value;
        const char *after = number_read_float(csv->name[c], &value);
        if (after && fabsf(value - nm) < 1e-3f && (!*after || !strcmp(after, "nm"))) return c;
    }
    return count == 1 ? csv_table_column(csv, "brdf") : -1;
}

static bool reject_other_wavelengths(const CsvTable *csv, const float *wavelength_nm, int count,
                                     Error *err) {
    for (int c = 0; c < csv->columns; c++) {
        const char *name = csv->name[c];
        if (!strcasecmp(name, "theta") || !strcasecmp(name, "phi")) continue;
        if (count == 1 && !strcmp(name, "brdf")) continue;
        if (!is_wavelength_column(csv, c, wavelength_nm, count))
            return error_at(err, ERROR_INPUT, csv->file, "header line",
                            "column '%s' is no wavelength of the manifest, required: theta, "
                            "phi and wavelengths_nm",
                            name);
    }
    return true;
}

static bool read_brdf(const char *file, const float *wavelength_nm, int count, Arena *scratch,
                      RawTable *out, Error *err) {
    CsvTable csv;
    RawTable raw;
    if (!csv_table_read(file, scratch, &csv, err) || !start_rows(&csv, "", scratch, &raw, err) ||
        !reject_other_wavelengths(&csv, wavelength_nm, count, err))
        return false;
    float *value = ARENA_NEW(scratch, float, (size_t)csv.rows *(size_t)count);
    for (int w = 0; w < count; w++) {
        int column = wavelength_column(&csv, wavelength_nm[w], count);
        if (column < 0)
            return error_at(err, ERROR_INPUT, file, "header line",
                            "has no column for %g nm, required: one a wavelength of the "
                            "manifest",
                            (double)wavelength_nm[w]);
        for (int i = 0; i < csv.rows; i++)
            value[(size_t)i * (size_t)count + (size_t)w] =
                csv.cell[(size_t)i * (size_t)csv.columns + (size_t)column];
    }
    raw.value = value;
    raw.channels = count;
    *out = raw;
    return true;
}

bool angle_table_read_brdf(const char *file, const float *wavelength_nm, int count, Arena *arena,
                           AngleTable *out, Error *err) {
    RawTable raw;
    Arena scratch = arena_reserve(SCRATCH_BYTES);
    bool ok = read_brdf(file, wavelength_nm, count, &scratch, &raw, err) &&
              finish_table(&raw, brdf_noise, arena, out, err);
    arena_release(&scratch);
    return ok;
}

bool angle_table_same_rows(const AngleTable *a, const AngleTable *b) {
    return a->rows == b->rows && !memcmp(a->theta, b->theta, sizeof *a->theta * (size_t)a->rows) &&
           !memcmp(a->phi, b->phi, sizeof *a->phi * (size_t)a->rows);
}
