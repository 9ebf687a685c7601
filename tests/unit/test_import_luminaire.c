/* SPDX-License-Identifier: Apache-2.0 */
/* EULUMDAT and IES LM-63: luminous intensities as luminances of a flat panel. */
#include "lab_fixture.h"

#include "base/units.h"
#include "import/luminaire/ies.h"
#include "import/luminaire/luminaire_opening.h"

/* ---- EULUMDAT ---------------------------------------------------------------------------- */

#define HEAD_LINES \
    "Maker\n2\n%d\n%d\n%g\n%d\n%g\nreport\nLamp 7\nno\nfile\ndate\n" \
    "100\n50\n20\n%g\n%g\n0\n0\n0\n0\n100\n%g\n%g\n0\n1\n%d\nLED\n%g\n4000K\n80\n10\n" \
    "1\n1\n1\n1\n1\n1\n1\n1\n1\n1\n"

typedef struct Ldt {
    int symmetry, planes, gammas, stored, lamps;
    double length_mm, width_mm, ratio, factor, flux;
} Ldt;

static const Ldt plain = {1, 4, 19, 1, 1, 200, 100, 80, 1, 2000};

/* Intensity of the stored plane k at a gamma: Lambertian, k + 1 times as bright. */
static char *ldt_text(Lab *lab, const Ldt *ldt) {
    char *text = ARENA_NEW(&lab->arena, char, 1 << 18);
    double c_step = 360.0 / ldt->planes, step = 90.0 / (ldt->gammas - 1);
    size_t at = (size_t)sprintf(text, HEAD_LINES, ldt->symmetry, ldt->planes, c_step, ldt->gammas,
                                step, ldt->length_mm, ldt->width_mm, ldt->ratio, ldt->factor,
                                ldt->lamps, ldt->flux);
    for (int i = 0; i < ldt->planes; i++) at += (size_t)sprintf(text + at, "%g\n", i * c_step);
    for (int i = 0; i < ldt->gammas; i++) at += (size_t)sprintf(text + at, "%g\n", i * step);
    for (int k = 0; k < ldt->stored; k++)
        for (int i = 0; i < ldt->gammas; i++)
            at += (size_t)sprintf(text + at, "%.9g\n",
                                  (k + 1) * 100 * cos(radians_from_degrees(i * step)));
    return text;
}

static const ImportTable *import_ldt(Lab *lab, const Ldt *ldt) {
    lab_write(lab, "lamp.ldt", ldt_text(lab, ldt));
    lab_import(lab);
    return lab_table(lab, IMPORT_WHITE, 255);
}

/* 100 cd/klm, 2000 lm, 0.02 m2: 10,000 cd/m2 everywhere; flux pi I0 = 628 lm of 1600. */
LAB_TEST(a_lambertian_luminaire_is_equally_bright_everywhere) {
    const ImportTable *white = import_ldt(lab, &plain);
    assert_int_equal(white->rows, 36 * 18); /* not the horizon */
    for (int i = 0; i < white->rows; i++) assert_close(white->value[3 * i + 1], 10000, 1e-6);
    assert_true(lab_noted(lab, "the file states 1600 lm (lamps' flux times light output "
                               "ratio): ratio 0.392"));
    assert_string_equal(lab->set.panel, "Lamp 7");
}

LAB_TEST(area_factor_and_absolute_flux_count) {
    Ldt round = plain, factor = plain, absolute = plain;
    round.width_mm = 0;
    assert_close(lab_value(import_ldt(lab, &round), 0, 0, 1), 200 / (PI * 0.01), 1e-6);
    factor.factor = 1.5;
    assert_close(lab_value(import_ldt(lab, &factor), 0, 0, 1), 15000, 1e-6);
    absolute.lamps = -1;
    assert_close(lab_value(import_ldt(lab, &absolute), 0, 0, 1), 10000, 1e-6);
    assert_true(lab_noted(lab, "the file states 2000 lm (absolute)"));
    lab->request->options.area_mm[0] = lab->request->options.area_mm[1] = 100;
    assert_close(lab_value(import_ldt(lab, &plain), 0, 0, 1), 20000, 1e-6);
}

/* Brightness of each quarter plane, in units of the first stored plane's. */
LAB_TEST(symmetries_fill_the_other_planes) {
    static const struct {
        int symmetry, stored;
        double at[4];
    } cases[] = {{0, 4, {1, 2, 3, 4}},
                 {1, 1, {1, 1, 1, 1}},
                 {2, 3, {1, 2, 3, 2}},  /* C0, C90, C180 */
                 {3, 3, {2, 3, 2, 1}},  /* C270, C0, C90 */
                 {4, 2, {1, 2, 1, 2}}}; /* C0, C90 */
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Ldt ldt = plain;
        ldt.symmetry = cases[i].symmetry;
        ldt.stored = cases[i].stored;
        const ImportTable *white = import_ldt(lab, &ldt);
        for (int quarter = 0; quarter < 4; quarter++) /* C runs clockwise for the viewer */
            assert_close(lab_value(white, 45, -90.0 * quarter, 1), 10000 * cases[i].at[quarter],
                         1e-6);
    }
    lab_declare(lab, "azimuth_sense", "ccw");
    lab_declare(lab, "azimuth_zero", "top");
    Ldt ldt = plain;
    ldt.symmetry = 0;
    ldt.stored = 4;
    assert_close(lab_value(import_ldt(lab, &ldt), 45, 180, 1), 20000, 1e-6);
}

LAB_TEST(eulumdat_is_refused_with_its_line) {
    Ldt no_area = plain, odd = plain, dark = plain;
    no_area.length_mm = no_area.width_mm = 0;
    lab_write(lab, "lamp.ldt", ldt_text(lab, &no_area));
    lab_refused(lab, "lamp.ldt: states no luminous area, which luminance needs — give it with "
                     "--area-mm W,H");
    odd.symmetry = 3;
    odd.planes = 6;
    lab_write(lab, "lamp.ldt", ldt_text(lab, &odd));
    lab_refused(lab, "lamp.ldt: line 4: has 6 C-planes, required: a multiple of 4 for "
                     "symmetry 3");
    dark.flux = 0;
    lab_write(lab, "lamp.ldt", ldt_text(lab, &dark));
    lab_refused(lab, "lamp.ldt: line 32: the lamps' flux is 0 lm, required: the flux that the "
                     "intensities belong to");
    char *text = ldt_text(lab, &plain);
    memcpy(strstr(text, "\n2\n1\n") + 3, "9", 1);
    lab_write(lab, "lamp.ldt", text);
    lab_refused(lab, "lamp.ldt: line 3: the symmetry is '9', required: a number from 0 to 4");
    text = ldt_text(lab, &plain);
    strstr(text, "\n5\n10\n")[1] = 0;
    lab_write(lab, "lamp.ldt", text);
    lab_refused(lab, "lamp.ldt: line 48: the file ends before the angle");
}

static void no_prefix_is_taken(Lab *lab, const char *name, const char *text, size_t whole) {
    lab_write(lab, name, text);
    for (size_t n = 0; n < whole; n++) {
        Arena before = lab->arena;
        lab_write_bytes(lab, name, text, n);
        if (lab_run(lab)) fail_msg("a prefix of %zu of %zu bytes is taken", n, whole);
        assert_true(lab->err.text[0] != 0);
        lab->arena = before;
    }
}

LAB_TEST(a_cut_eulumdat_is_refused) {
    Ldt small = plain;
    small.gammas = 7;
    char *text = ldt_text(lab, &small);
    char *end = text + strlen(text);
    for (int newlines = 0; newlines < 2; newlines += *--end == '\n') continue;
    no_prefix_is_taken(lab, "lamp.ldt", text, (size_t)(end - text) + 1);
}

/* ---- IES --------------------------------------------------------------------------------- */

#define IES_HEAD "IESNA:LM-63-2002\n[TEST] 1\n[LUMINAIRE] Panel 60\nTILT=NONE\n"
#define GAMMAS "0 30 60 90\n"
/* Lambertian of 100 cd, times the plane's number. */
#define PLANE_1 "100 86.6025404 50 0\n"
#define PLANE_2 "200 173.205081 100 0\n"
#define PLANE_3 "300 259.807621 150 0\n"

static const ImportTable *import_ies(Lab *lab, const char *text) {
    lab_write(lab, "lamp.ies", text);
    lab_import(lab);
    return lab_table(lab, IMPORT_WHITE, 255);
}

LAB_TEST(intensity_over_area_times_cosine_is_luminance) {
    const ImportTable *white = import_ies(lab, IES_HEAD "1 400 2 4 1 1 2 .5 .2 0\n"
                                                        "1.1 1 60\n" GAMMAS "0\n" PLANE_1);
    assert_close(lab_value(white, 0, 0, 1), 2200, 1e-6);
    assert_close(lab_value(white, 60, 250, 1), 2200, 1e-6);
    assert_int_equal(white->rows, 36 * 3);
    assert_string_equal(lab->set.panel, "Panel 60");
    assert_true(lab_noted(lab, "the file states 440 lm"));
}

LAB_TEST(sizes_may_be_feet_and_circles) {
    static const struct {
        const char *sizes;
        double area_m2;
    } cases[] = {{"2 .5 .2 0", 0.1},         {"1 1 2 0", 2 * 0.3048 * 0.3048},
                 {"2 -.2 -.2 0", PI * 0.01}, {"2 -.2 0 0", PI * 0.01},
                 {"2 -.4 -.2 0", PI * 0.02}, {"2 -.1 .5 .1", PI / 4 * 0.05},
                 {"2 0 .5 -.1", 0.05},       {"2 -.2 -.3 -.4", PI / 4 * 0.06},
                 {"2 .1 -.5 -.3", 0.05},     {"2 .5 .2 .3", 0.1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const ImportTable *white =
            import_ies(lab, arena_format(&lab->arena,
                                         IES_HEAD "1 -1 1 4 1 1 %s\n1 1 60\n" GAMMAS "0\n" PLANE_1,
                                         cases[i].sizes));
        assert_close(lab_value(white, 30, 0, 1), 100 / cases[i].area_m2, 1e-6);
    }
}

LAB_TEST(the_range_of_horizontal_angles_tells_the_symmetry) {
    static const struct {
        const char *planes;
        double at[4];
    } cases[] = {
        {"2 1 2 1 1 0\n1 1 9\n" GAMMAS "0 90\n" PLANE_1 PLANE_2, {1, 2, 1, 2}},
        {"3 1 2 1 1 0\n1 1 9\n" GAMMAS "0 90 180\n" PLANE_1 PLANE_2 PLANE_3, {1, 2, 3, 2}},
        {"3 1 2 1 1 0\n1 1 9\n" GAMMAS "90 180 270\n" PLANE_1 PLANE_2 PLANE_3, {2, 1, 2, 3}},
        {"5 1 2 1 1 0\n1 1 9\n" GAMMAS "0 90 180 270 360\n" PLANE_1 PLANE_2 PLANE_3 PLANE_2 PLANE_1,
         {1, 2, 3, 2}},
        {"4 1 2 1 1 0\n1 1 9\n" GAMMAS "0, 90, 180, 270\n" PLANE_1 PLANE_3 PLANE_2 PLANE_2,
         {1, 3, 2, 2}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const ImportTable *white =
            import_ies(lab, arena_format(&lab->arena, IES_HEAD "1 -1 1 4 %s", cases[i].planes));
        for (int quarter = 0; quarter < 4; quarter++)
            assert_close(lab_value(white, 60, -90.0 * quarter, 1), 100 * cases[i].at[quarter],
                         1e-6);
    }
}

/* A panel is not tilted: the factor at 0 counts. */
LAB_TEST(the_factor_of_no_tilt_counts_and_light_behind_is_told) {
    const ImportTable *white = import_ies(
        lab, "IESNA91\nTILT=INCLUDE\n1\n3\n0 45 90\n.5 .9\n.8\n1 1000 1 3 1 1 2 1 1 0\n1 1 9\n"
             "0 90 180\n0\n200\n200 200\n");
    assert_int_equal(white->rows, 36);
    assert_close(white->value[1], 100, 1e-6);
    assert_true(lab_noted(lab, "is not tilted: of its tilt factors 0.5 is applied"));
    assert_true(lab_noted(lab, "50% of the flux goes beyond 90 degrees"));
    /* A sphere of 100 cd: 400 pi lm. */
    assert_true(lab_noted(lab, "1256.64 lm in all directions, the file states 1000 lm"));
    static const char text[] =
        "IESNA91\nTILT= a.tlt\n1 -1 1 4 1 1 2 1 1 0\n1 1 9\n" GAMMAS "0\n" PLANE_1;
    import_ies(lab, text);
    assert_true(lab_noted(lab, "its tilt factors are not there: no file"));
    lab_write(lab, "a.tlt", "2\n2\n0 90\n.25 1\n");
    lab->count--; /* beside the luminaire, not to be imported itself */
    assert_close(lab_value(import_ies(lab, text), 0, 0, 1), 25, 1e-6);
    lab_write(lab, "a.tlt", "2\n2\n0 90\n.25\n");
    lab->count--;
    lab_refused(lab, "a.tlt: line 5: the file ends before a tilt factor");
}

TEST(what_is_tilted_is_the_lamp) {
    static double angle[3] = {0, 60, 90}, factor[3] = {1, 0.7, 0.4};
    static const struct {
        int geometry;
        WebType type;
        Vec3 down;
        double tilted, factor;
    } cases[] = {{1, WEB_C, {0, 0, -1}, 0, 1},
                 {1, WEB_C, {0.5f, 0, -0.8660254f}, 30, 0.85},
                 {1, WEB_C, {0, 0.8660254f, -0.5f}, 60, 0.7},
                 {1, WEB_C, {0, 0, 1}, 0, 1},
                 {1, WEB_B, {0.8660254f, 0, 0.5f}, 60, 0.7},
                 {2, WEB_C, {0, 0, -1}, 0, 1},
                 {2, WEB_C, {0, 1, 0}, 0, 1},
                 {2, WEB_C, {1, 0, 0}, 90, 0.4},
                 {2, WEB_C, {-0.5f, 0, -0.8660254f}, 30, 0.85},
                 {3, WEB_C, {1, 0, 0}, 0, 1},
                 {3, WEB_C, {0, 0.5f, -0.8660254f}, 30, 0.85},
                 {1, WEB_A, {-1, 0, 0}, 0, 1},
                 {2, WEB_A, {0, 0, -1}, 90, 0.4},
                 {0, WEB_C, {0, 1, 0}, 0, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        LuminaireTilt tilt = {NULL, cases[i].geometry, 3, angle, factor};
        double tilted;
        assert_near(luminaire_tilt_factor(&tilt, cases[i].type, cases[i].down, &tilted),
                    cases[i].factor, 1e-5);
        assert_near(tilted, cases[i].tilted, 1e-3);
    }
    LuminaireTilt whole = {NULL, 1, 2, (double[]){0, 180}, (double[]){1, 0}};
    double tilted;
    assert_near(luminaire_tilt_factor(&whole, WEB_C, vec3(0, 0, 1), &tilted), 0, 1e-6);
}

/* ---- types A and B ----------------------------------------------------------------------- */

/* cd towards d; with sides == 0 alike for both signs of d.y. */
static double tipped_cd(Vec3 d, double sides) {
    double x = (double)d.x, y = (double)d.y, z = (double)d.z;
    return -z * (100 + 40 * x + 20 * x * z + 30 * y * y) - z * sides * 25 * y;
}

/* LM-63's angles as directions of the luminaire's frame. */
static Vec3 direction_of(WebType type, double v, double h) {
    v = radians_from_degrees(v);
    h = radians_from_degrees(h);
    if (type == WEB_C) /* v: gamma, h: C */
        return vec3((float)(sin(v) * cos(h)), (float)(sin(v) * sin(h)), -(float)cos(v));
    if (type == WEB_B)
        return vec3((float)(cos(h) * sin(v)), -(float)sin(h), -(float)(cos(h) * cos(v)));
    return vec3((float)sin(v), -(float)(cos(v) * sin(h)), -(float)(cos(v) * cos(h)));
}

typedef struct Tipped {
    WebType type;
    double h_first, sides;
} Tipped;

static char *tipped_text(Arena *arena, const Tipped *t) {
    double step = 3, v_first = t->type == WEB_C ? 0 : -90, h_last = t->type == WEB_C ? 360 : 90;
    int v_count = (int)((90 - v_first) / step) + 1;
    int h_count = (int)((h_last - t->h_first) / step) + 1;
    char *text = ARENA_NEW(arena, char, 1 << 18);
    size_t at = (size_t)sprintf(text,
                                "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 %d %d %d 2 %s\n"
                                "1 1 9\n",
                                v_count, h_count, (int)t->type + 1,
                                t->type == WEB_A ? ".1 0 .1" : ".1 .1 0");
    for (int i = 0; i < v_count; i++) at += (size_t)sprintf(text + at, "%g ", v_first + i * step);
    for (int i = 0; i < h_count; i++)
        at += (size_t)sprintf(text + at, "%g ", t->h_first + i * step);
    for (int i = 0; i < h_count; i++)
        for (int k = 0; k < v_count; k++) {
            Vec3 d = direction_of(t->type, v_first + k * step, t->h_first + i * step);
            double cd = fmax(tipped_cd(d, t->sides), 0);
            at += (size_t)sprintf(text + at, "%.7g%s", cd, k % 10 == 9 ? "\n" : " ");
        }
    return text;
}

static IntensityWeb tipped_web(Lab *lab, const Tipped *t) {
    Error err = {0};
    IntensityWeb web = {0};
    Luminaire luminaire;
    char *text = tipped_text(&lab->arena, t);
    FileBytes bytes = {(const unsigned char *)text, strlen(text)};
    lab->set = import_set(&lab->arena);
    if (!ies_read_luminaire("lamp.ies", &bytes, &lab->set, &luminaire, &err) ||
        !luminaire_web(&luminaire, &lab->arena, &web, &err))
        fail_msg("%s", err.text);
    return web;
}

/* One function of the direction written in types A, B and C: bilinear of 3 degrees is within
 * step^2 / 8 of its second derivatives. Flux: pi times 100 + 30 / 4 of the even part. */
LAB_TEST(types_a_b_and_c_of_one_lamp_are_one_lamp) {
    static const Tipped cases[] = {{WEB_C, 0, 1}, {WEB_B, -90, 1}, {WEB_A, -90, 1},
                                   {WEB_C, 0, 0}, {WEB_B, 0, 0},   {WEB_A, 0, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        IntensityWeb web = tipped_web(lab, &cases[i]);
        assert_true(web.type == cases[i].type);
        for (int k = 0; k < 4000; k++) {
            double z = 2 * ((k + 0.5) / 4000) - 1, phi = 2.399963 * k, r = sqrt(1 - z * z);
            Vec3 d = vec3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
            double wanted = z < 0 ? fmax(tipped_cd(d, cases[i].sides), 0) : 0;
            double found = (double)(intensity_web_at(&web, d) * web.largest_cd);
            if (fabs(z) > 0.003) assert_near(found, wanted, 0.35);
        }
        assert_close(web.flux_lm, PI * (100 + 30 / 4.0), 3e-3);
        Vec3 best = web.brightest;
        assert_near(web.largest_cd, tipped_cd(best, cases[i].sides), 1e-3);
    }
}

/* As the viewer sees them V runs up, H to the left, and nothing is resampled. */
LAB_TEST(types_a_and_b_are_panels_at_their_own_directions) {
    for (int type = WEB_B; type <= WEB_A; type++) {
        Tipped t = {(WebType)type, -90, 1};
        const ImportTable *white = import_ies(lab, tipped_text(&lab->arena, &t));
        assert_true(lab_noted(lab, type == WEB_A ? "type A: the viewer sees V run up"
                                                 : "type B: the viewer sees V run up"));
        assert_close(lab_value(white, 30, 90, 1),
                     tipped_cd(vec3(0.5f, 0, -0.8660254f), 1) / (0.01 * 0.8660254), 1e-5);
        assert_close(lab_value(white, 60, 180, 1),
                     tipped_cd(vec3(0, -0.8660254f, -0.5f), 1) / (0.01 * 0.5), 1e-5);
    }
}

/* ---- openings ---------------------------------------------------------------------------- */

TEST(sizes_tell_the_shape) {
    static const struct {
        int year;
        WebType type;
        double size[3];
        OpeningShape shape;
        int axis;
        double x, y, z;
    } cases[] = {{2002, WEB_C, {0, 0, 0}, OPENING_POINT, 2, 0, 0, 0},
                 {2002, WEB_C, {2, 3, 0}, OPENING_BOX, 2, 3, 2, 0},
                 {2002, WEB_C, {2, 3, 4}, OPENING_BOX, 2, 3, 2, 4},
                 {2002, WEB_C, {-2, -2, 0}, OPENING_CYLINDER, 2, 2, 2, 0},
                 {2002, WEB_C, {-2, -3, 0}, OPENING_CYLINDER, 2, 3, 2, 0},
                 {2002, WEB_C, {-2, -2, 4}, OPENING_CYLINDER, 2, 2, 2, 4},
                 {2002, WEB_C, {-2, -2, -2}, OPENING_ELLIPSOID, 2, 2, 2, 2},
                 {2002, WEB_C, {-2, 3, -4}, OPENING_CYLINDER, 0, 3, 2, 4},
                 {2002, WEB_C, {2, -3, -4}, OPENING_CYLINDER, 1, 3, 2, 4},
                 {2002, WEB_C, {-2, 0, -4}, OPENING_CYLINDER, 0, 0, 2, 4},
                 {1995, WEB_C, {-2, 0, 0}, OPENING_CYLINDER, 2, 2, 2, 0},
                 {1995, WEB_C, {-2, 0, -2}, OPENING_ELLIPSOID, 2, 2, 2, 2},
                 {1995, WEB_C, {-2, 0, 4}, OPENING_CYLINDER, 2, 2, 2, 4},
                 {1995, WEB_C, {0, 3, -2}, OPENING_CYLINDER, 0, 3, 2, 2},
                 {1995, WEB_C, {3, 0, -2}, OPENING_CYLINDER, 1, 2, 3, 2},
                 {1995, WEB_C, {-2, 3, 0}, OPENING_CYLINDER, 2, 3, 2, 0},
                 {1995, WEB_C, {2, -3, -4}, OPENING_ELLIPSOID, 2, 3, 2, 4},
                 {2002, WEB_A, {-2, 0, -2}, OPENING_CYLINDER, 2, 2, 2, 0},
                 {2002, WEB_A, {2, 0, 4}, OPENING_BOX, 2, 4, 2, 0},
                 {2002, WEB_A, {2, 3, 4}, OPENING_BOX, 2, 4, 2, 3}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        LuminousOpening o;
        assert_null(opening_of_ies(cases[i].year, cases[i].type, cases[i].size, &o));
        assert_int_equal(o.shape, cases[i].shape);
        if (o.shape == OPENING_POINT) continue;
        if (o.is_flat || o.shape == OPENING_CYLINDER) assert_int_equal(o.axis, cases[i].axis);
        assert_near(2 * o.half[0], cases[i].x, 1e-6);
        assert_near(2 * o.half[1], cases[i].y, 1e-6);
        assert_near(2 * o.half[2], cases[i].z, 1e-6);
        assert_true(o.is_flat == (o.half[0] * o.half[1] * o.half[2] == 0));
    }
    LuminousOpening o;
    assert_non_null(opening_of_ies(2002, WEB_C, (double[]){2, 3, -4}, &o));
    assert_int_equal(o.shape, OPENING_POINT);
    assert_non_null(opening_of_ies(2002, WEB_A, (double[]){2, 3, 0}, &o));
    o = opening_of_eulumdat(3, 2, 1);
    assert_true(o.shape == OPENING_BOX && o.half[0] == 1 && o.half[1] == 1.5f);
    o = opening_of_eulumdat(3, 0, 0);
    assert_true(o.shape == OPENING_CYLINDER && o.is_flat && o.half[0] == 1.5f);
}

LAB_TEST(ies_is_refused_with_its_line) {
    static const struct {
        const char *text, *message;
    } cases[] = {{"IESNA91\n1 1 1\n", "lamp.ies: has no line TILT="},
                 {IES_HEAD "1 -1 1 4 1 2 2 1 1 0\n1 1 9\n" GAMMAS "0\n" PLANE_1,
                  "lamp.ies: line 8: photometry of types A and B has one horizontal angle, "
                  "required: 0 to 90 or -90 to 90 degrees"},
                 {IES_HEAD "1 -1 1 4 2 3 2 1 1 0\n1 1 9\n" GAMMAS "0 90\n" PLANE_1 PLANE_1,
                  "lamp.ies: line 8: vertical angles of types A and B go from 0 to 90: nothing "
                  "says whether the half below is dark or the same, required: -90 to 90 "
                  "degrees"},
                 {IES_HEAD "1 -1 1 3 2 3 2 1 1 0\n1 1 9\n-90 0 90\n30 90\n1 1 1 1 1 1\n",
                  "lamp.ies: line 8: horizontal angles of types A and B go from 30 to 90, "
                  "required: 0 to 90 or -90 to 90 degrees"},
                 {IES_HEAD "1 -1 1 4 1 1 2 0 0 0\n1 1 9\n" GAMMAS "0\n" PLANE_1,
                  "lamp.ies: states no luminous area, which luminance needs — give it with "
                  "--area-mm W,H"},
                 {IES_HEAD "1 -1 1 4 2 1 2 1 1 0\n1 1 9\n" GAMMAS "0 45\n" PLANE_1 PLANE_1,
                  "lamp.ies: line 8: horizontal angles go from 0 to 45, required: 0, 0 to 90, "
                  "0 to 180, 90 to 270 or 0 to 360 degrees"},
                 {IES_HEAD "1 -1 1 4 1 1 2 1 1 0\n1 1 9\n0 30 20 90\n0\n" PLANE_1,
                  "lamp.ies: line 7: the vertical angle 20 follows 30, required: rising "
                  "angles"},
                 {IES_HEAD "1 -1 1 99999 1 1 2 1 1 0\n", "lamp.ies: line 5: the number of "
                                                         "vertical angles is '99999', "
                                                         "required: a number from 2 to 4096"},
                 {IES_HEAD "1 -1 1 4.5 1 1 2 1 1 0\n", "lamp.ies: line 5: the number of "
                                                       "vertical angles is 4.5, required: a "
                                                       "whole number"},
                 {IES_HEAD "1 -1 1 4 1 1 2 1 1 0\n1 1 9\n" GAMMAS "0\n1 2 x\n",
                  "lamp.ies: line 9: an intensity is 'x', required: a number from 0 to 1e+09"},
                 {IES_HEAD "1 -1 1 2 1 1 2 1 1 0\n1 1 9\n90 180\n0\n0 5\n",
                  "lamp.ies: shines nothing within 90 degrees of gamma 0, required: a "
                  "luminaire that lights in front of its face"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lab_write(lab, "lamp.ies", cases[i].text);
        lab_refused(lab, cases[i].message);
    }
}

LAB_TEST(a_cut_ies_is_refused) {
    static const char text[] = IES_HEAD "1 -1 1 4 1 1 2 1 1 0\n1 1 9\n" GAMMAS "0\n100 86 50 ";
    no_prefix_is_taken(lab, "lamp.ies", text, sizeof text);
}

/* ---- real files -------------------------------------------------------------------------- */

static double ratio_noted(const Lab *lab) {
    for (int i = 0; i < lab->set.note_count; i++) {
        const char *at = strstr(lab->set.note[i], "ratio ");
        while (at && strstr(at + 1, "ratio ")) at = strstr(at + 1, "ratio ");
        if (at && at[6] >= '0' && at[6] <= '9') return strtod(at + 6, NULL);
    }
    return 0;
}

static double lumens_noted(const Lab *lab) {
    for (int i = 0; i < lab->set.note_count; i++) {
        const char *at = strstr(lab->set.note[i], ".ies: ");
        if (at && strstr(at, " lm in all directions")) return strtod(at + 6, NULL);
    }
    return 0;
}

/* The flux that the tables add up to beside what the file, its name or its lamp's line says. */
LAB_TEST(real_luminaires_add_up_to_their_lumens) {
    static const struct {
        const char *name;
        double ratio, lumens, within;
    } cases[] = {{"FL_MAX_900W_SYM60.ldt", 1, 0, 0.002},
                 {"road_luminaire.ldt", 1, 0, 0.005},
                 {"Indoor_60W_5300lm.ies", 0, 5300, 0.001},
                 {"threejs_007cfb.ies", 0, 321, 0.001},
                 {"ASA_15M_R2.ies", 0.735, 0, 0.002},
                 {"examp1.ies", 0.913, 0, 0.002},
                 {"ABSOLUTE_LED.ies", 0, 0, 0}};
    if (!file_exists(SHARED_DATA_DIR "/photometry/road_luminaire.ldt")) skip();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lab->file[0] =
            arena_format(&lab->arena, "%s/photometry/%s", SHARED_DATA_DIR, cases[i].name);
        lab->count = 1;
        lab_import(lab);
        if (cases[i].ratio > 0) assert_close(ratio_noted(lab), cases[i].ratio, cases[i].within);
        if (cases[i].lumens > 0) assert_close(lumens_noted(lab), cases[i].lumens, cases[i].within);
    }
    lab->file[0] = SHARED_DATA_DIR "/photometry/MAXWELL_measured_IESNA.ies";
    assert_false(lab_run(lab));
    assert_non_null(strstr(lab->err.text, "--area-mm"));
    lab->request->options.area_mm[0] = lab->request->options.area_mm[1] = 100;
    lab_import(lab);
}

TEST_PROGRAM(NULL, NULL)
