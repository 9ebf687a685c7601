/* SPDX-License-Identifier: Apache-2.0 */
/* half_angle.h -- half and difference angles (Rusinkiewicz, "A New Change of Variables for
 * Efficient BRDF Representation", 1998), and tables of a BRDF that is known as a function.
 *
 * Frame     scatter.h's. Degrees.
 * Memory    the arena's. Threads: one set per thread.
 */
#pragma once
#include "import/scatter/scatter.h"

/* half: the half vector, from the normal and around it. diff: the light in the frame of the
 * half vector, whose first axis points down from the normal and whose second runs around it. */
typedef struct HalfAngles {
    double half_theta, half_phi, diff_theta, diff_phi; /* degrees; phi in (-180, 180] */
} HalfAngles;

HalfAngles half_angles(Direction light, Direction leaving);

/* Where light leaves that a half vector mirrors. */
Direction half_angle_mirror(Direction light, Direction half);

/* Values for light and leaving direction; false: not measured there. */
typedef bool (*BrdfFunction)(const void *data, Direction light, Direction leaving, double *value);

typedef struct BrdfSource {
    const char *file;
    BrdfFunction function;
    const void *data;
    int channels;
    const float *wavelength_nm;
    const double *half_theta_deg; /* rising: rings of half vectors on which it is evaluated */
    int rings;
} BrdfSource;

/* Tables at incidences 0, 10, ... 80 degrees. The rows stand where half vectors on the rings
 * mirror the light to, so that a narrow peak has the rings' resolution; rings stand at most 2.5
 * degrees apart, and each has 12 to 72 half vectors. */
bool brdf_source_add(const BrdfSource *source, ImportSet *set, Error *err);
