/* SPDX-License-Identifier: Apache-2.0 */
/* test_review_route.c -- routes: the same from GPX and CSV, headings of great circles, times
 * that move; levels that follow the light. */
#include "fixture.h"

#include "review/request/request.h"
#include "review/route/route.h"

static bool read_route(const char *text, Arena *arena, Route *out, Error *err)
{
    const char *file = in_folder("route");
    write_text(file, text);
    return route_read(file, arena, out, err);
}

static Route must_read(const char *text, Arena *arena)
{
    Route route = {0};
    assert_done(read_route(text, arena, &route, &err));
    return route;
}

/* ---- bearings ---------------------------------------------------------------------------- */

static double bearing(double lat0, double lon0, double lat1, double lon1)
{
    SkyPlace from = {lat0, lon0, 0}, to = {lat1, lon1, 0};
    return route_bearing_deg(&from, &to);
}

TEST(bearings_are_those_of_great_circles)
{
    assert_near(bearing(0, 0, 1, 0), 0, 1e-12);
    assert_near(bearing(0, 0, 0, 1), 90, 1e-12);
    assert_near(bearing(1, 0, 0, 0), 180, 1e-12);
    assert_near(bearing(0, 0, 0, -1), 270, 1e-12);
    assert_near(bearing(0, 179.5, 0, -179.5), 90, 1e-9); /* over the date line */
    /* To the pole everything goes north, over it along the meridian. */
    assert_near(bearing(60, 10, 90, 123), 0, 1e-9);
    assert_near(bearing(80, 0, 80, 180), 0, 1e-9);
    /* A right spherical triangle on the equator: tan A = tan a / sin b. */
    double right = atan(sin(30 * M_PI / 180) / tan(20 * M_PI / 180)) * 180 / M_PI;
    assert_near(bearing(0, 0, 20, 30), right, 1e-9);
}

/* There and back differ by half a turn and the meridians' convergence, which is small. */
TEST(there_and_back_are_opposite)
{
    for (int i = 0; i < 36; i++) {
        double turn = i * M_PI / 18, lat = 48 + 1e-3 * cos(turn), lon = 11 + 1e-3 * sin(turn);
        double apart = bearing(48, 11, lat, lon) - bearing(lat, lon, 48, 11);
        assert_near(fabs(remainder(apart, 360)), 180, 1e-3);
    }
}

/* ---- the two formats --------------------------------------------------------------------- */

#define GPX(points)                                                                            \
    "<?xml version='1.0' encoding='UTF-8'?>\n<gpx version='1.1' "                              \
    "xmlns='urn:gpx'>\n<trk><trkseg>\n" points "</trkseg></trk>\n</gpx>\n"
#define POINT(lat, lon, more) "<trkpt lat='" lat "' lon='" lon "'>" more "</trkpt>\n"

static const char gpx_text[] =
    GPX(POINT("48", "11", "<ele>520.5</ele><time>2026-06-21T06:00:00Z</time>")
        POINT("48.001", "11", "<ele>521</ele><time>2026-06-21T06:00:10Z</time>")
        "</trkseg><trkseg>" POINT("48.001", "11.001", "<time>2026-06-21T06:00:30.5Z</time>"));

static const char csv_text[] =
    "\xEF\xBB\xBFlat,lon,time,altitude_m\n# a comment\n48,11,2026-06-21T06:00:00Z,520.5\n\n"
    "48.001 , 11,2026-06-21T08:00:10+02:00,521\r\n48.001,11.001,2026-06-21T06:00:30.5Z,\n";

ARENA_TEST(gpx_and_csv_are_the_same_route)
{
    Route a = must_read(gpx_text, &arena), b = must_read(csv_text, &arena);
    assert_int_equal(a.count, 3);
    assert_int_equal(b.count, 3);
    for (int i = 0; i < 3; i++) {
        assert_near(a.points[i].seconds, b.points[i].seconds, 0);
        assert_near(a.points[i].where.latitude_deg, b.points[i].where.latitude_deg, 0);
        assert_near(a.points[i].where.longitude_deg, b.points[i].where.longitude_deg, 0);
        assert_near(a.points[i].where.altitude_m, b.points[i].where.altitude_m, 0);
        assert_near(a.points[i].heading_deg, b.points[i].heading_deg, 0);
    }
    assert_near(a.points[1].seconds, 10, 0);
    assert_near(a.points[2].seconds, 30.5, 0);
    assert_near(a.points[0].where.altitude_m, 520.5, 0);
    assert_near(a.points[0].heading_deg, 0, 1e-9);
    assert_near(a.points[1].heading_deg, 90, 1e-3);
    assert_near(a.points[2].heading_deg, 90, 1e-3); /* the last keeps it */
    assert_int_equal(a.points[0].line, 4);
    assert_int_equal(b.points[1].line, 5);
}

/* ---- headings ---------------------------------------------------------------------------- */

#define AT(second, lat, lon, heading)                                                          \
    "2026-06-21T06:00:" second "Z," lat "," lon "," heading "\n"

ARENA_TEST(standing_still_keeps_the_last_heading)
{
    Route r = must_read("time,lat,lon,heading\n" AT("00", "0", "0", "") AT("01", "0", "0", "")
                        AT("02", "0", "0.001", "") AT("03", "0", "0.001", "")
                        AT("04", "0", "0.001", "") AT("05", "0.001", "0.001", "")
                        AT("06", "0.001", "0.001", ""), &arena);
    static const double wanted[] = {90, 90, 90, 90, 0, 0, 0};
    for (int i = 0; i < 7; i++) assert_near(r.points[i].heading_deg, wanted[i], 1e-6);
}

/* Half a metre a second: no two neighbours are a metre apart. */
ARENA_TEST(creeping_is_moving)
{
    char *text = arena_format(&arena, "time,lat,lon\n");
    for (int i = 0; i < 20; i++)
        text = arena_format(&arena, "%s2026-06-21T06:00:%02dZ,0,%.7f\n", text, i, i * 4.5e-6);
    Route r = must_read(text, &arena);
    for (int i = 0; i < 20; i++) assert_near(r.points[i].heading_deg, 90, 1e-6);
}

ARENA_TEST(headings_of_the_file_count)
{
    Route r = must_read("time,lat,lon,heading\n" AT("00", "0", "0", "-90")
                        AT("01", "0", "0.001", "") AT("02", "0.001", "0.001", "-359"), &arena);
    assert_near(r.points[0].heading_deg, 270, 1e-12);
    assert_near(r.points[1].heading_deg, 0, 1e-6);
    assert_near(r.points[2].heading_deg, 1, 1e-12);
    r = must_read("time,lat,lon,heading\n" AT("00", "48", "11", "30"), &arena);
    assert_near(r.points[0].heading_deg, 30, 1e-12);
}

/* ---- times ------------------------------------------------------------------------------- */

ARENA_TEST(a_route_starts_when_it_is_said)
{
    Route   r = must_read(csv_text, &arena);
    SkyTime start = {2028, 2, 28, 23, 59, 45, 2};
    double  before = r.points[2].seconds;
    route_start_at(&r, &start);
    SkyTime first = r.points[0].when, second = r.points[1].when, last = r.points[2].when;
    assert_true(first.day == 28 && first.hour == 23 && first.zone_h == 2);
    assert_true(second.day == 28 && second.minute == 59 && second.second == 55);
    assert_true(last.month == 2 && last.day == 29 && last.hour == 0 && last.minute == 0);
    assert_near(last.second, 15.5, 1e-9);
    assert_near((sky_julian_day(&last) - sky_julian_day(&first)) * 86400, before, 1e-3);
    SkyTime silvester = {2026, 12, 31, 23, 59, 50, 0};
    route_start_at(&r, &silvester);
    assert_true(r.points[1].when.year == 2027 && r.points[1].when.month == 1 &&
                r.points[1].when.day == 1 && r.points[1].when.second == 0);
}

/* ---- what is wrong ----------------------------------------------------------------------- */

typedef struct Wrong {
    const char *text, *place, *words;
} Wrong;

TEST(what_is_wrong_is_said_with_its_line)
{
    static const Wrong wrong[] = {
        {"", "", "is empty, required: a header line time,lat,lon,heading"},
        {"time,lat,lon\n", "", "has a header line but no points"},
        {"time,lat,long\n", "line 1", "has a column 'long', required: time,lat,lon,heading"},
        {"time,lat,lat\n", "line 1", "has the column 'lat' twice"},
        {"time,lat\n", "line 1", "has no column 'lon'"},
        {"time,lat,lon\n\n2026-06-21T06:00:00Z,48\n", "line 3",
         "has 2 cells, required: the header's 3"},
        {"time,lat,lon\n2026-06-21T06:00:00Z,98,1\n", "line 2",
         "lat is '98', required: a number from -90 to 90"},
        {"time,lat,lon\n2026-06-21T06:00:00Z,9x,1\n", "line 2", "lat is '9x'"},
        {"time,lat,lon\n2026-06-21T06:00:00Z,nan,1\n", "line 2", "lat is 'nan'"},
        {"time,lat,lon\n2026-06-21T06:00:00Z,1,\n", "line 2", "the point has no lon"},
        {"time,lat,lon\n,1,1\n", "line 2", "the point has no time"},
        {"time,lat,lon\n2026-06-21T06:00:00,1,1\n", "line 2", "is no moment"},
        {"time,lat,lon\n2026-06-21T06:00:05Z,1,1\n2026-06-21T08:00:00+02:00,1,1\n", "line 3",
         "the time lies 5 s before that of line 2, required: times that do not fall"},
        {"time,lat,lon\n2026-06-21T06:00:05Z,1,1\n2026-06-21T06:00:06Z,1,1\n", "",
         "never moves, so that no heading follows"},
        {"time,lat,lon,heading\n2026-06-21T06:00:05Z,1,1,north\n", "line 2",
         "heading is 'north', required: a number from -360 to 360"},
        {"<gpx>", "line 1", "is no sound XML"},
        {"<kml/>", "", "holds an element 'kml', required: a GPX file's 'gpx'"},
        {"<gpx/>", "", "has no track point, required: trk / trkseg / trkpt"},
        {"<!DOCTYPE gpx><gpx/>", "", "has a document type"},
        {GPX("<trkpt lat='1'/>\n"), "line 4", "the point has no lon"},
        {GPX(POINT("1", "1", "")), "line 4", "the point has no time"},
        {GPX(POINT("1", "1", "<time>now</time>")), "line 4", "'now' is no moment"},
        {GPX(POINT("1", "1", "<ele>high</ele><time>2026-06-21T06:00:00Z</time>")), "line 4",
         "altitude is 'high', required: a number from -500 to 60000"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        Arena arena = test_arena(state);
        Route route;
        if (read_route(wrong[i].text, &arena, &route, why())) fail_msg("%s", wrong[i].text);
        assert_told(ERROR_INPUT, wrong[i].place, wrong[i].words);
    }
}

TEST(every_prefix_is_read_or_refused)
{
    static const char *const texts[] = {gpx_text, csv_text};
    for (int k = 0; k < 2; k++)
        for (size_t n = 0; n < strlen(texts[k]); n++) {
            Arena arena = test_arena(state);
            Route route = {0};
            char *part = arena_string(&arena, texts[k], n);
            if (read_route(part, &arena, &route, why()))
                assert_true(route.count > 0);
            else
                assert_true(why()->text[0] && !strchr(why()->text, '\n'));
        }
}

/* ---- levels ------------------------------------------------------------------------------ */

static const ReviewLevelPoint points[] = {{0, 0.02}, {50, 0.08}, {1000, 0.4}, {20000, 1}};
static const ReviewLevel curve = {.is_curve = true, .points = points, .point_count = 4};

TEST(a_level_curve_goes_through_its_points)
{
    for (int i = 0; i < 4; i++)
        assert_close(review_level_of_lux(&curve, points[i].lux), points[i].level, 1e-12);
    assert_near(review_level_of_lux(&curve, -5), 0.02, 0);
    assert_near(review_level_of_lux(&curve, 1e6), 1, 0); /* the end's beyond the ends */
}

/* Halfway in log-log the level is the geometric mean; next to 0 lx the piece is linear. */
TEST(a_level_curve_is_a_power_law_between_points)
{
    assert_close(review_level_of_lux(&curve, sqrt(50.0 * 1000)), sqrt(0.08 * 0.4), 1e-12);
    assert_close(review_level_of_lux(&curve, sqrt(1000.0 * 20000)), sqrt(0.4), 1e-12);
    double whole = review_level_of_lux(&curve, 4000) / review_level_of_lux(&curve, 2000);
    assert_close(whole, review_level_of_lux(&curve, 16000) / review_level_of_lux(&curve, 8000),
                 1e-12); /* the same factor in light is the same factor in level */
    assert_close(review_level_of_lux(&curve, 25), 0.05, 1e-12);
}

TEST(a_level_curve_does_not_fall)
{
    double last = 0;
    for (double lux = 0; lux < 30000; lux = lux * 1.003 + 0.01) {
        double level = review_level_of_lux(&curve, lux);
        assert_true(level >= last && level <= 1);
        last = level;
    }
}

TEST(fixed_levels_go_by_name_material_and_the_rest)
{
    ReviewFixedLevel  fixed[] = {{"*", 0.5}, {"windows", 0.2}, {"node:alt", 0.1}};
    ReviewLevel       level = {.fixed = fixed, .fixed_count = 3};
    ReviewDisplayName alt = {"node:alt", "windows"}, hdg = {"node:hdg", "windows"};
    ReviewDisplayName other = {"pfd", "pfd"};
    assert_near(review_level_at(&level, alt, 7, 1e4), 0.1, 0);
    assert_near(review_level_at(&level, hdg, 7, 1e4), 0.2, 0);
    assert_near(review_level_at(&level, other, 7, 1e4), 0.5, 0);
    level.fixed = fixed + 1, level.fixed_count = 2;
    assert_near(review_level_at(&level, other, 7, 1e4), 7, 0); /* the scene's own */
    assert_near(review_level_at(&curve, other, 7, 1000), 0.4, 1e-12);
}

TEST_PROGRAM(make_folder, clear_folder)
