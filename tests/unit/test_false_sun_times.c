/* SPDX-License-Identifier: Apache-2.0 */
/* When a mirror throws the sun into an eye, against the sun's way and plane geometry. */
#include "fixture.h"

#include "base/units.h"
#include "review/run/false_sun_times.h"
#include "vision/eye_spread.h"
#include "world_fixture.h"

#define SIDE_M 0.004 /* of a facet, 0.7 m away */
#define HEADING_DEG 90

static const double sun_lx = 30000; /* less than any sun above 10 degrees gives */

static bool looks[] = {true};
static ReviewGaze gaze = {.name = "road", .direction = {0, 0, -1}, .for_eye = looks};
static ReviewEye eye = {.name = "driver", .kind = EYE_POINT};
static const double heading = HEADING_DEG;
static ReviewRequest request = {.forward = {0, 0, -1},
                                .eyes = &eye,
                                .eye_count = 1,
                                .gazes = &gaze,
                                .gaze_count = 1,
                                .observer = {50, 0.5}};

static ReviewCondition year_condition(void) {
    return (ReviewCondition){.name = "a year",
                             .kind = CONDITION_YEAR_SWEEP,
                             .year = 2026,
                             .where = {48.14, 11.58, 520},
                             .step_minutes = 60,
                             .headings_deg = (double *)(uintptr_t)&heading,
                             .heading_count = 1,
                             .weather_id = NO_ID,
                             .level_id = NO_ID,
                             .with_id = NO_ID};
}

typedef struct Facet {
    Vec3 at, normal, right, up; /* right, up: unit */
} Facet;

/* Throws the sun of one minute of the year, which comes from behind, into the eye. */
static Facet facet_for(Vec3 sun) {
    Vec3 at = vec3_scale(vec3_normalize(vec3(0.35f, -0.3f, -0.9f)), 0.7f);
    Facet facet = {.at = at, .normal = vec3_normalize(vec3_sub(sun, vec3_normalize(at)))};
    Frame frame = frame_from_z(facet.normal);
    facet.right = frame.x;
    facet.up = frame.y;
    return facet;
}

/* How far from the sun's middle the facet's edge lies, degrees; below 0: the middle is in it.
 * */
static double degrees_outside(const Facet *facet, Vec3 sun) {
    float along = 2 * vec3_dot(sun, facet->normal);
    Vec3 seen = vec3_neg(vec3_along(sun, facet->normal, -along));
    seen = vec3_neg(seen); /* against the reflected light */
    float t = vec3_dot(facet->at, facet->normal) / vec3_dot(seen, facet->normal);
    Vec3 apart = vec3_sub(vec3_scale(seen, t), facet->at);
    double x = fabs((double)vec3_dot(apart, facet->right)) - SIDE_M / 2;
    double y = fabs((double)vec3_dot(apart, facet->up)) - SIDE_M / 2;
    if (!(t > 0)) return 180;
    return degrees_from_radians(hypot(fmax(x, 0), fmax(y, 0)) / 0.7);
}

typedef struct Brute {
    double certain, possible; /* minutes */
} Brute;

/* Minute by minute. */
static Brute brute_force(const Setup *setup, const Facet *facet, const SweepSuns *suns) {
    Brute out = {0, 0};
    for (int i = 0; i < suns->count; i++) {
        double apart = degrees_outside(facet, setup_direction(setup, suns->distant[i].at));
        out.certain += apart < SUN_MEAN_RADIUS_DEG - 0.06;
        out.possible += apart < SUN_MEAN_RADIUS_DEG + 0.08;
    }
    return out;
}

static void add_facet(World *world, const Facet *facet) {
    Material silver = builder_mirror(0.9f);
    silver.name = "chrome";
    builder_part(world->scene, silver);
    builder_quad(world->scene, facet->at, vec3_scale(facet->right, SIDE_M / 2),
                 vec3_scale(facet->up, SIDE_M / 2));
    /* Far away, that the scene has a size. */
    builder_part(world->scene, builder_material(0.2f));
    builder_quad(world->scene, vec3(0, -100, 0), vec3(1, 0, 0), vec3(0, 0, -1));
}

/* An hour's sweep would see it once in many years. */
TEST(a_facet_that_dazzles_for_minutes_a_year_is_found) {
    SCOPED_WORLD world = world_start();
    Arena scratch = arena_reserve((size_t)1 << 30);
    const Kernel *kernel;
    ReviewCondition condition = year_condition(), minutes = condition;
    static const Profile none;
    ReviewRun run = {.request = &request, .profile = &none};
    ReviewFalseSun reported[FALSE_SUNS_LISTED];
    Review out = {.false_suns = reported};
    Setup setup = {.request = &request, .condition = &condition, .scene = world.scene};
    minutes.step_minutes = 1;
    SweepSuns suns = sweep_suns(&minutes, 2, &scratch);
    int at = 0; /* 3 October, in the afternoon: ahead is east, the sun behind */
    while (suns.list[at].step < (275 * 24 + 15) * 60 + 20) at++;
    Facet facet = facet_for(setup_direction(&setup, suns.distant[at].at));
    add_facet(&world, &facet);
    world_ready(&world, 16);
    assert_done(kernel_choose(NULL, &kernel, &err));
    setup.tools = (ProbeTools){.kernel = kernel, .threads = 2};
    setup.context = world.context;
    Brute brute = brute_force(&setup, &facet, &suns);
    assert_true(brute.certain >= 3 && brute.certain < 60);

    float bands[LIGHT_BANDS];
    FalseSunRays rays;
    FalseSuns images;
    Sweep sweep = {.run = &run, .setup = &setup, .false_suns = &images};
    DaylightInput clear = daylight_input_default(DAYLIGHT_CLEAR);
    DistantTools tools = {.table = &sweep.table};
    sweep.table = sky_table_start(&clear, 16, 36, &scratch);
    assert_done(distant_probes_sample_skies(NULL, 0, &tools, &scratch, &err));
    for (int b = 0; b < LIGHT_BANDS; b++) bands[b] = 1;
    false_suns_search(&setup, vec3(0, 0, 0), &scratch, &rays);
    images = false_suns_of(&rays, bands, &scratch);
    false_sun_times(&sweep, scratch, &world.arena, &out);

    assert_int_equal(out.false_sun_count, 1);
    if (!(reported[0].minutes >= brute.certain && reported[0].minutes <= brute.possible))
        fail_msg("%g minutes of %g to %g", reported[0].minutes, brute.certain, brute.possible);
    assert_true(reported[0].longest_minutes >= 2 && reported[0].longest_minutes <= 8);
    assert_string_equal(reported[0].mirror, "part (chrome)");
    assert_string_equal(reported[0].gaze, "road");
    assert_non_null(strstr(reported[0].when, "UTC, heading 90 degrees"));
    /* The sun returns to that height in spring: either day will do. */
    assert_true(strstr(reported[0].when, "2026-10-0") || strstr(reported[0].when, "2026-03-") ||
                strstr(reported[0].when, "2026-09-") || strstr(reported[0].when, "2026-04-"));
    assert_near(reported[0].share * suns.count, reported[0].minutes, 1e-6 * suns.count);
    double angle = degrees_from_radians(acos(0.9 / sqrt(0.35 * 0.35 + 0.3 * 0.3 + 0.9 * 0.9)));
    assert_near(reported[0].angle_deg, angle, 0.5);
    double veil = reported[0].lux * cos(radians_from_degrees(angle)) *
                  eye_spread_at(angle, (HumanEye){50, 0.5});
    assert_true(fabs(reported[0].veil_cd_m2 / veil - 1) < 0.05);
    double covered =
        SIDE_M * SIDE_M / 0.49 / (2 * PI * (1 - cos(radians_from_degrees(SUN_MEAN_RADIUS_DEG))));
    assert_true(reported[0].lux > 0.5 * covered * sun_lx && reported[0].lux < covered * 130000);
    arena_release(&scratch);
}

TEST_PROGRAM(NULL, NULL)
