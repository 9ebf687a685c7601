/* SPDX-License-Identifier: Apache-2.0 */
/* The map of a year: no holes between its steps, and no answer that no step gave. */
#include "check.h"

#include "base/units.h"
#include "review/folder/sweep_output.h"
#include "review/run/sun_figures.h"

#define CELL_DEG 5.0
#define HOUR_DEG 15.0 /* that the sun moves, at most */

static ReviewCondition year_of(double latitude, double minutes, double *headings, int count) {
    return (ReviewCondition){.kind = CONDITION_YEAR_SWEEP,
                             .year = 2026,
                             .weather_id = NO_ID,
                             .level_id = NO_ID,
                             .with_id = NO_ID,
                             .where = {latitude, 11.58, 520},
                             .step_minutes = minutes,
                             .headings_deg = headings,
                             .heading_count = count};
}

/* Each sun's contrast names it: 1 + its place in the list; all others fail. */
static SweepTable table_of(const SweepSuns *suns, Arena *arena) {
    SweepTable out = {.suns = suns};
    out.figures = sun_figures_start(suns->count, arena);
    for (int i = 0; i < suns->count; i++) {
        out.figures.contrast[i] = (float)(1 + i);
        out.figures.margin[i] = (float)i;
        out.figures.verdict[i] = i % 2 ? VERDICT_FAIL : VERDICT_PASS;
    }
    return out;
}

static size_t cell_of(const ReviewMap *map, const SweepSun *sun) {
    int a = (int)lrint(sun->azimuth_deg / CELL_DEG) % map->azimuth_deg.count;
    int e = (int)(sun->elevation_deg / CELL_DEG);
    return (size_t)(e * map->azimuth_deg.count + a);
}

static double apart_deg(const SweepSun *sun, double azimuth_deg, double elevation_deg) {
    double a = radians_from_degrees(sun->elevation_deg);
    double b = radians_from_degrees(elevation_deg);
    double turn = radians_from_degrees(sun->azimuth_deg - azimuth_deg);
    double cosine = sin(a) * sin(b) + cos(a) * cos(b) * cos(turn);
    return degrees_from_radians(acos(fmin(fmax(cosine, -1), 1)));
}

/* The sun's cell, and whether all places within half a degree of it lie in that, too. Sets
 * those of all of them in `is_near`. */
static bool is_well_inside(const ReviewMap *map, const SweepSun *sun, bool *is_near) {
    double turn = 0.5 / cos(radians_from_degrees(fmin(sun->elevation_deg, 89)));
    bool is_inside = true;
    for (int k = 0; k < 9; k++) {
        SweepSun near = *sun;
        near.azimuth_deg = fmod(sun->azimuth_deg + (k % 3 - 1) * turn + 360, 360);
        near.elevation_deg = fmin(fmax(sun->elevation_deg + (k / 3 - 1) * 0.5, 0), 89.9);
        is_near[cell_of(map, &near)] = true;
        is_inside = is_inside && cell_of(map, &near) == cell_of(map, sun);
    }
    return is_inside;
}

/* Held to the same year by steps of four minutes: above the first and the last step of a day
 * every cell that the sun enters by more than half a degree has an answer, and no cell that it
 * stays away from by more than that has one. */
static void assert_no_holes(const ReviewMap *map, const SweepSuns *fine, Arena *arena) {
    int cells = map->azimuth_deg.count * map->elevation_deg.count;
    bool *is_near = ARENA_NEW(arena, bool, cells);
    for (int i = 0; i < fine->count; i++) {
        const SweepSun *sun = &fine->list[i];
        bool is_open = isnan(map->cells[cell_of(map, sun)].contrast);
        if (is_well_inside(map, sun, is_near) && is_open && sun->elevation_deg > HOUR_DEG)
            fail_msg("a hole at %.1f, %.1f", sun->azimuth_deg, sun->elevation_deg);
    }
    for (int i = 0; i < cells; i++)
        if (!isnan(map->cells[i].contrast) && !is_near[i]) fail_msg("cell %d is nobody's", i);
}

/* Every answer is a step's own, with its margin and verdict, and that step's sun is at most
 * half a step away from the cell. */
static void assert_all_of_steps(const ReviewMap *map, const SweepTable *table) {
    for (int i = 0; i < map->azimuth_deg.count * map->elevation_deg.count; i++) {
        const ReviewStep *step = &map->cells[i];
        if (isnan(step->contrast)) continue;
        int sun = (int)step->contrast - 1;
        const SweepSun *at = &table->suns->list[sun];
        double azimuth = CELL_DEG * (i % map->azimuth_deg.count);
        double elevation = CELL_DEG * (i / map->azimuth_deg.count + 0.5);
        assert_true(step->margin == (double)table->figures.margin[sun]);
        assert_int_equal(step->verdict, table->figures.verdict[sun]);
        assert_true(step->azimuth_deg == at->azimuth_deg && step->when);
        assert_true(apart_deg(at, azimuth, elevation) < HOUR_DEG / 2 + CELL_DEG * 0.75);
    }
}

/* Cells in which steps lie show the worst of them, as before. */
static void assert_own_first(const ReviewMap *map, const SweepTable *table, Arena *arena) {
    int cells = map->azimuth_deg.count * map->elevation_deg.count;
    float *least = ARENA_NEW(arena, float, cells);
    for (int i = table->suns->count - 1; i >= 0; i--)
        least[cell_of(map, &table->suns->list[i])] = table->figures.contrast[i];
    for (int i = 0; i < cells; i++)
        if (least[i] > 0) assert_true(map->cells[i].contrast == (double)least[i]);
}

TEST(a_years_map_has_no_holes_and_no_answers_of_its_own) {
    static const double LATITUDES[] = {48.14, 1.3, -33.9};
    static double HEADINGS[] = {0, 45, 90, 135, 180, 225, 270, 315};
    static const int COUNTS[] = {8, 1, 3};
    for (int i = 0; i < 3; i++) {
        ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 32);
        ReviewCondition hours = year_of(LATITUDES[i], 60, HEADINGS, COUNTS[i]);
        ReviewCondition minutes = year_of(LATITUDES[i], 4, HEADINGS, COUNTS[i]);
        SweepSuns suns = sweep_suns(&hours, 2, &arena);
        SweepSuns fine = sweep_suns(&minutes, 2, &arena);
        SweepTable table = table_of(&suns, &arena);
        ReviewMap map = sweep_map(&table, NULL, &hours, CELL_DEG, &arena);
        assert_true(map.is_between_steps);
        assert_no_holes(&map, &fine, &arena);
        assert_all_of_steps(&map, &table);
        assert_own_first(&map, &table, &arena);
    }
}

TEST_PROGRAM(NULL, NULL)
