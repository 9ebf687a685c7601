/* SPDX-License-Identifier: Apache-2.0 */
/* confidence.h -- where the true mean lies, from a few batches of samples whose tail is long.
 *
 * Light has a long tail: few paths find the sun in a mirror, and where they are missing mean
 * and spread are both too small, so that the usual interval misses too often below. The
 * interval here is that of Student's t after Hall's transformation, which takes the skewness of
 * the samples out of it ("On the removal of skewness by transformation", J. R. Stat. Soc. B 54
 * (1992) 221-228). Student's quantiles from normal ones by the series of Abramowitz and Stegun,
 * 26.7.5.
 *
 * Threads  pure functions.
 */
#pragma once
#include <stdbool.h>

#define CONFIDENCE_MISS 0.05 /* chance that a 95 % interval does not hold the true value */
/* A normal variable lies farther out, on either side, with that chance: erfc(z / sqrt 2) */
#define NORMAL_QUANTILE 1.959963984540054

/* Power sums of batch means; every batch has the same number of samples. */
typedef struct BatchSums {
    double count, sum, squares, cubes;
} BatchSums;

void batch_add(BatchSums *sums, double mean);

/* The standard error of the mean of all; at least 2 batches. */
double batch_error(const BatchSums *sums);

/* Exceeded by a variable of Student's distribution, either side, with CONFIDENCE_MISS. */
double student_quantile(double freedom);

typedef struct MeanInterval {
    double low, high;
} MeanInterval;

/* Power sums of single samples of light, each 0 or more. */
typedef struct BrightSamples {
    double squares, fourths; /* sums */
} BrightSamples;

void bright_add(BrightSamples *samples, double light);
void bright_merge(BrightSamples *to, const BrightSamples *more);

/* The light that a mean over `count` samples may lack for lack of bright ones: the upper end
 * of its interval has this more. repeated: the mean is over so many times these samples. */
double bright_missing(const BrightSamples *samples, double count, double repeated);

/* Misses the true mean with CONFIDENCE_MISS, both sides together. */
MeanInterval batch_interval(const BatchSums *sums);

/* An input of a figure: how large it is, and the ends of its own 95 % interval, the one that makes
 * the figure less and the one that makes it more. */
typedef struct IntervalInput {
    double is, less, more;
} IntervalInput;

#define INTERVAL_INPUTS 8

/* A figure's interval, and how far each input by itself takes it to its two ends. */
typedef struct FigureInterval {
    double low, high;
    double below[INTERVAL_INPUTS], above[INTERVAL_INPUTS];
} FigureInterval;

/* The one rule for figures that are made of several: each input is moved to an end of its own
 * interval, and what that moves the figure by is added as squares, since the inputs are
 * independent (Zou and Donner, Stat. Med. 27 (2008) 1693-1702). An infinite figure has the ends
 * of all inputs at once. f gets count <= INTERVAL_INPUTS values. */
FigureInterval interval_of(double (*f)(const double *at, const void *user), const void *user,
                           const IntervalInput *in, int count);

/* Which share of the doubt below or above, 0..1, is that of inputs first .. first + count - 1? */
double interval_share(const FigureInterval *of, bool is_below, int first, int count);
