/* SPDX-License-Identifier: Apache-2.0 */
/* What is left of a review is the work of each kind at the pace of that kind. */
#include "fixture.h"

#include "review/pace/work.h"

static Work planned(double cases, double frames)
{
    WorkPlan plan = {{[WORK_CASE] = cases, [WORK_FRAME] = frames}};
    return work_start(PROGRESS_NONE, &plan);
}

/* As if so much of a kind were done in so many seconds. */
static void pass(Work *work, WorkKind kind, double weight, double seconds)
{
    work->done.of[kind] += weight;
    work->timed.of[kind] += weight;
    work->seconds.of[kind] += seconds;
}

TEST(before_any_work_a_weight_is_a_second)
{
    Work work = planned(30, 70);
    assert_near(work_left_s(&work), 100, 1e-9);
}

/* A quick kind says little of a slow one, once both were met: here 1 s and 8 s a weight. */
TEST(each_kind_has_its_own_pace)
{
    Work work = planned(100, 50);
    pass(&work, WORK_CASE, 20, 20);
    assert_near(work_left_s(&work), 80 + 50, 1e-9); /* frames as all others */
    pass(&work, WORK_FRAME, 10, 80);
    double left = 80 * 1.0 + 40 * 8.0;
    assert_near(work_left_s(&work), left, 0.03 * left);
    pass(&work, WORK_CASE, 60, 60);
    left = 20 * 1.0 + 40 * 8.0;
    assert_near(work_left_s(&work), left, 0.03 * left);
}

/* The same on a machine that others use: a constant share of it is one factor. */
TEST(a_shared_machine_is_slower_in_all_kinds)
{
    for (double times = 1; times <= 20; times *= 1.5) {
        Work work = planned(100, 100);
        pass(&work, WORK_CASE, 20, 20 * times);
        double left = 180 * times;
        if (work_left_s(&work) < left / 2 || work_left_s(&work) > 2 * left)
            fail_msg("%g times as slow: %g s left of %g", times, work_left_s(&work), left);
    }
}

/* A second of work of a kind, of which so many more were waited for a processor. */
static void work_a_second(Work *work, WorkKind kind, double waited_s)
{
    work->mark_s -= 1 + waited_s;
    work->mark_waited_s -= waited_s;
    work_add(work, kind, 1);
}

static void assert_within(const Work *work, double left, double times)
{
    double told = work_left_s(work);
    if (told < left / times || told > left * times) fail_msg("%g s left of %g", told, left);
}

/* Others' load begins and ends: it is no kind's, and what is left goes by that of late. */
TEST(a_load_that_comes_and_goes_is_not_the_kinds)
{
    for (double waited = 0; waited <= 15; waited += 3) {
        Work work = planned(200, 100);
        for (int i = 0; i < 40; i++) work_a_second(&work, WORK_CASE, 0);
        assert_within(&work, 160 + 100, 1.05);
        for (int i = 0; i < 40; i++) work_a_second(&work, WORK_CASE, waited);
        assert_within(&work, (120 + 100) * (1 + waited), 1.5);
        for (int i = 0; i < 10; i++) work_a_second(&work, WORK_FRAME, waited);
        assert_within(&work, (120 + 90) * (1 + waited), 1.4);
        for (int i = 0; i < 80; i++) work_a_second(&work, WORK_FRAME, 0);
        assert_within(&work, 120 + 10, 1.6);
    }
}

TEST(what_is_planned_anew_is_left)
{
    Work     work = planned(10, 10);
    WorkPlan before = {{[WORK_CASE] = 10}}, now = {{[WORK_CASE] = 25, [WORK_LOOK] = 5}};
    work_replan(&work, &before, &now);
    assert_near(work_left_s(&work), 40, 1e-9);
    pass(&work, WORK_CASE, 30, 30); /* more than was planned: nothing is left of it */
    assert_near(work_left_s(&work), 15, 1e-9);
}

/* What was done before a restart counts as done, and for no pace. */
TEST(what_takes_no_time_tells_no_pace)
{
    Work work = planned(1000, 10);
    work_add(&work, WORK_CASE, 400);
    assert_near(work.done.of[WORK_CASE], 400, 0);
    assert_near(work_left_s(&work), 610, 1e-9);
}

TEST(what_is_shown_never_runs_back)
{
    double   last = 0;
    Work     work = planned(10, 10);
    WorkPlan none = {{0}}, more = {{[WORK_CASE] = 100}};
    for (int i = 0; i < 10; i++) {
        work.progress.begun_s -= 2; /* two seconds later */
        work.mark_s -= 2;
        if (i == 5) work_replan(&work, &none, &more);
        work_add(&work, WORK_CASE, 1);
        if (work.progress.done < last) fail_msg("step %d: back to %g", i, work.progress.done);
        last = work.progress.done;
    }
    assert_true(last > 0 && last < work.progress.total);
}

TEST_PROGRAM(NULL, NULL)
