/* SPDX-License-Identifier: Apache-2.0 */
#include "review/folder/sweep_output.h"

#include <math.h>

#include "base/calendar.h"
#include "base/units.h"
#include "text/text.h"

#define MINUTES_A_DAY 1440

/* ---- the table --------------------------------------------------------------------------- */

static void add_time(Text *text, const SweepTable *table, const ReviewCondition *c,
                     const SweepSun *sun) {
    if (c->kind == CONDITION_YEAR_SWEEP) {
        double minutes = (sun->step + 0.5) * table->suns->step_minutes;
        text_format(text, "%d,%d,%.4g,", (int)(minutes / MINUTES_A_DAY) + 1, c->year,
                    fmod(minutes, MINUTES_A_DAY) / 60);
    }
}

static const char *head_of(const ReviewCondition *c) {
    return c->kind == CONDITION_YEAR_SWEEP ? "day_of_year,year,hour_utc," : "";
}

bool sweep_table_write(const SweepTable *table, const ReviewCondition *condition, const char *path,
                       Error *err) {
    Arena own = arena_reserve((size_t)1 << 32);
    Text text = {.arena = &own};
    const SunFigures *f = &table->figures;
    text_format(&text,
                "%ssun_azimuth_deg,sun_elevation_deg,heading_deg,vehicle_azimuth_deg,"
                "minutes,level,display_lx,reflected_cd_m2,sun_by_mirror_cd_m2,"
                "contrast_ratio,contrast_low,contrast_high,margin,verdict\n",
                head_of(condition));
    for (int i = 0; i < table->suns->count; i++) {
        const SweepSun *sun = &table->suns->list[i];
        add_time(&text, table, condition, sun);
        text_format(&text, "%.2f,%.2f,%g,%.2f,%g,%.4g,%.5g,%.5g,%.5g,%.5g,%.5g,%.5g,",
                    sun->compass_deg, sun->elevation_deg, sun->heading_deg, sun->azimuth_deg,
                    sun->minutes, (double)f->level[i], (double)f->lux[i], (double)f->reflected[i],
                    (double)f->mirror[i], (double)f->contrast[i], (double)f->low[i],
                    (double)f->high[i]);
        if (!isnan(f->margin[i])) text_format(&text, "%.4g", (double)f->margin[i]);
        text_format(&text, ",%s\n", verdict_names[f->verdict[i]]);
    }
    bool ok = text_write(&text, path, err);
    arena_release(&own);
    return ok;
}

/* ---- the map ----------------------------------------------------------------------------- */

/* Whose cell shows the worst of the suns that are put there; -1: none. */
static void put_worst(const SweepTable *table, int sun, int *cell) {
    float found = table->figures.contrast[sun];
    float before = *cell < 0 ? NAN : table->figures.contrast[*cell];
    if (table->figures.is_private ? found <= before : found >= before) return;
    *cell = sun;
}

static ReviewStep step_of(const SweepTable *table, const ReviewCondition *condition, int i,
                          Arena *arena) {
    if (i < 0) return (ReviewStep){.contrast = NAN};
    const SunFigures *f = &table->figures;
    const SweepSun *sun = &table->suns->list[i];
    return (ReviewStep){.azimuth_deg = sun->azimuth_deg,
                        .elevation_deg = sun->elevation_deg,
                        .when = sweep_suns_when(condition, table->suns, sun, arena),
                        .contrast = (double)f->contrast[i],
                        .low = (double)f->low[i],
                        .high = (double)f->high[i],
                        .margin = (double)f->margin[i],
                        .reflected = (double)f->reflected[i],
                        .mirror = (double)f->mirror[i],
                        .level = (double)f->level[i],
                        .lux = (double)f->lux[i],
                        .verdict = (Verdict)f->verdict[i]};
}

/* ---- between the steps of a year --------------------------------------------------------- */

/* A step's answer stands for half a step of time before it and after it. Where the sun passes
 * in that time, cells without a step of their own get the answer of the step nearest in time:
 * no other answer is made, and cells that the sun does not pass stay empty. */

typedef struct SunWay {
    const SweepTable *table;
    const ReviewMap *map;
    int *cells;   /* [cell] sun */
    float *apart; /* [cell] part of a step's time from its answer's; 0: its own */
} SunWay;

static int cell_at(const ReviewMap *map, double azimuth_deg, double elevation_deg) {
    const ReviewAxis *across = &map->azimuth_deg, *up = &map->elevation_deg;
    int a = (int)floor((azimuth_deg - across->first) / across->step + 0.5);
    int e = (int)floor((elevation_deg - up->first) / up->step + 0.5);
    a = (a % across->count + across->count) % across->count;
    return e < 0 || e >= up->count ? -1 : e * across->count + a;
}

static void direction_of(const SweepSun *sun, double out[3]) {
    double turn = radians_from_degrees(sun->azimuth_deg);
    double up = radians_from_degrees(sun->elevation_deg);
    out[0] = cos(up) * sin(turn);
    out[1] = cos(up) * cos(turn);
    out[2] = sin(up);
}

/* The answer of `sun`, `apart` of a step away. */
static void offer(const SunWay *way, int sun, int at, float apart) {
    if (at < 0 || apart > way->apart[at]) return;
    if (apart < way->apart[at]) way->cells[at] = -1;
    way->apart[at] = apart;
    put_worst(way->table, sun, &way->cells[at]);
}

/* From one step to the next, by the straight way, which is within 0.3 degrees of the sun's. */
static void walk(const SunWay *way, int from, int to) {
    double a[3], b[3], at[3], cosine = 0;
    direction_of(&way->table->suns->list[from], a);
    direction_of(&way->table->suns->list[to], b);
    for (int i = 0; i < 3; i++) cosine += a[i] * b[i];
    double angle = degrees_from_radians(acos(fmin(fmax(cosine, -1), 1)));
    int parts = 2 * (int)ceil(2 * angle / way->map->azimuth_deg.step);
    for (int k = 1; k < parts; k++) {
        double t = (double)k / parts;
        for (int i = 0; i < 3; i++) at[i] = a[i] + t * (b[i] - a[i]);
        int cell = cell_at(way->map, degrees_from_radians(atan2(at[0], at[1])),
                           degrees_from_radians(atan2(at[2], hypot(at[0], at[1]))));
        if (2 * k <= parts) offer(way, from, cell, (float)t);
        if (2 * k >= parts) offer(way, to, cell, (float)(1 - t));
    }
}

/* Steps of one heading, where the sun is up at both. */
static void fill_between(const SunWay *way, Arena scratch) {
    const SweepSuns *suns = way->table->suns;
    int headings = 0;
    int *before;
    for (int i = 0; i < suns->count; i++)
        if (suns->list[i].heading_id >= headings) headings = suns->list[i].heading_id + 1;
    before = ARENA_NEW(&scratch, int, headings + 1);
    for (int h = 0; h < headings; h++) before[h] = -1;
    for (int i = 0; i < suns->count; i++) {
        int *last = &before[suns->list[i].heading_id];
        if (*last >= 0 && suns->list[*last].step + 1 == suns->list[i].step) walk(way, *last, i);
        *last = i;
    }
}

static void fill_year(const SweepTable *table, ReviewMap *map, int *cells, Arena scratch) {
    const SweepSuns *suns = table->suns;
    int count = map->azimuth_deg.count * map->elevation_deg.count;
    SunWay way = {table, map, cells, ARENA_NEW(&scratch, float, count)};
    for (int i = 0; i < count; i++) way.apart[i] = 1;
    for (int i = 0; i < suns->count; i++) {
        const SweepSun *sun = &suns->list[i];
        offer(&way, i, cell_at(map, sun->azimuth_deg, sun->elevation_deg), 0);
    }
    map->is_between_steps = suns->step_minutes > 0;
    if (map->is_between_steps) fill_between(&way, scratch);
}

ReviewMap sweep_map(const SweepTable *table, const ReviewSweep *sweep,
                    const ReviewCondition *condition, double step_deg, Arena *arena) {
    const SweepSuns *suns = table->suns;
    ReviewAxis across = {0, step_deg, (int)(360 / step_deg)};
    ReviewAxis up = {0.5 * step_deg, step_deg, (int)(90 / step_deg)};
    if (!suns->has_time) {
        across = (ReviewAxis){suns->list[0].azimuth_deg, suns->azimuth_deg.step,
                              suns->azimuth_deg.count};
        up = (ReviewAxis){suns->elevation_deg.first, suns->elevation_deg.step,
                          suns->elevation_deg.count};
    }
    int count = across.count * up.count;
    ReviewStep *steps = ARENA_NEW(arena, ReviewStep, count);
    int *cells = ARENA_NEW(arena, int, count);
    ReviewMap map = {.of = sweep, .azimuth_deg = across, .elevation_deg = up, .cells = steps};
    for (int i = 0; i < count; i++) cells[i] = suns->has_time ? -1 : i;
    if (suns->has_time) fill_year(table, &map, cells, *arena);
    for (int i = 0; i < count; i++) steps[i] = step_of(table, condition, cells[i], arena);
    return map;
}

/* ---- the calendar ------------------------------------------------------------------------ */

ReviewCalendar sweep_calendar(const SweepTable *table, const ReviewSweep *sweep,
                              const ReviewCondition *condition, Arena *arena) {
    const SweepSuns *suns = table->suns;
    int steps = (int)floor(MINUTES_A_DAY / suns->step_minutes + 0.5);
    int year = condition->year;
    int days = 365 + calendar_is_leap(year);
    int *failing = ARENA_NEW(arena, int, (size_t)days *(size_t)steps);
    for (int i = 0; i < days * steps; i++) failing[i] = -1;
    for (int i = 0; i < suns->count; i++) {
        int at = suns->list[i].step;
        if (at >= days * steps) continue;
        failing[at] =
            (failing[at] < 0 ? 0 : failing[at]) + (table->figures.verdict[i] == VERDICT_FAIL);
    }
    return (ReviewCalendar){sweep, year, days, steps, condition->heading_count, failing};
}
