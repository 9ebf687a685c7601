/* SPDX-License-Identifier: Apache-2.0 */
#include "review/suns/sweep_suns.h"

#include <math.h>

#include "base/parallel.h"
#include "base/units.h"

#define LOWEST_DEG (-12) /* what the table of skies reaches */

SkyTime sweep_time(const ReviewCondition *condition, double step_minutes, double step) {
    SkyTime start = {.year = condition->year, .month = 1, .day = 1};
    return sky_time_later(start, (step + 0.5) * step_minutes * 60);
}

typedef struct SunList {
    SweepSun *list;
    int count;
    bool with_night;
} SunList;

/* Apparent, as the standard atmosphere at the place refracts. */
static DistantSun sun_at(double julian_day, const SkyPlace *place) {
    SunPosition sun = sun_position(julian_day, sky_delta_t_s(julian_day), place);
    double mbar, celsius;
    standard_atmosphere(place->altitude_m, &mbar, &celsius);
    double lifted = sun_refraction_deg(sun.elevation_deg, mbar, celsius);
    return (DistantSun){{sun.azimuth_deg, sun.elevation_deg + lifted},
                        1 / (sun.distance_au * sun.distance_au)};
}

static void place_sun(SweepSun *sun, const DistantSun *found) {
    sun->compass_deg = found->at.azimuth_deg;
    sun->elevation_deg = found->at.elevation_deg;
    sun->azimuth_deg = fmod(found->at.azimuth_deg - sun->heading_deg + 720, 360);
    sun->light = found->light;
}

static void add_sun(SunList *to, DistantSun found, SweepSun sun) {
    if (found.at.elevation_deg < (to->with_night ? LOWEST_DEG : 0)) return;
    place_sun(&sun, &found);
    to->list[to->count++] = sun;
}

#define YEAR_CHUNK 1024 /* steps of one piece of work */

typedef struct YearWork {
    const ReviewCondition *condition;
    double first; /* Julian day of its beginning */
    int steps;
    DistantSun *at; /* [step] */
} YearWork;

static void find_places(void *user, int item, int worker) {
    (void)worker;
    const YearWork *work = user;
    int first = item * YEAR_CHUNK, end = first + YEAR_CHUNK;
    for (int step = first; step < end && step < work->steps; step++) {
        double days = (step + 0.5) * work->condition->step_minutes / 1440;
        work->at[step] = sun_at(work->first + days, &work->condition->where);
    }
}

static void year_suns(const ReviewCondition *c, int threads, SunList *to, Arena scratch) {
    SkyTime start = {.year = c->year, .month = 1, .day = 1};
    YearWork work = {.condition = c, .first = sky_julian_day(&start)};
    start.year++;
    double minutes = (sky_julian_day(&start) - work.first) * 1440;
    work.steps = (int)floor(minutes / c->step_minutes + 0.5);
    work.at = ARENA_NEW(&scratch, DistantSun, work.steps);
    parallel_for(threads, (work.steps + YEAR_CHUNK - 1) / YEAR_CHUNK, find_places, &work);
    for (int step = 0; step < work.steps; step++)
        for (int h = 0; h < c->heading_count; h++)
            add_sun(to, work.at[step],
                    (SweepSun){.heading_deg = c->headings_deg[h],
                               .heading_id = h,
                               .minutes = c->step_minutes,
                               .step = step});
}

static void grid_suns(const ReviewCondition *c, SunList *to) {
    for (int e = 0; e < c->elevation_deg.count; e++)
        for (int a = 0; a < c->azimuth_deg.count; a++)
            to->list[to->count++] =
                (SweepSun){.azimuth_deg = review_range_value(&c->azimuth_deg, a) -
                                          (c->has_heading ? c->heading_deg : 0),
                           .compass_deg = review_range_value(&c->azimuth_deg, a),
                           .heading_deg = c->has_heading ? c->heading_deg : 0,
                           .elevation_deg = review_range_value(&c->elevation_deg, e),
                           .step = -1,
                           .light = 1};
}

static SweepSuns suns_of(const SunList *list, Arena *arena) {
    SweepSuns suns = {.list = list->list,
                      .count = list->count,
                      .distant = ARENA_NEW(arena, DistantSun, list->count)};
    for (int i = 0; i < list->count; i++) {
        const SweepSun *sun = &list->list[i];
        suns.distant[i] = (DistantSun){{sun->azimuth_deg, sun->elevation_deg}, sun->light};
    }
    return suns;
}

static int most_suns(const ReviewCondition *c) {
    if (c->kind == CONDITION_SUN_SWEEP) return c->azimuth_deg.count * c->elevation_deg.count;
    return c->heading_count * (int)ceil(366 * 1440 / c->step_minutes + 1);
}

SweepSuns sweep_suns(const ReviewCondition *c, int threads, Arena *arena) {
    SunList list = {ARENA_NEW(arena, SweepSun, most_suns(c)), 0, c->with_night};
    if (c->kind == CONDITION_SUN_SWEEP) grid_suns(c, &list);
    else year_suns(c, threads, &list, *arena);
    SweepSuns suns = suns_of(&list, arena);
    suns.has_time = c->kind != CONDITION_SUN_SWEEP;
    suns.step_minutes = c->step_minutes;
    suns.azimuth_deg = c->azimuth_deg;
    suns.elevation_deg = c->elevation_deg;
    return suns;
}

/* ---- closer ones ------------------------------------------------------------------------- */

#define DEG_A_MINUTE 0.25
#define COARSE_PARTS 5 /* of a step, in the first round over a grid */

static double within(double value, const ReviewRange *range) {
    return fmin(fmax(value, range->first), range->last);
}

/* From a step before to a step after. */
static void grid_about(const ReviewCondition *c, const SweepSun *sun, int round, SunList *to,
                       Arena *arena) {
    double step = fmax(c->azimuth_deg.step, c->elevation_deg.step);
    double reach = round ? step / COARSE_PARTS : step;
    double close = round ? SWEEP_CLOSE_DEG : step / COARSE_PARTS;
    int parts = (int)ceil(reach / close);
    to->list = ARENA_NEW(arena, SweepSun, (2 * parts + 1) * (2 * parts + 1));
    for (int e = -parts; e <= parts; e++)
        for (int a = -parts; a <= parts; a++) {
            SweepSun near = *sun;
            near.elevation_deg = within(sun->elevation_deg + e * reach / parts, &c->elevation_deg);
            near.compass_deg = within(sun->compass_deg + a * reach / parts, &c->azimuth_deg);
            near.azimuth_deg = near.compass_deg - near.heading_deg;
            to->list[to->count++] = near;
        }
}

/* From the middle of the step before to that of the one after. */
static void year_about(const ReviewCondition *c, const SweepSun *sun, SunList *to, Arena *arena) {
    SkyTime start = {.year = c->year, .month = 1, .day = 1};
    double first = sky_julian_day(&start);
    double middle = (sun->step + 0.5) * c->step_minutes;
    int parts = (int)ceil(c->step_minutes * DEG_A_MINUTE / SWEEP_CLOSE_DEG);
    to->list = ARENA_NEW(arena, SweepSun, 2 * parts + 1);
    for (int i = -parts; i <= parts; i++) {
        SweepSun near = *sun;
        near.later_minutes = i * c->step_minutes / parts;
        add_sun(to, sun_at(first + (middle + near.later_minutes) / 1440, &c->where), near);
    }
}

SweepSuns sweep_suns_about(const ReviewCondition *c, const SweepSun *sun, int round, Arena *arena) {
    SunList list = {.with_night = c->with_night};
    if (c->kind == CONDITION_SUN_SWEEP && round < 2) grid_about(c, sun, round, &list, arena);
    if (c->kind == CONDITION_YEAR_SWEEP && c->weather_id == NO_ID && round < 1)
        year_about(c, sun, &list, arena);
    if (!list.count) {
        list.list = ARENA_NEW(arena, SweepSun, 1);
        list.list[list.count++] = *sun;
    }
    return suns_of(&list, arena);
}

SweepSuns sweep_suns_later(const ReviewCondition *c, SweepSun *list, int count, Arena *arena) {
    SkyTime start = {.year = c->year, .month = 1, .day = 1};
    double first = sky_julian_day(&start);
    for (int i = 0; i < count; i++) {
        double minutes = (list[i].step + 0.5) * c->step_minutes + list[i].later_minutes;
        DistantSun found = sun_at(first + minutes / 1440, &c->where);
        place_sun(&list[i], &found);
    }
    return suns_of(&(SunList){.list = list, .count = count}, arena);
}

double sweep_suns_apart_deg(const SweepSun *a, const SweepSun *b) {
    double up_a = radians_from_degrees(a->elevation_deg);
    double up_b = radians_from_degrees(b->elevation_deg);
    double turn = radians_from_degrees(a->azimuth_deg - b->azimuth_deg);
    double cosine = sin(up_a) * sin(up_b) + cos(up_a) * cos(up_b) * cos(turn);
    return degrees_from_radians(acos(fmin(fmax(cosine, -1), 1)));
}

/* ---- words ------------------------------------------------------------------------------- */

const char *sweep_suns_when(const ReviewCondition *condition, const SweepSuns *suns,
                            const SweepSun *sun, Arena *arena) {
    if (condition->kind != CONDITION_YEAR_SWEEP) return NULL;
    double later = sun->later_minutes / suns->step_minutes;
    SkyTime when = sweep_time(condition, suns->step_minutes, sun->step + later);
    return arena_format(arena, "%d-%02d-%02d %02d:%02d UTC, heading %g degrees", when.year,
                        when.month, when.day, when.hour, when.minute, sun->heading_deg);
}

#define CLOSE_MINUTES 1.0
#define CLOSE_SHARE 0.001 /* of all failures: where their sum is known so well, it will do */
#define CLOSE_PART 8      /* of a step: what is coarser never does, wherever changes gather */

/* A change between a step and the next of its heading, minutes after the first one's middle: it
 * lies between low and high. */
typedef struct Edge {
    int before, after; /* suns */
    double low, high;
} Edge;

typedef struct Steps {
    const ReviewCondition *condition;
    const SweepSuns *suns;
    const unsigned char *states;
    int *before;    /* [sun] the step before under its heading; NO_ID: the sun was down */
    double *change; /* [sun] if its state is another than before: how long after that */
} Steps;

/* A step reaches as far to either side of its middle. */
static double half_step(const Steps *steps, int sun) {
    return steps->suns->list[sun].minutes / 2;
}

static bool fails(const Steps *steps, int sun) {
    return steps->states[sun] != STEP_PASSES;
}

static int heading_count(const SweepSuns *suns) {
    int count = 1;
    for (int i = 0; i < suns->count; i++)
        if (suns->list[i].heading_id >= count) count = suns->list[i].heading_id + 1;
    return count;
}

static Steps steps_of(const ReviewCondition *condition, const SweepSuns *suns,
                      const unsigned char *states, Arena *arena) {
    Steps steps = {condition, suns, states, ARENA_NEW(arena, int, suns->count),
                   ARENA_NEW(arena, double, suns->count)};
    int headings = heading_count(suns), *last = ARENA_NEW(arena, int, headings);
    for (int h = 0; h < headings; h++) last[h] = NO_ID;
    for (int i = 0; i < suns->count; i++) {
        const SweepSun *sun = &suns->list[i];
        int other = last[sun->heading_id];
        bool follows = other != NO_ID && suns->list[other].step + 1 == sun->step;
        steps.before[i] = follows ? other : NO_ID;
        if (follows) steps.change[i] = half_step(&steps, other);
        last[sun->heading_id] = i;
    }
    return steps;
}

/* ---- between steps ----------------------------------------------------------------------- */

static Edge *edges_of(const Steps *steps, int *count, Arena *arena) {
    Edge *edges = ARENA_NEW(arena, Edge, steps->suns->count);
    *count = 0;
    for (int i = 0; i < steps->suns->count; i++) {
        int before = steps->before[i];
        if (before != NO_ID && fails(steps, i) != fails(steps, before))
            edges[(*count)++] = (Edge){before, i, 0, steps->suns->step_minutes};
    }
    return edges;
}

/* Half of each is left. */
static void halve(const Steps *steps, Edge *edges, int count, const FailureArgs *args,
                  Arena scratch) {
    SweepSun *middle = ARENA_NEW(&scratch, SweepSun, count);
    unsigned char *states = ARENA_NEW(&scratch, unsigned char, count);
    for (int i = 0; i < count; i++) {
        middle[i] = steps->suns->list[edges[i].before];
        middle[i].later_minutes = 0.5 * (edges[i].low + edges[i].high);
    }
    SweepSuns suns = sweep_suns_later(steps->condition, middle, count, &scratch);
    args->states(args->user, &suns, states, scratch);
    for (int i = 0; i < count; i++) {
        bool is_as_before = (states[i] != STEP_PASSES) == fails(steps, edges[i].before);
        *(is_as_before ? &edges[i].low : &edges[i].high) = middle[i].later_minutes;
    }
}

/* ---- stretches --------------------------------------------------------------------------- */

typedef struct Stretch {
    double minutes, step;
    int first, end; /* the suns before which it begins and ends, between steps; or NO_ID */
    bool is_open, is_sure;
} Stretch;

typedef struct Stretches {
    Stretch *list; /* those that count */
    int count;
} Stretches;

static void end_stretch(Stretch *stretch, double more, double step, Stretches *to) {
    stretch->minutes += more;
    stretch->step = step;
    if (stretch->is_sure) to->list[to->count++] = *stretch;
    *stretch = (Stretch){0};
}

/* last: the step that was met before under this heading; NO_ID: none. */
static void meet(const Steps *steps, int sun, int last, Stretch *stretch, Stretches *to) {
    bool follows = steps->before[sun] != NO_ID, was_open = stretch->is_open;
    if (was_open && !(follows && fails(steps, sun))) {
        stretch->end = follows ? sun : NO_ID;
        end_stretch(stretch, follows ? steps->change[sun] : half_step(steps, last),
                    steps->suns->list[last].minutes, to);
    }
    if (!fails(steps, sun)) return;
    double since = follows ? steps->suns->list[last].minutes : 0;
    if (stretch->is_open) stretch->minutes += since;
    else {
        stretch->first = follows ? sun : NO_ID;
        stretch->minutes = follows ? since - steps->change[sun] : half_step(steps, sun);
    }
    stretch->is_open = true;
    stretch->is_sure |= steps->states[sun] == STEP_FAILS_SURELY;
}

static Stretches find_stretches(const Steps *steps, Arena *arena) {
    Stretches out = {ARENA_NEW(arena, Stretch, steps->suns->count), 0};
    Arena scratch = *arena;
    int headings = heading_count(steps->suns);
    int *last = ARENA_NEW(&scratch, int, headings);
    Stretch *open = ARENA_NEW(&scratch, Stretch, headings);
    for (int h = 0; h < headings; h++) last[h] = NO_ID;
    for (int i = 0; i < steps->suns->count; i++) {
        int h = steps->suns->list[i].heading_id;
        meet(steps, i, last[h], &open[h], &out);
        last[h] = i;
    }
    for (int h = 0; h < headings; h++) {
        if (!open[h].is_open) continue;
        open[h].end = NO_ID;
        end_stretch(&open[h], half_step(steps, last[h]), steps->suns->list[last[h]].minutes, &out);
    }
    return out;
}

static double longest_of(const Stretches *stretches) {
    double longest = 0;
    for (int i = 0; i < stretches->count; i++) longest = fmax(longest, stretches->list[i].minutes);
    return longest;
}

static double sum_of(const Stretches *stretches) {
    double sum = 0;
    for (int i = 0; i < stretches->count; i++)
        sum += fmax(stretches->list[i].minutes, stretches->list[i].step);
    return sum;
}

/* ---- to a minute ------------------------------------------------------------------------- */

static void set_changes(const Steps *steps, const Edge *edges, int count) {
    for (int i = 0; i < count; i++)
        steps->change[edges[i].after] = 0.5 * (edges[i].low + edges[i].high);
}

/* Errors of many edges, each even within its width, add up as their root. */
static bool is_sum_close(const Steps *steps, double width, int count, Arena scratch) {
    Stretches stretches = find_stretches(steps, &scratch);
    if (CLOSE_PART * width > steps->suns->step_minutes) return false;
    return width * sqrt(count / 12.0) <= CLOSE_SHARE * sum_of(&stretches);
}

/* Those of stretches that may be the longest; how many. */
static int keep_longest(const Steps *steps, Edge *edges, int count, double width, Arena scratch) {
    Stretches stretches = find_stretches(steps, &scratch);
    bool *is_kept = ARENA_NEW(&scratch, bool, steps->suns->count);
    double least = longest_of(&stretches) - 2 * width;
    int kept = 0;
    for (int i = 0; i < stretches.count; i++) {
        const Stretch *s = &stretches.list[i];
        if (s->minutes < least) continue;
        if (s->first != NO_ID) is_kept[s->first] = true;
        if (s->end != NO_ID) is_kept[s->end] = true;
    }
    for (int i = 0; i < count; i++)
        if (is_kept[edges[i].after]) edges[kept++] = edges[i];
    return kept;
}

static void find_changes(const Steps *steps, const FailureArgs *args, Arena scratch) {
    int count;
    double width = steps->suns->step_minutes;
    Edge *edges = edges_of(steps, &count, &scratch);
    count = keep_longest(steps, edges, count, INFINITY, scratch); /* of all that count */
    for (; count && width > CLOSE_MINUTES && !is_sum_close(steps, width, count, scratch);
         width /= 2) {
        halve(steps, edges, count, args, scratch);
        set_changes(steps, edges, count);
    }
    for (; count && width > CLOSE_MINUTES; width /= 2) {
        count = keep_longest(steps, edges, count, width, scratch);
        if (!count) return;
        halve(steps, edges, count, args, scratch);
        set_changes(steps, edges, count);
    }
}

Failures sweep_failures(const ReviewCondition *condition, const SweepSuns *suns,
                        const unsigned char *states, const FailureArgs *args, Arena scratch) {
    Steps steps = steps_of(condition, suns, states, &scratch);
    double all = 0;
    if (args) find_changes(&steps, args, scratch);
    Stretches stretches = find_stretches(&steps, &scratch);
    for (int i = 0; i < suns->count; i++) all += suns->list[i].minutes;
    return (Failures){all > 0 ? sum_of(&stretches) / all : 0, longest_of(&stretches)};
}
