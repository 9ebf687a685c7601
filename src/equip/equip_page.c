/* SPDX-License-Identifier: Apache-2.0 */
#include "equip/equip_page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "equip/equip_content.h"
#include "equip/equip_picture.h"
#include "equip/equip_shipped.h"
#include "equip/usual_material.h"
#include "page/page.h"
#include "review/profile_table.h"
#include "scene/load/material_data.h"
#include "text/json_text.h"

/* Debian's three.js, and its notice beside this file; the build embeds both. */
extern const char THREE_NOTICE[], THREE_SCRIPT[];

#define STEPS 16777215.0             /* of a coordinate over the model's size: three bytes */
#define DATA_BYTES ((size_t)1 << 32) /* address space: what is not touched costs nothing */
#define GRID 12                      /* of places where a texture is sampled for its mean */
#define GLASS_ALPHA 0.25             /* what lets light through is drawn so */

/* ---- pictures ---------------------------------------------------------------------------- */

/* The largest power of two that is no larger: what WebGL repeats. */
static int power_of_two(int size) {
    int power = 1;
    while (2 * power <= size && 2 * power <= THUMB_PIXELS) power *= 2;
    return power;
}

static bool is_worn(const Scene *scene, int texture) {
    bool found = false;
    for (int i = 0; i < scene->material_count && !found; i++)
        found = scene->materials[i].base_color_texture.texture_id == texture;
    return found;
}

/* One a texture of the scene; null for those that are no base colour. */
static json_t *textures_json(const Scene *scene, Arena scratch) {
    json_t *list = json_array();
    for (int i = 0; i < scene->texture_count; i++) {
        const Image *image = &scene->textures[i].image;
        json_t *picture =
            is_worn(scene, i)
                ? equip_picture_json(
                      image, equip_picture_box(image),
                      (PixelSize){power_of_two(image->width), power_of_two(image->height)}, scratch)
                : NULL;
        json_array_append_new(list, picture ? picture : json_null());
    }
    return list;
}

/* ---- what is known of the model ---------------------------------------------------------- */

/* Linear; alpha too. */
static void mean_colour(const Scene *scene, const Material *m, double out[4]) {
    double sum[4] = {1, 1, 1, 1};
    if (m->base_color_texture.texture_id != NO_ID) {
        const Texture *texture = &scene->textures[m->base_color_texture.texture_id];
        memset(sum, 0, sizeof sum);
        for (int i = 0; i < GRID * GRID; i++) {
            float rgba[4];
            texture_colour(texture, ((float)(i % GRID) + 0.5f) / GRID,
                           ((float)(i / GRID) + 0.5f) / GRID, rgba);
            for (int c = 0; c < 4; c++) sum[c] += (double)rgba[c] / (GRID * GRID);
        }
    }
    for (int c = 0; c < 4; c++) out[c] = sum[c] * (double)m->base_color[c];
}

/* A picture with holes is glass only when most of it is hole. */
static bool is_glass(const Material *m, double mean_alpha) {
    bool is_clear = m->alpha_mode != ALPHA_OPAQUE && (m->base_color[3] < 0.95f || mean_alpha < 0.6);
    return m->glazing || m->transmission > 0 || is_clear;
}

static json_t *material_json(const Scene *scene, const Material *m, bool is_missing) {
    double colour[4];
    mean_colour(scene, m, colour);
    return json_pack("{s:o, s:[f,f,f], s:[f,f,f], s:i, s:f, s:b, s:b}", "name", json_text(m->name),
                     "color", colour[0], colour[1], colour[2], "factor", (double)m->base_color[0],
                     (double)m->base_color[1], (double)m->base_color[2], "texture",
                     m->base_color_texture.texture_id, "alpha",
                     is_glass(m, colour[3]) ? GLASS_ALPHA : 1.0, "missing", is_missing, "display",
                     m->display_id != NO_ID);
}

static json_t *materials_json(const Scene *scene, Arena scratch) {
    int count;
    int *missing = scene_without_data(scene, &count, &scratch);
    json_t *list = json_array();
    for (int i = 0, k = 0; i < scene->material_count; i++) {
        bool is_missing = k < count && missing[k] == i;
        k += is_missing;
        json_array_append_new(list, material_json(scene, &scene->materials[i], is_missing));
    }
    return list;
}

static json_t *parts_json(const Scene *scene) {
    json_t *list = json_array();
    for (int i = 0; i < scene->part_count; i++) {
        const Part *p = &scene->parts[i];
        json_array_append_new(
            list, json_pack("{s:o, s:o, s:i, s:I, s:I}", "name", json_text(p->name), "mesh",
                            json_text(p->mesh_name), "material", p->material_id, "first",
                            (json_int_t)p->first_triangle, "count", (json_int_t)p->triangle_count));
    }
    return list;
}

static json_t *cameras_json(const Scene *scene) {
    json_t *list = json_array();
    for (int i = 0; i < scene->camera_count; i++) {
        const SceneCamera *c = &scene->cameras[i];
        const char *name = c->node_name[0] ? c->node_name : c->camera_name;
        json_array_append_new(list, json_pack("{s:o, s:b, s:o, s:o}", "name", json_text(name),
                                              "perspective", c->is_perspective, "position",
                                              json_vector(c->world_from_camera.origin), "ahead",
                                              json_vector(vec3_neg(c->world_from_camera.z))));
    }
    return list;
}

/* ---- what lies with the program ---------------------------------------------------------- */

static json_t *profiles_json(void) {
    json_t *list = json_array();
    for (int i = 0; i < profile_count; i++)
        json_array_append_new(list, json_string(profile_table[i].name));
    return list;
}

/* ---- the page ---------------------------------------------------------------------------- */

static int index_bytes(const Scene *scene) {
    return scene->vertex_count > 0xffffff ? 4 : 3;
}

static json_t *data_json(const Scene *scene, const char *model, const char *command, Arena *arena) {
    int panel_count;
    const char **panels = equip_shipped_names(&shipped_panels, &panel_count, arena);
    json_t *data =
        json_pack("{s:o, s:o, s:I, s:I, s:i, s:o, s:o}", "model", json_text(path_name(model)),
                  "command", json_text(command), "vertices", (json_int_t)scene->vertex_count,
                  "triangles", (json_int_t)scene->triangle_count, "index_bytes", index_bytes(scene),
                  "low", json_vector(scene->bounds_min), "high", json_vector(scene->bounds_max));
    json_object_set_new(data, "origin", json_world_point(scene->origin));
    json_object_set_new(data, "parts", parts_json(scene));
    json_object_set_new(data, "materials", materials_json(scene, *arena));
    json_object_set_new(data, "textures", textures_json(scene, *arena));
    json_object_set_new(data, "cameras", cameras_json(scene));
    json_object_set_new(data, "panels", json_texts(panels, panel_count));
    json_object_set_new(data, "contents", equip_contents_json(arena));
    json_object_set_new(data, "profiles", profiles_json());
    json_object_set_new(data, "usual", usual_material_json());
    return data;
}

/* Inside a script element nothing may look like its end. Takes the data. */
static json_t *script_text(json_t *data) {
    Arena own = arena_reserve(DATA_BYTES), more = arena_reserve(DATA_BYTES);
    Text text = {.arena = &own}, script = {.arena = &more};
    if (!json_dump_text(&text, data, JSON_COMPACT | JSON_REAL_PRECISION(9))) text_add(&text, "{}");
    for (const char *c = text.data; *c;) {
        size_t plain = strcspn(c, "<");
        text_add_bytes(&script, c, plain);
        c += plain;
        if (*c) text_add(&script, "\\u003c");
        c += *c != 0;
    }
    json_t *out = json_stringn(script.data, script.size);
    arena_release(&more);
    arena_release(&own);
    json_decref(data);
    return out;
}

/* False: there are none. */
static bool set_packed(json_t *to, const char *name, const char *numbers) {
    return !json_object_set_new(to, name, json_string(numbers));
}

static float coordinate(Vec3 v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static bool add_positions(json_t *list, const Scene *scene, int axis, Arena scratch, Error *err) {
    double low = (double)coordinate(scene->bounds_min, axis);
    double size = (double)coordinate(scene->bounds_max, axis) - low;
    uint32_t *steps = ARENA_NEW(&scratch, uint32_t, scene->vertex_count);
    for (uint32_t i = 0; i < scene->vertex_count; i++) {
        double at = ((double)coordinate(scene->positions[i], axis) - low) / size;
        if (at > 0 && at <= 1) steps[i] = (uint32_t)lround(at * STEPS);
    }
    json_t *to = page_add(list);
    json_object_set_new(to, "axis", json_stringn(&"xyz"[axis], 1));
    return set_packed(to, "steps", page_packed(steps, scene->vertex_count, 3, &scratch, err));
}

/* u or v of a base colour's texture, of all vertices; who has none stays 0. */
static float *coordinates(const Scene *scene, bool is_v, Arena *arena) {
    float *out = ARENA_NEW(arena, float, scene->vertex_count);
    for (int p = 0; p < scene->part_count; p++) {
        const Part *part = &scene->parts[p];
        const TextureSlot *slot = &scene->materials[part->material_id].base_color_texture;
        const float *row = slot->uv_from_uv + (is_v ? 3 : 0);
        uint32_t end = part->first_triangle + part->triangle_count;
        if (slot->texture_id == NO_ID) continue;
        for (uint32_t t = part->first_triangle; t < end; t++)
            for (int k = 0; k < 3; k++) {
                Vec2 uv = scene_corner_uv(scene, t, k, slot->uv_set);
                out[scene->triangles[t].vertex[k]] = row[0] * uv.x + row[1] * uv.y + row[2];
            }
    }
    return out;
}

/* Like a position, with its range. */
static bool add_coordinates(json_t *list, const Scene *scene, bool is_v, Arena scratch,
                            Error *err) {
    float *uv = coordinates(scene, is_v, &scratch), low = 0, high = 0;
    uint32_t *steps = ARENA_NEW(&scratch, uint32_t, scene->vertex_count);
    for (uint32_t i = 0; i < scene->vertex_count; i++)
        low = fminf(low, uv[i]), high = fmaxf(high, uv[i]);
    double size = fmax(1e-6, (double)high - (double)low);
    for (uint32_t i = 0; i < scene->vertex_count; i++)
        steps[i] = (uint32_t)lround(((double)uv[i] - (double)low) / size * STEPS);
    json_t *to = page_add(list);
    page_set(to, "axis", is_v ? "v" : "u");
    json_object_set_new(to, "low", json_real((double)low));
    json_object_set_new(to, "size", json_real(size));
    return set_packed(to, "steps", page_packed(steps, scene->vertex_count, 3, &scratch, err));
}

static bool set_triangles(json_t *to, const Scene *scene, Arena scratch, Error *err) {
    uint32_t *index = ARENA_NEW(&scratch, uint32_t, 3 * (size_t)scene->triangle_count);
    for (uint32_t t = 0; t < scene->triangle_count; t++)
        memcpy(index + 3 * (size_t)t, scene->triangles[t].vertex, 3 * sizeof *index);
    return set_packed(
        to, "triangles",
        page_packed(index, 3 * (size_t)scene->triangle_count, index_bytes(scene), &scratch, err));
}

static bool set_geometry(json_t *to, const Scene *scene, Arena scratch, Error *err) {
    json_t *axes = json_array(), *textured = json_array();
    bool ok = true;
    json_object_set_new(to, "axes", axes);
    json_object_set_new(to, "textured", textured);
    for (int axis = 0; axis < 3 && ok; axis++) ok = add_positions(axes, scene, axis, scratch, err);
    for (int axis = 0; axis < 2 && ok; axis++)
        ok = add_coordinates(textured, scene, axis == 1, scratch, err);
    return ok && set_triangles(to, scene, scratch, err);
}

static bool check_size(const Scene *scene, const char *model, Error *err) {
    if (!scene->triangle_count)
        return error_at(err, ERROR_INPUT, model, "", "has no triangles, so no face to click");
    return scene->triangle_count <= EQUIP_TRIANGLES_MAX ||
           error_at(err, ERROR_INPUT, model, "",
                    "has %u triangles, a page takes at most %d — export it without what nobody "
                    "sees from the seats",
                    scene->triangle_count, EQUIP_TRIANGLES_MAX);
}

bool equip_page_write(const Scene *scene, const char *model, const char *command, const char *path,
                      Arena *arena, Error *err) {
    if (!check_size(scene, model, err)) return false;
    json_t *values = json_object();
    Text three = {.arena = arena};
    text_add(&three, THREE_NOTICE);
    text_add(&three, THREE_SCRIPT);
    const char *title = arena_format(arena, "%s: equip", path_name(model));
    page_set(values, "three", three.data);
    json_object_set_new(values, "data", script_text(data_json(scene, model, command, arena)));
    if (page_set_head(values, title, command, err) && set_geometry(values, scene, *arena, err))
        return page_write_values("equip.html", values, NULL, path, err);
    json_decref(values);
    return false;
}
