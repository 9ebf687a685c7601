/* SPDX-License-Identifier: Apache-2.0 */
#include "review/suns/failures.h"

#include <math.h>

#define CLOSE_MINUTES 1.0
#define CLOSE_SHARE 0.001 /* of all failures: where their sum is known so well, it will do */
#define CLOSE_PART 8      /* of a step: what is coarser never does, wherever changes gather */

/* A change between a step and the next of its heading, minutes after the first one's middle (of
 * a route after the point itself): it lies between low and high. */
typedef struct Edge {
    int    before, after; /* suns */
    double low, high;
} Edge;

typedef struct Steps {
    const ReviewCondition *condition;
    const SweepSuns       *suns;
    const unsigned char   *states;
    int    *before; /* [sun] the step before under its heading; NO_ID: the sun was down */
    double *change; /* [sun] if its state is another than before: how long after that */
} Steps;

/* A year's steps reach as far to either side, a route's points to the next one. */
static double begins_before(const Steps *steps, int sun)
{
    return steps->condition->kind == CONDITION_ROUTE ? 0 : steps->suns->list[sun].minutes / 2;
}

static double ends_after(const Steps *steps, int sun)
{
    return steps->suns->list[sun].minutes - begins_before(steps, sun);
}

static bool fails(const Steps *steps, int sun)
{
    return steps->states[sun] != STEP_PASSES;
}

static int heading_count(const SweepSuns *suns)
{
    int count = 1;
    for (int i = 0; i < suns->count; i++)
        if (suns->list[i].heading_id >= count) count = suns->list[i].heading_id + 1;
    return count;
}

static Steps steps_of(const ReviewCondition *condition, const SweepSuns *suns,
                      const unsigned char *states, Arena *arena)
{
    Steps steps = {condition, suns, states, ARENA_NEW(arena, int, suns->count),
                   ARENA_NEW(arena, double, suns->count)};
    int   headings = heading_count(suns), *last = ARENA_NEW(arena, int, headings);
    for (int h = 0; h < headings; h++) last[h] = NO_ID;
    for (int i = 0; i < suns->count; i++) {
        const SweepSun *sun = &suns->list[i];
        int other = last[sun->heading_id];
        bool follows = other != NO_ID && suns->list[other].step + 1 == sun->step;
        steps.before[i] = follows ? other : NO_ID;
        if (follows) steps.change[i] = ends_after(&steps, other);
        last[sun->heading_id] = i;
    }
    return steps;
}

/* ---- between steps ----------------------------------------------------------------------- */

static Edge *edges_of(const Steps *steps, int *count, Arena *arena)
{
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
static void halve(const Steps *steps, Edge *edges, int count, const FailureAsk *ask,
                  Arena scratch)
{
    SweepSun      *middle = ARENA_NEW(&scratch, SweepSun, count);
    unsigned char *states = ARENA_NEW(&scratch, unsigned char, count);
    for (int i = 0; i < count; i++) {
        middle[i] = steps->suns->list[edges[i].before];
        middle[i].later_minutes = 0.5 * (edges[i].low + edges[i].high);
    }
    SweepSuns suns = sweep_suns_later(steps->condition, middle, count, &scratch);
    ask->states(ask->user, &suns, states, scratch);
    for (int i = 0; i < count; i++) {
        bool is_as_before = (states[i] != STEP_PASSES) == fails(steps, edges[i].before);
        *(is_as_before ? &edges[i].low : &edges[i].high) = middle[i].later_minutes;
    }
}

/* ---- stretches --------------------------------------------------------------------------- */

typedef struct Stretch {
    double minutes, step;
    int    first, end; /* the suns before which it begins and ends, between steps; or NO_ID */
    bool   is_open, is_sure;
} Stretch;

typedef struct Stretches {
    Stretch *list; /* those that count */
    int      count;
} Stretches;

static void end_stretch(Stretch *stretch, double more, double step, Stretches *to)
{
    stretch->minutes += more;
    stretch->step = step;
    if (stretch->is_sure) to->list[to->count++] = *stretch;
    *stretch = (Stretch){0};
}

/* last: the step that was met before under this heading; NO_ID: none. */
static void meet(const Steps *steps, int sun, int last, Stretch *stretch, Stretches *to)
{
    bool follows = steps->before[sun] != NO_ID, was_open = stretch->is_open;
    if (was_open && !(follows && fails(steps, sun))) {
        stretch->end = follows ? sun : NO_ID;
        end_stretch(stretch, follows ? steps->change[sun] : ends_after(steps, last),
                    steps->suns->list[last].minutes, to);
    }
    if (!fails(steps, sun)) return;
    double since = follows ? steps->suns->list[last].minutes : 0;
    if (stretch->is_open) stretch->minutes += since;
    else {
        stretch->first = follows ? sun : NO_ID;
        stretch->minutes = follows ? since - steps->change[sun] : begins_before(steps, sun);
    }
    stretch->is_open = true;
    stretch->is_sure |= steps->states[sun] == STEP_FAILS_SURELY;
}

static Stretches find_stretches(const Steps *steps, Arena *arena)
{
    Stretches out = {ARENA_NEW(arena, Stretch, steps->suns->count), 0};
    Arena     scratch = *arena;
    int       headings = heading_count(steps->suns);
    int      *last = ARENA_NEW(&scratch, int, headings);
    Stretch  *open = ARENA_NEW(&scratch, Stretch, headings);
    for (int h = 0; h < headings; h++) last[h] = NO_ID;
    for (int i = 0; i < steps->suns->count; i++) {
        int h = steps->suns->list[i].heading_id;
        meet(steps, i, last[h], &open[h], &out);
        last[h] = i;
    }
    for (int h = 0; h < headings; h++) {
        if (!open[h].is_open) continue;
        open[h].end = NO_ID;
        end_stretch(&open[h], ends_after(steps, last[h]), steps->suns->list[last[h]].minutes,
                    &out);
    }
    return out;
}

static double longest_of(const Stretches *stretches)
{
    double longest = 0;
    for (int i = 0; i < stretches->count; i++)
        longest = fmax(longest, stretches->list[i].minutes);
    return longest;
}

static double sum_of(const Stretches *stretches)
{
    double sum = 0;
    for (int i = 0; i < stretches->count; i++)
        sum += fmax(stretches->list[i].minutes, stretches->list[i].step);
    return sum;
}

/* ---- to a minute ------------------------------------------------------------------------- */

static void set_changes(const Steps *steps, const Edge *edges, int count)
{
    for (int i = 0; i < count; i++)
        steps->change[edges[i].after] = 0.5 * (edges[i].low + edges[i].high);
}

/* Errors of many edges, each even within its width, add up as their root. */
static bool is_sum_close(const Steps *steps, double width, int count, Arena scratch)
{
    Stretches stretches = find_stretches(steps, &scratch);
    if (CLOSE_PART * width > steps->suns->step_minutes) return false;
    return width * sqrt(count / 12.0) <= CLOSE_SHARE * sum_of(&stretches);
}

/* Those of stretches that may be the longest; how many. */
static int keep_longest(const Steps *steps, Edge *edges, int count, double width,
                        Arena scratch)
{
    Stretches stretches = find_stretches(steps, &scratch);
    bool     *is_kept = ARENA_NEW(&scratch, bool, steps->suns->count);
    double    least = longest_of(&stretches) - 2 * width;
    int       kept = 0;
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

static void find_changes(const Steps *steps, const FailureAsk *ask, Arena scratch)
{
    int    count;
    double width = steps->suns->step_minutes;
    Edge  *edges = edges_of(steps, &count, &scratch);
    count = keep_longest(steps, edges, count, INFINITY, scratch); /* of all that count */
    for (; count && width > CLOSE_MINUTES && !is_sum_close(steps, width, count, scratch);
         width /= 2) {
        halve(steps, edges, count, ask, scratch);
        set_changes(steps, edges, count);
    }
    for (; count && width > CLOSE_MINUTES; width /= 2) {
        count = keep_longest(steps, edges, count, width, scratch);
        if (!count) return;
        halve(steps, edges, count, ask, scratch);
        set_changes(steps, edges, count);
    }
}

Failures sweep_failures(const ReviewCondition *condition, const SweepSuns *suns,
                        const unsigned char *states, const FailureAsk *ask, Arena scratch)
{
    Steps  steps = steps_of(condition, suns, states, &scratch);
    double all = 0;
    if (ask) find_changes(&steps, ask, scratch);
    Stretches stretches = find_stretches(&steps, &scratch);
    for (int i = 0; i < suns->count; i++) all += suns->list[i].minutes;
    return (Failures){all > 0 ? sum_of(&stretches) / all : 0, longest_of(&stretches)};
}
