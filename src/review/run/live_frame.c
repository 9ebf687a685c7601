/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/live_frame.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "vision/eye_filter.h"

static LivePlanes planes_new(int width, int height, Arena *arena)
{
    LivePlanes planes = {.width = width, .height = height};
    for (int c = 0; c < 3; c++)
        planes.rgb[c] = ARENA_NEW(arena, float, (size_t)width * (size_t)height);
    return planes;
}

bool live_frame_split(const FrameImage *frame, Arena *arena, LiveFrame *out, Error *err)
{
    const float *all[3], *emitted[3];
    const float *coverage = frame_channel(frame, "display.coverage");
    size_t       count = frame_pixel_count(frame);
    int          width = frame->data.x1 - frame->data.x0;
    int          height = frame->data.y1 - frame->data.y0;
    if (!frame_rgb(frame, "", all) || !frame_rgb(frame, "display.emitted", emitted) ||
        !coverage)
        return error_set(err, ERROR_INPUT,
                         "wanted channels R, G, B, display.emitted and display.coverage");
    out->scene = planes_new(width, height, arena);
    out->displays = planes_new(width, height, arena);
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < count; i++) {
            /* emitted is the mean over the samples that saw a display: NaN without any */
            float shown = coverage[i] > 0 ? coverage[i] * emitted[c][i] : 0;
            out->displays.rgb[c][i] = shown;
            out->scene.rgb[c][i] = all[c][i] - shown;
        }
    return true;
}

/* ---- smaller ----------------------------------------------------------------------------- */

/* Mean of `from` values `step` apart over each of `count` equal parts. */
static void shrink_line(const float *values, int from, size_t step, float *out, int count)
{
    double scale = (double)from / count;
    for (int i = 0; i < count; i++) {
        double low = i * scale, high = fmin((i + 1) * scale, from), sum = 0;
        for (int j = (int)low; j < high; j++)
            sum += (fmin(j + 1, high) - fmax(j, low)) * (double)values[(size_t)j * step];
        out[(size_t)i * step] = (float)(sum / (high - low));
    }
}

LivePlanes live_frame_shrink(const LivePlanes *planes, int width, int height, Arena *arena)
{
    double     ratio = fmax((double)planes->width / width, (double)planes->height / height);
    if (ratio <= 1) return *planes;
    int        w = (int)fmax(1, floor(planes->width / ratio + 0.5));
    int        h = (int)fmax(1, floor(planes->height / ratio + 0.5));
    LivePlanes out = planes_new(w, h, arena);
    Arena      scratch = *arena;
    size_t     across = (size_t)planes->width;
    float     *narrow = ARENA_NEW(&scratch, float, across * (size_t)planes->height);
    float     *column = ARENA_NEW(&scratch, float, across * (size_t)planes->height);
    for (int c = 0; c < 3; c++) {
        for (int y = 0; y < planes->height; y++)
            shrink_line(planes->rgb[c] + (size_t)y * across, planes->width, 1,
                        narrow + (size_t)y * across, w);
        for (int x = 0; x < w; x++)
            shrink_line(narrow + x, planes->height, across, column + x, h);
        for (int y = 0; y < h; y++)
            memcpy(out.rgb[c] + (size_t)y * (size_t)w, column + (size_t)y * across,
                   (size_t)w * sizeof(float));
    }
    return out;
}

/* ---- in the eye -------------------------------------------------------------------------- */

static EyeLayer layer_of(const LivePlanes *from, const LivePlanes *to)
{
    EyeLayer layer;
    for (int c = 0; c < 3; c++) {
        layer.rgb[c] = from->rgb[c];
        layer.out[c] = to->rgb[c];
    }
    return layer;
}

bool live_frame_spread(LiveFrame *frame, double yfov_deg, HumanEye eye, int threads,
                       Arena *arena, Error *err)
{
    int       width = frame->scene.width, height = frame->scene.height;
    LiveFrame out = {planes_new(width, height, arena), planes_new(width, height, arena)};
    double    high = 2 * tan_d(radians_from_degrees(yfov_deg) / 2);
    const EyeFilter filter = {
        .view = {.width = width, .height = height, .axis_x = width / 2.0,
                 .axis_y = height / 2.0, .pixel = high / height},
        .eye = eye, .threads = threads};
    const EyeLayer layers[] = {layer_of(&frame->scene, &out.scene),
                               layer_of(&frame->displays, &out.displays)};
    if (!eye_filter(&filter, layers, 2, *arena, err)) return false;
    *frame = out;
    return true;
}
