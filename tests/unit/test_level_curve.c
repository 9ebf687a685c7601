/* SPDX-License-Identifier: Apache-2.0 */
/* Levels that follow the light. */
#include "fixture.h"

#include "review/request/request.h"

static const ReviewLevelPoint points[] = {{0, 0.02}, {50, 0.08}, {1000, 0.4}, {20000, 1}};
static const ReviewLevel curve = {.is_curve = true, .points = points, .point_count = 4};

TEST(a_level_curve_goes_through_its_points) {
    for (int i = 0; i < 4; i++)
        assert_close(review_level_of_lux(&curve, points[i].lux), points[i].level, 1e-12);
    assert_near(review_level_of_lux(&curve, -5), 0.02, 0);
    assert_near(review_level_of_lux(&curve, 1e6), 1, 0); /* the end's beyond the ends */
}

/* Halfway in log-log the level is the geometric mean; next to 0 lx the piece is linear. */
TEST(a_level_curve_is_a_power_law_between_points) {
    assert_close(review_level_of_lux(&curve, sqrt(50.0 * 1000)), sqrt(0.08 * 0.4), 1e-12);
    assert_close(review_level_of_lux(&curve, sqrt(1000.0 * 20000)), sqrt(0.4), 1e-12);
    double whole = review_level_of_lux(&curve, 4000) / review_level_of_lux(&curve, 2000);
    assert_close(whole, review_level_of_lux(&curve, 16000) / review_level_of_lux(&curve, 8000),
                 1e-12); /* the same factor in light is the same factor in level */
    assert_close(review_level_of_lux(&curve, 25), 0.05, 1e-12);
}

TEST(a_level_curve_does_not_fall) {
    double last = 0;
    for (double lux = 0; lux < 30000; lux = lux * 1.003 + 0.01) {
        double level = review_level_of_lux(&curve, lux);
        assert_true(level >= last && level <= 1);
        last = level;
    }
}

TEST(fixed_levels_go_by_name_material_and_the_rest) {
    ReviewFixedLevel fixed[] = {{"*", 0.5}, {"windows", 0.2}, {"node:alt", 0.1}};
    ReviewLevel level = {.fixed = fixed, .fixed_count = 3};
    ReviewDisplayName alt = {"node:alt", "windows"}, hdg = {"node:hdg", "windows"};
    ReviewDisplayName other = {"pfd", "pfd"};
    assert_near(review_level_at(&level, alt, 7, 1e4), 0.1, 0);
    assert_near(review_level_at(&level, hdg, 7, 1e4), 0.2, 0);
    assert_near(review_level_at(&level, other, 7, 1e4), 0.5, 0);
    level.fixed = fixed + 1, level.fixed_count = 2;
    assert_near(review_level_at(&level, other, 7, 1e4), 7, 0); /* the scene's own */
    assert_near(review_level_at(&curve, other, 7, 1000), 0.4, 1e-12);
}

TEST_PROGRAM(NULL, NULL)
