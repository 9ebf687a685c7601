/* SPDX-License-Identifier: Apache-2.0 */
/* seen.h -- what an eye or a frame's pixel sees along a ray, with all that its context has:
 * polarised light; and what is requested besides.
 *
 * Threads  one thread's, like the path.
 */
#pragma once
#include "path/collect/history.h"
#include "path/path.h"

typedef struct SeenRequest {
    bool with_lambertian;         /* of a display that the eye sees, without haze */
    bool with_extrapolated;       /* and by directions that were not measured */
    const PathListener *listener; /* NULL: none */
} SeenRequest;

typedef struct SeenLight {
    PathResult path;
    float stokes[3];       /* S1, S2, S3, luminances, cd m^-2, where the context's eye needs
                              them; else 0 */
    float lambertian[3];   /* of path.xyz: what a display that the eye sees scattered by its
                              lambertian part, where that was requested; else 0 */
    float extrapolated[3]; /* likewise: what it sent on, by its mirror too, in directions
                            that were not measured (bsdf_is_extrapolated) */
} SeenLight;

/* start: without collectors. The path does not depend on what is requested. */
void path_seen(const PathStart *start, Ray ray, const SeenRequest *request, SeenLight *out);

/* Light counts by how it is polarised (path/polarised.h). path_seen has it. */
typedef struct PolarisedRows {
    PathCollector base;
    const PolarisedEye *eye;
    Polarised light;
    float *stokes; /* S0 to S3 that analysers find besides, added to; NULL: none */
} PolarisedRows;

/* Before the collectors that take light, which is weighed then. */
PolarisedRows polarised_rows(const PolarisedEye *eye, float *stokes, PathCollector *next);
