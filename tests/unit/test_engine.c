/* SPDX-License-Identifier: Apache-2.0 */
/* A whole review without a command line: a display on a wall under an even sky. */
#include "wall_fixture.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/count.h"
#include "keep/kept.h"
#include "review/engine/engine.h"
#include "review/request/request_read.h"
#include "review/review_decide.h"

/* ' stands for ". */
static const char request_text[] =
    "{'title':'Small','scene':['a.gltf'],'forward':[0,0,-1],"
    "'eyes':{'driver':{'camera':'eye'}},"
    "'symbols':{'speed':{'display':'cluster','content':'c.png','uv':[0.167,0.408,0.27,0.609],"
    "'polarity':'light-on-dark'}},'profile':'iso-15008','precision':{'contrast':0.2},"
    "'gaze':[{'at':'symbols'},{'name':'road','direction':[0,0.2,-1],'eyes':['driver']}],"
    "'frames':{'size':[32,18],'noise':1,'worst':0},"
    "'variants':{'brighter':{'brightness':{'*':2}}},"
    "'conditions':[{'name':'grey','environment':{'type':'constant','luminance':500}},"
    "{'name':'bright','environment':{'type':'constant','luminance':90000}}]}";

typedef struct Heard {
    int  scenes;
    bool refuses;
} Heard;

static bool hear_scene(void *user, const Scene *scene, Error *err)
{
    Heard *heard = user;
    assert_int_equal(scene->display_count, 1);
    heard->scenes++;
    return !heard->refuses || error_set(err, ERROR_OUTPUT, "the disk is full");
}

static bool run_request(Heard *heard, Journal *journal, Arena *arena, ReviewOutcome *out,
                        Error *err)
{
    Problems       problems = problems_start(arena);
    ReviewRequest  request;
    const Profile *profile;
    Error          fault = {0};
    if (!review_request_read(in_folder("r.json"), NULL, arena, &problems, &request, &fault) ||
        !profile_load(request.profile, arena, &profile, &fault))
        fail_msg("%s: %s", fault.path, fault.text);
    Progress  progress = progress_start(PROGRESS_NONE, "review", "steps", 1);
    ReviewRun run = {.request = &request, .profile = profile,
                     .means = {.threads = 2, .journal = journal},
                     .problems = &problems, .progress = &progress,
                     .news = {hear_scene, heard}};
    return review_run(&run, false, arena, out, err);
}

ARENA_TEST(a_review_is_a_call)
{
    ReviewOutcome outcome;
    Heard         heard = {0};
    wall_write_files(request_text, arena);
    assert_done(run_request(&heard, NULL, &arena, &outcome, &err));
    const Review *review = &outcome.review;
    assert_true(heard.scenes >= 2);
    assert_int_equal(review->case_count, 2);
    assert_int_equal(review->variant_count, 1);
    const ReviewCase *grey = review_case_named(review, "grey", "driver", "speed");
    const ReviewCase *bright = review_case_named(review, "bright", "driver", "speed");
    assert_true(grey && bright);
    assert_true(bright->contrast_ratio > 1 && bright->contrast_ratio < grey->contrast_ratio);
    assert_false(review->pass);
    assert_int_equal(bright->verdict, VERDICT_FAIL);
}

ARENA_TEST(a_listener_ends_it)
{
    ReviewOutcome outcome;
    Heard         heard = {.refuses = true};
    wall_write_files(request_text, arena);
    assert_fails_as(run_request(&heard, NULL, &arena, &outcome, &err), ERROR_OUTPUT,
                    "the disk is full");
    assert_int_equal(heard.scenes, 1);
}

/* ---- what was kept ----------------------------------------------------------------------- */

static bool run_kept(Arena *arena, ReviewOutcome *out, int *answers, Error *fault)
{
    Heard    heard = {0};
    Problems problems = problems_start(arena);
    Journal *journal;
    assert_done(journal_open(in_folder("journal"), arena, &problems, &journal, &err));
    assert_int_equal(problems.count, 0);
    bool ok = run_request(&heard, journal, arena, out, fault);
    *answers = journal_count(journal);
    journal_close(journal);
    return ok;
}

/* Every answer with other bytes, and a checksum that fits. */
static void patch(const FileBytes *file, uint64_t word, size_t from, Arena arena)
{
    unsigned char *bytes = ARENA_NEW(&arena, unsigned char, file->size);
    memcpy(bytes, file->data, file->size);
    for (size_t at = sizeof(KeptHead); at < file->size;) {
        uint64_t     size;
        XXH3_state_t sum;
        memcpy(&size, bytes + at + 16, sizeof size);
        for (size_t k = from; k + 8 <= size; k += 8) memcpy(bytes + at + 32 + k, &word, 8);
        XXH3_64bits_reset(&sum);
        XXH3_64bits_update(&sum, bytes + at, 24);
        XXH3_64bits_update(&sum, bytes + at + 32, size);
        uint64_t checksum = XXH3_64bits_digest(&sum);
        memcpy(bytes + at + 24, &checksum, sizeof checksum);
        at += 32 + size;
    }
    write_bytes(in_folder("journal"), bytes, file->size);
}

/* No member may lead anywhere: numbers that are none, indices that are far off. */
ARENA_TEST(answers_with_any_bytes_do_no_harm)
{
    static const uint64_t words[] = {UINT64_MAX,            /* NaN; -1, -1 */
                                     0x7fe1ccf385ebc8a0u,   /* 1e308 */
                                     0x7ffffff07ffffff0u,   /* large ints; NaN */
                                     0x3ff0000040000000u,   /* 1 and somewhat */
                                     0x8000000080000000u,   /* the least ints */
                                     0x0000000700000007u};
    ReviewOutcome first, again;
    FileBytes     file;
    int           count, kept;
    wall_write_files(request_text, arena);
    assert_done(run_kept(&arena, &first, &count, &err));
    assert_true(count > 4);
    assert_done(file_read(in_folder("journal"), 1 << 26, &arena, &file, &err));
    assert_done(run_kept(&arena, &again, &kept, &err));
    assert_int_equal(kept, count);
    assert_true(again.review.cases[0].contrast_ratio == first.review.cases[0].contrast_ratio);
    for (int i = 0; i < COUNT_OF(words); i++) {
        Arena room = arena;
        patch(&file, words[i], i % 2 ? 8 : 0, room);
        if (!run_kept(&room, &again, &kept, why())) assert_true(why()->text[0]);
        else assert_int_equal(again.review.case_count, first.review.case_count);
    }
}

TEST_PROGRAM(make_folder, clear_folder)
