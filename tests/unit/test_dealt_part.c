/* SPDX-License-Identifier: Apache-2.0 */
/* Parts that samples are dealt to: they meet, none is empty, none is larger than another by more
 * than one; and which of them are missing, or there twice. */
#include "fixture.h"

#include "base/count.h"
#include "cli/render/dealt_part.h"

TEST(parts_meet_and_are_of_one_size) {
    static const uint32_t counts[] = {1, 2, 3, 7, 100, 1023, 1024};
    enum { SAMPLES = 1024 };
    for (int k = 0; k < COUNT_OF(counts); k++) {
        uint32_t count = counts[k], at = 0;
        for (uint32_t i = 1; i <= count; i++) {
            uint32_t first = 99, end = SAMPLES;
            assert_done(dealt_part_samples((DealtPart){i, count}, &first, &end, &err));
            assert_int_equal(first, at);
            assert_in_range(end - first, SAMPLES / count, SAMPLES / count + 1);
            at = end;
        }
        assert_int_equal(at, SAMPLES);
    }
}

TEST(as_many_samples_as_there_are_numbers_are_dealt_without_loss) {
    uint32_t at = 0;
    for (uint32_t i = 1; i <= DEALT_PARTS_MAX; i++) {
        uint32_t first = 0, end = UINT32_MAX;
        assert_done(dealt_part_samples((DealtPart){i, DEALT_PARTS_MAX}, &first, &end, &err));
        assert_int_equal(first, at);
        at = end;
    }
    assert_int_equal(at, UINT32_MAX);
}

TEST(fewer_samples_than_parts_are_refused) {
    uint32_t first = 0, end = 7;
    assert_fails(dealt_part_samples((DealtPart){1, 8}, &first, &end, &err),
                 "--part 1/8: there are only 7 samples a pixel to deal");
    assert_int_equal(end, 7);
}

TEST(a_part_is_read_as_it_is_typed) {
    static const char *const bad[] = {
        "",     "1",        "/",    "1/",
        "/1",   "0/3",      "4/3",  "1/3/3",
        "-1/3", "+1/3",     " 1/3", "1 /3",
        "1/3 ", "1/100001", "a/3",  "99999999999999999999/99999999999999999999",
        "0x1/3"};
    DealtPart part = {0, 0};
    assert_true(dealt_part_parse("3/12", &part) && part.number == 3 && part.count == 12);
    assert_true(dealt_part_parse("100000/100000", &part));
    for (int i = 0; i < COUNT_OF(bad); i++)
        if (dealt_part_parse(bad[i], &part)) fail_msg("'%s' is taken", bad[i]);
}

/* Of files a.exr, b.exr ... : parts as typed, in one window each; "" is not dealt. */
static bool check(const char *const *dealt, const int *windows, Arena scratch, Error *err) {
    static const char *const names[] = {"a.exr", "b.exr", "c.exr", "d.exr", "e.exr", "f.exr"};
    DealtPart parts[6] = {{0, 0}};
    FilmPart files[6];
    int count = 0;
    for (; count < 6 && dealt[count]; count++) {
        int x = windows[count];
        files[count] = (FilmPart){.name = names[count], .crop = {x, 0, x + 1, 1}};
        if (*dealt[count]) assert_true(dealt_part_parse(dealt[count], &parts[count]));
    }
    return dealt_parts_check(parts, files, count, scratch, err);
}

ARENA_TEST(what_is_missing_or_doubled_is_named) {
    static const struct {
        const char *dealt[7]; /* until NULL */
        int windows[6];
        const char *message; /* NULL: all is there */
    } cases[] = {
        {{"2/3", "1/3", "3/3"}, {0}, NULL},
        {{"", ""}, {0}, NULL},
        {{"1/1", ""}, {0}, NULL},
        {{"1/2", "2/2", "2/2", "1/2"}, {0, 0, 5, 5}, NULL},
        {{"1/2", "1/3", "3/3", "2/2", "2/3"}, {0}, NULL},
        {{"1/3", "3/3"},
         {0},
         "part 2 of 3 is missing — the command that made the others makes "
         "it with --part 2/3"},
        {{"1/2", "2/2"}, {0, 1}, "part 2 of 2 is missing"},
        {{"2/12", "4/12", "11/12", "5/12"},
         {0},
         "parts 1,3,6-10,12 of 12 are missing — the command that made the others makes each "
         "with --part K/12"},
        {{"2/3", "1/3", "2/3"}, {0}, "is part 2 of 3, and so is a.exr — leave one of the two"},
    };
    for (int i = 0; i < COUNT_OF(cases); i++) {
        Error err = {0};
        bool done = check(cases[i].dealt, cases[i].windows, arena, &err);
        if (done != !cases[i].message ||
            (!done && strncmp(err.text, cases[i].message, strlen(cases[i].message)) != 0))
            fail_msg("case %d: %s", i, err.text);
        assert_true(done || err.code == ERROR_INPUT);
    }
}

TEST_PROGRAM(make_arena, drop_arena)
