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
#include "text/text.h"

/* The Okabe and Ito palette, and lighter and darker ones between. */
static const unsigned char COLOURS[][3] = {
    {0xe6, 0x9f, 0x00}, {0x56, 0xb4, 0xe9}, {0xd5, 0x5e, 0x00}, {0x00, 0x9e, 0x73},
    {0xcc, 0x79, 0xa7}, {0xf0, 0xe4, 0x42}, {0x00, 0x72, 0xb2}, {0xff, 0xb0, 0x90},
    {0x8c, 0xd9, 0xc0}, {0xb0, 0xb0, 0xff}};
#define COLOUR_COUNT (int)(sizeof COLOURS / sizeof *COLOURS)

/* sRGB of cause i, 0..1: distinct without colour vision, too, by their order in lightness. */
static void ray_colour(int i, float srgb[3])
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

/* ---- rays -------------------------------------------------------------------------------- */

#define NEAR_M 0.02    /* nothing nearer to the eye is drawn */
#define RIM_APART 0.01 /* share of a picture's width between a symbol and its line */

/* In a picture x is to the right and y down, pixels; before the eye right and up, metres. z is
 * metres before the eye in both. */
typedef struct SeenPoint {
    double x, y, z;
} SeenPoint;

static SeenPoint before_eye(const CaseView *view, Vec3 p)
{
    Vec3 d = vec3_sub(p, view->eye);
    return (SeenPoint){(double)vec3_dot(d, view->right), (double)vec3_dot(d, view->up),
                       (double)vec3_dot(d, view->forward)};
}

static SeenPoint in_picture(const CaseView *view, SeenPoint p)
{
    double depth = view->is_perspective ? p.z : 1;
    double x = (p.x / (depth * view->half_width) + 1) * 0.5 * view->width;
    double y = (1 - p.y / (depth * view->half_height)) * 0.5 * view->height;
    return (SeenPoint){x, y, p.z};
}

/* Narrows `kept`, shares 0..1 of the stretch, to what lies in 0..size along one axis. */
static void keep_within(double from, double to, double size, double kept[2])
{
    double step = to - from, low = -from / step, high = (size - from) / step;
    if (fabs(step) < 1e-9) {
        if (from < 0 || from > size) kept[1] = -1;
        return;
    }
    kept[0] = fmax(kept[0], fmin(low, high));
    kept[1] = fmin(kept[1], fmax(low, high));
}

/* The point of the stretch where it comes before the eye. */
static SeenPoint cut(SeenPoint hidden, SeenPoint shown)
{
    double t = (NEAR_M - shown.z) / (hidden.z - shown.z);
    return (SeenPoint){shown.x + t * (hidden.x - shown.x), shown.y + t * (hidden.y - shown.y),
                       NEAR_M};
}

static void add_stretch(Text *html, const CaseView *view, SeenPoint a, SeenPoint b)
{
    if (a.z < NEAR_M && b.z < NEAR_M) return;
    if (a.z < NEAR_M) a = cut(a, b);
    if (b.z < NEAR_M) b = cut(b, a);
    SeenPoint p = in_picture(view, a), q = in_picture(view, b);
    double    kept[2] = {0, 1};
    keep_within(p.x, q.x, view->width, kept);
    keep_within(p.y, q.y, view->height, kept);
    if (!(kept[0] < kept[1])) return;
    text_format(html, "M%.0f %.0fL%.0f %.0f", p.x + kept[0] * (q.x - p.x),
                p.y + kept[0] * (q.y - p.y), p.x + kept[1] * (q.x - p.x),
                p.y + kept[1] * (q.y - p.y));
}

/* A cause's, all but the first stretch of each, which runs along the look. */
static void add_rays(Text *html, const CaseView *view, const CaseCause *cause)
{
    for (int k = 0; k < cause->ray_count; k++) {
        const CaseRay *ray = &cause->rays[k];
        for (int i = 1; i + 1 < ray->count; i++)
            add_stretch(html, view, before_eye(view, ray->points[i]),
                        before_eye(view, ray->points[i + 1]));
    }
}

static void add_place(Text *html, const CaseView *view, const CaseRay *ray)
{
    SeenPoint p = before_eye(view, ray->points[1]);
    if (p.z < NEAR_M) return;
    p = in_picture(view, p);
    if (p.x < 0 || p.x > view->width || p.y < 0 || p.y > view->height) return;
    text_format(html, "<circle cx=\"%.0f\" cy=\"%.0f\" r=\"%d\"/>", p.x, p.y,
                view->width / 320 + 2);
}

/* x, y in pixels: about a middle, half as wide and high. */
typedef struct PictureBox {
    double x, y, half_width, half_height;
} PictureBox;

static PictureBox rim_box(const ReviewCase *c)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < c->rim_count; i++) {
        SeenPoint p = in_picture(c->view, before_eye(c->view, c->rim[i]));
        double    at[2] = {p.x, p.y};
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    return (PictureBox){(low[0] + high[0]) / 2, (low[1] + high[1]) / 2,
                        (high[0] - low[0]) / 2, (high[1] - low[1]) / 2};
}

/* Made wider by so many pixels on either side. */
static double widened(double x, double middle, double half, double by)
{
    return middle + (x - middle) * (1 + by / fmax(half, 1));
}

static bool is_before_eye(const ReviewCase *c)
{
    for (int i = 0; i < c->rim_count; i++)
        if (before_eye(c->view, c->rim[i]).z < NEAR_M) return false;
    return c->rim_count > 0;
}

static void add_rim_path(Text *html, const ReviewCase *c)
{
    PictureBox box = rim_box(c);
    double     by = RIM_APART * c->view->width;
    for (int i = 0; i < c->rim_count; i++) {
        SeenPoint p = in_picture(c->view, before_eye(c->view, c->rim[i]));
        text_format(html, "%c%.1f %.1f", i ? 'L' : 'M',
                    widened(p.x, box.x, box.half_width, by),
                    widened(p.y, box.y, box.half_height, by));
    }
    text_add(html, "Z\"/>");
}

static void add_line(Text *html, const ReviewCase *c)
{
    text_add(html, "<g class=\"rim\"><path class=\"under\" d=\"");
    add_rim_path(html, c);
    text_add(html, "<path d=\"");
    add_rim_path(html, c);
    text_add(html, "</g>");
}

const char *review_rays_line(const ReviewCase *c, Arena *arena)
{
    Text svg = {.arena = arena};
    add_line(&svg, c);
    return svg.data;
}

const char *review_rays_rim(const ReviewCase *c, Arena *arena)
{
    Text svg = {.arena = arena};
    if (!c->view || !is_before_eye(c)) return "";
    text_format(&svg, "<svg class=\"rim\" viewBox=\"0 0 %d %d\" aria-hidden=\"true\" "
                "preserveAspectRatio=\"xMidYMid slice\">", c->view->width, c->view->height);
    add_line(&svg, c);
    text_add(&svg, "</svg>");
    return svg.data;
}

#define CLOSE_SIZE 6     /* of what is shown close up, over the symbol's */
#define CLOSE_LEAST 0.12 /* share of the picture's width and height */
#define CLOSE_MOST 0.4

/* Where a stretch of `size` about `middle` begins, so that it lies within 0..all. */
static double begin_within(double middle, double size, double all)
{
    return fmin(fmax(middle - size / 2, 0), all - size);
}

bool review_rays_close_up(const ReviewCase *c, double box[4])
{
    const CaseView *view = c->view;
    if (!view || !is_before_eye(c)) return false;
    PictureBox at = rim_box(c);
    if (at.x < 0 || at.x > view->width || at.y < 0 || at.y > view->height) return false;
    double share = CLOSE_SIZE * 2 * fmax(at.half_width / view->width,
                                         at.half_height / view->height);
    share = fmin(fmax(share, CLOSE_LEAST), CLOSE_MOST);
    box[2] = share * view->width;
    box[3] = share * view->height;
    box[0] = begin_within(at.x, box[2], view->width);
    box[1] = begin_within(at.y, box[3], view->height);
    return true;
}

bool review_rays_has(const ReviewCase *c, int i)
{
    return c->frame && c->view && c->causes[i].ray_count > 0;
}

const char *review_rays_id(const char *card_id, int i, Arena *arena)
{
    return arena_format(arena, "%s-way%d", card_id, i + 1);
}

const char *review_rays_drawn(const ReviewCase *c, const char *card_id, Arena *arena)
{
    const CaseView *view = c->view;
    Text            svg = {.arena = arena}, *html = &svg;
    text_format(html, "<svg class=\"rays\" viewBox=\"0 0 %d %d\">", view->width, view->height);
    for (int i = 0; i < c->cause_count; i++) {
        const CaseCause *cause = &c->causes[i];
        float rgb[3];
        if (!review_rays_has(c, i)) continue;
        ray_colour(i, rgb);
        text_format(html, "<g id=\"%s\" style=\"--ray:#%02x%02x%02x\"><title>",
                    review_rays_id(card_id, i, arena), (int)(255 * rgb[0] + 0.5f),
                    (int)(255 * rgb[1] + 0.5f), (int)(255 * rgb[2] + 0.5f));
        escape_markup(html, words_chain(cause, arena));
        text_add(html, "</title><path class=\"under\" d=\"");
        add_rays(html, view, cause);
        text_add(html, "\"/><path d=\"");
        add_rays(html, view, cause);
        text_add(html, "\"/>");
        for (int k = 0; k < cause->ray_count; k++) add_place(html, view, &cause->rays[k]);
        text_add(html, "</g>");
    }
    text_add(html, "</svg>");
    return svg.data;
}
