/* SPDX-License-Identifier: Apache-2.0 */
/* How often a watched render shows itself, and to whom. Packets: tests/hostile/live_view.py. */
#include "fixture.h"

#include <string.h>

#include "cli/render/render_live.h"

/* Updates that each take `cost`, at the end of passes of `pass` seconds: the time they took. */
static double spent_after(double share, double pass_s, double cost_s, int passes)
{
    TimeShare time = {.share = share, .begun_s = 100};
    double    now_s = time.begun_s;
    for (int i = 0; i < passes; i++) {
        now_s += pass_s;
        if (!time_share_allows(&time, now_s)) continue;
        time_share_begin(&time);
        time_share_spend(&time, 0.3 * cost_s); /* made, and sent */
        time_share_spend(&time, 0.7 * cost_s);
        now_s += cost_s;
    }
    return time.spent_s / (now_s - time.begun_s);
}

TEST(what_is_shown_takes_its_share_and_no_more)
{
    static const double costs[] = {1e-4, 1e-3, 0.01, 0.1, 1, 10};
    for (int i = 0; i < (int)(sizeof costs / sizeof *costs); i++) {
        double taken = spent_after(0.005, 0.3, costs[i], 1000000);
        assert_true(taken <= 0.005 && taken > 0);
        if (costs[i] > 0.01) assert_true(taken > 0.0049); /* passes are no limit */
    }
}

TEST(the_first_is_shown_at_once_and_dear_ones_are_waited_for)
{
    TimeShare time = {.share = 0.01, .begun_s = 50};
    assert_true(time_share_allows(&time, 50));
    time_share_begin(&time);
    time_share_spend(&time, 0.5);
    time_share_spend(&time, 1.5);
    time_share_begin(&time);
    time_share_spend(&time, 1);
    assert_false(time_share_allows(&time, 50 + 499.9)); /* 3 s are spent, the next may take 2 */
    assert_true(time_share_allows(&time, 50 + 500.1));
}

/* A file that was written so many seconds ago, all of whose writing took `spent` of an hour. */
static bool wants_file(double ago_s, double spent_s)
{
    double     now_s = monotonic_seconds();
    RenderLive live = {.has_file = true, .file_written_s = now_s - ago_s,
                       .file_time = {.share = 0.05, .begun_s = now_s - 3600,
                                     .spent_s = spent_s}};
    return render_live_wants_file(&live);
}

TEST(the_file_is_written_every_ten_seconds)
{
    RenderLive live = {.has_file = true};
    assert_true(render_live_wants_file(&live));
    assert_false(wants_file(5, 10));
    assert_true(wants_file(11, 10));
    assert_false(wants_file(11, 200));
    live.has_file = false;
    assert_false(render_live_wants_file(&live));
}

TEST(addresses_are_taken_apart)
{
    static const struct {
        const char *text, *host, *port;
    } cases[] = {{"localhost", "localhost", "14158"}, {"a-b.c_d:1", "a-b.c_d", "1"},
                 {"10.0.0.7:65535", "10.0.0.7", "65535"}, {"[::1]", "::1", "14158"},
                 {"[fe80::12:34]:00080", "fe80::12:34", "00080"},
                 {"[::ffff:10.0.0.7]:9", "::ffff:10.0.0.7", "9"}};
    for (int i = 0; i < (int)(sizeof cases / sizeof *cases); i++) {
        ViewerAddress address;
        assert_done(viewer_address_parse(cases[i].text, &address, &err));
        assert_string_equal(address.host, cases[i].host);
        assert_string_equal(address.port, cases[i].port);
    }
}

TEST_PROGRAM(NULL, NULL)
