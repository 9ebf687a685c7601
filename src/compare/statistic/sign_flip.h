/* SPDX-License-Identifier: Apache-2.0 */
/* sign_flip.h -- the sign-flip test: sums of independent differences, and how likely the noise
 * makes them.
 *
 * src/compare/README.md has the reasons. Sums of disjoint pixels add up.
 *
 * Units    those of the differences; c is a factor that exchanging the frames does not change.
 * Threads  plain data, pure functions.
 */
#pragma once
#include <stdbool.h>

/* One pixel's difference and what is known of it. */
typedef struct NoisyNumber {
    double difference; /* test - reference */
    double mean;       /* of both */
    double variance;   /* of the difference as if samples were independent; NaN: not known */
    double stated;     /* the sum of the frames' own variances; NaN: not known */
    double halves;     /* the same from their halves; NaN: not known */
} NoisyNumber;

typedef struct SignFlipSum {
    long count;      /* of pixels */
    double sum;      /* of c d */
    double square;   /* of (c d)^2 */
    double fourth;   /* of (c d)^4 */
    double variance; /* of c^2 times NoisyNumber's variance, stated, halves */
    double stated, halves;
    double light; /* of c times the size of the mean */
} SignFlipSum;

/* Properties of the two frames' noise together. */
typedef struct NoiseLaw {
    bool is_same;      /* exchanging the frames changes nothing */
    bool has_variance; /* NoisyNumber.variance is known and comes from both frames together */
    bool has_halves;
} NoiseLaw;

void sign_flip_add(SignFlipSum *sum, const NoisyNumber *number, double c);
void sign_flip_join(SignFlipSum *sum, const SignFlipSum *other);

/* A shift of the light by less than this share is rounding, not a move. */
#define SIGN_FLIP_ROUNDING 1e-5

/* The first quotient's size, with the larger denominator for noise of two laws; 0 without any
 * difference. */
double sign_flip_quotient(const SignFlipSum *sum, NoiseLaw law);

/* Variance of the square of that quotient over its signs: 2 minus twice the share that the
 * largest terms have; 0 for a single pixel. */
double sign_flip_square_variance(const SignFlipSum *sum);

/* How likely the sum is as large or larger, of either sign; never too small: see above. */
double sign_flip_p(const SignFlipSum *sum, NoiseLaw law);

/* Standard error of `sum` when only the noise differs. */
double sign_flip_sigma(const SignFlipSum *sum, NoiseLaw law);

/* The p-value of the least of `count` independent ones. */
double sidak_p(double least, double count);

/* The level of one test for which `count` of them have the level together. */
double sidak_level(double level, double count);

/* Upper tail of a normal distribution, and of a gamma distribution by Wilson and Hilferty's
 * cube root (1931), good to some per cent for shapes above 1. */
double normal_tail(double z);
double gamma_tail(double value, double mean, double variance);
