/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/collect/seen.h"

#include "path/collect/lambertian_part.h"
#include "path/collect/pixel_ray.h"
#include "path/collect/polarised_rows.h"

_Static_assert(COLLECTOR_ROOM(PolarisedRows) + COLLECTOR_ROOM(PixelRay) +
                       COLLECTOR_ROOM(LambertianPart) + COLLECTOR_ROOM(HistoryCollector) <=
                   COLLECTORS_MAX_BYTES,
               "what an eye sees is collected by more than a sheet has room for");

void path_seen(const PathStart *start, Ray ray, const SeenAsk *ask, SeenLight *out)
{
    const PathContext *context = start->context;
    const PolarisedEye *eye = context->eye;
    PathStart      own = *start;
    PolarisedRows  rows;
    PixelRay       pixel;
    LambertianPart part;
    HistoryCollector by_way;
    for (int i = 0; i < 3; i++) out->stokes[i] = out->lambertian[i] = 0;
    if (ask->listener) {
        by_way = history_collector(ask->listener, own.collector);
        own.collector = &by_way.base;
    }
    if (ask->with_lambertian) {
        part = lambertian_part(out->lambertian, own.collector);
        own.collector = &part.base;
    }
    if (pixel_ray_is_wanted(context)) {
        pixel = pixel_ray(own.collector);
        own.collector = &pixel.base;
    }
    if (eye) {
        rows = polarised_rows(eye, eye->with_stokes ? out->stokes : NULL, own.collector);
        own.collector = &rows.base;
    }
    path_from_ray(&own, ray, &out->path);
    if (eye && eye->with_stokes) /* the analysers found S0 too */
        for (int i = 0; i < 3; i++) out->stokes[i] -= out->path.xyz[1];
}
