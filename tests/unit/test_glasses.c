/* SPDX-License-Identifier: Apache-2.0 */
/* Sunglasses: what they let through, and how they weigh one light against another. */
#include "fixture.h"

#include "review/light/glasses.h"

/* `below` up to nm, `above` from there on. */
static Curve step_at(int nm, float below, float above) {
    Curve curve;
    for (int i = 0; i < CURVE_COUNT; i++) curve.value[i] = CURVE_FIRST_NM + i < nm ? below : above;
    return curve;
}

TEST(a_grey_lens_lets_through_what_it_says) {
    for (float share = 0.03f; share <= 1; share += 0.1f) {
        Curve grey = step_at(500, share, share);
        assert_near(glasses_luminous(&grey), (double)share, 1e-6);
    }
}

/* Half of daylight's luminance lies on either side of some 557 nm. */
TEST(daylight_counts_as_the_eye_sees_it) {
    double last = 0;
    for (int nm = 400; nm < 750; nm += 10) {
        Curve below = step_at(nm, 1, 0), above = step_at(nm, 0, 1);
        double share = glasses_luminous(&below);
        assert_near(share + glasses_luminous(&above), 1, 1e-6);
        assert_true(share >= last);
        last = share;
    }
    Curve half = step_at(557, 1, 0);
    assert_near(glasses_luminous(&half), 0.5, 0.02);
}

/* Over its luminous transmittance: daylight's luminance stays. */
ARENA_TEST(colour_is_parted_from_darkness) {
    Curve step = step_at(600, 0.1f, 0.4f);
    ReviewGlasses given = {.curve = &step};
    ReviewCondition condition = {.glasses = &given};
    Glasses worn = glasses_worn(&condition, vec3(0, 0, -1), &arena);
    assert_near(worn.transmittance, glasses_luminous(&step), 1e-12);
    assert_near(glasses_luminous(worn.colour), 1, 1e-6);
    assert_null(worn.polariser);
    condition.glasses = NULL;
    assert_near(glasses_worn(&condition, vec3(0, 0, -1), &arena).transmittance, 1, 0);
}

/* Unpolarised light comes through as by grey lenses; the axis turns with the head. */
ARENA_TEST(a_polariser_is_worn_upright) {
    ReviewGlasses given = {
        .transmittance = 0.2, .is_polarising = true, .axis_deg = 90, .extinction = 9};
    ReviewCondition condition = {.glasses = &given};
    Glasses worn = glasses_worn(&condition, vec3(3, 0, 0), &arena);
    const PolarisedEye *eye = worn.polariser;
    assert_near(eye->lets + eye->blocks, 2, 1e-6);
    assert_near(eye->lets / eye->blocks, 9, 1e-5);
    assert_near(eye->axis[0], 1, 1e-6); /* along its right, */
    assert_near(eye->right.z, 1, 1e-6); /* which is +Z for who looks along +X */
    assert_near(worn.transmittance, 0.2, 0);
    assert_true(glasses_worn(&condition, vec3(0, 1, 0), &arena).polariser->right.y < 1e-6f);
}

TEST_PROGRAM(make_arena, drop_arena)
