/* SPDX-License-Identifier: Apache-2.0 */
/* Which instants the rows of a weather file hold: files of known instants, made here. */
#include <math.h>

#include "base/units.h"
#include "fixture.h"
#include "sky/daylight.h"
#include "sky/weather_clock.h"

/* A file to make. */
typedef struct Made {
    const char *name;
    double latitude, longitude, zone_h;
    double offset_h;                           /* instants: from the label; hour means: ignored */
    bool is_means;                             /* of the hour that ends at the label */
    double zone_error_h;                       /* the file claims another zone than its clock has */
    double noise;                              /* relative, of each irradiance */
    bool is_broken;                            /* its global irradiance is another day's */
    int rows_per_hour, day_step, hours_of_day; /* 0: 1, 6, 24 */
    const char *comment;
} Made;

static uint32_t seed;

static double random_unit(void) {
    seed = seed * 1664525u + 1013904223u;
    return (double)(seed >> 8) / 16777216.0;
}

/* Irradiances at an instant under a sky of some cloudiness. */
static void light_at(const Made *made, double julian_day, double cloud, double sum[3]) {
    SkyPlace place = {made->latitude, made->longitude, 100};
    SunPosition p = sun_position(julian_day, 67, &place);
    double sine = sin(radians_from_degrees(p.elevation_deg));
    if (sine <= 0) return;
    double direct = cloud * 950 * exp(-0.2 / fmax(sine, 0.03));
    double diffuse = 30 + 250 * (1.1 - cloud) * sine;
    sum[0] += direct * sine + diffuse;
    sum[1] += direct;
    sum[2] += diffuse;
}

static double noisy(const Made *made, double value) {
    double bell = random_unit() + random_unit() + random_unit() + random_unit() - 2;
    return fmax(0, value * (1 + made->noise * bell * 1.7));
}

static void write_row(FILE *out, const Made *made, int month, int day, double label_h) {
    SkyTime midnight = {2019, month, day, 0, 0, 0, made->zone_h};
    int rows = made->rows_per_hour ? made->rows_per_hour : 1;
    int parts = made->is_means ? 12 : 1, hour = (int)ceil(label_h - 1e-9);
    double sum[3] = {0, 0, 0}, cloud = random_unit() < 0.3 ? 0.1 : 0.3 + 0.7 * random_unit();
    for (int i = 0; i < parts; i++) {
        double before = made->is_means ? -(i + 0.5) / parts / rows : made->offset_h;
        light_at(made, sky_julian_day(&midnight) + (label_h + before) / 24, cloud, sum);
    }
    double global = made->is_broken ? 900 * random_unit() * (sum[0] > 0) : sum[0] / parts;
    fprintf(out, "2019,%d,%d,%d,%d,x,10,5,80,100000,0,0,300,%.0f,%.0f,%.0f,0\n", month, day, hour,
            rows > 1 ? (int)lround((label_h - hour + 1) * 60) : 60, noisy(made, global),
            noisy(made, sum[1] / parts), noisy(made, sum[2] / parts));
}

static const char *make_file(const Made *made) {
    static const int days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    const char *name = in_folder("made.epw");
    FILE *out = fopen(name, "w");
    int rows = made->rows_per_hour ? made->rows_per_hour : 1;
    int step = made->day_step ? made->day_step : 6;
    seed = 5;
    assert_non_null(out);
    fprintf(out, "LOCATION,Made,-,X,made,1,%.4f,%.4f,%.2f,100\nCOMMENTS 1,made\n", made->latitude,
            made->longitude, made->zone_h + made->zone_error_h);
    if (made->comment) fprintf(out, "COMMENTS 2,%s\n", made->comment);
    fprintf(out, "DATA PERIODS,1,%d,Data,Sunday, 1/ 1,12/31\n", rows);
    for (int month = 1; month <= 12; month++)
        for (int day = 1; day <= days[month - 1]; day += step)
            for (int i = 1; i <= 24 * rows; i++)
                if (!made->hours_of_day || i <= made->hours_of_day)
                    write_row(out, made, month, day, (double)i / rows);
    fclose(out);
    return name;
}

static WeatherClock clock_of(const Made *made, const double *given_h, Arena *arena, Weather *w) {
    const char *name = make_file(made);
    assert_done(weather_read(name, arena, w, &err));
    unlink(name);
    return weather_clock_find(w, given_h, *arena);
}

TEST(a_file_tells_the_instants_of_its_rows) {
    static const struct {
        Made made;
        double offset_h, within_h;
        WeatherClockSource source;
    } rows[] = {
        {{"means", 48, 11, 1, .is_means = true}, -0.5, 0, WEATHER_CLOCK_MEANS},
        {{"at the label", 48, 11, 1, .offset_h = 0}, 0, 1 / 60.0, WEATHER_CLOCK_CLOSURE},
        {{"begins at the label", -34, 151, 10, .offset_h = 0.5},
         0.5,
         1 / 60.0,
         WEATHER_CLOCK_CLOSURE},
        {{"PVGIS", 45, 8, 1, .offset_h = 0.1761, .comment = "Irradiance Time Offset (h):-0.8239"},
         0.1761,
         1e-9,
         WEATHER_CLOCK_COMMENT},
        {{"PVGIS south", -33.9, 18.4, 2, .offset_h = -0.82,
          .comment = "Irradiance Time Offset (h):-0.82"},
         -0.82,
         1e-9,
         WEATHER_CLOCK_COMMENT},
        {{"a line that lies", 45, 8, 1, .offset_h = 0.1761,
          .comment = "Irradiance Time Offset (h): 0.6"},
         0.1761,
         1 / 60.0,
         WEATHER_CLOCK_CLOSURE},
        {{"half-hour zone", 28.6, 77.2, 5.5, .offset_h = -0.25},
         -0.25,
         1 / 60.0,
         WEATHER_CLOCK_CLOSURE},
        {{"quarter-hour zone, means", 27.7, 85.3, 5.75, .is_means = true},
         -0.5,
         0,
         WEATHER_CLOCK_MEANS},
        {{"polar circle", 69, 19, 1, .offset_h = 0.2}, 0.2, 1 / 60.0, WEATHER_CLOCK_CLOSURE},
        {{"equator", 0.5, -78, -5, .offset_h = 0.2}, 0.2, 1 / 60.0, WEATHER_CLOCK_CLOSURE},
        {{"noise of 5 %, means", 40, -105, -7, .is_means = true, .noise = 0.05},
         -0.5,
         0,
         WEATHER_CLOCK_MEANS},
        {{"noise of 5 %, instants", 40, -105, -7, .offset_h = 0.18, .noise = 0.05},
         0.18,
         3 / 60.0,
         WEATHER_CLOCK_CLOSURE},
        {{"a wrong zone", 40, -105, -7, .is_means = true, .zone_error_h = 7},
         6.5,
         2 / 60.0,
         WEATHER_CLOCK_CLOSURE},
        {{"quarter hours", 48, 11, 1, .is_means = true, .rows_per_hour = 4, .day_step = 16},
         -0.125,
         0,
         WEATHER_CLOCK_MEANS},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        Arena arena = test_arena(state);
        Weather w;
        WeatherClock clock = clock_of(&rows[i].made, NULL, &arena, &w);
        printf("%s: %+.4f h by %s, closes to %.2f W/m2 (as hour means %.2f) of %.0f\n",
               rows[i].made.name, clock.offset_h, weather_clock_source_text(clock.source),
               clock.closure_w_m2, clock.means_closure_w_m2, clock.mean_global_w_m2);
        assert_near(clock.offset_h, rows[i].offset_h, rows[i].within_h + 1e-9);
        assert_int_equal(clock.source, rows[i].source);
        assert_true(clock.closes && clock.rows > 150);
        assert_true(clock.closure_w_m2 <= clock.best_closure_w_m2 * 1.1 + 1.5);
        if (!rows[i].made.is_means)
            assert_true(clock.means_closure_w_m2 > 1.2 * clock.closure_w_m2);
    }
}

ARENA_TEST(a_file_that_closes_nowhere_is_told) {
    Weather w;
    Made made = {"broken", 48, 11, 1, .is_broken = true};
    WeatherClock clock = clock_of(&made, NULL, &arena, &w);
    assert_false(clock.closes);
    assert_true(clock.rows > 150 && clock.best_closure_w_m2 > 0.1 * clock.mean_global_w_m2);
    assert_int_equal(clock.source, WEATHER_CLOCK_MEANS);
    made.comment = "Irradiance Time Offset (h):-0.8239"; /* the only thing that is known */
    clock = clock_of(&made, NULL, &arena, &w);
    assert_int_equal(clock.source, WEATHER_CLOCK_COMMENT);
    assert_near(clock.offset_h, 0.1761, 1e-9);
}

ARENA_TEST(too_few_rows_tell_nothing) {
    Weather w;
    Made made = {"short", 48, 11, 1, .offset_h = -1, .day_step = 31, .hours_of_day = 7};
    WeatherClock clock = clock_of(&made, NULL, &arena, &w);
    assert_int_equal(clock.rows, 0);
    assert_near(clock.offset_h, -0.5, 0);
    assert_int_equal(clock.source, WEATHER_CLOCK_MEANS);
}

ARENA_TEST(the_users_offset_wins_and_its_closure_is_told) {
    Weather w;
    Made made = {"given", 48, 11, 1, .offset_h = 0};
    double given = -0.25;
    WeatherClock clock = clock_of(&made, &given, &arena, &w);
    assert_int_equal(clock.source, WEATHER_CLOCK_GIVEN);
    assert_near(clock.offset_h, -0.25, 0);
    assert_true(clock.closure_w_m2 > 3 * clock.best_closure_w_m2);
}

/* ---- rows of moments --------------------------------------------------------------------- */

static SkyTime moment(const char *text) {
    SkyTime time;
    assert_done(sky_time_parse(text, "", &time, &err));
    return time;
}

static const WeatherHour *row_at(const Weather *w, double offset_h, const char *when,
                                 double *apart_min) {
    WeatherClock clock = {.offset_h = offset_h};
    SkyTime time = moment(when);
    return weather_clock_row(w, &clock, &time, apart_min);
}

ARENA_TEST(the_nearest_instant_is_taken_over_days_years_and_zones) {
    Weather w;
    Made made = {"year", 48, 11, 1, .day_step = 1};
    const struct {
        const char *when;
        double offset_h;
        int month, day;
        double label_h, apart_min;
    } rows[] = {
        {"2026-06-21T13:30+02:00", -0.5, 6, 21, 13, 0},
        {"2026-06-21T12:59+02:00", -0.5, 6, 21, 12, -29},
        {"2026-06-21T12:00+01:00", -0.5, 6, 21, 13, 30}, /* an hour begins at its full clock */
        {"2026-06-21T12:00+01:00", 0.1761, 6, 21, 12, 10.566},
        {"2026-06-21T12:45+01:00", 0.1761, 6, 21, 13, 25.566},
        {"2026-06-21T23:50+01:00", -0.5, 6, 21, 24, -20},
        {"2026-06-21T23:50+01:00", 0.1761, 6, 21, 24, 20.566},
        {"2026-01-01T00:10+01:00", 0.1761, 12, 31, 24, 0.566},
        {"2026-12-31T23:59+01:00", -0.5, 12, 31, 24, -29},
        {"2024-02-29T12:30+01:00", -0.5, 2, 28, 13, 0}, /* the file has no such day */
        {"2024-03-01T12:30+01:00", -0.5, 3, 1, 13, 0},
        {"2024-12-31T12:30+01:00", -0.5, 12, 31, 13, 0},
        {"2026-06-21T23:30-11:00", -0.5, 6, 22, 12, 0},
    };
    clock_of(&made, NULL, &arena, &w);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double apart = 99;
        const WeatherHour *hour = row_at(&w, rows[i].offset_h, rows[i].when, &apart);
        assert_non_null(hour);
        assert_int_equal(hour->month, rows[i].month);
        assert_int_equal(hour->day, rows[i].day);
        assert_near(hour->label_h, rows[i].label_h, 1e-9);
        assert_near(apart, rows[i].apart_min, 1e-6);
    }
}

ARENA_TEST(a_leap_day_is_its_own) {
    static const char text[] =
        "LOCATION,Leap,-,X,made,1,48,11,1,100\nDATA PERIODS,1,1,Data,Sunday,1/1,12/31\n"
        "2016,2,28,12,60,x,10,5,80,100000,0,0,300,500,600,28,0\n"
        "2016,2,29,12,60,x,10,5,80,100000,0,0,300,500,600,29,0\n"
        "2016,3,1,12,60,x,10,5,80,100000,0,0,300,500,600,1,0\n"
        "2017,3,1,12,60,x,10,5,80,100000,0,0,300,500,600,2,0\n";
    const struct {
        const char *when;
        double diffuse; /* identifies the row */
    } rows[] = {{"2024-02-29T11:30+01:00", 29}, {"2024-02-28T11:30+01:00", 28},
                {"2025-02-28T11:30+01:00", 28}, {"2025-03-01T11:30+01:00", 1},
                {"2017-03-01T11:30+01:00", 2},  {"2016-03-01T11:30+01:00", 1}};
    Weather w;
    double apart;
    const char *name = in_folder("leap.epw");
    write_text(name, text);
    assert_done(weather_read(name, &arena, &w, &err));
    unlink(name);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const WeatherHour *hour = row_at(&w, -0.5, rows[i].when, &apart);
        assert_non_null(hour);
        assert_near(hour->diffuse_horizontal_w_m2, rows[i].diffuse, 0);
    }
    assert_null(row_at(&w, -0.5, "2025-03-02T11:30+01:00", &apart));
    assert_null(row_at(&w, -0.5, "2025-03-01T12:05+01:00", &apart));
}

/* ---- low light --------------------------------------------------------------------------- */

/* Each row that has light makes a sky at its instant and a quarter of an hour beside it. */
static void assert_all_make_skies(const Weather *w, const WeatherClock *clock, int stride) {
    for (int i = 0; i < w->count; i += stride) {
        const WeatherHour *hour = &w->hour[i];
        for (int k = -1; k <= 1 && hour->has_light && hour->diffuse_horizontal_w_m2 > 0; k++) {
            DaylightInput input = daylight_input_default(DAYLIGHT_PEREZ);
            double at = (hour->label_h + clock->offset_h) * 60 + 15 * k;
            input.has_time = true;
            input.when = (SkyTime){hour->year, hour->month, hour->day, 0, 0, at * 60, w->zone_h};
            input.where = w->place;
            input.direct_w_m2 = hour->direct_normal_w_m2;
            input.diffuse_w_m2 = hour->diffuse_horizontal_w_m2;
            SkyShape shape;
            SunPosition p = sun_position(sky_julian_day(&input.when), 67, &w->place);
            PerezInput perez = {fmin(1.569, PI / 2 - radians_from_degrees(p.elevation_deg)),
                                input.direct_w_m2, input.diffuse_w_m2, 80};
            assert_true(p.elevation_deg > -4 || k);
            assert_done(sky_shape_perez(&perez, &shape, NULL, &err));
            assert_true(shape.b <= 0 && sky_shape_integral(&shape, perez.sun_zenith, 20) > 0);
        }
    }
}

ARENA_TEST(every_lit_row_of_a_real_year_makes_a_sky) {
    Weather w;
    const char *file = SHARED_DATA_DIR "/solar/NLD_Amsterdam062400_IWEC.epw";
    if (access(file, R_OK)) {
        print_message("skipped: no shared data\n");
        skip();
    }
    assert_done(weather_read(file, &arena, &w, &err));
    WeatherClock clock = weather_clock_find(&w, NULL, arena);
    printf("Amsterdam: %+.2f h by %s, closes to %.2f W/m2 of %.0f\n", clock.offset_h,
           weather_clock_source_text(clock.source), clock.closure_w_m2, clock.mean_global_w_m2);
    assert_int_equal(clock.source, WEATHER_CLOCK_MEANS);
    assert_true(clock.closes && clock.closure_w_m2 < 1.5);
    assert_near(clock.best_offset_h, -0.5, 2 / 60.0);
    assert_all_make_skies(&w, &clock, 7);
}

ARENA_TEST(a_sun_about_to_rise_has_a_perez_sky_without_direct_light) {
    Daylight *out = arena_alloc(&arena, sizeof *out, 64, 1);
    double before = 0;
    for (int i = 0; i <= 12; i++) {
        DaylightInput input = daylight_input_default(DAYLIGHT_PEREZ);
        input.has_sun = true;
        input.sun_elevation = radians_from_degrees(-3.9 + 0.5 * i);
        input.direct_w_m2 = 40;
        input.diffuse_w_m2 = 9;
        input.integral_steps = 100; /* the shape's scale alone hangs on it, by less than 1e-3 */
        assert_done(daylight_build(&input, &arena, out, &err));
        bool is_up = -3.9 + 0.5 * i > -0.27;
        assert_int_equal(out->metrics.direct_normal_w_m2 > 0, is_up);
        assert_near(out->metrics.direct_normal_lx,
                    out->metrics.efficacy.direct * out->metrics.direct_normal_w_m2, 1e-3);
        assert_true(out->metrics.diffuse_horizontal_lx > 500 && out->shape_scale > 0);
        if (i) assert_close(out->metrics.diffuse_horizontal_lx, before, 0.1);
        before = out->metrics.diffuse_horizontal_lx;
    }
    assert_true(out->metrics.direct_normal_lx > 100); /* 2 degrees up */
}

TEST_PROGRAM(make_folder, remove_folder)
