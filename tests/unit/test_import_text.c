/* SPDX-License-Identifier: Apache-2.0 */
/* Text tables in the layouts that laboratories have, as values at directions of the set. */
#include "base/count.h"
#include "lab_fixture.h"

/* White at four directions, a list as this project writes it. */
#define WHITE "theta,phi,X,Y,Z\n0,0,95,100,109\n30,0,85,90,98\n30,90,75,80,87\n30,180,65,70,76\n"

static void check_white(const Lab *lab) {
    const ImportTable *white = lab_table(lab, IMPORT_WHITE, 255);
    assert_int_equal(white->rows, 4);
    assert_int_equal(white->channels, 3);
    assert_near(lab_value(white, 0, 0, 1), 100, 0);
    assert_near(lab_value(white, 30, 0, 0), 85, 0);
    assert_near(lab_value(white, 30, 90, 1), 80, 0);
    assert_near(lab_value(white, 30, 180, 2), 76, 0);
}

static void import_white(Lab *lab, const char *text) {
    lab_write(lab, "white.csv", text);
    lab_import(lab);
}

/* ---- how numbers are written ------------------------------------------------------------- */

LAB_TEST(delimiters_and_decimal_signs_are_found) {
    static const char *const texts[] = {
        WHITE,
        "theta;phi;X;Y;Z\r\n0;0;95,0;100,0;109,0\r\n30;0;85,0;90;98\r\n30;90;75;80;87\r\n"
        "30;180;65;70;76\r\n",
        "theta\tphi\tX\tY\tZ\n0\t0\t95\t100\t109\n30\t0\t85\t90\t98\n30\t90\t75\t80\t87\n"
        "30\t180\t65\t70\t76\n",
        "theta phi X Y Z\n 0   0 95 100 109\n30   0 85  90  98\n30  90 75  80  87\n"
        "30 180 65  70  76\n",
        "theta phi X Y Z\n0,0 0,0 95,0 100,0 109,0\n30,0 0,0 85,0 90,0 98,0\n"
        "30,0 90,0 75,0 80,0 87,0\n30,0 180,0 65,0 70,0 76,0\n",
        "theta, phi, X, Y, Z\n0, 0, 95, 100, 109\n30, 0, 85, 90, 98\n30, 90, 75, 80, 87\n"
        "30, 180, 65, 70, 76\n",
        "\"theta\",\"phi\",\"X\",\"Y\",\"Z\"\n\"0\",\"0\",\"9.5e1\",\"1E+02\",\"109\"\n"
        "30,0,85,90,98\n30,90,75,80,87\n30,180,65,70,76\n",
        "theta,phi,X,Y,Z\n\"0,0\",\"0,0\",\"95,0\",\"100,0\",\"109,0\"\n\"30,0\",\"0\","
        "\"85,0\",\"90,0\",\"98,0\"\n30,90,75,80,87\n30,180,\"65,0\",70,76\n",
        "theta;phi;X;Y;Z;\n0;0;95;100;109;\n30;0;85;90;98;\n30;90;75;80;87;\n30;180;65;70;76;"
        "\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        import_white(lab, texts[i]);
        check_white(lab);
    }
}

LAB_TEST(encodings_are_found) {
    static const char latin[] = "# Leuchtdichte in cd/m\xB2\n" WHITE;
    static const char marked[] = "\xEF\xBB\xBF" WHITE;
    char wide[2][2 * sizeof WHITE];
    memcpy(wide[0], "\xFF\xFE", 2);
    memcpy(wide[1], "\xFE\xFF", 2);
    for (size_t i = 0; i < sizeof WHITE - 1; i++) {
        wide[0][2 + 2 * i] = WHITE[i];
        wide[0][3 + 2 * i] = 0;
        wide[1][2 + 2 * i] = 0;
        wide[1][3 + 2 * i] = WHITE[i];
    }
    import_white(lab, WHITE "\x1A");
    check_white(lab);
    import_white(lab, latin);
    check_white(lab);
    import_white(lab, marked);
    check_white(lab);
    for (int i = 0; i < 2; i++) {
        lab_write_bytes(lab, "white.csv", wide[i], sizeof wide[i]);
        lab_import(lab);
        check_white(lab);
        lab_write_bytes(lab, "white.csv", wide[i] + 2, sizeof wide[i] - 2); /* without its mark */
        lab_refused(lab, "white.csv: holds zero bytes, as UTF-16 without its mark — say "
                         "--encoding utf-16le or utf-16be");
        lab_declare(lab, "encoding", i ? "utf-16be" : "utf-16le");
        lab_import(lab);
        check_white(lab);
        lab->request->text.encoding = ENCODING_AUTO;
    }
}

LAB_TEST(comments_and_lines_before_the_header_are_passed_over) {
    import_white(lab,
                 "! a comment\n% another\n// a third\n\nSerial 17, batch 2\n\n" WHITE "# end\n");
    check_white(lab);
    lab_declare(lab, "comment", "REM");
    lab_declare(lab, "skip_lines", "2");
    import_white(lab, "1,2,3,4,5\n6,7,8,9,10\nREM 1,2\n" WHITE);
    check_white(lab);
}

/* ---- columns ----------------------------------------------------------------------------- */

LAB_TEST(columns_stand_in_any_order_and_others_are_left) {
    import_white(lab, "no,Z,Azimuth (deg),when,Y [cd/m2],Inclination [deg],X\n"
                      "1,109,0,10:31,100,0,95\n2,98,0,10:32,90,30,85\n3,87,90,10:33,80,30,75\n"
                      "4,76,180,10:34,70,30,65\n");
    check_white(lab);
    assert_true(lab_noted(lab, "2 columns with other names are not used"));
    lab_declare(lab, "columns", "theta,phi,-,X,Y,Z");
    import_white(lab, "0,0,7,95,100,109\n30,0,7,85,90,98\n30,90,7,75,80,87\n30,180,7,65,70,"
                      "76\n");
    check_white(lab);
}

/* CIE 15: X = Y x/y, Z = Y (1-x-y)/y; X = 9 Y u'/(4v'), Z = Y (12-3u'-20v')/(4v'). */
LAB_TEST(chromaticities_become_tristimulus_values) {
    import_white(lab, "theta,phi,Y,x,y\n0,0,100,0.3,0.4\n10,0,50,0.25,0.5\n20,0,0,0,0\n");
    const ImportTable *white = lab_table(lab, IMPORT_WHITE, 255);
    assert_close(lab_value(white, 0, 0, 0), 75, 1e-12);
    assert_close(lab_value(white, 0, 0, 2), 75, 1e-12);
    assert_close(lab_value(white, 10, 0, 0), 25, 1e-12);
    assert_near(lab_value(white, 20, 0, 0), 0, 0);
    import_white(lab, "theta,phi,L,u',v'\n0,0,100,0.2,0.5\n10,0,50,0.2,0.45\n20,0,10,.2,.5\n");
    white = lab_table(lab, IMPORT_WHITE, 255);
    assert_close(lab_value(white, 0, 0, 0), 90, 1e-12);
    assert_close(lab_value(white, 0, 0, 2), 70, 1e-12);
    double x = 9 * 0.2 / (6 * 0.2 - 16 * 0.5 + 12), y = 4 * 0.5 / (6 * 0.2 - 16 * 0.5 + 12);
    assert_close(lab_value(white, 0, 0, 0) / 100, x / y, 1e-12);
}

LAB_TEST(luminance_alone_has_the_colour_of_the_spectra_or_of_daylight) {
    import_white(lab, "theta,phi,L\n0,0,100\n10,0,90\n20,0,80\n");
    const ImportTable *white = lab_table(lab, IMPORT_WHITE, 255);
    assert_close(lab_value(white, 10, 0, 0), 0.95047 * 90, 1e-9);
    assert_close(lab_value(white, 10, 0, 1), 90, 0);
    assert_true(lab_noted(lab, "taken as D65"));
    const char *spectra = arena_format(&lab->arena, "%s/spectra.csv", lab->folder);
    lab_write(lab, "spectra.csv",
              "wavelength_nm,R,G,B\n599,0,0,0\n600,1,0,0\n601,0,0,0\n"
              "650,0,1,0\n660,0,0,1\n661,0,0,0\n");
    lab->count = 0;
    lab->request->primaries = spectra;
    for (int p = 0; p < 4; p++) {
        static const char *const names[] = {"red_255.csv", "green_255.csv", "blue_255.csv",
                                            "black.csv"};
        lab_write(lab, names[p], "theta,phi,L\n0,0,100\n10,0,90\n20,0,80\n");
    }
    lab_import(lab);
    const ImportTable *red = lab_table(lab, IMPORT_RED, 255);
    assert_close(lab_value(red, 0, 0, 0) / 100, 1.0622 / 0.631, 1e-3); /* CIE 1931 at 600 nm */
    assert_true(lab_noted(lab, "that of the primaries' spectra"));
    assert_int_equal(lab->set.spectra.rows, 6);
}

LAB_TEST(units_of_luminance_become_candela_a_square_metre) {
    static const struct {
        const char *header;
        double factor;
    } cases[] = {{"theta,phi,L (cd/m2)", 1},       {"theta,phi,L [nit]", 1},
                 {"theta,phi,L_fL", 3.4262590996}, {"theta,phi,Luminance [kcd/m\xC2\xB2]", 1000},
                 {"theta,phi,Lv (cd/m^2)", 1},     {"theta,phi,L (cd/ft2)", 10.763910417}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        import_white(lab,
                     arena_format(&lab->arena, "%s\n0,0,10\n5,0,9\n10,0,8\n", cases[i].header));
        assert_close(lab_value(lab_table(lab, IMPORT_WHITE, 255), 0, 0, 1), 10 * cases[i].factor,
                     1e-9);
    }
    lab_write(lab, "white.csv", "theta;phi;L\ndeg;deg;fL\n0;0;10\n5;0;9\n9;0;8\n");
    lab_refused(lab, "white.csv: line 2: stands between the header and its numbers — leave it out "
                     "with --comment, and say the units it may hold with --unit and --angle-unit");
    import_white(lab,
                 "Unit: fL\nInclination;Azimuth;L\n0\xC2\xB0;0\xC2\xB0;10\n5\xC2\xB0;0;9\n9;0;8\n");
    assert_close(lab_value(lab_table(lab, IMPORT_WHITE, 255), 0, 0, 1), 34.262590996, 1e-9);
    lab_declare(lab, "unit", "fL");
    import_white(lab, "theta,phi,L\n0,0,10\n5,0,9\n10,0,8\n");
    assert_close(lab_value(lab_table(lab, IMPORT_WHITE, 255), 0, 0, 1), 34.262590996, 1e-9);
}

/* ---- angles ------------------------------------------------------------------------------ */

LAB_TEST(azimuths_are_turned_to_the_viewers_right) {
    static const struct {
        const char *zero, *sense, *side;
        double phi_of_30;
    } cases[] = {{"right", "ccw", "viewer", 30},   {"top", "cw", "viewer", 60},
                 {"top", "ccw", "viewer", 120},    {"left", "cw", "viewer", 150},
                 {"bottom", "ccw", "viewer", 300}, {"45", "ccw", "viewer", 75},
                 {"top", "cw", "behind", 120},     {"right", "ccw", "behind", 150}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lab_declare(lab, "azimuth_zero", cases[i].zero);
        lab_declare(lab, "azimuth_sense", cases[i].sense);
        lab_declare(lab, "azimuth_seen_from", cases[i].side);
        import_white(lab, "theta,phi,X,Y,Z\n0,0,1,2,3\n40,30,4,5,6\n-40,30,7,8,9\n");
        const ImportTable *white = lab_table(lab, IMPORT_WHITE, 255);
        assert_near(lab_value(white, 40, cases[i].phi_of_30, 1), 5, 0);
        assert_near(lab_value(white, 40, cases[i].phi_of_30 + 180, 1), 8, 0);
    }
}

LAB_TEST(a_file_says_its_own_azimuths_and_units) {
    import_white(lab, "[Conoscope export]\nAzimuth;0 = 12 o'clock; clockwise\nUnit;fL\n\n"
                      "theta;phi;X;Y;Z\n0;0;1;2;3\n40;30;4;5;6\n40;60;7;8;9\n");
    assert_close(lab_value(lab_table(lab, IMPORT_WHITE, 255), 40, 60, 1), 5 * 3.4262590996, 1e-9);
    assert_false(lab_noted(lab, "azimuth 0 is taken"));
    import_white(lab, "theta;phi;X;Y;Z\n0;0;1;2;3\n40;30;4;5;6\n40;60;7;8;9\n");
    assert_true(lab_noted(lab, "azimuth 0 is taken to point right"));
    assert_true(lab_noted(lab, "luminances are taken in cd/m2"));
}

LAB_TEST(radians_are_told_from_degrees_by_their_name) {
    import_white(lab, "theta_rad,phi_rad,X,Y,Z\n0,0,1,2,3\n0.5235987755982988,"
                      "1.5707963267948966,4,5,6\n0.1,0,7,8,9\n");
    assert_near(lab_value(lab_table(lab, IMPORT_WHITE, 255), 30, 90, 1), 5, 0);
    lab_declare(lab, "angle_unit", "deg");
    import_white(lab, "theta,phi,X,Y,Z\n0,0,1,2,3\n0.5,90,4,5,6\n1.5,0,7,8,9\n");
    assert_near(lab_value(lab_table(lab, IMPORT_WHITE, 255), 0.5, 90, 1), 5, 0);
}

/* Directions of closed form: on the axes all conventions agree; off them each has its own. */
LAB_TEST(horizontal_and_vertical_angles_become_theta_and_phi) {
    static const struct {
        const char *angles;
        double theta, phi;
    } cases[] = {
        {"projected", 0, 45}, {"equidistant", 0, 45}, {"north-polar", 0, 0}, {"east-polar", 0, 0}};
    double r = 3.14159265358979323846 / 180, h = 30 * r, v = 30 * r;
    double theta[4], phi[4];
    theta[0] = atan(hypot(tan(h), tan(v))) / r, phi[0] = 45;
    theta[1] = hypot(30, 30), phi[1] = 45;
    theta[2] = acos(cos(v) * cos(h)) / r, phi[2] = atan2(sin(v), cos(v) * sin(h)) / r;
    theta[3] = acos(cos(v) * cos(h)) / r, phi[3] = atan2(cos(h) * sin(v), sin(h)) / r;
    for (int i = 0; i < 4; i++) {
        lab_declare(lab, "angles", cases[i].angles);
        import_white(lab, "theta_H,theta_V,X,Y,Z\n20,0,1,2,3\n0,20,4,5,6\n30,30,7,8,9\n"
                          "-20,0,10,11,12\n");
        const ImportTable *white = lab_table(lab, IMPORT_WHITE, 255);
        assert_near(lab_value(white, 20, 0, 1), 2, 0);
        assert_near(lab_value(white, 20, 90, 1), 5, 0);
        assert_near(lab_value(white, 20, 180, 1), 11, 0);
        assert_near(lab_value(white, theta[i], phi[i], 1), 8, 0);
    }
}

/* ---- matrices ---------------------------------------------------------------------------- */

LAB_TEST(matrices_read_down_and_across) {
    import_white(lab, "[X]\ntheta\\phi;0;90;180;\n0;1;1;1;\n30;2;3;4;\n\n"
                      "[Y]\ntheta\\phi;0;90;180;\n0;10;10;10;\n30;20;30;40;\n\n"
                      "[Z]\ntheta\\phi;0;90;180;\n0;100;100;100;\n30;200;300;400;\n");
    const ImportTable *white = lab_table(lab, IMPORT_WHITE, 255);
    assert_int_equal(white->rows, 6);
    for (int k = 0; k < 3; k++) {
        assert_near(lab_value(white, 30, 90 * k, 0), 2 + k, 0);
        assert_near(lab_value(white, 30, 90 * k, 1), 20 + 10 * k, 0);
        assert_near(lab_value(white, 30, 90 * k, 2), 200 + 100 * k, 0);
    }
    import_white(lab, "Luminance (cd/m2)\nphi/theta,0,30\n0,10,20\n90,10,30\n180,10,40\n");
    white = lab_table(lab, IMPORT_WHITE, 255);
    assert_near(lab_value(white, 30, 180, 1), 40, 0);
    assert_near(lab_value(white, 0, 0, 1), 10, 0);
}

LAB_TEST(a_matrix_without_names_is_told_by_options) {
    lab_declare(lab, "quantity", "L");
    lab_declare(lab, "table", "theta-down");
    import_white(lab, ",0,120,240\n0,10,10,10\n30,20,30,40\n");
    assert_near(lab_value(lab_table(lab, IMPORT_WHITE, 255), 30, 240, 1), 40, 0);
    lab_declare(lab, "table", "phi-down");
    import_white(lab, ",0,30\n0,10,20\n120,10,30\n240,10,40\n");
    assert_near(lab_value(lab_table(lab, IMPORT_WHITE, 255), 30, 240, 1), 40, 0);
    import_white(lab, "0,0,30\n0,10,20\n40,10,30\n80,10,40\n");
    assert_near(lab_value(lab_table(lab, IMPORT_WHITE, 255), 30, 80, 1), 40, 0);
}

LAB_TEST(a_matrix_may_have_horizontal_and_vertical_angles) {
    lab_declare(lab, "angles", "equidistant");
    import_white(lab, "[L]\ntheta_V\\theta_H;-30;0;40\n-20;1;2;3\n0;4;5;6\n");
    const ImportTable *white = lab_table(lab, IMPORT_WHITE, 255);
    assert_near(lab_value(white, 40, 0, 1), 6, 0);
    assert_near(lab_value(white, 30, 180, 1), 4, 0);
    assert_near(lab_value(white, 20, 270, 1), 2, 0);
    lab_declare(lab, "table", "horizontal-down");
    import_white(lab, "[L]\n;-20;0\n-30;1;4\n0;2;5\n40;3;6\n");
    assert_near(lab_value(lab_table(lab, IMPORT_WHITE, 255), 40, 0, 1), 6, 0);
    assert_near(lab_value(lab_table(lab, IMPORT_WHITE, 255), 20, 270, 1), 2, 0);
}

LAB_TEST(one_file_a_component_is_joined) {
    static const char matrix[] = "theta\\phi,0,120,240\n0,1,1,1\n30,2,3,4\n";
    lab_write(lab, "one.csv", matrix);
    lab_write(lab, "two.csv", matrix);
    lab_write(lab, "tristimulus.csv", matrix);
    lab_role(lab, "one.csv", "white:X");
    lab_role(lab, "two.csv", "white:Y");
    lab_role(lab, "tri*.csv", "white:Z");
    lab_import(lab);
    assert_int_equal(lab->set.count, 1);
    assert_near(lab_value(lab_table(lab, IMPORT_WHITE, 255), 30, 240, 2), 4, 0);
}

/* ---- what was not measured --------------------------------------------------------------- */

LAB_TEST(marks_are_left_out_and_counted) {
    lab_declare(lab, "mask", "-999");
    import_white(lab, "theta;phi;X;Y;Z\n0;0;1;2;3\n10;0;---;5;6\n10;90;NaN;;6\n"
                      "10;180;4;5;n/a\n10;270;4;-999;6\n20;0;4;5;6\n20;90;4;5;6\n");
    const ImportTable *white = lab_table(lab, IMPORT_WHITE, 255);
    assert_int_equal(white->rows, 3);
    assert_int_equal(white->masked, 4);
    assert_near(white->masked_theta_deg[3], 10, 0);
    assert_near(white->masked_phi_deg[3], 270, 0);
}

LAB_TEST(directions_beyond_the_horizon_are_left_out_and_told) {
    import_white(lab, "theta,phi,L\n0,0,3\n80,0,2\n90,0,1\n100,0,1\n180,0,1\n");
    assert_int_equal(lab_table(lab, IMPORT_WHITE, 255)->rows, 3);
    assert_true(lab_noted(lab, "2 of 5 directions lie beyond 90 degrees"));
}

LAB_TEST(a_direction_that_stands_twice_becomes_the_mean) {
    import_white(lab, "theta,phi,X,Y,Z\n0,0,1,2,3\n0,90,1,2,3\n30,0,10,20,30\n30,360,12,24,36\n"
                      "30,90,5,6,7\n");
    const ImportTable *white = lab_table(lab, IMPORT_WHITE, 255);
    assert_int_equal(white->rows, 4); /* the pole's rows stay: the set takes their mean */
    assert_near(lab_value(white, 30, 0, 1), 22, 0);
    assert_true(lab_noted(lab, "1 directions of 1 tables stood more than once and disagree by "
                               "up to 17 % (white.csv, theta 30, phi 0; its second values"));
}

/* A second run of another scale is no noise; one that is noisy is. */
LAB_TEST(two_runs_are_of_one_scale) {
    static const double scales[] = {0.5, 0.75, 0.85, 1.1, 2, 1};
    for (int run = 0; run < COUNT_OF(scales); run++) {
        const char *text = "theta,phi,L\n0,0,100\n";
        for (int i = 0; i < 24; i++) {
            double noise = run == 5 && i >= 12 ? (i % 2 ? 0.75 : 1.25) : 1;
            text = arena_format(&lab->arena, "%s%d,%d,%g\n", text, i % 12 < 6 ? 30 : 60, i % 6 * 60,
                                80 * noise * (i < 12 ? 1 : scales[run]));
        }
        lab_write(lab, "white.csv", text);
        if (scales[run] == 1.1 || scales[run] == 1) lab_import(lab);
        else
            lab_refused(lab, arena_format(&lab->arena,
                                          "white.csv: 12 directions stand more "
                                          "than once, with %g times the light when they stand "
                                          "again: required within 10 %% — leave one run out, "
                                          "or say --accept for their mean",
                                          scales[run]));
    }
}

/* What contradicts itself is refused by its place, unless the user takes the mean. */
LAB_TEST(a_direction_that_contradicts_itself_is_refused_or_accepted) {
    static const struct {
        const char *rows, *words;
    } cases[] = {
        {"30,0,80\n30,0,30\n30,180,80\n",
         "theta 30, phi 0 stands more than once, and its "
         "values are 62.5 % apart: required within 50 % (of what is at least 5 % of the "
         "table's largest) — leave one out, or say --accept for their mean"},
        {"0,90,40\n30,0,80\n", "theta 0, phi 90 stands more than once, and its values are "
                               "60 %"},
        {"30,0,80\n30,0,60\n30,180,80\n", NULL},
        {"30,0,80\n60,0,1\n60,0,3\n60,180,2\n", NULL}, /* dim beside the table's largest */
    };
    for (int i = 0; i < COUNT_OF(cases); i++) {
        lab->request->accepts_repeats = false;
        lab_write(lab, "white.csv",
                  arena_format(&lab->arena, "theta,phi,L\n0,0,100\n%s", cases[i].rows));
        if (!cases[i].words) {
            lab_import(lab);
            continue;
        }
        assert_false(lab_run(lab));
        assert_error_has(&lab->err, cases[i].words);
        lab->request->accepts_repeats = true;
        lab_import(lab);
    }
}

/* ---- sections ---------------------------------------------------------------------------- */

LAB_TEST(sections_of_one_pattern_make_one_table) {
    lab_declare(lab, "section", "*_hor*=0");
    lab_declare(lab, "section", "*_ver*=90");
    lab_declare(lab, "azimuth_zero", "left");
    lab_write(lab, "white_hor.txt", "theta\tL\n-40\t4\n-20\t5\n0\t6\n20\t---\n");
    lab_write(lab, "white_ver.txt", "theta\tL\n-40\t7\n0\t6\n40\t8\n");
    lab_import(lab);
    assert_int_equal(lab->set.count, 1);
    const ImportTable *white = lab_table(lab, IMPORT_WHITE, 255);
    assert_int_equal(white->rows, 6);
    assert_int_equal(white->masked, 1);
    assert_near(lab_value(white, 40, 0, 1), 4, 0); /* 0 is left, and the angle negative */
    assert_near(lab_value(white, 40, 90, 1), 7, 0);
    assert_near(lab_value(white, 40, 270, 1), 8, 0);
    assert_near(white->masked_phi_deg[0], 180, 0);
    lab->request->text.section.count = 0;
    lab_refused(lab, "white_hor.txt: header line: has theta but no azimuth — say the section's "
                     "azimuth with --section white_hor.txt=DEG; 1 more file is refused");
}

/* ---- reflection -------------------------------------------------------------------------- */

#define BRDF "theta,phi,450nm,550nm\n0,0,1,2\n30,0,3,4\n30,90,5,6\n60,180,7,8\n"

LAB_TEST(reflection_has_a_column_a_wavelength) {
    lab_write(lab, "BRDF_20.csv", "theta,phi,550 nm,R_450nm\n0,0,2,1\n30,0,4,3\n30,90,6,5\n");
    lab_write(lab, "BRDF_40.csv", BRDF);
    lab_import(lab);
    const ImportTable *table = lab_table(lab, IMPORT_REFLECTION, 20);
    assert_int_equal(lab->set.count, 2);
    assert_near(table->wavelength_nm[0], 450, 0);
    assert_near(lab_value(table, 30, 90, 0), 5, 0);
    assert_near(lab_value(table, 30, 90, 1), 6, 0);
    assert_near(table->incidence_phi_deg, 180, 0);
    assert_false(lab->set.is_anisotropic);
    assert_true(lab_noted(lab, "count from the mirror direction"));
}

LAB_TEST(one_file_a_wavelength_is_joined) {
    lab_write(lab, "i10_w550.csv", "theta,phi,brdf\n0,0,2\n30,0,4\n30,90,6\n");
    lab_write(lab, "i10_w450.csv", "theta,phi,brdf\n0,0,1\n30,0,3\n30,90,5\n");
    lab_import(lab);
    const ImportTable *table = lab_table(lab, IMPORT_REFLECTION, 10);
    assert_int_equal(lab->set.count, 1);
    assert_int_equal(table->channels, 2);
    assert_near(lab_value(table, 30, 90, 0), 5, 0);
    assert_near(lab_value(table, 30, 90, 1), 6, 0);
}

LAB_TEST(long_lists_are_cut_into_tables) {
    lab_write(lab, "all.csv",
              "theta_i,phi_i,theta,phi,wavelength,brdf\n"
              "0,0,0,0,450,1\n0,0,10,0,450,2\n0,0,20,0,450,3\n"
              "0,0,0,0,550,4\n0,0,10,0,550,5\n0,0,20,0,550,6\n"
              "30,0,0,0,450,7\n30,0,10,20,450,8\n30,0,20,0,450,9\n"
              "30,0,0,0,550,10\n30,0,10,20,550,11\n30,0,20,0,550,12\n");
    lab_write(lab, "codes.csv",
              "R,G,B,theta,phi,X,Y,Z\n"
              "0,0,0,0,0,1,1,1\n0,0,0,10,0,1,1,1\n0,0,0,20,0,1,1,1\n"
              "255,0,0,0,0,2,2,2\n255,0,0,10,0,2,2,2\n255,0,0,20,0,2,2,2\n"
              "127,0,0,0,0,3,3,3\n127,0,0,10,0,3,3,3\n127,0,0,20,0,3,3,3\n"
              "0,255,0,0,0,4,4,4\n0,255,0,10,0,4,4,4\n0,255,0,20,0,4,4,4\n"
              "0,0,255,0,0,5,5,5\n0,0,255,10,0,5,5,5\n0,0,255,20,0,5,5,5\n");
    lab_import(lab);
    assert_int_equal(lab->set.count, 7);
    /* The light is at phi 0, so the mirror direction, where phi counts from, is at 180. */
    const ImportTable *table = lab_table(lab, IMPORT_REFLECTION, 30);
    assert_near(lab_value(table, 10, 200, 1), 11, 0);
    assert_near(lab_value(lab_table(lab, IMPORT_RED, 127), 10, 0, 1), 3, 0);
    assert_near(lab_value(lab_table(lab, IMPORT_BLACK, 0), 10, 0, 1), 1, 0);
}

LAB_TEST(scatter_units_become_brdf) {
    double pi = 3.14159265358979323846;
    static const char *const units[] = {"brdf", "brdf-cos", "factor"};
    double wanted[] = {0.5, 0.5 / cos(60 * pi / 180), 0.5 * 0.98 / pi};
    for (int i = 0; i < 3; i++) {
        lab_declare(lab, "unit", units[i]);
        lab_declare(lab, "white_reflectance", "0.98");
        lab_write(lab, "BRDF_20.csv", "theta,phi,550nm\n0,0,1\n30,0,1\n60,0,0.5\n");
        lab_import(lab);
        assert_close(lab_value(lab_table(lab, IMPORT_REFLECTION, 20), 60, 0, 0), wanted[i], 1e-12);
    }
}

LAB_TEST(azimuths_of_the_light_make_an_anisotropic_set) {
    static const char table[] = "theta,phi,550nm\n0,0,1\n30,180,9\n30,270,3\n60,0,4\n";
    lab_write(lab, "i0.csv", table);
    lab_write(lab, "i30_a0.csv", table);
    lab_write(lab, "i30_a90.csv", table);
    lab_import(lab);
    assert_true(lab->set.is_anisotropic);
    assert_int_equal(lab->set.count, 4);
    for (int i = 0; i < lab->set.count; i++) {
        const ImportTable *one = &lab->set.table[i];
        double mirror = one->incidence_phi_deg + 180;
        assert_near(lab_value(one, 30, 180 - mirror, 0), 9, 0);
    }
    lab->request->is_isotropic = true;
    lab_refused(lab, "i30_a90.csv: has light from incidence 30, azimuth 180 degrees at 550 nm, "
                     "and so has i30_a0.csv");
}

TEST_PROGRAM(NULL, NULL)
