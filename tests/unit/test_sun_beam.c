/* SPDX-License-Identifier: Apache-2.0 */
/* The sun's direct beam above the horizon and, from the air, below the horizontal. */
#include "sky_fixture.h"
#include "sky/sun_beam.h"

static const Air clear_air = {1013.25, 1.4, 0.34, 0.17, 1.14, 0.2};
static const double altitudes_m[] = {0, 3000, 12000, 20000};

static SunBeam beam_at(double altitude_m, double elevation_deg) {
    SunBeamPath path = {altitude_m, 0, radians_from_degrees(elevation_deg)};
    return sun_beam(&clear_air, &path, 1);
}

/* Watts, lux and air mass change together and without steps, through the horizontal too. */
TEST(a_setting_sun_fades_smoothly_at_every_altitude) {
    for (size_t k = 0; k < sizeof altitudes_m / sizeof *altitudes_m; k++) {
        double edge = -horizon_dip_deg(altitudes_m[k]), before_step[3] = {1, 1, 1};
        SunBeam before = beam_at(altitudes_m[k], 10);
        for (double e = 9.95; e >= edge; e -= 0.05) {
            SunBeam now = beam_at(altitudes_m[k], e);
            double step[3] = {now.air_mass / before.air_mass, now.lux / before.lux,
                              now.w_m2 / before.w_m2};
            assert_true(step[0] > 1 && step[1] < 1 && step[2] < 1);
            /* bright light loses what the eye sees first: the beam reddens */
            assert_true(step[1] < step[2]);
            /* depth grows by a third a step where the ray dives into the haze */
            for (int i = 0; i < 3; i++) {
                double change = log(step[i]), last = log(before_step[i]);
                if (e < 9.9) assert_true(fabs(change - last) < 0.35 * fabs(last) + 0.01);
                before_step[i] = step[i];
            }
            before = now;
        }
        printf("%5.0f m, at the edge %.2f degrees: air mass %.1f, %.3g W/m2, %.3g lx\n",
               altitudes_m[k], edge, before.air_mass, before.w_m2, before.lux);
    }
}

TEST(a_high_sun_has_spectrl2s_beam) {
    for (int elevation = 20; elevation <= 90; elevation += 10) {
        SunBeam beam = beam_at(0, elevation);
        Spectrl2 ground = spectrl2(&clear_air, 90 - elevation, 1);
        assert_close(beam.air_mass, air_mass(90 - elevation), 5e-3);
        assert_close(beam.w_m2, spectrl2_total(ground.direct), 5e-3);
    }
    SunBeam near = sun_beam(&clear_air, &(SunBeamPath){0, 0, 1}, 0.98);
    assert_close(near.w_m2 * 0.98 * 0.98, beam_at(0, degrees_from_radians(1)).w_m2, 1e-9);
}

ARENA_TEST(the_figures_of_a_sun_below_the_horizontal_agree) {
    static const double elevation_deg[] = {0.1, -0.1, -3.1, -3.6, -3.9};
    double lux = 1e9, watts = 1e9, mass = 0;
    for (int i = 0; i < 5; i++) {
        if (i == 2 && !all_laws()) continue;
        Arena scratch = arena;
        DaylightInput input = sun_at_deg(elevation_deg[i]);
        input.where.altitude_m = 12000;
        const DaylightMetrics *f = &daylight_of(&input, &scratch)->metrics;
        bool is_up = i < 4; /* the dip is 3.51 degrees, the disc's radius 0.27 */
        printf("12 km, %.1f degrees: %.4g W/m2, %.4g lx, air mass %.1f\n", elevation_deg[i],
               f->direct_normal_w_m2, f->direct_normal_lx, f->air_mass);
        assert_int_equal(f->is_sun_up, is_up);
        assert_int_equal(f->direct_normal_lx > 0, is_up);
        assert_int_equal(f->direct_normal_w_m2 > 0, is_up);
        assert_int_equal(f->air_mass > 0, is_up);
        assert_true(f->direct_normal_lx < lux && f->direct_normal_w_m2 < watts);
        assert_true(!is_up || f->air_mass > mass);
        assert_true(i != 1 || (f->direct_normal_lx > 0.9 * lux && f->air_mass < 1.1 * mass));
        lux = f->direct_normal_lx, watts = f->direct_normal_w_m2, mass = f->air_mass;
    }
}

TEST_PROGRAM(make_arena, drop_arena)
