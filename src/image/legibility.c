/* SPDX-License-Identifier: Apache-2.0 */
#include "image/legibility.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "spectrum/photometry.h"

/* ---- figures ----------------------------------------------------------------------------- */

double legibility_contrast(const DisplayLight *light)
{
    return (light->white + light->reflected[1]) / (light->black + light->reflected[1]);
}

double legibility_weber(const DisplayLight *light)
{
    return (light->white - light->black) / (light->black + light->reflected[1]);
}

double legibility_michelson(const DisplayLight *light)
{
    return (light->white - light->black) /
           (light->white + light->black + 2 * light->reflected[1]);
}

double legibility_luminance_error(const DisplayLight *light)
{
    return light->reflected[1] == 0 ? 0 : light->reflected[1] / light->shown[1];
}

/* CIE 1976 u', v'. */
static void uv_of(const double xyz[3], double uv[2])
{
    double sum = xyz[0] + 15 * xyz[1] + 3 * xyz[2];
    uv[0] = 4 * xyz[0] / sum;
    uv[1] = 9 * xyz[1] / sum;
}

double legibility_colour_error(const DisplayLight *light)
{
    double seen[3], seen_uv[2], shown_uv[2];
    for (int c = 0; c < 3; c++) seen[c] = light->shown[c] + light->reflected[c];
    uv_of(seen, seen_uv);
    uv_of(light->shown, shown_uv);
    double du = seen_uv[0] - shown_uv[0], dv = seen_uv[1] - shown_uv[1];
    return sqrt(du * du + dv * dv);
}

/* ---- layers ------------------------------------------------------------------------------ */

#define RATIO_FROM {"display.white", "display.black", "display.reflected"}
#define ERROR_FROM {"display.emitted", "display.reflected"}

static const LegibilityLayer LAYERS[] = {
    {"display.contrast", legibility_contrast, RATIO_FROM, ": 1", true},
    {"display.weber", legibility_weber, RATIO_FROM, "Weber", true},
    {"display.michelson", legibility_michelson, RATIO_FROM, "Michelson", false},
    {"display.luminance_error", legibility_luminance_error, ERROR_FROM, "x shown", true},
    {"display.colour_error", legibility_colour_error, ERROR_FROM, "u'v'", false},
};

static bool has_layers(const FrameImage *frame, const LegibilityLayer *layer,
                       const char **missing)
{
    const float *unused[3];
    for (int i = 0; layer->from[i]; i++)
        if (!frame_rgb(frame, layer->from[i], unused)) {
            *missing = layer->from[i];
            return false;
        }
    return true;
}

const char *legibility_names(const FrameImage *frame, Arena *arena)
{
    const char *names = "", *unused;
    for (int i = 0; i < COUNT_OF(LAYERS); i++)
        if (has_layers(frame, &LAYERS[i], &unused) && !frame_channel(frame, LAYERS[i].name))
            names = arena_format(arena, "%s, %s", names, LAYERS[i].name);
    return names;
}

const LegibilityLayer *legibility_layer(const char *name)
{
    for (int i = 0; i < COUNT_OF(LAYERS); i++)
        if (!strcmp(name, LAYERS[i].name)) return &LAYERS[i];
    return NULL;
}

/* The planes of a layer, when there are any. */
typedef struct LegibilityPlanes {
    const float *white[3], *black[3], *shown[3], *reflected[3];
} LegibilityPlanes;

static void xyz_at(const float *const planes[3], size_t i, double xyz[3])
{
    float rgb[3], out[3];
    for (int c = 0; c < 3; c++) rgb[c] = planes[c] ? planes[c][i] : NAN;
    xyz_from_rgb(rgb, out);
    for (int c = 0; c < 3; c++) xyz[c] = (double)out[c];
}

static DisplayLight light_at(const LegibilityPlanes *planes, size_t i)
{
    DisplayLight light;
    double       xyz[3];
    xyz_at(planes->white, i, xyz);
    light.white = xyz[1];
    xyz_at(planes->black, i, xyz);
    light.black = xyz[1];
    xyz_at(planes->shown, i, light.shown);
    xyz_at(planes->reflected, i, light.reflected);
    return light;
}

const float *legibility_plane(const FrameImage *frame, const LegibilityLayer *layer,
                              Arena *arena, Error *err)
{
    LegibilityPlanes planes = {{NULL}, {NULL}, {NULL}, {NULL}};
    size_t           count = frame_pixel_count(frame);
    const char      *missing;
    if (!has_layers(frame, layer, &missing)) {
        error_set(err, ERROR_USAGE, "has no layer \"%s\", from which \"%s\" follows; render it "
                  "with --layers display", missing, layer->name);
        return NULL;
    }
    frame_rgb(frame, "display.white", planes.white);
    frame_rgb(frame, "display.black", planes.black);
    frame_rgb(frame, "display.emitted", planes.shown);
    frame_rgb(frame, "display.reflected", planes.reflected);
    float *out = ARENA_NEW(arena, float, count);
    for (size_t i = 0; i < count; i++) {
        DisplayLight light = light_at(&planes, i);
        out[i] = (float)layer->figure(&light);
    }
    return out;
}
