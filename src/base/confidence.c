/* SPDX-License-Identifier: Apache-2.0 */
#include "base/confidence.h"

#include <math.h>

#include "base/mathd.h"

void batch_add(BatchSums *sums, double mean) {
    sums->count++;
    sums->sum += mean;
    sums->squares += mean * mean;
    sums->cubes += mean * mean * mean;
}

/* About the mean, over all batches. */
static double variance_of(const BatchSums *sums) {
    double mean = sums->sum / sums->count;
    return fmax(sums->squares / sums->count - mean * mean, 0);
}

double batch_error(const BatchSums *sums) {
    return sqrt(variance_of(sums) / (sums->count - 1));
}

void bright_add(BrightSamples *samples, double light) {
    double square = light * light;
    samples->squares += square;
    samples->fourths += square * square;
}

void bright_merge(BrightSamples *to, const BrightSamples *more) {
    to->squares += more->squares;
    to->fourths += more->fourths;
}

/* Light that few paths find, and that then is bright, is missing from most means, and their
 * spread does not show it; but the light around it does. With q and f the sums of squares and
 * of fourth powers, q^2/f samples make most of the spread, each of the light sqrt(f/q). Where
 * the brightest go with rank i as i^-k these are 1.2 samples for k = 2 (a lamp in a glossy
 * edge, whose lobe falls with the fourth power of the angle), 2.5 for k = 1, and more and more
 * where the spread is finite (k < 1/2). As many such may be missing: for k = 2 those up to 50
 * times as bright as the brightest, 2 (sqrt(50) - 1) = 12; for k = 1 log(50) = 4 to 7; of many
 * that are alike what an interval of Poisson's has more than a normal one, 1. */
double bright_missing(const BrightSamples *samples, double count, double repeated) {
    double q = samples->squares, f = samples->fourths;
    if (!(f > 0)) return 0;
    return (1 + 14 * f / (q * q * repeated)) * sqrt(f / q) / (count * repeated);
}

/* The third moment by the standard deviation's cube. */
static double skewness_of(const BatchSums *sums) {
    double n = sums->count, mean = sums->sum / n, variance = variance_of(sums);
    if (!(variance > 0)) return 0;
    double third = sums->cubes / n - mean * (3 * variance + mean * mean);
    return third / (variance * sqrt(variance));
}

double student_quantile(double freedom) {
    double z = NORMAL_QUANTILE, s = z * z, v = freedom;
    return z * (1 + (s + 1) / (4 * v) + ((5 * s + 16) * s + 3) / (96 * v * v) +
                (((3 * s + 19) * s + 17) * s - 15) / (384 * v * v * v));
}

/* The same bits on every processor. */
static double cube_root(double x) {
    return x != 0 ? copysign(exp_d(log_d(fabs(x)) / 3), x) : 0;
}

/* The inverse t of Hall's transformation: t + a t^2 / 3 + a^2 t^3 / 27 + a / 6 is `value`, a
 * the skewness over the square root of the count. */
static double untransformed(double value, double a) {
    if (fabs(a) < 1e-6) return value;
    return 3 / a * (cube_root(1 + a * (value - a / 6)) - 1);
}

MeanInterval batch_interval(const BatchSums *sums) {
    double n = sums->count, mean = sums->sum / n, error = batch_error(sums);
    double a = skewness_of(sums) / sqrt(n), t = student_quantile(n - 1);
    return (MeanInterval){mean - error * untransformed(t, a), mean - error * untransformed(-t, a)};
}

/* One end: by so much each input alone takes the figure there, in `away`. */
static double end_of(double (*f)(const double *at, const void *user), const void *user,
                     const IntervalInput *in, int count, bool is_low, double *away) {
    double at[INTERVAL_INPUTS] = {0}, squares = 0, last = 0;
    int moved = 0;
    for (int i = 0; i < count; i++) at[i] = in[i].is;
    double middle = f(at, user);
    if (isnan(middle)) return middle;
    for (int i = 0; i < count; i++) {
        double end = is_low ? in[i].less : in[i].more;
        away[i] = 0;
        if (end == in[i].is) continue;
        at[i] = end;
        last = f(at, user);
        away[i] = last - middle;
        squares += away[i] * away[i];
        moved++;
        if (isfinite(middle)) at[i] = in[i].is;
    }
    if (!moved) return middle;
    if (moved > 1 && isfinite(middle)) return middle + (is_low ? -sqrt(squares) : sqrt(squares));
    return is_low ? fmin(last, middle) : fmax(last, middle);
}

FigureInterval interval_of(double (*f)(const double *at, const void *user), const void *user,
                           const IntervalInput *in, int count) {
    FigureInterval out = {0, 0, {0}, {0}};
    out.low = end_of(f, user, in, count, true, out.below);
    out.high = end_of(f, user, in, count, false, out.above);
    return out;
}

double interval_share(const FigureInterval *of, bool is_below, int first, int count) {
    const double *away = is_below ? of->below : of->above;
    double all = 0, part = 0;
    for (int i = 0; i < INTERVAL_INPUTS; i++) {
        all += away[i] * away[i];
        if (i >= first && i < first + count) part += away[i] * away[i];
    }
    return all > 0 ? sqrt(part / all) : 1;
}
