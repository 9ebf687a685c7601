/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/collect/told.h"

#include "path/emitted.h"

/* What ToldWays and ImageWays begin with. */
typedef struct TaleWays {
    PathCollector base;
    PathTale      tale;
} TaleWays;

static PathTale *tale_of(PathCollector *c)
{
    return &((TaleWays *)c)->tale;
}

static PathTale tale_start(void)
{
    return (PathTale){.pane_id = NO_ID, .reached_by = NO_ID};
}

/* ---- the way so far ---------------------------------------------------------------------- */

static void add_step(PathTale *tale, const Surface *surface, PathEvent event)
{
    if (tale->count < PATH_STEPS_TOLD)
        tale->step[tale->count] =
            (PathStep){surface->part_id, event, tale->reached_by, surface->position};
    tale->count++;
    tale->reached_by = NO_ID;
}

static void start(PathCollector *c, PathState *path)
{
    tale_of(c)->towards = path->ray.direction;
}

static void meet(PathCollector *c, PathState *path)
{
    (void)path;
    tale_of(c)->reached_by = tale_of(c)->pane_id;
}

static void behind(PathCollector *c, PathState *path, const Surface *surface)
{
    (void)path;
    tale_of(c)->pane_id = surface->part_id;
}

static void turn(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                 const BsdfSample *next)
{
    (void)path, (void)wo;
    PathTale *tale = tale_of(c);
    bool      is_across = next->wi.z * surface->local_wo.z < 0;
    if (surface->part_id == NO_ID) return;
    add_step(tale, surface, !next->is_delta ? PATH_SCATTERS
                            : is_across     ? PATH_TRANSMITS
                                            : PATH_REFLECTS);
    tale->pane_id = NO_ID;
}

/* ---- light ------------------------------------------------------------------------------- */

/* The last sheet that a shadow ray was told of. */
static int last_pane(const ShadowRay *ray)
{
    const Scene *scene = ray->path->context->scene;
    if (!ray->hit_count) return NO_ID;
    const Hit *hit = &ray->recent[(ray->hit_count - 1) % SHADOW_HITS];
    return (int)scene->triangles[hit->triangle].part_id;
}

/* A light sample: the surface scatters it, after a mirror maybe. */
static void add_sample(const PathFound *light, PathTale *tale)
{
    tale->pane_id = last_pane(light->shadow);
    if (light->by->part_id != NO_ID) add_step(tale, light->by, PATH_SCATTERS);
    else tale->towards = light->mirror ? light->mirror->light.wi : vec3_neg(light->way);
    if (!light->mirror) return;
    tale->reached_by = tale->pane_id;
    add_step(tale, &light->mirror->surface, PATH_REFLECTS);
    tale->pane_id = last_pane(light->beyond);
}

static PathLight light_of(const PathFound *found)
{
    PathLight light = {.radiance = found->radiance};
    for (int i = 0; i < 3 && found->xyz; i++) light.xyz[i] = found->share * found->xyz[i];
    return light;
}

static void hear(PathCollector *c, PathState *path, const PathFound *found)
{
    const PathListener *listener = ((ToldWays *)c)->listener;
    if (found->set != LIGHTS_EMITTERS && listener->of_emitters) return;
    PathLight light = light_of(found);
    PathTale  tale = *tale_of(c);
    Spectrum  lanes = light.radiance;
    float     xyz[3];
    if (found->by) add_sample(found, &tale);
    if (found->xyz && listener->with_lanes)
        lanes = path->throughput * spectrum_all(found->weight) *
                emitted_seen(path, found->met, found->triangle, found->way);
    tale.source = found->set;
    tale.source_id = found->source_id;
    tale.from = found->from;
    tale.is_far = found->is_far;
    tale.lanes = found->xyz && !listener->with_lanes ? NULL : (const float *)&lanes;
    tale.wavelengths = path->wavelengths;
    path_light_to_xyz(&light, path->wavelengths, xyz);
    listener->hear(listener->user, &tale, xyz);
}

ToldWays told_ways(const PathListener *listener, PathCollector *next)
{
    static const CollectorKind kind = {.size = sizeof(ToldWays), .start = start, .meet = meet,
                                       .behind = behind, .turn = turn, .hear = hear};
    return (ToldWays){{&kind, next}, tale_start(), listener};
}

/* ---- mirror images ----------------------------------------------------------------------- */

static bool refuse_scattered(PathCollector *c, PathState *path, const Surface *surface,
                             const BsdfSample *next)
{
    (void)c, (void)path, (void)surface;
    return !next->is_delta;
}

static bool add_image(PathCollector *c, PathState *path)
{
    const PathImages *images = ((ImageWays *)c)->images;
    if (path->last.is_delta)
        images->add(images->user, tale_of(c), path->ray.direction,
                    (const float *)&path->throughput);
    return true;
}

ImageWays image_ways(const PathImages *images)
{
    static const CollectorKind kind = {
        .size = sizeof(ImageWays), .start = start, .meet = meet, .behind = behind,
        .turn = turn, .vertex = collector_asks_nobody, .refuse = refuse_scattered,
        .escape = add_image};
    return (ImageWays){{&kind, NULL}, tale_start(), images};
}
