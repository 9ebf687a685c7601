/* SPDX-License-Identifier: Apache-2.0 */
/* A frame's parts: they meet, none is empty, none is larger than another by more than one. */
#include "fixture.h"

#include <string.h>

#include "job/job.h"

static const JobPart whole = {{3, 5, 64, 1085}, 40, 1064};

static uint64_t size_of(const JobPart *part, JobSplit how)
{
    return how == JOB_SPLIT_ROWS ? (uint64_t)(part->crop.y1 - part->crop.y0)
                                 : part->end_sample - part->first_sample;
}

/* Part and neighbour, and nothing but what is cut differs from the whole. */
static void assert_meets(const JobPart *a, const JobPart *b, JobSplit how)
{
    JobPart as_cut = whole;
    if (how == JOB_SPLIT_ROWS) {
        assert_int_equal(a->crop.y1, b->crop.y0);
        as_cut.crop.y0 = a->crop.y0;
        as_cut.crop.y1 = a->crop.y1;
    } else {
        assert_int_equal(a->end_sample, b->first_sample);
        as_cut.first_sample = a->first_sample;
        as_cut.end_sample = a->end_sample;
    }
    assert_memory_equal(a, &as_cut, sizeof as_cut);
}

TEST(parts_meet_and_are_of_one_size)
{
    static const int counts[] = {1, 2, 3, 7, 100, 1023, 1024};
    for (JobSplit how = JOB_SPLIT_SAMPLES; how <= JOB_SPLIT_ROWS; how++)
        for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
            Arena    arena = test_arena(state);
            JobPart *parts = NULL;
            int      count = counts[k];
            uint64_t least = size_of(&whole, how) / (uint64_t)count, sum = 0;
            assert_done(job_split(&whole, how, count, &arena, &parts, &err));
            for (int i = 0; i < count; i++) {
                uint64_t size = size_of(&parts[i], how);
                assert_in_range(size, least, least + 1);
                sum += size;
                if (i + 1 < count) assert_meets(&parts[i], &parts[i + 1], how);
            }
            assert_int_equal(sum, size_of(&whole, how));
            assert_int_equal(how == JOB_SPLIT_ROWS ? (uint64_t)parts[0].crop.y0
                                                   : parts[0].first_sample,
                             how == JOB_SPLIT_ROWS ? 5 : 40);
        }
}

ARENA_TEST(as_many_samples_as_there_are_numbers_are_shared_without_loss)
{
    JobPart  all = {{0, 0, 1, 1}, 0, UINT32_MAX}, *parts = NULL;
    uint64_t sum = 0;
    assert_done(job_split(&all, JOB_SPLIT_SAMPLES, 100000, &arena, &parts, &err));
    for (int i = 0; i < 100000; i++) sum += parts[i].end_sample - parts[i].first_sample;
    assert_int_equal(sum, UINT32_MAX);
    assert_int_equal(parts[99999].end_sample, UINT32_MAX);
}

TEST(more_parts_than_there_is_to_share_are_refused)
{
    static const struct {
        JobSplit    how;
        int         count;
        const char *words;
    } cases[] = {
        {JOB_SPLIT_SAMPLES, 1025, "--slurm 1025: there are only 1024 samples a pixel to share"},
        {JOB_SPLIT_ROWS, 1081, "--slurm 1081: there are only 1080 rows of pixels to share"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Arena    arena = test_arena(state);
        JobPart *parts = NULL;
        assert_fails_as(job_split(&whole, cases[k].how, cases[k].count, &arena, &parts, &err),
                        ERROR_USAGE, cases[k].words);
        assert_null(parts);
    }
}

TEST_PROGRAM(make_arena, drop_arena)
