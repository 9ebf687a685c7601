/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/eye_option.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"
#include "vision/eye_filter.h"

#define FIELD_OF_VIEW "parhelion:yfov_deg"

bool eye_option_check(EyeOption *option, Error *err)
{
    if (!option->words)
        return option->fov_deg == 0 ||
               error_set(err, ERROR_USAGE, "--fov: only --eye asks how wide the view is");
    return human_eye_parse(option->words, &option->eye, err) || error_prefix(err, "--eye");
}

/* The frame's own word counts. */
static bool field_of_view(const EyeOption *option, const FrameImage *frame, double *out,
                          Error *err)
{
    const ExrAttribute *own = frame_attribute(frame, FIELD_OF_VIEW);
    if (frame_attribute(frame, "parhelion:ymag_m"))
        return error_set(err, ERROR_INPUT, "is an orthographic view: no eye sees one");
    if (!own) {
        *out = option->fov_deg;
        return *out > 0 || error_set(err, ERROR_USAGE, "does not say its field of view ("
                                     FIELD_OF_VIEW "): add --fov DEG, the picture's height as "
                                     "an angle");
    }
    double degrees = own->kind == EXR_STRING ? NAN : own->values[0];
    if (!(degrees > 0 && degrees < 180))
        return error_set(err, ERROR_INPUT, FIELD_OF_VIEW " is %g, wanted degrees between 0 and "
                         "180", degrees);
    if (option->fov_deg > 0 && fabs(option->fov_deg - degrees) > 1e-3 * degrees)
        return error_set(err, ERROR_USAGE, "says itself that it is %g degrees high: leave out "
                         "--fov %g", degrees, option->fov_deg);
    *out = degrees;
    return true;
}

/* Square pixels about the middle of the display window, of which the planes may be a part. */
static EyeView view_of(const FrameImage *frame, double fov_deg)
{
    const ExrWindow whole = frame->display, part = frame->data;
    double high = 2 * tan_d(radians_from_degrees(fov_deg) / 2);
    return (EyeView){.width = part.x1 - part.x0, .height = part.y1 - part.y0,
                     .axis_x = (whole.x0 + whole.x1) / 2.0 - part.x0,
                     .axis_y = (whole.y0 + whole.y1) / 2.0 - part.y0,
                     .pixel = high / (whole.y1 - whole.y0)};
}

/* The frame with other planes as its R, G, B, which are put in place of those there. */
static FrameImage with_planes(const FrameImage *frame, const float *const rgb[3],
                              float *const planes[3], Arena *arena)
{
    FrameImage out = *frame;
    out.channels = ARENA_NEW(arena, ExrChannel, frame->channel_count);
    out.channel_room = frame->channel_count;
    for (int i = 0; i < frame->channel_count; i++) {
        out.channels[i] = frame->channels[i];
        for (int c = 0; c < 3; c++)
            if (frame->channels[i].values == rgb[c]) out.channels[i].values = planes[c];
    }
    return out;
}

bool eye_option_apply(const EyeOption *option, const FrameImage *frame, int threads,
                      Arena *arena, FrameImage *out, Error *err)
{
    const float *rgb[3];
    float       *planes[3];
    double       fov_deg = 0;
    if (!frame_rgb(frame, "", rgb))
        return error_set(err, ERROR_INPUT, "has no channels R, G, B whose light an eye could "
                         "spread");
    if (!field_of_view(option, frame, &fov_deg, err)) return false;
    for (int c = 0; c < 3; c++) planes[c] = ARENA_NEW(arena, float, frame_pixel_count(frame));
    const EyeFilter filter = {view_of(frame, fov_deg), option->eye, threads};
    const EyeLayer layer = {{rgb[0], rgb[1], rgb[2]}, {planes[0], planes[1], planes[2]}};
    if (!eye_filter(&filter, &layer, 1, *arena, err)) return false;
    *out = with_planes(frame, rgb, planes, arena);
    return true;
}

const char *eye_option_words(const EyeOption *option, Arena *arena)
{
    return arena_format(arena, "light as in an eye of %g years, pigment %g; of what lies in "
                        "the frame", option->eye.age_years, option->eye.pigment);
}
