/* SPDX-License-Identifier: Apache-2.0 */
/* Reflection tables of any layout: as many samples of a closed form tell as much on rings
 * about the mirror direction, scattered, or with other directions at each incidence as on a
 * grid; what samples do not surround is said, and held. */
#include <stdlib.h>
#include <string.h>

#include "reflection_fixture.h"
#include "panel/fit/common/scatter_surface.h"
#include "panel/fit/common/table_rows.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_info.h"

#define ROWS_MAX 4000
#define TOGETHER 2.0 /* times a grid's error, rms */
#define ROOM 0.002   /* of it, besides: what the coder may leave */

/* ---- layouts ----------------------------------------------------------------------------- */

typedef struct Layout {
    Vec3 direction[ROWS_MAX];
    int  rows;
} Layout;

typedef void LayoutMaker(double theta_i, Layout *out);

#define CONE_DEG 80.0

static void add(Layout *out, Vec3 d)
{
    if ((double)d.z >= cos(radians_from_degrees(CONE_DEG + 1e-4)))
        out->direction[out->rows++] = d;
}

/* Round an axis in the plane of incidence, `theta` from the normal. */
static Vec3 around(double theta, double angle, double turn)
{
    double a = radians_from_degrees(angle), t = radians_from_degrees(turn);
    double x = sin(a) * cos(t), y = sin(a) * sin(t), z = cos(a);
    return vec3((float)(cos(theta) * x + sin(theta) * z), (float)y,
                (float)(cos(theta) * z - sin(theta) * x));
}

static void normal_rings(double theta_i, Layout *out)
{
    (void)theta_i;
    add(out, vec3(0, 0, 1));
    for (double a = 5; a <= 80; a += 5)
        for (double t = 0; t < 360; t += 10) add(out, around(0, a, t));
}

static void mirror_rings(double theta_i, Layout *out)
{
    static const double ring[] = {5, 10, 15, 20, 25, 30, 35, 40, 50, 60, 70, 80, 90, 105, 120,
                                  135, 150};
    add(out, around(theta_i, 0, 0));
    for (size_t i = 0; i < sizeof ring / sizeof *ring; i++)
        for (double t = 0; t < 360; t += 10) add(out, around(theta_i, ring[i], t));
}

/* Evenly by the golden angle, each moved at random; other ones at each incidence. */
static void scattered(double theta_i, Layout *out)
{
    unsigned state = 1 + (unsigned)(1000 * theta_i);
    for (int i = 0; i < 577; i++) {
        state = 1664525 * state + 1013904223;
        double u = (state >> 8) / 16777216.0;
        state = 1664525 * state + 1013904223;
        double v = (state >> 8) / 16777216.0;
        double z = 1 - (i + u) / 577 * (1 - cos(radians_from_degrees(CONE_DEG)));
        add(out, around(0, degrees_from_radians(acos(z)), 137.50776 * i + 6 * v));
    }
}

static void mixed(double theta_i, Layout *out)
{
    if (theta_i < 0.3) normal_rings(theta_i, out);
    else if (theta_i < 1.0) mirror_rings(theta_i, out);
    else scattered(theta_i, out);
}

/* ---- closed forms ------------------------------------------------------------------------ */

typedef struct Lobe {
    double width_deg, height, floor;
    double noise; /* of its samples, relative, rms */
} Lobe;

static double lobe_of(const Lobe *lobe, double theta_i, Vec3 d)
{
    double cosine = sin(theta_i) * (double)d.x + cos(theta_i) * (double)d.z;
    double angle = acos(fmin(1, cosine)) / radians_from_degrees(lobe->width_deg);
    return lobe->floor + lobe->height * exp(-angle * angle) * (1 + theta_i * theta_i);
}

/* ---- sets -------------------------------------------------------------------------------- */

static int by_direction(const void *a, const void *b)
{
    const float *p = a, *q = b;
    return p[0] != q[0] ? (p[0] > q[0]) - (p[0] < q[0]) : (p[1] > q[1]) - (p[1] < q[1]);
}

static AngleTable table_of(const Layout *layout, const Lobe *lobe, double theta_i, Arena *arena)
{
    float (*row)[3] = arena_alloc(arena, (size_t)layout->rows, 8, sizeof *row);
    float *theta = ARENA_NEW(arena, float, layout->rows);
    float *phi = ARENA_NEW(arena, float, layout->rows);
    float *value = ARENA_NEW(arena, float, layout->rows);
    uint32_t random = 5;
    for (int i = 0; i < layout->rows; i++) {
        Vec3   d = layout->direction[i];
        double error = lobe->noise * sqrt(12) * (steady_random(&random) - 0.5);
        double turn = atan2((double)d.y, (double)d.x);
        row[i][0] = (float)atan2(hypot((double)d.x, (double)d.y), (double)d.z);
        row[i][1] = (float)(turn < 0 ? turn + 2 * PI : turn);
        row[i][2] = (float)(lobe_of(lobe, theta_i, d) * (1 + error));
    }
    qsort(row, (size_t)layout->rows, sizeof *row, by_direction);
    for (int i = 0; i < layout->rows; i++)
        theta[i] = row[i][0], phi[i] = row[i][1], value[i] = row[i][2];
    return (AngleTable){.name = "table", .rows = layout->rows, .channels = 1, .theta = theta,
                        .phi = phi, .value = value, .theta_max = theta[layout->rows - 1]};
}

static const double incidence_deg[] = {10, 30, 50, 70};
#define COUNT 4

static Fitted fit_layout(LayoutMaker *make, const Lobe *lobe)
{
    Fitted     f;
    FitOptions options = quick();
    fixture_folder(&f.fit);
    Measurement *set = ARENA_NEW(&f.fit.arena, Measurement, 1);
    Layout      *layout = ARENA_NEW(&f.fit.arena, Layout, 1);
    set->file = set->panel = set->instrument = set->note = "";
    set->incidence_count = COUNT;
    set->azimuth_count = set->wavelength_count = 1;
    set->wavelength_nm[0] = 550;
    set->brdf = ARENA_NEW(&f.fit.arena, AngleTable, COUNT);
    for (int i = 0; i < COUNT; i++) {
        set->incidence[i] = radians_from_degrees(incidence_deg[i]);
        layout->rows = 0;
        make(set->incidence[i], layout);
        set->brdf[i] = table_of(layout, lobe, set->incidence[i], &f.fit.arena);
    }
    f.fit.set = set;
    fixture_fit(&f.fit, &options);
    return f;
}

/* rms relative to the truth at the measured incidences, up to 75 degrees. */
static double error_of(LayoutMaker *make, const Lobe *lobe)
{
    Fitted f = fit_layout(make, lobe);
    double squares = 0, count = 0;
    for (int i = 0; i < COUNT; i++)
        for (double a = 1.7; a <= 75; a += 4.3)
            for (double t = 3; t < 360; t += 13) {
                double theta_i = radians_from_degrees(incidence_deg[i]);
                double truth = lobe_of(lobe, theta_i, direction_deg(a, t));
                double found = brdf_deg(f.fit.panel, (double[]){a, t},
                                        (double[]){incidence_deg[i], 180}, 0);
                squares += (found / truth - 1) * (found / truth - 1);
                count++;
            }
    fitted_end(&f);
    return sqrt(squares / count);
}

/* ---- laws -------------------------------------------------------------------------------- */

TEST(any_layout_fits_like_a_grid)
{
    static const Lobe lobes[] = {{25, 0.03, 0.006, 0}, {12, 0.2, 0.01, 0}};
    static LayoutMaker *const layouts[] = {mirror_rings, mixed};
    for (size_t k = 0; k < sizeof lobes / sizeof *lobes; k++) {
        double grid = error_of(normal_rings, &lobes[k]);
        for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++) {
            double error = error_of(layouts[i], &lobes[k]);
            if (!(error <= TOGETHER * grid + ROOM))
                fail_msg("lobe %g, layout %zu: rms %.4f, grid %.4f", lobes[k].width_deg, i,
                         error, grid);
        }
    }
}

/* Rings up to 40 degrees about the mirror direction: inside it is measured, outside held. */
static void narrow_rings(double theta_i, Layout *out)
{
    add(out, around(theta_i, 0, 0));
    for (double ring = 4; ring <= 40; ring += 4)
        for (double t = 0; t < 360; t += 12) add(out, around(theta_i, ring, t));
}

/* Off the mirror direction, radians. */
static double off_mirror(double theta_i, Vec3 d)
{
    return acos(fmin(1, sin(theta_i) * (double)d.x + cos(theta_i) * (double)d.z));
}

TEST(outside_of_the_samples_values_are_held_and_said_to_be_extrapolated)
{
    Lobe   lobe = {25, 0.1, 0.005, 0};
    ENDS_BY(fitted_end) Fitted f = fit_layout(narrow_rings, &lobe);
    double ring = radians_from_degrees(40), near = radians_from_degrees(3);
    for (int i = 0; i < COUNT; i++)
        for (double a = 1; a < 90; a += 4)
            for (double t = 0; t < 360; t += 15) {
                double theta_i = radians_from_degrees(incidence_deg[i]);
                Vec3   d = direction_deg(a, t), light = direction_deg(incidence_deg[i], 180);
                double off = off_mirror(theta_i, d), edge = lobe_of(&lobe, theta_i,
                                                                    around(theta_i, 40, 180));
                double here = brdf_deg(f.fit.panel, (double[]){a, t},
                                       (double[]){incidence_deg[i], 180}, 0);
                bool is_measured = panel_brdf_is_measured(f.fit.panel, d, light);
                if (off < ring - near && a < CONE_DEG - 8) assert_true(is_measured);
                if (off > ring + near || a > CONE_DEG + 2) assert_false(is_measured);
                if (off > ring && a < 60) assert_close(here, edge, 0.06);
                assert_true(here > 0.9 * lobe.floor);
            }
    double share = json_number_at(f.fit.report, "total/extrapolated_share");
    assert_true(share > 0.5 && share < 0.9);
}

/* What surrounds the cone has no hulls in its file, and what was measured is its cone. */
TEST(scattered_samples_of_the_whole_cone_need_no_hulls)
{
    Lobe lobe = {25, 0.1, 0.005, 0};
    ENDS_BY(fitted_end) Fitted f = fit_layout(scattered, &lobe);
    assert_false(panel_info_has_hulls(f.fit.panel));
    assert_true(panel_brdf_is_measured(f.fit.panel, direction_deg(77, 123),
                                       direction_deg(40, 180)));
    assert_false(panel_brdf_is_measured(f.fit.panel, direction_deg(83, 123),
                                        direction_deg(40, 180)));
}

/* 3000 points are many patches: through each of them, and smooth between. */
TEST(a_surface_of_many_patches_is_smooth)
{
    Arena   arena = arena_reserve(1 << 28);
    Layout *layout = ARENA_NEW(&arena, Layout, 1);
    Lobe    lobe = {30, 1, 0.5, 0};
    for (int i = 0; i < 3000; i++)
        add(layout, around(0, degrees_from_radians(acos(1 - (i + 0.5) / 3000 * 0.8)),
                           137.50776 * i));
    AngleTable table = table_of(layout, &lobe, 0.5, &arena);
    const ScatterSurface *surface = scatter_surface_make(&table, false, table.value, 1, &arena);
    double worst = 0, step = 0;
    float  before = 0, here;
    for (int i = 0; i < table.rows; i++) {
        scatter_surface_read(surface, table_row_direction(&table, i), &here);
        worst = fmax(worst, fabs((double)(here - table.value[i])));
    }
    for (int i = 0; i < 20000; i++) {
        Vec3 d = around(0, 60.0 * i / 20000, 33);
        scatter_surface_read(surface, d, &here);
        worst = fmax(worst, fabs((double)here - lobe_of(&lobe, 0.5, d)));
        if (i) step = fmax(step, fabs((double)(here - before)));
        before = here;
    }
    assert_in_range((unsigned long)(1e6 * worst), 0, 500);
    assert_in_range((unsigned long)(1e6 * step), 0, 200);
    arena_release(&arena);
}

/* Rings of 2 degrees have samples that stand close together: a surface through their noise
 * would swing far. */
TEST(a_surface_passes_beside_noise_and_tells_it)
{
    Arena   arena = arena_reserve(1 << 28);
    Layout *layout = ARENA_NEW(&arena, Layout, 1);
    Lobe    lobe = {30, 1, 0.5, 0};
    float   here;
    double  squares = 0, count = 0;
    uint32_t seed = 7;
    for (double ring = 2; ring <= 42; ring += 4)
        for (double t = 0; t < 360; t += 8) add(layout, around(0.5, ring, t));
    AngleTable table = table_of(layout, &lobe, 0.5, &arena);
    float     *noisy = ARENA_NEW(&arena, float, table.rows);
    for (int i = 0; i < table.rows; i++) /* evenly, standard deviation 0.02 */
        noisy[i] = table.value[i] + 0.0693f * (float)(steady_random(&seed) - 0.5);
    const ScatterSurface *surface = scatter_surface_make(&table, false, noisy, 1, &arena);
    for (double ring = 0; ring <= 40; ring += 3)
        for (double t = 5; t < 360; t += 20, count++) {
            Vec3 d = around(0.5, ring, t);
            scatter_surface_read(surface, d, &here);
            squares += ((double)here - lobe_of(&lobe, 0.5, d)) *
                       ((double)here - lobe_of(&lobe, 0.5, d));
        }
    assert_true(sqrt(squares / count) < 0.015);
    assert_close(scatter_surface_noise(surface), 0.02, 0.3);
    arena_release(&arena);
}

/* ---- holes ------------------------------------------------------------------------------- */

#define HOLE_DEG 8.0

/* 1200 directions; none near the mirror direction. */
static void holed(double theta_i, Layout *out)
{
    for (int i = 0; i < 1200; i++) {
        Vec3 d = around(0, degrees_from_radians(acos(1 - (i + 0.5) / 1200)), 137.50776 * i);
        if (off_mirror(theta_i, d) > radians_from_degrees(HOLE_DEG)) add(out, d);
    }
}

/* The hole filled in steps. */
static double step_deg;

static void filled(double theta_i, Layout *out)
{
    holed(theta_i, out);
    add(out, around(theta_i, 0, 0));
    for (double ring = step_deg; ring < HOLE_DEG; ring += step_deg)
        for (double t = 0; t < 359; t += degrees_from_radians(step_deg / ring))
            add(out, around(theta_i, ring, t));
}

static double between(const Fitted *f)
{
    return json_number_at(f->fit.report, "judged/reflection_between_samples/worst");
}

/* The verdict names a hole at a narrow peak; what it says to measure there is enough. */
TEST(a_hole_at_a_peak_wants_care_and_its_advice_works)
{
    Lobe lobe = {12, 0.2, 0.01, 0};
    ENDS_BY(fitted_end) Fitted f = fit_layout(holed, &lobe);
    const char *reason = json_string_value(
        json_array_get(json_object_get(f.fit.report, "reasons"), 0));
    const char *step = reason ? strstr(reason, "measure every ") : NULL;
    assert_true(between(&f) > 0.15);
    assert_non_null(step);
    assert_non_null(strstr(reason, "no sample lies within "));
    step_deg = strtod(step + strlen("measure every "), NULL);
    assert_true(step_deg > 0.5 && step_deg < HOLE_DEG);
    ENDS_BY(fitted_end) Fitted whole = fit_layout(filled, &lobe);
    assert_true(between(&whole) < 0.15);
    assert_string_equal(json_string_value(json_object_get(whole.fit.report, "verdict")),
                        "good");
}

/* What may be noise or fine structure is no "good" panel: the sentence says how much. */
TEST(samples_that_scatter_want_care)
{
    Lobe steady = {25, 0.03, 0.006, 0.005}, unsteady = {25, 0.03, 0.006, 0.06};
    ENDS_BY(fitted_end) Fitted good = fit_layout(scattered, &steady);
    ENDS_BY(fitted_end) Fitted poor = fit_layout(scattered, &unsteady);
    double spread = json_number_at(poor.fit.report, "judged/reflection_spread");
    char  *reasons = json_dumps(json_object_get(poor.fit.report, "reasons"), 0);
    assert_true(json_number_at(good.fit.report, "judged/reflection_spread") < 0.02);
    assert_true(spread > 0.03 && spread < 0.12);
    assert_non_null(strstr(reasons, "the samples scatter by "));
    assert_non_null(strstr(reasons, "measure in half the steps"));
    free(reasons);
}

/* What a surface says of itself: it errs by about as much as it doubts. */
TEST(a_surface_knows_how_far_it_is_off)
{
    static const double widths[] = {6, 12, 25};
    Arena   arena = arena_reserve(1 << 28);
    Layout *layout = ARENA_NEW(&arena, Layout, 1);
    scattered(0.5, layout);
    for (size_t k = 0; k < sizeof widths / sizeof *widths; k++) {
        Lobe       lobe = {widths[k], 1, 0.2, 0};
        AngleTable table = table_of(layout, &lobe, 0.5, &arena);
        const ScatterSurface *surface = scatter_surface_make(&table, false, table.value, 1,
                                                             &arena);
        double missed = 0, doubted = 0;
        for (double t = 0; t < 360; t += 7)
            for (double a = 1; a < widths[k]; a += 1) {
                Vec3         d = around(0.5, a, t);
                ScatterDoubt doubt;
                float        here;
                scatter_surface_read(surface, d, &here);
                scatter_surface_doubt(surface, &d, 1, &doubt, arena);
                double miss = (double)here - lobe_of(&lobe, 0.5, d);
                double sigma = scatter_doubt_sigma(&doubt);
                missed += miss * miss, doubted += sigma * sigma;
            }
        if (!(doubted > missed / 9 && doubted < 25 * missed))
            fail_msg("lobe %g: off by %g, doubt %g", widths[k], sqrt(missed), sqrt(doubted));
    }
    arena_release(&arena);
}

/* ---- emission ---------------------------------------------------------------------------- */

static AngleTable lit_table(const AngleTable *of, double share, Arena *arena)
{
    AngleTable out = *of;
    float     *value = ARENA_NEW(arena, float, 3 * of->rows);
    for (int i = 0; i < 3 * of->rows; i++) value[i] = (float)(share * (double)of->value[i / 3]);
    out.channels = 3;
    out.value = value;
    return out;
}

/* Harmonics of the azimuth ran away between scattered samples: 10 % and more of the light. */
TEST(an_emission_of_scattered_samples_is_as_smooth_as_they_are)
{
    Fitted     f;
    FitOptions options = quick();
    Lobe       lobe = {25, 300, 150, 0};
    fixture_folder(&f.fit);
    Measurement *set = ARENA_NEW(&f.fit.arena, Measurement, 1);
    Layout      *layout = ARENA_NEW(&f.fit.arena, Layout, 1);
    set->file = set->panel = set->instrument = set->note = "";
    scattered(0.5, layout);
    AngleTable bare = table_of(layout, &lobe, 0.5, &f.fit.arena);
    for (int p = 0; p < 3; p++) {
        static const double shares[] = {0.2, 0.7, 0.1};
        set->primary[p].level_count = 1;
        set->primary[p].level[0] = 255;
        set->primary[p].table[0] = lit_table(&bare, shares[p], &f.fit.arena);
    }
    f.fit.set = set;
    fixture_fit(&f.fit, &options);
    double worst = 0;
    for (double a = 1; a < 75; a += 4)
        for (double t = 0; t < 360; t += 11) {
            Vec3  d = around(0, a, t);
            float xyz[3], white[3] = {255, 255, 255};
            panel_emission_xyz(f.fit.panel, d, white, xyz);
            worst = fmax(worst, fabs((double)xyz[1] / lobe_of(&lobe, 0.5, d) - 1));
        }
    assert_true(worst < 0.02);
    assert_true(json_number_at(f.fit.report, "judged/emission_between_samples/light") < 0.01);
    fitted_end(&f);
}

TEST_PROGRAM(NULL, NULL)
