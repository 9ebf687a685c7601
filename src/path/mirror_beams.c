#include "path/mirror_beams.h"

#include <stdlib.h>

#include "base/mathf.h"
#include "mirror/mirrors_build.h"
#include "shaders/microfacet.h"
#include "spectrum/photometry.h"

#define LEAST_RAYS 8       /* to every mirror, and by its area in all of theirs */
#define RAYS_BY_AREA 200000
#define SHEETS_PASSED 16   /* by one ray behind its mirror */
#define GENEROSITY 1.0f    /* they are asked at every hit where all light is theirs */
#define LEAST 0.025f

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
    bool     is_rough;
    double   lm;
} Beam;

static bool always_passes(void *user, const Hit *hit)
{
    (void)user;
    (void)hit;
    return true;
}

/* Rays of one mirror come one after the other. */
static void add_pair(Beams *beams, MirrorPair pair)
{
    for (uint32_t i = beams->count; i > 0 && beams->pairs[i - 1].triangle == pair.triangle; i--)
        if (!mirrors_compare_pairs(&beams->pairs[i - 1], &pair)) return;
    beams->pairs = ARENA_GROW(beams->arena, MirrorPair, beams->pairs, beams->count,
                              beams->count + 1);
    beams->pairs[beams->count++] = pair;
}

/* What scatters into less than a rough mirror does finds the sun in it by itself. */
static bool is_asked_of(const Scene *scene, int part_id, const Beam *beam)
{
    const Material *m = &scene->materials[scene->parts[part_id].material_id];
    return !beam->is_rough || m->roughness * m->roughness > 2 * GLINT_ALPHA;
}

/* All parts along the ray, up to one that stops it. */
static void follow(Beams *beams, Beam beam)
{
    const Scene *scene = beams->tools->scene;
    Hit hit;
    add_pair(beams, (MirrorPair){NO_ID, beam.is_rough, beam.triangle});
    for (int i = 0; i < SHEETS_PASSED && bvh_intersect(beams->tools->bvh, beam.ray, 0, &hit);
         i++) {
        TrianglePoint point = triangle_point(scene, hit.triangle, hit.u, hit.v);
        int part_id = (int)scene->triangles[hit.triangle].part_id;
        if (is_asked_of(scene, part_id, &beam)) {
            add_pair(beams, (MirrorPair){part_id, beam.is_rough, beam.triangle});
            beams->lm[2 * part_id + (vec3_dot(point.ng, beam.ray.direction) > 0)] += beam.lm;
        }
        if (hit.triangle < scene->opaque_count) return;
        beam.ray.origin = ray_offset_origin(point.position, point.ng, beam.ray.direction);
    }
}

/* Luminous flux that the sun's ray takes on, per m2 of the mirror; of a rough one about. */
static double reflected_lx(const Lights *lights, const Surface *mirror, const LightSample *sun,
                           Vec3 local_wo, const Wavelengths *wavelengths)
{
    float    xyz[3] = {0};
    Spectrum smooth = bsdf_mirror(&mirror->bsdf, local_wo);
    Spectrum share = spectrum_is_zero(smooth) ? bsdf_albedo(&mirror->bsdf, local_wo) : smooth;
    share *= spectrum_all(fabsf(vec3_dot(mirror->ng, sun->wi)) / sun->pdf);
    spectrum_add_xyz(wavelengths, share * lights_radiance(lights, sun, wavelengths), xyz);
    return isfinite(xyz[1]) ? (double)xyz[1] : 0;
}

/* A rough mirror's facet, leaning as GGX facets do. */
static Vec3 facet_normal(Vec3 ns, float alpha, Vec2 u)
{
    Frame frame = frame_from_z(ns);
    float sine, cosine, lean = alpha * sqrtf(u.x / (1 - u.x));
    sincos_turns(u.y, &sine, &cosine);
    return vec3_normalize(frame_to_world(&frame, vec3(lean * cosine, lean * sine, 1)));
}

/* By a mirror's triangle: smooth where alpha is 0. */
typedef struct Aim {
    uint32_t triangle;
    float    alpha;
    double   ray_m2; /* that one ray stands for */
} Aim;

/* The sampler's numbers in turn: wavelengths, place, direction, facet. */
static void send_ray(Beams *beams, const Aim *aim, Sampler sampler)
{
    const BeamTools *tools = beams->tools;
    Wavelengths wavelengths;
    Surface     mirror;
    LightSample sun;
    wavelengths_sample(sampler_1d(&sampler), &wavelengths);
    Vec2 at = sampler_2d(&sampler), disc = sampler_2d(&sampler), lean = sampler_2d(&sampler);
    const float u[3] = {disc.x, disc.y, 0};
    if (at.x + at.y > 1) at = (Vec2){1 - at.x, 1 - at.y};
    Hit hit = {0, at.x, at.y, aim->triangle};
    TrianglePoint point = triangle_point(tools->scene, aim->triangle, at.x, at.y);
    LitPoint      place = {point.position, point.ns, true};
    if (!lights_sample(tools->lights, LIGHTS_SUN, place, u, &sun)) return;
    Vec3 n = aim->alpha > 0 ? facet_normal(point.ns, aim->alpha, lean) : point.ns;
    Vec3 r = vec3_sub(vec3_scale(n, 2 * vec3_dot(n, sun.wi)), sun.wi);
    if (!(vec3_dot(point.ng, r) * vec3_dot(point.ng, sun.wi) > 0)) return;
    Vec3 origin = ray_offset_origin(point.position, point.ng, r);
    if (bvh_occluded(tools->bvh, (Ray){origin, sun.wi, 0, INFINITY}, always_passes, NULL))
        return;
    surface_at(tools->scene, tools->tables, &hit, r, &wavelengths, &mirror);
    double lx = reflected_lx(tools->lights, &mirror, &sun, frame_to_local(&mirror.frame, r),
                             &wavelengths);
    if (lx > 0)
        follow(beams, (Beam){{origin, r, 0, INFINITY}, aim->triangle, aim->alpha > 0,
                             lx * aim->ray_m2});
}

static double area_m2(const Scene *scene, uint32_t triangle)
{
    Vec3 p[3];
    for (int i = 0; i < 3; i++) p[i] = scene_corner(scene, triangle, i);
    return 0.5 * (double)vec3_length(vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0])));
}

/* More to large ones. all_m2: of all that are aimed at. */
static void send_rays(Beams *beams, Aim aim, double all_m2)
{
    double   own = area_m2(beams->tools->scene, aim.triangle);
    uint32_t rays = LEAST_RAYS + (uint32_t)(RAYS_BY_AREA * own / all_m2);
    aim.ray_m2 = own / rays;
    for (uint32_t k = 0; k < rays; k++)
        send_ray(beams, &aim, sampler_start(aim.alpha > 0, (int)aim.triangle, 0, k));
}

/* To what of each material is smooth, and to what is rough. */
static void send_all_rays(Beams *beams)
{
    const Scene *scene = beams->tools->scene;
    bool  *is_smooth_one = ARENA_NEW(beams->arena, bool, scene->material_count + 1);
    double all_m2 = 0;
    for (int i = 0; i < scene->material_count; i++)
        is_smooth_one[i] = mirrors_can_be(scene, &scene->materials[i]);
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t i = 0; i < scene->triangle_count; i++) {
            int   id = scene_part(scene, i)->material_id;
            float alpha = mirrors_rough_alpha(&scene->materials[id]);
            if (pass == 0 && (is_smooth_one[id] || alpha > 0)) all_m2 += area_m2(scene, i);
            if (pass == 1 && is_smooth_one[id]) send_rays(beams, (Aim){i, 0, 0}, all_m2);
            if (pass == 1 && alpha > 0) send_rays(beams, (Aim){i, alpha, 0}, all_m2);
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
    send_all_rays(&beams);
    if (!beams.count) return (MirrorBeams){NULL, NULL};
    qsort(beams.pairs, beams.count, sizeof *beams.pairs, mirrors_compare_pairs);
    return (MirrorBeams){mirrors_build(tools->scene, beams.pairs, beams.count, arena),
                         weigh_parts(tools->scene, beams.lm, selection, arena)};
}
