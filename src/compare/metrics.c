/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/metrics.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "compare/metrics/deltae.h"
#include "compare/metrics/ssim.h"
#include "image/develop.h"
#include "image/exposure.h"
#include "image/srgb.h"

#define SILLY_STOPS 12 /* of HDR-FLIP's own range: only a sun is that far above the median */

double ev_of_stops(double stops) {
    return exposure_ev_of_grey(MIDDLE_GREY / exp2_d(stops));
}

double stops_of_ev(double ev) {
    return log2_d(MIDDLE_GREY / exposure_grey_of_ev(ev));
}

/* ---- what is looked at ------------------------------------------------------------------- */

/* Light with 0 for what is not finite on either side; such pixels leave the mask. */
static void clean_light(Comparison *out, Arena *arena) {
    const Planes *from[2] = {&out->reference.light, &out->test.light};
    size_t count = planes_pixel_count(from[0]);
    unsigned char *mask = ARENA_NEW(arena, unsigned char, count);
    float *to[2][3];
    memcpy(mask, out->selection.counts, count);
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            if (!isfinite(from[0]->rgb[c][i]) || !isfinite(from[1]->rgb[c][i])) mask[i] = 0;
    for (int side = 0; side < 2; side++) {
        out->light[side] = *from[side];
        for (int c = 0; c < 3; c++) {
            to[side][c] = ARENA_NEW(arena, float, count);
            for (size_t i = 0; i < count; i++) {
                float value = from[side]->rgb[c][i];
                to[side][c][i] = isfinite(value) ? value : 0;
            }
            out->light[side].rgb[c] = to[side][c];
        }
    }
    out->mask = mask;
}

/* Interleaved codes as planes, cut off at black and white. */
static Planes planes_of(const Picture *picture, Arena *arena) {
    Planes planes = {picture->width, picture->height, {NULL}};
    size_t count = planes_pixel_count(&planes);
    for (size_t c = 0; c < 3; c++) {
        float *plane = ARENA_NEW(arena, float, count);
        for (size_t i = 0; i < count; i++) {
            float code = picture->rgb[3 * i + c];
            plane[i] = code > 0 ? (code < 1 ? code : 1) : 0;
        }
        planes.rgb[c] = plane;
    }
    return planes;
}

/* Both with the reference's exposure and view. */
bool metrics_develop(const CompareOptions *options, Arena *arena, Comparison *out, Error *err) {
    if (out->reference.kind != INPUT_FRAME) return true;
    CompareInput *sides[2] = {&out->reference, &out->test};
    DevelopReport report;
    /* Local adaptation is a look, of which no figure may be taken. */
    DevelopOptions develop = {
        .exposure = options->exposure, .own_config = true, .adapt = DEVELOP_ADAPT_NONE};
    for (int side = 0; side < 2; side++) {
        Picture picture;
        develop.frame_name = sides[side]->name;
        if (!develop_picture(&sides[side]->frame, &develop, arena, &picture, &report, err))
            return false;
        sides[side]->codes = planes_of(&picture, arena);
        if (side == 0) {
            out->shown_ev = report.ev;
            out->shown_with =
                arena_format(arena, "%s, %s, %s", report.display, report.view, report.config);
            develop.exposure = arena_format(arena, "%.17g", report.ev);
            develop.view = arena_format(arena, "%s", report.view);
        }
    }
    return true;
}

/* The display-referred linear light of codes. */
static Planes shown_light(const Planes *codes, Arena *arena) {
    Planes planes = *codes;
    size_t count = planes_pixel_count(codes);
    for (int c = 0; c < 3; c++) {
        float *plane = ARENA_NEW(arena, float, count);
        for (size_t i = 0; i < count; i++) plane[i] = linear_from_srgb(codes->rgb[c][i]);
        planes.rgb[c] = plane;
    }
    return planes;
}

/* ---- what is kept ------------------------------------------------------------------------ */

void metrics_set_errors(const PixelErrors *errors, unsigned groups, Comparison *out) {
    if (groups & GROUP_MSE) {
        out->value[METRIC_MSE] = errors->mse;
        out->value[METRIC_RELMSE] = errors->rel_mse;
        out->value[METRIC_MAE] = errors->mae;
        out->value[METRIC_MAX_DIFFERENCE] = errors->max_difference;
        out->value[METRIC_MEAN_SHIFT] = errors->mean_shift;
    }
    if (groups & GROUP_PSNR) {
        out->value[METRIC_PSNR] = errors->psnr_db;
        out->psnr_peak = errors->peak;
    }
}

void metrics_set_flip(const MapSummary *flip, Comparison *out) {
    out->value[METRIC_FLIP] = flip->mean;
    out->value[METRIC_FLIP_MEDIAN] = flip->median;
    out->value[METRIC_FLIP_P95] = flip->p95;
    out->value[METRIC_FLIP_MAX] = flip->max;
}

void metrics_set_deltae(const MapSummary *deltae, Comparison *out) {
    out->value[METRIC_DELTAE_MEAN] = deltae->mean;
    out->value[METRIC_DELTAE_P95] = deltae->p95;
    out->value[METRIC_DELTAE_MAX] = deltae->max;
}

/* ---- metrics ----------------------------------------------------------------------------- */

static void note_silly_range(Comparison *out) {
    const FlipExposures *e = &out->exposures;
    if (e->stop_ev - e->start_ev <= SILLY_STOPS) return;
    lines_add(&out->notes,
              "HDR-FLIP went over %d exposures, EV %.1f to %.1f: something very "
              "bright, a sun perhaps, decides the range; give one, such as "
              "--exposure-range %.0f,%.0f, or leave it out with --mask",
              e->count, ev_of_stops(e->stop_ev), ev_of_stops(e->start_ev), floor(out->shown_ev - 3),
              ceil(out->shown_ev + 3));
}

static void measure_flip(const CompareOptions *options, Arena *arena, Comparison *out) {
    size_t count = planes_pixel_count(&out->light[0]);
    FlipOptions flip = {
        .threads = options->threads, .mask = out->mask, .has_range = options->has_range};
    out->flip_map = ARENA_NEW(arena, float, count);
    if (options->has_range) {
        flip.start_ev = stops_of_ev(options->range_ev[1]);
        flip.stop_ev = stops_of_ev(options->range_ev[0]);
    }
    out->exposures = flip_hdr(&out->light[0], &out->light[1], &flip, *arena, out->flip_map);
    if (!options->has_range) note_silly_range(out);
    MapSummary s = map_summary(out->flip_map, count, out->mask);
    metrics_set_flip(&s, out);
}

static void measure_colour(Arena *arena, Comparison *out) {
    out->deltae_map = ARENA_NEW(arena, float, planes_pixel_count(&out->light[0]));
    Arena scratch = *arena;
    Planes a = shown_light(&out->reference.codes, &scratch);
    Planes b = shown_light(&out->test.codes, &scratch);
    MapSummary e = deltae_pictures(&a, &b, out->mask, out->deltae_map);
    metrics_set_deltae(&e, out);
}

/* ---- displays ---------------------------------------------------------------------------- */

/* The frame with NaN for the light of pixels that do not count: measure.h leaves those out. */
static FrameImage masked_frame(const FrameImage *frame, PixelMask mask, Arena *arena) {
    FrameImage out = *frame;
    size_t count = frame_pixel_count(frame);
    out.channels = ARENA_NEW(arena, ExrChannel, frame->channel_count);
    for (int c = 0; c < frame->channel_count; c++) {
        const char *name = frame->channels[c].name;
        out.channels[c] = frame->channels[c];
        if (strcmp(name, "R") != 0 && strcmp(name, "G") != 0 && strcmp(name, "B") != 0) continue;
        float *plane = ARENA_NEW(arena, float, count);
        for (size_t i = 0; i < count; i++) {
            long place = selection_place(frame, i);
            plane[i] = place >= 0 && mask[place] ? frame->channels[c].values[i] : NAN;
        }
        out.channels[c].values = plane;
    }
    return out;
}

static double relative(Measured measured) {
    return measured_half_width(measured) / measured.value;
}

static ContrastChange contrast_change(const char *display, const FrameImage frames[2],
                                      Arena scratch) {
    ContrastChange change = {.display = display};
    MeasureRequest request = {.display = display};
    Error unused;
    change.has = measure_frame(&frames[0], &request, scratch, &change.reference, &unused) &&
                 measure_frame(&frames[1], &request, scratch, &change.test, &unused) &&
                 change.reference.has_contrast && change.test.has_contrast;
    if (!change.has) return change;
    Measured a = change.reference.contrast, b = change.test.contrast;
    double ratio = b.value / a.value;
    change.ratio = measured_about(ratio, ratio * hypot(relative(a), relative(b)));
    return change;
}

static void measure_displays(Arena *arena, Comparison *out) {
    static const char PREFIX[] = "parhelion:display.";
    const FrameImage *frame = &out->reference.frame;
    out->contrasts = ARENA_NEW(arena, ContrastChange, frame->attribute_count);
    Arena scratch = *arena;
    FrameImage frames[2] = {masked_frame(frame, out->mask, &scratch),
                            masked_frame(&out->test.frame, out->mask, &scratch)};
    double greatest = NAN;
    for (int i = 0; i < frame->attribute_count; i++) {
        const ExrAttribute *a = &frame->attributes[i];
        if (a->kind != EXR_STRING || strncmp(a->name, PREFIX, sizeof PREFIX - 1) != 0) continue;
        ContrastChange change = contrast_change(a->text, frames, scratch);
        if (!change.has) continue;
        out->contrasts[out->contrast_count++] = change;
        if (!(fabs(change.ratio.value - 1) <= fabs(greatest))) greatest = change.ratio.value - 1;
    }
    out->value[METRIC_CONTRAST_CHANGE] = greatest;
}

/* ---- the statistical test ---------------------------------------------------------------- */

static bool measure_statistic(const CompareOptions *options, Arena *arena, Comparison *out,
                              Error *err) {
    Error why;
    const StatisticOptions stat = {options->level, out->mask, out->reference.name, out->test.name};
    out->has_stat =
        statistic_compare(&out->reference.frame, &out->test.frame, &stat, arena, &out->stat, &why);
    if (out->has_stat) {
        if (out->stat.verdict != STATISTIC_UNKNOWN) out->value[METRIC_P_VALUE] = out->stat.p_value;
        out->value[METRIC_FRACTION_FAILED] = out->stat.fraction_failed;
        if (out->stat.broken[0]) { /* its displays' numbers and samples are no others' */
            out->value[METRIC_CONTRAST_CHANGE] = NAN;
            out->contrast_count = 0;
        }
        if (out->stat.note[0]) lines_add(&out->notes, "%s", out->stat.note);
        return true;
    }
    if (options->wants_stat) {
        *err = why;
        return false;
    }
    lines_add(&out->notes, "no statistical test: %s%s%s", why.file, why.file[0] ? ": " : "",
              why.text);
    return true;
}

bool metrics_measure(const CompareOptions *options, unsigned groups, Arena *arena, Comparison *out,
                     Error *err) {
    clean_light(out, arena);
    const Planes *a = &out->light[0], *b = &out->light[1];
    change_add_rows(&out->grid, (const Planes *const[2]){a, b}, out->mask, 0,
                    (const int[2]){0, out->grid.height});
    if (groups & (GROUP_MSE | GROUP_PSNR)) {
        PixelErrors e = pixel_errors_measure(a, b, out->mask, true, *arena);
        metrics_set_errors(&e, groups, out);
    }
    if (groups & GROUP_FLIP) measure_flip(options, arena, out);
    if (groups & GROUP_SSIM)
        out->value[METRIC_SSIM] =
            ssim_mean(&out->reference.codes, &out->test.codes, out->mask, NULL, *arena);
    if (groups & GROUP_DELTAE) measure_colour(arena, out);
    if (groups & GROUP_CONTRAST) measure_displays(arena, out);
    return !(groups & GROUP_STAT) || measure_statistic(options, arena, out, err);
}
