/* SPDX-License-Identifier: Apache-2.0 */
/* Speos' measured scatter (.anisotropicbsdf, .brdf) and its simplest model (.simplescattering).
 *
 * The tables are PROPORTIONAL to the BRDF, or to BRDF times the cosine of the leaving angle;
 * the spectrum gives the directional-hemispherical reflectance R(nm) at the incidence i0 where
 * it was measured, so brdf = value * R / H(i0) with H the integral of value * cos (between two
 * incidences R / H is interpolated; below the first one the first one counts). In a .brdf
 * every table has its own reflectance: brdf = value * R / H. */
#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/number.h"
#include "base/units.h"
#include "import/scatter/scan.h"
#include "import/scatter/scatter.h"
#include "import/scatter/speos_binary.h"
#include "panel/set/measurement.h"

/* ---- the text form ---------------------------------------------------------------------- */

/* The text form of Speos' .anisotropicbsdf and .brdf.
 * The text form of Speos' .anisotropicbsdf and .brdf, version 8 and later, with rows as in
 * the manual of Speos Labs. */

typedef struct SpeosText {
    WordScan scan;
    Arena *arena;
    Speos *out;
} SpeosText;

/* ---- small parts ------------------------------------------------------------------------- */

static bool read_flag(SpeosText *in, const char *what, bool *out, Error *err) {
    double value;
    if (!scan_number(&in->scan, what, &value, err)) return false;
    if (value != 0 && value != 1)
        return scan_fail(&in->scan, err, "%s is %g, required: 0 or 1", what, value);
    *out = value == 1;
    return true;
}

/* A length in characters, then a text of that length, which may have lines of its own. */
static bool skip_description(SpeosText *in, Error *err) {
    double length;
    WordScan *scan = &in->scan;
    if (!scan_number(scan, "the length of the description", &length, err)) return false;
    scan_line(scan);
    if (!(length >= 0 && length <= (double)(scan->end - scan->next)))
        return scan_fail(scan, err,
                         "the length of the description is %g, more than the rest "
                         "of the file",
                         length);
    for (const char *stop = scan->next + (size_t)length; scan->next < stop; scan->next++)
        scan->line += *scan->next == '\n';
    scan_line(scan);
    return true;
}

static bool read_table(SpeosText *in, SpeosTable *table, Error *err) {
    WordScan *scan = &in->scan;
    if (!scan_count(scan, "the number of thetas", SPEOS_ANGLES_MAX, &table->thetas, err) ||
        !scan_count(scan, "the number of phis", SPEOS_ANGLES_MAX, &table->phis, err))
        return false;
    size_t size = (size_t)table->thetas * (size_t)table->phis;
    if (size / 2 > (size_t)(scan->end - scan->next))
        return scan_fail(scan, err,
                         "a table of %d thetas x %d phis is more than the rest of "
                         "the file can hold",
                         table->thetas, table->phis);
    if (!scan_list(scan, "phi", table->phis, &table->phi_deg, err)) return false;
    double *rows = ARENA_NEW(in->arena, double, size);
    table->theta_deg = ARENA_NEW(in->arena, double, table->thetas);
    for (int i = 0; i < table->thetas; i++) {
        if (!scan_number(scan, "theta", &table->theta_deg[i], err)) return false;
        for (int j = 0; j < table->phis; j++)
            if (!scan_number(scan, "a value of the table", &rows[i * table->phis + j], err))
                return false;
    }
    return speos_table_fill(scan->file, table, rows, in->arena, err);
}

/* The rest of the file is transmission, which is not read, or nothing. */
static bool check_end(const SpeosText *in, Error *err) {
    const WordScan *scan = &in->scan;
    const char *word = scan_peek(scan);
    if (!scan_check_end(scan, err)) return false;
    if (word && strcmp(word, "End") && !in->out->has_transmission)
        return scan_fail(scan, err, "'%.40s' follows the last table", word);
    return true;
}

static bool read_kind(SpeosText *in, Error *err) {
    Speos *out = in->out;
    if (!read_flag(in, "the flag of reflection", &out->has_reflection, err) ||
        !read_flag(in, "the flag of transmission", &out->has_transmission, err) ||
        !read_flag(in, "the kind of value", &out->is_bsdf, err))
        return false;
    return out->has_reflection || scan_fail(&in->scan, err,
                                            "there is transmission only: a "
                                            "display panel is opaque");
}

/* ---- .anisotropicbsdf -------------------------------------------------------------------- */

static bool add_lights(SpeosText *in, double anisotropy_deg, Error *err) {
    int count;
    double *incidence;
    Speos *out = in->out;
    if (!scan_counted_list(&in->scan, "the number of incidences", SPEOS_ANGLES_MAX, &count,
                           &incidence, err))
        return false;
    if (out->tables + count > SPEOS_TABLES_MAX)
        return scan_fail(&in->scan, err, "there are more than %d tables", SPEOS_TABLES_MAX);
    for (int i = 0; i < count; i++)
        out->table[out->tables++] =
            (SpeosTable){.anisotropy_deg = anisotropy_deg, .incidence_deg = incidence[i]};
    return true;
}

/* Anisotropy angles, and for each its incidences. */
static bool read_lights(SpeosText *in, bool is_kept, Error *err) {
    int count, tables = in->out->tables;
    double *anisotropy;
    if (!scan_counted_list(&in->scan, "the number of anisotropy angles", SPEOS_ANGLES_MAX, &count,
                           &anisotropy, err))
        return false;
    for (int i = 0; i < count; i++)
        if (!add_lights(in, anisotropy[i], err)) return false;
    if (!is_kept) in->out->tables = tables;
    return true;
}

static bool read_spectrum(SpeosText *in, Error *err) {
    Speos *out = in->out;
    WordScan *scan = &in->scan;
    if (!scan_number(scan, "the spectrum's theta", &out->spectrum_theta_deg, err) ||
        !scan_number(scan, "the spectrum's phi", &out->spectrum_phi_deg, err))
        return false;
    scan_line(scan);
    scan_line(scan); /* its description */
    if (!scan_count(scan, "the number of wavelengths", SPEOS_ANGLES_MAX, &out->spectrum_count, err))
        return false;
    out->spectrum_nm = ARENA_NEW(in->arena, double, out->spectrum_count);
    out->spectrum_percent = ARENA_NEW(in->arena, double, out->spectrum_count);
    for (int i = 0; i < out->spectrum_count; i++)
        if (!scan_number(scan, "a wavelength", &out->spectrum_nm[i], err) ||
            !scan_number(scan, "a coefficient of the spectrum", &out->spectrum_percent[i], err))
            return false;
    return true;
}

static bool read_anisotropic(SpeosText *in, Error *err) {
    Speos *out = in->out;
    double vector;
    Speos ignored = {.file = out->file};
    for (int i = 0; i < 3; i++)
        if (!scan_number(&in->scan, "the anisotropy vector", &vector, err)) return false;
    if (!read_kind(in, err) || !read_lights(in, true, err)) return false;
    if (out->has_transmission && !read_lights(in, false, err)) return false;
    if (!read_spectrum(in, err)) return false;
    if (out->has_transmission) {
        in->out = &ignored;
        bool ok = read_spectrum(in, err);
        in->out = out;
        if (!ok) return false;
    }
    for (int i = 0; i < out->tables; i++)
        if (!read_table(in, &out->table[i], err)) return false;
    return true;
}

/* ---- .brdf ------------------------------------------------------------------------------- */

static bool read_brdf(SpeosText *in, Error *err) {
    int incidences, wavelengths;
    double *incidence, *nm;
    Speos *out = in->out;
    WordScan *scan = &in->scan;
    if (!read_kind(in, err) ||
        !scan_count(scan, "the number of incidences", SPEOS_ANGLES_MAX, &incidences, err) ||
        !scan_count(scan, "the number of wavelengths", SPEOS_ANGLES_MAX, &wavelengths, err))
        return false;
    if (incidences > SPEOS_TABLES_MAX / wavelengths)
        return scan_fail(scan, err, "there are more than %d tables", SPEOS_TABLES_MAX);
    if (!scan_list(scan, "an incidence", incidences, &incidence, err) ||
        !scan_list(scan, "a wavelength", wavelengths, &nm, err))
        return false;
    out->tables = incidences * wavelengths;
    for (int i = 0; i < out->tables; i++) {
        SpeosTable *table = &out->table[i];
        table->incidence_deg = incidence[i / wavelengths];
        table->nm = nm[i % wavelengths];
        if (!scan_number(scan, "the table's reflectance", &table->percent, err) ||
            !read_table(in, table, err))
            return false;
    }
    return true;
}

static bool speos_text_read(const char *file, Arena *arena, Speos *out, Error *err) {
    SpeosText in = {.arena = arena, .out = out};
    *out = (Speos){.file = file, .table = ARENA_NEW(arena, SpeosTable, SPEOS_TABLES_MAX)};
    if (!scan_open(file, arena, &in.scan, err)) return false;
    in.scan.comment = 0;
    const char *title = scan_line(&in.scan);
    const char *version = title ? strrchr(title, 'v') : NULL;
    double number;
    if (!version || !number_is(version + 1, &number) || number < 8)
        return scan_fail(&in.scan, err, "the version is '%.20s', required: v8.0 or later",
                         version ? version : "");
    out->is_spectral = !strstr(title, "Anisotropic");
    bool is_binary;
    if (!read_flag(&in, "the mode", &is_binary, err)) return false;
    scan_line(&in.scan);
    scan_line(&in.scan); /* the comment */
    if (!skip_description(&in, err)) return false;
    bool ok = out->is_spectral ? read_brdf(&in, err) : read_anisotropic(&in, err);
    return ok && check_end(&in, err);
}

/* Nearer to the horizon a value cannot be divided by its cosine. */
#define GRAZING_DEG 89.95
/* The panel's wavelengths. */
#define FIRST_NM 360.0
#define LAST_NM 830.0

/* The table's integral of value * cos. */
static double table_integral(const SpeosTable *table, Arena scratch) {
    ScatterGrid grid = {
        table->thetas, table->phis, table->theta_deg, table->phi_deg, table->value, 0, false};
    return scatter_grid_integral(&grid, scratch);
}

/* ---- scale ------------------------------------------------------------------------------- */

/* Divides the cosine out. At the horizon the value of the last theta before it is repeated: it
 * only closes the integral, and is not imported. */
static void divide_cosine(SpeosTable *table) {
    for (int j = 0; j < table->phis; j++) {
        double *value = table->value + (size_t)j * (size_t)table->thetas;
        for (int i = 0; i < table->thetas; i++) {
            if (table->theta_deg[i] <= GRAZING_DEG)
                value[i] /= cos_d(radians_from_degrees(table->theta_deg[i]));
            else value[i] = i ? value[i - 1] : 0;
        }
    }
}

/* The two tables of the anisotropy angle nearest to the spectrum's, whose incidences enclose
 * its theta; the same twice outside them. */
static void find_reference(const Speos *in, const SpeosTable *out[2]) {
    double nearest = 1e9;
    for (int i = 0; i < in->tables; i++)
        nearest = fmin(nearest, fabs(in->table[i].anisotropy_deg - in->spectrum_phi_deg));
    out[0] = out[1] = NULL;
    for (int i = 0; i < in->tables; i++) {
        const SpeosTable *table = &in->table[i];
        double lean = table->incidence_deg, wanted = in->spectrum_theta_deg;
        if (fabs(table->anisotropy_deg - in->spectrum_phi_deg) > nearest + 1e-9) continue;
        if (lean <= wanted && (!out[0] || lean > out[0]->incidence_deg)) out[0] = table;
        if (lean >= wanted && (!out[1] || lean < out[1]->incidence_deg)) out[1] = table;
    }
    if (!out[0]) out[0] = out[1];
    if (!out[1]) out[1] = out[0];
}

/* The factor from value times reflectance to BRDF: 1 / H, interpolated between incidences. */
static bool find_scale(const Speos *in, Arena scratch, double *scale, Error *err) {
    const SpeosTable *table[2];
    find_reference(in, table);
    double low = table_integral(table[0], scratch);
    double high = table_integral(table[1], scratch);
    if (!(low > 0 && high > 0))
        return error_at(err, ERROR_INPUT, in->file, "",
                        "the table at incidence %g integrates "
                        "to %g, required: above 0",
                        table[0]->incidence_deg, low > 0 ? high : low);
    double span = table[1]->incidence_deg - table[0]->incidence_deg;
    double u = span > 0 ? (in->spectrum_theta_deg - table[0]->incidence_deg) / span : 0;
    *scale = (1 - u) / low + u / high;
    return true;
}

/* ---- the spectrum ------------------------------------------------------------------------ */

static double percent_at(const Speos *in, double nm) {
    int last = in->spectrum_count - 1;
    if (nm <= in->spectrum_nm[0]) return in->spectrum_percent[0];
    for (int i = 1; i <= last; i++) {
        double low = in->spectrum_nm[i - 1], high = in->spectrum_nm[i];
        if (nm > high) continue;
        double u = (nm - low) / (high - low);
        return (1 - u) * in->spectrum_percent[i - 1] + u * in->spectrum_percent[i];
    }
    return in->spectrum_percent[last];
}

/* The file's wavelengths that a panel has, and its ends where the file goes beyond them. */
static int choose_bands(const Speos *in, ImportSet *set, float *nm) {
    int count = 0, last = in->spectrum_count - 1;
    double first_nm = in->spectrum_nm[0], last_nm = in->spectrum_nm[last];
    bool before = first_nm < FIRST_NM && last_nm >= FIRST_NM;
    bool after = last_nm > LAST_NM && first_nm <= LAST_NM;
    if (before) nm[count++] = (float)FIRST_NM;
    for (int i = 0; i <= last && count < MEASUREMENT_WAVELENGTHS_MAX - 1; i++) {
        double one = in->spectrum_nm[i];
        if (one >= FIRST_NM && one <= LAST_NM && !(before && one == FIRST_NM) &&
            !(after && one == LAST_NM))
            nm[count++] = (float)one;
    }
    if (after) nm[count++] = (float)LAST_NM;
    if (before || after)
        import_note(set,
                    "%s: the spectrum goes from %g to %g nm; it is cut (by straight "
                    "lines) to %g to %g nm",
                    path_name(in->file), first_nm, last_nm, FIRST_NM, LAST_NM);
    return count;
}

static bool check_spectrum(const Speos *in, Error *err) {
    for (int i = 0; i < in->spectrum_count; i++) {
        double nm = in->spectrum_nm[i], percent = in->spectrum_percent[i];
        if (!(nm > 0) || (i && !(nm > in->spectrum_nm[i - 1])))
            return error_at(err, ERROR_INPUT, in->file, "",
                            "the spectrum has %g nm, required: "
                            "rising wavelengths",
                            nm);
        if (!(percent >= 0))
            return error_at(err, ERROR_INPUT, in->file, "",
                            "the spectrum is %g%% at %g nm, "
                            "required: 0 or more",
                            percent, nm);
    }
    return true;
}

/* ---- tables ------------------------------------------------------------------------------ */

typedef struct SpeosBands {
    int count;
    const float *nm;
    double factor[MEASUREMENT_WAVELENGTHS_MAX]; /* of the values */
} SpeosBands;

static void put_rows(const Speos *in, const SpeosTable *table, const double *factor,
                     ImportRows *rows) {
    double value[MEASUREMENT_WAVELENGTHS_MAX];
    for (int i = 0; i < table->thetas; i++)
        for (int j = 0; j < table->phis; j++) {
            bool is_again = table->phi_deg[j] == 360 && table->phi_deg[0] == 0;
            if (is_again || (!in->is_bsdf && table->theta_deg[i] > GRAZING_DEG)) continue;
            for (int c = 0; c < rows->channels; c++)
                value[c] = table->value[j * table->thetas + i] * factor[c];
            scatter_put_measured(rows, table->theta_deg[i], table->phi_deg[j], value);
        }
}

static bool add_table(const Speos *in, const SpeosTable *table, const SpeosBands *bands,
                      ImportSet *set, Error *err) {
    ImportRows rows = scatter_rows(set->arena, table->thetas * table->phis, bands->count);
    put_rows(in, table, bands->factor, &rows);
    /* The mirror direction lies `anisotropy` before the vector, which is at phi 0. */
    ScatterLight light = {table->incidence_deg, 180 - table->anisotropy_deg};
    return scatter_add(set, in->file, &rows, light, bands->nm, err);
}

static bool add_scaled(const Speos *in, ImportSet *set, Error *err) {
    float *nm = ARENA_NEW(set->arena, float, MEASUREMENT_WAVELENGTHS_MAX);
    SpeosBands bands = {.nm = nm};
    double scale = 0;
    if (!check_spectrum(in, err) || !find_scale(in, *set->arena, &scale, err)) return false;
    bands.count = choose_bands(in, set, nm);
    if (!bands.count)
        return error_at(err, ERROR_INPUT, in->file, "",
                        "the spectrum goes from %g to %g nm, "
                        "required: some of %g to %g nm",
                        in->spectrum_nm[0], in->spectrum_nm[in->spectrum_count - 1], FIRST_NM,
                        LAST_NM);
    for (int c = 0; c < bands.count; c++)
        bands.factor[c] = percent_at(in, (double)nm[c]) / 100 * scale;
    for (int i = 0; i < in->tables; i++) {
        const SpeosTable *table = &in->table[i];
        bool is_again = table->anisotropy_deg == 360 && in->table[0].anisotropy_deg == 0;
        if (table->incidence_deg >= 90 || is_again) continue;
        if (!add_table(in, table, &bands, set, err)) return false;
    }
    import_note(set,
                "%s: relative values scaled to %g%% directional-hemispherical reflectance "
                "at incidence %g and %g nm, as the file states",
                path_name(in->file), percent_at(in, (double)nm[0]), in->spectrum_theta_deg,
                (double)nm[0]);
    return true;
}

static bool add_spectral(const Speos *in, ImportSet *set, Error *err) {
    TotalsNote totals = {{0}, 0};
    for (int i = 0; i < in->tables; i++) {
        const SpeosTable *table = &in->table[i];
        double total = table_integral(table, *set->arena);
        if (!(total > 0))
            return error_at(err, ERROR_INPUT, in->file, "",
                            "the table at incidence %g and %g "
                            "nm integrates to %g, required: above 0",
                            table->incidence_deg, table->nm, total);
        SpeosBands bands = {1, scatter_band(table->nm, set), {table->percent / 100 / total}};
        totals_add(&totals, table->incidence_deg, table->percent / 100, total);
        if (!add_table(in, table, &bands, set, err)) return false;
    }
    import_note(set, "%s: every table is scaled to the reflectance that the file states",
                path_name(in->file));
    totals_report(&totals, in->file, set);
    return true;
}

/* Compares the quarters around phi 0 and around phi 180, beyond 20 degrees. */
static void warn_of_brighter_back(const Speos *in, ImportSet *set) {
    double front = 0, back = 0;
    for (int t = 0; t < in->tables; t++) {
        const SpeosTable *table = &in->table[t];
        for (int j = 0; j < table->phis; j++)
            for (int i = 0; i < table->thetas; i++) {
                double across = cos_d(radians_from_degrees(table->phi_deg[j]));
                if (table->incidence_deg < 20 || table->theta_deg[i] < 20) continue;
                if (across > 0.7071) front += table->value[j * table->thetas + i];
                if (across < -0.7071) back += table->value[j * table->thetas + i];
            }
    }
    if (back > 1.2 * front)
        import_note(set,
                    "%s: brighter towards the light (phi 180) than towards the mirror "
                    "direction (phi 0): a retroreflector, or a file that counts phi from the "
                    "light",
                    path_name(in->file));
}

/* ---- .simplescattering ------------------------------------------------------------------- */

/* Four numbers of which the second is the Lambertian share in percent; the order of the others
 * is not public, so they must leave nothing beside it. */
static bool read_simple(const char *file, ImportSet *set, Error *err) {
    WordScan scan;
    double number[4];
    if (!scan_open(file, set->arena, &scan, err)) return false;
    scan_line(&scan);
    scan_line(&scan); /* title and comment */
    if (!scan_accept(&scan, "Reflection"))
        return scan_fail(&scan, err, "the surface's kind is '%.40s', required: Reflection",
                         scan_peek(&scan) ? scan_peek(&scan) : "");
    for (int i = 0; i < 4; i++)
        if (!scan_number(&scan, "a share in percent", &number[i], err)) return false;
    if (number[0] != 0 || number[2] != 0 || !(number[1] > 0 && number[1] <= 100))
        return scan_fail(&scan, err,
                         "the shares are %g, %g and %g%%; only a Lambertian "
                         "surface (0, above 0, 0) is known here",
                         number[0], number[1], number[2]);
    double brdf = number[1] / 100 / PI;
    const float *nm = scatter_band((double)PHOTOPIC_NM, set);
    for (int lean = 0; lean <= 80; lean += 20) {
        ImportRows rows = scatter_rows(set->arena, 19 * 24, 1);
        scatter_put(&rows, 0, 0, &brdf);
        for (int i = 1; i < 19; i++)
            for (int j = 0; j < 24; j++) scatter_put(&rows, i * 5, j * 15, &brdf);
        if (!scatter_add(set, file, &rows, (ScatterLight){lean, 180}, nm, err)) return false;
    }
    import_note(set,
                "%s: a Lambertian surface of %g%%, the same at every wavelength (one band "
                "at %g nm), on a grid of theta 5 x phi 15 degrees at incidences 0 to 80",
                path_name(file), number[1], (double)*nm);
    return true;
}

/* ---- which form -------------------------------------------------------------------------- */

static bool read_speos(const char *file, const ImportOptions *options, ImportSet *set, Error *err) {
    (void)options;
    WordScan scan;
    Speos in;
    Arena scratch = *set->arena;
    if (!scan_open(file, &scratch, &scan, err)) return false;
    const char *title = scan_line(&scan);
    if (!title || strncmp(title, "OPTIS - ", 8))
        return scan_fail(&scan, err, "the first line is '%.40s', required: OPTIS - ...",
                         title ? title : "");
    if (strstr(title, "Simple scattering")) return read_simple(file, set, err);
    bool is_binary = scan.next < scan.end && *scan.next == '1';
    bool ok = is_binary ? speos_binary_read(file, set->arena, &in, err)
                        : speos_text_read(file, set->arena, &in, err);
    if (!ok) return false;
    for (int i = 0; !in.is_bsdf && i < in.tables; i++) divide_cosine(&in.table[i]);
    if (in.has_transmission) import_note(set, "%s: transmission is left out", path_name(file));
    warn_of_brighter_back(&in, set);
    return in.is_spectral ? add_spectral(&in, set, err) : add_scaled(&in, set, err);
}

static bool is_speos(const char *file, const char *head, size_t head_size) {
    (void)file;
    return head_size > 8 && !memcmp(head, "OPTIS - ", 8) && strstr(head, "surface file");
}

const Importer importer_speos = {"speos", "Speos .anisotropicbsdf, .brdf, .simplescattering",
                                 is_speos, read_speos};
