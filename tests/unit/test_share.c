/* SPDX-License-Identifier: Apache-2.0 */
/* Every question of a review is one part's, whatever their number. */
#include "check.h"

#include "review/run/job.h"

static int owners_of(int parts, int place, int moments, int at, int count)
{
    int owners = 0;
    for (int i = 0; i < parts; i++) {
        MomentShare share = {{i, parts}, place, moments};
        if (!moment_share_has(&share, at, count)) continue;
        assert_true(moment_share_has_any(&share));
        owners++;
    }
    return owners;
}

TEST(each_question_of_a_moment_is_of_one_part)
{
    for (int parts = 1; parts <= 13; parts++)
        for (int moments = 1; moments <= 7; moments++)
            for (int place = 0; place < moments; place++)
                for (int count = 1; count <= 11; count += 2)
                    for (int at = 0; at < count; at++)
                        assert_int_equal(owners_of(parts, place, moments, at, count), 1);
}

/* Questions of moments of one size differ by one at most. */
TEST(parts_of_moments_are_of_one_size)
{
    enum { MOMENTS = 5, COUNT = 12, PARTS = 7 };
    int least = MOMENTS * COUNT, most = 0;
    for (int i = 0; i < PARTS; i++) {
        int has = 0;
        for (int k = 0; k < MOMENTS * COUNT; k++) {
            MomentShare share = {{i, PARTS}, k / COUNT, MOMENTS};
            has += moment_share_has(&share, k % COUNT, COUNT);
        }
        if (has < least) least = has;
        if (has > most) most = has;
    }
    assert_true(most - least <= 1);
}

/* Few moments are opened: those in which a part has something, and at most one beyond. */
TEST(a_part_opens_few_moments)
{
    enum { MOMENTS = 40, PARTS = 10 };
    for (int i = 0; i < PARTS; i++) {
        int opened = 0;
        for (int place = 0; place < MOMENTS; place++)
            opened += moment_share_has_any(&(MomentShare){{i, PARTS}, place, MOMENTS});
        assert_int_equal(opened, MOMENTS / PARTS);
    }
}

TEST(each_sight_of_a_sweep_is_of_one_part_and_all_are_of_who_shares_nothing)
{
    for (int parts = 1; parts <= 9; parts++)
        for (int at = 0; at < 20; at++) {
            int owners = 0;
            for (int i = 0; i < parts; i++)
                owners += review_share_has(&(ReviewShare){i, parts}, at);
            assert_int_equal(owners, 1);
        }
    assert_true(review_share_has(&(ReviewShare){0, 0}, 17));
    assert_true(moment_share_has(&(MomentShare){{0, 0}, 3, 9}, 4, 5));
    assert_true(moment_share_has_any(&(MomentShare){{0, 0}, 3, 9}));
}

TEST_PROGRAM(NULL, NULL)
