/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion check: what is in a scene, and everything that is wrong with it. */
#include <string.h>

#include "base/count.h"
#include "print/print.h"
#include "base/units.h"
#include "cli/commands.h"
#include "cli/material_list.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/scene_warnings.h"
#include "cli/options/missed_answer.h"
#include "cli/options/scene_options.h"
#include "missed/missed.h"
#include "scene/check/display_frame.h"
#include "scene/load/scene_load.h"
#include "spectrum/photometry.h"
#include "text/json_text.h"

static double degrees(float radians) {
    return degrees_from_radians((double)radians);
}

/* ---- words for kinds ------------------------------------------------------------------- */

static const char *light_kind(LightKind kind) {
    static const char *const names[] = {"point", "spot", "directional", "luminaire"};
    return names[kind];
}

static const char *light_unit(LightKind kind) {
    return kind == LIGHT_DIRECTIONAL ? "lx" : "cd";
}

static const char *environment_kind(EnvironmentKind kind) {
    switch (kind) {
    case ENVIRONMENT_NONE: return "none";
    case ENVIRONMENT_CONSTANT: return "constant";
    case ENVIRONMENT_HDRI: return "hdri";
    case ENVIRONMENT_CIE: return "cie";
    case ENVIRONMENT_PEREZ: return "perez";
    case ENVIRONMENT_SKY: return "sky";
    }
    return "";
}

static const char *camera_name(const SceneCamera *camera) {
    return camera->node_name[0] ? camera->node_name : camera->camera_name;
}

static const Image *content_of(const Scene *scene, const Display *display) {
    int id = display->content.texture_id;
    return id == NO_ID ? NULL : &scene->textures[id].image;
}

/* ---- for people ------------------------------------------------------------------------ */

static void print_displays(const Scene *scene) {
    for (int i = 0; i < scene->display_count; i++) {
        const Display *d = &scene->displays[i];
        const Image *content = content_of(scene, d);
        print("display      %s: panel %s, level %g %%, ", d->name, d->panel_path,
              100 * (double)d->level);
        if (content) print("content of %dx%d pixels\n", content->width, content->height);
        else print("no content (full white)\n");
    }
}

static bool is_same_light(const PunctualLight *a, const PunctualLight *b) {
    return a->kind == b->kind && !strcmp(a->name, b->name) &&
           !memcmp(a->intensity, b->intensity, sizeof a->intensity);
}

/* The world's direction in which a luminaire is brightest. */
static Vec3 brightest_of(const PunctualLight *light) {
    Vec3 d = light->web->brightest;
    return vec3_along(vec3_along(vec3_scale(light->axis_x, d.x), light->axis_y, d.y), light->axis_z,
                      d.z);
}

/* The factor that level, tilt and colour apply to a luminaire's file. */
static float share_of(const PunctualLight *light) {
    return light->level * light->tilt_factor * luminance_from_rgb(light->color);
}

/* "4000 K" of which text, or why D65. */
static void print_white(const PunctualLight *light) {
    const char *text = light->cct_text;
    if (light->cct_k > 0) print("%g K", (double)light->cct_k);
    else print("D65");
    if (text && light->cct_k > 0) print(" (\"%.60s\")", text);
    else if (text && text[0]) print(" (\"%.60s\" tells no colour temperature)", text);
    else if (text) print(" (the file tells no colour temperature)");
}

static const char *opening_name(const LuminousOpening *opening) {
    switch (opening->shape) {
    case OPENING_BOX: return opening->is_flat ? "rectangle" : "box";
    case OPENING_CYLINDER: return opening->is_flat ? "ellipse" : "cylinder";
    case OPENING_ELLIPSOID: return "ellipsoid";
    case OPENING_POINT: break;
    }
    return "point";
}

static void print_luminaire(const PunctualLight *light) {
    Vec3 d = brightest_of(light);
    float share = share_of(light);
    const float *half = light->opening.half;
    print("light        %s: luminaire %s, ", light->name, light->file);
    print_white(light);
    print(", level %g %%, %g lm, at most %g cd towards (%.3f, %.3f, %.3f), ",
          100 * (double)light->level, (double)(light->web->flux_lm * share),
          (double)(light->web->largest_cd * share), (double)d.x, (double)d.y, (double)d.z);
    if (light->opening.shape == OPENING_POINT) print("a point");
    else
        print("%s of %g x %g x %g m", opening_name(&light->opening), 2 * (double)half[0],
              2 * (double)half[1], 2 * (double)half[2]);
    if (light->has_tilt)
        print(", tilted by %.3g degrees: x %g", (double)light->tilt_deg,
              (double)light->tilt_factor);
    print("\n");
}

/* A row of street lamps is one line. */
static void print_light(const Scene *scene, int index) {
    const PunctualLight *light = &scene->lights[index];
    int count = 0;
    for (int i = 0; i < scene->light_count; i++) {
        bool is_same = is_same_light(light, &scene->lights[i]);
        if (is_same && i < index) return;
        count += is_same;
    }
    if (light->kind == LIGHT_LUMINAIRE) {
        print_luminaire(light);
        return;
    }
    print("light        %s: %s, RGB %g %g %g %s", light->name, light_kind(light->kind),
          (double)light->intensity[0], (double)light->intensity[1], (double)light->intensity[2],
          light_unit(light->kind));
    if (count > 1) print(", %d times", count);
    print("\n");
}

static void print_lights(const Scene *scene) {
    for (int i = 0; i < scene->light_count; i++) print_light(scene, i);
    for (int i = 0; i < scene->material_count; i++) {
        const Material *m = &scene->materials[i];
        if (!m->is_emitter || m->display_id != NO_ID || m->unlit) continue;
        print("light        %s: emissive material, RGB up to %g %g %g cd/m2\n", m->name,
              (double)m->emissive_cd_m2[0], (double)m->emissive_cd_m2[1],
              (double)m->emissive_cd_m2[2]);
    }
}

static void print_environment(const Environment *e) {
    print("environment  %s", environment_kind(e->kind));
    if (e->kind == ENVIRONMENT_CONSTANT) print(", %g cd/m2", (double)e->luminance_cd_m2);
    if (e->kind == ENVIRONMENT_HDRI)
        print(" %s, %dx%d pixels", e->hdri_path, e->hdri.width, e->hdri.height);
    if (e->has_sun)
        print(", sun at azimuth %.4g deg, elevation %.4g deg, %g lx", degrees(e->sun_azimuth),
              degrees(e->sun_elevation), (double)e->sun_illuminance_lx);
    print("%s\n", e->kind == ENVIRONMENT_NONE && !e->has_sun ? ": the outside is black" : "");
}

static void print_cameras(const Scene *scene) {
    for (int i = 0; i < scene->camera_count; i++) {
        const SceneCamera *c = &scene->cameras[i];
        print("camera %-5d %s: ", i, camera_name(c)[0] ? camera_name(c) : "(no name)");
        if (c->is_perspective) print("perspective, %.4g deg high\n", degrees(c->yfov));
        else print("orthographic, %g m high\n", 2 * (double)c->ymag);
    }
    if (!scene->camera_count)
        print("camera       none: %s seen from the front\n",
              scene->display_count ? "the displays are" : "the scene is framed whole,");
}

static void print_states(const Scene *scene) {
    for (int i = 0; i < scene->variant_count; i++) print("variant      %s\n", scene->variants[i]);
    for (int i = 0; i < scene->animation_count; i++)
        print("animation    %s: %g s\n", scene->animations[i].name, scene->animations[i].end_s);
}

static void print_size(const Scene *scene, Arena *arena) {
    const Vec3 low = scene->bounds_min, high = scene->bounds_max;
    print("triangles    %u (%u opaque) in %d parts\n", scene->triangle_count, scene->opaque_count,
          scene->part_count);
    if (scene->triangle_count)
        print("size         %.4g x %.4g x %.4g m\n", (double)(high.x - low.x),
              (double)(high.y - low.y), (double)(high.z - low.z));
    const double *o = scene->origin;
    if (o[0] != 0 || o[1] != 0 || o[2] != 0)
        print("origin       %.10g, %.10g, %.10g m: coordinates are reckoned from there\n", o[0],
              o[1], o[2]);
    print("materials    %d, textures %d\n", scene->material_count, scene->texture_count);
    material_list_print_one_sided(scene, arena);
    if (scene->ignored_occlusion_count)
        print("note         %d materials have an occlusion texture: it is ignored, since tracing "
              "finds what is occluded\n",
              scene->ignored_occlusion_count);
}

static void print_problems(const Problems *problems) {
    for (int i = 0; i < problems->count; i++) {
        const Problem *p = &problems->list[i];
        print("%-12s %s: %s%s%s%s\n", p->severity == SEVERITY_ERROR ? "ERROR" : "warning", p->file,
              p->message, p->path[0] ? " (" : "", p->path, p->path[0] ? ")" : "");
    }
}

static void print_report(const Scene *scene, const Problems *problems, Arena *arena) {
    print_size(scene, arena);
    print_displays(scene);
    print_lights(scene);
    print_environment(&scene->environment);
    print_cameras(scene);
    print_states(scene);
    if (scene->extension_count) print("extensions  ");
    for (int i = 0; i < scene->extension_count; i++) print(" %s", scene->extensions[i]);
    if (scene->extension_count) print("\n");
    print("conformance  see the Khronos glTF Validator: what is wrong here is what a picture "
          "depends on\n");
    print_problems(problems);
    print("%s: %d errors, %d warnings\n", problems->error_count ? "NOT OK" : "ok",
          problems->error_count, problems->warning_count);
}

/* ---- for scripts ----------------------------------------------------------------------- */

static json_t *json_displays(const Scene *scene) {
    json_t *list = json_array();
    for (int i = 0; i < scene->display_count; i++) {
        const Display *d = &scene->displays[i];
        const Image *content = content_of(scene, d);
        json_t *size = content ? json_pack("[i,i]", content->width, content->height) : json_null();
        json_t *display =
            json_pack("{s:o, s:o, s:o, s:f}", "name", json_text(d->name), "panel",
                      json_text(d->panel_path), "content_size", size, "level", (double)d->level);
        json_array_append_new(list, display);
    }
    return list;
}

static json_t *json_rgb(const float rgb[3]) {
    return json_pack("[f,f,f]", (double)rgb[0], (double)rgb[1], (double)rgb[2]);
}

/* NULL for a point; sizes along the node's X, Y, Z. */
static json_t *json_opening(const LuminousOpening *opening) {
    const float *h = opening->half, size[3] = {2 * h[0], 2 * h[1], 2 * h[2]};
    if (opening->shape == OPENING_POINT) return json_null();
    return json_pack("{s:s, s:o}", "shape", opening_name(opening), "size_m", json_rgb(size));
}

static void add_luminaire(json_t *entry, const PunctualLight *light) {
    Vec3 d = brightest_of(light);
    const float direction[3] = {d.x, d.y, d.z};
    json_object_set_new(entry, "file", json_text(light->file));
    json_object_set_new(entry, "level", json_real((double)light->level));
    json_object_set_new(entry, "cct_k",
                        light->cct_k > 0 ? json_real((double)light->cct_k) : json_null());
    json_object_set_new(entry, "flux_lm",
                        json_real((double)(light->web->flux_lm * share_of(light))));
    json_object_set_new(entry, "max_cd",
                        json_real((double)(light->web->largest_cd * share_of(light))));
    json_object_set_new(entry, "direction", json_rgb(direction));
    json_object_set_new(entry, "cct_text",
                        light->cct_text && light->cct_text[0] ? json_text(light->cct_text)
                                                              : json_null());
    json_object_set_new(entry, "opening", json_opening(&light->opening));
    json_object_set_new(entry, "tilt",
                        light->has_tilt
                            ? json_pack("{s:f, s:f}", "angle_deg", (double)light->tilt_deg,
                                        "factor", (double)light->tilt_factor)
                            : json_null());
}

static json_t *json_lights(const Scene *scene) {
    json_t *list = json_array();
    for (int i = 0; i < scene->light_count; i++) {
        const PunctualLight *light = &scene->lights[i];
        json_t *entry = json_pack("{s:o, s:s, s:o, s:s}", "name", json_text(light->name), "type",
                                  light_kind(light->kind), "intensity", json_rgb(light->intensity),
                                  "unit", light_unit(light->kind));
        if (light->kind == LIGHT_LUMINAIRE) add_luminaire(entry, light);
        json_array_append_new(list, entry);
    }
    for (int i = 0; i < scene->material_count; i++) {
        const Material *m = &scene->materials[i];
        if (!m->is_emitter || m->display_id != NO_ID || m->unlit) continue;
        json_array_append_new(list, json_pack("{s:o, s:s, s:o, s:s}", "name", json_text(m->name),
                                              "type", "emissive", "intensity",
                                              json_rgb(m->emissive_cd_m2), "unit", "cd/m2"));
    }
    return list;
}

static json_t *json_environment(const Environment *e) {
    json_t *out = json_pack("{s:s}", "type", environment_kind(e->kind));
    if (e->kind == ENVIRONMENT_CONSTANT)
        json_object_set_new(out, "luminance_cd_m2", json_real((double)e->luminance_cd_m2));
    if (e->kind == ENVIRONMENT_HDRI) json_object_set_new(out, "file", json_text(e->hdri_path));
    if (e->has_sun)
        json_object_set_new(out, "sun",
                            json_pack("{s:f, s:f, s:f}", "azimuth_deg", degrees(e->sun_azimuth),
                                      "elevation_deg", degrees(e->sun_elevation), "illuminance_lx",
                                      (double)e->sun_illuminance_lx));
    return out;
}

static json_t *json_cameras(const Scene *scene) {
    json_t *list = json_array();
    for (int i = 0; i < scene->camera_count; i++) {
        const SceneCamera *c = &scene->cameras[i];
        json_t *camera = json_pack("{s:o, s:o, s:s}", "node", json_text(c->node_name), "name",
                                   json_text(c->camera_name), "type",
                                   c->is_perspective ? "perspective" : "orthographic");
        if (c->is_perspective) json_object_set_new(camera, "yfov_deg", json_real(degrees(c->yfov)));
        else json_object_set_new(camera, "ymag_m", json_real((double)c->ymag));
        json_array_append_new(list, camera);
    }
    return list;
}

/* The corners of a box around all triangles; null: there are none. */
static json_t *json_bounds(const Scene *scene) {
    double low[3], high[3];
    if (!scene->triangle_count) return json_null();
    world_from_scene(scene->origin, scene->bounds_min, low);
    world_from_scene(scene->origin, scene->bounds_max, high);
    return json_pack("[o,o]", json_world_point(low), json_world_point(high));
}

static json_t *json_animations(const Scene *scene) {
    json_t *list = json_array();
    for (int i = 0; i < scene->animation_count; i++)
        json_array_append_new(list,
                              json_pack("{s:o, s:f}", "name", json_text(scene->animations[i].name),
                                        "end_s", scene->animations[i].end_s));
    return list;
}

static bool print_json(const Scene *scene, const MissedLight *missed, const Problems *problems,
                       Arena *arena, Error *err) {
    json_t *list = cli_json_problems(problems, SEVERITY_ERROR);
    json_t *warnings = cli_json_problems(problems, SEVERITY_WARNING);
    json_array_extend(list, warnings);
    json_decref(warnings);
    json_t *answer = json_pack("{s:b, s:o, s:o, s:o, s:o, s:o, s:i, s:i, s:I, s:o}", "ok",
                               problems->error_count == 0, "problems", list, "displays",
                               json_displays(scene), "lights", json_lights(scene), "environment",
                               json_environment(&scene->environment), "cameras",
                               json_cameras(scene), "materials", scene->material_count, "textures",
                               scene->texture_count, "triangles", (json_int_t)scene->triangle_count,
                               "extensions", json_texts(scene->extensions, scene->extension_count));
    json_object_set_new(answer, "bounds_m", json_bounds(scene));
    json_object_set_new(answer, "origin_m", json_world_point(scene->origin));
    json_object_set_new(answer, "variants", json_texts(scene->variants, scene->variant_count));
    json_object_set_new(answer, "animations", json_animations(scene));
    json_object_set_new(answer, "missed_light", missed_pairs_json(scene, missed));
    json_object_set_new(answer, "material_list", material_list_json(scene, arena));
    return cli_print_json(answer, err);
}

/* ---- the command ----------------------------------------------------------------------- */

/* A scene with errors is not looked at. */
static bool find_missed(const Scene *scene, const MissedRun *run, Arena *arena, Problems *problems,
                        MissedLight *missed, Error *err) {
    const char *file = scene->input_count ? scene->inputs[0] : "";
    *missed = (MissedLight){.count = 0};
    if (problems->error_count) return true;
    if (!missed_in_scene(scene, run, arena, missed, err)) return false;
    const char *line;
    for (int i = 0; (line = missed_line(scene, missed, i, arena)); i++)
        problems_add(problems, SEVERITY_WARNING, file, "", "%s", line);
    return true;
}

static Outcome run_check(int argc, char **argv, Arena *arena, Error *err) {
    const char *root = NULL;
    bool materials = false, is_strict = false;
    SceneWords words = {0};
    const Option options[] = {
        {"--root", OPTION_TEXT, "DIR", ROOT_HELP, &root},
        {"--materials", OPTION_FLAG, NULL,
         "which materials there are, on which nodes, how large, and which look like screens",
         &materials},
        LAMP_OPTIONS(&words),
        {"--strict", OPTION_FLAG, NULL,
         "materials without optical data, and panels that say "
         "they are not usable, are errors",
         &is_strict},
        STATE_OPTIONS(&words.state),
    };
    const CliCommand command = {"check",
                                command_check.summary,
                                "SCENE.gltf|.glb [LIGHTS.gltf|.glb ...]",
                                "parhelion check scenes/car_dashboard.gltf scenes/noon.gltf",
                                options,
                                COUNT_OF(options),
                                1,
                                -1};
    Cli cli;
    if (!cli_parse(&command, argc, argv, arena, &cli, err)) return OUTCOME_FAILED;
    if (cli.help_shown) return OUTCOME_DONE;
    Problems problems = problems_start(arena);
    SceneOptions files = {.root = root};
    if (!scene_options_read(&words, &cli, arena, &files, err)) return OUTCOME_FAILED;
    Scene *scene = scene_survey(&files, cli.progress, arena, &problems);
    const MissedRun run = {cli.threads, cli.progress};
    MissedLight missed;
    bool done = true;
    hdri_warn(&scene->environment, &problems);
    data_warn(scene, is_strict ? SEVERITY_ERROR : SEVERITY_WARNING, &problems);
    forward_doubt(scene, &problems);
    panels_warn(scene, is_strict ? SEVERITY_ERROR : SEVERITY_WARNING, &problems);
    if (!find_missed(scene, &run, arena, &problems, &missed, err)) {
        scene_close(scene);
        return OUTCOME_FAILED;
    }
    if (cli.json) done = print_json(scene, &missed, &problems, arena, err);
    else if (materials) material_list_print(scene, arena);
    else print_report(scene, &problems, arena);
    if (!cli.json && materials) print_problems(&problems);
    scene_close(scene);
    if (!done || !problems.error_count) return outcome_of(done);
    *err = (Error){.code = ERROR_INPUT}; /* said already, problem by problem */
    return OUTCOME_FAILED;
}

const Command command_check = {"check", "what is in a scene, and everything that is wrong with it",
                               run_check};
