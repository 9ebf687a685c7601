/* SPDX-License-Identifier: Apache-2.0 */
/* Shares of a frame's samples: none is taken twice or left out, however the frame is cut. */
#include "film_fixture.h"

#include "film/sample_shares.h"

enum { WIDTH = 7, HEIGHT = 5, SAMPLES = 3 * 64 + 5 };

static const FilmRect whole = {0, 0, WIDTH, HEIGHT};

TEST(a_pixel_takes_its_share_evenly) {
    for (uint32_t share = 1; share <= SAMPLE_SHARE_ALL; share++) {
        assert_int_equal(sample_shares_own(share, 0), 0);
        assert_int_equal(sample_shares_own(share, 1), 1);
        assert_int_equal(sample_shares_own(share, 5 * SAMPLE_SHARE_ALL), 5 * share);
        for (uint32_t n = 0; n < SAMPLES; n++) {
            uint32_t own = sample_shares_own(share, n), next = sample_shares_own(share, n + 1);
            double even = (double)n * share / SAMPLE_SHARE_ALL;
            assert_true(next == own || next == own + 1);
            assert_true((double)own >= even && (double)own < even + 1);
        }
    }
    assert_int_equal(sample_shares_own(SAMPLE_SHARE_ALL, FILM_SAMPLES_MAX), FILM_SAMPLES_MAX);
    assert_int_equal(sample_shares_own(8, FILM_SAMPLES_MAX), (FILM_SAMPLES_MAX + 7) / 8);
}

/* Samples of four parts of the pixels and three of the range, one by one and as sums. */
TEST(parts_add_up_to_the_whole) {
    const FilmRect parts[] = {
        {0, 0, 3, 2}, {3, 0, WIDTH, 2}, {0, 2, 6, HEIGHT}, {6, 2, WIDTH, HEIGHT}};
    const uint32_t ends[] = {0, 1, 100, SAMPLES};
    uint8_t of[WIDTH * HEIGHT];
    uint64_t sum = 0, one_by_one = 0, full = 0;
    SampleShares shares = {of, whole};
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        of[i] = i % 3 ? (uint8_t)(1 + 11 * i % 63) : (uint8_t)SAMPLE_SHARE_ALL;
        full += of[i] == SAMPLE_SHARE_ALL;
        one_by_one += sample_shares_own(sample_shares_at(&shares, i % WIDTH, i / WIDTH), SAMPLES);
    }
    for (int part = 0; part < 4; part++)
        for (int k = 0; k < 3; k++)
            sum += sample_shares_sum(&shares, parts[part], ends[k], ends[k + 1]);
    assert_int_equal(sum, one_by_one);
    assert_int_equal(sum, sample_shares_sum(&shares, whole, 0, SAMPLES));
    assert_int_equal(sample_shares_whole(&shares), full);
}

TEST(without_shares_all_pixels_take_all) {
    const SampleShares shares = {NULL, whole};
    assert_int_equal(sample_shares_at(&shares, 3, 4), SAMPLE_SHARE_ALL);
    assert_int_equal(sample_shares_whole(&shares), WIDTH * HEIGHT);
    assert_int_equal(sample_shares_sum(&shares, whole, 3, 10), 7 * WIDTH * HEIGHT);
}

TEST_PROGRAM(NULL, NULL)
