/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/collect/distant.h"

#include "path/direct.h"
#include "path/path.h"

#define SHARP_ALPHA 0.2f /* of GGX: what ways follow besides mirrors */

static bool is_sharp(const Surface *surface) {
    return bsdf_sharpest(&surface->bsdf) <= SHARP_ALPHA;
}

/* ---- ways -------------------------------------------------------------------------------- */

/* A ray that a vertex sends out: it follows mirrors, and ends behind a sharp lobe. */
typedef struct DistantWay {
    PathCollector base;
    const PathDistant *distant;
    float pdf; /* of its direction behind that lobe, sr^-1; 0: none yet */
} DistantWay;

/* Does the way end? Vertices behind a sharp lobe send out their own. */
static bool refuse(PathCollector *c, PathState *path, const Surface *surface,
                   const BsdfSample *next) {
    (void)path;
    DistantWay *way = (DistantWay *)c;
    if (way->pdf > 0) return true;
    if (next->is_delta) return false;
    if (!is_sharp(surface)) return true;
    way->pdf = PATH_WAYS * next->pdf;
    return false;
}

static bool leave_by_way(PathCollector *c, PathState *path) {
    const DistantWay *way = (const DistantWay *)c;
    if (path->last.is_delta || way->pdf > 0)
        way->distant->add_escaped(way->distant->user, path->ray.direction, path->bounce,
                                  (const float *)&path->throughput, way->pdf);
    return true;
}

static const CollectorKind way_kind = {
    .size = sizeof(DistantWay),
    .steer = {.vertex = collector_no_lights, .refuse = refuse, .escape = leave_by_way}};

/* Sends a way into a direction that the surface scatters to; its mirror direction is followed
 * by the path itself. */
static void send_way(const DistantCollector *questions, const PathState *from,
                     const Surface *surface, Vec3 wo, const Guiding *guiding, int i) {
    PathState path = *from;
    DistantWay way = {{&way_kind, NULL}, questions->distant, 0};
    SheetStack stack;
    Guiding guidings[2] = {*guiding, *guiding};
    BsdfSample next;
    float u[4];
    path.steps += STEPS_FAR * (SPLITS + 1) * (1 + i);
    numbers_for(&path, NUMBERS_SCATTER);
    sampler_4d(path.sampler, u);
    if (!guiding_sample(guiding, surface, u, &next) || next.is_delta || next.passes) return;
    path_weigh(&path, surface, next.weight * spectrum_all(1.0f / PATH_WAYS));
    path.stack = &stack;
    path.guiding = &guidings[0];
    path.spare = &guidings[1];
    path.splits_left = 1;
    path.first_bounce = path.bounce + 1;
    path.collector = &way.base;
    path.manner = (PathManner){.is_dark = true, .is_spared = true, .has_sheets = true};
    path_follow(&path, surface, wo, &next);
}

/* Few paths go on by a mirror, each in one direction: sunlight via a pane or of a satin
 * ring would depend on a handful of paths. Ways cost a ray or two; a vertex samples
 * hundreds. */
static void send_ways(const DistantCollector *questions, const PathState *path,
                      const Surface *surface, Vec3 wo, const Guiding *guiding) {
    if (!questions->distant->has_ways || path->bounce + 1 >= path->context->max_bounces) return;
    for (int i = 0; i < PATH_WAYS; i++) send_way(questions, path, surface, wo, guiding, i);
}

/* ---- questions --------------------------------------------------------------------------- */

static void sample_all(const DistantCollector *questions, PathState *path, const Surface *surface,
                       Vec3 wo, const Guiding *guiding) {
    const PathDistant *distant = questions->distant;
    Vec3 local_wo = surface->local_wo;
    int ways = questions->sent_ways && is_sharp(surface) ? PATH_WAYS : 0;
    for (int i = 0; i < distant->count; i++) {
        LightSample light = {.wi = distant->towards[i], .distance = INFINITY};
        Vec3 local_wi = frame_to_local(&surface->frame, light.wi);
        ShadowRay ray;
        float pdf;
        if (!direct_sides_agree(surface, local_wi, light.wi, wo)) continue;
        if (!bsdf_reaches(&surface->bsdf, local_wo, local_wi)) continue;
        Spectrum passed = direct_arrival(path, surface, &light, &ray);
        if (spectrum_is_zero(passed)) continue;
        Spectrum share = path->throughput * passed *
                         bsdf_eval(&surface->bsdf, local_wo, local_wi, &pdf) *
                         spectrum_all(fabsf(local_wi.z));
        distant->add(distant->user, i, path->bounce, (const float *)&share,
                     ways ? (float)ways * guiding_pdf(guiding, light.wi, pdf) : 0);
    }
}

static bool at_hit(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                   const Guiding *guiding) {
    const DistantCollector *questions = (const DistantCollector *)c;
    if (path->bounce < path->context->max_bounces && bsdf_scatters(&surface->bsdf)) {
        sample_all(questions, path, surface, wo, guiding);
        send_ways(questions, path, surface, wo, guiding);
    }
    return true;
}

/* A first display, whose mirror alone is requested. */
static bool is_of_mirror(const PathCollector *c, const PathState *path, const Surface *surface) {
    return ((const DistantCollector *)c)->distant->asks_mirror && !path->bounce &&
           surface_is_display(path->context->scene, surface);
}

static bool refuse_mirror(PathCollector *c, PathState *path, const Surface *surface,
                          const BsdfSample *next) {
    const PathDistant *distant = ((DistantCollector *)c)->distant;
    return is_of_mirror(c, path, surface) &&
           !distant->asks_mirror(distant->user, frame_to_world(&surface->frame, next->wi));
}

/* Chooses the mirror direction of a first display, so that chance leaves none of it out. */
static bool choose_mirror(PathCollector *c, PathState *path, const Surface *surface,
                          BsdfSample *next) {
    Vec3 local_wo = surface->local_wo;
    if (!is_of_mirror(c, path, surface)) return false;
    *next = (BsdfSample){.wi = vec3(-local_wo.x, -local_wo.y, local_wo.z),
                         .pdf = 1,
                         .weight = bsdf_mirror(&surface->bsdf, local_wo),
                         .is_delta = true};
    return true;
}

static void turn_from(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                      const BsdfSample *next) {
    (void)path, (void)surface, (void)wo;
    DistantCollector *questions = (DistantCollector *)c;
    if (questions->distant->has_ways) questions->sent_ways |= !next->is_delta;
}

/* Vertices that scatter have sampled lights themselves. */
static bool leave(PathCollector *c, PathState *path) {
    const DistantCollector *questions = (const DistantCollector *)c;
    const PathDistant *distant = questions->distant;
    if (!questions->sent_ways && path->last.is_delta)
        distant->add_escaped(distant->user, path->ray.direction, path->bounce,
                             (const float *)&path->throughput, 0);
    return true;
}

DistantCollector distant_collector(const PathDistant *distant) {
    static const CollectorKind kind = {.size = sizeof(DistantCollector),
                                       .steer = {.vertex = at_hit,
                                                 .choose = choose_mirror,
                                                 .refuse = refuse_mirror,
                                                 .escape = leave},
                                       .turn = turn_from};
    return (DistantCollector){{&kind, NULL}, distant, false};
}
