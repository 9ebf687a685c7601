/* SPDX-License-Identifier: Apache-2.0 */
#include "sunlit/sunlit_receivers.h"

#include "base/mathf.h"
#include "base/sampler.h"

#define WALKS 1024   /* from displays, and as many from cameras */
#define WALK_STEPS 3 /* surfaces that one meets */
#define SEED 0x72656376u

typedef struct Walks {
    const SunlitTools *tools;
    SunlitReceivers out;
} Walks;

/* About n (unit), by the cosine. */
static Vec3 cosine_direction(Vec3 n, Vec2 u) {
    Frame frame = frame_from_z(n);
    float sine, cosine, r = sqrtf(u.x);
    sincos_turns(u.y, &sine, &cosine);
    return frame_to_world(&frame, vec3(r * cosine, r * sine, safe_sqrtf(1 - u.x)));
}

/* What lets light through is passed. */
static void walk(Walks *walks, Ray ray, Sampler *sampler) {
    const SunlitTools *tools = walks->tools;
    for (int step = 0; step < WALK_STEPS; step++) {
        Hit hit;
        if (!sunlit_land(tools->scene, tools->bvh, ray, &hit)) return;
        TrianglePoint point = triangle_point(tools->scene, hit.triangle, hit.u, hit.v);
        bool is_back = vec3_dot(point.ng, ray.direction) > 0;
        Vec3 n = is_back ? vec3_neg(point.ng) : point.ng;
        Vec3 place = ray_start(&point, n);
        walks->out.at[walks->out.count++] = (SunlitReceiver){place, n};
        Vec3 next = cosine_direction(n, sampler_2d(sampler));
        ray = (Ray){ray_start(&point, next), next, 0, INFINITY};
    }
}

static bool is_display(const Scene *scene, uint32_t triangle) {
    return scene->materials[scene_part(scene, triangle)->material_id].display_id != NO_ID;
}

/* The displays' triangles, and the sums of their areas so far, m^2. */
typedef struct Fronts {
    uint32_t *triangle;
    float *until;
    int count;
} Fronts;

static Fronts find_fronts(const Scene *scene, Arena *arena) {
    Fronts fronts = {0};
    float sum = 0;
    for (uint32_t i = 0; i < scene->triangle_count; i++) fronts.count += is_display(scene, i);
    fronts.triangle = ARENA_NEW(arena, uint32_t, fronts.count);
    fronts.until = ARENA_NEW(arena, float, fronts.count);
    fronts.count = 0;
    for (uint32_t i = 0; i < scene->triangle_count; i++) {
        if (!is_display(scene, i)) continue;
        Vec3 a = scene_corner(scene, i, 0);
        sum += vec3_length(vec3_cross(vec3_sub(scene_corner(scene, i, 1), a),
                                      vec3_sub(scene_corner(scene, i, 2), a)));
        fronts.triangle[fronts.count] = i;
        fronts.until[fronts.count++] = sum;
    }
    return fronts;
}

/* A place of a display is a receiver itself. */
static void walk_from_displays(Walks *walks, Arena scratch) {
    const Scene *scene = walks->tools->scene;
    Fronts fronts = find_fronts(scene, &scratch);
    for (int k = 0; k < WALKS && fronts.count; k++) {
        Sampler sampler = sampler_start(SEED, 0, 0, (uint32_t)k);
        float at = sampler_2d(&sampler).x * fronts.until[fronts.count - 1];
        Vec2 u = sampler_2d(&sampler);
        int i = 0;
        while (i + 1 < fronts.count && fronts.until[i] <= at) i++;
        if (u.x + u.y > 1) u = (Vec2){1 - u.x, 1 - u.y};
        TrianglePoint point = triangle_point(scene, fronts.triangle[i], u.x, u.y);
        Vec3 way = cosine_direction(point.ng, sampler_2d(&sampler));
        Vec3 place = ray_start(&point, point.ng);
        Ray ray = {ray_start(&point, way), way, 0, INFINITY};
        walks->out.at[walks->out.count++] = (SunlitReceiver){place, point.ng};
        walk(walks, ray, &sampler);
    }
}

/* Even over the picture's plane; a camera without perspective looks straight on. */
static Vec3 view_direction(const SceneCamera *camera, Vec2 u) {
    float sine, cosine, aspect = camera->aspect > 0 ? camera->aspect : 1;
    float half = camera->is_perspective ? camera->yfov / 2 : 0;
    sincos_turns(half / (2 * PI_F), &sine, &cosine);
    float high = sine / max_f(cosine, 1e-3f);
    Vec3 local = vec3((2 * u.x - 1) * high * aspect, (2 * u.y - 1) * high, -1);
    return vec3_normalize(transform_vector(&camera->world_from_camera, local));
}

static void walk_from_cameras(Walks *walks) {
    const Scene *scene = walks->tools->scene;
    for (int k = 0; k < WALKS && scene->camera_count; k++) {
        const SceneCamera *camera = &scene->cameras[k % scene->camera_count];
        Sampler sampler = sampler_start(SEED, 1, 0, (uint32_t)k);
        Vec3 eye = transform_point(&camera->world_from_camera, vec3(0, 0, 0));
        Vec3 way = view_direction(camera, sampler_2d(&sampler));
        walk(walks, (Ray){eye, way, 0, INFINITY}, &sampler);
    }
}

SunlitReceivers sunlit_receivers(const SunlitTools *tools, Arena *arena) {
    Walks walks = {.tools = tools};
    walks.out.at = ARENA_NEW(arena, SunlitReceiver, 2 * WALKS * (WALK_STEPS + 1));
    walk_from_displays(&walks, *arena);
    walk_from_cameras(&walks);
    return walks.out;
}
