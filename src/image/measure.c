/* SPDX-License-Identifier: Apache-2.0 */
#include "image/measure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/confidence.h"
#include "base/count.h"
#include "image/frame_view.h"
#include "image/layer_view.h"
#include "image/legibility.h"
#include "spectrum/photometry.h"

#define SIGMAS_95 1.959964 /* of the normal distribution */

/* Variances of sums over pixels, of channels and of luminance. */
typedef struct PixelNoise {
    double rgb[3], luminance, fourths; /* fourths: squares of the pixels' variances */
    long   pixels;
} PixelNoise;

/* Sums over the pixels. */
typedef struct Sums {
    double rgb[3]; /* of the channels */
    PixelNoise noise, by_halves;
    PixelNoise display_noise, display_by_halves; /* over the pixels of displays */
    PixelNoise reflected_by_halves; /* of what is reflected there: all that contrasts hang on */
    double reflected_missing;       /* what few samples find may be missing there, summed */
    DisplayLight light; /* of displays */
    double mirror, lambertian;
    long   pixels, display_pixels, nonfinite;
    double least, greatest;
} Sums;

/* The planes that are looked at; has_... states which the frame has. */
typedef struct RegionPlanes {
    LayerView    light, variance, halves, white, black, reflected, shown, mirror, lambertian;
    LayerView    display_halves, fine;
    const float *display_id; /* NULL: every pixel is wanted */
    const float *coverage;   /* by displays; NULL: not known */
    bool has_variance, has_halves, has_display, has_shown, has_mirror, has_lambertian;
    bool has_display_halves, has_fine;
} RegionPlanes;

static void xyz_at(const LayerView *view, size_t i, double xyz[3])
{
    float rgb[3] = {view->planes[0][i], view->planes[1][i], view->planes[2][i]}, out[3];
    xyz_from_rgb(rgb, out);
    for (int c = 0; c < 3; c++) xyz[c] = (double)out[c];
}

static double luminance_at(const LayerView *view, size_t i)
{
    double xyz[3];
    xyz_at(view, i, xyz);
    return xyz[1];
}

/* ---- what the frame has -------------------------------------------------------------- */

/* Three planes of a layer as they are, without a change of colour space. */
static bool raw_layer(const FrameImage *frame, const char *layer, Arena *arena, LayerView *out)
{
    const float *rgb[3];
    LayerView    views[3];
    char         name[128];
    Error        unused;
    if (!frame_rgb(frame, layer, rgb)) return false;
    for (int c = 0; c < 3; c++) {
        snprintf(name, sizeof name, "%s.%c", layer, "RGB"[c]);
        if (!layer_view_find(frame, name, arena, &views[c], &unused)) return false;
    }
    *out = views[0];
    for (int c = 1; c < 3; c++) out->planes[c] = views[c].planes[0];
    return true;
}

static bool find_display(const FrameImage *frame, const char *display, Arena *arena, int *id,
                         const float **plane, Error *err)
{
    LayerView view;
    *id = frame_id_of(frame, "display", display);
    if (*id < 0)
        return error_set(err, ERROR_USAGE, "has no display \"%s\"; its displays: %s", display,
                         frame_display_names(frame, arena));
    if (!frame_channel(frame, "id.display"))
        return error_set(err, ERROR_INPUT,
                         "has no layer id, which tells the pixels of a display; render it with "
                         "--layers id,display");
    if (!layer_view_find(frame, "id.display", arena, &view, err)) return false;
    *plane = view.planes[0];
    return true;
}

static bool find_planes(const FrameImage *frame, Arena *arena, RegionPlanes *out, Error *err)
{
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
    out->coverage = frame_channel(frame, "display.coverage");
    return true;
}

/* ---- one pixel after the other ------------------------------------------------------- */

/* Greatest variance of the luminance that those of R, G and B allow. */
static double luminance_variance(const float variance[3])
{
    float sigma[3] = {sqrtf(variance[0]), sqrtf(variance[1]), sqrtf(variance[2])}, xyz[3];
    xyz_from_rgb(sigma, xyz);
    return (double)xyz[1] * (double)xyz[1];
}

static double variance_at(const RegionPlanes *planes, size_t i)
{
    float v[3];
    for (int c = 0; c < 3; c++) v[c] = planes->variance.planes[c][i];
    return luminance_variance(v);
}

static bool display_light(const RegionPlanes *planes, size_t i, DisplayLight *out)
{
    *out = (DisplayLight){luminance_at(&planes->white, i), luminance_at(&planes->black, i),
                          {0, 0, 0}, {0, 0, 0}};
    xyz_at(&planes->reflected, i, out->reflected);
    if (planes->has_shown) xyz_at(&planes->shown, i, out->shown);
    return isfinite(out->white) && isfinite(out->black) && isfinite(out->reflected[1]) &&
           isfinite(out->shown[1]);
}

static bool add_display(const RegionPlanes *planes, size_t i, Sums *sums)
{
    DisplayLight light;
    if (!display_light(planes, i, &light)) return false;
    sums->light.white += light.white;
    sums->light.black += light.black;
    for (int c = 0; c < 3; c++) {
        sums->light.shown[c] += light.shown[c];
        sums->light.reflected[c] += light.reflected[c];
    }
    if (planes->has_mirror) sums->mirror += luminance_at(&planes->mirror, i);
    if (planes->has_lambertian) sums->lambertian += luminance_at(&planes->lambertian, i);
    sums->display_pixels++;
    return true;
}

static void add_noise(PixelNoise *noise, const double rgb[3], double luminance)
{
    noise->luminance += luminance;
    noise->fourths += luminance * luminance;
    for (int c = 0; c < 3; c++) noise->rgb[c] += rgb[c];
    noise->pixels++;
}

/* The squares of a pixel's halves have the expectation of its variances, that of their
 * luminance, too. */
static void add_halves(const LayerView *halves, size_t i, PixelNoise *to)
{
    double rgb[3], y = luminance_at(halves, i);
    for (int c = 0; c < 3; c++) {
        double half = (double)halves->planes[c][i];
        rgb[c] = half * half;
    }
    if (isfinite(y)) add_noise(to, rgb, y * y);
}

static void add_spread(const RegionPlanes *planes, size_t i, PixelNoise *to)
{
    double rgb[3];
    for (int c = 0; c < 3; c++) rgb[c] = (double)planes->variance.planes[c][i];
    add_noise(to, rgb, variance_at(planes, i));
}

/* Does the pixel show nothing but a display whose own light is known twice? */
static bool is_known_twice(const RegionPlanes *planes, size_t i)
{
    return planes->coverage && planes->coverage[i] == 1 && planes->has_shown &&
           planes->has_fine && planes->has_display_halves &&
           isfinite(luminance_at(&planes->shown, i)) &&
           isfinite(luminance_at(&planes->fine, i)) &&
           isfinite(luminance_at(&planes->display_halves, i));
}

/* What a display shows is spread by its samples better than two halves of them can tell. But
 * display.fine is the same by rays of other points, up to eight times as many: the distance of
 * the two has the samples' noise, and that of those rays, which is smaller. */
static void add_known_twice(const RegionPlanes *planes, size_t i, PixelNoise *to)
{
    double rgb[3], reflected = luminance_at(&planes->display_halves, i);
    double shown = luminance_at(&planes->shown, i) - luminance_at(&planes->fine, i);
    for (int c = 0; c < 3; c++) {
        double half = (double)planes->display_halves.planes[c][i];
        double apart = (double)planes->shown.planes[c][i] - (double)planes->fine.planes[c][i];
        rgb[c] = apart * apart + half * half;
    }
    add_noise(to, rgb, shown * shown + reflected * reflected);
}

static void add_pixel_noise(const RegionPlanes *planes, size_t i, bool on_display, Sums *sums)
{
    if (planes->has_variance) add_spread(planes, i, &sums->noise);
    if (on_display && is_known_twice(planes, i)) add_known_twice(planes, i, &sums->by_halves);
    else if (planes->has_halves) add_halves(&planes->halves, i, &sums->by_halves);
    if (!on_display) return;
    if (planes->has_variance) add_spread(planes, i, &sums->display_noise);
    if (planes->has_halves) add_halves(&planes->halves, i, &sums->display_by_halves);
    if (planes->has_display_halves)
        add_halves(&planes->display_halves, i, &sums->reflected_by_halves);
}

#define HALVES_FREEDOM 16   /* of the halves' squares, at least: */
#define REFLECTED_FREEDOM 4 /* no other layer has the noise of what is reflected */

/* Halves' squares are those of normal variables, as many as count: 3 (sum d^2)^2 / sum d^4.
 * Student's factor is put into the variances. False where they are too few, or some pixel has
 * none. */
static bool choose_halves(const PixelNoise *halves, long pixels, double least,
                          PixelNoise *out)
{
    double freedom = halves->fourths > 0
                         ? 3 * halves->luminance * halves->luminance / halves->fourths : 0;
    if (halves->pixels != pixels || freedom < least) return false;
    double factor = student_quantile(freedom) / SIGMAS_95;
    *out = *halves;
    out->luminance *= factor * factor;
    for (int c = 0; c < 3; c++) out->rgb[c] *= factor * factor;
    return true;
}

/* A bright sample in a pixel of n moves it by its n-th part, and half the difference of the
 * pixel's halves is as much: these stand for the samples. */
static void choose_noise(Sums *sums)
{
    const PixelNoise *reflected = &sums->reflected_by_halves;
    BrightSamples     bright = {reflected->luminance, reflected->fourths};
    choose_halves(&sums->by_halves, sums->pixels, HALVES_FREEDOM, &sums->noise);
    if (choose_halves(reflected, sums->display_pixels, REFLECTED_FREEDOM, &sums->display_noise))
        sums->reflected_missing = bright_missing(&bright, 1, 1);
    else
        choose_halves(&sums->display_by_halves, sums->display_pixels, HALVES_FREEDOM,
                      &sums->display_noise);
}

static void add_pixel(const RegionPlanes *planes, size_t i, Sums *sums)
{
    double luminance = luminance_at(&planes->light, i);
    if (!isfinite(luminance)) {
        sums->nonfinite++;
        return;
    }
    for (int c = 0; c < 3; c++) sums->rgb[c] += (double)planes->light.planes[c][i];
    bool on_display = planes->has_display && add_display(planes, i, sums);
    add_pixel_noise(planes, i, on_display, sums);
    if (luminance < sums->least) sums->least = luminance;
    if (luminance > sums->greatest) sums->greatest = luminance;
    sums->pixels++;
}

/* ---- figures ------------------------------------------------------------------------- */

static void chromaticity_of(const double rgb[3], double xyuv[4], double xyz[3])
{
    float in[3] = {(float)rgb[0], (float)rgb[1], (float)rgb[2]}, out[3];
    xyz_from_rgb(in, out);
    for (int c = 0; c < 3; c++) xyz[c] = (double)out[c];
    double sum = xyz[0] + xyz[1] + xyz[2], uv = xyz[0] + 15 * xyz[1] + 3 * xyz[2];
    xyuv[0] = xyz[0] / sum;
    xyuv[1] = xyz[1] / sum;
    xyuv[2] = 4 * xyz[0] / uv;
    xyuv[3] = 9 * xyz[1] / uv;
}

/* First-order propagation of the channels' variances, the slopes by central differences. */
static void measure_colour(const double rgb[3], const double variance[3], FrameMeasurement *out)
{
    double    mean[4], spread[4] = {0, 0, 0, 0}, unused[3];
    Measured *figures[4] = {&out->x, &out->y, &out->u, &out->v};
    double    scale = fabs(rgb[0]) + fabs(rgb[1]) + fabs(rgb[2]);
    chromaticity_of(rgb, mean, out->xyz);
    for (int c = 0; c < 3; c++) {
        double step = scale * 1e-3, above[3], below[3], high[4], low[4];
        memcpy(above, rgb, sizeof above);
        memcpy(below, rgb, sizeof below);
        above[c] += step;
        below[c] -= step;
        chromaticity_of(above, high, unused);
        chromaticity_of(below, low, unused);
        for (int k = 0; k < 4; k++) {
            double slope = (high[k] - low[k]) / (2 * step);
            spread[k] += slope * slope * variance[c];
        }
    }
    for (int k = 0; k < 4; k++)
        *figures[k] = measured_about(
            mean[k], out->has_variance ? SIGMAS_95 * sqrt(spread[k]) : (double)NAN);
}

/* The interval of a figure that falls as the reflected light, the only noisy one, rises from
 * r.low to r.high. */
static Measured falling(double (*figure)(const DisplayLight *light), const DisplayLight *light,
                        Measured r)
{
    DisplayLight dim = *light, bright = *light;
    dim.reflected[1] = r.low;
    bright.reflected[1] = r.high;
    double low = figure(&bright), high = figure(&dim);
    return (Measured){figure(light), fmin(low, high), fmax(low, high)};
}

static void measure_ratios(const DisplayLight *light, Measured reflected, FrameMeasurement *out)
{
    out->contrast = falling(legibility_contrast, light, reflected);
    out->weber = falling(legibility_weber, light, reflected);
    out->michelson = falling(legibility_michelson, light, reflected);
}

static Measured reflected_interval(double reflected, const Sums *sums)
{
    double n = (double)sums->display_pixels;
    double width = SIGMAS_95 * sqrt(sums->display_noise.luminance) / n;
    return (Measured){reflected, fmax(reflected - width, 0),
                      reflected + width + sums->reflected_missing / n};
}

/* By the slopes along the noisy channels; where there is no error, its own size. */
static double colour_error_width(const DisplayLight *light, const double variance[3])
{
    double spread = 0, middle = legibility_colour_error(light);
    for (int c = 0; c < 3; c++) {
        float        rgb[3] = {0, 0, 0}, xyz[3];
        DisplayLight moved = *light;
        rgb[c] = (float)sqrt(variance[c]);
        xyz_from_rgb(rgb, xyz);
        for (int k = 0; k < 3; k++) moved.reflected[k] += (double)xyz[k];
        double change = legibility_colour_error(&moved) - middle;
        spread += change * change;
    }
    return SIGMAS_95 * sqrt(spread);
}

static void measure_errors(const DisplayLight *light, Measured reflected, const Sums *sums,
                           FrameMeasurement *out)
{
    double n = (double)sums->display_pixels, variance[3];
    for (int c = 0; c < 3; c++) variance[c] = sums->display_noise.rgb[c] / (n * n);
    out->shown = light->shown[1];
    out->luminance_error = (Measured){legibility_luminance_error(light),
                                      reflected.low / light->shown[1],
                                      reflected.high / light->shown[1]};
    out->colour_error = measured_about(legibility_colour_error(light),
                                       colour_error_width(light, variance));
}

static void measure_display(const RegionPlanes *planes, const Sums *sums,
                            FrameMeasurement *out)
{
    double n = (double)sums->display_pixels;
    out->display_pixels = sums->display_pixels;
    out->has_contrast = sums->display_pixels > 0;
    if (!out->has_contrast) return;
    DisplayLight light = {sums->light.white / n, sums->light.black / n, {0}, {0}};
    for (int c = 0; c < 3; c++) {
        light.shown[c] = sums->light.shown[c] / n;
        light.reflected[c] = sums->light.reflected[c] / n;
    }
    out->white = light.white;
    out->black = light.black;
    out->reflected = light.reflected[1];
    out->mirror = planes->has_mirror ? sums->mirror / n : (double)NAN;
    out->lambertian = planes->has_lambertian ? sums->lambertian / n : (double)NAN;
    out->has_errors = planes->has_shown;
    Measured reflected = reflected_interval(light.reflected[1], sums);
    measure_ratios(&light, reflected, out);
    if (out->has_errors) measure_errors(&light, reflected, sums, out);
    if (out->has_variance) return;
    Measured *noisy[] = {&out->contrast, &out->weber, &out->michelson, &out->luminance_error,
                         &out->colour_error};
    for (int i = 0; i < COUNT_OF(noisy); i++) noisy[i]->low = noisy[i]->high = NAN;
}

/* The pixels that are measured, by themselves. */
static ContentContrast measure_content(const RegionPlanes *planes, const ExrWindow *r, int id,
                                       size_t first, Arena scratch)
{
    ContentPixels part = {.width = r->x1 - r->x0, .height = r->y1 - r->y0};
    size_t count = (size_t)part.width * (size_t)part.height, k = 0;
    float *luminance = ARENA_NEW(&scratch, float, count);
    float *variance = planes->has_variance ? ARENA_NEW(&scratch, float, count) : NULL;
    for (int y = 0; y < part.height; y++) {
        for (int x = 0; x < part.width; x++, k++) {
            size_t i = first + (size_t)y * (size_t)planes->light.width + (size_t)x;
            bool   is_wanted = !planes->display_id || planes->display_id[i] == (float)id;
            luminance[k] = is_wanted ? (float)luminance_at(&planes->light, i) : NAN;
            if (variance) variance[k] = (float)variance_at(planes, i);
        }
    }
    part.luminance = luminance;
    part.variance = variance;
    return content_contrast(&part, scratch);
}

static FrameMeasurement figures_of(const RegionPlanes *planes, const Sums *sums)
{
    bool        has_variance = planes->has_variance;
    double      n = (double)sums->pixels, rgb[3], variance[3];
    FrameMeasurement out = {.pixels = sums->pixels, .nonfinite = sums->nonfinite,
                            .has_variance = has_variance, .least = sums->least,
                            .greatest = sums->greatest};
    for (int c = 0; c < 3; c++) {
        rgb[c] = sums->rgb[c] / n;
        variance[c] = sums->noise.rgb[c] / (n * n);
    }
    measure_colour(rgb, variance, &out);
    out.luminance = measured_about(
        out.xyz[1], has_variance ? SIGMAS_95 * sqrt(sums->noise.luminance) / n : (double)NAN);
    measure_display(planes, sums, &out);
    return out;
}

static bool check_region(const FrameImage *frame, const MeasureRequest *request, ExrWindow *out,
                         Error *err)
{
    const ExrWindow d = frame->data, r = request->has_region ? request->region : d;
    if (r.x0 < d.x0 || r.y0 < d.y0 || r.x1 > d.x1 || r.y1 > d.y1 || r.x0 >= r.x1 ||
        r.y0 >= r.y1)
        return error_set(err, ERROR_USAGE,
                         "--region %d,%d,%d,%d: wanted X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1 "
                         "inside the frame's pixels %d,%d,%d,%d",
                         r.x0, r.y0, r.x1, r.y1, d.x0, d.y0, d.x1, d.y1);
    const ExrWindow w = frame->display;
    *out = (ExrWindow){r.x0 > w.x0 ? r.x0 : w.x0, r.y0 > w.y0 ? r.y0 : w.y0,
                       r.x1 < w.x1 ? r.x1 : w.x1, r.y1 < w.y1 ? r.y1 : w.y1};
    return true;
}

bool measure_frame(const FrameImage *frame, const MeasureRequest *request, Arena scratch,
                   FrameMeasurement *out, Error *err)
{
    RegionPlanes    planes = {0};
    Sums      sums = {.least = INFINITY, .greatest = -INFINITY};
    ExrWindow r = frame->data, w = frame->display;
    FrameView circle = frame_view_circle(frame);
    int       id = -1;
    if (!check_region(frame, request, &r, err)) return false;
    if (request->display && !find_display(frame, request->display, &scratch, &id,
                                          &planes.display_id, err))
        return error_in_file(err, request->frame_name);
    if (!find_planes(frame, &scratch, &planes, err))
        return error_in_file(err, request->frame_name);
    for (int y = r.y0; y < r.y1; y++) {
        for (int x = r.x0; x < r.x1; x++) {
            size_t i = (size_t)(y - w.y0) * (size_t)planes.light.width + (size_t)(x - w.x0);
            if ((!planes.display_id || planes.display_id[i] == (float)id) &&
                frame_view_sees(&circle, x - w.x0, y - w.y0))
                add_pixel(&planes, i, &sums);
        }
    }
    if (sums.pixels == 0)
        return error_at(err, ERROR_INPUT, request->frame_name, "",
                        "no pixel to measure%s%s: %ld are not finite",
                        request->display ? " on display " : "",
                        request->display ? request->display : "", sums.nonfinite);
    if (planes.has_variance) choose_noise(&sums);
    *out = figures_of(&planes, &sums);
    out->has_content = request->has_region || request->display;
    size_t first = (size_t)(r.y0 - w.y0) * (size_t)planes.light.width + (size_t)(r.x0 - w.x0);
    if (out->has_content) out->content = measure_content(&planes, &r, id, first, scratch);
    return true;
}

/* ---- groups of lights ---------------------------------------------------------------- */

#define LIGHT "light."
#define GREEN ".G"

/* The pixels that count, as indices into the data window. */
typedef struct ChosenPixels {
    const size_t *index;
    size_t        count;
} ChosenPixels;

static double channel_luminance(const float *const rgb[3], size_t i)
{
    float values[3] = {rgb[0][i], rgb[1][i], rgb[2][i]};
    return (double)luminance_from_rgb(values);
}

static bool is_inside(ExrWindow w, int x, int y)
{
    return x >= w.x0 && x < w.x1 && y >= w.y0 && y < w.y1;
}

static ChosenPixels choose_pixels(const FrameImage *frame, const MeasureRequest *request,
                                  const float *const rgb[3], Arena *arena)
{
    ExrWindow    d = frame->data, r = request->has_region ? request->region : d;
    const float *ids = request->display ? frame_channel(frame, "id.display") : NULL;
    float        id = ids ? (float)frame_id_of(frame, "display", request->display) : 0;
    size_t      *index = ARENA_NEW(arena, size_t, frame_pixel_count(frame));
    FrameView    circle = frame_view_circle(frame);
    ExrWindow    w = frame->display;
    ChosenPixels out = {index, 0};
    size_t       i = 0;
    for (int y = d.y0; y < d.y1; y++)
        for (int x = d.x0; x < d.x1; x++, i++)
            if (is_inside(r, x, y) && is_inside(w, x, y) &&
                frame_view_sees(&circle, x - w.x0, y - w.y0) &&
                (!ids || ids[i] == id) && isfinite(channel_luminance(rgb, i)))
                index[out.count++] = i;
    return out;
}

static double mean_luminance(const float *const rgb[3], const ChosenPixels *pixels)
{
    double sum = 0;
    for (size_t i = 0; i < pixels->count; i++) sum += channel_luminance(rgb, pixels->index[i]);
    return pixels->count ? sum / (double)pixels->count : 0;
}

/* The layer of a channel light.NAME.G; NULL: it is none. */
static const char *layer_of(const char *channel, Arena *arena)
{
    size_t length = strlen(channel), tail = strlen(GREEN);
    if (strncmp(channel, LIGHT, strlen(LIGHT)) != 0 || length <= strlen(LIGHT) + tail ||
        strcmp(channel + length - tail, GREEN) != 0)
        return NULL;
    return arena_string(arena, channel, length - tail);
}

/* NaN sorts last. */
static double rank_of(const LightShare *light)
{
    return isnan(light->cd_m2) ? -(double)INFINITY : light->cd_m2;
}

static int compare_shares(const void *a, const void *b)
{
    const LightShare *x = a, *y = b;
    double first = rank_of(x), second = rank_of(y);
    if (first != second) return first < second ? 1 : -1;
    return strcmp(x->layer, y->layer);
}

LightShares measure_lights(const FrameImage *frame, const MeasureRequest *request,
                           Arena *arena)
{
    LightShares  out = {ARENA_NEW(arena, LightShare, frame->channel_count), 0};
    const float *rgb[3], *light[3];
    if (!frame_rgb(frame, "", rgb)) return out;
    ChosenPixels pixels = choose_pixels(frame, request, rgb, arena);
    double       all = mean_luminance(rgb, &pixels);
    for (int i = 0; i < frame->channel_count; i++) {
        const char *layer = layer_of(frame->channels[i].name, arena);
        if (!layer || !frame_rgb(frame, layer, light)) continue;
        const char *name = frame_string(frame, arena_format(arena, "parhelion:%s", layer));
        double      cd_m2 = mean_luminance(light, &pixels);
        if (!name) name = layer + strlen(LIGHT);
        out.list[out.count++] =
            (LightShare){layer, name, cd_m2, all > 0 ? cd_m2 / all : 0};
    }
    qsort(out.list, (size_t)out.count, sizeof *out.list, compare_shares);
    return out;
}
