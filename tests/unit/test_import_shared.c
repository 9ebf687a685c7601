/* SPDX-License-Identifier: Apache-2.0 */
/* The foreign sets of the shared data, imported with as few words as are honest, equal to their
 * source value by value. Without the shared data the cases are skipped. */
#include "lab_fixture.h"

#include <glob.h>

#define PANELS SHARED_DATA_DIR "/panels"
#define DISPLAY SHARED_DATA_DIR "/display"

static void add_files(Lab *lab, const char *pattern) {
    glob_t found;
    if (glob(pattern, 0, NULL, &found) != 0) {
        globfree(&found);
        skip();
    }
    for (size_t i = 0; i < found.gl_pathc; i++)
        lab->file[lab->count++] =
            arena_string(&lab->arena, found.gl_pathv[i], strlen(found.gl_pathv[i]));
    globfree(&found);
}

/* ---- set-a: lists in this project's own convention --------------------------------------- */

/* Every row of the source as it stands, to the float. */
static void compare_list(const ImportTable *table) {
    FILE *source = fopen(table->file, "r");
    char line[4096];
    assert_non_null(source);
    assert_non_null(fgets(line, sizeof line, source));
    for (int i = 0; i < table->rows; i++) {
        char *at = fgets(line, sizeof line, source);
        assert_non_null(at);
        assert_near(strtof(at, &at), table->theta_deg[i], 0);
        assert_near(strtof(at + 1, &at), table->phi_deg[i], 0);
        for (int c = 0; c < table->channels; c++) {
            float value = (float)table->value[(size_t)(i * table->channels + c)];
            assert_near(strtof(at + 1, &at), value, 0);
        }
    }
    assert_null(fgets(line, sizeof line, source));
    fclose(source);
}

LAB_TEST(set_a_is_what_it_was) {
    add_files(lab, PANELS "/set-a/*.csv");
    lab->request->skip.text[lab->request->skip.count++] = "truth_*";
    lab_import(lab);
    assert_int_equal(lab->set.count, 25 + 7);
    assert_false(lab->set.is_anisotropic);
    for (int i = 0; i < lab->set.count; i++) {
        assert_int_equal(lab->set.table[i].masked, 0);
        compare_list(&lab->set.table[i]);
    }
    lab_table(lab, IMPORT_BLUE, 223);
    assert_int_equal(lab_table(lab, IMPORT_REFLECTION, 65)->channels, 16);
}

LAB_TEST(the_truth_files_are_no_tables_and_are_named) {
    add_files(lab, PANELS "/set-a/truth_*.csv");
    assert_false(lab_run(lab));
    assert_non_null(strstr(lab->err.file, "truth_brdf.csv"));
    assert_non_null(strstr(lab->err.text, "--role FILE=skip"));
    lab->file[0] = lab->file[1];
    lab->count = 1;
    assert_false(lab_run(lab));
    assert_non_null(strstr(lab->err.text, "--role FILE=skip"));
}

/* ---- set-b: matrices, Latin-1, decimal comma, clockwise from 12 o'clock ------------------ */

/* The matrix of a component: its cells by row and column; "---" as NAN. */
static void read_matrix(const char *text, char component, double cell[23][36]) {
    char head[8];
    snprintf(head, sizeof head, "\n[%c]", component);
    const char *at = strstr(text, head);
    assert_non_null(at);
    at = strchr(strstr(at, "Incl\\Azim"), '\n') + 1;
    for (int i = 0; i < 23; i++, at = strchr(at, '\n') + 1) {
        const char *here = at;
        for (int k = 0; k < 36; k++) {
            char digits[32] = {0};
            here = strchr(here, ';') + 1;
            for (int n = 0; n < 30 && !strchr(";\r\n", here[n]); n++)
                digits[n] = here[n] == ',' ? '.' : here[n];
            cell[i][k] = digits[0] == '-' && digits[1] == '-' ? NAN : strtod(digits, NULL);
        }
    }
}

static int compare_matrices(Lab *lab, const ImportTable *table) {
    FileBytes bytes;
    double cell[23][36];
    int holes = 0;
    assert_true(file_read(table->file, 1 << 24, &lab->arena, &bytes, &lab->err));
    for (int c = 0; c < 3; c++) {
        read_matrix((const char *)bytes.data, "XYZ"[c], cell);
        for (int i = 0; i < 23; i++)
            for (int k = 0; k < 36; k++) {
                if (isnan(cell[i][k])) {
                    holes += c == 0;
                    continue;
                }
                double found = 0, phi = 90 - 10 * k;
                bool seen = false;
                for (int r = 0; r < table->rows && !seen; r++) {
                    seen = table->theta_deg[r] == 4 * i &&
                           fabs(remainder(table->phi_deg[r] - phi, 360)) < 1e-9;
                    found = table->value[3 * r + c];
                }
                assert_true(seen);
                assert_near(found, cell[i][k], 0);
            }
    }
    return holes;
}

LAB_TEST(set_b_is_turned_to_the_viewers_right) {
    add_files(lab, PANELS "/set-b/*.txt");
    lab_import(lab);
    assert_int_equal(lab->set.count, 25);
    assert_false(lab_noted(lab, "azimuth 0 is taken"));
    assert_false(lab_noted(lab, "luminances are taken"));
    int holes = 0;
    for (int i = 0; i < lab->set.count; i++) {
        holes += compare_matrices(lab, &lab->set.table[i]);
        assert_int_equal(lab->set.table[i].rows + lab->set.table[i].masked, 23 * 36);
    }
    assert_int_equal(holes, 25);
    lab_declare(lab, "azimuth_sense", "ccw");
    assert_false(lab_run(lab));
    assert_non_null(strstr(lab->err.text, "--azimuth-sense"));
}

/* Both sets are of one display: their luminances agree where their grids meet. */
LAB_TEST(both_sets_show_the_same_display) {
    add_files(lab, PANELS "/set-a/[RGBK]_*.csv");
    lab_import(lab);
    ImportSet a = lab->set;
    lab->count = 0;
    add_files(lab, PANELS "/set-b/*.txt");
    lab_import(lab);
    double sum = 0;
    int count = 0;
    for (int i = 0; i < a.count; i++) {
        const ImportTable *one = &a.table[i], *other = lab_table(lab, one->source, one->level);
        for (int r = 0; r < one->rows; r += 7) {
            double theta = one->theta_deg[r], phi = one->phi_deg[r];
            for (int k = 0; k < other->rows; k++)
                if (theta > 0 && other->theta_deg[k] == theta && other->phi_deg[k] == phi) {
                    sum += fabs(log(other->value[3 * k + 1] / one->value[3 * r + 1])) > 0.06;
                    count++;
                }
        }
    }
    assert_true(count > 500);
    assert_true(sum < 0.02 * count); /* hot pixels */
}

/* ---- others ------------------------------------------------------------------------------ */

LAB_TEST(a_viewing_angle_table_needs_but_its_role) {
    add_files(lab, DISPLAY "/viewing_angle_oled_phi0_90.csv");
    assert_false(lab_run(lab));
    assert_non_null(strstr(lab->err.text, "--role viewing_angle_oled_phi0_90.csv=red:255"));
    lab_role(lab, "viewing*", "white");
    lab->request->primaries = DISPLAY "/OLED-SonyPVM-2541_primaries.csv";
    lab_import(lab);
    const ImportTable *white = lab_table(lab, IMPORT_WHITE, 255);
    assert_int_equal(white->rows, 242);
    assert_near(lab_value(white, 60, 180, 1), 212.57, 0); /* theta -60 at phi 0 */
    assert_close(lab_value(white, 60, 180, 0), 212.57 * 0.302 / 0.319, 1e-12);
    assert_true(lab->set.spectra.rows > 90);
}

LAB_TEST(every_primaries_file_is_read) {
    static const char *const names[] = {"OLED-SonyPVM-2541", "apple_studio_display_lcd",
                                        "typical_crt_brainard1997"};
    for (int i = 0; i < 3; i++) {
        const char *path = arena_format(&lab->arena, "%s/%s_primaries.csv", DISPLAY, names[i]);
        if (!file_exists(path)) skip();
        lab->set = import_set(&lab->arena);
        if (!primaries_read(path, &lab->set, &lab->err)) fail_msg("%s", lab->err.text);
        assert_near(lab->set.spectra.nm[0], 380, 0);
    }
}

/* A reflectance factor at one leaving direction an incidence is no angular table. */
LAB_TEST(single_directions_are_no_table) {
    add_files(lab, SHARED_DATA_DIR "/bsdf/loft-blacklab/20250210_S7_sample_final.txt");
    lab_declare(lab, "columns", "theta_i,phi_i,theta,phi,386nm,414nm,-,-,-,-,-,-,-,-,-");
    assert_false(lab_run(lab));
    assert_non_null(strstr(lab->err.text, "required: an angular table of at least 3"));
}

TEST_PROGRAM(NULL, NULL)
