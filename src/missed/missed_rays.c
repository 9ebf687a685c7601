/* SPDX-License-Identifier: Apache-2.0 */
#include "missed/missed_rays.h"

#include <math.h>

#include "base/parallel.h"
#include "base/units.h"
#include "mirror/mirrors.h"
#include "path/direct.h"
#include "path/mirror_share.h"
#include "scene/point/ray_ends.h"
#include "shaders/facets/microfacet.h"

#define LEAST_RAYS 4      /* to every smooth part; besides */
#define RAYS_A_PART 16384 /* shared evenly by the parts, and */
#define RAYS_BY_AREA 16384
#define SHEETS_PASSED 16
#define DIM 1e-3f                      /* of a ray's light at its start: less is not followed */
#define PIECES 64                      /* of the rays */
#define WORKER_BYTES ((size_t)1 << 30) /* address space */
#define FIRST_ROOM 256
#define SEED 0x6d697373u

/* ---- areas ------------------------------------------------------------------------------- */

const double *areas_measure(const Scene *scene, Arena *arena) {
    double *m2 = ARENA_NEW(arena, double, scene->triangle_count + 1);
    for (int id = 0; id < scene->part_count; id++) {
        const Part *part = &scene->parts[id];
        double sum = 0;
        for (uint32_t i = 0; i < part->triangle_count; i++)
            m2[part->first_triangle + i] = sum +=
                scene_triangle_m2(scene, part->first_triangle + i);
    }
    return m2;
}

Hit areas_point(const Scene *scene, const double *areas, int part_id, double m2, Vec2 at) {
    const Part *part = &scene->parts[part_id];
    uint32_t low = part->first_triangle, high = low + part->triangle_count - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (areas[middle] > m2) high = middle;
        else low = middle + 1;
    }
    if (at.x + at.y > 1) at = (Vec2){1 - at.x, 1 - at.y};
    return (Hit){0, at.x, at.y, low};
}

/* ---- what all rays share, and one ray ---------------------------------------------------- */

/* Finds of one worker. */
typedef struct FindList {
    MissedFind *list;
    uint32_t count, room;
    Arena arena;
} FindList;

typedef struct MissedWork {
    const PathContext *context;
    const Wavelengths *wavelengths; /* of all rays: what they bring is an estimate */
    const EyeTiles *eyes;
    int eye_count;
    const double *areas;
    double smooth_m2; /* of the parts with smooth surfaces, to which rays go */
    int smooth_count;
    FindList *lists; /* one a worker */
} MissedWork;

typedef struct MissedBeam {
    const MissedWork *work;
    FindList *finds;
    Ray ray;
    Spectrum power; /* of all wavelengths, W m^-2 sr^-1 nm^-1 times m^2 sr: becomes lm */
    float start;    /* the brightest lane at the start */
    float length;   /* m, from the light on */
    int medium_id;
    bool is_scattered;
    LightChain chain;
    MissedWay way;
} MissedBeam;

static void add_find(const MissedBeam *beam, int tile, float light) {
    FindList *to = beam->finds;
    if (!(light > 0) || !isfinite(light)) return;
    if (to->count == to->room) {
        to->room = to->room ? 2 * to->room : FIRST_ROOM;
        to->list = ARENA_GROW(&to->arena, MissedFind, to->list, to->count, to->room);
    }
    to->list[to->count++] = (MissedFind){beam->way, tile, light};
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

/* ---- where a camera's picture shows a place ---------------------------------------------- */

/* The picture's area is A, in the units of half_width; a solid angle dw at the camera is dA of
 * it. A piece dS of a surface at the distance r fills dw = dS cos / r^2, and has the luminance
 * f lm / dS: its share of the mean over A is f lm cos (dA / dw) / (A r^2). */

/* dA / dw, and the place, of a direction in the camera's axes. False: out of view. */
static bool place_of_direction(const Camera *camera, Vec3 d, Vec2 *place, float *density) {
    if (!(d.z < 0)) return false;
    if (!camera->fisheye) {
        *place = (Vec2){d.x / -d.z, d.y / -d.z};
        *density = 1 / (-d.z * d.z * d.z);
        return true;
    }
    float angle = acosf(fminf(-d.z, 1)), sine = fmaxf(sinf(angle), 1e-6f);
    bool is_equisolid = camera->fisheye == FISHEYE_EQUISOLID;
    float r = is_equisolid ? sqrtf(1 + d.z) : 2 * INV_PI_F * angle;
    *place = (Vec2){r * d.x / sine, r * d.y / sine};
    *density = is_equisolid ? 0.5f : 2 * INV_PI_F * r / sine;
    return true;
}

bool eye_place_of(const Camera *camera, Vec3 position, EyePlace *out) {
    const Transform *world = &camera->world_from_camera;
    Vec3 away = vec3_sub(position, world->origin);
    Vec3 local = vec3(vec3_dot(away, world->x), vec3_dot(away, world->y), vec3_dot(away, world->z));
    float distance = vec3_length(away), density = 1;
    Vec2 place = {local.x, local.y};
    if (camera->is_perspective) {
        if (!(distance > 0) ||
            !place_of_direction(camera, vec3_scale(local, 1 / distance), &place, &density))
            return false;
        density /= distance * distance;
        out->ray = (Ray){position, vec3_scale(away, -1 / distance), 0, distance};
    } else {
        if (!(local.z < 0)) return false;
        out->ray = (Ray){position, world->z, 0, -local.z};
    }
    out->x = 0.5f * (place.x / camera->half_width + 1);
    out->y = 0.5f * (1 - place.y / camera->half_height);
    out->per_flux = density / (4 * camera->half_width * camera->half_height);
    return out->x >= 0 && out->x < 1 && out->y >= 0 && out->y < 1;
}

/* ---- what an eye has of it --------------------------------------------------------------- */

/* wo: unit, from the place to where the light comes from. */
static void show_camera(const MissedBeam *beam, const EyeTiles *eye, const Surface *surface,
                        Vec3 wo) {
    EyePlace place;
    float pdf;
    if (!eye_place_of(eye->eye->camera, surface->position, &place)) return;
    Vec3 to = place.ray.direction, local = frame_to_local(&surface->frame, to);
    if (!direct_sides_agree(surface, local, to, wo)) return;
    Spectrum f = bsdf_eval(&surface->bsdf, surface->local_wo, local, &pdf);
    if (spectrum_is_zero(f)) return;
    place.ray.origin = ray_start(&surface->point, to);
    f *= beam->power * spectrum_all(fabsf(local.z) * place.per_flux * surface->alpha);
    int column = (int)(place.x * MISSED_SIDE), row = (int)(place.y * MISSED_SIDE);
    float light = luminous(beam->work, f * share_along(beam->work, place.ray));
    add_find(beam, eye->first + row * MISSED_SIDE + column, (float)eye->count * light);
}

static void show(const MissedBeam *beam, const Surface *surface, Vec3 wo) {
    const MissedWork *work = beam->work;
    int display_id = work->context->scene->materials[surface->material_id].display_id;
    for (int i = 0; i < work->eye_count; i++) {
        const EyeTiles *eye = &work->eyes[i];
        if (eye->eye->camera) show_camera(beam, eye, surface, wo);
        else if (display_id == eye->eye->display_id && vec3_dot(wo, surface->ng) > 0)
            add_find(beam, eye->first, luminous(work, beam->power) / (float)eye->m2);
    }
}

/* ---- the way ----------------------------------------------------------------------------- */

/* Does chance hardly find it? */
static bool is_compact(const MissedBeam *beam) {
    const MissedWork *work = beam->work;
    if (beam->way.from != CHAIN_EMITTER) return true;
    double m2 = areas_of_part(work->context->scene, work->areas, beam->way.light_id);
    return m2 < (double)(MISSED_COMPACT_SR * beam->length * beam->length);
}

static int events(const MissedBeam *beam) {
    return beam->chain.mirrors + beam->chain.others;
}

static void follow(MissedBeam *beam, Hit hit, Sampler *sampler);

static bool leave(MissedBeam *beam, const Surface *surface, Vec3 local, Vec3 wo) {
    Vec3 wi = frame_to_world(&surface->frame, local);
    beam->ray = (Ray){ray_start(&surface->point, wi), vec3_normalize(wi), 0, INFINITY};
    return direct_sides_agree(surface, local, wi, wo);
}

/* On a surface that scatters: what eyes see of it, and of one more that it lights. */
static void land(const MissedBeam *beam, const Surface *surface, Vec3 wo, Sampler *sampler) {
    const PathContext *c = beam->work->context;
    MissedBeam lit = *beam;
    BsdfSample next;
    Hit hit;
    float u[4];
    if (!bsdf_scatters(&surface->bsdf) ||
        (!beam->is_scattered && (chain_is_connected(c, &beam->chain) || !is_compact(beam))))
        return;
    show(beam, surface, wo);
    sampler_4d(sampler, u);
    if (beam->is_scattered || events(beam) + 1 >= c->max_bounces ||
        !bsdf_sample(&surface->bsdf, surface->local_wo, u, &next) || next.is_delta || next.passes ||
        !leave(&lit, surface, next.wi, wo))
        return;
    lit.is_scattered = true;
    lit.power *= next.weight * spectrum_all(surface->alpha);
    if (bvh_intersect(c->bvh, lit.ray, 0, &hit)) follow(&lit, hit, sampler);
}

/* The next part on its way, by its mirror or into it. */
static void name_part(MissedWay *way, int part_id, bool is_solid) {
    if (way->part_id == NO_ID) {
        way->part_id = part_id;
        way->is_solid = is_solid;
    } else if (way->then_id == NO_ID) {
        way->then_id = part_id;
    }
}

/* Counts what happens at a surface that is no plate, or reflects. */
static void note_event(MissedBeam *beam, const Surface *surface, Vec3 wo, bool crosses) {
    const Scene *scene = beam->work->context->scene;
    bool is_inside = beam->medium_id != NO_ID;
    bool is_mirror = !crosses && !is_inside &&
                     mirrors_can_be(scene, &scene->materials[surface->material_id]) &&
                     mirror_is_plain(scene, surface, wo);
    *(is_mirror ? &beam->chain.mirrors : &beam->chain.others) += 1;
    if (crosses) beam->medium_id = is_inside ? NO_ID : surface->material_id;
    if (!is_inside) name_part(&beam->way, surface->part_id, crosses);
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
    int most = beam->work->context->max_bounces - 1;
    if (beam->is_scattered || events(beam) >= (most < MISSED_EVENTS ? most : MISSED_EVENTS) ||
        !choose(surface, u, &next) || !leave(beam, surface, next.wi, wo))
        return false;
    bool crosses = next.wi.z * surface->local_wo.z < 0;
    note_event(beam, surface, wo, crosses);
    const Dielectric *solid = surface_clear_solid(surface);
    /* the weight is of radiance, which a denser medium squeezes; the flux is not */
    float squeezed = !crosses || !solid         ? 1
                     : beam->medium_id != NO_ID ? solid->ior
                                                : 1 / solid->ior;
    beam->power *= next.weight * spectrum_all(squeezed * squeezed * surface->alpha);
    return true;
}

/* Straight on through a window or a plate. */
static void pass(MissedBeam *beam, const Surface *surface, const Hit *hit) {
    const PathContext *c = beam->work->context;
    const Plate *plate = surface->plate;
    beam->power *= plate ? plate->pane.passed
                         : surface_pass(c->scene, c->tables, hit, beam->ray.direction,
                                        beam->work->wavelengths);
    beam->ray = plate ? ray_from_plate(beam->ray, plate) : ray_behind(c->scene, beam->ray, hit);
    if (!plate) return;
    beam->chain.plates++;
    name_part(&beam->way, surface->part_id, true);
}

/* From a hit on: the first one is that of the surface to which it was sent. */
static void follow(MissedBeam *beam, Hit hit, Sampler *sampler) {
    const PathContext *c = beam->work->context;
    const Wavelengths *wavelengths = beam->work->wavelengths;
    PlateView view = plate_view(c, wavelengths);
    for (int i = 0; i < MISSED_EVENTS + SHEETS_PASSED; i++) {
        Surface surface;
        Plate plate;
        float u[4];
        Vec3 wo = vec3_neg(beam->ray.direction);
        bool is_sent = i == 0 && !beam->is_scattered;
        sampler_4d(sampler, u);
        beam->length += hit.t;
        if (beam->medium_id != NO_ID)
            direct_absorb(c->scene, wavelengths, beam->medium_id, hit.t, &beam->power);
        surface_at(c->scene, c->tables, &hit, wo, wavelengths, &surface);
        if (beam->medium_id == NO_ID && c->plates.count &&
            plate_at(&view, &surface, &hit, beam->ray.direction, &plate))
            plate_be_pane(&plate, &surface);
        bsdf_carry(&surface.bsdf, &beam->power);
        if (!is_sent) land(beam, &surface, wo, sampler);
        /* straight on, or by its own boundary */
        bool may_pass = surface.plate || (!is_sent && hit.triangle >= c->scene->opaque_count);
        bool passes = may_pass && (beam->is_scattered || u[3] < 0.5f);
        if (may_pass && !beam->is_scattered) beam->power *= spectrum_all(2);
        if (passes) pass(beam, &surface, &hit);
        else if (!turn(beam, &surface, wo, u)) return;
        if (!(spectrum_max_lane(beam->power) > DIM * beam->start) ||
            !bvh_intersect(c->bvh, beam->ray, 0, &hit))
            return;
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
static void send(const MissedWork *work, FindList *finds, LightSet set, const Hit *hit, double m2,
                 Sampler *sampler) {
    const PathContext *c = work->context;
    const Scene *scene = c->scene;
    TrianglePoint point = triangle_point(scene, hit->triangle, hit->u, hit->v);
    const Part *part = scene_part(scene, hit->triangle);
    const Material *m = &scene->materials[part->material_id];
    LightSample light;
    float u[4];
    sampler_4d(sampler, u);
    if (!lights_has(c->lights, set) ||
        !lights_sample(c->lights, set, (LitPoint){point.position, point.ns, true}, u, &light))
        return;
    bool is_inside = m->is_solid && m->transmission > 0 && vec3_dot(light.wi, point.ng) < 0;
    const int *compact = c->beams[BEAMS_OF_EMITTERS].emitters.of_part;
    int light_id = light_of(scene, &light);
    MissedBeam beam = {
        .work = work,
        .finds = finds,
        .ray = {.direction = vec3_neg(light.wi)},
        .length = isfinite(light.distance) ? light.distance : 0,
        .medium_id = is_inside ? part->material_id : NO_ID,
        .chain = {.from = chain_light(set),
                  .others = is_inside,
                  .is_compact = set == LIGHTS_EMITTERS && compact && compact[light_id] != NO_ID},
        .way = {chain_light(set), light_id, NO_ID, false, NO_ID}};
    if (is_inside) name_part(&beam.way, (int)(part - scene->parts), true);
    beam.power = share_along(work, lights_ray(ray_start(&point, light.wi), &light));
    if (spectrum_is_zero(beam.power)) return;
    beam.power *= lights_radiance(c->lights, &light, work->wavelengths) *
                  spectrum_all(fabsf(vec3_dot(point.ng, light.wi)) / light.pdf * (float)m2);
    beam.start = spectrum_max_lane(beam.power);
    follow(&beam, *hit, sampler);
}

/* Half of the rays go to the parts evenly: a small lens counts as much as a wall of glass. */
static uint32_t rays_to(const MissedWork *work, double m2) {
    return LEAST_RAYS + (uint32_t)(RAYS_A_PART / work->smooth_count) +
           (uint32_t)(RAYS_BY_AREA * m2 / work->smooth_m2);
}

/* Every PIECES-th ray to each part. */
static void send_piece(void *user, int item, int worker) {
    static const LightSet SETS[] = {LIGHTS_SUN, LIGHTS_EMITTERS, LIGHTS_PUNCTUAL};
    const MissedWork *work = user;
    const Scene *scene = work->context->scene;
    for (int id = 0; id < scene->part_count; id++) {
        double all = areas_of_part(scene, work->areas, id);
        if (!(all > 0) || !missed_is_smooth(scene, &scene->materials[scene->parts[id].material_id]))
            continue;
        uint32_t rays = rays_to(work, all);
        for (uint32_t k = (uint32_t)item; k < rays; k += PIECES)
            for (int i = 0; i < 3; i++) {
                Sampler sampler = sampler_start(SEED, id, (int)SETS[i], k);
                float u[4];
                sampler_4d(&sampler, u);
                double m2 = ((double)k + (double)u[0]) / rays * all;
                Hit hit = areas_point(scene, work->areas, id, m2, (Vec2){u[1], u[2]});
                send(work, &work->lists[worker], SETS[i], &hit, all / rays, &sampler);
            }
    }
}

bool missed_is_smooth(const Scene *scene, const Material *m) {
    bool sends = m->metallic > 0 || m->specular > 0 || m->transmission > 0;
    if (m->unlit || (m->display_id != NO_ID && !mirrors_can_be(scene, m))) return false;
    return mirrors_can_be(scene, m) || (sends && is_smooth(m->roughness * m->roughness)) ||
           (m->clearcoat > 0 && is_smooth(m->clearcoat_roughness * m->clearcoat_roughness));
}

MissedFinds missed_rays_send(const PathContext *context, const EyeTiles *eyes, int eye_count,
                             const double *areas, Arena *arena) {
    const Scene *scene = context->scene;
    int threads = bvh_threads(context->bvh);
    MissedFinds all = {0};
    Wavelengths middle;
    MissedWork work = {context, &middle, eyes, eye_count, areas, 0, 0, NULL};
    wavelengths_sample(0.5f, &middle);
    for (int i = 0; i < scene->part_count; i++) {
        if (!missed_is_smooth(scene, &scene->materials[scene->parts[i].material_id])) continue;
        work.smooth_m2 += areas_of_part(scene, areas, i);
        work.smooth_count++;
    }
    work.lists = ARENA_NEW(arena, FindList, threads);
    for (int i = 0; i < threads; i++) work.lists[i].arena = arena_reserve(WORKER_BYTES);
    parallel_for(threads, PIECES, send_piece, &work);
    for (int i = 0; i < threads; i++) all.count += work.lists[i].count;
    all.list = ARENA_NEW(arena, MissedFind, all.count + 1);
    MissedFind *next = all.list;
    for (int i = 0; i < threads; i++) {
        for (uint32_t k = 0; k < work.lists[i].count; k++) *next++ = work.lists[i].list[k];
        arena_release(&work.lists[i].arena);
    }
    return all;
}
