/* EULUMDAT and IES LM-63: luminous intensities as luminances of a flat panel. */
#include "lab_fixture.h"

#include "base/units.h"

/* ---- EULUMDAT ---------------------------------------------------------------------------- */

#define HEAD_LINES                                                                             \
    "Maker\n2\n%d\n%d\n%g\n%d\n%g\nreport\nLamp 7\nno\nfile\ndate\n"                           \
    "100\n50\n20\n%g\n%g\n0\n0\n0\n0\n100\n%g\n%g\n0\n1\n%d\nLED\n%g\n4000K\n80\n10\n"         \
    "1\n1\n1\n1\n1\n1\n1\n1\n1\n1\n"

typedef struct Ldt {
    int    symmetry, planes, gammas, stored, lamps;
    double length_mm, width_mm, ratio, factor, flux;
} Ldt;

static const Ldt plain = {1, 4, 19, 1, 1, 200, 100, 80, 1, 2000};

/* Intensity of the stored plane k at a gamma: Lambertian, k + 1 times as bright. */
static char *ldt_text(Lab *lab, const Ldt *ldt)
{
    char  *text = ARENA_NEW(&lab->arena, char, 1 << 18);
    double c_step = 360.0 / ldt->planes, step = 90.0 / (ldt->gammas - 1);
    size_t at = (size_t)sprintf(text, HEAD_LINES, ldt->symmetry, ldt->planes, c_step,
                                ldt->gammas, step, ldt->length_mm, ldt->width_mm, ldt->ratio,
                                ldt->factor, ldt->lamps, ldt->flux);
    for (int i = 0; i < ldt->planes; i++) at += (size_t)sprintf(text + at, "%g\n", i * c_step);
    for (int i = 0; i < ldt->gammas; i++) at += (size_t)sprintf(text + at, "%g\n", i * step);
    for (int k = 0; k < ldt->stored; k++)
        for (int i = 0; i < ldt->gammas; i++)
            at += (size_t)sprintf(text + at, "%.9g\n",
                                  (k + 1) * 100 * cos(radians_from_degrees(i * step)));
    return text;
}

static const ImportTable *import_ldt(Lab *lab, const Ldt *ldt)
{
    lab_write(lab, "lamp.ldt", ldt_text(lab, ldt));
    lab_import(lab);
    return lab_table(lab, IMPORT_WHITE, 255);
}

/* 100 cd/klm, 2000 lm, 0.02 m2: 10,000 cd/m2 everywhere; flux pi I0 = 628 lm of 1600. */
LAB_TEST(a_lambertian_luminaire_is_equally_bright_everywhere)
{
    Lab *lab = *state;
    const ImportTable *white = import_ldt(lab, &plain);
    assert_int_equal(white->rows, 36 * 18); /* not the horizon */
    for (int i = 0; i < white->rows; i++) assert_close(white->value[3 * i + 1], 10000, 1e-6);
    assert_true(lab_noted(lab, "the file states 1600 lm (lamps' flux times light output "
                               "ratio): ratio 0.392"));
    assert_string_equal(lab->set.panel, "Lamp 7");
}

LAB_TEST(area_factor_and_absolute_flux_count)
{
    Lab *lab = *state;
    Ldt  round = plain, factor = plain, absolute = plain;
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
LAB_TEST(symmetries_fill_the_other_planes)
{
    static const struct { int symmetry, stored; double at[4]; } cases[] = {
        {0, 4, {1, 2, 3, 4}}, {1, 1, {1, 1, 1, 1}},
        {2, 3, {1, 2, 3, 2}},  /* C0, C90, C180 */
        {3, 3, {2, 3, 2, 1}},  /* C270, C0, C90 */
        {4, 2, {1, 2, 1, 2}}}; /* C0, C90 */
    Lab *lab = *state;
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

LAB_TEST(eulumdat_is_refused_with_its_line)
{
    Lab *lab = *state;
    Ldt  no_area = plain, odd = plain, dark = plain;
    no_area.length_mm = no_area.width_mm = 0;
    lab_write(lab, "lamp.ldt", ldt_text(lab, &no_area));
    lab_refused(lab, "lamp.ldt: states no luminous area, which luminance needs — give it with "
                     "--area-mm W,H");
    odd.symmetry = 3;
    odd.planes = 6;
    lab_write(lab, "lamp.ldt", ldt_text(lab, &odd));
    lab_refused(lab, "lamp.ldt: line 4: has 6 C-planes, wanted a multiple of 4 for symmetry 3");
    dark.flux = 0;
    lab_write(lab, "lamp.ldt", ldt_text(lab, &dark));
    lab_refused(lab, "lamp.ldt: line 32: the lamps' flux is 0 lm, wanted the flux that the "
                     "intensities belong to");
    char *text = ldt_text(lab, &plain);
    memcpy(strstr(text, "\n2\n1\n") + 3, "9", 1);
    lab_write(lab, "lamp.ldt", text);
    lab_refused(lab, "lamp.ldt: line 3: the symmetry is '9', wanted a number from 0 to 4");
    text = ldt_text(lab, &plain);
    strstr(text, "\n5\n10\n")[1] = 0;
    lab_write(lab, "lamp.ldt", text);
    lab_refused(lab, "lamp.ldt: line 48: the file ends before the angle");
}

static void no_prefix_is_taken(Lab *lab, const char *name, const char *text, size_t whole)
{
    lab_write(lab, name, text);
    for (size_t n = 0; n < whole; n++) {
        Arena before = lab->arena;
        lab_write_bytes(lab, name, text, n);
        if (lab_run(lab)) fail_msg("a prefix of %zu of %zu bytes is taken", n, whole);
        assert_true(lab->err.text[0] != 0);
        lab->arena = before;
    }
}

LAB_TEST(a_cut_eulumdat_is_refused)
{
    Lab  *lab = *state;
    Ldt   small = plain;
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

static const ImportTable *import_ies(Lab *lab, const char *text)
{
    lab_write(lab, "lamp.ies", text);
    lab_import(lab);
    return lab_table(lab, IMPORT_WHITE, 255);
}

LAB_TEST(intensity_over_area_times_cosine_is_luminance)
{
    Lab *lab = *state;
    const ImportTable *white = import_ies(lab, IES_HEAD "1 400 2 4 1 1 2 .5 .2 0\n"
                                               "1.1 1 60\n" GAMMAS "0\n" PLANE_1);
    assert_close(lab_value(white, 0, 0, 1), 2200, 1e-6);
    assert_close(lab_value(white, 60, 250, 1), 2200, 1e-6);
    assert_int_equal(white->rows, 36 * 3);
    assert_string_equal(lab->set.panel, "Panel 60");
    assert_true(lab_noted(lab, "the file states 440 lm"));
}

LAB_TEST(sizes_may_be_feet_and_circles)
{
    static const struct { const char *sizes; double area_m2; } cases[] = {
        {"2 .5 .2 0", 0.1}, {"1 1 2 0", 2 * 0.3048 * 0.3048}, {"2 -.2 -.2 0", PI * 0.01},
        {"2 -.2 0 0", PI * 0.01}, {"2 -.4 -.2 0", PI * 0.02}, {"2 -.1 .5 .1", 0.05}};
    Lab *lab = *state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const ImportTable *white = import_ies(lab, arena_format(&lab->arena, IES_HEAD
            "1 -1 1 4 1 1 %s\n1 1 60\n" GAMMAS "0\n" PLANE_1, cases[i].sizes));
        assert_close(lab_value(white, 30, 0, 1), 100 / cases[i].area_m2, 1e-6);
    }
}

LAB_TEST(the_range_of_horizontal_angles_tells_the_symmetry)
{
    static const struct { const char *planes; double at[4]; } cases[] = {
        {"2 1 2 1 1 0\n1 1 9\n" GAMMAS "0 90\n" PLANE_1 PLANE_2, {1, 2, 1, 2}},
        {"3 1 2 1 1 0\n1 1 9\n" GAMMAS "0 90 180\n" PLANE_1 PLANE_2 PLANE_3, {1, 2, 3, 2}},
        {"3 1 2 1 1 0\n1 1 9\n" GAMMAS "90 180 270\n" PLANE_1 PLANE_2 PLANE_3, {2, 1, 2, 3}},
        {"5 1 2 1 1 0\n1 1 9\n" GAMMAS "0 90 180 270 360\n" PLANE_1 PLANE_2 PLANE_3 PLANE_2
         PLANE_1, {1, 2, 3, 2}},
        {"4 1 2 1 1 0\n1 1 9\n" GAMMAS "0, 90, 180, 270\n" PLANE_1 PLANE_3 PLANE_2 PLANE_2,
         {1, 3, 2, 2}}};
    Lab *lab = *state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const ImportTable *white = import_ies(lab, arena_format(&lab->arena, IES_HEAD
                                              "1 -1 1 4 %s", cases[i].planes));
        for (int quarter = 0; quarter < 4; quarter++)
            assert_close(lab_value(white, 60, -90.0 * quarter, 1), 100 * cases[i].at[quarter],
                         1e-6);
    }
}

LAB_TEST(tilts_are_passed_over_and_light_behind_is_told)
{
    Lab *lab = *state;
    const ImportTable *white = import_ies(lab,
        "IESNA91\nTILT=INCLUDE\n1\n3\n0 45 90\n1 .9\n.8\n1 1000 1 3 1 1 2 1 1 0\n1 1 9\n"
        "0 90 180\n0\n100\n100 100\n");
    assert_int_equal(white->rows, 36);
    assert_true(lab_noted(lab, "tilt factors are not applied"));
    assert_true(lab_noted(lab, "50% of the flux goes beyond 90 degrees"));
    /* A sphere of 100 cd: 400 pi lm. */
    assert_true(lab_noted(lab, "1256.64 lm in all directions, the file states 1000 lm"));
}

LAB_TEST(ies_is_refused_with_its_line)
{
    static const struct { const char *text, *message;
    } cases[] = {{"IESNA91\n1 1 1\n", "lamp.ies: has no line TILT="},
                 {IES_HEAD "1 -1 1 4 1 2 2 1 1 0\n1 1 9\n", "lamp.ies: line 6: is photometry "
                                                            "of type B (2), wanted type C (1)"},
                 {IES_HEAD "1 -1 1 4 1 3 2 1 1 0\n1 1 9\n", "lamp.ies: line 6: is photometry "
                                                            "of type A (3), wanted type C (1)"},
                 {IES_HEAD "1 -1 1 4 1 1 2 0 0 0\n1 1 9\n" GAMMAS "0\n" PLANE_1,
                  "lamp.ies: states no luminous area, which luminance needs — give it with "
                  "--area-mm W,H"},
                 {IES_HEAD "1 -1 1 4 2 1 2 1 1 0\n1 1 9\n" GAMMAS "0 45\n" PLANE_1 PLANE_1,
                  "lamp.ies: line 8: horizontal angles go from 0 to 45, wanted 0, 0 to 90, 0 "
                  "to 180, 90 to 270 or 0 to 360 degrees"},
                 {IES_HEAD "1 -1 1 4 1 1 2 1 1 0\n1 1 9\n0 30 20 90\n0\n" PLANE_1,
                  "lamp.ies: line 7: the vertical angle 20 follows 30, wanted rising angles"},
                 {IES_HEAD "1 -1 1 99999 1 1 2 1 1 0\n", "lamp.ies: line 5: the number of "
                                                         "vertical angles is '99999', wanted a "
                                                         "number from 2 to 4096"},
                 {IES_HEAD "1 -1 1 4.5 1 1 2 1 1 0\n", "lamp.ies: line 5: the number of "
                                                       "vertical angles is 4.5, wanted a whole "
                                                       "number"},
                 {IES_HEAD "1 -1 1 4 1 1 2 1 1 0\n1 1 9\n" GAMMAS "0\n1 2 x\n",
                  "lamp.ies: line 9: an intensity is 'x', wanted a number from -1e+09 to "
                  "1e+09"},
                 {IES_HEAD "1 -1 1 2 1 1 2 1 1 0\n1 1 9\n90 180\n0\n0 5\n",
                  "lamp.ies: shines nothing within 90 degrees of gamma 0, wanted a luminaire "
                  "that lights in front of its face"}};
    Lab *lab = *state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lab_write(lab, "lamp.ies", cases[i].text);
        lab_refused(lab, cases[i].message);
    }
}

LAB_TEST(a_cut_ies_is_refused)
{
    static const char text[] = IES_HEAD "1 -1 1 4 1 1 2 1 1 0\n1 1 9\n" GAMMAS "0\n100 86 50 ";
    no_prefix_is_taken(*state, "lamp.ies", text, sizeof text);
}

/* ---- real files -------------------------------------------------------------------------- */

static double ratio_noted(const Lab *lab)
{
    for (int i = 0; i < lab->set.note_count; i++) {
        const char *at = strstr(lab->set.note[i], "ratio ");
        while (at && strstr(at + 1, "ratio ")) at = strstr(at + 1, "ratio ");
        if (at && at[6] >= '0' && at[6] <= '9') return strtod(at + 6, NULL);
    }
    return 0;
}

static double lumens_noted(const Lab *lab)
{
    for (int i = 0; i < lab->set.note_count; i++) {
        const char *at = strstr(lab->set.note[i], ".ies: ");
        if (at && strstr(at, " lm in all directions")) return strtod(at + 6, NULL);
    }
    return 0;
}

/* The flux that the tables add up to beside what the file, its name or its lamp's line says. */
LAB_TEST(real_luminaires_add_up_to_their_lumens)
{
    static const struct { const char *name; double ratio, lumens, within; } cases[] = {
        {"FL_MAX_900W_SYM60.ldt", 1, 0, 0.002}, {"road_luminaire.ldt", 1, 0, 0.005},
        {"Indoor_60W_5300lm.ies", 0, 5300, 0.001}, {"threejs_007cfb.ies", 0, 321, 0.001},
        {"ASA_15M_R2.ies", 0.735, 0, 0.002}, {"examp1.ies", 0.913, 0, 0.002},
        {"ABSOLUTE_LED.ies", 0, 0, 0}};
    Lab *lab = *state;
    if (!file_exists(SHARED_DATA_DIR "/photometry/road_luminaire.ldt")) skip();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lab->file[0] = arena_format(&lab->arena, "%s/photometry/%s", SHARED_DATA_DIR,
                                    cases[i].name);
        lab->count = 1;
        lab_import(lab);
        if (cases[i].ratio > 0) assert_close(ratio_noted(lab), cases[i].ratio, cases[i].within);
        if (cases[i].lumens > 0)
            assert_close(lumens_noted(lab), cases[i].lumens, cases[i].within);
    }
    lab->file[0] = SHARED_DATA_DIR "/photometry/MAXWELL_measured_IESNA.ies";
    assert_false(lab_run(lab));
    assert_non_null(strstr(lab->err.text, "--area-mm"));
    lab->request->options.area_mm[0] = lab->request->options.area_mm[1] = 100;
    lab_import(lab);
}

int main(void)
{
    return run_cases(NULL, NULL);
}
