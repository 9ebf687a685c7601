/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/collect/lesson.h"

#include "scene/point/ray_ends.h"

/* The place alone counts, not its light. */
static bool note_place(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                       const Guiding *guiding)
{
    (void)path;
    PathPlaces *places = ((LessonPlaces *)c)->out;
    if (!guiding->is_wide || places->count == PATH_PLACES_MAX) return true;
    Vec3 origin = ray_start(&surface->point, wo);
    places->place[places->count++] = (LitPoint){origin, surface->frame.z, false};
    return true;
}

static bool ask_for_no_light(PathCollector *c, PathState *path)
{
    (void)c, (void)path;
    return true;
}

LessonPlaces lesson_places(PathPlaces *out)
{
    static const CollectorKind kind = {
        .size = sizeof(LessonPlaces),
        .steer = {.vertex = note_place, .escape = ask_for_no_light}};
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

/* What lights the first dull surface without another is most of what it sends, and half of what
 * the whole path costs. */
static bool ends_at(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                    const Guiding *guiding)
{
    (void)path, (void)surface, (void)wo;
    LessonSky *sky = (LessonSky *)c;
    sky->wide += guiding->is_wide;
    return sky->wide > 1;
}

static bool has_ended(PathCollector *c, PathState *path, const Surface *surface,
                      const BsdfSample *next)
{
    (void)path, (void)surface, (void)next;
    return ((const LessonSky *)c)->wide > 1;
}

LessonSky lesson_sky(float *sky_cd_m2)
{
    static const CollectorKind kind = {
        .size = sizeof(LessonSky),
        .steer = {.sky = take_sky, .vertex = ends_at, .refuse = has_ended}};
    *sky_cd_m2 = 0;
    return (LessonSky){.base = {&kind, NULL}, .sky_cd_m2 = sky_cd_m2};
}
