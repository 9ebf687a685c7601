/* SPDX-License-Identifier: Apache-2.0 */
/* Many files to one set, and the set on disk as this project reads it. */
#include "lab_fixture.h"

#include <sys/stat.h>

#include "base/units.h"
#include "import/importers.h"
#include "import/set/import_write.h"

#define TABLE "theta,phi,X,Y,Z\n0,0,1,2,3\n40,90,4,5,6\n60,0,.123456789,8,9\n"
#define BRDF "theta,phi,450nm,550nm\n0,0,1,2\n30,0,3,4\n30,90,5,6\n60,180,7,8\n"

static void write_primaries(Lab *lab) {
    static const char *const names[] = {"R_031.csv", "R_255.csv", "G_031.csv",
                                        "G_255.csv", "B_031.csv", "B_255.csv"};
    for (int i = 0; i < 6; i++) lab_write(lab, names[i], TABLE);
}

static const char *manifest_of(Lab *lab) {
    return arena_format(&lab->arena, "%s/out/MANIFEST.json", lab->folder);
}

static const char *write_set(Lab *lab) {
    const char *manifest = manifest_of(lab);
    if (!import_write(&lab->set, manifest, &lab->err)) fail_msg("%s", lab->err.text);
    return manifest;
}

static Measurement *read_back(Lab *lab) {
    Measurement *set = ARENA_NEW(&lab->arena, Measurement, 1);
    char line[2048];
    if (measurement_read(write_set(lab), &lab->arena, set, &lab->err)) return set;
    error_line(&lab->err, line, sizeof line);
    fail_msg("%s", line);
    return NULL;
}

LAB_TEST(what_is_written_reads_as_it_was_to_the_last_bit) {
    write_primaries(lab);
    lab_write(lab, "K_000.csv", TABLE);
    lab_write(lab, "BRDF_20.csv", BRDF);
    lab_write(lab, "BRDF_33.3333333.csv", BRDF);
    lab->request->panel = "A \"quoted\" panel";
    lab_import(lab);
    Measurement *set = read_back(lab);
    assert_string_equal(set->panel, "A \"quoted\" panel");
    assert_true(set->has_black && !set->is_white_only);
    for (int p = 0; p < 3; p++) {
        assert_int_equal(set->primary[p].level_count, 2);
        assert_near(set->primary[p].level[0], 31, 0);
        const AngleTable *table = &set->primary[p].table[1];
        assert_int_equal(table->rows, 3);
        assert_near(table->value[6], .123456789f, 0);
        assert_near(table->phi[1], (float)(PI / 2), 0);
    }
    assert_int_equal(set->incidence_count, 2);
    assert_int_equal(set->wavelength_count, 2);
    assert_near(degrees_from_radians(set->incidence[1]), 33.333333, 1e-6);
    assert_near(set->wavelength_nm[1], 550, 0);
    assert_near(set->brdf[0].value[2 * set->brdf[0].rows - 1], 8, 0);
}

LAB_TEST(any_float_survives_the_text) {
    char *text = ARENA_NEW(&lab->arena, char, 1 << 20);
    size_t at = (size_t)sprintf(text, "theta,phi,L\n");
    uint32_t random = 7;
    float value[2000];
    for (int i = 0; i < 2000; i++) {
        random = random * 1664525u + 1013904223u;
        uint32_t bits = (random >> 2) % 0x10000000u + 0x38000000u; /* 3e-5 to 2e33 */
        memcpy(&value[i], &bits, sizeof bits);
        value[i] = fminf(value[i], 1e25f);
        at += (size_t)sprintf(text + at, "%d,%d,%.9g\n", 1 + i / 100, i % 100, (double)value[i]);
    }
    lab_write(lab, "white.csv", text);
    lab_import(lab);
    write_set(lab);
    FileBytes bytes;
    const char *path = arena_format(&lab->arena, "%s/out/emission/white.csv", lab->folder);
    assert_true(file_read(path, 1 << 24, &lab->arena, &bytes, &lab->err));
    const char *line = strstr((const char *)bytes.data, "\n1,0,");
    for (int i = 0; i < 2000; i++) {
        float xyz[3];
        int theta, phi;
        assert_int_equal(sscanf(line, "\n%d,%d,%f,%f,%f", &theta, &phi, &xyz[0], &xyz[1], &xyz[2]),
                         5);
        if (xyz[1] != value[i]) fail_msg("%.9g became %.9g", (double)value[i], (double)xyz[1]);
        line = strchr(line + 1, '\n');
    }
}

LAB_TEST(anisotropic_tables_are_named_by_azimuth) {
    lab_write(lab, "i0.csv", BRDF);
    lab_write(lab, "i30_a0.csv", BRDF);
    lab_write(lab, "i30_a90.csv", BRDF);
    lab_import(lab);
    FileBytes bytes;
    const char *manifest = write_set(lab);
    assert_true(file_read(manifest, 1 << 20, &lab->arena, &bytes, &lab->err));
    assert_non_null(strstr((const char *)bytes.data, "brdf/i{incidence}_a{azimuth}.csv"));
    assert_non_null(strstr((const char *)bytes.data, "incidence_phi_deg"));
    assert_null(strstr((const char *)bytes.data, "\"emission\""));
    assert_true(file_exists(path_beside(manifest, "brdf/i30_a90.csv", &lab->arena)));
    assert_true(file_exists(path_beside(manifest, "brdf/i0_a90.csv", &lab->arena)));
}

LAB_TEST(a_black_that_was_subtracted_is_written_as_zero) {
    write_primaries(lab);
    lab->request->black_is_zero = true;
    lab_import(lab);
    Measurement *set = read_back(lab);
    assert_true(set->has_black);
    for (int i = 0; i < 3 * set->black.rows; i++) assert_near(set->black.value[i], 0, 0);
    lab_write(lab, "black.csv", TABLE);
    lab_refused(lab, "black.csv: is a black pattern, and --no-black says that there is none");
}

LAB_TEST(what_a_set_needs_is_said) {
    lab_refused(lab, "the files hold no table of a panel");
    lab_write(lab, "red.csv", TABLE);
    lab_refused(lab, "no file is green — name one as --role FILE=green:LEVEL");
    lab_write(lab, "green.csv", TABLE);
    lab_write(lab, "blue.csv", TABLE);
    lab_refused(lab, "no file is the black pattern — name one as --role FILE=black, or say "
                     "--no-black when it was subtracted");
    lab_write(lab, "black.csv", TABLE);
    lab_write(lab, "red_255.csv", TABLE);
    lab_refused(lab, "red_255.csv: is red 255, and so is red.csv — give one of them another "
                     "--role, or leave it out");
    lab->count = 0;
    lab_write(lab, "black.csv", TABLE);
    lab_refused(lab, "black.csv: is a black pattern alone, required: also red, green and "
                     "blue, or white");
    lab->count = 0;
    lab_write(lab, "white_x.csv", "theta,phi,X\n0,0,1\n9,0,1\n8,0,1\n");
    lab_refused(lab, "white_x.csv: is X of white 255, and no file has Y — give the missing "
                     "file, or its role as --role FILE=white:255:Y");
    lab->count = 0;
    lab_write(lab, "i10.csv", BRDF);
    lab_write(lab, "i20.csv", "theta,phi,450nm\n0,0,1\n30,0,3\n30,90,5\n");
    lab_refused(lab, "i20.csv: has other wavelengths than i10.csv, required: the same in every "
                     "table");
    lab->count = 0;
    lab_write(lab, "i10_a0.csv", BRDF);
    lab_write(lab, "i20_a90.csv", BRDF);
    lab_refused(lab, "no file has light from incidence 10, azimuth 90 degrees; a material that "
                     "depends on the azimuth is required at every incidence (2) and azimuth "
                     "(2) of the light — or say --isotropic when the azimuth makes no "
                     "difference");
}

LAB_TEST(what_cannot_be_noise_below_zero_is_refused) {
    lab_write(lab, "white.csv", "theta,phi,L\n0,0,100\n30,90,-0.4\n40,0,90\n");
    lab_import(lab);
    lab_write(lab, "white.csv", "theta,phi,L\n0,0,100\n30,90,-2\n40,0,90\n");
    lab_refused(lab, "white.csv: is -2.17766 at theta 30, phi 90, required: at least -0.544415 "
                     "cd/m2 (noise below zero)");
    lab->count = 0;
    lab_write(lab, "i10.csv", "theta,phi,550nm\n0,0,1\n30,0,-0.0009\n40,0,1\n");
    lab_import(lab);
    lab_write(lab, "i10.csv", "theta,phi,550nm\n0,0,1\n30,0,-0.0011\n40,0,1\n");
    lab_refused(lab, "i10.csv: is -0.0011 at theta 30, phi 0, required: at least -0.001 sr^-1 "
                     "(noise below zero)");
}

LAB_TEST(wavelengths_that_nobody_sees_are_left_out) {
    lab_write(lab, "i10.csv", "theta,phi,300nm,550nm,1064nm\n0,0,1,2,3\n30,0,1,2,3\n9,9,1,2,3\n");
    lab_import(lab);
    assert_int_equal(lab_table(lab, IMPORT_REFLECTION, 10)->channels, 1);
    assert_near(lab_value(lab_table(lab, IMPORT_REFLECTION, 10), 30, 0, 0), 2, 0);
    assert_true(lab_noted(lab, "2 of 3 wavelengths lie outside 360 to 830 nm"));
    lab_write(lab, "i10.csv", "theta,phi,1064nm\n0,0,3\n30,0,3\n9,9,3\n");
    lab_refused(lab, "i10.csv: has wavelengths from 1064 to 1064 nm, required: some of 360 to "
                     "830 nm");
}

LAB_TEST(a_declared_symmetry_fills_what_was_not_measured) {
    lab_write(lab, "white.csv", "theta,phi,L\n0,0,9\n30,0,1\n30,30,2\n30,90,3\n");
    lab->request->symmetry = IMPORT_BOTH;
    lab_import(lab);
    const ImportTable *white = lab_table(lab, IMPORT_WHITE, 255);
    assert_int_equal(white->rows, 1 + 8);
    static const double phi[] = {30, 150, 210, 330};
    for (int i = 0; i < 4; i++) assert_near(lab_value(white, 30, phi[i], 1), 2, 0);
    assert_near(lab_value(white, 30, 270, 1), 3, 0);
    lab->request->symmetry = IMPORT_HALF_TURN;
    lab_import(lab);
    assert_near(lab_value(lab_table(lab, IMPORT_WHITE, 255), 30, 210, 1), 2, 0);
    assert_int_equal(lab_table(lab, IMPORT_WHITE, 255)->rows, 1 + 6);
}

/* The sample's image is the sample: light and leaving direction mirrored, the same value. */
LAB_TEST(mirrored_lights_keep_the_mirrored_values) {
    static const char text[] = "theta,phi,550nm\n0,0,1\n30,20,2\n40,200,3\n50,300,4\n";
    static const char *const names[] = {"i30_a0.csv", "i30_a50.csv", "i30_a90.csv"};
    for (int i = 0; i < 3; i++) lab_write(lab, names[i], text);
    lab->request->symmetry = IMPORT_BOTH;
    lab_import(lab);
    assert_int_equal(lab->set.count, 8);
    for (int i = 0; i < lab->set.count; i++) {
        const ImportTable *table = &lab->set.table[i];
        double light = table->incidence_phi_deg;
        bool is_left = light > 90 && light < 270, is_low = light > 180;
        if (light == 0 || light == 90 || light == 180 || light == 270) continue;
        for (int k = 0; k < 3; k++) {
            static const double phi[] = {20, 200, 300};
            double seen = is_left ? 180 - phi[k] : phi[k];
            seen = is_low ? -seen : seen;
            assert_near(lab_value(table, 30 + 10 * k, seen + 180 - light, 0), 2 + k, 0);
        }
    }
}

LAB_TEST(white_is_compared_with_the_sum_of_the_primaries) {
    static const char *const names[] = {"red.csv", "green.csv", "blue.csv", "black.csv",
                                        "white.csv"};
    static const double level[] = {11, 21, 31, 1, 60};
    for (int i = 0; i < 5; i++)
        lab_write(lab, names[i],
                  arena_format(&lab->arena,
                               "theta,phi,L\n0,0,%g\n30,0,%g\n"
                               "40,0,%g\n",
                               level[i], level[i], level[i] + 6 * (i == 4)));
    lab_import(lab);
    assert_true(lab_noted(lab, "white is -1.64% of red + green + blue - 2 black on the normal "
                               "and +8.20% at theta 40, phi 0"));
    assert_true(lab_noted(lab, "the white table is not used"));
}

LAB_TEST(nothing_half_written_stays) {
    struct stat status;
    lab_write(lab, "white.csv", TABLE);
    lab_write(lab, "i10.csv", BRDF);
    lab_import(lab);
    const char *blocked = arena_format(&lab->arena, "%s/out", lab->folder);
    lab_write(lab, "out", "a file where the folder should be");
    assert_false(import_write(&lab->set, manifest_of(lab), &lab->err));
    assert_int_equal(lab->err.code, ERROR_OUTPUT);
    assert_int_equal(remove(blocked), 0);
    assert_int_equal(mkdir(blocked, 0777), 0);
    lab_write(lab, "out/brdf", "a file where the folder should be");
    assert_false(import_write(&lab->set, manifest_of(lab), &lab->err));
    const char *left = arena_format(&lab->arena, "%s/out/emission", lab->folder);
    assert_int_not_equal(stat(left, &status), 0);
    assert_false(file_exists(manifest_of(lab)));
    assert_int_equal(remove(path_beside(manifest_of(lab), "brdf", &lab->arena)), 0);
    write_set(lab);
    assert_true(file_exists(manifest_of(lab)));
}

LAB_TEST(a_source_is_not_written_over) {
    assert_int_equal(mkdir(arena_format(&lab->arena, "%s/out", lab->folder), 0777), 0);
    const char *inside = arena_format(&lab->arena, "%s/out/emission", lab->folder);
    assert_int_equal(mkdir(inside, 0777), 0);
    lab_write(lab, "out/emission/white.csv", TABLE);
    lab_import(lab);
    assert_false(import_write(&lab->set, manifest_of(lab), &lab->err));
    assert_int_equal(lab->err.code, ERROR_OUTPUT);
    assert_non_null(strstr(lab->err.text, "would be written over"));
    assert_false(file_exists(manifest_of(lab)));
    lab->file[0] = inside;
    lab_refused(lab, "out/emission: is a folder, a file is required");
}

#define WHITE "theta,phi,X,Y,Z\n0,0,95,100,108\n40,90,47,50,54\n60,90,23,25,27\n"

/* ---- levels of white alone -------------------------------------------------------------- */

static const char *beside(Lab *lab, const char *name, const char *text) {
    lab_write(lab, name, text);
    return lab->file[--lab->count];
}

LAB_TEST(a_gamma_table_goes_into_the_set) {
    lab_write(lab, "white.csv", WHITE);
    lab->request->levels = beside(lab, "gamma.csv", "level,L\n0,1\n0.5,25\n1,103\n");
    lab_import(lab);
    assert_true(lines_have(lab->set.note, lab->set.note_count, "from gamma.csv: 3 rows"));
    const Measurement *set = read_back(lab);
    assert_true(set->is_white_only && set->has_black && set->levels);
    assert_close(set->black.value[1], 100.0 / 103, 1e-5);
    assert_int_equal(set->primary[1].level_count, 2);
    assert_near(set->primary[1].level[0], 127.5, 0);
    double sum = 0; /* black is in every primary's table */
    for (int p = 0; p < 3; p++) sum += (double)set->primary[p].table[0].value[4];
    assert_close(sum - 2 * (double)set->black.value[4], 50 * 25.0 / 103, 1e-5);
}

static void levels_refused(Lab *lab, const char *text, const char *place, const char *words) {
    lab->request->levels = beside(lab, "gamma.csv", text);
    assert_false(lab_run(lab));
    assert_string_equal(lab->err.file, lab->request->levels);
    assert_string_equal(lab->err.path, place);
    assert_error_has(&lab->err, words);
}

LAB_TEST(a_gamma_table_that_does_not_fit_is_refused) {
    lab_write(lab, "white.csv", WHITE);
    lab_declare(lab, "level_max", "1023"); /* of the table as of the patterns */
    levels_refused(lab, "level,L\n0,1\n255,100\n", "line 3",
                   "required: rows up to the highest "
                   "code, 1023 as stated");
    lab_declare(lab, "level_max", "255");
    levels_refused(lab, "level,L\n0,1\n255,106\n", "line 3",
                   "full level has 106 cd/m2, but the set's white on the axis 100 (");
    levels_refused(lab, "level,L\n0,1\n9,0\n255,100\n", "line 3",
                   "0 cd/m2 at level 9 is less than the 1 of level 0 (line 2)");
    write_primaries(lab);
    lab_write(lab, "K_000.csv", TABLE);
    lab->file[0] = lab->file[--lab->count]; /* without white.csv */
    levels_refused(lab, "level,L\n0,1\n255,100\n", "", "is a level table for a set of white alone");
}

LAB_TEST(a_gamma_table_is_not_written_over) {
    assert_int_equal(mkdir(arena_format(&lab->arena, "%s/out", lab->folder), 0777), 0);
    const char *inside = arena_format(&lab->arena, "%s/out/emission", lab->folder);
    assert_int_equal(mkdir(inside, 0777), 0);
    lab_write(lab, "white.csv", TABLE);
    lab->request->levels = beside(lab, "out/emission/levels.csv", "level,L\n0,0\n255,2\n");
    lab_import(lab);
    assert_false(import_write(&lab->set, manifest_of(lab), &lab->err));
    assert_text_has(lab->err.file, "out/emission/levels.csv");
    assert_error_has(&lab->err, "would be written over");
}

/* ---- the declaration file ---------------------------------------------------------------- */

static bool read_layout(Lab *lab, const char *text) {
    const char *path = arena_format(&lab->arena, "%s/layout.json", lab->folder);
    int before = lab->count;
    lab_write(lab, "layout.json", text);
    lab->count = before;
    *lab->request = (ImportRequest){.panel = NULL};
    lab->err = (Error){.code = ERROR_NONE};
    return import_request_read(path, &lab->arena, lab->request, &lab->err);
}

LAB_TEST(a_declaration_file_holds_all_options) {
    assert_true(read_layout(
        lab, "{\"columns\": [\"theta\", \"phi\", \"-\", \"L\"], \"delimiter\": \"semicolon\","
             " \"decimal\": \"comma\", \"skip_lines\": 1, \"azimuth_zero\": \"top\","
             " \"azimuth_sense\": \"cw\", \"mask\": [-999, \"bad\"], \"unit\": \"fL\","
             " \"roles\": {\"m1.txt\": \"white\"}, \"skip\": [\"m2*\"], \"panel\": \"P\","
             " \"instrument\": \"I\", \"isotropic\": true, \"area_mm\": [10, 20],"
             " \"wavelength_nm\": 550, \"note\": \"ours\"}"));
    assert_near(lab->request->options.area_mm[1], 20, 0);
    assert_true(lab->request->is_isotropic);
    lab_write(lab, "m1.txt",
              "anything\n0;0;5;1,5\n30;0;5;2,5\n30;30;5;3,5\n40;0;5;-999\n"
              "50;0;5;bad\n");
    lab_write(lab, "m2.txt", "anything\n");
    lab_import(lab);
    const ImportTable *white = lab_table(lab, IMPORT_WHITE, 255);
    assert_close(lab_value(white, 30, 60, 1), 3.5 * 3.4262590996, 1e-9);
    assert_int_equal(white->masked, 2);
    assert_string_equal(lab->set.panel, "P");
}

LAB_TEST(a_declaration_files_mistakes_are_named) {
    static const char *const wrong[][2] = {
        {"{\"azimut_zero\": \"top\"}", "azimuth_zero"},
        {"{\"azimuth_zero\": \"north\"}", "required: right|top|left|bottom|DEG"},
        {"{\"roles\": {\"a\": \"rot\"}}", "the role 'rot' is unknown"},
        {"{\"roles\": {\"a\": []}}", "required: a role"},
        {"{\"skip\": \"a\"}", "required: a list of patterns"},
        {"{\"isotropic\": 1}", "required: true or false"},
        {"{\"mask\": [{}]}", "required: texts or numbers"},
        {"{\"delimiter\": null}", "required: a text or a number"},
        {"{\"area_mm\": [0, 1]}", "area_mm"},
        {"{\"area_mm\": [10]}", "has 1 values, required: 2"},
        {"{", ""},
        {"[]", ""},
        {"", ""}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char line[2048];
        if (read_layout(lab, wrong[i][0])) fail_msg("%s is taken", wrong[i][0]);
        error_line(&lab->err, line, sizeof line);
        if (!strstr(line, wrong[i][1]) || !strstr(line, "layout.json"))
            fail_msg("%s: %s", wrong[i][0], line);
    }
}

/* ---- spectra ----------------------------------------------------------------------------- */

LAB_TEST(spectra_go_into_the_set) {
    write_primaries(lab);
    lab_write(lab, "black.csv", TABLE);
    int count = lab->count;
    lab_write(lab, "s.csv",
              "# relative\nWavelength_nm;B;G;R\n380;0;0;0\n400;0.5;0;0\n"
              "550;0;1;0\n620;0;0;0.25\n700;0;0;0\n");
    lab->count = count;
    lab->request->primaries = arena_format(&lab->arena, "%s/s.csv", lab->folder);
    lab_import(lab);
    Measurement *set = read_back(lab);
    assert_true(set->has_spectra);
    assert_near(set->spectrum[0][620 - SPECTRAL_FIRST_NM], 0.25, 1e-6);
    assert_near(set->spectrum[2][400 - SPECTRAL_FIRST_NM], 0.5, 1e-6);
    static const char *const wrong[][2] = {
        {"nm,red,green\n400,1,2\n500,1,2\n", "s.csv: header line: has no column 'blue'"},
        {"nm,red,green,blue\n400,1,2,3\n390,1,2,3\n", "s.csv: line 3: wavelength 390 follows "
                                                      "400, required: rising wavelengths"},
        {"nm,red,green,blue\n400,1,2,3\n500,1,2\n",
         "s.csv: line 3: has fewer cells than the header's 4 "
         "columns"},
        {"nm,red,green,blue\n400,1,2,3\n500,1,2,x\n",
         "s.csv: line 3: column 'blue' holds 'x', required: a "
         "finite number"},
        {"nm,red,green,blue\n.4,1,2,3\n.5,1,2,3\n", "s.csv: column 'red' goes from 0.4 to 0.5 nm "
                                                    "and ends in light, required: 400 to 700 "
                                                    "nm or beyond"},
        {"nm,red,green,blue,note\n400,1,2,3,4\n", "s.csv: header line: has 5 columns, required: "
                                                  "nm, red, green, blue and maybe black, each "
                                                  "once"},
        {"nm,red,green,blue\n400,1,2,3\n", "s.csv: has 1 wavelengths, required: more"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        lab_write(lab, "s.csv", wrong[i][0]);
        lab->count = count;
        lab_refused(lab, wrong[i][1]);
    }
}

/* ---- documentation ----------------------------------------------------------------------- */

LAB_TEST(the_readme_names_every_key_and_format) {
    FileBytes readme;
    assert_true(
        file_read(PROJECT_DIR "/src/import/README.md", 1 << 20, &lab->arena, &readme, &lab->err));
    for (int i = 0; i < text_key_count; i++)
        if (!strstr((const char *)readme.data,
                    arena_format(&lab->arena, "| `%s` |", text_keys[i].key)))
            fail_msg("no key %s", text_keys[i].key);
    for (int i = 0; importers[i]; i++)
        if (!strstr((const char *)readme.data,
                    arena_format(&lab->arena, "| `%s` |", importers[i]->name)))
            fail_msg("no format %s", importers[i]->name);
}

/* The command line's keys and words are those of a file. */
LAB_TEST(a_declaration_file_has_every_key_of_a_text_declaration) {
    for (int i = 0; i < text_key_count; i++) {
        const RecordRow *row = import_format.rows;
        char values[256], word[64], *rest = values, *value;
        while (row->key && strcmp(row->key, text_keys[i].key) != 0) row++;
        if (!row->key) fail_msg("no row %s", text_keys[i].key);
        snprintf(values, sizeof values, "%s", text_keys[i].values);
        bool is_choice = strstr(row->schema, "'enum'") != NULL;
        while (is_choice && (value = strsep(&rest, "|")) && strcmp(value, "DEG") != 0) {
            snprintf(word, sizeof word, "'%s'", value);
            if (!strstr(row->schema, word)) fail_msg("%s: no %s", row->key, word);
        }
    }
}

TEST_PROGRAM(NULL, NULL)
