/* SPDX-License-Identifier: Apache-2.0 */
/* Reflection tables of any layout: as many samples of a closed form show as much on rings
 * about the mirror direction, scattered, or with other directions at each incidence as on a
 * grid; what samples do not surround is said, and held. */
#include "scatter_fixture.h"

#include "panel/fit/common/scatter_surface.h"
#include "panel/fit/common/table_rows.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_info.h"

#define TOGETHER 2.0 /* times a grid's error, rms */
#define ROOM 0.002   /* of it, besides: what the coder may leave */

/* rms relative to the truth at the measured incidences, up to 75 degrees. */
static double error_of(LayoutMaker *make, const Lobe *lobe) {
    Fitted f = fit_layout(make, lobe);
    double squares = 0, count = 0;
    for (int i = 0; i < COUNT; i++)
        for (double a = 1.7; a <= 75; a += 4.3)
            for (double t = 3; t < 360; t += 13) {
                double theta_i = radians_from_degrees(incidence_deg[i]);
                double truth = lobe_of(lobe, theta_i, direction_deg(a, t));
                double found =
                    brdf_deg(f.fit.panel, (double[]){a, t}, (double[]){incidence_deg[i], 180}, 0);
                squares += (found / truth - 1) * (found / truth - 1);
                count++;
            }
    fitted_end(&f);
    return sqrt(squares / count);
}

/* ---- laws -------------------------------------------------------------------------------- */

TEST(any_layout_fits_like_a_grid) {
    static const Lobe lobes[] = {{25, 0.03, 0.006, 0}, {12, 0.2, 0.01, 0}};
    static LayoutMaker *const layouts[] = {mirror_rings, mixed};
    for (size_t k = all_laws() ? 0 : 1; k < sizeof lobes / sizeof *lobes; k++) {
        double grid = error_of(normal_rings, &lobes[k]);
        for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++) {
            double error = error_of(layouts[i], &lobes[k]);
            if (!(error <= TOGETHER * grid + ROOM))
                fail_msg("lobe %g, layout %zu: rms %.4f, grid %.4f", lobes[k].width_deg, i, error,
                         grid);
        }
    }
}

/* Rings up to 40 degrees about the mirror direction: inside it is measured, outside held. */
static void narrow_rings(double theta_i, Layout *out) {
    add(out, around(theta_i, 0, 0));
    for (double ring = 4; ring <= 40; ring += 4)
        for (double t = 0; t < 360; t += 12) add(out, around(theta_i, ring, t));
}

TEST(outside_of_the_samples_values_are_held_and_said_to_be_extrapolated) {
    Lobe lobe = {25, 0.1, 0.005, 0};
    ENDS_BY(fitted_end) Fitted f = fit_layout(narrow_rings, &lobe);
    double ring = radians_from_degrees(40), near = radians_from_degrees(3);
    for (int i = 0; i < COUNT; i++)
        for (double a = 1; a < 90; a += 4)
            for (double t = 0; t < 360; t += 15) {
                double theta_i = radians_from_degrees(incidence_deg[i]);
                Vec3 d = direction_deg(a, t), light = direction_deg(incidence_deg[i], 180);
                double off = off_mirror(theta_i, d),
                       edge = lobe_of(&lobe, theta_i, around(theta_i, 40, 180));
                double here =
                    brdf_deg(f.fit.panel, (double[]){a, t}, (double[]){incidence_deg[i], 180}, 0);
                bool is_measured = panel_brdf_is_measured(f.fit.panel, d, light);
                if (off < ring - near && a < CONE_DEG - 8) assert_true(is_measured);
                if (off > ring + near || a > CONE_DEG + 2) assert_false(is_measured);
                if (off > ring && a < 60) assert_close(here, edge, 0.06);
                assert_true(here > 0.9 * lobe.floor);
            }
    double share = json_number_at(f.fit.report, "total/extrapolated_share");
    assert_true(share > 0.5 && share < 0.9);
}

/* What was measured is the cone that the samples surround. */
TEST(scattered_samples_of_the_whole_cone_need_no_hulls) {
    Lobe lobe = {25, 0.1, 0.005, 0};
    ENDS_BY(fitted_end) Fitted f = fit_layout(scattered, &lobe);
    assert_true(
        panel_brdf_is_measured(f.fit.panel, direction_deg(77, 123), direction_deg(40, 180)));
    assert_false(
        panel_brdf_is_measured(f.fit.panel, direction_deg(83, 123), direction_deg(40, 180)));
}

/* 3000 points are many patches: through each of them, and smooth between. */
TEST(a_surface_of_many_patches_is_smooth) {
    Arena arena = arena_reserve(1 << 28);
    Layout *layout = ARENA_NEW(&arena, Layout, 1);
    Lobe lobe = {30, 1, 0.5, 0};
    for (int i = 0; i < 3000; i++)
        add(layout,
            around(0, degrees_from_radians(acos(1 - (i + 0.5) / 3000 * 0.8)), 137.50776 * i));
    AngleTable table = table_of(layout, &lobe, 0.5, &arena);
    const ScatterSurface *surface = scatter_surface_make(&table, false, table.value, 1, &arena);
    double worst = 0, step = 0;
    float before = 0, here;
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
TEST(a_surface_passes_beside_noise_and_tells_it) {
    Arena arena = arena_reserve(1 << 28);
    Layout *layout = ARENA_NEW(&arena, Layout, 1);
    Lobe lobe = {30, 1, 0.5, 0};
    float here;
    double squares = 0, count = 0;
    uint32_t seed = 7;
    for (double ring = 2; ring <= 42; ring += 4)
        for (double t = 0; t < 360; t += 8) add(layout, around(0.5, ring, t));
    AngleTable table = table_of(layout, &lobe, 0.5, &arena);
    float *noisy = ARENA_NEW(&arena, float, table.rows);
    for (int i = 0; i < table.rows; i++) /* evenly, standard deviation 0.02 */
        noisy[i] = table.value[i] + 0.0693f * (float)(steady_random(&seed) - 0.5);
    const ScatterSurface *surface = scatter_surface_make(&table, false, noisy, 1, &arena);
    for (double ring = 0; ring <= 40; ring += 3)
        for (double t = 5; t < 360; t += 20, count++) {
            Vec3 d = around(0.5, ring, t);
            scatter_surface_read(surface, d, &here);
            squares +=
                ((double)here - lobe_of(&lobe, 0.5, d)) * ((double)here - lobe_of(&lobe, 0.5, d));
        }
    assert_true(sqrt(squares / count) < 0.015);
    assert_close(scatter_surface_noise(surface), 0.02, 0.3);
    arena_release(&arena);
}

/* ---- what a surface knows --------------------------------------------------------------- */

/* What a surface says of itself: it errs by about as much as it doubts. */
TEST(a_surface_knows_how_far_it_is_off) {
    static const double widths[] = {6, 12, 25};
    Arena arena = arena_reserve(1 << 28);
    Layout *layout = ARENA_NEW(&arena, Layout, 1);
    scattered(0.5, layout);
    for (size_t k = 0; k < sizeof widths / sizeof *widths; k++) {
        Lobe lobe = {widths[k], 1, 0.2, 0};
        AngleTable table = table_of(layout, &lobe, 0.5, &arena);
        const ScatterSurface *surface = scatter_surface_make(&table, false, table.value, 1, &arena);
        double missed = 0, doubted = 0;
        for (double t = 0; t < 360; t += all_laws() ? 7 : 28)
            for (double a = 1; a < widths[k]; a += 1) {
                Vec3 d = around(0.5, a, t);
                ScatterDoubt doubt;
                float here;
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

static AngleTable lit_table(const AngleTable *of, double share, Arena *arena) {
    AngleTable out = *of;
    float *value = ARENA_NEW(arena, float, 3 * of->rows);
    for (int i = 0; i < 3 * of->rows; i++) value[i] = (float)(share * (double)of->value[i / 3]);
    out.channels = 3;
    out.value = value;
    return out;
}

/* Harmonics of the azimuth ran away between scattered samples: 10 % and more of the light. */
TEST(an_emission_of_scattered_samples_is_as_smooth_as_they_are) {
    Fitted f;
    FitOptions options = quick();
    Lobe lobe = {25, 300, 150, 0};
    fixture_folder(&f.fit);
    Measurement *set = ARENA_NEW(&f.fit.arena, Measurement, 1);
    Layout *layout = ARENA_NEW(&f.fit.arena, Layout, 1);
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
            Vec3 d = around(0, a, t);
            float xyz[3], white[3] = {255, 255, 255};
            panel_emission_xyz(f.fit.panel, d, white, xyz);
            worst = fmax(worst, fabs((double)xyz[1] / lobe_of(&lobe, 0.5, d) - 1));
        }
    assert_true(worst < 0.02);
    assert_true(json_number_at(f.fit.report, "judged/emission_between_samples/light") < 0.01);
    fitted_end(&f);
}

TEST_PROGRAM(NULL, NULL)
