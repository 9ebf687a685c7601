/* SPDX-License-Identifier: Apache-2.0 */
/* The binary form of .anisotropicbsdf, version 9.0: a line of text, then packed fields, and
 * arrays of doubles as LZ4 blocks. No description of it is public; the layout here was read off
 * one public file (reflection, one anisotropy angle), whose angles, spectrum and values then
 * fall into place. Fields of unknown meaning must be as they are there.
 *
 *   '1', i32 3, i32 1, u8 0, f64 x 3 the anisotropy vector, text comment, text description,
 *   u8 reflection, u8 transmission, f64 1, f64 1, u8 is BSDF, u8 0
 *   list of anisotropy angles; for each: list of incidences            (list: u32 n, block)
 *   f64 theta, f64 phi, text, u32 n, n x f64 nm, n x f64 percent        (the spectrum)
 *   for each light: u32 thetas, u32 phis, block thetas, block phis, block values
 *   for each light 4 x f64 (settings of an interpolation), u8, f64
 *   block: u64 bytes, u32 bytes, u32 packed bytes, packed bytes;  text: u32 length, bytes */
#include "import/scatter/speos_binary.h"

#include <lz4.h>
#include <math.h>
#include <string.h>

#include "import/scatter/byte_scan.h"
#include "import/scatter/scatter.h"

/* ---- a table ---------------------------------------------------------------------------- */

bool speos_table_fill(const char *file, SpeosTable *table, const double *rows, Arena *arena,
                      Error *err) {
    const double theta[] = {0, 90}, phi[] = {0, 360};
    table->value = ARENA_NEW(arena, double, (size_t)table->thetas *(size_t)table->phis);
    for (int i = 0; i < table->thetas; i++)
        for (int j = 0; j < table->phis; j++)
            table->value[j * table->thetas + i] = rows[i * table->phis + j];
    return angles_check(file, "theta", table->theta_deg, table->thetas, theta, err) &&
           angles_check(file, "phi", table->phi_deg, table->phis, phi, err);
}

#define SETTINGS_PER_LIGHT 4

typedef struct SpeosBinary {
    ByteScan scan;
    Arena *arena;
    Speos *out;
} SpeosBinary;

/* ---- small parts ------------------------------------------------------------------------- */

static bool cut(const SpeosBinary *in, Error *err, const char *what) {
    return byte_scan_fail(&in->scan, err, "the file ends inside %s", what);
}

static bool read_uint(SpeosBinary *in, size_t bytes, const char *what, uint64_t *out, Error *err) {
    return byte_scan_uint(&in->scan, bytes, out) || cut(in, err, what);
}

static bool expect(SpeosBinary *in, size_t bytes, unsigned wanted, Error *err) {
    uint64_t found;
    if (!read_uint(in, bytes, "its header", &found, err)) return false;
    return found == wanted || byte_scan_fail(&in->scan, err,
                                             "a field of the header is %u, and only %u is known "
                                             "here — save the file as text",
                                             (unsigned)found, wanted);
}

static bool read_flag(SpeosBinary *in, bool *out, Error *err) {
    uint64_t found;
    if (!read_uint(in, 1, "its header", &found, err)) return false;
    *out = found == 1;
    return found <= 1 ||
           byte_scan_fail(&in->scan, err, "a flag is %d, required: 0 or 1", (int)found);
}

static bool read_double(SpeosBinary *in, const char *what, double *out, Error *err) {
    if (!byte_scan_double(&in->scan, out)) return cut(in, err, what);
    return isfinite(*out) || byte_scan_fail(&in->scan, err, "%s is not a finite number", what);
}

static bool skip_text(SpeosBinary *in, Error *err) {
    uint64_t length;
    return (byte_scan_uint(&in->scan, 4, &length) && byte_scan_take(&in->scan, (size_t)length)) ||
           cut(in, err, "a text");
}

/* `count` doubles, packed. What the block yields is bounded by what LZ4 can (255 a byte). */
static bool read_block(SpeosBinary *in, size_t count, double **out, Error *err) {
    uint64_t bytes, again, packed;
    const unsigned char *block;
    if (!byte_scan_uint(&in->scan, 8, &bytes) || !byte_scan_uint(&in->scan, 4, &again) ||
        !byte_scan_uint(&in->scan, 4, &packed) ||
        !(block = byte_scan_take(&in->scan, (size_t)packed)))
        return cut(in, err, "a block of numbers");
    if (bytes != count * sizeof(double) || again != bytes)
        return byte_scan_fail(&in->scan, err, "a block has %llu bytes, required: %zu",
                              (unsigned long long)bytes, count * sizeof(double));
    if (bytes / 255 > packed)
        return byte_scan_fail(&in->scan, err, "a block of %u bytes cannot hold %llu",
                              (unsigned)packed, (unsigned long long)bytes);
    unsigned char *raw = ARENA_NEW(in->arena, unsigned char, bytes);
    /* No file is larger than an int: IMPORT_FILE_BYTES_MAX, and 8 SPEOS_ANGLES_MAX^2. */
    if (LZ4_decompress_safe((const char *)block, (char *)raw, (int)packed, (int)bytes) !=
        (int)bytes)
        return byte_scan_fail(&in->scan, err, "a packed block is not sound");
    *out = ARENA_NEW(in->arena, double, count);
    for (size_t i = 0; i < count; i++) {
        (*out)[i] = double_from_bytes(raw + i * sizeof(double));
        if (!isfinite((*out)[i]))
            return byte_scan_fail(&in->scan, err, "a number in the block is not finite");
    }
    return true;
}

static bool read_count(SpeosBinary *in, const char *what, int *out, Error *err) {
    uint64_t count;
    if (!read_uint(in, 4, what, &count, err)) return false;
    if (count < 1 || count > SPEOS_ANGLES_MAX)
        return byte_scan_fail(&in->scan, err,
                              "%s is %u, required: 1 to "
                              "%d",
                              what, (unsigned)count, SPEOS_ANGLES_MAX);
    *out = (int)count;
    return true;
}

/* ---- parts of the file ------------------------------------------------------------------- */

static bool read_header(SpeosBinary *in, Error *err) {
    static const char title[] = "OPTIS - Anisotropic BSDF surface file v9.0\n1";
    Speos *out = in->out;
    double value;
    const unsigned char *start = byte_scan_take(&in->scan, sizeof title - 1);
    if (!start || memcmp(start, title, sizeof title - 1))
        return error_at(err, ERROR_INPUT, out->file, "",
                        "is binary and not of version 9.0, "
                        "the only one that is known here — save the file as text");
    if (!expect(in, 4, 3, err) || !expect(in, 4, 1, err) || !expect(in, 1, 0, err)) return false;
    for (int i = 0; i < 3; i++)
        if (!read_double(in, "the anisotropy vector", &value, err)) return false;
    if (!skip_text(in, err) || !skip_text(in, err) || !read_flag(in, &out->has_reflection, err) ||
        !read_flag(in, &out->has_transmission, err))
        return false;
    if (out->has_transmission)
        return byte_scan_fail(&in->scan, err,
                              "the file has transmission, whose binary layout "
                              "is not known here — save the file as text");
    if (!out->has_reflection) return byte_scan_fail(&in->scan, err, "there is no reflection");
    for (int i = 0; i < 2; i++) {
        if (!read_double(in, "the header", &value, err)) return false;
        if (value != 1)
            return byte_scan_fail(&in->scan, err,
                                  "a field of the header is %g, and only 1 is "
                                  "known here — save the file as text",
                                  value);
    }
    return read_flag(in, &out->is_bsdf, err) && expect(in, 1, 0, err);
}

static bool read_lights(SpeosBinary *in, Error *err) {
    int angles, count;
    double *angle, *incidence;
    Speos *out = in->out;
    if (!read_count(in, "the number of anisotropy angles", &angles, err) ||
        !read_block(in, (size_t)angles, &angle, err))
        return false;
    for (int i = 0; i < angles; i++) {
        if (!read_count(in, "the number of incidences", &count, err) ||
            !read_block(in, (size_t)count, &incidence, err))
            return false;
        if (out->tables + count > SPEOS_TABLES_MAX)
            return byte_scan_fail(&in->scan, err, "there are more than %d tables",
                                  SPEOS_TABLES_MAX);
        for (int j = 0; j < count; j++)
            out->table[out->tables++] =
                (SpeosTable){.anisotropy_deg = angle[i], .incidence_deg = incidence[j]};
    }
    return true;
}

static bool read_spectrum(SpeosBinary *in, Error *err) {
    Speos *out = in->out;
    if (!read_double(in, "the spectrum's theta", &out->spectrum_theta_deg, err) ||
        !read_double(in, "the spectrum's phi", &out->spectrum_phi_deg, err) ||
        !skip_text(in, err) ||
        !read_count(in, "the number of wavelengths", &out->spectrum_count, err))
        return false;
    out->spectrum_nm = ARENA_NEW(in->arena, double, out->spectrum_count);
    out->spectrum_percent = ARENA_NEW(in->arena, double, out->spectrum_count);
    for (int i = 0; i < out->spectrum_count; i++)
        if (!read_double(in, "the spectrum's wavelengths", &out->spectrum_nm[i], err)) return false;
    for (int i = 0; i < out->spectrum_count; i++)
        if (!read_double(in, "the spectrum's coefficients", &out->spectrum_percent[i], err))
            return false;
    return true;
}

static bool read_table(SpeosBinary *in, SpeosTable *table, Error *err) {
    double *rows;
    if (!read_count(in, "the number of thetas", &table->thetas, err) ||
        !read_count(in, "the number of phis", &table->phis, err) ||
        !read_block(in, (size_t)table->thetas, &table->theta_deg, err) ||
        !read_block(in, (size_t)table->phis, &table->phi_deg, err) ||
        !read_block(in, (size_t)table->thetas * (size_t)table->phis, &rows, err))
        return false;
    return speos_table_fill(in->out->file, table, rows, in->arena, err);
}

bool speos_binary_read(const char *file, Arena *arena, Speos *out, Error *err) {
    SpeosBinary in = {.arena = arena, .out = out};
    *out = (Speos){.file = file, .table = ARENA_NEW(arena, SpeosTable, SPEOS_TABLES_MAX)};
    if (!byte_scan_open(file, arena, &in.scan, err) || !read_header(&in, err) ||
        !read_lights(&in, err) || !read_spectrum(&in, err))
        return false;
    for (int i = 0; i < out->tables; i++)
        if (!read_table(&in, &out->table[i], err)) return false;
    size_t settings = (size_t)out->tables * SETTINGS_PER_LIGHT;
    size_t tail = (settings + 1) * sizeof(double) + 1;
    size_t left = in.scan.size - in.scan.at;
    return left == tail || byte_scan_fail(&in.scan, err,
                                          "%zu bytes follow the tables, "
                                          "required: %zu",
                                          left, tail);
}
