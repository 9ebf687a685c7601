/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/look_options.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"
#include "image/frame_view.h"
#include "text/json_text.h"
#include "vision/eye_filter.h"

/* ---- the eye ----------------------------------------------------------------------------- */

#define FIELD_OF_VIEW "parhelion:yfov_deg"

bool eye_option_check(EyeOption *option, Error *err) {
    if (!option->words)
        return option->fov_deg == 0 ||
               error_set(err, ERROR_USAGE, "--fov: is the width of --eye's view: give both");
    return human_eye_parse(option->words, &option->eye, err) || error_prefix(err, "--eye");
}

/* The frame's own word counts. */
static bool field_of_view(const EyeOption *option, const FrameImage *frame, double *out,
                          Error *err) {
    const ExrAttribute *own = frame_attribute(frame, FIELD_OF_VIEW);
    if (frame_attribute(frame, "parhelion:ymag_m"))
        return error_set(err, ERROR_INPUT, "is an orthographic view: no eye sees one");
    if (frame_view_circle(frame).fisheye)
        return error_set(err, ERROR_INPUT,
                         "is a fisheye's: --eye spreads light in perspective "
                         "views alone");
    if (!own) {
        *out = option->fov_deg;
        return *out > 0 || error_set(err, ERROR_USAGE,
                                     "does not say its field of view (" FIELD_OF_VIEW
                                     "): add --fov DEG, the picture's height as "
                                     "an angle");
    }
    double degrees = own->kind == EXR_STRING ? NAN : own->values[0];
    if (!(degrees > 0 && degrees < 180))
        return error_set(err, ERROR_INPUT,
                         FIELD_OF_VIEW " is %g, required: degrees between 0 "
                                       "and 180",
                         degrees);
    if (option->fov_deg > 0 && fabs(option->fov_deg - degrees) > 1e-3 * degrees)
        return error_set(err, ERROR_USAGE,
                         "says itself that it is %g degrees high: leave out "
                         "--fov %g",
                         degrees, option->fov_deg);
    *out = degrees;
    return true;
}

/* Square pixels about the middle of the display window, of which the planes may be a part. */
static EyeView view_of(const FrameImage *frame, double fov_deg) {
    const ExrWindow whole = frame->display, part = frame->data;
    double high = 2 * tan_d(radians_from_degrees(fov_deg) / 2);
    return (EyeView){.width = part.x1 - part.x0,
                     .height = part.y1 - part.y0,
                     .axis_x = (whole.x0 + whole.x1) / 2.0 - part.x0,
                     .axis_y = (whole.y0 + whole.y1) / 2.0 - part.y0,
                     .pixel = high / (whole.y1 - whole.y0)};
}

/* The frame with R, G, B filtered; other channels are shared with it. out may be the frame. */
static bool apply_eye(const EyeOption *option, const FrameImage *frame, int threads, Arena *arena,
                      FrameImage *out, Error *err) {
    const float *rgb[3];
    float *planes[3];
    double fov_deg = 0;
    if (!frame_rgb(frame, "", rgb))
        return error_set(err, ERROR_INPUT,
                         "has no channels R, G, B whose light an eye could "
                         "spread");
    if (!field_of_view(option, frame, &fov_deg, err)) return false;
    for (int c = 0; c < 3; c++) planes[c] = ARENA_NEW(arena, float, frame_pixel_count(frame));
    const EyeFilter filter = {view_of(frame, fov_deg), option->eye, threads};
    const EyeLayer layer = {{rgb[0], rgb[1], rgb[2]}, {planes[0], planes[1], planes[2]}};
    if (!eye_filter(&filter, &layer, 1, *arena, err)) return false;
    *out = frame_with_rgb(frame, planes, arena);
    return true;
}

/* ---- the look ---------------------------------------------------------------------------- */

/* Before anything is filtered. */
static bool check_denoise(const DevelopOptions *look, Error *err) {
    if (look->is_denoised && look->false_colour)
        return error_set(err, ERROR_USAGE,
                         "--denoise and --false-colour exclude each other: "
                         "colours that stand for figures show the frame as it is");
    if (look->is_denoised && look->layer)
        return error_set(err, ERROR_USAGE,
                         "--denoise and --layer exclude each other: the "
                         "frame is filtered, its layers are not");
    return true;
}

static bool check_eye(const DevelopOptions *look, Error *err) {
    return !look->layer || error_set(err, ERROR_USAGE,
                                     "--eye and --layer exclude each other: the frame's own "
                                     "light is spread, its layers are not");
}

bool look_options_develop(const LookRequest *request, Arena scratch, LookReport *report,
                          Error *err) {
    DevelopOptions look = *request->look;
    FrameImage filtered = *request->frame;
    LookReport made = {0};
    bool has_eye = request->eye && request->eye->words;
    look.threads = request->threads;
    if (!check_denoise(&look, err) || (has_eye && !check_eye(&look, err))) return false;
    if (look.is_denoised &&
        !denoise_frame(request->frame, request->threads, &scratch, &filtered, &made.denoise, err))
        return error_in_file(err, look.frame_name);
    if (has_eye) {
        if (!apply_eye(request->eye, &filtered, request->threads, &scratch, &filtered, err))
            return error_in_file(err, look.frame_name);
        look.eye = arena_format(&scratch,
                                "light as in an eye of %g years, pigment %g; of what lies in "
                                "the frame",
                                request->eye->eye.age_years, request->eye->eye.pigment);
        made.eye = request->eye->eye;
    }
    if (!develop_frame(&filtered, &look, request->path, scratch, &made.develop, err)) return false;
    *report = made;
    return true;
}

/* ---- the answer -------------------------------------------------------------------------- */

json_t *look_options_json(const char *output, const LookReport *report) {
    const DevelopReport *r = &report->develop;
    const DenoiseReport *d = &report->denoise;
    json_t *answer = json_pack("{s:o, s:[i,i], s:I}", "output", json_text(output), "size", r->width,
                               r->height, "nonfinite_pixels", (json_int_t)r->nonfinite_pixels);
    if (r->is_developed) {
        json_object_set_new(answer, "config", json_text(r->config));
        json_object_set_new(answer, "display", json_text(r->display));
        json_object_set_new(answer, "view", json_text(r->view));
        json_object_set_new(answer, "exposure_ev", json_real(r->ev));
        json_object_set_new(answer, "middle_grey_cd_m2", json_real(r->grey_cd_m2));
    } else if (r->scale[0]) {
        json_object_set_new(answer, "scale", json_text(r->scale));
    }
    json_object_set_new(answer, "denoised",
                        r->is_denoised
                            ? json_pack("{s:f, s:f, s:f}", "energy_ratio", d->energy_ratio,
                                        "block_error", d->block_error, "left_share", d->left_share)
                            : json_null());
    json_object_set_new(answer, "adapt", r->is_adapted ? json_string("local") : json_null());
    return answer;
}
