/* SPDX-License-Identifier: Apache-2.0 */
/* Probes and their responses: light adds up, however it is sampled. */

#include "base/units.h"
#include "panel/query/panel_reflection.h"
#include "review/light/distant_probe.h"
#include "review/light/sky_table.h"
#include "review/light/response_suns.h"
#include "reading_fixture.h"

/* A display that looks along +z, 0.4 m wide, 0.2 m high. */
static void add_display(World *world) {
    world_display(world)->level = 0;
    builder_quad(world->scene, vec3(0, 0, 0), vec3(0.2f, 0, 0), vec3(0, 0.1f, 0));
}

/* It stands in a white niche, open to the sky above and on the right. */
static World niche(void) {
    World world = world_start();
    Scene *scene = world.scene;
    Material wall = builder_material(0.5f);
    builder_part(scene, wall);
    builder_quad(scene, vec3(0, -0.3f, 0.5f), vec3(0.6f, 0, 0), vec3(0, 0, -0.6f));
    builder_quad(scene, vec3(-0.6f, 0, 0.5f), vec3(0, 0, -0.6f), vec3(0, 0.3f, 0));
    builder_quad(scene, vec3(0, 0, 1.1f), vec3(-0.6f, 0, 0), vec3(0, 0.3f, 0));
    add_display(&world);
    return world;
}

static const Vec3 eye = {0.1f, 0.1f, 0.7f};
static const Vec3 targets[4] = {
    {-0.1f, -0.05f, 0}, {0.1f, 0.05f, 0}, {-0.1f, 0.05f, 0}, {0.1f, -0.05f, 0}};

static ProbeAim aim_of(const World *world) {
    return (ProbeAim){
        .context = &world->context, .eye = eye, .targets = targets, .target_count = 4, .seed = 7};
}

static Reading read_all(const ProbeAim *aim, Arena scratch) {
    ReadingGoal goal = {.precision = 0.01, .most = 1 << 16};
    ProbeTools tools = reading_tools(2);
    return reading_take(aim, &goal, &tools, scratch);
}

static Response respond(const ProbeAim *aim, int paths, int threads, Arena *arena) {
    ResponseOptions options = {reading_tools(threads), RESPONSE_LEVEL, paths, 0};
    Response response;
    response_trace(aim, &options, arena, &response);
    return response;
}

/* D65, as a constant sky is: what bands give of 1 cd m^-2. */
static void d65_bands(float bands[LIGHT_BANDS]) {
    for (int b = 0; b < LIGHT_BANDS; b++) bands[b] = 0;
    for (int k = 0; k < 16; k++) {
        Wavelengths w;
        wavelengths_sample(((float)k + 0.5f) / 16, &w);
        for (int b = 0; b < LIGHT_BANDS; b++) bands[b] += w.d65[b] * w.xyz[1][b] / 16;
    }
}

static double uniform_reading(const Response *response, const float bands[LIGHT_BANDS]) {
    double sum = 0;
    for (int i = 0; i < response->cells.count * LIGHT_BANDS; i++)
        sum += (double)(response->first[i] + response->rest[i]) * (double)bands[i % LIGHT_BANDS];
    return sum;
}

TEST(bands_add_up_to_the_luminance) {
    float bands[LIGHT_BANDS];
    double sum = 0;
    d65_bands(bands);
    for (int b = 0; b < LIGHT_BANDS; b++) sum += (double)bands[b];
    assert_near(sum, 1, 2e-3);
}

TEST(a_luxmeter_in_the_open_responds_with_pi) {
    ENDS_BY(world_end) World world = world_start();
    builder_part(world.scene, builder_material(0));
    builder_quad(world.scene, vec3(0, -100, 0), vec3(1, 0, 0), vec3(0, 0, -1));
    world_ready(&world, 8);
    LitPoint head = {{0, 0, 0}, {0, 1, 0}, false};
    ProbeAim aim = {.context = &world.context, .meter = &head, .seed = 3};
    float bands[LIGHT_BANDS];
    Response response = respond(&aim, 128, 2, &world.arena);
    d65_bands(bands);
    assert_near(uniform_reading(&response, bands), PI, 0.01);
    Vec3 sun = vec3_normalize(vec3(1, 1, 0));
    ProbeSuns suns = {&sun, 1, 0.00465f, false};
    ResponseOptions options = {reading_tools(1), 4, 16, 0};
    const float *shares = response_suns(&aim, &options, &suns, &world.arena);
    for (int b = 0; b < LIGHT_BANDS; b++) assert_near(shares[b], sqrt(0.5), 2e-3);
}

/* The niche, with what ways follow: a wall that mirrors, one of satin metal, and a pane. */
static World mirrored_niche(void) {
    World world = niche();
    Scene *scene = world.scene;
    Material metal = builder_mirror(0.8f), pane = builder_pane(1.5f);
    builder_part(scene, metal);
    builder_quad(scene, vec3(0, 0, -0.1f), vec3(0.6f, 0, 0), vec3(0, 0.3f, 0));
    metal.roughness = 0.35f;
    builder_part(scene, metal);
    builder_quad(scene, vec3(0, 0, 1), vec3(-0.6f, 0, 0), vec3(0, 0.3f, 0));
    pane.specular = 1;
    builder_part(scene, pane);
    builder_quad(scene, vec3(0.6f, 0, 0.5f), vec3(0, 0.3f, 0), vec3(0, 0, 0.6f));
    return world;
}

static void check_under_a_uniform_sky(World world) {
    builder_sky(world.scene, 1000);
    world_ready(&world, 64);
    ProbeAim aim = aim_of(&world);
    float bands[LIGHT_BANDS];
    Reading reading = read_all(&aim, world.arena);
    Response response = respond(&aim, 16384, 2, &world.arena);
    d65_bands(bands);
    double found = 1000 * uniform_reading(&response, bands);
    double sigma = hypot(reading.sigma, found * response.relative_error);
    if (!(fabs(found - reading.reflected) < 3.5 * sigma + 2e-3 * found))
        fail_msg("%g, paths %g +- %g", found, reading.reflected, sigma);
    assert_true(reading.mirror > 0 && reading.mirror < reading.reflected);
    world_end(&world);
}

TEST(a_response_to_a_uniform_sky_is_what_paths_find_under_it) {
    check_under_a_uniform_sky(niche());
    check_under_a_uniform_sky(mirrored_niche());
}

/* Suns from all sides, one of them in the mirror direction of a target. */
static int suns_about(Vec3 *suns) {
    int count = 0;
    for (int e = 15; e < 90; e += 25)
        for (int a = 0; a < 360; a += 40) {
            double elevation = radians_from_degrees(e), azimuth = radians_from_degrees(a);
            suns[count++] = vec3((float)(cos(elevation) * cos(azimuth)), (float)sin(elevation),
                                 (float)(cos(elevation) * sin(azimuth)));
        }
    return count;
}

static void light_again(World *world) {
    Lights *lights;
    assert_done(lights_build(world->scene, &world->arena, &lights, &err));
    world->context = path_context_build(world->scene, world->bvh, lights, 64, &world->arena);
}

/* Nothing else shines. */
static void set_sun(World *world, Vec3 towards) {
    builder_sun(world->scene, (double)atan2f(towards.x, -towards.z), (double)asinf(towards.y),
                10000);
    light_again(world);
}

TEST(a_response_to_a_sun_is_what_paths_find_under_it) {
    ENDS_BY(world_end) World world = niche();
    Vec3 suns[64];
    int count = suns_about(suns);
    world_ready(&world, 64);
    ProbeAim aim = aim_of(&world);
    Response response = respond(&aim, 32768, 2, &world.arena);
    ProbeSuns asked = {suns, count, world.scene->environment.sun_angular_radius, false};
    ResponseOptions options = {reading_tools(2), 4, 64, 0};
    const float *scattered = response_suns(&aim, &options, &asked, &world.arena);
    double squares = 0;
    int judged = 0;
    for (int i = 0; i < count; i++) {
        Vec3 towards;
        float bands[LIGHT_BANDS];
        Setup setup = {.scene = world.scene};
        set_sun(&world, suns[i]);
        setup.context = world.context;
        assert_true(setup_sun(&setup, &towards, bands));
        assert_true(vec3_dot(towards, suns[i]) > 0.99999f);
        Reading reading = read_all(&aim, world.arena);
        double first = 0;
        for (int b = 0; b < LIGHT_BANDS; b++)
            first += (double)scattered[i * LIGHT_BANDS + b] * (double)bands[b];
        double found = first + response_sun(&response, suns[i], bands, NULL, NULL);
        if (!(reading.reflected > 1)) continue;
        double off = found / reading.reflected - 1;
        squares += off * off;
        judged++;
        if (!(fabs(off) < 0.15))
            fail_msg("sun %d: %g, paths %g +- %g", i, found, reading.reflected, reading.sigma);
    }
    /* means over a triangle's width move what enters by edges */
    double rms = sqrt(squares / judged);
    if (!(judged > 20 && rms < 0.04)) fail_msg("%d suns, rms %g", judged, rms);
}

/* ---- the sun in the display itself ------------------------------------------------------- */

#define TILES 16 /* of the display, a side */

/* The whole display, in tiles. */
static void tile_display(Vec3 middles[TILES * TILES], ProbePatch patches[TILES * TILES]) {
    Vec3 along = vec3(0.4f / TILES, 0, 0), down = vec3(0, -0.2f / TILES, 0);
    for (int i = 0; i < TILES * TILES; i++) {
        float x = ((float)(i % TILES) + 0.5f) / TILES, y = ((float)(i / TILES) + 0.5f) / TILES;
        middles[i] = vec3(0.4f * x - 0.2f, 0.2f * y - 0.1f, 0);
        patches[i] = (ProbePatch){along, down};
    }
}

/* Sum over bands of the mirror's reflectance. */
static double mirror_sum(const Panel *panel, float cosine) {
    double sum = 0;
    for (int k = 0; k < 64; k++) {
        Wavelengths w;
        wavelengths_sample(((float)k + 0.5f) / 64, &w);
        sum += (double)spectrum_sum(panel_mirror(panel, cosine, &w)) / 64;
    }
    return sum;
}

/* A disc of solid angle W at an angle whose cosine is c covers W d^2 / c of the display at the
 * distance d, where the eye sees 1 / W of a unit irradiance, less what the mirror takes:
 * anywhere, also between the tiles' middles, which lie further apart than the disc is wide. */
TEST(a_sun_in_a_display_is_as_bright_as_its_mirror_says) {
    enum { SUNS = 24 };
    ENDS_BY(world_end) World world = world_start();
    Vec3 middles[TILES * TILES], suns[SUNS], at[SUNS];
    ProbePatch patches[TILES * TILES];
    add_display(&world);
    world_ready(&world, 64);
    tile_display(middles, patches);
    for (int i = 0; i < SUNS; i++) {
        at[i] = vec3(0.03f * (float)(i % 6) - 0.07f, 0.04f * (float)(i / 6) - 0.06f, 0);
        Vec3 to = vec3_normalize(vec3_sub(at[i], eye));
        suns[i] = vec3(to.x, to.y, -to.z);
    }
    float radius = 0.0046504f;
    ProbeAim aim = {.context = &world.context,
                    .eye = eye,
                    .targets = middles,
                    .patches = patches,
                    .target_count = TILES * TILES,
                    .seed = 7};
    ProbeSuns asked = {suns, SUNS, radius, true};
    ResponseOptions options = {reading_tools(2), 4, response_mirror_paths(&aim, radius), 0};
    const float *shares = response_suns(&aim, &options, &asked, &world.arena);
    double squares = 0;
    for (int i = 0; i < SUNS; i++) {
        double sum = 0, distance = (double)vec3_length(vec3_sub(at[i], eye));
        double c = (double)eye.z / distance;
        for (int b = 0; b < LIGHT_BANDS; b++) sum += (double)shares[i * LIGHT_BANDS + b];
        double wanted = mirror_sum(world.panel, (float)c) * distance * distance / (c * 0.4 * 0.2);
        squares += (sum / wanted - 1) * (sum / wanted - 1);
        if (!(fabs(sum / wanted - 1) < 0.025)) fail_msg("sun %d: %g, required: %g", i, sum, wanted);
    }
    double rms = sqrt(squares / SUNS);
    if (!(rms < 0.01)) fail_msg("rms %g", rms);
}

/* Alone, where few paths ask whether there is any, as beside others: down to the slice that
 * stands 0.9 radii beyond the rim. */
TEST(a_slice_of_the_sun_at_a_rim_of_a_display_is_found) {
    enum { SUNS = 12 };
    ENDS_BY(world_end) World world = world_start();
    Vec3 middles[TILES * TILES], suns[SUNS];
    ProbePatch patches[TILES * TILES];
    add_display(&world);
    world_ready(&world, 64);
    tile_display(middles, patches);
    float radius = 0.0046504f;
    for (int i = 0; i < SUNS; i++) {
        float beyond = 0.9f * (2.0f * (float)i / (SUNS - 1) - 1) * radius;
        Vec3 to = vec3_sub(vec3(0.2f, 0.01f * (float)(i - SUNS / 2), 0), eye);
        to.x += beyond * vec3_length(to);
        to = vec3_normalize(to);
        suns[i] = vec3(to.x, to.y, -to.z);
    }
    ProbeAim aim = {.context = &world.context,
                    .eye = eye,
                    .targets = middles,
                    .patches = patches,
                    .target_count = TILES * TILES,
                    .seed = 7};
    ProbeSuns all = {suns, SUNS, radius, true}, one = all;
    ResponseOptions options = {reading_tools(2), 4, response_mirror_paths(&aim, radius), 0};
    const float *together = response_suns(&aim, &options, &all, &world.arena);
    one.count = 1;
    for (int i = 0; i < SUNS; i++) {
        one.towards = suns + i;
        const float *alone = response_suns(&aim, &options, &one, &world.arena);
        assert_true(alone[0] > 0);
        assert_memory_equal(alone, together + (size_t)i * LIGHT_BANDS, LIGHT_BANDS * sizeof(float));
    }
}

/* The sun in a tile of 20 x 10 mm: by luck, and as what is known of it beside all else. */
TEST(a_reading_knows_of_the_sun_in_a_display) {
    ENDS_BY(world_end) World world = world_start();
    Vec3 at = vec3(0.02f, 0.01f, 0), to = vec3_normalize(vec3_sub(at, eye)), towards;
    ProbePatch patch = {vec3(0.02f, 0, 0), vec3(0, -0.01f, 0)};
    float bands[LIGHT_BANDS];
    add_display(&world);
    world_ready(&world, 64);
    set_sun(&world, vec3(to.x, to.y, -to.z));
    Setup setup = {.scene = world.scene, .context = world.context};
    ProbeAim aim = {.context = &world.context,
                    .eye = eye,
                    .targets = &at,
                    .patches = &patch,
                    .target_count = 1,
                    .seed = 7};
    assert_true(setup_sun(&setup, &towards, bands));
    float radius = world.scene->environment.sun_angular_radius;
    ProbeSuns asked = {&towards, 1, radius, true};
    ResponseOptions options = {reading_tools(2), 4, response_mirror_paths(&aim, radius), 0};
    double known = light_bands_sum(response_suns(&aim, &options, &asked, &world.arena), bands);
    PathContext without = world.context;
    ProbeAim rest = aim;
    ReadingGoal all = {.most = 1 << 16}, less = {.most = 1 << 11, .known = known};
    ProbeTools tools = reading_tools(2);
    without.without_mirrored_sun = true;
    rest.context = &without;
    Reading by_luck = reading_take(&aim, &all, &tools, world.arena);
    Reading knowing = reading_take(&rest, &less, &tools, world.arena);
    double off = knowing.reflected - by_luck.reflected;
    assert_true(known > 0.5 * by_luck.reflected);
    if (!(fabs(off) < 3.5 * hypot(by_luck.sigma, knowing.sigma)))
        fail_msg("%g +- %g, by luck %g +- %g", knowing.reflected, knowing.sigma, by_luck.reflected,
                 by_luck.sigma);
    assert_true(knowing.sigma < by_luck.sigma && 32 * knowing.paths == by_luck.paths);
    assert_true(knowing.interval.low < knowing.reflected &&
                knowing.reflected < knowing.interval.high);
}

static Environment clear_sky(double azimuth_deg, double elevation_deg, float lux) {
    return (Environment){.kind = ENVIRONMENT_SKY,
                         .daylight = daylight_input_default(DAYLIGHT_CLEAR),
                         .has_sun = true,
                         .sun_azimuth = (float)radians_from_degrees(azimuth_deg),
                         .sun_elevation = (float)radians_from_degrees(elevation_deg),
                         .sun_illuminance_lx = lux,
                         .sun_angular_radius = 0.0046504f,
                         .forward = vec3(0, 0, -1)};
}

TEST(a_response_to_a_clear_sky_is_what_paths_find_under_it) {
    static const DistantSun suns[] = {
        {{270, 33}, 1}, {{180, 30}, 0.967}, {{0, 36}, 1.034}, {{90, 30}, 1}};
    static const ReviewRequest request = {.forward = {0, 0, -1}};
    ENDS_BY(world_end) World world = niche();
    world_ready(&world, 64);
    Setup setup = {.request = &request,
                   .tools = {.kernel = kernel(), .threads = 2},
                   .scene = world.scene,
                   .context = world.context};
    DaylightInput like = daylight_input_default(DAYLIGHT_CLEAR);
    like.threads = 2;
    SkyTable table = sky_table_start(&like, 30, 36, &world.arena);
    DistantTools tools = {&setup, &table, {suns, 4}, 16384, 0, 64, false, NULL};
    DistantProbe probe = {.aim = aim_of(&world)};
    probe.aim.context = &setup.context;
    distant_probe_respond(&probe, &tools, &world.arena);
    assert_done(
        distant_probes_sample_skies((DistantProbe *[]){&probe}, 1, &tools, &world.arena, &err));
    distant_probe_sample_suns(&probe, &tools, &world.arena);
    for (int i = 0; i < 4; i++) {
        SunAngles at = suns[i].at;
        world.scene->environment = clear_sky(at.azimuth_deg, at.elevation_deg, 0);
        light_again(&world);
        ProbeAim aim = aim_of(&world);
        Reading reading = read_all(&aim, world.arena);
        world.scene->environment = (Environment){.forward = vec3(0, 0, -1)};
        double found = distant_probe_read(&probe, &tools, i).sky / suns[i].light;
        double off = fabs(found - reading.reflected);
        if (!(off < 3.5 * reading.sigma + 0.01 * reading.reflected))
            fail_msg("sky %d: %g, paths %g +- %g", i, found, reading.reflected, reading.sigma);
    }
}

TEST(a_kept_sky_is_the_one_that_would_be_made) {
    Error err;
    ENDS_BY(world_end) World world = world_start();
    SkiesKept kept = {&world.arena, NULL};
    DaylightInput like = daylight_input_default(DAYLIGHT_CLEAR);
    SkyTable own = sky_table_start(&like, 30, 36, &world.arena);
    SkyTable first = sky_table_start(&like, 30, 36, &world.arena);
    SkyTable again = sky_table_start(&like, 30, 36, &world.arena);
    first.kept = again.kept = &kept;
    for (int row = 0; row < own.count; row++) {
        float bands[2][LIGHT_BANDS];
        const Daylight *made = sky_table_make(&own, row, &world.arena, &err);
        const Daylight *left = sky_table_make(&first, row, &world.arena, &err);
        assert_true(made && left && made != left);
        assert_ptr_equal(sky_table_make(&again, row, &world.arena, &err), left);
        light_bands_sky(made, 0.3f, 1, bands[0]);
        light_bands_sky(left, 0.3f, 1, bands[1]);
        assert_memory_equal(bands[0], bands[1], sizeof bands[0]);
        assert_memory_equal(own.sun_bands[row], again.sun_bands[row], sizeof own.sun_bands[row]);
    }
    again.like.albedo = 0.6;
    const Daylight *other = sky_table_make(&again, 0, &world.arena, &err);
    assert_ptr_not_equal(other, sky_table_make(&first, 0, &world.arena, &err));
    assert_true(other->input.albedo == again.like.albedo);
}

/* Where it does not none lights it, sampled by itself. */
enum { SUNS = 4000 };

/* Fibonacci's spiral over the sphere. */
static Vec3 *suns_all_round(Arena *arena) {
    Vec3 *suns = ARENA_NEW(arena, Vec3, SUNS);
    for (int i = 0; i < SUNS; i++) {
        double y = 1 - (2 * i + 1.0) / SUNS, about = 2.399963229728653 * i;
        double ring = sqrt(1 - y * y);
        suns[i] = vec3((float)(ring * cos(about)), (float)y, (float)(ring * sin(about)));
    }
    return suns;
}

TEST(a_response_reaches_all_suns_that_light_it) {
    ENDS_BY(world_end) World world = niche();
    int left = 0, lit = 0;
    world_ready(&world, 8);
    ProbeAim aim = aim_of(&world);
    Response response = respond(&aim, 8192, 2, &world.arena);
    Vec3 *suns = suns_all_round(&world.arena);
    ProbeSuns asked = {suns, SUNS, 0.00465f, false};
    ResponseOptions options = {reading_tools(2), 4, 256, 0};
    const float *shares = response_suns(&aim, &options, &asked, &world.arena);
    for (int i = 0; i < SUNS; i++) {
        bool is_lit = false;
        for (int b = 0; b < LIGHT_BANDS; b++) is_lit |= shares[i * LIGHT_BANDS + b] > 0;
        bool reaches = response_reaches(&response, suns[i]);
        if (is_lit && !reaches)
            fail_msg("%g, %g, %g", (double)suns[i].x, (double)suns[i].y, (double)suns[i].z);
        left += !reaches;
        lit += is_lit;
    }
    assert_true(lit > SUNS / 20);
    assert_true(left > SUNS / 2); /* behind the display, and walls */
}

TEST(an_even_response_is_the_same_for_suns_anywhere) {
    ENDS_BY(world_end) World world = niche();
    float bands[LIGHT_BANDS];
    uint32_t random = 1;
    world_ready(&world, 4);
    ProbeAim aim = aim_of(&world);
    Response even = respond(&aim, 32, 1, &world.arena);
    float *rest = ARENA_NEW(&world.arena, float, even.cells.count *LIGHT_BANDS);
    for (int i = 0; i < even.cells.count * LIGHT_BANDS; i++)
        rest[i] = even.cells.samplers[i / LIGHT_BANDS % (even.cells.count / 2)].area;
    even.rest = rest;
    for (int b = 0; b < LIGHT_BANDS; b++) bands[b] = 1.0f / LIGHT_BANDS;
    for (int i = 0; i < 20000; i++) {
        float v[3];
        for (int k = 0; k < 3; k++) {
            random = hash_u32(random + 1);
            v[k] = unit_float(random) - 0.5f;
        }
        Vec3 towards = vec3_normalize(vec3(v[0], v[1], v[2]));
        assert_close(response_sun(&even, towards, bands, NULL, NULL), 1, 1e-5);
    }
}

/* As many samples alike, and one that is all of the light. */
TEST(a_sun_tells_the_samples_it_is_made_of) {
    ENDS_BY(world_end) World world = niche();
    float bands[LIGHT_BANDS];
    world_ready(&world, 4);
    ProbeAim aim = aim_of(&world);
    Response even = respond(&aim, 32, 1, &world.arena);
    int cells = even.cells.count;
    float *rest = ARENA_NEW(&world.arena, float, cells *LIGHT_BANDS);
    float *groups = ARENA_NEW(&world.arena, float, cells * 2 * RESPONSE_GROUPS);
    double without[RESPONSE_GROUPS];
    for (int cell = 0; cell < cells; cell++) {
        float area = even.cells.samplers[cell % (cells / 2)].area;
        for (int b = 0; b < LIGHT_BANDS; b++) rest[cell * LIGHT_BANDS + b] = area;
        for (int k = 0; k < RESPONSE_GROUPS; k++)
            groups[(2 * cell + 1) * RESPONSE_GROUPS + k] = area / RESPONSE_GROUPS;
    }
    even.rest = rest;
    even.groups = groups;
    for (int b = 0; b < LIGHT_BANDS; b++) bands[b] = 1.0f / LIGHT_BANDS;
    Vec3 towards = even.centers[100];
    BrightSamples many = {0}, one = {0};
    response_sun(&even, towards, bands, without, &many);
    assert_true(many.squares > 1 / (16.0 * RESPONSE_GROUPS));
    assert_true(many.squares < 1 / (1.5 * RESPONSE_GROUPS));
    memset(groups, 0, (size_t)cells * 2 * RESPONSE_GROUPS * sizeof *groups);
    groups[(2 * 100 + 1) * RESPONSE_GROUPS + 3] = 1;
    response_sun(&even, towards, bands, without, &one);
    assert_close(one.squares, 1, 1e-5);
    assert_close(one.fourths, 1, 1e-5);
}

/* So that what is kept of one sampling is what another would find. */
TEST(a_sun_is_answered_alike_beside_any_others) {
    ENDS_BY(world_end) World world = niche();
    world_ready(&world, 8);
    ProbeAim aim = aim_of(&world);
    Vec3 *suns = suns_all_round(&world.arena);
    int lit = 0;
    for (int by_mirror = 0; by_mirror < 2; by_mirror++) {
        ProbeSuns all = {suns, SUNS, 0.00465f, by_mirror}, one = all;
        ResponseOptions options = {reading_tools(2), 4, by_mirror ? 2048 : 49, 0};
        const float *together = response_suns(&aim, &options, &all, &world.arena);
        for (int i = 0; i < SUNS; i += 7) {
            Arena room = world.arena;
            one.towards = suns + i;
            one.count = 1;
            const float *alone = response_suns(&aim, &options, &one, &room);
            lit += alone[0] > 0;
            assert_memory_equal(alone, together + (size_t)i * LIGHT_BANDS,
                                LIGHT_BANDS * sizeof(float));
        }
    }
    assert_true(lit > SUNS / 7 / 20);
}

TEST(responses_are_the_same_for_any_threads) {
    ENDS_BY(world_end) World world = niche();
    world_ready(&world, 64);
    ProbeAim aim = aim_of(&world);
    Response one = respond(&aim, 512, 1, &world.arena);
    Response five = respond(&aim, 512, 5, &world.arena);
    assert_memory_equal(one.first, five.first,
                        (size_t)one.cells.count * LIGHT_BANDS * sizeof(float));
    assert_memory_equal(one.rest, five.rest, (size_t)one.cells.count * LIGHT_BANDS * sizeof(float));
    assert_true(one.relative_error == five.relative_error);
}

typedef struct Heard {
    double y;
    int count;
} Heard;

static void on_light(void *user, const PathHistory *history, const float xyz[3]) {
    Heard *heard = user;
    assert_true(history->count >= 0 && history->source < LIGHT_SETS);
    if (history->count) heard->y += (double)xyz[1]; /* else the display's own */
    heard->count++;
}

TEST(what_a_listener_hears_adds_up_to_the_light) {
    ENDS_BY(world_end) World world = niche();
    builder_sky(world.scene, 1000);
    world.scene->displays[0].level = 1;
    world_ready(&world, 64);
    ProbeAim aim = aim_of(&world);
    Heard heard = {0};
    PathListener listener = {.on_light = on_light, .user = &heard};
    PathStatistics statistics = {0};
    ProbeLook looks[256];
    double seen = 0;
    kernel()->trace(&aim, 0, 256, &listener, &statistics);
    kernel()->look(&aim, 0, 256, looks, &statistics);
    for (int i = 0; i < 256; i++) seen += (double)looks[i].reflected[1];
    assert_close(heard.y, seen, 1e-6);
    assert_true(heard.count > 256);
}

TEST_PROGRAM(NULL, NULL)
