/* SPDX-License-Identifier: Apache-2.0 */
/* plates.h -- plane-parallel plates of clear solid glass in the way of light.
 *
 * A plate is found by the ray that crosses it: the ray enters a smooth solid by a flat face and
 * leaves the same solid by a flat face parallel to that, with nothing between. It goes on in
 * its own direction, shifted; all turns between the faces count, for each polarisation by
 * itself (shaders/solid_pane.h). So light samples of sun and lamps go through plates, and an
 * eye's ray sees through them as through a pane.
 *
 * Units    metres, scene. Threads  const context. HOT.
 */
#pragma once
#include "base/mathf.h"
#include "bvh/bvh.h"
#include "surface/surface.h"

/* Boxes about the parts whose material may be clear, smooth and solid. */
typedef struct PlateBoxes {
    int count; /* 0: the scene has no plates */
    Vec3 (*box)[2];
} PlateBoxes;

PlateBoxes plate_boxes_build(const Scene *scene, Arena *arena);

/* May a plate stand in the way of the ray? */
bool plate_boxes_meet(const PlateBoxes *boxes, Ray ray);

/* What paths share; wavelengths: one path's. */
typedef struct PlateView {
    const Scene *scene;
    const Bvh *bvh;
    const SurfaceTables *tables;
    const PlateBoxes *boxes;
    const Wavelengths *wavelengths;
} PlateView;

typedef struct Plate {
    Hit hit;         /* of its near face; t along the ray that met it */
    Vec3 normal;     /* unit, of that face */
    float thickness; /* m */
    float index;     /* in the middle of the lanes */
    float inside;    /* m, on the way through it */
    Vec3 start;      /* where the ray goes on behind it */
    SolidPane pane;  /* what it does to light */
} Plate;

/* The plate that a ray along `way` enters by the surface. False: it enters none. */
bool plate_at(const PlateView *view, const Surface *face, const Hit *hit, Vec3 way, Plate *out);

/* What is left of a ray behind the plate that it met: it ends as far from the plate as it would
 * have without that. */
static inline Ray ray_from_plate(Ray ray, const Plate *plate) {
    float gone = plate->hit.t + plate->thickness / fabsf(vec3_dot(ray.direction, plate->normal));
    return (Ray){plate->start, ray.direction, 0, max_f(ray.t_max - gone, 0)};
}

/* Its near face's surface becomes the plate, which must outlive it. */
void plate_be_pane(const Plate *plate, Surface *face);

#define PLATES_MAX 8 /* on one way */

/* A way in air that plates may stand in. */
typedef struct PlateWay {
    PlateView view;
    BvhPasses *passes; /* for the sheets on it */
    void *user;
    int count;
    float from;              /* m along the way: hits that `passes` gets have their t from there */
    Plate plate[PLATES_MAX]; /* in the ray's order; t of hits from the way's beginning */
    Spectrum passed;         /* by the plates */
} PlateWay;

/* Goes along the ray up to its t_max. False: it goes through no plate, or is stopped. */
bool plates_follow(PlateWay *way, Ray ray);

/* ---- lamps -------------------------------------------------------------------------------
 *
 * Plates with a common normal bend light between two points in one plane. With h the way in air
 * along that normal, t the plates' thicknesses, n their indices and q the tangent of the angle
 * in air, light that starts along q lands beside the normal by
 *     rho(q) = q M(q),  M = h + sum of t / sqrt(n^2 + (n^2 - 1) q^2),
 * which grows with q: Newton's steps find q of a given rho. A lamp of unit intensity then gives
 * a plane that faces the ray
 *     sin d(theta) / (rho cos d(rho)) = 1 / (M rho'(q) (1 + q^2)).
 * What turns inside a plate once more has crossed it three times: a way of its own.
 *
 * Source   Snell's law; Born and Wolf, "Principles of Optics", 3.2.2.
 */

#define PLATE_ORDERS 3 /* ways: no turn inside, one, and all others by the way of two */

typedef struct PlateLampWay {
    Vec3 wi;      /* unit, in air, at the point and at the lamp */
    float per_d2; /* lx on a plane that faces it, of 1 cd */
    float length; /* m, of the straight ray that plates shift on to the lamp */
    float share;  /* of what comes through in all */
} PlateLampWay;

/* Where the lamp's light may come through plates. */
typedef struct PlateLamp {
    Vec3 from, lamp; /* m; light is looked for from here to there */
    int count;       /* plates that the straight line meets */
    Plate plate[PLATES_MAX];
    bool is_lost;    /* a clear solid stands there that is no plate, or plates of several
                        normals: no way is known */
    bool is_blocked; /* something opaque stands there */
} PlateLamp;

/* Finds the plates between `from`, where a ray starts from `start`, and the lamp. */
void plate_lamp_look(const PlateView *view, Vec3 start, PlateLamp *out);

/* The ways through them, no turn first. Returns 0 where there is none. */
int plate_lamp_ways(const PlateLamp *lamp, PlateLampWay ways[PLATE_ORDERS]);
