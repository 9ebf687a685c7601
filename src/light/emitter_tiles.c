/* Before the first path: tiles of emitters, and the directions of displays. */
#include "light/emitter_tiles.h"

#include <math.h>
#include <stdlib.h>

#include "base/mathd.h"
#include "panel/query/panel_emission.h"


#define PARTS_MAX 12 /* with tiles of their own; the dimmest share one */
#define FINE_ENOUGH 0.2  /* of the part's mean square extent: a good third of its length */
#define PROFILE_CODES 8  /* of the content, whose directions are averaged */

/* A tile while it is made: cells order[first .. first + count - 1]. */
typedef struct Gathering {
    uint32_t first, count;
    int      part_id; /* NO_ID: of several */
    double   power, centre[3], spread2, normal[3], whole_spread2;
} Gathering;

typedef struct TileWork {
    const Scene    *scene;
    const Emitters *emitters;
    const double   *weight;
    uint32_t       *order;
    EmitterChoice  *choices; /* in the same order */
    float         (*position)[3]; /* of every cell's centroid */
    Gathering       tile[EMITTER_TILES_MAX];
    int             count;
} TileWork;

static const Part *part_of(const Scene *scene, uint32_t triangle)
{
    return &scene->parts[scene->triangles[triangle].part_id];
}

static TrianglePoint cell_point(const TileWork *work, uint32_t cell)
{
    const Emitter *e = &work->emitters->emitters[work->emitters->cell_emitter[cell]];
    EmitterCell at = emitter_cell(e, cell);
    float inside = at.is_turned ? 2 / 3.0f : 1 / 3.0f, step = 1 / (float)at.side;
    return triangle_point(work->scene, e->triangle, ((float)at.i + inside) * step,
                          ((float)at.j + inside) * step);
}

static void find_positions(TileWork *work)
{
    for (uint32_t c = 0; c < work->emitters->cell_count; c++) {
        Vec3 p = cell_point(work, c).position;
        work->position[c][0] = p.x;
        work->position[c][1] = p.y;
        work->position[c][2] = p.z;
    }
}

static Vec3 emitter_normal(const TileWork *work, uint32_t cell)
{
    const Emitter *e = &work->emitters->emitters[work->emitters->cell_emitter[cell]];
    return triangle_point(work->scene, e->triangle, 1 / 3.0f, 1 / 3.0f).ng;
}

/* Power, centre, extent and mean normal of a tile's cells. */
static void measure(const TileWork *work, Gathering *tile)
{
    double squares = 0;
    uint32_t emitter = UINT32_MAX;
    Vec3   n = vec3(0, 0, 0);
    tile->power = 0;
    for (int k = 0; k < 3; k++) tile->centre[k] = tile->normal[k] = 0;
    for (uint32_t i = 0; i < tile->count; i++) {
        uint32_t cell = work->order[tile->first + i];
        double   w = work->weight[cell];
        if (work->emitters->cell_emitter[cell] != emitter) {
            emitter = work->emitters->cell_emitter[cell];
            n = emitter_normal(work, cell);
        }
        const double normal[3] = {(double)n.x, (double)n.y, (double)n.z};
        tile->power += w;
        for (int k = 0; k < 3; k++) {
            double p = (double)work->position[cell][k];
            tile->centre[k] += w * p;
            tile->normal[k] += w * normal[k];
            squares += w * p * p;
        }
    }
    if (!(tile->power > 0)) return;
    for (int k = 0; k < 3; k++) {
        tile->centre[k] /= tile->power;
        tile->normal[k] /= tile->power;
        squares -= tile->power * tile->centre[k] * tile->centre[k];
    }
    tile->spread2 = fmax(0, squares / tile->power);
}

/* ---- which tiles ------------------------------------------------------------------------- */

static int by_power(const void *a, const void *b)
{
    const Gathering *x = a, *y = b;
    if (x->power != y->power) return x->power < y->power ? 1 : -1;
    return x->part_id - y->part_id;
}

/* One tile a part, the strongest first. Cells of a part follow each other. */
static Gathering *tiles_of_parts(const TileWork *work, Arena *arena, int *count)
{
    const Emitters *e = work->emitters;
    Gathering *all = ARENA_NEW(arena, Gathering, work->scene->part_count);
    *count = 0;
    for (int p = 0; p < work->scene->part_count; p++) {
        const Part *part = &work->scene->parts[p];
        int first = e->first_of_part[p], last = first + (int)part->triangle_count - 1;
        if (first == NO_ID || !part->triangle_count) continue;
        Gathering *tile = &all[(*count)++];
        uint32_t end = e->emitters[last].first_cell +
                       (uint32_t)(e->emitters[last].side * e->emitters[last].side);
        *tile = (Gathering){.first = e->emitters[first].first_cell, .part_id = p};
        tile->count = end - tile->first;
        for (uint32_t c = tile->first; c < end; c++) tile->power += work->weight[c];
        if (!(tile->power > 0)) (*count)--; /* without any area */
    }
    qsort(all, (size_t)*count, sizeof *all, by_power);
    return all;
}

/* The order of cells by part, the strongest parts first; the dimmest become one tile. */
static void start_tiles(TileWork *work, Arena scratch)
{
    int        parts;
    uint32_t   next = 0;
    Gathering *all = tiles_of_parts(work, &scratch, &parts);
    for (int p = 0; p < parts; p++) {
        Gathering *from = &all[p], *to = &work->tile[work->count];
        for (uint32_t c = 0; c < from->count; c++) work->order[next + c] = from->first + c;
        bool joins = p > PARTS_MAX - 1;
        if (joins) {
            to = &work->tile[work->count - 1];
            to->count += from->count;
            to->part_id = NO_ID;
        } else {
            *to = (Gathering){next, from->count, from->part_id, 0, {0}, 0, {0}, 0};
            work->count++;
        }
        next += from->count;
    }
    for (int t = 0; t < work->count; t++) {
        measure(work, &work->tile[t]);
        work->tile[t].whole_spread2 = work->tile[t].spread2;
    }
}

static int longest_axis(const TileWork *work, const Gathering *tile)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    int   axis = 0;
    for (uint32_t i = 0; i < tile->count; i++)
        for (int k = 0; k < 3; k++) {
            float p = work->position[work->order[tile->first + i]][k];
            low[k] = fminf(low[k], p);
            high[k] = fmaxf(high[k], p);
        }
    for (int k = 1; k < 3; k++)
        if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
    return axis;
}

/* At the centre, across the longest side. False: one half would be empty. */
static bool split(TileWork *work, int t)
{
    Gathering *tile = &work->tile[t];
    uint32_t  *order = work->order + tile->first, below = 0;
    int        axis = longest_axis(work, tile);
    for (uint32_t i = 0; i < tile->count; i++) {
        uint32_t cell = order[i];
        if (!((double)work->position[cell][axis] < tile->centre[axis])) continue;
        order[i] = order[below];
        order[below++] = cell;
    }
    if (!below || below == tile->count) return false;
    Gathering *rest = &work->tile[work->count++];
    *rest = *tile;
    rest->first += below;
    rest->count -= below;
    tile->count = below;
    measure(work, tile);
    measure(work, rest);
    if (tile->power > 0 && rest->power > 0) return true;
    tile->count += rest->count;
    work->count--;
    measure(work, tile);
    return false;
}

static void split_tiles(TileWork *work)
{
    bool is_done[EMITTER_TILES_MAX] = {false};
    while (work->count < EMITTER_TILES_MAX) {
        int    best = -1;
        double most = 0;
        for (int t = 0; t < work->count; t++) {
            const Gathering *tile = &work->tile[t];
            double gain = tile->power * tile->spread2;
            if (is_done[t] || !(tile->spread2 > FINE_ENOUGH * tile->whole_spread2)) continue;
            if (gain > most) {
                best = t;
                most = gain;
            }
        }
        if (best < 0) return;
        is_done[best] = !split(work, best);
    }
}

/* ---- directions of displays -------------------------------------------------------------- */

/* Codes of the content, each standing for the same share of the light. */
static void choose_codes(const TileWork *work, int part_id, float codes[PROFILE_CODES][3])
{
    const Part     *part = &work->scene->parts[part_id];
    const Material *material = &work->scene->materials[part->material_id];
    const Display  *display = &work->scene->displays[material->display_id];
    const Emitter  *first = &work->emitters->emitters[work->emitters->first_of_part[part_id]];
    const Emitter  *last = first + part->triangle_count - 1;
    uint32_t begin = first->first_cell, end = last->first_cell +
                                              (uint32_t)(last->side * last->side);
    double   total = 0, sum = 0;
    int      k = 0;
    for (uint32_t c = begin; c < end; c++) total += work->weight[c];
    for (uint32_t c = begin; c < end && k < PROFILE_CODES; c++) {
        sum += work->weight[c];
        TrianglePoint point = {0};
        if (sum * PROFILE_CODES > total * (k + 0.5)) point = cell_point(work, c);
        for (; k < PROFILE_CODES && sum * PROFILE_CODES > total * (k + 0.5); k++)
            display_codes(work->scene, display, &point, codes[k]);
    }
}

/* The direction of a node of the turned octahedral map, as emitters.c reads it. */
static Vec3 node_direction(int i, int j)
{
    float s = 2 * (float)i / (EMITTER_PROFILE_SIDE - 1) - 1;
    float t = 2 * (float)j / (EMITTER_PROFILE_SIDE - 1) - 1;
    float x = 0.5f * (s + t), y = 0.5f * (s - t);
    return vec3_normalize(vec3(x, y, fmaxf(0, 1 - fabsf(x) - fabsf(y))));
}

static const EmitterProfile *profile_of(const TileWork *work, int part_id, Arena *arena)
{
    const Material *material =
        &work->scene->materials[work->scene->parts[part_id].material_id];
    const Panel    *panel = work->scene->displays[material->display_id].panel;
    EmitterProfile *profile = ARENA_NEW(arena, EmitterProfile, 1);
    float           codes[PROFILE_CODES][3], mean = 0;
    choose_codes(work, part_id, codes);
    for (int k = 0; k < PROFILE_CODES; k++) mean += panel_mean_luminance(panel, codes[k]);
    for (int j = 0; j < EMITTER_PROFILE_SIDE; j++)
        for (int i = 0; i < EMITTER_PROFILE_SIDE; i++) {
            float xyz[3], sum = 0;
            Vec3  d = node_direction(i, j);
            for (int k = 0; k < PROFILE_CODES; k++) {
                panel_emission_xyz(panel, d, codes[k], xyz);
                sum += xyz[1];
            }
            profile->value[j * EMITTER_PROFILE_SIDE + i] = mean > 0 ? d.z * sum / mean : d.z;
        }
    return profile;
}

static const EmitterProfile *lambert(Arena *arena)
{
    EmitterProfile *profile = ARENA_NEW(arena, EmitterProfile, 1);
    for (int j = 0; j < EMITTER_PROFILE_SIDE; j++)
        for (int i = 0; i < EMITTER_PROFILE_SIDE; i++)
            profile->value[j * EMITTER_PROFILE_SIDE + i] = node_direction(i, j).z;
    return profile;
}

/* ---- all of it -------------------------------------------------------------------------- */

static bool is_display(const TileWork *work, int part_id)
{
    if (part_id == NO_ID) return false;
    return work->scene->materials[work->scene->parts[part_id].material_id].display_id != NO_ID;
}

/* The display's frame at the cell nearest to the tile's centre. */
static Frame display_frame_of(const TileWork *work, const Gathering *tile)
{
    const Part     *part = &work->scene->parts[tile->part_id];
    const Material *material = &work->scene->materials[part->material_id];
    uint32_t nearest = work->order[tile->first];
    double   least = INFINITY;
    for (uint32_t i = 0; i < tile->count; i++) {
        uint32_t cell = work->order[tile->first + i];
        double   d2 = 0;
        for (int k = 0; k < 3; k++)
            d2 += pow_d((double)work->position[cell][k] - tile->centre[k], 2);
        if (d2 < least) nearest = cell;
        if (d2 < least) least = d2;
    }
    TrianglePoint point = cell_point(work, nearest);
    uint32_t      triangle =
        work->emitters->emitters[work->emitters->cell_emitter[nearest]].triangle;
    return display_frame(work->scene, &work->scene->displays[material->display_id], triangle,
                         &point);
}

static bool shines_both_ways(const TileWork *work, const Gathering *tile)
{
    uint32_t cell = work->order[tile->first];
    const Emitter  *e = &work->emitters->emitters[work->emitters->cell_emitter[cell]];
    const Material *m =
        &work->scene->materials[part_of(work->scene, e->triangle)->material_id];
    return tile->part_id == NO_ID || (m->double_sided && m->display_id == NO_ID);
}

static void set_frame(EmitterTiles *tiles, int t, Frame frame)
{
    const Vec3 axes[3] = {frame.x, frame.y, frame.z};
    for (int a = 0; a < 3; a++) {
        tiles->axis[a][0][t] = axes[a].x;
        tiles->axis[a][1][t] = axes[a].y;
        tiles->axis[a][2][t] = axes[a].z;
    }
}

static void finish_tile(const TileWork *work, int t, EmitterTiles *tiles)
{
    const Gathering *from = &work->tile[t];
    Vec3  normal = vec3((float)from->normal[0], (float)from->normal[1], (float)from->normal[2]);
    float length = vec3_length(normal);
    Frame frame = length > 1e-3f ? frame_from_z(vec3_scale(normal, 1 / length))
                                 : frame_from_z(vec3(0, 0, 1));
    for (int k = 0; k < 3; k++) tiles->centre[k][t] = (float)from->centre[k];
    tiles->power[t] = (float)from->power;
    tiles->spread2[t] = (float)from->spread2;
    tiles->focus[t] = fminf(1, length);
    tiles->both_sides[t] = shines_both_ways(work, from) ? -1 : 0;
    tiles->cells[t] = work->choices + from->first;
    set_frame(tiles, t, is_display(work, from->part_id) ? display_frame_of(work, from) : frame);
}

static double cell_area(const TileWork *work, const Emitter *e)
{
    Vec3 a = scene_corner(work->scene, e->triangle, 0);
    Vec3 cross = vec3_cross(vec3_sub(scene_corner(work->scene, e->triangle, 1), a),
                            vec3_sub(scene_corner(work->scene, e->triangle, 2), a));
    return 0.5 * (double)vec3_length(cross) / ((double)e->side * e->side);
}

/* The choice among a tile's cells, and what they know of it. */
static void finish_cells(const TileWork *work, int t, Arena *arena, Emitters *emitters)
{
    const Gathering *from = &work->tile[t];
    double *weight = ARENA_NEW(arena, double, from->count);
    for (uint32_t i = 0; i < from->count; i++)
        weight[i] = work->weight[work->order[from->first + i]];
    AliasTable made = alias_build(weight, (int)from->count, arena);
    emitters->tiles->choice[t] = made;
    for (uint32_t i = 0; i < from->count; i++) {
        uint32_t cell = work->order[from->first + i], emitter = emitters->cell_emitter[cell];
        double   area = cell_area(work, &emitters->emitters[emitter]);
        float    pdf_area = area > 0 ? (float)((double)made.prob[i] / area) : 0;
        emitters->cell_tile[cell] = (uint8_t)t;
        emitters->cell_pdf_area[cell] = pdf_area;
        work->choices[from->first + i] = (EmitterChoice){cell, emitter, pdf_area};
    }
}

static void choose_profiles(const TileWork *work, Arena *arena, EmitterTiles *tiles)
{
    const EmitterProfile  *plain = lambert(arena);
    const EmitterProfile **of_part = ARENA_NEW(arena, const EmitterProfile *,
                                               work->scene->part_count + 1);
    for (int t = 0; t < work->count; t++) {
        int part_id = work->tile[t].part_id;
        tiles->profile[t] = plain;
        if (!is_display(work, part_id)) continue;
        if (!of_part[part_id]) of_part[part_id] = profile_of(work, part_id, arena);
        tiles->profile[t] = of_part[part_id];
    }
}

void emitter_tiles_build(const Scene *scene, const double *weight, Arena *arena,
                         Emitters *emitters)
{
    TileWork     work = {.scene = scene, .emitters = emitters, .weight = weight};
    uint32_t cells = emitters->cell_count;
    work.order = ARENA_NEW(arena, uint32_t, cells);
    work.choices = ARENA_NEW(arena, EmitterChoice, cells);
    work.position = (float(*)[3])ARENA_NEW(arena, float, 3 * (size_t)cells);
    find_positions(&work);
    start_tiles(&work, *arena);
    split_tiles(&work);
    emitters->cell_tile = ARENA_NEW(arena, uint8_t, cells);
    emitters->cell_pdf_area = ARENA_NEW(arena, float, cells);
    EmitterTiles *tiles = emitters->tiles = ARENA_NEW(arena, EmitterTiles, 1);
    tiles->count = work.count;
    for (int t = 0; t < work.count; t++) {
        finish_tile(&work, t, tiles);
        finish_cells(&work, t, arena, emitters);
    }
    tiles->share = tiles->power / spectrum_all(spectrum_sum(tiles->power));
    choose_profiles(&work, arena, tiles);
}
