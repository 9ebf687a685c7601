/* SPDX-License-Identifier: Apache-2.0 */
/* path_light.h -- what a path has found so far.
 *
 * Threads  a plain value.
 */
#pragma once
#include "spectrum/wavelengths.h"

/* Light that a path has found. Most of it is radiance per lane; a display that is seen by ways
 * on which nothing depended on wavelength keeps its measured XYZ: lanes would only blur it. */
typedef struct PathLight {
    Spectrum radiance; /* W m^-2 sr^-1 nm^-1 per lane */
    float    xyz[3];   /* cd m^-2 */
} PathLight;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

static inline void path_light_add(PathLight *sum, const PathLight *more)
{
    sum->radiance += more->radiance;
    for (int i = 0; i < 3; i++) sum->xyz[i] += more->xyz[i];
}

static inline void path_light_take(PathLight *from, const PathLight *part)
{
    from->radiance -= part->radiance;
    for (int i = 0; i < 3; i++) from->xyz[i] -= part->xyz[i];
}

static inline void path_light_to_xyz(const PathLight *gathered,
                                     const Wavelengths *wavelengths, float xyz[3])
{
    for (int i = 0; i < 3; i++) xyz[i] = gathered->xyz[i];
    spectrum_add_xyz(wavelengths, gathered->radiance, xyz);
}

#pragma GCC diagnostic pop
