/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/sweep_output.h"

#include <math.h>

#include "base/calendar.h"
#include "text/text.h"

#define MINUTES_A_DAY 1440

/* ---- the table --------------------------------------------------------------------------- */

static void add_time(Text *text, const SweepTable *table, const ReviewCondition *c,
                     const SweepSun *sun)
{
    if (c->kind == CONDITION_YEAR_SWEEP) {
        double minutes = (sun->step + 0.5) * table->suns->step_minutes;
        text_format(text, "%d,%d,%.4g,", (int)(minutes / MINUTES_A_DAY) + 1, c->year,
                 fmod(minutes, MINUTES_A_DAY) / 60);
    } else if (c->kind == CONDITION_ROUTE) {
        const SkyTime *when = &c->route.points[sun->step].when;
        text_format(text, "%04d-%02d-%02dT%02d:%02d:%02.0f,", when->year, when->month,
                    when->day, when->hour, when->minute, when->second);
    }
}

static const char *head_of(const ReviewCondition *c)
{
    if (c->kind == CONDITION_YEAR_SWEEP) return "day_of_year,year,hour_utc,";
    return c->kind == CONDITION_ROUTE ? "time," : "";
}

bool sweep_table_write(const SweepTable *table, const ReviewCondition *condition,
                       const char *path, Error *err)
{
    Arena own = arena_reserve((size_t)1 << 32);
    Text  text = {.arena = &own};
    const SunFigures *f = &table->figures;
    text_format(&text, "%ssun_azimuth_deg,sun_elevation_deg,heading_deg,vehicle_azimuth_deg,"
                       "minutes,level,display_lx,reflected_cd_m2,sun_by_mirror_cd_m2,"
                       "contrast_ratio,contrast_low,contrast_high,margin,verdict\n",
                head_of(condition));
    for (int i = 0; i < table->suns->count; i++) {
        const SweepSun *sun = &table->suns->list[i];
        add_time(&text, table, condition, sun);
        text_format(&text, "%.2f,%.2f,%g,%.2f,%g,%.4g,%.5g,%.5g,%.5g,%.5g,%.5g,%.5g,",
                    sun->compass_deg, sun->elevation_deg, sun->heading_deg, sun->azimuth_deg,
                    sun->minutes, (double)f->level[i], (double)f->lux[i],
                    (double)f->reflected[i], (double)f->mirror[i], (double)f->contrast[i],
                    (double)f->low[i], (double)f->high[i]);
        if (!isnan(f->margin[i])) text_format(&text, "%.4g", (double)f->margin[i]);
        text_format(&text, ",%s\n", verdict_names[f->verdict[i]]);
    }
    bool ok = text_write(&text, path, err);
    arena_release(&own);
    return ok;
}

/* ---- the map ----------------------------------------------------------------------------- */

typedef struct MapCells {
    float         *contrast, *margin;
    unsigned char *verdict;
} MapCells;

static ReviewMap empty_map(const ReviewSweep *sweep, ReviewAxis azimuth, ReviewAxis elevation,
                           MapCells *cells, Arena *arena)
{
    size_t count = (size_t)azimuth.count * (size_t)elevation.count;
    cells->contrast = ARENA_NEW(arena, float, count);
    cells->margin = ARENA_NEW(arena, float, count);
    cells->verdict = ARENA_NEW(arena, unsigned char, count);
    for (size_t i = 0; i < count; i++) cells->contrast[i] = cells->margin[i] = NAN;
    return (ReviewMap){.of = sweep, .is_of_vehicle = true, .azimuth_deg = azimuth,
                       .elevation_deg = elevation, .contrast = cells->contrast,
                       .margin = cells->margin, .verdict = cells->verdict};
}

static void put_worst(const SweepTable *table, int sun, MapCells *cells, size_t at)
{
    if (table->figures.contrast[sun] >= cells->contrast[at]) return;
    cells->contrast[at] = table->figures.contrast[sun];
    cells->margin[at] = table->figures.margin[sun];
    cells->verdict[at] = table->figures.verdict[sun];
}

static ReviewMap grid_map(const SweepTable *table, const ReviewSweep *sweep, Arena *arena)
{
    const SweepSuns *suns = table->suns;
    MapCells  cells;
    ReviewAxis azimuth = {suns->list[0].azimuth_deg, suns->azimuth_deg.step,
                          suns->azimuth_deg.count};
    ReviewAxis elevation = {suns->elevation_deg.first, suns->elevation_deg.step,
                            suns->elevation_deg.count};
    ReviewMap map = empty_map(sweep, azimuth, elevation, &cells, arena);
    for (int i = 0; i < suns->count; i++) put_worst(table, i, &cells, (size_t)i);
    return map;
}

ReviewMap sweep_map(const SweepTable *table, const ReviewSweep *sweep, double step_deg,
                    Arena *arena)
{
    const SweepSuns *suns = table->suns;
    MapCells  cells;
    if (!suns->has_time) return grid_map(table, sweep, arena);
    ReviewAxis azimuth = {0, step_deg, (int)(360 / step_deg)};
    ReviewAxis elevation = {0.5 * step_deg, step_deg, (int)(90 / step_deg)};
    ReviewMap map = empty_map(sweep, azimuth, elevation, &cells, arena);
    for (int i = 0; i < suns->count; i++) {
        const SweepSun *sun = &suns->list[i];
        int a = (int)floor(sun->azimuth_deg / step_deg + 0.5) % azimuth.count;
        int e = (int)floor(sun->elevation_deg / step_deg);
        if (e < 0 || e >= elevation.count) continue;
        put_worst(table, i, &cells, (size_t)e * (size_t)azimuth.count + (size_t)a);
    }
    return map;
}

/* ---- the calendar ------------------------------------------------------------------------ */

ReviewCalendar sweep_calendar(const SweepTable *table, const ReviewSweep *sweep,
                              const ReviewCondition *condition, Arena *arena)
{
    const SweepSuns *suns = table->suns;
    int    steps = (int)floor(MINUTES_A_DAY / suns->step_minutes + 0.5);
    int    year = condition->year;
    int    days = 365 + calendar_is_leap(year);
    float *share = ARENA_NEW(arena, float, (size_t)days * (size_t)steps);
    int   *asked = ARENA_NEW(arena, int, (size_t)days * (size_t)steps);
    for (int i = 0; i < suns->count; i++) {
        int at = suns->list[i].step;
        if (at >= days * steps) continue;
        asked[at]++;
        share[at] += table->figures.verdict[i] == VERDICT_FAIL;
    }
    for (int i = 0; i < days * steps; i++)
        share[i] = asked[i] ? share[i] / (float)asked[i] : NAN;
    return (ReviewCalendar){sweep, year, days, steps, "UTC", condition->heading_count,
                            share};
}
