/* SPDX-License-Identifier: Apache-2.0 */
#include "base/mathd.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define PI 3.141592653589793238

static uint64_t bits_from_double(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static double double_from_bits(uint64_t bits) {
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* 2^k for -1022 <= k <= 1023. */
static double power_of_two(int k) {
    return double_from_bits((uint64_t)(k + 1023) << 52);
}

/* ---- exponential and logarithm ---------------------------------------------------------- */

/* ln 2 in two parts; the first has 33 bits, so that up to 2^20 times it is exact. */
static const double LN2_HIGH = 0x1.62e42fee00000p-1, LN2_LOW = 0x1.a39ef35793c76p-33;

/* 2^(i/32). */
static const double POWERS[32] = {
    0x1.0000000000000p+0, 0x1.059b0d3158574p+0, 0x1.0b5586cf9890fp+0, 0x1.11301d0125b51p+0,
    0x1.172b83c7d517bp+0, 0x1.1d4873168b9aap+0, 0x1.2387a6e756238p+0, 0x1.29e9df51fdee1p+0,
    0x1.306fe0a31b715p+0, 0x1.371a7373aa9cbp+0, 0x1.3dea64c123422p+0, 0x1.44e086061892dp+0,
    0x1.4bfdad5362a27p+0, 0x1.5342b569d4f82p+0, 0x1.5ab07dd485429p+0, 0x1.6247eb03a5585p+0,
    0x1.6a09e667f3bcdp+0, 0x1.71f75e8ec5f74p+0, 0x1.7a11473eb0187p+0, 0x1.82589994cce13p+0,
    0x1.8ace5422aa0dbp+0, 0x1.93737b0cdc5e5p+0, 0x1.9c49182a3f090p+0, 0x1.a5503b23e255dp+0,
    0x1.ae89f995ad3adp+0, 0x1.b7f76f2fb5e47p+0, 0x1.c199bdd85529cp+0, 0x1.cb720dcef9069p+0,
    0x1.d5818dcfba487p+0, 0x1.dfc97337b9b5fp+0, 0x1.ea4afa2a490dap+0, 0x1.f50765b6e4540p+0};

/* exp(r) - 1: Taylor's series; the term left out is below 2e-17 r for |r| of 0.011 .. */
static double exp_series_short(double r) {
    return r + r * r * (0.5 + r * (1.0 / 6 + r * (1.0 / 24 + r * (1.0 / 120 + r / 720))));
}

/* .. and for |r| of 0.35. */
static double exp_series(double r) {
    static const double factors[] = {
        1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040,
        1.0 / 720,       1.0 / 120,      1.0 / 24,      1.0 / 6,      0.5};
    double sum = 1.0 / 6227020800; /* 1 / 13! */
    for (int i = 0; i < 11; i++) sum = sum * r + factors[i];
    return r + r * r * sum;
}

/* x = (32 k + i) ln 2 / 32 + r; exp(x) = 2^k 2^(i/32) exp(r), the power in two steps so that
 * subnormal results round once. */
double exp_d(double x) {
    if (!(x > -745.2)) return x != x ? x : 0;
    if (x > 709.782712893384) return INFINITY;
    double n = floor(x * 46.166241308446828384 + 0.5);
    double r = (x - n * (LN2_HIGH / 32)) - n * (LN2_LOW / 32);
    int whole = (int)n, k = (whole - (whole & 31)) / 32;
    double power = POWERS[whole & 31], value = power + power * exp_series_short(r);
    return value * power_of_two(k / 2) * power_of_two(k - k / 2);
}

double expm1_d(double x) {
    return fabs(x) < 0.34 ? exp_series(x) : exp_d(x) - 1;
}

/* log(1 + f) for 1 + f in [sqrt 1/2, sqrt 2]: with s = f / (2 + f) it is
 * 2 s (1 + s^2/3 + s^4/5 ...), and 2 s = f - s f keeps the leading term exact. */
static double log_series(double f) {
    static const double factors[] = {2.0 / 23, 2.0 / 21, 2.0 / 19, 2.0 / 17, 2.0 / 15, 2.0 / 13,
                                     2.0 / 11, 2.0 / 9,  2.0 / 7,  2.0 / 5,  2.0 / 3};
    double s = f / (2 + f), z = s * s, sum = 0;
    for (int i = 0; i < 11; i++) sum = (sum + factors[i]) * z;
    return f - s * (f - sum);
}

/* x = 2^k m with m in [sqrt 1/2, sqrt 2). x is positive and finite. */
static double split(double x, int *k) {
    int power = 0;
    if (x < 0x1p-1022) {
        x *= 0x1p54;
        power = -54;
    }
    uint64_t bits = bits_from_double(x);
    power += (int)(bits >> 52) - 1023;
    double m = double_from_bits((bits & 0xfffffffffffffu) | 0x3ff0000000000000u);
    if (m >= 1.4142135623730951) {
        m *= 0.5;
        power++;
    }
    *k = power;
    return m;
}

double log_d(double x) {
    if (!(x > 0)) return x == 0 ? -INFINITY : (double)NAN;
    if (x > 0x1.fffffffffffffp1023) return x;
    int k;
    double m = split(x, &k);
    return k * LN2_HIGH + (k * LN2_LOW + log_series(m - 1));
}

double log2_d(double x) {
    if (!(x > 0) || x > 0x1.fffffffffffffp1023) return log_d(x);
    int k;
    double m = split(x, &k);
    return k + log_series(m - 1) * 1.4426950408889634074;
}

double log10_d(double x) {
    return log_d(x) * 0.43429448190325182765;
}

/* x^n by squaring. */
static double whole_power(double x, int n) {
    double result = 1;
    for (unsigned left = (unsigned)(n < 0 ? -n : n); left; left >>= 1) {
        if (left & 1) result *= x;
        x *= x;
    }
    return n < 0 ? 1 / result : result;
}

double pow_d(double x, double y) {
    bool is_whole = floor(y) == y;
    if (is_whole && fabs(y) <= 64) return whole_power(x, (int)y);
    if (x == 0) return y > 0 ? 0 : INFINITY;
    if (x > 0) return exp_d(y * log_d(x));
    if (!is_whole) return (double)NAN;
    double size = exp_d(y * log_d(-x));
    return floor(y * 0.5) * 2 == y ? size : -size;
}

double exp2_d(double x) {
    double whole = floor(x + 0.5);
    if (!(fabs(x) < 1000)) return pow_d(2, x);
    return exp_d((x - whole) * 0.69314718055994530942) * power_of_two((int)whole);
}

/* ---- circle ------------------------------------------------------------------------------ */

/* On [-pi/4, pi/4]; the terms left out are below 5e-17 and 3e-18. */
static double sin_series(double x) {
    double z = x * x, sum = -1.0 / 1307674368000; /* 1 / 15! */
    static const double factors[] = {1.0 / 6227020800, -1.0 / 39916800, 1.0 / 362880,
                                     -1.0 / 5040,      1.0 / 120,       -1.0 / 6};
    sum += z / 355687428096000.0; /* 1 / 17! */
    for (int i = 0; i < 6; i++) sum = sum * z + factors[i];
    return x + x * (z * sum);
}

static double cos_series(double x) {
    double z = x * x, sum = 1.0 / 20922789888000; /* 1 / 16! */
    static const double factors[] = {-1.0 / 87178291200, 1.0 / 479001600, -1.0 / 3628800,
                                     1.0 / 40320,        -1.0 / 720,      1.0 / 24};
    for (int i = 0; i < 6; i++) sum = sum * z + factors[i];
    return 1 + (z * z * sum - 0.5 * z);
}

/* x less whole quarters of a turn; pi / 2 in three parts, the first two of 33 bits: exact
 * products for up to 2^20 quarters. */
static double reduce(double x, int *quarter) {
    double k = floor(x * 0.63661977236758134308 + 0.5);
    if (!(fabs(k) < 1e15)) {
        *quarter = 0;
        return (double)NAN;
    }
    *quarter = (int)(k - 4 * floor(k / 4));
    return ((x - k * 0x1.921fb54400000p+0) - k * 0x1.0b4611a600000p-34) - k * 0x1.3198a2e037073p-69;
}

static double quarter_value(double r, int quarter) {
    double value = quarter & 1 ? cos_series(r) : sin_series(r);
    return quarter & 2 ? -value : value;
}

double sin_d(double x) {
    int quarter;
    double r = reduce(x, &quarter);
    return quarter_value(r, quarter);
}

double cos_d(double x) {
    int quarter;
    double r = reduce(x, &quarter);
    return quarter_value(r, quarter + 1);
}

double tan_d(double x) {
    int quarter;
    double r = reduce(x, &quarter);
    return quarter_value(r, quarter) / quarter_value(r, quarter + 1);
}

/* On [0, 1]: atan(x) = atan(c) + atan((x - c) / (1 + x c)) with c the nearest eighth, so that
 * the series' argument is at most 1/16. */
static double atan_of_fraction(double x) {
    static const double eighths[] = {0,
                                     0.12435499454676143503,
                                     0.24497866312686415417,
                                     0.35877067027057222039,
                                     0.46364760900080611621,
                                     0.55859931534356243597,
                                     0.64350110879328438680,
                                     0.71882999962162450542,
                                     0.78539816339744830962};
    int i = (int)(x * 8 + 0.5);
    static const double factors[] = {1.0 / 13, -1.0 / 11, 1.0 / 9, -1.0 / 7, 1.0 / 5, -1.0 / 3};
    double c = i * 0.125, t = (x - c) / (1 + x * c), z = t * t, sum = 0;
    for (int k = 0; k < 6; k++) sum = (sum + factors[k]) * z;
    return eighths[i] + (t + t * sum);
}

double atan2_d(double y, double x) {
    double ax = fabs(x), ay = fabs(y);
    if (x != x || y != y) return (double)NAN;
    double angle = ax == 0 && ay == 0 ? 0
                   : ay <= ax         ? atan_of_fraction(ax > 1e308 && ay > 1e308 ? 1 : ay / ax)
                              : PI / 2 - (atan_of_fraction(ax / ay) - 6.123233995736766e-17);
    if (signbit(x)) angle = PI - (angle - 1.2246467991473532e-16);
    return signbit(y) ? -angle : angle;
}

double asin_d(double x) {
    return fabs(x) <= 1 ? atan2_d(x, sqrt((1 - x) * (1 + x))) : (double)NAN;
}

double acos_d(double x) {
    return fabs(x) <= 1 ? atan2_d(sqrt((1 - x) * (1 + x)), x) : (double)NAN;
}

double hypot_d(double x, double y) {
    return sqrt(x * x + y * y);
}

/* ---- the normal distribution's tail ------------------------------------------------------ */

/* exp(-x^2): the square's rounding error would count x^2-fold. */
static double exp_of_minus_square(double x) {
    double high = double_from_bits(bits_from_double(x) & ~0x7ffffffull);
    return exp_d(-high * high) * exp_d(-(x - high) * (x + high));
}

/* erf(x) = 2 / sqrt(pi) exp(-x^2) sum of 2^n x^(2n+1) / (2n+1)!! (Abramowitz and Stegun
 * 7.1.6): no term is negative. x in [0, 1]. */
static double erf_series(double x) {
    double term = x, sum = x;
    for (int n = 1; n < 24; n++) sum += term *= 2 * x * x / (2 * n + 1);
    return 1.1283791670955125739 * exp_of_minus_square(x) * sum;
}

/* The continued fraction 1 / (x + (1/2) / (x + 1 / (x + (3/2) / (x + ...)))) (Abramowitz and
 * Stegun 7.1.14), from its end. The terms needed fall with the square of x; sixteen more change
 * nothing but, for one x in thousands, the last bit. x > 1. */
static double erfc_fraction(double x) {
    double value = x;
    for (int n = (int)(240 / (x * x)) + 16; n >= 1; n--) value = x + 0.5 * n / value;
    return exp_of_minus_square(x) / (value * 1.7724538509055160273);
}

double erfc_d(double x) {
    if (x != x) return x;
    if (x < 0) return x < -6 ? 2 : 2 - erfc_d(-x);
    return x <= 1 ? 1 - erf_series(x) : x > 27.3 ? 0 : erfc_fraction(x);
}
