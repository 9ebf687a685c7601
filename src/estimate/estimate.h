/* SPDX-License-Identifier: Apache-2.0 */
/* estimate.h -- a mean over random paths and how sure it is: one rule for all who print an
 * interval of what paths find.
 *
 * Paths come in batches that differ in nothing but chance. The interval is that of the batches'
 * means (batch_interval); its upper end has, besides, the light of bright paths that may be
 * missing (bright_missing), what is known to be there but was met by none (`unmet`), and what
 * no number of paths would show (`unseen`). What is known without paths, with an error of
 * its own, is added last. How many paths there are must hang on none of them
 * (estimate_plan.h).
 *
 * Units    the figure's.
 * Threads  pure functions.
 */
#pragma once
#include "base/confidence.h"

#define ESTIMATE_BATCHES 32

/* One figure's light over all paths. */
typedef struct EstimateSums {
    double batch[ESTIMATE_BATCHES]; /* of each batch's paths */
    BrightSamples bright;           /* path by path */
    int batches;                    /* 2 .. ESTIMATE_BATCHES */
    long paths;                     /* of all batches; which get them in turn, */
    int piece;                      /* so many at once: paths is a multiple */
    double share;  /* of paths that count, above 0: the mean is over these; as a rule 1 */
    double unmet;  /* light that may be there although no path met it: what the mean of the
                      truth may have of it, at most (estimate_unmet) */
    double unseen; /* likewise, but by a bound that paths do not lessen */
} EstimateSums;

typedef struct Estimate {
    double mean, sigma;    /* its standard error */
    MeanInterval interval; /* 95 %, its lower end at least 0 */
    BrightSamples bright;  /* of the paths, */
    double counted;        /* so many of which count */
    double unmet, unseen;  /* EstimateSums's */
    double known_sigma;    /* error that no path lessens */
} Estimate;

Estimate estimate_of(const EstimateSums *sums);

/* The mean of batch i by itself, over its paths that count. */
double estimate_batch(const EstimateSums *sums, int i);

/* Adds what is known within an error. */
void estimate_add_known(Estimate *to, double known, double sigma);

/* By so many times the paths, all fresh: as wide as these make it, about somewhere in this
 * one's interval. What is unseen stays, once: fresh paths meet none of it. */
Estimate estimate_expected(const Estimate *pilot, double times);

/* Light that other paths find, in as many batches of equal length: it adds to each one's. */
void estimate_sums_add(EstimateSums *to, const EstimateSums *more);

/* The mean that light of `each` a path may have, although none of `paths` met it. */
double estimate_unmet(double each, double paths);
