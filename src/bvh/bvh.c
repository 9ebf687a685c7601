/* SPDX-License-Identifier: Apache-2.0 */
#include "bvh/bvh.h"

#include <stdlib.h>

#include "bvh/bvh_build.h"
#include "bvh/bvh_parts.h"

/* The only place that fills a ray; every member is set, because one that is forgotten means
 * silently no hit. */
static struct RTCRay embree_ray(Ray ray)
{
    return (struct RTCRay){.org_x = ray.origin.x, .org_y = ray.origin.y, .org_z = ray.origin.z,
                           .dir_x = ray.direction.x, .dir_y = ray.direction.y,
                           .dir_z = ray.direction.z, .tnear = ray.t_min, .tfar = ray.t_max,
                           .time = 0, .mask = ~0u, .id = 0, .flags = 0};
}

/* Debian 12's Embree aborts on what is refused here; later ones would miss in silence. */
static bool ray_is_valid(Ray ray)
{
    return vec3_is_finite(ray.origin) && vec3_is_finite(ray.direction) && ray.t_min >= 0 &&
           ray.t_max >= ray.t_min && vec3_dot(ray.direction, ray.direction) > 0;
}

static void record(BvhRecorder *recorder, Ray ray, bool is_shadow)
{
    if (recorder->count == recorder->capacity) return;
    recorder->is_shadow[recorder->count] = is_shadow;
    recorder->rays[recorder->count++] = ray;
}

bool bvh_intersect(const Bvh *bvh, Ray ray, float sheets_from, Hit *hit)
{
    if (!ray_is_valid(ray)) return false;
    if (bvh->recorder) record(bvh->recorder, ray, false);
    struct RTCRayHit rayhit = {.ray = embree_ray(ray),
                               .hit = {.geomID = RTC_INVALID_GEOMETRY_ID,
                                       .primID = RTC_INVALID_GEOMETRY_ID,
                                       .instID = {RTC_INVALID_GEOMETRY_ID}}};
    QueryContext context = {.sheets_from = sheets_from};
    embree_context_init(&context.embree);
    embree_intersect(bvh->scene, &context.embree, &rayhit);
    if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    *hit = (Hit){rayhit.ray.tfar, rayhit.hit.u, rayhit.hit.v,
                 bvh->first_triangle[rayhit.hit.geomID] + rayhit.hit.primID};
    return true;
}

bool bvh_occluded(const Bvh *bvh, Ray ray, BvhPasses *passes, void *user)
{
    if (!ray_is_valid(ray)) return true;
    if (bvh->recorder) record(bvh->recorder, ray, true);
    struct RTCRay query = embree_ray(ray);
    QueryContext context = {.passes = passes, .user = user, .bvh = bvh};
    embree_context_init(&context.embree);
    embree_occluded(bvh->scene, &context.embree, &query);
    return query.tfar < 0; /* Embree marks an occluded ray by tfar = -infinity */
}

bool bvh_has_sheets(const Bvh *bvh)
{
    return bvh->sheets != NULL;
}

void bvh_ask_sheets(const Bvh *bvh, Ray ray, BvhPasses *asked, void *user)
{
    if (!ray_is_valid(ray)) return;
    struct RTCRay query = embree_ray(ray);
    QueryContext context = {.passes = asked, .user = user, .bvh = bvh};
    embree_context_init(&context.embree);
    embree_occluded(bvh->sheets, &context.embree, &query);
}

bool bvh_create(const Scene *scene, int threads, const char *isa, Bvh **out, Error *err)
{
    return bvh_build(scene, threads, isa, PROGRESS_NONE, out, err);
}

void bvh_destroy(Bvh *bvh)
{
    if (!bvh) return;
    if (bvh->sheets) rtcReleaseScene(bvh->sheets);
    if (bvh->scene) rtcReleaseScene(bvh->scene);
    if (bvh->device) rtcReleaseDevice(bvh->device);
    free(bvh);
}

void bvh_record(Bvh *bvh, BvhRecorder *recorder)
{
    bvh->recorder = recorder;
}

#define TEXT_OF(x) #x
#define VERSION_TEXT(a, b, c) TEXT_OF(a) "." TEXT_OF(b) "." TEXT_OF(c)

const char *bvh_library(void)
{
    return "Embree " VERSION_TEXT(RTC_VERSION_MAJOR, RTC_VERSION_MINOR, RTC_VERSION_PATCH);
}
