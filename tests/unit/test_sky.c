/* SPDX-License-Identifier: Apache-2.0 */
/* Sun position, the sun's spectrum, sky shapes, weather files. */
#include "sky_fixture.h"
#include "sky/epw.h"
#include "sky/sky_shape.h"
#include "sky/air/spectrl2.h"
#include "sky/sun_disc.h"
#include "sky/sun_position.h"
#include "spectrum/spectral_table.h"

/* ---- position --------------------------------------------------------------------------- */

TEST(the_published_example_holds_at_every_step) {
    SkyTime time = moment("2003-10-17T12:30:30-07:00");
    SkyPlace place = {39.742476, -105.1786, 1830.14};
    SunPosition p = sun_position(sky_julian_day(&time), 67, &place);
    const double steps[][3] = {
        /* ours, the report's, half a unit of its last digit */
        {p.julian_day, 2452930.312847, 5e-7},
        {p.julian_century, 0.0379277986858, 1e-11},
        {p.ephemeris_day, 2452930.313623, 5e-7},
        {p.ephemeris_century, 0.037927819916852, 1e-11},
        {p.ephemeris_millennium, 0.003792781991685, 1e-12},
        {p.heliocentric_longitude_deg, 24.0182616917, 5e-10},
        {p.heliocentric_latitude_deg, -0.0001011219, 5e-11},
        {p.distance_au, 0.9965422974, 5e-11},
        {p.geocentric_longitude_deg, 204.0182616917, 5e-10},
        {p.geocentric_latitude_deg, 0.0001011219, 5e-11},
        {p.nutation_argument_deg[0], 17185.861179, 5e-6},
        {p.nutation_argument_deg[1], 1722.893218, 5e-7},
        {p.nutation_argument_deg[2], 18234.075703, 5e-6},
        {p.nutation_argument_deg[3], 18420.071012, 5e-6},
        {p.nutation_argument_deg[4], 51.686951, 5e-7},
        {p.nutation_longitude_deg, -0.00399840, 5e-9},
        {p.nutation_obliquity_deg, 0.00166657, 5e-9},
        {p.mean_obliquity_arcsec, 84379.672625, 5e-7},
        {p.obliquity_deg, 23.440465, 5e-7},
        {p.aberration_deg, -0.005711, 5e-7},
        {p.apparent_longitude_deg, 204.0085519281, 5e-10},
        {p.mean_sidereal_deg, 318.515579, 2e-6},
        {p.apparent_sidereal_deg, 318.511910, 2e-6},
        {p.right_ascension_deg, 202.227408, 5e-7},
        {p.declination_deg, -9.31434, 5e-6},
        {p.hour_angle_deg, 11.10590, 5e-6},
        {p.parallax_deg, 0.002451, 5e-7},
        {p.parallax_right_ascension_deg, -0.000369, 5e-7},
        {p.topocentric_right_ascension_deg, 202.22704, 5e-6},
        {p.topocentric_declination_deg, -9.316179, 5e-7},
        {p.topocentric_hour_angle_deg, 11.10627, 5e-6},
        {p.elevation_deg, 39.872046, 5e-7},
        {p.azimuth_deg, 194.340241, 5e-7},
        {sun_refraction_deg(p.elevation_deg, 820, 11), 0.016332, 5e-7},
        {90 - p.elevation_deg - sun_refraction_deg(p.elevation_deg, 820, 11), 50.11162, 5e-6}};
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++)
        assert_near(steps[i][0], steps[i][1], steps[i][2] * 1.02);
}

TEST(other_places_and_seasons_agree_with_spa) {
    const struct {
        const char *when;
        double latitude, zenith, apparent, azimuth;
    } rows[] = {{"2020-10-17T12:30Z", 45, 57.782913, 57.756323, 204.918816},
                {"2020-02-29T12:30Z", 45, 54.243379, 54.220078, 197.670100},
                {"2020-10-17T12:30Z", 0, 23.143171, 23.135982, 245.090653},
                {"2020-10-17T12:30Z", -45, 39.893464, 39.879401, 326.234467},
                {"2020-10-17T05:50Z", 45, 88.892268, 88.541525, 104.539898}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        SkyTime time = moment(rows[i].when);
        SkyPlace place = {rows[i].latitude, 10, 0};
        SunPosition p = sun_position(sky_julian_day(&time), 67, &place);
        double lift = sun_refraction_deg(p.elevation_deg, 1013.25, 12);
        assert_near(90 - p.elevation_deg, rows[i].zenith, 6e-7);
        assert_near(90 - p.elevation_deg - lift, rows[i].apparent, 6e-7);
        assert_near(p.azimuth_deg, rows[i].azimuth, 6e-7);
    }
}

/* PSA's algorithm with its coefficients of 2020 (Blanco, Milidonis and Bonanos 2020): unit
 * vector east, north, up. */
static void psa_vector(const SkyTime *t, const SkyPlace *place, double out[3]) {
    double n = sky_julian_day(t) - 2451545.0;
    double hours = t->hour - t->zone_h + (t->minute + t->second / 60) / 60;
    double om = 2.267127827 - 9.300339267e-4 * n, l = 4.895036035 + 1.720279602e-2 * n;
    double g = 6.239468336 + 1.720200135e-2 * n;
    double le = l + 3.338320972e-2 * sin(g) + 3.497596876e-4 * sin(2 * g) - 1.544353226e-4 -
                8.689729360e-6 * sin(om);
    double ep = 4.090904909e-1 - 6.213605399e-9 * n + 4.418094944e-5 * cos(om);
    double ra = atan2(cos(ep) * sin(le), cos(le)), d = asin(sin(ep) * sin(le));
    double sidereal = 6.697096103 + 6.570984737e-2 * n + hours;
    double w = radians_from_degrees(15 * sidereal + place->longitude_deg) - ra;
    double lat = radians_from_degrees(place->latitude_deg);
    double z = acos(cos(lat) * cos(w) * cos(d) + sin(d) * sin(lat));
    double az = atan2(-sin(w), tan(d) * cos(lat) - sin(lat) * cos(w));
    z += 6371.01 / 149597890 * sin(z);
    out[0] = sin(z) * sin(az), out[1] = sin(z) * cos(az), out[2] = cos(z);
}

TEST(an_independent_algorithm_agrees_at_10000_times_and_places) {
    double most = 0;
    for (int i = 0; i < 10000; i++) {
        SkyTime t = {2020 + (int)(random_unit() * 30),
                     1 + (int)(random_unit() * 12),
                     1 + (int)(random_unit() * 28),
                     (int)(random_unit() * 24),
                     (int)(random_unit() * 60),
                     0,
                     0};
        SkyPlace place = {asin(2 * random_unit() - 1) * 180 / PI, 360 * random_unit() - 180, 0};
        double day = sky_julian_day(&t), other[3];
        SunPosition p = sun_position(day, sky_delta_t_s(day), &place);
        double e = radians_from_degrees(p.elevation_deg), a = radians_from_degrees(p.azimuth_deg);
        psa_vector(&t, &place, other);
        double dx = cos(e) * sin(a) - other[0], dy = cos(e) * cos(a) - other[1];
        double dz = sin(e) - other[2];
        most = fmax(most, sqrt(dx * dx + dy * dy + dz * dz) * 180 / PI);
    }
    printf("SPA against PSA-2020, 10,000 times and places: at most %.4f degrees\n", most);
    assert_in(most, 1e-4, 0.01);
}

TEST(the_date_line_and_the_poles_are_no_seams) {
    SkyTime time = moment("2024-02-29T23:59:59.5+14:00");
    double day = sky_julian_day(&time);
    SkyPlace west = {20, -180, 0}, east = {20, 180, 0};
    SunPosition a = sun_position(day, 69, &west), b = sun_position(day, 69, &east);
    assert_near(a.elevation_deg, b.elevation_deg, 1e-9);
    assert_near(a.azimuth_deg, b.azimuth_deg, 1e-9);
    for (int pole = -1; pole <= 1; pole += 2) {
        SkyPlace place = {90 * pole, 33, 0};
        SunPosition p = sun_position(day, 69, &place);
        assert_near(p.elevation_deg, pole * p.declination_deg, 3e-3); /* parallax */
    }
}

TEST(refraction_is_smooth_below_the_horizon_too) {
    double before = sun_refraction_deg(-8, 1013.25, 15);
    assert_near(sun_refraction_deg(0, 1010, 10), 1.02 / 60 / tan(10.3 / 5.11 * PI / 180), 1e-6);
    for (double e = -8; e < 90; e += 0.01) {
        double now = sun_refraction_deg(e, 1013.25, 15);
        assert_true(now >= 0 && now < 1 && fabs(now - before) < 0.01);
        before = now;
    }
}

TEST(a_moment_needs_its_zone_and_real_dates) {
    static const char *const wrong[] = {"",
                                        "2026-06-21",
                                        "2026-06-21T08:30",
                                        "2026-02-29T08:30Z",
                                        "2026-13-01T00:00Z",
                                        "2026-06-21T24:00Z",
                                        "2026-06-21T08:61Z",
                                        "2026-06-21 08:30Z",
                                        "2026-06-21T08:30+25:00",
                                        "2026-06-21T08:30Zx",
                                        "noon"};
    SkyTime time;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_fails_as(sky_time_parse(wrong[i], "lights.gltf", &time, &err), ERROR_INPUT,
                        "2026-06-21T08:30+02:00");
    }
    assert_near(moment("2026-06-21T08:30:15.5-03:30").zone_h, -3.5, 1e-12);
    SkyTime a = moment("2026-06-21T00:30+02:00"), b = moment("2026-06-20T22:30Z");
    assert_near(sky_julian_day(&a), sky_julian_day(&b), 1e-9);
}

TEST(the_horizon_dips_and_the_air_thins_with_altitude) {
    double pressure, celsius;
    standard_atmosphere(10668, &pressure, &celsius);
    assert_near(pressure, 238.42, 0.02);
    assert_near(celsius, -54.3, 0.05);
    standard_atmosphere(12497, &pressure, &celsius);
    assert_near(pressure, 178.74, 0.05);
    assert_near(horizon_dip_deg(10668), 3.31, 0.005);
    assert_near(horizon_dip_deg(12497), 3.59, 0.005);
}

/* ---- spectra ----------------------------------------------------------------------------- */

TEST(spectrl2_is_the_published_program) {
    const Air air = {1013, 1.42, 0.344, 0.1, 1.14, 0.2};
    double b = 2 * PI * 74 / 365, most = 0, nm, diffuse, direct, outside;
    double factor = 1.00011 + 0.034221 * cos(b) + 0.00128 * sin(b) + 0.000719 * cos(2 * b) +
                    0.000077 * sin(2 * b);
    Spectrl2 s = spectrl2(&air, 47.912086486816406, factor);
    assert_near(air_mass(47.912086486816406), 1.4899535986910446, 1e-12);
    assert_near(spectrl2_read(s.direct, 550), 1.38386, 5e-6);
    assert_near(spectrl2_read(s.diffuse, 400), 0.27464, 5e-6);
    FILE *file = fopen(SHARED_DATA_DIR "/solar/spectrl2_example_spectra.csv", "r");
    if (!file) {
        print_message("skipped the whole table: no shared data\n");
        return;
    }
    char line[400];
    int row, rows = 0;
    assert_non_null(fgets(line, sizeof line, file));
    for (; fgets(line, sizeof line, file); rows++) {
        assert_int_equal(sscanf(line, "%d,%lf,%lf,%lf,%lf", &row, &nm, &diffuse, &direct, &outside),
                         5);
        assert_near(spectrl2_nm(rows), 1000 * nm, 1e-3); /* micrometres there */
        most = fmax(most, fabs(s.diffuse[rows] - diffuse / 1000));
        most = fmax(most, fabs(s.direct[rows] - direct / 1000));
        most = fmax(most, fabs(s.outside[rows] - outside / 1000));
    }
    fclose(file);
    printf("SPECTRL2 against the published values: at most %.2g W m^-2 nm^-1\n", most);
    assert_int_equal(rows, SPECTRL2_COUNT);
    assert_in(most, 1e-12, 1e-6);
}

static double illuminance(const double *rows) {
    double sum = 0;
    for (int i = 0; i < SPECTRAL_COUNT; i++)
        sum += 683.002 * (double)spectral_table[i].y * spectrl2_read(rows, SPECTRAL_FIRST_NM + i);
    return sum;
}

TEST(the_direct_beam_is_that_of_astm_g173_within_2_percent) {
    const Air air = {1013.25, 1.4164, 0.3438, 0.084, 1.14, 0.2};
    Spectrl2 s = spectrl2(&air, 48.2, 1);
    printf("direct normal: %.1f W/m2 and %.0f lx (G173: 900.1 and 97143)\n",
           spectrl2_total(s.direct), illuminance(s.direct));
    assert_close(spectrl2_total(s.direct), 900.14, 0.02);
    assert_close(illuminance(s.direct), 97143, 0.02);
}

/* Radiance over the disc's mean at mu = sqrt(1 - (sin gamma / sin r)^2). */
static double sun_limb_value(const double coefficient[6], double mu) {
    double value = 0;
    for (int k = 5; k >= 0; k--) value = value * mu + coefficient[k];
    return fmax(0, value);
}

TEST(limb_darkening_keeps_the_irradiance) {
    for (int nm = 300; nm <= 900; nm += 13) {
        double c[6], flux = 0, weight = 0;
        sun_limb(nm, c);
        for (int i = 0; i < 2000; i++) {
            double r = (i + 0.5) / 2000;
            flux += r * sun_limb_value(c, sqrt(1 - r * r));
            weight += r;
        }
        assert_close(flux / weight, 1, 2e-5);
        assert_true(sun_limb_value(c, 1) > 1.1 && sun_limb_value(c, 0.05) < 0.6);
    }
    assert_near(degrees_from_radians(sun_angular_radius(1)), 0.26645, 5e-6);
}

/* ---- shapes ------------------------------------------------------------------------------ */

TEST(the_cie_skies_have_their_known_illuminance_over_zenith_luminance) {
    static const double known[16] = {2.44954, 2.08602, 2.76999, 2.31542, 3.14159, 2.58416,
                                     2.42123, 2.32838, 3.45932, 3.17026, 2.98906, 3.19057,
                                     3.02586, 3.21696, 3.01586, 2.44346};
    for (int type = 1; type <= 16; type++) {
        SkyShape shape = sky_shape_cie(type);
        double zenith = sky_shape_value(&shape, 1, PI / 6);
        assert_close(sky_shape_integral(&shape, PI / 6, 600) / zenith, known[type - 1], 5e-4);
    }
}

TEST(perez_makes_the_known_skies) {
    static const double in[4][4] = {
        {45, 100, 800, 172}, {60, 150, 400, 80}, {45, 250, 0, 80}, {60, 300, 50, 80}};
    static const double known[4][11] = {{1.411923, 0.106762, 6.317959, 8, -0.951719, -0.150927,
                                         19.394149, -5.435566, 1.240755, 0.343562, 1.852569},
                                        {1.992764, 0.216951, 2.214625, 5, -0.987590, -0.468529,
                                         12.972326, -3.267055, 0.039785, 0.547479, 3.426400},
                                        {1.411923, 0.256192, 1, 1, 0.792204, -0.465025, 1.233846,
                                         -0.788518, -0.008786, 2.485732, 6.872419},
                                        {1.992764, 0.433902, 1.075914, 2, -0.916954, -1.448707,
                                         9.902142, -2.835673, 0.043045, 1.191873, 5.464208}};
    for (int i = 0; i < 4; i++) {
        PerezInput input = {radians_from_degrees(in[i][0]), in[i][2], in[i][1], (int)in[i][3]};
        SkyShape s;
        PerezState p;
        assert_done(sky_shape_perez(&input, &s, &p, &err));
        const double ours[11] = {p.air_mass,
                                 p.brightness,
                                 p.clearness,
                                 p.bin,
                                 s.a,
                                 s.b,
                                 s.c,
                                 s.d,
                                 s.e,
                                 sky_shape_value(&s, 1, input.sun_zenith),
                                 sky_shape_integral(&s, input.sun_zenith, 1000)};
        for (int k = 0; k < 10; k++) assert_near(ours[k], known[i][k], 6e-7);
        assert_close(ours[10], known[i][10], 1e-5);
    }
}

TEST(the_quick_form_of_a_shape_is_the_same) {
    for (int type = 1; type <= 16; type++) {
        SkyShape shape = sky_shape_cie(type);
        for (float c = 0.01f; c <= 1; c += 0.07f)
            for (float gamma = 0; gamma < 3.1f; gamma += 0.2f)
                assert_near(sky_shape_at(&shape, c, gamma),
                            sky_shape_value(&shape, (double)c, (double)gamma), 1e-4);
    }
}

TEST(irradiances_without_a_sky_are_refused) {
    PerezInput input = {0.5, 100, 0, 80};
    SkyShape shape;
    assert_fails_as(sky_shape_perez(&input, &shape, NULL, &err), ERROR_INPUT, "above 0");
}

/* ---- weather ----------------------------------------------------------------------------- */

static const char weather_text[] =
    "LOCATION,Testville,-,NLD,Data,062400,52.30,4.77,1.0,-2.0\r\n"
    "COMMENTS 1,none\r\nDATA PERIODS,1,1,Data,Sunday, 6/ 1,6/30\r\n"
    "1995,6,21,12,60,x,20.1,11.8,79,100100,0,1415,288,500,410.5,210,0,0,0,0,180,3,5,5,20,"
    "77777,9,999999999,23,0.12\r\n"
    "1995,6,21,13,60,x,21.1,11.8,79,100100,0,1415,288,500,9999,9999,0,0,0,0,180,3,5,5,20,"
    "77777,9,999999999,23,0.12\r\n";

ARENA_TEST(a_weather_file_tells_place_and_hours) {
    const char *name = in_folder("weather.epw");
    write_text(name, weather_text);
    Weather w;
    assert_done(weather_read(name, &arena, &w, &err));
    unlink(name);
    assert_string_equal(w.city, "Testville");
    assert_near(w.place.latitude_deg, 52.3, 1e-9);
    assert_int_equal(w.count, 2);
    assert_int_equal(w.hour[1].line, 5);
    assert_near(w.hour[0].label_h, 12, 0);
    assert_near(w.hour[0].direct_normal_w_m2, 410.5, 1e-9);
    assert_near(w.hour[0].global_horizontal_w_m2, 500, 1e-9);
    assert_near(w.hour[0].diffuse_horizontal_w_m2, 210, 1e-9);
    assert_false(w.hour[1].has_light || w.has_comment_offset);
}

ARENA_TEST(every_prefix_of_a_weather_file_is_read_or_refused_by_line) {
    for (size_t n = 0; n < sizeof weather_text - 1; n++) {
        char text[sizeof weather_text];
        Arena scratch = arena;
        Weather w;
        memcpy(text, weather_text, n);
        text[n] = 0;
        const char *name = in_folder("weather.epw");
        write_text(name, text);
        if (!weather_read(name, &scratch, &w, why()))
            assert_true(why()->code == ERROR_INPUT && strstr(why()->text, "required"));
        unlink(name);
    }
}

ARENA_TEST(a_real_year_has_8760_hours) {
    Weather w;
    double direct = 0;
    if (access(SHARED_DATA_DIR "/solar/NLD_Amsterdam062400_IWEC.epw", R_OK)) {
        print_message("skipped: no shared data\n");
        skip();
    }
    assert_done(
        weather_read(SHARED_DATA_DIR "/solar/NLD_Amsterdam062400_IWEC.epw", &arena, &w, &err));
    assert_int_equal(w.count, 8760);
    for (int i = 0; i < w.count; i++) direct += w.hour[i].direct_normal_w_m2;
    assert_in(direct / 1000, 500, 1500); /* kWh m^-2 of a northern year */
}

TEST_PROGRAM(make_folder, remove_folder)
