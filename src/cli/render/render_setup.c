#include "cli/render/render_setup.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "camera/camera.h"

/* ---- camera ------------------------------------------------------------------------------ */

static int find_camera(const Scene *scene, const char *wanted)
{
    for (int i = 0; i < scene->camera_count; i++)
        if (!strcmp(scene->cameras[i].node_name, wanted)) return i;
    for (int i = 0; i < scene->camera_count; i++)
        if (!strcmp(scene->cameras[i].camera_name, wanted)) return i;
    char *end;
    long  index = strtol(wanted, &end, 10);
    bool  is_index = *wanted && !*end && index >= 0 && index < scene->camera_count;
    return is_index ? (int)index : NO_ID;
}

static const char *camera_name(const SceneCamera *camera)
{
    return camera->node_name[0] ? camera->node_name : camera->camera_name;
}

static bool no_such_camera(const Scene *scene, const char *wanted, Error *err)
{
    char   names[512] = "";
    size_t length = 0;
    for (int i = 0; i < scene->camera_count && length + 80 < sizeof names; i++)
        length += (size_t)snprintf(names + length, sizeof names - length, "%s%d '%.60s'",
                                   i ? ", " : "", i, camera_name(&scene->cameras[i]));
    return error_set(err, ERROR_USAGE, "--camera %s: no camera has this name or index — the "
                                       "scene has %s",
                     wanted, scene->camera_count ? names : "none");
}

bool render_choose_camera(const Scene *scene, const char *wanted, Problems *problems,
                          SceneCamera *out, Error *err)
{
    if (wanted || scene->camera_count) {
        int index = wanted ? find_camera(scene, wanted) : 0;
        if (index == NO_ID) return no_such_camera(scene, wanted, err);
        *out = scene->cameras[index];
        return true;
    }
    *out = camera_frame_scene(scene);
    problems_add(problems, SEVERITY_WARNING, scene->input_count ? scene->inputs[0] : "", NULL,
                 scene->triangle_count ? "the scene has no camera: it is framed whole"
                                       : "the scene has neither a camera nor triangles: the "
                                         "view is from its origin along -Z");
    return true;
}

/* ---- light ------------------------------------------------------------------------------- */

static bool has_light(const Scene *scene)
{
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

void render_tell_of_darkness(const Scene *scene, Problems *problems)
{
    if (!has_light(scene))
        problems_add(problems, SEVERITY_WARNING, scene->input_count ? scene->inputs[0] : "",
                     NULL, "nothing gives light, the frame is black — add a file with lights, "
                     "or --environment");
}
