/* SPDX-License-Identifier: Apache-2.0 */
#include "surface/plates.h"

#include "base/mathf.h"
#include "scene/point/ray_ends.h"
#include "shaders/facets/microfacet.h"

#define UNBENT2 1e-8f    /* squared sine: an angle that moves the sun by a fiftieth of its width */
#define SHEETS_PASSED 64 /* windows and holes on one stretch of a way */

/* ---- where there may be plates ----------------------------------------------------------- */

static bool may_be_plate(const Material *m) {
    float alpha = m->roughness * m->roughness;
    bool may_be_smooth = is_smooth(alpha) || m->metallic_roughness_texture.texture_id != NO_ID;
    return m->is_solid && m->transmission > 0 && may_be_smooth && !m->brushing &&
           m->display_id == NO_ID && !m->lets_light_through;
}

PlateBoxes plate_boxes_build(const Scene *scene, Arena *arena) {
    PlateBoxes boxes = {0};
    boxes.box = arena_alloc(arena, sizeof *boxes.box, _Alignof(Vec3), (size_t)scene->part_count);
    for (int id = 0; id < scene->part_count; id++) {
        const Part *part = &scene->parts[id];
        Vec3 *box = boxes.box[boxes.count];
        if (!part->triangle_count || !may_be_plate(&scene->materials[part->material_id])) continue;
        scene_part_box(scene, part, &box[0], &box[1]);
        boxes.count++;
    }
    return boxes;
}

/* Takes the stretch of the ray between two planes across an axis; a ray within rounding of a
 * face counts as inside. */
static void clip(float origin, float direction, float low, float high, float *from, float *to) {
    float slack = 1e-5f * (fabsf(origin) + fabsf(low) + fabsf(high));
    float a = low - slack - origin, b = high + slack - origin;
    if (fabsf(direction) < 1e-12f) {
        if (a > 0 || b < 0) *to = -1;
        return;
    }
    a /= direction;
    b /= direction;
    *from = max_f(*from, min_f(a, b));
    *to = min_f(*to, max_f(a, b));
}

bool plate_boxes_meet(const PlateBoxes *boxes, Ray ray) {
    for (int i = 0; i < boxes->count; i++) {
        Vec3 low = boxes->box[i][0], high = boxes->box[i][1];
        float from = 0, to = ray.t_max;
        clip(ray.origin.x, ray.direction.x, low.x, high.x, &from, &to);
        clip(ray.origin.y, ray.direction.y, low.y, high.y, &from, &to);
        clip(ray.origin.z, ray.direction.z, low.z, high.z, &from, &to);
        if (from <= to) return true;
    }
    return false;
}

/* ---- one plate --------------------------------------------------------------------------- */

static bool is_parallel(Vec3 a, Vec3 b) {
    Vec3 across = vec3_cross(a, b);
    return vec3_dot(across, across) < UNBENT2;
}

/* Is the surface a flat face of a clear smooth solid? */
static bool is_face(const Scene *scene, const Surface *surface) {
    const Dielectric *solid = surface_clear_solid(surface);
    return solid && solid->ior > 0 && surface->triangle < scene->opaque_count && !surface->emits &&
           is_parallel(surface->frame.z, surface->ng);
}

/* What a plate of that thickness does to light which meets its face. */
static void set_pane(const PlateView *view, const Surface *face, float sideways, Plate *out) {
    const Material *m = &view->scene->materials[face->material_id];
    SolidPlate plate = {.face = surface_clear_solid(face),
                        .cosine = min_f(face->local_wo.z, 1),
                        .left = spectrum_all(1),
                        .sideways = sideways};
    if (isfinite(m->attenuation_distance_m)) {
        plate.depths = out->thickness / m->attenuation_distance_m;
        plate.left = spectrum_from_rgb(view->wavelengths, m->attenuation_color);
    }
    solid_pane_set(&plate, &out->pane);
}

bool plate_at(const PlateView *view, const Surface *face, const Hit *hit, Vec3 way, Plate *out) {
    const Scene *scene = view->scene;
    float cosine = face->local_wo.z;
    if (!is_face(scene, face) || !(cosine > 0)) return false;
    float index = solid_pane_index(surface_clear_solid(face));
    float behind2 = 1 - (1 - cosine * cosine) / (index * index);
    if (!(behind2 > 0)) return false;
    float behind = sqrtf(behind2);
    Vec3 wo = vec3_neg(way);
    Vec3 in = vec3_normalize(refracted(wo, face->frame.z, index, cosine, behind));
    Hit far;
    Surface back;
    if (!bvh_intersect(view->bvh, (Ray){ray_start(&face->point, in), in, 0, INFINITY}, 0, &far) ||
        scene_part(scene, far.triangle)->material_id != face->material_id)
        return false;
    surface_at(scene, view->tables, &far, vec3_neg(in), view->wavelengths, &back);
    if (!is_face(scene, &back) || !(back.local_wo.z < 0) ||
        !is_parallel(back.frame.z, face->frame.z))
        return false;
    *out = (Plate){.hit = *hit,
                   .normal = face->frame.z,
                   .thickness = vec3_dot(face->frame.z, vec3_sub(face->position, back.position)),
                   .index = index,
                   .start = ray_start(&back.point, way)};
    out->inside = out->thickness / behind;
    if (!(out->thickness > 0)) return false;
    set_pane(view, face, out->inside * sqrtf(max_f(1 - behind2, 0)), out);
    return true;
}

void plate_be_pane(const Plate *plate, Surface *face) {
    surface_be_thick(&plate->pane, face);
    face->plate = plate;
}

/* ---- along a way ------------------------------------------------------------------------- */

/* The first thing on the ray that is neither a window nor a hole; t from its origin. */
static bool next_solid(const PlateWay *way, Ray ray, Hit *hit) {
    const Scene *scene = way->view.scene;
    float gone = 0;
    for (int i = 0; i < SHEETS_PASSED; i++) {
        if (!bvh_intersect(way->view.bvh, ray, 0, hit)) return false;
        gone += hit->t;
        if (hit->triangle < scene->opaque_count) break;
        ray = ray_behind(scene, ray, hit);
    }
    hit->t = gone;
    return true;
}

bool plates_follow(PlateWay *way, Ray ray) {
    const PlateView *view = &way->view;
    way->count = 0;
    way->from = 0;
    way->passed = spectrum_all(1);
    if (!plate_boxes_meet(view->boxes, ray)) return false;
    for (;;) {
        Hit hit;
        Surface face;
        bool is_met = next_solid(way, ray, &hit);
        if (!is_met) return way->count > 0 && !bvh_occluded(view->bvh, ray, way->passes, way->user);
        if (way->count == PLATES_MAX || hit.triangle >= view->scene->opaque_count) return false;
        Vec3 wo = vec3_neg(ray.direction);
        Plate *plate = &way->plate[way->count];
        surface_at(view->scene, view->tables, &hit, wo, view->wavelengths, &face);
        if (!plate_at(view, &face, &hit, ray.direction, plate)) return false;
        Ray before = ray_to(ray.origin, &face.point, wo);
        if (bvh_occluded(view->bvh, before, way->passes, way->user)) return false;
        ray = ray_from_plate(ray, plate);
        plate->hit.t += way->from;
        way->from = plate->hit.t + plate->thickness;
        way->passed *= plate->pane.passed;
        way->count++;
    }
}

/* ---- lamps ------------------------------------------------------------------------------- */

#define THINGS_MAX 64 /* on the straight line */
#define STEPS_MAX 30  /* of Newton: they come near by squares */

/* Opaque things are looked through: light that is bent may pass beside them, and what comes
 * through is tested along its own way. */
void plate_lamp_look(const PlateView *view, Vec3 start, PlateLamp *out) {
    const Scene *scene = view->scene;
    Vec3 at = start;
    out->count = 0;
    out->is_lost = out->is_blocked = false;
    for (int i = 0; i < THINGS_MAX; i++) {
        Vec3 to = vec3_sub(out->lamp, at);
        float left = vec3_length(to);
        Ray ray = {at, vec3_normalize(to), 0, left};
        Hit hit;
        Surface face;
        if (!(left > 0) || !bvh_intersect(view->bvh, ray, 0, &hit)) return;
        TrianglePoint point = triangle_point(scene, hit.triangle, hit.u, hit.v);
        at = ray_start(&point, ray.direction);
        surface_at(scene, view->tables, &hit, vec3_neg(ray.direction), view->wavelengths, &face);
        if (!surface_clear_solid(&face)) {
            out->is_blocked |= hit.triangle < scene->opaque_count;
            continue;
        }
        Plate *plate = &out->plate[out->count];
        bool is_plate = out->count < PLATES_MAX &&
                        plate_at(view, &face, &hit, ray.direction, plate) &&
                        is_parallel(plate->normal, out->plate[0].normal);
        out->is_lost |= !is_plate;
        if (out->is_lost) continue;
        out->count++;
        at = plate->start;
    }
}

/* The plates as light of one order goes through them. */
typedef struct PlateStack {
    int count;
    float air, thickness[PLATES_MAX], index2[PLATES_MAX];
} PlateStack;

/* M, and drho/dq. */
static float stack_at(const PlateStack *stack, float q, float *slope) {
    float m = stack->air;
    *slope = m;
    for (int i = 0; i < stack->count; i++) {
        float n2 = stack->index2[i];
        float inside2 = max_f(n2 + (n2 - 1) * q * q, 1e-12f), root = sqrtf(inside2);
        m += stack->thickness[i] / root;
        *slope += stack->thickness[i] * n2 / (inside2 * root);
    }
    return m;
}

/* Into glass rho is concave: from below, steps come up to the root. */
static float solve(const PlateStack *stack, float rho) {
    float slope, q = rho / stack_at(stack, 0, &slope);
    for (int i = 0; i < STEPS_MAX; i++) {
        float m = stack_at(stack, q, &slope), step = (rho - q * m) / slope;
        q = max_f(q + step, 0);
        if (fabsf(step) <= 1e-7f * q) break;
    }
    return q;
}

int plate_lamp_ways(const PlateLamp *lamp, PlateLampWay ways[PLATE_ORDERS]) {
    Vec3 to = vec3_sub(lamp->lamp, lamp->from), normal = lamp->plate[0].normal;
    if (!lamp->count || lamp->is_lost) return 0;
    if (vec3_dot(normal, to) < 0) normal = vec3_neg(normal);
    float height = vec3_dot(normal, to), turns = 0, rest = 1;
    Vec3 beside = vec3_along(to, normal, -height);
    float rho = vec3_length(beside);
    PlateStack stack = {.count = lamp->count, .air = height};
    for (int i = 0; i < lamp->count; i++) {
        stack.air -= lamp->plate[i].thickness;
        stack.index2[i] = lamp->plate[i].index * lamp->plate[i].index;
        turns += lamp->plate[i].pane.turn;
        rest *= 1 - lamp->plate[i].pane.turn;
    }
    if (!(stack.air > 0)) return 0;
    float share[PLATE_ORDERS] = {rest, rest * turns};
    share[2] = max_f(1 - share[0] - share[1], 0);
    for (int order = 0; order < PLATE_ORDERS; order++) {
        float slope;
        for (int i = 0; i < lamp->count; i++) {
            float own = turns > 0 ? lamp->plate[i].pane.turn / turns : 0;
            stack.thickness[i] = lamp->plate[i].thickness * (1 + 2 * (float)order * own);
        }
        float q = solve(&stack, rho), m = stack_at(&stack, q, &slope);
        Vec3 wi = rho > 0 ? vec3_along(normal, beside, q / rho) : normal;
        ways[order] = (PlateLampWay){vec3_normalize(wi), 1 / (m * slope * (1 + q * q)),
                                     height * sqrtf(1 + q * q), share[order]};
    }
    return PLATE_ORDERS;
}
