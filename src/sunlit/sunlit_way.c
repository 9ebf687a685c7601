/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "sunlit/sunlit_way.h"

#include <math.h>

#include "base/mathf.h"
#include "scene/point/ray_ends.h"

bool sunlit_way_choose(const SunlitTools *tools, const SunlitMap *map, const LitPoint *from,
                       const float u[6], SunlitWay *way) {
    SunlitRay ray;
    Hit hit;
    float length;
    if (!sunlit_map_choose(map, from, u, &ray) ||
        !lights_sample(tools->lights, LIGHTS_SUN, *from, u + 3, &way->sun))
        return false;
    Vec3 sun = way->sun.wi;
    Vec3 entry = sunlit_map_entry(map, &ray, sun, &length);
    if (!sunlit_land(tools->scene, tools->bvh, (Ray){entry, vec3_neg(sun), 0, length}, &hit))
        return false;
    LightSample *y = &way->y;
    *y = (LightSample){.set = LIGHTS_EMITTERS,
                       .is_emitter = true,
                       .triangle = hit.triangle,
                       .u = hit.u,
                       .v = hit.v,
                       .point = triangle_point(tools->scene, hit.triangle, hit.u, hit.v)};
    Vec3 to_y = vec3_sub(y->point.position, from->position);
    float distance2 = vec3_dot(to_y, to_y);
    if (!(distance2 > 0)) return false;
    y->distance = sqrtf(distance2);
    y->wi = vec3_scale(to_y, 1 / y->distance);
    float slope = fabsf(vec3_dot(y->point.ng, sun)) / vec3_dot(map->frame.z, sun);
    float y_x = fabsf(vec3_dot(y->point.ng, y->wi));
    y->pdf = sunlit_way_at_x(ray.density, slope, y_x, distance2);
    return y->pdf > 0;
}

/* ---- before the first path --------------------------------------------------------------- */

static bool let_pass(void *user, const Hit *hit) {
    (void)user, (void)hit;
    return true;
}

static bool arrives(const SunlitTools *tools, const LitPoint *from, const SunlitWay *way) {
    const TrianglePoint *y = &way->y.point;
    Vec3 sun = way->sun.wi;
    Ray up = {ray_start(y, sun), sun, 0, INFINITY};
    return vec3_dot(from->ns, way->y.wi) > 0 &&
           !bvh_occluded(tools->bvh, lights_ray(from->position, &way->y), let_pass, NULL) &&
           !bvh_occluded(tools->bvh, up, let_pass, NULL);
}

#define LEAST_ALBEDO 0.05f

/* Luminance that y sends to x, about, if it is lit from that side: a Lambert surface's, without
 * its textures. */
static double luminance(const SunlitTools *tools, const SunlitWay *way, float u) {
    const Scene *scene = tools->scene;
    const Material *m = &scene->materials[scene_part(scene, way->y.triangle)->material_id];
    Vec3 sun = way->sun.wi, ng = way->y.point.ng;
    LitPoint facing = {way->y.point.position, sun, false};
    bool is_behind = vec3_dot(ng, sun) * vec3_dot(ng, way->y.wi) > 0;
    if (is_behind && !m->is_solid && !material_sends_through(m)) return 0;
    float albedo = (m->base_color[0] + m->base_color[1] + m->base_color[2]) / 3;
    float cosine = fabsf(vec3_dot(ng, sun));
    return lights_sample_lx(tools->lights, facing, &way->sun, u) *
           (double)(max_f(albedo, LEAST_ALBEDO) * cosine * INV_PI_F);
}

bool sunlit_try(const SunlitTools *tools, const SunlitMap *map, LitPoint point, const float u[6],
                SunlitTry *out) {
    SunlitWay way;
    if (!map->nodes || !sunlit_way_choose(tools, map, &point, u, &way) ||
        !arrives(tools, &point, &way))
        return false;
    float cosine = vec3_dot(point.ns, way.y.wi);
    out->wi = way.y.wi;
    out->pdf = way.y.pdf;
    out->lx = luminance(tools, &way, u[0]) * (double)(cosine / way.y.pdf);
    return isfinite(out->lx);
}

static const float PROB[SUNLIT_PROBS] = {1 / 64.0f, 1 / 16.0f, 1 / 8.0f, 1 / 3.0f, 1};

void sunlit_finds_add(SunlitFinds *finds, const SunlitTry *found, float own) {
    double ratio = (double)found->pdf / fmax((double)own, 1e-9);
    for (int k = 0; k < SUNLIT_PROBS; k++)
        finds->variance[k] += found->lx * found->lx * ratio / (1 + (double)PROB[k] * ratio);
}

/* A sample takes so much of the time of all else that a vertex does. */
#define SAMPLE_TIME 0.4

float sunlit_finds_prob(const SunlitFinds *finds, double points, double rest) {
    double least = (double)INFINITY;
    float best = PROB[0];
    for (int k = 0; k < SUNLIT_PROBS && points > 0; k++) {
        double variance = rest + finds->variance[k] / points;
        double work = variance * (1 + SAMPLE_TIME * (double)PROB[k]);
        if (work < least) best = PROB[k];
        least = fmin(least, work);
    }
    return best;
}
