/* SPDX-License-Identifier: Apache-2.0 */
/* The functions of mathd.h against the C library in long double precision. */
#include <float.h>
#include <math.h>

#include "base/mathd.h"
#include "check.h"

typedef double Function(double x);
typedef long double Truth(long double x);

/* A repeatable number in [0, 1). */
static double uniform(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

/* Units of the last place between value and truth. */
static double ulps(double value, long double truth) {
    if ((long double)value == truth || (isnan(value) && isnan(truth))) return 0;
    double size = fabs((double)truth);
    if (size < DBL_MIN) size = DBL_MIN;
    return (double)(fabsl((long double)value - truth) / ((long double)size * 0x1p-53L)) / 2;
}

/* The greatest error over `count` random arguments of [low, high]. */
static double worst(Function *function, Truth *truth, double low, double high) {
    uint64_t seed = 1;
    double most = 0;
    for (int i = 0; i < 200000; i++) {
        double x = low + (high - low) * uniform(&seed);
        double error = ulps(function(x), truth(x));
        if (error > most) most = error;
    }
    return most;
}

TEST(exponentials) {
    assert_true(worst(exp_d, expl, -700, 709) < 1.01);
    assert_true(worst(exp_d, expl, -1, 1) < 1.01);
    assert_true(worst(expm1_d, expm1l, -0.5, 0.5) < 3.01);
    assert_true(worst(expm1_d, expm1l, -1e-9, 1e-9) < 1.01);
    assert_true(exp_d(0) == 1 && exp_d(-800) == 0 && isinf(exp_d(710)));
    assert_true(isnan(exp_d((double)NAN)));
    assert_true(fabs(exp_d(-744) - exp(-744)) < 1e-323);
}

TEST(logarithms) {
    assert_true(worst(log_d, logl, 1e-300, 1e300) < 1.01);
    assert_true(worst(log_d, logl, 0.5, 2) < 1.01);
    assert_true(worst(log_d, logl, 0.999, 1.001) < 1.01);
    assert_true(worst(log2_d, log2l, 0.001, 1000) < 2.01);
    assert_true(worst(log10_d, log10l, 0.001, 1000) < 2.01);
    assert_true(log2_d(8) == 3 && log2_d(0x1p-1000) == -1000 && log_d(1) == 0);
    assert_true(ulps(log_d(0x1p-1060), logl(0x1p-1060L)) < 1.01);
    assert_true(isinf(log_d(0)) && isnan(log_d(-1)) && isinf(log_d(INFINITY)));
}

TEST(powers) {
    uint64_t seed = 2;
    for (int i = 0; i < 200000; i++) {
        double x = exp_d(20 * uniform(&seed) - 10), y = 20 * uniform(&seed) - 10;
        long double truth = powl(x, y);
        assert_true(ulps(pow_d(x, y), truth) < 2 + (double)fabsl(logl(truth)));
    }
    assert_true(pow_d(3, 4) == 81 && pow_d(2, -3) == 0.125 && pow_d(-2, 3) == -8);
    assert_true(pow_d(0, 2.5) == 0 && pow_d(0, 0) == 1 && pow_d(-8, 101) < 0);
    assert_true(isnan(pow_d(-2, 0.5)) && exp2_d(10) == 1024 && exp2_d(-3) == 0.125);
    assert_true(worst(exp2_d, exp2l, -300, 300) < 1.51);
}

TEST(circular) {
    assert_true(worst(sin_d, sinl, -0.7, 0.7) < 1.01);
    assert_true(worst(cos_d, cosl, -0.7, 0.7) < 1.01);
    assert_true(worst(sin_d, sinl, -100, 100) < 1.5);
    assert_true(worst(cos_d, cosl, -1e5, 1e5) < 1.5);
    assert_true(worst(tan_d, tanl, -1.5, 1.5) < 3.01);
    assert_true(sin_d(0) == 0 && cos_d(0) == 1 && isnan(sin_d(INFINITY)));
    uint64_t seed = 3;
    for (int i = 0; i < 10000; i++) {
        double x = 1e9 * uniform(&seed);
        assert_true((double)fabsl(sin_d(x) - sinl(x)) < 2e-16 * x + 4e-16);
    }
}

TEST(arcs) {
    assert_true(worst(asin_d, asinl, -1, 1) < 2.51);
    assert_true(worst(acos_d, acosl, -1, 1) < 2.51);
    uint64_t seed = 4;
    for (int i = 0; i < 200000; i++) {
        double y = 2 * uniform(&seed) - 1, x = 2 * uniform(&seed) - 1;
        assert_true(ulps(atan2_d(y, x), atan2l(y, x)) < 2.01);
    }
    const double ends[] = {0.0, -0.0, 1, -1, INFINITY, -INFINITY, 1e-320, 1e308};
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 8; k++) {
            if (isinf(ends[i]) && isinf(ends[k])) continue;
            assert_true(ulps(atan2_d(ends[i], ends[k]), atan2l(ends[i], ends[k])) < 2.01);
        }
    assert_true(signbit(atan2_d(-0.0, 1)) && isnan(asin_d(1.5)) && isnan(acos_d(-1.1)));
}

TEST(tails) {
    assert_true(worst(erfc_d, erfcl, -5, 1) < 25);
    assert_true(worst(erfc_d, erfcl, 1, 26) < 3);
    assert_true(erfc_d(0) == 1 && erfc_d(30) == 0 && erfc_d(-30) == 2);
}

TEST_PROGRAM(NULL, NULL)
