/* SPDX-License-Identifier: Apache-2.0 */
/* direct.h -- light that a vertex samples: every set of lights. HOT.
 */
#pragma once
#include "path/path_collector.h"

/* Adds the light samples of the surface, which the path reached against wo. */
void direct_add(PathState *path, const Surface *surface, Vec3 wo, const Guiding *guiding);

/* Adds light that comes from this direction of the sun, if it arrives, times its radiance over
 * sun->pdf: all of it, whatever chance may find. */
void direct_add_sun(PathState *path, const Surface *surface, Vec3 wo, const LightSample *sun);

/* A direction must lie on the same side of the triangle as of the shading normal's plane, or
 * light would leak through the surface. */
bool direct_sides_agree(const Surface *surface, Vec3 local_wi, Vec3 wi, Vec3 wo);

/* Share of the light sample that arrives at the surface; *ray: the sheets that it passed. */
Spectrum direct_visibility(PathState *path, const Surface *surface, const LightSample *light,
                           ShadowRay *ray);

/* The same of light from infinity, which keeps its direction through plates. */
Spectrum direct_arrival(PathState *path, const Surface *surface, const LightSample *light,
                        ShadowRay *ray);

/* Beer's law inside a solid: the material's colour is what is left after its distance. */
void direct_absorb(const Scene *scene, const Wavelengths *wavelengths, int medium_id,
                   float distance, Spectrum *light);
