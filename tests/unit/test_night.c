/* SPDX-License-Identifier: Apache-2.0 */
/* Clear nights: the moon as a weak sun, and the background that is always there. */
#include "sky_fixture.h"

static DaylightInput clear_moment(const char *when, SkyPlace where) {
    DaylightInput input = daylight_input_default(DAYLIGHT_CLEAR);
    input.has_time = true;
    input.threads = 2;
    input.where = where;
    input.when = moment(when);
    return input;
}

/* ---- the background ---------------------------------------------------------------------- */

static NightBackground background_of(double depth) {
    Curve sun;
    for (int i = 0; i < CURVE_COUNT; i++) sun.value[i] = 1.7f;
    return night_background(&(NightBackgroundInput){depth, -0.05, 0.2, &sun});
}

TEST(the_background_is_that_of_a_dark_place) {
    NightBackground b = background_of(0.11);
    assert_in(night_background_luminance(&b, 0.5f * PI_F), 1.7e-4f, 2.3e-4f);
    assert_in(b.horizontal_lx, 6e-4, 1e-3);
    assert_close((double)night_background_luminance(&b, -0.1f), 0.2 * b.horizontal_lx / PI, 1e-5);
    assert_close(night_background_luminance(&b, -0.02f), night_background_luminance(&b, 0),
                 1e-5); /* a dipped horizon */
}

/* Brighter by air mass 1.5 by a quarter of a magnitude (Benn and Ellison), and on to the
 * horizon where little air takes it back. */
TEST(the_background_grows_towards_the_horizon) {
    NightBackground b = background_of(0.11);
    double zenith = (double)night_background_luminance(&b, 0.5f * PI_F);
    double lower = (double)night_background_luminance(&b, (float)asin(1 / 1.5));
    assert_float_equal(2.5 * log10(lower / zenith), 0.3, 0.1);
    for (int e = 89; e >= 0; e--) {
        float here = (float)radians_from_degrees(e), above = (float)radians_from_degrees(e + 1);
        assert_true(night_background_luminance(&b, here) >= night_background_luminance(&b, above));
    }
}

TEST(the_backgrounds_illuminance_is_its_integral) {
    for (int k = 0; k < 5; k++) {
        NightBackground b = background_of(0.1 * k);
        double sum = 0;
        for (int i = 0; i < 20000; i++) {
            double e = PI / 2 * (i + 0.5) / 20000;
            sum += (double)night_background_luminance(&b, (float)e) * sin(e) * cos(e) * 2 * PI *
                   PI / 2 / 20000;
        }
        assert_close(sum, b.horizontal_lx, 1e-4);
    }
}

/* ---- whole skies ------------------------------------------------------------------------- */

static double drawn_illuminance(const Daylight *sky) {
    const int rows = 400, columns = 300;
    double sum = 0;
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++) {
            double share = (i + 0.5) / rows, step = PI * share / rows;
            double e = PI / 2 * share * share;
            float azimuth = (float)(2 * PI * j / columns);
            sum += (double)daylight_luminance(sky, (float)e, azimuth) * sin(e) * cos(e) * step * 2 *
                   PI / columns;
        }
    return sum;
}

static double spectral_luminance(const Daylight *sky, float elevation, float azimuth) {
    double sum = 0;
    for (int i = 0; i < 256; i++) {
        Wavelengths lanes;
        wavelengths_sample(((float)i + 0.5f) / 256, &lanes);
        sum += (double)spectrum_sum(daylight_radiance(sky, elevation, azimuth, &lanes) *
                                    lanes.xyz[1]) /
               256;
    }
    return sum;
}

/* The full moon near the zenith, 6 degrees of phase: Honolulu, 2024 January 25. */
ARENA_TEST(a_full_moon_overhead_gives_a_quarter_of_a_lux) {
    DaylightInput input = clear_moment("2024-01-25T01:00-10:00", (SkyPlace){21.3, -157.86, 0});
    const Daylight *sky = daylight_of(&input, &arena);
    const NightMetrics *n = &sky->metrics.night;
    assert_in(n->moon_elevation_deg, 80, 90);
    assert_in(n->phase_angle_deg, 0, 10);
    assert_in(sky->metrics.global_horizontal_lx, 0.25, 0.32);
    assert_in(sky->metrics.night.moon_sky_lx / n->moon_normal_lx, 0.08, 0.3);
    assert_true(!sky->has_sun && sky->night && sky->night->has_moon);
    assert_true(sky->metrics.direct_normal_lx < 1e-9);
    assert_close(sky->metrics.global_horizontal_lx,
                 n->moon_normal_lx * sin(sky->night->moon_elevation) + n->moon_sky_lx +
                     n->background_lx,
                 1e-3);
    assert_close(drawn_illuminance(sky), sky->metrics.diffuse_horizontal_lx, 2e-3);
    for (int i = 0; i < 4; i++)
        assert_close(spectral_luminance(sky, 0.4f * (float)i - 0.2f, (float)i),
                     (double)daylight_luminance(sky, 0.4f * (float)i - 0.2f, (float)i), 4e-3);
    assert_close(sky->metrics.zenith_cd_m2, (double)daylight_luminance(sky, 0.5f * PI_F, 0), 2e-3);
    /* the aureole: brighter beside the moon than opposite it */
    float moon = (float)sky->night->moon_azimuth;
    assert_true(daylight_luminance(sky, 1.2f, moon) > daylight_luminance(sky, 1.2f, moon + 3));
    double disc = PI * pow(sin(sky->night->moon_radius), 2), lux = 0;
    for (int i = 0; i < 4096; i++) {
        double r2 = (i + 0.5) / 4096, turn = 2.399963 * i;
        Wavelengths lanes;
        wavelengths_sample((float)fmod(i * 0.6180339887, 1), &lanes);
        lux += (double)spectrum_sum(
                   night_moon(sky->night, (float)(sqrt(r2) * cos(turn)), (float)r2, &lanes) *
                   lanes.xyz[1]) *
               disc / 4096;
    }
    assert_close(lux, n->moon_normal_lx, 3e-3);
}

ARENA_TEST(without_the_moon_the_background_is_left) {
    DaylightInput input = clear_moment("2024-01-25T01:00-10:00", (SkyPlace){21.3, -157.86, 0});
    input.no_moon = true;
    const Daylight *sky = daylight_of(&input, &arena);
    assert_true(sky->night && !sky->night->has_moon && !sky->metrics.night.has_moon);
    assert_close(sky->metrics.global_horizontal_lx, sky->metrics.night.background_lx, 1e-3);
    assert_in(sky->metrics.global_horizontal_lx, 6e-4, 1e-3);
    assert_close(drawn_illuminance(sky), sky->metrics.diffuse_horizontal_lx, 2e-3);
    assert_in(sky->metrics.zenith_cd_m2, 1.4e-4, 2.5e-4);
}

/* A sun that is placed by hand has no date, and no moon. */
ARENA_TEST(a_placed_sun_knows_no_moon) {
    DaylightInput input = sun_at_deg(-40);
    const Daylight *sky = daylight_of(&input, &arena);
    assert_true(sky->night && !sky->metrics.night.has_moon);
    assert_close(sky->metrics.global_horizontal_lx, sky->metrics.night.background_lx, 1e-3);
}

/* In the deepest night the sun's light is not even sought: where that begins there is less than
 * a thousandth of the background's left, also in the glow that an airliner sees at the edge. */
ARENA_TEST(the_deep_night_begins_where_nothing_is_left) {
    DaylightInput input = sun_at_deg(-40);
    input.where.altitude_m = 11000;
    double limit = daylight_of(&input, &arena)->horizon - radians_from_degrees(27);
    for (int is_dark = 0; is_dark <= 1; is_dark++) {
        input.sun_elevation = limit + (is_dark ? -1e-6 : 1e-6);
        const Daylight *sky = daylight_of(&input, &arena);
        double most = 0;
        for (float e = -1.5f; e < 1.5f; e += 0.01f)
            for (float azimuth = 0; azimuth < 3.2f; azimuth += 0.2f) {
                Spectrum light = atmosphere_radiance(&sky->sunlight.atmosphere, e, azimuth);
                most = fmax(most, lit_air_luminance(&sky->sunlight, light) /
                                      (double)night_luminance(sky->night, e, azimuth));
            }
        if (is_dark) assert_true(most <= 0);
        else assert_in(most, 1e-9, 1e-3);
    }
}

/* By day nothing of the night is looked up, so that no bit of a frame depends on it. */
ARENA_TEST(the_day_has_no_night) {
    DaylightInput input = clear_moment("2026-06-19T17:00+02:00", (SkyPlace){48.14, 11.58, 520});
    const Daylight *sky = daylight_of(&input, &arena);
    assert_true(sky->metrics.is_sun_up && !sky->night);
    assert_true(sky->metrics.night.has_moon && sky->metrics.night.is_moon_up);
    assert_true(sky->metrics.night.moon_normal_lx <= 0 && !sky->metrics.night.is_moon_lit);
}

/* ---- from day to night ------------------------------------------------------------------- */

static SkyTime minutes_after(SkyTime time, double minutes) {
    time.second += 60 * minutes; /* sky_julian_day takes any number of seconds */
    return time;
}

/* The first moment after noon at which no part of the sun is up. */
static SkyTime sunset_of(DaylightInput input) {
    SkyTime noon = input.when;
    double low = 0, high = 720;
    for (int i = 0; i < 26; i++) {
        double middle = (low + high) / 2;
        input.when = minutes_after(noon, middle);
        if (daylight_sun_clearance_deg(&input) > 0) low = middle;
        else high = middle;
    }
    return minutes_after(noon, high + 1e-4);
}

/* Light by the moon outside the air on a horizontal plane, over the sun's. */
static double moon_share(const DaylightInput *input) {
    double day = sky_julian_day(&input->when);
    Curve ratio;
    MoonPosition p = moon_position(day, sky_delta_t_s(day), &input->where);
    moon_over_sun(&(MoonDistances){p.phase_angle_deg, p.topocentric_km, p.sun_moon_au}, &ratio);
    return (double)ratio.value[190] * fmax(0, sin(radians_from_degrees(p.elevation_deg)));
}

/* What enters at sunset is less than a thousandth, on the worst evening of two years too. */
ARENA_TEST(night_falls_without_a_step) {
    DaylightInput input = clear_moment("2025-01-01T12:00+01:00", (SkyPlace){48.14, 11.58, 520});
    SkyTime noon = input.when, worst = noon;
    double most = 0;
    for (int day = 0; day < 730; day++) {
        input.when = minutes_after(noon, 1440.0 * day);
        SkyTime sunset = input.when = sunset_of(input);
        double share = moon_share(&input);
        if (share > most) most = share, worst = sunset;
    }
    input.when = worst;
    const Daylight *sky = daylight_of(&input, &arena);
    const NightMetrics *n = &sky->metrics.night;
    assert_true(!sky->metrics.is_sun_up && sky->night && n->is_moon_lit);
    double entered =
        n->moon_sky_lx + n->background_lx + n->moon_normal_lx * sin(sky->night->moon_elevation);
    printf("moon %.1f degrees high, %.2f lit: %.2g of %.0f lx enter at sunset\n",
           n->moon_elevation_deg, n->illuminated, entered / sky->metrics.global_horizontal_lx,
           sky->metrics.global_horizontal_lx);
    assert_true(entered < 1e-3 * sky->metrics.global_horizontal_lx);
}

/* The moon's own setting: its light in the air ends where the background hides it. */
ARENA_TEST(the_moon_sets_without_a_step) {
    double before = 1;
    static const double elevation_deg[] = {0, -3, -6, -8.99};
    for (int i = 0; i < 4; i += all_laws() ? 1 : 3) {
        Arena scratch = arena;
        Night *night = arena_alloc(&scratch, sizeof *night, 64, 1);
        MoonPosition moon = {.elevation_deg = elevation_deg[i] - (i ? 0 : 0.5),
                             .topocentric_km = 384400,
                             .sun_moon_au = 1,
                             .sun_elevation_deg = -20,
                             .sun_azimuth_deg = 90};
        Air air = {1013.25, 1.4, 0.34, 0.17, 1.14, 0.2};
        NightInput input = {{air, 0, 0, 0, 2, 16, false, 0, 0}, air, 0, 0, &moon};
        assert_done(night_build(&input, &scratch, night, &err));
        assert_true(night->has_moonlight);
        assert_true(night->metrics.moon_sky_lx < before);
        before = night->metrics.moon_sky_lx;
        assert_int_equal(night->has_moon, i == 0);
    }
    assert_true(before < 2e-3 * background_of(0.3).horizontal_lx);
}

TEST_PROGRAM(make_arena, drop_arena)
