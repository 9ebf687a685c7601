/* SPDX-License-Identifier: Apache-2.0 */
/* The scattering atmosphere and the skies made of it: energy, known figures, convergence. */

#include "base/units.h"
#include "fixture.h"
#include "sky/air/diffuse_light.h"
#include "sky/daylight.h"
#include "sky/sun_disc.h"
#include "spectrum/photometry.h"

static const Air usual = {1013.25, 1.42, 0.344, 0.1, 1.14, 0.2};

static Atmosphere build(double observer_m, double floor_m, double albedo, double elevation_deg,
                        Arena *arena) {
    AtmosphereInput input = {usual, observer_m, floor_m, radians_from_degrees(elevation_deg), 2, 0,
                             false, 0,          0};
    Atmosphere atmosphere;
    input.air.ground_albedo = albedo;
    assert_done(atmosphere_build(&input, arena, &atmosphere, &err));
    return atmosphere;
}

static DaylightInput clear_day(const char *when, double altitude_m) {
    DaylightInput input = daylight_input_default(DAYLIGHT_CLEAR);
    input.has_time = true;
    input.threads = 2;
    input.where = (SkyPlace){48.14, 11.58, altitude_m};
    assert_done(sky_time_parse(when, "", &input.when, &err));
    return input;
}

/* ---- columns ----------------------------------------------------------------------------- */

TEST(columns_add_up_over_altitude_and_slant) {
    AirOptics optics = air_optics(&usual);
    double whole[AIR_PARTS], low[AIR_PARTS], high[AIR_PARTS], slant[AIR_PARTS];
    air_vertical(&optics, 0, AIR_TOP_M, whole);
    air_vertical(&optics, 0, 9000, low);
    air_vertical(&optics, 9000, AIR_TOP_M, high);
    for (int p = 0; p < AIR_PARTS; p++) {
        assert_near(whole[p], 1, 1e-3);
        assert_close(low[p] + high[p], whole[p], 1e-12);
    }
    assert_true(air_column(&optics, 0, cos(radians_from_degrees(60)), 0, slant));
    assert_close(slant[AIR_MOLECULES], air_mass(60), 2e-3);
    assert_true(air_column(&optics, 0, 1e-9, 0, slant));
    assert_in(slant[AIR_MOLECULES], 34, 42); /* Kasten and Young: 38 */
    assert_false(air_column(&optics, 1000, -0.5, 0, slant));
    assert_true(air_column(&optics, 12000, -0.05, 0, slant)); /* over the dipped horizon */
}

TEST(density_is_the_columns_derivative) {
    AirOptics optics = air_optics(&usual);
    for (int p = 0; p < AIR_PARTS; p++) {
        double sum = 0, step = 25, column[AIR_PARTS];
        for (double z = 0.5 * step; z < AIR_TOP_M; z += step)
            sum += step * air_density(&optics, (AirPart)p, z);
        air_vertical(&optics, 0, AIR_TOP_M, column);
        assert_close(sum, column[p], 2e-4);
    }
}

/* Over 2 cm the column grows as the density just below says, where one layer of the standard
 * atmosphere meets the next, too. */
TEST(the_pressure_has_no_step_between_layers) {
    static const double bases[7] = {11000, 20000, 32000, 47000, 51000, 71000, 84852};
    AirOptics optics = air_optics(&usual);
    optics.top_m = AIR_HIGHEST_TOP_M;
    for (int i = 0; i < 7; i++) {
        double column[AIR_PARTS], z = bases[i];
        air_vertical(&optics, z - 0.01, z + 0.01, column);
        double density = air_density(&optics, AIR_MOLECULES, z - 20);
        assert_close(column[AIR_MOLECULES], 0.02 * density, 0.01);
    }
}

TEST(phase_functions_integrate_to_one) {
    double sum[2] = {0, 0};
    for (int i = 0; i < 20000; i++) {
        float c = -1 + 2 * ((float)i + 0.5f) / 20000;
        sum[0] += 2 * PI * 2.0 / 20000 * (double)air_phase_molecules(c);
        sum[1] += 2 * PI * 2.0 / 20000 * (double)air_phase_aerosol(c);
    }
    assert_near(sum[0], 1, 1e-5);
    assert_near(sum[1], 1, 1e-5);
}

/* ---- energy ------------------------------------------------------------------------------ */

/* Air that absorbs nothing over a white floor gives back all light: what comes down on the
 * floor, times 1 - albedo, is what does not leave at the top. */
ARENA_TEST(air_without_absorption_keeps_the_light) {
    Air air = usual;
    air.ozone_atm_cm = 0;
    AirOptics optics = air_optics(&air);
    optics.scattering[AIR_AEROSOL] = optics.depth[AIR_AEROSOL];
    for (int white = 0; white <= 1; white++) {
        DiffuseLight light;
        DiffuseInput input = {&optics, 0, white, 0.8, 0};
        Arena scratch = arena;
        diffuse_light_build(&input, &scratch, &light);
        for (int k = 0; k < SPECTRUM_LANES; k++) {
            double down = (double)(light.ground_direct[k] + light.ground_diffuse[k]);
            double taken = (1 - white) * down, given = (double)light.top_exitance[k];
            assert_close(taken + given, 0.8, 6e-3);
        }
    }
}

ARENA_TEST(orders_of_scattering_add_up_to_the_whole) {
    AirOptics optics = air_optics(&usual);
    float before = 0;
    for (int orders = 1; orders <= 8; orders++) {
        DiffuseLight light;
        DiffuseInput input = {&optics, 0, 0.2, 0.7, orders};
        Arena scratch = arena;
        diffuse_light_build(&input, &scratch, &light);
        assert_true(light.ground_diffuse[2] > before);
        before = light.ground_diffuse[2];
    }
    DiffuseLight whole;
    DiffuseInput input = {&optics, 0, 0.2, 0.7, 0};
    diffuse_light_build(&input, &arena, &whole);
    assert_close(before, whole.ground_diffuse[2], 0.01);
}

/* ---- azimuth ----------------------------------------------------------------------------- */

#define GREEN 8

/* Light scattered once, at the bottom of flat air of one scatterer above a black floor, looking
 * up (both in closed form: Chandrasekhar 1960, section 1.7), per unit of its single-scattering
 * albedo; all directions are looked along. */
static double scattered_once(const double look[3], const double sun[3], double depth) {
    float angle = (float)(look[0] * sun[0] + look[1] * sun[1] + look[2] * sun[2]);
    double u = look[2], s = sun[2] + 1e-9;
    return (double)air_phase_aerosol(angle) * s / (s - u) * (exp(-depth / s) - exp(-depth / u));
}

/* What of that is scattered again, at the bottom, to an eye that looks along a direction:
 * summed over all directions that the light can come from. */
static double scattered_twice(const double look[3], const double sun[3], double depth) {
    const int rows = 200, columns = 240;
    double sum = 0;
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++) {
            double z = (i + 0.5) / rows, r = sqrt(1 - z * z);
            double turn = 2 * PI * (j + 0.5) / columns;
            double from[3] = {r * cos(turn), r * sin(turn), z};
            float angle = (float)(look[0] * from[0] + look[1] * from[1] + look[2] * z);
            sum += (double)air_phase_aerosol(angle) * scattered_once(from, sun, depth);
        }
    return sum * 2 * PI / rows / columns;
}

static AirOptics only_aerosol(void) {
    Air air = usual;
    air.pressure_mbar = air.ozone_atm_cm = 0;
    return air_optics(&air);
}

/* Against a sum over directions that knows no series: haze scatters forwards, so its second
 * order, too, is brighter towards the sun. */
ARENA_TEST(the_second_order_lies_towards_the_sun) {
    AirOptics optics = only_aerosol();
    DiffuseLight light;
    const double sun[3] = {cos(0.6), 0, sin(0.6)};
    DiffuseInput input = {&optics, 0, 0, sun[2], 1};
    diffuse_light_build(&input, &arena, &light);
    double depth = (double)optics.depth[AIR_AEROSOL][GREEN], before = 1e9;
    double albedo = (double)optics.scattering[AIR_AEROSOL][GREEN] / depth;
    double unit = albedo * (double)optics.scattering[AIR_AEROSOL][GREEN] *
                  air_density(&optics, AIR_AEROSOL, 0);
    for (int i = 0; i <= 4; i++) { /* looks from the sun's azimuth to the opposite */
        double azimuth = PI * i / 4, up = 0.25;
        double look[3] = {sqrt(1 - up * up) * cos(azimuth), sqrt(1 - up * up) * sin(azimuth), up};
        Spectrum mode[DIFFUSE_MODES], source;
        DiffusePlace at = diffuse_light_place(&light, 0, (float)-up);
        diffuse_light_modes(&light, &at, mode);
        diffuse_light_source(mode, (float)cos(azimuth), &source);
        double want = unit * scattered_twice(look, sun, depth);
        printf("%3.0f degrees from the sun's azimuth: %.3e, summed %.3e\n",
               degrees_from_radians(azimuth), (double)source[GREEN], want);
        assert_close((double)source[GREEN], want, 0.05);
        assert_true(want < before);
        before = want;
    }
}

/* The same in the drawn sky, by flat layers and by spherical air. */
ARENA_TEST(light_scattered_often_is_brighter_towards_the_sun) {
    static const double elevation_deg[] = {20, -6};
    for (int i = 0; i < 2; i++) {
        Arena scratch = arena;
        Atmosphere a = build(0, 0, 0, elevation_deg[i], &scratch);
        for (int row = 1; row < ATMOSPHERE_ROWS / 2; row += 8) {
            const Spectrum *rest = a.rest + (size_t)row * ATMOSPHERE_COLUMNS;
            for (int k = 2; k < 14; k++) assert_true(rest[0][k] > rest[ATMOSPHERE_COLUMNS - 1][k]);
        }
    }
}

/* ---- figures ----------------------------------------------------------------------------- */

ARENA_TEST(the_sky_gives_what_spectrl2_says) {
    static const double zenith_deg[] = {0, 30, 48.2, 60, 75};
    for (int i = 0; i < 5; i++) {
        Arena scratch = arena;
        Atmosphere a = build(0, 0, 0.2, 90 - zenith_deg[i], &scratch);
        Spectrl2 s = spectrl2(&usual, zenith_deg[i], 1);
        Spectrum diffuse = atmosphere_diffuse(&a);
        double sums[2] = {0, 0};
        for (int k = 3; k < 13; k++) { /* 420 to 680 nm: bands without gases */
            double nm = (double)AIR_NM[k], daylight = spectrl2_read(s.outside, nm);
            double y = (double)spectral_row(nm).y;
            sums[0] += y * (double)diffuse[k] * daylight;
            sums[1] += y * spectrl2_read(s.diffuse, nm);
            if (nm < 580 || (nm > 600 && nm < 660))
                assert_close((double)a.sun_passing[k], spectrl2_read(s.direct, nm) / daylight,
                             0.01);
        }
        printf("sun %4.1f deg from the zenith: diffuse light over SPECTRL2's %.3f\n", zenith_deg[i],
               sums[0] / sums[1]);
        assert_in(sums[0] / sums[1], 0.97, 1.13);
    }
}

ARENA_TEST(steps_and_tables_have_converged) {
    for (int low = 0; low <= 1; low++) {
        AtmosphereInput input = {usual, low ? 11000 : 0, 0, low ? 0.03 : 0.7, 2, 0, false, 0, 0};
        Atmosphere coarse, fine;
        double worst = 0;
        assert_done(atmosphere_build(&input, &arena, &coarse, &err));
        input.steps = 400;
        assert_done(atmosphere_build(&input, &arena, &fine, &err));
        for (float e = -1.5f; e < 1.55f; e += 0.11f)
            for (float az = 0; az < 3.1f; az += 0.4f) {
                Spectrum a = atmosphere_radiance(&coarse, e, az);
                Spectrum b = atmosphere_radiance(&fine, e, az);
                worst = fmax(worst, fabs((double)(a[8] / b[8]) - 1));
            }
        printf("48 steps against 400, observer at %g m: at most %.2f %%\n", input.observer_m,
               100 * worst);
        assert_in(worst, 0, 0.02);
    }
}

ARENA_TEST(the_sky_darkens_with_altitude_and_the_sun_gains) {
    double zenith = 1e9, sun = 0;
    for (double altitude = 0; altitude <= 15000; altitude += 3000) {
        Arena scratch = arena;
        Atmosphere a = build(altitude, 0, 0.2, 45, &scratch);
        double now = (double)atmosphere_radiance(&a, (float)(PI / 2), 0)[8];
        assert_true(now < zenith && (double)a.sun_passing[8] > sun);
        zenith = now;
        sun = (double)a.sun_passing[8];
    }
}

ARENA_TEST(an_airliner_sees_126_klx_of_sun_and_a_dipped_horizon) {
    DaylightInput input = daylight_input_default(DAYLIGHT_CLEAR);
    Daylight *out = arena_alloc(&arena, sizeof *out, 64, 1);
    input.has_sun = true;
    input.threads = 2;
    input.sun_elevation = PI / 2;
    input.where.altitude_m = 10668;
    input.floor = FLOOR_CLOUD;
    assert_done(daylight_build(&input, &arena, out, &err));
    assert_close(out->metrics.direct_normal_lx, 126092, 0.01);
    assert_in(out->metrics.horizon_deg, -3.1, -2.9);   /* of the deck, 2000 m high */
    assert_in(out->metrics.floor_cd_m2, 24000, 33000); /* AS8034's forward field: 34,300 */
    assert_true(daylight_luminance(out, -0.06f, 1) > 3000);
}

ARENA_TEST(the_drawn_sky_integrates_to_its_stated_illuminance) {
    for (int kind = 0; kind < 5; kind++) {
        Arena scratch = arena;
        Daylight *out = arena_alloc(&scratch, sizeof *out, 64, 1);
        DaylightInput input = clear_day("2026-06-21T08:30+02:00", kind == 4 ? 9000 : 520);
        double sum = 0;
        input.kind = kind < 2 ? DAYLIGHT_CIE : kind < 3 ? DAYLIGHT_PEREZ : DAYLIGHT_CLEAR;
        input.cie_type = kind ? 12 : 1;
        input.diffuse_lux = 12000;
        input.direct_w_m2 = 700, input.diffuse_w_m2 = 120;
        assert_done(daylight_build(&input, &scratch, out, &err));
        const int rows = 500, columns = 500;
        for (int i = 0; i < rows; i++)
            for (int j = 0; j < columns; j++) {
                double share = (i + 0.5) / rows, e = PI / 2 * share * share;
                double step = PI * share / rows;
                float azimuth = (float)(2 * PI * j / columns);
                sum += (double)daylight_luminance(out, (float)e, azimuth) * sin(e) * cos(e) * step *
                       2 * PI / columns;
            }
        assert_close(sum, out->metrics.diffuse_horizontal_lx, 1e-3);
    }
}

ARENA_TEST(spectral_radiance_has_the_stated_luminance) {
    for (int kind = 0; kind < 3; kind++) {
        Arena scratch = arena;
        Daylight *out = arena_alloc(&scratch, sizeof *out, 64, 1);
        DaylightInput input = clear_day("2026-03-21T17:30+01:00", 520);
        double y = 0, sun = 0;
        input.kind = (DaylightKind)kind;
        input.sun_lux = kind == DAYLIGHT_CIE ? 50000 : -1;
        input.direct_w_m2 = 700, input.diffuse_w_m2 = 120;
        assert_done(daylight_build(&input, &scratch, out, &err));
        for (int i = 0; i < 256; i++) {
            Wavelengths lanes;
            wavelengths_sample(((float)i + 0.5f) / 256, &lanes);
            y += (double)spectrum_sum(daylight_radiance(out, 0.6f, 2, &lanes) * lanes.xyz[1]) / 256;
            for (int r = 0; r < 50; r++) {
                float share = sqrtf(((float)r + 0.5f) / 50);
                sun += (double)spectrum_sum(daylight_sun(out, share, &lanes) * lanes.xyz[1]) /
                       (50 * 256);
            }
        }
        assert_close(y, (double)daylight_luminance(out, 0.6f, 2), 3e-3);
        double disc = PI * pow(sin(out->sun_radius), 2);
        assert_close(sun * disc, out->metrics.direct_normal_lx, 3e-3);
    }
}

ARENA_TEST(twilight_fades_and_night_is_told) {
    static const double elevation_deg[] = {0, -2, -4, -6};
    double before = 3000;
    for (int i = 0; i < 4; i++) {
        Arena scratch = arena;
        Daylight *out = arena_alloc(&scratch, sizeof *out, 64, 1);
        DaylightInput input = daylight_input_default(DAYLIGHT_CLEAR);
        Error err;
        input.has_sun = true;
        input.threads = 2;
        input.sun_elevation = radians_from_degrees(elevation_deg[i]);
        assert_true(daylight_build(&input, &scratch, out, &err));
        assert_true(out->metrics.diffuse_horizontal_lx < before / 1.5);
        assert_true(out->metrics.diffuse_horizontal_lx > 0.5);
        assert_int_equal(out->metrics.is_sun_up, i == 0);
        assert_int_equal(daylight_sun_clearance_deg(&input) > 0, i == 0);
        before = out->metrics.diffuse_horizontal_lx;
    }
    Arena scratch = arena;
    Daylight *out = arena_alloc(&scratch, sizeof *out, 64, 1);
    DaylightInput input = clear_day("2026-06-21T01:00+02:00", 520);
    Error err;
    input.kind = DAYLIGHT_PEREZ;
    input.direct_w_m2 = 0, input.diffuse_w_m2 = 10;
    assert_false(daylight_build(&input, &scratch, out, &err));
    assert_non_null(strstr(err.text, "below the horizon"));
}

ARENA_TEST(what_makes_no_sky_is_refused) {
    Daylight *out = arena_alloc(&arena, sizeof *out, 64, 1);
    DaylightInput input = daylight_input_default(DAYLIGHT_CLEAR);
    assert_fails(daylight_build(&input, &arena, out, &err), "time and a place");
    input.has_sun = true;
    input.floor = FLOOR_CLOUD;
    assert_fails(daylight_build(&input, &arena, out, &err), "cloud deck"); /* under the deck */
    input = daylight_input_default(DAYLIGHT_CIE);
    input.cie_type = 17;
    assert_fails(daylight_build(&input, &arena, out, &err), "");
}

TEST_PROGRAM(make_arena, drop_arena)
