/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/collect/history.h"

#include "path/emitted.h"

static PathHistory *history_of(PathCollector *c) {
    return &((HistoryCollector *)c)->history;
}

static PathHistory history_start(void) {
    return (PathHistory){.pane_id = NO_ID, .reached_by = NO_ID};
}

/* ---- the steps of a path ----------------------------------------------------------------- */

static void add_step(PathHistory *history, const Surface *surface, PathEvent event) {
    if (history->count < PATH_STEPS_MAX)
        history->step[history->count] =
            (PathStep){surface->part_id, event, history->reached_by, surface->position};
    history->count++;
    history->reached_by = NO_ID;
}

/* Before that surface's step is added. */
static void note_extrapolated(const PathListener *listener, const Surface *surface, Vec3 local_wi,
                              PathHistory *history) {
    if (listener && listener->with_extrapolated && !history->count)
        history->is_extrapolated =
            bsdf_is_extrapolated(&surface->bsdf, surface->local_wo, local_wi);
}

static void start(PathCollector *c, PathState *path) {
    history_of(c)->towards = path->ray.direction;
}

static void meet(PathCollector *c, PathState *path) {
    (void)path;
    history_of(c)->reached_by = history_of(c)->pane_id;
}

static void behind(PathCollector *c, PathState *path, const Surface *surface) {
    (void)path;
    history_of(c)->pane_id = surface->part_id;
}

static void turn(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                 const BsdfSample *next) {
    (void)wo;
    PathHistory *history = history_of(c);
    const PathListener *listener = ((HistoryCollector *)c)->listener;
    bool is_across = next->wi.z * surface->local_wo.z < 0;
    if (surface->part_id == NO_ID) return;
    note_extrapolated(listener, surface, next->wi, history);
    add_step(history, surface,
             !next->is_delta ? PATH_SCATTERS
             : is_across     ? PATH_TRANSMITS
                             : PATH_REFLECTS);
    history->pane_id = NO_ID;
    history->is_sampled = path->way.is_of_eye;
    if (listener && listener->on_mirror && next->is_delta)
        listener->on_mirror(listener->user, history, frame_to_world(&surface->frame, next->wi),
                            spectrum_max_lane(path->throughput));
}

static bool sample_less(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                        const Guiding *guiding) {
    (void)path, (void)surface, (void)wo, (void)guiding;
    return ((HistoryCollector *)c)->listener->reach == PATH_BY_MIRRORS;
}

static bool refuse_beyond(PathCollector *c, PathState *path, const Surface *surface,
                          const BsdfSample *next) {
    (void)path, (void)surface;
    return ((HistoryCollector *)c)->listener->reach == PATH_BY_MIRRORS && !next->is_delta;
}

/* ---- light ------------------------------------------------------------------------------- */

/* The last sheet that a shadow ray passed. */
static int last_pane(const ShadowRay *ray) {
    const Scene *scene = ray->path->context->scene;
    int plates = ray->plates.count;
    if (!ray->hit_count && !plates) return NO_ID;
    const Hit *hit = ray->hit_count ? &ray->recent[(ray->hit_count - 1) % SHADOW_HITS]
                                    : &ray->plates.plate[plates - 1].hit;
    return (int)scene->triangles[hit->triangle].part_id;
}

/* Adds a light sample's steps: the surface that scatters it, then its mirror if any. */
static void add_sample(const PathFound *light, PathHistory *history) {
    history->pane_id = last_pane(light->shadow);
    if (light->by->part_id != NO_ID) add_step(history, light->by, PATH_SCATTERS);
    else history->towards = light->mirror ? light->mirror->light.wi : vec3_neg(light->way);
    if (!light->mirror) return;
    history->reached_by = history->pane_id;
    add_step(history, &light->mirror->surface, PATH_REFLECTS);
    history->pane_id = last_pane(light->beyond);
}

static PathLight light_of(const PathFound *found) {
    PathLight light = {.radiance = found->radiance};
    for (int i = 0; i < 3 && found->xyz; i++) light.xyz[i] = found->share * found->xyz[i];
    return light;
}

static void on_light(PathCollector *c, PathState *path, const PathFound *found) {
    const PathListener *listener = ((HistoryCollector *)c)->listener;
    PathLight light = light_of(found);
    PathHistory history = *history_of(c);
    Spectrum lanes = light.radiance;
    float xyz[3];
    if (found->by) {
        note_extrapolated(listener, found->by, found->local_wi, &history);
        add_sample(found, &history);
    }
    if (found->xyz && listener->with_lanes)
        lanes = path->throughput * spectrum_all(found->weight) *
                triangle_emission(path->context->scene, found->triangle, found->point, found->way,
                                  path->wavelengths);
    history.source = found->set;
    history.source_id = found->source_id;
    history.from = found->from;
    history.is_distant = found->is_distant;
    history.is_sampled = found->is_sampled || found->mirror != NULL;
    history.lanes = found->xyz && !listener->with_lanes ? NULL : (const float *)&lanes;
    history.wavelengths = path->wavelengths;
    path_light_to_xyz(&light, path->wavelengths, xyz);
    listener->on_light(listener->user, &history, xyz);
}

HistoryCollector history_collector(const PathListener *listener, PathCollector *next) {
    static const CollectorKind kind = {.size = sizeof(HistoryCollector),
                                       .steer = {.vertex = sample_less, .refuse = refuse_beyond},
                                       .start = start,
                                       .meet = meet,
                                       .behind = behind,
                                       .turn = turn,
                                       .on_light = on_light};
    return (HistoryCollector){{&kind, next}, history_start(), listener, NULL};
}

/* ---- mirror images ----------------------------------------------------------------------- */

static bool refuse_scattered(PathCollector *c, PathState *path, const Surface *surface,
                             const BsdfSample *next) {
    (void)c, (void)path, (void)surface;
    return !next->is_delta;
}

static bool add_image(PathCollector *c, PathState *path) {
    const PathImages *images = ((HistoryCollector *)c)->images;
    if (path->last.is_delta)
        images->add(images->user, history_of(c), path->ray.direction,
                    (const float *)&path->throughput);
    return true;
}

HistoryCollector image_collector(const PathImages *images) {
    static const CollectorKind kind = {
        .size = sizeof(HistoryCollector),
        .steer = {.vertex = collector_no_lights, .refuse = refuse_scattered, .escape = add_image},
        .start = start,
        .meet = meet,
        .behind = behind,
        .turn = turn};
    return (HistoryCollector){{&kind, NULL}, history_start(), NULL, images};
}
