/* SPDX-License-Identifier: Apache-2.0 */
/* lab_fixture.h -- a laboratory's files in a temporary folder, imported as a user would. */
#pragma once
#include "fixture.h"
#include "import/import_request.h"
#include "import/import_request.h"
#include "panel/set/measurement.h"

typedef struct Lab {
    Arena arena;
    char folder[FOLDER_BYTES];
    ImportRequest *request;
    const char *file[64];
    int count;
    ImportSet set;
    Error err;
} Lab;

static inline void lab_write_bytes(Lab *lab, const char *name, const void *bytes, size_t size) {
    const char *path = arena_format(&lab->arena, "%s/%s", lab->folder, name);
    write_bytes(path, bytes, size);
    for (int i = 0; i < lab->count; i++)
        if (!strcmp(lab->file[i], path)) return;
    lab->file[lab->count++] = path;
}

static inline void lab_write(Lab *lab, const char *name, const char *text) {
    lab_write_bytes(lab, name, text, strlen(text));
}

static inline void lab_declare(Lab *lab, const char *key, const char *value) {
    if (!text_options_set(&lab->request->text, key, value, &lab->err))
        fail_msg("%s", lab->err.text);
}

static inline void lab_role(Lab *lab, const char *pattern, const char *role) {
    TextOptions *text = &lab->request->text;
    text->role[text->role_count++] = (RoleRow){pattern, role};
}

static inline bool lab_run(Lab *lab) {
    lab->set = import_set(&lab->arena);
    lab->err = (Error){.code = ERROR_NONE};
    return import_run(lab->file, lab->count, lab->request, &lab->set, &lab->err);
}

static inline void lab_import(Lab *lab) {
    char line[2048];
    if (lab_run(lab)) return;
    error_line(&lab->err, line, sizeof line);
    fail_msg("%s", line);
}

/* The refusal's line, without the temporary folder. */
static inline void lab_refused(Lab *lab, const char *message) {
    char line[2048], *at;
    assert_false(lab_run(lab));
    error_line(&lab->err, line, sizeof line);
    size_t length = strlen(lab->folder) + 1;
    while ((at = strstr(line, lab->folder))) memmove(at, at + length, strlen(at + length) + 1);
    assert_string_equal(line, message);
}

static inline int lab_setup(void **state) {
    Lab *lab = calloc(1, sizeof *lab);
    const char *base = getenv("TMPDIR"); /* thousands of small files: in memory if there is */
    if (!base) base = !access("/dev/shm", W_OK) ? "/dev/shm" : P_tmpdir;
    lab->arena = arena_reserve((size_t)16 << 30);
    lab->request = ARENA_NEW(&lab->arena, ImportRequest, 1);
    *state = lab;
    return folder_create_below(base, lab->folder) ? 0 : -1;
}

static inline int lab_teardown(void **state) {
    Lab *lab = *state;
    return drop_owner(lab->folder, &lab->arena, lab);
}

static inline const ImportTable *lab_table(const Lab *lab, ImportSource source, double which) {
    for (int i = 0; i < lab->set.count; i++) {
        const ImportTable *table = &lab->set.table[i];
        double told = source == IMPORT_REFLECTION ? table->incidence_deg : table->level;
        if (table->source == source && fabs(told - which) < 1e-6) return table;
    }
    fail_msg("no table of source %d at %g", (int)source, which);
    return NULL;
}

static inline double lab_value(const ImportTable *table, double theta, double phi, int channel) {
    for (int i = 0; i < table->rows; i++) {
        double turn = remainder(table->phi_deg[i] - phi, 360);
        bool at_pole = theta == 0 && table->theta_deg[i] == 0;
        if (fabs(table->theta_deg[i] - theta) < 1e-6 && (at_pole || fabs(turn) < 1e-6))
            return table->value[(size_t)i * (size_t)table->channels + (size_t)channel];
    }
    fail_msg("no row at theta %g, phi %g", theta, phi);
    return 0;
}

static inline bool lab_noted(const Lab *lab, const char *words) {
    return lines_have(lab->set.note, lab->set.note_count, words);
}

/* A case with `Lab *lab`. */
#define LAB_TEST(name) TEST_ON(name, lab_setup, lab_teardown, Lab *lab, *state)
