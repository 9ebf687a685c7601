/* SPDX-License-Identifier: Apache-2.0 */
/* Lamps without a surface in mirrors: random places of each kind beside closed forms. */
#include "base/units.h"
#include "world_fixture.h"

/* Of each kind. */
static int places(void) {
    return all_laws() ? 200 : 24;
}

static float between(Sampler *sampler, float low, float high) {
    return low + (high - low) * sampler_1d(sampler);
}

static Vec3 random_direction(Sampler *sampler) {
    Vec2 at = sampler_2d(sampler);
    float z = 1 - 2 * at.x, r = sqrtf(fmaxf(1 - z * z, 0)), sine, cosine;
    sincos_turns(at.y, &sine, &cosine);
    return vec3(r * cosine, r * sine, z);
}

static void add_lamp(World *world, LightKind kind, Vec3 at, Vec3 direction) {
    world->scene->lights[world->scene->light_count++] = (PunctualLight){.name = "lamp",
                                                                        .kind = kind,
                                                                        .position = at,
                                                                        .direction = direction,
                                                                        .intensity = {50, 50, 50},
                                                                        .cos_inner = 0.9f,
                                                                        .cos_outer = 0.3f,
                                                                        .level = 1};
}

/* cd towards a unit direction; of a directional light lux. */
static double sent(const PunctualLight *light, Vec3 towards) {
    double c = (double)vec3_dot(light->direction, towards);
    double ramp = fmin(fmax((c - 0.3) / (0.9 - 0.3), 0), 1);
    return light->kind == LIGHT_SPOT ? 50 * ramp * ramp : 50;
}

/* Exact Fresnel of a dielectric face, unpolarised; of a pane all its inner reflections. */
static double pane_reflectance(double cosine, double ior) {
    double sine = sqrt(1 - cosine * cosine) / ior, inner = sqrt(1 - sine * sine), sum = 0;
    for (int s = 0; s < 2; s++) {
        double a = s ? cosine : ior * cosine, b = s ? ior * inner : inner;
        double r = (a - b) / (a + b), r2 = r * r;
        sum += 0.5 * 2 * r2 / (1 + r2);
    }
    return sum;
}

static double metal_reflectance(double cosine) {
    return 0.6 + 0.4 * pow(1 - cosine, 5);
}

/* Lux on a meter that faces n, from a direction, of what brings `lx` to what faces it. */
static double on(Vec3 n, Vec3 from, double lx) {
    return fmax((double)vec3_dot(n, from), 0) * lx;
}

/* The plane z = 0 mirrors, 60 m wide: all lies above it. A directional light comes from above. */
static double expected_flat(const PunctualLight *light, Vec3 at, Vec3 n, bool is_pane) {
    Vec3 image = light->position, flipped = light->direction;
    double lx = 0;
    image.z = -image.z;
    flipped.z = -flipped.z;
    if (light->kind == LIGHT_DIRECTIONAL) {
        Vec3 from = vec3_neg(flipped), straight = vec3_neg(light->direction);
        double cosine = -(double)from.z;
        double r = is_pane ? pane_reflectance(cosine, 1.5) : metal_reflectance(cosine);
        return on(n, straight, 50) + on(n, from, 50 * r);
    }
    Vec3 way = vec3_sub(light->position, at);
    double d2 = (double)vec3_dot(way, way);
    way = vec3_normalize(way);
    lx += on(n, way, sent(light, vec3_neg(way)) / d2);
    way = vec3_sub(image, at);
    d2 = (double)vec3_dot(way, way);
    way = vec3_normalize(way);
    Vec3 leaves = vec3(-way.x, -way.y, way.z);
    double cosine = -(double)way.z;
    double r = is_pane ? pane_reflectance(cosine, 1.5) : metal_reflectance(cosine);
    return lx + on(n, way, r * sent(light, leaves) / d2);
}

TEST(a_lamp_in_a_flat_mirror_is_a_lamp_at_its_image) {
    const LightKind kinds[] = {LIGHT_POINT, LIGHT_SPOT, LIGHT_DIRECTIONAL};
    for (int i = 0; i < 2 * 3 * places(); i++) {
        SCOPED_WORLD world = world_start();
        Sampler sampler = sampler_start(1, i, 0, 0);
        bool is_pane = i % 2;
        Material pane = builder_pane(1.5f);
        pane.specular = 1;
        builder_part(world.scene, is_pane ? pane : builder_mirror(0.6f));
        builder_quad(world.scene, vec3(0, 0, 0), vec3(30, 0, 0), vec3(0, 30, 0));
        Vec3 from =
            vec3(between(&sampler, -2, 2), between(&sampler, -2, 2), between(&sampler, 0.1f, 2));
        Vec3 at =
            vec3(between(&sampler, -2, 2), between(&sampler, -2, 2), between(&sampler, 0.1f, 2));
        Vec3 way = random_direction(&sampler), n = random_direction(&sampler);
        LightKind kind = kinds[i / 2 % 3];
        if (kind == LIGHT_DIRECTIONAL)
            way = vec3_normalize(vec3(way.x, way.y, -0.3f - fabsf(way.z)));
        add_lamp(&world, kind, from, way);
        world_ready(&world, 2);
        Gauge head = {at, n, 0, true};
        double found = world_measure(&world, head, 1, 2048).mean;
        double expected = expected_flat(&world.scene->lights[0], at, n, is_pane);
        if (!(fabs(found - expected) <= 5e-3 * expected + 1e-6))
            fail_msg("place %d, kind %d: %g lx, expected %g", i, (int)kind, found, expected);
    }
}

/* On a piece of a sphere, from outside and from within, a lamp's light is spread as test_mirror.c
 * says; a hollow mirror's radius counts as negative. */
TEST(a_lamp_in_a_bent_mirror_is_spread_as_the_mirror_equation_says) {
    int focused = 0;
    for (int i = 0; i < 2 * places(); i++) {
        SCOPED_WORLD world = world_start();
        Sampler sampler = sampler_start(2, i, 0, 0);
        double bend = i % 2 ? -2 : 2, t = (double)between(&sampler, 0.05f, 0.8f);
        Vec3 p = random_direction(&sampler), side = random_direction(&sampler);
        double s = (double)between(&sampler, 0.2f, 3), l = (double)between(&sampler, 0.2f, 3);
        side = vec3_normalize(vec3_along(side, p, -vec3_dot(side, p)));
        double along = s + l + bend * s * l / cos(t), across = s + l + bend * s * l * cos(t);
        /* Near a focus the piece's end cuts the image off, or light comes by two points. */
        if (fmin(fabs(along), fabs(across)) < 0.8) continue;
        focused += along < 0;
        builder_part(world.scene, builder_mirror(0.6f));
        builder_cap(world.scene, p);
        Vec3 up = vec3_scale(p, (float)(bend / 2 * cos(t)));
        Vec3 in = vec3_along(up, side, (float)sin(t)), out = vec3_along(up, side, -(float)sin(t));
        Vec3 lamp = vec3_along(p, in, (float)s), at = vec3_along(p, out, (float)l);
        add_lamp(&world, LIGHT_POINT, lamp, vec3(0, 0, 1));
        world_ready(&world, 2);
        Gauge head = {at, vec3_neg(out), 0, true};
        Vec3 straight = vec3_sub(lamp, at);
        double d2 = (double)vec3_dot(straight, straight);
        double expected = 50 * metal_reflectance(cos(t)) / fabs(along * across);
        expected += on(head.direction, vec3_normalize(straight), 50 / d2);
        double found = world_measure(&world, head, 1, 2048).mean;
        if (!(fabs(found - expected) <= 5e-3 * expected))
            fail_msg("place %d: %g lx, expected %g", i, found, expected);
    }
    assert_true(focused > places() / 10);
}

/* What a matt floor beside a mirror sends to an eye: by the part's own mirrors and by all. */
TEST(a_floor_beside_a_mirror_is_lit_by_the_lamps_image) {
    SCOPED_WORLD world = world_start();
    builder_part(world.scene, builder_material(0.5f));
    builder_quad(world.scene, vec3(0, 0, 0), vec3(2, 0, 0), vec3(0, 0, -2));
    builder_part(world.scene, builder_mirror(0.6f));
    builder_quad(world.scene, vec3(0, 1, -2), vec3(2, 0, 0), vec3(0, 1, 0));
    Vec3 lamp = vec3(0.3f, 1.2f, 0.5f), at = vec3(0.2f, 0, 0.1f);
    add_lamp(&world, LIGHT_POINT, lamp, vec3(0, 0, 1));
    world_ready(&world, 2);
    WorldLook look = {vec3(0.2f, 1.5f, 1.5f), vec3(0, -1.5f, -1.4f), 1e-3f, 1, 40000};
    WorldMean found = world_luminance(&world, &look);
    Vec3 straight = vec3_sub(lamp, at), image = vec3(lamp.x, lamp.y, -4 - lamp.z);
    Vec3 by_mirror = vec3_sub(image, at);
    double d = (double)vec3_length(straight), m = (double)vec3_length(by_mirror);
    double lx = 50 * (double)straight.y / (d * d * d);
    lx += 50 * metal_reflectance(-(double)by_mirror.z / m) * (double)by_mirror.y / (m * m * m);
    /* Light that goes floor, mirror, floor is not there: two bounces end before. */
    if (!(fabs(found.mean - 0.5 / PI * lx) < 4 * found.sigma) || !(found.sigma < 2e-3 * lx))
        fail_msg("%g +- %g cd/m2, expected %g", found.mean, found.sigma, 0.5 / PI * lx);
}

/* A ball of 6 cm beside a mirror and a bent one: what is sampled and what chance finds share its
 * light, and add up to what chance alone finds. */
TEST(small_emitters_in_mirrors_keep_their_mean) {
    for (int i = 0; i < 3; i++) {
        SCOPED_WORLD world = world_start();
        Material floor = builder_material(0.5f), pane = builder_pane(1.5f);
        floor.specular = pane.specular = 1;
        floor.roughness = 0.4f;
        builder_part(world.scene, floor);
        builder_quad(world.scene, vec3(0, 0, 0), vec3(2, 0, 0), vec3(0, 0, -2));
        builder_part(world.scene, i == 2 ? pane : builder_mirror(0.8f));
        if (i == 1) builder_sphere(world.scene, vec3(0, 0.5f, -0.6f), 0.4f, 16, 0);
        else builder_quad(world.scene, vec3(0, 1, -1), vec3(2, 0, 0), vec3(0, 1, 0));
        builder_part(world.scene, builder_lamp(20000));
        builder_sphere(world.scene, vec3(0.3f, 0.6f, 0.1f), 0.03f, 6, 0);
        world_ready(&world, 4);
        assert_int_equal(world.context.beams[BEAMS_OF_EMITTERS].emitters.count, 1);
        Gauge eye = {vec3(0.2f, 1.2f, 1.4f), vec3(-0.1f, -1.2f, -1.4f), 0.05f, false};
        for (int head = 0; head < 2; head++) {
            if (!all_laws() && head != i % 2) continue;
            eye.is_luxmeter = head;
            if (head) eye = (Gauge){vec3(0.1f, 0.02f, 0), vec3(0, 0.2f, -1), 0, true};
            WorldMean both = world_measure(&world, eye, 1, 40000);
            const Mirrors *mirrors = world.context.beams[BEAMS_OF_EMITTERS].mirrors;
            world.context.beams[BEAMS_OF_EMITTERS].mirrors = NULL;
            WorldMean chance = world_measure(&world, eye, 2, 600000);
            world.context.beams[BEAMS_OF_EMITTERS].mirrors = mirrors;
            double sigma = sqrt(both.sigma * both.sigma + chance.sigma * chance.sigma);
            if (!(fabs(both.mean - chance.mean) < 3.5 * sigma) || !(sigma < 0.05 * chance.mean))
                fail_msg("kind %d, head %d: %g +- %g, by chance %g +- %g", i, head, both.mean,
                         both.sigma, chance.mean, chance.sigma);
            print_message("[          ] %g +- %g, by chance %g +- %g\n", both.mean, both.sigma,
                          chance.mean, chance.sigma);
        }
    }
}

/* Under another sky mirrors do the same with a lamp's light, which counts for less beside it. */
TEST(another_sky_leaves_what_mirrors_do_with_lamps) {
    SCOPED_WORLD world = world_start();
    builder_part(world.scene, builder_material(0.5f));
    builder_quad(world.scene, vec3(0, 0, 0), vec3(2, 0, 0), vec3(0, 0, -2));
    builder_part(world.scene, builder_mirror(0.6f));
    builder_quad(world.scene, vec3(0, 1, -2), vec3(2, 0, 0), vec3(0, 1, 0));
    add_lamp(&world, LIGHT_POINT, vec3(0.3f, 1.2f, 0.5f), vec3(0, 0, 1));
    world_ready(&world, 2);
    builder_sky(world.scene, 5000);
    Lights *lights;
    assert_done(lights_build(world.scene, &world.arena, &lights, &err));
    PathContext again = path_context_relight(&world.context, lights, &world.arena);
    PathContext fresh = path_context_build(world.scene, world.bvh, lights, 2, &world.arena);
    const MirrorBeams *before = &world.context.beams[BEAMS_OF_LAMPS];
    const MirrorBeams *kept = &again.beams[BEAMS_OF_LAMPS], *own = &fresh.beams[BEAMS_OF_LAMPS];
    bool is_rarer = false;
    assert_ptr_equal(kept->mirrors, before->mirrors);
    for (int i = 0; i < 20; i++) {
        Vec3 at = vec3(0.1f * (float)i - 1, 0, -0.05f * (float)i);
        float prob = mirror_beams_prob(kept, 0, false, at);
        assert_true(prob == mirror_beams_prob(own, 0, false, at));
        is_rarer |= prob < mirror_beams_prob(before, 0, false, at);
    }
    assert_true(is_rarer);
}

TEST_PROGRAM(NULL, NULL)
