/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/collect/lesson.h"

static bool note_place(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                       const Guiding *guiding)
{
    (void)path;
    PathPlaces *places = ((LessonPlaces *)c)->out;
    if (!guiding->is_wide || places->count == PATH_PLACES_MAX) return false;
    Vec3 origin = ray_offset_origin(surface->position, surface->ng, wo);
    places->place[places->count++] = (LitPoint){origin, surface->frame.z, false};
    return false;
}

LessonPlaces lesson_places(PathPlaces *out)
{
    static const CollectorKind kind = {.size = sizeof(LessonPlaces), .vertex = note_place};
    out->count = 0;
    return (LessonPlaces){{&kind, NULL}, out};
}

static void take_sky(PathCollector *c, PathState *path, Spectrum *radiance)
{
    float xyz[3] = {0};
    if (path->bounce != 1) return;
    spectrum_add_xyz(path->wavelengths, path->throughput * *radiance, xyz);
    *((LessonSky *)c)->sky_cd_m2 = xyz[1];
    *radiance = spectrum_all(0);
}

LessonSky lesson_sky(float *sky_cd_m2)
{
    static const CollectorKind kind = {.size = sizeof(LessonSky), .sky = take_sky};
    *sky_cd_m2 = 0;
    return (LessonSky){{&kind, NULL}, sky_cd_m2};
}
