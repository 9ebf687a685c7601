/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/sun_figures.h"

#include <math.h>

#include "base/parallel.h"
#include "review/judge.h"
#include "review/run/case_visibility.h"
#include "review/suns/sweep_suns.h"

/* ---- reading them ------------------------------------------------------------------------ */

static double level_for(const Sweep *sweep, const Sight *sight, int sun)
{
    double lux = sweep->sensor ? sweep->sensor->lux[sun] + sweep->sensor->own.lamps : 0;
    return setup_level_of(sweep->setup, sweep->level, sight->symbol->display.display_id,
                          sight->symbol->display_name, lux);
}

/* The figures of a case under one sun, behind lenses that are grey in sweeps; the caller judges
 * its limits. Levels of visibility are made only for those. */
static ReviewCase case_at(const Sweep *sweep, const Sight *sight, const DistantTools *tools,
                          int sun, Arena *arena)
{
    const ReviewGlasses *glasses = sweep->setup->condition->glasses;
    DistantReading light =
        sight->read ? sight->read[sun] : distant_probe_read(&sight->probe, tools, sun);
    double     level = level_for(sweep, sight, sun);
    double     own = sight->own.lamps + level * sight->own.displays;
    double     reflected = distant_reading_sum(light) + own;
    ReviewCase c = {.level = level, .limit_id = -1, .visible_share = sight->seen.visible_share,
                    .height_arcmin = sight->height_arcmin,
                    .stroke_ratio = symbol_stroke_ratio(sight->symbol),
                    .panel = sight->symbol->panel};
    c.display_lux = sight->face->lux[sun] + sight->face->own.lamps +
                    level * sight->face->own.displays;
    c.glasses_transmittance = glasses ? glasses->transmittance : 1;
    if (profile_has(sweep->run->profile, LIMIT_VISIBILITY_LEVEL))
        case_visibility_start(sweep->run->request, &sight->symbol->split, &c, arena);
    c.luminance_cd_m2 = (CaseLuminances){
        level * sight->shown.foreground, level * sight->shown.background, reflected,
        light.mirror, reflected - light.mirror, (double)NAN};
    judge_contrasts(&c, (MeanInterval){fmax(light.interval.low + own, 0),
                                       light.interval.high + own});
    judge_ambient(&c, sweep->run->profile, light.sun_first > CASE_SUNLIT * reflected);
    return c;
}

/* ---- all suns ---------------------------------------------------------------------------- */

SunFigures sun_figures_start(int count, Arena *arena)
{
    float *numbers = ARENA_NEW(arena, float, 8 * (size_t)count);
    return (SunFigures){numbers, numbers + count, numbers + 2 * count, numbers + 3 * count,
                        numbers + 4 * count, numbers + 5 * count, numbers + 6 * count,
                        numbers + 7 * count,
                        ARENA_NEW(arena, unsigned char, count),
                        ARENA_NEW(arena, unsigned char, count), -1};
}

/* Worse: by its verdict, then by its margin, then by its contrast. */
static bool is_worse(const SunFigures *figures, int sun, int than)
{
    if (than < 0) return true;
    int rank = verdict_rank(figures->verdict[sun]);
    int other = verdict_rank(figures->verdict[than]);
    if (rank != other) return rank > other;
    float margin = figures->margin[sun], before = figures->margin[than];
    if (!isnan(margin) && !isnan(before) && margin != before) return margin < before;
    return figures->contrast[sun] < figures->contrast[than];
}

int sun_figures_next(const SunFigures *figures, const SweepSuns *suns, FarSteps of,
                     const SweepSun *others, int count)
{
    int next = -1;
    for (int sun = 0; sun < suns->count; sun++) {
        bool is_new = !of.fail || figures->verdict[sun] == VERDICT_FAIL;
        for (int i = 0; i < count && is_new; i++)
            is_new = sweep_suns_apart_deg(&suns->list[sun], &others[i]) > of.apart_deg;
        if (is_new && is_worse(figures, sun, next)) next = sun;
    }
    return next;
}

const LimitVerdict *const *sun_figures_limits(const Sight *sight, const Profile *profile,
                                              Arena *arena)
{
    const LimitVerdict **asked = ARENA_NEW(arena, const LimitVerdict *, AMBIENT_COUNT);
    for (int ambient = 0; ambient < AMBIENT_COUNT; ambient++) {
        ReviewCase c = {.ambient = (Ambient)ambient, .visible_share = sight->seen.visible_share,
                        .height_arcmin = sight->height_arcmin};
        judge_case(&c, profile, arena);
        asked[ambient] = c.limit_id >= 0 ? &c.limits[c.limit_id] : NULL;
    }
    return asked;
}

#define JUDGE_CHUNK 256 /* suns of one piece of work */
#define JUDGE_BYTES ((size_t)1 << 20) /* scratch of a worker */

typedef struct JudgeWork {
    const Sweep    *sweep;
    const Sight    *sight;
    const DistantTools *tools;
    SunFigures     *figures;
    Arena          *scratch; /* one a worker */
} JudgeWork;

static void judge_sun(const JudgeWork *work, int sun, Arena scratch)
{
    SunFigures *figures = work->figures;
    ReviewCase c = case_at(work->sweep, work->sight, work->tools, sun, &scratch);
    judge_case(&c, work->sweep->run->profile, &scratch);
    figures->contrast[sun] = (float)c.contrast_ratio;
    figures->low[sun] = (float)c.contrast_low;
    figures->high[sun] = (float)c.contrast_high;
    figures->margin[sun] = (float)c.margin;
    figures->reflected[sun] = (float)c.luminance_cd_m2.reflected;
    figures->mirror[sun] = (float)c.luminance_cd_m2.mirror;
    figures->level[sun] = (float)c.level;
    figures->lux[sun] = (float)c.display_lux;
    figures->verdict[sun] = (unsigned char)c.verdict;
    figures->ambient[sun] = (unsigned char)c.ambient;
}

static void judge_chunk(void *user, int item, int worker)
{
    const JudgeWork *work = user;
    int first = item * JUDGE_CHUNK, end = first + JUDGE_CHUNK, count = work->sweep->suns.count;
    for (int sun = first; sun < end && sun < count; sun++)
        judge_sun(work, sun, work->scratch[worker]);
}

void sun_figures_judge(const Sweep *sweep, const Sight *sight, const DistantTools *tools,
                       SunFigures *figures, Arena room)
{
    int      count = sweep->suns.count, threads = sweep->run->means.threads;
    JudgeWork work = {sweep, sight, tools, figures, NULL};
    work.scratch = ARENA_NEW(&room, Arena, threads);
    for (int i = 0; i < threads; i++) work.scratch[i] = arena_reserve(JUDGE_BYTES);
    parallel_for(threads, (count + JUDGE_CHUNK - 1) / JUDGE_CHUNK, judge_chunk, &work);
    for (int i = 0; i < threads; i++) arena_release(&work.scratch[i]);
    for (int sun = 0; sun < count; sun++)
        if (is_worse(figures, sun, figures->worst)) figures->worst = sun;
}

/* By its figure, and for sure. */
static StepState state_of(const SunFigures *figures, int sun)
{
    if (figures->verdict[sun] == VERDICT_FAIL) return STEP_FAILS_SURELY;
    return figures->margin[sun] < 0 ? STEP_FAILS : STEP_PASSES;
}

void sun_figures_states(const SunFigures *figures, int count, unsigned char *states)
{
    for (int i = 0; i < count; i++) states[i] = (unsigned char)state_of(figures, i);
}
