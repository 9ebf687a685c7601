/* SPDX-License-Identifier: Apache-2.0 */
/* test_progress.c -- parts of long work count as their weights, and never run backwards. */
#include "fixture.h"

#include "base/progress.h"

static Progress shown(double total) {
    return progress_start(PROGRESS_JSON, "test", "steps", total);
}

TEST(a_part_counts_as_its_weight) {
    Progress all = shown(10);
    Progress first = progress_part(&all, 4, 8);
    progress_update(&first, 2);
    assert_near(all.done, 1, 1e-12);
    progress_update(&first, 6);
    assert_near(all.done, 3, 1e-12);
    progress_end(&first, 8);
    assert_near(all.done, 4, 1e-12);
    Progress second = progress_part(&all, 6, 3);
    Progress inner = progress_part(&second, 1, 2);
    progress_update(&inner, 1);
    assert_near(second.done, 0.5, 1e-12);
    assert_near(all.done, 5, 1e-12);
    progress_end(&inner, 2);
    assert_near(all.done, 6, 1e-12);
    progress_end(&second, 3);
    assert_near(all.done, 10, 1e-12);
}

/* Who finds more to do than was thought goes on more slowly, not back. */
TEST(a_part_that_grows_does_not_run_back) {
    Progress all = shown(10);
    Progress part = progress_part(&all, 10, 4);
    progress_update(&part, 3);
    assert_near(all.done, 7.5, 1e-12);
    part.total = 8;
    progress_update(&part, 4);
    assert_near(all.done, 7.5, 1e-12);
    progress_update(&part, 7);
    assert_near(all.done, 8.75, 1e-12);
    progress_update(&part, 99);
    assert_near(all.done, 10, 1e-12);
}

TEST_PROGRAM(NULL, NULL)
