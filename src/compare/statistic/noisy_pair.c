/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/statistic/noisy_pair.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mathd.h"
#include "base/number.h"

#define LAYERS_WANTED "--layers variance,halves,samples"
/* Sample counts that differ by no more than this share make noise of one shape. */
#define ONE_COUNT 0.1
/* So do variances when neither frame has the larger one in more than this share of the pixels
 * beyond a half, or more than so many standard errors of such a share. */
#define ONE_SIZE 0.05
#define ONE_SIZE_ERRORS 5

/* ---- opening ----------------------------------------------------------------------------- */

static void read_layer(const FrameImage *frame, const char *layer, const float *rgb[3]) {
    if (!frame_rgb(frame, layer, rgb)) rgb[0] = rgb[1] = rgb[2] = NULL;
}

/* "parhelion:samples" is "A:B", half-open. */
static double stated_samples(const FrameImage *frame) {
    const char *text = frame_string(frame, "parhelion:samples");
    uint64_t first, last;
    const char *at = text ? number_read_count(text, &first) : NULL;
    if (at && *at == ':') at = number_read_count(at + 1, &last);
    else at = NULL;
    return at && !*at && last > first ? (double)(last - first) : (double)NAN;
}

/* A count: whole, none below 0; NULL: every value is one that the program could have written. */
static const char *fault_of_count(float value, double most) {
    if (!(value >= 0) || value != floorf(value)) return "is no count";
    return (double)value > most ? "is more than the frame has samples" : NULL;
}

static const char *fault_of_id(float value, double most) {
    (void)most;
    return isfinite(value) && value == floorf(value) ? NULL : "is no number of a part";
}

static const char *fault_of_variance(float value, double most) {
    (void)most;
    return value < 0 ? "is no variance" : NULL;
}

/* Notes the first value of a channel that has a fault; false: there is none. */
static bool note_fault(const FrameImage *frame, const char *channel, double most,
                       const char *(*fault_of)(float, double), char broken[96]) {
    const float *values = frame_channel(frame, channel);
    size_t width = (size_t)(frame->data.x1 - frame->data.x0);
    for (size_t i = 0; values && i < frame_pixel_count(frame); i++) {
        const char *fault = fault_of(values[i], most);
        if (!fault) continue;
        snprintf(broken, 96, "%s: %.6g at pixel %zu,%zu %s", channel, (double)values[i], i % width,
                 i / width, fault);
        return true;
    }
    return false;
}

/* Whoever multiplies all channels of a frame multiplies these. */
static void leave_broken_out(const FrameImage *frame, NoisySide *side) {
    double most = isnan(side->samples_of_all) ? INFINITY : side->samples_of_all;
    if (note_fault(frame, "samples.N", most, fault_of_count, side->broken)) {
        side->samples = NULL;
        side->samples_of_all = NAN;
    } else if (note_fault(frame, "variance.G", 0, fault_of_variance, side->broken)) {
        side->variance[0] = side->variance[1] = side->variance[2] = NULL;
    } else {
        note_fault(frame, "id.display", 0, fault_of_id, side->broken);
    }
}

static bool open_side(const FrameImage *frame, const char *name, NoisySide *out, Error *err) {
    read_layer(frame, "", out->light);
    read_layer(frame, "variance", out->variance);
    read_layer(frame, "halves", out->halves);
    read_layer(frame, "display.reflected", out->reflected);
    out->samples = frame_channel(frame, "samples.N");
    out->samples_of_all = stated_samples(frame);
    leave_broken_out(frame, out);
    if (!out->light[0]) return error_at(err, ERROR_INPUT, name, "", "has no channels R, G, B");
    if (out->variance[0] || out->halves[0]) return true;
    return error_at(err, ERROR_INPUT, name, "",
                    "has neither layer variance nor halves, which tell its noise; render it "
                    "with " LAYERS_WANTED);
}

static double samples_at(const NoisySide *side, size_t i) {
    return side->samples ? (double)side->samples[i] : side->samples_of_all;
}

static size_t pixels_of(const NoisyPair *pair) {
    return (size_t)(pair->data.x1 - pair->data.x0) * (size_t)(pair->data.y1 - pair->data.y0);
}

/* Whether all but a hundredth of the pixels have as many samples in both. */
static bool has_one_count(const NoisyPair *pair) {
    size_t count = pixels_of(pair), odd = 0;
    for (size_t i = 0; i < count; i++) {
        double a = samples_at(&pair->side[0], i), b = samples_at(&pair->side[1], i);
        odd += !(fabs(a - b) <= ONE_COUNT * fmax(a, b));
    }
    return odd <= count / 100;
}

/* Whether the noise is about as strong in both: a program that got better at finding light
 * makes another noise of the same mean. */
static bool has_one_size(const NoisyPair *pair) {
    double more = 0, less = 0;
    for (size_t i = 0; pair->has_variance && i < pixels_of(pair); i++) {
        float a = pair->side[0].variance[1][i], b = pair->side[1].variance[1][i];
        more += a > b;
        less += a < b;
    }
    double share = fabs(more - less) / 2, all = more + less;
    return share <= fmax(ONE_SIZE * all, ONE_SIZE_ERRORS * 0.5 * sqrt(all));
}

static bool same_text(const FrameImage *a, const FrameImage *b, const char *name) {
    const char *one = frame_string(a, name), *other = frame_string(b, name);
    return one && other && !strcmp(one, other);
}

bool noisy_pair_shares_noise(const FrameImage *reference, const FrameImage *test) {
    return same_text(reference, test, "parhelion:seed") &&
           same_text(reference, test, "parhelion:samples");
}

static bool check_windows(const FrameImage *reference, const FrameImage *test,
                          const StatisticOptions *options, Error *err) {
    const ExrWindow a = reference->data, b = test->data;
    if (!memcmp(&a, &b, sizeof a) && !memcmp(&reference->display, &test->display, sizeof a))
        return true;
    return error_at(err, ERROR_INPUT, options->test_name, "",
                    "holds pixels %d,%d,%d,%d, the reference %d,%d,%d,%d: required: the same", b.x0,
                    b.y0, b.x1, b.y1, a.x0, a.y0, a.x1, a.y1);
}

bool noisy_pair_open(const FrameImage *reference, const FrameImage *test,
                     const StatisticOptions *options, NoisyPair *out, Error *err) {
    NoisyPair pair = {
        .data = reference->data, .display_window = reference->display, .mask = options->mask};
    NoisySide *a = &pair.side[0], *b = &pair.side[1];
    if (!open_side(reference, options->reference_name, a, err) ||
        !open_side(test, options->test_name, b, err) ||
        !check_windows(reference, test, options, err))
        return false;
    if (!a->broken[0] && !b->broken[0]) pair.display = frame_channel(reference, "id.display");
    pair.has_reflected = pair.display && a->reflected[0] && b->reflected[0];
    pair.has_variance = a->variance[0] && b->variance[0];
    pair.has_halves = a->halves[0] && b->halves[0];
    pair.knows_samples =
        (a->samples || a->samples_of_all > 0) && (b->samples || b->samples_of_all > 0);
    pair.shares_noise = noisy_pair_shares_noise(reference, test);
    pair.law.is_same =
        pair.knows_samples && has_one_count(&pair) && (pair.shares_noise || has_one_size(&pair));
    pair.law.has_variance = pair.has_variance && pair.knows_samples;
    pair.law.has_halves = pair.has_halves;
    *out = pair;
    return true;
}

/* ---- reading ----------------------------------------------------------------------------- */

bool noisy_pair_counts(const NoisyPair *pair, int x, int y) {
    const ExrWindow w = pair->display_window;
    int column = x + pair->data.x0 - w.x0, row = y + pair->data.y0 - w.y0;
    if (column < 0 || row < 0 || column >= w.x1 - w.x0 || row >= w.y1 - w.y0) return false;
    size_t place = (size_t)row * (size_t)(w.x1 - w.x0) + (size_t)column;
    if (pair->mask && !pair->mask[place]) return false;
    size_t i = noisy_pair_index(pair, x, y);
    for (int s = 0; s < 2; s++)
        for (int c = 0; c < 3; c++)
            if (!isfinite(pair->side[s].light[c][i])) return false;
    return true;
}

static double luminance_of(const float *const rgb[3], size_t i) {
    return 0.2126 * (double)rgb[0][i] + 0.7152 * (double)rgb[1][i] + 0.0722 * (double)rgb[2][i];
}

double noisy_pair_luminance(const NoisyPair *pair, int side, size_t i, NoisyChannel channel) {
    const NoisySide *s = &pair->side[side];
    return luminance_of(channel == NOISY_REFLECTED ? s->reflected : s->light, i);
}

static double value_of(const NoisyPair *pair, int side, size_t i, NoisyChannel channel) {
    return channel < NOISY_LUMINANCE ? (double)pair->side[side].light[channel][i]
                                     : noisy_pair_luminance(pair, side, i, channel);
}

/* From the frame's own layer. R, G and B count as fully correlated, which gives the greatest
 * variance that the luminance can have. */
static double stated_variance(const NoisySide *side, size_t i, NoisyChannel channel) {
    if (channel < NOISY_LUMINANCE) return (double)side->variance[channel][i];
    double sigma = 0.2126 * sqrt((double)side->variance[0][i]) +
                   0.7152 * sqrt((double)side->variance[1][i]) +
                   0.0722 * sqrt((double)side->variance[2][i]);
    return sigma * sigma;
}

static double halves_variance(const NoisySide *side, size_t i, NoisyChannel channel) {
    double h = channel < NOISY_LUMINANCE ? (double)side->halves[channel][i]
                                         : luminance_of(side->halves, i);
    return h * h;
}

/* The sum of squares about a mean of `count` samples, from that mean's variance. */
static double squares_of(double variance, double count) {
    return count > 1 ? count * (count - 1) * variance : 0;
}

/* Variance of the difference of two means of a and b samples of one kind: the squares of all
 * samples about their common mean, shared out over a + b - 1 of them. stated: of each mean. */
static double common_variance(const double stated[2], double difference, double a, double b) {
    double squares = squares_of(stated[0], a) + squares_of(stated[1], b) +
                     a * b / (a + b) * difference * difference;
    double common = squares / (a + b - 1) * (1 / a + 1 / b), own = stated[0] + stated[1];
    return common > own || a == b ? common : own;
}

bool noisy_pair_number(const NoisyPair *pair, size_t i, NoisyChannel channel, double scale,
                       NoisyNumber *out) {
    const NoisySide *a = &pair->side[0], *b = &pair->side[1];
    double reference = scale * value_of(pair, 0, i, channel);
    double test = value_of(pair, 1, i, channel), square = scale * scale;
    if (!isfinite(reference) || !isfinite(test)) return false;
    *out = (NoisyNumber){.difference = test - reference,
                         .mean = 0.5 * (test + reference),
                         .variance = NAN,
                         .stated = NAN,
                         .halves = NAN};
    if (pair->has_halves)
        out->halves = square * halves_variance(a, i, channel) + halves_variance(b, i, channel);
    if (!pair->has_variance) return true;
    double stated[2] = {square * stated_variance(a, i, channel), stated_variance(b, i, channel)};
    out->stated = stated[0] + stated[1];
    if (pair->knows_samples)
        out->variance =
            common_variance(stated, out->difference, samples_at(a, i), samples_at(b, i));
    return true;
}

/* Student's t for the tail of a normal z: t^2 = n (exp(z^2 w^2 / n) - 1), w = (8 n + 3) / (8 n +
 * 1), n samples less one (Wallace 1959). */
double noisy_pair_sigma(const NoisyPair *pair, size_t i, double sigmas) {
    NoisyNumber number;
    double n = fmin(samples_at(&pair->side[0], i), samples_at(&pair->side[1], i)) - 1;
    if (!pair->has_variance || !(n >= 1) ||
        !noisy_pair_number(pair, i, NOISY_LUMINANCE, 1, &number))
        return INFINITY;
    double z = sigmas * (8 * n + 3) / (8 * n + 1);
    return sqrt(number.stated * n * expm1_d(z * z / n)) / sigmas;
}

bool noisy_pair_differs(const NoisyPair *pair, size_t i) {
    for (int c = 0; c < 3; c++) {
        double a = (double)pair->side[0].light[c][i], b = (double)pair->side[1].light[c][i];
        if (fabs(a - b) > SIGN_FLIP_ROUNDING * fmax(fabs(a), fabs(b))) return true;
    }
    return false;
}
