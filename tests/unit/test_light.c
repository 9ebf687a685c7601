/* SPDX-License-Identifier: Apache-2.0 */
#include "emitter_fixture.h"
#include "light/emitters_build.h"
#include "light/sky.h"
#include "light_fixture.h"

TEST(the_suns_irradiance_is_exact_whatever_its_size) {
    const float radius[] = {0.0005f, 0.00465f, 0.05f};
    for (int i = 0; i < 3; i++) {
        ENDS_BY(arena_release) Arena arena = arena_reserve(1 << 28);
        Scene *scene = builder_scene(&arena);
        builder_sun(scene, 1.1, 0.6, 90000);
        scene->environment.sun_angular_radius = radius[i];
        const Lights *lights = build(scene, &arena);
        Vec3 to_sun =
            vec3((float)(cos(0.6) * sin(1.1)), (float)sin(0.6), (float)(-cos(0.6) * cos(1.1)));
        assert_illuminance("facing the sun", lights, LIGHTS_SUN, to_sun, 90000);
        assert_illuminance("on the ground", lights, LIGHTS_SUN, vec3(0, 1, 0), 90000 * sin(0.6));
    }
}

ARENA_TEST(the_heading_turns_the_sun_and_not_the_scene) {
    Scene *scene = builder_scene(&arena);
    Sky sky;
    builder_sun(scene, PI / 2, 0, 1); /* east */
    assert_done(sky_build(&scene->environment, &arena, &sky, &err));
    assert_near(sky.sun_direction.x, 1, 1e-6);
    scene->environment.heading = (float)(PI / 2); /* driving east: the sun is ahead */
    assert_done(sky_build(&scene->environment, &arena, &sky, &err));
    assert_near(sky.sun_direction.z, -1, 1e-6);
    scene->environment.forward = vec3(1, 0, 0);
    assert_done(sky_build(&scene->environment, &arena, &sky, &err));
    assert_near(sky.sun_direction.x, 1, 1e-6);
}

ARENA_TEST(a_uniform_sky_of_luminance_l_gives_pi_l) {
    Scene *scene = builder_scene(&arena);
    builder_sky(scene, 1000);
    const Lights *lights = build(scene, &arena);
    assert_illuminance("uniform sky", lights, LIGHTS_SKY, vec3(0, 1, 0), PI * 1000);
}

/* A picture with a soft gradient, a small sun, a dark half and a negative pixel. */
static Scene *picture_scene(Arena *arena, int width, int height) {
    Scene *scene = builder_scene(arena);
    float *pixels = ARENA_NEW(arena, float, 4 * width * height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int i = 0; i < 3; i++)
                pixels[4 * (y * width + x) + i] =
                    x > width / 2 ? 0.0f : 1 + 0.2f * (float)i + (float)y / (float)height;
    for (int i = 0; i < 3; i++) pixels[4 * (9 * width + 17) + i] = 5000;
    scene->environment.kind = ENVIRONMENT_HDRI;
    scene->environment.hdri_path = "picture";
    scene->environment.hdri_scale = 1;
    scene->environment.hdri = (Image){width, height, IMAGE_RGBA32F, pixels};
    return scene;
}

ARENA_TEST(a_picture_can_be_scaled_to_an_illuminance) {
    Scene *scene = picture_scene(&arena, 64, 32);
    scene->environment.horizontal_illuminance_lx = 15000;
    const Lights *lights = build(scene, &arena);
    assert_illuminance("scaled picture", lights, LIGHTS_SKY, vec3(0, 1, 0), 15000);
}

/* North is the left edge, east a quarter, south (+Z) the middle; rotation adds to azimuth. */
ARENA_TEST(a_picture_hangs_the_right_way_round) {
    Scene *scene = builder_scene(&arena);
    float pixels[8 * 4 * 4] = {0}; /* 8 columns, 4 rows: column 0 north, 2 east ... */
    Sky sky;
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
        assert_done(sky_build(&scene->environment, &arena, &sky, &err));
        for (int k = 0; k < 4; k++) {
            float angle = (float)(k * PI / 2 + 0.35 + PI / 4);
            Vec3 d = vec3((float)sin((double)angle), 0, (float)-cos((double)angle));
            SkySample seen = sky_seen(&sky, d, d, &lanes);
            assert_close(spectrum_sum(seen.radiance * lanes.xyz[1]), (k - turn + 4) % 4 + 1, 1e-2);
        }
    }
}

/* Pearson's test of a sampler against its density, both over a grid of directions. */
ARENA_TEST(picture_samples_follow_their_density) {
    enum { ROWS = 16, COLUMNS = 32, COUNT = 400000, FINE = 24 };
    Scene *scene = picture_scene(&arena, 64, 32);
    Sky sky;
    uint32_t random = 5;
    int unlike = 0;
    static double found[ROWS * COLUMNS], expected[ROWS * COLUMNS];
    Wavelengths lanes;
    wavelengths_sample(0.3f, &lanes);
    scene->environment.hdri_rotation = (float)(2 * PI * 5 / 64); /* texels on the grid */
    assert_done(sky_build(&scene->environment, &arena, &sky, &err));
    for (int i = 0; i < COUNT; i++) {
        SkySample sample;
        Vec3 n = vec3(0, 1, 0);
        float u0 = random_unit(&random), u1 = random_unit(&random);
        if (!sky_choose(&sky, n, (float[2]){u0, u1}, &sample)) continue;
        Vec3 d = sample.direction;
        float seen = sky_seen(&sky, d, n, &lanes).pdf; /* a neighbour's, at a texel's edge */
        unlike += fabsf(sample.pdf - seen) > 1e-2f * seen;
        int row = (int)(acos(fmax(-1, fmin(1, (double)d.y))) / PI * ROWS);
        int column = (int)((atan2((double)d.z, (double)d.x) + PI) / (2 * PI) * COLUMNS);
        found[(row < ROWS ? row : ROWS - 1) * COLUMNS + column % COLUMNS]++;
    }
    assert_true(unlike < COUNT / 1000);
    double total = 0;
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
    assert_chi_square(0, found, expected, ROWS * COLUMNS, (ChiLimits){2e-5, 100, 4});
}

ARENA_TEST(sun_samples_are_uniform_on_the_disc_and_never_off_it) {
    enum { RINGS = 8, SECTORS = 16 };
    Scene *scene = builder_scene(&arena);
    Sky sky;
    uint32_t random = 3;
    static double counts[RINGS * SECTORS], even[RINGS * SECTORS];
    builder_sun(scene, 0, 0.4f, 1);
    assert_done(sky_build(&scene->environment, &arena, &sky, &err));
    Frame frame = frame_from_z(sky.sun_direction);
    for (int i = 0; i < SAMPLES; i++) {
        float u0 = random_unit(&random), u1 = random_unit(&random);
        Vec3 d = sun_sample(&sky, u0, u1), local = frame_to_local(&frame, d);
        assert_close(sun_pdf(&sky, d), 1 / sky.sun_solid_angle, 1e-6);
        double away2 = (double)(local.x * local.x + local.y * local.y);
        double share = away2 / pow(sin((double)sky.sun_radius), 2);
        double turns = atan2((double)local.y, (double)local.x) / (2 * PI) + 0.5;
        int ring = (int)(share * RINGS), sector = (int)(turns * SECTORS);
        counts[(ring < RINGS ? ring : RINGS - 1) * SECTORS + sector % SECTORS]++;
    }
    for (int i = 0; i < RINGS * SECTORS; i++) even[i] = SAMPLES / (double)(RINGS * SECTORS);
    assert_chi_square(0, counts, even, RINGS * SECTORS, (ChiLimits){0, 100, 4});
    assert_close(sky.sun_solid_angle, 2 * PI * (1 - cos((double)sky.sun_radius)), 1e-4);
}

/* ---- emitters ---------------------------------------------------------------------------- */

static double triangle_area(const Scene *scene, uint32_t triangle) {
    TrianglePoint p[3];
    for (int k = 0; k < 3; k++) p[k] = triangle_point(scene, triangle, k == 1, k == 2);
    return 0.5 * (double)vec3_length(vec3_cross(vec3_sub(p[1].position, p[0].position),
                                                vec3_sub(p[2].position, p[0].position)));
}

/* The integral of the density over a triangle's pieces, fine^2 of them, by their middles;
 * strips: NULL, or by the strip of u that the piece lies in. */
static double density_total(const Emitters *emitters, const Scene *scene, const LitPoint *from,
                            uint32_t triangle, int fine, int strip_count, double *strips) {
    double total = 0, area = triangle_area(scene, triangle) / ((double)fine * fine);
    for (int i = 0; i < fine; i++)
        for (int k = 0; k < 2 * (fine - i) - 1; k++) {
            float in = k % 2 ? 2 / 3.0f : 1 / 3.0f, side = (float)fine;
            EmitterPoint at = {triangle, ((float)i + in) / side, ((float)(k / 2) + in) / side};
            EmitterDensity density = emitters_density(emitters, scene, from, at);
            double share = density_on_area(scene, at, from->position, density) * area;
            total += share;
            if (strips) strips[(int)(at.u * (float)strip_count * 0.99999f)] += share;
        }
    return total;
}

/* Two lamps, one four times as large and three times as bright, and a picture with a bright
 * corner and a dark half. */
static Scene *lamp_scene(Arena *arena) {
    static uint8_t picture[16 * 16 * 4];
    Scene *scene = builder_scene(arena);
    for (int lamp = 0; lamp < 3; lamp++) {
        Material material = builder_lamp(lamp ? 300 : 100);
        if (lamp == 2) material.emissive_texture.texture_id = 0;
        builder_part(scene, material);
        builder_quad(scene, vec3(4.0f * (float)lamp, 2, 0), vec3(lamp ? 2.0f : 1.0f, 0, 0),
                     vec3(0, 0, lamp ? 2.0f : 1.0f));
    }
    for (int i = 0; i < 16 * 16; i++)
        for (int k = 0; k < 4; k++)
            picture[4 * i + k] = k == 3 ? 255 : i % 16 > 7 ? 0 : i < 16 * 4 ? 255 : 90;
    scene->textures[0] = (Texture){{16, 16, IMAGE_RGBA8, picture}, WRAP_CLAMP, WRAP_CLAMP, true};
    return scene;
}

/* Far, near, nearer than a cell is long, behind, and where no lamp is above the horizon. */
static const LitPoint LIT[] = {{{0, 0, 0}, {0, 1, 0}, false},
                               {{3, 1.9f, 0.2f}, {0, 1, 0}, false},
                               {{3, 1.9f, 0.2f}, {0.8f, 0.6f, 0}, false},
                               {{8.3f, 1.98f, 1}, {0, 0, 1}, true},
                               {{-50, -20, 7}, {1, 0, 0}, false},
                               {{9, 5, 0}, {0, -1, 0}, false},
                               {{0, 0, 0}, {0, -1, 0}, false}};

ARENA_TEST(densities_of_emitters_integrate_to_one_from_anywhere) {
    Scene *scene = lamp_scene(&arena);
    Emitters emitters = emitters_build(scene, &arena);
    assert_int_equal(emitters.count, 6);
    for (size_t i = 0; i < sizeof LIT / sizeof *LIT; i++) {
        double total = 0;
        for (int t = 0; t < emitters.count; t++) {
            const Emitter *e = &emitters.emitters[t]; /* whole pieces of every cell */
            int fine = e->side * (1 + 200 / e->side);
            total += density_total(&emitters, scene, &LIT[i], e->triangle, fine, 1, NULL);
        }
        assert_close(total, 1, 1e-3);
    }
}

/* Points fall into strips of every triangle as the density says. */
ARENA_TEST(emitter_samples_follow_their_density) {
    enum { STRIPS = 9, TRIANGLES = 6 };
    Scene *scene = lamp_scene(&arena);
    int fine = STRIPS * (all_laws() ? 64 : 16); /* 16: at most 0.3 % of a strip amiss */
    int count = all_laws() ? SAMPLES : SAMPLES / 2;
    Emitters emitters = emitters_build(scene, &arena);
    uint32_t random = 8;
    for (size_t p = 0; p < sizeof LIT / sizeof *LIT; p++) {
        double found[TRIANGLES * STRIPS] = {0}, expected[TRIANGLES * STRIPS] = {0};
        int unlike = 0;
        for (int i = 0; i < count; i++) {
            float u[3];
            EmitterDensity density, seen;
            random3(&random, u);
            EmitterPoint at = emitters_sample(&emitters, scene, &LIT[p], u, &density);
            assert_true(at.u >= 0 && at.v >= 0 && at.u + at.v <= 1.0001f);
            assert_true(density.on_area > 0 || density.on_sphere > 0);
            seen = emitters_density(&emitters, scene, &LIT[p], at);
            unlike += seen.on_area != density.on_area || /* rounded into the next cell */
                      seen.on_sphere != density.on_sphere;
            found[at.triangle * STRIPS + (uint32_t)(at.u * STRIPS * 0.99999f)]++;
        }
        for (uint32_t t = 0; t < TRIANGLES; t++)
            density_total(&emitters, scene, &LIT[p], t, fine, STRIPS, expected + t * STRIPS);
        for (int i = 0; i < TRIANGLES * STRIPS; i++) expected[i] *= count;
        assert_chi_square((int)p, found, expected, TRIANGLES * STRIPS, (ChiLimits){4e-5, 15, 4.5});
        assert_true(unlike < count / 1000);
    }
}

/* From far away the choice is by power; from near it is the lamp at hand. */
ARENA_TEST(emitters_are_chosen_by_what_they_send_to_the_point) {
    Scene *scene = builder_scene(&arena);
    uint32_t random = 3;
    for (int lamp = 0; lamp < 2; lamp++) {
        builder_part(scene, builder_lamp(lamp ? 300 : 100));
        builder_quad(scene, vec3(4.0f * (float)lamp, 2, 0), vec3(lamp ? 2.0f : 1.0f, 0, 0),
                     vec3(0, 0, lamp ? 2.0f : 1.0f));
    }
    Emitters emitters = emitters_build(scene, &arena);
    const LitPoint from[] = {{{4, -400, 0}, {0, 1, 0}, false},
                             {{-0.5f, 1.5f, 0}, {0, 1, 0}, false}};
    const double low[] = {11.5, 0}, high[] = {12.5, 0.6};
    for (int k = 0; k < 2; k++) {
        int chosen[2] = {0};
        for (int i = 0; i < SAMPLES; i++) {
            float u[3];
            EmitterDensity density;
            random3(&random, u);
            chosen[emitters_sample(&emitters, scene, &from[k], u, &density).triangle / 2]++;
        }
        double ratio = chosen[1] / (double)chosen[0];
        if (!(ratio >= low[k] && ratio <= high[k])) fail_msg("ratio %g", ratio);
    }
}

/* Lit texels are found in proportion to their light. */
ARENA_TEST(bright_texels_are_chosen_more_often) {
    enum { SIDE = 64 };
    Scene *scene = builder_scene(&arena);
    uint32_t random = 21;
    int lit = 0;
    uint8_t *picture = ARENA_NEW(&arena, uint8_t, SIDE *SIDE * 4);
    for (int i = 0; i < SIDE * SIDE; i++) /* one texel in 64, and a grey that gives a tenth */
        for (int k = 0; k < 3; k++) picture[4 * i + k] = i % 8 == 3 && i / SIDE % 8 == 5 ? 255 : 12;
    scene->textures[0] =
        (Texture){{SIDE, SIDE, IMAGE_RGBA8, picture}, WRAP_CLAMP, WRAP_CLAMP, true};
    Material material = builder_lamp(1000);
    material.emissive_texture.texture_id = 0;
    builder_part(scene, material);
    builder_quad(scene, vec3(0, 2, 0), vec3(1, 0, 0), vec3(0, 0, 1));
    Emitters emitters = emitters_build(scene, &arena);
    for (int i = 0; i < SAMPLES; i++) {
        float u[3], rgb[3];
        EmitterDensity density;
        random3(&random, u);
        EmitterPoint at = emitters_sample(&emitters, scene, &LIT[0], u, &density);
        TrianglePoint point = triangle_point(scene, at.triangle, at.u, at.v);
        emitted_rgb(scene, at.triangle, &point, rgb);
        lit += rgb[1] > 500;
    }
    print_message("texels with 81%% of the light take %.0f%% of the samples, 1.6%% by area\n",
                  100.0 * lit / SAMPLES);
    assert_true(lit > SAMPLES / 2);
}

ARENA_TEST(point_and_spot_follow_the_inverse_square_and_the_cone) {
    Scene *scene = builder_scene(&arena);
    scene->lights[scene->light_count++] = (PunctualLight){
        .kind = LIGHT_POINT, .position = {0, 3, 0}, .intensity = {1000, 1000, 1000}};
    const Lights *lights = build(scene, &arena);
    assert_illuminance("1000 cd at 3 m", lights, LIGHTS_PUNCTUAL, vec3(0, 1, 0), 111.111);
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
}

ARENA_TEST(many_lights_are_chosen_without_bias) {
    Scene *scene = builder_scene(&arena);
    double expected = 0;
    for (int i = 0; i < 50; i++) {
        Vec3 at = vec3((float)(i % 10) - 4.5f, 2 + 0.1f * (float)(i % 3), (float)(i / 10) - 2.0f);
        float cd = 10.0f * (float)(i % 7 + 1);
        double d2 = (double)vec3_dot(at, at);
        scene->lights[scene->light_count++] =
            (PunctualLight){.kind = LIGHT_POINT, .position = at, .intensity = {cd, cd, cd}};
        expected += (double)cd * (double)at.y / (d2 * sqrt(d2));
    }
    assert_illuminance("fifty lamps", build(scene, &arena), LIGHTS_PUNCTUAL, vec3(0, 1, 0),
                       expected);
}

/* Discs close to the point with beams so narrow that the middle of most sends nothing there:
 * together they give what each gives alone, chosen among few and among many. */
TEST(lamps_with_openings_are_chosen_without_bias) {
    static const float c[2] = {0, 6.2831853f}, gamma[3] = {0, 0.4f, 0.6f};
    static const float relative[6] = {1, 1, 0, 1, 1, 0};
    static const IntensityWeb web = {WEB_C, 1, 3, c, gamma, relative, 1, 1, {0, 0, -1}};
    for (int count = 3; count <= 12; count += 9) {
        Arena arena = test_arena(state);
        Scene *scene = builder_scene(&arena);
        double expected = 0;
        for (int i = 0; i < count; i++) {
            PunctualLight lamp = {.kind = LIGHT_LUMINAIRE,
                                  .web = &web,
                                  .position = {0.5f * (float)(i % 4) - 0.6f, 1.0f, 0.3f},
                                  .axis_x = {1, 0, 0},
                                  .axis_y = {0, 0, -1},
                                  .axis_z = {0, 1, 0},
                                  .opening = {OPENING_CYLINDER, 2, true, {0.3f, 0.3f, 0}}};
            for (int k = 0; k < 3; k++) lamp.intensity[k] = 100 + 50 * (float)i;
            scene->lights[0] = lamp;
            scene->light_count = 1;
            Mean alone =
                illuminance(build(scene, &arena), LIGHTS_PUNCTUAL, vec3(0, 0, 0), vec3(0, 1, 0));
            expected += alone.sum / (double)alone.count;
        }
        for (int i = 0; i < count; i++) {
            scene->lights[i] = scene->lights[0];
            scene->lights[i].position.x = 0.5f * (float)(i % 4) - 0.6f;
            for (int k = 0; k < 3; k++) scene->lights[i].intensity[k] = 100 + 50 * (float)i;
        }
        scene->light_count = count;
        assert_mean(
            "lamps with openings",
            illuminance(build(scene, &arena), LIGHTS_PUNCTUAL, vec3(0, 0, 0), vec3(0, 1, 0)),
            expected);
    }
}

/* A square of half side a at height h over the point: E = L * 4 * (corner factor). */
ARENA_TEST(an_area_light_gives_its_configuration_factor) {
    Scene *scene = builder_scene(&arena);
    builder_part(scene, builder_lamp(2000));
    builder_quad(scene, vec3(0, 2, 0), vec3(1, 0, 0), vec3(0, 0, 1)); /* front looks down */
    double x = 0.5, root = sqrt(1 + x * x);
    double factor = 4 / (2 * PI) * 2 * (x / root * atan(x / root));
    const Lights *lights = build(scene, &arena);
    assert_illuminance("square lamp", lights, LIGHTS_EMITTERS, vec3(0, 1, 0), PI * 2000 * factor);
    LightSample sample;
    float u[3] = {0.3f, 0.4f, 0.1f};
    assert_true(lights_sample(lights, LIGHTS_EMITTERS, LIT[0], u, &sample));
    /* the ray that finds the same point: on the plane y = 2, u and v along the quad's edges */
    Vec3 at = vec3_scale(sample.wi, sample.distance);
    float s = 0.5f + 0.5f * at.x, t = 0.5f - 0.5f * at.z; /* builder_quad's corners */
    Hit hits[2] = {{sample.distance, s - (1 - t), 1 - t, 0}, {sample.distance, s, 1 - t - s, 1}};
    Hit hit = hits[hits[0].u >= 0 ? 0 : 1];
    assert_close(lights_emitter_pdf(lights, &LIT[0], &hit, sample.wi, vec3(0, -1, 0)), sample.pdf,
                 1e-3);
    assert_false(lights_sample(lights, LIGHTS_EMITTERS,
                               (LitPoint){vec3(0, 4, 0), vec3(0, -1, 0), false}, u,
                               &sample)); /* its back is dark */
}

TEST_PROGRAM(make_arena, drop_arena)
