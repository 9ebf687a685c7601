/* SPDX-License-Identifier: Apache-2.0 */
/* ASTM E1392 / E2387 text (.astm): lines of a keyword and its value, then VARS with the names
 * of the columns, then rows of numbers between commas.
 *
 * theta_i, phi_i is where the light comes from and theta_s, phi_s where it leaves, in one
 * frame: the mirror direction is at phi_i + 180. Angles are radians in the files of Cornell's
 * gonioreflectometer; a file with a theta above 1.6 or a phi above 6.3 is in degrees. */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/number.h"
#include "base/units.h"
#include "import/scatter/scan.h"
#include "import/scatter/scatter.h"
#include "panel/set/measurement.h"

#define COLUMNS_MAX (4 + MEASUREMENT_WAVELENGTHS_MAX)
#define LIGHTS_MAX 4096
#define THETA_RADIANS_MAX 1.6
#define PHI_RADIANS_MAX 6.3

typedef enum AstmColumn { THETA_I, PHI_I, THETA_S, PHI_S, ANGLES } AstmColumn;

typedef struct Astm {
    WordScan scan;
    int columns, rows, stated_rows;
    int angle[ANGLES];      /* column of each, -1: none */
    int value[COLUMNS_MAX]; /* columns of the channels, in the order of the table */
    int channels;
    float *nm; /* NULL: not in the file */
    bool is_rgb, is_xyz;
    double *cell; /* rows x columns */
} Astm;

/* ---- header ------------------------------------------------------------------------------ */

/* "465nm" or "465 nm". */
static bool is_wavelength(const char *name, double *nm) {
    double value;
    const char *unit = number_read(name, &value);
    while (unit && *unit == ' ') unit++;
    if (!unit || strcasecmp(unit, "nm") || !(value > 0)) return false;
    *nm = value;
    return true;
}

static bool note_angle(Astm *in, const char *name, int column) {
    static const char *const names[] = {"theta_i", "phi_i", "theta_s", "phi_s", NULL};
    int which = import_word_find(names, name);
    if (which >= 0) in->angle[which] = column;
    return which >= 0;
}

/* Wavelengths rise in a table: by insertion. */
static void insert_channel(Astm *in, int column, float nm) {
    int at = in->channels++;
    for (; at > 0 && in->nm[at - 1] > nm; at--) {
        in->nm[at] = in->nm[at - 1];
        in->value[at] = in->value[at - 1];
    }
    in->nm[at] = nm;
    in->value[at] = column;
}

static bool is_triple(char *const *name, const char *letters) {
    for (int i = 0; i < 3; i++)
        if (strlen(name[i]) != 1 || strncasecmp(name[i], letters + i, 1)) return false;
    return true;
}

static bool name_channels(Astm *in, char *const *name, const int *column, int count, Error *err) {
    double nm;
    if (count == 3 && is_triple(name, "RGB")) {
        in->is_rgb = true;
        in->channels = 3;
        for (int c = 0; c < 3; c++) in->value[c] = column[2 - c]; /* blue first */
        return true;
    }
    if (count == 3 && is_triple(name, "XYZ")) {
        in->is_xyz = true;
        in->channels = 1;
        in->value[0] = column[1];
        return true;
    }
    if (count == 1 && !is_wavelength(name[0], &nm)) {
        in->channels = 1;
        in->value[0] = column[0];
        return true;
    }
    in->nm = ARENA_NEW(in->scan.arena, float, count);
    for (int c = 0; c < count; c++) {
        if (!is_wavelength(name[c], &nm))
            return scan_fail(&in->scan, err,
                             "VARS names '%.40s', required: a wavelength like "
                             "550nm, or R,G,B or X,Y,Z, or one column",
                             name[c]);
        insert_channel(in, column[c], (float)nm);
    }
    return true;
}

static bool read_names(Astm *in, char *text, Error *err) {
    char *name[COLUMNS_MAX];
    int column[COLUMNS_MAX], others = 0;
    for (char *at = text, *word; (word = strtok_r(at, ",", &at)); in->columns++) {
        while (*word == ' ' || *word == '\t') word++;
        if (in->columns == COLUMNS_MAX)
            return scan_fail(&in->scan, err, "VARS names more than %d columns", COLUMNS_MAX);
        if (note_angle(in, word, in->columns)) continue;
        name[others] = word;
        column[others++] = in->columns;
    }
    if (in->angle[THETA_I] < 0 || in->angle[THETA_S] < 0)
        return scan_fail(&in->scan, err, "VARS names no %s",
                         in->angle[THETA_I] < 0 ? "theta_i" : "theta_s");
    if (!others) return scan_fail(&in->scan, err, "VARS names no column of values");
    return name_channels(in, name, column, others, err);
}

static bool read_header(Astm *in, Error *err) {
    in->scan.comment = 0;
    for (int i = 0; i < ANGLES; i++) in->angle[i] = -1;
    for (const char *line; (line = scan_line(&in->scan));) {
        double number;
        if (!strncasecmp(line, "NUM_POINTS", 10)) {
            if (!number_is(line + 10, &number) || number < 1 || number > IMPORT_ROWS_MAX)
                return scan_fail(&in->scan, err, "NUM_POINTS is '%.40s', required: 1 to %d",
                                 line + 10, IMPORT_ROWS_MAX);
            in->stated_rows = (int)number;
        }
        if (strncasecmp(line, "VARS", 4) || (line[4] != ' ' && line[4] != '\t')) continue;
        return read_names(in, arena_string(in->scan.arena, line + 5, strlen(line + 5)), err);
    }
    return scan_fail(&in->scan, err, "the file ends in its header, required: VARS and rows");
}

/* ---- rows -------------------------------------------------------------------------------- */

/* A file that was cut must show: NUM_POINTS, or else a line end after the last row. */
static bool check_whole(const Astm *in, Error *err) {
    if (in->stated_rows && in->rows != in->stated_rows)
        return scan_fail(&in->scan, err, "there are %d rows, and NUM_POINTS is %d", in->rows,
                         in->stated_rows);
    if (!scan_check_end(&in->scan, err)) return false;
    return in->rows || scan_fail(&in->scan, err, "the file ends before its first row");
}

static bool read_rows(Astm *in, Error *err) {
    size_t columns = (size_t)in->columns;
    int most = scan_lines_left(&in->scan);
    if (columns > (size_t)(in->scan.end - in->scan.next) + 1)
        return scan_fail(&in->scan, err, "the file ends before its first row");
    in->scan.commas = true;
    in->cell = ARENA_NEW(in->scan.arena, double, (size_t)most *columns);
    while (scan_peek(&in->scan)) {
        if (in->rows == most)
            return scan_fail(&in->scan, err, "a line has more than %d numbers", in->columns);
        int line = in->scan.line;
        for (size_t c = 0; c < columns; c++) {
            if (!scan_number(&in->scan, "a number of the row",
                             &in->cell[(size_t)in->rows * columns + c], err))
                return false;
            if (!c) line = in->scan.line;
            else if (in->scan.line != line)
                return scan_fail(&in->scan, err, "the row before has fewer than %d numbers",
                                 in->columns);
        }
        in->rows++;
    }
    return check_whole(in, err);
}

/* Radians become degrees; a missing azimuth of the light is 180, of the leaving direction 0. */
static bool convert_angles(Astm *in, ImportSet *set, Error *err) {
    static const double most[ANGLES] = {THETA_RADIANS_MAX, PHI_RADIANS_MAX, THETA_RADIANS_MAX,
                                        PHI_RADIANS_MAX};
    static const double limit[ANGLES] = {90, 360, 180, 360};
    bool is_degree = false;
    for (int i = 0; i < in->rows; i++)
        for (int a = 0; a < ANGLES; a++)
            if (in->angle[a] >= 0)
                is_degree |= fabs(in->cell[i * in->columns + in->angle[a]]) > most[a];
    for (int i = 0; i < in->rows; i++)
        for (int a = 0; a < ANGLES; a++) {
            if (in->angle[a] < 0) continue;
            double *one = &in->cell[i * in->columns + in->angle[a]];
            if (!is_degree) *one = degrees_from_radians(*one);
            if (!(fabs(*one) <= limit[a] + 1e-3))
                return error_at(err, ERROR_INPUT, in->scan.file, "",
                                "row %d has an angle of "
                                "%g, required: at most %g degrees",
                                i + 1, *one, limit[a]);
        }
    import_note(set, "%s: angles are taken as %s", path_name(in->scan.file),
                is_degree ? "degrees" : "radians");
    return true;
}

/* ---- tables ------------------------------------------------------------------------------ */

static double angle_of(const Astm *in, int row, AstmColumn which, double otherwise) {
    return in->angle[which] < 0 ? otherwise : in->cell[row * in->columns + in->angle[which]];
}

static ScatterLight light_of(const Astm *in, int row) {
    ScatterLight light = {angle_of(in, row, THETA_I, 0), angle_of(in, row, PHI_I, 180)};
    if (light.incidence_deg < 0) {
        light.incidence_deg = -light.incidence_deg;
        light.azimuth_deg += 180;
    }
    return light;
}

static bool same_light(ScatterLight a, ScatterLight b) {
    return fabs(a.incidence_deg - b.incidence_deg) < 1e-4 &&
           fabs(remainder(a.azimuth_deg - b.azimuth_deg, 360)) < 1e-4;
}

static void put_row(const Astm *in, int row, ScatterLight light, ImportRows *rows) {
    double value[MEASUREMENT_WAVELENGTHS_MAX];
    double theta = angle_of(in, row, THETA_S, 0), phi = angle_of(in, row, PHI_S, 0);
    for (int c = 0; c < in->channels; c++) value[c] = in->cell[row * in->columns + in->value[c]];
    if (theta < 0) phi += 180;
    scatter_put_measured(rows, fabs(theta), phi + 180 - light.azimuth_deg, value);
}

static bool add_tables(const Astm *in, const float *nm, ImportSet *set, Error *err) {
    int count = 0, *group = ARENA_NEW(set->arena, int, in->rows);
    ScatterLight *light = ARENA_NEW(set->arena, ScatterLight, LIGHTS_MAX);
    int *size = ARENA_NEW(set->arena, int, LIGHTS_MAX);
    for (int i = 0, g = 0; i < in->rows; i++) {
        ScatterLight one = light_of(in, i);
        if (g == count || !same_light(light[g], one)) /* rows of one light stand together */
            for (g = 0; g < count && !same_light(light[g], one);) g++;
        if (g == LIGHTS_MAX)
            return error_at(err, ERROR_INPUT, in->scan.file, "",
                            "has light from more than %d "
                            "directions",
                            LIGHTS_MAX);
        if (g == count) light[count++] = one;
        size[group[i] = g]++;
    }
    ImportRows *rows = ARENA_NEW(set->arena, ImportRows, count);
    for (int g = 0; g < count; g++) rows[g] = scatter_rows(set->arena, size[g], in->channels);
    for (int i = 0; i < in->rows; i++) put_row(in, i, light[group[i]], &rows[group[i]]);
    for (int g = 0; g < count; g++)
        if (!scatter_add(set, in->scan.file, &rows[g], light[g], nm, err)) return false;
    return true;
}

static const float *name_bands(const Astm *in, const ImportOptions *options, ImportSet *set,
                               Error *err) {
    const char *file = in->scan.file;
    if (in->nm) return in->nm;
    if (in->is_rgb) return scatter_rgb_bands(file, set);
    return in->is_xyz ? scatter_xyz(options, file, set)
                      : scatter_wavelength(options, file, set, err);
}

static bool read_astm(const char *file, const ImportOptions *options, ImportSet *set, Error *err) {
    Astm in = {.columns = 0};
    const float *nm;
    if (!scan_open(file, set->arena, &in.scan, err) || !read_header(&in, err) ||
        !read_rows(&in, err) || !convert_angles(&in, set, err) ||
        !(nm = name_bands(&in, options, set, err)))
        return false;
    if (in.channels > MEASUREMENT_WAVELENGTHS_MAX)
        return error_at(err, ERROR_INPUT, file, "", "has %d wavelengths, required: at most %d",
                        in.channels, MEASUREMENT_WAVELENGTHS_MAX);
    return add_tables(&in, nm, set, err);
}

static bool is_astm(const char *file, const char *head, size_t head_size) {
    (void)file;
    return scan_head_has(head, head_size, "VARS theta_i") ||
           scan_head_has(head, head_size, "VARS\ttheta_i");
}

const Importer importer_astm = {"astm", "ASTM E1392 / E2387 text (.astm)", is_astm, read_astm};
