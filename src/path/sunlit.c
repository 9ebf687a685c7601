/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/sunlit.h"

#include "scene/point/ray_ends.h"
#include "path/direct.h"
#include "path/emitted.h"
#include "path/windows.h"
#include "sunlit/sunlit_way.h"

bool sunlit_is_sampled(const PathState *path, const Surface *surface) {
    const PathContext *context = path->context;
    return context->sunlit.nodes && context->strategy == PATH_MIS && path->medium_id == NO_ID &&
           path->bounce + 1 < context->max_bounces && bsdf_scatters(&surface->bsdf);
}

/* Does light from local_wi come to the surface through a solid? */
static bool comes_inside(const PathState *path, const Surface *surface, Vec3 local_wi) {
    if (surface->material_id == NO_ID || !(local_wi.z * surface->local_wo.z < 0)) return false;
    const Material *m = &path->context->scene->materials[surface->material_id];
    return bsdf_is(&surface->bsdf, BSDF_REFRACTS) || material_is_translucent_solid(m);
}

/* The path at y, as if chance had led it there. */
static void add_from_y(PathState *path, const Surface *surface, Vec3 wo, const SunlitWay *way,
                       const BsdfSample *next) {
    const PathContext *context = path->context;
    SheetRoom room;
    PathState child;
    Guiding guiding;
    Surface y;
    BsdfRoom looked;
    sheet_branch(path, &room, &child);
    path_weigh(&child, surface, next->weight);
    collect_leave(&child, surface, wo, next);
    if (spectrum_is_zero(child.throughput) || collect_refuse(&child, surface, next)) return;
    collect_turn(&child, surface, wo, next);
    Vec3 to_x = vec3_neg(way->y.wi);
    Hit hit = {way->y.distance, way->y.u, way->y.v, way->y.triangle};
    child.last = (PathVertex){.at = emitted_lit_point(path, surface),
                              .part_id = surface->part_id,
                              .pdf = next->pdf,
                              .sun_share = spectrum_all(1)};
    child.bounce++;
    child.ray = (Ray){surface->position, way->y.wi, 0, INFINITY};
    child.straight = way->y.distance;
    child.spare = &guiding;
    guiding_none(context, &guiding);
    surface_at(context->scene, context->tables, &hit, to_x, path->wavelengths, &y);
    bsdf_carry(&y.bsdf, &child.throughput);
    collect_meet(&child);
    bsdf_look(&y.bsdf, y.local_wo, &looked);
    if (collect_vertex(&child, &y, to_x, &guiding)) return;
    direct_add_sun(&child, &y, to_x, &way->sun);
    path_light_add(&path->gathered, &child.gathered);
}

void sunlit_add(PathState *path, const Surface *surface, Vec3 wo, const Guiding *guiding) {
    const PathContext *context = path->context;
    const SunlitTools tools = {context->scene, context->bvh, context->lights};
    float prob = guiding->asked[LIGHTS_SUNLIT] * guiding->often, u[8];
    if (!(prob > 0) || !sunlit_is_sampled(path, surface)) return;
    numbers_for_map(path);
    sampler_4d(path->sampler, u);
    if (!unit_choose(&u[0], prob)) return;
    sampler_4d(path->sampler, u + 4);
    SunlitWay way;
    ShadowRay ray;
    LitPoint from = emitted_lit_point(path, surface);
    const float numbers[6] = {u[0], u[4], u[5], u[2], u[3], 0};
    path->statistics->shadow_rays++;
    if (!sunlit_way_choose(&tools, &context->sunlit, &from, numbers, &way)) return;
    BsdfSample next = {.wi = frame_to_local(&surface->frame, way.y.wi)};
    if (!direct_sides_agree(surface, next.wi, way.y.wi, wo) ||
        !bsdf_reaches(&surface->bsdf, surface->local_wo, next.wi) ||
        comes_inside(path, surface, next.wi))
        return;
    Spectrum passed = direct_visibility(path, surface, &way.y, &ray);
    if (spectrum_is_zero(passed)) return;
    float bsdf_pdf, chosen = way.y.pdf * prob;
    Spectrum f = bsdf_eval(&surface->bsdf, surface->local_wo, next.wi, &bsdf_pdf);
    next.pdf = guiding_pdf(guiding, way.y.wi, bsdf_pdf);
    next.weight =
        f * passed * spectrum_all(fabsf(next.wi.z) / chosen * mis_weight(chosen, next.pdf));
    if (!spectrum_is_zero(next.weight)) add_from_y(path, surface, wo, &way, &next);
}
