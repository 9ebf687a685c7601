/* SPDX-License-Identifier: Apache-2.0 */
/* A cloud deck with a relief: it sends what an even deck sends, has no seam, fades at the
 * horizon, and is the same for any number of threads. */
#include "fixture.h"

#include "base/units.h"
#include "sky/cloud_view.h"
#include "sky/daylight.h"

#define HEIGHT_M 7668.0

static CloudViewInput usual(double sun_deg, int threads) {
    double horizon = -acos((AIR_EARTH_M + 3000) / (AIR_EARTH_M + 3000 + HEIGHT_M));
    return (CloudViewInput){
        HEIGHT_M, 500, horizon, radians_from_degrees(130), radians_from_degrees(sun_deg), threads};
}

/* Mean and standard deviation over the azimuths of [from, to), radians, of elevations from
 * `low` to `high`, by solid angle. */
static void statistics(const CloudRelief *relief, const double bounds[4], double out[2]) {
    enum { ROWS = 400, COLUMNS = 1440 };
    double sum = 0, square = 0, low = sin(bounds[0]), high = sin(bounds[1]);
    for (int i = 0; i < ROWS; i++)
        for (int j = 0; j < COLUMNS; j++) {
            double elevation = asin(low + (high - low) * (i + 0.5) / ROWS);
            double azimuth = bounds[2] + (bounds[3] - bounds[2]) * (j + 0.5) / COLUMNS;
            double f = (double)cloud_relief_factor(relief, (float)elevation, (float)azimuth);
            assert_true(f >= 0 && f < 8);
            sum += f;
            square += f * f;
        }
    out[0] = sum / (ROWS * COLUMNS);
    out[1] = sqrt(fmax(0, square / (ROWS * COLUMNS) - out[0] * out[0]));
}

/* Over the whole deck, and in front of every side of the observer, where a window may be. */
ARENA_TEST(the_mean_of_the_factor_is_one_on_every_side) {
    static const double sun_deg[] = {68, 6, -6};
    for (int s = 0; s < 3; s++) {
        Arena scratch = arena;
        CloudRelief relief;
        CloudViewInput input = usual(sun_deg[s], 2);
        double found[2], edge = input.horizon;
        cloud_view_build(&input, &scratch, &relief);
        statistics(&relief, (double[]){-PI / 2, edge, 0, 2 * PI}, found);
        assert_close(found[0], 1, 0.003);
        assert_true(found[1] > 0.1); /* there is something to see */
        for (int side = 0; side < 4; side++) {
            double from = side * PI / 2 - PI / 4;
            statistics(&relief, (double[]){-0.5, edge, from, from + PI / 2}, found);
            assert_close(found[0], 1, 0.05);
        }
    }
}

/* Far billows merge: of their contrast little is left where they meet the horizon, and nothing
 * at it. The air in between takes the rest. */
ARENA_TEST(the_relief_fades_into_the_horizon) {
    CloudRelief relief;
    CloudViewInput input = usual(30, 2);
    double near[2], far[2], edge = input.horizon;
    cloud_view_build(&input, &arena, &relief);
    statistics(&relief, (double[]){edge - 0.12, edge - 0.08, 0, 2 * PI}, near);
    statistics(&relief, (double[]){edge - 0.0015, edge, 0, 2 * PI}, far);
    assert_true(far[1] < 0.7 * near[1]);
    for (int j = 0; j < 360; j++)
        assert_near(
            (double)cloud_relief_factor(&relief, (float)edge - 1e-6f, (float)(PI * j / 180)), 1,
            0.05);
}

/* Between columns, and where the azimuth begins anew. */
ARENA_TEST(the_relief_has_no_seam_at_any_azimuth) {
    CloudRelief relief;
    CloudViewInput input = usual(30, 2);
    double sum = 0, seam = 0;
    int rows = 0;
    cloud_view_build(&input, &arena, &relief);
    for (float e = -0.06f; e > -1.2f; e -= 0.003f, rows++) {
        float step = 2 * PI_F / CLOUD_RELIEF_COLUMNS;
        assert_near((double)cloud_relief_factor(&relief, e, -0.01f * step),
                    (double)cloud_relief_factor(&relief, e, 0.01f * step), 3e-3);
        assert_near((double)cloud_relief_factor(&relief, e, -1e-7f),
                    (double)cloud_relief_factor(&relief, e, 2 * PI_F), 1e-3);
        seam += fabs((double)(cloud_relief_factor(&relief, e, -0.5f * step) -
                              cloud_relief_factor(&relief, e, 0.5f * step)));
        for (int j = 1; j <= 64; j++) {
            float a = 0.09f * (float)j;
            sum += fabs((double)(cloud_relief_factor(&relief, e, a - 0.5f * step) -
                                 cloud_relief_factor(&relief, e, a + 0.5f * step))) /
                   64;
        }
    }
    assert_true(seam < 2.5 * sum);
    assert_true(sum / rows < 0.05); /* and neighbours are like each other */
}

ARENA_TEST(the_relief_is_the_same_for_any_number_of_threads) {
    CloudRelief one, three;
    CloudViewInput input = usual(30, 1);
    cloud_view_build(&input, &arena, &one);
    input.threads = 3;
    cloud_view_build(&input, &arena, &three);
    assert_memory_equal(one.factor, three.factor,
                        sizeof(uint16_t) * CLOUD_RELIEF_ROWS * CLOUD_RELIEF_COLUMNS);
}

/* ---- in a sky ---------------------------------------------------------------------------- */

static Daylight *deck(double relief_m, double sun_deg, Arena *arena) {
    Daylight *out = arena_alloc(arena, sizeof *out, 64, 1);
    DaylightInput input = daylight_input_default(DAYLIGHT_CLEAR);
    input.has_sun = true;
    input.threads = 2;
    input.sun_elevation = radians_from_degrees(sun_deg);
    input.sun_azimuth = 1;
    input.where.altitude_m = 10668;
    input.floor = FLOOR_CLOUD;
    input.cloud_top_m = 3000;
    input.cloud_relief_m = relief_m;
    assert_done(daylight_build(&input, arena, out, &err));
    return out;
}

/* Illuminance by all below the horizon on an upright plane, relative, all lanes. */
static double light_from_below(const Daylight *sky, double facing, bool at_mean) {
    enum { ROWS = 300, COLUMNS = 700 };
    const LitAir *air = &sky->sunlight;
    double sum = 0, low = -0.7, high = sky->horizon;
    for (int i = 0; i < ROWS; i++)
        for (int j = 0; j < COLUMNS; j++) {
            double e = low + (high - low) * (i + 0.5) / ROWS;
            double a = PI * (j + 0.5) / COLUMNS - PI / 2;
            float elevation = (float)e, azimuth = (float)(facing + a);
            Spectrum light = atmosphere_radiance(&air->atmosphere, elevation, azimuth);
            if (!at_mean) light += atmosphere_relief(&air->atmosphere, elevation, azimuth);
            sum += lit_air_luminance(air, light) * cos(e) * cos(e) * cos(a);
        }
    return sum;
}

/* The cabin's windows get what they get over an even deck. */
ARENA_TEST(a_window_gets_the_light_of_an_even_deck) {
    static const double sun_deg[] = {60, 7};
    for (int s = 0; s < 2; s++) {
        Arena scratch = arena;
        Daylight *sky = deck(500, sun_deg[s], &scratch);
        for (int side = 0; side < 4; side++) {
            double even = light_from_below(sky, side * PI / 2, true);
            assert_close(light_from_below(sky, side * PI / 2, false), even, 0.01);
        }
    }
}

/* Its mean is the light of before, bit for bit; above the horizon and without the key there is
 * nothing to add. */
ARENA_TEST(without_a_relief_a_deck_is_what_it_was) {
    Daylight *even = deck(0, 20, &arena), *rough = deck(500, 20, &arena);
    const Atmosphere *a = &even->sunlight.atmosphere, *b = &rough->sunlight.atmosphere;
    Wavelengths lanes;
    int changed = 0;
    wavelengths_sample(0.3f, &lanes);
    assert_null(a->relief);
    for (int i = 0; i < 2000; i++) {
        float e = -1.5f + 3.0f * (float)i / 2000, azimuth = 0.37f * (float)i;
        Spectrum one = atmosphere_radiance(a, e, azimuth);
        Spectrum two = atmosphere_radiance(b, e, azimuth);
        Spectrum seen[2] = {daylight_radiance(even, e, azimuth, &lanes),
                            daylight_radiance(rough, e, azimuth, &lanes)};
        assert_memory_equal(&one, &two, sizeof one);
        bool same = !memcmp(&seen[0], &seen[1], sizeof seen[0]);
        if ((double)e > even->horizon) assert_true(same);
        changed += !same;
        for (int k = 0; k < SPECTRUM_LANES; k++) assert_true(seen[1][k] >= 0);
    }
    assert_true(changed > 500);
}

/* Land and sea have none, and a deck around the observer neither. */
ARENA_TEST(only_a_deck_below_has_a_relief) {
    Daylight out;
    DaylightInput input = daylight_input_default(DAYLIGHT_CLEAR);
    input.has_sun = true;
    input.sun_elevation = 1;
    input.cloud_relief_m = 300;
    input.cloud_top_m = 2000;
    input.where.altitude_m = 2010;
    for (int kind = FLOOR_LAND; kind <= FLOOR_CLOUD; kind++) {
        Arena scratch = arena;
        input.floor = (FloorKind)kind;
        assert_done(daylight_build(&input, &scratch, &out, &err));
        assert_null(out.sunlight.atmosphere.relief);
    }
}

TEST_PROGRAM(make_arena, drop_arena)
