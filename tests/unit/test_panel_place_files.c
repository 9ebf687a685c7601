/* SPDX-License-Identifier: Apache-2.0 */
/* Manifests with spots and uniformity maps: what is wrong is named, what they become, and what
 * is written back. */
#include "panel_fixture.h"

#include "image/picture.h"
#include "openexr/exr_file.h"
#include "panel/query/panel_emission.h"
#include "panel/figures/panel_figure.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_place.h"

static Fixture folder; /* files */

static int start(void **state) {
    *state = &folder;
    fixture_folder(&folder);
    return 0;
}

#define TABLE "theta,phi,X,Y,Z\n0,0,95,100,108\n50,0,60,70,75\n50,180,61,70,75\n"
#define HAZE "theta,phi,brdf\n0,0,0.1\n20,0,0.1\n50,0,0.1\n50,90,0.1\n"

static void write_tables(void) {
    fixture_file(&folder, "a.csv", TABLE);
    fixture_file(&folder, "b.csv", "theta,phi,X,Y,Z\n0,0,190,200,216\n50,0,120,140,150\n");
    fixture_file(&folder, "i20.csv", HAZE);
    fixture_file(&folder, "map.csv", "column,row,Y\n0,0,1\n1,0,0.5\n0,1,2\n1,1,1\n");
    fixture_file(&folder, "half.csv", "column,row,Y\n0,0,1\n1,0,0.5\n0,1,2\n");
    fixture_file(&folder, "twice.csv", "column,row,Y\n0,0,1\n0,0,0.5\n");
    fixture_file(&folder, "broken.csv", "column,row,Y\n0.5,0,1\n");
    fixture_file(&folder, "negative.csv", "column,row,Y\n0,0,1\n1,0,-0.5\n");
    fixture_file(&folder, "nan.csv", "column,row,Y\n0,0,1\n1,0,nan\n");
    fixture_file(&folder, "dark.csv", "column,row,Y\n0,0,0\n1,0,0\n");
    fixture_file(&folder, "hole.csv", "column,row,Y\n0,0,1\n1,0,0\n2,0,1\n");
    fixture_file(&folder, "xy.csv", "column,row,X,Y\n0,0,1,1\n");
    fixture_file(&folder, "both.csv", "column,row,Y,black_Y\n0,0,1,1\n");
    fixture_file(&folder, "none.csv", "column,row\n0,0\n");
    fixture_file(&folder, "other.csv", "column,row,Y,Black_Y\n0,0,1,1\n");
    fixture_file(&folder, "most.csv", "column,row,Y\n0,0,2e9\n");
    fixture_file(&folder, "rows.csv", "row,Y\n0,1\n");
    fixture_file(&folder, "one.csv", "column,row,Y\n0,0,1\n");
    fixture_file(&folder, "no.exr", "not a picture");
    fixture_file(&folder, "no.png", "not a picture");
}

/* 3 x 2 pixels of X, Y, Z and black's Y, in steps of a 16-bit picture. */
static const float seen[4][6] = {{0.5f, 0.6f, 0.7f, 0.8f, 0.9f, 1},
                                 {1, 0.9f, 0.8f, 0.7f, 0.6f, 0.5f},
                                 {0.25f, 0.5f, 0.75f, 1, 0.75f, 0.5f},
                                 {0.1f, 0.2f, 0.1f, 0.2f, 0.1f, 0.4f}};

static void write_exr(const char *name, const char *const names[4]) {
    ExrChannel channel[4];
    float plane[4][6];
    ExrBytes *encoded;
    size_t size;
    for (int k = 0; k < 4; k++) {
        memcpy(plane[k], seen[k], sizeof plane[k]);
        channel[k] = (ExrChannel){.name = names[k], .values = plane[k]};
    }
    ExrPicture picture = {
        .display = {0, 0, 3, 2}, .data = {0, 0, 3, 2}, .channel_count = 4, .channels = channel};
    assert_done(exr_encode(&picture, &encoded, &err));
    const void *bytes = exr_bytes(encoded, &size);
    assert_done(file_write(fixture_path(&folder, name), bytes, size, &err));
    exr_bytes_destroy(encoded);
}

#define WHITE(file) "\"emission\": {\"white\": \"" file "\"}"
#define SPOT(at, file) "{\"position\": [" at "], " WHITE(file) "}"
#define REFLECTION \
    "\"reflection\": {\"wavelengths_nm\": [550], \"incidence_deg\": [20], \"files\": " \
    "\"i{incidence}.csv\"}"
#define MAP(text) "{" WHITE("a.csv") ", \"uniformity\": {" text "}}"

/* What a manifest of this text becomes; false: err says why not. */
static bool try_manifest(const char *text, const char *panel, Panel **out, FileBytes *bytes,
                         Error *err) {
    FitOptions fit = fit_options_default();
    const char *path = fixture_file(&folder, "MANIFEST.json", text);
    *err = (Error){0};
    fit.force = true;
    return fixture_try(&folder, path, &fit, fixture_path(&folder, panel), bytes, out, err);
}

TEST(what_is_wrong_with_places_is_named) {
    static const struct {
        const char *text, *parts[3];
    } cases[] = {
        {"{\"spots\": 3}", {"/spots", "is a number", "an array"}},
        {"{\"spots\": []}", {"/spots", "0 values", "1 to 49"}},
        {"{\"spots\": [5]}", {"/spots/0", "required: an object", ""}},
        {"{\"spots\": [{" WHITE("a.csv") "}]}", {"/spots/0", "'position' is missing", ""}},
        {"{\"spots\": [{\"position\": [0.5, 0.5]}]}",
         {"/spots/0", "neither 'emission' nor 'reflection'", ""}},
        {"{\"spots\": [{\"position\": [0.5]," WHITE("a.csv") "}]}",
         {"/spots/0/position", "1 values", "required: 2"}},
        {"{\"spots\": [{\"position\": 0.5," WHITE("a.csv") "}]}",
         {"/spots/0/position", "is a number", ""}},
        {"{\"spots\": [" SPOT("0.5, 1.2", "a.csv") "]}", {"/spots/0/position", "1.2", "0 to 1"}},
        {"{\"spots\": [" SPOT("-0.1, 0", "a.csv") "]}", {"/spots/0/position", "-0.1", "0 to 1"}},
        {"{\"spots\": [{\"position_mm\": [5, 5]," WHITE("a.csv") "}]}",
         {"/spots/0/position_mm", "was removed", "size_mm"}},
        {"{\"spots\": [{\"at\": [0, 0]," WHITE("a.csv") "}]}", {"/spots/0/at", "unknown key", ""}},
        {"{\"spots\": [" SPOT("0, 0", "a.csv") "," SPOT("0.5, 0.5", "a.csv") "," SPOT("0, 0",
                                                                                      "b.csv") "]}",
         {"/spots/2", "same place as spot 0", ""}},
        {"{\"spots\": [" SPOT("0, 0", "gone.csv") "]}", {"gone.csv", "", ""}},
        {"{\"spots\": [" SPOT("0, 0", "a.csv") ", {\"position\": [1, 1], " REFLECTION "}]}",
         {"/spots/0", "no 'reflection' as other spots have", "none that would serve"}},
        {"{" REFLECTION ", \"uniformity\": {\"file\": \"map.csv\"}}",
         {"/uniformity", "the set has none", ""}},
        {"{" WHITE("a.csv") ", \"uniformity\": \"map.csv\"}",
         {"/uniformity", "is a text", "an object"}},
        {MAP(""), {"/uniformity", "'file' is missing", ""}},
        {MAP("\"file\": 5"), {"/uniformity/file", "is a number", ""}},
        {MAP("\"map\": \"map.csv\""), {"/uniformity/map", "unknown key", ""}},
        {MAP("\"file\": \"gone.csv\""), {"gone.csv", "", ""}},
        {MAP("\"file\": \"gone.exr\""), {"gone.exr", "", ""}},
        {MAP("\"file\": \"gone.png\""), {"gone.png", "", ""}},
        {MAP("\"file\": \"no.exr\""), {"no.exr", "", ""}},
        {MAP("\"file\": \"no.png\""), {"no.png", "", ""}},
        {MAP("\"file\": \"half.csv\""), {"half.csv", "3 pixels of 2 x 2", "all"}},
        {MAP("\"file\": \"twice.csv\""), {"twice.csv: line 3", "0,0", "twice"}},
        {MAP("\"file\": \"broken.csv\""), {"broken.csv: line 2", "column is 0.5", "whole"}},
        {MAP("\"file\": \"negative.csv\""), {"negative.csv: pixel 1,0", "-0.5", "from 0 to 1e+09"}},
        {MAP("\"file\": \"most.csv\""), {"most.csv: pixel 0,0", "2e+09", "from 0 to 1e+09"}},
        {MAP("\"file\": \"nan.csv\""), {"nan.csv: line 3", "nan", ""}},
        {MAP("\"file\": \"dark.csv\""), {"dark.csv", "white's Y is 0 everywhere", ""}},
        {MAP("\"file\": \"hole.csv\""), {"hole.csv", "dark at 0.5, 0.5", ""}},
        {MAP("\"file\": \"xy.csv\""), {"xy.csv", "only some of X, Y and Z", ""}},
        {MAP("\"file\": \"none.csv\""), {"none.csv", "has no column Y", ""}},
        {MAP("\"file\": \"rgb.exr\""), {"rgb.exr", "has no channel Y", ""}},
        {MAP("\"file\": \"other.csv\""), {"other.csv", "column 'Black_Y' is unknown", "'black_Y'"}},
        {MAP("\"file\": \"map.csv\", \"black\": \"both.csv\""),
         {"both.csv", "named as \"black\"", "alone"}},
        {MAP("\"file\": \"rows.csv\""), {"rows.csv", "no column 'column'", ""}},
        {MAP("\"file\": \"map.csv\", \"black\": \"one.csv\""),
         {"one.csv", "1 x 1 pixels", "2 x 2"}},
        {MAP("\"file\": \"both.csv\", \"black\": \"one.csv\""),
         {"/uniformity/black", "holds black too", "one of them"}},
        {MAP("\"file\": \"map.csv\", \"bend_deg\": 200"),
         {"/uniformity/bend_deg", "200", "-170 to 170"}},
        {MAP("\"file\": \"map.csv\", \"camera_mm\": 500"),
         {"/uniformity/camera_mm", "no 'size_mm'", ""}},
        {"{\"polarisation\": {\"degree\": 1, \"azimuth_deg\": 0}, \"spots\": [{\"position\": "
         "[0, 0], " REFLECTION "}]}",
         {"/polarisation", "no 'emission'", ""}},
        {"{" REFLECTION ", \"polarisation\": {\"degree\": 1, \"azimuth_deg\": 0}}",
         {"/polarisation", "no 'emission'", ""}},
        {"{\"polarisation\": {\"degree\": 1, \"azimuth_deg\": 0}, \"spots\": {}}",
         {"/spots", "is an object", "an array"}},
        {"{\"size_mm\": [100], " WHITE("a.csv") "}", {"/size_mm", "1 values", "required: 2"}},
    };
    write_tables();
    write_exr("rgb.exr", (const char *const[4]){"R", "G", "B", "A"});
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Panel *panel;
        FileBytes bytes;
        if (try_manifest(cases[i].text, "wrong.panel", &panel, &bytes, why()))
            fail_msg("was accepted: %s", cases[i].text);
        assert_line_has(why(), cases[i].parts, 3);
    }
}

/* One spot, or spots that leave nothing to choose, and no map: the file of old. */
TEST(one_spot_is_a_plain_panel_to_the_byte) {
    Panel *plain, *spot;
    FileBytes old, now;
    write_tables();
    assert_done(
        try_manifest("{" WHITE("a.csv") ", " REFLECTION "}", "x.panel", &plain, &old, &err));
    assert_done(try_manifest(
        "{\"spots\": [{\"position\": [0.2, 0.7], " WHITE("a.csv") ", " REFLECTION "}]}", "x.panel",
        &spot, &now, &err));
    assert_int_equal(now.size, old.size);
    assert_memory_equal(now.data, old.data, old.size);
    assert_false(panel_varies(spot));
    float place[2] = {0.9f, 0.1f}, rgb[3] = {200, 100, 50}, a[3], b[3];
    panel_emission_xyz(plain, direction_deg(30, 40), rgb, a);
    panel_place_emission_xyz(spot, place, direction_deg(30, 40), rgb, b);
    assert_memory_equal(a, b, sizeof a);
    panel_close(spot);
    panel_close(plain);
}

/* Where a spot leaves a part out, the manifest's own serves there. */
TEST(the_manifests_own_tables_serve_where_a_spot_has_none) {
    Panel *panel;
    FileBytes bytes;
    const float rgb[3] = {255, 255, 255}, places[3][2] = {{0, 0}, {1, 0}, {0.25f, 0}};
    const double wanted[3] = {100, 200, 125};
    write_tables();
    assert_done(try_manifest("{" WHITE("a.csv") ", " REFLECTION ", \"spots\": ["
                                                "{\"position\": [0, 0], " REFLECTION
                                                "}, " SPOT("1, 0", "b.csv") "]}",
                             "x.panel", &panel, &bytes, &err));
    for (int i = 0; i < 3; i++) {
        float xyz[3];
        panel_place_emission_xyz(panel, places[i], vec3(0, 0, 1), rgb, xyz);
        assert_close((double)xyz[1], wanted[i], 2e-3);
        assert_int_equal(panel_place_reflection(panel, places[i]).count, i == 2 ? 2 : 1);
    }
    panel_close(panel);
}

/* A map alone: ratios to the middle, bilinear between pixels, held at the edges; cd/m2 or
 * shares are the same. Black without a map of its own follows white. */
TEST(a_map_counts_relative_to_where_the_panel_was_measured) {
    Panel *panel;
    FileBytes bytes;
    const float rgb[3] = {255, 255, 255};
    /* the middle is (1 + 0.5 + 2 + 1) / 4 */
    const struct {
        float at[2];
        double share;
    } cases[] = {
        {{0.5f, 0.5f}, 1},           {{0.25f, 0.25f}, 1 / 1.125}, {{0.75f, 0.25f}, 0.5 / 1.125},
        {{0.25f, 0.75f}, 2 / 1.125}, {{0, 1}, 2 / 1.125},         {{0.5f, 0.25f}, 0.75 / 1.125},
    };
    write_tables();
    assert_done(try_manifest(MAP("\"file\": \"map.csv\""), "x.panel", &panel, &bytes, &err));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        float xyz[3], middle[3];
        panel_emission_xyz(panel, vec3(0, 0, 1), rgb, middle);
        panel_place_emission_xyz(panel, cases[i].at, vec3(0, 0, 1), rgb, xyz);
        for (int j = 0; j < 3; j++)
            assert_close((double)xyz[j], cases[i].share * (double)middle[j], 1e-4);
    }
    PanelEvenness e = panel_figure_evenness(panel, rgb);
    assert_close(e.nine_most / e.nine_least, 4, 1e-3);
    assert_close(panel_non_uniformity(e.least, e.most), 0.75, 1e-3);
    panel_close(panel);
}

static void write_png(const char *name, int first, int step, int bits) {
    Picture picture = picture_create(3, 2, &folder.arena);
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 3; k++) picture.rgb[3 * i + k] = seen[first + step * k][i];
    assert_done(picture_write(fixture_path(&folder, name), &picture, (PictureFile){.bits = bits},
                              folder.arena, &err));
}

/* The same map as numbers, as OpenEXR and as 16-bit pictures; 8 bits are refused. */
TEST(a_map_is_the_same_in_every_format) {
    static const char *const maps[3] = {MAP("\"file\": \"m.csv\""), MAP("\"file\": \"m.exr\""),
                                        MAP("\"file\": \"m.png\", \"black\": \"k.png\"")};
    Panel *panel[3];
    FileBytes bytes;
    char text[1024];
    size_t n = (size_t)snprintf(text, sizeof text, "column,row,X,Y,Z,black_Y\n");
    write_tables();
    for (int i = 0; i < 6; i++)
        n += (size_t)snprintf(text + n, sizeof text - n, "%d,%d,%.9g,%.9g,%.9g,%.9g\n", i % 3,
                              i / 3, (double)seen[0][i], (double)seen[1][i], (double)seen[2][i],
                              (double)seen[3][i]);
    fixture_file(&folder, "m.csv", text);
    write_exr("m.exr", (const char *const[4]){"X", "Y", "Z", "black.Y"});
    write_png("m.png", 0, 1, 16);
    write_png("k.png", 3, 0, 16);
    write_png("bad.png", 0, 1, 8);
    for (int k = 0; k < 3; k++)
        assert_done(try_manifest(maps[k], "x.panel", &panel[k], &bytes, &err));
    for (int i = 0; i < 30; i++) {
        float place[2] = {0.033f * (float)i, 1 - 0.021f * (float)i}, xyz[3][3];
        float rgb[3] = {i % 2 ? 255 : 0, i % 2 ? 200 : 0, 0};
        for (int k = 0; k < 3; k++)
            panel_place_emission_xyz(panel[k], place, direction_deg(i, 7 * i), rgb, xyz[k]);
        for (int k = 1; k < 3; k++)
            for (int j = 0; j < 3; j++)
                assert_near(xyz[k][j], xyz[0][j], 2e-4 * (double)xyz[0][j] + 1e-6);
    }
    for (int k = 0; k < 3; k++) panel_close(panel[k]);
    assert_fails_as(try_manifest(MAP("\"file\": \"bad.png\""), "x.panel", panel, &bytes, &err),
                    ERROR_INPUT, "8 bits a channel");
}

/* A bent display and a camera close by: what only the angle made is taken out again. */
TEST(what_the_camera_saw_under_an_angle_is_no_mura) {
    Panel *panel;
    FileBytes bytes;
    char text[16384], cosines[8192];
    const float rgb[3] = {255, 255, 255};
    size_t n = (size_t)snprintf(text, sizeof text, "theta,phi,X,Y,Z\n");
    for (int t = 0; t <= 85; t += 5) /* light that falls with the cosine's square */
        for (int p = 0; p < 360; p += t ? 30 : 360)
            n += (size_t)snprintf(text + n, sizeof text - n, "%d,%d,%.7g,%.7g,%.7g\n", t, p,
                                  95 * pow(cos(radians_from_degrees(t)), 2),
                                  100 * pow(cos(radians_from_degrees(t)), 2),
                                  108 * pow(cos(radians_from_degrees(t)), 2));
    fixture_file(&folder, "cosine.csv", text);
    /* 300 mm wide, bent by 1 rad towards the viewer (R = 300 mm), camera at 500 mm. */
    n = (size_t)snprintf(cosines, sizeof cosines, "column,row,Y\n");
    for (int i = 0; i < 21; i++) {
        double a = (i + 0.5) / 21 - 0.5, x = 300 * sin(a), z = 300 * (1 - cos(a));
        double to[2] = {-x, 500 - z};
        double c = (-to[0] * sin(a) + to[1] * cos(a)) / hypot(to[0], to[1]);
        n += (size_t)snprintf(cosines + n, sizeof cosines - n, "%d,0,%.8g\n", i, c * c);
    }
    fixture_file(&folder, "seen.csv", cosines);
    assert_done(try_manifest(
        "{\"size_mm\": [300, 100], " WHITE(
            "cosine.csv") ", \"uniformity\": {\"file\": \"seen.csv\", \"camera_mm\": 500, "
                          "\"bend_deg\": 57.29577951308232}}",
        "x.panel", &panel, &bytes, &err));
    PanelEvenness e = panel_figure_evenness(panel, rgb);
    assert_true(panel_non_uniformity(e.least, e.most) < 2e-3);
    panel_close(panel);
}

TEST_PROGRAM(start, fixture_group_end)
