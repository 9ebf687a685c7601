/* SPDX-License-Identifier: Apache-2.0 */
/* Perez 1990's luminous efficacies: each coefficient as it is published, what skies make of
 * them, and the lux that a weather file holds itself. */
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

#include "base/units.h"
#include "sky/weather_light.h"

/* The published table: by column, the eight ranges of clearness after each other. */
static const double published[3][4][8] = {
    {{57.20, 98.99, 109.83, 110.34, 106.36, 107.19, 105.75, 101.18},
     {-4.55, -3.46, -4.90, -5.84, -3.97, -1.25, 0.77, 1.58},
     {-2.98, -1.21, -1.71, -1.99, -1.75, -1.51, -1.26, -1.10},
     {117.12, 12.38, -8.81, -4.56, -6.16, -26.73, -34.44, -8.29}},
    {{97.24, 107.22, 104.97, 102.39, 100.71, 106.42, 141.88, 152.23},
     {-0.46, 1.15, 2.96, 5.59, 5.94, 3.83, 1.90, 0.35},
     {12.00, 0.59, -5.53, -13.95, -22.75, -36.15, -53.24, -45.27},
     {-8.91, -3.95, -8.77, -13.90, -23.74, -28.83, -14.03, -7.98}},
    {{96.63, 107.54, 98.73, 92.72, 86.73, 88.34, 78.63, 99.65},
     {-0.47, 0.79, 0.70, 0.56, 0.98, 1.39, 1.47, 1.86},
     {11.50, 1.79, 4.40, 8.36, 7.10, 6.06, 4.93, -4.46},
     {-9.16, -1.19, -6.95, -8.31, -10.94, -7.60, -11.37, -3.15}}};

static double efficacy(int kind, int bin, double brightness, double zenith, double water) {
    PerezState state = {.brightness = brightness, .bin = bin + 1};
    LuminousEfficacy e = luminous_efficacy(&state, zenith, water);
    return kind == 0 ? e.direct : kind == 1 ? e.diffuse : e.global;
}

/* From five values of the function, each coefficient by differences: that of water, of the
 * zenith angle's term, of the brightness's, and what is left. */
TEST(every_coefficient_is_the_published_one) {
    const double z = 0.3, far = 0.9, delta = 0.2, more = 0.4, water = 1;
    for (int kind = 0; kind < 3; kind++)
        for (int bin = 0; bin < 8; bin++) {
            double at = efficacy(kind, bin, delta, z, water);
            double near_term = kind ? cos(z) : exp(5.73 * z - 5);
            double far_term = kind ? cos(far) : exp(5.73 * far - 5);
            double low = kind ? log(delta) : delta, high = kind ? log(more) : more;
            double b = efficacy(kind, bin, delta, z, water + 1) - at;
            double c = (efficacy(kind, bin, delta, far, water) - at) / (far_term - near_term);
            double d = (efficacy(kind, bin, more, z, water) - at) / (high - low);
            const double found[4] = {at - b * water - c * near_term - d * low, b, c, d};
            for (int k = 0; k < 4; k++) assert_near(found[k], published[kind][k][bin], 1e-9);
        }
}

TEST(a_sun_at_the_horizon_has_no_direct_light_rather_than_less) {
    for (int bin = 0; bin < 8; bin++)
        for (double z = 0; z < 1.57; z += 0.05) assert_true(efficacy(0, bin, 0.01, z, 8) >= 0);
    assert_near(efficacy(0, 0, 0.2, 1.56, 2), 0, 0);
}

TEST(water_follows_the_dew_point) {
    assert_close(water_from_dew_point_cm(10.97), WATER_USUAL_CM, 5e-4);
    assert_near(water_from_dew_point_cm(0), 0.927743, 1e-6);
    assert_near(water_from_dew_point_cm(24), 4.978, 1e-3);
}

/* ---- skies ------------------------------------------------------------------------------- */

static DaylightInput sky_of(double elevation_deg, int month, int day, double direct,
                            double diffuse) {
    DaylightInput in = daylight_input_default(DAYLIGHT_PEREZ);
    in.has_time = in.has_sun = true;
    in.when = (SkyTime){2023, month, day, 12, 0, 0, 0};
    in.sun_elevation = radians_from_degrees(elevation_deg);
    in.sun_azimuth = 3;
    in.direct_w_m2 = direct;
    in.diffuse_w_m2 = diffuse;
    in.integral_steps = 100;
    return in;
}

/* Radiance's gendaylit for rows of a weather file: lm/W of what its sky sends, the diffuse
 * light by its own sum over the sky. */
ARENA_TEST(skies_have_the_lux_of_gendaylits) {
    FILE *file = fopen(SHARED_DATA_DIR "/cases/sky/perez.csv", "r");
    char line[400], name[40];
    int rows = 0, month, day;
    if (!file) {
        print_message("skipped: no shared data\n");
        skip();
    }
    assert_non_null(fgets(line, sizeof line, file));
    for (; fgets(line, sizeof line, file); rows++) {
        double v[10] = {0}, direct = 0, diffuse;
        Daylight out;
        assert_int_equal(sscanf(line, "%39[^,],%lf,%lf,%lf,%d,%d,%lf,%lf,%lf,%lf,%lf", name, &v[0],
                                &v[1], &v[2], &month, &day, &v[3], &v[4], &v[5], &v[6], &v[7]),
                         11);
        const char *last = strrchr(line, ',');
        const char *before = last - 1;
        while (*before != ',') before--;
        diffuse = strtod(last + 1, NULL);
        direct = strtod(before + 1, NULL); /* empty: 0 */
        DaylightInput in = sky_of(v[4], month, day, v[6], v[7]);
        in.water_cm = water_from_dew_point_cm(v[5]);
        assert_done(daylight_build(&in, &arena, &out, &err));
        const DaylightMetrics *f = &out.metrics;
        printf("%-16s diffuse %.2f lm/W (%.1f), direct %.2f (%.1f)\n", name,
               f->diffuse_horizontal_lx / v[7], diffuse, v[6] > 0 ? f->efficacy.direct : 0, direct);
        assert_close(f->diffuse_horizontal_lx / v[7], diffuse, 0.03);
        if (v[6] > 0) assert_close(f->direct_normal_lx / v[6], direct, 0.01);
        assert_near(f->direct_normal_w_m2, v[6], 1e-9);
        assert_near(f->diffuse_horizontal_w_m2, v[7], 1e-9);
    }
    fclose(file);
    assert_int_equal(rows, 5);
}

/* The colour is the air's and does not hang on the watts; the lux do. */
ARENA_TEST(spectra_keep_the_colour_alone) {
    Daylight one, two;
    DaylightInput in = sky_of(35, 6, 21, 400, 100);
    assert_done(daylight_build(&in, &arena, &one, &err));
    in.has_lux = true;
    in.direct_lux = 12345;
    in.diffuse_lux = 6789;
    assert_done(daylight_build(&in, &arena, &two, &err));
    assert_close(two.metrics.direct_normal_lx, 12345, 1e-6);
    assert_close(two.metrics.diffuse_horizontal_lx, 6789, 1e-6);
    assert_close(two.metrics.efficacy.direct, 12345 / 400.0, 1e-9);
    for (int i = 0; i < 2; i++) {
        assert_near(one.metrics.sun_xy[i], two.metrics.sun_xy[i], 1e-6);
        assert_near(one.metrics.zenith_xy[i], two.metrics.zenith_xy[i], 1e-6);
    }
}

/* ---- a weather file's rows --------------------------------------------------------------- */

static WeatherHour row(double direct, double diffuse, double direct_lx, double diffuse_lx) {
    return (WeatherHour){.has_light = true,
                         .has_dew_point = true,
                         .dew_point_c = 3,
                         .direct_normal_w_m2 = direct,
                         .diffuse_horizontal_w_m2 = diffuse,
                         .direct_normal_lx = direct_lx,
                         .diffuse_horizontal_lx = diffuse_lx};
}

TEST(what_a_row_lacks_is_its_state) {
    static const struct {
        double direct, diffuse, direct_lx, diffuse_lx;
        WeatherRowState perez, file;
    } rows[] = {
        {300, 100, 28000, 12000, WEATHER_ROW_LIT, WEATHER_ROW_LIT},
        {0, 100, 0, 12000, WEATHER_ROW_LIT, WEATHER_ROW_LIT},
        {8, 3, 0, 400, WEATHER_ROW_LIT, WEATHER_ROW_LIT}, /* a sun at the horizon */
        {0, 0, 0, 0, WEATHER_ROW_DARK, WEATHER_ROW_DARK},
        {0, 0, -1, -1, WEATHER_ROW_DARK, WEATHER_ROW_DARK},
        {300, 0, 28000, 0, WEATHER_ROW_WITHOUT_SKY, WEATHER_ROW_WITHOUT_SKY},
        {300, 100, -1, 12000, WEATHER_ROW_LIT, WEATHER_ROW_WITHOUT_LUX},
        {300, 100, 28000, -1, WEATHER_ROW_LIT, WEATHER_ROW_WITHOUT_LUX},
        {300, 100, 0, 0, WEATHER_ROW_LIT, WEATHER_ROW_WITHOUT_LUX},
        {0, 1, 0, 0, WEATHER_ROW_LIT, WEATHER_ROW_WITHOUT_LUX},
        {300, 100, 28, 12, WEATHER_ROW_LIT, WEATHER_ROW_WITHOUT_LUX}, /* klx */
        {300, 100, 28000, 36000, WEATHER_ROW_LIT, WEATHER_ROW_WITHOUT_LUX},
        {2500, 91.8, 0, 0, WEATHER_ROW_TOO_BRIGHT, WEATHER_ROW_TOO_BRIGHT},
        {1300, 100, 150000, 12000, WEATHER_ROW_LIT, WEATHER_ROW_TOO_BRIGHT},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        WeatherHour hour =
            row(rows[i].direct, rows[i].diffuse, rows[i].direct_lx, rows[i].diffuse_lx);
        assert_int_equal(weather_row_state(&hour, WEATHER_LUX_PEREZ), rows[i].perez);
        assert_int_equal(weather_row_state(&hour, WEATHER_LUX_FILE), rows[i].file);
        hour.has_light = false;
        assert_int_equal(weather_row_state(&hour, WEATHER_LUX_PEREZ), WEATHER_ROW_WITHOUT_VALUES);
    }
}

ARENA_TEST(a_row_becomes_a_sky_by_either_rule) {
    WeatherHour hour = row(300, 100, 28000, 12000);
    DaylightInput in = daylight_input_default(DAYLIGHT_PEREZ);
    weather_light_take(&hour, WEATHER_LUX_PEREZ, &in);
    assert_true(!in.has_lux && in.water_source == WATER_DEW_POINT);
    assert_near(in.water_cm, exp(0.07 * 3 - 0.075), 1e-12);
    assert_string_equal(weather_light_rule_text(&in, &arena),
                        "Perez 1990's luminous efficacies, 1.14 cm of water (dew point)");
    hour.has_dew_point = false;
    weather_light_take(&hour, WEATHER_LUX_PEREZ, &in);
    assert_near(in.water_cm, 2, 0);
    assert_string_equal(weather_light_rule_text(&in, &arena),
                        "Perez 1990's luminous efficacies, 2.00 cm of water (assumed)");
    weather_light_take(&hour, WEATHER_LUX_FILE, &in);
    assert_true(in.has_lux);
    assert_near(in.direct_lux, 28000, 0);
    assert_near(in.diffuse_lux, 12000, 0);
    assert_string_equal(weather_light_rule_text(&in, &arena), "the file's own lux columns");
}

/* A real file's own lux columns, which its makers had of the same publication: whole hundreds
 * of lux. Instants of low suns are left out: theirs are another. */
ARENA_TEST(a_real_years_own_lux_are_these) {
    Weather w;
    double own[2] = {0, 0}, ours[2] = {0, 0}, apart[2] = {0, 0};
    int rows = 0;
    const char *file = SHARED_DATA_DIR "/solar/NLD_Amsterdam062400_IWEC.epw";
    if (access(file, R_OK)) {
        print_message("skipped: no shared data\n");
        skip();
    }
    assert_done(weather_read(file, &arena, &w, &err));
    for (int i = 0; i < w.count; i += 3) {
        const WeatherHour *hour = &w.hour[i];
        Daylight sky;
        DaylightInput in = daylight_input_default(DAYLIGHT_PEREZ);
        if (weather_row_state(hour, WEATHER_LUX_FILE) != WEATHER_ROW_LIT) continue;
        weather_light_take(hour, WEATHER_LUX_PEREZ, &in);
        in.has_time = true;
        in.when = (SkyTime){hour->year, hour->month, hour->day, 0, 60 * (hour->label_h - 0.5),
                            0,          w.zone_h};
        in.where = w.place;
        in.integral_steps = 8;
        if (!daylight_build(&in, &arena, &sky, why()) || sky.metrics.sun_elevation_deg < 5)
            continue;
        double mine[2] = {sky.metrics.direct_normal_lx, sky.metrics.diffuse_horizontal_lx};
        double files[2] = {hour->direct_normal_lx, hour->diffuse_horizontal_lx};
        for (int k = 0; k < 2; k++) {
            own[k] += files[k];
            ours[k] += mine[k];
            apart[k] += fabs(files[k] - mine[k]);
        }
        rows++;
    }
    for (int k = 0; k < 2; k++)
        printf("%s: %d rows, %.2f %% brighter than the file's lux, %.2f %% apart in the mean\n",
               k ? "diffuse" : "direct", rows, 100 * (ours[k] / own[k] - 1),
               100 * apart[k] / own[k]);
    assert_true(rows > 1000);
    for (int k = 0; k < 2; k++) {
        assert_close(ours[k], own[k], 0.01);
        assert_true(apart[k] < 0.02 * own[k]);
    }
}

TEST_PROGRAM(make_folder, remove_folder)
