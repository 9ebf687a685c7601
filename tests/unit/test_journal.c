/* SPDX-License-Identifier: Apache-2.0 */
/* What a journal was given it returns, after any kill; what is cut off or damaged ends it, and
 * all before that counts. */
#include "fixture.h"

#include <sys/stat.h>

#include "keep/journal.h"

enum { ANSWERS = 12, MOST = 40 };

static char file[2 * FOLDER_BYTES];

static int start(void **state)
{
    if (make_folder(state)) return -1;
    snprintf(file, sizeof file, "%s", in_folder("journal"));
    return 0;
}

static JournalKey key_of(int i)
{
    return (JournalKey){(uint64_t)i * 0x9E3779B97F4A7C15u, (uint64_t)i};
}

static size_t size_of(int i)
{
    return (size_t)(i * 7 % MOST);
}

static void answer_of(int i, unsigned char answer[MOST])
{
    for (int k = 0; k < MOST; k++) answer[k] = (unsigned char)(31 * i + k);
}

static Journal *open_journal(Arena *arena, int *warnings)
{
    Problems problems = problems_start(arena);
    Journal *journal;
    assert_done(journal_open(file, arena, &problems, &journal, &err));
    *warnings = problems.count;
    return journal;
}

static void fill(Arena *arena)
{
    int      warnings;
    unsigned char answer[MOST];
    unlink(file);
    Journal *journal = open_journal(arena, &warnings);
    for (int i = 1; i <= ANSWERS; i++) {
        answer_of(i, answer);
        journal_add(journal, key_of(i), answer, size_of(i));
    }
    assert_int_equal(journal_count(journal), ANSWERS);
    journal_close(journal);
}

/* How many of the first answers are there; none behind them may be. */
static int count_known(const Journal *journal)
{
    int known = 0;
    for (int i = 1; i <= ANSWERS; i++) {
        unsigned char found[MOST], wanted[MOST];
        answer_of(i, wanted);
        if (!journal_find(journal, key_of(i), found, size_of(i))) continue;
        assert_int_equal(known, i - 1);
        assert_memory_equal(found, wanted, size_of(i));
        known = i;
    }
    assert_int_equal(known, journal_count(journal));
    return known;
}

ARENA_TEST(what_was_kept_is_found_again)
{
    int   warnings;
    unsigned char other[MOST] = {0};
    fill(&arena);
    Journal *journal = open_journal(&arena, &warnings);
    assert_int_equal(warnings, 0);
    assert_int_equal(count_known(journal), ANSWERS);
    assert_false(journal_find(journal, key_of(3), other, size_of(3) + 1));
    assert_false(journal_find(journal, key_of(ANSWERS + 1), other, 1));
    journal_add(journal, key_of(3), other, size_of(3)); /* the first counts */
    assert_int_equal(count_known(journal), ANSWERS);
    for (int i = 100; i < 3000; i++) journal_add(journal, key_of(i), &i, sizeof i);
    for (int i = 100, k; i < 3000; i++)
        assert_true(journal_find(journal, key_of(i), &k, sizeof k) && k == i);
    journal_close(journal);
}

ARENA_TEST(cut_off_anywhere_it_goes_on)
{
    FileBytes bytes;
    int       warnings, last = -1;
    fill(&arena);
    assert_done(file_read(file, 1 << 20, &arena, &bytes, &err));
    for (size_t size = 0; size <= bytes.size; size++) {
        Arena room = arena;
        write_bytes(file, bytes.data, size);
        Journal *journal = open_journal(&room, &warnings);
        int known = count_known(journal);
        assert_true(known >= last);
        last = known;
        unsigned char answer[MOST];
        for (int i = known + 1; i <= ANSWERS; i++) {
            answer_of(i, answer);
            journal_add(journal, key_of(i), answer, size_of(i));
        }
        journal_close(journal);
        FileBytes again;
        assert_done(file_read(file, 1 << 20, &room, &again, &err));
        assert_int_equal(again.size, bytes.size);
        assert_memory_equal(again.data, bytes.data, bytes.size);
    }
    assert_int_equal(last, ANSWERS);
}

ARENA_TEST(a_damaged_byte_is_told_and_nothing_wrong_is_found)
{
    FileBytes bytes;
    fill(&arena);
    assert_done(file_read(file, 1 << 20, &arena, &bytes, &err));
    unsigned char *damaged = ARENA_NEW(&arena, unsigned char, bytes.size);
    for (size_t at = 0; at < bytes.size; at++) {
        Arena room = arena;
        int   warnings;
        memcpy(damaged, bytes.data, bytes.size);
        damaged[at] ^= 0x10;
        write_bytes(file, damaged, bytes.size);
        Journal *journal = open_journal(&room, &warnings);
        assert_int_equal(warnings, 1);
        assert_true(count_known(journal) < ANSWERS);
        journal_close(journal);
    }
}

ARENA_TEST(two_at_once_are_refused_and_an_empty_one_leaves_nothing)
{
    Problems problems = problems_start(&arena);
    Journal *second;
    int      warnings;
    unlink(file);
    Journal *journal = open_journal(&arena, &warnings);
    assert_fails_as(journal_open(file, &arena, &problems, &second, &err), ERROR_OUTPUT,
                    "another review is at work in this folder");
    assert_string_equal(why()->file, file);
    journal_close(journal);
    assert_false(file_exists(file));
}

/* A folder that came from anywhere: what a link leads to is not written, nobody waits. */
ARENA_TEST(a_journal_is_a_regular_file)
{
    Problems    problems = problems_start(&arena);
    Journal    *journal;
    const char *mine = arena_format(&arena, "%s", in_folder("mine"));
    unlink(file);
    write_text(mine, "mine");
    assert_int_equal(symlink(mine, file), 0);
    assert_false(journal_open(file, &arena, &problems, &journal, why()));
    assert_int_equal(why()->code, ERROR_OUTPUT);
    assert_string_equal(read_text(mine, &arena), "mine");
    unlink(file);
    assert_int_equal(mkfifo(file, 0600), 0);
    assert_false(journal_open(file, &arena, &problems, &journal, why()));
    assert_error_has(why(), "is not a regular file");
    unlink(file);
}

ARENA_TEST(a_large_answer_is_kept)
{
    enum { LARGE = 1 << 20 };
    int            warnings;
    unsigned char *answer = ARENA_NEW(&arena, unsigned char, LARGE);
    unsigned char *found = ARENA_NEW(&arena, unsigned char, LARGE);
    for (int i = 0; i < LARGE; i++) answer[i] = (unsigned char)(i * 7 >> 3);
    fill(&arena);
    Journal *journal = open_journal(&arena, &warnings);
    journal_add(journal, key_of(99), answer, LARGE);
    journal_close(journal);
    journal = open_journal(&arena, &warnings);
    assert_int_equal(journal_count(journal), ANSWERS + 1);
    assert_true(journal_find(journal, key_of(99), found, LARGE));
    assert_memory_equal(found, answer, LARGE);
    journal_close(journal);
}

TEST_PROGRAM(start, clear_folder)
