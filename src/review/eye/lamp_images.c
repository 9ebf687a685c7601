/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/lamp_images.h"

#include <math.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "base/sampler.h"
#include "base/units.h"
#include "panel/query/panel_emission.h"
#include "spectrum/photometry.h"

/* ---- x ----------------------------------------------------------------------------------- */

static double part_luminance(const Scene *scene, const Part *part)
{
    static const float WHITE[3] = {255, 255, 255};
    const Material *material = &scene->materials[part->material_id];
    if (material->display_id == NO_ID)
        return (double)luminance_from_rgb(material->unlit ? material->base_color
                                                          : material->emissive_cd_m2);
    const Display *display = &scene->displays[material->display_id];
    return (double)(panel_mean_luminance(display->panel, WHITE) * display->level);
}

static Lamp lamp_of_triangle(const Scene *scene, uint32_t triangle, double cd_m2)
{
    const uint32_t *vertex = scene->triangles[triangle].vertex;
    Lamp            lamp = {.middle = vec3(0, 0, 0), .cd_m2 = cd_m2};
    for (int k = 0; k < 3; k++)
        lamp.middle = vec3_along(lamp.middle, scene->positions[vertex[k]], 1 / 3.0f);
    for (int k = 0; k < 3; k++) {
        Vec3 off = vec3_sub(scene->positions[vertex[k]], lamp.middle);
        lamp.radius = fmax(lamp.radius, (double)vec3_length(off));
    }
    return lamp;
}

/* cd_m2 0: the part is no lamp. */
static Lamp lamp_of_part(const Scene *scene, int part_id)
{
    const Part *part = &scene->parts[part_id];
    Lamp        lamp = {.cd_m2 = part_luminance(scene, part)};
    Vec3        low = vec3(INFINITY, INFINITY, INFINITY), high = vec3_neg(low);
    uint32_t    corners = 3 * part->triangle_count;
    for (uint32_t i = 0; i < corners; i++) {
        Vec3 p = scene_corner(scene, part->first_triangle + i / 3, (int)(i % 3));
        low = vec3(fminf(low.x, p.x), fminf(low.y, p.y), fminf(low.z, p.z));
        high = vec3(fmaxf(high.x, p.x), fmaxf(high.y, p.y), fmaxf(high.z, p.z));
    }
    if (!corners) return (Lamp){.cd_m2 = 0};
    lamp.middle = vec3_scale(vec3_add(low, high), 0.5f);
    lamp.radius = 0.5 * (double)vec3_length(vec3_sub(high, low));
    return lamp;
}

static int brightest_first(const void *a, const void *b)
{
    double x = ((const Lamp *)a)->cd_m2, y = ((const Lamp *)b)->cd_m2;
    return (x < y) - (x > y);
}

UnmetLamps lamps_unmet(const Setup *setup, const bool *met, Arena *arena)
{
    const Scene *scene = setup->scene;
    int          count = 0;
    for (int i = 0; i < scene->part_count; i++)
        if (!met[i] && part_luminance(scene, &scene->parts[i]) > 0)
            count += (int)scene->parts[i].triangle_count;
    UnmetLamps out = {.list = ARENA_NEW(arena, Lamp, count)};
    for (int i = 0; i < scene->part_count; i++) {
        const Part *part = &scene->parts[i];
        double      cd_m2 = met[i] ? 0 : part_luminance(scene, part);
        for (uint32_t t = 0; cd_m2 > 0 && t < part->triangle_count; t++)
            out.list[out.count++] = lamp_of_triangle(scene, part->first_triangle + t, cd_m2);
    }
    if (out.count) qsort(out.list, (size_t)out.count, sizeof *out.list, brightest_first);
    return out;
}

/* Is the lamp's ball within the angle? Most are far off: asin x is at most PI / 2 x, and a
 * cosine falls by no more than its angle grows. */
static bool may_be_seen(const Lamp *lamp, Ray ray, double half, double cos_half)
{
    Vec3   to = vec3_sub(lamp->middle, ray.origin);
    double distance = (double)vec3_length(to);
    if (distance <= lamp->radius) return true;
    double cosine = (double)vec3_dot(to, ray.direction) / distance;
    if (cosine < cos_half - 0.5 * PI * lamp->radius / distance) return false;
    return acos(fmin(fmax(cosine, -1), 1)) <= half + asin(lamp->radius / distance);
}

double lamps_brightest(const UnmetLamps *lamps, Ray ray, double half)
{
    double cos_half = cos(half);
    for (int i = 0; i < lamps->count; i++)
        if (may_be_seen(&lamps->list[i], ray, half, cos_half)) return lamps->list[i].cd_m2;
    return 0;
}

#define PER_SIDE 2    /* cells along each side of one that is cut */
#define LEVELS 13     /* pictures, each finer than the one before: at last 0.8 arc seconds */
#define ENOUGH 200    /* cells that show an image: its rim makes an error of 1.5 % */
#define HIDDEN 8      /* times as many where it may lie: the rest of it is hidden */
#define SLIGHT 0.01   /* of all images, by the square of their luminance */
#define CELLS_MOST (1 << 20)
#define CELLS_A_CHUNK 256
#define KEPT 4        /* lamps that a ray finds, mirrors that it meets */
#define BOUNCES 8
#define LOOKS_FEW 2   /* rays that agree are sure, */
#define LOOKS_NONE 8  /* so many that find nothing, too; */
#define LOOKS_MANY 32 /* others are a matter of chance: their mean is the image */
#define ALIKE 0.1
#define NO_MIRROR (-1)

/* ---- lamps ------------------------------------------------------------------------------- */

static Lamp *pieces_of(const Scene *scene, const Part *part, double cd_m2, Arena *arena)
{
    Lamp *out = ARENA_NEW(arena, Lamp, part->triangle_count);
    for (uint32_t t = 0; t < part->triangle_count; t++)
        out[t] = lamp_of_triangle(scene, part->first_triangle + t, cd_m2);
    return out;
}

BrightLamps bright_lamps(const Scene *scene, double least_cd_m2, Arena *arena)
{
    int         parts = scene->part_count;
    BrightLamps out = {.scene = scene, .list = ARENA_NEW(arena, Lamp, parts),
                       .pieces = ARENA_NEW(arena, Lamp *, parts),
                       .part_ids = ARENA_NEW(arena, int, parts),
                       .is_one = ARENA_NEW(arena, bool, parts),
                       .cd_m2 = ARENA_NEW(arena, double, parts)};
    for (int i = 0; i < parts; i++) {
        Lamp lamp = lamp_of_part(scene, i);
        out.is_one[i] = lamp.cd_m2 > least_cd_m2;
        out.cd_m2[i] = lamp.cd_m2;
        if (!out.is_one[i]) continue;
        out.part_ids[out.count] = i;
        out.pieces[out.count] = pieces_of(scene, &scene->parts[i], lamp.cd_m2, arena);
        out.list[out.count++] = lamp;
    }
    return out;
}

/* No chance chose the way. */
static bool is_sure(const Scene *scene, const PathHistory *history)
{
    if (!history->count || history->count > PATH_STEPS_MAX) return false;
    for (int i = 0; i < history->count; i++) {
        const Part     *part = &scene->parts[history->step[i].part_id];
        const Material *material = &scene->materials[part->material_id];
        if (history->step[i].event != PATH_REFLECTS) return false;
        if (material->transmission > 0 && (i || material->is_solid)) return false;
    }
    return true;
}

bool bright_lamps_tell(const BrightLamps *lamps, const PathHistory *history)
{
    return history->source == LIGHTS_EMITTERS && lamps->is_one[history->source_id] &&
           is_sure(lamps->scene, history);
}

/* ---- a ray ------------------------------------------------------------------------------- */

typedef struct LampFound {
    int   mirror_id, lamp_id; /* parts: the first mirror's, the lamp's */
    float cd_m2;              /* 0: it may be there */
} LampFound;

/* What lies behind a mirror is seen along it. */
typedef struct MirroredRay {
    Ray ray;
    int mirror_id, depth; /* of the first mirror, how many there are */
} MirroredRay;

typedef struct LampRay {
    const BrightLamps *lamps;
    LampFound   found[KEPT];
    MirroredRay mirrored[KEPT];
    int         found_count, mirrored_count;
} LampRay;

static LampFound *found_of(LampFound *list, int *count, int mirror_id, int lamp_id)
{
    for (int i = 0; i < *count; i++)
        if (list[i].mirror_id == mirror_id && list[i].lamp_id == lamp_id) return &list[i];
    if (*count == KEPT) return NULL;
    list[*count] = (LampFound){mirror_id, lamp_id, 0};
    return &list[(*count)++];
}

static void on_light(void *user, const PathHistory *history, const float xyz[3])
{
    LampRay *ray = user;
    if (!bright_lamps_tell(ray->lamps, history)) return;
    LampFound *found = found_of(ray->found, &ray->found_count, history->step[0].part_id,
                                history->source_id);
    if (found) found->cd_m2 += xyz[1];
}

static void on_mirror(void *user, const PathHistory *history, Vec3 towards, float share)
{
    LampRay *ray = user;
    if (ray->mirrored_count == KEPT || !(share > 0)) return;
    if (!is_sure(ray->lamps->scene, history)) return;
    Vec3 from = history->step[history->count - 1].position;
    ray->mirrored[ray->mirrored_count++] = (MirroredRay){
        {from, towards, 0, INFINITY}, history->step[0].part_id, history->count};
}

typedef struct LampSearch {
    const LampImagesArgs *args;
    PathContext context;
    int         count; /* cells over 180 degrees */
    struct LampCell *cells;
    int         cell_count;
} LampSearch;

static LampRay look(const LampSearch *search, Vec3 towards, uint32_t seed, int index)
{
    LampRay        ray = {.lamps = search->args->lamps};
    Vec3           eye = search->args->head->eye, target = vec3_add(eye, towards);
    ProbeAim       aim = {.context = &search->context, .eye = eye, .targets = &target,
                          .target_count = 1, .seed = seed};
    PathListener   listener = {.on_light = on_light, .on_mirror = on_mirror, .user = &ray,
                               .reach = PATH_BY_SURE_MIRRORS};
    PathStatistics statistics = {0};
    search->args->setup->tools.kernel->trace(&aim, index, index + 1, &listener, &statistics);
    return ray;
}

/* ---- a cell ------------------------------------------------------------------------------ */

/* found: what it shows, or may have somewhere (cd_m2 0). */
typedef struct LampCell {
    int       x, y;
    int       mirror_id; /* part, which both of its rays meet; NO_MIRROR: its rim, or none */
    Vec3      towards;
    float     sr; /* 0: it does not look ahead */
    LampFound found[KEPT];
    bool      touches[KEPT]; /* its ray meets the ball of a triangle of the lamp */
    int       found_count;
} LampCell;

/* How far beside the ray a cell sees, m, where the ray starts and per metre. */
typedef struct RayWidth {
    double start, grows;
} RayWidth;

static bool is_within(const Lamp *lamp, Ray ray, RayWidth width)
{
    Vec3   to = vec3_sub(lamp->middle, ray.origin);
    double t = fmax((double)vec3_dot(to, ray.direction), 0);
    double beside = (double)vec3_length(vec3_along(to, ray.direction, -(float)t));
    return beside <= lamp->radius + width.start + t * width.grows;
}

/* Does it meet a triangle's ball, of those of a part? */
static bool meets_part(const BrightLamps *lamps, int i, Ray ray, RayWidth width)
{
    const Part *part = &lamps->scene->parts[lamps->part_ids[i]];
    if (!is_within(&lamps->list[i], ray, width)) return false;
    for (uint32_t t = 0; t < part->triangle_count; t++)
        if (is_within(&lamps->pieces[i][t], ray, width)) return true;
    return false;
}

/* A second ray, at half a cell's width to the side and up, shows how mirrors spread a cell; its
 * far corner lies at most twice as far off. Mirrors that the other ray does not meet are taken
 * for flat. */
#define CORNER 2.5

static RayWidth width_of(const LampSearch *search, const MirroredRay *ray, const LampRay *other,
                         bool *is_met)
{
    double step = PI / search->count, apart = step / sqrt(2.0);
    Vec3   eye = search->args->head->eye;
    double start = apart * (double)vec3_length(vec3_sub(ray->ray.origin, eye)), grows = apart;
    *is_met = false;
    for (int i = 0; i < other->mirrored_count; i++) {
        const MirroredRay *m = &other->mirrored[i];
        if (m->mirror_id != ray->mirror_id || m->depth != ray->depth) continue;
        *is_met = true;
        start = (double)vec3_length(vec3_sub(m->ray.origin, ray->ray.origin));
        grows = (double)vec3_length(vec3_sub(m->ray.direction, ray->ray.direction));
    }
    return (RayWidth){CORNER * start, CORNER * grows};
}

/* Notes lamps that the cell may see. */
static void note_near(const LampSearch *search, const LampRay *ray, const LampRay *other,
                      LampCell *cell)
{
    const BrightLamps *lamps = search->args->lamps;
    cell->mirror_id = ray->mirrored[0].mirror_id;
    for (int k = 0; k < ray->mirrored_count; k++) {
        const MirroredRay *mirrored = &ray->mirrored[k];
        bool               is_met;
        RayWidth           width = width_of(search, mirrored, other, &is_met);
        if (!is_met || mirrored->mirror_id != cell->mirror_id) cell->mirror_id = NO_MIRROR;
        for (int i = 0; i < lamps->count; i++) {
            if (!meets_part(lamps, i, mirrored->ray, width)) continue;
            LampFound *found = found_of(cell->found, &cell->found_count, mirrored->mirror_id,
                                        lamps->part_ids[i]);
            if (found && meets_part(lamps, i, mirrored->ray, (RayWidth){0, 0}))
                cell->touches[found - cell->found] = true;
        }
    }
}

static void add_look(LampCell *cell, const LampRay *ray)
{
    for (int i = 0; i < ray->found_count; i++) {
        LampFound *to = found_of(cell->found, &cell->found_count, ray->found[i].mirror_id,
                                 ray->found[i].lamp_id);
        if (to) to->cd_m2 += ray->found[i].cd_m2;
    }
}

static bool are_alike(const LampRay *a, const LampRay *b)
{
    float x = 0, y = 0;
    for (int i = 0; i < a->found_count; i++) x += a->found[i].cd_m2;
    for (int i = 0; i < b->found_count; i++) y += b->found[i].cd_m2;
    return x > 0 && y > 0 && fabsf(x - y) <= (float)ALIKE * fmaxf(x, y);
}

/* The mean of rays towards where a lamp lies. */
static void look_well(const LampSearch *search, const LampRay *first, uint32_t seed,
                      LampCell *cell)
{
    int looks = LOOKS_MANY, found = first->found_count, i = 1;
    add_look(cell, first);
    for (; i < looks; i++) {
        LampRay ray = look(search, cell->towards, seed, i);
        add_look(cell, &ray);
        found += ray.found_count;
        if (i + 1 == LOOKS_FEW && are_alike(first, &ray)) looks = LOOKS_FEW;
        if (i + 1 == LOOKS_NONE && !found) looks = LOOKS_NONE;
    }
    for (i = 0; i < cell->found_count; i++) cell->found[i].cd_m2 /= (float)looks;
}

static bool touches_any(const LampCell *cell)
{
    bool touches = false;
    for (int i = 0; i < cell->found_count; i++) touches |= cell->touches[i];
    return touches;
}

/* Somewhere in its place of the raster, and what is seen there. */
static void look_at_cell(const LampSearch *search, LampCell *cell)
{
    double   step = PI / search->count;
    uint32_t seed = hash_combine(hash_combine(hash_u32(search->args->seed), (uint32_t)cell->x),
                                 (uint32_t)cell->y);
    cell->mirror_id = NO_MIRROR;
    double   u = seed * 0x1p-32, v = hash_u32(seed) * 0x1p-32;
    double   x = (cell->x + u) * step - PI / 2, y = PI / 2 - (cell->y + v) * step;
    double   t = hypot(x, y);
    if (!(t < PI / 2)) return;
    cell->sr = (float)(step * step * (t > 0 ? sin(t) / t : 1));
    cell->towards = glare_head_direction(search->args->head, x, y);
    LampRay ray = look(search, cell->towards, seed, 0);
    if (!ray.mirrored_count) return;
    Vec3    beside = glare_head_direction(search->args->head, x + step / 2, y + step / 2);
    LampRay other = look(search, beside, seed, 0);
    note_near(search, &ray, &other, cell);
    if (ray.found_count || touches_any(cell)) look_well(search, &ray, seed, cell);
}

static void look_chunk(void *user, int item, int worker)
{
    (void)worker;
    const LampSearch *search = user;
    int first = item * CELLS_A_CHUNK;
    for (int i = first; i < first + CELLS_A_CHUNK && i < search->cell_count; i++)
        look_at_cell(search, &search->cells[i]);
}

/* ---- pictures, ever finer ---------------------------------------------------------------- */

/* A lamp and the first mirror that shows it, over all cells of a picture. */
typedef struct LampPair {
    int    mirror_id, lamp_id;
    long   shown, touched;
    double glare;   /* the squares of the luminance of its cells, times their solid angles */
    bool   is_well; /* known well enough */
} LampPair;

typedef struct LampPairs {
    LampPair *list;
    int       count;
    double    told; /* glare of cells that are not looked at again */
} LampPairs;

static int pair_of(LampPairs *pairs, const LampFound *found, Arena *arena)
{
    for (int i = 0; i < pairs->count; i++)
        if (pairs->list[i].mirror_id == found->mirror_id &&
            pairs->list[i].lamp_id == found->lamp_id)
            return i;
    pairs->list = ARENA_GROW(arena, LampPair, pairs->list, pairs->count, pairs->count + 1);
    pairs->list[pairs->count] = (LampPair){found->mirror_id, found->lamp_id, 0, 0, 0, false};
    return pairs->count++;
}

static double glare_of(const LampFound *found, const LampCell *cell)
{
    return (double)found->cd_m2 * (double)found->cd_m2 * (double)cell->sr;
}

static void add_cell(LampPairs *pairs, const LampCell *cell, Arena *arena)
{
    for (int k = 0; k < cell->found_count; k++) {
        int       i = pair_of(pairs, &cell->found[k], arena);
        LampPair *pair = &pairs->list[i];
        pair->shown += cell->found[k].cd_m2 > 0;
        pair->touched += cell->touches[k];
        pair->glare += glare_of(&cell->found[k], cell);
    }
}

/* A pair is known well by many cells, or where the error of few is slight beside all images:
 * that of a count of n is its root, of none that is seen a cell of the lamp itself. */
static bool is_well(const LampSearch *search, const LampPair *pair, double all)
{
    double step = PI / search->count, cd_m2 = search->args->lamps->cd_m2[pair->lamp_id];
    double error = pair->shown ? pair->glare / sqrt((double)pair->shown)
                               : cd_m2 * cd_m2 * step * step;
    return pair->shown >= ENOUGH || pair->touched >= ENOUGH * HIDDEN || error <= SLIGHT * all;
}

static void count_pairs(const LampSearch *search, LampPairs *pairs, Arena *arena)
{
    double all = pairs->told;
    for (int i = 0; i < pairs->count; i++) {
        LampPair *pair = &pairs->list[i];
        pair->shown = pair->touched = 0;
        pair->glare = 0;
    }
    for (int i = 0; i < search->cell_count; i++) add_cell(pairs, &search->cells[i], arena);
    for (int i = 0; i < pairs->count; i++) all += pairs->list[i].glare;
    for (int i = 0; i < pairs->count; i++)
        pairs->list[i].is_well = is_well(search, &pairs->list[i], all);
}

/* Where the cell at x, y stands in the list: by a table of at least twice as many entries,
 * whose index is a hash of the place. */
typedef struct CellTable {
    int     *at; /* in the list, and one more; 0: none */
    uint32_t mask;
} CellTable;

static uint32_t entry_of(const CellTable *table, const LampCell *cells, int x, int y)
{
    uint32_t i = hash_combine(hash_u32((uint32_t)x), (uint32_t)y) & table->mask;
    while (table->at[i] && (cells[table->at[i] - 1].x != x || cells[table->at[i] - 1].y != y))
        i = (i + 1) & table->mask;
    return i;
}

static CellTable table_of(const LampSearch *search, Arena *arena)
{
    uint32_t size = 2;
    while (size < 2 * (uint32_t)search->cell_count) size *= 2;
    CellTable table = {ARENA_NEW(arena, int, size), size - 1};
    for (int i = 0; i < search->cell_count; i++) {
        const LampCell *cell = &search->cells[i];
        table.at[entry_of(&table, search->cells, cell->x, cell->y)] = i + 1;
    }
    return table;
}

/* A lamp in a mirror is looked for in the cell and in those of its neighbours that may hold
 * the mirror's rim, which their rays have just missed: else it would be cut away. A neighbour
 * whose rays meet the mirror knows for itself. */
static void cut_near(const LampSearch *search, const CellTable *table, const LampCell *cell,
                     int mirror_id, bool *out)
{
    for (int k = 0; k < 9; k++) {
        int x = cell->x + k % 3 - 1, y = cell->y + k / 3 - 1;
        int i = table->at[entry_of(table, search->cells, x, y)] - 1;
        if (i >= 0 && (k == 4 || search->cells[i].mirror_id != mirror_id)) out[i] = true;
    }
}

static bool *cut_of(const LampSearch *search, LampPairs *pairs, Arena *of_pairs, Arena *arena)
{
    CellTable table = table_of(search, arena);
    bool     *out = ARENA_NEW(arena, bool, search->cell_count);
    for (int i = 0; i < search->cell_count; i++) {
        const LampCell *cell = &search->cells[i];
        for (int k = 0; k < cell->found_count; k++)
            if (!pairs->list[pair_of(pairs, &cell->found[k], of_pairs)].is_well)
                cut_near(search, &table, cell, cell->found[k].mirror_id, out);
    }
    return out;
}

static void tell(const LampCell *cell, LampPairs *pairs, LampImages *out, Arena *arenas[2])
{
    for (int k = 0; k < cell->found_count; k++) {
        const LampFound *found = &cell->found[k];
        if (!(found->cd_m2 > 0)) continue;
        pairs->told += glare_of(found, cell);
        out->list = ARENA_GROW(arenas[0], LampImage, out->list, out->count, out->count + 1);
        out->list[out->count++] = (LampImage){
            pair_of(pairs, found, arenas[1]), cell->towards, (double)found->cd_m2,
            (double)cell->sr, cell->x, cell->y};
    }
}

static void cut(const LampCell *cell, LampCell *to)
{
    for (int i = 0; i < PER_SIDE * PER_SIDE; i++)
        to[i] = (LampCell){.x = cell->x * PER_SIDE + i % PER_SIDE,
                           .y = cell->y * PER_SIDE + i / PER_SIDE};
}

/* Reports what is known well, and leaves the cells of the next picture. */
static void go_finer(LampSearch *search, bool is_last, LampPairs *pairs, LampImages *out,
                     Arena *arenas[3])
{
    int       count = 0, pieces = PER_SIDE * PER_SIDE;
    LampCell *cells = search->cells, *finer = NULL;
    bool     *is_cut_up = cut_of(search, pairs, arenas[1], arenas[2]);
    for (int i = 0; i < search->cell_count; i++) count += is_cut_up[i] ? pieces : 0;
    bool is_end = is_last || count > CELLS_MOST;
    if (!is_end) finer = ARENA_NEW(arenas[2], LampCell, count);
    count = 0;
    for (int i = 0; i < search->cell_count; i++) {
        if (is_end || !is_cut_up[i]) {
            tell(&cells[i], pairs, out, arenas);
            continue;
        }
        cut(&cells[i], finer + count);
        count += pieces;
    }
    search->cells = finer;
    search->cell_count = is_end ? 0 : count;
    search->count *= PER_SIDE;
}

static void set_first(LampSearch *search, Arena *arena)
{
    int side = search->args->pixels;
    search->count = side;
    search->cell_count = side * side;
    search->cells = ARENA_NEW(arena, LampCell, search->cell_count);
    for (int i = 0; i < search->cell_count; i++)
        search->cells[i] = (LampCell){.x = i % side, .y = i / side};
}

#define BYTES ((size_t)1 << 34) /* of address space */

LampImages lamp_images_find(const LampImagesArgs *args, Arena *arena)
{
    LampImages out = {0};
    LampPairs  pairs = {0};
    LampSearch search = {.args = args, .context = args->setup->context};
    if (!args->lamps->count) return out;
    Arena  of_pairs = arena_reserve(BYTES), of_cells = arena_reserve(BYTES);
    Arena *arenas[3] = {arena, &of_pairs, &of_cells};
    search.context.max_bounces = BOUNCES;
    search.context.guide = NULL;
    set_first(&search, &of_cells);
    for (int level = 0; level < LEVELS && search.cell_count; level++) {
        int chunks = (search.cell_count + CELLS_A_CHUNK - 1) / CELLS_A_CHUNK;
        parallel_for(args->setup->tools.threads, chunks, look_chunk, &search);
        count_pairs(&search, &pairs, &of_pairs);
        go_finer(&search, level == LEVELS - 1, &pairs, &out, arenas);
    }
    out.pairs = pairs.count;
    arena_release(&of_pairs);
    arena_release(&of_cells);
    return out;
}
