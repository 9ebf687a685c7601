/* check.h -- what every unit test includes: cmocka with its prerequisites, and closeness. */
#pragma once
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

/* Relative; also fails on NaN. An expected zero needs assert_near. */
#define assert_close(actual, expected, relative)                                               \
    do {                                                                                       \
        double a_ = (double)(actual), e_ = (double)(expected), tol_ = fabs(e_) * (relative);   \
        if (!(fabs(a_ - e_) <= tol_))                                                          \
            fail_msg("%s = %.9g, expected %.9g within %.2g", #actual, a_, e_, tol_);           \
    } while (0)

/* Absolute; also fails on NaN. */
#define assert_near(actual, expected, absolute)                                                \
    do {                                                                                       \
        double a_ = (double)(actual), e_ = (double)(expected);                                 \
        if (!(fabs(a_ - e_) <= (absolute)))                                                    \
            fail_msg("%s = %.9g, expected %.9g within %.2g", #actual, a_, e_,                  \
                     (double)(absolute));                                                      \
    } while (0)
