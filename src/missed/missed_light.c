/* SPDX-License-Identifier: Apache-2.0 */
#include "missed/missed_light.h"

#include <math.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "missed/missed_rays.h"
#include "path/path.h"
#include "scene/point/ray_ends.h"

#define TILE_PATHS 4 /* of a camera's tile */
#define DISPLAY_PATHS 256
#define DARK 1e-6                       /* cd m^-2 or lx: less is not seen by night */
#define SCRATCH_BYTES ((size_t)1 << 30) /* address space */
#define SEED 0x70696c6fu

/* ---- what a few paths find --------------------------------------------------------------- */

/* A tile of an eye, and what is there: cd m^-2 or lx. */
typedef struct Tile {
    int eye, place;
    AreaList front; /* of a display */
    double found, missed;
} Tile;

typedef struct TilePilot {
    const PathContext *context;
    const MissedEye *eyes;
    Tile *tiles;
} TilePilot;

static Ray tile_ray(const Camera *camera, int place, Vec2 at) {
    float column = (float)(place % MISSED_SIDE), row = (float)(place / MISSED_SIDE);
    return camera_ray(camera, (column + at.x) / MISSED_SIDE * (float)camera->width,
                      (row + at.y) / MISSED_SIDE * (float)camera->height);
}

/* One path's light, Y. */
static double try_path(const TilePilot *work, const Tile *tile, const PathStart *start) {
    const MissedEye *eye = &work->eyes[tile->eye];
    const Scene *scene = work->context->scene;
    PathResult result = {.xyz = {0}};
    float lx[3], u[4];
    sampler_4d(start->sampler, u);
    if (eye->camera) {
        Ray ray = tile_ray(eye->camera, tile->place, (Vec2){u[0], u[1]});
        path_from_ray(start, ray, &result);
        return (double)result.xyz[1];
    }
    if (!tile->front.count) return 0;
    uint32_t triangle = area_list_at(&tile->front, (double)u[2] * area_list_m2(&tile->front));
    if (u[0] + u[1] > 1) {
        u[0] = 1 - u[0];
        u[1] = 1 - u[1];
    }
    TrianglePoint point = triangle_point(scene, triangle, u[0], u[1]);
    path_from_point(start, (LitPoint){ray_start(&point, point.ng), point.ng, false}, lx);
    return (double)lx[1];
}

static void try_tile(void *user, int item, int worker) {
    const TilePilot *work = user;
    Tile *tile = &work->tiles[item];
    int paths = work->eyes[tile->eye].camera ? TILE_PATHS : DISPLAY_PATHS;
    PathStatistics counted = {0};
    (void)worker;
    for (int k = 0; k < paths; k++) {
        Sampler sampler = sampler_start(SEED, tile->eye, tile->place, (uint32_t)k);
        Wavelengths wavelengths;
        wavelengths_sample(sampler_1d(&sampler), &wavelengths);
        PathStart start = {.context = work->context,
                           .wavelengths = &wavelengths,
                           .sampler = &sampler,
                           .statistics = &counted};
        double y = try_path(work, tile, &start);
        if (isfinite(y) && y > 0) tile->found += y / paths;
    }
}

/* Few paths find nothing in a dark tile. As for a frame's relative error (film.h), shadow is judged
 * against what an eye sees that is adapted to the picture: half its key, the geometric mean. */
static void lift_shadow(const TilePilot *work, int eye_count) {
    Tile *first = work->tiles;
    for (int i = 0; i < eye_count; first += missed_tiles(&work->eyes[i]), i++) {
        int tiles = missed_tiles(&work->eyes[i]), lit = 0;
        double logs = 0;
        for (int k = 0; k < tiles; k++) {
            if (!(first[k].found > 0)) continue;
            logs += log(first[k].found);
            lit++;
        }
        double low = lit ? fmax(0.5 * exp(logs / lit), DARK) : DARK;
        for (int k = 0; k < tiles; k++) first[k].found = fmax(first[k].found, low);
    }
}

/* ---- pairs ------------------------------------------------------------------------------- */

/* Finds of one lamp by one part side by side; the same order on every machine. */
static int compare_finds(const void *a, const void *b) {
    const MissedFind *x = a, *y = b;
    if (x->from != y->from) return x->from < y->from ? -1 : 1;
    if (x->light_id != y->light_id) return x->light_id < y->light_id ? -1 : 1;
    if (x->part_id != y->part_id) return x->part_id < y->part_id ? -1 : 1;
    if (x->is_solid != y->is_solid) return x->is_solid < y->is_solid ? -1 : 1;
    if (x->then_id != y->then_id) return x->then_id < y->then_id ? -1 : 1;
    if (x->tile != y->tile) return x->tile < y->tile ? -1 : 1;
    return x->light < y->light ? -1 : x->light > y->light;
}

static bool is_same_pair(const MissedFind *a, const MissedFind *b) {
    return a->from == b->from && a->light_id == b->light_id && a->part_id == b->part_id &&
           a->is_solid == b->is_solid;
}

static int compare_pairs(const void *a, const void *b) {
    const MissedPair *x = a, *y = b;
    if (x->share != y->share) return x->share > y->share ? -1 : 1;
    if (x->from != y->from) return x->from < y->from ? -1 : 1;
    if (x->light_id != y->light_id) return x->light_id < y->light_id ? -1 : 1;
    if (x->part_id != y->part_id) return x->part_id < y->part_id ? -1 : 1;
    return x->is_solid - y->is_solid;
}

typedef struct Pairing {
    const MissedEye *eyes;
    int eye_count;
    const Tile *tiles;
    double *light, *share; /* of one pair, an eye */
} Pairing;

/* Of `count` finds. */
static MissedPair pair_of(const Pairing *work, const MissedFind *finds, uint32_t count) {
    MissedPair pair = {.from = finds->from,
                       .light_id = finds->light_id,
                       .part_id = finds->part_id,
                       .is_solid = finds->is_solid,
                       .then_id = NO_ID};
    double then = 0, most = 0;
    for (int i = 0; i < work->eye_count; i++) work->light[i] = work->share[i] = 0;
    for (uint32_t i = 0; i < count; i++) {
        const Tile *tile = &work->tiles[finds[i].tile];
        double light = (double)finds[i].light / missed_tiles(&work->eyes[tile->eye]);
        double share = light / (tile->found + tile->missed);
        work->light[tile->eye] += light;
        work->share[tile->eye] += share;
        if (i && finds[i].then_id != finds[i - 1].then_id) then = 0;
        then += share;
        if (then > most) {
            most = then;
            pair.then_id = finds[i].then_id;
        }
    }
    for (int i = 0; i < work->eye_count; i++) {
        if (!(work->share[i] > pair.share)) continue;
        pair.eye = i;
        pair.light = work->light[i];
        pair.share = work->share[i];
    }
    return pair;
}

static void find_pairs(const Pairing *work, MissedFinds *finds, MissedLight *out, Arena *arena) {
    MissedPair *pairs = ARENA_NEW(arena, MissedPair, finds->count + 1);
    qsort(finds->list, finds->count, sizeof *finds->list, compare_finds);
    for (uint32_t first = 0, end; first < finds->count; first = end) {
        for (end = first + 1; end < finds->count; end++)
            if (!is_same_pair(&finds->list[first], &finds->list[end])) break;
        MissedPair pair = pair_of(work, &finds->list[first], end - first);
        if (pair.share >= MISSED_SHARE) pairs[out->count++] = pair;
    }
    qsort(pairs, (size_t)out->count, sizeof *pairs, compare_pairs);
    out->pairs = pairs;
}

/* All together. */
static void add_up(const Pairing *work, int tile_count, MissedLight *out) {
    for (int i = 0; i < work->eye_count; i++) work->light[i] = work->share[i] = 0;
    for (int i = 0; i < tile_count; i++) {
        const Tile *tile = &work->tiles[i];
        double tiles = missed_tiles(&work->eyes[tile->eye]);
        if (!(tile->missed > 0)) continue;
        work->light[tile->eye] += tile->missed / tiles;
        work->share[tile->eye] += tile->missed / (tile->found + tile->missed) / tiles;
    }
    for (int i = 0; i < work->eye_count; i++) {
        if (!(work->share[i] > out->share)) continue;
        out->eye = i;
        out->light = work->light[i];
        out->share = work->share[i];
    }
}

/* ---- all of it --------------------------------------------------------------------------- */

static Tile *list_tiles(const PathContext *context, const MissedEye *eyes, int eye_count,
                        int *count, Arena *arena) {
    *count = 0;
    for (int i = 0; i < eye_count; i++) *count += missed_tiles(&eyes[i]);
    Tile *tiles = ARENA_NEW(arena, Tile, *count + 1), *next = tiles;
    for (int i = 0; i < eye_count; i++) {
        AreaList front = {0};
        if (!eyes[i].camera)
            front = area_list_of_display(context->scene, eyes[i].display_id, arena);
        for (int k = 0; k < missed_tiles(&eyes[i]); k++)
            *next++ = (Tile){.eye = i, .place = k, .front = front};
    }
    return tiles;
}

MissedLight missed_light_find(const PathContext *context, const MissedEye *eyes, int eye_count,
                              Arena *arena) {
    MissedLight out = {.eyes = eyes};
    Arena scratch = arena_reserve(SCRATCH_BYTES);
    MissedFinds finds = missed_rays_send(context, eyes, eye_count, &scratch);
    int tile_count;
    if (finds.count) {
        Tile *tiles = list_tiles(context, eyes, eye_count, &tile_count, &scratch);
        TilePilot pilot = {context, eyes, tiles};
        for (uint32_t i = 0; i < finds.count; i++)
            tiles[finds.list[i].tile].missed += (double)finds.list[i].light;
        parallel_for(bvh_threads(context->bvh), tile_count, try_tile, &pilot);
        lift_shadow(&pilot, eye_count);
        Pairing pairing = {eyes, eye_count, tiles, ARENA_NEW(&scratch, double, eye_count),
                           ARENA_NEW(&scratch, double, eye_count)};
        find_pairs(&pairing, &finds, &out, arena);
        add_up(&pairing, tile_count, &out);
    }
    arena_release(&scratch);
    return out;
}
