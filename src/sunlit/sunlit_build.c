/* SPDX-License-Identifier: Apache-2.0 */
#include "sunlit/sunlit_build.h"

#include "base/mathf.h"
#include "base/parallel.h"
#include "base/sampler.h"
#include "base/sort.h"
#include "sunlit/sunlit_receivers.h"
#include "sunlit/sunlit_tree.h"

#define OUTLIERS 0.01f /* of the receivers, at either end, do not make the region wider */
#define MARGIN 0.05f   /* of its extent, that is added at either end */
#define FAR 4.0f       /* times the median distance from their median: beyond is outside */
#define TRIES 65536    /* rays through the pixels about which one landed, about; but */
#define LEAST_TRIES 1  /* through each at least, and at most */
#define MOST_TRIES 32
#define TESTED 4  /* one in so many pixels of a triangle is held against a receiver */
#define STEP 4.0f /* pixels by which a ray lands deeper beside an opening's edge */
#define OPENING_TRIES 8
#define BESIDE_TRIES 16
#define FINE_PIXELS 8192  /* at most, if pixels are cut */
#define SUN_BLUR 0.00465f /* half of the sun's disc, radians */
#define REACH_MOST 3.0f
#define SOFT 0.1f /* of its neighbours' mean power: the least of a pixel beside them */
#define LEAST_ALBEDO 0.05f
#define SCRATCH_BYTES ((size_t)1 << 30) /* address space */
#define SEED 0x73756e6cu

typedef struct SunlitWork {
    const SunlitTools *tools;
    SunlitMap map;
    float pitch;
    int columns, rows; /* of pixels in the region */
    int reach;         /* pixels about one that is lit, which are looked at as well */
    SunlitReceivers receivers;
    float *depth;         /* m, of all pixels, row by row: where a ray lands; */
    uint8_t *is_received; /* and whether a receiver sees that; */
    uint8_t *is_beside;   /* whether one sees a place of another ray through it */
    uint8_t *is_tried;    /* is_beside was evaluated */
    SunlitGrid grid;      /* of what is looked at more closely */
    int blocks;           /* pixels of the first grid that it has */
    int tries;            /* rays through each of its pixels */
} SunlitWork;

/* ---- the region -------------------------------------------------------------------------- */

typedef struct Extent {
    float low, high;
} Extent;

/* Of the receivers along an axis, but for outliers. */
static Extent extent_along(const SunlitReceivers *receivers, Vec3 axis, float *value) {
    long n = receivers->count, out = (long)(OUTLIERS * (float)n);
    for (long i = 0; i < n; i++) value[i] = vec3_dot(receivers->at[i].place, axis);
    sort_floats(value, n);
    float low = value[out], high = value[n - 1 - out];
    float margin = MARGIN * (high - low) + 1e-3f;
    return (Extent){low - margin, high + margin};
}

/* Leaves out those far from most. */
static void keep_near(SunlitReceivers *receivers, float *value) {
    float middle[3];
    int n = receivers->count, kept = 0;
    for (int k = 0; k < 3; k++) {
        Vec3 axis = vec3(k == 0, k == 1, k == 2);
        for (int i = 0; i < n; i++) value[i] = vec3_dot(receivers->at[i].place, axis);
        middle[k] = sort_ranked(value, n, n / 2);
    }
    Vec3 centre = vec3(middle[0], middle[1], middle[2]);
    for (int i = 0; i < n; i++) value[i] = vec3_length(vec3_sub(receivers->at[i].place, centre));
    float far = FAR * sort_ranked(value, n, n / 2);
    for (int i = 0; i < n; i++)
        if (vec3_length(vec3_sub(receivers->at[i].place, centre)) <= far)
            receivers->at[kept++] = receivers->at[i];
    receivers->count = kept;
}

static void place_region(SunlitWork *work, Arena scratch) {
    SunlitMap *map = &work->map;
    float *value = ARENA_NEW(&scratch, float, work->receivers.count);
    keep_near(&work->receivers, value);
    map->frame = frame_from_z(lights_sun_direction(work->tools->lights));
    Extent s = extent_along(&work->receivers, map->frame.x, value);
    Extent t = extent_along(&work->receivers, map->frame.y, value);
    Extent h = extent_along(&work->receivers, map->frame.z, value);
    map->side = max_f(s.high - s.low, t.high - t.low);
    map->above = map->below = (h.high - h.low) / 2;
    map->corner = frame_to_world(&map->frame, vec3(s.low, t.low, (h.low + h.high) / 2));
    work->pitch = map->side / SUNLIT_SIDE;
    work->columns = (int)min_f(ceilf((s.high - s.low) / work->pitch), SUNLIT_SIDE);
    work->rows = (int)min_f(ceilf((t.high - t.low) / work->pitch), SUNLIT_SIDE);
    float blur = SUN_BLUR * 2 * map->above / work->pitch; /* of edges, by the sun's disc */
    work->reach = 1 + (int)ceilf(min_f(blur, REACH_MOST));
}

/* ---- one ray ----------------------------------------------------------------------------- */

static bool let_pass(void *user, const Hit *hit) {
    (void)user, (void)hit;
    return true;
}

/* Where a ray landed. */
typedef struct Landing {
    Hit hit;
    TrianglePoint point;
    Vec3 sun;        /* unit, to the disc */
    Vec3 normal;     /* unit, to the sun's side */
    bool both_sides; /* light leaves by the other one, too */
} Landing;

/* The sampler's numbers in turn: direction on the disc, place in the pixel, a receiver's. */
#define RAY_NUMBERS 8
#define BESIDE_FIRST (1 + OPENING_TRIES + MOST_TRIES) /* of a pixel's rays */

static SunlitRay ray_through(int i, int j, float pitch, const float u[RAY_NUMBERS]) {
    return (SunlitRay){((float)i + u[4]) * pitch, ((float)j + u[5]) * pitch, 0};
}

/* Follows a ray of the sun; false: it does not end in the region. */
static bool land(const SunlitWork *work, SunlitRay ray, const float u[RAY_NUMBERS], Landing *out) {
    const SunlitTools *tools = work->tools;
    const Scene *scene = tools->scene;
    LightSample sun;
    LitPoint any = {work->map.corner, work->map.frame.z, true};
    float length;
    if (!lights_sample(tools->lights, LIGHTS_SUN, any, u, &sun)) return false;
    Vec3 entry = sunlit_map_entry(&work->map, &ray, sun.wi, &length);
    if (!sunlit_land(scene, tools->bvh, (Ray){entry, vec3_neg(sun.wi), 0, length}, &out->hit))
        return false;
    const Material *m = &scene->materials[scene_part(scene, out->hit.triangle)->material_id];
    out->point = triangle_point(scene, out->hit.triangle, out->hit.u, out->hit.v);
    out->sun = sun.wi;
    out->normal = vec3_dot(out->point.ng, sun.wi) < 0 ? vec3_neg(out->point.ng) : out->point.ng;
    out->both_sides = m->is_solid || material_sends_through(m);
    return true;
}

/* Does one receiver see the place, from a side by which the sun's light leaves, and the place
 * the sun? */
static bool is_received(const SunlitWork *work, const Landing *landing, float u) {
    const SunlitReceiver *to = &work->receivers.at[(int)(u * (float)work->receivers.count)];
    const Bvh *bvh = work->tools->bvh;
    Vec3 way = vec3_sub(to->place, landing->point.position);
    if (!landing->both_sides && !(vec3_dot(way, landing->normal) > 0)) return false;
    if (!(vec3_dot(way, to->ns) < 0)) return false;
    if (bvh_occluded(bvh, ray_to(to->place, &landing->point, way), let_pass, NULL)) return false;
    Ray up = {ray_start(&landing->point, landing->sun), landing->sun, 0, INFINITY};
    return !bvh_occluded(bvh, up, let_pass, NULL);
}

static void sample_ray(int i, int j, int k, float u[RAY_NUMBERS]) {
    Sampler sampler = sampler_start(SEED, i, j, (uint32_t)k);
    sampler_4d(&sampler, u);
    sampler_4d(&sampler, u + 4);
}

/* About what the surface sends on of the light, without its textures. */
static float albedo_of(const SunlitWork *work, const Landing *landing) {
    const Scene *scene = work->tools->scene;
    int id = scene_part(scene, landing->hit.triangle)->material_id;
    const Material *m = &scene->materials[id];
    float mean = (m->base_color[0] + m->base_color[1] + m->base_color[2]) / 3;
    return clampf(mean, LEAST_ALBEDO, 1);
}

/* ---- all rays ---------------------------------------------------------------------------- */

/* NO_DEPTH: it ends nowhere inside. */
#define NO_DEPTH (-INFINITY)

/* Side by side on one triangle what one is, the next is as a rule: few are tested. What comes
 * in by an opening lands on another than its rim. */
static void land_row(void *user, int j, int worker) {
    SunlitWork *work = user;
    uint32_t last = UINT32_MAX;
    (void)worker;
    for (int i = 0; i < work->columns; i++) {
        Landing landing;
        float u[RAY_NUMBERS];
        int n = j * work->columns + i;
        sample_ray(i, j, 0, u);
        bool lands = land(work, ray_through(i, j, work->pitch, u), u, &landing);
        bool is_next = lands && landing.hit.triangle == last && (i + j) % TESTED;
        work->is_received[n] =
            is_next ? work->is_received[n - 1] : lands && is_received(work, &landing, u[6]);
        last = lands ? landing.hit.triangle : UINT32_MAX;
        work->depth[n] = lands ? -vec3_dot(landing.point.position, work->map.frame.z) : NO_DEPTH;
    }
}

/* Does the ray land deeper than one beside it? What comes in by an opening does. */
static bool is_deep(const SunlitWork *work, int i, int j) {
    float own = work->depth[j * work->columns + i] - STEP * work->pitch;
    if (!(own > NO_DEPTH)) return false;
    return (i > 0 && work->depth[j * work->columns + i - 1] < own) ||
           (i + 1 < work->columns && work->depth[j * work->columns + i + 1] < own) ||
           (j > 0 && work->depth[(j - 1) * work->columns + i] < own) ||
           (j + 1 < work->rows && work->depth[(j + 1) * work->columns + i] < own);
}

/* Does a receiver see where one of some more rays through the pixel lands? */
static bool is_received_again(const SunlitWork *work, int i, int j, int first, int tries) {
    for (int k = first; k < first + tries; k++) {
        Landing landing;
        float u[RAY_NUMBERS];
        sample_ray(i, j, k, u);
        if (land(work, ray_through(i, j, work->pitch, u), u, &landing) &&
            is_received(work, &landing, u[6]))
            return true;
    }
    return false;
}

/* A small opening has few pixels: more receivers are tried. */
static void try_openings(void *user, int j, int worker) {
    SunlitWork *work = user;
    (void)worker;
    for (int i = 0; i < work->columns; i++) {
        uint8_t *seen = &work->is_received[j * work->columns + i];
        Landing landing;
        float u[RAY_NUMBERS];
        if (*seen || !is_deep(work, i, j)) continue;
        sample_ray(i, j, 1, u);
        if (!land(work, ray_through(i, j, work->pitch, u), u, &landing)) continue;
        for (int k = 1; k <= OPENING_TRIES && !*seen; k++) {
            *seen = is_received(work, &landing, u[6]);
            sample_ray(i, j, k + 1, u);
        }
    }
}

static bool is_received_about(const SunlitWork *work, int i, int j) {
    int reach = work->reach;
    for (int b = j > reach ? j - reach : 0; b <= j + reach && b < work->rows; b++)
        for (int a = i > reach ? i - reach : 0; a <= i + reach && a < work->columns; a++)
            if (work->is_received[b * work->columns + a]) return true;
    return false;
}

static float beam_lm(const SunlitWork *work) {
    LightSample sun;
    const float u[3] = {0.5f, 0.5f, 0.5f};
    LitPoint facing = {work->map.corner, work->map.frame.z, false};
    if (!lights_sample(work->tools->lights, LIGHTS_SUN, facing, u, &sun)) return 0;
    return (float)lights_sample_lx(work->tools->lights, facing, &sun, 0.5f) * work->pitch *
           work->pitch;
}

static void try_beside(void *user, int j, int worker) {
    SunlitWork *work = user;
    (void)worker;
    for (int i = 0; i < work->columns; i++) {
        int n = j * work->columns + i;
        if (work->is_tried[n] || work->is_received[n] || !is_received_about(work, i, j)) continue;
        work->is_tried[n] = 1;
        work->is_beside[n] = is_received_again(work, i, j, BESIDE_FIRST, BESIDE_TRIES);
    }
}

/* Takes over what try_beside found; false: nothing new. */
static bool take_beside(SunlitWork *work) {
    bool is_new = false;
    for (int n = 0; n < work->columns * work->rows; n++) {
        if (!work->is_beside[n] || work->is_received[n]) continue;
        work->is_received[n] = 1;
        is_new = true;
    }
    return is_new;
}

static int count_about(const SunlitWork *work) {
    int count = 0;
    for (int j = 0; j < work->rows; j++)
        for (int i = 0; i < work->columns; i++) count += is_received_about(work, i, j);
    return count;
}

/* Of a slit narrower than a pixel one ray in many comes in: where those that did lie far
 * apart, what is between them would be missed. So it is followed from pixel to pixel, as long
 * as few are lit. */
static void follow_openings(SunlitWork *work, int threads, Arena scratch) {
    size_t count = (size_t)work->columns * (size_t)work->rows;
    work->is_beside = ARENA_NEW(&scratch, uint8_t, count);
    work->is_tried = ARENA_NEW(&scratch, uint8_t, count);
    do {
        if (count_about(work) > FINE_PIXELS) return;
        parallel_for(threads, work->rows, try_beside, work);
    } while (take_beside(work));
}

/* ---- the plane, and finer pixels --------------------------------------------------------- */

/* The first of a pixel's neighbours at which a ray lands less deep; NO_DEPTH: none. */
static float rim_depth(const SunlitWork *work, int i, int j) {
    float own = work->depth[j * work->columns + i] - STEP * work->pitch;
    for (int k = 0; k < 4; k++) {
        int a = i + (k == 0) - (k == 1), b = j + (k == 2) - (k == 3);
        if (a < 0 || b < 0 || a >= work->columns || b >= work->rows) continue;
        float depth = work->depth[b * work->columns + a];
        if (depth > NO_DEPTH && depth < own) return depth;
    }
    return NO_DEPTH;
}

/* The sun's disc blurs edges by their distance from the plane: it goes to where most openings'
 * rims are. */
static void move_plane(SunlitWork *work, Arena scratch) {
    float *rim = ARENA_NEW(&scratch, float, work->columns * work->rows);
    long count = 0;
    for (int j = 0; j < work->rows; j++)
        for (int i = 0; i < work->columns; i++) {
            if (!work->is_received[j * work->columns + i]) continue;
            float depth = rim_depth(work, i, j);
            if (depth > NO_DEPTH) rim[count++] = depth;
        }
    if (!count) return;
    SunlitMap *map = &work->map;
    float up = -sort_ranked(rim, count, count / 2) - vec3_dot(map->corner, map->frame.z);
    up = clampf(up, -map->below, map->above);
    map->corner = vec3_along(map->corner, map->frame.z, up);
    map->above -= up;
    map->below += up;
}

/* Pixels about which a ray's place is seen become blocks of finer ones, as far as they are
 * few. */
static void list_blocks(SunlitWork *work, Arena *arena) {
    SunlitGrid *grid = &work->grid;
    grid->block_at = ARENA_NEW(arena, int32_t, SUNLIT_SIDE *SUNLIT_SIDE);
    for (int n = 0; n < SUNLIT_SIDE * SUNLIT_SIDE; n++) grid->block_at[n] = NO_ID;
    for (int j = 0; j < work->rows; j++)
        for (int i = 0; i < work->columns; i++)
            if (is_received_about(work, i, j)) grid->block_at[j * SUNLIT_SIDE + i] = work->blocks++;
    while (grid->fine < SUNLIT_FINE && work->blocks << 2 * (grid->fine + 1) <= FINE_PIXELS)
        grid->fine++;
    grid->pitch = work->pitch / (float)(1 << grid->fine);
    grid->pixels = ARENA_NEW(arena, SunlitPixel, work->blocks << 2 * grid->fine);
    int tries = work->blocks ? TRIES / (work->blocks << 2 * grid->fine) : 0;
    work->tries = tries < LEAST_TRIES ? LEAST_TRIES : tries > MOST_TRIES ? MOST_TRIES : tries;
}

/* Adds a landing that a receiver sees. */
static void add_landing(SunlitPixel *pixel, const Landing *landing, float power) {
    Vec3 p = landing->point.position;
    if (!pixel->landed++) pixel->low = pixel->high = p;
    pixel->low = vec3(min_f(pixel->low.x, p.x), min_f(pixel->low.y, p.y), min_f(pixel->low.z, p.z));
    pixel->high =
        vec3(max_f(pixel->high.x, p.x), max_f(pixel->high.y, p.y), max_f(pixel->high.z, p.z));
    pixel->normals = vec3_add(pixel->normals, landing->normal);
    pixel->both_sides |= landing->both_sides;
    pixel->power += power;
}

static void try_pixel(const SunlitWork *work, int i, int j, SunlitPixel *pixel) {
    for (int k = 1; k <= work->tries; k++) {
        Landing landing;
        float u[RAY_NUMBERS];
        sample_ray(i, j, k + OPENING_TRIES, u);
        if (land(work, ray_through(i, j, work->grid.pitch, u), u, &landing) &&
            is_received(work, &landing, u[6]))
            add_landing(pixel, &landing, albedo_of(work, &landing));
    }
    pixel->power /= (float)work->tries;
}

static void try_row(void *user, int j, int worker) {
    SunlitWork *work = user;
    (void)worker;
    int side = 1 << work->grid.fine;
    for (int i = 0; i < work->columns; i++) {
        if (work->grid.block_at[j * SUNLIT_SIDE + i] < 0) continue;
        for (int b = j * side; b < (j + 1) * side; b++)
            for (int a = i * side; a < (i + 1) * side; a++)
                try_pixel(work, a, b, sunlit_pixel(&work->grid, a, b));
    }
}

/* ---- powers ------------------------------------------------------------------------------ */

/* What a pixel's neighbours show. */
typedef struct About {
    SunlitPixel all;
    int count; /* pixels */
} About;

static void add_about(const SunlitPixel *pixel, About *about) {
    SunlitPixel *all = &about->all;
    about->count++;
    all->power += pixel->power;
    if (!pixel->landed) return;
    if (!all->landed) {
        all->low = pixel->low;
        all->high = pixel->high;
    }
    all->landed += pixel->landed;
    all->low = vec3(min_f(all->low.x, pixel->low.x), min_f(all->low.y, pixel->low.y),
                    min_f(all->low.z, pixel->low.z));
    all->high = vec3(max_f(all->high.x, pixel->high.x), max_f(all->high.y, pixel->high.y),
                     max_f(all->high.z, pixel->high.z));
    all->normals = vec3_add(all->normals, pixel->normals);
    all->both_sides |= pixel->both_sides;
}

#define ABOUT 2 /* pixels to either side */

static About look_about(const SunlitWork *work, int i, int j) {
    About about = {.count = 0};
    int side = SUNLIT_SIDE << work->grid.fine;
    for (int b = j - ABOUT; b <= j + ABOUT; b++)
        for (int a = i - ABOUT; a <= i + ABOUT; a++) {
            if (a < 0 || b < 0 || a >= side || b >= side) continue;
            const SunlitPixel *pixel = sunlit_pixel(&work->grid, a, b);
            if (pixel) add_about(pixel, &about);
        }
    return about;
}

/* A few tries show little of one pixel: half of its power is its neighbours' mean. One beside
 * lit ones, none of whose rays were seen to come in, may have some that do: it is where its
 * neighbours are. */
static SunlitPixel smoothed(const SunlitWork *work, int i, int j) {
    const SunlitPixel *pixel = sunlit_pixel(&work->grid, i, j);
    About about = look_about(work, i, j);
    float mean = about.all.power / (float)about.count;
    SunlitPixel out = pixel->landed ? *pixel : about.all;
    out.power = max_f(pixel->landed ? 0.5f * (pixel->power + mean) : 0, SOFT * mean);
    return out;
}

static SunlitGrid smooth_grid(const SunlitWork *work, Arena *arena) {
    SunlitGrid out = work->grid;
    int side = 1 << out.fine;
    out.pixels = ARENA_NEW(arena, SunlitPixel, work->blocks << 2 * out.fine);
    for (int j = 0; j < work->rows * side; j++)
        for (int i = 0; i < work->columns * side; i++) {
            if (out.block_at[(j >> out.fine) * SUNLIT_SIDE + (i >> out.fine)] < 0) i |= side - 1;
            else *sunlit_pixel(&out, i, j) = smoothed(work, i, j);
        }
    return out;
}

SunlitMap sunlit_build(const SunlitTools *tools, Arena *arena) {
    Arena scratch = arena_reserve(SCRATCH_BYTES);
    int threads = bvh_threads(tools->bvh);
    SunlitWork work = {.tools = tools};
    if (lights_has(tools->lights, LIGHTS_SUN)) work.receivers = sunlit_receivers(tools, &scratch);
    if (work.receivers.count) {
        place_region(&work, scratch);
        work.depth = ARENA_NEW(&scratch, float, work.columns *work.rows);
        work.is_received = ARENA_NEW(&scratch, uint8_t, work.columns *work.rows);
        parallel_for(threads, work.rows, land_row, &work);
        parallel_for(threads, work.rows, try_openings, &work);
        follow_openings(&work, threads, scratch);
        move_plane(&work, scratch);
        list_blocks(&work, &scratch);
        parallel_for(threads, work.rows, try_row, &work);
        SunlitGrid smooth = smooth_grid(&work, &scratch);
        work.map.nodes = sunlit_tree(&smooth, arena);
        if (!work.map.nodes) work.map.unseen_lm = beam_lm(&work);
    }
    arena_release(&scratch);
    return work.map;
}
