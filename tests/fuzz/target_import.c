/* SPDX-License-Identifier: Apache-2.0 */
/* Measurements of other programs: what is imported is a set that this program's fit reads. */
#include <math.h>
#include <string.h>

#include "harness.h"
#include "import/import_request.h"
#include "import/set/import_write.h"
#include "panel/set/measurement.h"

#define FILES_MAX 8
#define FILE_MARK "=== "     /* begins a line that names the next file */
#define WRITTEN_TABLES_MAX 8 /* a larger set is not written */
#define WRITTEN_ROWS_MAX 400

/* ---- what must hold ---------------------------------------------------------------------- */

static void claim_table(const ImportTable *table) {
    fuzz_claim(table->rows > 0 && table->channels > 0, "a table has values");
    for (int i = 0; i < table->rows; i++)
        fuzz_claim(table->theta_deg[i] >= 0 && table->theta_deg[i] <= 90 &&
                       isfinite(table->phi_deg[i]),
                   "a direction is on the hemisphere");
    size_t count = (size_t)table->rows * (size_t)table->channels;
    for (size_t i = 0; i < count; i++) fuzz_claim(isfinite(table->value[i]), "a value is finite");
    for (int c = 1; table->source == IMPORT_REFLECTION && c < table->channels; c++)
        fuzz_claim(table->wavelength_nm[c] > table->wavelength_nm[c - 1], "wavelengths rise");
}

static bool is_small(const ImportSet *set) {
    long rows = 0;
    for (int i = 0; i < set->count; i++) rows += (long)set->table[i].rows;
    return set->count <= WRITTEN_TABLES_MAX && rows <= WRITTEN_ROWS_MAX;
}

/* Written and read again, as a user would. The reader may refuse values (a black that is
 * brighter than white), but never for a reason that the writer could have known. */
static void claim_round_trip(const ImportSet *set, Arena *arena) {
    Error err = {0};
    const char *path = fuzz_path("set/MANIFEST.json", arena);
    Measurement *back = ARENA_NEW(arena, Measurement, 1);
    if (!import_write(set, path, &err) || !measurement_read(path, arena, back, &err))
        fuzz_claim_refusal(&err);
}

static void claim_run(const char *const *files, int count, const ImportRequest *request,
                      Arena *arena) {
    Error err = {0};
    ImportSet set = import_set(arena);
    if (!import_run(files, count, request, &set, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    fuzz_claim(set.count > 0 && set.count <= IMPORT_TABLES_MAX, "a set has tables");
    for (int i = 0; i < set.count; i++) claim_table(&set.table[i]);
    for (int i = 0; i < set.note_count; i++)
        fuzz_claim(!strchr(set.note[i], '\n'), "a note is one line");
    if (is_small(&set)) claim_round_trip(&set, arena);
}

/* ---- one file ---------------------------------------------------------------------------- */

/* Half of the inputs, by their size, come with the numbers that some formats lack. */
static void give_numbers(ImportOptions *options, size_t size) {
    if (size % 2) return;
    options->wavelength_nm = 550;
    options->area_mm[0] = options->area_mm[1] = 100;
}

void fuzz_import(const uint8_t *data, size_t size, Arena *arena) {
    const char *path = fuzz_file("sample.dat", data, size, arena);
    ImportRequest *request = ARENA_NEW(arena, ImportRequest, 1);
    request->options.format = fuzz_more();
    request->symmetry = (ImportSymmetry)(size % 3 == 0 ? size / 3 % 5 : 0);
    give_numbers(&request->options, size);
    claim_run(&path, 1, request, arena);
}

void fuzz_import_any(const uint8_t *data, size_t size, Arena *arena) {
    const char *path = fuzz_file("white_255.dat", data, size, arena);
    ImportRequest *request = ARENA_NEW(arena, ImportRequest, 1);
    give_numbers(&request->options, size);
    claim_run(&path, 1, request, arena);
}

/* ---- text with its declaration ----------------------------------------------------------- */

/* A line "KEY VALUE". What the declaration refuses is left out. */
static void declare_line(ImportRequest *request, char *line) {
    Error err = {0};
    TextOptions *text = &request->text;
    char *value = strchr(line, ' ');
    if (!value) return;
    *value++ = 0;
    if (!strcmp(line, "role")) {
        char *equals = strrchr(value, '=');
        if (!equals || text->role_count == TEXT_ENTRIES_MAX) return;
        *equals = 0;
        text->role[text->role_count++] = (RoleRow){value, equals + 1};
    } else if (!strcmp(line, "symmetry")) {
        if (!import_symmetry_named(value, &request->symmetry, &err)) fuzz_claim_refusal(&err);
    } else if (!strcmp(line, "set")) {
        request->is_isotropic = strchr(value, 'i') != NULL;
        request->black_is_zero = strchr(value, 'b') != NULL;
    } else if (!text_options_set(text, line, value, &err)) {
        fuzz_claim_refusal(&err);
    }
}

/* A name without a folder, so that the file lies where it should. */
static const char *safe_name(const char *line, Arena *arena) {
    char *name = arena_string(arena, line, strnlen(line, 40));
    for (char *c = name; *c; c++)
        if (*c == '/') *c = '_';
    return *name && *name != '.' ? name : "white.csv";
}

static char *next_line(char **text) {
    char *line = *text, *end = line + strcspn(line, "\n");
    *text = *end ? end + 1 : end;
    *end = 0;
    return line;
}

static char *find_mark(char *text) {
    if (!strncmp(text, FILE_MARK, strlen(FILE_MARK))) return text;
    char *found = strstr(text, "\n" FILE_MARK);
    return found ? found + 1 : NULL;
}

/* Lines that declare, then files, each after a line with its name. Without such a line all of
 * it is one file. */
void fuzz_import_text(const uint8_t *data, size_t size, Arena *arena) {
    const char *files[FILES_MAX];
    int count = 0;
    char *text = fuzz_text(data, size, arena), *end = text + size;
    char *mark = find_mark(text);
    ImportRequest *request = ARENA_NEW(arena, ImportRequest, 1);
    request->options.format = "text";
    if (!mark) files[count++] = fuzz_file("white.csv", data, size, arena);
    while (mark && text < mark) declare_line(request, next_line(&text));
    while (mark && count < FILES_MAX) {
        text = mark + strlen(FILE_MARK);
        const char *name = safe_name(next_line(&text), arena);
        mark = find_mark(text);
        files[count++] = fuzz_file(name, text, (size_t)((mark ? mark : end) - text), arena);
    }
    claim_run(files, count, request, arena);
}

void fuzz_primaries(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    ImportSet set = import_set(arena);
    const char *path = fuzz_file("primaries.csv", data, size, arena);
    if (!primaries_read(path, &set, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    fuzz_claim(set.spectra.rows > 0, "primaries have rows");
    for (int i = 0; i < set.spectra.rows; i++)
        fuzz_claim(isfinite(set.spectra.nm[i]) && (!i || set.spectra.nm[i] > set.spectra.nm[i - 1]),
                   "wavelengths rise");
}
