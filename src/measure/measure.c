/* SPDX-License-Identifier: Apache-2.0 */
#include "measure/measure.h"

#include <math.h>
#include <string.h>

#include "base/confidence.h"
#include "image/frame_view.h"
#include "measure/pixel_noise.h"
#include "measure/region_planes.h"
#include "spectrum/photometry.h"

/* The light that a display sends to the eye, luminances, cd m^-2. */
typedef struct DisplayLight {
    double white, black, shown, reflected;
} DisplayLight;

/* Sums over the pixels, each times its part. */
typedef struct Sums {
    double area, rgb[3]; /* of the parts and of the channels */
    PixelNoise noise, by_halves;
    RimNoise rim, display_rim;                   /* of the light, and of what is reflected */
    PixelNoise display_noise, display_by_halves; /* over the pixels of displays */
    PixelNoise reflected_by_halves;    /* of what is reflected there: all that contrasts hang on */
    double missing, reflected_missing; /* what few samples find may be missing, summed: of all
                                          light, and of what is reflected there */
    DisplayLight light;                /* of displays */
    double mirror, lambertian, display_area, reflected_rgb[3];
    double extrapolated[2]; /* of what is shown, and reflected, there */
    long pixels, display_pixels, nonfinite, rim_pixels, shared_pixels, unknown_pixels;
    double least, greatest;
} Sums;

static double luminance_at(const LayerView *view, size_t i) {
    float rgb[3] = {view->planes[0][i], view->planes[1][i], view->planes[2][i]}, xyz[3];
    xyz_from_rgb(rgb, xyz);
    return (double)xyz[1];
}

/* ---- one pixel after the other ------------------------------------------------------- */

static bool display_light(const RegionPlanes *planes, size_t i, DisplayLight *out) {
    *out = (DisplayLight){.white = luminance_at(&planes->white, i),
                          .black = luminance_at(&planes->black, i),
                          .shown = planes->has_shown ? luminance_at(&planes->shown, i) : 0,
                          .reflected = luminance_at(&planes->reflected, i)};
    return isfinite(out->white) && isfinite(out->black) && isfinite(out->reflected) &&
           isfinite(out->shown);
}

/* What counts of a pixel. */
typedef struct PixelShare {
    double area;              /* 1, or a display's coverage */
    double rgb[3], luminance; /* means over it */
    double variance[3];       /* of area times rgb; NaN: not known */
    DisplayPart own;          /* of the display that is measured, or else of the pixel's */
} PixelShare;

static DisplayPart part_at(const RegionPlanes *planes, size_t i) {
    int width = planes->light.width, row = planes->data.x1 - planes->data.x0;
    int x = (int)(i % (size_t)width) + planes->window.x0 - planes->data.x0;
    int y = (int)(i / (size_t)width) + planes->window.y0 - planes->data.y0;
    size_t k = (size_t)y * (size_t)row + (size_t)x;
    if (!planes->has_parts) return (DisplayPart){0};
    return display_part(&planes->parts, k,
                        planes->wanted < 0 ? (int)planes->parts.id[k] : planes->wanted);
}

static PixelShare pixel_light(const RegionPlanes *planes, size_t i) {
    PixelShare pixel = {.area = 1, .own = part_at(planes, i)};
    bool is_part = planes->rim == RIM_BY_COVERAGE;
    if (is_part) pixel.area = pixel.own.coverage;
    for (int c = 0; c < 3; c++) {
        pixel.rgb[c] = is_part ? pixel.own.rgb[c] : (double)planes->light.planes[c][i];
        pixel.variance[c] = is_part                ? pixel.own.scatter[c]
                            : planes->has_variance ? (double)planes->variance.planes[c][i]
                                                   : (double)NAN;
    }
    float rgb[3] = {(float)pixel.rgb[0], (float)pixel.rgb[1], (float)pixel.rgb[2]}, xyz[3];
    xyz_from_rgb(rgb, xyz);
    pixel.luminance = (double)xyz[1];
    return pixel;
}

/* Not a display's share of a pixel, but all of it, and nothing else. */
static bool is_alone(const RegionPlanes *planes, const PixelShare *pixel, size_t i) {
    return planes->coverage && planes->coverage[i] == 1 && !pixel->own.is_shared;
}

/* The share of the pixel that means over displays are taken with; 0: none, as the layers are of
 * two displays. */
static double display_weight(const RegionPlanes *planes, const PixelShare *pixel, size_t i) {
    if (planes->has_parts) return pixel->own.is_shared ? 0 : pixel->own.coverage;
    return planes->coverage ? (double)planes->coverage[i] : 1;
}

static bool add_display(const RegionPlanes *planes, size_t i, double weight, Sums *sums) {
    DisplayLight light;
    if (!(weight > 0) || !display_light(planes, i, &light)) return false;
    sums->light.white += weight * light.white;
    sums->light.black += weight * light.black;
    sums->light.shown += weight * light.shown;
    sums->light.reflected += weight * light.reflected;
    for (int c = 0; c < 3; c++)
        sums->reflected_rgb[c] += weight * (double)planes->reflected.planes[c][i];
    if (planes->has_mirror) sums->mirror += weight * luminance_at(&planes->mirror, i);
    if (planes->has_lambertian) sums->lambertian += weight * luminance_at(&planes->lambertian, i);
    for (int k = 0; k < 2; k++)
        if (planes->extrapolated[k])
            sums->extrapolated[k] +=
                weight * (double)planes->extrapolated[k][i] * (k ? light.reflected : light.shown);
    sums->display_area += weight;
    sums->display_pixels++;
    return true;
}

/* The squares of a pixel's halves have the expectation of its variances, that of their
 * luminance, too. */
static void add_halves(const LayerView *halves, size_t i, double weight, PixelNoise *to) {
    double rgb[3], y = weight * luminance_at(halves, i);
    for (int c = 0; c < 3; c++) {
        double half = weight * (double)halves->planes[c][i];
        rgb[c] = half * half;
    }
    if (isfinite(y)) pixel_noise_add(to, rgb, y * y);
}

static void add_variance(const double variance[3], PixelNoise *to) {
    pixel_noise_add(to, variance, pixel_noise_luminance(variance));
}

/* Is the display's own light there known twice? */
static bool is_known_twice(const RegionPlanes *planes, size_t i) {
    return planes->has_shown && planes->has_fine && planes->has_display_halves &&
           isfinite(luminance_at(&planes->shown, i)) && isfinite(luminance_at(&planes->fine, i)) &&
           isfinite(luminance_at(&planes->display_halves, i));
}

/* What a display shows is spread by its samples better than its two halves can estimate. But
 * display.fine is the same by rays of other points, up to eight times as many: the distance of
 * the two has the samples' noise, and that of those rays, which is smaller. */
static void add_known_twice(const RegionPlanes *planes, size_t i, PixelNoise *to) {
    double rgb[3], reflected = luminance_at(&planes->display_halves, i);
    double shown = luminance_at(&planes->shown, i) - luminance_at(&planes->fine, i);
    for (int c = 0; c < 3; c++) {
        double half = (double)planes->display_halves.planes[c][i];
        double apart = (double)planes->shown.planes[c][i] - (double)planes->fine.planes[c][i];
        rgb[c] = apart * apart + half * half;
    }
    pixel_noise_add(to, rgb, shown * shown + reflected * reflected);
}

/* Halves are of whole pixels: of one that shows other things, too, the part of a display has
 * its own variance alone. */
static void add_pixel_noise(const RegionPlanes *planes, size_t i, const PixelShare *pixel,
                            bool on_display, Sums *sums) {
    bool is_whole = is_alone(planes, pixel, i), is_part = planes->rim == RIM_BY_COVERAGE;
    if (is_part || planes->has_variance) add_variance(pixel->variance, &sums->noise);
    if (is_part) rim_noise_add(&sums->rim, pixel->own.spread, pixel->rgb);
    if (on_display && is_whole && is_known_twice(planes, i))
        add_known_twice(planes, i, &sums->by_halves);
    else if (is_part && !is_whole) add_variance(pixel->variance, &sums->by_halves);
    else if (planes->has_halves) add_halves(&planes->halves, i, 1, &sums->by_halves);
}

/* weight: the display's share. What is reflected is measured by the display's samples alone. */
static void add_display_noise(const RegionPlanes *planes, size_t i, const PixelShare *pixel,
                              double weight, Sums *sums) {
    bool has_own = planes->has_parts, is_whole = is_alone(planes, pixel, i);
    const double *variance = has_own ? pixel->own.scatter : pixel->variance;
    double rgb[3];
    for (int c = 0; c < 3; c++) rgb[c] = (double)planes->reflected.planes[c][i];
    if (has_own || planes->has_variance) add_variance(variance, &sums->display_noise);
    if (has_own) rim_noise_add(&sums->display_rim, pixel->own.spread, rgb);
    if (has_own && !is_whole) add_variance(variance, &sums->display_by_halves);
    else if (planes->has_halves) add_halves(&planes->halves, i, 1, &sums->display_by_halves);
    if (!planes->has_display_halves) return;
    if (has_own && !isfinite(luminance_at(&planes->display_halves, i))) /* of few samples */
        add_variance(variance, &sums->reflected_by_halves);
    else add_halves(&planes->display_halves, i, weight, &sums->reflected_by_halves);
}

#define HALVES_FREEDOM 16   /* of the halves' squares, at least: */
#define REFLECTED_FREEDOM 4 /* no other layer has the noise of what is reflected */

/* A bright sample in a pixel of n moves it by its n-th part, and half the difference of the
 * pixel's halves is as much, its variance the square: these stand for the samples. */
static double missing_by(const PixelNoise *noise) {
    return bright_missing(&(BrightSamples){noise->luminance, noise->fourths}, 1, 1);
}

/* The rule of estimates (estimate/estimate.h) where pixels stand for batches. But a pixel has
 * two halves alone, whose difference is as often above 0 as below: it shows no skewness, and so
 * the interval is Student's as it is, of as many degrees of freedom as pixels count. Of all
 * light bright samples are looked for among that many pixels only: in one or two all noise
 * would be taken for a single sample. */
static void choose_noise(Sums *sums) {
    const PixelNoise *reflected = &sums->reflected_by_halves;
    double missing = missing_by(&sums->noise), by_halves = missing_by(&sums->by_halves);
    if (pixel_noise_of_halves(&sums->by_halves, sums->pixels, HALVES_FREEDOM, &sums->noise))
        missing = by_halves;
    sums->missing = sums->pixels < HALVES_FREEDOM ? 0 : missing;
    if (pixel_noise_of_halves(reflected, sums->display_pixels, REFLECTED_FREEDOM,
                              &sums->display_noise))
        sums->reflected_missing = missing_by(reflected);
    else
        pixel_noise_of_halves(&sums->display_by_halves, sums->display_pixels, HALVES_FREEDOM,
                              &sums->display_noise);
}

static bool is_wanted(const RegionPlanes *planes, size_t i, const PixelShare *pixel) {
    bool is_named = planes->wanted < 0 || planes->display_id[i] == (float)planes->wanted;
    if (planes->rim == RIM_BY_COVERAGE) return pixel->area > 0;
    return is_named && (planes->rim == RIM_WHOLE || is_alone(planes, pixel, i));
}

/* What a display shows of a pixel that shows something else, too. */
static void count_rim(const RegionPlanes *planes, size_t i, const PixelShare *pixel, Sums *sums) {
    if (planes->wanted < 0) return;
    bool is_named = planes->display_id[i] == (float)planes->wanted;
    sums->unknown_pixels += is_named && pixel->own.is_unknown;
    if (planes->coverage && (is_named || pixel->own.coverage > 0))
        sums->rim_pixels += !is_alone(planes, pixel, i);
    sums->shared_pixels += pixel->own.coverage > 0 && pixel->own.is_shared;
}

static void add_pixel(const RegionPlanes *planes, size_t i, Sums *sums) {
    bool is_finite = isfinite(luminance_at(&planes->light, i));
    PixelShare pixel = pixel_light(planes, i);
    count_rim(planes, i, &pixel, sums);
    if (!is_wanted(planes, i, &pixel)) return;
    if (!is_finite) {
        sums->nonfinite++;
        return;
    }
    double weight = display_weight(planes, &pixel, i);
    bool on_display = planes->has_display && add_display(planes, i, weight, sums);
    sums->area += pixel.area;
    for (int c = 0; c < 3; c++) sums->rgb[c] += pixel.area * pixel.rgb[c];
    add_pixel_noise(planes, i, &pixel, on_display, sums);
    if (on_display) add_display_noise(planes, i, &pixel, weight, sums);
    if (pixel.luminance < sums->least) sums->least = pixel.luminance;
    if (pixel.luminance > sums->greatest) sums->greatest = pixel.luminance;
    sums->pixels++;
}

/* ---- figures ------------------------------------------------------------------------- */

static void chromaticity_of(const double rgb[3], double xyuv[4], double xyz[3]) {
    float in[3] = {(float)rgb[0], (float)rgb[1], (float)rgb[2]}, out[3];
    xyz_from_rgb(in, out);
    for (int c = 0; c < 3; c++) xyz[c] = (double)out[c];
    double sum = xyz[0] + xyz[1] + xyz[2], uv = xyz[0] + 15 * xyz[1] + 3 * xyz[2];
    xyuv[0] = xyz[0] / sum;
    xyuv[1] = xyz[1] / sum;
    xyuv[2] = 4 * xyz[0] / uv;
    xyuv[3] = 9 * xyz[1] / uv;
}

#define ROUNDING 1e-6 /* of a figure: channels in single precision, and their matrix */

/* A display of even light has no noise but its channels' last digits. */
static Measured about(double value, double half_width, const FrameMeasurement *out) {
    double least = out->rim == RIM_BY_COVERAGE ? ROUNDING * fabs(value) : 0;
    if (!out->has_variance) half_width = NAN;
    return measured_about(value, half_width < least ? least : half_width);
}

/* First-order propagation of the channels' variances, the slopes by central differences. wider:
 * by bright samples that may be missing, of colours as those that were found. */
static void measure_colour(const double rgb[3], const double variance[3], double wider,
                           FrameMeasurement *out) {
    double mean[4], spread[4] = {0, 0, 0, 0}, unused[3];
    Measured *figures[4] = {&out->x, &out->y, &out->u, &out->v};
    double scale = fabs(rgb[0]) + fabs(rgb[1]) + fabs(rgb[2]);
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
        *figures[k] = about(mean[k], wider * SIGMAS_95 * sqrt(spread[k]), out);
}

static double contrast_with(double white, double black, double reflected) {
    return (white + reflected) / (black + reflected);
}

/* It falls as the reflected light, the only noisy one, rises from r.low to r.high. */
static Measured contrast_of(double white, double black, Measured r) {
    double low = contrast_with(white, black, r.high), high = contrast_with(white, black, r.low);
    return (Measured){contrast_with(white, black, r.value), fmin(low, high), fmax(low, high)};
}

static Measured reflected_interval(double reflected, const Sums *sums) {
    double n = sums->display_area;
    double width = SIGMAS_95 * sqrt(sums->display_noise.luminance) / n;
    return (Measured){reflected, fmax(reflected - width, 0),
                      reflected + width + sums->reflected_missing / n};
}

/* NaN: not known; 0 where there is no light. */
static double share_of(bool is_known, double part, double all) {
    return !is_known ? (double)NAN : all > 0 ? part / all : 0;
}

static void measure_display(const RegionPlanes *planes, const Sums *sums, FrameMeasurement *out) {
    double n = sums->display_area;
    out->display_pixels = sums->display_pixels;
    out->has_contrast = sums->display_pixels > 0;
    if (!out->has_contrast) return;
    out->white = sums->light.white / n;
    out->black = sums->light.black / n;
    out->reflected = sums->light.reflected / n;
    out->mirror = planes->has_mirror ? sums->mirror / n : (double)NAN;
    out->lambertian = planes->has_lambertian ? sums->lambertian / n : (double)NAN;
    out->shown = planes->has_shown ? sums->light.shown / n : (double)NAN;
    out->extrapolated_shown = share_of(planes->has_shown && planes->extrapolated[0],
                                       sums->extrapolated[0], sums->light.shown);
    out->extrapolated_reflected =
        share_of(planes->extrapolated[1], sums->extrapolated[1], sums->light.reflected);
    out->contrast = contrast_of(out->white, out->black, reflected_interval(out->reflected, sums));
    if (!out->has_variance) out->contrast.low = out->contrast.high = NAN;
}

/* The pixels that are measured, by themselves. */
static ContentContrast measure_content(const RegionPlanes *planes, const ExrWindow *r,
                                       bool has_variance, size_t first, Arena scratch) {
    ContentPixels part = {.width = r->x1 - r->x0, .height = r->y1 - r->y0};
    size_t count = (size_t)part.width * (size_t)part.height, k = 0;
    float *luminance = ARENA_NEW(&scratch, float, count);
    float *variance = has_variance ? ARENA_NEW(&scratch, float, count) : NULL;
    for (int y = 0; y < part.height; y++) {
        for (int x = 0; x < part.width; x++, k++) {
            size_t i = first + (size_t)y * (size_t)planes->light.width + (size_t)x;
            PixelShare pixel = pixel_light(planes, i);
            bool wanted = is_wanted(planes, i, &pixel);
            luminance[k] = wanted ? (float)pixel.luminance : NAN;
            if (variance)
                variance[k] =
                    (float)(pixel_noise_luminance(pixel.variance) / (pixel.area * pixel.area));
        }
    }
    part.luminance = luminance;
    part.variance = variance;
    return content_contrast(&part, scratch);
}

static bool states_noise(const RegionPlanes *planes) {
    return planes->has_variance || planes->rim == RIM_BY_COVERAGE;
}

/* Of the parts that chance gives pixels, once the means are known. */
static void add_rim_noise(Sums *sums) {
    double rgb[3], reflected[3];
    for (int c = 0; c < 3; c++) {
        rgb[c] = sums->rgb[c] / sums->area;
        reflected[c] = sums->reflected_rgb[c] / sums->display_area;
    }
    rim_noise_put(&sums->rim, rgb, &sums->noise);
    if (sums->display_area > 0) rim_noise_put(&sums->display_rim, reflected, &sums->display_noise);
}

static FrameMeasurement figures_of(const RegionPlanes *planes, const Sums *sums) {
    double n = sums->area, rgb[3], variance[3];
    FrameMeasurement out = {.pixels = sums->pixels,
                            .nonfinite = sums->nonfinite,
                            .rim = planes->rim,
                            .area = sums->area,
                            .rim_pixels = sums->rim_pixels,
                            .shared_pixels = sums->shared_pixels,
                            .unknown_pixels = sums->unknown_pixels,
                            .has_variance = states_noise(planes),
                            .least = sums->least,
                            .greatest = sums->greatest};
    for (int c = 0; c < 3; c++) {
        rgb[c] = sums->rgb[c] / n;
        variance[c] = sums->noise.rgb[c] / (n * n);
    }
    double half = SIGMAS_95 * sqrt(sums->noise.luminance);
    measure_colour(rgb, variance, half > 0 ? 1 + sums->missing / half : 1, &out);
    out.luminance = about(out.xyz[1], half / n, &out);
    out.luminance.high += sums->missing / n;
    measure_display(planes, sums, &out);
    return out;
}

static bool check_region(const FrameImage *frame, const MeasureRequest *request, ExrWindow *out,
                         Error *err) {
    const ExrWindow d = frame->data, r = request->has_region ? request->region : d;
    if (r.x0 < d.x0 || r.y0 < d.y0 || r.x1 > d.x1 || r.y1 > d.y1 || r.x0 >= r.x1 || r.y0 >= r.y1)
        return error_set(err, ERROR_USAGE,
                         "--region %d,%d,%d,%d: required: X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1 "
                         "inside the frame's pixels %d,%d,%d,%d",
                         r.x0, r.y0, r.x1, r.y1, d.x0, d.y0, d.x1, d.y1);
    const ExrWindow w = frame->display;
    *out = (ExrWindow){r.x0 > w.x0 ? r.x0 : w.x0, r.y0 > w.y0 ? r.y0 : w.y0,
                       r.x1 < w.x1 ? r.x1 : w.x1, r.y1 < w.y1 ? r.y1 : w.y1};
    return true;
}

/* Rims are left out where their parts are not known. */
static bool no_pixel(const MeasureRequest *request, const Sums *sums, Error *err) {
    if (request->display && sums->rim_pixels)
        return error_at(err, ERROR_INPUT, request->frame_name, "",
                        "no pixel shows display %s alone, and how much the %ld at its rim show "
                        "is not known — render it again with --layers display",
                        request->display, sums->rim_pixels);
    if (!request->display && !sums->nonfinite)
        return error_at(err, ERROR_INPUT, request->frame_name, "",
                        "no pixel to measure: all lie outside the fisheye's circle");
    return error_at(err, ERROR_INPUT, request->frame_name, "",
                    "no pixel to measure%s%s: %ld are not finite",
                    request->display ? " on display " : "",
                    request->display ? request->display : "", sums->nonfinite);
}

bool measure_frame(const FrameImage *frame, const MeasureRequest *request, Arena scratch,
                   FrameMeasurement *out, Error *err) {
    RegionPlanes planes = {.wanted = -1};
    Sums sums = {.least = INFINITY, .greatest = -INFINITY};
    ExrWindow r = frame->data, w = frame->display;
    FrameView circle = frame_view_circle(frame);
    if (!check_region(frame, request, &r, err)) return false;
    if ((request->display &&
         !region_planes_choose(frame, request->display, &scratch, &planes, err)) ||
        !region_planes_find(frame, &scratch, &planes, err))
        return error_in_file(err, request->frame_name);
    for (int y = r.y0; y < r.y1; y++)
        for (int x = r.x0; x < r.x1; x++)
            if (frame_view_sees(&circle, x - w.x0, y - w.y0))
                add_pixel(&planes,
                          (size_t)(y - w.y0) * (size_t)planes.light.width + (size_t)(x - w.x0),
                          &sums);
    if (sums.pixels == 0) return no_pixel(request, &sums, err);
    if (states_noise(&planes)) choose_noise(&sums);
    add_rim_noise(&sums);
    *out = figures_of(&planes, &sums);
    out->has_content = request->has_region || request->display;
    size_t first = (size_t)(r.y0 - w.y0) * (size_t)planes.light.width + (size_t)(r.x0 - w.x0);
    if (out->has_content)
        out->content = measure_content(&planes, &r, out->has_variance, first, scratch);
    return true;
}
