/* Suns of a sweep: where each stands, and how much of the time it means. */
#include "check.h"

#include "review/run/sweep_suns.h"

static SweepSuns suns_of(ReviewCondition condition, Arena *arena)
{
    condition.weather_id = condition.level_id = condition.with_id = NO_ID;
    return sweep_suns(&condition, arena);
}

/* Every hour of a year is counted once a heading, when the sun is up: half of the year and what
 * refraction and the altitude of the pole add. */
TEST(a_year_has_its_hours_of_sun_for_every_heading)
{
    (void)state;
    Arena  arena = arena_reserve((size_t)1 << 28);
    double headings[] = {0, 90, 200};
    SweepSuns suns = suns_of((ReviewCondition){.kind = CONDITION_YEAR_SWEEP, .year = 2026,
                                               .where = {48.14, 11.58, 520}, .step_minutes = 60,
                                               .headings_deg = headings, .heading_count = 3},
                             &arena);
    double minutes = 0, highest = 0;
    assert_int_equal(suns.count % 3, 0);
    for (int i = 0; i < suns.count; i++) {
        const SweepSun *sun = &suns.list[i];
        double back = fmod(sun->azimuth_deg + sun->heading_deg, 360);
        assert_true(fabs(back - sun->compass_deg) < 1e-9 ||
                    fabs(fabs(back - sun->compass_deg) - 360) < 1e-9);
        assert_true(sun->elevation_deg >= 0 && sun->step >= 0 && sun->step < 8760);
        assert_true(sun->heading_id == i % 3);
        minutes += sun->minutes;
        highest = fmax(highest, sun->elevation_deg);
    }
    assert_true(fabs(minutes / 3 / 60 / 8760 - 0.51) < 0.01);
    assert_true(fabs(highest - (90 - 48.14 + 23.44)) < 1.0);
    arena_release(&arena);
}

TEST(a_grid_of_suns_is_the_vehicles)
{
    (void)state;
    Arena arena = arena_reserve((size_t)1 << 24);
    ReviewCondition condition = {.kind = CONDITION_SUN_SWEEP, .azimuth_deg = {0, 350, 10, 36},
                                 .elevation_deg = {5, 45, 20, 3}, .has_heading = true,
                                 .heading_deg = 90};
    SweepSuns suns = suns_of(condition, &arena);
    assert_int_equal(suns.count, 36 * 3);
    assert_false(suns.has_time);
    for (int i = 0; i < suns.count; i++) {
        assert_near(suns.list[i].compass_deg, 10 * (i % 36), 1e-9);
        assert_near(suns.list[i].azimuth_deg, 10 * (i % 36) - 90, 1e-9);
        assert_near(suns.angles[i].elevation_deg, 5 + 20 * (i / 36), 1e-9);
    }
    arena_release(&arena);
}

/* Points of a drive at noon in summer: each stands for the time to the next. */
TEST(a_route_gives_each_point_its_time)
{
    (void)state;
    Arena      arena = arena_reserve((size_t)1 << 24);
    RoutePoint points[3];
    for (int i = 0; i < 3; i++)
        points[i] = (RoutePoint){.when = {2026, 6, 21, 12, 10 * i, 0, 1}, .seconds = 600 * i,
                                 .where = {50 + 0.1 * i, 8, 100}, .heading_deg = 30 * i};
    ReviewCondition condition = {.kind = CONDITION_ROUTE, .route = {"r", points, 3}};
    SweepSuns suns = suns_of(condition, &arena);
    assert_int_equal(suns.count, 3);
    assert_near(suns.list[0].minutes, 10, 1e-9);
    assert_near(suns.list[2].minutes, 0, 1e-9);
    for (int i = 0; i < 3; i++) {
        assert_true(suns.list[i].elevation_deg > 60);
        assert_near(suns.list[i].heading_deg, 30 * i, 1e-9);
        assert_true(suns.list[i].step == i);
    }
    arena_release(&arena);
}

int main(void)
{
    return run_cases(NULL, NULL);
}
