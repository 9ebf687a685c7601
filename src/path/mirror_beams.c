#include "path/mirror_beams.h"

#include <stdlib.h>

#include "spectrum/photometry.h"

#define LEAST_RAYS 8       /* to every mirror, and by its area in all of theirs */
#define RAYS_BY_AREA 200000
#define SHEETS_PASSED 16   /* by one ray behind its mirror */
#define GENEROSITY 4.0f    /* with a quarter of a part's light they are asked at every hit */
#define LEAST 0.1f

typedef struct Beams {
    const BeamTools *tools;
    Arena           *arena;
    MirrorPair      *pairs;
    uint32_t         count;
    double          *lm; /* that came to a side, one a row of LightSelection */
} Beams;

/* One ray of the sun behind its mirror. */
typedef struct Beam {
    Ray      ray;
    uint32_t triangle;
    double   lm;
} Beam;

static bool always_passes(void *user, const Hit *hit)
{
    (void)user;
    (void)hit;
    return true;
}

/* Rays of one mirror come one after the other. */
static void add_pair(Beams *beams, int part_id, uint32_t triangle)
{
    for (uint32_t i = beams->count; i > 0 && beams->pairs[i - 1].triangle == triangle; i--)
        if (beams->pairs[i - 1].part_id == part_id) return;
    beams->pairs = ARENA_GROW(beams->arena, MirrorPair, beams->pairs, beams->count,
                              beams->count + 1);
    beams->pairs[beams->count++] = (MirrorPair){part_id, triangle};
}

/* All parts along the ray, up to one that stops it. */
static void follow(Beams *beams, Beam beam)
{
    const Scene *scene = beams->tools->scene;
    Hit hit;
    add_pair(beams, NO_ID, beam.triangle);
    for (int i = 0; i < SHEETS_PASSED && bvh_intersect(beams->tools->bvh, beam.ray, 0, &hit);
         i++) {
        TrianglePoint point = triangle_point(scene, hit.triangle, hit.u, hit.v);
        int part_id = (int)scene->triangles[hit.triangle].part_id;
        add_pair(beams, part_id, beam.triangle);
        beams->lm[2 * part_id + (vec3_dot(point.ng, beam.ray.direction) > 0)] += beam.lm;
        if (hit.triangle < scene->opaque_count) return;
        beam.ray.origin = ray_offset_origin(point.position, point.ng, beam.ray.direction);
    }
}

/* Luminous flux that the sun's ray takes on, per m2 of the mirror. */
static double reflected_lx(const Lights *lights, const Surface *mirror, const LightSample *sun,
                           Vec3 wo, const Wavelengths *wavelengths)
{
    float    xyz[3] = {0};
    Vec3     local_wo = frame_to_local(&mirror->frame, wo);
    Spectrum share = bsdf_mirror(&mirror->bsdf, local_wo) *
                     spectrum_all(fabsf(vec3_dot(mirror->ng, sun->wi)) / sun->pdf);
    spectrum_add_xyz(wavelengths, share * lights_radiance(lights, sun, wavelengths), xyz);
    return isfinite(xyz[1]) ? (double)xyz[1] : 0;
}

/* The sampler's numbers in turn: wavelengths, place, direction. */
static void send_ray(Beams *beams, uint32_t triangle, Sampler sampler, double ray_m2)
{
    const BeamTools *tools = beams->tools;
    Wavelengths wavelengths;
    Surface     mirror;
    LightSample sun;
    wavelengths_sample(sampler_1d(&sampler), &wavelengths);
    Vec2 at = sampler_2d(&sampler), disc = sampler_2d(&sampler);
    const float u[3] = {disc.x, disc.y, 0};
    if (at.x + at.y > 1) at = (Vec2){1 - at.x, 1 - at.y};
    Hit hit = {0, at.x, at.y, triangle};
    TrianglePoint point = triangle_point(tools->scene, triangle, at.x, at.y);
    if (!lights_sample(tools->lights, LIGHTS_SUN, (LitPoint){point.position, point.ns, true},
                       u, &sun))
        return;
    Vec3 r = vec3_sub(vec3_scale(point.ns, 2 * vec3_dot(point.ns, sun.wi)), sun.wi);
    if (!(vec3_dot(point.ng, r) * vec3_dot(point.ng, sun.wi) > 0)) return;
    Vec3 origin = ray_offset_origin(point.position, point.ng, r);
    if (bvh_occluded(tools->bvh, (Ray){origin, sun.wi, 0, INFINITY}, always_passes, NULL))
        return;
    surface_at(tools->scene, tools->tables, &hit, r, &wavelengths, &mirror);
    double lx = reflected_lx(tools->lights, &mirror, &sun, r, &wavelengths);
    if (lx > 0) follow(beams, (Beam){{origin, r, 0, INFINITY}, triangle, lx * ray_m2});
}

static double area_m2(const Scene *scene, uint32_t triangle)
{
    Vec3 p[3];
    for (int i = 0; i < 3; i++) p[i] = scene_corner(scene, triangle, i);
    return 0.5 * (double)vec3_length(vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0])));
}

static int compare_pairs(const void *a, const void *b)
{
    const MirrorPair *x = a, *y = b;
    if (x->part_id != y->part_id) return x->part_id < y->part_id ? -1 : 1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

/* To all mirrors, more to large ones. */
static void send_rays(Beams *beams)
{
    const Scene *scene = beams->tools->scene;
    bool  *is_mirror = ARENA_NEW(beams->arena, bool, scene->part_count + 1);
    double total = 0;
    for (int i = 0; i < scene->part_count; i++)
        is_mirror[i] = mirrors_can_be(scene, &scene->materials[scene->parts[i].material_id]);
    for (uint32_t i = 0; i < scene->triangle_count; i++)
        if (is_mirror[scene->triangles[i].part_id]) total += area_m2(scene, i);
    for (uint32_t i = 0; i < scene->triangle_count && total > 0; i++) {
        if (!is_mirror[scene->triangles[i].part_id]) continue;
        double   own = area_m2(scene, i);
        uint32_t rays = LEAST_RAYS + (uint32_t)(RAYS_BY_AREA * own / total);
        for (uint32_t k = 0; k < rays; k++)
            send_ray(beams, i, sampler_start(0, (int)i, 0, k), own / rays);
    }
}

/* What lets light through is lit from both of its sides. */
static float *weigh_parts(const Scene *scene, const double *lm,
                          const LightSelection *selection, Arena *arena)
{
    float *prob = ARENA_NEW(arena, float, 2 * ((size_t)scene->part_count + 1));
    for (int part_id = 0; part_id < scene->part_count; part_id++) {
        const Part *part = &scene->parts[part_id];
        double m2 = 0, all = lm[2 * part_id] + lm[2 * part_id + 1];
        bool   is_sheet = scene->materials[part->material_id].transmission > 0;
        for (uint32_t i = 0; i < part->triangle_count; i++)
            m2 += area_m2(scene, part->first_triangle + i);
        for (int row = 2 * part_id; row < 2 * part_id + 2; row++) {
            float lx = m2 > 0 ? (float)((is_sheet ? all : lm[row]) / m2) : 0;
            float share = lx > 0 ? lx / (lx + selection->lx[row]) : 0;
            prob[row] = clampf(GENEROSITY * share, LEAST, 1);
        }
    }
    return prob;
}

MirrorBeams mirror_beams_build(const BeamTools *tools, const LightSelection *selection,
                               Arena *arena)
{
    Beams beams = {.tools = tools, .arena = arena};
    if (!lights_has(tools->lights, LIGHTS_SUN)) return (MirrorBeams){NULL, NULL};
    beams.lm = ARENA_NEW(arena, double, 2 * ((size_t)tools->scene->part_count + 1));
    send_rays(&beams);
    if (!beams.count) return (MirrorBeams){NULL, NULL};
    qsort(beams.pairs, beams.count, sizeof *beams.pairs, compare_pairs);
    return (MirrorBeams){mirrors_build(tools->scene, beams.pairs, beams.count, arena),
                         weigh_parts(tools->scene, beams.lm, selection, arena)};
}
