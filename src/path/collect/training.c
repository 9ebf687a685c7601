/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/collect/training.h"

#include "scene/point/ray_ends.h"

/* The place alone counts, not its light. */
static bool note_place(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                       const Guiding *guiding) {
    (void)path;
    PathPlaces *places = ((TrainingPlaces *)c)->out;
    if (!guiding->is_wide || places->count == PATH_PLACES_MAX) return true;
    Vec3 origin = ray_start(&surface->point, wo);
    places->place[places->count++] = (LitPoint){origin, surface->frame.z, false};
    return true;
}

static bool end_without_light(PathCollector *c, PathState *path) {
    (void)c, (void)path;
    return true;
}

TrainingPlaces training_places(PathPlaces *out) {
    static const CollectorKind kind = {
        .size = sizeof(TrainingPlaces),
        .steer = {.vertex = note_place, .escape = end_without_light}};
    out->count = 0;
    return (TrainingPlaces){{&kind, NULL}, out};
}

static void take_sky(PathCollector *c, PathState *path, Spectrum *radiance) {
    float xyz[3] = {0};
    if (path->bounce != 1) return;
    spectrum_add_xyz(path->wavelengths, path->throughput * *radiance, xyz);
    *((TrainingSky *)c)->sky_cd_m2 = xyz[1];
    *radiance = spectrum_all(0);
}

/* What lights the first dull surface without another is most of what it sends, and half of what
 * the whole path costs. */
static bool ends_at(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                    const Guiding *guiding) {
    (void)path, (void)surface, (void)wo;
    TrainingSky *sky = (TrainingSky *)c;
    sky->wide += guiding->is_wide;
    return sky->wide > 1;
}

static bool has_ended(PathCollector *c, PathState *path, const Surface *surface,
                      const BsdfSample *next) {
    (void)path, (void)surface, (void)next;
    return ((const TrainingSky *)c)->wide > 1;
}

TrainingSky training_sky(float *sky_cd_m2) {
    static const CollectorKind kind = {
        .size = sizeof(TrainingSky),
        .steer = {.sky = take_sky, .vertex = ends_at, .refuse = has_ended}};
    *sky_cd_m2 = 0;
    return (TrainingSky){.base = {&kind, NULL}, .sky_cd_m2 = sky_cd_m2};
}
