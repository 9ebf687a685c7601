/* SPDX-License-Identifier: Apache-2.0 */
/* Gamma tables beside a set of white alone: laws of the curves, the way round from a known
 * panel, and every table that is refused, by its words. */
#include "panel_fixture.h"

#include "panel/query/panel_emission.h"
#include "panel/set/level_table.h"
#include "panel/shape/panel_levels.h"
#include "text/text.h"

/* ---- reading ---------------------------------------------------------------------------- */

static LevelTable read_table(Arena *arena, const char *text) {
    LevelTable table;
    const char *path = in_folder("levels.csv");
    write_text(path, text);
    assert_done(level_table_read(path, 0, arena, &table, &err));
    return table;
}

ARENA_TEST(codes_and_shares_are_one_table) {
    static const char *const same[] = {
        "level,luminance_cd_m2\n0,1\n51,3\n255,101\n",
        "# a comment\nCode;Y;x;y\n0;1;.3;.3\n51;3;.3;.3\n255;101;.3;.3\n",
        "grey level,Lv (cd/m2)\n1,101\n0.2,3\n0,1\n",
        "\xEF\xBB\xBFgrey\twhite\n1\t101\n0\t1\n\n.2\t3\n",
        "step,level,L,time_s\n0,0,1,9\n1,51,3,9\n2,255,101,9\n",
    };
    for (int i = 0; i < 5; i++) {
        LevelTable table = read_table(&arena, same[i]);
        assert_int_equal(table.rows, 3);
        assert_near(table.level[1], 51, 1e-5);
        assert_near(table.level[2], 255, 0);
        assert_near(table.black_share, 1.0 / 101, 1e-9);
        assert_near(table.curve[2].level[0], 51, 1e-5);
        assert_near(table.curve[2].share[0], 0.02, 1e-7);
        assert_true(table.has_white && !table.has_primaries && table.has_black);
    }
}

/* 10, 12 and 16 bits, and a highest code that is stated; luminance that ends at 1 is relative. */
ARENA_TEST(codes_of_more_bits_and_relative_luminance_are_one_table) {
    static const struct {
        const char *text;
        double level_max;
        bool is_relative;
    } same[] = {
        {"code,L\n0,1\n204.6,3\n1023,101\n", 0, false},
        {"code,L\n0,1\n204.6,3\n1023,101\n", 1023, false},
        {"code,L\n0,1\n819,3\n4095,101\n", 0, false},
        {"code,L\n0,1\n13107,3\n65535,101\n", 0, false},
        {"code,L\n0,1\n200,3\n1000,101\n", 1000, false},
        {"level,L\n0,1\n0.2,3\n1,101\n", 1023, false}, /* shares stay shares */
        {"code,relative\n0,.00990099\n51,.02970297\n255,1\n", 0, true},
        {"code,L\n0,.00990099\n51,.02970297\n255,1\n", 0, true},
        {"code,R,G,B\n0,.0294117647,.0294117647,.0294117647\n"
         "51,.0488235294,.0488235294,.0488235294\n255,1,1,1\n",
         0, true},
    };
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        LevelTable table;
        const char *path = in_folder("levels.csv");
        write_text(path, same[i].text);
        assert_done(level_table_read(path, same[i].level_max, &arena, &table, &err));
        assert_near(table.level[1], 51, 1e-5);
        assert_near(table.level[2], 255, 0);
        assert_near(table.black_share, 1.0 / 101 - (i == 8) * (1.0 / 101 - 1.0 / 100), 1e-6);
        assert_near(table.curve[2].share[0], 0.02, 1e-5);
        assert_true(table.is_relative == same[i].is_relative);
        assert_int_equal(level_table_check_white(&table, 380, "white", why()), same[i].is_relative);
        LevelTable again = read_table(&arena, level_table_text(&table, &arena));
        assert_true(again.is_relative == table.is_relative);
        assert_near(again.black_share, table.black_share, 1e-6);
    }
    LevelTable table;
    const char *path = in_folder("levels.csv");
    write_text(path, "code,L\n0,1\n128,3\n255,101\n");
    assert_fails_as(level_table_read(path, 1023, &arena, &table, &err), ERROR_INPUT,
                    "the highest level is 255, required: rows up to the highest code, 1023");
}

/* The curve of a panel at a code, as it is interpolated; cd/m2. */
static double curve_at(const LevelTable *table, double code) {
    const LevelCurve *curve = &table->curve[0];
    float x[LEVEL_CURVE_MAX], y[LEVEL_CURVE_MAX];
    for (int i = 0; i < curve->count; i++) {
        x[i] = (float)log(curve->level[i]);
        y[i] = (float)log(curve->share[i]);
    }
    PanelLevelWeights w = panel_level_weights(x, y, curve->count, 2.2f, (float)log(code));
    double sum = (double)w.offset;
    for (int k = 0; k < 4 && w.first + k < curve->count; k++)
        sum += (double)(w.weight[k] * y[w.first + k]);
    double full = table->white_cd_m2[table->rows - 1], black = full * table->black_share;
    return black + (full - black) * exp(sum);
}

static double even_noise(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return (double)*state / 2147483648.0 - 1;
}

/* 300 cd/m2 over black, of 8 to 12 bits, under noise of 0.5 % and 0.005 cd/m2 (even, so that
 * the rms is 0.577 of it): read, and the curve is nearer to the truth than the table is. */
ARENA_TEST(noise_decides_neither_black_nor_the_curve) {
    uint32_t state = 7;
    for (int most = 255; most <= 4095; most = 4 * most + 3)
        for (int black = 0; black < 2; black++) {
            Text text = {.arena = &arena};
            double squares = 0, worst = 0;
            text_add(&text, "code,L\n");
            for (int g = 0; g <= most; g++) {
                double one = 0.3 * black + 300 * pow((double)g / most, 2.3);
                if (g < most) one += 0.005 * even_noise(&state) * (1 + one);
                text_format(&text, "%d,%.6f\n", g, one);
            }
            LevelTable table = read_table(&arena, text.data);
            assert_true(table.curve[0].is_smooth && table.curve[0].count <= 33);
            assert_true(table.noise_rows > 2 || most == 255);
            for (int g = 1; g < most; g++) {
                double one = 0.3 * black + 300 * pow((double)g / most, 2.3);
                double miss = (curve_at(&table, 255.0 * g / most) - one) / (one + 0.3);
                squares += miss * miss / (most - 1);
                worst = fmax(worst, fabs(miss));
            }
            assert_true(sqrt(squares) < 0.0025 && worst < 0.02);
            assert_true(table.curve[0].rms < 0.006);
        }
}

/* A monitor's 1,024 codes as a laboratory measured them: relative, noisy beside black. */
ARENA_TEST(a_real_table_of_1024_codes_is_read) {
    const char *path = SHARED_DATA_DIR "/display/OLED-SonyPVM-2541_gamma.csv";
    LevelTable table;
    if (access(path, R_OK)) skip();
    assert_done(level_table_read(path, 0, &arena, &table, &err));
    assert_int_equal(table.rows, 1024);
    assert_true(table.is_relative && table.curve[0].is_smooth);
    assert_true(table.curve[0].rms < 0.005 && table.curve[0].miss < 0.05);
    for (int i = 1; i < 1023; i++) { /* miss is of the panel's own interpolation */
        double miss = fabs(curve_at(&table, table.level[i]) - table.white_cd_m2[i]);
        assert_true(miss / (table.white_cd_m2[i] + 0.001) < 0.05);
    }
}

ARENA_TEST(primaries_have_curves_of_their_own) {
    LevelTable table = read_table(&arena, "level,R,G,B\n0,1,1,1\n128,11,16,3\n255,21,61,6\n");
    for (int p = 0; p < 3; p++) assert_int_equal(table.curve[p].count, 2);
    assert_near(table.curve[0].share[0], 0.5, 1e-7);
    assert_near(table.curve[1].share[0], 0.25, 1e-7);
    assert_near(table.curve[2].share[0], 0.4, 1e-7);
    assert_near(table.white_cd_m2[2], 21 + 61 + 6 - 2, 1e-9); /* black is in it once */
    assert_near(table.black_share, 1.0 / 86, 1e-9);
}

/* The table that a set keeps is read as the one it came from. */
ARENA_TEST(the_table_as_text_reads_the_same) {
    LevelTable table = read_table(&arena, "level,R,G,B,W\n0,.1,.1,.1,.1\n"
                                          "0.3,1.234567,2,3,6.1\n1,20,60,6,85.8\n");
    LevelTable again = read_table(&arena, level_table_text(&table, &arena));
    assert_int_equal(again.rows, 3);
    for (int i = 0; i < 3; i++) {
        assert_close(again.level[i], table.level[i], 1e-6);
        assert_close(again.white_cd_m2[i], table.white_cd_m2[i], 1e-6);
        assert_close(again.primary_cd_m2[0][i], table.primary_cd_m2[0][i], 1e-6);
    }
}

/* A power law over black is a straight line of the logarithms; a curve that is none needs more
 * levels, and no row may be missed by more than is promised. */
ARENA_TEST(as_few_levels_are_kept_as_every_row_needs) {
    Text power = {.arena = &arena}, bent = {.arena = &arena};
    text_add(&power, "code,L\n0,0.5\n");
    text_add(&bent, "code,L\n0,0.5\n");
    for (int g = 1; g <= 255; g++) {
        double x = g / 255.0, srgb = x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
        text_format(&power, "%d,%.9g\n", g, 0.5 + 400 * pow(x, 1.8));
        text_format(&bent, "%d,%.9g\n", g, 0.5 + 400 * srgb);
    }
    assert_int_equal(read_table(&arena, power.data).curve[0].count, 2);
    LevelTable table = read_table(&arena, bent.data);
    assert_int_equal(table.rows, 256);
    assert_true(table.curve[0].count > 4 && table.curve[0].count < 24);
    assert_true(table.curve[0].miss <= LEVEL_CURVE_MISS);
    assert_near(table.curve[0].share[table.curve[0].count - 1], 1, 1e-12);
}

ARENA_TEST(levels_without_more_light_than_black_are_left_out) {
    LevelTable table = read_table(&arena, "level,L\n0,0.02\n1,0.02\n2,0.02\n64,6\n255,100\n");
    assert_int_equal(table.dark_rows, 2);
    assert_near(table.curve[0].level[0], 64, 0);
}

/* ---- what is refused -------------------------------------------------------------------- */

ARENA_TEST(bad_tables_are_refused_by_line_and_words) {
    static const struct {
        const char *text, *place, *words;
    } bad[] = {
        {"level,L\n0,1\n128,30\n200,29.5\n255,100\n", "line 4",
         "29.5 cd/m2 at level 200 is"
         " less than the 30 of level 128 (line 3), required: luminance that does not fall"},
        {"level,L\n0,1\n128,-30\n255,100\n", "line 3",
         "-30 cd/m2, required: no luminance "
         "below"},
        {"level,L\n-1,1\n128,30\n255,100\n", "line 2", "level -1 is below zero"},
        {"level,L\n255,100\n", "", "has 1 row, required: 2 or more"},
        {"level,L\n", "", "no rows"},
        {"", "", "is empty"},
        {"level,L\n0,1\n# here\n224,70\n", "line 4",
         "highest level is 224, so the full level"
         " is not there: required are rows up to 255, 1023, 4095 or 65535 (codes)"},
        {"level,L\n0,1\n0.5,20\n0.9,70\n", "line 4", "highest level is 0.9"},
        {"level,L\n0,1\n1,70\n", "line 3", "highest level is 1, so the full level is unclear"},
        {"level,L\n0,1\n50,20\n100,70\n", "line 4", "full level is unclear"},
        {"level,L\n0,1\n512,20\n1000,70\n", "line 4", "full level is unclear"},
        {"level_%,L\n0,1\n20,20\n100,70\n", "line 4", "up to 1 with levels between (shares)"},
        {"level,L\n0,1\n128,20\n128,20\n255,70\n", "line 4", "level 128 stands in line 3"},
        {"level,L\n0,1\n128,1\n255,1\n", "line 4", "full level has no more light than level 0"},
        {"level,L\n0,0\n255,0\n", "line 3", "full level has no more light than level 0"},
        {"level,L\n0,1\n128,nan\n255,70\n", "line 3", "column 'L' holds 'nan'"},
        {"level,L,L\n0,1,2\n255,70,9\n", "line 1", "has the column 'L' twice"},
        {"level,L\n0,1\n128\n255,70\n", "line 3", "fewer cells than the header's 2 columns"},
        {"0,1\n128,20\n255,70\n", "header line", "no column of levels, required: one named"},
        {"level,x,y\n0,1,1\n255,70,1\n", "header line", "no column of luminance"},
        {"level,red,green\n0,1,1\n255,70,1\n", "header line", "not all of 'red', 'green' and"},
        {"level,R,red,G,B\n0,1,1,1,1\n255,7,7,7,7\n", "header line", "'R' and 'red' hold the"},
        {"level,R,G,B\n0,1,1,1\n99,3,3,.5\n255,7,7,7\n", "line 3", "column 'B': 0.5 cd/m2 at"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        LevelTable table;
        const char *path = in_folder("bad.csv");
        write_text(path, bad[i].text);
        if (level_table_read(path, 0, &arena, &table, why())) fail_msg("%s: was read", bad[i].text);
        assert_string_equal(why()->file, path);
        assert_told(ERROR_INPUT, bad[i].place, bad[i].words);
    }
}

/* ---- from a known panel and back -------------------------------------------------------- */

#define KNOWN_SHIFT "\"shift\": [0, 0, 0]}"

/* Every primary and level of one angular shape: what the approximation takes for granted. */
#define KNOWN \
    "{\"panel\": \"known\", \"refractive_index\": 1.5, \"emission\": {" \
    "\"red\": {\"luminance_cd_m2\": 60, \"peaks_nm\": [622], \"fwhm_nm\": [30]," \
    " \"weights\": [1], " KNOWN_SHIFT ", \"green\": {\"luminance_cd_m2\": 200," \
    " \"peaks_nm\": [528], \"fwhm_nm\": [32], \"weights\": [1], " KNOWN_SHIFT ", \"blue\": " \
    "{\"luminance_cd_m2\": 20, \"peaks_nm\": [461], \"fwhm_nm\": [20], \"weights\": [1], " KNOWN_SHIFT \
    ", \"gamma\": 2.35, \"gamma_drop\": 0, \"cosine_power\": [0.6, 0.9]," \
    "\"black_cd_m2\": 0.3, \"leak\": 0, \"levels\": [255]}," \
    "\"instrument\": {\"theta_max_deg\": 80, \"theta_step_deg\": 4, \"phi_step_deg\": 15}}"

/* The recipe's white at the directions of the simulated tables. */
static const char *white_table(Fixture *known) {
    const AngleTable *red = &known->set->primary[0].table[0];
    const float full[3] = {255, 255, 255};
    Text text = {.arena = &known->arena};
    text_add(&text, "theta,phi,X,Y,Z\n");
    for (int i = 0; i < red->rows; i++) {
        double theta = degrees_from_radians(red->theta[i]), xyz[3];
        double phi = degrees_from_radians(red->phi[i]);
        true_xyz_deg(&known->recipe, theta, phi, full, xyz);
        text_format(&text, "%.6g,%.6g,%.9g,%.9g,%.9g\n", theta, phi, xyz[0], xyz[1], xyz[2]);
    }
    return fixture_file(known, "white.csv", text.data);
}

static const char *level_file(Fixture *known, const char *name, double scale) {
    Text text = {.arena = &known->arena};
    text_add(&text, "level,luminance_cd_m2\n");
    for (int g = 0; g <= 255; g += 15) {
        float rgb[3] = {(float)g, (float)g, (float)g};
        double xyz[3];
        true_xyz_deg(&known->recipe, 0, 0, rgb, xyz);
        text_format(&text, "%d,%.7g\n", g, scale * xyz[1]);
    }
    return fixture_file(known, name, text.data);
}

static const double asked[] = {0, 1, 2, 5, 13, 34, 77.5, 100, 127, 128, 180, 222, 240, 254, 255};

static void assert_known(const Fixture *known) {
    for (int t = 0; t <= 72; t += 24)
        for (size_t i = 0; i < sizeof asked / sizeof *asked; i++) {
            float g = (float)asked[i], rgb[3] = {g, g, g}, xyz[3];
            double truth[3];
            true_xyz_deg(&known->recipe, t, 40, rgb, truth);
            panel_emission_xyz(known->panel, direction_deg(t, 40), rgb, xyz);
            for (int j = 0; j < 3; j++) assert_close(xyz[j], truth[j], 0.005);
        }
}

TEST(a_known_gamma_comes_back_from_white_and_its_table) {
    ENDS_BY(fixture_end) Fixture known;
    fixture_measure(&known, KNOWN);
    const char *levels = level_file(&known, "levels.csv", 1);
    fixture_read(&known, white_table(&known));
    assert_done(measurement_read_levels(known.set, levels, 0, &known.arena, &err));
    fixture_fit(&known, NULL);
    assert_known(&known);
    char *report = json_dumps(known.report, 0);
    assert_text_has(report, "levels from levels.csv: 18 rows, of which 2 keep all within 0.05");
    assert_text_has(report, "\"levels_measured\": true");
    free(report);
}

TEST(a_manifest_may_name_the_table) {
    ENDS_BY(fixture_end) Fixture known;
    fixture_measure(&known, KNOWN);
    level_file(&known, "levels.csv", 1.03); /* the set's white counts, not the table's */
    white_table(&known);
    fixture_read(&known, fixture_file(&known, "M.json",
                                      "{\"emission\": {\"white\": "
                                      "\"white.csv\", \"levels\": \"levels.csv\"}}"));
    assert_true(known.set->has_black);
    fixture_fit(&known, NULL);
    assert_known(&known);
}

TEST(a_table_of_another_white_or_set_is_refused) {
    ENDS_BY(fixture_end) Fixture known;
    fixture_measure(&known, KNOWN);
    const char *levels = level_file(&known, "levels.csv", 1.06);
    assert_fails_as(measurement_read_levels(known.set, levels, 0, &known.arena, &err), ERROR_INPUT,
                    "its primaries' levels are measured");
    fixture_read(&known, white_table(&known));
    assert_fails_as(measurement_read_levels(known.set, levels, 0, &known.arena, &err), ERROR_INPUT,
                    "full level has 297.1");
    assert_string_equal(why()->file, levels);
    assert_string_equal(why()->path, "line 19");
    assert_error_has(why(), "6 % apart, required: within 5 %");
    assert_int_equal(known.set->primary[0].level_count, 1); /* as it was */
    assert_false(known.set->has_black);
    const char *both =
        fixture_file(&known, "M.json",
                     "{\"emission\": {\"black\": \"b\", "
                     "\"red\": {}, \"green\": {}, \"blue\": {}, \"levels\": \"levels.csv\"}}");
    Measurement set;
    assert_fails_as(measurement_read(both, &known.arena, &set, &err), ERROR_INPUT,
                    "is for a set of 'white' alone");
    assert_string_equal(why()->path, "/emission/levels");
}

TEST_PROGRAM(make_folder, clear_folder)
