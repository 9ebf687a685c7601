/* SPDX-License-Identifier: Apache-2.0 */
/* Figures as people read them: with their interval, and no more digits than that allows. */
#include "fixture.h"

#include "text/effect_text.h"
#include "text/interval_text.h"

static void assert_says(double value, double low, double high, const char *wanted) {
    assert_string_equal(interval_text(value, low, high, test_memory()), wanted);
}

TEST(digits_end_where_the_interval_does) {
    assert_says(417.486, 392.3, 442.7, "417 +- 25");
    assert_says(441.2, 436, 446.4, "441 +- 5");
    assert_says(2.9501, 2.91, 3.024, "2.95 (2.91 to 3.02)");
    assert_says(12345, 10345, 14345, "12300 +- 2000");
    assert_says(0.00123, 0.00093, 0.00153, "0.0012 +- 0.0003");
    assert_says(2, 2, 2, "2");
    assert_says(3, 2.5, (double)INFINITY, "at least 2.5");
    assert_says((double)NAN, 1, 2, "unknown");
    assert_says(0.01, -0.5, 0.52, "0.0 +- 0.5");
}

/* What is read is what was written, within half of the last digit, over many sizes. */
TEST(what_is_read_is_what_was_written) {
    for (int i = 0; i < 2000; i++) {
        double size = pow(10, i % 17 - 8), value = size * (1 + i / 7.0);
        double half = value * pow(10, -(i % 5) - 0.3 * (i % 3)), read, around;
        const char *text = interval_text(value, value - half, value + half, test_memory());
        char *end;
        read = strtod(text, &end);
        assert_memory_equal(end, " +- ", 4);
        around = strtod(end + 4, &end);
        assert_true(*end == 0);
        if (!(fabs(around - half) <= 0.17 * half && fabs(read - value) <= 0.17 * half))
            fail_msg("%g +- %g reads %s", value, half, text);
        assert_null(strchr(text, 'e'));
    }
}

/* An effect and its error end at one place, and neither says more than is known. */
TEST(an_effect_has_the_digits_of_its_error) {
    static const struct {
        double share, half, least;
        const char *words;
    } ROWS[] = {{0.20834, 0.0053, 0.001, "+20.8 ± 0.5 %"},
                {-0.587, 0.021, 0.001, "−58.7 ± 2.1 %"},
                {0.1419, 1.1e-6, 0.001, "+14.2 ± less than 0.1 %"},
                {1.2345, 0.123, 0.001, "+123 ± 12 %"},
                {12, 1.5, 0.001, "+1200 ± 150 %"},
                {0.004, 0.005, 0.001, "none above 0.9 %"},
                {-0.3, 0.9, 0.001, "none above 120 %"},
                {0.0001, 0.0001, 0.001, EFFECT_NONE},
                {0.5734, 0.00053, 0.01, "+57 ± less than 1 %"},
                {NAN, NAN, 0.001, "–"}};
    for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
        MeanInterval range = {ROWS[i].share - ROWS[i].half, ROWS[i].share + ROWS[i].half};
        assert_string_equal(effect_text(ROWS[i].share, range, ROWS[i].least, test_memory()),
                            ROWS[i].words);
    }
}

TEST_PROGRAM(make_arena, drop_arena)
