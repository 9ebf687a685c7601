/* SPDX-License-Identifier: Apache-2.0 */
/* How often a watched render writes its file. The file itself: tests/hostile/live_view.py. */
#include "fixture.h"

#include "cli/render/render_live.h"

/* A file that was written so many seconds ago, all of whose writing took `spent` of an hour,
 * and the longest of it `longest`. */
static bool is_due(double ago_s, double spent_s, double longest_s) {
    double now_s = monotonic_seconds();
    RenderLive live = {.path = "live.exr",
                       .written_s = now_s - ago_s,
                       .begun_s = now_s - 3600,
                       .spent_s = spent_s,
                       .longest_s = longest_s};
    return render_live_is_due(&live);
}

TEST(the_file_is_written_every_ten_seconds) {
    RenderLive live = {.path = "live.exr"};
    assert_true(render_live_is_due(&live));
    assert_false(is_due(5, 10, 1));
    assert_true(is_due(11, 10, 1));
    assert_false(is_due(11, 200, 1));
    live.path = NULL;
    assert_false(render_live_is_due(&live));
}

TEST(the_next_may_take_as_long_as_the_longest) {
    assert_true(is_due(11, 100, 79));
    assert_false(is_due(11, 100, 81));
}

TEST_PROGRAM(NULL, NULL)
