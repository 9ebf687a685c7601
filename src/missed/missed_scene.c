/* SPDX-License-Identifier: Apache-2.0 */
#include "missed/missed_scene.h"

#include "missed/missed_rays.h"
#include "path/path.h"

#define BOUNCES 64
#define HEIGHT 512 /* pixels: a picture's shape is all that counts */

static MissedEye camera_eye(const SceneCamera *camera, Arena *arena) {
    Camera *placed = ARENA_NEW(arena, Camera, 1);
    float aspect = camera->aspect > 0 ? camera->aspect : 16.0f / 9;
    *placed = camera_from_scene(camera, (int)(aspect * HEIGHT + 0.5f), HEIGHT);
    const char *name = camera->node_name[0] ? camera->node_name : camera->camera_name;
    return (MissedEye){.name = name, .camera = placed, .display_id = NO_ID};
}

static MissedEye *list_eyes(const Scene *scene, int *count, Arena *arena) {
    MissedEye *eyes = ARENA_NEW(arena, MissedEye, scene->camera_count + scene->display_count + 1);
    *count = 0;
    for (int i = 0; i < scene->camera_count; i++)
        eyes[(*count)++] = camera_eye(&scene->cameras[i], arena);
    if (!scene->camera_count) {
        SceneCamera framing = camera_frame_scene(scene);
        eyes[(*count)++] = camera_eye(&framing, arena);
        eyes[0].name = "";
    }
    for (int i = 0; i < scene->display_count; i++)
        eyes[(*count)++] = (MissedEye){.name = scene->displays[i].name, .display_id = i};
    return eyes;
}

/* Else there is nothing to miss, and surfaces' tables and the ray tracer need not be built. */
static bool has_smooth_parts(const Scene *scene) {
    for (int i = 0; i < scene->part_count; i++)
        if (missed_is_smooth(scene, &scene->materials[scene->parts[i].material_id])) return true;
    return false;
}

bool missed_in_scene(const Scene *scene, const MissedRun *run, Arena *arena, MissedLight *out,
                     Error *err) {
    Lights *lights;
    Bvh *bvh;
    int count;
    *out = (MissedLight){.count = 0};
    if (!has_smooth_parts(scene)) return true;
    if (!lights_build(scene, arena, &lights, err)) return false;
    if (!lights_has(lights, LIGHTS_SUN) && !lights_has(lights, LIGHTS_PUNCTUAL) &&
        !lights_has(lights, LIGHTS_EMITTERS))
        return true;
    if (!bvh_build(scene, run->threads, NULL, run->progress, &bvh, err)) return false;
    PathContext context = path_context_sketch(scene, bvh, lights, BOUNCES, arena);
    MissedEye *eyes = list_eyes(scene, &count, arena);
    *out = missed_light_find(&context, eyes, count, arena);
    bvh_destroy(bvh);
    return true;
}
