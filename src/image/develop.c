/* SPDX-License-Identifier: Apache-2.0 */
#include "image/develop.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "image/adapt.h"
#include "image/colour.h"
#include "image/exposure.h"
#include "image/icc_profile.h"
#include "image/layer_view.h"
#include "image/srgb.h"
#include "opencolorio/ocio_file.h"
#include "opencolorio/view_transform.h"

/* assets/ocio/parhelion.ocio, embedded by the build. */
extern const char OWN_OCIO_CONFIG[];

#define LINEAR_MAX 1e6f /* of what goes into a view; any view shows it as white */

/* Linear light times scale, interleaved; NaN becomes black and infinity the most there is. */
static Picture exposed(const LayerView *view, float scale, long *nonfinite, Arena *arena) {
    Picture picture = picture_create(view->width, view->height, arena);
    size_t count = (size_t)view->width * (size_t)view->height;
    for (size_t i = 0; i < count; i++) {
        bool finite = true;
        for (int c = 0; c < 3; c++) {
            float value = view->planes[c][i] * scale;
            finite = finite && isfinite(view->planes[c][i]);
            if (isnan(value)) value = 0;
            if (value > LINEAR_MAX) value = LINEAR_MAX;
            if (value < -LINEAR_MAX) value = -LINEAR_MAX;
            picture.rgb[3 * i + (size_t)c] = value;
        }
        *nonfinite += !finite;
    }
    return picture;
}

/* Pixels that the crop left out are not accidents. */
static long pixels_outside_data(const FrameImage *frame) {
    const ExrWindow w = frame->display, d = frame->data;
    int x0 = d.x0 > w.x0 ? d.x0 : w.x0, x1 = d.x1 < w.x1 ? d.x1 : w.x1;
    int y0 = d.y0 > w.y0 ? d.y0 : w.y0, y1 = d.y1 < w.y1 ? d.y1 : w.y1;
    long inside = x1 > x0 && y1 > y0 ? (long)(x1 - x0) * (y1 - y0) : 0;
    return (long)(w.x1 - w.x0) * (w.y1 - w.y0) - inside;
}

static const char *chosen_config(const DevelopOptions *options) {
    const char *from_environment = getenv("OCIO");
    if (options->config) return options->config;
    if (options->own_config) return NULL;
    return from_environment && from_environment[0] ? from_environment : NULL;
}

/* Of our own views one alone shows what is to become white as white: the others keep room for
 * what is brighter, and show it as light grey. A user's configuration names its own views. */
static const char *chosen_view(const DevelopOptions *options, const char *config) {
    ExposureRequest exposure;
    Error unused;
    bool wants_white = options->exposure && exposure_parse(options->exposure, &exposure, &unused) &&
                       exposure.kind == EXPOSURE_WHITE;
    return options->view || config || !wants_white ? options->view : "untonemapped";
}

#define PIECE_PIXELS 8192 /* of a picture, that a thread transforms at once */

typedef struct ViewWork {
    const ViewTransform *transform;
    float *rgb;
    size_t count;
} ViewWork;

static bool transform_piece(void *user, int item, Error *err) {
    const ViewWork *work = user;
    size_t first = (size_t)item * PIECE_PIXELS, left = work->count - first;
    return view_transform_apply(work->transform, work->rgb + 3 * first,
                                left < PIECE_PIXELS ? left : PIECE_PIXELS, err);
}

static bool apply_view(Picture *picture, const DevelopOptions *options, Arena scratch,
                       DevelopReport *report, Error *err) {
    ViewTransform *transform;
    const char *config = chosen_config(options);
    const ViewRequest request = {config, OWN_OCIO_CONFIG, options->display,
                                 chosen_view(options, config), ocio_file_check};
    if (!view_transform_create(&request, &transform, err)) return false;
    snprintf(report->config, sizeof report->config, "%s", view_transform_config(transform));
    snprintf(report->display, sizeof report->display, "%s", view_transform_display(transform));
    snprintf(report->view, sizeof report->view, "%s", view_transform_view(transform));
    size_t count = (size_t)picture->width * (size_t)picture->height;
    ViewWork work = {transform, picture->rgb, count};
    bool ok = parallel_try(options->threads ? options->threads : 1,
                           (int)((count + PIECE_PIXELS - 1) / PIECE_PIXELS), transform_piece, &work,
                           scratch, err);
    view_transform_destroy(transform);
    return ok;
}

/* Finds the luminance of middle grey, in cd m^-2. */
static bool find_exposure(const LayerView *view, const char *exposure, Arena scratch, double *grey,
                          Error *err) {
    ExposureRequest request;
    if (!exposure_parse(exposure ? exposure : "auto", &request, err)) return false;
    size_t count = (size_t)view->width * (size_t)view->height;
    float *luminance = layer_view_luminance(view, &scratch);
    *grey = exposure_grey(request, luminance, count, scratch);
    return true;
}

/* 0 to 1: how far a picture is adapted. */
static float adapt_share(const LayerView *view, const DevelopOptions *options, double grey,
                         Arena scratch) {
    ExposureRequest exposure;
    Error unused;
    if (options->adapt != DEVELOP_ADAPT_AUTO) return options->adapt == DEVELOP_ADAPT_LOCAL ? 1 : 0;
    if (options->exposure &&
        (!exposure_parse(options->exposure, &exposure, &unused) || exposure.kind != EXPOSURE_AUTO))
        return 0;
    size_t count = (size_t)view->width * (size_t)view->height;
    const float *luminance = layer_view_luminance(view, &scratch);
    double stops = exposure_bright_stops(luminance, count, grey, scratch);
    return (float)fmin(fmax(stops - ADAPT_FROM_STOPS, 0), 1);
}

static void adapt(LayerView *view, double grey, float share, Arena *arena) {
    const float *luminance = layer_view_luminance(view, arena);
    float *gains = adapt_gains(luminance, view->width, view->height, (float)grey, arena);
    for (size_t i = 0; share < 1 && i < (size_t)view->width * (size_t)view->height; i++)
        gains[i] = pow_f(gains[i], share);
    for (int c = 0; c < 3; c++) {
        size_t count = (size_t)view->width * (size_t)view->height;
        float *plane = ARENA_NEW(arena, float, count);
        for (size_t i = 0; i < count; i++) plane[i] = view->planes[c][i] * gains[i];
        view->planes[c] = plane;
    }
}

static bool develop_light(LayerView *view, const DevelopOptions *options, Arena *arena,
                          Picture *out, DevelopReport *report, Error *err) {
    if (!find_exposure(view, options->exposure, *arena, &report->grey_cd_m2, err)) return false;
    report->ev = exposure_ev_of_grey(report->grey_cd_m2);
    report->is_developed = true;
    float share = adapt_share(view, options, report->grey_cd_m2, *arena);
    report->is_adapted = share > 0;
    report->is_denoised = options->is_denoised;
    if (report->is_adapted) adapt(view, report->grey_cd_m2, share, arena);
    float scale = (float)(MIDDLE_GREY / report->grey_cd_m2);
    *out = exposed(view, scale, &report->nonfinite_pixels, arena);
    return apply_view(out, options, *arena, report, err);
}

static bool set_range(const DevelopOptions *options, LayerView *view, Error *err) {
    double low = options->range[0], high = options->range[1];
    if (low == 0 && high == 0) return true;
    if (view->show != SHOW_NUMBER)
        return error_set(err, ERROR_USAGE, "--range: only false colours have a range");
    if (!(high > low) || (view->is_log && !(low > 0)))
        return error_set(err, ERROR_USAGE,
                         "--range %g,%g: required: LOW,HIGH with LOW < "
                         "HIGH%s",
                         low, high, view->is_log ? " and LOW above 0" : "");
    view->low = (float)low;
    view->high = (float)high;
    return true;
}

/* Local adaptation changes luminances: false colours and other layers exclude it. */
static bool check_adapt(const DevelopOptions *options, const LayerView *view, Error *err) {
    if (options->adapt != DEVELOP_ADAPT_LOCAL) return true;
    if (options->false_colour)
        return error_set(err, ERROR_USAGE,
                         "--adapt local and --false-colour exclude each "
                         "other: colours that stand for figures show the frame as it is");
    return view->show == SHOW_LIGHT ||
           error_set(err, ERROR_USAGE, "--adapt local: layer \"%s\" is not light", options->layer);
}

#define GROUND_SHARE 0.45f /* of white, in sRGB codes: what is dim is no value */

/* Where displays have a figure and the rest has none, the rest shows the frame, dim and grey,
 * so that one sees whose figures these are. */
static void draw_ground(const FrameImage *frame, const LayerView *figures, Arena scratch,
                        Picture *picture) {
    LayerView light;
    double grey;
    Error unused;
    if (!layer_view_find(frame, NULL, &scratch, &light, &unused) ||
        !find_exposure(&light, NULL, scratch, &grey, &unused))
        return;
    const float *luminance = layer_view_luminance(&light, &scratch);
    for (int y = 0; y < light.height; y++)
        for (int x = 0; x < light.width; x++) {
            size_t i = (size_t)y * (size_t)light.width + (size_t)x;
            if (!isnan(figures->planes[0][i]) || !(luminance[i] >= 0)) continue;
            float bright = luminance[i] * (float)(MIDDLE_GREY / grey);
            float code = isfinite(bright) ? srgb_from_linear(bright / (1 + bright)) : 1;
            for (int c = 0; c < 3; c++) picture_pixel(picture, x, y)[c] = GROUND_SHARE * code;
        }
}

bool develop_picture(const FrameImage *frame, const DevelopOptions *options, Arena *arena,
                     Picture *out, DevelopReport *report, Error *err) {
    LayerView view;
    DevelopReport made = {0};
    Picture picture;
    if (!layer_view_find(frame, options->layer, arena, &view, err))
        return error_in_file(err, options->frame_name);
    if (!check_adapt(options, &view, err)) return false;
    if (options->false_colour) {
        if (view.show != SHOW_LIGHT)
            return error_at(err, ERROR_USAGE, options->frame_name, "",
                            "layer \"%s\" is not light, it has no luminance to show in false "
                            "colours",
                            options->layer);
        view = (LayerView){.show = SHOW_NUMBER,
                           .width = view.width,
                           .height = view.height,
                           .planes = {layer_view_luminance(&view, arena)},
                           .unit = "cd/m^2",
                           .is_log = true,
                           .has_gaps = view.has_gaps};
    }
    if (!set_range(options, &view, err)) return false;
    if (view.show == SHOW_LIGHT) {
        if (!develop_light(&view, options, arena, &picture, &made, err)) return false;
    } else {
        picture = layer_view_picture(&view, arena, made.scale);
        if (view.show == SHOW_NUMBER && view.has_gaps) draw_ground(frame, &view, *arena, &picture);
    }
    if (options->eye) snprintf(made.eye, sizeof made.eye, "%s", options->eye);
    made.nonfinite_pixels -= pixels_outside_data(frame);
    if (view.has_gaps || view.show != SHOW_LIGHT) made.nonfinite_pixels = 0;
    made.width = picture.width;
    made.height = picture.height;
    *out = picture;
    if (report) *report = made;
    return true;
}

static const char *description(const DevelopReport *report, Arena *arena) {
    const char *eye = report->eye[0] ? arena_format(arena, "%s; ", report->eye) : "";
    if (!report->is_developed)
        return report->scale[0] ? arena_format(arena, "%s%s", eye, report->scale) : NULL;
    return arena_format(arena, "%s%s%smiddle grey %.6g cd/m2 (EV %.3f), display %s, view %s, %s",
                        report->is_denoised ? DENOISED_WORDS "; " : "",
                        report->is_adapted ? "locally adapted, not for figures; " : "", eye,
                        report->grey_cd_m2, report->ev, report->display, report->view,
                        report->config);
}

/* The displays of our own configuration besides sRGB; what a user's displays are is not
 * known. */
static IccProfile profile_of(const DevelopReport *report, Arena *arena) {
    static const double P3[8] = {0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290};
    if (!strcmp(report->display, "Display P3"))
        return icc_profile_create(P3, ICC_CURVE_SRGB, "Display P3", arena);
    if (!strcmp(report->display, "Rec.1886"))
        return icc_profile_create(REC709_CHROMATICITIES, ICC_CURVE_GAMMA24, "Rec.1886", arena);
    return (IccProfile){NULL, 0};
}

bool develop_frame(const FrameImage *frame, const DevelopOptions *options, const char *path,
                   Arena scratch, DevelopReport *report, Error *err) {
    DevelopReport made;
    Picture picture;
    int bits = options->bits ? options->bits : 8;
    if (!picture_check_name(path, bits, err)) return false;
    if (!develop_picture(frame, options, &scratch, &picture, &made, err)) return false;
    PictureFile file = {bits, !made.is_developed || !strcmp(made.display, "sRGB"),
                        profile_of(&made, &scratch), description(&made, &scratch)};
    if (!picture_write(path, &picture, file, scratch, err)) return false;
    if (report) *report = made;
    return true;
}
