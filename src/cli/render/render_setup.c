/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/render_setup.h"

#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "base/units.h"
#include "camera/camera.h"

#define DEFAULT_WIDTH 1280
#define DEFAULT_HEIGHT 720
#define FISHEYE_SIZE 1024

/* ---- camera ------------------------------------------------------------------------------ */

static int find_camera(const Scene *scene, const char *wanted) {
    for (int i = 0; i < scene->camera_count; i++)
        if (!strcmp(scene->cameras[i].node_name, wanted)) return i;
    for (int i = 0; i < scene->camera_count; i++)
        if (!strcmp(scene->cameras[i].camera_name, wanted)) return i;
    uint64_t index;
    const char *end = number_read_count(wanted, &index);
    bool is_index = end && !*end && index < (uint64_t)scene->camera_count;
    return is_index ? (int)index : NO_ID;
}

static const char *camera_name(const SceneCamera *camera) {
    return camera->node_name[0] ? camera->node_name : camera->camera_name;
}

static bool no_such_camera(const Scene *scene, const char *wanted, Error *err) {
    char names[512] = "";
    size_t length = 0;
    for (int i = 0; i < scene->camera_count && length + 80 < sizeof names; i++)
        length += (size_t)snprintf(names + length, sizeof names - length, "%s%d '%.60s'",
                                   i ? ", " : "", i, camera_name(&scene->cameras[i]));
    return error_set(err, ERROR_USAGE,
                     "--camera %s: no camera has this name or index — the "
                     "scene has %s",
                     wanted, scene->camera_count ? names : "none");
}

static Fisheye fisheye_of(const CameraChoice *choice) {
    static const Fisheye KINDS[] = {FISHEYE_NONE, FISHEYE_EQUIDISTANT, FISHEYE_EQUIDISTANT,
                                    FISHEYE_EQUISOLID}; /* PROJECTIONS */
    return KINDS[choice->projection];
}

const char *render_projection_name(const CameraChoice *choice) {
    Fisheye kind = fisheye_of(choice);
    return kind ? fisheye_name(kind) : "camera";
}

bool render_check_size(const CameraChoice *choice, bool given, int size[2], Error *err) {
    bool is_round = fisheye_of(choice) != FISHEYE_NONE;
    if (!given) {
        size[0] = is_round ? FISHEYE_SIZE : DEFAULT_WIDTH;
        size[1] = is_round ? FISHEYE_SIZE : DEFAULT_HEIGHT;
    }
    return !is_round || size[0] == size[1] ||
           error_set(err, ERROR_USAGE,
                     "--size %dx%d: a fisheye's picture is a square around its circle, "
                     "required: %dx%d or another",
                     size[0], size[1], size[1], size[1]);
}

#define DEFAULT_FOV_DEG 40

static bool look(const Scene *scene, const CameraChoice *choice, SceneCamera *out, Error *err) {
    Vec3 eye = scene_from_world(scene->origin, choice->eye);
    Vec3 target = scene_from_world(scene->origin, choice->look_at);
    double fov_deg = choice->has_fov ? choice->fov_deg : DEFAULT_FOV_DEG;
    if (choice->name) return error_set(err, ERROR_USAGE, "--camera and --eye exclude each other");
    if (!choice->has_eye || !choice->has_look_at)
        return error_set(err, ERROR_USAGE, "%s: required: --eye X,Y,Z and --look-at X,Y,Z together",
                         choice->has_eye       ? "--eye"
                         : choice->has_look_at ? "--look-at"
                                               : "--fov");
    if (choice->has_fov && fisheye_of(choice))
        return error_set(err, ERROR_USAGE,
                         "--fov: a fisheye always sees 180 degrees — leave "
                         "it out");
    if (!(vec3_length(vec3_sub(target, eye)) > 0))
        return error_set(err, ERROR_USAGE,
                         "--look-at: is where --eye is; another point is required");
    *out = camera_look_at(eye, target, (float)radians_from_degrees(fov_deg));
    return true;
}

/* A frame that is not where anybody put it is said to be so. */
static void warn_of_framing(const Scene *scene, const SceneCamera *camera, Problems *problems) {
    double eye[3];
    const char *file = scene->input_count ? scene->inputs[0] : "";
    bool shows_displays = !strcmp(camera->camera_name, "displays");
    world_from_scene(scene->origin, camera->world_from_camera.origin, eye);
    if (scene->triangle_count)
        problems_add(problems, SEVERITY_WARNING, file, NULL,
                     "the scene has no camera: %s seen from the front, from %.4g,%.4g,%.4g — "
                     "another place with --eye and --look-at",
                     shows_displays ? "its displays are" : "it is framed whole,", eye[0], eye[1],
                     eye[2]);
    else
        problems_add(problems, SEVERITY_WARNING, file, NULL,
                     "the scene has neither a camera nor triangles: the view is from its "
                     "origin along -Z");
}

static bool choose(const Scene *scene, const CameraChoice *choice, Problems *problems,
                   SceneCamera *out, Error *err) {
    const char *wanted = choice->name;
    if (choice->has_eye || choice->has_look_at || choice->has_fov)
        return look(scene, choice, out, err);
    if (wanted || scene->camera_count) {
        int index = wanted ? find_camera(scene, wanted) : 0;
        if (index == NO_ID) return no_such_camera(scene, wanted, err);
        *out = scene->cameras[index];
        return true;
    }
    *out = camera_frame_scene(scene);
    warn_of_framing(scene, out, problems);
    return true;
}

bool render_choose_camera(const Scene *scene, const CameraChoice *choice, Problems *problems,
                          SceneCamera *out, Error *err) {
    if (!choose(scene, choice, problems, out, err)) return false;
    out->fisheye = fisheye_of(choice);
    return true;
}

bool render_check_pixel(const SceneCamera *camera, const int size[2], const double pixel[2],
                        Error *err) {
    Camera seen = camera_from_scene(camera, size[0], size[1]);
    return camera_sees_pixel(&seen, (int)pixel[0], (int)pixel[1]) ||
           error_set(err, ERROR_USAGE,
                     "pixel %g,%g lies outside the fisheye's circle: there "
                     "are no samples of it",
                     pixel[0], pixel[1]);
}

/* ---- light ------------------------------------------------------------------------------- */

static bool has_light(const Scene *scene) {
    const Environment *sky = &scene->environment;
    if (sky->has_sun || sky->kind > ENVIRONMENT_CONSTANT) return true;
    if (sky->kind == ENVIRONMENT_CONSTANT && sky->luminance_cd_m2 > 0) return true;
    for (int i = 0; i < scene->light_count; i++)
        for (int c = 0; c < 3; c++)
            if (scene->lights[i].intensity[c] > 0) return true;
    for (int i = 0; i < scene->part_count; i++)
        if (scene->materials[scene->parts[i].material_id].is_emitter) return true;
    return false;
}

void render_warn_of_darkness(const Scene *scene, Problems *problems) {
    if (!has_light(scene))
        problems_add(problems, SEVERITY_WARNING, scene->input_count ? scene->inputs[0] : "", NULL,
                     "nothing gives light, the frame is black — add a file with lights, "
                     "or --environment");
}
