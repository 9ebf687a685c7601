/* SPDX-License-Identifier: Apache-2.0 */
#include "missed/missed.h"

#include <math.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "path/path.h"
#include "scene/point/ray_ends.h"

#define TILE_PATHS 4 /* of a camera's tile */
#define DISPLAY_PATHS 256
#define DARK 1e-6                       /* cd m^-2 or lx: less is not seen by night */
#define SCRATCH_BYTES ((size_t)1 << 30) /* address space */
#define SEED 0x70696c6fu
#define BOUNCES 64
#define HEIGHT 512 /* pixels: a picture's shape is all that counts */
#define LINES 4    /* of pairs */

/* A tile of an eye, and what is there: cd m^-2 or lx. */
typedef struct Tile {
    const EyeTiles *eye;
    int place;
    double found, missed;
} Tile;

typedef struct MissedSearch {
    const PathContext *context;
    const double *areas;
    EyeTiles *eyes;
    int eye_count, tile_count;
    Tile *tiles;
} MissedSearch;

static bool shows(const Scene *scene, int part_id, const MissedEye *eye) {
    return scene->materials[scene->parts[part_id].material_id].display_id == eye->display_id;
}

static void list_tiles(MissedSearch *search, const MissedEye *eyes, Arena *arena) {
    const Scene *scene = search->context->scene;
    search->eyes = ARENA_NEW(arena, EyeTiles, search->eye_count);
    for (int i = 0; i < search->eye_count; i++) {
        EyeTiles *eye = &search->eyes[i];
        int count = eyes[i].camera ? MISSED_SIDE * MISSED_SIDE : 1;
        *eye = (EyeTiles){.eye = &eyes[i], .first = search->tile_count, .count = count};
        search->tile_count += count;
        for (int id = 0; id < scene->part_count; id++)
            if (shows(scene, id, &eyes[i])) eye->m2 += areas_of_part(scene, search->areas, id);
    }
    search->tiles = ARENA_NEW(arena, Tile, search->tile_count);
    for (int i = 0; i < search->eye_count; i++)
        for (int k = 0; k < search->eyes[i].count; k++)
            search->tiles[search->eyes[i].first + k] = (Tile){.eye = &search->eyes[i], .place = k};
}

/* ---- what a few paths find --------------------------------------------------------------- */

static double try_picture(const Tile *tile, const PathStart *start, const float u[4]) {
    const Camera *camera = tile->eye->eye->camera;
    float column = (float)(tile->place % MISSED_SIDE), row = (float)(tile->place / MISSED_SIDE);
    PathResult result = {.xyz = {0}};
    path_from_ray(start,
                  camera_ray(camera, (column + u[0]) / MISSED_SIDE * (float)camera->width,
                             (row + u[1]) / MISSED_SIDE * (float)camera->height),
                  &result);
    return (double)result.xyz[1];
}

/* At a point of the display's front. */
static double try_display(const MissedSearch *search, const Tile *tile, const PathStart *start,
                          const float u[4]) {
    const Scene *scene = search->context->scene;
    double m2 = (double)u[2] * tile->eye->m2;
    for (int id = 0; id < scene->part_count; id++) {
        float lx[3];
        double own = areas_of_part(scene, search->areas, id);
        if (!shows(scene, id, tile->eye->eye)) continue;
        if (m2 >= own) {
            m2 -= own;
            continue;
        }
        Hit hit = areas_point(scene, search->areas, id, m2, (Vec2){u[0], u[1]});
        TrianglePoint point = triangle_point(scene, hit.triangle, hit.u, hit.v);
        path_from_point(start, (LitPoint){ray_start(&point, point.ng), point.ng, false}, lx);
        return (double)lx[1];
    }
    return 0;
}

static void try_tile(void *user, int item, int worker) {
    const MissedSearch *search = user;
    Tile *tile = &search->tiles[item];
    bool is_picture = tile->eye->eye->camera;
    int paths = is_picture ? TILE_PATHS : DISPLAY_PATHS;
    PathStatistics counted = {0};
    (void)worker;
    for (int k = 0; k < paths; k++) {
        Sampler sampler = sampler_start(SEED, item, 0, (uint32_t)k);
        Wavelengths wavelengths;
        float u[4];
        wavelengths_sample(sampler_1d(&sampler), &wavelengths);
        sampler_4d(&sampler, u);
        PathStart start = {.context = search->context,
                           .wavelengths = &wavelengths,
                           .sampler = &sampler,
                           .statistics = &counted};
        double y = is_picture ? try_picture(tile, &start, u) : try_display(search, tile, &start, u);
        if (isfinite(y) && y > 0) tile->found += y / paths;
    }
}

/* Few paths find nothing in a dark tile. As for a frame's relative error (film.h), shadow is judged
 * against what an eye sees that is adapted to the picture: half its key, the geometric mean. */
static void lift_shadow(Tile *tiles, int count) {
    double logs = 0;
    int lit = 0;
    for (int k = 0; k < count; k++) {
        if (!(tiles[k].found > 0)) continue;
        logs += log(tiles[k].found);
        lit++;
    }
    double low = lit ? fmax(0.5 * exp(logs / lit), DARK) : DARK;
    for (int k = 0; k < count; k++) tiles[k].found = fmax(tiles[k].found, low);
}

/* ---- pairs ------------------------------------------------------------------------------- */

static int compare_ways(const MissedWay *a, const MissedWay *b) {
    const int x[] = {(int)a->from, a->light_id, a->part_id, a->is_solid};
    const int y[] = {(int)b->from, b->light_id, b->part_id, b->is_solid};
    for (int i = 0; i < 4; i++)
        if (x[i] != y[i]) return x[i] < y[i] ? -1 : 1;
    return 0;
}

/* Finds of one lamp by one part side by side; the same order on every machine. */
static int compare_finds(const void *a, const void *b) {
    const MissedFind *x = a, *y = b;
    int order = compare_ways(&x->way, &y->way);
    if (order) return order;
    if (x->way.then_id != y->way.then_id) return x->way.then_id < y->way.then_id ? -1 : 1;
    if (x->tile != y->tile) return x->tile < y->tile ? -1 : 1;
    return x->light < y->light ? -1 : x->light > y->light;
}

static int compare_pairs(const void *a, const void *b) {
    const MissedPair *x = a, *y = b;
    if (x->share != y->share) return x->share > y->share ? -1 : 1;
    return compare_ways(&x->way, &y->way);
}

/* Of `count` finds, in their order. */
static MissedPair pair_of(const MissedSearch *search, const MissedFind *finds, uint32_t count,
                          Arena scratch) {
    MissedPair pair = {.way = finds->way};
    double *light = ARENA_NEW(&scratch, double, search->eye_count);
    double *share = ARENA_NEW(&scratch, double, search->eye_count);
    double then = 0, most = 0;
    for (uint32_t i = 0; i < count; i++) {
        const Tile *tile = &search->tiles[finds[i].tile];
        int eye = (int)(tile->eye - search->eyes);
        double own = (double)finds[i].light / tile->eye->count;
        light[eye] += own;
        share[eye] += own / (tile->found + tile->missed);
        if (i && finds[i].way.then_id != finds[i - 1].way.then_id) then = 0;
        then += own / (tile->found + tile->missed);
        if (then > most) {
            most = then;
            pair.way.then_id = finds[i].way.then_id;
        }
    }
    for (int i = 0; i < search->eye_count; i++)
        if (share[i] > pair.share) pair = (MissedPair){pair.way, i, light[i], share[i]};
    return pair;
}

static void find_pairs(const MissedSearch *search, const MissedFinds *finds, MissedLight *out,
                       Arena scratch, Arena *arena) {
    MissedPair *pairs = ARENA_NEW(arena, MissedPair, finds->count);
    for (uint32_t first = 0, end; first < finds->count; first = end) {
        for (end = first + 1; end < finds->count; end++)
            if (compare_ways(&finds->list[first].way, &finds->list[end].way)) break;
        MissedPair pair = pair_of(search, &finds->list[first], end - first, scratch);
        if (pair.share >= MISSED_SHARE) pairs[out->count++] = pair;
    }
    qsort(pairs, (size_t)out->count, sizeof *pairs, compare_pairs);
    out->pairs = pairs;
    out->all = pair_of(search, finds->list, finds->count, scratch);
}

MissedLight missed_light_find(const PathContext *context, const MissedEye *eyes, int eye_count,
                              Arena *arena) {
    MissedLight out = {.eyes = eyes};
    Arena scratch = arena_reserve(SCRATCH_BYTES);
    MissedSearch search = {.context = context,
                           .areas = areas_measure(context->scene, &scratch),
                           .eye_count = eye_count};
    list_tiles(&search, eyes, &scratch);
    MissedFinds finds = missed_rays_send(context, search.eyes, eye_count, search.areas, &scratch);
    if (finds.count) {
        qsort(finds.list, finds.count, sizeof *finds.list, compare_finds);
        for (uint32_t i = 0; i < finds.count; i++)
            search.tiles[finds.list[i].tile].missed += (double)finds.list[i].light;
        parallel_for(bvh_threads(context->bvh), search.tile_count, try_tile, &search);
        for (int i = 0; i < eye_count; i++)
            lift_shadow(&search.tiles[search.eyes[i].first], search.eyes[i].count);
        find_pairs(&search, &finds, &out, scratch, arena);
    }
    arena_release(&scratch);
    return out;
}

/* ---- a scene as it is loaded ------------------------------------------------------------- */

static MissedEye camera_eye(const SceneCamera *camera, Arena *arena) {
    Camera *placed = ARENA_NEW(arena, Camera, 1);
    float aspect = camera->aspect > 0 ? camera->aspect : 16.0f / 9;
    *placed = camera_from_scene(camera, (int)(aspect * HEIGHT + 0.5f), HEIGHT);
    const char *name = camera->node_name[0] ? camera->node_name : camera->camera_name;
    return (MissedEye){.name = name, .camera = placed, .display_id = NO_ID};
}

static MissedEye *list_eyes(const Scene *scene, int *count, Arena *arena) {
    MissedEye *eyes = ARENA_NEW(arena, MissedEye, scene->camera_count + scene->display_count + 1);
    *count = 0;
    for (int i = 0; i < scene->camera_count; i++)
        eyes[(*count)++] = camera_eye(&scene->cameras[i], arena);
    if (!scene->camera_count) {
        SceneCamera framing = camera_frame_scene(scene);
        eyes[(*count)++] = camera_eye(&framing, arena);
        eyes[0].name = "";
    }
    for (int i = 0; i < scene->display_count; i++)
        eyes[(*count)++] = (MissedEye){.name = scene->displays[i].name, .display_id = i};
    return eyes;
}

/* Else there is nothing to miss, and surfaces' tables and the ray tracer need not be built. */
static bool has_smooth_parts(const Scene *scene) {
    for (int i = 0; i < scene->part_count; i++)
        if (missed_is_smooth(scene, &scene->materials[scene->parts[i].material_id])) return true;
    return false;
}

bool missed_in_scene(const Scene *scene, const MissedRun *run, Arena *arena, MissedLight *out,
                     Error *err) {
    Lights *lights;
    Bvh *bvh;
    int count;
    *out = (MissedLight){.count = 0};
    if (!has_smooth_parts(scene)) return true;
    if (!lights_build(scene, arena, &lights, err)) return false;
    if (!lights_has(lights, LIGHTS_SUN) && !lights_has(lights, LIGHTS_PUNCTUAL) &&
        !lights_has(lights, LIGHTS_EMITTERS))
        return true;
    if (!bvh_build(scene, run->threads, NULL, run->progress, &bvh, err)) return false;
    PathContext context = path_context_sketch(scene, bvh, lights, BOUNCES, arena);
    MissedEye *eyes = list_eyes(scene, &count, arena);
    *out = missed_light_find(&context, eyes, count, arena);
    bvh_destroy(bvh);
    return true;
}

/* ---- in words ---------------------------------------------------------------------------- */

const char *missed_kind(ChainLight from) {
    static const char *const KINDS[] = {
        [CHAIN_SUN] = "sun", [CHAIN_LAMP] = "lamp", [CHAIN_EMITTER] = "emitter"};
    return KINDS[from];
}

const char *missed_name(const Scene *scene, const MissedWay *way) {
    if (way->from == CHAIN_SUN) return "";
    return way->from == CHAIN_LAMP ? scene->lights[way->light_id].name
                                   : scene->parts[way->light_id].name;
}

/* `sun through solid "lens", then "visor"`. */
static const char *way_words(const Scene *scene, const MissedWay *way, const char *verb,
                             Arena *arena) {
    const char *light = missed_kind(way->from), *then = "";
    if (way->from != CHAIN_SUN)
        light = arena_format(arena, "%s \"%.60s\"", light, missed_name(scene, way));
    if (way->then_id == way->part_id) then = ", then by it again";
    else if (way->then_id != NO_ID)
        then = arena_format(arena, ", then \"%.60s\"", scene->parts[way->then_id].name);
    return arena_format(arena, "%s%s %s \"%.60s\"%s", light, verb,
                        way->is_solid ? "through solid" : "by mirror",
                        scene->parts[way->part_id].name, then);
}

static const char *where(const MissedEye *eye, double light, Arena *arena) {
    if (eye->camera)
        return arena_format(arena, "%.3g cd/m2 of the mean of what %s%s%s sees", light,
                            eye->name[0] ? "camera \"" : "the camera", eye->name,
                            eye->name[0] ? "\"" : "");
    return arena_format(arena, "%.3g lx on display \"%.60s\"", light, eye->name);
}

const char *missed_line(const Scene *scene, const MissedLight *missed, int line, Arena *arena) {
    const MissedPair *pair = &missed->pairs[line];
    if (line >= missed->count || line > LINES) return NULL;
    if (line == LINES)
        return arena_format(arena, "and %d more lights by mirrors or through solids",
                            missed->count - LINES);
    return arena_format(arena, "%s: this light is %s (about %s, %.2g %% of the light there)",
                        way_words(scene, &pair->way, " shines", arena),
                        pair->way.from == CHAIN_LAMP ? "not followed, it is missing"
                                                     : "left to chance, which hardly finds it",
                        where(&missed->eyes[pair->eye], pair->light, arena), 100 * pair->share);
}

const char *missed_words(const Scene *scene, const MissedLight *missed, Arena *arena) {
    const char *list = "";
    if (!(missed->all.share >= MISSED_SHARE)) return NULL;
    for (int i = 0; i < missed->count && i < LINES; i++)
        list = arena_format(arena, "%s%s%s", list, i ? "; " : ": ",
                            way_words(scene, &missed->pairs[i].way, "", arena));
    if (missed->count > LINES)
        list = arena_format(arena, "%s; and %d more", list, missed->count - LINES);
    return arena_format(arena, "about %.3g cd/m2, %.2g %% of the light with it%s",
                        missed->all.light, 100 * missed->all.share, list);
}
