/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/pane_image_reading.h"

#include <math.h>

#define SEED 0x70616e65u

enum { IMAGE, THROUGH, AGAINST };

typedef struct PaneImageBatch {
    Vec3 place;                  /* of the display, that the near face shows along the path */
    double alone, ghost, beside; /* image light by one reflection; of it, the ghost's;
                                    and that times how far beside it stands, radians */
} PaneImageBatch;

/* ---- the image's solid angle ------------------------------------------------------------- */

/* Before a cell, of all. */
static double share_before(const PaneImage *image, int cell) {
    return cell < image->cell_count ? image->cells[cell].sr_before / image->sr : 1;
}

/* Cells are so small that even over the plane is even over the sphere. */
static Vec3 towards(KindBatch *batch, double u, double v) {
    const PaneImage *image = ((const PaneImageGoal *)batch->paths->goal)->image;
    int low = 0, high = image->cell_count;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (share_before(image, middle) <= u) low = middle;
        else high = middle;
    }
    const PaneCell *cell = &image->cells[low];
    double before = share_before(image, low);
    double within = (u - before) / (share_before(image, low + 1) - before);
    double root = sqrt(fmin(fmax(within, 0), 1));
    float weight[3] = {(float)(1 - root), (float)(root * (1 - v)), (float)(root * v)};
    Vec3 d = vec3(0, 0, 0), p = vec3(0, 0, 0);
    for (int k = 0; k < 3; k++) {
        d = vec3_along(d, cell->corner[k], weight[k]);
        p = vec3_along(p, cell->place[k], weight[k]);
    }
    ((PaneImageBatch *)batch->own)->place = p;
    return vec3_normalize(d);
}

/* ---- light ------------------------------------------------------------------------------- */

/* of how far the pane's thickness puts the ghost aside: what is nearer is the image itself.
 * Between a cell's corners the place is known to a minute of arc of a curved pane */
#define GHOST_LEAST 0.25

/* m, across the rays: s = d sin 2t / sqrt(n^2 - sin^2 t) of a flat pane of thickness d; 0: it
 * has none of its own. The turn from the way in to the way out is 180 degrees less 2 t. */
static double ghost_shift(const Scene *scene, int pane_id, Vec3 in, Vec3 out) {
    const Glazing *pane = scene->materials[scene->parts[pane_id].material_id].glazing;
    double thickness = 0;
    if (!pane) return 0;
    for (int i = 0; i < pane->layer_count; i++) thickness += (double)pane->layers[i].thickness_m;
    double cosine2 = fmin(fmax(0.5 * (1 - (double)vec3_dot(in, out)), 0), 1);
    double sine2 = 1 - cosine2, ior = (double)pane->absorbing_ior;
    return 2 * thickness * sqrt(sine2 * cosine2 / (ior * ior - sine2));
}

/* Where the light began lies beside the place that the near face shows, across the way there:
 * that over the whole way is how far the ghost stands beside. */
static void note_ghost(const PathHistory *history, double luminance, const KindPaths *paths,
                       PaneImageBatch *batch) {
    Vec3 eye = paths->eye, pane = history->step[0].position;
    Vec3 way = vec3_sub(batch->place, pane), off = vec3_sub(history->from, batch->place);
    double far = (double)(vec3_length(vec3_sub(pane, eye)) + vec3_length(way));
    way = vec3_normalize(way);
    double beside = (double)vec3_length(vec3_along(off, way, -vec3_dot(off, way)));
    double shift =
        ghost_shift(paths->context->scene, history->step[0].part_id, history->towards, way);
    batch->alone += luminance;
    if (!(shift > 0 && beside > GHOST_LEAST * shift)) return;
    batch->ghost += luminance;
    batch->beside += luminance * beside / far;
}

static void on_light(const ProbePart *to, const PathHistory *history, const float xyz[3]) {
    KindBatch *batch = to->own;
    const KindPaths *paths = to->user;
    const PaneImage *image = ((const PaneImageGoal *)paths->goal)->image;
    if (path_is_by_mirrors(history) != paths->by_mirrors) return;
    int step = path_mirroring_step(paths->context->scene, history);
    bool is_image = paths->by_mirrors && step != NO_ID &&
                    history->step[step].part_id == image->pane_id &&
                    history->source == LIGHTS_EMITTERS && history->source_id == image->part_id;
    batch->path[is_image ? IMAGE : AGAINST] += (double)xyz[1];
    if (step == NO_ID) batch->path[THROUGH] += (double)xyz[1];
    if (is_image && history->count == 1) note_ghost(history, (double)xyz[1], paths, batch->own);
}

/* ---- all of it --------------------------------------------------------------------------- */

static void set_ghost(const KindPaths *paths, PaneImageReading *out) {
    double alone = 0, ghost = 0, beside = 0;
    for (int b = 0; b < ESTIMATE_BATCHES; b++) {
        const PaneImageBatch *batch = paths->batch[b].own;
        alone += batch->alone;
        ghost += batch->ghost;
        beside += batch->beside;
    }
    out->ghost_share = alone > 0 ? ghost / alone : 0;
    out->ghost_rad = ghost > 0 ? beside / ghost : (double)NAN;
}

static void begin_batch(KindBatch *batch, Arena *arena) {
    batch->own = ARENA_NEW(arena, PaneImageBatch, 1);
}

PaneImageReading pane_image_read(const Setup *setup, const PaneImageGoal *goal, Arena scratch) {
    Frame frame = frame_from_z(goal->image->towards);
    PolarisedEye eye = {.right = frame.x, .forward = frame.z};
    PathContext context = setup->context;
    context.eye = &eye;
    KindPaths paths = {.tools = &setup->tools,
                       .context = &context,
                       .eye = goal->eye,
                       .goal = goal,
                       .begin = begin_batch,
                       .towards = towards,
                       .is_polarised = true,
                       .on_light = on_light,
                       .precision = goal->precision,
                       .most = goal->most,
                       .planned = {IMAGE, AGAINST},
                       .is_halved = true};
    PathKinds found;
    path_kinds_read(&paths, review_seed(setup->request, SEED ^ goal->seed), &scratch, &found);
    PaneImageReading out = {.image = path_kinds_figure(&found, IMAGE),
                            .through = path_kinds_figure(&found, THROUGH),
                            .against = path_kinds_figure(&found, AGAINST)};
    set_ghost(&found.mirrors, &out);
    return out;
}
