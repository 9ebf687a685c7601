/* SPDX-License-Identifier: Apache-2.0 */
/* region_planes.h -- the layers of a frame that figures of a part of it are made of.
 *
 * Memory   views of the frame; what is converted is the arena's.
 * Threads  pure functions.
 * Fails    when the frame lacks what is requested: the text names what to render again.
 */
#pragma once
#include "image/layer_view.h"
#include "measure/display_part.h"

/* The planes that are looked at; has_... states which the frame has. */
typedef struct RegionPlanes {
    LayerView light, variance, halves, white, black, reflected, shown, mirror, lambertian;
    LayerView display_halves, fine;
    const float *extrapolated[2]; /* shares of shown and of reflected; NULL: not known */
    const float *display_id;      /* NULL: every pixel counts */
    int wanted;                   /* id of the display that does; -1: all pixels */
    RimCount rim;
    const float *coverage; /* by displays; NULL: not known */
    DisplayLayers parts;
    ExrWindow data, window; /* of the frame: the layers of parts are of the data window */
    bool has_parts;
    bool has_variance, has_halves, has_display, has_shown, has_mirror, has_lambertian;
    bool has_display_halves, has_fine;
} RegionPlanes;

/* Only this display's pixels, by name: before region_planes_find. */
bool region_planes_choose(const FrameImage *frame, const char *display, Arena *arena,
                          RegionPlanes *out, Error *err);

bool region_planes_find(const FrameImage *frame, Arena *arena, RegionPlanes *out, Error *err);
