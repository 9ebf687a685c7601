/* SPDX-License-Identifier: Apache-2.0 */
/* JSON files of users: a measurement set, a recipe, a declaration. */
#include <math.h>
#include <string.h>
#include <sys/stat.h>

#include "harness.h"
#include "import/import_request.h"
#include "panel/set/synthetic_format.h"
#include "panel/set/measurement.h"

/* ---- tables that a manifest may name ----------------------------------------------------- */

#define WHITE "theta,phi,X,Y,Z\n0,0,90,100,80\n30,0,80,90,70\n30,90,82,91,72\n60,180,40,50,30\n"
#define BLACK "theta,phi,X,Y,Z\n0,0,.1,.1,.1\n30,0,.1,.1,.1\n30,90,.1,.1,.1\n60,180,.1,.1,.1\n"
#define LIGHT "theta,phi,450,550,650\n0,0,.1,.2,.3\n20,0,1,2,3\n20,90,.1,.1,.2\n60,0,.1,.2,.1\n"
#define SPECTRA "nm,red,green,blue\n360,0,0,0\n400,0,0,1\n500,0,1,.5\n600,1,.2,0\n830,.5,0,0\n"

typedef struct SmallFile {
    const char *name, *text;
} SmallFile;

static const SmallFile small_files[] = {
    {"white.csv", WHITE},    {"black.csv", BLACK},   {"spectra.csv", SPECTRA},
    {"red_127.csv", BLACK},  {"red_255.csv", WHITE}, {"green_255.csv", WHITE},
    {"blue_255.csv", WHITE}, {"i20.csv", LIGHT},     {"i50.csv", LIGHT},
    {"i20_a0.csv", LIGHT},   {"i50_a0.csv", LIGHT},  {"i20_a180.csv", LIGHT},
    {"i50_a180.csv", LIGHT},
};

static void write_small_files(Arena *arena) {
    struct stat info;
    if (!stat(fuzz_path("i50_a180.csv", arena), &info)) return;
    for (size_t i = 0; i < sizeof small_files / sizeof *small_files; i++)
        fuzz_file(small_files[i].name, small_files[i].text, strlen(small_files[i].text), arena);
}

/* ---- targets ----------------------------------------------------------------------------- */

static void claim_table(const AngleTable *table) {
    for (int i = 0; i < table->rows; i++)
        fuzz_claim(table->theta[i] >= 0 && table->theta[i] < 1.571f && table->phi[i] >= 0 &&
                       table->phi[i] < 6.2832f,
                   "a direction is on the hemisphere");
    for (int i = 0; i < table->rows * table->channels; i++)
        fuzz_claim(isfinite(table->value[i]), "a value is finite");
}

void fuzz_manifest(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    Measurement *set = ARENA_NEW(arena, Measurement, 1);
    write_small_files(arena);
    const char *path = fuzz_file("MANIFEST.json", data, size, arena);
    if (!measurement_read(path, arena, set, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < set->primary[p].level_count; i++)
            claim_table(&set->primary[p].table[i]);
    for (int i = 0; i < set->incidence_count * set->azimuth_count; i++) claim_table(&set->brdf[i]);
}

void fuzz_recipe(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    SyntheticPanel *recipe = ARENA_NEW(arena, SyntheticPanel, 1);
    const char *path = fuzz_file("recipe.json", data, size, arena);
    const double angles[2] = {0.7, 2};
    double xyz[3];
    if (!synthetic_panel_read(path, arena, recipe, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    for (int p = 0; p < 3; p++) {
        closed_form_emission_xyz(recipe, p, 255, angles, xyz);
        fuzz_claim(isfinite(xyz[0]) && isfinite(xyz[1]) && isfinite(xyz[2]),
                   "what a recipe emits is finite");
    }
    if (recipe->reflection.exists)
        fuzz_claim(closed_form_brdf(recipe, 0.3, 0.4, 0.5, 550) >= 0, "a BRDF is not negative");
}

void fuzz_declaration(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    ImportRequest *request = ARENA_NEW(arena, ImportRequest, 1);
    const char *path = fuzz_file("declaration.json", data, size, arena);
    if (!import_request_read(path, arena, request, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    fuzz_claim(request->text.role_count <= TEXT_ENTRIES_MAX, "roles fit");
    import_request_skips(request, "lab/white_255.csv");
    text_options_role(&request->text, "lab/white_255.csv");
}

/* A table of directions: luminances, and a reflection of three wavelengths. */
void fuzz_table(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0}, other = {0};
    AngleTable table;
    const float nm[3] = {450, 550, 650};
    const char *path = fuzz_file("table.csv", data, size, arena);
    bool is_xyz = angle_table_read_xyz(path, "white", arena, &table, &err);
    if (is_xyz) claim_table(&table);
    bool is_brdf = angle_table_read_brdf(path, nm, 3, arena, &table, &other);
    if (is_brdf) claim_table(&table);
    if (is_xyz || is_brdf) return; /* what is one is not the other */
    fuzz_claim_refusal(&err);
    fuzz_claim_refusal(&other);
}
