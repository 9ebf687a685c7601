/* SPDX-License-Identifier: Apache-2.0 */
#include "review/chain/outlook.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "base/units.h"
#include "image/false_colour.h"
#include "review/chain/chains.h"
#include "text/text.h"

#define SIZE OUTLOOK_SIZE
#define PATHS 12     /* in a pixel */
#define PASSES 4096  /* of the luxmeter for sun and lamps */
#define SEED 0x6f75746cu
#define RIM 1.5703   /* radians: pixels on the rim look no further down */
#define THINGS 64    /* that one row keeps apart */
#define ALL_THINGS 1024

/* A thing that is seen first, or a source that is seen by itself. */
typedef struct Thing {
    int    part_id;   /* NO_ID: the source */
    int    source, source_id, pane_id;
    double lux, near_mirror;
} Thing;

typedef struct ThingList {
    Thing *list;
    int    count, room;
} ThingList;

typedef struct OutlookWork {
    const OutlookArgs *args;
    Frame      frame;   /* x right, y up, z along the normal */
    Vec3       mirror;  /* towards what the eye sees mirrored */
    ProbeAim   aim;
    Vec3      *targets; /* one a path of the picture */
    ThingList *rows;
    float     *cd_m2;
} OutlookWork;

/* ---- where pixels look ------------------------------------------------------------------- */

/* Radians from the normal of a place in the picture; above a right angle: outside. */
static double angle_at(double x, double y)
{
    return hypot(x - 0.5 * SIZE, y - 0.5 * SIZE) / (0.5 * SIZE) * 0.5 * PI;
}

/* Picture x to the right as one looks out along the normal. */
static Vec3 direction_at(const Frame *frame, double x, double y)
{
    double theta = fmin(angle_at(x, y), RIM), phi = atan2(0.5 * SIZE - y, x - 0.5 * SIZE);
    return frame_to_world(frame, vec3((float)(sin(theta) * cos(phi)),
                                      (float)(sin(theta) * sin(phi)), (float)cos(theta)));
}

static void place_of(const Frame *frame, Vec3 towards, double *x, double *y)
{
    Vec3   d = frame_to_local(frame, towards);
    double theta = acos(fmin(fmax((double)d.z, -1), 1)), phi = atan2((double)d.y, (double)d.x);
    double r = theta / (0.5 * PI) * 0.5 * SIZE;
    *x = 0.5 * SIZE + r * cos(phi);
    *y = 0.5 * SIZE - r * sin(phi);
}

/* Solid angle of a pixel at an angle from the normal, sr. */
static double pixel_sr(double theta)
{
    double side = PI / SIZE;
    return side * side * (theta > 1e-6 ? sin(theta) / theta : 1);
}

Vec3 outlook_up(Vec3 ng)
{
    return fabsf(ng.y) < 0.95f ? vec3(0, 1, 0) : vec3(0, 0, -1);
}

/* A picture's right for a look along z. */
static Frame frame_of(Vec3 ng, Vec3 up)
{
    Vec3 right = vec3_normalize(vec3_cross(ng, up));
    return (Frame){right, vec3_cross(right, ng), ng};
}

/* ---- what paths find --------------------------------------------------------------------- */

static Thing *thing_of(ThingList *things, const Thing *wanted)
{
    for (int i = 0; i < things->count; i++) {
        Thing *t = &things->list[i];
        if (t->part_id == wanted->part_id && t->source == wanted->source &&
            t->source_id == wanted->source_id && t->pane_id == wanted->pane_id)
            return t;
    }
    if (things->count == things->room) return &things->list[things->room - 1];
    things->list[things->count] = *wanted;
    return &things->list[things->count++];
}

static Thing thing_met(const PathHistory *history)
{
    if (history->count)
        return (Thing){.part_id = history->step[0].part_id, .source = -1, .source_id = -1,
                       .pane_id = history->step[0].pane_id};
    return (Thing){.part_id = history->source == LIGHTS_EMITTERS ? history->source_id : NO_ID,
                   .source = history->source == LIGHTS_EMITTERS ? -1 : (int)history->source,
                   .source_id = history->source == LIGHTS_PUNCTUAL ? history->source_id : -1,
                   .pane_id = history->pane_id};
}

/* One pixel, while paths add to it. */
typedef struct OutlookPixel {
    ThingList *things;
    double     cd_m2, lux_per_cd_m2;
    bool       is_mirrored;
} OutlookPixel;

static void add_pixel(void *user, const PathHistory *history, const float xyz[3])
{
    OutlookPixel *pixel = user;
    double     y = (double)xyz[1] / PATHS;
    if (!(y > 0) || (history->count == 0 && history->source == LIGHTS_SUN)) return;
    Thing  met = thing_met(history);
    Thing *thing = thing_of(pixel->things, &met);
    pixel->cd_m2 += y;
    thing->lux += y * pixel->lux_per_cd_m2;
    if (pixel->is_mirrored) thing->near_mirror += y;
}

static void see_pixel(const OutlookWork *work, int column, int row)
{
    double theta = angle_at(column + 0.5, row + 0.5);
    int    pixel = row * SIZE + column, first = pixel * PATHS;
    float *out = &work->cd_m2[pixel];
    *out = NAN;
    if (theta >= 0.5 * PI) return;
    Vec3         towards = direction_at(&work->frame, column + 0.5, row + 0.5);
    double       apart = acos(fmin((double)vec3_dot(towards, work->mirror), 1));
    OutlookPixel sums = {.things = &work->rows[row],
                         .lux_per_cd_m2 = pixel_sr(theta) * cos(theta),
                         .is_mirrored = degrees_from_radians(apart) <= OUTLOOK_MIRROR_DEG};
    PathListener   listener = {.on_light = add_pixel, .user = &sums};
    PathStatistics statistics = {0};
    work->args->tools->kernel->trace(&work->aim, first, first + PATHS, &listener, &statistics);
    *out = (float)sums.cd_m2;
}

static void see_row(void *user, int row, int worker)
{
    (void)worker;
    const OutlookWork *work = user;
    for (int column = 0; column < SIZE; column++) see_pixel(work, column, row);
}

/* ---- sun and lamps ----------------------------------------------------------------------- */

/* They are too small for pixels: light samples find them. */
typedef struct SmallLights {
    ThingList things;
    Vec3      sun;   /* sum of directions by lux */
} SmallLights;

static void add_small(void *user, const PathHistory *history, const float xyz[3])
{
    SmallLights *lights = user;
    double       lux = (double)xyz[1] / PASSES;
    bool         is_small = history->source == LIGHTS_SUN || history->source == LIGHTS_PUNCTUAL;
    if (!(lux > 0) || history->count || !is_small) return;
    Thing met = thing_met(history);
    thing_of(&lights->things, &met)->lux += lux;
    if (history->source == LIGHTS_SUN)
        lights->sun = vec3_along(lights->sun, history->towards, (float)lux);
}

static SmallLights small_lights(const OutlookArgs *args, Vec3 from, Arena *arena)
{
    LitPoint       head = {from, args->ng, false};
    PathContext    lights_only = *args->context;
    ProbeAim       aim = {.context = &lights_only, .meter = &head, .seed = SEED + 1};
    SmallLights    out = {.things = {ARENA_NEW(arena, Thing, THINGS), 0, THINGS}};
    PathListener   listener = {.on_light = add_small, .user = &out};
    PathStatistics statistics = {0};
    lights_only.strategy = PATH_LIGHTS_ONLY;
    lights_only.max_bounces = 1;
    args->tools->kernel->trace(&aim, 0, PASSES, &listener, &statistics);
    return out;
}

/* ---- all of it --------------------------------------------------------------------------- */

static const char *thing_words(const Scene *scene, const Thing *thing, Arena *arena)
{
    const char *what = thing->part_id != NO_ID
                           ? chain_part_words(scene, thing->part_id, arena)
                           : chain_source_words(scene, thing->source, thing->source_id, arena);
    if (thing->pane_id == NO_ID) return what;
    return arena_format(arena, "%s through %s", what,
                        chain_part_words(scene, thing->pane_id, arena));
}

/* Things that are called alike are one. */
static void add_things(const Scene *scene, const ThingList *from, OutlookShare *to, int *count,
                       Arena *arena)
{
    for (int i = 0; i < from->count; i++) {
        const char *what = thing_words(scene, &from->list[i], arena);
        int at = 0;
        while (at < *count && strcmp(to[at].what, what) != 0) at++;
        if (at == ALL_THINGS) at--;
        if (at == *count) to[(*count)++].what = what;
        to[at].lux += from->list[i].lux;
        to[at].share += from->list[i].near_mirror; /* till all are there */
    }
}

static int by_lux(const void *a, const void *b)
{
    const OutlookShare *x = a, *y = b;
    if (x->lux != y->lux) return x->lux < y->lux ? 1 : -1;
    return strcmp(x->what, y->what);
}

static void find_mirrored(const OutlookWork *work, const OutlookShare *all, int count,
                          Outlook *out)
{
    double sum = 0, most = -1, pixels = 0;
    for (int i = 0; i < count; i++) {
        sum += all[i].share;
        if (!(all[i].share > most)) continue;
        most = all[i].share;
        out->mirror_what = all[i].what;
    }
    for (int i = 0; i < SIZE * SIZE; i++) {
        double theta = angle_at(i % SIZE + 0.5, (int)(i / SIZE) + 0.5);
        Vec3   d = direction_at(&work->frame, i % SIZE + 0.5, (int)(i / SIZE) + 0.5);
        double apart = acos(fmin((double)vec3_dot(d, work->mirror), 1));
        pixels += theta < 0.5 * PI && degrees_from_radians(apart) <= OUTLOOK_MIRROR_DEG;
    }
    out->mirror_cd_m2 = pixels > 0 ? sum / pixels : (double)NAN;
}

static void set_shares(OutlookShare *all, int count, Outlook *out)
{
    for (int i = 0; i < count; i++) out->lux += all[i].lux;
    qsort(all, (size_t)count, sizeof *all, by_lux);
    for (int i = 0; i < count; i++) {
        all[i].share = out->lux > 0 ? all[i].lux / out->lux : 0;
        if (i < OUTLOOK_SHARES) out->shares[out->share_count++] = all[i];
        else out->rest += all[i].share;
    }
}

static void aim_paths(OutlookWork *work, Arena *arena)
{
    work->targets = ARENA_NEW(arena, Vec3, SIZE * SIZE * PATHS);
    for (int i = 0; i < SIZE * SIZE * PATHS; i++) {
        int    pixel = i / PATHS, k = i % PATHS;
        double x = pixel % SIZE + (k + 0.5) / PATHS;
        double y = (int)(pixel / SIZE) + reverse_bits((uint32_t)k) * 0x1p-32 + 0.5 / PATHS;
        work->targets[i] = vec3_add(work->aim.eye, direction_at(&work->frame, x, y));
    }
    work->aim.targets = work->targets;
    work->aim.target_count = SIZE * SIZE * PATHS;
}

Outlook outlook_take(const OutlookArgs *args, Arena *arena)
{
    Outlook     out = {.cd_m2 = ARENA_NEW(arena, float, SIZE * SIZE)};
    Arena       own = arena_reserve((size_t)1 << 28);
    Vec3        from = args->point;
    Vec3        to_eye = vec3_normalize(vec3_sub(args->eye, args->point));
    OutlookWork work = {.args = args, .frame = frame_of(args->ng, args->up), .cd_m2 = out.cd_m2,
                        .aim = {.context = args->context, .eye = from, .seed = SEED},
                        .rows = ARENA_NEW(&own, ThingList, SIZE)};
    work.mirror = vec3_sub(vec3_scale(args->ng, 2 * vec3_dot(args->ng, to_eye)), to_eye);
    for (int i = 0; i < SIZE; i++)
        work.rows[i] = (ThingList){ARENA_NEW(&own, Thing, THINGS), 0, THINGS};
    aim_paths(&work, &own);
    parallel_for(args->tools->threads, SIZE, see_row, &work);
    SmallLights   small = small_lights(args, from, &own);
    OutlookShare *all = ARENA_NEW(&own, OutlookShare, ALL_THINGS);
    int           count = 0;
    for (int i = 0; i < SIZE; i++)
        add_things(args->context->scene, &work.rows[i], all, &count, arena);
    add_things(args->context->scene, &small.things, all, &count, arena);
    find_mirrored(&work, all, count, &out);
    place_of(&work.frame, work.mirror, &out.mirror_x, &out.mirror_y);
    set_shares(all, count, &out);
    out.has_sun = vec3_length(small.sun) > 0;
    if (out.has_sun)
        place_of(&work.frame, vec3_normalize(small.sun), &out.sun_x, &out.sun_y);
    arena_release(&own);
    return out;
}

/* ---- as a picture and in words ----------------------------------------------------------- */

#define SCALE 3 /* pixels of the picture to one that was seen */
#define SUN 5

static float *enlarged(const float *values, Arena *arena)
{
    const int side = SCALE * OUTLOOK_SIZE;
    float    *out = ARENA_NEW(arena, float, side * side);
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++)
            out[y * side + x] = values[(y / SCALE) * OUTLOOK_SIZE + x / SCALE];
    return out;
}

/* code: grey, 0..1. */
static void dot(Picture *picture, double x, double y, float code)
{
    if (!(x >= 0 && y >= 0 && x < picture->width && y < picture->height)) return;
    float *rgb = picture_pixel(picture, (int)x, (int)y);
    rgb[0] = rgb[1] = rgb[2] = code;
}

/* White within black, to be seen on any ground. */
static void ring(Picture *picture, double x, double y, double radius)
{
    for (double r = radius - 2; r <= radius + 2; r += 0.5)
        for (int i = 0; i < 720; i++) {
            double a = i * 3.14159265358979 / 360;
            dot(picture, x + r * cos(a), y + r * sin(a), fabs(r - radius) <= 1 ? 1.0f : 0.0f);
        }
}

static void sun(Picture *picture, double x, double y)
{
    for (int i = 0; i < 8; i++) {
        double a = i * 3.14159265358979 / 4;
        for (double r = 0; r <= 2.4 * SUN; r += 0.5)
            if (r < SUN || r > 1.5 * SUN)
                for (int k = -1; k <= 1; k++)
                    dot(picture, x + r * cos(a) - 0.7 * k * sin(a),
                        y + r * sin(a) + 0.7 * k * cos(a), 1);
    }
    for (double r = 0; r <= SUN; r += 0.5)
        for (int i = 0; i < 180; i++)
            dot(picture, x + r * cos(i * 0.0349), y + r * sin(i * 0.0349),
                r > SUN - 1 ? 0.0f : 1.0f);
}

Picture outlook_picture(const Outlook *outlook, Arena *arena)
{
    const int  side = SCALE * OUTLOOK_SIZE;
    ScaleRange range =
        scale_range_of(outlook->cd_m2, (size_t)OUTLOOK_SIZE * OUTLOOK_SIZE, true, *arena);
    Picture out = false_colour_picture(enlarged(outlook->cd_m2, arena), side, side, range,
                                       "cd/m^2", arena);
    ring(&out, SCALE * outlook->mirror_x, SCALE * outlook->mirror_y,
         side * OUTLOOK_MIRROR_DEG / 180.0);
    if (outlook->has_sun) sun(&out, SCALE * outlook->sun_x, SCALE * outlook->sun_y);
    return out;
}

const char *outlook_words(const Outlook *outlook, Arena *arena)
{
    Text text = {.arena = arena};
    text_format(&text, outlook->lux < 100 ? "%.3g lx: " : "%.0f lx: ", outlook->lux);
    for (int i = 0; i < outlook->share_count; i++)
        if (outlook->shares[i].share >= 0.005)
            text_format(&text, "%s%.0f %% %s", i ? ", " : "", 100 * outlook->shares[i].share,
                        outlook->shares[i].what);
    if (outlook->rest >= 0.005) text_format(&text, ", %.0f %% other", 100 * outlook->rest);
    if (outlook->mirror_what)
        text_format(&text, ". Where the eye sees it mirrored (ring): %s, %.3g cd/m2",
                    outlook->mirror_what, outlook->mirror_cd_m2);
    return text.data;
}
