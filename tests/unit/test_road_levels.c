/* SPDX-License-Identifier: Apache-2.0 */
/* Increments of a road, and the levels of displays that keep a limit of them, from veils that
 * are known. */
#include "fixture.h"

#include "base/count.h"
#include "panel/query/panel_stated.h"
#include "review/judge.h"
#include "review/run/road.h"
#include "vision/road_glare.h"
#include "world_fixture.h"

#define LIMIT 15.0
#define ROAD 0.3

static const double AGES[] = {25, 70};
static const ReviewRoad road = {
    .luminance_cd_m2 = ROAD, .s_p = 1.4, .ages = AGES, .age_count = COUNT_OF(AGES)};
static const ReviewRequest request = {.forward = {0, 0, -1}, .observer = {50, 0.5}};
static const Profile profile = {.increment_most_pct = LIMIT};

/* The first display at 0.5, the second at 0.25, a third that is dark. */
static World three_displays(void) {
    static const char *const NAMES[] = {"wide", "cluster", "dark"};
    static const float LEVELS[] = {0.5f, 0.25f, 0};
    World world = world_start();
    for (int i = 0; i < 3; i++) {
        Display *display = world_display(&world);
        display->name = NAMES[i];
        display->level = LEVELS[i];
    }
    return world;
}

/* The veils that make these increments; each known within a share. */
static RoadReading reading_of(double wide, double cluster, double rest, double doubt,
                              Arena *arena) {
    RoadReading reading = road_reading_start(COUNT_OF(AGES), 3, arena);
    for (int a = 0; a < COUNT_OF(AGES); a++) {
        double veils[] = {wide, cluster, 0, wide + cluster + rest};
        for (int d = 0; d < 4; d++) {
            double mean = road_veil_of_increment(veils[d] * (1 + a), ROAD);
            double half = doubt * mean;
            if (d == 3) { /* its parts are independent */
                double w = wide * (1 + a), c = cluster * (1 + a), r = rest * (1 + a);
                half = road_veil_of_increment(doubt * sqrt(w * w + c * c + r * r), ROAD);
            }
            reading.found[a * 4 + d] =
                (RoadFound){mean, mean - half, mean + half, d == 3 ? 0.9 * mean : (double)NAN};
        }
    }
    for (int d = 0; d < 2; d++) reading.shares[d].way[ROAD_STRAIGHT] = 1;
    return reading;
}

static GazeRoad *road_with(World *world, const RoadReading *reading) {
    Setup setup = {.request = &request, .scene = world->scene};
    return road_of(&setup, &road, reading, &profile, &world->arena);
}

static GazeFinding gaze_with(GazeRoad *found, const Profile *limits, Arena *arena) {
    GazeFinding out = {.condition = "night", .eye = "driver", .gaze = "road", .road = found};
    judge_gaze(&out, limits, arena);
    return out;
}

/* ---- levels ------------------------------------------------------------------------------ */

/* A review at the level, all else as it stands, is on the limit. */
TEST(the_level_that_is_named_is_on_the_limit) {
    SCOPED_WORLD world = three_displays();
    RoadReading before = reading_of(20, 2, 3, 0, &world.arena);
    GazeRoad *found = road_with(&world, &before);
    assert_int_equal(gaze_with(found, &profile, &world.arena).verdict, VERDICT_FAIL);
    assert_int_equal(found->age_count, 2);
    assert_close(found->ages[0].increment_pct, 25, 1e-12);
    assert_close(found->ages[0].increment_by_spread_pct, 22.5, 1e-12);
    assert_close(found->mesopic_cd_m2, road_mesopic_luminance(ROAD, 1.4), 1e-12);
    assert_int_equal(found->ages[0].display_count, 2); /* a dark one is none */
    const RoadDisplay *wide = &found->ages[0].displays[0];
    assert_string_equal(wide->display, "wide");
    assert_close(wide->share, 0.8, 1e-12);
    assert_close(wide->level_most, 0.5 * (LIMIT - 5) / 20, 1e-12);
    RoadReading after = reading_of(20 * wide->level_most / 0.5, 2, 3, 0, &world.arena);
    assert_close(road_with(&world, &after)->ages[0].increment_pct, LIMIT, 1e-12);
    /* the older eye has 6 of the rest and 4 of the cluster */
    assert_close(found->ages[1].displays[0].level_most, 0.5 * (LIMIT - 10) / 40, 1e-12);
    /* without the cluster there is still too much */
    assert_true(found->ages[0].displays[1].level_most == 0);
}

/* A review there finds an interval that ends on the limit. */
TEST(a_level_is_known_as_well_as_the_veil_is) {
    SCOPED_WORLD world = three_displays();
    PanelStated stated = panel_stated(world.panel, &world.arena);
    double doubt = 1.959964 * stated.emission_error;
    RoadReading before = reading_of(20, 0, 3, 0.04, &world.arena);
    const RoadDisplay *wide = &road_with(&world, &before)->ages[0].displays[0];
    double ends[] = {wide->level_most_range.low, wide->level_most_range.high};
    assert_true(ends[0] < wide->level_most && wide->level_most < ends[1]);
    for (int i = 0; i < 2; i++) {
        double own = 20 * ends[i] / 0.5, sign = i ? -1 : 1;
        double half = sqrt(own * own * (0.04 * 0.04 + doubt * doubt) + 9 * 0.04 * 0.04);
        assert_close(own + 3 + sign * half, LIMIT, 2e-3);
        RoadReading after = reading_of(own, 0, 3, 0.04, &world.arena);
        GazeRoad *there = road_with(&world, &after);
        MeanInterval range = there->ages[0].increment_range;
        assert_close(i ? range.low : range.high, LIMIT, 2e-3);
    }
}

/* ---- the table --------------------------------------------------------------------------- */

static const RoadDimming *row_of(const GazeRoad *of, const char *display, double age,
                                 double cd_m2) {
    for (int i = 0; i < of->dimming_count; i++) {
        const RoadDimming *row = &of->dimming[i];
        bool is_it = display ? row->display && !strcmp(row->display, display) : !row->display;
        if (is_it && row->age_years == age && row->road_cd_m2 == cd_m2) return row;
    }
    fail_msg("no row of %s, %g years, %g cd/m2", display ? display : "all", age, cd_m2);
    return NULL;
}

TEST(the_table_holds_the_levels_of_every_road) {
    SCOPED_WORLD world = three_displays();
    RoadReading before = reading_of(20, 2, 3, 0.01, &world.arena);
    GazeFinding gaze = gaze_with(road_with(&world, &before), &profile, &world.arena);
    road_dim(&road, &profile, NULL, 0, &gaze, &world.arena);
    const GazeRoad *of = gaze.road;
    assert_int_equal(of->dimming_count, 2 * 6 * 3); /* ages, roads, two displays and all */
    const RoadDimming *own = row_of(of, "wide", 25, ROAD);
    assert_close(own->level_most, of->ages[0].displays[0].level_most, 1e-9);
    assert_close(own->level_most_range.low, of->ages[0].displays[0].level_most_range.low, 1e-6);
    static const double roads[] = {0.1, 0.2, 0.3, 0.5, 1, 2};
    for (int i = 0; i < COUNT_OF(roads); i++) {
        double veil = road_veil_of_increment(LIMIT, roads[i]);
        double allowed = road_threshold_increment(veil, ROAD); /* in increments of the own */
        const RoadDimming *all = row_of(of, NULL, 25, roads[i]);
        const RoadDimming *wide = row_of(of, "wide", 25, roads[i]);
        assert_near(all->level_most, fmax((allowed - 3) / 22, 0), 1e-9);
        assert_near(wide->level_most, fmax(0.5 * (allowed - 5) / 20, 0), 1e-9);
        assert_true(all->level == 1 && wide->level == 0.5);
        assert_int_equal(wide->window, ROAD_WINDOW_NONE); /* nobody reads it */
        assert_true(isnan(wide->level_least));
    }
    assert_true(row_of(of, "wide", 70, 2)->level_most < row_of(of, "wide", 25, 2)->level_most);
}

TEST(the_request_s_own_road_is_one_of_the_table) {
    static const double list[] = {0.1, 1};
    const ReviewRoad other = {.luminance_cd_m2 = ROAD,
                              .s_p = NAN,
                              .ages = AGES,
                              .age_count = 2,
                              .dimming = list,
                              .dimming_count = 2};
    SCOPED_WORLD world = three_displays();
    RoadReading before = reading_of(20, 2, 3, 0, &world.arena);
    GazeFinding gaze = gaze_with(road_with(&world, &before), &profile, &world.arena);
    road_dim(&other, &profile, NULL, 0, &gaze, &world.arena);
    assert_int_equal(gaze.road->dimming_count, 2 * 3 * 3);
    row_of(gaze.road, "cluster", 70, ROAD);
}

/* A symbol of so much contrast at level 0.5, the rest of what is reflected so much. */
static ReviewCase case_of(double other, const LimitVerdict *limit) {
    ReviewCase c = review_case_unknown();
    c.condition = "night";
    c.eye = "driver";
    c.symbol = "speed";
    c.display = "wide";
    c.luminance_cd_m2 =
        (CaseLuminances){.foreground = 10, .background = 0.01, .reflected = other, .veil = 0};
    c.own_reflected = 0;
    c.level = 0.5;
    c.height_arcmin = 20;
    c.visible_share = 1;
    c.limits = limit;
    c.limit_count = 1;
    c.verdict = VERDICT_PASS;
    c.unjudged = UNJUDGED_NOT;
    c.reflected_range = (MeanInterval){0.99 * other, 1.01 * other};
    return c;
}

TEST(the_window_lies_between_too_bright_and_too_dark) {
    static const ProfileLimit five = {.name = "five",
                                      .kind = LIMIT_CONTRAST_RATIO,
                                      .ambients = {true, true, true, true},
                                      .value = 5};
    const Profile limits = {.increment_most_pct = LIMIT, .limits = &five, .limit_count = 1};
    const LimitVerdict limit = {.name = "five",
                                .kind = "contrast_ratio",
                                .unit = "1",
                                .value = 5,
                                .found = 50,
                                .low = 49,
                                .high = 51,
                                .verdict = VERDICT_PASS};
    static const struct {
        double other; /* reflected, cd/m2 */
        RoadWindow window;
    } rows[] = {{0.1, ROAD_WINDOW_OPEN}, {5, ROAD_WINDOW_EMPTY}};
    for (int i = 0; i < COUNT_OF(rows); i++) {
        SCOPED_WORLD world = three_displays();
        ReviewCase c = case_of(rows[i].other, &limit);
        RoadReading before = reading_of(20, 2, 3, 0.01, &world.arena);
        GazeFinding gaze = gaze_with(road_with(&world, &before), &profile, &world.arena);
        road_dim(&road, &limits, &c, 1, &gaze, &world.arena);
        const RoadDimming *row = row_of(gaze.road, "wide", 25, ROAD);
        /* (10 x + r) / (0.01 x + r) = 5 */
        double least = 0.5 * 4 * rows[i].other / (10 - 0.05);
        assert_close(row->level_least, least, 1e-9);
        assert_true(row->level_least_sure >= least && row->level_least_sure < 1.02 * least);
        assert_int_equal(row->window, rows[i].window);
        assert_string_equal(row->symbol, "speed");
        assert_close(row_of(gaze.road, NULL, 25, ROAD)->level_least, least / 0.5, 1e-9);
        assert_int_equal(row_of(gaze.road, "cluster", 25, ROAD)->window, ROAD_WINDOW_NONE);
    }
}

TEST(a_display_without_a_limit_has_no_table) {
    const Profile none = {.increment_most_pct = NAN};
    SCOPED_WORLD world = three_displays();
    Setup setup = {.request = &request, .scene = world.scene};
    RoadReading before = reading_of(20, 2, 3, 0, &world.arena);
    GazeFinding gaze =
        gaze_with(road_of(&setup, &road, &before, &none, &world.arena), &none, &world.arena);
    road_dim(&road, &none, NULL, 0, &gaze, &world.arena);
    assert_int_equal(gaze.road->dimming_count, 0);
    assert_true(isnan(gaze.road->ages[0].displays[0].level_most));
    assert_int_equal(gaze.limit_count, 0);
    assert_close(gaze.road->ages[1].increment_pct, 50, 1e-12);
}

TEST_PROGRAM(NULL, NULL)
