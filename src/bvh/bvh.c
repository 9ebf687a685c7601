/* SPDX-License-Identifier: Apache-2.0 */
#include "bvh/bvh.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/machine.h"
#include "base/parallel.h"
#include "onetbb/task_threads.h"

/* EMBREE_MAJOR comes from the build. */
#if EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

/* ---- what differs between Embree 3 and 4: the context, and the two queries --------------- */

#if EMBREE_MAJOR >= 4
typedef struct RTCRayQueryContext EmbreeContext;

static inline void embree_intersect(RTCScene scene, EmbreeContext *context,
                                    struct RTCRayHit *rayhit) {
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = context;
    rtcIntersect1(scene, rayhit, &arguments);
}

static inline void embree_occluded(RTCScene scene, EmbreeContext *context, struct RTCRay *ray) {
    struct RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = context;
    rtcOccluded1(scene, ray, &arguments);
}

static inline void embree_context_init(EmbreeContext *context) {
    rtcInitRayQueryContext(context);
}
#else
typedef struct RTCIntersectContext EmbreeContext;

static inline void embree_intersect(RTCScene scene, EmbreeContext *context,
                                    struct RTCRayHit *rayhit) {
    rtcIntersect1(scene, context, rayhit);
}

static inline void embree_occluded(RTCScene scene, EmbreeContext *context, struct RTCRay *ray) {
    rtcOccluded1(scene, context, ray);
}

static inline void embree_context_init(EmbreeContext *context) {
    rtcInitIntersectContext(context);
}
#endif

/* ---- queries ----------------------------------------------------------------------------- */

/* Two geometries: opaque triangles, which always stop light, and the others, for which shadow
 * rays call BvhPasses. Scene.triangles holds them in this order. */
enum { GEOMETRY_OPAQUE, GEOMETRY_ASKED, GEOMETRY_COUNT };

struct Bvh {
    RTCDevice device;
    RTCScene scene;
    RTCScene sheets; /* GEOMETRY_ASKED alone; NULL: no material has holes */
    uint32_t first_triangle[GEOMETRY_COUNT];
    BvhRecorder *recorder;
    int threads; /* that built it */
};

/* A query's context, with what the filters need behind Embree's own part. */
typedef struct QueryContext {
    EmbreeContext embree;
    BvhPasses *passes; /* of shadow rays */
    void *user;
    const Bvh *bvh;
    float sheets_from; /* of other rays */
} QueryContext;

/* The only place that fills a ray; every member is set, because one that is forgotten means
 * silently no hit. */
static struct RTCRay embree_ray(Ray ray) {
    return (struct RTCRay){.org_x = ray.origin.x,
                           .org_y = ray.origin.y,
                           .org_z = ray.origin.z,
                           .dir_x = ray.direction.x,
                           .dir_y = ray.direction.y,
                           .dir_z = ray.direction.z,
                           .tnear = ray.t_min,
                           .tfar = ray.t_max,
                           .time = 0,
                           .mask = ~0u,
                           .id = 0,
                           .flags = 0};
}

#define FARTHEST 1.8e18f /* Embree's FLT_LARGE is 1.844e18 */

/* Debian 12's Embree aborts on what is refused here; later ones would miss in silence. */
static bool ray_is_valid(Ray ray) {
    return vec3_is_within(ray.origin, FARTHEST) && vec3_is_within(ray.direction, FARTHEST) &&
           ray.t_min >= 0 && ray.t_max >= ray.t_min && vec3_dot(ray.direction, ray.direction) > 0;
}

static void record(BvhRecorder *recorder, Ray ray, bool is_shadow) {
    if (recorder->count == recorder->capacity) return;
    recorder->is_shadow[recorder->count] = is_shadow;
    recorder->rays[recorder->count++] = ray;
}

bool bvh_intersect(const Bvh *bvh, Ray ray, float sheets_from, Hit *hit) {
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

bool bvh_occluded(const Bvh *bvh, Ray ray, BvhPasses *passes, void *user) {
    if (!ray_is_valid(ray)) return true;
    if (bvh->recorder) record(bvh->recorder, ray, true);
    struct RTCRay query = embree_ray(ray);
    QueryContext context = {.passes = passes, .user = user, .bvh = bvh};
    embree_context_init(&context.embree);
    embree_occluded(bvh->scene, &context.embree, &query);
    return query.tfar < 0; /* Embree marks an occluded ray by tfar = -infinity */
}

bool bvh_has_sheets(const Bvh *bvh) {
    return bvh->sheets != NULL;
}

void bvh_find_sheets(const Bvh *bvh, Ray ray, BvhPasses *asked, void *user) {
    if (!ray_is_valid(ray)) return;
    struct RTCRay query = embree_ray(ray);
    QueryContext context = {.passes = asked, .user = user, .bvh = bvh};
    embree_context_init(&context.embree);
    embree_occluded(bvh->sheets, &context.embree, &query);
}

/* ---- what Embree tests along a ray ------------------------------------------------------ */

/* Called by Embree for tested triangles that a ray might meet first (always one ray at a time),
 * where there are sheets. */
static void skip_sheets(const struct RTCFilterFunctionNArguments *args) {
    const QueryContext *context = (const QueryContext *)args->context;
    const struct RTCRay *ray = (const struct RTCRay *)args->ray; /* N = 1: the plain struct */
    if (ray->tfar < context->sheets_from) args->valid[0] = 0;
}

/* Called by Embree for every tested triangle along a shadow ray (always one ray at a time). */
static void report_passes(const struct RTCFilterFunctionNArguments *args) {
    const QueryContext *context = (const QueryContext *)args->context;
    if (!args->valid[0] || !context->passes) return;
    const struct RTCRay *ray = (const struct RTCRay *)args->ray; /* N = 1: the plain structs */
    const struct RTCHit *met = (const struct RTCHit *)args->hit;
    Hit hit = {ray->tfar, met->u, met->v,
               context->bvh->first_triangle[GEOMETRY_ASKED] + met->primID};
    if (context->passes(context->user, &hit)) args->valid[0] = 0;
}

/* ---- building --------------------------------------------------------------------------- */

static void keep_first_message(void *user, enum RTCError code, const char *text) {
    Error *err = user;
    const char *why = text ? text : "unknown error";
    if (err->code != ERROR_NONE) return;
    if (code == RTC_ERROR_OUT_OF_MEMORY)
        error_set(err, ERROR_MEMORY, "out of memory for the ray tracer: %s", why);
    else error_set(err, ERROR_LIBRARY, "ray tracing: %s", why);
}

/* What all threads may be granted in one moment, and the kernel's own pages for it, which count
 * in a control group, too. */
#define GRANTED_AT_ONCE ((size_t)1 << 22)

/* Where the memory is short the library's next block is refused: it says so then, and nobody is
 * killed. */
static bool grant_memory(void *user, ssize_t bytes, bool is_done) {
    (void)user;
    if (is_done || bytes <= 0) return true;
    return (size_t)bytes + GRANTED_AT_ONCE < machine_memory_left();
}

static bool has_holes(const Scene *scene) {
    for (int i = 0; i < scene->part_count; i++)
        if (scene->parts[i].triangle_count &&
            scene->materials[scene->parts[i].material_id].alpha_mode != ALPHA_OPAQUE)
            return true;
    return false;
}

static void attach_triangles(Bvh *bvh, const Scene *scene, int geometry_id, uint32_t first,
                             uint32_t count) {
    bvh->first_triangle[geometry_id] = first;
    if (!count) return;
    RTCGeometry geometry = rtcNewGeometry(bvh->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               scene->positions, 0, sizeof(Vec3), scene->vertex_count);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               scene->triangles, first * sizeof(Triangle), sizeof(Triangle), count);
    rtcSetGeometryMask(geometry, ~0u); /* the default differs between Embree 3 and 4 */
    bool is_sheet = geometry_id == GEOMETRY_ASKED && bvh->sheets;
    if (geometry_id == GEOMETRY_ASKED)
        rtcSetGeometryOccludedFilterFunction(geometry, report_passes);
    if (is_sheet) rtcSetGeometryIntersectFilterFunction(geometry, skip_sheets);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(bvh->scene, geometry, (unsigned)geometry_id);
    if (is_sheet) rtcAttachGeometryByID(bvh->sheets, geometry, (unsigned)geometry_id);
    rtcReleaseGeometry(geometry);
}

static bool check_device(RTCDevice device, Error *err) {
    if (!rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_TRIANGLE_GEOMETRY_SUPPORTED) ||
        !rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED))
        return error_set(err, ERROR_LIBRARY,
                         "this build of %s lacks triangles or filter "
                         "functions: install Debian's package",
                         bvh_library());
    return true;
}

static RTCScene new_scene(RTCDevice device) {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    /* Not HIGH: its spatial splits would call BvhPasses twice about one triangle. */
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    return scene;
}

/* Progress of the tree, reported by any of Embree's threads. */
typedef struct TreeProgress {
    atomic_flag busy;
    Progress progress;
} TreeProgress;

static bool report(void *user, double share) {
    TreeProgress *building = user;
    if (atomic_flag_test_and_set(&building->busy)) return true; /* another thread does */
    progress_update(&building->progress, share * building->progress.total);
    atomic_flag_clear(&building->busy);
    return true;
}

static void commit(RTCScene tree, const char *what, double triangles, ProgressMode mode) {
    TreeProgress building = {.busy = ATOMIC_FLAG_INIT,
                             .progress = progress_start(mode, what, "triangles", triangles)};
    if (mode != PROGRESS_NONE) rtcSetSceneProgressMonitorFunction(tree, report, &building);
    rtcCommitScene(tree);
    rtcSetSceneProgressMonitorFunction(tree, NULL, NULL);
    while (atomic_flag_test_and_set(&building.busy)) { /* now all they wrote is visible */
    }
    if (building.progress.shown_columns) progress_clear(&building.progress);
}

static void build_scene(Bvh *bvh, const Scene *scene, ProgressMode progress) {
    uint32_t asked = scene->triangle_count - scene->opaque_count;
    bvh->scene = new_scene(bvh->device);
    if (has_holes(scene)) bvh->sheets = new_scene(bvh->device);
    attach_triangles(bvh, scene, GEOMETRY_OPAQUE, 0, scene->opaque_count);
    attach_triangles(bvh, scene, GEOMETRY_ASKED, scene->opaque_count, asked);
    commit(bvh->scene, "ray tracer", scene->triangle_count, progress);
    if (bvh->sheets) commit(bvh->sheets, "ray tracer's sheets", asked, progress);
}

bool bvh_build(const Scene *scene, int threads, const char *isa, ProgressMode progress, Bvh **out,
               Error *err) {
    char config[96];
    Error first = {0};
    int granted = parallel_grantable_threads(threads);
    if (granted < threads && !task_threads_limit(granted, err)) return false;
    snprintf(config, sizeof config, "threads=%d,set_affinity=0%s%s", granted, isa ? ",isa=" : "",
             isa ? isa : "");
    Bvh *bvh = calloc(1, sizeof *bvh);
    if (!bvh) return error_set(err, ERROR_MEMORY, "out of memory for the ray tracer");
    bvh->threads = granted;
    bvh->device = rtcNewDevice(config);
    if (!bvh->device) {
        free(bvh);
        return error_set(err, ERROR_LIBRARY, "ray tracing: no device for \"%s\"", config);
    }
    rtcSetDeviceErrorFunction(bvh->device, keep_first_message, &first);
    rtcSetDeviceMemoryMonitorFunction(bvh->device, grant_memory, NULL);
    if (check_device(bvh->device, &first)) build_scene(bvh, scene, progress);
    rtcSetDeviceErrorFunction(bvh->device, NULL, NULL);
    if (first.code != ERROR_NONE) {
        /* Mostly for lack of memory. Embree and oneTBB allocate while they clean up, and end
         * the program where they cannot: what stands half-built is left to the system. */
        *err = first;
        return false;
    }
    *out = bvh;
    return true;
}

bool bvh_create(const Scene *scene, int threads, const char *isa, Bvh **out, Error *err) {
    return bvh_build(scene, threads, isa, PROGRESS_NONE, out, err);
}

void bvh_destroy(Bvh *bvh) {
    if (!bvh) return;
    if (bvh->sheets) rtcReleaseScene(bvh->sheets);
    if (bvh->scene) rtcReleaseScene(bvh->scene);
    if (bvh->device) rtcReleaseDevice(bvh->device);
    free(bvh);
}

int bvh_threads(const Bvh *bvh) {
    return bvh->threads;
}

void bvh_record(Bvh *bvh, BvhRecorder *recorder) {
    bvh->recorder = recorder;
}

#define TEXT_OF(x) #x
#define VERSION_TEXT(a, b, c) TEXT_OF(a) "." TEXT_OF(b) "." TEXT_OF(c)

const char *bvh_library(void) {
    return "Embree " VERSION_TEXT(RTC_VERSION_MAJOR, RTC_VERSION_MINOR, RTC_VERSION_PATCH);
}
