/* SPDX-License-Identifier: Apache-2.0 */
#include "measure/region_planes.h"

#include <stdio.h>

/* Three planes of a layer as they are, without a change of colour space. */
static bool raw_layer(const FrameImage *frame, const char *layer, Arena *arena, LayerView *out) {
    const float *rgb[3];
    LayerView views[3];
    char name[128];
    Error unused;
    if (!frame_rgb(frame, layer, rgb)) return false;
    for (int c = 0; c < 3; c++) {
        snprintf(name, sizeof name, "%s.%c", layer, "RGB"[c]);
        if (!layer_view_find(frame, name, arena, &views[c], &unused)) return false;
    }
    *out = views[0];
    for (int c = 1; c < 3; c++) out->planes[c] = views[c].planes[0];
    return true;
}

static const float *number_plane(const FrameImage *frame, const char *channel, Arena *arena) {
    LayerView view;
    Error unused;
    return frame_channel(frame, channel) && layer_view_find(frame, channel, arena, &view, &unused)
               ? view.planes[0]
               : NULL;
}

bool region_planes_choose(const FrameImage *frame, const char *display, Arena *arena,
                          RegionPlanes *out, Error *err) {
    LayerView view;
    out->wanted = frame_id_of(frame, "display", display);
    if (out->wanted < 0)
        return error_set(err, ERROR_USAGE, "has no display \"%s\"; its displays: %s", display,
                         frame_display_names(frame, arena));
    if (!frame_channel(frame, "id.display"))
        return error_set(err, ERROR_INPUT,
                         "has no layer id, which tells the pixels of a display; render it with "
                         "--layers id,display");
    if (!layer_view_find(frame, "id.display", arena, &view, err)) return false;
    out->display_id = view.planes[0];
    return true;
}

bool region_planes_find(const FrameImage *frame, Arena *arena, RegionPlanes *out, Error *err) {
    if (!layer_view_find(frame, NULL, arena, &out->light, err)) return false;
    out->has_variance = raw_layer(frame, "variance", arena, &out->variance);
    out->has_halves = raw_layer(frame, "halves", arena, &out->halves);
    out->has_display = raw_layer(frame, "display.white", arena, &out->white) &&
                       raw_layer(frame, "display.black", arena, &out->black) &&
                       raw_layer(frame, "display.reflected", arena, &out->reflected);
    out->has_shown = raw_layer(frame, "display.emitted", arena, &out->shown);
    out->has_mirror = raw_layer(frame, "display.mirror", arena, &out->mirror);
    out->has_lambertian = raw_layer(frame, "display.lambertian", arena, &out->lambertian);
    out->has_display_halves = raw_layer(frame, "display.halves", arena, &out->display_halves);
    out->has_fine = raw_layer(frame, "display.fine", arena, &out->fine);
    out->has_parts = display_layers_find(frame, &out->parts);
    out->data = frame->data;
    out->window = frame->display;
    out->coverage = number_plane(frame, "display.coverage", arena);
    out->extrapolated[0] = number_plane(frame, "display.extrapolated.emitted", arena);
    out->extrapolated[1] = number_plane(frame, "display.extrapolated.reflected", arena);
    out->rim = out->wanted < 0  ? RIM_WHOLE
               : out->has_parts ? RIM_BY_COVERAGE
               : out->coverage  ? RIM_LEFT_OUT
                                : RIM_WHOLE;
    return true;
}
