/* What the command line changes about a scene, and the camera that looks at it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/units.h"
#include "cli/render_command.h"

#define HDRI_BYTES_MAX ((size_t)4 << 30)
#define SUN_RADIUS_DEG 0.26645 /* half the Sun's mean angular diameter */

/* ---- environment ------------------------------------------------------------------------- */

static void add_input(Scene *scene, const char *path, uint64_t hash, Arena *arena)
{
    int          count = scene->input_count;
    const char **inputs = ARENA_NEW(arena, const char *, count + 1);
    uint64_t    *hashes = ARENA_NEW(arena, uint64_t, count + 1);
    for (int i = 0; i < count; i++) {
        inputs[i] = scene->inputs[i];
        hashes[i] = scene->input_hashes[i];
    }
    inputs[count] = path;
    hashes[count] = hash;
    scene->inputs = inputs;
    scene->input_hashes = hashes;
    scene->input_count = count + 1;
}

static bool set_constant(const char *text, Environment *environment, Error *err)
{
    double luminance;
    if (!cli_numbers(text, 1, &luminance) || luminance < 0)
        return error_set(err, ERROR_USAGE,
                         "--environment constant:%s: wanted a luminance in cd/m2, at least 0",
                         text);
    environment->kind = ENVIRONMENT_CONSTANT;
    environment->luminance_cd_m2 = (float)luminance;
    for (int i = 0; i < 3; i++) environment->color[i] = 1;
    return true;
}

static bool set_hdri(const char *path, Scene *scene, Arena *arena, Error *err)
{
    Environment *environment = &scene->environment;
    FileBytes    bytes;
    Image        image;
    if (!file_read(path, HDRI_BYTES_MAX, arena, &bytes, err)) return false;
    if (!image_read_memory(bytes.data, bytes.size, path, arena, &image, err)) return false;
    if (image.format != IMAGE_RGBA32F)
        return error_at(err, ERROR_INPUT, path, NULL,
                        "holds display codes, wanted linear light — an OpenEXR or Radiance HDR "
                        "picture");
    if (environment->kind != ENVIRONMENT_HDRI) environment->hdri_scale = 1;
    environment->kind = ENVIRONMENT_HDRI;
    environment->hdri_path = path;
    environment->hdri = image;
    add_input(scene, path, XXH3_64bits(bytes.data, bytes.size), arena);
    return true;
}

static bool set_environment(const char *text, Scene *scene, Arena *arena, Error *err)
{
    if (!strncmp(text, "constant:", 9)) return set_constant(text + 9, &scene->environment, err);
    if (!strncmp(text, "hdri:", 5) && text[5]) return set_hdri(text + 5, scene, arena, err);
    if (!strncmp(text, "sky:", 4) || !strncmp(text, "cie:", 4) || !strncmp(text, "perez:", 6))
        return error_set(err, ERROR_USAGE,
                         "--environment %s: sky models are not available in this version — use "
                         "constant:CD_M2 or hdri:FILE",
                         text);
    return error_set(err, ERROR_USAGE, "--environment %s: wanted constant:CD_M2 or hdri:FILE",
                     text);
}

static bool set_sun(const char *text, Environment *environment, Error *err)
{
    double sun[3] = {0, 0, (double)environment->sun_illuminance_lx};
    if (!strcmp(text, "off")) {
        environment->has_sun = false;
        return true;
    }
    bool has_lux = cli_numbers(text, 3, sun);
    if ((!has_lux && !cli_numbers(text, 2, sun)) || fabs(sun[0]) > 360 || fabs(sun[1]) > 90 ||
        sun[2] < 0)
        return error_set(
            err, ERROR_USAGE,
            "--sun %s: wanted off, or AZ,EL,LUX with AZ -360 to 360 and EL -90 to 90 "
            "degrees and LUX at least 0",
            text);
    if (!has_lux && !environment->has_sun)
        return error_set(
            err, ERROR_USAGE,
            "--sun %s: the scene's sun has no illuminance to keep — write AZ,EL,LUX", text);
    environment->has_sun = true;
    environment->sun_azimuth = (float)radians_from_degrees(sun[0]);
    environment->sun_elevation = (float)radians_from_degrees(sun[1]);
    environment->sun_illuminance_lx = (float)sun[2];
    if (!(environment->sun_angular_radius > 0))
        environment->sun_angular_radius = (float)radians_from_degrees(SUN_RADIUS_DEG);
    return true;
}

static bool set_directions(const EnvironmentChange *change, Environment *environment,
                           Error *err)
{
    if (change->has_heading)
        environment->heading = (float)radians_from_degrees(change->heading_deg);
    if (vec3_length(environment->forward) == 0) environment->forward = vec3(0, 0, -1);
    if (!change->has_forward) return true;
    Vec3 forward = vec3((float)change->forward[0], (float)change->forward[1],
                        (float)change->forward[2]);
    if (forward.x == 0 && forward.z == 0)
        return error_set(err, ERROR_USAGE,
                         "--forward %g,%g,%g: wanted a vector that is not vertical",
                         change->forward[0], change->forward[1], change->forward[2]);
    environment->forward = forward;
    return true;
}

bool render_change_environment(const EnvironmentChange *change, Scene *scene, Arena *arena,
                               Error *err)
{
    Environment *environment = &scene->environment;
    if (change->environment && !set_environment(change->environment, scene, arena, err))
        return false;
    if (change->has_hdri_lux) {
        if (environment->kind != ENVIRONMENT_HDRI)
            return error_set(err, ERROR_USAGE,
                             "--hdri-lux: there is no HDRI — add --environment "
                             "hdri:FILE");
        environment->horizontal_illuminance_lx = (float)change->hdri_lux;
    }
    if (change->sun && !set_sun(change->sun, environment, err)) return false;
    return set_directions(change, environment, err);
}

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
