/* path.h -- light along one ray: the loop that everyone reads first.
 *
 * Units    spectral radiance in W m^-2 sr^-1 nm^-1 inside; the result is CIE XYZ in cd m^-2.
 * Threads  const context; one PathStatistics a thread.
 */
#pragma once
#include "base/sampler.h"
#include "bvh/bvh.h"
#include "light/light.h"
#include "path/light_selection.h"
#include "path/mirror_beams.h"
#include "path/surface.h"

/* Which estimators reach the light; all three agree in the mean (a test). */
typedef enum PathStrategy { PATH_MIS, PATH_LIGHTS_ONLY, PATH_BSDF_ONLY } PathStrategy;

typedef struct PathContext {
    const Scene         *scene;
    const Bvh           *bvh;
    const Lights        *lights;
    const SurfaceTables *tables;
    MirrorBeams          beams; /* without mirrors: the sun in them is left to chance */
    LightSelection       selection;
    int                  max_bounces; /* 0: emission only, 1: plus direct light */
    PathStrategy         strategy;
} PathContext;

/* All that paths need besides scene, ray tracer and lights, which must outlive the context. The
 * tables come from the arena. Strategy: PATH_MIS. */
PathContext path_context_build(const Scene *scene, const Bvh *bvh, const Lights *lights,
                               int max_bounces, Arena *arena);

/* Counts of one thread; add them up. */
typedef struct PathStatistics {
    uint64_t samples;
    uint64_t camera_rays, bounce_rays, shadow_rays;
} PathStatistics;

/* What one path found. */
typedef struct PathResult {
    float    xyz[3];    /* cd m^-2, along the ray against its direction */
    bool     hit;       /* the ray met a surface (windows passed and holes do not count): */
    Hit      first;     /* t counted from the ray's origin */
    Vec3     direction; /* of the ray there */
} PathResult;

/* Radiance along `ray` at the given wavelengths, as tristimulus values. */
void path_trace(const PathContext *context, Ray ray, const Wavelengths *wavelengths,
                Sampler *sampler, PathResult *out, PathStatistics *statistics);

/* Illuminance of a plane at the point, facing its normal, as tristimulus values in lx: what a
 * white Lambert surface would send back, times pi. */
void path_illuminance(const PathContext *context, LitPoint point,
                      const Wavelengths *wavelengths, Sampler *sampler, float xyz_lx[3],
                      PathStatistics *statistics);
