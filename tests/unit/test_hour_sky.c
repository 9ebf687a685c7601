/* SPDX-License-Identifier: Apache-2.0 */
/* Skies of a weather file's hours over a response: those of daylight_build, only
 * quicker. Suns of the table of clear skies. */
#include "fixture.h"

#include "base/count.h"
#include "base/sampler.h"
#include "base/units.h"
#include "review/light/distant_probe.h"

#define ROUND 64
#define UPPER (ROUND * ROUND)
#define HOURS 12

static uint32_t seed = 7;

static double random_unit(void) {
    seed = hash_u32(seed + 1);
    return (double)unit_float(seed);
}

/* Directions of the sphere, each for as much of it. */
static Response sphere(Arena *arena) {
    Vec3 *centers = ARENA_NEW(arena, Vec3, 2 * UPPER);
    Response response = {.cells.count = 2 * UPPER, .centers = centers};
    response.first = ARENA_NEW(arena, float, 2 * UPPER * LIGHT_BANDS);
    response.rest = ARENA_NEW(arena, float, 2 * UPPER * LIGHT_BANDS);
    for (int i = 0; i < UPPER; i++) {
        double sine = (i / ROUND + 0.5) / ROUND, turn = 2 * PI * (i % ROUND + 0.5) / ROUND;
        double across = sqrt(1 - sine * sine);
        centers[i] = vec3((float)(across * cos(turn)), (float)sine, (float)(across * sin(turn)));
        centers[UPPER + i] = vec3(centers[i].x, -centers[i].y, centers[i].z);
    }
    return response;
}

/* Of clear, broken and overcast hours, the sun from just below the horizon to high. */
static DaylightInput hour_of(int i) {
    static const double elevation_deg[HOURS] = {-3, 0, 0.5, 2, 5, 9, 14, 22, 33, 45, 58, 72};
    static const double cloud[3] = {0, 0.6, 1};
    DaylightInput input = daylight_input_default(DAYLIGHT_PEREZ);
    double rise = fmax(0, sin(radians_from_degrees(elevation_deg[i])));
    input.has_time = input.has_sun = true;
    input.when = (SkyTime){2026, 1 + i, 15, 12, 0, 0, 0};
    input.where = (SkyPlace){52, 5, 10};
    input.sun_elevation = radians_from_degrees(elevation_deg[i]);
    input.sun_azimuth = radians_from_degrees(29 * i);
    input.direct_w_m2 = (1 - cloud[i % 3]) * 950 * exp(-0.2 / fmax(rise, 0.05));
    input.diffuse_w_m2 = 3 + (100 + 200 * cloud[i % 3]) * rise;
    return input;
}

static Vec3 direction_of(const DaylightInput *input) {
    double e = input->sun_elevation, a = input->sun_azimuth;
    return vec3((float)(cos(e) * sin(a)), (float)sin(e), (float)(-cos(e) * cos(a)));
}

/* By the whole sky, as moments have it. */
static double whole_reading(const Daylight *sky, const Response *response) {
    double sum = 0;
    for (int cell = 0; cell < response->cells.count; cell++) {
        Vec3 d = response->centers[cell];
        float bands[LIGHT_BANDS], shares[LIGHT_BANDS];
        for (int b = 0; b < LIGHT_BANDS; b++)
            shares[b] =
                response->first[cell * LIGHT_BANDS + b] + response->rest[cell * LIGHT_BANDS + b];
        light_bands_sky(sky, asinf(d.y), atan2f(d.x, -d.z), bands);
        sum += light_bands_sum(shares, bands);
    }
    return sum;
}

typedef struct Hours {
    DaylightInput inputs[HOURS];
    Vec3 suns[HOURS];
    int of_sun[HOURS];
    HourSkies skies;
} Hours;

static void make_hours(Hours *out, Arena *arena) {
    Error err = {0};
    int failed;
    for (int i = 0; i < HOURS; i++) {
        out->inputs[i] = hour_of(i);
        out->suns[i] = direction_of(&out->inputs[i]);
        out->of_sun[i] = i;
    }
    out->skies.of_sun = out->of_sun;
    HourInputs inputs = {out->inputs, HOURS};
    if (!hour_skies_build(&inputs, 2, arena, &out->skies.list, &failed, &err))
        fail_msg("hour %d: %s", failed, err.text);
}

/* Two responses: that of a luxmeter in the open, which reads what the hour's light is, and one
 * of small windows and a reflecting floor, each with colours of its own. */
ARENA_TEST(hours_read_as_their_whole_skies) {
    static Hours hours;
    static Daylight sky;
    Response open = sphere(&arena), windows = sphere(&arena);
    float *lux = ARENA_NEW(&arena, float, 2 * UPPER * LIGHT_BANDS), *shares[2];
    for (int i = 0; i < UPPER * LIGHT_BANDS; i++)
        lux[i] = open.centers[i / LIGHT_BANDS].y * (2 * PI_F / UPPER);
    open.first = lux;
    for (int k = 0; k < 2; k++) {
        shares[k] = ARENA_NEW(&arena, float, 2 * UPPER * LIGHT_BANDS);
        for (int cell = 0; cell < 2 * UPPER; cell++)
            for (int b = 0; b < LIGHT_BANDS && cell / 8 % 5 == 0; b++)
                shares[k][cell * LIGHT_BANDS + b] = (float)(random_unit() * 1e-3);
    }
    windows.first = shares[0];
    windows.rest = shares[1];
    make_hours(&hours, &arena);
    const double *in_open = hour_skies_read(&hours.skies, &open, hours.suns, HOURS, 2, &arena);
    const double *behind = hour_skies_read(&hours.skies, &windows, hours.suns, HOURS, 2, &arena);
    for (int i = 0; i < HOURS; i++) {
        double sun = 0;
        assert_done(daylight_build(&hours.inputs[i], &arena, &sky, &err));
        for (int b = 0; b < LIGHT_BANDS; b++) sun += (double)hours.skies.list[i].sun_bands[b];
        assert_close(behind[i], whole_reading(&sky, &windows), 1e-3);
        assert_close(in_open[i], sky.metrics.diffuse_horizontal_lx, 5e-3);
        /* a setting sun's spectrum is steep for bands of four wavelengths each */
        assert_near(sun, sky.metrics.direct_normal_lx,
                    (i < 4 ? 1e-2 : 3e-3) * sky.metrics.direct_normal_lx + 1e-9);
    }
}

ARENA_TEST(a_dark_hour_reads_nothing_and_threads_change_nothing) {
    static Hours hours;
    Response response = sphere(&arena);
    float *shares = ARENA_NEW(&arena, float, 2 * UPPER * LIGHT_BANDS);
    for (int i = 0; i < 2 * UPPER * LIGHT_BANDS; i++) shares[i] = (float)random_unit();
    response.first = shares;
    make_hours(&hours, &arena);
    hours.of_sun[4] = -1;
    const double *one = hour_skies_read(&hours.skies, &response, hours.suns, HOURS, 1, &arena);
    const double *many = hour_skies_read(&hours.skies, &response, hours.suns, HOURS, 5, &arena);
    assert_memory_equal(one, many, HOURS * sizeof *one);
    for (int i = 0; i < HOURS; i++) assert_true(i == 4 ? one[i] == 0 : one[i] > 0);
}

ARENA_TEST(an_hour_that_is_no_sky_is_told) {
    Error err = {0};
    int failed = -1;
    const HourSky *list;
    DaylightInput inputs[3] = {hour_of(6), hour_of(7), hour_of(8)};
    inputs[1].diffuse_w_m2 = 0;
    assert_false(hour_skies_build(&(HourInputs){inputs, 3}, 2, &arena, &list, &failed, &err));
    assert_int_equal(failed, 1);
    assert_non_null(strstr(err.text, "a Perez sky wants a diffuse irradiance above 0"));
}

/* Below 2 degrees light changes faster. */
static void sun_is_the_atmospheres(double elevation_deg, Arena arena) {
    DaylightInput input = daylight_input_default(DAYLIGHT_CLEAR);
    SkyTable table = sky_table_start(&input, elevation_deg, elevation_deg, &arena);
    DistantTools tools = {.table = &table};
    Daylight sky;
    float bands[LIGHT_BANDS], wanted[LIGHT_BANDS];
    double sum = 0, off = 0;
    assert_done(distant_probes_sample_skies(NULL, 0, &tools, &arena, &err));
    input.has_sun = input.no_moon = input.has_time = true;
    input.when = (SkyTime){2026, 1, 4, 12, 0, 0, 0}; /* the earth is near */
    input.sun_elevation = radians_from_degrees(elevation_deg);
    input.sun_lux = -1;
    assert_done(daylight_build(&input, &arena, &sky, &err));
    light_bands_sun(&sky, wanted);
    double near = sky.metrics.distance_au * sky.metrics.distance_au;
    assert_in(near, 0.966, 0.968);
    sky_table_sun(&table, elevation_deg, 1 / near, bands);
    for (int b = 0; b < LIGHT_BANDS; b++) {
        sum += (double)wanted[b];
        off += (double)(bands[b] - wanted[b]);
    }
    if (!(fabs(off) < (elevation_deg < 2 ? 0.03 * sum + 1 : 0.01 * sum)))
        fail_msg("%g degrees: %g lx, %+g", elevation_deg, sum, off);
}

/* Made alone it has the bits of the sky's, in twilight and below the horizon, too. */
ARENA_TEST(a_sun_alone_is_its_skys) {
    static const double elevations[] = {-3, -0.2, 0, 0.5, 5, 30, 90};
    for (size_t i = 0; i < COUNT_OF(elevations); i++) {
        Arena room = arena;
        DaylightInput input = daylight_input_default(DAYLIGHT_CLEAR);
        Daylight whole, alone;
        input.has_sun = input.no_moon = true;
        input.sun_elevation = radians_from_degrees(elevations[i]);
        assert_done(daylight_build(&input, &room, &whole, &err));
        input.sun_alone = true;
        assert_done(daylight_build(&input, &room, &alone, &err));
        assert_memory_equal(&whole.sun_mean, &alone.sun_mean, sizeof whole.sun_mean);
        assert_near(whole.metrics.direct_normal_lx, alone.metrics.direct_normal_lx, 0);
    }
}

/* Also between its elevations: each has the rows beside it alone, by day one of four. */
ARENA_TEST(the_sun_of_a_sky_table_is_the_atmospheres) {
    static const double BETWEEN[] = {0.3, 0.75, 1.2,  1.7,  2.2, 3.5, 4.5,
                                     6.8, 9,    11.5, 14.5, 18,  33};
    for (size_t i = 0; i < COUNT_OF(BETWEEN); i += all_laws() ? 1 : 4)
        sun_is_the_atmospheres(BETWEEN[i], arena);
}

TEST_PROGRAM(make_arena, drop_arena)
