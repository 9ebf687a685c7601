/* SPDX-License-Identifier: Apache-2.0 */
/* Sweeps under a weather file: each step takes its row, and gaps are reported. */
#include "fixture.h"

#include <math.h>

#include "review/run/sweep.h"
#include "review/run/sweep_weather.h"

#define DAY 24
#define DAYS_BEFORE 171 /* 21 June */

/* 21 June of another year, UTC: sun from 5 to 19 h; each row gives its label. */
typedef struct Fixture {
    WeatherHour hours[DAY];
    ReviewWeather weather;
    ReviewRequest request;
    ReviewCondition condition;
    Arena arena;
} Fixture;

static bool is_day(int label) {
    return label > 5 && label < 20;
}

/* A year with `steps` of them an hour. */
static Fixture *year_of(int steps) {
    static Fixture f;
    static const double north[1];
    f = (Fixture){.arena = *test_memory()};
    for (int i = 0; i < DAY; i++)
        f.hours[i] = (WeatherHour){.line = 9 + i,
                                   .year = 1999,
                                   .month = 6,
                                   .day = 21,
                                   .label_h = i + 1,
                                   .has_light = true,
                                   .has_dew_point = true,
                                   .dew_point_c = i + 1,
                                   .direct_normal_w_m2 = is_day(i + 1) ? 100 + i + 1 : 0,
                                   .diffuse_horizontal_w_m2 = is_day(i + 1) ? 50 + i + 1 : 0};
    f.weather = (ReviewWeather){
        .path = "w.epw",
        .weather = {.city = "Here", .rows_per_hour = 1, .hour = f.hours, .count = DAY},
        .clock = {.offset_h = -0.5}};
    f.request = (ReviewRequest){.weathers = &f.weather, .weather_count = 1};
    f.condition = (ReviewCondition){.name = "year",
                                    .kind = CONDITION_YEAR_SWEEP,
                                    .year = 2026,
                                    .where = {50, 0, 0},
                                    .step_minutes = 60.0 / steps,
                                    .headings_deg = north,
                                    .heading_count = 1};
    return &f;
}

static int first_of_day(const Fixture *f) {
    return (int)(DAYS_BEFORE * DAY * 60 / f->condition.step_minutes);
}

/* Those of the day that the file has. */
static SweepSuns day_of(Fixture *f) {
    SweepSuns day = sweep_suns(&f->condition, 2, &f->arena);
    int first = first_of_day(f), end = first + (int)(DAY * 60 / f->condition.step_minutes);
    const SweepSun *last = day.list + day.count;
    while (day.list->step < first) day.list++;
    for (day.count = 0; day.list + day.count < last && day.list[day.count].step < end;) day.count++;
    return day;
}

TEST(each_step_has_the_light_of_its_row) {
    for (int steps = 1; steps <= 4; steps += 3) {
        Fixture *f = year_of(steps);
        SweepSuns suns = day_of(f);
        assert_true(suns.count > 15 * steps);
        assert_done(sweep_weather_check(&f->request, &f->condition, &suns, f->arena, &err));
        for (int i = 0; i < suns.count; i++) {
            const SweepSun *sun = &suns.list[i];
            DaylightInput light;
            int label = (sun->step - first_of_day(f)) / steps + 1;
            bool is_lit = sweep_weather_light(&f->request, &f->condition, sun, &light);
            assert_int_equal(is_lit, is_day(label));
            if (!is_lit) continue;
            assert_near(light.direct_w_m2, 100 + label, 1e-12);
            assert_near(light.diffuse_w_m2, 50 + label, 1e-12);
            assert_true(light.water_source == WATER_DEW_POINT && !light.has_lux);
            assert_near(light.water_cm, exp(0.07 * label - 0.075), 1e-12);
            assert_true(light.kind == DAYLIGHT_PEREZ && light.has_time && !light.has_sun &&
                        light.when.year == 2026 && light.when.hour == label - 1);
        }
    }
}

/* All headings of an hour share its sky; dark ones have none. */
TEST(skies_are_made_once_an_hour) {
    Fixture *f = year_of(1);
    double headings[3] = {0, 10, 200};
    HourSkies skies;
    f->condition.headings_deg = headings;
    f->condition.heading_count = 3;
    Setup setup = {.request = &f->request, .condition = &f->condition, .tools.threads = 2};
    SweepSuns day = day_of(f);
    assert_done(sweep_weather_skies(&setup, &day, &f->arena, &skies, &err));
    for (int i = 0; i < day.count; i++) {
        int label = day.list[i].step - first_of_day(f) + 1;
        assert_int_equal(skies.of_sun[i] >= 0, is_day(label));
        assert_int_equal(skies.of_sun[i], skies.of_sun[i - i % 3]);
        if (i >= 3 && skies.of_sun[i] >= 0) assert_true(skies.of_sun[i] >= skies.of_sun[i - 3]);
    }
}

/* What is traced in full: the hour's own sky, nothing in a dark one, and a clear sky for a sun
 * that belongs to no hour. */
TEST(a_sun_is_traced_under_its_hour) {
    Fixture *f = year_of(1);
    int first = first_of_day(f);
    Setup setup = {.request = &f->request, .condition = &f->condition};
    SweepSun noon = {.elevation_deg = 60, .heading_deg = 90, .step = first + 11};
    SweepSun dusk = {.elevation_deg = 2, .step = first + 20};
    SweepSun any = {.elevation_deg = 30, .step = -1};
    f->request.forward[2] = -1;
    Environment sky = sweep_environment(&setup, &noon);
    assert_int_equal(sky.kind, ENVIRONMENT_PEREZ);
    assert_false(sky.has_sun);
    assert_near(sky.daylight.direct_w_m2, 112, 1e-12);
    assert_near(sky.heading, 1.5707963, 1e-6);
    assert_int_equal(sweep_environment(&setup, &dusk).kind, ENVIRONMENT_NONE);
    assert_int_equal(sweep_environment(&setup, &any).kind, ENVIRONMENT_SKY);
}

typedef void Harm(Fixture *f);

static void lose_a_row(Fixture *f) {
    f->hours[11] = f->hours[10];
}
static void lose_values(Fixture *f) {
    f->hours[11].has_light = false;
}
static void lose_lux(Fixture *f) {
    f->condition.weather_lux = WEATHER_LUX_FILE;
    for (int i = 0; i < DAY; i++) {
        f->hours[i].direct_normal_lx = 95 * f->hours[i].direct_normal_w_m2;
        f->hours[i].diffuse_horizontal_lx = 120 * f->hours[i].diffuse_horizontal_w_m2;
    }
    f->hours[11].diffuse_horizontal_lx = -1;
}
static void add_a_spike(Fixture *f) {
    f->hours[11].direct_normal_w_m2 = 2500;
}
static void lose_diffuse(Fixture *f) {
    f->hours[11].diffuse_horizontal_w_m2 = 0;
}
static void lose_noon(Fixture *f) {
    for (int i = 11; i < 13; i++)
        f->hours[i].direct_normal_w_m2 = f->hours[i].diffuse_horizontal_w_m2 = 0;
}

TEST(gaps_by_day_are_told) {
    static const struct {
        Harm *harm;
        const char *path, *words;
    } wrong[] = {
        {lose_a_row, "",
         "has no row within half an hour, where 'year' needs one "
         "(2026-06-21 11:30 UTC, 1 of its 16 steps alike)"},
        {lose_values, "line 20", "has no direct or no diffuse radiation, where 'year' needs"},
        {lose_diffuse, "line 20", "has 112 W/m2 of direct light and no diffuse, where"},
        {lose_lux, "line 20",
         "has 10640 lx direct and no lx diffuse beside 112 and 62 W/m2, "
         "where 'year' needs one (2026-06-21 11:30 UTC, 1 of its 16"},
        {add_a_spike, "line 20",
         "has 2500 W/m2 of direct and 62 of diffuse light, more than "
         "the sun's own 1410, where 'year' needs one"},
        {lose_noon, "line 20",
         "is dark while the sun stands 63 degrees high, where 'year' "
         "needs one (2026-06-21 11:30 UTC, 2 of its"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        Fixture *f = year_of(1);
        wrong[i].harm(f);
        SweepSuns suns = day_of(f);
        assert_false(sweep_weather_check(&f->request, &f->condition, &suns, f->arena, why()));
        assert_told(ERROR_INPUT, wrong[i].path, wrong[i].words);
    }
}

TEST(gaps_by_night_matter_to_none) {
    Fixture *f = year_of(1);
    f->hours[0].has_light = f->hours[23].has_light = false;
    SweepSuns suns = day_of(f);
    assert_done(sweep_weather_check(&f->request, &f->condition, &suns, f->arena, &err));
    f->condition.with_night = true;
    f->condition.where.latitude_deg = 62; /* no deep night */
    suns = day_of(f);
    assert_false(sweep_weather_check(&f->request, &f->condition, &suns, f->arena, why()));
}

TEST_PROGRAM(make_arena, drop_arena)
