/* SPDX-License-Identifier: Apache-2.0 */
/* Before the first path: cells of emitters, their light, and the tree they are gathered in. */
#include "light/emitters_build.h"

#include <math.h>

#include "base/parallel.h"
#include "light/emitter_tree.h"
#include "panel/query/panel_emission.h"
#include "spectrum/photometry.h"

#define CELLS_OF_PICTURE 32768 /* about, of a part with content or an emissive texture */
#define CELLS_OF_DISPLAY 256   /* without content: its directions change across it */
#define CELLS_OF_PLAIN 8
#define POINTS_LEAST 16 /* a cell, at which the light of a picture is read */
#define POINTS_MAX TEXTURE_AT_ONCE
#define POINTS_STEP 16   /* that are placed together: a fixed number is fast */
#define FLOOR_SHARE 0.02 /* of the part's mean, so that no lit texel is impossible */
#define SIDE_MAX 512

/* Luminance of a display by its codes: what red, green and blue add, the rest at code 0. */
typedef struct CodeTable {
    float dark, added[3][256];
} CodeTable;

static void fill_codes(const Display *display, CodeTable *table) {
    float rgb[3] = {0, 0, 0};
    table->dark = panel_mean_luminance(display->panel, rgb) * display->level;
    for (int p = 0; p < 3; p++)
        for (int code = 0; code < 256; code++) {
            for (int i = 0; i < 3; i++) rgb[i] = i == p ? (float)code : 0;
            table->added[p][code] =
                panel_mean_luminance(display->panel, rgb) * display->level - table->dark;
        }
}

/* Points of a cell, or of a texture. */
typedef struct PointList {
    float u[POINTS_MAX], v[POINTS_MAX];
} PointList;

/* How the light of one part is read. */
typedef struct EmissionReader {
    const Scene *scene;
    const Material *material;
    const TextureSlot *slot; /* texture_id NO_ID: the same everywhere */
    CodeTable *codes;
    const PointList *lattice; /* barycentric weights in a cell */
    double plain;             /* luminance where the slot has no texture */
} EmissionReader;

static EmissionReader reader_of(const Scene *scene, const Material *material,
                                const PointList *lattice, CodeTable *codes) {
    EmissionReader reader = {
        .scene = scene, .material = material, .codes = codes, .lattice = lattice};
    if (material->display_id == NO_ID) {
        const float *factor = material->unlit ? material->base_color : material->emissive_cd_m2;
        reader.slot = material->unlit ? &material->base_color_texture : &material->emissive_texture;
        reader.plain = (double)luminance_from_rgb(factor);
        return reader;
    }
    const Display *display = &scene->displays[material->display_id];
    reader.slot = &display->content;
    fill_codes(display, codes);
    reader.plain =
        (double)(codes->dark + codes->added[0][255] + codes->added[1][255] + codes->added[2][255]);
    return reader;
}

static double sum_plain(const EmissionReader *reader, int points) {
    double squares = 0;
    for (int k = 0; k < points; k++) squares += reader->plain * reader->plain;
    return squares;
}

static double sum_content(const EmissionReader *reader, const PointList *at, int points) {
    uint8_t code[POINTS_MAX][3];
    const CodeTable *table = reader->codes;
    double squares = 0;
    texture_whole_codes(&reader->scene->textures[reader->slot->texture_id], at->u, at->v, points,
                        code);
    for (int k = 0; k < points; k++) {
        float l = table->dark;
        for (int i = 0; i < 3; i++) l += table->added[i][code[k][i]];
        squares += (double)l * (double)l;
    }
    return squares;
}

static double sum_emissive(const EmissionReader *reader, const PointList *at, int points) {
    const Material *m = reader->material;
    const float *factor = m->unlit ? m->base_color : m->emissive_cd_m2;
    double squares = 0;
    for (int k = 0; k < points; k++) {
        float texel[4];
        texture_colour(&reader->scene->textures[reader->slot->texture_id], at->u[k], at->v[k],
                       texel);
        for (int i = 0; i < 3; i++) texel[i] *= factor[i];
        double l = (double)luminance_from_rgb(texel);
        squares += l * l;
    }
    return squares;
}

/* Sum of the squared luminances at points of the texture. */
static double sum_squares(const EmissionReader *reader, const PointList *at, int points) {
    if (reader->slot->texture_id == NO_ID) return sum_plain(reader, points);
    if (reader->material->display_id != NO_ID) return sum_content(reader, at, points);
    return sum_emissive(reader, at, points);
}

/* ---- cells ------------------------------------------------------------------------------- */

/* Texture coordinates of a triangle's point are linear in its barycentric weights. */
typedef struct Corner {
    Vec2 at, along_u, along_v;
} Corner;

static Corner uv_corner(const EmissionReader *reader, uint32_t triangle) {
    Vec2 uv[3];
    for (int i = 0; i < 3; i++) uv[i] = slot_corner_uv(reader->scene, reader->slot, triangle, i);
    return (Corner){
        uv[0], {uv[1].x - uv[0].x, uv[1].y - uv[0].y}, {uv[2].x - uv[0].x, uv[2].y - uv[0].y}};
}

/* Barycentric weights of a point: the three corners, where a bright texel may reach in, then
 * uniform ones from a low-discrepancy lattice (R2 sequence). */
static Vec2 lattice_point(int i) {
    static const Vec2 corners[3] = {{0.01f, 0.01f}, {0.98f, 0.01f}, {0.01f, 0.98f}};
    if (i < 3) return corners[i];
    double a = 0.5 + 0.7548776662466927 * i, b = 0.5 + 0.5698402909980532 * i;
    a -= floor(a);
    b -= floor(b);
    return a + b > 1 ? (Vec2){(float)(1 - a), (float)(1 - b)} : (Vec2){(float)a, (float)b};
}

/* Points first .. first + POINTS_STEP - 1 of a cell in the texture. */
static void place_points(const EmissionReader *reader, const Corner *corner,
                         const EmitterCell *cell, int first, PointList *at) {
    const Vec2 origin = corner->at, du = corner->along_u, dv = corner->along_v;
    const float *x = reader->lattice->u + first, *y = reader->lattice->v + first;
    const float step = 1 / (float)cell->side, i = (float)cell->i, j = (float)cell->j;
    for (int k = 0; k < POINTS_STEP; k++) {
        float a = cell->is_turned ? 1 - x[k] : x[k], b = cell->is_turned ? 1 - y[k] : y[k];
        float u = (i + a) * step, v = (j + b) * step;
        at->u[first + k] = origin.x + u * du.x + v * dv.x;
        at->v[first + k] = origin.y + u * du.y + v * dv.y;
    }
}

/* Root of the mean square luminance of a cell whose lower corner is at column i, row j. */
static double cell_luminance(const EmissionReader *reader, const Corner *corner,
                             const EmitterCell *cell, int points) {
    PointList at;
    for (int k = 0; k < points; k += POINTS_STEP) place_points(reader, corner, cell, k, &at);
    return sqrt(sum_squares(reader, &at, points) / points);
}

/* Points a cell, about one a texel. */
static int points_of(const EmissionReader *reader, const Corner *corner, int side) {
    if (reader->slot->texture_id == NO_ID) return 1;
    const Image *image = &reader->scene->textures[reader->slot->texture_id].image;
    double cross = fabs(
        (double)(corner->along_u.x * corner->along_v.y - corner->along_u.y * corner->along_v.x));
    double texels = 0.5 * cross * image->width * image->height / ((double)side * side);
    return (int)fmin(POINTS_MAX, fmax(POINTS_LEAST, ceil(texels)));
}

/* Luminances of an emitter's cells, in order. */
static void read_emitter(const EmissionReader *reader, const Emitter *emitter, double *luminance) {
    Corner corner = uv_corner(reader, emitter->triangle);
    int side = emitter->side, points = points_of(reader, &corner, side), n = 0;
    for (int i = 0; i < side; i++)
        for (int k = 0; k < 2 * (side - i) - 1; k++) {
            EmitterCell cell = {side, i, k / 2, k % 2};
            luminance[n++] = cell_luminance(reader, &corner, &cell, points);
        }
}

static int list_emitters(const Scene *scene, Emitters *emitters, Arena *arena) {
    int count = 0;
    emitters->first_of_part = ARENA_NEW(arena, int, scene->part_count + 1);
    for (int p = 0; p < scene->part_count; p++) {
        const Part *part = &scene->parts[p];
        bool emits = scene->materials[part->material_id].is_emitter;
        emitters->first_of_part[p] = emits ? count : NO_ID;
        count += emits ? (int)part->triangle_count : 0;
    }
    return count;
}

static const TextureSlot *slot_of(const Scene *scene, const Material *material) {
    if (material->display_id != NO_ID) return &scene->displays[material->display_id].content;
    return material->unlit ? &material->base_color_texture : &material->emissive_texture;
}

/* Cuts each triangle into cells, as many as its share of the part's area deserves. */
static void cut_part(const Scene *scene, int part_id, Emitters *emitters) {
    const Part *part = &scene->parts[part_id];
    const Material *material = &scene->materials[part->material_id];
    bool is_picture = slot_of(scene, material)->texture_id != NO_ID;
    bool is_display = material->display_id != NO_ID;
    double cells = is_picture ? CELLS_OF_PICTURE : is_display ? CELLS_OF_DISPLAY : CELLS_OF_PLAIN;
    double total = 0;
    for (uint32_t i = 0; i < part->triangle_count; i++)
        total += scene_triangle_m2(scene, part->first_triangle + i);
    for (uint32_t i = 0; i < part->triangle_count; i++) {
        uint32_t triangle = part->first_triangle + i;
        double share = total > 0 ? scene_triangle_m2(scene, triangle) / total : 0;
        int side = (int)fmin(SIDE_MAX, fmax(1, sqrt(cells * share)));
        emitters->emitters[emitters->first_of_part[part_id] + (int)i] =
            (Emitter){triangle, emitters->cell_count, side,
                      (float)(scene_triangle_m2(scene, triangle) / ((double)side * side))};
        emitters->cell_count += (uint32_t)(side * side);
    }
}

static void read_part(const Scene *scene, int part_id, const PointList *lattice,
                      const Emitters *emitters, double *weight) {
    const Part *part = &scene->parts[part_id];
    CodeTable codes;
    EmissionReader reader = reader_of(scene, &scene->materials[part->material_id], lattice, &codes);
    bool both_sides = reader.material->double_sided && reader.material->display_id == NO_ID;
    const Emitter *first = &emitters->emitters[emitters->first_of_part[part_id]];
    double sum = 0, total = 0;
    for (uint32_t t = 0; t < part->triangle_count; t++) {
        const Emitter *e = &first[t];
        double area = scene_triangle_m2(scene, e->triangle) / ((double)e->side * e->side);
        read_emitter(&reader, e, weight + e->first_cell);
        for (int c = 0; c < e->side * e->side; c++) {
            sum += weight[e->first_cell + (uint32_t)c] * area;
            total += area;
        }
    }
    double floor = FLOOR_SHARE * (sum > 0 ? sum / total : 1); /* light where no point fell */
    for (uint32_t t = 0; t < part->triangle_count; t++) {
        const Emitter *e = &first[t];
        double area = scene_triangle_m2(scene, e->triangle) / ((double)e->side * e->side);
        for (int c = 0; c < e->side * e->side; c++) {
            double *w = &weight[e->first_cell + (uint32_t)c];
            *w = (*w + floor) * area * (both_sides ? 2 : 1);
        }
    }
}

typedef struct PartsReading {
    const Scene *scene;
    const Emitters *emitters;
    PointList lattice;
    double *weight;
} PartsReading;

/* A part's weights are its own: the threads decide nothing. */
static void read_one_part(void *user, int part_id, int worker) {
    const PartsReading *r = user;
    (void)worker;
    if (r->emitters->first_of_part[part_id] != NO_ID)
        read_part(r->scene, part_id, &r->lattice, r->emitters, r->weight);
}

static void read_parts(const Scene *scene, const Emitters *emitters, double *weight) {
    PartsReading reading = {.scene = scene, .emitters = emitters, .weight = weight};
    for (int i = 0; i < POINTS_MAX; i++) {
        Vec2 point = lattice_point(i);
        reading.lattice.u[i] = point.x;
        reading.lattice.v[i] = point.y;
    }
    parallel_for(parallel_default_threads(), scene->part_count, read_one_part, &reading);
}

Emitters emitters_build(const Scene *scene, Arena *arena) {
    Emitters emitters = {0};
    double total = 0;
    emitters.count = list_emitters(scene, &emitters, arena);
    if (!emitters.count) return emitters;
    emitters.emitters = ARENA_NEW(arena, Emitter, emitters.count);
    for (int p = 0; p < scene->part_count; p++)
        if (emitters.first_of_part[p] != NO_ID) cut_part(scene, p, &emitters);
    double *weight = ARENA_NEW(arena, double, emitters.cell_count);
    emitters.cell_emitter = ARENA_NEW(arena, uint32_t, emitters.cell_count);
    for (int i = 0; i < emitters.count; i++) {
        const Emitter *e = &emitters.emitters[i];
        for (int c = 0; c < e->side * e->side; c++)
            emitters.cell_emitter[e->first_cell + (uint32_t)c] = (uint32_t)i;
    }
    read_parts(scene, &emitters, weight);
    for (uint32_t c = 0; c < emitters.cell_count; c++) total += weight[c];
    if (!(total > 0)) return (Emitters){.first_of_part = emitters.first_of_part};
    emitter_tree_build(scene, weight, arena, &emitters);
    return emitters;
}
