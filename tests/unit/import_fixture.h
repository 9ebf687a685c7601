/* SPDX-License-Identifier: Apache-2.0 */
/* import_fixture.h -- for tests of importers of scatter: a foreign file in a temporary folder,
 * read by one importer; rows looked up by direction. */
#pragma once
#include <sys/stat.h>

#include "fixture.h"
#include "import/set/import.h"
#include "import/importers.h"

typedef struct Fixture {
    Arena arena;
    char folder[FOLDER_BYTES];
    char file[FOLDER_BYTES + 32];
    ImportOptions options;
    ImportSet set;
    Error err;
} Fixture;

static inline int fixture_setup(void **state) {
    Fixture *f = calloc(1, sizeof *f);
    f->arena = arena_reserve((size_t)4 << 30);
    if (!folder_create(f->folder)) return -1;
    snprintf(f->file, sizeof f->file, "%s/sample", f->folder);
    f->options.wavelength_nm = 550;
    *state = f;
    return 0;
}

static inline int fixture_teardown(void **state) {
    Fixture *f = *state;
    return drop_owner(f->folder, &f->arena, f);
}

static inline void fixture_write(Fixture *f, const void *bytes, size_t size) {
    write_bytes(f->file, bytes, size);
}

/* Reads bytes by an importer, whoever recognises them. */
static inline bool fixture_import(Fixture *f, const void *bytes, size_t size,
                                  const Importer *importer) {
    fixture_write(f, bytes, size);
    f->set = import_set(&f->arena);
    f->err = (Error){.code = ERROR_NONE};
    return importer->read(f->file, &f->options, &f->set, &f->err);
}

/* With this message. */
static inline void assert_bytes_refused(Fixture *f, const void *bytes, size_t size,
                                        const Importer *importer, const char *message) {
    assert_false(fixture_import(f, bytes, size, importer));
    assert_string_equal(f->err.text, message);
}

/* Reads `file` by the importer that recognises it, which must be `name`. */
static inline bool fixture_read_file(Fixture *f, const char *file, const char *name) {
    static char head[4097];
    FILE *stream = fopen(file, "rb");
    assert_non_null(stream);
    size_t size = fread(head, 1, 4096, stream);
    head[size] = 0;
    fclose(stream);
    f->set = import_set(&f->arena);
    f->err = (Error){.code = ERROR_NONE};
    for (int i = 0; importers[i]; i++)
        if (importers[i]->recognises(file, head, size)) {
            assert_string_equal(importers[i]->name, name);
            return importers[i]->read(file, &f->options, &f->set, &f->err);
        }
    fail_msg("%s is recognised by no importer", file);
    return false;
}

static inline bool fixture_read(Fixture *f, const void *bytes, size_t size, const char *name) {
    fixture_write(f, bytes, size);
    return fixture_read_file(f, f->file, name);
}

static inline void assert_reads(Fixture *f, const char *text, const char *name) {
    if (!fixture_read(f, text, strlen(text), name)) {
        char line[2048];
        error_line(&f->err, line, sizeof line);
        fail_msg("%s", line);
    }
}

/* The message of the refusal, with "FILE: " before it cut off. */
static inline void assert_refused(Fixture *f, const char *text, const Importer *importer,
                                  const char *message) {
    char line[2048];
    assert_false(fixture_import(f, text, strlen(text), importer));
    error_line(&f->err, line, sizeof line);
    assert_memory_equal(line, f->file, strlen(f->file));
    assert_string_equal(line + strlen(f->file) + 2, message);
}

/* Every prefix is refused with a message (but the whole of it), and nothing is read beyond. */
static inline void assert_prefixes_refused(Fixture *f, const void *bytes, size_t size, size_t step,
                                           const Importer *importer) {
    for (size_t n = 0; n < size; n += step) {
        Arena before = f->arena;
        if (fixture_import(f, bytes, n, importer))
            fail_msg("a prefix of %zu of %zu bytes was taken", n, size);
        assert_true(f->err.code != ERROR_NONE && f->err.text[0]);
        f->arena = before;
    }
}

static inline const ImportTable *table_at(const Fixture *f, double incidence, double azimuth) {
    for (int i = 0; i < f->set.count; i++)
        if (fabs(f->set.table[i].incidence_deg - incidence) < 1e-6 &&
            fabs(f->set.table[i].incidence_phi_deg - azimuth) < 1e-6)
            return &f->set.table[i];
    fail_msg("no table at incidence %g, azimuth %g", incidence, azimuth);
    return NULL;
}

/* The angle between two directions, degrees. */
static inline double angle_between(double theta, double phi, double other_theta, double other_phi) {
    double r = 3.14159265358979323846 / 180;
    double x = sin(theta * r) * cos(phi * r) - sin(other_theta * r) * cos(other_phi * r);
    double y = sin(theta * r) * sin(phi * r) - sin(other_theta * r) * sin(other_phi * r);
    double z = cos(theta * r) - cos(other_theta * r);
    return 2 * asin(fmin(1, sqrt(x * x + y * y + z * z) / 2)) / r;
}

/* The row nearest to a direction, which must be within `within` degrees of it. */
static inline int row_at(const ImportTable *table, double theta, double phi, double within) {
    int best = -1;
    double least = within;
    for (int i = 0; i < table->rows; i++) {
        double away = angle_between(theta, phi, table->theta_deg[i], table->phi_deg[i]);
        if (away <= least) {
            least = away;
            best = i;
        }
    }
    if (best < 0) fail_msg("no row within %g degrees of (%g, %g)", within, theta, phi);
    return best;
}

static inline double value_at(const ImportTable *table, double theta, double phi, int channel) {
    return table->value[row_at(table, theta, phi, 1e-4) * table->channels + channel];
}

static inline bool has_note(const Fixture *f, const char *words) {
    return lines_have(f->set.note, f->set.note_count, words);
}

static inline void assert_noted(const Fixture *f, const char *words) {
    if (has_note(f, words)) return;
    for (int i = 0; i < f->set.note_count; i++) print_message("note: %s\n", f->set.note[i]);
    fail_msg("no note says '%s'", words);
}

/* The real files are not part of the project: without them the case is skipped, visibly. */
static inline const char *shared_bsdf(Fixture *f, const char *name) {
    const char *path = arena_format(&f->arena, "%s/bsdf/%s", SHARED_DATA_DIR, name);
    if (!file_exists(path)) skip();
    return path;
}

/* A case with `Fixture *f`. */
#define FIXTURE_TEST(name) TEST_ON(name, fixture_setup, fixture_teardown, Fixture *f, *state)
