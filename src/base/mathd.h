/* SPDX-License-Identifier: Apache-2.0 */
/* mathd.h -- elementary functions in double precision whose bits depend on no library and no
 * CPU: what mathf.h is for floats, for tables that are made before the first ray.
 *
 * The C library's exp, log, sin ... differ between its versions, and on one version between
 * CPUs with and without FMA. These use only +, -, *, /, sqrt, floor and exact scaling, which
 * IEEE 754 fixes. Errors stated are the greatest found by tests/unit/test_mathd.c, in units of
 * 2.2e-16 of the value (ulp).
 *
 * Units    angles in radians.
 * Threads  pure functions.
 * Not for the hot loop: that has mathf.h.
 */
#pragma once

/* 1 ulp. Below -745.2: 0; above 709.7827: infinity. */
double exp_d(double x);

/* exp(x) - 1 without cancellation: 3 ulp. */
double expm1_d(double x);

/* 1 ulp. Of 0: -infinity; of a negative number: NaN. */
double log_d(double x);
double log2_d(double x);  /* 2 ulp; exact for powers of two */
double log10_d(double x); /* 2 ulp */

/* x^y by y log x: (2 + |y log x|) ulp. Whole y up to 64 by products. A negative x needs a
 * whole y; 0 to a positive power is 0. */
double pow_d(double x, double y);

/* 2^x, as pow_d. */
double exp2_d(double x);

/* 1.5 ulp up to |x| = 1e5, absolute error 2e-16 |x| beyond 1e6. */
double sin_d(double x);
double cos_d(double x);
double tan_d(double x); /* 3 ulp */

static inline float sin_of(float x) {
    return (float)sin_d((double)x);
}

static inline float cos_of(float x) {
    return (float)cos_d((double)x);
}

/* 2 ulp; the ranges are the C library's, atan2(0, 0) = 0 included. */
double atan2_d(double y, double x);
double asin_d(double x); /* of |x| > 1: NaN */
double acos_d(double x);

/* 1 - erf(x), within 5e-15 of the value for x up to 26, 0 above 27.3: the upper tail of a
 * normal distribution is erfc_d(z / sqrt 2) / 2. */
double erfc_d(double x);

/* sqrt(x^2 + y^2), 2 ulp, where the squares neither overflow nor vanish. */
double hypot_d(double x, double y);
