/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/ray_file.h"

#include <jansson.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <strings.h>

#include "base/file.h"
#include "review/output/review_words.h"
#include "text/base64.h"
#include "text/json_text.h"

/* The Okabe and Ito palette, and lighter and darker ones between. */
static const unsigned char COLOURS[][3] = {
    {0xe6, 0x9f, 0x00}, {0x56, 0xb4, 0xe9}, {0xd5, 0x5e, 0x00}, {0x00, 0x9e, 0x73},
    {0xcc, 0x79, 0xa7}, {0xf0, 0xe4, 0x42}, {0x00, 0x72, 0xb2}, {0xff, 0xb0, 0x90},
    {0x8c, 0xd9, 0xc0}, {0xb0, 0xb0, 0xff}};
#define COLOUR_COUNT (int)(sizeof COLOURS / sizeof *COLOURS)

void ray_colour(int i, float srgb[3])
{
    for (int k = 0; k < 3; k++) srgb[k] = (float)COLOURS[i % COLOUR_COUNT][k] / 255;
}

/* ---- the numbers ------------------------------------------------------------------------- */

/* Positions of all causes, then the ends of their lines. */
typedef struct RayNumbers {
    float    *positions;
    uint32_t *ends;
    size_t    point_count, end_count;
} RayNumbers;

/* Where a cause's numbers lie. */
typedef struct RaySpan {
    size_t first_point, points, first_end, ends;
} RaySpan;

static RayNumbers room_for(const ReviewCase *c, Arena *arena)
{
    size_t points = 0;
    for (int i = 0; i < c->cause_count; i++)
        for (int k = 0; k < c->causes[i].ray_count; k++)
            points += (size_t)c->causes[i].rays[k].count;
    return (RayNumbers){ARENA_NEW(arena, float, 3 * points),
                        ARENA_NEW(arena, uint32_t, 2 * points), 0, 0};
}

static void add_ray(const CaseRay *ray, size_t first_point, RayNumbers *to)
{
    for (int i = 0; i < ray->count; i++) {
        uint32_t at = (uint32_t)(to->point_count - first_point);
        const Vec3 p = ray->points[i];
        float     *out = to->positions + 3 * to->point_count++;
        out[0] = p.x;
        out[1] = p.y;
        out[2] = p.z;
        if (i + 1 == ray->count) break;
        to->ends[to->end_count++] = at;
        to->ends[to->end_count++] = at + 1;
    }
}

static RaySpan add_cause(const CaseCause *cause, RayNumbers *to)
{
    RaySpan span = {to->point_count, 0, to->end_count, 0};
    for (int k = 0; k < cause->ray_count; k++)
        add_ray(&cause->rays[k], span.first_point, to);
    span.points = to->point_count - span.first_point;
    span.ends = to->end_count - span.first_end;
    return span;
}

/* ---- the document ------------------------------------------------------------------------ */

static json_t *bounds(const float *positions, size_t count, bool is_upper)
{
    json_t *out = json_array();
    for (int k = 0; k < 3; k++) {
        float bound = positions[k];
        for (size_t i = 1; i < count; i++) {
            float v = positions[3 * i + (size_t)k];
            if (is_upper ? v > bound : v < bound) bound = v;
        }
        json_array_append_new(out, json_real((double)bound));
    }
    return out;
}

static double linear(float srgb)
{
    double c = (double)srgb;
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

static json_t *material(int i)
{
    float srgb[3];
    ray_colour(i, srgb);
    double r = linear(srgb[0]), g = linear(srgb[1]), b = linear(srgb[2]);
    return json_pack("{s:s, s:{s:[f,f,f,i], s:i, s:i}, s:[f,f,f], s:{s:{}}}", "name", "light",
                     "pbrMetallicRoughness", "baseColorFactor", r, g, b, 1, "metallicFactor", 0,
                     "roughnessFactor", 1, "emissiveFactor", r, g, b, "extensions",
                     "KHR_materials_unlit");
}

typedef struct RayDocument {
    json_t *nodes, *meshes, *materials, *accessors;
} RayDocument;

static void add_mesh(const RayDocument *to, const CaseCause *cause, const RayNumbers *numbers,
                     RaySpan span, Arena *arena)
{
    int    id = (int)json_array_size(to->meshes);
    const float *positions = numbers->positions + 3 * span.first_point;
    const char  *name = arena_format(arena, "%d: %s %s", id + 1,
                                     words_share(cause->share, arena),
                                     words_chain(cause, arena));
    json_array_append_new(to->accessors, json_pack(
        "{s:i, s:I, s:i, s:I, s:s, s:o, s:o}", "bufferView", 0, "byteOffset",
        (json_int_t)(12 * span.first_point), "componentType", 5126, "count",
        (json_int_t)span.points, "type", "VEC3", "min", bounds(positions, span.points, false),
        "max", bounds(positions, span.points, true)));
    json_array_append_new(to->accessors, json_pack(
        "{s:i, s:I, s:i, s:I, s:s}", "bufferView", 1, "byteOffset",
        (json_int_t)(4 * span.first_end), "componentType", 5125, "count",
        (json_int_t)span.ends, "type", "SCALAR"));
    json_array_append_new(to->meshes, json_pack(
        "{s:o, s:[{s:{s:i}, s:i, s:i, s:i}]}", "name", json_text(name), "primitives",
        "attributes", "POSITION", 2 * id, "indices", 2 * id + 1, "material", id, "mode", 1));
    json_array_append_new(to->materials, material(cause->light ? cause->light - 1 : id));
    json_array_append_new(to->nodes, json_pack(
        "{s:o, s:i, s:{s:o, s:o, s:o}}", "name", json_text(name), "mesh", id, "extras", "share",
        json_figure(cause->share), "cd_m2", json_figure(cause->cd_m2), "contrast_without",
        json_figure(cause->contrast_without)));
}

/* A scene far off has its origin there (scene/scene.h). */
static void move_nodes(json_t *nodes, const double origin_m[3])
{
    if (origin_m[0] == 0 && origin_m[1] == 0 && origin_m[2] == 0) return;
    for (size_t i = 0; i < json_array_size(nodes); i++)
        json_object_set_new(json_array_get(nodes, i), "translation",
                            json_pack("[f,f,f]", origin_m[0], origin_m[1], origin_m[2]));
}

/* uri NULL: the binary form's own chunk. */
static json_t *document_of(const ReviewCase *c, RayNumbers *numbers, Arena *arena)
{
    RayDocument to = {json_array(), json_array(), json_array(), json_array()};
    json_t     *scene_nodes = json_array();
    for (int i = 0; i < c->cause_count; i++) {
        if (!c->causes[i].ray_count) continue;
        RaySpan span = add_cause(&c->causes[i], numbers);
        add_mesh(&to, &c->causes[i], numbers, span, arena);
        json_array_append_new(scene_nodes,
                              json_integer((json_int_t)json_array_size(to.nodes) - 1));
    }
    move_nodes(to.nodes, c->origin_m);
    json_int_t points = (json_int_t)(12 * numbers->point_count);
    json_int_t ends = (json_int_t)(4 * numbers->end_count);
    return json_pack(
        "{s:{s:s, s:s}, s:[s], s:i, s:[{s:s, s:o}], s:o, s:o, s:o, s:o, "
        "s:[{s:i, s:i, s:I, s:i, s:i}, {s:i, s:I, s:I, s:i}]}",
        "asset", "version", "2.0", "generator", "parhelion explain", "extensionsUsed",
        "KHR_materials_unlit", "scene", 0, "scenes", "name", "ways of light", "nodes",
        scene_nodes, "nodes", to.nodes, "meshes", to.meshes, "materials", to.materials,
        "accessors", to.accessors, "bufferViews", "buffer", 0, "byteOffset", 0, "byteLength",
        points, "byteStride", 12, "target", 34962, "buffer", 0, "byteOffset", points,
        "byteLength", ends, "target", 34963);
}

/* ---- files ------------------------------------------------------------------------------- */

static bool is_binary(const char *path)
{
    return !strcasecmp(path_ending(path), ".glb");
}

bool ray_file_check(const char *path, Error *err)
{
    return is_binary(path) || !strcasecmp(path_ending(path), ".gltf") ||
           error_at(err, ERROR_USAGE, path, "", "required: a name that ends in .gltf or .glb");
}

static void add_word(Text *out, uint32_t word)
{
    const unsigned char bytes[4] = {(unsigned char)word, (unsigned char)(word >> 8),
                                    (unsigned char)(word >> 16), (unsigned char)(word >> 24)};
    text_add_bytes(out, bytes, 4);
}

static void add_padded(Text *out, const Text *chunk, char filler)
{
    text_add_bytes(out, chunk->data, chunk->size);
    for (size_t i = chunk->size; i % 4; i++) text_add_bytes(out, &filler, 1);
}

/* The container of glTF 2.0: a head, the document, the numbers. */
static void add_container(Text *out, const Text *json, const Text *bin)
{
    uint32_t json_size = (uint32_t)(json->size + 3) / 4 * 4;
    uint32_t bin_size = (uint32_t)(bin->size + 3) / 4 * 4;
    add_word(out, 0x46546c67);
    add_word(out, 2);
    add_word(out, 12 + 8 + json_size + 8 + bin_size);
    add_word(out, json_size);
    add_word(out, 0x4e4f534a);
    add_padded(out, json, ' ');
    add_word(out, bin_size);
    add_word(out, 0x004e4942);
    add_padded(out, bin, 0);
}

static void set_buffer(json_t *document, const Text *bin, bool has_uri, Arena *arena)
{
    json_t *buffer = json_pack("{s:I}", "byteLength", (json_int_t)bin->size);
    if (has_uri) {
        Text uri = {.arena = arena};
        text_add(&uri, "data:application/octet-stream;base64,");
        base64_encode(&uri, bin->data, bin->size);
        json_object_set_new(buffer, "uri", json_string(uri.data));
    }
    json_object_set_new(document, "buffers", json_pack("[o]", buffer));
}

/* glTF forbids empty lists: without rays there is a scene of nothing. */
static json_t *empty_document(void)
{
    return json_pack("{s:{s:s, s:s}, s:i, s:[{s:s}]}", "asset", "version", "2.0", "generator",
                     "parhelion explain", "scene", 0, "scenes", "name", "ways of light");
}

bool ray_file_write(const ReviewCase *c, const char *path, Error *err)
{
    Arena      arena = arena_reserve((size_t)1 << 28);
    RayNumbers numbers = room_for(c, &arena);
    json_t    *document = document_of(c, &numbers, &arena);
    Text       bin = {.arena = &arena}, json = {.arena = &arena}, file = {.arena = &arena};
    text_add_bytes(&bin, numbers.positions, 12 * numbers.point_count);
    text_add_bytes(&bin, numbers.ends, 4 * numbers.end_count);
    if (!bin.size) {
        json_decref(document);
        document = empty_document();
    } else {
        set_buffer(document, &bin, !is_binary(path), &arena);
    }
    json_dump_text(&json, document, JSON_INDENT(1) | JSON_REAL_PRECISION(9));
    json_decref(document);
    if (is_binary(path)) add_container(&file, &json, &bin);
    else file = json;
    bool ok = ray_file_check(path, err) && text_write(&file, path, err);
    arena_release(&arena);
    return ok;
}
