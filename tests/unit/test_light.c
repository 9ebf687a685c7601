#include "check.h"

#include "base/units.h"
#include "light/emitters.h"
#include "light/light.h"
#include "light/sky.h"
#include "scene_builder.h"
#include "spectrum/photometry.h"

#define SAMPLES 200000

static float random_unit(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    return unit_float(hash_u32(*state));
}

static void random3(uint32_t *state, float u[3])
{
    for (int i = 0; i < 3; i++) u[i] = random_unit(state);
}

/* Mean and standard error of a running sum. */
typedef struct Mean {
    double sum, squares;
    long count;
} Mean;

static void mean_add(Mean *mean, double value)
{
    mean->sum += value;
    mean->squares += value * value;
    mean->count++;
}

static void assert_mean(const char *what, Mean mean, double expected)
{
    double value = mean.sum / (double)mean.count;
    double variance = mean.squares / (double)mean.count - value * value;
    double sigma = sqrt(fmax(variance, 0) / (double)mean.count) + 1e-6 * fabs(expected);
    if (!(fabs(value - expected) <= 4 * sigma) || !(sigma < 0.02 * fabs(expected)))
        fail_msg("%s: %.7g +- %.2g, expected %.7g", what, value, sigma, expected);
}

/* Illuminance, lx, of one set at `position` on a plane with normal n, by its own samples. */
static Mean illuminance(const Lights *lights, LightSet set, Vec3 position, Vec3 n)
{
    Mean mean = {0};
    uint32_t random = 11;
    for (int i = 0; i < SAMPLES; i++) {
        Wavelengths w;
        LightSample sample;
        float u[3], xyz[3] = {0};
        random3(&random, u);
        wavelengths_sample(random_unit(&random), &w);
        if (lights_sample(lights, set, (LitPoint){position, n}, &w, u, &sample)) {
            float cosine = fmaxf(vec3_dot(n, sample.wi), 0);
            spectrum_add_xyz(&w, sample.radiance * spectrum_all(cosine / sample.pdf), xyz);
        }
        mean_add(&mean, (double)xyz[1]);
    }
    return mean;
}

static const Lights *build(const Scene *scene, Arena *arena)
{
    Lights *lights;
    Error err = {0};
    if (!lights_build(scene, arena, &lights, &err)) fail_msg("%s", err.text);
    return lights;
}

static void the_suns_irradiance_is_exact_whatever_its_size(void **state)
{
    (void)state;
    const float radius[] = {0.0005f, 0.00465f, 0.05f};
    for (int i = 0; i < 3; i++) {
        Arena arena = arena_reserve(1 << 28);
        Scene *scene = builder_scene(&arena);
        scene->environment.has_sun = true;
        scene->environment.sun_angular_radius = radius[i];
        scene->environment.sun_azimuth = 1.1f;
        scene->environment.sun_elevation = 0.6f;
        scene->environment.sun_illuminance_lx = 90000;
        const Lights *lights = build(scene, &arena);
        Vec3 to_sun =
            vec3((float)(cos(0.6) * sin(1.1)), (float)sin(0.6), (float)(-cos(0.6) * cos(1.1)));
        assert_mean("facing the sun", illuminance(lights, LIGHTS_SUN, vec3(0, 0, 0), to_sun),
                    90000);
        assert_mean("on the ground",
                    illuminance(lights, LIGHTS_SUN, vec3(0, 0, 0), vec3(0, 1, 0)),
                    90000 * sin(0.6));
        arena_release(&arena);
    }
}

static void the_heading_turns_the_sun_and_not_the_scene(void **state)
{
    (void)state;
    Arena arena = arena_reserve(1 << 26);
    Scene *scene = builder_scene(&arena);
    Sky sky;
    Error err;
    scene->environment.has_sun = true;
    scene->environment.sun_illuminance_lx = 1;
    scene->environment.sun_azimuth = (float)(PI / 2); /* east */
    assert_true(sky_build(&scene->environment, &arena, &sky, &err));
    assert_near(sky.sun_direction.x, 1, 1e-6);
    scene->environment.heading = (float)(PI / 2); /* driving east: the sun is ahead */
    assert_true(sky_build(&scene->environment, &arena, &sky, &err));
    assert_near(sky.sun_direction.z, -1, 1e-6);
    scene->environment.forward = vec3(1, 0, 0);
    assert_true(sky_build(&scene->environment, &arena, &sky, &err));
    assert_near(sky.sun_direction.x, 1, 1e-6);
    arena_release(&arena);
}

static void a_uniform_sky_of_luminance_l_gives_pi_l(void **state)
{
    (void)state;
    Arena arena = arena_reserve(1 << 28);
    Scene *scene = builder_scene(&arena);
    scene->environment.kind = ENVIRONMENT_CONSTANT;
    scene->environment.luminance_cd_m2 = 1000;
    for (int i = 0; i < 3; i++) scene->environment.color[i] = 1;
    const Lights *lights = build(scene, &arena);
    assert_mean("uniform sky", illuminance(lights, LIGHTS_SKY, vec3(0, 0, 0), vec3(0, 1, 0)),
                PI * 1000);
    arena_release(&arena);
}

/* A picture with a soft gradient, a small sun, a dark half and a negative pixel. */
static Scene *picture_scene(Arena *arena, int width, int height)
{
    Scene *scene = builder_scene(arena);
    float *pixels = ARENA_NEW(arena, float, 4 * width * height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int i = 0; i < 3; i++)
                pixels[4 * (y * width + x) + i] =
                    x > width / 2 ? 0.0f : 1 + 0.2f * (float)i + (float)y / (float)height;
    for (int i = 0; i < 3; i++) pixels[4 * (9 * width + 17) + i] = 5000;
    pixels[4 * (20 * width + 40)] = -3;
    scene->environment.kind = ENVIRONMENT_HDRI;
    scene->environment.hdri_path = "picture";
    scene->environment.hdri_scale = 1;
    scene->environment.hdri = (Image){width, height, IMAGE_RGBA32F, pixels};
    return scene;
}

static void a_picture_can_be_scaled_to_an_illuminance(void **state)
{
    (void)state;
    Arena arena = arena_reserve(1 << 28);
    Scene *scene = picture_scene(&arena, 64, 32);
    scene->environment.horizontal_illuminance_lx = 15000;
    const Lights *lights = build(scene, &arena);
    assert_int_equal(lights_refused_pixels(lights), 1);
    assert_mean("scaled picture", illuminance(lights, LIGHTS_SKY, vec3(0, 0, 0), vec3(0, 1, 0)),
                15000);
    arena_release(&arena);
}

/* North is the left edge, east a quarter, south (+Z) the middle; rotation adds to azimuth. */
static void a_picture_hangs_the_right_way_round(void **state)
{
    (void)state;
    Arena arena = arena_reserve(1 << 26);
    Scene *scene = builder_scene(&arena);
    float pixels[8 * 4 * 4] = {0}; /* 8 columns, 4 rows: column 0 north, 2 east ... */
    Sky sky;
    Error err;
    Wavelengths lanes;
    wavelengths_sample(0.3f, &lanes);
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 8; x++)
            for (int i = 0; i < 3; i++) pixels[4 * (y * 8 + x) + i] = (float)(x / 2 + 1);
    scene->environment.kind = ENVIRONMENT_HDRI;
    scene->environment.hdri_scale = 1;
    scene->environment.hdri = (Image){8, 4, IMAGE_RGBA32F, pixels};
    for (int turn = 0; turn < 4; turn++) {
        scene->environment.hdri_rotation = (float)(turn * PI / 2 + 0.35);
        assert_true(sky_build(&scene->environment, &arena, &sky, &err));
        for (int k = 0; k < 4; k++) {
            float angle = (float)(k * PI / 2 + 0.35 + PI / 4);
            Vec3 d = vec3((float)sin((double)angle), 0, (float)-cos((double)angle));
            SkySample seen = sky_seen(&sky, d, d, &lanes);
            assert_close(spectrum_sum(seen.radiance * lanes.xyz[1]), (k - turn + 4) % 4 + 1,
                         1e-2);
        }
    }
    arena_release(&arena);
}

/* Pearson's test of a sampler against its density, both over a grid of directions. */
static void picture_samples_follow_their_density(void **state)
{
    (void)state;
    enum { ROWS = 16, COLUMNS = 32, COUNT = 400000, FINE = 24 };
    Arena arena = arena_reserve(1 << 28);
    Scene *scene = picture_scene(&arena, 64, 32);
    Sky sky;
    Error err;
    uint32_t random = 5;
    int unlike = 0;
    static double found[ROWS * COLUMNS], expected[ROWS * COLUMNS];
    Wavelengths lanes;
    wavelengths_sample(0.3f, &lanes);
    scene->environment.hdri_rotation = (float)(2 * PI * 5 / 64); /* texels on the grid */
    assert_true(sky_build(&scene->environment, &arena, &sky, &err));
    for (int i = 0; i < COUNT; i++) {
        SkySample sample;
        Vec3 n = vec3(0, 1, 0);
        float u0 = random_unit(&random), u1 = random_unit(&random);
        if (!sky_sample(&sky, n, (float[2]){u0, u1}, &lanes, &sample)) continue;
        Vec3 d = sample.direction;
        float seen = sky_seen(&sky, d, n, &lanes).pdf; /* a neighbour's, at a texel's edge */
        unlike += fabsf(sample.pdf - seen) > 1e-2f * seen;
        int row = (int)(acos(fmax(-1, fmin(1, (double)d.y))) / PI * ROWS);
        int column = (int)((atan2((double)d.z, (double)d.x) + PI) / (2 * PI) * COLUMNS);
        found[(row < ROWS ? row : ROWS - 1) * COLUMNS + column % COLUMNS]++;
    }
    assert_true(unlike < COUNT / 1000);
    double total = 0, chi2 = 0;
    int cells = 0;
    for (int row = 0; row < ROWS * FINE; row++)
        for (int column = 0; column < COLUMNS * FINE; column++) {
            double theta = PI * (row + 0.5) / (ROWS * FINE);
            double phi = 2 * PI * (column + 0.5) / (COLUMNS * FINE) - PI;
            Vec3 d = vec3((float)(sin(theta) * cos(phi)), (float)cos(theta),
                          (float)(sin(theta) * sin(phi)));
            double share = (double)sky_seen(&sky, d, vec3(0, 1, 0), &lanes).pdf * sin(theta) * PI /
                           (ROWS * FINE) * 2 * PI / (COLUMNS * FINE);
            expected[row / FINE * COLUMNS + column / FINE] += share * COUNT;
            total += share;
        }
    assert_close(total, 1, 2e-3);
    for (int i = 0; i < ROWS * COLUMNS; i++) {
        if (expected[i] < 10) continue;
        double spread = expected[i] + 2e-5 * expected[i] * expected[i]; /* grid's own error */
        chi2 += (found[i] - expected[i]) * (found[i] - expected[i]) / spread;
        cells++;
    }
    assert_true(cells > 100);
    assert_true(chi2 < cells + 4 * sqrt(2.0 * cells));
    arena_release(&arena);
}

/* Pearson's sum for counts that should all be the same. */
static double chi_square_of_equals(const int *counts, int cells, int samples)
{
    double expected = (double)samples / cells, sum = 0;
    for (int i = 0; i < cells; i++)
        sum += (counts[i] - expected) * (counts[i] - expected) / expected;
    return sum;
}

static void assert_equal_cells(const char *what, const int *counts, int cells, int samples)
{
    double chi2 = chi_square_of_equals(counts, cells, samples);
    if (chi2 > cells + 4 * sqrt(2.0 * cells))
        fail_msg("%s: chi-square %.1f over %d equal cells", what, chi2, cells);
}

static void sun_samples_are_uniform_on_the_disc_and_never_off_it(void **state)
{
    (void)state;
    enum { RINGS = 8, SECTORS = 16 };
    Arena    arena = arena_reserve(1 << 26);
    Scene   *scene = builder_scene(&arena);
    Sky      sky;
    Error    err;
    uint32_t random = 3;
    static int counts[RINGS * SECTORS];
    scene->environment.has_sun = true;
    scene->environment.sun_illuminance_lx = 1;
    scene->environment.sun_elevation = 0.4f;
    assert_true(sky_build(&scene->environment, &arena, &sky, &err));
    Frame frame = frame_from_z(sky.sun_direction);
    for (int i = 0; i < SAMPLES; i++) {
        float u0 = random_unit(&random), u1 = random_unit(&random);
        Vec3  d = sun_sample(&sky, u0, u1), local = frame_to_local(&frame, d);
        assert_close(sun_pdf(&sky, d), 1 / sky.sun_solid_angle, 1e-6);
        double away2 = (double)(local.x * local.x + local.y * local.y);
        double share = away2 / pow(sin((double)sky.sun_radius), 2);
        double turns = atan2((double)local.y, (double)local.x) / (2 * PI) + 0.5;
        int    ring = (int)(share * RINGS), sector = (int)(turns * SECTORS);
        counts[(ring < RINGS ? ring : RINGS - 1) * SECTORS + sector % SECTORS]++;
    }
    assert_equal_cells("sun", counts, RINGS * SECTORS, SAMPLES);
    assert_close(sky.sun_solid_angle, 2 * PI * (1 - cos((double)sky.sun_radius)), 1e-4);
    arena_release(&arena);
}

/* Two lamps, one four times as large and three times as bright: points are uniform on each
 * triangle, triangles are chosen by power, and the density integrates to one. */
static void emitter_samples_follow_their_density(void **state)
{
    (void)state;
    enum { STRIPS = 8 };
    Arena    arena = arena_reserve(1 << 28);
    Scene   *scene = builder_scene(&arena);
    uint32_t random = 8;
    static int chosen[4], strips[STRIPS];
    for (int lamp = 0; lamp < 2; lamp++) {
        Material material = builder_material(0);
        material.is_emitter = true;
        for (int i = 0; i < 3; i++) material.emissive_cd_m2[i] = lamp ? 300.0f : 100.0f;
        builder_part(scene, material);
        builder_quad(scene, vec3(4.0f * (float)lamp, 2, 0), vec3(lamp ? 2.0f : 1.0f, 0, 0),
                     vec3(0, 0, lamp ? 2.0f : 1.0f));
    }
    Emitters emitters = emitters_build(scene, &arena);
    double   area[4] = {2, 2, 8, 8}, total = 0;
    assert_int_equal(emitters.count, 4);
    for (int t = 0; t < 4; t++)
        total += area[t] * (double)emitters_pdf_area(&emitters, scene, (uint32_t)t);
    assert_close(total, 1, 1e-5);
    for (int i = 0; i < SAMPLES; i++) {
        TrianglePoint point;
        float    u[3], pdf_area;
        random3(&random, u);
        uint32_t t = emitters_sample(&emitters, scene, u, &point, &pdf_area);
        chosen[t]++;
        assert_close(pdf_area, emitters_pdf_area(&emitters, scene, t), 1e-6);
        if (t >= 2) strips[(int)((double)(point.position.x - 2) / 4 * STRIPS * 0.99999)]++;
    }
    for (int t = 0; t < 4; t++) {
        double share = area[t] * (double)emitters.pdf_area[t];
        assert_near(chosen[t], share * SAMPLES, 5 * sqrt(share * SAMPLES));
    }
    assert_close(chosen[2] / (double)chosen[0], 12, 0.1);
    assert_equal_cells("strips of the large lamp", strips, STRIPS, chosen[2] + chosen[3]);
    arena_release(&arena);
}

static void point_and_spot_follow_the_inverse_square_and_the_cone(void **state)
{
    (void)state;
    Arena arena = arena_reserve(1 << 26);
    Scene *scene = builder_scene(&arena);
    scene->lights[scene->light_count++] = (PunctualLight){
        .kind = LIGHT_POINT, .position = {0, 3, 0}, .intensity = {1000, 1000, 1000}};
    const Lights *lights = build(scene, &arena);
    assert_mean("1000 cd at 3 m",
                illuminance(lights, LIGHTS_PUNCTUAL, vec3(0, 0, 0), vec3(0, 1, 0)), 111.111);
    scene->lights[0].kind = LIGHT_SPOT;
    scene->lights[0].direction = vec3(0, -1, 0);
    scene->lights[0].cos_inner = (float)cos(0.2);
    scene->lights[0].cos_outer = (float)cos(0.4);
    assert_mean("inside the cone",
                illuminance(lights, LIGHTS_PUNCTUAL, vec3(0.3f, 0, 0), vec3(0, 1, 0)),
                1000 * 3 / pow(9.09, 1.5));
    double ramp = (cos(0.3) - cos(0.4)) / (cos(0.2) - cos(0.4));
    assert_mean(
        "on the cone's edge",
        illuminance(lights, LIGHTS_PUNCTUAL, vec3((float)(3 * tan(0.3)), 0, 0), vec3(0, 1, 0)),
        1000.0 / 9 * pow(cos(0.3), 3) * ramp * ramp);
    arena_release(&arena);
}

static void many_lights_are_chosen_without_bias(void **state)
{
    (void)state;
    Arena arena = arena_reserve(1 << 26);
    Scene *scene = builder_scene(&arena);
    double expected = 0;
    for (int i = 0; i < 50; i++) {
        Vec3 at =
            vec3((float)(i % 10) - 4.5f, 2 + 0.1f * (float)(i % 3), (float)(i / 10) - 2.0f);
        float cd = 10.0f * (float)(i % 7 + 1);
        double d2 = (double)vec3_dot(at, at);
        scene->lights[scene->light_count++] =
            (PunctualLight){.kind = LIGHT_POINT, .position = at, .intensity = {cd, cd, cd}};
        expected += (double)cd * (double)at.y / (d2 * sqrt(d2));
    }
    assert_mean(
        "fifty lamps",
        illuminance(build(scene, &arena), LIGHTS_PUNCTUAL, vec3(0, 0, 0), vec3(0, 1, 0)),
        expected);
    arena_release(&arena);
}

/* A square of half side a at height h over the point: E = L * 4 * (corner factor). */
static void an_area_light_gives_its_configuration_factor(void **state)
{
    (void)state;
    Arena arena = arena_reserve(1 << 28);
    Scene *scene = builder_scene(&arena);
    Material lamp = builder_material(0);
    lamp.is_emitter = true;
    for (int i = 0; i < 3; i++) lamp.emissive_cd_m2[i] = 2000;
    builder_part(scene, lamp);
    builder_quad(scene, vec3(0, 2, 0), vec3(1, 0, 0), vec3(0, 0, 1)); /* front looks down */
    double x = 0.5, root = sqrt(1 + x * x);
    double factor = 4 / (2 * PI) * 2 * (x / root * atan(x / root));
    const Lights *lights = build(scene, &arena);
    assert_mean("square lamp",
                illuminance(lights, LIGHTS_EMITTERS, vec3(0, 0, 0), vec3(0, 1, 0)),
                PI * 2000 * factor);
    LightSample sample;
    Wavelengths w;
    float u[3] = {0.3f, 0.4f, 0.1f};
    wavelengths_sample(0.5f, &w);
    assert_true(lights_sample(lights, LIGHTS_EMITTERS, (LitPoint){vec3(0, 0, 0), vec3(0, 1, 0)},
                              &w, u, &sample));
    float pdf0 = lights_emitter_pdf(lights, 0, sample.wi, vec3(0, -1, 0), sample.distance);
    float pdf1 = lights_emitter_pdf(lights, 1, sample.wi, vec3(0, -1, 0), sample.distance);
    assert_close(pdf0, sample.pdf, 1e-5);
    assert_close(pdf1, sample.pdf, 1e-5);
    assert_false(lights_sample(lights, LIGHTS_EMITTERS,
                               (LitPoint){vec3(0, 4, 0), vec3(0, -1, 0)}, &w, u,
                               &sample)); /* its back is dark */
    arena_release(&arena);
}

static void a_sky_model_that_is_not_there_is_named(void **state)
{
    (void)state;
    Arena arena = arena_reserve(1 << 26);
    Scene *scene = builder_scene(&arena);
    Lights *lights;
    Error err;
    scene->environment.kind = ENVIRONMENT_PEREZ;
    assert_false(lights_build(scene, &arena, &lights, &err));
    assert_non_null(strstr(err.text, "\"perez\""));
    assert_int_equal(err.code, ERROR_INPUT);
    arena_release(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_suns_irradiance_is_exact_whatever_its_size),
        cmocka_unit_test(the_heading_turns_the_sun_and_not_the_scene),
        cmocka_unit_test(a_uniform_sky_of_luminance_l_gives_pi_l),
        cmocka_unit_test(a_picture_can_be_scaled_to_an_illuminance),
        cmocka_unit_test(a_picture_hangs_the_right_way_round),
        cmocka_unit_test(picture_samples_follow_their_density),
        cmocka_unit_test(sun_samples_are_uniform_on_the_disc_and_never_off_it),
        cmocka_unit_test(emitter_samples_follow_their_density),
        cmocka_unit_test(point_and_spot_follow_the_inverse_square_and_the_cone),
        cmocka_unit_test(many_lights_are_chosen_without_bias),
        cmocka_unit_test(an_area_light_gives_its_configuration_factor),
        cmocka_unit_test(a_sky_model_that_is_not_there_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
