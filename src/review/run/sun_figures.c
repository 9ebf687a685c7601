/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/sun_figures.h"

#include <math.h>

#include "base/parallel.h"
#include "review/chain/causes.h"
#include "review/judge.h"
#include "review/run/case_visibility.h"
#include "review/suns/sweep_suns.h"

/* ---- reading them ------------------------------------------------------------------------ */

static double level_for(const Sweep *sweep, const Sight *sight, int sun) {
    double lux = sweep->sensor ? sweep->sensor->lux[sun] + sweep->sensor->own.lamps : 0;
    return setup_level_of(sweep->setup, sweep->level, sight->symbol->display.display_id,
                          sight->symbol->display_name, lux);
}

/* The figures of a case under one sun, behind lenses that are grey in sweeps; the caller judges
 * its limits. Levels of visibility are made only for those. */
static ReviewCase case_at(const Sweep *sweep, const Sight *sight, const DistantTools *tools,
                          int sun, Arena *arena) {
    const ReviewGlasses *glasses = sweep->setup->condition->glasses;
    DistantReading light = distant_probe_read(&sight->probe, tools, sun);
    double level = level_for(sweep, sight, sun);
    double own = sight->own.lamps + level * sight->own.displays;
    double reflected = distant_reading_sum(light) + own;
    ReviewCase c = {.level = level,
                    .limit_id = -1,
                    .visible_share = sight->seen.visible_share,
                    .height_arcmin = sight->height_arcmin,
                    .stroke_ratio = symbol_stroke_ratio(sight->symbol),
                    .must_not_be_read = sight->is_private,
                    .panel = sight->symbol->panel};
    c.display_lux =
        sight->face->lux[sun] + sight->face->own.lamps + level * sight->face->own.displays;
    c.glasses_transmittance = glasses ? glasses->transmittance : 1;
    if (profile_has(sweep->run->profile, LIMIT_VISIBILITY_LEVEL))
        case_visibility_start(sweep->run->request, &sight->symbol->split, &c, arena);
    c.luminance_cd_m2 = (CaseLuminances){level * sight->shown.foreground,
                                         level * sight->shown.background,
                                         reflected,
                                         light.mirror,
                                         reflected - light.mirror,
                                         (double)NAN};
    judge_contrasts(&c,
                    (MeanInterval){fmax(light.interval.low + own, 0), light.interval.high + own});
    judge_ambient(&c, sweep->run->profile, light.sun_first > CASE_SUNLIT * reflected);
    return c;
}

/* ---- what is hidden ---------------------------------------------------------------------- */

/* The share of an eye's places that see anything of it; 1 where they are not known. */
static double seeing_share(const Sweep *sweep, const Sight *sight, Arena scratch) {
    Error ignored;
    int count, seeing = 0;
    const Vec3 *points = setup_eye_points(sweep->setup, sight->eye, &count, &scratch, &ignored);
    for (int i = 0; points && i < count; i++)
        seeing +=
            symbol_visibility(&sight->symbol->surface, &sweep->setup->context, points[i], NULL)
                .visible_share > 0;
    return points ? (double)seeing / count : 1;
}

ReviewCase sun_figures_unread(const Sweep *sweep, const Sight *sight, Arena *arena) {
    ReviewCase c = review_case_unknown();
    c.condition = sweep->setup->condition->name;
    c.eye = sight->eye->name;
    c.display = sight->symbol->display_name;
    c.panel = symbol_panel(sight->symbol, arena);
    c.is_optional = review_is_optional(sweep->run->request, sight->symbol->symbol_id, sight->eye);
    c.must_not_be_read = sight->is_private;
    if (review_eye_is_wide(sight->eye)) c.eye_failed_share = 1;
    if (sight_is_seen(sight)) return c;
    c.visible_share = sight->seen.visible_share;
    case_hiders(&sight->symbol->surface, &sweep->setup->context, sight->from, &c, arena);
    if (!sight->is_private) return c;
    double seeing = seeing_share(sweep, sight, *arena);
    if (review_eye_is_wide(sight->eye)) c.eye_failed_share = seeing;
    if (seeing > 0) return c;
    c.verdict = VERDICT_PASS;
    c.unjudged = UNJUDGED_NOT;
    return c;
}

/* ---- all suns ---------------------------------------------------------------------------- */

SunFigures sun_figures_start(int count, Arena *arena) {
    float *numbers = ARENA_NEW(arena, float, 8 * (size_t)count);
    return (SunFigures){.contrast = numbers,
                        .low = numbers + count,
                        .high = numbers + 2 * count,
                        .margin = numbers + 3 * count,
                        .reflected = numbers + 4 * count,
                        .mirror = numbers + 5 * count,
                        .level = numbers + 6 * count,
                        .lux = numbers + 7 * count,
                        .verdict = ARENA_NEW(arena, unsigned char, count),
                        .worst = -1};
}

/* Worse: by its verdict, then by its margin, then by its contrast. */
static bool is_worse(const SunFigures *figures, int sun, int than) {
    if (than < 0) return true;
    int rank = verdict_rank(figures->verdict[sun]);
    int other = verdict_rank(figures->verdict[than]);
    if (rank != other) return rank > other;
    float margin = figures->margin[sun], before = figures->margin[than];
    if (!isnan(margin) && !isnan(before) && margin != before) return margin < before;
    float one = figures->contrast[sun], two = figures->contrast[than];
    return figures->is_private ? one > two : one < two;
}

int sun_figures_next(const SunFigures *figures, const SweepSuns *suns, FarSteps of,
                     const SweepSun *others, int count) {
    int next = -1;
    for (int sun = 0; sun < suns->count; sun++) {
        bool is_new = !of.fail || figures->verdict[sun] == VERDICT_FAIL;
        for (int i = 0; i < count && is_new; i++)
            is_new = sweep_suns_apart_deg(&suns->list[sun], &others[i]) > of.apart_deg;
        if (is_new && is_worse(figures, sun, next)) next = sun;
    }
    return next;
}

#define JUDGE_CHUNK 256               /* suns of one piece of work */
#define JUDGE_BYTES ((size_t)1 << 20) /* scratch of a worker */

typedef struct JudgeWork {
    const Sweep *sweep;
    const Sight *sight;
    const DistantTools *tools;
    SunFigures *figures;
    Arena *scratch; /* one a worker */
} JudgeWork;

static void judge_sun(const JudgeWork *work, int sun, Arena scratch) {
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
}

static void judge_chunk(void *user, int item, int worker) {
    const JudgeWork *work = user;
    int first = item * JUDGE_CHUNK, end = first + JUDGE_CHUNK, count = work->sweep->suns.count;
    for (int sun = first; sun < end && sun < count; sun++)
        judge_sun(work, sun, work->scratch[worker]);
}

void sun_figures_judge(const Sweep *sweep, const Sight *sight, const DistantTools *tools,
                       SunFigures *figures, Arena room) {
    int count = sweep->suns.count, threads = sweep->run->means.threads;
    figures->is_private = sight->is_private;
    JudgeWork work = {sweep, sight, tools, figures, NULL};
    work.scratch = ARENA_NEW(&room, Arena, threads);
    for (int i = 0; i < threads; i++) work.scratch[i] = arena_reserve(JUDGE_BYTES);
    parallel_for(threads, (count + JUDGE_CHUNK - 1) / JUDGE_CHUNK, judge_chunk, &work);
    for (int i = 0; i < threads; i++) arena_release(&work.scratch[i]);
    for (int sun = 0; sun < count; sun++)
        if (is_worse(figures, sun, figures->worst)) figures->worst = sun;
}

/* By its figure, and for sure. */
static StepState state_of(const SunFigures *figures, int sun) {
    if (figures->verdict[sun] == VERDICT_FAIL) return STEP_FAILS_SURELY;
    return figures->margin[sun] < 0 ? STEP_FAILS : STEP_PASSES;
}

void sun_figures_states(const SunFigures *figures, int count, unsigned char *states) {
    for (int i = 0; i < count; i++) states[i] = (unsigned char)state_of(figures, i);
}
