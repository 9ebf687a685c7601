/* SPDX-License-Identifier: Apache-2.0 */
/* Suns of a sweep: where each stands, and how much of the time it means. */
#include "check.h"

#include "base/units.h"
#include "review/light/distant_probe.h"
#include "review/suns/sweep_suns.h"

static SweepSuns suns_of(ReviewCondition condition, Arena *arena) {
    condition.weather_id = condition.level_id = condition.with_id = NO_ID;
    return sweep_suns(&condition, 2, arena);
}

/* Every hour of a year is counted once a heading, when the sun is up: half of the year and what
 * refraction and the altitude of the pole add. */
TEST(a_year_has_its_hours_of_sun_for_every_heading) {
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 28);
    double headings[] = {0, 90, 200};
    SweepSuns suns = suns_of((ReviewCondition){.kind = CONDITION_YEAR_SWEEP,
                                               .year = 2026,
                                               .where = {48.14, 11.58, 520},
                                               .step_minutes = 60,
                                               .headings_deg = headings,
                                               .heading_count = 3},
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
}

TEST(a_grid_of_suns_is_the_vehicles) {
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 24);
    ReviewCondition condition = {.kind = CONDITION_SUN_SWEEP,
                                 .azimuth_deg = {0, 350, 10, 36},
                                 .elevation_deg = {5, 45, 20, 3},
                                 .has_heading = true,
                                 .heading_deg = 90};
    SweepSuns suns = suns_of(condition, &arena);
    assert_int_equal(suns.count, 36 * 3);
    assert_false(suns.has_time);
    for (int i = 0; i < suns.count; i++) {
        assert_near(suns.list[i].compass_deg, 10 * (i % 36), 1e-9);
        assert_near(suns.list[i].azimuth_deg, 10 * (i % 36) - 90, 1e-9);
        assert_near(suns.distant[i].at.elevation_deg, 5 + 20 * (i / 36), 1e-9);
    }
}

/* Closer about one of them, as far as its neighbours and a tenth of a degree apart. */
TEST(suns_about_one_are_a_tenth_of_a_degree_apart) {
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 28);
    double heading = 90;
    ReviewCondition year = {.kind = CONDITION_YEAR_SWEEP,
                            .year = 2026,
                            .weather_id = NO_ID,
                            .where = {48.14, 11.58, 520},
                            .step_minutes = 60,
                            .headings_deg = &heading,
                            .heading_count = 1};
    ReviewCondition grid = {.kind = CONDITION_SUN_SWEEP,
                            .azimuth_deg = {0, 350, 10, 36},
                            .elevation_deg = {5, 45, 20, 3},
                            .has_heading = true,
                            .heading_deg = 90,
                            .weather_id = NO_ID};
    SweepSuns suns = suns_of(year, &arena);
    int at = 2000; /* high up: neighbours are up too */
    while (suns.list[at].elevation_deg < 50) at++;
    SweepSun one = suns.list[at];
    SweepSuns about = sweep_suns_about(&year, &one, 0, &arena);
    int middle = about.count / 2;
    assert_near(about.list[middle].azimuth_deg, one.azimuth_deg, 1e-9);
    assert_near(about.list[0].azimuth_deg, suns.list[at - 1].azimuth_deg, 1e-6);
    assert_near(about.list[about.count - 1].azimuth_deg, suns.list[at + 1].azimuth_deg, 1e-6);
    for (int i = 1; i < about.count; i++) {
        const SweepSun *a = &about.list[i - 1], *b = &about.list[i];
        double east =
            (b->compass_deg - a->compass_deg) * cos(radians_from_degrees(a->elevation_deg));
        assert_true(hypot(east, b->elevation_deg - a->elevation_deg) < 0.11);
    }
    assert_non_null(strstr(sweep_suns_when(&year, &suns, &about.list[0], &arena), ":30 UTC"));
    assert_int_equal(sweep_suns_about(&year, &one, 1, &arena).count, 1);
    one = suns_of(grid, &arena).list[40];
    double reach = 20;
    for (int round = 0; round < 2; round++) {
        about = sweep_suns_about(&grid, &one, round, &arena);
        double low = INFINITY, high = -INFINITY, least = INFINITY;
        for (int i = 0; i < about.count; i++) {
            double apart = fabs(about.list[i].elevation_deg - one.elevation_deg);
            low = fmin(low, about.list[i].elevation_deg);
            high = fmax(high, about.list[i].elevation_deg);
            if (apart > 1e-9) least = fmin(least, apart);
        }
        assert_near(high - low, 2 * reach, 1e-9);
        assert_near(least, round ? 0.1 : 4, 1e-9);
        reach = least;
    }
    assert_int_equal(sweep_suns_about(&grid, &one, 2, &arena).count, 1);
}

/* Each is found with its own reading, and no other is, however many there are. */
TEST(kept_readings_are_found_by_their_suns) {
    enum { MANY = 5000 };
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 28);
    SunReadings of[2] = {sun_readings_start(&arena), sun_readings_start(&arena)};
    for (int i = 0; i < 2 * MANY; i++) {
        DistantSun sun = {{i % 100 * 3.6, i / 100 * 0.9}, 1};
        assert_null(sun_readings_find(&of[i % 2], sun));
        sun_readings_add(&of[i % 2], sun, i);
    }
    for (int i = 0; i < 2 * MANY; i++) {
        DistantSun sun = {{i % 100 * 3.6, i / 100 * 0.9}, 1};
        DistantSun beside = {{i % 100 * 3.6, i / 100 * -0.9}, 1}, nearer = {sun.at, 1.03};
        assert_true(*sun_readings_find(&of[i % 2], sun) == i);
        assert_null(sun_readings_find(&of[1 - i % 2], sun));
        if (i >= 100) assert_null(sun_readings_find(&of[i % 2], beside));
        assert_null(sun_readings_find(&of[i % 2], nearer)); /* of another date */
    }
    assert_int_equal(of[0].count, MANY);
}

/* Every step carries its own date's light: 1 / R^2 by the earth's orbit, nearest on 3 January,
 * an eccentricity of 0.0167; and so do suns about it and later ones. */
TEST(suns_are_as_bright_as_the_earth_is_near) {
    ReviewCondition year = {.kind = CONDITION_YEAR_SWEEP,
                            .year = 2026,
                            .where = {48, 11, 0},
                            .step_minutes = 120,
                            .heading_count = 2,
                            .weather_id = NO_ID,
                            .headings_deg = (double[]){0, 90}};
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 28);
    SweepSuns suns = sweep_suns(&year, 2, &arena);
    double most = 0, least = 2;
    for (int i = 0; i < suns.count; i++) {
        const SweepSun *sun = &suns.list[i];
        double day = (sun->step + 0.5) * 120 / 1440;
        double turn = 2 * PI * (day - 2.7) / 365.25;
        double distance = 1 - 0.0167 * cos(turn) + 0.0167 * 0.0167 * sin(turn) * sin(turn);
        assert_close(sun->light, 1 / (distance * distance), 5e-4);
        assert_near(suns.distant[i].light, sun->light, 0);
        most = fmax(most, sun->light), least = fmin(least, sun->light);
    }
    assert_near(most, 1.034, 1e-3);
    assert_near(least, 0.967, 1e-3);
    SweepSuns about = sweep_suns_about(&year, &suns.list[5], 0, &arena);
    for (int i = 0; i < about.count; i++)
        assert_close(about.list[i].light, suns.list[5].light, 1e-4);
    SweepSun later = suns.list[5];
    later.later_minutes = 30;
    later.light = 0;
    assert_close(sweep_suns_later(&year, &later, 1, &arena).distant[0].light, suns.list[5].light,
                 1e-4);
}

TEST_PROGRAM(NULL, NULL)
