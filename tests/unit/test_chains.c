/* SPDX-License-Identifier: Apache-2.0 */
/* Chains of objects: they add up, their intervals hold, what they foretell comes true. */
#include "fixture.h"

#include "base/sampler.h"
#include "base/units.h"
#include "panel/query/panel_opened.h"
#include "review/chain/chains.h"
#include "world_fixture.h"

#define MOST 10

static const Vec3 eye = {0.1f, 0.1f, 0.7f};
static const Vec3 targets[4] = {
    {-0.1f, -0.05f, 0}, {0.1f, 0.05f, 0}, {-0.1f, 0.05f, 0}, {0.1f, -0.05f, 0}};

enum { FLOOR, SIDE, BACK, LAMP, SCREEN, PANE, PARTS };

/* A display that looks along +z into grey walls, a lamp above and a pane to the right, under a
 * sky. wall[]: reflectances; of the pane 0: it is covered; level: of the display. */
static World room(const float wall[PARTS], float level) {
    static const char *const names[] = {"floor", "side", "back", "lamp", "screen", "pane"};
    World world = world_start();
    Scene *scene = world.scene;
    Material pane = builder_material(1), display = builder_material(0);
    builder_part(scene, builder_material(wall[FLOOR]));
    builder_quad(scene, vec3(0, -0.3f, 0.5f), vec3(0.6f, 0, 0), vec3(0, 0, -0.6f));
    builder_part(scene, builder_material(wall[SIDE]));
    builder_quad(scene, vec3(-0.6f, 0, 0.5f), vec3(0, 0, -0.6f), vec3(0, 0.3f, 0));
    builder_part(scene, builder_material(wall[BACK]));
    builder_quad(scene, vec3(0, 0, 1.1f), vec3(-0.6f, 0, 0), vec3(0, 0.3f, 0));
    builder_part(scene, builder_lamp(4000));
    builder_quad(scene, vec3(0.2f, 0.4f, 0.5f), vec3(0.1f, 0, 0), vec3(0, 0, 0.1f));
    display.display_id = 0;
    display.is_emitter = true;
    pane.transmission = 1;
    pane.roughness = 0;
    pane.specular = 1;
    pane.lets_light_through = true;
    int material_id = builder_part(scene, display);
    builder_quad(scene, vec3(0, 0, 0), vec3(0.2f, 0, 0), vec3(0, 0.1f, 0));
    builder_part(scene, wall[PANE] > 0 ? pane : builder_material(0));
    builder_quad(scene, vec3(0.6f, 0, 0.5f), vec3(0, 0, 0.6f), vec3(0, 0.3f, 0));
    for (int i = 0; i < PARTS; i++) scene->parts[i].name = names[i];
    assert_done(panel_open(PROJECT_DIR "/assets/panels/ips_cluster.panel", &world.arena,
                           &world.panel, &err));
    scene->displays[scene->display_count++] = (Display){.name = "display",
                                                        .panel = world.panel,
                                                        .material_id = material_id,
                                                        .level = level,
                                                        .content = builder_no_texture()};
    builder_sky(scene, 1000);
    return world;
}

static const float grey[PARTS] = {[FLOOR] = 0.5f, [SIDE] = 0.5f, [BACK] = 0.5f, [PANE] = 1};

static ProbeTools tools_of(int threads) {
    ProbeTools tools = {.threads = threads};
    assert_done(kernel_choose(NULL, &tools.kernel, &err));
    return tools;
}

static ProbeAim aim_of(const World *world, uint32_t seed) {
    return (ProbeAim){.context = &world->context,
                      .eye = eye,
                      .targets = targets,
                      .target_count = 4,
                      .seed = seed};
}

static Chains find(World *world, uint32_t seed, long paths, int threads) {
    ProbeTools tools = tools_of(threads);
    ProbeAim aim = aim_of(world, seed);
    ChainArgs args = {.aim = &aim, .tools = &tools, .paths = paths, .most = MOST};
    return chains_find(&args, &world->arena);
}

/* ---- they add up ------------------------------------------------------------------------- */

TEST(chains_add_up_to_what_is_seen) {
    SCOPED_WORLD world = room(grey, 1);
    enum { PATHS = 4096, BATCH = PATHS / CHAIN_BATCHES };
    static ProbeLook looks[PATHS];
    PathStatistics statistics = {0};
    double reflected = 0, mirror = 0, kept = 0;
    world_ready(&world, 16);
    Chains chains = find(&world, 5, PATHS, 2);
    ProbeAim aim = aim_of(&world, 5);
    aim.is_spread = true;
    for (int i = 0; i < CHAIN_BATCHES; i++) {
        aim.seed = hash_combine(hash_u32(5), (uint32_t)i);
        tools_of(1).kernel->look(&aim, 0, BATCH, looks + i * BATCH, &statistics);
    }
    for (int i = 0; i < PATHS; i++) {
        reflected += (double)looks[i].reflected[1] / PATHS;
        mirror += (double)looks[i].mirror[1] / PATHS;
    }
    for (int i = 0; i < chains.count; i++) kept += chains.list[i].figure.cd_m2;
    assert_int_equal(chains.count, MOST);
    assert_true(chains.others > 0);
    assert_close(chains.all.cd_m2 / reflected, 1, 1e-4);
    assert_close(chains.mirror.cd_m2 / mirror, 1, 1e-4);
    assert_close((kept + chains.rest.cd_m2) / chains.all.cd_m2, 1, 1e-9);
    for (int i = 1; i < chains.count; i++)
        assert_true(chains.list[i].figure.cd_m2 <= chains.list[i - 1].figure.cd_m2);
}

TEST(threads_change_nothing) {
    SCOPED_WORLD world = room(grey, 1);
    world_ready(&world, 16);
    Chains a = find(&world, 5, 2048, 1), b = find(&world, 5, 2048, 3);
    assert_int_equal(a.count, b.count);
    assert_memory_equal(&a.rest, &b.rest, sizeof a.rest);
    for (int i = 0; i < a.count; i++) assert_memory_equal(&a.list[i], &b.list[i], sizeof a.list[i]);
}

/* ---- what they are called ---------------------------------------------------------------- */

static bool has_chain(const Chains *chains, const char *wanted, Arena *arena) {
    for (int i = 0; i < chains->count; i++) {
        int links;
        const char *text = "";
        const char *const *words = chain_words(chains->scene, &chains->list[i].key, &links, arena);
        for (int k = 0; k < links; k++)
            text = arena_format(arena, "%s%s%s", text, k ? " > " : "", words[k]);
        if (!strcmp(text, wanted)) return true;
    }
    return false;
}

TEST(chains_name_what_light_meets) {
    SCOPED_WORLD world = room(grey, 1);
    world_ready(&world, 16);
    Chains chains = find(&world, 5, 4096, 2);
    static const char *const wanted[] = {
        "display display: scatters > back (test): scatters > lamp (test): emits",
        "display display: scatters > sky",
        "display display: reflects > back (test): scatters > sky",
        "display display: scatters > pane (test): through > sky",
        "display display: scatters > back (test): scatters > sky"};
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++)
        if (!has_chain(&chains, wanted[i], &world.arena)) fail_msg("no %s", wanted[i]);
}

TEST(rays_lead_from_the_eye_over_what_is_named) {
    SCOPED_WORLD world = room(grey, 1);
    world_ready(&world, 16);
    Chains chains = find(&world, 5, 4096, 2);
    for (int i = 0; i < chains.count; i++) {
        const Chain *chain = &chains.list[i];
        assert_true(chain->ray_count > 0);
        for (int k = 0; k < chain->ray_count; k++) {
            const ChainRay *ray = &chain->rays[k];
            assert_true(ray->count >= chain->key.count + 1);
            assert_close(vec3_length(vec3_sub(ray->point[0], eye)), 0, 1e-6);
            assert_close(ray->point[1].z, 0, 1e-6); /* the display */
            if (chain->key.count < 2) continue;
            Vec3 wall = ray->point[2];
            bool on_one = fabsf(wall.y + 0.3f) < 1e-5f || fabsf(wall.x + 0.6f) < 1e-5f ||
                          fabsf(wall.z - 1.1f) < 1e-5f || fabsf(wall.z) < 1e-5f ||
                          fabsf(wall.x - 0.6f) < 1e-5f || fabsf(wall.y - 0.4f) < 1e-5f;
            if (!on_one) fail_msg("%g, %g, %g", (double)wall.x, (double)wall.y, (double)wall.z);
        }
    }
}

/* ---- their intervals --------------------------------------------------------------------- */

/* The chain's figure among others; none of it was found: 0. */
static ChainFigure same_chain(const Chains *chains, const ChainKey *key) {
    for (int i = 0; i < chains->count; i++)
        if (!memcmp(&chains->list[i].key, key, sizeof *key)) return chains->list[i].figure;
    return (ChainFigure){.cd_m2 = 0};
}

TEST(intervals_cover) {
    enum { RUNS = 120, CHAINS = 3 };
    SCOPED_WORLD world = room(grey, 1);
    int covered[CHAINS + 1] = {0};
    world_ready(&world, 16);
    Chains truth = find(&world, 1, 1 << 18, 2);
    for (uint32_t run = 0; run < RUNS; run++) {
        Arena before = world.arena;
        Chains some = find(&world, 100 + run, 4096, 2);
        for (int i = 0; i <= CHAINS; i++) {
            ChainFigure found = i == CHAINS ? some.all : same_chain(&some, &truth.list[i].key);
            ChainFigure wanted = i == CHAINS ? truth.all : truth.list[i].figure;
            covered[i] += found.low <= wanted.cd_m2 && wanted.cd_m2 <= found.high;
        }
        world.arena = before;
    }
    for (int i = 0; i <= CHAINS; i++) {
        print_message("covered %d of %d\n", covered[i], RUNS);
        if (covered[i] < 0.90 * RUNS) fail_msg("%d: covered %d of %d", i, covered[i], RUNS);
    }
}

/* ---- what they foretell ------------------------------------------------------------------ */

/* Within 2 %, or 3 standard errors. */
static void assert_foretold(const char *what, double foretold, double sigma,
                            const ChainFigure *found) {
    double apart = fabs(foretold - found->cd_m2), of = hypot(sigma, found->sigma);
    print_message("%s: foretold %.5g, found %.5g +- %.2g\n", what, foretold, found->cd_m2, of);
    if (apart > 0.02 * found->cd_m2 && apart > 3 * of)
        fail_msg("%s: foretold %g, found %g +- %g", what, foretold, found->cd_m2, of);
}

static Chains find_in(World *world, uint32_t seed) {
    world_ready(world, 16);
    return find(world, seed, 1 << 15, 2);
}

TEST(own_light_grows_with_brightness) {
    SCOPED_WORLD world = room(grey, 1), brighter = room(grey, 3);
    Chains one = find_in(&world, 2), three = find_in(&brighter, 3);
    assert_true(one.own > 0.01 * one.all.cd_m2);
    assert_foretold("three times as bright", one.all.cd_m2 + 2 * one.own, one.all.sigma,
                    &three.all);
}

/* Light that meets the display's mirror twice is hardly any. */
TEST(a_coating_takes_its_share_of_the_mirror) {
    SCOPED_WORLD world = room(grey, 0), coated = room(grey, 0);
    Chains plain = find_in(&world, 2);
    const PanelReflection *reflection = coated.panel->reflection;
    size_t count = (size_t)PANEL_ANGLES * reflection->padded_wavelengths;
    float *mirror = ARENA_NEW(&coated.arena, float, count);
    for (size_t i = 0; i < count; i++) mirror[i] = 0.25f * reflection->mirror[i];
    PanelReflection changed = *reflection;
    changed.mirror = mirror;
    ((Panel *)coated.panel)->reflection = &changed;
    Chains left = find_in(&coated, 3);
    ((Panel *)coated.panel)->reflection = reflection;
    assert_true(plain.mirror.cd_m2 > 0.05 * plain.all.cd_m2);
    assert_foretold("a coating", plain.all.cd_m2 - 0.75 * plain.mirror.cd_m2, plain.all.sigma,
                    &left.all);
}

TEST_PROGRAM(NULL, NULL)
