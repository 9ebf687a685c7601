/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/road_steps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "review/keep/frame_kept.h"
#include "review/road_verdict.h"
#include "review/run/gazes.h"
#include "review/run/sweep.h"
#include "review/suns/sweep_suns.h"

int road_steps_choose(int count, int most, int *chosen)
{
    int used = count < most ? count : most;
    for (int k = 0; k < used; k++)
        chosen[k] = used > 1 ? (int)((long)k * (count - 1) / (used - 1)) : count / 2;
    return used;
}

/* ---- which suns -------------------------------------------------------------------------- */

typedef struct RoadSun {
    const SweepSun *sun;
    int             place;
} RoadSun;

typedef struct RoadSuns {
    ReviewCondition night; /* the condition with its nights */
    SweepSuns       all;
    RoadSun        *down;  /* of them in twilight, the highest first */
    int             down_count;
    int             first; /* of these that counts */
    int            *chosen; /* among these */
    int             chosen_count;
} RoadSuns;

static int compare_heights(const void *a, const void *b)
{
    const RoadSun *p = a, *q = b;
    double         x = p->sun->elevation_deg, y = q->sun->elevation_deg;
    return x != y ? (x < y ? 1 : -1) : p->place - q->place;
}

static const ReviewRoad *road_named(const ReviewRequest *request, const char *gaze)
{
    for (int i = 0; i < request->gaze_count; i++)
        if (request->gazes[i].name && !strcmp(request->gazes[i].name, gaze))
            return request->gazes[i].road;
    return NULL;
}

static int most_steps(const ReviewRequest *request, const GazeFinding *found, int count)
{
    int most = 0;
    for (int i = 0; i < count; i++) {
        const ReviewRoad *road = road_named(request, found[i].gaze);
        if (road && road->twilight_steps > most) most = road->twilight_steps;
    }
    return most;
}

/* No part of the sun is up. */
static RoadSuns *suns_of(const Setup *setup, int most, Arena *arena)
{
    RoadSuns *suns = ARENA_NEW(arena, RoadSuns, 1);
    suns->night = *setup->condition;
    suns->night.with_night = true;
    suns->all = sweep_suns(&suns->night, setup->tools.threads, arena);
    suns->down = ARENA_NEW(arena, RoadSun, suns->all.count + 1);
    suns->chosen = ARENA_NEW(arena, int, most);
    for (int i = 0; i < suns->all.count; i++)
        if (suns->all.list[i].elevation_deg < -SUN_MEAN_RADIUS_DEG)
            suns->down[suns->down_count++] = (RoadSun){&suns->all.list[i], i};
    if (suns->down_count)
        qsort(suns->down, (size_t)suns->down_count, sizeof *suns->down, compare_heights);
    return suns;
}

/* Those that are nearer to it than to the other chosen ones. */
static double minutes_about(const RoadSuns *suns, int k)
{
    int    at = suns->chosen[k], first = suns->first, end = suns->down_count;
    double sum = 0;
    if (k > 0) first = (suns->chosen[k - 1] + at + 1) / 2;
    if (k + 1 < suns->chosen_count) end = (at + suns->chosen[k + 1] + 1) / 2;
    for (int i = first; i < end; i++) sum += suns->down[i].sun->minutes;
    return suns->all.has_time ? sum : (double)NAN;
}

/* ---- one step ---------------------------------------------------------------------------- */

/* Lux of the sky on level ground; 0: it is dark. */
static bool sky_lux(const Environment *sky, Arena scratch, double *out, Error *err)
{
    Daylight      daylight;
    DaylightInput input = sky->daylight;
    *out = 0;
    if (sky->kind == ENVIRONMENT_NONE) return true;
    input.has_sun = sky->has_sun;
    input.sun_azimuth = (double)sky->sun_azimuth;
    input.sun_elevation = (double)sky->sun_elevation;
    if (sky->has_sun) input.sun_lux = (double)sky->sun_illuminance_lx;
    if (!daylight_build(&input, &scratch, &daylight, err)) return false;
    *out = daylight.metrics.diffuse_horizontal_lx;
    return true;
}

/* Does the sky light one of the roads no more than its lamps do? */
static bool is_dark_enough(const ReviewRoad *road, double lux)
{
    return !(road->sky_cd_m2_per_lx * lux > road->luminance_cd_m2);
}

static bool any_dark_enough(const ReviewRequest *request, double lux)
{
    for (int i = 0; i < request->gaze_count; i++) {
        const ReviewRoad *road = request->gazes[i].road;
        if (road && road->twilight_steps && is_dark_enough(road, lux)) return true;
    }
    return false;
}

/* From which sun on: the light falls with it. */
static bool choose(RoadSuns *suns, const Setup *setup, int most, Arena scratch, Error *err)
{
    int low = 0, high = suns->down_count;
    while (low < high) {
        int         middle = (low + high) / 2;
        Environment sky = sweep_environment(setup, suns->down[middle].sun);
        double      lux;
        if (!sky_lux(&sky, scratch, &lux, err)) return false;
        *(any_dark_enough(setup->request, lux) ? &high : &low) =
            any_dark_enough(setup->request, lux) ? middle : middle + 1;
    }
    suns->first = low;
    suns->chosen_count = road_steps_choose(suns->down_count - low, most, suns->chosen);
    for (int k = 0; k < suns->chosen_count; k++) suns->chosen[k] += low;
    return true;
}

/* The request with its roads as twilight lights them. */
static ReviewRequest request_under(const ReviewRequest *of, double lux, Arena *arena)
{
    ReviewRequest out = *of;
    ReviewGaze   *gazes = ARENA_NEW(arena, ReviewGaze, of->gaze_count);
    out.gazes = gazes;
    for (int i = 0; i < of->gaze_count; i++) {
        gazes[i] = of->gazes[i];
        if (!gazes[i].road) continue;
        ReviewRoad *road = ARENA_NEW(arena, ReviewRoad, 1);
        *road = *gazes[i].road;
        road->luminance_cd_m2 += road->sky_cd_m2_per_lx * lux;
        gazes[i].road = road;
    }
    return out;
}

/* What a step is, besides its ages. */
static RoadStep step_of(const RoadSuns *suns, int k, double lux, Arena *arena)
{
    const SweepSun *sun = suns->down[suns->chosen[k]].sun;
    return (RoadStep){.when = sweep_suns_when(&suns->night, &suns->all, sun, arena),
                      .sun_azimuth_deg = sun->azimuth_deg,
                      .sun_elevation_deg = sun->elevation_deg, .sky_lx = lux,
                      .minutes = minutes_about(suns, k)};
}

static void add_step(GazeRoad *to, const GazeRoad *from, RoadStep step)
{
    step.road_cd_m2 = from->luminance_cd_m2;
    for (int i = 0; i < from->age_count; i++) {
        const RoadAge *age = &from->ages[i];
        step.age_years = age->age_years;
        step.veil = age->veil;
        step.veil_range = age->veil_range;
        step.increment_pct = age->increment_pct;
        step.increment_range = age->increment_range;
        step.displays_share = 0;
        for (int d = 0; d < age->display_count; d++)
            step.displays_share += age->displays[d].share;
        step.margin = age->limit.margin;
        step.verdict = from->has_limit ? age->limit.verdict : VERDICT_UNJUDGED;
        to->steps[to->step_count++] = step;
    }
}

/* ---- all of them ------------------------------------------------------------------------- */

typedef struct RoadWalk {
    const RoadStepsArgs *args;
    const ReviewRequest *request; /* without twilight's light */
    const RoadSuns      *suns;
    Setup                before;
    GazeFinding         *found, *worst;
    int                  count;
    Arena               *arena;
} RoadWalk;

static void keep_step(const RoadWalk *walk, int i, const GazeFinding *of, RoadStep step)
{
    GazeRoad *to = walk->found[i].road;
    const ReviewRoad *asked = road_named(walk->request, of->gaze);
    if (!to->steps || of->road->left_out || !is_dark_enough(asked, step.sky_lx)) return;
    add_step(to, of->road, step);
    if (!road_is_worse(of, &walk->worst[i])) return;
    walk->worst[i] = *of;
    walk->worst[i].road->when =
        step.when ? step.when
                  : arena_format(walk->arena, "sun %.1f degrees below the horizon",
                                 -step.sun_elevation_deg);
}

static bool walk_step(const RoadWalk *walk, int k, Arena scratch, Error *err)
{
    const RoadStepsArgs *args = walk->args;
    const SweepSun *sun = walk->suns->down[walk->suns->chosen[k]].sun;
    MomentShare     all = {{0, 0}, 0, 1};
    double          lux;
    Environment     sky = sweep_environment(args->setup, sun);
    GazeFinding    *of = ARENA_NEW(walk->arena, GazeFinding, walk->count);
    if (!review_goes_on(args->run->means.journal, err) ||
        !sky_lux(&sky, scratch, &lux, err) ||
        !setup_light_again(args->setup, &walk->before, &sky, &scratch, err))
        return false;
    ReviewRequest request = request_under(walk->request, lux, &scratch);
    GazesArgs     looks = {args->setup, &all, args->run->sun_searches, args->run->profile, NULL,
                           0, true};
    args->setup->request = &request;
    bool ok = setup_gazes(&looks, walk->arena, of, err);
    args->setup->request = walk->request;
    RoadStep step = step_of(walk->suns, k, lux, walk->arena);
    for (int i = 0; ok && i < walk->count; i++) keep_step(walk, i, &of[i], step);
    return ok;
}

/* After dark is the first of a road's steps. */
static void start_steps(const RoadWalk *walk)
{
    const double nan = (double)NAN;
    const RoadStep dark = {.sun_azimuth_deg = nan, .sun_elevation_deg = nan, .minutes = nan};
    for (int i = 0; i < walk->count; i++) {
        GazeRoad         *road = walk->found[i].road;
        const ReviewRoad *asked = road_named(walk->request, walk->found[i].gaze);
        walk->worst[i] = walk->found[i];
        if (!asked || !asked->twilight_steps) continue;
        road->steps = ARENA_NEW(walk->arena, RoadStep,
                                (walk->suns->chosen_count + 1) * road->age_count);
        road->twilight_count = walk->suns->down_count - walk->suns->first;
        add_step(road, road, dark);
    }
}

static void take_worst(const RoadWalk *walk)
{
    for (int i = 0; i < walk->count; i++) {
        GazeRoad *after_dark = walk->found[i].road, *worst = walk->worst[i].road;
        if (worst == after_dark) continue;
        worst->steps = after_dark->steps;
        worst->step_count = after_dark->step_count;
        worst->twilight_count = after_dark->twilight_count;
        walk->found[i] = walk->worst[i];
    }
}

bool road_steps_find(const RoadStepsArgs *args, GazeFinding *found, int count, Arena *arena,
                     Error *err)
{
    Setup     *setup = args->setup;
    int        most = most_steps(setup->request, found, count);
    Work      *work = args->run->work;
    if (!most) return true;
    Arena    scratch = arena_reserve((size_t)1 << 36);
    RoadWalk walk = {.args = args, .request = setup->request, .found = found, .count = count,
                     .before = *setup, .arena = arena,
                     .worst = ARENA_NEW(&scratch, GazeFinding, count)};
    RoadSuns *suns = suns_of(setup, most, &scratch);
    bool      ok = choose(suns, setup, most, scratch, err) &&
                   setup_before_light(&walk.before, &scratch, err);
    WorkPlan none = {{0}}, plan = work_of_looks(count * suns->chosen_count);
    walk.suns = suns;
    work_replan(work, &none, &plan);
    start_steps(&walk);
    for (int k = 0; ok && k < walk.suns->chosen_count; k++) {
        ok = walk_step(&walk, k, scratch, err);
        work_add(work, WORK_LOOK, work_of_looks(count).of[WORK_LOOK]);
    }
    take_worst(&walk);
    arena_release(&scratch);
    return ok;
}
