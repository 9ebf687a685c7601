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

static const Image *content_of(const Scene *scene, const Display *display) {
    int id = display->content.texture_id;
    return id == NO_ID ? NULL : &scene->textures[id].image;
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

static const char *opening_name(const LuminousOpening *opening) {
    switch (opening->shape) {
    case OPENING_BOX: return opening->is_flat ? "rectangle" : "box";
    case OPENING_CYLINDER: return opening->is_flat ? "ellipse" : "cylinder";
    case OPENING_ELLIPSOID: return "ellipsoid";
    case OPENING_POINT: break;
    }
    return "point";
}

/* ---- the answer ------------------------------------------------------------------------ */

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

static json_t *answer_of(const Scene *scene, const MissedLight *missed, const Problems *problems,
                         Arena *arena) {
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
    const Vec3 low = scene->bounds_min, high = scene->bounds_max;
    json_object_set_new(answer, "bounds_m", json_bounds(scene));
    json_object_set_new(answer, "size_m",
                        scene->triangle_count ? json_vector(vec3_sub(high, low)) : json_null());
    json_object_set_new(answer, "origin_m", json_world_point(scene->origin));
    json_object_set_new(answer, "variants", json_texts(scene->variants, scene->variant_count));
    json_object_set_new(answer, "animations", json_animations(scene));
    json_object_set_new(answer, "missed_light", missed_pairs_json(scene, missed));
    json_object_set_new(answer, "material_list", material_list_json(scene, arena));
    json_object_set_new(answer, "one_sided", material_list_one_sided(scene));
    json_object_set_new(answer, "ignored_occlusion_textures",
                        json_integer(scene->ignored_occlusion_count));
    return answer;
}

/* ---- what people read ------------------------------------------------------------------- */

static const Column DISPLAYS[] = {
    COLUMN_TEXT("name", "display"),
    COLUMN_TEXT("panel", "panel"),
    COLUMN_SHARE("level", "level"),
    {.key = "content_size", .words = "content, pixels", .none = "none: full white"}};
static const TableKind DISPLAYS_KIND = TABLE_KIND("displays", NULL, DISPLAYS);

static const Column LIGHTS[] = {
    COLUMN_TEXT("name", "light"),
    COLUMN_TEXT("type", "type"),
    COLUMN_DIGITS("intensity", "RGB", NULL, 0),
    COLUMN_TEXT("unit", "unit"),
    COLUMN_SHARE("level", "level"),
    COLUMN_DIGITS("flux_lm", "flux", "lm", 4),
    COLUMN_DIGITS("max_cd", "at most", "cd", 4),
    {.key = "direction",
     .words = "towards",
     .is_fixed = true,
     .places = 3,
     .about = "unit, world: where `max_cd` goes to"},
    {.key = "cct_k", .words = "colour", .unit = "K", .none = "D65"},
    {.key = "cct_text",
     .words = "the file says",
     .about = "of its colour, understood or not; null: nothing, or `--light-cct` spoke"},
    {.key = "opening.shape",
     .words = "opening",
     .about = "`rectangle`, `ellipse`, `box`, `cylinder`, `ellipsoid`; `opening` is null: a point"},
    {.key = "opening.size_m", .words = "of", .unit = "m", .about = "along the node's X, Y and Z"},
    {.key = "tilt.angle_deg",
     .words = "tilt",
     .unit = "deg",
     .places = 3,
     .about = "`tilt` is null: the file has no factors"},
    {.key = "tilt.factor", .words = "by it times", .about = "is in `flux_lm` and `max_cd`"},
    {.key = "file",
     .words = "file",
     .about = "of a luminaire, as all from `level` on; inside a scene `SCENE#` and the pointer"}};
static const TableKind LIGHTS_KIND = TABLE_KIND("lights", NULL, LIGHTS);

static const Column CAMERAS[] = {COLUMN_TEXT("node", "camera, node"), COLUMN_TEXT("name", "name"),
                                 COLUMN_TEXT("type", "type"),
                                 COLUMN_DIGITS("yfov_deg", "field of view, high", "deg", 4),
                                 COLUMN_DIGITS("ymag_m", "half height", "m", 0)};
static const TableKind CAMERAS_KIND = TABLE_KIND("cameras", NULL, CAMERAS);

static const Column ANIMATIONS[] = {
    COLUMN_TEXT("name", "animation"),
    {.key = "end_s", .words = "ends at", .unit = "s", .about = "the last key frame"}};
static const TableKind ANIMATIONS_KIND = TABLE_KIND("animations", NULL, ANIMATIONS);

static const Column SCENE[] = {
    COLUMN_TEXT("triangles", "triangles"),
    COLUMN_DIGITS("size_m", "size", "m", 4),
    {.key = "origin_m",
     .words = "coordinates begin at",
     .unit = "m",
     .hides_zero = true,
     .about = "0 unless the scene stands far off: `parhelion help scenes`"},
    COLUMN_TEXT("materials", "materials"),
    COLUMN_TEXT("textures", "textures"),
    {.key = "ignored_occlusion_textures",
     .words = "occlusion textures, ignored",
     .hides_zero = true},
    COLUMN_TEXT("environment.type", "environment"),
    COLUMN_DIGITS("environment.luminance_cd_m2", "its luminance", "cd/m2", 0),
    COLUMN_TEXT("environment.file", "its file"),
    COLUMN_DIGITS("environment.sun.azimuth_deg", "sun, azimuth", "deg", 4),
    COLUMN_DIGITS("environment.sun.elevation_deg", "sun, elevation", "deg", 4),
    COLUMN_DIGITS("environment.sun.illuminance_lx", "sun", "lx", 0),
    {.key = "variants", .words = "variants", .parts = ""},
    {.key = "extensions", .words = "extensions", .parts = ""},
    {.key = "one_sided",
     .words = "one-sided, back seen too",
     .parts = "",
     .about =
         "materials without `doubleSided`, but for displays: viewers of glTF leave their backs "
         "out, which are seen and reflect here"},
    {.key = "displays", .of = &DISPLAYS_KIND},
    {.key = "lights", .of = &LIGHTS_KIND},
    {.key = "cameras", .of = &CAMERAS_KIND},
    {.key = "animations", .of = &ANIMATIONS_KIND},
    COLUMN_KEY("ok", "no problem is an error"),
    COLUMN_KEY("problems", "`file`, `path`, `severity` (`error`, `warning`), `message` of each"),
    COLUMN_KEY("bounds_m", "low and high corner of all triangles, world; null without any, as "
                           "`size_m`"),
    COLUMN_KEY("missed_light", "light that no path connects, as `may_miss.lights` of `render`"),
};
static const TableKind SCENE_KIND = TABLE_KIND("scene", NULL, SCENE);

static const Column MATERIALS[] = {COLUMN_TEXT("name", "material"),
                                   {.key = "looks_like_screen",
                                    .words = "screen?",
                                    .about = "flat, with an emissive texture and coordinates"},
                                   COLUMN_DIGITS("area_m2", "area", "m2", 4),
                                   COLUMN_TEXT("is_flat", "flat"),
                                   COLUMN_TEXT("has_uv", "UVs"),
                                   COLUMN_TEXT("has_emissive_texture", "emissive texture"),
                                   COLUMN_TEXT("is_display", "display"),
                                   COLUMN_TEXT("is_one_sided", "one-sided"),
                                   COLUMN_TEXT("nodes", "nodes"),
                                   COLUMN_TEXT("meshes", "meshes")};
static const TableKind MATERIALS_KIND = TABLE_KIND("materials", NULL, MATERIALS);
static const Column MATERIALS_ONLY[] = {{.key = "material_list", .of = &MATERIALS_KIND}};
static const TableKind MATERIALS_ONLY_KIND = TABLE_KIND("materials", NULL, MATERIALS_ONLY);

static void print_problems(const Problems *problems) {
    for (int i = 0; i < problems->count; i++) {
        const Problem *p = &problems->list[i];
        print("%-12s %s: %s%s%s%s\n", p->severity == SEVERITY_ERROR ? "ERROR" : "warning", p->file,
              p->message, p->path[0] ? " (" : "", p->path, p->path[0] ? ")" : "");
    }
    print("%s: %d errors, %d warnings; conformance is for the Khronos glTF Validator\n",
          problems->error_count ? "NOT OK" : "ok", problems->error_count, problems->warning_count);
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
    const CliCommand command = {
        "check",
        command_check.summary,
        "SCENE.gltf|.glb [LIGHTS.gltf|.glb ...]",
        "parhelion check scenes/car_dashboard.gltf scenes/noon.gltf",
        options,
        COUNT_OF(options),
        1,
        -1,
        .answers = (const Answer[]){{"", &SCENE_KIND}, {"", &MATERIALS_ONLY_KIND}, {0}}};
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
    const TableKind *kind = materials ? &MATERIALS_ONLY_KIND : &SCENE_KIND;
    done = cli_print_answer(kind, answer_of(scene, &missed, &problems, arena), cli.json, err);
    if (!cli.json) print_problems(&problems);
    scene_close(scene);
    if (!done || !problems.error_count) return outcome_of(done);
    *err = (Error){.code = ERROR_INPUT}; /* said already, problem by problem */
    return OUTCOME_FAILED;
}

const Command command_check = {"check", "what is in a scene, and everything that is wrong with it",
                               run_check};
