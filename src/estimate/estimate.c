/* SPDX-License-Identifier: Apache-2.0 */
#include "estimate/estimate.h"

#include <math.h>

#include "base/mathd.h"

static double batch_paths(const EstimateSums *sums, int i) {
    long pieces = sums->paths / sums->piece;
    return (double)((pieces - i + sums->batches - 1) / sums->batches * sums->piece);
}

/* Over all paths of a batch. Where batches differ in length each is the mean of all and, as a
 * share of the whole, what its sum has more than its paths' part: so they stay alike. */
static double batch_mean(const EstimateSums *sums, int i, double mean) {
    double own = batch_paths(sums, i);
    if (sums->paths % ((long)sums->batches * sums->piece) == 0) return sums->batch[i] / own;
    return mean + (sums->batch[i] - mean * own) * sums->batches / (double)sums->paths;
}

static double mean_of(const EstimateSums *sums) {
    double sum = 0;
    for (int i = 0; i < sums->batches; i++) sum += sums->batch[i];
    return sum / (double)sums->paths;
}

double estimate_batch(const EstimateSums *sums, int i) {
    return batch_mean(sums, i, mean_of(sums)) / sums->share;
}

Estimate estimate_of(const EstimateSums *sums) {
    BatchSums means = {0};
    double share = sums->share, counted = (double)sums->paths * share;
    double mean = mean_of(sums);
    for (int i = 0; i < sums->batches; i++) batch_add(&means, batch_mean(sums, i, mean));
    MeanInterval in = batch_interval(&means);
    double missing = bright_missing(&sums->bright, counted, 1);
    return (Estimate){.mean = means.sum / sums->batches / share,
                      .sigma = batch_error(&means) / share,
                      .interval = {fmax(in.low, 0) / share,
                                   in.high / share + missing + sums->unmet + sums->unseen},
                      .bright = sums->bright,
                      .counted = counted,
                      .unmet = sums->unmet,
                      .unseen = sums->unseen};
}

void estimate_add_known(Estimate *to, double known, double sigma) {
    to->mean += known;
    to->sigma = hypot(to->sigma, sigma);
    to->known_sigma = hypot(to->known_sigma, sigma);
    to->interval.low += known - 2 * sigma;
    to->interval.high += known + 2 * sigma;
}

/* What the upper end has more than the spread, and fewer paths have more of. */
static double beyond(const Estimate *estimate, double times) {
    return bright_missing(&estimate->bright, estimate->counted, times) + estimate->unmet / times;
}

Estimate estimate_expected(const Estimate *pilot, double times) {
    double scale = sqrt(1 / times), known = pilot->known_sigma;
    double sampled = sqrt(fmax(pilot->sigma * pilot->sigma - known * known, 0));
    Estimate fresh = *pilot;
    fresh.sigma = hypot(sampled * scale, known);
    fresh.unmet = pilot->unmet / times;
    fresh.counted = pilot->counted * times;
    fresh.interval.low -= (pilot->mean - pilot->interval.low) * scale;
    fresh.interval.low = fmax(fresh.interval.low, 0);
    fresh.interval.high +=
        (pilot->interval.high - pilot->unseen - beyond(pilot, 1) - pilot->mean) * scale +
        beyond(pilot, times);
    return fresh;
}

/* None of n is met with the chance (1 - p)^n <= exp(-n p), p that of meeting it: with that of
 * one end of the interval at the most where p n is more than this. */
double estimate_unmet(double each, double paths) {
    return paths > 0 ? each * fmin(-log_d(CONFIDENCE_MISS / 2) / paths, 1) : each;
}

void estimate_sums_add(EstimateSums *to, const EstimateSums *more) {
    double scale = (double)to->paths / (double)more->paths, square = scale * scale;
    for (int i = 0; i < to->batches; i++) to->batch[i] += scale * more->batch[i];
    to->bright.squares += square * more->bright.squares;
    to->bright.fourths += square * square * more->bright.fourths;
    to->unmet += more->unmet;
    to->unseen += more->unseen;
}
