/* SPDX-License-Identifier: Apache-2.0 */
/* polarised.h -- how light along a path must be polarised to count.
 *
 * The eye measures one number: behind polarising glasses a weighted sum of the four Stokes
 * parameters. Followed backwards from the eye these weights are a row, and every surface
 * multiplies it from the right by its Mueller matrix (adjoint transport); what an emitter sends
 * is a column. A row's first weight is the path's throughput; here are the others over it, per
 * lane. The eye's own row comes first; where Stokes parameters are requested there are three
 * more, of analysers, each with its first weight over that of the eye's.
 *
 * Axes     of light that travels along k: x = `axis`, y = k cross x; S1 > 0 along x, S2 > 0
 *          half-way from x to y, S3 > 0 clockwise as seen against the light.
 * Source   Chipman, Lam, Young, "Polarized Light and Optical Systems", 2018, chapters 3 and 6.
 * Threads  plain values.
 */
#pragma once
#include "surface/surface.h"

#define POLARISED_ROWS 4

/* An eye, world, unit: right and forward as the camera has them. */
typedef struct PolarisedEye {
    Vec3 right, forward;
    bool has_glasses;   /* else all light counts the same */
    float axis[2];      /* the glasses' transmission axis: along right and up, unit */
    float lets, blocks; /* shares of light polarised along and across it, [0, 1] */
    bool with_stokes;   /* of light as it comes to the eye; not with glasses */
} PolarisedEye;

typedef struct PolarisedRow {
    Spectrum scale; /* first weight over the eye's own; the eye's: 1 */
    Spectrum q[3];  /* the others over the row's first */
} PolarisedRow;

typedef struct Polarised {
    Vec3 axis;      /* unit, across the ray */
    Spectrum share; /* what the eye's first weight was multiplied by since it was taken */
    int row_count;
    PolarisedRow row[POLARISED_ROWS];
} Polarised;

/* Light that is partly polarised: the rest is unpolarised. */
typedef struct PolarisedLight {
    Vec3 axis;       /* unit, across its way */
    Spectrum degree; /* [0, 1] */
} PolarisedLight;

/* HOT. The eye looks along `direction`; the first weights go to out->share. */
void polarised_start(const PolarisedEye *eye, Vec3 direction, Polarised *out);

/* HOT. The path goes on along way->wi (local) from a surface that it came to against wo. */
void polarised_turn(Polarised *light, const Surface *surface, Vec3 wo, const BsdfSample *way);

/* HOT. It goes straight through, by holes and by what the surface lets pass. */
void polarised_pass(Polarised *light, const Surface *surface, Vec3 wo);

/* HOT. The factor of the eye's first weight since it was last taken. */
Spectrum polarised_take(Polarised *light);

/* HOT. The weight of this light, which travels along `way` (unit, world), for one of the rows,
 * over that of unpolarised light; for analysers over the eye's own. NULL: unpolarised. */
Spectrum polarised_seen(const Polarised *light, int row, Vec3 way, const PolarisedLight *from);
