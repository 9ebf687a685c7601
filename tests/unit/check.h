/* SPDX-License-Identifier: Apache-2.0 */
/* check.h -- what every unit test includes: cmocka with its prerequisites, the list of a
 * program's cases, and closeness.
 *
 * TEST(name) { ... } is a case that gets `void **state`, which it need not use;
 * TEST_ON(name, set_up, tear_down, parameter, argument) one that gets what it stands on as a
 * parameter of its type, made of the state by `argument`, an expression;
 * TEST_PROGRAM(set_up, tear_down) is the main that runs all of a file's in their order, by
 * run_cases.
 */
#pragma once
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { TEST_CASES_MAX = 128 };

typedef struct TestCases {
    struct CMUnitTest test[TEST_CASES_MAX];
    int line[TEST_CASES_MAX], count;
} TestCases;

static inline TestCases *test_cases(void) {
    static TestCases cases;
    return &cases;
}

/* Keeps the cases in the order of their lines, which a linker need not keep. */
static inline void test_add(struct CMUnitTest test, int line) {
    TestCases *cases = test_cases();
    int at = cases->count++;
    if (at == TEST_CASES_MAX) abort();
    for (; at > 0 && cases->line[at - 1] > line; at--) {
        cases->test[at] = cases->test[at - 1];
        cases->line[at] = cases->line[at - 1];
    }
    cases->test[at] = test;
    cases->line[at] = line;
}

#define TEST_WITH(name, set_up, tear_down) \
    static void name(void **state); \
    __attribute__((constructor)) static void name##_is_a_case(void) { \
        test_add((struct CMUnitTest){#name, name, set_up, tear_down, NULL}, __LINE__); \
    } \
    static void name(__attribute__((unused)) void **state)

#define TEST(name) TEST_WITH(name, NULL, NULL)

#define TEST_ON(name, set_up, tear_down, parameter, argument) \
    static void name##_holds(__attribute__((unused)) parameter); \
    TEST_WITH(name, set_up, tear_down) { \
        name##_holds(argument); \
    } \
    static void name##_holds(__attribute__((unused)) parameter)

static inline int run_cases(CMFixtureFunction set_up, CMFixtureFunction tear_down) {
    TestCases *cases = test_cases();
    return _cmocka_run_group_tests("tests", cases->test, (size_t)cases->count, set_up, tear_down);
}

#define TEST_PROGRAM(set_up, tear_down) \
    int main(void) { \
        return run_cases(set_up, tear_down); \
    }

/* PARHELION_LAWS=all in the environment, as tests/long.sh has it: a law is held everywhere; by
 * day at fewer places, or over fewer samples, which still find a fault worth the name. */
static inline bool all_laws(void) {
    const char *asked = getenv("PARHELION_LAWS");
    return asked && !strcmp(asked, "all");
}

/* Relative; also fails on NaN. An expected zero needs assert_near. */
#define assert_close(actual, expected, relative) \
    do { \
        double a_ = (double)(actual), e_ = (double)(expected), tol_ = fabs(e_) * (relative); \
        if (!(fabs(a_ - e_) <= tol_)) \
            fail_msg("%s = %.9g, expected %.9g within %.2g", #actual, a_, e_, tol_); \
    } while (0)

/* Absolute; also fails on NaN. */
#define assert_near(actual, expected, absolute) \
    do { \
        double a_ = (double)(actual), e_ = (double)(expected); \
        if (!(fabs(a_ - e_) <= (absolute))) \
            fail_msg("%s = %.9g, expected %.9g within %.2g", #actual, a_, e_, (double)(absolute)); \
    } while (0)

#define assert_in(value, low, high) \
    do { \
        double v_ = (double)(value), l_ = (double)(low), h_ = (double)(high); \
        if (!(v_ >= l_ && v_ <= h_)) \
            fail_msg("%s = %.9g, expected %.9g to %.9g", #value, v_, l_, h_); \
    } while (0)

/* `ENDS_BY(world_end) World world = ...` calls world_end(&world) where its block ends; a case
 * that fails leaves it at that. */
#define ENDS_BY(end) __attribute__((cleanup(end)))
