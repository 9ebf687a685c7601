/* SPDX-License-Identifier: Apache-2.0 */
/* emission.h -- what a triangle sends out at one point, in one direction.
 *
 * Used where a ray hits an emitter and where one is sampled: the same numbers both times.
 */
#pragma once
#include "bvh/ray.h"
#include "scene/point/display_frame.h"
#include "spectrum/wavelengths.h"

/* Emission of the display's panel there along `local`, a direction of display_frame, for
 * codes, without the display's level: XYZ, cd m^-2, or spectral radiance. Where the panel's
 * backlight is dimmed by zones it is what the content leaves there (backlight.h); the `full`
 * ones have all zones full, as the panel was measured: what white would shine that is shown
 * there with its zones on. */
void display_full_xyz(const Display *display, const TrianglePoint *point, Vec3 local,
                      const float codes[3], float xyz[3]);
Spectrum display_full_spectrum(const Display *display, const TrianglePoint *point, Vec3 local,
                               const float codes[3], const Wavelengths *wavelengths);
void display_panel_xyz(const Display *display, const TrianglePoint *point, Vec3 local,
                       const float codes[3], float xyz[3]);
Spectrum display_panel_spectrum(const Display *display, const TrianglePoint *point, Vec3 local,
                                const float codes[3], const Wavelengths *wavelengths);

/* Is that direction within the measured cone? */
bool display_is_measured(const Display *display, const TrianglePoint *point, Vec3 local);

/* Codes, 0..255, that the display shows at the point; white where it has no content. */
void display_codes(const Scene *scene, const Display *display, const TrianglePoint *point,
                   float codes[3]);

/* The panel's measured XYZ, cd m^-2, that leaves the point along `direction` (unit, world, on
 * the front's side). */
void display_emission_xyz(const Scene *scene, const Display *display, uint32_t triangle,
                          const TrianglePoint *point, Vec3 direction, float xyz[3]);

/* Emitted colour of a material that is no display, linear Rec.709, cd m^-2; front side, below
 * any coat. */
void emitted_rgb(const Scene *scene, uint32_t triangle, const TrianglePoint *point, float rgb[3]);

/* Can anything leave the point along `direction` (unit, world)? The back of a display is its
 * casing and emits nothing; that of another material emits where it is double-sided. */
bool triangle_emits_to(const Scene *scene, uint32_t triangle, const TrianglePoint *point,
                       Vec3 direction);

/* Is the light that leaves the point along `direction` (unit, world) partly polarised?
 * *degree: in (0, 1]; *axis: unit, across the direction, along which the field oscillates.
 * True of displays with a known polariser: it absorbs what oscillates along its absorption
 * axis, seen from there. */
bool triangle_polarisation(const Scene *scene, uint32_t triangle, const TrianglePoint *point,
                           Vec3 direction, Vec3 *axis, float *degree);

/* Spectral radiance that leaves the point along `direction` (unit, world). A clear coat lets
 * out 1 - clearcoat * Fresnel of it (KHR_materials_clearcoat, its exact curve); an unlit
 * material has no coat, and a display was measured with all that lies on it. */
Spectrum triangle_emission(const Scene *scene, uint32_t triangle, const TrianglePoint *point,
                           Vec3 direction, const Wavelengths *wavelengths);
