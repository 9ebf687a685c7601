/* SPDX-License-Identifier: Apache-2.0 */
/* What variants take over from their review: its guides, where the scene is the same, and its
 * clear skies, bit by bit. */
#include "fixture.h"

#include "base/units.h"
#include "review/light/inherited.h"

static const char *own[] = {"car.gltf"}, *other[] = {"bus.gltf"};

TEST(a_guide_is_inherited_where_files_and_lights_are_the_same)
{
    ReviewRequest request = {.scenes = own, .scene_count = 1, .condition_count = 2};
    ReviewRequest same = request, bus = request, more = request;
    const char   *two[] = {"car.gltf", "mug.gltf"};
    GuideScene    scene = {.has = {true, false, true, false}, .light_count = 3,
                           .lamp_count = 2};
    GuideScene    lamps = scene, sky = scene;
    LightGuide    guide = {.node_count = 1};
    Inherited    *inherited = inherited_start(&request);
    bus.scenes = other;
    more.scenes = two;
    more.scene_count = 2;
    lamps.lamp_count = 1;
    sky.has[1] = true;
    assert_null(inherited_guide(inherited, &same, 0, &scene));
    inherited_keep_guide(inherited, 0, &guide, &scene);
    assert_ptr_equal(inherited_guide(inherited, &same, 0, &scene), &guide);
    assert_null(inherited_guide(inherited, &same, 1, &scene));
    assert_null(inherited_guide(inherited, &bus, 0, &scene));
    assert_null(inherited_guide(inherited, &more, 0, &scene));
    assert_null(inherited_guide(inherited, &same, 0, &lamps));
    assert_null(inherited_guide(inherited, &same, 0, &sky));
    inherited_end(inherited);
}

static DaylightInput sun_at(double elevation_deg, double turbidity)
{
    DaylightInput input = daylight_input_default(DAYLIGHT_CLEAR);
    input.has_sun = input.no_moon = true;
    input.sun_elevation = radians_from_degrees(elevation_deg);
    input.sun_lux = -1;
    input.turbidity = turbidity;
    input.threads = 2;
    return input;
}

static void check_same(const Daylight *a, const Daylight *b)
{
    for (int i = 0; i < 40; i++) {
        float elevation = 0.03f * (float)i + 0.01f, azimuth = 0.5f * (float)i;
        assert_true(daylight_luminance(a, elevation, azimuth) ==
                    daylight_luminance(b, elevation, azimuth));
    }
}

ARENA_TEST(a_sky_is_made_once_and_is_the_sky_that_was_asked_for)
{
    ReviewRequest request = {.scenes = own, .scene_count = 1, .condition_count = 1};
    Inherited    *inherited = inherited_start(&request);
    DaylightInput low = sun_at(8, 2.5), high = sun_at(40, 2.5), hazy = sun_at(8, 5);
    Daylight      alone;
    const Daylight *first = inherited_sky(inherited, &low, why());
    assert_non_null(first);
    assert_done(daylight_build(&low, &arena, &alone, &err));
    check_same(first, &alone);
    assert_ptr_not_equal(inherited_sky(inherited, &high, why()), first);
    assert_ptr_not_equal(inherited_sky(inherited, &hazy, why()), first);
    assert_ptr_equal(inherited_sky(inherited, &low, why()), first);
    check_same(first, &alone);
    inherited_end(inherited);
}

TEST(a_sky_that_cannot_be_is_an_error_and_leaves_none)
{
    ReviewRequest request = {.scenes = own, .scene_count = 1, .condition_count = 1};
    Inherited    *inherited = inherited_start(&request);
    DaylightInput input = sun_at(20, 2.5);
    input.where.altitude_m = 90000;
    assert_null(inherited_sky(inherited, &input, why()));
    assert_true(why()->text[0] != 0);
    input.where.altitude_m = 0;
    assert_non_null(inherited_sky(inherited, &input, why()));
    inherited_end(inherited);
}

TEST_PROGRAM(make_arena, drop_arena)
