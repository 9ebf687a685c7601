/* SPDX-License-Identifier: Apache-2.0 */
/* What a file is: by an option, or by its name. */
#include "lab_fixture.h"

#include "import/set/role.h"

TEST(names_tell_the_pattern_or_the_light) {
    static const struct {
        const char *name;
        ImportSource source;
        double number;
    } cases[] = {{"R_031", IMPORT_RED, 31},
                 {"red_255", IMPORT_RED, 255},
                 {"G127", IMPORT_GREEN, 127},
                 {"B-63 run 2", IMPORT_BLUE, 63},
                 {"K_000", IMPORT_BLACK, 0},
                 {"black", IMPORT_BLACK, 0},
                 {"White", IMPORT_WHITE, 0},
                 {"W_255", IMPORT_WHITE, 0},
                 {"panel7_Blue_16", IMPORT_BLUE, 16},
                 {"red", IMPORT_RED, 255},
                 {"2024-05-17_red_063", IMPORT_RED, 63},
                 {"BRDF_05", IMPORT_REFLECTION, 5},
                 {"i10_w550", IMPORT_REFLECTION, 10},
                 {"sample3 inc45.5", IMPORT_REFLECTION, 45.5},
                 {"brdf_i20", IMPORT_REFLECTION, 20},
                 {"AOI 30 deg", IMPORT_REFLECTION, 30},
                 {"bsdf_60_550nm", IMPORT_REFLECTION, 60},
                 {"BRDF_10_20250211", IMPORT_REFLECTION, 10}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bool mixed;
        Role role = role_from_words(cases[i].name, 255, &mixed);
        if (!role.is_known || mixed || role.source != cases[i].source)
            fail_msg("'%s' is taken as %d", cases[i].name, role.is_known ? (int)role.source : -1);
        if (role.source <= IMPORT_BLUE) assert_near(role.level, cases[i].number, 0);
        if (role.source == IMPORT_REFLECTION) assert_near(role.incidence_deg, cases[i].number, 0);
    }
}

TEST(names_tell_the_rest_too) {
    bool mixed;
    Role role = role_from_words("i10_a45_w550", 255, &mixed);
    assert_true(role.has_azimuth);
    assert_near(role.azimuth_deg, 45, 0);
    assert_near(role.wavelength_nm, 550, 0);
    role = role_from_words("brdf_30_632.8nm", 255, &mixed);
    assert_near(role.wavelength_nm, 632.8, 0);
    assert_near(role_from_words("R_1023", 1023, &mixed).level, 1023, 0);
}

TEST(what_a_name_does_not_tell_is_not_guessed) {
    static const struct {
        const char *name;
        bool is_ambiguous;
    } cases[] = {{"measurement 12", false}, {"truth_emission", false}, {"R", false},
                 {"oled_phi0_90", false},   {"red_and_blue", true},    {"R2_G_255 b31", true},
                 {"BRDF_20-90", true},      {"R_1023", true},          {"white_128", true},
                 {"red_0", true},           {"brdf_20_i30", true},     {"black_12", true},
                 {"black_i20", true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bool mixed;
        Role role = role_from_words(cases[i].name, 255, &mixed);
        if (role.is_known && !mixed) fail_msg("'%s' is taken as told", cases[i].name);
        if (mixed != cases[i].is_ambiguous) fail_msg("'%s'", cases[i].name);
    }
}

TEST(a_role_is_written_with_colons) {
    Role role;
    Error err = {0};
    assert_true(role_parse("red:127:X", 255, &role, &err));
    assert_int_equal(role.source, IMPORT_RED);
    assert_near(role.level, 127, 0);
    assert_int_equal(role.component, 'X');
    assert_true(role_parse("brdf:20:90:550", 255, &role, &err));
    assert_near(role.incidence_deg, 20, 0);
    assert_near(role.azimuth_deg, 90, 0);
    assert_near(role.wavelength_nm, 550, 0);
    assert_true(role_parse("skip", 255, &role, &err) && role.is_skipped);
    static const char *const wrong[] = {"",           "rot",         "red:",
                                        "red:0",      "red:256",     "red:12:W",
                                        "red:12:X:1", "black:12",    "brdf:x",
                                        "brdf:90",    "brdf:10:400", "brdf:10:0:50",
                                        "dark",       "skip:1",      "brdf:10:0:550:1",
                                        "reference"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        if (role_parse(wrong[i], 255, &role, &err)) fail_msg("'%s' is taken", wrong[i]);
        assert_int_equal(err.code, ERROR_USAGE);
        assert_non_null(strstr(err.text, "required: red, green or blue with :LEVEL"));
    }
}

#define TABLE "theta,phi,X,Y,Z\n0,0,1,2,3\n10,0,1,2,3\n20,0,1,2,3\n"

LAB_TEST(a_file_that_does_not_tell_is_named_with_the_option) {
    lab_write(lab, "m1.csv", TABLE);
    lab_refused(lab, "m1.csv: does not tell by its name which pattern it "
                     "shows — say it with --role m1.csv=red:255 (or green, blue, black, "
                     "white)");
    lab_write(lab, "m1.csv", "theta,phi,550nm\n0,0,1\n10,0,1\n20,0,1\n");
    lab_refused(lab, "m1.csv: does not tell by its name the light's angle of "
                     "incidence — say it with --role m1.csv=brdf:INCIDENCE");
    lab_role(lab, "m1.csv", "red:255");
    lab_refused(lab, "m1.csv: holds reflection, and its role is 'red:255'");
    lab_write(lab, "BRDF_20-90.csv", "theta,phi,550nm\n0,0,1\n10,0,1\n20,0,1\n");
    lab->file[0] = lab->file[1];
    lab->count = 1;
    lab_refused(lab, "BRDF_20-90.csv: tells more than one angle of incidence — say it with "
                     "--role BRDF_20-90.csv=brdf:INCIDENCE");
}

LAB_TEST(one_message_counts_all_refused_files) {
    lab_write(lab, "m1.csv", TABLE);
    lab_write(lab, "white.csv", TABLE);
    lab_write(lab, "m2.csv", TABLE);
    lab_write(lab, "m3.csv", TABLE);
    lab_refused(lab, "m1.csv: does not tell by its name which pattern it "
                     "shows — say it with --role m1.csv=red:255 (or green, blue, black, "
                     "white); 2 more files are refused");
}

LAB_TEST(levels_scale_from_the_panels_highest_code) {
    lab_declare(lab, "level_max", "1023");
    lab->request->black_is_zero = true;
    lab_write(lab, "R_1023.csv", TABLE);
    lab_write(lab, "R_341.csv", TABLE);
    lab_write(lab, "G_1023.csv", TABLE);
    lab_write(lab, "B_1023.csv", TABLE);
    lab_import(lab);
    lab_table(lab, IMPORT_RED, 85);
    lab_table(lab, IMPORT_RED, 255);
}

LAB_TEST(files_are_left_out_as_asked) {
    lab_write(lab, "white.csv", TABLE);
    lab_write(lab, "truth_1.csv", "no table\n");
    lab_write(lab, "notes.txt", "no table\n");
    lab_role(lab, "notes.txt", "skip");
    lab->request->skip.text[lab->request->skip.count++] = "truth_*";
    lab_import(lab);
    assert_true(lab_noted(lab, "2 files were left out as asked"));
}

TEST_PROGRAM(NULL, NULL)
