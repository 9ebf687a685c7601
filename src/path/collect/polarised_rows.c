/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/collect/polarised_rows.h"

static Polarised *light_of(PathCollector *c)
{
    return &((PolarisedRows *)c)->light;
}

/* ---- the path's own way ------------------------------------------------------------------ */

/* Moves the first weight into the path's throughput. */
static void take(PathCollector *c, PathState *path)
{
    path->throughput *= polarised_take(light_of(c));
}

static void start(PathCollector *c, PathState *path)
{
    polarised_start(((PolarisedRows *)c)->eye, path->ray.direction, light_of(c));
    take(c, path);
}

static void leave(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                  const BsdfSample *next)
{
    polarised_turn(light_of(c), surface, wo, next);
    take(c, path);
}

static void pass(PathCollector *c, PathState *path, const Surface *pane, Vec3 wo)
{
    polarised_pass(light_of(c), pane, wo);
    take(c, path);
}

/* Polarisation of what leaves a triangle's point along `way` (unit); NULL: unpolarised. */
static const PolarisedLight *emitter_light(const PathState *path, uint32_t triangle,
                                           const TrianglePoint *point, Vec3 way,
                                           PolarisedLight *out)
{
    float degree;
    if (!triangle_polarisation(path->context->scene, triangle, point, way, &out->axis, &degree))
        return NULL;
    out->degree = spectrum_all(degree);
    return out;
}

/* Weighs the light that the first surface sends to the eye. */
static void see(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                uint32_t triangle)
{
    PolarisedLight room;
    const PolarisedLight *from = emitter_light(path, triangle, &surface->point, wo, &room);
    path->first.through *= polarised_seen(light_of(c), 0, wo, from);
}

/* ---- found light ------------------------------------------------------------------------- */

/* A shadow ray's sheets, along its direction: the nearest first; of more than it remembers,
 * some. */
static void pass_panes(const ShadowRay *ray, Vec3 direction, Polarised *light)
{
    const PathState   *path = ray->path;
    const PathContext *context = path->context;
    Hit hit[SHADOW_HITS];
    int count = ray->hit_count < SHADOW_HITS ? ray->hit_count : SHADOW_HITS;
    for (int i = 0; i < count; i++) {
        int k = i;
        for (; k > 0 && hit[k - 1].t > ray->recent[i].t; k--) hit[k] = hit[k - 1];
        hit[k] = ray->recent[i];
    }
    for (int i = 0; i < count; i++) {
        Surface pane;
        Vec3    wo = vec3_neg(direction);
        surface_at(context->scene, context->tables, &hit[i], wo, path->wavelengths, &pane);
        polarised_pass(light, &pane, wo);
    }
}

/* Follows a light sample's way once more, for what surface, panes and mirror do to it. */
static void go_again(const PathFound *found, Polarised *light)
{
    const SunMirror *mirror = found->mirror;
    Vec3       to_light = vec3_neg(found->way);
    Vec3       first = mirror ? mirror->light.wi : to_light;
    BsdfSample out = {.wi = found->local_wi};
    polarised_turn(light, found->by, found->wo, &out);
    pass_panes(found->shadow, first, light);
    if (!mirror) return;
    BsdfSample on = {.wi = frame_to_local(&mirror->surface.frame, to_light),
                     .is_delta = !found->by_rough};
    polarised_turn(light, &mirror->surface, vec3_neg(first), &on);
    pass_panes(found->beyond, to_light, light);
}

/* Polarisation of the light where it begins; NULL: unpolarised. */
static const PolarisedLight *origin_of(const PathState *path, const PathFound *found,
                                       PolarisedLight *room)
{
    if (found->point)
        return emitter_light(path, found->triangle, found->point, found->way, room);
    bool is_some = found->set == LIGHTS_SKY &&
                   lights_sky_polarisation(path->context->lights, vec3_neg(found->way),
                                           path->wavelengths, &room->axis, &room->degree);
    return is_some ? room : NULL;
}

/* Weighs a display's XYZ; all lanes are the same. */
static void count_display(const PolarisedRows *rows, const Polarised *light,
                          const PolarisedLight *from, PathFound *found)
{
    float luminance = found->share * found->xyz[1];
    for (int i = 1; rows->stokes && i < light->row_count; i++)
        rows->stokes[i - 1] += luminance * polarised_seen(light, i, found->way, from)[0];
    found->share *= polarised_seen(light, 0, found->way, from)[0];
}

static void add_stokes(const PolarisedRows *rows, const Polarised *light,
                       const PolarisedLight *from, const PathState *path,
                       const PathFound *found)
{
    for (int i = 1; rows->stokes && i < light->row_count; i++) {
        float xyz[3] = {0};
        spectrum_add_xyz(path->wavelengths,
                         found->radiance * polarised_seen(light, i, found->way, from), xyz);
        rows->stokes[i - 1] += xyz[1];
    }
}

static void count(PathCollector *c, PathState *path, PathFound *found)
{
    PolarisedRows   *rows = (PolarisedRows *)c;
    const Polarised *light = &rows->light;
    Polarised        again;
    PolarisedLight   room;
    if (found->by) {
        if (spectrum_is_zero(found->radiance)) return;
        again = rows->light;
        go_again(found, &again);
        light = &again;
    }
    const PolarisedLight *from = origin_of(path, found, &room);
    if (found->xyz) {
        count_display(rows, light, from, found);
        return;
    }
    found->radiance *= light->share;
    add_stokes(rows, light, from, path, found);
    found->radiance *= polarised_seen(light, 0, found->way, from);
}

PolarisedRows polarised_rows(const PolarisedEye *eye, float *stokes, PathCollector *next)
{
    static const CollectorKind kind = {.size = sizeof(PolarisedRows), .start = start,
                                       .see = see, .leave = leave, .pass = pass,
                                       .count = count};
    PolarisedRows rows = {.base = {&kind, next}, .eye = eye, .stokes = stokes};
    return rows;
}
