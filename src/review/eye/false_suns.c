/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/false_suns.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/units.h"

#define SEED 0x66616c73u
#define BLOCK 10     /* rays along each side of a block: BLOCK_DEG by FALSE_SUN_STEP_DEG */
#define ENOUGH 5     /* images a ray, on the average, that are required of a block */
#define RAYS_MOST 32 /* rays a direction */

/* ---- rays -------------------------------------------------------------------------------- */

#define BLOCK_DEG 1
#define RINGS (FALSE_SUN_FIELD_DEG / BLOCK_DEG)

/* Rings about straight ahead, one block wide; each in as many blocks as are about square. */
static int blocks_of_ring(int ring) {
    double t = radians_from_degrees((ring + 0.5) * BLOCK_DEG);
    int count = (int)(360 * sin(t) / BLOCK_DEG);
    return count > 1 ? count : 1;
}

typedef struct ImageSearch {
    const Setup *setup;
    Vec3 eye;
    Frame ahead;  /* z: straight ahead */
    Arena *found; /* FalseSunRay by FalseSunRay, one a ring */
} ImageSearch;

/* One direction at work. */
typedef struct SearchRay {
    const ImageSearch *search;
    Arena *found;
    Vec3 seen;
    double sr; /* in the field of view */
    int count; /* images that were found */
} SearchRay;

static void add_image(void *user, int part_id, Vec3 direction, const float *share) {
    SearchRay *ray = user;
    float left = 0;
    FalseSunRay *found;
    for (int b = 0; b < LIGHT_BANDS; b++) left += share[b];
    if (!(left > 0)) return;
    found = ARENA_NEW(ray->found, FalseSunRay, 1);
    *found = (FalseSunRay){
        .sun = direction, .seen = ray->seen, .sr = (float)ray->sr, .part_id = part_id};
    memcpy(found->share, share, sizeof found->share);
    ray->count++;
}

/* Rays [first, end) of a direction. */
static void follow(SearchRay *ray, int first, int end) {
    const ImageSearch *search = ray->search;
    Vec3 target = vec3_add(search->eye, ray->seen);
    ProbeAim aim = {.context = &search->setup->context,
                    .eye = search->eye,
                    .targets = &target,
                    .target_count = 1,
                    .seed = SEED};
    ProbeImages images = {add_image, ray};
    PathStatistics statistics = {0};
    search->setup->tools.kernel->sample_images(&aim, first, end, &images, &statistics);
}

typedef struct SearchBlock {
    const ImageSearch *search;
    Arena *found;
    double low, high; /* angles from straight ahead, radians */
    double from, to;  /* about it */
} SearchBlock;

/* rays [first, end) of all directions of a block: images that were found. */
static int search_rays(const SearchBlock *block, int first, int end) {
    int count = 0;
    double step = (cos(block->low) - cos(block->high)) / BLOCK;
    for (int i = 0; i < BLOCK * BLOCK; i++) {
        double cosine = cos(block->low) - (i / BLOCK + 0.5) * step;
        double sine = sqrt(fmax(1 - cosine * cosine, 0));
        double about = block->from + (block->to - block->from) * (i % BLOCK + 0.5) / BLOCK;
        Vec3 d = vec3((float)(sine * cos(about)), (float)(sine * sin(about)), (float)cosine);
        SearchRay ray = {block->search, block->found,
                         vec3_normalize(frame_to_world(&block->search->ahead, d)),
                         step * (block->to - block->from) / BLOCK, 0};
        follow(&ray, (first * BLOCK * BLOCK) + i * (end - first),
               (first * BLOCK * BLOCK) + (i + 1) * (end - first));
        count += ray.count;
    }
    return count;
}

/* How many rays a direction of the block is worth, after one each that found so many images. */
static int rays_wanted(int found) {
    if (!found) return 1;
    double rays = ceil((double)ENOUGH * BLOCK * BLOCK / found);
    return (int)fmin(rays, RAYS_MOST);
}

static void search_block(const SearchBlock *block) {
    FalseSunRay *begin = ARENA_NEW(block->found, FalseSunRay, 0);
    int count = search_rays(block, 0, 1), rays = rays_wanted(count);
    if (rays > 1) count += search_rays(block, 1, rays);
    for (int i = 0; i < count; i++) begin[i].sr /= (float)rays;
}

static void search_ring(void *user, int ring, int worker) {
    (void)worker;
    const ImageSearch *search = user;
    int blocks = blocks_of_ring(ring);
    double wide = radians_from_degrees(BLOCK_DEG);
    for (int i = 0; i < blocks; i++) {
        SearchBlock block = {search,
                             &search->found[ring],
                             ring * wide,
                             (ring + 1) * wide,
                             2 * PI * i / blocks,
                             2 * PI * (i + 1) / blocks};
        search_block(&block);
    }
}

/* ---- in order ---------------------------------------------------------------------------- */

/* Cells of the sun's direction, as wide as the disc at least: rings about the vertical. */
#define CELL_DEG 1.0
#define CELL_ROWS 180
#define CELL_COLUMNS 360
_Static_assert(CELL_ROWS *CELL_COLUMNS == FALSE_SUN_CELLS, "cells of one degree");

static int row_of(Vec3 d) {
    double up = degrees_from_radians(asin(fmin(fmax((double)d.y, -1), 1))) + 90;
    return (int)fmin(up / CELL_DEG, CELL_ROWS - 1);
}

static int column_of(Vec3 d) {
    double about = degrees_from_radians(atan2((double)d.x, (double)d.z)) + 180;
    return (int)(about / CELL_DEG) % CELL_COLUMNS;
}

static int cell_of(Vec3 d) {
    return row_of(d) * CELL_COLUMNS + column_of(d);
}

static int count_of(const Arena *found) {
    return (int)((size_t)(found->next - found->begin) / sizeof(FalseSunRay));
}

/* Counting sort: within a cell in the order of the rings. */
static void put_in_order(const Arena *found, Arena *arena, FalseSunRays *out) {
    int *first = ARENA_NEW(arena, int, CELL_ROWS *CELL_COLUMNS + 1), total = 0;
    for (int ring = 0; ring < RINGS; ring++) {
        const FalseSunRay *list = (const FalseSunRay *)(const void *)found[ring].begin;
        for (int i = 0; i < count_of(&found[ring]); i++) first[cell_of(list[i].sun) + 1]++;
        total += count_of(&found[ring]);
    }
    for (int cell = 0; cell < CELL_ROWS * CELL_COLUMNS; cell++) first[cell + 1] += first[cell];
    FalseSunRay *ordered = ARENA_NEW(arena, FalseSunRay, total);
    Arena scratch = *arena;
    int *next = ARENA_NEW(&scratch, int, CELL_ROWS *CELL_COLUMNS);
    for (int ring = 0; ring < RINGS; ring++) {
        const FalseSunRay *list = (const FalseSunRay *)(const void *)found[ring].begin;
        for (int i = 0; i < count_of(&found[ring]); i++) {
            int cell = cell_of(list[i].sun);
            ordered[first[cell] + next[cell]++] = list[i];
        }
    }
    *out = (FalseSunRays){ordered, first, total};
}

#define RING_BYTES ((size_t)1 << 28) /* address space: what is not touched costs nothing */

void false_suns_search(const Setup *setup, Vec3 eye, Arena *arena, FalseSunRays *out) {
    Arena found[RINGS];
    ImageSearch search = {.setup = setup,
                          .eye = eye,
                          .found = found,
                          .ahead = frame_from_z(vec3_from_doubles(setup->request->forward))};
    for (int ring = 0; ring < RINGS; ring++) found[ring] = arena_reserve(RING_BYTES);
    parallel_for(setup->tools.threads, RINGS, search_ring, &search);
    put_in_order(found, arena, out);
    for (int ring = 0; ring < RINGS; ring++) arena_release(&found[ring]);
}

/* ---- suns of one spectrum ---------------------------------------------------------------- */

FalseSuns false_suns_of(const FalseSunRays *rays, const float bands[LIGHT_BANDS], Arena *arena) {
    FalseSun *list = ARENA_NEW(arena, FalseSun, rays->count);
    double all = 0;
    for (int b = 0; b < LIGHT_BANDS; b++) all += (double)bands[b];
    for (int i = 0; i < rays->count; i++) {
        const FalseSunRay *ray = &rays->list[i];
        double left = light_bands_sum(ray->share, bands) / all;
        list[i] = (FalseSun){ray->sun, ray->seen, (float)(left * (double)ray->sr), ray->part_id};
    }
    return (FalseSuns){list, rays->first, rays->count};
}

/* ---- one sun ----------------------------------------------------------------------------- */

#define MIRRORS_LISTED 16

typedef struct MirrorSums {
    int part_id;
    double sr;
    Vec3 seen; /* weighed by it */
} MirrorSums;

typedef struct ImageSums {
    MirrorSums mirror[MIRRORS_LISTED];
    int count;
    double sr;
} ImageSums;

static void add_false_sun(void *user, const FalseSun *image, double share) {
    ImageSums *sums = user;
    int i = 0;
    double sr = share * (double)image->sr;
    while (i < sums->count && sums->mirror[i].part_id != image->part_id) i++;
    sums->sr += sr;
    if (i == MIRRORS_LISTED) return;
    if (i == sums->count) sums->mirror[sums->count++] = (MirrorSums){.part_id = image->part_id};
    sums->mirror[i].sr += sr;
    sums->mirror[i].seen = vec3_add(sums->mirror[i].seen, vec3_scale(image->seen, (float)sr));
}

/* Rays stand for a step's width: those near the disc's edge lie in it by a part. */
static double share_in_disc(Vec3 ray, Vec3 towards) {
    Vec3 apart = vec3_sub(ray, towards);
    double degrees = degrees_from_radians((double)vec3_length(apart)); /* they are small */
    double inside = (SUN_MEAN_RADIUS_DEG - degrees) / FALSE_SUN_STEP_DEG + 0.5;
    return fmin(fmax(inside, 0), 1);
}

/* The visitor of one sun's images. */
typedef struct SunVisit {
    Vec3 towards;
    FalseSunVisitor *visit;
    void *user;
} SunVisit;

static void visit_row(const FalseSuns *suns, int row, int columns, const SunVisit *to) {
    int middle = column_of(to->towards), count = 2 * columns + 1;
    for (int k = 0; k < count && k < CELL_COLUMNS; k++) {
        int column = (middle - columns + k + CELL_COLUMNS) % CELL_COLUMNS;
        int cell = row * CELL_COLUMNS + column;
        for (int i = suns->first[cell]; i < suns->first[cell + 1]; i++) {
            double share = share_in_disc(suns->list[i].sun, to->towards);
            if (share > 0) to->visit(to->user, &suns->list[i], share);
        }
    }
}

/* How many columns to each side a disc may reach into; all, when it covers the vertical. */
static int columns_about(Vec3 towards) {
    double sine = sqrt((double)(towards.x * towards.x + towards.z * towards.z));
    double reach = sin(radians_from_degrees(SUN_MEAN_RADIUS_DEG + FALSE_SUN_STEP_DEG));
    if (sine <= reach) return CELL_COLUMNS / 2;
    return (int)ceil(degrees_from_radians(asin(reach / sine)) / CELL_DEG);
}

void false_suns_each(const FalseSuns *suns, Vec3 towards, FalseSunVisitor *visit, void *user) {
    SunVisit to = {towards, visit, user};
    int row = row_of(towards), columns = columns_about(towards);
    for (int r = row - 1; r <= row + 1; r++)
        if (r >= 0 && r < CELL_ROWS) visit_row(suns, r, columns, &to);
}

FalseSunSight false_suns_at(const FalseSuns *suns, Vec3 towards) {
    ImageSums sums = {.count = 0};
    int most = 0;
    false_suns_each(suns, towards, add_false_sun, &sums);
    if (!(sums.sr > 0)) return (FalseSunSight){0, NO_ID, vec3(0, 0, 0)};
    for (int i = 1; i < sums.count; i++)
        if (sums.mirror[i].sr > sums.mirror[most].sr) most = i;
    double radius = radians_from_degrees(SUN_MEAN_RADIUS_DEG);
    double disc = 2 * PI * (1 - cos(radius));
    return (FalseSunSight){sums.sr / disc, sums.mirror[most].part_id,
                           vec3_normalize(sums.mirror[most].seen)};
}

/* ---- searches that are kept -------------------------------------------------------------- */

#define BYTES ((size_t)1 << 34) /* address space: what is not touched costs nothing */

struct SunSearch {
    const char *identity; /* the scene's */
    Vec3 eye;
    FalseSunRays rays;
    const SunSearch *before;
};

SunSearches sun_searches_start(void) {
    return (SunSearches){arena_reserve(BYTES), NULL};
}

void sun_searches_end(SunSearches *searches) {
    arena_release(&searches->arena);
}

static bool is_of(const SunSearch *search, const Setup *setup, Vec3 eye) {
    return search->eye.x == eye.x && search->eye.y == eye.y && search->eye.z == eye.z &&
           !strcmp(search->identity, setup->identity);
}

const FalseSunRays *sun_searches_find(SunSearches *searches, const Setup *setup, Vec3 eye) {
    Arena *arena = &searches->arena;
    for (const SunSearch *search = searches->last; search; search = search->before)
        if (is_of(search, setup, eye)) return &search->rays;
    SunSearch *search = ARENA_NEW(arena, SunSearch, 1);
    *search = (SunSearch){.identity = arena_string(arena, setup->identity, strlen(setup->identity)),
                          .eye = eye,
                          .before = searches->last};
    false_suns_search(setup, eye, arena, &search->rays);
    searches->last = search;
    return &search->rays;
}
