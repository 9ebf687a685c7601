/* SPDX-License-Identifier: Apache-2.0 */
/* surface.h -- a hit becomes a surface: where it is, how it scatters, what it emits.
 *
 * The only place where textures and materials of the scene turn into a Bsdf.
 * Threads  const tables.
 */
#pragma once
#include "bvh/ray.h"
#include "light/emission.h"
#include "scene/scene.h"
#include "shaders/bsdf.h"

/* Energy tables of the scene's indices of refraction. */
typedef struct SurfaceTables SurfaceTables;

typedef enum SurfaceDetail {
    SURFACE_PLAIN,
    SURFACE_POLARISED, /* with the tables of coatings and metals that polarised light needs */
    SURFACE_SKETCH     /* rough solids lose what turns among facets more than once: no tables */
} SurfaceDetail;

/* Everything comes from the arena. */
const SurfaceTables *surface_tables_build(const Scene *scene, SurfaceDetail detail, Arena *arena);

struct Plate;

typedef struct Surface {
    Vec3 position; /* m, scene */
    Vec3 ng;       /* unit geometric normal of the front */
    Frame frame;   /* shading frame; for all but solids that refract turned to wo's side */
    Vec3 local_wo; /* wo in it */
    int part_id, material_id;
    uint32_t triangle; /* undefined where part_id is NO_ID */
    float alpha;       /* 1: all there; below: the share 1 - alpha passes as by a hole */
    bool emits;        /* towards wo */
    bool is_grey;      /* treats all wavelengths alike, by its material's data */
    TrianglePoint point;
    const struct Plate *plate; /* it stands for a plate of which it is the near face (plates.h),
                                  and goes on behind that; NULL: it does not */
    Bsdf bsdf;
} Surface;

static inline bool surface_is_display(const Scene *scene, const Surface *surface) {
    return surface->material_id != NO_ID &&
           scene->materials[surface->material_id].display_id != NO_ID;
}

/* wo: unit, world, from the hit to where the ray came from. Wavelengths must outlive *out. */
void surface_at(const Scene *scene, const SurfaceTables *tables, const Hit *hit, Vec3 wo,
                const Wavelengths *wavelengths, Surface *out);

/* The boundary of a clear smooth solid that the surface is; NULL: it is none. */
const Dielectric *surface_clear_solid(const Surface *surface);

/* The surface becomes that thick pane. */
void surface_be_thick(const SolidPane *pane, Surface *surface);

/* A white Lambert point that faces `normal` (unit, world): a luxmeter's head. */
void surface_white(const SurfaceTables *tables, Vec3 position, Vec3 normal, Surface *out);

/* Share of light, per lane, that passes the triangle straight on by holes and thin windows. */
Spectrum surface_pass(const Scene *scene, const SurfaceTables *tables, const Hit *hit,
                      Vec3 direction, const Wavelengths *wavelengths);
