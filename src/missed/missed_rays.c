/* SPDX-License-Identifier: Apache-2.0 */
#include "missed/missed_rays.h"

#include <math.h>

#include "base/mathf.h"
#include "base/parallel.h"
#include "missed/missed_eye.h"
#include "mirror/mirrors.h"
#include "path/direct.h"
#include "scene/point/ray_ends.h"
#include "shaders/facets/microfacet.h"

#define LEAST_RAYS 4      /* to every smooth part; besides */
#define RAYS_A_PART 16384 /* shared evenly by the parts, and */
#define RAYS_BY_AREA 16384
#define SHEETS_PASSED 16
#define DIM 1e-3f                      /* of a ray's light at its start: less is not followed */
#define PARALLEL 1e-3f                 /* sine of the angle between a plate's faces, at most */
#define PIECES 64                      /* of the rays; the same for any number of threads */
#define WORKER_BYTES ((size_t)1 << 30) /* address space */
#define FIRST_ROOM 256
#define SEED 0x6d697373u

/* ---- areas ------------------------------------------------------------------------------- */

static void add_area(const Scene *scene, AreaList *list, uint32_t triangle) {
    Vec3 a = scene_corner(scene, triangle, 0);
    Vec3 normal = vec3_cross(vec3_sub(scene_corner(scene, triangle, 1), a),
                             vec3_sub(scene_corner(scene, triangle, 2), a));
    double before = area_list_m2(list);
    list->triangle[list->count] = triangle;
    list->until[list->count++] = before + 0.5 * (double)vec3_length(normal);
}

static AreaList area_list_start(size_t room, Arena *arena) {
    return (AreaList){ARENA_NEW(arena, uint32_t, room), ARENA_NEW(arena, double, room), 0};
}

static AreaList area_list_of_part(const Scene *scene, int part_id, Arena *arena) {
    const Part *part = &scene->parts[part_id];
    AreaList list = area_list_start(part->triangle_count + 1, arena);
    for (uint32_t i = 0; i < part->triangle_count; i++)
        add_area(scene, &list, part->first_triangle + i);
    return list;
}

static int display_of(const Scene *scene, uint32_t triangle) {
    return scene->materials[scene_part(scene, triangle)->material_id].display_id;
}

AreaList area_list_of_display(const Scene *scene, int display_id, Arena *arena) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->triangle_count; i++)
        count += display_of(scene, i) == display_id;
    AreaList list = area_list_start(count + 1, arena);
    for (uint32_t i = 0; i < scene->triangle_count; i++)
        if (display_of(scene, i) == display_id) add_area(scene, &list, i);
    return list;
}

uint32_t area_list_at(const AreaList *list, double m2) {
    int low = 0, high = list->count - 1;
    while (low < high) {
        int middle = (low + high) / 2;
        if (list->until[middle] > m2) high = middle;
        else low = middle + 1;
    }
    return list->triangle[low];
}

/* ---- what all rays share, and one ray ---------------------------------------------------- */

typedef struct EyeTiles {
    const MissedEye *eye;
    int first_tile;
    double m2; /* of a display */
} EyeTiles;

/* A part with smooth surfaces, to which so many rays go. */
typedef struct Target {
    int part_id;
    AreaList area;
    uint32_t rays, before; /* before: to the targets in front of it */
} Target;

typedef struct MissedWork {
    const PathContext *context;
    const Wavelengths *wavelengths; /* of all rays: what they bring is an estimate */
    const EyeTiles *eyes;
    int eye_count;
    const double *part_m2;
    const Target *targets;
    int target_count;
    uint32_t rays;
    MissedFinds *pieces;
    uint32_t *rooms;
    Arena *arenas; /* one a worker */
} MissedWork;

typedef struct MissedBeam {
    const MissedWork *work;
    MissedFinds *finds;
    uint32_t *room;
    Arena *arena;
    Ray ray;
    Spectrum power; /* of all wavelengths, W m^-2 sr^-1 nm^-1 times m^2 sr: becomes lm */
    float start;    /* the brightest lane at the start */
    float length;   /* m, from the light on */
    int medium_id;
    bool is_plate; /* in a solid that it came into by a flat face, without reflections since; */
    Vec3 face;     /* that face's normal */
    int events;
    LightChain chain;
    MissedFind find; /* whose light, by which parts */
} MissedBeam;

static void add_find(MissedBeam *beam, int tile, float light) {
    MissedFinds *finds = beam->finds;
    if (!(light > 0) || !isfinite(light)) return;
    if (finds->count == *beam->room) {
        *beam->room = *beam->room ? 2 * *beam->room : FIRST_ROOM;
        finds->list = ARENA_GROW(beam->arena, MissedFind, finds->list, finds->count, *beam->room);
    }
    MissedFind *find = &finds->list[finds->count++];
    *find = beam->find;
    find->tile = tile;
    find->light = light;
}

/* Share of the light that goes along the ray to its end. */
static Spectrum share_along(const MissedWork *work, Ray ray) {
    const PathContext *c = work->context;
    Spectrum share = spectrum_all(1);
    Hit hit;
    for (int i = 0; bvh_intersect(c->bvh, ray, 0, &hit); i++) {
        if (hit.triangle < c->scene->opaque_count || i == SHEETS_PASSED) return spectrum_all(0);
        share *= surface_pass(c->scene, c->tables, &hit, ray.direction, work->wavelengths);
        if (spectrum_is_zero(share)) return share;
        ray = ray_behind(c->scene, ray, &hit);
    }
    return share;
}

static float luminous(const MissedWork *work, Spectrum power) {
    float xyz[3] = {0};
    spectrum_add_xyz(work->wavelengths, power, xyz);
    return xyz[1];
}

/* ---- what an eye has of it --------------------------------------------------------------- */

/* wo: unit, from the place to where the light comes from. */
static void show_camera(MissedBeam *beam, const EyeTiles *tiles, const Surface *surface, Vec3 wo) {
    EyePlace place;
    float pdf;
    if (!eye_place_of(tiles->eye->camera, surface->position, &place)) return;
    Vec3 to = place.ray.direction, local = frame_to_local(&surface->frame, to);
    if (!direct_sides_agree(surface, local, to, wo)) return;
    Spectrum f = bsdf_eval(&surface->bsdf, surface->local_wo, local, &pdf);
    if (spectrum_is_zero(f)) return;
    place.ray.origin = ray_start(&surface->point, to);
    f *= beam->power * spectrum_all(fabsf(local.z) * place.per_flux * surface->alpha);
    int column = (int)(place.x * MISSED_SIDE), row = (int)(place.y * MISSED_SIDE);
    add_find(beam, tiles->first_tile + row * MISSED_SIDE + column,
             MISSED_SIDE * MISSED_SIDE *
                 luminous(beam->work, f * share_along(beam->work, place.ray)));
}

static void show(MissedBeam *beam, const Surface *surface, Vec3 wo) {
    const MissedWork *work = beam->work;
    for (int i = 0; i < work->eye_count; i++) {
        const EyeTiles *tiles = &work->eyes[i];
        if (tiles->eye->camera) show_camera(beam, tiles, surface, wo);
        else if (display_of(work->context->scene, surface->triangle) == tiles->eye->display_id &&
                 vec3_dot(wo, surface->ng) > 0 && tiles->m2 > 0)
            add_find(beam, tiles->first_tile, luminous(work, beam->power) / (float)tiles->m2);
    }
}

/* Would chance hardly find the light, from a surface at the end of the way? */
static bool is_compact(const MissedBeam *beam) {
    if (beam->chain.from != CHAIN_EMITTER) return true;
    double m2 = beam->work->part_m2[beam->find.light_id];
    return m2 < (double)(MISSED_COMPACT_SR * beam->length * beam->length);
}

static bool meet(const MissedWork *work, Ray *ray, Hit *hit, Surface *surface, Spectrum *power) {
    const PathContext *c = work->context;
    for (int i = 0; i < SHEETS_PASSED && bvh_intersect(c->bvh, *ray, 0, hit); i++) {
        surface_at(c->scene, c->tables, hit, vec3_neg(ray->direction), work->wavelengths, surface);
        bsdf_carry(&surface->bsdf, power);
        if (surface->alpha > 0 && !bsdf_is(&surface->bsdf, BSDF_IS_SHEET)) return true;
        *power *= surface_pass(c->scene, c->tables, hit, ray->direction, work->wavelengths);
        *ray = ray_behind(c->scene, *ray, hit);
    }
    return false;
}

/* On a surface that scatters: what eyes see of it, and of one more that it lights. */
static void land(const MissedBeam *beam, const Surface *surface, Vec3 wo, const float u[3]) {
    const PathContext *c = beam->work->context;
    MissedBeam lit = *beam;
    LightChain chain = beam->chain;
    BsdfSample next;
    Surface other;
    Hit hit;
    chain.others += beam->medium_id != NO_ID;
    if (!bsdf_scatters(&surface->bsdf) || chain_is_connected(c, &chain) || !is_compact(beam))
        return;
    show(&lit, surface, wo);
    if (beam->events + 1 >= c->max_bounces ||
        !bsdf_sample(&surface->bsdf, surface->local_wo, u, &next) || next.is_delta || next.passes)
        return;
    Vec3 wi = frame_to_world(&surface->frame, next.wi);
    if (!direct_sides_agree(surface, next.wi, wi, wo)) return;
    lit.power *= next.weight * spectrum_all(surface->alpha);
    lit.ray = (Ray){ray_start(&surface->point, wi), vec3_normalize(wi), 0, INFINITY};
    if (meet(beam->work, &lit.ray, &hit, &other, &lit.power) && bsdf_scatters(&other.bsdf))
        show(&lit, &other, vec3_neg(lit.ray.direction));
}

/* ---- the way ----------------------------------------------------------------------------- */

static void absorb(const MissedWork *work, int medium_id, float distance, Spectrum *power) {
    const Material *m = &work->context->scene->materials[medium_id];
    if (!isfinite(m->attenuation_distance_m)) return;
    Spectrum left = spectrum_from_rgb(work->wavelengths, m->attenuation_color);
    for (int i = 0; i < SPECTRUM_LANES; i++)
        (*power)[i] *= pow_f(left[i], distance / m->attenuation_distance_m);
}

static bool is_unbent(const Surface *surface) {
    return fabsf(vec3_dot(surface->point.ns, surface->frame.z)) > 1 - 1e-6f;
}

static bool is_flat(const Surface *surface) {
    return is_unbent(surface) && vec3_dot(surface->point.ns, surface->ng) > 1 - 1e-6f;
}

/* The next part on its way, by its mirror or into it. */
static void name_part(MissedBeam *beam, int part_id, bool is_solid) {
    MissedFind *find = &beam->find;
    if (find->part_id == NO_ID) {
        find->part_id = part_id;
        find->is_solid = is_solid;
    } else if (find->then_id == NO_ID) {
        find->then_id = part_id;
    }
}

/* Counts what happens at the surface. */
static void note_event(MissedBeam *beam, const Surface *surface, bool crosses) {
    const Scene *scene = beam->work->context->scene;
    LightChain *chain = &beam->chain;
    beam->events++;
    if (!crosses && beam->medium_id != NO_ID) {
        beam->is_plate = false;
    } else if (!crosses) {
        bool is_plain = mirrors_can_be(scene, &scene->materials[surface->material_id]);
        *(is_plain && is_unbent(surface) ? &chain->mirrors : &chain->others) += 1;
        name_part(beam, surface->part_id, false);
    } else if (beam->medium_id == NO_ID) {
        beam->medium_id = surface->material_id;
        beam->is_plate = is_flat(surface);
        beam->face = surface->ng;
        name_part(beam, surface->part_id, true);
    } else {
        Vec3 apart = vec3_cross(beam->face, surface->ng);
        bool is_plate = beam->is_plate && is_flat(surface) &&
                        vec3_dot(apart, apart) < PARALLEL * PARALLEL &&
                        beam->medium_id == surface->material_id;
        *(is_plate ? &chain->plates : &chain->others) += 1;
        beam->medium_id = NO_ID;
    }
}

/* Mirrors send on all that they reflect; whether a solid reflects or refracts, and which way a
 * coated one goes on, is drawn. False: not by a smooth boundary. */
static bool choose(const Surface *surface, const float u[3], BsdfSample *next) {
    Vec3 wo = surface->local_wo;
    if (bsdf_is(&surface->bsdf, BSDF_REFRACTS))
        return bsdf_sample(&surface->bsdf, wo, u, next) && next->is_delta && !next->passes;
    *next = (BsdfSample){.wi = vec3(-wo.x, -wo.y, wo.z),
                         .weight = bsdf_mirror(&surface->bsdf, wo),
                         .is_delta = true};
    return !spectrum_is_zero(next->weight);
}

/* False: it ends there. wo: unit, to where the light comes from. */
static bool turn(MissedBeam *beam, const Surface *surface, Vec3 wo, const float u[3]) {
    BsdfSample next;
    if (beam->events == MISSED_EVENTS || beam->events + 1 >= beam->work->context->max_bounces ||
        !choose(surface, u, &next))
        return false;
    Vec3 wi = frame_to_world(&surface->frame, next.wi);
    if (!direct_sides_agree(surface, next.wi, wi, wo)) return false;
    bool crosses = next.wi.z * surface->local_wo.z < 0;
    const Dielectric *solid = surface_clear_solid(surface);
    float index = solid ? solid->ior : 1;
    float before = beam->medium_id == NO_ID ? 1 : index;
    note_event(beam, surface, crosses);
    /* the weight is of radiance, which a denser medium squeezes; the flux is not */
    float after = beam->medium_id == NO_ID ? 1 : index;
    float squeezed = crosses ? after / before : 1;
    beam->power *= next.weight * spectrum_all(squeezed * squeezed * surface->alpha);
    beam->ray = (Ray){ray_start(&surface->point, wi), vec3_normalize(wi), 0, INFINITY};
    return spectrum_max_lane(beam->power) > DIM * beam->start;
}

/* From a first smooth surface on. */
static void follow(MissedBeam *beam, Sampler *sampler) {
    const MissedWork *work = beam->work;
    const PathContext *c = work->context;
    for (int i = 0; i < MISSED_EVENTS + SHEETS_PASSED; i++) {
        Hit hit;
        Surface surface;
        float u[4], v[4];
        Vec3 wo = vec3_neg(beam->ray.direction);
        sampler_4d(sampler, u);
        sampler_4d(sampler, v);
        if (!bvh_intersect(c->bvh, beam->ray, 0, &hit)) return;
        if (beam->medium_id != NO_ID) absorb(work, beam->medium_id, hit.t, &beam->power);
        beam->length += hit.t;
        surface_at(c->scene, c->tables, &hit, wo, work->wavelengths, &surface);
        bsdf_carry(&surface.bsdf, &beam->power);
        land(beam, &surface, wo, v);
        bool may_pass = hit.triangle >= c->scene->opaque_count;
        if (may_pass && u[3] < 0.5f) { /* straight on, or by its own boundary */
            beam->power *= spectrum_all(2) * surface_pass(c->scene, c->tables, &hit,
                                                          beam->ray.direction, work->wavelengths);
            beam->ray = ray_behind(c->scene, beam->ray, &hit);
            if (!(spectrum_max_lane(beam->power) > DIM * beam->start)) return;
            continue;
        }
        if (may_pass) beam->power *= spectrum_all(2);
        if (!turn(beam, &surface, wo, u)) return;
    }
}

/* ---- from the lights --------------------------------------------------------------------- */

static ChainLight chain_light(LightSet set) {
    return set == LIGHTS_SUN ? CHAIN_SUN : set == LIGHTS_PUNCTUAL ? CHAIN_LAMP : CHAIN_EMITTER;
}

static int light_of(const Scene *scene, const LightSample *light) {
    if (light->set == LIGHTS_EMITTERS) return (int)scene->triangles[light->triangle].part_id;
    return light->set == LIGHTS_PUNCTUAL ? light->light_id : 0;
}

/* From one light to the place, which stands for m2 of its part, and on. */
static void send(MissedBeam *beam, LightSet set, const Hit *hit, double m2, Sampler *sampler) {
    const MissedWork *work = beam->work;
    const PathContext *c = work->context;
    TrianglePoint point = triangle_point(c->scene, hit->triangle, hit->u, hit->v);
    LitPoint place = {point.position, point.ns, true};
    LightSample light;
    Surface surface;
    float u[4], v[4];
    sampler_4d(sampler, u);
    sampler_4d(sampler, v);
    if (!lights_has(c->lights, set) || !lights_sample(c->lights, set, place, u, &light)) return;
    Vec3 wo = light.wi;
    beam->power = share_along(work, lights_ray(ray_start(&point, wo), &light));
    if (spectrum_is_zero(beam->power)) return;
    surface_at(c->scene, c->tables, hit, wo, work->wavelengths, &surface);
    beam->power *= lights_radiance(c->lights, &light, work->wavelengths) *
                   spectrum_all(fabsf(vec3_dot(point.ng, wo)) / light.pdf * (float)m2);
    bsdf_carry(&surface.bsdf, &beam->power);
    beam->start = spectrum_max_lane(beam->power);
    beam->length = isfinite(light.distance) ? light.distance : 0;
    bool is_inside = bsdf_is(&surface.bsdf, BSDF_REFRACTS) && vec3_dot(wo, surface.ng) < 0;
    beam->medium_id = is_inside ? surface.material_id : NO_ID;
    beam->is_plate = false;
    beam->events = 0;
    const int *compact = c->beams[BEAMS_OF_EMITTERS].emitters.of_part;
    beam->chain = (LightChain){.from = chain_light(set)};
    if (set == LIGHTS_EMITTERS && compact)
        beam->chain.is_compact = compact[light_of(c->scene, &light)] != NO_ID;
    beam->find = (MissedFind){.from = beam->chain.from,
                              .light_id = light_of(c->scene, &light),
                              .part_id = is_inside ? surface.part_id : NO_ID,
                              .is_solid = is_inside,
                              .then_id = NO_ID};
    if (turn(beam, &surface, wo, v)) follow(beam, sampler);
}

static void send_ray(MissedBeam *beam, const Target *target, uint32_t k) {
    static const LightSet SETS[] = {LIGHTS_SUN, LIGHTS_EMITTERS, LIGHTS_PUNCTUAL};
    double all = area_list_m2(&target->area);
    for (int i = 0; i < 3; i++) {
        Sampler sampler = sampler_start(SEED, target->part_id, (int)SETS[i], k);
        float u[4];
        sampler_4d(&sampler, u);
        Vec2 at = {u[1], u[2]};
        if (at.x + at.y > 1) at = (Vec2){1 - at.x, 1 - at.y};
        double m2 = ((double)k + (double)u[0]) / target->rays * all;
        Hit hit = {0, at.x, at.y, area_list_at(&target->area, m2)};
        send(beam, SETS[i], &hit, all / target->rays, &sampler);
    }
}

static void send_piece(void *user, int item, int worker) {
    MissedWork *work = user;
    uint32_t first = (uint32_t)((uint64_t)work->rays * (uint64_t)item / PIECES);
    uint32_t end = (uint32_t)((uint64_t)work->rays * ((uint64_t)item + 1) / PIECES);
    MissedBeam beam = {.work = work,
                       .finds = &work->pieces[item],
                       .room = &work->rooms[item],
                       .arena = &work->arenas[worker]};
    for (int t = 0; t < work->target_count; t++) {
        const Target *target = &work->targets[t];
        for (uint32_t k = 0; k < target->rays; k++)
            if (target->before + k >= first && target->before + k < end) send_ray(&beam, target, k);
    }
}

bool missed_is_smooth(const Scene *scene, const Material *m) {
    bool sends = m->metallic > 0 || m->specular > 0 || m->transmission > 0;
    if (m->unlit || (m->display_id != NO_ID && !mirrors_can_be(scene, m))) return false;
    return mirrors_can_be(scene, m) || (sends && is_smooth(m->roughness * m->roughness)) ||
           (m->clearcoat > 0 && is_smooth(m->clearcoat_roughness * m->clearcoat_roughness));
}

/* Half of the rays go to the parts evenly: a small lens counts as much as a wall of glass. */
static void list_targets(MissedWork *work, Arena *arena) {
    const Scene *scene = work->context->scene;
    Target *targets = ARENA_NEW(arena, Target, scene->part_count + 1);
    double all = 0;
    for (int i = 0; i < scene->part_count; i++) {
        if (!missed_is_smooth(scene, &scene->materials[scene->parts[i].material_id])) continue;
        Target *target = &targets[work->target_count];
        *target = (Target){.part_id = i, .area = area_list_of_part(scene, i, arena)};
        work->target_count += area_list_m2(&target->area) > 0;
        all += area_list_m2(&target->area);
    }
    for (int i = 0; i < work->target_count; i++) {
        targets[i].before = work->rays;
        targets[i].rays = LEAST_RAYS + (uint32_t)(RAYS_A_PART / work->target_count) +
                          (uint32_t)(RAYS_BY_AREA * area_list_m2(&targets[i].area) / all);
        work->rays += targets[i].rays;
    }
    work->targets = targets;
}

static EyeTiles *list_eyes(const Scene *scene, const MissedEye *eyes, int count, Arena *arena) {
    EyeTiles *out = ARENA_NEW(arena, EyeTiles, count + 1);
    int tiles = 0;
    for (int i = 0; i < count; i++) {
        out[i] = (EyeTiles){.eye = &eyes[i], .first_tile = tiles};
        Arena scratch = *arena;
        AreaList front = {0};
        if (!eyes[i].camera) front = area_list_of_display(scene, eyes[i].display_id, &scratch);
        out[i].m2 = area_list_m2(&front);
        tiles += missed_tiles(&eyes[i]);
    }
    return out;
}

static double *measure_parts(const Scene *scene, Arena *arena) {
    double *m2 = ARENA_NEW(arena, double, scene->part_count + 1);
    for (int i = 0; i < scene->part_count; i++) {
        Arena scratch = *arena;
        AreaList area = area_list_of_part(scene, i, &scratch);
        m2[i] = area_list_m2(&area);
    }
    return m2;
}

MissedFinds missed_rays_send(const PathContext *context, const MissedEye *eyes, int eye_count,
                             Arena *arena) {
    int threads = bvh_threads(context->bvh);
    MissedFinds pieces[PIECES] = {{0}}, all = {0};
    uint32_t rooms[PIECES] = {0};
    Wavelengths middle;
    Arena scratch = arena_reserve(WORKER_BYTES);
    MissedWork work = {.context = context,
                       .wavelengths = &middle,
                       .eyes = list_eyes(context->scene, eyes, eye_count, &scratch),
                       .eye_count = eye_count,
                       .part_m2 = measure_parts(context->scene, &scratch),
                       .pieces = pieces,
                       .rooms = rooms};
    wavelengths_sample(0.5f, &middle);
    list_targets(&work, &scratch);
    work.arenas = ARENA_NEW(&scratch, Arena, threads);
    for (int i = 0; i < threads; i++) work.arenas[i] = arena_reserve(WORKER_BYTES);
    if (work.rays) parallel_for(threads, PIECES, send_piece, &work);
    for (int p = 0; p < PIECES; p++) all.count += pieces[p].count;
    all.list = ARENA_NEW(arena, MissedFind, all.count + 1);
    uint32_t count = 0;
    for (int p = 0; p < PIECES; p++)
        for (uint32_t i = 0; i < pieces[p].count; i++) all.list[count++] = pieces[p].list[i];
    for (int i = 0; i < threads; i++) arena_release(&work.arenas[i]);
    arena_release(&scratch);
    return all;
}
