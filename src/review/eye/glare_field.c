/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/glare_field.h"

#include <math.h>

#include "base/parallel.h"
#include "base/sampler.h"
#include "base/units.h"

#define SIDE 8 /* rays along each side of a pixel that is looked at again */
#define RAYS (SIDE * SIDE)
#define BOUNCES 8 /* in clear solids */
#define AGAIN_SEED 0x6167u
#define PIXELS_A_CHUNK 256
#define FIELD_BYTES ((size_t)1 << 32) /* of address space */
_Static_assert(SIDE % GLARE_DEAL == 0, "as many in each group");

/* ---- what a ray shows -------------------------------------------------------------------- */

static bool comes_straight(const PathHistory *history, int steps)
{
    if (steps > path_steps_kept(history)) return false;
    for (int i = 0; i < steps; i++)
        if (history->step[i].event != PATH_TRANSMITS) return false;
    return true;
}

static bool is_sky(const PathHistory *history)
{
    return history->source == LIGHTS_SKY && comes_straight(history, history->count);
}

static bool is_sunlit(const PathHistory *history)
{
    int last = history->count - 1;
    return history->source == LIGHTS_SUN && last >= 0 && comes_straight(history, last) &&
           last < PATH_STEPS_MAX && history->step[last].event == PATH_SCATTERS;
}

bool glare_field_tells(const PathHistory *history)
{
    return is_sky(history) || is_sunlit(history);
}

/* ---- rays -------------------------------------------------------------------------------- */

typedef enum FieldClass { FIELD_DIM, FIELD_SOURCE, FIELD_PEAK, FIELD_CLASSES } FieldClass;

/* One ray: what it showed. sr 0: it does not look ahead. */
typedef struct FieldRay {
    float sky, lit; /* cd m^-2 */
    float sr;
    Vec3  towards;  /* unit, world */
} FieldRay;

typedef struct LookedAt {
    const GlareFieldArgs *args;
    ProbeAim  aim;
    PathContext context;
    PathReach   reach;
    FieldRay *rays;    /* [pixel] */
    int      *again;   /* [pixel] where its rays lie among the others', by RAYS; NO_ID: none */
    int      *pixels;  /* that are looked at again */
    int       again_count, seen_again; /* how many, and of these how many were */
    FieldRay *others;
    uint8_t  *classes; /* [pixel] bits */
} LookedAt;

/* Somewhere in cell `cell` of a raster of `count` by `count` over the field. */
static FieldRay place_of(const GlareFieldArgs *args, int count, int cell, uint32_t seed)
{
    double   step = PI / count;
    uint32_t hash = hash_combine(hash_u32(args->seed + seed), (uint32_t)cell);
    double   u = hash * 0x1p-32, v = hash_u32(hash) * 0x1p-32;
    double   x = (cell % count + u) * step - PI / 2, y = PI / 2 - (cell / count + v) * step;
    double   t = hypot(x, y);
    FieldRay ray = {0};
    if (!(t < PI / 2)) return ray;
    ray.sr = (float)(step * step * (t > 0 ? sin(t) / t : 1));
    ray.towards = glare_head_direction(&args->rest->head, x, y);
    return ray;
}

static void add_told(void *user, const PathHistory *history, const float xyz[3])
{
    FieldRay *ray = user;
    if (is_sky(history)) ray->sky += xyz[1];
    else if (is_sunlit(history)) ray->lit += xyz[1];
}

/* seed: of the pass. index: of the ray among all that this pass may have. */
static FieldRay look(const LookedAt *field, const FieldRay *place, uint32_t seed, int index)
{
    FieldRay ray = *place;
    if (!(ray.sr > 0)) return ray;
    PathStatistics statistics = {0};
    Vec3           target = vec3_add(field->aim.eye, ray.towards);
    ProbeAim       aim = field->aim;
    PathListener   listener = {.on_light = add_told, .user = &ray, .reach = field->reach};
    aim.targets = &target;
    aim.target_count = 1;
    aim.seed += seed;
    field->args->setup->tools.kernel->trace(&aim, index, index + 1, &listener, &statistics);
    if ((double)ray.sky > field->args->peak_cd_m2) ray.sky = 0;
    return ray;
}

static void look_chunk(void *user, int item, int worker)
{
    (void)worker;
    const LookedAt *field = user;
    int count = field->args->pixels, first = item * PIXELS_A_CHUNK;
    for (int i = first; i < first + PIXELS_A_CHUNK && i < count * count; i++) {
        FieldRay place = place_of(field->args, count, i, 0);
        field->rays[i] = look(field, &place, 0, i);
    }
}

/* The rays of one pixel. */
static void look_again(void *user, int item, int worker)
{
    (void)worker;
    const LookedAt *field = user;
    int at = field->seen_again + item, count = field->args->pixels, pixel = field->pixels[at];
    for (int k = 0; k < RAYS; k++) {
        int x = pixel % count * SIDE + k % SIDE, y = pixel / count * SIDE + k / SIDE;
        int cell = y * count * SIDE + x;
        FieldRay place = place_of(field->args, count * SIDE, cell, AGAIN_SEED);
        field->others[at * RAYS + k] = look(field, &place, AGAIN_SEED, cell);
    }
}

/* ---- which is what ----------------------------------------------------------------------- */

static double luminance_of(const LookedAt *field, const FieldRay *ray)
{
    return (double)ray->sky + (double)ray->lit + glare_rest_at(field->args->rest, ray->towards);
}

static FieldClass class_of(const LookedAt *field, const FieldRay *ray)
{
    if (!(ray->sr > 0)) return FIELD_DIM;
    double luminance = luminance_of(field, ray);
    if (!(luminance > field->args->threshold_cd_m2)) return FIELD_DIM;
    return luminance > field->args->peak_cd_m2 ? FIELD_PEAK : FIELD_SOURCE;
}

static bool is_inside(int count, int x, int y)
{
    return x >= 0 && y >= 0 && x < count && y < count;
}

/* ---- what hangs together ----------------------------------------------------------------- */

/* The first pixel of each set. */
static int root_of(int *parent, int i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

static void join(int *parent, int i, int k)
{
    int a = root_of(parent, i), b = root_of(parent, k);
    if (a < b) parent[b] = a;
    else parent[a] = b;
}

/* Sets of pixels that touch one another and have some of these classes. */
static int *sets_of(const LookedAt *field, int bits, Arena *scratch)
{
    static const int beside[4][2] = {{-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    int  count = field->args->pixels, total = count * count;
    int *parent = ARENA_NEW(scratch, int, total);
    for (int i = 0; i < total; i++) {
        parent[i] = i;
        if (!(field->classes[i] & bits)) continue;
        for (int k = 0; k < 4; k++) {
            int x = i % count + beside[k][0], y = i / count + beside[k][1];
            if (is_inside(count, x, y) && (field->classes[y * count + x] & bits))
                join(parent, i, y * count + x);
        }
    }
    return parent;
}

/* ---- where it is looked at again --------------------------------------------------------- */

#define BRIGHT (1 << FIELD_SOURCE | 1 << FIELD_PEAK)

/* The area of a source of many pixels is known well enough from one ray each. */
#define FEW_PIXELS 64
#define HARDLY 0.01 /* of all sources together */

static bool is_edge(const LookedAt *field, int pixel)
{
    int count = field->args->pixels, x = pixel % count, y = pixel / count;
    for (int k = 0; k < 9; k++) {
        int i = x + k % 3 - 1, j = y + k / 3 - 1;
        if (is_inside(count, i, j) && field->classes[j * count + i] != field->classes[pixel])
            return true;
    }
    return false;
}

/* Marks the pixel and those about it. */
static void mark(LookedAt *field, int pixel)
{
    int count = field->args->pixels, x = pixel % count, y = pixel / count;
    for (int k = 0; k < 9; k++) {
        int i = x + k % 3 - 1, j = y + k / 3 - 1, at = j * count + i;
        if (!is_inside(count, i, j) || !(field->rays[at].sr > 0) || field->again[at] != NO_ID)
            continue;
        field->again[at] = field->again_count;
        field->pixels[field->again_count++] = at;
    }
}

/* What a ray adds to the sum of UGR and DGP, L^2 w/P^2. */
static double weight_of(const LookedAt *field, const FieldRay *ray)
{
    const GlareHead *head = &field->args->rest->head;
    double luminance = luminance_of(field, ray);
    double p = position_index((double)vec3_dot(ray->towards, head->right),
                              (double)vec3_dot(ray->towards, head->up),
                              (double)vec3_dot(ray->towards, head->gaze));
    return luminance * luminance * (double)ray->sr / (p * p);
}

/* The rims of sources of few pixels, but for those that hardly count. */
static void mark_small(LookedAt *field, Arena scratch)
{
    int     total = field->args->pixels * field->args->pixels;
    int    *sets = sets_of(field, BRIGHT, &scratch), *sizes = ARENA_NEW(&scratch, int, total);
    double *weights = ARENA_NEW(&scratch, double, total), all = 0;
    for (int i = 0; i < total; i++) {
        if (!(field->classes[i] & BRIGHT)) continue;
        double weight = weight_of(field, &field->rays[i]);
        sizes[root_of(sets, i)]++;
        weights[root_of(sets, i)] += weight;
        all += weight;
    }
    for (int i = 0; i < total; i++) {
        int root = root_of(sets, i);
        if ((field->classes[i] & BRIGHT) && sizes[root] <= FEW_PIXELS &&
            weights[root] > HARDLY * all && is_edge(field, i))
            mark(field, i);
    }
}

static int pixel_of(const GlareFieldArgs *args, Vec3 d)
{
    const GlareHead *head = &args->rest->head;
    double x = (double)vec3_dot(d, head->right), y = (double)vec3_dot(d, head->up);
    double beside = hypot(x, y), t = atan2(beside, (double)vec3_dot(d, head->gaze));
    double scale = beside > 0 ? t / beside : 1;
    int    i = (int)((scale * x / PI + 0.5) * args->pixels);
    int    j = (int)((0.5 - scale * y / PI) * args->pixels);
    return is_inside(args->pixels, i, j) ? j * args->pixels + i : NO_ID;
}

/* What a path found bright, and no ray about it. */
static void mark_found(LookedAt *field)
{
    const GlareFieldArgs *args = field->args;
    for (int i = 0; i < args->found.count; i++) {
        FieldRay ray = {(float)args->found.cd_m2[i], 0, 1, args->found.towards[i]};
        if ((double)ray.sky > args->peak_cd_m2 || class_of(field, &ray) == FIELD_DIM) continue;
        int pixel = pixel_of(args, ray.towards);
        if (pixel != NO_ID && !(field->classes[pixel] & BRIGHT) && !is_edge(field, pixel))
            mark(field, pixel);
    }
}

static void find_edges(LookedAt *field, Arena *scratch)
{
    int total = field->args->pixels * field->args->pixels;
    field->again = ARENA_NEW(scratch, int, total);
    field->pixels = ARENA_NEW(scratch, int, total);
    for (int i = 0; i < total; i++) {
        field->classes[i] = (uint8_t)(1 << class_of(field, &field->rays[i]));
        field->again[i] = NO_ID;
    }
    mark_small(field, *scratch);
    mark_found(field);
}

/* Pixels [first, end) of the list have been looked at again. */
static void set_classes(LookedAt *field, int first, int end)
{
    for (int i = first; i < end; i++) {
        uint8_t *bits = &field->classes[field->pixels[i]];
        bool     was_dim = !(*bits & BRIGHT);
        *bits = 0;
        for (int k = 0; k < RAYS; k++)
            *bits |= (uint8_t)(1 << class_of(field, &field->others[i * RAYS + k]));
        if (was_dim && (*bits & BRIGHT)) mark(field, field->pixels[i]);
    }
}

/* Rays have room as pixels are found: all that there may be would be 64 times the field's. */
static void look_at_edges(LookedAt *field, Arena *scratch)
{
    for (int round = 0; round < 2 && field->seen_again < field->again_count; round++) {
        int first = field->seen_again, end = field->again_count;
        field->others = ARENA_GROW(scratch, FieldRay, field->others, first * RAYS, end * RAYS);
        parallel_for(field->args->setup->tools.threads, end - first, look_again, field);
        field->seen_again = end;
        set_classes(field, first, end);
    }
    for (int i = field->seen_again; i < field->again_count; i++)
        field->again[field->pixels[i]] = NO_ID;
}

/* ---- sources ----------------------------------------------------------------------------- */

/* Where rays go: into the source of their set, or the background. */
typedef struct FieldSums {
    const LookedAt     *field;
    GlareTable      *table;
    GlareBackground *background;
    int   *sets[FIELD_CLASSES];
    int   *source[FIELD_CLASSES]; /* [first pixel] in the table, and one more; 0: none yet */
    Arena *arena;
} FieldSums;

static GlareSum *sum_of(const FieldSums *sums, FieldClass class, int pixel, int group)
{
    int root = root_of(sums->sets[class], pixel), *source = &sums->source[class][root];
    if (!*source) {
        glare_table_add(sums->table, sums->arena);
        *source = sums->table->count;
    }
    return &sums->table->list[*source - 1].group[group];
}

static void add_ray(const FieldSums *sums, const FieldRay *ray, int pixel, int group)
{
    const GlareHead *head = &sums->field->args->rest->head;
    if (!(ray->sr > 0)) return;
    double     sr = (double)ray->sr, forward = (double)vec3_dot(ray->towards, head->gaze);
    FieldClass class = class_of(sums->field, ray);
    if (class == FIELD_DIM) {
        double rest = glare_rest_at(sums->field->args->rest, ray->towards);
        sums->background->rest_lx += rest * sr * forward;
        sums->background->told_lx[group] +=
            ((double)ray->sky + (double)ray->lit) * sr * forward;
        return;
    }
    glare_sum_add(sum_of(sums, class, pixel, group), luminance_of(sums->field, ray), sr,
                  (double)vec3_dot(ray->towards, head->right),
                  (double)vec3_dot(ray->towards, head->up), forward);
}

static void add_pixel(const FieldSums *sums, int pixel)
{
    const LookedAt *field = sums->field;
    int          count = field->args->pixels, again = field->again[pixel];
    if (again == NO_ID)
        add_ray(sums, &field->rays[pixel], pixel, glare_group_at(pixel % count, pixel / count));
    for (int k = 0; again != NO_ID && k < RAYS; k++)
        add_ray(sums, &field->others[again * RAYS + k], pixel,
                glare_group_at(k % SIDE, k / SIDE));
}

static void add_all(const LookedAt *field, GlareTable *table, GlareBackground *background,
                    Arena *arena, Arena scratch)
{
    int       total = field->args->pixels * field->args->pixels;
    FieldSums sums = {.field = field, .table = table, .background = background, .arena = arena};
    for (int c = FIELD_SOURCE; c < FIELD_CLASSES; c++) {
        sums.sets[c] = sets_of(field, 1 << c, &scratch);
        sums.source[c] = ARENA_NEW(&scratch, int, total);
    }
    for (int i = 0; i < total; i++) add_pixel(&sums, i);
}

/* Rays need no light samples but the sun's, by the first surface. */
static void set_aim(LookedAt *field)
{
    const Setup *setup = field->args->setup;
    field->context = setup->context;
    field->context.strategy = PATH_LIGHTS_ONLY;
    field->context.max_bounces = BOUNCES;
    field->context.guide = NULL;
    field->context.beams.mirrors = NULL;
    field->reach = lights_has(setup->context.lights, LIGHTS_SUN) ? PATH_TO_SUNLIT_SURFACE
                                                                 : PATH_TO_SURFACE;
    field->aim = (ProbeAim){.context = &field->context, .eye = field->args->rest->head.eye,
                            .seed = field->args->seed};
}

void glare_field_add(const GlareFieldArgs *args, GlareTable *table, GlareBackground *background,
                     Arena *arena)
{
    int   total = args->pixels * args->pixels, threads = args->setup->tools.threads;
    LookedAt field = {.args = args};
    Arena scratch = arena_reserve(FIELD_BYTES);
    field.rays = ARENA_NEW(&scratch, FieldRay, total);
    field.classes = ARENA_NEW(&scratch, uint8_t, total);
    set_aim(&field);
    parallel_for(threads, (total + PIXELS_A_CHUNK - 1) / PIXELS_A_CHUNK, look_chunk, &field);
    find_edges(&field, &scratch);
    look_at_edges(&field, &scratch);
    add_all(&field, table, background, arena, scratch);
    arena_release(&scratch);
}
