/* SPDX-License-Identifier: Apache-2.0 */
/* mathf.h -- elementary functions whose bits depend on no library and no CPU.
 *
 * A frame must be the same on every machine; libm's sinf, expf ... are not (glibc versions
 * differ, and so do CPUs with and without FMA). Only +, -, *, / and sqrt are used here, which
 * IEEE 754 fixes. Errors stated are maxima over the range, measured by tests/unit/test_base.c.
 */
#pragma once
#include <math.h>
#include <stdint.h>
#include <string.h>

static inline float float_from_bits(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline uint32_t bits_from_float(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static inline float clampf(float value, float low, float high) {
    return value < low ? low : value > high ? high : value;
}

/* fminf and fmaxf, which are calls of a library, before which a hot function saves its vector
 * registers. Of a number and a NaN it is the number; of two equal ones (0 and -0) the second. */
static inline float min_f(float a, float b) {
    float least = a < b ? a : b;
    return b != b ? a : least;
}

static inline float max_f(float a, float b) {
    float most = a > b ? a : b;
    return b != b ? a : most;
}

static inline float lerpf(float a, float b, float t) {
    return a + (b - a) * t;
}

/* The two samples around a place from 0 to 1, and where between their middles. */
static inline int sample_place(float at, int count, int *next, float *t) {
    float x = clampf((at > 0 ? at : 0) * (float)count - 0.5f, 0, (float)(count - 1));
    int i = (int)x;
    *next = i + 1 < count ? i + 1 : i;
    *t = x - (float)i;
    return i;
}

static inline float safe_sqrtf(float value) {
    return value > 0 ? sqrtf(value) : 0.0f;
}

/* sin(2 pi t) and cos(2 pi t), |t| below 2^22, absolute error below 1e-7 (of |t| within 4; the
 * float t itself is coarser beyond). The quarter is taken off exactly, then Taylor series
 * (degree 9 and 8) on [-pi/4, pi/4] in double precision. */
static inline void sincos_turns(float t, float *sine, float *cosine) {
    double turns = (double)t - (double)(int)t;
    if (turns < 0) turns += 1;
    int quarter = (int)(turns * 4 + 0.5);
    double x = (turns - quarter * 0.25) * 6.283185307179586;
    double x2 = x * x;
    double s = x * (1 + x2 * (-1.0 / 6 + x2 * (1.0 / 120 + x2 * (-1.0 / 5040 + x2 / 362880))));
    double c = 1 + x2 * (-0.5 + x2 * (1.0 / 24 + x2 * (-1.0 / 720 + x2 / 40320)));
    switch (quarter & 3) {
    case 0:
        *sine = (float)s;
        *cosine = (float)c;
        break;
    case 1:
        *sine = (float)c;
        *cosine = (float)-s;
        break;
    case 2:
        *sine = (float)-s;
        *cosine = (float)-c;
        break;
    default:
        *sine = (float)-c;
        *cosine = (float)s;
        break;
    }
}

/* e^x, relative error below 2e-7 for x in [-87, 88]; 0 below, infinity above, NaN of NaN. */
static inline float exp_f(float x) {
    if (x < -87.3f) return 0.0f;
    if (x > 88.7f) return INFINITY;
    if (x != x) return x;
    int n = (int)((double)x * 1.4426950408889634 + 128.5) - 128;
    double r = (double)x - n * 0.6931471805599453;
    double p =
        1 +
        r * (1 + r * (1.0 / 2 + r * (1.0 / 6 + r * (1.0 / 24 + r * (1.0 / 120 +
                                                                    r * (1.0 / 720 + r / 5040))))));
    union {
        uint64_t bits;
        double value;
    } scale = {(uint64_t)(n + 1023) << 52};
    return (float)(p * scale.value);
}

/* ln x for finite x > 0, error below 2e-7 * max(1, |ln x|); -infinity at 0 and below. */
static inline float log_f(float x) {
    if (!(x > 0)) return -INFINITY;
    union {
        double value;
        uint64_t bits;
    } u = {(double)x};
    int exponent = (int)(u.bits >> 52) - 1023;
    u.bits = (u.bits & 0xFFFFFFFFFFFFFull) | 0x3FF0000000000000ull;
    if (u.value > 1.4142135623730951) {
        u.value *= 0.5;
        exponent++;
    }
    double t = (u.value - 1) / (u.value + 1), t2 = t * t; /* atanh series, |t| < 0.172 */
    double s = t * (2 + t2 * (2.0 / 3 + t2 * (2.0 / 5 + t2 * (2.0 / 7 + t2 * (2.0 / 9)))));
    return (float)(s + exponent * 0.6931471805599453);
}

/* base^exponent, relative error below 3e-7 (1 + |exponent ln base|); 0 for base <= 0. */
static inline float pow_f(float base, float exponent) {
    return base > 0 ? exp_f(exponent * log_f(base)) : 0.0f;
}

/* atan2(y, x) in [-pi, pi], absolute error below 1e-6; 0 when both are 0. */
static inline float atan2_f(float y, float x) {
    double ax = fabs((double)x), ay = fabs((double)y);
    double high = ax > ay ? ax : ay, low = ax > ay ? ay : ax;
    if (high == 0) return 0.0f;
    double t = low / high, base = 0;
    if (t > 0.4142135623730951) { /* atan t = pi/4 + atan((t-1)/(t+1)) */
        base = 0.7853981633974483;
        t = (t - 1) / (t + 1);
    }
    double t2 = t * t;
    double a =
        t *
        (1 + t2 * (-1.0 / 3 +
                   t2 * (1.0 / 5 +
                         t2 * (-1.0 / 7 + t2 * (1.0 / 9 + t2 * (-1.0 / 11 + t2 * (1.0 / 13)))))));
    double angle = base + a;
    if (ay > ax) angle = 1.5707963267948966 - angle;
    if (x < 0) angle = 3.141592653589793 - angle;
    return (float)(y < 0 ? -angle : angle);
}

/* acos x, x clamped to [-1, 1], absolute error below 1e-6. */
static inline float acos_f(float x) {
    double c = x < -1 ? -1.0 : x > 1 ? 1.0 : (double)x;
    return atan2_f((float)sqrt((1 - c) * (1 + c)), (float)c);
}
