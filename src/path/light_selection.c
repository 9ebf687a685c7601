/* SPDX-License-Identifier: Apache-2.0 */
#include "path/light_selection.h"

#include "base/parallel.h"
#include "base/units.h"
#include "bvh/bvh.h"
#include "light/ray_ends.h"
#include "path/sheets.h"

#define POINTS 32        /* of every side of a part, for every set */
#define GENEROSITY 4.0f  /* a set with a quarter of a part's light is sampled at every hit */
#define LEAST 0.1f       /* and none less often than this */
#define TOGETHER 16      /* parts that a thread takes at once */

bool light_selection_arrives(const Bvh *bvh, LitPoint point, const LightSample *light)
{
    return vec3_dot(point.ns, light->wi) > 0 &&
           !bvh_occluded(bvh, lights_ray(point.position, light), sheets_let_pass, NULL);
}

double light_selection_lx(const Lights *lights, LitPoint point, const LightSample *light,
                          float u)
{
    Wavelengths wavelengths;
    float xyz[3] = {0};
    float cosine = vec3_dot(point.ns, light->wi);
    wavelengths_sample(u, &wavelengths);
    spectrum_add_xyz(&wavelengths, lights_radiance(lights, light, &wavelengths) *
                                       spectrum_all(cosine / light->pdf), xyz);
    return isfinite(xyz[1]) ? (double)xyz[1] : 0;
}

typedef struct Weighing {
    const Scene  *scene;
    const Bvh    *bvh;
    const Lights *lights;
    LightSelection selection;
} Weighing;

/* Illuminance, lx, by one sample of the set; 0 where it does not arrive. */
static double sample_illuminance(const Weighing *w, LightSet set, LitPoint point,
                                 Sampler *sampler)
{
    LightSample light;
    float u[4];
    sampler_4d(sampler, u);
    if (!lights_sample(w->lights, set, point, u, &light)) return 0;
    if (!light_selection_arrives(w->bvh, point, &light)) return 0;
    return light_selection_lx(w->lights, point, &light, u[3]);
}

/* Mean over points spread over the part's triangles; side 0: its front, 1: its back. */
static double side_illuminance(const Weighing *w, LightSet set, int part_id, int side)
{
    const Part *part = &w->scene->parts[part_id];
    double sum = 0;
    for (uint32_t i = 0; i < POINTS; i++) {
        Sampler  sampler = sampler_start((uint32_t)set, part_id, side, i);
        Vec2     at = sampler_2d(&sampler);
        uint32_t triangle = (uint32_t)((uint64_t)part->triangle_count * i / POINTS);
        float    u = at.x, v = at.y;
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        TrianglePoint point = triangle_point(w->scene, part->first_triangle + triangle, u, v);
        Vec3     ng = side ? vec3_neg(point.ng) : point.ng;
        LitPoint lit = {ray_start(&point, ng), ng, false};
        sum += sample_illuminance(w, set, lit, &sampler);
    }
    return sum / POINTS;
}

static void share_out(const Lights *lights, const double lx[LIGHT_SETS], float prob[LIGHT_SETS])
{
    double total = 0;
    for (int set = 0; set < LIGHT_SETS; set++) total += lx[set];
    for (int set = 0; set < LIGHT_SETS; set++) {
        if (!lights_has(lights, (LightSet)set)) continue;
        float wanted = total > 0 ? GENEROSITY * (float)(lx[set] / total) : 1;
        prob[set] = clampf(wanted, LEAST, 1);
    }
}

/* A part that lets light through is lit from both of its sides, whichever is seen. */
static void weigh_part(const Weighing *w, int part_id)
{
    const Material *material = &w->scene->materials[w->scene->parts[part_id].material_id];
    double lx[2][LIGHT_SETS] = {{0}};
    for (int set = 0; set < LIGHT_SETS; set++)
        for (int side = 0; side < 2 && lights_has(w->lights, (LightSet)set); side++)
            lx[side][set] = side_illuminance(w, (LightSet)set, part_id, side);
    for (int set = 0; set < LIGHT_SETS && material_sends_through(material); set++)
        lx[0][set] = lx[1][set] = lx[0][set] + lx[1][set];
    for (int side = 0; side < 2; side++) {
        int row = 2 * part_id + side;
        share_out(w->lights, lx[side], w->selection.prob[row]);
        for (int set = 0; set < LIGHT_SETS; set++)
            w->selection.lx[row] += (float)lx[side][set];
    }
}

/* Each part has its own rows and random numbers, so the threads decide nothing. */
static void weigh_some(void *context, int item, int worker)
{
    const Weighing *w = context;
    (void)worker;
    for (int part = TOGETHER * item; part < TOGETHER * (item + 1); part++)
        if (part < w->scene->part_count && w->scene->parts[part].triangle_count)
            weigh_part(w, part);
}

LightSelection light_selection_build(const Scene *scene, const Bvh *bvh, const Lights *lights,
                                     Arena *arena)
{
    size_t   rows = 2 * ((size_t)scene->part_count + 1);
    Weighing work = {.scene = scene, .bvh = bvh, .lights = lights};
    work.selection.prob = (float(*)[LIGHT_SETS])ARENA_NEW(arena, float, LIGHT_SETS * rows);
    work.selection.lx = ARENA_NEW(arena, float, rows);
    for (int set = 0; set < LIGHT_SETS; set++)
        work.selection.all[set] = lights_has(lights, (LightSet)set) ? 1.0f : 0.0f;
    parallel_for(bvh_threads(bvh), (scene->part_count + TOGETHER - 1) / TOGETHER, weigh_some,
                 &work);
    return work.selection;
}
