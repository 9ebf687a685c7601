/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/gaze_paths.h"

#include <math.h>

#include "base/parallel.h"
#include "base/sampler.h"
#include "base/units.h"
#include "render/signals.h"
#include "review/eye/lamps_unmet.h"

/* One over the root of x^3 = x + 1, and its square: points that fill a square evenly, however
 * many (M. Roberts' sequence). */
#define STEP_U 0.7548776662466927
#define STEP_V 0.5698402909980532
#define SHIFT_U 0x75u
#define SHIFT_V 0x76u
#define CHUNK 32 /* paths that are aimed together */

/* ---- the cone ---------------------------------------------------------------------------- */

static double fraction(double x)
{
    return x - floor(x);
}

static double shift_of(uint32_t seed, uint32_t axis)
{
    return hash_combine(hash_u32(seed), axis) * 0x1p-32;
}

/* Path i of a batch. Even over the cone's solid angle; each batch's points are shifted as one
 * (Cranley and Patterson 1976), so that batches differ in nothing but chance. */
static Vec3 target_of(const GazePaths *paths, uint32_t seed, int i)
{
    double u = fraction(shift_of(seed, SHIFT_U) + STEP_U * i);
    double v = fraction(shift_of(seed, SHIFT_V) + STEP_V * i);
    double cosine = 1 - (1 - cos(radians_from_degrees(GAZE_CONE_DEG))) * u;
    double sine = sqrt(1 - cosine * cosine), phi = 2 * PI * v;
    Vec3   d = vec3((float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)cosine);
    return vec3_add(paths->eye, frame_to_world(&paths->frame, d));
}

/* ---- what paths find --------------------------------------------------------------------- */

static bool is_pane(const Scene *scene, int part_id)
{
    return scene->materials[scene->parts[part_id].material_id].transmission > 0;
}

/* The step at which a pane mirrors what the eye sees there; NO_ID: none does. */
static int mirroring_step(const Scene *scene, const PathHistory *history)
{
    int kept = path_steps_kept(history), i = 0;
    while (i < kept && history->step[i].event == PATH_TRANSMITS) i++;
    bool mirrors = i < kept && history->step[i].event == PATH_REFLECTS &&
                   is_pane(scene, history->step[i].part_id);
    return mirrors ? i : NO_ID;
}

/* By no more surfaces than are kept: of others nobody knows. */
static bool is_by_mirrors(const PathHistory *history)
{
    if (history->count > PATH_STEPS_MAX) return false;
    for (int i = 0; i < history->count; i++)
        if (history->step[i].event == PATH_SCATTERS) return false;
    return true;
}

/* Straight, or through panes with a thickness. */
static bool is_suns_disc(const PathHistory *history)
{
    for (int i = 0; i < path_steps_kept(history); i++)
        if (history->step[i].event != PATH_TRANSMITS) return false;
    return history->source == LIGHTS_SUN;
}

static int place_shown(const Scene *scene, const PathHistory *history, int from)
{
    for (int i = from + 1; i < path_steps_kept(history); i++)
        if (!is_pane(scene, history->step[i].part_id)) return history->step[i].part_id;
    return history->source == LIGHTS_EMITTERS ? history->source_id
                                              : scene->part_count + (int)history->source;
}

static void on_light(void *user, const PathHistory *history, const float xyz[3])
{
    GazeBatch *batch = user;
    if (is_suns_disc(history) || is_by_mirrors(history) != batch->by_mirrors) return;
    int        step = mirroring_step(batch->scene, history);
    GazeFigure figure = step == NO_ID ? GAZE_THROUGH : GAZE_MIRRORED;
    batch->path[figure] += (double)xyz[1];
    if (batch->by_mirrors && history->source == LIGHTS_EMITTERS)
        batch->met[figure][history->source_id] = true;
    if (step == NO_ID) return;
    batch->panes[history->step[step].part_id] += (double)xyz[1];
    batch->shown[place_shown(batch->scene, history, step)] += (double)xyz[1];
}

static int mirrors_of(const PathHistory *history)
{
    int count = 0;
    for (int i = 0; i < path_steps_kept(history); i++)
        count += history->step[i].event == PATH_REFLECTS;
    return count;
}

static void on_mirror(void *user, const PathHistory *history, Vec3 towards, float share)
{
    GazeBatch *batch = user;
    bool       is_mirrored = mirroring_step(batch->scene, history) != NO_ID;
    GazeFigure figure = is_mirrored ? GAZE_MIRRORED : GAZE_THROUGH;
    int        again = mirrors_of(history) > 1, *count = &batch->images[figure][again];
    if (history->count > PATH_STEPS_MAX || *count == GAZE_IMAGES) return;
    Vec3 from = history->step[history->count - 1].position;
    batch->image[figure][again][(*count)++] =
        (GazeImage){(Ray){from, towards, 0, INFINITY}, share};
}

/* ---- batches ----------------------------------------------------------------------------- */

static void trace_one(const GazePaths *paths, const ProbeAim *aim, int i, GazeBatch *batch)
{
    PathListener listener = {.on_light = on_light, .on_mirror = on_mirror, .user = batch,
                             .reach = paths->by_mirrors ? PATH_BY_MIRRORS : PATH_TO_ITS_END};
    PathStatistics statistics = {0};
    batch->path[GAZE_THROUGH] = batch->path[GAZE_MIRRORED] = 0;
    paths->setup->tools.kernel->trace(aim, i, i + 1, &listener, &statistics);
    for (int k = 0; k < GAZE_FIGURES; k++) {
        batch->sum[k] += batch->path[k];
        bright_add(&batch->bright[k], batch->path[k]);
    }
}

static void read_batch(void *user, int item, int worker)
{
    (void)worker;
    const GazePaths *paths = user;
    uint32_t seed = hash_combine(hash_u32(paths->seed), (uint32_t)item);
    Vec3     targets[CHUNK];
    ProbeAim aim = {.context = &paths->setup->context, .eye = paths->eye, .targets = targets,
                    .target_count = CHUNK, .seed = seed};
    for (int i = paths->first; i < paths->end; i++) {
        if (signals_stop_requested()) return;
        targets[i % CHUNK] = target_of(paths, seed, i);
        trace_one(paths, &aim, i, &paths->batches[item]);
    }
}

GazePaths gaze_paths_start(const Setup *setup, const GazeAim *gaze, bool by_mirrors,
                           uint32_t seed, Arena *arena)
{
    int       parts = setup->scene->part_count;
    GazePaths paths = {.setup = setup, .eye = gaze->eye, .seed = seed,
                       .frame = frame_from_z(vec3_normalize(gaze->towards)),
                       .by_mirrors = by_mirrors,
                       .batches = ARENA_NEW(arena, GazeBatch, ESTIMATE_BATCHES)};
    for (int b = 0; b < ESTIMATE_BATCHES; b++) {
        GazeBatch *batch = &paths.batches[b];
        batch->scene = setup->scene;
        batch->by_mirrors = by_mirrors;
        batch->panes = ARENA_NEW(arena, double, parts);
        batch->shown = ARENA_NEW(arena, double, parts + LIGHT_SETS);
        for (int k = 0; k < GAZE_FIGURES; k++) batch->met[k] = ARENA_NEW(arena, bool, parts);
    }
    return paths;
}

/* ---- figures ----------------------------------------------------------------------------- */

/* What no path met of lamps that the eye may see there, straight or by the mirrors that paths
 * came by. */
static double unmet(const GazePaths *paths, GazeFigure figure, Arena scratch)
{
    const Setup *setup = paths->setup;
    int    parts = setup->scene->part_count;
    bool  *met = ARENA_NEW(&scratch, bool, parts);
    double most = 0, half = radians_from_degrees(GAZE_CONE_DEG);
    for (int b = 0; b < ESTIMATE_BATCHES; b++)
        for (int i = 0; i < parts; i++) met[i] |= paths->batches[b].met[figure][i];
    UnmetLamps lamps = lamps_unmet(setup, met, &scratch);
    if (figure == GAZE_THROUGH)
        most = lamps_brightest(&lamps, (Ray){paths->eye, paths->frame.z, 0, INFINITY}, half);
    for (int i = 0; i < ESTIMATE_BATCHES * 2 * GAZE_IMAGES; i++) {
        const GazeBatch *batch = &paths->batches[i / 2 / GAZE_IMAGES];
        int again = i / GAZE_IMAGES % 2, k = i % GAZE_IMAGES;
        if (k >= batch->images[figure][again]) continue;
        const GazeImage *image = &batch->image[figure][again][k];
        most = fmax(most, (double)image->share * lamps_brightest(&lamps, image->ray, half));
    }
    return most;
}

void gaze_paths_read(GazePaths *paths, long count, Arena scratch)
{
    paths->end = (int)(count / ESTIMATE_BATCHES);
    parallel_for(paths->setup->tools.threads, ESTIMATE_BATCHES, read_batch, paths);
    paths->first = paths->end;
    for (int k = 0; k < GAZE_FIGURES && paths->by_mirrors; k++)
        paths->unmet[k] = unmet(paths, (GazeFigure)k, scratch);
}

EstimateSums gaze_paths_sums(const GazePaths *paths, GazeFigure figure)
{
    EstimateSums sums = {.batches = ESTIMATE_BATCHES, .piece = 1, .share = 1,
                         .paths = (long)paths->end * ESTIMATE_BATCHES};
    for (int b = 0; b < ESTIMATE_BATCHES; b++) {
        const GazeBatch *batch = &paths->batches[b];
        sums.batch[b] = batch->sum[figure];
        sums.bright.squares += batch->bright[figure].squares;
        sums.bright.fourths += batch->bright[figure].fourths;
    }
    sums.unmet = estimate_unmet(paths->unmet[figure], (double)sums.paths);
    return sums;
}

void gaze_paths_places(const GazePaths *paths, double weight, double *panes, double *shown)
{
    int parts = paths->setup->scene->part_count;
    for (int b = 0; b < ESTIMATE_BATCHES; b++) {
        const GazeBatch *batch = &paths->batches[b];
        for (int i = 0; i < parts; i++) panes[i] += weight * batch->panes[i];
        for (int i = 0; i < parts + LIGHT_SETS; i++) shown[i] += weight * batch->shown[i];
    }
}
