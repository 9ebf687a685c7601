/* SPDX-License-Identifier: Apache-2.0 */
#include "review/suns/failures.h"

#include <math.h>

#define CLOSE_MINUTES 1.0

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

static void find_changes(const Steps *steps, const FailureAsk *ask, Arena scratch)
{
    int   count;
    Edge *edges = edges_of(steps, &count, &scratch);
    for (double width = steps->suns->step_minutes; count && width > CLOSE_MINUTES; width /= 2)
        halve(steps, edges, count, ask, scratch);
    for (int i = 0; i < count; i++)
        steps->change[edges[i].after] = 0.5 * (edges[i].low + edges[i].high);
}

/* ---- stretches --------------------------------------------------------------------------- */

typedef struct Stretch {
    double minutes;
    bool   is_open, is_sure;
} Stretch;

typedef struct Sum {
    double failed, longest;
} Sum;

static void end_stretch(Stretch *stretch, double more, double step, Sum *sum)
{
    stretch->minutes += more;
    if (stretch->is_sure) {
        sum->failed += fmax(stretch->minutes, step);
        sum->longest = fmax(sum->longest, stretch->minutes);
    }
    *stretch = (Stretch){0};
}

/* last: the step that was met before under this heading; NO_ID: none. */
static void meet(const Steps *steps, int sun, int last, Stretch *stretch, Sum *sum)
{
    bool follows = steps->before[sun] != NO_ID, was_open = stretch->is_open;
    if (was_open && !(follows && fails(steps, sun)))
        end_stretch(stretch, follows ? steps->change[sun] : ends_after(steps, last),
                    steps->suns->list[last].minutes, sum);
    if (!fails(steps, sun)) return;
    double since = follows ? steps->suns->list[last].minutes : 0;
    if (stretch->is_open) stretch->minutes += since;
    else stretch->minutes = follows ? since - steps->change[sun] : begins_before(steps, sun);
    stretch->is_open = true;
    stretch->is_sure |= steps->states[sun] == STEP_FAILS_SURELY;
}

static Sum sum_stretches(const Steps *steps, Arena scratch)
{
    int      headings = heading_count(steps->suns), *last = ARENA_NEW(&scratch, int, headings);
    Stretch *open = ARENA_NEW(&scratch, Stretch, headings);
    Sum      sum = {0};
    for (int h = 0; h < headings; h++) last[h] = NO_ID;
    for (int i = 0; i < steps->suns->count; i++) {
        int h = steps->suns->list[i].heading_id;
        meet(steps, i, last[h], &open[h], &sum);
        last[h] = i;
    }
    for (int h = 0; h < headings; h++)
        if (open[h].is_open)
            end_stretch(&open[h], ends_after(steps, last[h]),
                        steps->suns->list[last[h]].minutes, &sum);
    return sum;
}

Failures sweep_failures(const ReviewCondition *condition, const SweepSuns *suns,
                        const unsigned char *states, const FailureAsk *ask, Arena scratch)
{
    Steps  steps = steps_of(condition, suns, states, &scratch);
    double all = 0;
    if (ask) find_changes(&steps, ask, scratch);
    Sum sum = sum_stretches(&steps, scratch);
    for (int i = 0; i < suns->count; i++) all += suns->list[i].minutes;
    return (Failures){all > 0 ? sum.failed / all : 0, sum.longest};
}
