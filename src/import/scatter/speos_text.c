/* SPDX-License-Identifier: Apache-2.0 */
/* The text form of Speos' .anisotropicbsdf and .brdf, version 8 and later, with rows as in
 * the manual of Speos Labs. */
#include "import/scatter/speos_text.h"

#include <string.h>

#include "import/scatter/scan.h"

typedef struct SpeosText {
    WordScan scan;
    Arena *arena;
    Speos *out;
} SpeosText;

/* ---- small parts ------------------------------------------------------------------------- */

static bool read_flag(SpeosText *in, const char *what, bool *out, Error *err)
{
    double value;
    if (!scan_number(&in->scan, what, &value, err)) return false;
    if (value != 0 && value != 1)
        return scan_fail(&in->scan, err, "%s is %g, required: 0 or 1", what, value);
    *out = value == 1;
    return true;
}

/* A length in characters, then a text of that length, which may have lines of its own. */
static bool skip_description(SpeosText *in, Error *err)
{
    double length;
    WordScan  *scan = &in->scan;
    if (!scan_number(scan, "the length of the description", &length, err)) return false;
    scan_line(scan);
    if (!(length >= 0 && length <= (double)(scan->end - scan->next)))
        return scan_fail(scan, err, "the length of the description is %g, more than the rest "
                         "of the file", length);
    for (const char *stop = scan->next + (size_t)length; scan->next < stop; scan->next++)
        scan->line += *scan->next == '\n';
    scan_line(scan);
    return true;
}

static bool read_table(SpeosText *in, SpeosTable *table, Error *err)
{
    WordScan *scan = &in->scan;
    if (!scan_count(scan, "the number of thetas", SPEOS_ANGLES_MAX, &table->thetas, err) ||
        !scan_count(scan, "the number of phis", SPEOS_ANGLES_MAX, &table->phis, err))
        return false;
    size_t size = (size_t)table->thetas * (size_t)table->phis;
    if (size / 2 > (size_t)(scan->end - scan->next))
        return scan_fail(scan, err, "a table of %d thetas x %d phis is more than the rest of "
                         "the file can hold", table->thetas, table->phis);
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
static bool check_end(const SpeosText *in, Error *err)
{
    const WordScan *scan = &in->scan;
    const char *word = scan_peek(scan);
    if (!scan_check_end(scan, err)) return false;
    if (word && strcmp(word, "End") && !in->out->has_transmission)
        return scan_fail(scan, err, "'%.40s' follows the last table", word);
    return true;
}

static bool read_kind(SpeosText *in, Error *err)
{
    Speos *out = in->out;
    if (!read_flag(in, "the flag of reflection", &out->has_reflection, err) ||
        !read_flag(in, "the flag of transmission", &out->has_transmission, err) ||
        !read_flag(in, "the kind of value", &out->is_bsdf, err))
        return false;
    return out->has_reflection || scan_fail(&in->scan, err, "there is transmission only: a "
                                            "display panel is opaque");
}

/* ---- .anisotropicbsdf -------------------------------------------------------------------- */

static bool add_lights(SpeosText *in, double anisotropy_deg, Error *err)
{
    int     count;
    double *incidence;
    Speos  *out = in->out;
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
static bool read_lights(SpeosText *in, bool is_kept, Error *err)
{
    int     count, tables = in->out->tables;
    double *anisotropy;
    if (!scan_counted_list(&in->scan, "the number of anisotropy angles", SPEOS_ANGLES_MAX,
                           &count, &anisotropy, err))
        return false;
    for (int i = 0; i < count; i++)
        if (!add_lights(in, anisotropy[i], err)) return false;
    if (!is_kept) in->out->tables = tables;
    return true;
}

static bool read_spectrum(SpeosText *in, Error *err)
{
    Speos *out = in->out;
    WordScan  *scan = &in->scan;
    if (!scan_number(scan, "the spectrum's theta", &out->spectrum_theta_deg, err) ||
        !scan_number(scan, "the spectrum's phi", &out->spectrum_phi_deg, err))
        return false;
    scan_line(scan);
    scan_line(scan); /* its description */
    if (!scan_count(scan, "the number of wavelengths", SPEOS_ANGLES_MAX, &out->spectrum_count,
                    err))
        return false;
    out->spectrum_nm = ARENA_NEW(in->arena, double, out->spectrum_count);
    out->spectrum_percent = ARENA_NEW(in->arena, double, out->spectrum_count);
    for (int i = 0; i < out->spectrum_count; i++)
        if (!scan_number(scan, "a wavelength", &out->spectrum_nm[i], err) ||
            !scan_number(scan, "a coefficient of the spectrum", &out->spectrum_percent[i], err))
            return false;
    return true;
}

static bool read_anisotropic(SpeosText *in, Error *err)
{
    Speos  *out = in->out;
    double  vector;
    Speos   ignored = {.file = out->file};
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

static bool read_brdf(SpeosText *in, Error *err)
{
    int     incidences, wavelengths;
    double *incidence, *nm;
    Speos  *out = in->out;
    WordScan   *scan = &in->scan;
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

bool speos_text_read(const char *file, Arena *arena, Speos *out, Error *err)
{
    SpeosText in = {.arena = arena, .out = out};
    *out = (Speos){.file = file, .table = ARENA_NEW(arena, SpeosTable, SPEOS_TABLES_MAX)};
    if (!scan_open(file, arena, &in.scan, err)) return false;
    in.scan.comment = 0;
    const char *title = scan_line(&in.scan);
    const char *version = title ? strrchr(title, 'v') : NULL;
    double      number;
    if (!version || !scan_to_number(version + 1, &number) || number < 8)
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
