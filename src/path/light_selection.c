/* SPDX-License-Identifier: Apache-2.0 */
#include "path/light_selection.h"

#include "base/parallel.h"
#include "base/units.h"
#include "bvh/bvh.h"
#include "scene/point/ray_ends.h"
#include "path/sheets.h"
#include "sunlit/sunlit_way.h"

#define POINTS 32       /* of every side of a part, for every set */
#define SUNLIT_POINTS 8 /* of every side, for the sunlit map */
#define GENEROSITY 4.0f /* a set with a quarter of a part's light is sampled at every hit */
#define LEAST 0.1f      /* and none less often than this */
#define TOGETHER 16     /* parts that a thread takes at once */
#define SKY_SAMPLES 256

bool light_selection_arrives(const PlateView *plates, LitPoint point, const LightSample *light) {
    Ray ray = lights_ray(point.position, light);
    if (!(vec3_dot(point.ns, light->wi) > 0)) return false;
    if (!bvh_occluded(plates->bvh, ray, sheets_let_pass, NULL)) return true;
    PlateWay way = {.view = *plates, .passes = sheets_let_pass};
    return !light->is_emitter && plates_follow(&way, ray);
}

typedef struct Weighing {
    const Scene *scene;
    const PlateView *plates;
    const Lights *lights;
    const SunlitTools *tools;
    const SunlitMap *sunlit;
    LightSelection selection;
} Weighing;

/* Illuminance, lx, by one sample of the set; 0 where it does not arrive. */
static double sample_illuminance(const Weighing *w, LightSet set, LitPoint point,
                                 Sampler *sampler) {
    LightSample light;
    float u[4];
    sampler_4d(sampler, u);
    if (!lights_sample(w->lights, set, point, u, &light)) return 0;
    if (!light_selection_arrives(w->plates, point, &light)) return 0;
    return lights_sample_lx(w->lights, point, &light, u[3]);
}

/* Point i of so many that are spread over the part's triangles; side 0: in front, 1: behind. */
static LitPoint point_of(const Weighing *w, int part_id, int side, uint32_t i, uint32_t points,
                         Sampler *sampler) {
    const Part *part = &w->scene->parts[part_id];
    Vec2 at = sampler_2d(sampler);
    uint32_t triangle = (uint32_t)((uint64_t)part->triangle_count * i / points);
    if (at.x + at.y > 1) at = (Vec2){1 - at.x, 1 - at.y};
    TrianglePoint point = triangle_point(w->scene, part->first_triangle + triangle, at.x, at.y);
    Vec3 ng = side ? vec3_neg(point.ng) : point.ng;
    return (LitPoint){ray_start(&point, ng), ng, false};
}

static double side_illuminance(const Weighing *w, LightSet set, int part_id, int side) {
    double sum = 0;
    for (uint32_t i = 0; i < POINTS; i++) {
        Sampler sampler = sampler_start((uint32_t)set, part_id, side, i);
        LitPoint lit = point_of(w, part_id, side, i, POINTS, &sampler);
        sum += sample_illuminance(w, set, lit, &sampler);
    }
    return sum / POINTS;
}

static void try_sunlit(const Weighing *w, int part_id, int side, SunlitFinds *finds) {
    for (uint32_t i = 0; i < SUNLIT_POINTS; i++) {
        SunlitTry found;
        float u[8];
        Sampler sampler = sampler_start(LIGHTS_SUNLIT, part_id, side, i);
        LitPoint lit = point_of(w, part_id, side, i, SUNLIT_POINTS, &sampler);
        sampler_4d(&sampler, u);
        sampler_4d(&sampler, u + 4);
        if (sunlit_try(w->tools, w->sunlit, lit, u, &found))
            sunlit_finds_add(finds, &found, vec3_dot(lit.ns, found.wi) * INV_PI_F);
    }
}

static void share_out(const Weighing *w, const double lx[LIGHT_SETS], const SunlitFinds *sunlit,
                      float prob[LIGHT_CHOICES]) {
    double total = 0;
    for (int set = 0; set < LIGHT_SETS; set++) total += lx[set];
    for (int set = 0; set < LIGHT_SETS; set++) {
        if (!lights_has(w->lights, (LightSet)set)) continue;
        float wanted = total > 0 ? GENEROSITY * (float)(lx[set] / total) : 1;
        prob[set] = clampf(wanted, LEAST, 1);
    }
    if (w->sunlit->nodes)
        prob[LIGHTS_SUNLIT] = sunlit_finds_prob(sunlit, SUNLIT_POINTS, total * total);
}

/* A part that lets light through is lit from both of its sides, whichever is seen. */
static void weigh_part(const Weighing *w, int part_id) {
    const Material *material = &w->scene->materials[w->scene->parts[part_id].material_id];
    bool is_sheet = material_sends_through(material);
    double lx[2][LIGHT_SETS] = {{0}};
    SunlitFinds finds[2] = {{{0}}};
    for (int set = 0; set < LIGHT_SETS; set++)
        for (int side = 0; side < 2 && lights_has(w->lights, (LightSet)set); side++)
            lx[side][set] = side_illuminance(w, (LightSet)set, part_id, side);
    for (int set = 0; set < LIGHT_SETS && is_sheet; set++)
        lx[0][set] = lx[1][set] = lx[0][set] + lx[1][set];
    for (int side = 0; side < 2; side++) try_sunlit(w, part_id, side, &finds[is_sheet ? 0 : side]);
    if (is_sheet) finds[1] = finds[0];
    for (int side = 0; side < 2; side++) {
        int row = 2 * part_id + side;
        share_out(w, lx[side], &finds[side], w->selection.prob[row]);
        for (int set = 0; set < LIGHT_SETS; set++) w->selection.lx[row] += (float)lx[side][set];
    }
}

/* Each part has its own rows and random numbers, so the threads decide nothing. */
static void weigh_some(void *context, int item, int worker) {
    const Weighing *w = context;
    (void)worker;
    for (int part = TOGETHER * item; part < TOGETHER * (item + 1); part++)
        if (part < w->scene->part_count && w->scene->parts[part].triangle_count)
            weigh_part(w, part);
}

static float open_sky(const Lights *lights) {
    LitPoint up = {.ns = {0, 1, 0}};
    double lx = 0;
    for (uint32_t i = 0; i < SKY_SAMPLES && lights_has(lights, LIGHTS_SKY); i++) {
        LightSample light;
        Sampler sampler = sampler_start(LIGHTS_SKY, 0, 0, i);
        float u[4];
        sampler_4d(&sampler, u);
        if (lights_sample(lights, LIGHTS_SKY, up, u, &light))
            lx += lights_sample_lx(lights, up, &light, u[3]);
    }
    return (float)(lx / SKY_SAMPLES) * INV_PI_F;
}

LightSelection light_selection_build(const SunlitTools *tools, const SunlitMap *sunlit,
                                     const PlateView *plates, Arena *arena) {
    int parts = tools->scene->part_count;
    size_t rows = 2 * ((size_t)parts + 1);
    Weighing work = {.scene = tools->scene,
                     .plates = plates,
                     .lights = tools->lights,
                     .tools = tools,
                     .sunlit = sunlit};
    work.selection.prob = (float(*)[LIGHT_CHOICES])ARENA_NEW(arena, float, LIGHT_CHOICES *rows);
    work.selection.lx = ARENA_NEW(arena, float, rows);
    for (int set = 0; set < LIGHT_SETS; set++)
        work.selection.all[set] = lights_has(tools->lights, (LightSet)set) ? 1.0f : 0.0f;
    work.selection.all[LIGHTS_SUNLIT] = sunlit->nodes ? 1.0f : 0.0f;
    parallel_for(bvh_threads(tools->bvh), (parts + TOGETHER - 1) / TOGETHER, weigh_some, &work);
    work.selection.sky_cd_m2 = open_sky(tools->lights);
    return work.selection;
}
