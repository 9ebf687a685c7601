/* SPDX-License-Identifier: Apache-2.0 */
/* Skies of a model as lights. */
#include "light/sky.h"
#include "light_fixture.h"

static Scene *sky_scene(EnvironmentKind kind, double elevation_deg, Arena *arena) {
    Scene *scene = builder_scene(arena);
    Environment *e = &scene->environment;
    e->kind = kind;
    e->daylight = daylight_input_default(kind == ENVIRONMENT_CIE     ? DAYLIGHT_CIE
                                         : kind == ENVIRONMENT_PEREZ ? DAYLIGHT_PEREZ
                                                                     : DAYLIGHT_CLEAR);
    e->daylight.direct_w_m2 = 700;
    e->daylight.diffuse_w_m2 = 120;
    e->daylight.where.altitude_m = 9000;
    e->daylight.floor = FLOOR_SEA;
    e->has_sun = true;
    e->sun_azimuth = 1;
    e->sun_elevation = (float)(elevation_deg * PI / 180);
    e->sun_illuminance_lx = kind == ENVIRONMENT_CIE ? 50000 : -1;
    e->heading = 0.4f;
    return scene;
}

ARENA_TEST(a_modelled_sky_and_its_sun_give_the_stated_illuminance) {
    for (int kind = ENVIRONMENT_CIE; kind <= ENVIRONMENT_SKY; kind++) {
        Arena scratch = arena;
        Scene *scene = sky_scene((EnvironmentKind)kind, 35, &scratch);
        Daylight *out = arena_alloc(&scratch, sizeof *out, 64, 1);
        DaylightInput input = scene->environment.daylight;
        input.has_sun = true;
        input.sun_elevation = 35 * PI / 180;
        input.sun_lux = kind == ENVIRONMENT_CIE ? 50000 : -1;
        assert_done(daylight_build(&input, &scratch, out, &err));
        const Lights *lights = build(scene, &scratch);
        assert_illuminance("modelled sky", lights, LIGHTS_SKY, vec3(0, 1, 0),
                           out->metrics.diffuse_horizontal_lx);
        assert_illuminance("its sun", lights, LIGHTS_SUN, vec3(0, 1, 0),
                           out->metrics.direct_normal_lx * sin(35 * PI / 180));
    }
}

ARENA_TEST(a_half_set_sun_gives_half_its_light) {
    Scene *scene = sky_scene(ENVIRONMENT_SKY, 0, &arena);
    scene->environment.daylight.where.altitude_m = 0; /* the horizon is the horizontal */
    const Lights *lights = build(scene, &arena);
    Vec3 facing = vec3((float)sin(0.6), 0, (float)-cos(0.6));
    Wavelengths lanes;
    double sum[2] = {0, 0};
    wavelengths_sample(0.4f, &lanes);
    for (int i = 0; i < 20000; i++) {
        const float u[3] = {((float)i + 0.5f) / 20000, (float)((i * 7919) % 20000) / 20000, 0};
        LightSample sample;
        LitPoint point = {vec3(0, 0, 0), facing, false};
        assert_true(lights_sample(lights, LIGHTS_SUN, point, u, &sample));
        assert_true(vec3_dot(sample.wi, facing) > 0.9999f); /* where the heading puts it */
        sum[sample.wi.y >= 0] += (double)spectrum_sum(lights_radiance(lights, &sample, &lanes));
    }
    assert_true(sum[0] == 0 && sum[1] > 0);
}

ARENA_TEST(modelled_sky_samples_follow_their_density) {
    enum { ROWS = 24, COLUMNS = 24, COUNT = 300000, FINE = 40 };
    Wavelengths lanes;
    wavelengths_sample(0.3f, &lanes);
    for (int kind = ENVIRONMENT_CIE; kind <= ENVIRONMENT_SKY; kind++) {
        static double found[ROWS * COLUMNS], expected[ROWS * COLUMNS];
        Arena scratch = arena;
        Scene *scene = sky_scene((EnvironmentKind)kind, 20, &scratch);
        Sky sky;
        uint32_t random = 11;
        double total = 0;
        int unlike = 0;
        memset(found, 0, sizeof found);
        memset(expected, 0, sizeof expected);
        assert_done(sky_build(&scene->environment, &scratch, &sky, &err));
        for (int i = 0; i < COUNT; i++) {
            SkySample sample;
            const float u[2] = {random_unit(&random), random_unit(&random)};
            Vec3 n = vec3(0, 1, 0);
            assert_true(sky_choose(&sky, n, u, &sample));
            Vec3 d = sample.direction;
            unlike += !(fabsf(sample.pdf - sky_seen(&sky, d, n, &lanes).pdf) <= 1e-4f * sample.pdf);
            int row = (int)((double)(d.y + 1) / 2 * ROWS);
            int column = (int)((atan2((double)d.z, (double)d.x) + PI) / (2 * PI) * COLUMNS);
            found[(row < ROWS ? row : ROWS - 1) * COLUMNS + column % COLUMNS]++;
        }
        for (int row = 0; row < ROWS * FINE; row++)
            for (int column = 0; column < COLUMNS * FINE; column++) {
                double y = -1 + 2 * (row + 0.5) / (ROWS * FINE), r = sqrt(1 - y * y);
                double phi = 2 * PI * (column + 0.5) / (COLUMNS * FINE) - PI;
                Vec3 d = vec3((float)(r * cos(phi)), (float)y, (float)(r * sin(phi)));
                double share = (double)sky_seen(&sky, d, vec3(0, 1, 0), &lanes).pdf * 2 /
                               (ROWS * FINE) * 2 * PI / (COLUMNS * FINE);
                expected[row / FINE * COLUMNS + column / FINE] += share * COUNT;
                total += share;
            }
        assert_int_equal(unlike, 0);
        assert_near(total, 1, 5e-3);
        assert_chi_square(kind, found, expected, ROWS * COLUMNS, (ChiLimits){0, 0, 5});
    }
}

/* On a plane that faces down, lux, by quadrature over what is seen. */
static double light_from_below(const Daylight *sky) {
    enum { ROWS = 700, COLUMNS = 2400 };
    const LitAir *air = &sky->sunlight;
    double sum = 0;
    for (int i = 0; i < ROWS; i++) {
        double t = (i + 0.5) / ROWS, e = -PI / 2 * t * t, width = PI * t / ROWS;
        for (int j = 0; j < COLUMNS; j++) {
            float azimuth = (float)(2 * PI * (j + 0.5) / COLUMNS);
            Spectrum light = atmosphere_radiance(&air->atmosphere, (float)e, azimuth) +
                             atmosphere_relief(&air->atmosphere, (float)e, azimuth);
            sum -= lit_air_luminance(air, light) * sin(e) * cos(e) * width * 2 * PI / COLUMNS;
        }
    }
    return sum;
}

/* Directions are sampled by the mean of a cloud deck, and the light that they bring has its
 * relief: the estimate is that of the relief. */
ARENA_TEST(a_deck_with_a_relief_gives_its_light_by_its_own_samples) {
    Scene *scene = sky_scene(ENVIRONMENT_SKY, 12, &arena);
    Sky sky, even;
    scene->environment.daylight.floor = FLOOR_CLOUD;
    assert_done(sky_build(&scene->environment, &arena, &even, &err));
    scene->environment.daylight.cloud_relief_m = 600;
    assert_done(sky_build(&scene->environment, &arena, &sky, &err));
    const Lights *lights = build(scene, &arena);
    double lux = light_from_below(sky.model->daylight);
    assert_illuminance("a rough deck", lights, LIGHTS_SKY, vec3(0, -1, 0), lux);
    assert_close(lux, light_from_below(even.model->daylight), 0.01);
    assert_memory_equal(sky.model->cdf, even.model->cdf, sizeof even.model->cdf);
    assert_memory_equal(sky.model->row_cdf, even.model->row_cdf, sizeof even.model->row_cdf);
}

ARENA_TEST(a_sky_without_a_sun_to_stand_by_is_refused) {
    Scene *scene = sky_scene(ENVIRONMENT_PEREZ, -5, &arena);
    Lights *lights;
    assert_fails_as(lights_build(scene, &arena, &lights, &err), ERROR_INPUT,
                    "5.00 degrees below the horizon");
}

/* ---- the disc ---------------------------------------------------------------------------- */

/* A sun of 100 klx and of some radius in any environment. */
static void build_disc(EnvironmentKind kind, double radius_deg, Arena *arena, Sky *sky) {
    Scene *scene = sky_scene(kind < ENVIRONMENT_CIE ? ENVIRONMENT_CIE : kind, 40, arena);
    Environment *e = &scene->environment;
    float *pixels = ARENA_NEW(arena, float, 4 * 8 * 4);
    for (int i = 0; i < 4 * 8 * 4; i++) pixels[i] = 1;
    e->kind = kind;
    e->sun_illuminance_lx = 100000;
    e->sun_angular_radius = (float)radians_from_degrees(radius_deg);
    e->luminance_cd_m2 = 1000;
    e->color[0] = e->color[1] = e->color[2] = 1;
    e->hdri = (Image){.format = IMAGE_RGBA32F, .width = 8, .height = 4, .pixels = pixels};
    e->hdri_path = "";
    e->hdri_scale = 1;
    assert_done(sky_build(e, arena, sky, &err));
    assert_true(sky->has_sun);
}

/* Towards a place of the disc: a share of the sine of its radius, and an azimuth around it. */
static Vec3 disc_direction(const Sky *sky, double share, double turn) {
    Frame frame = frame_from_z(sky->sun_direction);
    double s = share * sin((double)sky->sun_radius), c = sqrt(1 - s * s);
    return frame_to_world(&frame, vec3((float)(s * cos(turn)), (float)(s * sin(turn)), (float)c));
}

TEST(every_environment_has_the_same_disc) {
    Wavelengths lanes;
    wavelengths_sample(0.3f, &lanes);
    for (int kind = ENVIRONMENT_NONE; kind <= ENVIRONMENT_SKY; kind++) {
        Arena arena = test_arena(state);
        Sky sky;
        build_disc((EnvironmentKind)kind, 0.26645, &arena, &sky);
        Spectrum centre = sun_radiance(&sky, sky.sun_direction, &lanes);
        for (int i = 1; i < 20; i++) {
            double mu = sqrt(1 - i * i * 0.0025);
            Spectrum there = sun_radiance(&sky, disc_direction(&sky, 0.05 * i, 0.7 * i), &lanes);
            for (int k = 0; k < SPECTRUM_LANES; k++) {
                double c[SUN_LIMB_TERMS], middle = 0, value = 0;
                sun_limb((double)lanes.nm[k], c);
                for (int n = SUN_LIMB_TERMS - 1; n >= 0; n--)
                    value = value * mu + c[n], middle += c[n];
                assert_near((double)(there[k] / centre[k]), value / middle, 4e-3);
            }
        }
    }
}

/* The flux through a plane that faces the disc, in rings; also of one as large as a fist. */
TEST(the_discs_shape_does_not_change_its_illuminance) {
    static const double radius_deg[] = {0.26645, 5};
    for (int kind = ENVIRONMENT_NONE; kind <= ENVIRONMENT_HDRI; kind++)
        for (int r = 0; r < 2; r++) {
            Arena arena = test_arena(state);
            Sky sky;
            double lux = 0;
            build_disc((EnvironmentKind)kind, radius_deg[r], &arena, &sky);
            double sine = sin((double)sky.sun_radius);
            for (int i = 0; i < 4000; i++) {
                double share = sqrt((i + 0.5) / 4000), y = 0;
                Wavelengths lanes;
                wavelengths_sample((float)fmod(i * 0.6180339887, 1), &lanes);
                Spectrum there = sun_radiance(&sky, disc_direction(&sky, share, 2.4 * i), &lanes);
                for (int k = 0; k < SPECTRUM_LANES; k++) y += (double)(there[k] * lanes.xyz[1][k]);
                lux += y * PI * sine * sine / 4000;
            }
            assert_close(lux, 100000, 2e-3);
        }
}

TEST(directions_to_the_sun_follow_their_density) {
    enum { RINGS = 8, SECTORS = 16, COUNT = 64000 };
    for (int kind = ENVIRONMENT_CONSTANT; kind <= ENVIRONMENT_SKY; kind++) {
        Arena arena = test_arena(state);
        Sky sky;
        double found[RINGS * SECTORS] = {0}, even[RINGS * SECTORS];
        uint32_t random = 5;
        build_disc((EnvironmentKind)kind, 0.26645, &arena, &sky);
        Frame frame = frame_from_z(sky.sun_direction);
        for (int i = 0; i < COUNT; i++) {
            float u0 = random_unit(&random);
            Vec3 d = sun_sample(&sky, u0, random_unit(&random));
            assert_true(sun_pdf(&sky, d) > 0);
            double x = (double)vec3_dot(d, frame.x), y = (double)vec3_dot(d, frame.y);
            double share2 = (x * x + y * y) / pow(sin((double)sky.sun_radius), 2);
            int ring = (int)fmin(share2 * RINGS, RINGS - 1);
            int sector = (int)((atan2(y, x) / (2 * PI) + 0.5) * SECTORS) % SECTORS;
            found[ring * SECTORS + sector]++;
        }
        assert_close((double)(sun_pdf(&sky, sky.sun_direction))*PI *
                         pow(sin((double)sky.sun_radius), 2),
                     1, 1e-4);
        for (int i = 0; i < RINGS * SECTORS; i++) even[i] = (double)COUNT / (RINGS * SECTORS);
        assert_chi_square(kind, found, even, RINGS * SECTORS, (ChiLimits){0, 100, 5});
    }
}

/* The half moon's disc as a light: its own samples give its illuminance, all from the side that
 * the sun lights; Munich, 2026 October 3, after midnight. */
ARENA_TEST(the_moon_lights_as_the_disc_when_the_sun_is_down) {
    Sky sky;
    Scene *scene = sky_scene(ENVIRONMENT_SKY, 0, &arena);
    Environment *e = &scene->environment;
    e->has_sun = false;
    e->daylight.has_time = true;
    e->daylight.where = (SkyPlace){48.14, 11.58, 520};
    e->daylight.floor = FLOOR_LAND;
    assert_done(sky_time_parse("2026-10-03T04:30+02:00", "", &e->daylight.when, &err));
    const Lights *lights = build(scene, &arena);
    assert_done(sky_build(e, &arena, &sky, &err));
    const NightMetrics *n = &sky.model->daylight->metrics.night;
    assert_true(sky.has_sun && sky.is_moon && n->illuminated > 0.4 && n->illuminated < 0.65);
    assert_illuminance("the moon", lights, LIGHTS_SUN, vec3(0, 1, 0),
                       n->moon_normal_lx * sin(radians_from_degrees(n->moon_elevation_deg)));
    assert_illuminance("its sky", lights, LIGHTS_SKY, vec3(0, 1, 0),
                       sky.model->daylight->metrics.diffuse_horizontal_lx);
    Wavelengths lanes;
    double side[2] = {0, 0};
    uint32_t random = 3;
    wavelengths_sample(0.3f, &lanes);
    for (int i = 0; i < 20000; i++) {
        float u0 = random_unit(&random);
        Vec3 d = sun_sample(&sky, u0, random_unit(&random));
        assert_true(sun_pdf(&sky, d) > 0);
        side[vec3_dot(d, sky.moon_lit) > 0] += (double)spectrum_sum(sun_radiance(&sky, d, &lanes));
    }
    assert_true(side[1] > 20 * side[0]);
    Vec3 sun = vec3((float)(sin(sky.model->daylight->sun_azimuth - (double)sky.model->turn)), 0,
                    (float)(-cos(sky.model->daylight->sun_azimuth - (double)sky.model->turn)));
    assert_true(vec3_dot(sun, sky.moon_lit) > 0);
}

TEST_PROGRAM(make_arena, drop_arena)
