/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/sweep_told.h"

#include <math.h>

#include "base/parallel.h"
#include "review/judge.h"
#include "review/suns/failures.h"

/* ---- reading them ------------------------------------------------------------------------ */

static double level_for(const Sweep *sweep, const Sight *sight, int sun)
{
    double lux = sweep->sensor ? sweep->sensor->lux[sun] + sweep->sensor->own.lamps : 0;
    return stage_level_of(sweep->stage, sweep->level, sight->symbol->display.display_id,
                          sight->symbol->display_name, lux);
}

/* The figures of a case under one sun; limits are judged by whoever asks. */
static ReviewCase case_at(const Sweep *sweep, const Sight *sight, const FarTools *tools,
                          int sun)
{
    FarReading light =
        sight->read ? sight->read[sun] : far_probe_read(&sight->probe, tools, sun);
    double     level = level_for(sweep, sight, sun);
    double     own = sight->own.lamps + level * sight->own.displays;
    double     reflected = far_reading_sum(light) + own;
    ReviewCase c = {.level = level, .limit_id = -1, .visible_share = sight->seen.visible_share,
                    .height_arcmin = sight->height_arcmin};
    c.display_lux = sight->face->lux[sun] + sight->face->own.lamps +
                    level * sight->face->own.displays;
    c.luminance_cd_m2 = (CaseLuminances){
        level * sight->shown.foreground, level * sight->shown.background, reflected,
        light.mirror, reflected - light.mirror, (double)NAN};
    judge_contrasts(&c, (Range){fmax(light.interval.low + own, 0), light.interval.high + own});
    judge_ambient(&c, sweep->run->profile, light.sun_first > CASE_SUNLIT * reflected);
    return c;
}

/* ---- what is told of them ---------------------------------------------------------------- */

Told told_start(int count, Arena *arena)
{
    float *numbers = ARENA_NEW(arena, float, 8 * (size_t)count);
    return (Told){numbers, numbers + count, numbers + 2 * count, numbers + 3 * count,
                  numbers + 4 * count, numbers + 5 * count, numbers + 6 * count,
                  numbers + 7 * count,
                  ARENA_NEW(arena, unsigned char, count),
                  ARENA_NEW(arena, unsigned char, count), -1};
}

/* Worse: by its verdict, then by its margin, then by its contrast. */
bool told_is_worse(const Told *told, int sun, int than)
{
    if (than < 0) return true;
    int rank = verdict_rank(told->verdict[sun]), other = verdict_rank(told->verdict[than]);
    if (rank != other) return rank > other;
    float margin = told->margin[sun], before = told->margin[than];
    if (!isnan(margin) && !isnan(before) && margin != before) return margin < before;
    return told->contrast[sun] < told->contrast[than];
}

#define TELL_CHUNK 256 /* suns of one piece of work */
#define TELL_BYTES ((size_t)1 << 20) /* scratch of a worker */

typedef struct TellWork {
    const Sweep    *sweep;
    const Sight    *sight;
    const FarTools *tools;
    Told           *told;
    Arena          *scratch; /* one a worker */
} TellWork;

static void tell_sun(const TellWork *work, int sun, Arena scratch)
{
    Told      *told = work->told;
    ReviewCase c = case_at(work->sweep, work->sight, work->tools, sun);
    judge_case(&c, work->sweep->run->profile, &scratch);
    told->contrast[sun] = (float)c.contrast_ratio;
    told->low[sun] = (float)c.contrast_low;
    told->high[sun] = (float)c.contrast_high;
    told->margin[sun] = (float)c.margin;
    told->reflected[sun] = (float)c.luminance_cd_m2.reflected;
    told->mirror[sun] = (float)c.luminance_cd_m2.mirror;
    told->level[sun] = (float)c.level;
    told->lux[sun] = (float)c.display_lux;
    told->verdict[sun] = (unsigned char)c.verdict;
    told->ambient[sun] = (unsigned char)c.ambient;
}

static void tell_chunk(void *user, int item, int worker)
{
    const TellWork *work = user;
    int first = item * TELL_CHUNK, end = first + TELL_CHUNK, count = work->sweep->suns.count;
    for (int sun = first; sun < end && sun < count; sun++)
        tell_sun(work, sun, work->scratch[worker]);
}

void told_tell(const Sweep *sweep, const Sight *sight, const FarTools *tools, Told *told,
               Arena room)
{
    int      count = sweep->suns.count, threads = sweep->run->threads;
    TellWork work = {sweep, sight, tools, told, NULL};
    work.scratch = ARENA_NEW(&room, Arena, threads);
    for (int i = 0; i < threads; i++) work.scratch[i] = arena_reserve(TELL_BYTES);
    parallel_for(threads, (count + TELL_CHUNK - 1) / TELL_CHUNK, tell_chunk, &work);
    for (int i = 0; i < threads; i++) arena_release(&work.scratch[i]);
    for (int sun = 0; sun < count; sun++)
        if (told_is_worse(told, sun, told->worst)) told->worst = sun;
}

/* By its figure, and for sure. */
static StepState state_of(const Told *told, int sun)
{
    if (told->verdict[sun] == VERDICT_FAIL) return STEP_FAILS_SURELY;
    return told->margin[sun] < 0 ? STEP_FAILS : STEP_PASSES;
}

void told_states(const Told *told, int count, unsigned char *states)
{
    for (int i = 0; i < count; i++) states[i] = (unsigned char)state_of(told, i);
}
