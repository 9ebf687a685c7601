/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/statistic/sign_flip.h"

#include <math.h>

#include "base/mathd.h"

/* 1 / (4 Q(sqrt 2)), Bentkus and Dzindzalieta's constant. */
#define BENTKUS_CONSTANT 3.1786
/* From so many terms of one size on the normal tail stands for that of their signs: the fourth
 * cumulant of the sum is -2 / terms, so its tail is the thinner one; that it comes in steps
 * makes it 1.6 times the normal one at the worst place of 16 equal terms. */
#define MANY_TERMS 16
/* The quotient is at most the root of the terms: with so many that limits nothing, and the
 * second one is not used. */
#define SURE_TERMS 64
/* Pixels from which the halves show what Sobol points gain, and the greatest gain accepted. */
#define MANY_PIXELS 100
#define LEAST_GAIN 0.1

void sign_flip_add(SignFlipSum *sum, const NoisyNumber *number, double c) {
    double term = c * number->difference, square = term * term;
    sum->count++;
    sum->sum += term;
    sum->square += square;
    sum->fourth += square * square;
    sum->variance += c * c * number->variance;
    sum->stated += c * c * number->stated;
    sum->halves += c * c * number->halves;
    sum->light += fabs(c * number->mean);
}

void sign_flip_join(SignFlipSum *sum, const SignFlipSum *other) {
    sum->count += other->count;
    sum->sum += other->sum;
    sum->square += other->square;
    sum->fourth += other->fourth;
    sum->variance += other->variance;
    sum->stated += other->stated;
    sum->halves += other->halves;
    sum->light += other->light;
}

/* ---- denominators ------------------------------------------------------------------------ */

/* For noise of two laws: the larger of the variance seen between the frames and the one
 * expected from both frames' samples, times the share of it that the halves show. */
static double larger_variance(const SignFlipSum *sum, NoiseLaw law) {
    double expected = law.has_variance ? sum->variance : sum->stated;
    if (isnan(expected)) expected = sum->halves;
    if (law.has_halves && sum->count >= MANY_PIXELS && sum->stated > 0) {
        double gain = sum->halves / sum->stated;
        expected *= gain < LEAST_GAIN ? LEAST_GAIN : gain < 1 ? gain : 1;
    }
    return expected > sum->square ? expected : sum->square; /* false for NaN */
}

static double variance_of(const SignFlipSum *sum, NoiseLaw law) {
    return law.is_same ? sum->square : larger_variance(sum, law);
}

double sign_flip_sigma(const SignFlipSum *sum, NoiseLaw law) {
    return sqrt(variance_of(sum, law));
}

/* How far the sum is beyond rounding. */
static double reach(const SignFlipSum *sum) {
    double far = fabs(sum->sum) - SIGN_FLIP_ROUNDING * sum->light;
    return far > 0 ? far : 0;
}

static double quotient(double reach, double variance) {
    return reach > 0 ? reach / sqrt(variance) : 0;
}

double sign_flip_quotient(const SignFlipSum *sum, NoiseLaw law) {
    return quotient(reach(sum), variance_of(sum, law));
}

/* How many terms of one size would spread like these. */
static double terms(const SignFlipSum *sum) {
    return sum->fourth > 0 ? sum->square * sum->square / sum->fourth : 0;
}

/* With random signs e, E (sum of a e)^4 = 3 (sum of a^2)^2 - 2 (sum of a^4). */
double sign_flip_square_variance(const SignFlipSum *sum) {
    double count = terms(sum);
    return count > 1 ? 2 - 2 / count : 0;
}

/* ---- probabilities ----------------------------------------------------------------------- */

double normal_tail(double z) {
    return 0.5 * erfc_d(z * 0.70710678118654752);
}

double gamma_tail(double value, double mean, double variance) {
    if (!(value > mean) || !(variance > 0)) return 1;
    double ninth = variance / (9 * mean * mean); /* 1 / (9 shape) */
    double root = exp_d(log_d(value / mean) / 3);
    return normal_tail((root - (1 - ninth)) / sqrt(ninth));
}

static double bounded(double p) {
    return p < 1 ? p : 1;
}

double sign_flip_p(const SignFlipSum *sum, NoiseLaw law) {
    double far = reach(sum);
    if (!(far > 0)) return 1;
    double p = 2 * normal_tail(sign_flip_quotient(sum, law));
    if (!law.is_same || terms(sum) < MANY_TERMS) p = bounded(BENTKUS_CONSTANT * p);
    if (!law.is_same || !law.has_variance || terms(sum) >= SURE_TERMS) return p;
    double expected = BENTKUS_CONSTANT * 2 * normal_tail(quotient(far, sum->variance));
    return bounded(2 * (expected < p ? expected : p));
}

/* log(1 - p) that keeps its digits for small p. */
static double log_complement(double p) {
    return p < 1e-6 ? -p - 0.5 * p * p : log_d(1 - p);
}

/* Subtracted, not negated: without a doubt left the answer is 0, and not -0. */
double sidak_p(double least, double count) {
    return least < 1 ? 0 - expm1_d(count * log_complement(least)) : 1;
}

double sidak_level(double level, double count) {
    return -expm1_d(log_complement(level) / count);
}
