/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/gaze_reading.h"

#include <math.h>

#include "base/units.h"
#include "review/eye/unmet_lamps.h"
#include "review/light/reading.h"

#define SHIFT_AXIS 0x75u
#define SEED 0x67617a65u

enum { GAZE_THROUGH, GAZE_MIRRORED, GAZE_FIGURES };

/* A ray behind its last mirror, and the share of its light that the eye sees. */
typedef struct GazeImage {
    Ray ray;
    float share;
} GazeImage;

/* that a batch keeps of a figure: the first ones behind the first mirror, and as many behind
 * others; they stand for all */
#define GAZE_IMAGES 2

/* What a batch of paths found. */
typedef struct GazeBatch {
    GazeImage image[GAZE_FIGURES][2][GAZE_IMAGES];
    int images[GAZE_FIGURES][2];
    bool *met[GAZE_FIGURES]; /* [part] emitters, by mirrors alone */
    double *panes, *shown;   /* mirrored light by scene part: the pane's, and that of the
                                part it shows; then one for each set of lights */
} GazeBatch;

/* ---- what paths find --------------------------------------------------------------------- */

/* Even over the cone's solid angle. */
static Vec3 towards(KindBatch *batch, double u, double v) {
    const GazeGoal *goal = batch->paths->goal;
    Frame frame = frame_from_z(vec3_normalize(goal->towards));
    double cosine = 1 - (1 - cos(radians_from_degrees(GAZE_CONE_DEG))) * u;
    double sine = sqrt(1 - cosine * cosine), phi = 2 * PI * v;
    Vec3 d = vec3((float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)cosine);
    return frame_to_world(&frame, d);
}

/* Straight, or through panes with a thickness. */
static bool is_suns_disc(const PathHistory *history) {
    for (int i = 0; i < path_steps_kept(history); i++)
        if (history->step[i].event != PATH_TRANSMITS) return false;
    return history->source == LIGHTS_SUN;
}

static int place_shown(const Scene *scene, const PathHistory *history, int from) {
    for (int i = from + 1; i < path_steps_kept(history); i++)
        if (!path_is_pane(scene, history->step[i].part_id)) return history->step[i].part_id;
    return history->source == LIGHTS_EMITTERS ? history->source_id
                                              : scene->part_count + (int)history->source;
}

static void on_light(const ProbePart *to, const PathHistory *history, const float xyz[3]) {
    KindBatch *batch = to->own;
    GazeBatch *own = batch->own;
    const Scene *scene = batch->paths->context->scene;
    bool by_mirrors = batch->paths->by_mirrors;
    if (is_suns_disc(history) || path_is_by_mirrors(history) != by_mirrors) return;
    int step = path_mirroring_step(scene, history);
    int figure = step == NO_ID ? GAZE_THROUGH : GAZE_MIRRORED;
    batch->path[figure] += (double)xyz[1];
    if (by_mirrors && history->source == LIGHTS_EMITTERS)
        own->met[figure][history->source_id] = true;
    if (step == NO_ID) return;
    own->panes[history->step[step].part_id] += (double)xyz[1];
    own->shown[place_shown(scene, history, step)] += (double)xyz[1];
}

static void on_mirror(const ProbePart *to, const PathHistory *history, Vec3 towards, float share) {
    GazeBatch *batch = ((KindBatch *)to->own)->own;
    bool is_mirrored = path_mirroring_step(to->piece->aim.context->scene, history) != NO_ID;
    int figure = is_mirrored ? GAZE_MIRRORED : GAZE_THROUGH;
    int mirrors = 0;
    for (int i = 0; i < path_steps_kept(history); i++)
        mirrors += history->step[i].event == PATH_REFLECTS;
    int again = mirrors > 1, *count = &batch->images[figure][again];
    if (history->count > PATH_STEPS_MAX || *count == GAZE_IMAGES ||
        history->step[history->count - 1].event != PATH_REFLECTS)
        return;
    Vec3 from = history->step[history->count - 1].position;
    batch->image[figure][again][(*count)++] = (GazeImage){(Ray){from, towards, 0, INFINITY}, share};
}

/* ---- figures ----------------------------------------------------------------------------- */

/* What no path met of lamps that the eye may see there, straight or by the mirrors that paths
 * came by. */
static double unmet(const KindPaths *paths, int figure, Arena scratch) {
    if (figure >= GAZE_FIGURES) return 0;
    Vec3 ahead = frame_from_z(vec3_normalize(((const GazeGoal *)paths->goal)->towards)).z;
    int parts = paths->context->scene->part_count;
    bool *met = ARENA_NEW(&scratch, bool, parts);
    double most = 0, half = radians_from_degrees(GAZE_CONE_DEG);
    for (int b = 0; b < ESTIMATE_BATCHES; b++)
        for (int i = 0; i < parts; i++)
            met[i] |= ((const GazeBatch *)paths->batch[b].own)->met[figure][i];
    UnmetLamps lamps = lamps_unmet(paths->context, met, &scratch);
    if (figure == GAZE_THROUGH)
        most = lamps_brightest(&lamps, (Ray){paths->eye, ahead, 0, INFINITY}, half, false);
    for (int i = 0; i < ESTIMATE_BATCHES * 2 * GAZE_IMAGES; i++) {
        const GazeBatch *batch = paths->batch[i / 2 / GAZE_IMAGES].own;
        int again = i / GAZE_IMAGES % 2, k = i % GAZE_IMAGES;
        if (k >= batch->images[figure][again]) continue;
        const GazeImage *image = &batch->image[figure][again][k];
        most = fmax(most, (double)image->share * lamps_brightest(&lamps, image->ray, half, false));
    }
    return most;
}

/* ---- all of it --------------------------------------------------------------------------- */

/* Adds where mirrored light came from, each path by `weight`: [part], [part and sets]. */
static void add_places(const KindPaths *paths, double weight, double *panes, double *shown) {
    int parts = paths->context->scene->part_count;
    for (int b = 0; b < ESTIMATE_BATCHES; b++) {
        const GazeBatch *batch = paths->batch[b].own;
        for (int i = 0; i < parts; i++) panes[i] += weight * batch->panes[i];
        for (int i = 0; i < parts + LIGHT_SETS; i++) shown[i] += weight * batch->shown[i];
    }
}

/* NO_ID: all are 0. */
static int greatest(const double *values, int count) {
    int at = NO_ID;
    for (int i = 0; i < count; i++)
        if (values[i] > (at == NO_ID ? 0 : values[at])) at = i;
    return at;
}

static GazeMirrored find_mirrored(const PathKinds *pair) {
    Arena scratch = pair->scratch;
    int parts = pair->whole.context->scene->part_count;
    double *panes = ARENA_NEW(&scratch, double, parts);
    double *shown = ARENA_NEW(&scratch, double, parts + LIGHT_SETS);
    add_places(&pair->whole, 1.0 / pair->whole.end, panes, shown);
    add_places(&pair->mirrors, 1.0 / pair->mirrors.end, panes, shown);
    int most = greatest(shown, parts + LIGHT_SETS);
    return (GazeMirrored){greatest(panes, parts), most < parts ? most : NO_ID,
                          most < parts ? LIGHTS_SUN : (LightSet)(most - parts)};
}

static void begin_batch(KindBatch *to, Arena *arena) {
    int parts = to->paths->context->scene->part_count;
    GazeBatch *batch = to->own = ARENA_NEW(arena, GazeBatch, 1);
    batch->panes = ARENA_NEW(arena, double, parts);
    batch->shown = ARENA_NEW(arena, double, parts + LIGHT_SETS);
    for (int k = 0; k < GAZE_FIGURES; k++) batch->met[k] = ARENA_NEW(arena, bool, parts);
}

GazeReading gaze_read(const Setup *setup, const GazeGoal *goal, Arena scratch) {
    KindPaths paths = {.tools = &setup->tools,
                       .context = &setup->context,
                       .eye = goal->eye,
                       .goal = goal,
                       .begin = begin_batch,
                       .towards = towards,
                       .first_axis = SHIFT_AXIS,
                       .on_light = on_light,
                       .on_mirror = on_mirror,
                       .unmet_of = unmet,
                       .precision = goal->precision,
                       .most = goal->most,
                       .planned = {GAZE_THROUGH, GAZE_MIRRORED}};
    PathKinds found;
    path_kinds_read(&paths, review_seed(setup->request, SEED), &scratch, &found);
    return (GazeReading){path_kinds_figure(&found, GAZE_THROUGH),
                         path_kinds_figure(&found, GAZE_MIRRORED), find_mirrored(&found)};
}
