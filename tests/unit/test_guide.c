/* SPDX-License-Identifier: Apache-2.0 */
/* A guide's samples follow its density, however it was trained the light stays what it is, and
 * its file is taken back as it was or not at all. */
#include "fixture.h"

#include "base/units.h"
#include "guide/guide_file.h"
#include "guide/guide_training.h"
#include "path/collect/training.h"
#include "path/path.h"
#include "world_fixture.h"

enum { CELLS = 3, BOUNCES = 64 };

/* A guide that was trained on nonsense: three cells, most bins dark, lights sampled at odds. */
static LightGuide *odd_guide(Arena *arena) {
    LightGuide *guide = ARENA_NEW(arena, LightGuide, 1);
    *guide = (LightGuide){.node_count = 2 * CELLS - 1,
                          .cell_count = CELLS,
                          .asks = true,
                          .nodes = ARENA_NEW(arena, GuideNode, 2 * CELLS - 1),
                          .cells = ARENA_NEW(arena, GuideCell, CELLS)};
    guide->nodes[0] = (GuideNode){0.1f, 0, 1, 0};
    guide->nodes[1] = (GuideNode){.cell = 0};
    guide->nodes[2] = (GuideNode){-0.2f, 2, 3, 0};
    guide->nodes[3] = (GuideNode){.cell = 1};
    guide->nodes[4] = (GuideNode){.cell = 2};
    for (uint32_t c = 0; c < CELLS; c++) {
        GuideCell *cell = &guide->cells[c];
        cell->is_lit = 1;
        for (int set = 0; set < GUIDE_LIGHTS; set++)
            cell->asked[set] = 0.2f + 0.2f * (float)((set + (int)c) % 5);
        for (uint32_t i = 0; i < GUIDE_AIMS * GUIDE_BINS; i++) {
            uint32_t bin = i % GUIDE_BINS;
            float value = unit_float(hash_combine(hash_u32(c), i));
            cell->light[i / GUIDE_BINS][bin / GUIDE_SIDE][bin % GUIDE_SIDE] =
                value > 0.6f ? (uint16_t)(100000 * (value - 0.6f)) : 0;
        }
    }
    guide->cells[1].lamps = (GuideLamps){2, {8, 3}, {0.5f, 1}, 0.1f};
    guide_place_bins(guide);
    return guide;
}

static Vec3 direction_to(double degrees, double turn) {
    double a = radians_from_degrees(degrees), b = radians_from_degrees(turn);
    return vec3((float)(sin(a) * cos(b)), (float)cos(a), (float)(sin(a) * sin(b)));
}

static const GuideSurface surfaces[] = {
    {{0, 1, 0}, {0, 1, 0}, 0.7f, 0, 0, 0},
    {{0, 1, 0}, {0.6f, 0.8f, 0}, 0.1f, 0.04f, 1, 0.2f},
    {{0, 1, 0}, {0.98f, 0.199f, 0}, 0, 0.9f, 1, 0.5f},
    {{0.48f, -0.6f, 0.64f}, {0.48f, -0.6f, 0.64f}, 0.3f, 0.04f, 1, 1},
};

enum { SURFACES = sizeof surfaces / sizeof *surfaces };

/* ---- density ----------------------------------------------------------------------------- */

ARENA_TEST(densities_integrate_to_one) {
    LightGuide *guide = odd_guide(&arena);
    for (int s = 0; s < SURFACES; s++) {
        GuideView view;
        double sum = 0;
        guide_view(guide, (uint32_t)s % CELLS, &surfaces[s], &view);
        const GuideChoice *choice = &view.towards[s % GUIDE_AIMS];
        for (int i = 0; i < 500; i++)
            for (int k = 0; k < 1000; k++) {
                float z = 1 - 2 * ((float)i + 0.5f) / 500, r = sqrtf(1 - z * z), sine, cosine;
                sincos_turns(((float)k + 0.5f) / 1000, &sine, &cosine);
                sum += (double)guide_pdf(choice, vec3(r * cosine, r * sine, z)) * 4 * PI / 5e5;
            }
        if (!(fabs(sum - 1) < 2e-3)) fail_msg("surface %d: %g", s, sum);
    }
}

/* Which of 12 x 24 cells of equal solid angle, for a count that knows nothing of the map. */
enum { ROWS = 12, COLUMNS = 24 };

static int cell_of(Vec3 d) {
    float turn = atan2_f(d.y, d.x) * (0.5f * INV_PI_F);
    int row = (int)((1 - d.z) * 0.5f * ROWS),
        column = (int)((turn < 0 ? turn + 1 : turn) * COLUMNS);
    return (row < ROWS ? row : ROWS - 1) * COLUMNS + (column < COLUMNS ? column : 0);
}

ARENA_TEST(samples_follow_the_density) {
    enum { SAMPLES = 400000, FINE = 40 };
    LightGuide *guide = odd_guide(&arena);
    for (int s = 0; s < SURFACES; s++) {
        static double expected[ROWS * COLUMNS], found[ROWS * COLUMNS];
        GuideView view;
        double chi2 = 0, degrees = 0;
        memset(expected, 0, sizeof expected);
        memset(found, 0, sizeof found);
        guide_view(guide, (uint32_t)s % CELLS, &surfaces[s], &view);
        const GuideChoice *choice = &view.towards[s % GUIDE_AIMS];
        for (int i = 0; i < ROWS * FINE; i++)
            for (int k = 0; k < COLUMNS * FINE; k++) {
                float z = 1 - 2 * ((float)i + 0.5f) / (ROWS * FINE), r = sqrtf(1 - z * z);
                float sine, cosine;
                sincos_turns(((float)k + 0.5f) / (COLUMNS * FINE), &sine, &cosine);
                expected[i / FINE * COLUMNS + k / FINE] +=
                    (double)guide_pdf(choice, vec3(r * cosine, r * sine, z)) * 4 * PI * SAMPLES /
                    (ROWS * FINE) / (COLUMNS * FINE);
            }
        for (int i = 0; i < SAMPLES; i++) {
            float u0 = unit_float(hash_u32((uint32_t)(2 * i))),
                  u1 = unit_float(hash_u32((uint32_t)(2 * i + 1)));
            found[cell_of(guide_sample(choice, u0, u1))]++;
        }
        for (int i = 0; i < ROWS * COLUMNS; i++) {
            if (expected[i] < 20) continue;
            /* the quadrature knows a cell's share to a few per mille only */
            double spread = expected[i] + 1e-5 * expected[i] * expected[i];
            chi2 += (found[i] - expected[i]) * (found[i] - expected[i]) / spread;
            degrees++;
        }
        double v = 2 / (9 * degrees), deviate = (cbrt(chi2 / degrees) - (1 - v)) / sqrt(v);
        if (!(deviate < 4)) fail_msg("surface %d: chi2 %g of %g degrees", s, chi2, degrees);
    }
}

ARENA_TEST(a_direction_of_a_bin_lies_there_and_a_view_of_darkness_is_empty) {
    LightGuide *guide = odd_guide(&arena);
    GuideView view;
    for (int bin = 0; bin < GUIDE_BINS; bin++) {
        GuideCell *cell = &guide->cells[0];
        GuideAim aim = bin % 3 ? GUIDE_LIGHT : GUIDE_SKY;
        for (int i = 0; i < GUIDE_AIMS * GUIDE_SIDE; i++)
            cell->light[i / GUIDE_SIDE][i % GUIDE_SIDE] = (GuideRow){0};
        cell->light[aim][bin / GUIDE_SIDE][bin % GUIDE_SIDE] = 1;
        Vec3 d = guide_bin_direction(bin, 0.3f, 0.7f);
        guide_view(guide, 0, &(GuideSurface){d, d, 1, 0, 0, 0}, &view);
        assert_true(guide_pdf(&view.towards[aim], d) > 1);
        assert_true(vec3_dot(guide_sample(&view.towards[aim], 0.3f, 0.7f), d) > 0.99999f);
        assert_true(view.towards[1 - aim].sum == 0);
    }
    guide->cells[0].is_lit = 0;
    guide_view(guide, 0, &surfaces[0], &view);
    for (int aim = 0; aim < GUIDE_AIMS; aim++) assert_true(view.towards[aim].sum == 0);
}

/* ---- light ------------------------------------------------------------------------------- */

static WorldMean luminance(const World *world, Vec3 from, Vec3 direction, int count) {
    return world_luminance(world, &(WorldLook){from, direction, 0.2f, 1, count});
}

/* A sphere whose wall reflects half and emits as much as it takes: 1 wherever one looks. */
static World guided_furnace(void) {
    World world = world_start();
    Material wall = builder_lamp(0.5f);
    for (int i = 0; i < 3; i++) wall.base_color[i] = 0.5f;
    builder_part(world.scene, wall);
    builder_sphere(world.scene, vec3(0, 0, 0), 1, 24, 1);
    world_ready(&world, BOUNCES);
    world.context.guide = odd_guide(&world.arena);
    return world;
}

TEST(a_furnace_shows_one_wherever_a_guide_leads) {
    SCOPED_WORLD world = guided_furnace();
    for (PathStrategy s = PATH_MIS; s <= PATH_BSDF_ONLY; s++) {
        world.context.strategy = s;
        WorldMean e = luminance(&world, vec3(0.2f, 0.1f, 0), vec3(0, 0.3f, -1), 40000);
        if (!(fabs(e.mean - 1) <= 3.5 * e.sigma + 1e-4 && e.sigma < 0.02))
            fail_msg("strategy %d: %g +- %g", s, e.mean, e.sigma);
    }
}

/* Mean luminance that rays from the middle of the world find, as a training pass or to their
 * end. */
static double training_mean(const World *world, bool is_training) {
    enum { RAYS = 20000 };
    PathStatistics statistics = {0};
    LitPoint point = {vec3(0, 0, 0), vec3(0, 0, 1), false};
    double sum = 0;
    for (uint32_t i = 0; i < RAYS; i++) {
        Sampler sampler = sampler_start(5, 0, 0, i);
        Wavelengths w;
        PathResult found;
        float sky;
        TrainingSky sky_seen = training_sky(&sky);
        wavelengths_sample(sampler_1d(&sampler), &w);
        PathStart start = {.context = &world->context,
                           .wavelengths = &w,
                           .sampler = &sampler,
                           .statistics = &statistics,
                           .from = &point,
                           .collector = is_training ? &sky_seen.base : NULL};
        path_from_ray(&start, (Ray){point.position, point.ns, 0, INFINITY}, &found);
        sum += (double)found.xyz[1] / RAYS;
    }
    return sum;
}

/* In a furnace the first dull wall shows what it emits and half of what the second emits; of
 * what comes to that one a training ray finds nothing. */
TEST(a_training_ray_ends_at_the_second_dull_surface) {
    SCOPED_WORLD world = guided_furnace();
    world.context.strategy = PATH_BSDF_ONLY;
    assert_near(training_mean(&world, true), 0.75, 0.005);
    assert_near(training_mean(&world, false), 1, 0.01);
}

/* A glossy floor under a lamp, a sky and a sun, lacquered or not. */
static World floor_world(float roughness, float clearcoat) {
    World world = world_start();
    Material floor = builder_material(0.4f);
    floor.roughness = roughness;
    floor.specular = 1;
    floor.clearcoat = clearcoat;
    builder_part(world.scene, floor);
    builder_quad(world.scene, vec3(0, 0, 0), vec3(5, 0, 0), vec3(0, 0, -5));
    builder_part(world.scene, builder_lamp(500));
    builder_quad(world.scene, vec3(0, 1.5f, -1), vec3(1, 0, 0), vec3(0, 0, 1));
    Environment *outside = &world.scene->environment;
    builder_sky(world.scene, 40);
    outside->has_sun = true;
    outside->sun_elevation = 0.6f;
    outside->sun_illuminance_lx = 300;
    world_ready(&world, BOUNCES);
    return world;
}

TEST(every_strategy_finds_the_same_light_with_a_guide_and_without) {
    static const float looks[][2] = {{0.45f, 0}, {0.7f, 1}, {1, 0}};
    for (int i = 0; i < 3; i++) {
        SCOPED_WORLD world = floor_world(looks[i][0], looks[i][1]);
        WorldMean plain = luminance(&world, vec3(0, 1, 2), vec3(0, -0.5f, -1), 60000);
        world.context.guide = odd_guide(&world.arena);
        for (PathStrategy s = PATH_MIS; s <= PATH_LIGHTS_ONLY; s++) {
            world.context.strategy = s;
            WorldMean e = luminance(&world, vec3(0, 1, 2), vec3(0, -0.5f, -1), 120000);
            if (!(fabs(e.mean - plain.mean) <= 3.5 * hypot(e.sigma, plain.sigma) &&
                  e.sigma < 0.02 * e.mean))
                fail_msg("look %d, strategy %d: %g +- %g, without a guide %g +- %g", i, s, e.mean,
                         e.sigma, plain.mean, plain.sigma);
        }
    }
}

/* ---- training ---------------------------------------------------------------------------- */

enum { PLACES = 5000, MOST = 64 };

static GuidePlace *spread_places(uint32_t count, Arena *arena) {
    GuidePlace *places = ARENA_NEW(arena, GuidePlace, count);
    for (uint32_t i = 0; i < count; i++) {
        Sampler sampler = sampler_start(5, 0, 0, i);
        Vec2 a = sampler_2d(&sampler), b = sampler_2d(&sampler);
        places[i].position = vec3(10 * a.x * a.x, a.y, i % 10 ? b.x : 3);
        places[i].normal = vec3(0, 1, 0);
    }
    return places;
}

static GuideTraining *taught(Arena *arena) {
    return guide_training_start(spread_places(PLACES, arena), PLACES, MOST, arena);
}

ARENA_TEST(cells_part_the_places_among_them) {
    GuideTraining *training = taught(&arena);
    const LightGuide *guide = &training->guide;
    assert_true(guide->cell_count >= PLACES / MOST && guide->cell_count < 4 * PLACES / MOST);
    assert_int_equal(guide->node_count, 2 * guide->cell_count - 1);
    for (uint32_t c = 0; c < guide->cell_count; c++) {
        assert_true(training->first_place[c + 1] - training->first_place[c] <= MOST);
        for (uint32_t i = training->first_place[c]; i < training->first_place[c + 1]; i++)
            assert_int_equal(guide_cell_at(guide, training->places[i].position), c);
    }
    assert_int_equal(training->first_place[guide->cell_count], PLACES);
}

/* However small the cells that are requested. None has far more than its share, but where all
 * places coincide. */
ARENA_TEST(cells_are_no_more_than_a_guide_holds) {
    enum { MANY = 10 * GUIDE_CELLS_MAX };
    for (int k = 0; k < 3; k++) {
        Arena room = arena;
        GuidePlace *places = spread_places(MANY, &room);
        for (uint32_t i = 1; k == 2 && i < MANY; i++) places[i] = places[0];
        GuideTraining *training = guide_training_start(places, MANY, k ? 1 : 19, &room);
        uint32_t cells = training->guide.cell_count;
        assert_true(cells <= GUIDE_CELLS_MAX && training->guide.node_count == 2 * cells - 1);
        for (uint32_t c = 0; k < 2 && c < cells; c++)
            assert_true(training->first_place[c + 1] - training->first_place[c] <= 22);
        assert_int_equal(training->first_place[cells], MANY);
    }
}

ARENA_TEST(a_cell_leads_to_where_its_training_found_light) {
    GuideTraining *training = taught(&arena);
    Vec3 bright = direction_to(40, 70);
    GuideView view;
    guide_training_choose(training, 0);
    assert_int_equal(training->cells[2].point_count, GUIDE_POINTS);
    for (int bin = 0; bin < GUIDE_BINS; bin++) {
        bool is_there = vec3_dot(guide_bin_direction(bin, 0.5f, 0.5f), bright) > 0.95f;
        const float cd_m2[GUIDE_AIMS] = {is_there ? 50 : 0.1f, is_there ? 0 : 8};
        guide_training_add(&training->cells[2], bin, cd_m2);
    }
    for (uint32_t cell = 0; cell < training->guide.cell_count; cell++)
        guide_training_update(training, cell);
    guide_view(&training->guide, 2, &surfaces[0], &view);
    assert_true(guide_pdf(&view.towards[GUIDE_LIGHT], bright) > 2);
    assert_true(guide_pdf(&view.towards[GUIDE_LIGHT], direction_to(40, 250)) < 0.1f);
    assert_true(guide_pdf(&view.towards[GUIDE_SKY], bright) < 0.1f);
    assert_true(guide_pdf(&view.towards[GUIDE_SKY], direction_to(40, 250)) > 0.15f);
    assert_true(training->guide.cells[2].is_lit > 0 && training->guide.cells[6].is_lit > 0);
    assert_true(!(training->guide.cells[7].is_lit > 0));
}

ARENA_TEST(even_light_from_everywhere_gives_pi_times_its_luminance) {
    GuideTraining *training = taught(&arena);
    const float cd_m2[GUIDE_AIMS] = {3, 8};
    for (int bin = 0; bin < GUIDE_BINS; bin++) guide_training_add(&training->cells[2], bin, cd_m2);
    assert_near(guide_training_illuminance(training, 2), 3 * PI, 0.02 * 3 * PI);
    assert_near(guide_training_illuminance(training, 3), 0, 0);
}

/* ---- the file ---------------------------------------------------------------------------- */

static const GuideScene has_none = {.light_count = 9, .lamp_count = 9};

static void refused(const char *path, const GuideScene *scene, const char *words, Arena scratch) {
    const LightGuide *guide;
    Error err = {0};
    assert_false(guide_read(path, scene, &scratch, &guide, &err));
    char line[1024];
    error_line(&err, line, (int)sizeof line);
    if (!strstr(line, words) || !strstr(line, path))
        fail_msg("'%s' says nothing of '%s' or '%s'", line, words, path);
}

ARENA_TEST(a_field_comes_back_from_its_file_or_not_at_all) {
    LightGuide *guide = odd_guide(&arena);
    const LightGuide *back;
    FileBytes file;
    char path[] = "test_guide.field";
    assert_done(guide_write(path, guide, arena, &err));
    assert_done(guide_read(path, &has_none, &arena, &back, &err));
    assert_true(guide_hash(back) == guide_hash(guide) && back->asks);
    assert_done(file_read(path, 1 << 20, &arena, &file, &err));
    for (size_t size = 0; size < file.size; size++) {
        write_bytes(path, file.data, size);
        refused(path, &has_none, size < 8 ? "is not a field" : "is cut off: has ", arena);
    }
    unsigned char *bytes = ARENA_NEW(&arena, unsigned char, file.size);
    for (size_t at = 0; at < file.size; at++) {
        memcpy(bytes, file.data, file.size);
        bytes[at] ^= 0x41;
        write_bytes(path, bytes, file.size);
        refused(path, &has_none, ": is ", arena);
    }
    unlink(path);
}

ARENA_TEST(a_field_that_never_asks_a_light_is_of_another_scene) {
    static const GuideScene scene = {{true, true, false, false}, 9, 9};
    LightGuide *guide = odd_guide(&arena);
    char path[] = "test_guide.field";
    guide->cells[1].asked[1] = 0;
    assert_done(guide_write(path, guide, arena, &err));
    refused(path, &scene, "a kind of light that this scene has", arena);
    unlink(path);
}

ARENA_TEST(a_field_with_impossible_lamps_is_refused) {
    static const GuideLamps wrong[] = {{9, {0}, {1}, 0.1f},    {-1, {0}, {1}, 0.1f},
                                       {1, {-2}, {1}, 0.1f},   {1, {2}, {0}, 0.1f},
                                       {1, {2}, {1.5f}, 0.1f}, {2, {2, 2}, {1, 1}, 0.1f},
                                       {1, {2}, {1}, -0.1f},   {1, {2}, {1}, 1},
                                       {1, {2}, {NAN}, 0.1f},  {1, {2}, {1}, NAN}};
    static const GuideScene fewer = {.light_count = 8, .lamp_count = 8};
    LightGuide *guide = odd_guide(&arena);
    char path[] = "test_guide.field";
    assert_done(guide_write(path, guide, arena, &err));
    refused(path, &fewer, "cell 1 knows lamp 8, the scene has 8", arena);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        guide->cells[1].lamps = wrong[i];
        assert_done(guide_write(path, guide, arena, &err));
        refused(path, &has_none, "cell 1 knows impossible lamps", arena);
    }
    guide->cells[1].lamps = (GuideLamps){2, {2, 5}, {1, 1}, 0};
    assert_done(guide_write(path, guide, arena, &err));
    refused(path, &has_none, "cell 1 looks for 2 lamps alone, the scene has 9", arena);
    unlink(path);
}

/* Of a file whose hash is right. */
ARENA_TEST(children_that_are_nowhere_are_refused) {
    const uint32_t wrong[] = {UINT32_MAX, UINT32_MAX - 1, 2 * CELLS - 1, 2 * CELLS - 2, 2, 1};
    LightGuide *guide = odd_guide(&arena);
    char path[] = "test_guide.field";
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        guide->nodes[2].child = wrong[i];
        assert_done(guide_write(path, guide, arena, &err));
        refused(path, &has_none, "node 2 of 5 does not part its box", arena);
    }
    unlink(path);
}

TEST_PROGRAM(make_arena, drop_arena)
