/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: footprints. No allocation, no lock, no libm. */
#include "path/footprint.h"

#include "scene/point/texture_slot.h"

/* The change of a shading normal that was bent towards the eye is not known. */
#define LEAST_AGREEMENT 0.9999f

RayFootprint footprint_of_cone(RayCone cone, Vec3 direction)
{
    Frame        frame = frame_from_z(direction);
    RayFootprint out = {.place = {{0}}};
    for (int i = 0; i < 2; i++) {
        Vec3 axis = i ? frame.y : frame.x;
        out.place[i] = vec3_scale(axis, cone.width);
        out.way[i] = vec3_scale(axis, cone.spread);
    }
    return out;
}

void footprint_across(const RayFootprint *footprint, float distance, const Frame *frame,
                      Vec3 across[2])
{
    for (int i = 0; i < 2; i++)
        across[i] = frame_to_local(
            frame, vec3_along(footprint->place[i], footprint->way[i], distance));
}

/* ---- a surface's normals ----------------------------------------------------------------- */

/* A triangle's edges from corner 0, and its normal, as long as twice the area. */
typedef struct CornerEdges {
    Vec3 e1, e2, n;
} CornerEdges;

static CornerEdges corner_edges(const Scene *scene, uint32_t triangle)
{
    Vec3 p = scene_corner(scene, triangle, 0);
    CornerEdges edges = {vec3_sub(scene_corner(scene, triangle, 1), p),
                         vec3_sub(scene_corner(scene, triangle, 2), p), vec3(0, 0, 0)};
    edges.n = vec3_cross(edges.e1, edges.e2);
    return edges;
}

/* Barycentric weights of corners 1 and 2 of a vector in the plane. */
static Vec2 weights_of(const CornerEdges *edges, Vec3 along)
{
    float square = vec3_dot(edges->n, edges->n);
    return (Vec2){vec3_dot(vec3_cross(along, edges->e2), edges->n) / square,
                  vec3_dot(vec3_cross(edges->e1, along), edges->n) / square};
}

static Vec3 weighed(const Vec3 from[2], Vec2 weights)
{
    return vec3_along(vec3_scale(from[0], weights.x), from[1], weights.y);
}

/* How the unit normal ns, which is `mean` over its length l, changes along the surface by
 * places[i]: (d mean - ns (ns . d mean)) / l. */
static void normal_changes(const Scene *scene, const Surface *surface,
                           const Vec3 places[FOOTPRINT_RAYS], Vec3 changes[FOOTPRINT_RAYS])
{
    const Vec3 *normals = scene_part(scene, surface->triangle)->normals;
    uint32_t    t = surface->triangle;
    for (int i = 0; i < FOOTPRINT_RAYS; i++) changes[i] = vec3(0, 0, 0);
    if (!normals) return;
    Vec3  first = normals[scene_corner_place(scene, t, 0)];
    Vec3  grows[2] = {vec3_sub(normals[scene_corner_place(scene, t, 1)], first),
                      vec3_sub(normals[scene_corner_place(scene, t, 2)], first)};
    Vec3  p = scene_corner(scene, t, 0), ns = surface->point.ns;
    CornerEdges edges = corner_edges(scene, t);
    Vec2  at = weights_of(&edges, vec3_sub(surface->position, p));
    float length = vec3_length(vec3_add(first, weighed(grows, at)));
    for (int i = 0; i < FOOTPRINT_RAYS; i++) {
        Vec3 change = weighed(grows, weights_of(&edges, places[i]));
        change = vec3_along(change, ns, -vec3_dot(change, ns));
        changes[i] = vec3_scale(change, 1 / length);
    }
}

/* ---- where a ray meets a surface --------------------------------------------------------- */

/* A ray's place, moved along d, the traced ray, to the triangle's plane. */
static Vec3 place_met(const RayFootprint *footprint, int ray, const Surface *surface, Vec3 d,
                      float distance)
{
    Vec3  place = vec3_along(footprint->place[ray], footprint->way[ray], distance);
    float off = vec3_dot(place, surface->ng) / vec3_dot(d, surface->ng);
    return vec3_along(place, d, -off);
}

Vec2 footprint_exact(const RayFootprint *footprint, const Scene *scene,
                     const Surface *surface, const TextureSlot *slot, Vec3 wo, float distance)
{
    CornerEdges edges = corner_edges(scene, surface->triangle);
    Vec3 place = place_met(footprint, FOOTPRINT_EXACT, surface, vec3_neg(wo), distance);
    Vec2 at = weights_of(&edges, place), uv[3];
    for (int i = 0; i < 3; i++) uv[i] = slot_corner_uv(scene, slot, surface->triangle, i);
    return (Vec2){at.x * (uv[1].x - uv[0].x) + at.y * (uv[2].x - uv[0].x),
                  at.x * (uv[1].y - uv[0].y) + at.y * (uv[2].y - uv[0].y)};
}

/* ---- what turns a ray -------------------------------------------------------------------- */

/* A boundary that a ray meets along d; n faces it. */
typedef struct MetBoundary {
    Vec3  d, n;
    float cosine; /* d . n, below 0 */
} MetBoundary;

/* r = d - 2 (d . n) n */
static Vec3 mirrored_change(const MetBoundary *b, Vec3 way, Vec3 normal)
{
    float turned = vec3_dot(way, b->n) + vec3_dot(b->d, normal);
    return vec3_along(vec3_along(way, normal, -2 * b->cosine), b->n, -2 * turned);
}

/* t = eta d - mu n with mu = eta (d . n) - (t . n), eta the index before over that behind. NaN
 * where the mean index would reflect all, and a wavelength's own does not. */
static Vec3 refracted_change(const MetBoundary *b, float eta, Vec3 way, Vec3 normal)
{
    float behind = -sqrtf(1 - eta * eta * (1 - b->cosine * b->cosine));
    float mu = eta * b->cosine - behind;
    float turned = vec3_dot(way, b->n) + vec3_dot(b->d, normal);
    float change = (eta - eta * eta * b->cosine / behind) * turned;
    return vec3_along(vec3_along(vec3_scale(way, eta), normal, -mu), b->n, -change);
}

static bool has_smooth_normals(const Scene *scene, const Surface *surface)
{
    const Material *m = &scene->materials[surface->material_id];
    bool is_mapped = m->normal_texture.texture_id != NO_ID ||
                     m->clearcoat_normal_texture.texture_id != NO_ID;
    if (is_mapped && m->display_id == NO_ID) return false;
    return fabsf(vec3_dot(surface->frame.z, surface->point.ns)) > LEAST_AGREEMENT;
}

/* The index on the ray's side over that behind; 1: the surface refracts nothing. */
static float index_ratio(const Surface *surface, Vec3 wo)
{
    float ior = bsdf_index(&surface->bsdf);
    if (!(ior > 0)) return 1;
    return vec3_dot(wo, surface->frame.z) > 0 ? 1 / ior : ior;
}

bool footprint_turn(RayFootprint *footprint, const Scene *scene, const Surface *surface,
                    Vec3 wo, const BsdfSample *next, float distance)
{
    MetBoundary b = {vec3_neg(wo), surface->frame.z, -vec3_dot(wo, surface->frame.z)};
    Vec3     changes[FOOTPRINT_RAYS];
    bool     is_mirrored = next->wi.z * -b.cosine > 0;
    float    sign = vec3_dot(b.n, surface->point.ns) < 0 ? -1.0f : 1.0f;
    if (!next->is_delta || !has_smooth_normals(scene, surface)) return false;
    if (b.cosine > 0) {
        b = (MetBoundary){b.d, vec3_neg(b.n), -b.cosine};
        sign = -sign;
    }
    for (int i = 0; i < FOOTPRINT_RAYS; i++)
        footprint->place[i] = place_met(footprint, i, surface, b.d, distance);
    normal_changes(scene, surface, footprint->place, changes);
    for (int i = 0; i < FOOTPRINT_RAYS; i++) {
        Vec3 normal = vec3_scale(changes[i], sign);
        footprint->way[i] =
            is_mirrored ? mirrored_change(&b, footprint->way[i], normal)
                        : refracted_change(&b, index_ratio(surface, wo), footprint->way[i],
                                           normal);
    }
    Vec3 start = ray_start(&surface->point, frame_to_world(&surface->frame, next->wi));
    footprint->place[FOOTPRINT_EXACT] = vec3_add(footprint->place[FOOTPRINT_EXACT],
                                                 vec3_sub(surface->position, start));
    return true;
}
