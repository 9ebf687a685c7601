/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/specular_table.h"

#include <math.h>

#include "base/count.h"
#include "base/file.h"
#include "base/mathd.h"
#include "base/sort.h"
#include "base/units.h"
#include "record/rows.h"
#include "spectrum/fresnel.h"
#include "text/csv_table.h"
#include "text/text.h"

#define GLASS_INDEX 1.567   /* of the gloss standard */
#define TABLE_INDEX 1.5     /* what is linear between incidences is over this one's */
#define ANY_NM 550.0        /* of a table without wavelengths */
#define PLACES_MOST 1000000 /* incidences by wavelengths: a table has hundreds */
#define GLOSS_MOST 2000.0   /* gu: a metal mirror at 20 degrees */

/* ---- the file ---------------------------------------------------------------------------- */

typedef struct SpecularColumns {
    int incidence, nm, value;
} SpecularColumns;

static int either_column(const CsvTable *csv, const char *a, const char *b) {
    int at = csv_table_column(csv, a);
    return at >= 0 ? at : csv_table_column(csv, b);
}

static bool find_columns(const CsvTable *csv, SpecularColumns *out, Error *err) {
    static const char *const known[] = {"incidence", "theta", "wavelength", "nm", "reflectance"};
    if (!csv_table_check_columns(csv, known, COUNT_OF(known), err)) return false;
    *out = (SpecularColumns){either_column(csv, "incidence", "theta"),
                             either_column(csv, "wavelength", "nm"),
                             csv_table_column(csv, "reflectance")};
    if (out->incidence < 0 || out->value < 0)
        return error_at(err, ERROR_INPUT, csv->file, "header line",
                        "column '%s' is missing, "
                        "required: incidence, wavelength and reflectance",
                        out->value < 0 ? "reflectance" : "incidence");
    return csv->rows > 0 || error_at(err, ERROR_INPUT, csv->file, "", "has no rows");
}

static double cell_of(const CsvTable *csv, int row, int column) {
    return (double)csv->cell[(size_t)row * (size_t)csv->columns + (size_t)column];
}

static double nm_of(const CsvTable *csv, const SpecularColumns *columns, int row) {
    return columns->nm < 0 ? ANY_NM : cell_of(csv, row, columns->nm);
}

static bool check_row(const CsvTable *csv, const SpecularColumns *columns, int row, Arena *arena,
                      Error *err) {
    const char *place = csv_table_place(csv, row, arena);
    double degrees = cell_of(csv, row, columns->incidence), nm = nm_of(csv, columns, row);
    double value = cell_of(csv, row, columns->value);
    if (!(degrees >= 0 && degrees < 90))
        return error_at(err, ERROR_INPUT, csv->file, place,
                        "incidence is %g degrees, "
                        "required: 0 to less than 90",
                        degrees);
    if (!(nm >= 360 && nm <= 830))
        return error_at(err, ERROR_INPUT, csv->file, place,
                        "wavelength is %g nm, required: "
                        "360 to 830",
                        nm);
    return (value >= 0 && value <= 1) || error_at(err, ERROR_INPUT, csv->file, place,
                                                  "reflectance is %g, required: 0 to 1 "
                                                  "(a share, not per cent)",
                                                  value);
}

/* Sorted, each once; how many. */
static int distinct(double *value, int count) {
    int kept = 0;
    sort_doubles(value, count);
    for (int i = 0; i < count; i++)
        if (!kept || value[i] > value[kept - 1]) value[kept++] = value[i];
    return kept;
}

static int place_of(const double *list, int count, double value) {
    int i = 0;
    while (i + 1 < count && list[i] < value) i++;
    return i;
}

/* Every incidence at every wavelength, once. */
static bool fill_table(const CsvTable *csv, const SpecularColumns *columns, const double *degrees,
                       Arena *arena, SpecularTable *out, Error *err) {
    if ((long long)out->rows * out->wavelengths > PLACES_MOST)
        return error_at(err, ERROR_INPUT, csv->file, "",
                        "has %d incidences and %d wavelengths "
                        "in %d rows, required: every incidence at every wavelength",
                        out->rows, out->wavelengths, csv->rows);
    int size = out->rows * out->wavelengths;
    double *value = ARENA_NEW(arena, double, size);
    for (int i = 0; i < size; i++) value[i] = -1;
    for (int row = 0; row < csv->rows; row++) {
        int i = place_of(degrees, out->rows, cell_of(csv, row, columns->incidence));
        int w = place_of(out->nm, out->wavelengths, nm_of(csv, columns, row));
        double *at = &value[i * out->wavelengths + w];
        if (*at >= 0)
            return error_at(err, ERROR_INPUT, csv->file, csv_table_place(csv, row, arena),
                            "%g degrees at %g nm stands there already, required: once", degrees[i],
                            out->nm[w]);
        *at = cell_of(csv, row, columns->value);
    }
    for (int i = 0; i < size; i++)
        if (value[i] < 0)
            return error_at(err, ERROR_INPUT, csv->file, "",
                            "has no reflectance at %g degrees "
                            "and %g nm, required: every incidence at every wavelength",
                            degrees[i / out->wavelengths], out->nm[i % out->wavelengths]);
    out->value = value;
    return true;
}

bool specular_table_read_file(const char *file, double aperture_deg, Arena *arena,
                              SpecularTable *out, Error *err) {
    CsvTable csv;
    SpecularColumns columns;
    if (!csv_table_read(file, arena, &csv, err) || !find_columns(&csv, &columns, err)) return false;
    double *degrees = ARENA_NEW(arena, double, csv.rows);
    double *nm = ARENA_NEW(arena, double, csv.rows);
    for (int i = 0; i < csv.rows; i++) {
        if (!check_row(&csv, &columns, i, arena, err)) return false;
        degrees[i] = cell_of(&csv, i, columns.incidence);
        nm[i] = nm_of(&csv, &columns, i);
    }
    *out = (SpecularTable){.file = file,
                           .rows = distinct(degrees, csv.rows),
                           .wavelengths = distinct(nm, csv.rows),
                           .nm = nm};
    if (!fill_table(&csv, &columns, degrees, arena, out, err)) return false;
    double *incidence = ARENA_NEW(arena, double, out->rows);
    double *aperture = ARENA_NEW(arena, double, out->rows);
    for (int i = 0; i < out->rows; i++) {
        incidence[i] = radians_from_degrees(degrees[i]);
        aperture[i] = radians_from_degrees(aperture_deg);
    }
    out->incidence = incidence;
    out->aperture = aperture;
    return true;
}

/* ---- gloss ------------------------------------------------------------------------------- */

/* A meter's receptor, in and across the plane of incidence. */
typedef struct GlossMeter {
    double geometry_deg, width_deg[2];
} GlossMeter;

static const GlossMeter meters[GLOSS_METERS] = {
    {20, {1.8, 3.6}}, {60, {4.4, 11.7}}, {85, {4.0, 6.0}}};

static double glass(double theta) {
    return fresnel_unpolarised_d(cos_d(theta), GLASS_INDEX);
}

/* In the order of the meters, so that angles rise. */
void specular_table_from_gloss(const Gloss *gloss, const char *file, Arena *arena,
                               SpecularTable *out) {
    double *incidence = ARENA_NEW(arena, double, GLOSS_METERS);
    double *aperture = ARENA_NEW(arena, double, GLOSS_METERS);
    double *value = ARENA_NEW(arena, double, GLOSS_METERS), *nm = ARENA_NEW(arena, double, 1);
    int rows = 0;
    for (int m = 0; m < GLOSS_METERS; m++)
        for (int i = 0; i < gloss->count; i++) {
            if (gloss->reading[i].geometry_deg != meters[m].geometry_deg) continue;
            const double *width = meters[m].width_deg;
            incidence[rows] = radians_from_degrees(meters[m].geometry_deg);
            aperture[rows] = radians_from_degrees(2 * sqrt(width[0] * width[1] / PI));
            value[rows] = gloss->reading[i].gu / 100 * glass(incidence[rows]);
            rows++;
        }
    nm[0] = ANY_NM;
    *out = (SpecularTable){file, true, rows, 1, incidence, aperture, nm, value};
}

bool specular_gloss_add(Gloss *gloss, double geometry_deg, double gu, Error *err) {
    bool is_known = false;
    for (int m = 0; m < GLOSS_METERS; m++) is_known |= meters[m].geometry_deg == geometry_deg;
    if (!is_known)
        return error_set(err, ERROR_INPUT,
                         "a gloss meter's angle is %g degrees, required: "
                         "20, 60 or 85",
                         geometry_deg);
    if (!(gu >= 0 && gu <= GLOSS_MOST))
        return error_set(err, ERROR_INPUT, "gloss is %g, required: 0 to %g gloss units", gu,
                         GLOSS_MOST);
    double mirror = 100 / glass(radians_from_degrees(geometry_deg));
    if (gu > mirror)
        return error_set(err, ERROR_INPUT,
                         "gloss is %g at %g degrees, where a perfect mirror "
                         "has %.4g gloss units",
                         gu, geometry_deg, mirror);
    for (int i = 0; i < gloss->count; i++)
        if (gloss->reading[i].geometry_deg == geometry_deg)
            return error_set(err, ERROR_INPUT,
                             "gloss at %g degrees is stated twice, required: "
                             "it once",
                             geometry_deg);
    gloss->reading[gloss->count++] = (GlossReading){geometry_deg, gu};
    return true;
}

/* ---- a manifest's ------------------------------------------------------------------------ */

#define OWNER GlossReading
static const RecordRow GLOSS[] = {
    NUMBER("geometry_deg", MUST, geometry_deg, 20, 85, "Of the meter: 20, 60 or 85."),
    NUMBER("gu", MUST, gu, 0, GLOSS_MOST, "Gloss units."),
    {0}};
#undef OWNER

const RecordFormat gloss_format = {
    "gloss", sizeof(GlossReading), GLOSS,
    .rules = "{'allOf': [{'properties': {'geometry_deg': {'enum': [20, 60, 85]}}}]}"};

bool specular_gloss_collect(const JsonView *view, const GlossReading *list, int count, Gloss *out,
                            Error *err) {
    *out = (Gloss){0};
    for (int i = 0; i < count; i++) {
        Error why;
        if (!specular_gloss_add(out, list[i].geometry_deg, list[i].gu, &why))
            return record_fails(view, arena_format(view->arena, "gloss/%d", i), err, "%s",
                                why.text);
    }
    return true;
}

#define OWNER SpecularFile
#define FILE_ROW(key, flag) {key, RECORD_PATH, (flag) | RECORD_FILLED, RECORD_AT(OWNER, file)}

static const RecordRow SPECULAR[] = {
    FILE_ROW("file", MUST),
    NUMBER("aperture_deg", 0, aperture_deg, 0, SPECULAR_APERTURE_MOST_DEG,
           "Full angle around the mirror direction that was measured; 0: the mirror alone."),
    {0}};
static const RecordFormat specular_format = {"specular", sizeof(OWNER), SPECULAR, .doc = NULL};

const RecordRow specular_forms[] = {
    FILE_ROW("a table's path", 0),
    {"an object with 'file'", RECORD_OBJECT, .of = &specular_format},
    {0}};
#undef OWNER

/* ---- reading ----------------------------------------------------------------------------- */

/* Place and share between the two values of a rising list around x, held at its ends. */
static int interval(const double *list, int count, double x, double *share) {
    int i = 0;
    while (i + 2 < count && list[i + 1] <= x) i++;
    *share = count < 2 ? 0 : fmin(1, fmax(0, (x - list[i]) / (list[i + 1] - list[i])));
    return i;
}

static double row_at(const SpecularTable *table, int row, double nm) {
    double share;
    int w = interval(table->nm, table->wavelengths, nm, &share);
    const double *value = table->value + row * table->wavelengths + w;
    double low = value[0], high = table->wavelengths > 1 ? value[1] : value[0];
    return (low + share * (high - low)) /
           fresnel_unpolarised_d(cos_d(table->incidence[row]), TABLE_INDEX);
}

double specular_table_at(const SpecularTable *table, double incidence, double nm,
                         double *aperture) {
    double share;
    int i = interval(table->incidence, table->rows, incidence, &share);
    int next = table->rows > 1 ? i + 1 : i;
    double low = row_at(table, i, nm), high = row_at(table, next, nm);
    *aperture = table->aperture[share > 0.5 ? next : i];
    return fmin(1, (low + share * (high - low)) *
                       fresnel_unpolarised_d(cos_d(incidence), TABLE_INDEX));
}

const char *specular_table_text(const SpecularTable *table, Arena *arena) {
    Text text = {.arena = arena};
    text_format(&text, "# from %s\nincidence,wavelength,reflectance\n", path_name(table->file));
    for (int i = 0; i < table->rows; i++)
        for (int w = 0; w < table->wavelengths; w++)
            text_format(&text, "%.9g,%.9g,%.7g\n",
                        round(degrees_from_radians(table->incidence[i]) * 1e9) / 1e9, table->nm[w],
                        table->value[i * table->wavelengths + w]);
    return text.data;
}
