/* SPDX-License-Identifier: Apache-2.0 */
#include "equip/equip_patch.h"

#include <math.h>
#include <string.h>

#include "text/base64.h"
#include "text/json_text.h"

#define EYE_FOV 0.7 /* radians, a picture's height: 40 degrees */
#define EYE_ASPECT 1.7778
#define STEEP 0.999 /* a direction that is hardly level: up is another axis */

enum { FLOAT_KIND = 5126, SHORT_KIND = 5123, INT_KIND = 5125, CORNERS = 4, INDICES = 6 };

/* ---- small things ------------------------------------------------------------------------ */

/* Appends to a list of the document, which need not be there; returns the place. */
static int add_to(json_t *document, const char *list, json_t *item) {
    if (!json_object_get(document, list)) json_object_set_new(document, list, json_array());
    json_t *items = json_object_get(document, list);
    json_array_append_new(items, item);
    return (int)json_array_size(items) - 1;
}

static void use_extension(json_t *document, const char *name) {
    json_t *item;
    size_t i;
    json_array_foreach(json_object_get(document, "extensionsUsed"), i,
                       item) if (!strcmp(json_string_value(item), name)) return;
    add_to(document, "extensionsUsed", json_string(name));
}

static json_t *numbers(const double *values, int count) {
    json_t *list = json_array();
    for (int i = 0; i < count; i++) json_array_append_new(list, json_real(values[i] + 0.0));
    return list;
}

static void cross(const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double unit(double a[3]) {
    double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int i = 0; i < 3; i++) a[i] /= length;
    return length;
}

/* The unit quaternion (x, y, z, w) of the rotation whose columns are three axes, by its largest
 * member: of q q^T = f(axes) each row is q times one of its members. */
static json_t *rotation(const double x[3], const double y[3], const double z[3]) {
    const double square[4] = {1 + x[0] - y[1] - z[2], 1 - x[0] + y[1] - z[2],
                              1 - x[0] - y[1] + z[2], 1 + x[0] + y[1] + z[2]};
    const double xy = x[1] + y[0], xz = x[2] + z[0], yz = y[2] + z[1];
    const double xw = y[2] - z[1], yw = z[0] - x[2], zw = x[1] - y[0];
    const double row[4][4] = {{square[0], xy, xz, xw},
                              {xy, square[1], yz, yw},
                              {xz, yz, square[2], zw},
                              {xw, yw, zw, square[3]}};
    int most = 0;
    double q[4], length = 0;
    for (int i = 1; i < 4; i++)
        if (square[i] > square[most]) most = i;
    for (int i = 0; i < 4; i++) length += row[most][i] * row[most][i];
    for (int i = 0; i < 4; i++) q[i] = row[most][i] / sqrt(length);
    return numbers(q, 4);
}

/* ---- the scene --------------------------------------------------------------------------- */

static bool is_child(const json_t *nodes, int index) {
    json_t *node, *child;
    size_t i, k;
    json_array_foreach(nodes, i, node)
        json_array_foreach(json_object_get(node, "children"), k,
                           child) if (json_number_value(child) == index) return true;
    return false;
}

/* Without a scene all nodes are shown: so that they still are, their roots become one. */
static json_t *make_scene(json_t *document) {
    const json_t *nodes = json_object_get(document, "nodes");
    json_t *roots = json_array();
    for (int i = 0; i < (int)json_array_size(nodes); i++)
        if (!is_child(nodes, i)) json_array_append_new(roots, json_integer(i));
    json_t *scene = json_pack("{s:o}", "nodes", roots);
    add_to(document, "scenes", scene);
    return scene;
}

static void add_node(json_t *document, json_t *node) {
    int shown = (int)json_number_value(json_object_get(document, "scene"));
    json_t *scene = json_array_get(json_object_get(document, "scenes"), (size_t)shown);
    if (!scene) scene = make_scene(document);
    add_to(scene, "nodes", json_integer(add_to(document, "nodes", node)));
}

/* ---- displays ---------------------------------------------------------------------------- */

typedef struct Rectangle {
    float position[CORNERS][3], uv[CORNERS][2];
    uint16_t index[INDICES];
} Rectangle;

static int add_view(json_t *document, int buffer, size_t offset, size_t size) {
    return add_to(document, "bufferViews",
                  json_pack("{s:i, s:I, s:I}", "buffer", buffer, "byteOffset", (json_int_t)offset,
                            "byteLength", (json_int_t)size));
}

static int add_accessor(json_t *document, int view, int kind, int count, const char *type) {
    return add_to(document, "accessors",
                  json_pack("{s:i, s:i, s:i, s:s}", "bufferView", view, "componentType", kind,
                            "count", count, "type", type));
}

/* Its primitive without a material: all displays share it. */
static json_t *add_rectangle(json_t *document, Arena scratch) {
    const Rectangle r = {{{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}},
                         {{0, 1}, {1, 1}, {1, 0}, {0, 0}},
                         {0, 1, 2, 0, 2, 3}};
    Text text = {.arena = &scratch};
    text_add(&text, "data:application/octet-stream;base64,");
    base64_encode(&text, &r, sizeof r);
    int buffer = add_to(document, "buffers",
                        json_pack("{s:i, s:s}", "byteLength", (int)sizeof r, "uri", text.data));
    int position = add_view(document, buffer, offsetof(Rectangle, position), sizeof r.position);
    int uv = add_view(document, buffer, offsetof(Rectangle, uv), sizeof r.uv);
    int index = add_view(document, buffer, offsetof(Rectangle, index), sizeof r.index);
    position = add_accessor(document, position, FLOAT_KIND, CORNERS, "VEC3");
    json_t *accessor = json_array_get(json_object_get(document, "accessors"), (size_t)position);
    json_object_set_new(accessor, "min", json_pack("[f,f,i]", -0.5, -0.5, 0));
    json_object_set_new(accessor, "max", json_pack("[f,f,i]", 0.5, 0.5, 0));
    uv = add_accessor(document, uv, FLOAT_KIND, CORNERS, "VEC2");
    index = add_accessor(document, index, SHORT_KIND, INDICES, "SCALAR");
    return json_pack("{s:{s:i, s:i}, s:i}", "attributes", "POSITION", position, "TEXCOORD_0", uv,
                     "indices", index);
}

/* Other viewers see its content glow on black. */
static int add_screen(json_t *document, const EquipDisplay *display, const EquipNames *names) {
    json_t *own =
        json_pack("{s:o, s:f}", "panel", json_text(names->panel), "level", display->level);
    if (display->max_level > 1)
        json_object_set_new(own, "max_level", json_real(display->max_level));
    if (display->any_size) json_object_set_new(own, "any_size", json_true());
    json_t *material =
        json_pack("{s:o, s:{s:[i,i,i,i], s:i, s:f}}", "name", json_text(display->name),
                  "pbrMetallicRoughness", "baseColorFactor", 0, 0, 0, 1, "metallicFactor", 0,
                  "roughnessFactor", 0.2);
    if (names->content) {
        int image =
            add_to(document, "images", json_pack("{s:o}", "uri", json_text(names->content)));
        int texture = add_to(document, "textures", json_pack("{s:i}", "source", image));
        json_object_set_new(own, "content", json_pack("{s:i}", "index", texture));
        json_object_set_new(material, "emissiveTexture", json_pack("{s:i}", "index", texture));
        json_object_set_new(material, "emissiveFactor", json_pack("[i,i,i]", 1, 1, 1));
    }
    json_object_set_new(material, "extensions", json_pack("{s:o}", "PARHELION_display", own));
    use_extension(document, "PARHELION_display");
    return add_to(document, "materials", material);
}

/* What a triangle adds to the normal of its corner k: its own by the angle there (Thuermer and
 * Wuethrich 1998), so that it does not matter how a surface is cut into triangles. */
static void add_normal(const double *const p[3], int k, float normal[3]) {
    double e[3], f[3], n[3], along = 0, length;
    for (int i = 0; i < 3; i++) {
        e[i] = p[(k + 1) % 3][i] - p[k][i];
        f[i] = p[(k + 2) % 3][i] - p[k][i];
        along += e[i] * f[i];
    }
    cross(e, f, n);
    length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3 && length > 0; i++)
        normal[i] += (float)(n[i] / length * atan2(length, along));
}

static void add_normals(const EquipMesh *mesh, float *normals) {
    for (int t = 0; t < mesh->triangle_count; t++) {
        const double *p[3];
        for (int k = 0; k < 3; k++) p[k] = mesh->positions_m + 3 * (int)mesh->triangles[3 * t + k];
        for (int k = 0; k < 3; k++) add_normal(p, k, normals + 3 * (int)mesh->triangles[3 * t + k]);
    }
    for (int v = 0; v < mesh->vertex_count; v++) {
        float *n = normals + 3 * v, length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int i = 0; i < 3; i++) n[i] = length > 0 ? n[i] / length : i == 2;
    }
}

/* Bytes of a list of a mesh, in a buffer of its own; returns its accessor. */
static int add_list(json_t *document, const void *bytes, int count, int items, Arena scratch) {
    static const char *const types[] = {"", "SCALAR", "VEC2", "VEC3"};
    Text text = {.arena = &scratch};
    size_t size = 4 * (size_t)count * (size_t)items;
    text_add(&text, "data:application/octet-stream;base64,");
    base64_encode(&text, bytes, size);
    int buffer = add_to(document, "buffers",
                        json_pack("{s:I, s:s}", "byteLength", (json_int_t)size, "uri", text.data));
    return add_accessor(document, add_view(document, buffer, 0, size),
                        items == 1 ? INT_KIND : FLOAT_KIND, count, types[items]);
}

/* glTF requires the bounds of positions. */
static void add_bounds(json_t *document, int accessor, const float *positions, int count) {
    double low[3], high[3];
    for (int i = 0; i < 3; i++) {
        low[i] = high[i] = (double)positions[i];
        for (int v = 1; v < count; v++) {
            low[i] = fmin(low[i], (double)positions[3 * v + i]);
            high[i] = fmax(high[i], (double)positions[3 * v + i]);
        }
    }
    json_t *object = json_array_get(json_object_get(document, "accessors"), (size_t)accessor);
    json_object_set_new(object, "min", numbers(low, 3));
    json_object_set_new(object, "max", numbers(high, 3));
}

/* Its primitive without a material: the face as the file has it, from the display's centre on,
 * where floats are fine however far off the model stands. */
static json_t *add_face(json_t *document, const EquipDisplay *display, Arena scratch) {
    const EquipMesh *mesh = &display->mesh;
    int count = mesh->vertex_count, corners = 3 * mesh->triangle_count;
    float *positions = ARENA_NEW(&scratch, float, 3 * (size_t)count);
    float *normals = ARENA_NEW(&scratch, float, 3 * (size_t)count);
    float *uv = ARENA_NEW(&scratch, float, 2 * (size_t)count);
    uint32_t *index = ARENA_NEW(&scratch, uint32_t, corners);
    for (int i = 0; i < 3 * count; i++)
        positions[i] = (float)(mesh->positions_m[i] - display->centre_m[i % 3]);
    for (int i = 0; i < 2 * count; i++) uv[i] = (float)mesh->uv[i];
    for (int i = 0; i < corners; i++) index[i] = (uint32_t)mesh->triangles[i];
    add_normals(mesh, normals);
    int position = add_list(document, positions, count, 3, scratch);
    add_bounds(document, position, positions, count);
    int normal = add_list(document, normals, count, 3, scratch);
    int picture = add_list(document, uv, count, 2, scratch);
    int triangles = add_list(document, index, corners, 1, scratch);
    return json_pack("{s:{s:i, s:i, s:i}, s:i}", "attributes", "POSITION", position, "NORMAL",
                     normal, "TEXCOORD_0", picture, "indices", triangles);
}

static void add_face_display(json_t *document, const EquipDisplay *display, const EquipNames *names,
                             Arena scratch) {
    json_t *primitive = add_face(document, display, scratch);
    json_object_set_new(primitive, "material", json_integer(add_screen(document, display, names)));
    int mesh = add_to(
        document, "meshes",
        json_pack("{s:o, s:[o]}", "name", json_text(display->name), "primitives", primitive));
    add_node(document, json_pack("{s:o, s:i, s:o}", "name", json_text(display->name), "mesh", mesh,
                                 "translation", numbers(display->centre_m, 3)));
}

static void add_display(json_t *document, const EquipDisplay *display, const EquipNames *names,
                        const json_t *rectangle) {
    double normal[3], centre[3], scale[3] = {display->width_m, display->height_m, 1};
    json_t *primitive = json_deep_copy(rectangle);
    cross(display->right, display->up, normal);
    for (int i = 0; i < 3; i++) centre[i] = display->centre_m[i] + display->before_m * normal[i];
    json_object_set_new(primitive, "material", json_integer(add_screen(document, display, names)));
    int mesh = add_to(
        document, "meshes",
        json_pack("{s:o, s:[o]}", "name", json_text(display->name), "primitives", primitive));
    add_node(document,
             json_pack("{s:o, s:i, s:o, s:o, s:o}", "name", json_text(display->name), "mesh", mesh,
                       "translation", numbers(centre, 3), "rotation",
                       rotation(display->right, display->up, normal), "scale", numbers(scale, 3)));
}

/* ---- eyes -------------------------------------------------------------------------------- */

/* Looks along -Z with +Y up: the world's up, or ahead where one looks straight down. */
static void add_eye(json_t *document, const EquipEye *eye, const double forward[3]) {
    const double world_up[3] = {0, 1, 0};
    double x[3], y[3], z[3];
    for (int i = 0; i < 3; i++) z[i] = eye->position_m[i] - eye->target_m[i];
    unit(z);
    cross(fabs(z[1]) > STEEP ? forward : world_up, z, x);
    unit(x);
    cross(z, x, y);
    int camera = add_to(document, "cameras",
                        json_pack("{s:o, s:s, s:{s:f, s:f, s:f}}", "name", json_text(eye->name),
                                  "type", "perspective", "perspective", "yfov", EYE_FOV,
                                  "aspectRatio", EYE_ASPECT, "znear", 0.01));
    add_node(document,
             json_pack("{s:o, s:i, s:o, s:o}", "name", json_text(eye->name), "camera", camera,
                       "translation", numbers(eye->position_m, 3), "rotation", rotation(x, y, z)));
}

/* ---- materials --------------------------------------------------------------------------- */

/* Keeps what describes its shape: a normal map, whether the back is a front. */
static json_t *material_of(json_t *document, const EquipMaterial *m, const json_t *old) {
    const char *const kept[] = {"name", "doubleSided", "normalTexture"};
    json_t *material = json_object(), *extensions = json_object();
    for (int i = 0; i < 3; i++) json_object_set(material, kept[i], json_object_get(old, kept[i]));
    json_object_set_new(material, "pbrMetallicRoughness",
                        json_pack("{s:[f,f,f,i], s:f, s:f}", "baseColorFactor", m->base_color[0],
                                  m->base_color[1], m->base_color[2], 1, "metallicFactor",
                                  m->metallic, "roughnessFactor", m->roughness));
    if (m->transmission > 0) {
        json_object_set_new(extensions, "KHR_materials_transmission",
                            json_pack("{s:f}", "transmissionFactor", m->transmission));
        use_extension(document, "KHR_materials_transmission");
    }
    if (m->ior != 1.5) { /* glTF's own */
        json_object_set_new(extensions, "KHR_materials_ior", json_pack("{s:f}", "ior", m->ior));
        use_extension(document, "KHR_materials_ior");
    }
    if (json_object_size(extensions)) json_object_set(material, "extensions", extensions);
    json_decref(extensions);
    if (m->as) json_object_set_new(material, "extras", json_pack("{s:s}", "equipped as", m->as));
    return material;
}

/* glTF's default material gets a place in the list, and who wears none wears it. */
static void dress_bare(json_t *document, int material) {
    json_t *mesh, *primitive;
    size_t i, k;
    json_array_foreach(json_object_get(document, "meshes"), i, mesh)
        json_array_foreach(json_object_get(mesh, "primitives"), k,
                           primitive) if (!json_object_get(primitive, "material"))
            json_object_set_new(primitive, "material", json_integer(material));
}

static bool check_material(const EquipMaterial *m, const Equip *equip, const json_t *old, int count,
                           Error *err) {
    const char *name = json_string_value(json_object_get(old, "name"));
    if (m->index > count)
        return error_at(err, ERROR_INPUT, equip->file, m->place,
                        "is for material %d, the model has %d — was it made for another model?",
                        m->index, count);
    return !m->name[0] || !strcmp(m->name, name ? name : "") || !old ||
           error_at(err, ERROR_INPUT, equip->file, m->place,
                    "is for material %d with the name '%.60s', the model's is '%.60s' — was it "
                    "made for another model?",
                    m->index, m->name, name ? name : "");
}

static bool patch_materials(json_t *document, const Equip *equip, Error *err) {
    int count = (int)json_array_size(json_object_get(document, "materials"));
    for (int i = 0; i < equip->material_count; i++) {
        const EquipMaterial *m = &equip->materials[i];
        json_t *list = json_object_get(document, "materials");
        json_t *old = m->index < count ? json_array_get(list, (size_t)m->index) : NULL;
        if (!check_material(m, equip, old, count, err)) return false;
        json_t *material = material_of(document, m, old);
        if (old) json_array_set_new(list, (size_t)m->index, material);
        else dress_bare(document, add_to(document, "materials", material));
    }
    return true;
}

bool equip_patch(json_t *document, const Equip *equip, const EquipNames *names, Arena scratch,
                 Error *err) {
    if (!patch_materials(document, equip, err)) return false;
    json_t *rectangle = equip->display_count ? add_rectangle(document, scratch) : NULL;
    for (int i = 0; i < equip->display_count; i++)
        if (equip->displays[i].mesh.vertex_count)
            add_face_display(document, &equip->displays[i], &names[i], scratch);
        else add_display(document, &equip->displays[i], &names[i], rectangle);
    for (int i = 0; i < equip->eye_count; i++) add_eye(document, &equip->eyes[i], equip->forward);
    json_decref(rectangle);
    return true;
}
