/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/graph.h"

#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "scene/change/mirror_change.h"
#include "scene/change/node_change.h"
#include "scene/gltf/document.h"
#include "scene/load/environment.h"
#include "scene/load/luminaire.h"
#include "scene/load/nodes.h"
#include "scene/load/primitive.h"

/* ---- cameras and lights ---------------------------------------------------------------- */

static void add_camera(GltfFile *file, const GltfValue *node, const Transform *world) {
    const GltfValue *camera = tree_referred(tree_member(node, "camera"), "cameras");
    const GltfValue *eye = tree_member(camera, "perspective");
    const GltfValue *flat = tree_member(camera, "orthographic");
    if (!eye && !flat) return; /* of a type that an extension adds */
    float xmag = fabsf(tree_float(flat, "xmag", 1)), ymag = fabsf(tree_float(flat, "ymag", 1));
    *(SceneCamera *)list_add(&file->load->cameras, &file->load->scratch) =
        (SceneCamera){.node_name = load_keep(file->load, tree_text(node, "name", "")),
                      .camera_name = load_keep(file->load, tree_text(camera, "name", "")),
                      .is_perspective = eye != NULL,
                      .yfov = tree_float(eye, "yfov", 0),
                      .ymag = ymag,
                      .aspect = eye ? tree_float(eye, "aspectRatio", 0) : xmag / ymag,
                      .znear = tree_float(eye ? eye : flat, "znear", 0),
                      .zfar = tree_float(eye ? eye : flat, "zfar", INFINITY),
                      .world_from_camera = nodes_camera_place(file, node, world)};
}

static void add_light(GltfFile *file, const GltfValue *node, const Transform *world) {
    const GltfValue *lights =
        tree_member(tree_extension(file->root, "KHR_lights_punctual"), "lights");
    const GltfValue *light =
        tree_item(lights, tree_int(tree_extension(node, "KHR_lights_punctual"), "light", NO_ID));
    const char *type = tree_text(light, "type", ""), *name = tree_text(node, "name", "");
    bool is_spot = strcmp(type, "spot") == 0, is_beam = strcmp(type, "directional") == 0;
    if (!light || (!is_spot && !is_beam && strcmp(type, "point") != 0)) return;
    const GltfValue *cone = tree_member(light, "spot");
    float color[3] = {1, 1, 1}, intensity = tree_float(light, "intensity", 1);
    tree_floats(light, "color", 3, color);
    PunctualLight *out = list_add(&file->load->lights, &file->load->scratch);
    *out = (PunctualLight){
        .kind = is_spot   ? LIGHT_SPOT
                : is_beam ? LIGHT_DIRECTIONAL
                          : LIGHT_POINT,
        .position = world->origin,
        .direction = vec3_normalize(vec3_neg(world->z)),
        .cos_inner = cos_of(is_spot ? tree_float(cone, "innerConeAngle", 0) : 0),
        .cos_outer = cos_of(is_spot ? tree_float(cone, "outerConeAngle", PI_F / 4) : PI_F)};
    for (int i = 0; i < 3; i++) out->intensity[i] = color[i] * intensity;
    bool is_named = tree_text(light, "name", "")[0];
    out->name =
        is_named || !name[0] ? load_name(file->load, light, "light") : load_keep(file->load, name);
}

static void claim_near(GltfFile *file, const GltfValue *node, const char *what, Vec3 p) {
    double at[3];
    if (!load_is_within_reach(file->load, p, at))
        file_error(file, node,
                   "its %s stands at (%g, %g, %g) in the world; numbers within %g m are "
                   "required",
                   what, at[0], at[1], at[2], (double)SCENE_MOST_M);
}

/* The light that was added last; of a directional one glTF ignores the place. */
static bool last_has_place(const Loader *load) {
    const PunctualLight *light = list_item(&load->lights, load->lights.count - 1);
    return light->kind != LIGHT_DIRECTIONAL;
}

/* Adds cameras and lights; the places of meshes are checked vertex by vertex. */
static void add_sights(GltfFile *file, const GltfValue *node, const Transform *world) {
    const Loader *load = file->load;
    int cameras = load->cameras.count, lights = load->lights.count;
    add_camera(file, node, world);
    if (!luminaire_place(file, node, world)) add_light(file, node, world);
    if (load->cameras.count > cameras) claim_near(file, node, "camera", world->origin);
    if (load->lights.count > lights && last_has_place(load))
        claim_near(file, node, "light", world->origin);
}

/* ---- all of it ------------------------------------------------------------------------- */

static void add_mesh(GltfFile *file, const GltfValue *node, const Transform *world) {
    const GltfValue *mesh = tree_referred(tree_member(node, "mesh"), "meshes");
    const GltfValue *primitives = tree_member(mesh, "primitives");
    if (!primitives) return;
    const NodeInstances *instances = &file->instances[node->index];
    for (int k = 0; k < instances->count; k++) {
        Transform at = *world;
        if (instances->node_from_mesh)
            at =
                node_place_within(&file->places[node->index], world, &instances->node_from_mesh[k]);
        for (int i = 0; i < primitives->count; i++)
            primitive_build(file, node, &at, mesh, &primitives->items[i]);
    }
}

/* For options that look up a node by its name. */
static void note_name(GltfFile *file, const GltfValue *node) {
    Loader *load = file->load;
    const char *name = tree_text(node, "name", "");
    if (name[0] && (load->options->light_count || load->options->change_count))
        load_note(load, &load->node_names, name);
}

static void build_environment(GltfFile *file) {
    const GltfValue *scene = tree_element(file->root, "scenes", tree_int(file->root, "scene", 0));
    const GltfValue *extension = tree_extension(scene, "PARHELION_environment");
    if (extension) environment_build(file, extension);
}

static void warn_of_skipped(GltfFile *file) {
    int animations = tree_count(file->root, "animations");
    if (animations && !file->load->options->state.has_time)
        file_warning(file, tree_member(file->root, "animations"),
                     "%d animation%s skipped: the pose at rest is shown (--time plays them)",
                     animations, animations == 1 ? "" : "s");
    if (file->skipped_count)
        file_warning(file, tree_member(file->root, "meshes"),
                     "%d primitive%s of points or lines skipped: only triangles are shown",
                     file->skipped_count, file->skipped_count == 1 ? "" : "s");
    if (file->degenerate_count)
        file_warning(file, tree_member(file->root, "meshes"), "%d triangle%s without area dropped",
                     file->degenerate_count, file->degenerate_count == 1 ? "" : "s");
}

void graph_build(GltfFile *file) {
    const GltfValue *nodes = tree_member(file->root, "nodes");
    build_environment(file);
    if (nodes) {
        nodes_enter_scene(file);
        nodes_change(file);
        nodes_mirror(file);
        load_progress_begin(file->load, "place", "nodes", file->shown_count);
        for (int i = 0; i < file->shown_count; i++) {
            const GltfValue *node = &nodes->items[file->shown[i]];
            const Transform *world = &file->world_from_node[file->shown[i]];
            note_name(file, node);
            add_sights(file, node, world);
            add_mesh(file, node, world);
            load_progress_add(file->load, 1);
        }
        load_progress_end(file->load);
    }
    warn_of_skipped(file);
}
