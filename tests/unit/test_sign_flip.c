/* SPDX-License-Identifier: Apache-2.0 */
/* The sign-flip test: its tails and the corrections for many tests. */
#include "check.h"

#include "base/sampler.h"
#include "compare/statistic/sign_flip.h"

static double unit(uint32_t *state) {
    *state = hash_u32(*state + 0x9e3779b9u);
    return ((double)*state + 0.5) * 0x1p-32;
}

/* Every one of the 2^12 signs of a sum: as many of them as p says, or fewer, reach as far. */
TEST(the_tail_of_random_signs_is_never_heavier_than_stated) {
    enum { TERMS = 12, SIGNS = 1 << TERMS };
    static double quotient[SIGNS], p[SIGNS];
    uint32_t random = 5;
    const NoiseLaw law = {.is_same = true};
    for (int shape = 0; shape < 12; shape++) {
        double size[TERMS], squares = 0;
        for (int i = 0; i < TERMS; i++)
            size[i] = shape == 0 ? 1 : pow(unit(&random), shape % 4) * (i < shape ? 5 : 1);
        for (int signs = 0; signs < SIGNS; signs++) {
            SignFlipSum sum = {0};
            for (int i = 0; i < TERMS; i++) {
                NoisyNumber n = {.difference = signs >> i & 1 ? size[i] : -size[i]};
                sign_flip_add(&sum, &n, 1);
            }
            quotient[signs] = sign_flip_quotient(&sum, law);
            p[signs] = sign_flip_p(&sum, law);
            squares += quotient[signs] * quotient[signs] / SIGNS;
        }
        assert_close(squares, 1, 1e-9);
        for (int k = 0; k < SIGNS; k += 61) {
            double reached = 0;
            for (int signs = 0; signs < SIGNS; signs++)
                reached += quotient[signs] > quotient[k] - 1e-9;
            assert_true(reached / SIGNS <= p[k] * (1 + 1e-3));
        }
    }
}

TEST(the_square_of_random_signs_has_the_stated_variance) {
    static const double SIZE[4] = {1, 2, 2, 5};
    double fourth = 0;
    const NoiseLaw law = {.is_same = true};
    SignFlipSum sum = {0};
    for (int signs = 0; signs < 16; signs++) {
        sum = (SignFlipSum){0};
        for (int i = 0; i < 4; i++) {
            NoisyNumber n = {.difference = signs >> i & 1 ? SIZE[i] : -SIZE[i]};
            sign_flip_add(&sum, &n, 1);
        }
        fourth += pow(sign_flip_quotient(&sum, law), 4) / 16;
    }
    assert_close(sign_flip_square_variance(&sum), fourth - 1, 1e-9);
}

TEST(tails_have_their_closed_forms) {
    assert_close(2 * normal_tail(1.959964), 0.05, 1e-6);
    assert_close(normal_tail(6), 9.865876e-10, 1e-6);
    /* chi square of 2 is exponential: exp(-x / 2); of 100, the table's 5 % and 0.1 % */
    assert_close(gamma_tail(9.21034, 2, 4), 0.01, 0.1);
    assert_close(gamma_tail(124.342, 100, 200), 0.05, 0.01);
    assert_close(gamma_tail(149.449, 100, 200), 0.001, 0.02);
    assert_near(gamma_tail(90, 100, 200), 1, 0);
    assert_close(sidak_p(0.01, 3), 1 - pow(0.99, 3), 1e-12);
    assert_close(sidak_p(1e-12, 1000), 1e-9, 1e-6);
    assert_near(sidak_p(1, 7), 1, 0);
    assert_close(sidak_p(sidak_level(0.01, 5000), 5000), 0.01, 1e-9);
}

TEST_PROGRAM(NULL, NULL)
