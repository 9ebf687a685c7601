/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/gaze_reading.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "base/sampler.h"
#include "estimate/estimate_plan.h"
#include "render/signals.h"
#include "review/light/question.h"

#define SEED 0x67617a65u
#define PILOT_SEED 0x70696c6fu
#define MIRROR_SEED 0x6d697272u
#define LEAST 2048   /* whole paths */
#define PILOT 1024
#define REACH 32     /* estimate_plan.h */
#define MIRRORS 4    /* so many times as many by mirrors, at least: they take a third of the
                        time */
#define UNMET 0.1    /* of all light there: what lamps may have that no path met */

/* Paths of both kinds. */
typedef struct GazePair {
    const GazeGoal *goal;
    GazePaths       whole, mirrors;
    long            whole_paths, mirror_paths; /* that will do */
    Arena           scratch;
} GazePair;

static GazePair start(const Setup *setup, const GazeGoal *goal, uint32_t seed, Arena *scratch)
{
    GazePair pair = {.goal = goal};
    GazeAim  aim = {goal->eye, goal->towards};
    pair.whole = gaze_paths_start(setup, &aim, false, seed, scratch);
    pair.mirrors = gaze_paths_start(setup, &aim, true, seed ^ MIRROR_SEED, scratch);
    pair.scratch = *scratch;
    return pair;
}

/* ---- how many ---------------------------------------------------------------------------- */

static void read_mirrors(void *user, long paths)
{
    GazePair *pair = user;
    gaze_paths_read(&pair->mirrors, paths, pair->scratch);
}

static void read_whole(void *user, long paths)
{
    GazePair *pair = user;
    gaze_paths_read(&pair->whole, paths, pair->scratch);
}

/* Of the variance that may be, by mirrors; the rest is left to whole paths, which cost more. */
#define MIRRORS_SHARE 0.5

/* One figure of both kinds. */
typedef struct FigurePair {
    Estimate whole, mirrors;
} FigurePair;

static FigurePair found_by(const GazePair *pair, GazeFigure figure)
{
    EstimateSums whole = gaze_paths_sums(&pair->whole, figure);
    EstimateSums mirrors = gaze_paths_sums(&pair->mirrors, figure);
    return (FigurePair){estimate_of(&whole), estimate_of(&mirrors)};
}

static bool mirrors_will_do(void *user, long pilot, long paths)
{
    const GazePair *pair = user;
    double all = 0, unmet = 0;
    for (int k = 0; k < GAZE_FIGURES; k++) {
        FigurePair found = found_by(pair, (GazeFigure)k);
        Estimate   then = estimate_expected(&found.mirrors, (double)paths / (double)pilot);
        double     mean = found.whole.mean + found.mirrors.mean;
        if (then.sigma > pair->goal->precision * mean * sqrt(MIRRORS_SHARE)) return false;
        all += mean;
        unmet = fmax(unmet, then.unmet);
    }
    return unmet <= UNMET * all;
}

/* What mirrors are expected to leave unsure is known. */
static bool whole_will_do(void *user, long pilot, long paths)
{
    const GazePair *pair = user;
    for (int k = 0; k < GAZE_FIGURES; k++) {
        FigurePair found = found_by(pair, (GazeFigure)k);
        double     mean = found.whole.mean + found.mirrors.mean;
        double     times = (double)pair->mirror_paths / (double)(pair->mirrors.end *
                                                                 ESTIMATE_BATCHES);
        Estimate   then = estimate_expected(&found.whole, (double)paths / (double)pilot);
        Estimate   mirrors = estimate_expected(&found.mirrors, times);
        if (hypot(then.sigma, mirrors.sigma) > pair->goal->precision * mean) return false;
    }
    return true;
}

/* How many of both; by mirrors first. */
static void plan(GazePair *pilot)
{
    EstimatePlan mirrors = {.pilot = PILOT * MIRRORS, .least = LEAST * MIRRORS, .reach = REACH,
                            .most = pilot->goal->most, .user = pilot,
                            .read_pilot = read_mirrors, .will_do = mirrors_will_do};
    EstimatePlan whole = {.pilot = PILOT, .least = LEAST, .reach = REACH,
                          .most = pilot->goal->most, .user = pilot,
                          .read_pilot = read_whole, .will_do = whole_will_do};
    read_whole(pilot, PILOT);
    pilot->mirror_paths = estimate_plan(&mirrors);
    pilot->whole_paths = estimate_plan(&whole);
}

/* ---- figures ----------------------------------------------------------------------------- */

static GazeFound figure_of(const GazePair *pair, GazeFigure figure)
{
    EstimateSums sums = gaze_paths_sums(&pair->whole, figure);
    EstimateSums mirrors = gaze_paths_sums(&pair->mirrors, figure);
    estimate_sums_add(&sums, &mirrors);
    Estimate estimate = estimate_of(&sums);
    return (GazeFound){estimate.mean, estimate.sigma, estimate.interval};
}

/* NO_ID: all are 0. */
static int greatest(const double *values, int count)
{
    int at = NO_ID;
    for (int i = 0; i < count; i++)
        if (values[i] > (at == NO_ID ? 0 : values[at])) at = i;
    return at;
}

static GazeMirrored find_mirrored(const GazePair *pair)
{
    Arena   scratch = pair->scratch;
    int     parts = pair->whole.setup->scene->part_count;
    double *panes = ARENA_NEW(&scratch, double, parts);
    double *shown = ARENA_NEW(&scratch, double, parts + LIGHT_SETS);
    gaze_paths_places(&pair->whole, 1.0 / pair->whole.end, panes, shown);
    gaze_paths_places(&pair->mirrors, 1.0 / pair->mirrors.end, panes, shown);
    int most = greatest(shown, parts + LIGHT_SETS);
    return (GazeMirrored){greatest(panes, parts), most < parts ? most : NO_ID,
                          most < parts ? LIGHTS_SUN : (LightSet)(most - parts)};
}

static GazeReading read_gaze(const Setup *setup, const GazeGoal *goal, Arena scratch)
{
    uint32_t seed = review_seed(setup->request, SEED);
    uint32_t first = hash_combine(hash_u32(seed), PILOT_SEED);
    GazePair pilot = start(setup, goal, first, &scratch);
    GazePair fresh = start(setup, goal, seed, &scratch);
    pilot.scratch = fresh.scratch = scratch;
    plan(&pilot);
    read_whole(&fresh, pilot.whole_paths);
    read_mirrors(&fresh, pilot.mirror_paths);
    return (GazeReading){figure_of(&fresh, GAZE_THROUGH), figure_of(&fresh, GAZE_MIRRORED),
                         find_mirrored(&fresh)};
}

static bool is_part(int id, int part_count)
{
    return id == NO_ID || (id >= 0 && id < part_count);
}

bool gaze_reading_is_sound(const GazeReading *reading, int part_count)
{
    unsigned            source;
    const GazeMirrored *most = &reading->most;
    memcpy(&source, &most->source, sizeof source);
    return isfinite(reading->through.mean) && isfinite(reading->mirrored.mean) &&
           is_part(most->pane_id, part_count) && is_part(most->part_id, part_count) &&
           source < LIGHT_SETS;
}

GazeReading gaze_read(const Setup *setup, const GazeGoal *goal, Arena scratch)
{
    const ReadingTools *tools = &setup->tools;
    GazeReading reading;
    if (!tools->journal) return read_gaze(setup, goal, scratch);
    ProbeAim   aim = {.context = &setup->context, .eye = goal->eye, .targets = &goal->towards,
                      .target_count = 1, .seed = review_seed(setup->request, SEED)};
    double     numbers[] = {goal->precision, goal->most};
    Question   question = {.base = tools->base, .kind = "gaze", .numbers = numbers,
                           .number_count = COUNT_OF(numbers)};
    JournalKey key = question_key(&question, &aim, scratch);
    if (journal_find(tools->journal, key, &reading, sizeof reading) &&
        gaze_reading_is_sound(&reading, setup->scene->part_count))
        return reading;
    reading = read_gaze(setup, goal, scratch);
    if (!signals_stop_requested()) journal_add(tools->journal, key, &reading, sizeof reading);
    return reading;
}
