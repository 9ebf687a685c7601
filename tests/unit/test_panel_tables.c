/* SPDX-License-Identifier: Apache-2.0 */
/* Files of a laboratory: what is wrong with recipes, manifests and tables is named; every
 * layout says the same. */
#include "panel_fixture.h"
#include "panel_bytes.h"
#include "panel/query/panel_emission.h"

static Fixture folder; /* a folder for files, nothing fitted */

static int start(void **state) {
    *state = &folder;
    fixture_folder(&folder);
    return 0;
}

#define EXPECT_LINE(err, ...) \
    do { \
        const char *const parts_[] = {__VA_ARGS__}; \
        assert_line_has(&(err), parts_, (int)(sizeof parts_ / sizeof *parts_)); \
    } while (0)

/* Why a measurement whose file `name` holds this text is refused; it must be. */
static Error bad_file(const char *name, const char *text) {
    Error err = {0};
    Measurement *set = ARENA_NEW(&folder.arena, Measurement, 1);
    const char *path = fixture_file(&folder, name, text);
    if (measurement_read(path, &folder.arena, set, &err)) fail_msg("was accepted: %s", text);
    return err;
}

TEST(tables_name_file_line_and_value) {
    static const struct {
        const char *text, *parts[3];
    } cases[] = {
        {"theta,phi,X,Y,Z\n0,0,1,1,1\n10,0,1,nan,1\n",
         {"table.csv: line 3", "column 'Y' holds 'nan'", "a finite number"}},
        {"theta,phi,X,Y,Z\n0,0,100,100,100\n10,0,1,-7,1\n", {"line 3", "-7", "noise below zero"}},
        {"theta,phi,X,Y,Z\n10,0,1,1,1\n# note\n10,360,1,2,1\n",
         {"line 4", "in line 2 with different values", "every direction once"}},
        {"theta,phi,X,Y,Z\n95,0,1,1,1\n", {"line 2", "theta is 95", "0 to 90 degrees"}},
        {"theta,phi,X,Y,Z\n5,400,1,1,1\n", {"line 2", "phi is 400", "-360 to 360"}},
        {"theta,phi,X,Y,Q\n5,40,1,1,1\n",
         {"header line", "column 'Q' is unknown", "nearest known one is '"}},
        {"thta,phi,X,Y,Z\n5,40,1,1,1\n", {"header line", "no column 'theta'", "'thta'"}},
        {"theta,phi,X,Y,Z\n5,40,1,1\n", {"line 2", "fewer cells", "5 columns"}},
        {"theta,phi,X,Y,Z\n5,40,1,1,1,9\n", {"line 2", "more cells", "5 columns"}},
        {"theta,phi,X,Y,Z\n5,40,1,x7,1\n", {"line 2", "'x7'", "a finite number"}},
        {"theta,phi,X,Y,Z\n", {"table.csv", "no rows", ""}},
        {"", {"table.csv", "is empty", "a header line"}},
        {"theta,phi,Y,x,y\n5,40,10,0.8,0.7\n", {"line 2", "x 0.8, y 0.7", "CIE 1931"}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Error err = bad_file("table.csv", cases[i].text);
        assert_line_has(&err, cases[i].parts, 3);
    }
}

TEST(every_prefix_of_a_table_is_read_or_refused) {
    const char *text = "theta,phi,X,Y,Z\n0,0,1,1,1\n# c\n10,0,1.5e0,2,1\n10,90,1,2,3\n";
    for (size_t n = 0; n < strlen(text); n++) {
        Measurement *set = ARENA_NEW(&folder.arena, Measurement, 1);
        const char *cut = arena_string(&folder.arena, text, n);
        const char *path = fixture_file(&folder, "table.csv", cut);
        Error err = {0};
        if (!measurement_read(path, &folder.arena, set, &err)) assert_true(err.text[0] != 0);
    }
}

TEST(rows_at_the_normal_are_averaged_and_equal_doubles_pass) {
    Measurement *set = ARENA_NEW(&folder.arena, Measurement, 1);
    const char *path = fixture_file(
        &folder, "table.csv",
        "phi,theta,X,Y,Z\n0,0,95,100,108\n90,0,97,102,110\n-90,-10,90,95,99\n90,10,90,95,99\n"
        "0,10,91,96,100\n");
    assert_done(measurement_read(path, &folder.arena, set, &err));
    const AngleTable *table = &set->primary[1].table[0];
    assert_int_equal(table->rows, 3);
    double sum = 0;
    for (int p = 0; p < 3; p++) sum += (double)set->primary[p].table[0].value[1];
    assert_close(sum, 101, 1e-4);
}

#define BRDF_ONLY \
    "\"reflection\": {\"wavelengths_nm\": [500], \"incidence_deg\": [0], " \
    "\"files\": \"{incidence}.csv\"}"
#define POLARISED(text) "{\"emission\": {\"white\": \"good.csv\"}, \"polarisation\": " text "}"

TEST(manifests_name_the_key) {
    static const struct {
        const char *text, *parts[3];
    } cases[] = {
        {"{\"panel\": \"x\", \"emision\": {}}", {"/emision", "unknown key", "'emission'"}},
        {"{\"panel\": \"x\"}", {"MANIFEST.json", "'emission' is missing", ""}},
        {"{\"emission\": {\"red\": {}}}", {"/emission", "'black' is missing", ""}},
        {"{\"emission\": {\"white\": \"no.csv\"}}", {"no.csv", "", ""}},
        {"{\"emission\": {\"white\": 3}}", {"/emission/white", "is a number", "required: a text"}},
        {"{\"emission\": {\"white\": \"t.csv\", \"red\": {}}}", {"both 'white' and 'red'", "", ""}},
        {"{\"emission\": 3}", {"/emission", "is a number", "required: an object"}},
        {"{\"emission\": {\"white\": \"good.csv\"}, \"reflection\": {"
         "\"wavelengths_nm\": [500, 400], \"incidence_deg\": [10],"
         "\"files\": \"i{incidence}.csv\"}}",
         {"/reflection/wavelengths_nm", "400 follows 500", "rising"}},
        {"{\"emission\": {\"white\": \"good.csv\"}, \"reflection\": {\"wavelengths_nm\": [500],"
         " \"incidence_deg\": [10], \"files\": \"i.csv\"}}",
         {"/reflection/files", "{incidence}", ""}},
        {"{\"emission\": {\"white\": \"good.csv\"}, \"primaries\": \"p.csv\"}",
         {"p.csv", "has no column 'green'", ""}},
        {"{\"emission\": {\"black\": \"good.csv\", \"red\": {\"256\": \"good.csv\"}}}",
         {"/emission/red/256", "no grey level", "up to 255"}},
        {"{\"emission\": {\"black\": \"good.csv\", \"red\": {\"128\": \"good.csv\", \"128.0\": "
         "\"good.csv\"}}}",
         {"same grey level", "", ""}},
        {POLARISED("3"), {"/polarisation", "is a number", "required: an object"}},
        {POLARISED("{\"degree\": 1}"), {"/polarisation", "'azimuth_deg' is missing", ""}},
        {POLARISED("{\"azimuth_deg\": 1}"), {"/polarisation", "'degree' is missing", ""}},
        {POLARISED("{\"degree\": 1.01, \"azimuth_deg\": 0}"),
         {"/polarisation/degree", "1.01", "0 to 1"}},
        {POLARISED("{\"degree\": \"1\", \"azimuth_deg\": 0}"),
         {"/polarisation/degree", "is a text", "required: a number"}},
        {POLARISED("{\"degree\": 1, \"azimuth_deg\": 361}"),
         {"/polarisation/azimuth_deg", "361", "-360 to 360"}},
        {POLARISED("{\"degree\": 1, \"azimuth\": 45}"),
         {"/polarisation/azimuth", "unknown key", "'azimuth_deg'"}},
        {"{\"polarisation\": {\"degree\": 1, \"azimuth_deg\": 45}, " BRDF_ONLY "}",
         {"/polarisation", "no 'emission'", ""}},
        {"{\"a\": 1,\n \"a\": 2}", {"MANIFEST.json: line 2", "not valid JSON", "duplicate"}},
        {"[1]", {"MANIFEST.json", "is an array", "required: an object"}},
    };
    fixture_file(&folder, "good.csv", "theta,phi,X,Y,Z\n0,0,1,1,1\n10,0,1,1,1\n");
    fixture_file(&folder, "p.csv", "nm,red,gren,blue\n500,1,1,1\n");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Error err = bad_file("MANIFEST.json", cases[i].text);
        assert_line_has(&err, cases[i].parts, 3);
    }
}

/* The panel of a manifest, and the bytes of its file. */
static Panel *fitted(const char *manifest, FileBytes *bytes) {
    Panel *panel = NULL;
    const char *path = fixture_file(&folder, "MANIFEST.json", manifest);
    assert_done(fixture_try(&folder, path, NULL, folder.panel_path, bytes, &panel, &err));
    return panel;
}

TEST(polarisation_is_kept_and_costs_nothing_where_there_is_none) {
    static const struct {
        const char *text;
        float degree, azimuth_deg;
    } cases[] = {
        {POLARISED("{\"degree\": 0.995, \"azimuth_deg\": 45}"), 0.995f, 45},
        {POLARISED("{\"degree\": 1, \"azimuth_deg\": -60}"), 1, 120},
        {POLARISED("{\"degree\": 0.25, \"azimuth_deg\": 360}"), 0.25f, 0},
        {POLARISED("{\"degree\": 0, \"azimuth_deg\": 45}"), 0, 0},
    };
    FileBytes none, some;
    fixture_file(&folder, "good.csv", "theta,phi,X,Y,Z\n0,0,95,100,108\n50,0,60,70,75\n");
    Panel *plain = fitted("{\"emission\": {\"white\": \"good.csv\"}}", &none);
    assert_true(panel_polarisation(plain).degree == 0);
    panel_close(plain);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Panel *panel = fitted(cases[i].text, &some);
        PanelPolarisation p = panel_polarisation(panel);
        assert_true(p.degree == cases[i].degree);
        assert_close(1 + (double)p.azimuth, 1 + radians_from_degrees((double)cases[i].azimuth_deg),
                     1e-6);
        if (p.degree > 0) assert_true(some.size > none.size && some.size <= none.size + 32);
        else assert_int_equal(some.size, none.size);
        if (p.degree == 0) assert_memory_equal(some.data, none.data, none.size);
        panel_close(panel);
    }
}

TEST(a_section_that_nobody_knows_is_passed_over) {
    Arena scratch = folder.arena;
    FileBytes bytes;
    Panel *panel;
    fixture_file(&folder, "good.csv", "theta,phi,X,Y,Z\n0,0,95,100,108\n50,0,60,70,75\n");
    panel_close(fitted(POLARISED("{\"degree\": 1, \"azimuth_deg\": 0}"), &bytes));
    unsigned char *copy = malloc(bytes.size);
    PanelSection *section = (PanelSection *)(copy + sizeof(PanelHeader));
    memcpy(copy, bytes.data, bytes.size);
    while (section->kind != PANEL_POLARISED) section++;
    section->kind = 99;
    repair_checksum(copy, bytes.size);
    assert_done(panel_from_bytes(copy, bytes.size, "x.panel", &scratch, &panel, &err));
    assert_true(panel_polarisation(panel).degree == 0);
    free(copy);
}

#define PRIMARY "{\"peaks_nm\": [600], \"fwhm_nm\": [20], \"weights\": [1]}"
#define PRIMARIES "{\"red\": " PRIMARY ", \"green\": " PRIMARY ", \"blue\": " PRIMARY "}"
#define RECIPE(polarisation) "{\"emission\": " PRIMARIES ", \"polarisation\": " polarisation "}"
#define PLACES(keys) "{\"emission\": " PRIMARIES ", \"places\": {" keys "}}"

TEST(recipes_name_the_key) {
    static const struct {
        const char *text, *parts[2];
    } cases[] = {
        {"{\"emission\": {\"red\": {\"peaks_nm\": [600], \"fwhm_nm\": [1], \"weights\": [1]}}}",
         {"/emission/red/fwhm_nm", "required: a number from 2 to 400"}},
        {"{\"emission\": {\"red\": {\"peak_nm\": [600]}}}",
         {"/emission/red/peak_nm", "nearest known one is 'peaks_nm'"}},
        {"{\"emission\": {\"red\": {\"peaks_nm\": [600, 610], \"fwhm_nm\": [10],"
         "\"weights\": [1]}}}",
         {"/emission/red", "2, 1 and 1 values, required: equal"}},
        {"{}", {"recipe.json", "key 'emission' is missing"}},
        {"{\"size_mm\": [100], \"emission\": " PRIMARIES "}",
         {"/size_mm", "has 1 values, required: 2"}},
        {PLACES("\"u\": [0.5]"), {"/places", "1 and 0 values, required: equal"}},
        {PLACES("\"map\": [4]"), {"/places/map", "has 1 values, required: 2"}},
        {PLACES("\"map\": [4, 2.5]"), {"/places/map", "is 2.5, required: whole numbers"}},
        {"{\"emission\": " PRIMARIES ", \"reflection\": {\"haze_share\": 0.8}, "
         "\"places\": {\"map\": [4, 4], \"haze_slope\": -0.6}}",
         {"/places/haze_slope", "haze_share 0.8 would be 1.04, required: at most 1"}},
        {RECIPE("45"), {"/polarisation", "required: an object"}},
        {RECIPE("{\"degree\": 1}"), {"/polarisation", "'azimuth_deg' is missing"}},
        {RECIPE("{\"azimuth_deg\": 1}"), {"/polarisation", "'degree' is missing"}},
        {RECIPE("{\"degree\": 1.5, \"azimuth_deg\": 1}"),
         {"/polarisation/degree", "required: a number from 0 to 1"}},
        {RECIPE("{\"degree\": 1, \"azimuth_deg\": 361}"),
         {"/polarisation/azimuth_deg", "required: a number from -360 to 360"}},
        {RECIPE("{\"degree\": 1, \"angle\": 3}"), {"/polarisation/angle", "unknown key"}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        SyntheticPanel recipe;
        const char *path = fixture_file(&folder, "recipe.json", cases[i].text);
        assert_false(synthetic_panel_read(path, &folder.arena, &recipe, why()));
        assert_line_has(why(), cases[i].parts, 2);
    }
}

/* A set in the other layouts: polar grids, one file a wavelength, rows in any order and a
 * shadow of missing directions. It must say what the plain layout says. */
TEST(rows_in_any_order_say_the_same) {
    char text[40000] = "";
    size_t at = (size_t)snprintf(text, sizeof text, "theta,phi,X,Y,Z\n");
    for (int t = 90; t >= 0; t -= 5) /* from the horizon up, a wedge shadowed */
        for (int p = 0; p < (t ? 12 : 1); p++) {
            double c = cos(radians_from_degrees(t));
            if (p == 4 && t > 20 && t < 50) continue;
            at += (size_t)snprintf(text + at, sizeof text - at, "%d,%d,%g,%g,%g\n", t, 30 * p,
                                   100 * c, 200 * c, 300 * c);
        }
    fixture_file(&folder, "rows.csv", text);
    float rgb[3] = {255, 255, 255}, xyz[3];
    Panel *panel = fitted("{\"emission\": {\"white\": \"rows.csv\"}}", NULL);
    for (int t = 0; t < 78; t += 6) {
        panel_emission_xyz(panel, direction_deg(t, 7.0 * t), rgb, xyz);
        assert_close(xyz[1], 200 * cos(radians_from_degrees(t)), 0.01);
    }
    panel_close(panel);
}

TEST(columns_are_the_manifests_wavelengths) {
    const char *manifest = "{\"emission\": {\"white\": \"good.csv\"}, \"reflection\": {"
                           "\"wavelengths_nm\": [500], \"incidence_deg\": [12.5],"
                           "\"files\": \"i{incidence}.csv\"}}";
    fixture_file(&folder, "good.csv", "theta,phi,X,Y,Z\n0,0,1,1,1\n10,0,1,1,1\n");
    fixture_file(&folder, "i12.5.csv", "theta,phi,reflectance\n0,0,4\n");
    Error err = bad_file("MANIFEST.json", manifest);
    EXPECT_LINE(err, "header line", "column 'reflectance' is no wavelength of the manifest");
}

TEST_PROGRAM(start, fixture_group_end)
