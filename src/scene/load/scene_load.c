/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/query/panel_open.h"
#include "scene/load/scene_load.h"

#include <stdlib.h>
#include <string.h>

#include "scene/change/material_change.h"
#include "scene/change/mirror_change.h"
#include "scene/check/check.h"
#include "scene/check/check_data.h"
#include "scene/check/check_graph.h"
#include "scene/check/display_frame.h"
#include "scene/check/schema.h"
#include "scene/check/schema_core.h"
#include "scene/check/schema_extensions.h"
#include "scene/gltf/buffer_view.h"
#include "scene/gltf/document.h"
#include "scene/gltf/extras.h"
#include "scene/gltf/list.h"
#include "scene/gltf/loader.h"
#include "scene/gltf/packed_mesh.h"
#include "scene/gltf/tree.h"
#include "scene/gltf/variant.h"
#include "scene/load/display.h"
#include "scene/load/graph.h"
#include "scene/load/hood.h"
#include "scene/load/image.h"
#include "scene/load/luminaire.h"
#include "scene/load/material.h"
#include "scene/load/nodes.h"
#include "scene/gltf/part_draft.h"
#include "scene/load/pose.h"
#include "scene/load/profiles.h"
#include "scene/load/scene_origin.h"
#include "text/nearest_word.h"

/* ---- materials marked BLEND or MASK that are opaque everywhere ------------------------- */

/* Exporters mark whole models so; testing such surfaces at every ray costs time for nothing. */

static bool has_full_alpha(const Image *image) {
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 3; i < 4 * count; i += 4) {
        if (image->format == IMAGE_RGBA8 && ((const uint8_t *)image->pixels)[i] < 255) return false;
        if (image->format == IMAGE_RGBA16 && ((const uint16_t *)image->pixels)[i] < 65535)
            return false;
        if (image->format == IMAGE_RGBA32F && !(((const float *)image->pixels)[i] >= 1))
            return false;
    }
    return true;
}

static bool has_opaque_colors(const Loader *load, int material_id) {
    for (int i = 0; i < load->parts.count; i++) {
        const PartDraft *draft = list_item(&load->parts, i);
        const VertexColor *colors = draft->part.colors;
        if (draft->part.material_id != material_id || !colors) continue;
        for (uint32_t v = 0; v < draft->vertex_count; v++)
            if (colors[v].linear[3] < 65535) return false;
    }
    return true;
}

static void find_opaque_materials(Loader *load) {
    for (int i = 0; i < load->materials.count; i++) {
        Material *m = list_item(&load->materials, i);
        int texture = m->base_color_texture.texture_id;
        if (m->alpha_mode == ALPHA_OPAQUE || m->base_color[3] < 1) continue;
        if (m->alpha_mode == ALPHA_MASK && m->alpha_cutoff > 1) continue;
        if (texture != NO_ID &&
            !has_full_alpha(&((const Texture *)list_item(&load->textures, texture))->image))
            continue;
        if (!has_opaque_colors(load, i)) continue;
        m->alpha_mode = ALPHA_OPAQUE;
    }
}

/* ---- from drafts to arrays ------------------------------------------------------------- */

static bool lets_through(const Loader *load, const PartDraft *draft) {
    const Material *material = list_item(&load->materials, draft->part.material_id);
    return material->lets_light_through;
}

static void append_part(Scene *scene, const PartDraft *draft) {
    Part *part = &scene->parts[scene->part_count];
    *part = draft->part;
    part->first_triangle = scene->triangle_count;
    part->triangle_count = draft->triangle_count;
    part->first_vertex = scene->vertex_count;
    memcpy(scene->positions + scene->vertex_count, draft->positions,
           sizeof *draft->positions * (size_t)draft->vertex_count);
    for (uint32_t t = 0; t < draft->triangle_count; t++) {
        Triangle *triangle = &scene->triangles[scene->triangle_count++];
        triangle->part_id = (uint32_t)scene->part_count;
        for (int c = 0; c < 3; c++)
            triangle->vertex[c] = scene->vertex_count + draft->indices[3 * (size_t)t + (size_t)c];
    }
    scene->vertex_count += draft->vertex_count;
    scene->part_count++;
}

static void join_parts(const Loader *load, Scene *scene) {
    size_t vertices = 0, triangles = 0;
    for (int i = 0; i < load->parts.count; i++) {
        const PartDraft *draft = list_item(&load->parts, i);
        vertices += draft->vertex_count;
        triangles += draft->triangle_count;
    }
    scene->positions = arena_alloc(load->arena, sizeof(Vec3), 64, vertices + 1);
    scene->triangles = ARENA_NEW(load->arena, Triangle, triangles);
    scene->parts = ARENA_NEW(load->arena, Part, load->parts.count);
    for (int pass = 0; pass < 2; pass++) { /* opaque ones first */
        for (int i = 0; i < load->parts.count; i++) {
            const PartDraft *draft = list_item(&load->parts, i);
            if (lets_through(load, draft) == (pass == 1)) append_part(scene, draft);
        }
        if (pass == 0) scene->opaque_count = scene->triangle_count;
    }
}

static void measure_edge(Scene *scene, Vec3 from, Vec3 to) {
    scene->longest_edge_m = fmaxf(scene->longest_edge_m, vec3_length(vec3_sub(to, from)));
}

static void measure_bounds(Scene *scene) {
    Vec3 low = vec3(INFINITY, INFINITY, INFINITY), high = vec3_neg(low);
    for (uint32_t t = 0; t < scene->triangle_count; t++)
        for (int c = 0; c < 3; c++) {
            Vec3 p = scene_corner(scene, t, c);
            measure_edge(scene, p, scene_corner(scene, t, (c + 1) % 3));
            low = vec3(fminf(low.x, p.x), fminf(low.y, p.y), fminf(low.z, p.z));
            high = vec3(fmaxf(high.x, p.x), fmaxf(high.y, p.y), fmaxf(high.z, p.z));
        }
    scene->bounds_min = low;
    scene->bounds_max = high;
}

/* Below a tenth of it, rays that leave a surface are set off by lengths like the scene's own,
 * and areas are no floats at last: light is lost. */
#define LEAST_SIZE_M 1e-6f

static void warn_if_odd(const Scene *scene, Loader *load) {
    if (!scene->triangle_count) return;
    Vec3 low = scene->bounds_min, high = scene->bounds_max;
    float size = vec3_length(vec3_sub(high, low));
    if (size < LEAST_SIZE_M)
        problems_add(load->problems, SEVERITY_WARNING, scene->inputs[0], "",
                     "the scene is %.3g m large: light goes astray below %g m; glTF's lengths "
                     "are in metres: make it larger",
                     (double)size, (double)LEAST_SIZE_M);
}

/* A texture that no material shows may have no picture; nobody looks, but it is valid. */
static void fill_gaps(Scene *scene) {
    static const unsigned char WHITE[4] = {255, 255, 255, 255};
    for (int i = 0; i < scene->texture_count; i++)
        if (scene->textures[i].image.width == 0)
            scene->textures[i].image = (Image){1, 1, IMAGE_RGBA8, WHITE};
}

static int compare_text(const void *a, const void *b) {
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

static void sort_extensions(Scene *scene) {
    int kept = 0;
    const char **list = scene->extensions;
    if (scene->extension_count)
        qsort(list, (size_t)scene->extension_count, sizeof *list, compare_text);
    for (int i = 0; i < scene->extension_count; i++)
        if (i == 0 || strcmp(list[i], list[kept - 1]) != 0) list[kept++] = list[i];
    scene->extension_count = kept;
}

static Scene *assemble(Loader *load) {
    Arena *arena = load->arena;
    Scene *scene = ARENA_NEW(arena, Scene, 1);
    *scene = (Scene){.materials = list_copy(&load->materials, arena),
                     .material_count = load->materials.count,
                     .textures = list_copy(&load->textures, arena),
                     .texture_count = load->textures.count,
                     .displays = list_copy(&load->displays, arena),
                     .display_count = load->displays.count,
                     .lights = list_copy(&load->lights, arena),
                     .light_count = load->lights.count,
                     .cameras = list_copy(&load->cameras, arena),
                     .camera_count = load->cameras.count,
                     .curves = list_copy(&load->curves, arena),
                     .curve_count = load->curves.count,
                     .inputs = list_copy(&load->inputs, arena),
                     .input_hashes = list_copy(&load->input_hashes, arena),
                     .input_count = load->inputs.count,
                     .undecoded = list_copy(&load->undecoded, arena),
                     .undecoded_count = load->undecoded.count,
                     .extensions = list_copy(&load->extensions, arena),
                     .extension_count = load->extensions.count,
                     .variants = list_copy(&load->variants, arena),
                     .variant_count = load->variants.count,
                     .animations = list_copy(&load->animations, arena),
                     .animation_count = load->animations.count,
                     .environment = load->environment,
                     .ignored_occlusion_count = load->ignored_occlusion_count};
    memcpy(scene->origin, load->origin, sizeof scene->origin);
    join_parts(load, scene);
    measure_bounds(scene);
    fill_gaps(scene);
    sort_extensions(scene);
    displays_doubt(scene, load->problems);
    warn_if_odd(scene, load);
    return scene;
}

/* ---- reading --------------------------------------------------------------------------- */

static void note_extensions(GltfFile *file) {
    for (const GltfValue *e = tree_items(file->root, "extensionsUsed"); e; e = tree_next(e))
        load_note(file->load, &file->load->extensions, e->text);
}

static void check_structure(GltfFile *file) {
    const DocumentCheck check = {file, SEVERITY_ERROR};
    schema_check(&check, file->root, &SCHEMA_ROOT);
    check_extensions(&check, file->root);
    check_hierarchy(&check, file->root);
    document_load_buffers(file);
}

static bool read_data(GltfFile *file) {
    Error err;
    return gltf_json_data(file->root, &file->load->scratch, &file->data, &err) ||
           file_error(file, NULL, "%s", err.text);
}

/* One file: read, check, and, when nothing is wrong, load what it refers to and place its
 * nodes. NULL: something is wrong. */
static GltfFile *load_file(Loader *load, const char *path) {
    const Problems *problems = load->problems;
    int before = problems->error_count;
    GltfFile *file = ARENA_NEW(&load->scratch, GltfFile, 1);
    *file = (GltfFile){.load = load, .path = load_keep(load, path)};
    if (!document_read(file)) return NULL;
    extras_unfold(file);
    materials_change(file);
    note_extensions(file);
    variant_choose(file);
    check_structure(file);
    if (problems->error_count > before || !read_data(file)) return NULL;
    buffer_views_build(file);
    if (problems->error_count == before) packed_meshes_build(file);
    if (problems->error_count > before) return NULL;
    check_data(file);
    if (problems->error_count > before) return NULL;
    images_load(file);
    profiles_load(file);
    materials_build(file);
    pose_build(file);
    nodes_place(file);
    return file;
}

static void load_files(Loader *load) {
    int count = 0;
    GltfFile **files = ARENA_NEW(&load->scratch, GltfFile *, load->options->path_count);
    for (int i = 0; i < load->options->path_count; i++) {
        GltfFile *file = load_file(load, load->options->paths[i]);
        if (file) files[count++] = file;
    }
    scene_origin_find(load, files, count);
    for (int i = 0; i < count; i++) graph_build(files[i]);
}

static Loader loader_start(const SceneOptions *options, Arena *arena, Problems *problems) {
    return (Loader){.arena = arena,
                    .scratch = arena_reserve(LOAD_SCRATCH_BYTES),
                    .problems = problems,
                    .options = options,
                    .environment = {.color = {1, 1, 1},
                                    .hdri_path = "",
                                    .hdri_scale = 1,
                                    .forward = {0, 0, -1}},
                    .parts = list_of(sizeof(PartDraft)),
                    .materials = list_of(sizeof(Material)),
                    .material_uv_sets = list_of(sizeof(int[SCENE_UV_SETS])),
                    .textures = list_of(sizeof(Texture)),
                    .texture_words = list_of(sizeof(const char *)),
                    .displays = list_of(sizeof(Display)),
                    .lights = list_of(sizeof(PunctualLight)),
                    .cameras = list_of(sizeof(SceneCamera)),
                    .curves = list_of(sizeof(Curve)),
                    .display_places = list_of(sizeof(DisplayPlace)),
                    .inputs = list_of(sizeof(const char *)),
                    .input_hashes = list_of(sizeof(uint64_t)),
                    .undecoded = list_of(sizeof(const char *)),
                    .extensions = list_of(sizeof(const char *)),
                    .node_names = list_of(sizeof(const char *)),
                    .variants = list_of(sizeof(const char *)),
                    .animations = list_of(sizeof(SceneAnimation))};
}

/* ---- what is tried out ------------------------------------------------------------------ */

/* The names that a change can refer to: nodes that are shown, materials, or those of
 * displays. */
static const char **names_for(Loader *load, SceneChangeKind kind, int *count) {
    if (kind == CHANGE_NODES) {
        *count = load->node_names.count;
        return load->node_names.items;
    }
    const char **names = ARENA_NEW(&load->scratch, const char *, load->materials.count);
    *count = 0;
    for (int i = 0; i < load->materials.count; i++) {
        const Material *m = list_item(&load->materials, i);
        if (kind == CHANGE_MATERIAL || m->display_id != NO_ID) names[(*count)++] = m->name;
    }
    return names;
}

/* The names that changes request and no file has. */
static void report_unused_changes(Loader *load) {
    static const char *const WHAT[] = {[CHANGE_NODES] = "node",
                                       [CHANGE_MATERIAL] = "material",
                                       [CHANGE_HOOD] = "display",
                                       [CHANGE_FINISH] = "display"};
    for (int i = 0; i < load->options->change_count; i++) {
        const SceneChange *change = &load->options->changes[i];
        char advice[600];
        int count;
        if (change->kind == CHANGE_NODES && load->change_uses[i] > 1)
            problems_add(load->problems, SEVERITY_ERROR, change->file, change->place,
                         "nodes of %d files are named \"%.100s\", required: one",
                         load->change_uses[i], change->name);
        if (load->change_uses[i] > 0 || change->kind == CHANGE_MIRROR) continue;
        const char **names = names_for(load, change->kind, &count);
        problems_add(load->problems, SEVERITY_ERROR, change->file, change->place,
                     "no %s is named \"%.100s\" — %s", WHAT[change->kind], change->name,
                     nearest_word_advice(change->name, names, count, advice, (int)sizeof advice));
    }
}

Scene *scene_survey(const SceneOptions *options, ProgressMode progress, Arena *arena,
                    Problems *problems) {
    Loader load = loader_start(options, arena, problems);
    load.progress_mode = progress;
    load.change_uses = ARENA_NEW(&load.scratch, int, options->change_count);
    luminaires_start(&load);
    load_files(&load);
    pose_report_missing(&load);
    luminaires_finish(&load);
    mirror_scene_origin(&load);
    displays_override(&load);
    displays_change(&load);
    displays_mirror(&load);
    hoods_build(&load);
    report_unused_changes(&load);
    displays_finish(&load);
    find_opaque_materials(&load);
    for (int i = 0; i < load.materials.count; i++)
        material_derive_flags(list_item(&load.materials, i));
    Scene *scene = assemble(&load);
    arena_release(&load.scratch);
    return scene;
}

bool scene_load(const SceneOptions *options, Arena *arena, Problems *problems, Scene **out,
                Error *err) {
    return scene_load_shown(options, PROGRESS_NONE, arena, problems, out, err);
}

bool scene_load_shown(const SceneOptions *options, ProgressMode progress, Arena *arena,
                      Problems *problems, Scene **out, Error *err) {
    Scene *scene = scene_survey(options, progress, arena, problems);
    if (problems_verdict(problems, err)) {
        *out = scene;
        return true;
    }
    scene_close(scene);
    return false;
}

void scene_close(Scene *scene) {
    for (int i = 0; scene && i < scene->display_count; i++) {
        const Display *displays = scene->displays;
        bool is_first = true; /* displays of one file share its panel */
        for (int k = 0; k < i; k++) is_first &= displays[k].panel != displays[i].panel;
        if (is_first) panel_close((Panel *)displays[i].panel);
    }
}
