/* SPDX-License-Identifier: Apache-2.0 */
/* A whole review without a command line: a display on a wall under an even sky. */
#include "wall_fixture.h"

#include <jansson.h>
#include <unistd.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/count.h"
#include "review/engine/engine.h"
#include "review/output/review_json.h"
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
    int scenes;
    bool refuses;
} Heard;

static bool hear_scene(void *user, const Scene *scene, Error *err) {
    Heard *heard = user;
    assert_int_equal(scene->display_count, 1);
    heard->scenes++;
    return !heard->refuses || error_set(err, ERROR_OUTPUT, "the disk is full");
}

/* unfinished: where conditions are kept; NULL: nowhere. */
static bool run_request(Heard *heard, const char *unfinished, Arena *arena, ReviewOutcome *out,
                        Error *err) {
    Problems problems = problems_start(arena);
    ReviewRequest request;
    const Profile *profile = NULL;
    Error fault = {0};
    if (!review_request_read(in_folder("r.json"), NULL, arena, &problems, &request, &fault) ||
        !profile_load(request.profile, arena, &profile, &fault))
        fail_msg("%s: %s", fault.path, fault.text);
    Progress progress = progress_start(PROGRESS_NONE, "review", "steps", 1);
    ReviewRun run = {.request = &request,
                     .profile = profile,
                     .means = {.threads = 2},
                     .problems = &problems,
                     .progress = &progress,
                     .unfinished = unfinished,
                     .news = {.read = hear_scene, .user = heard}};
    return review_run(&run, false, arena, out, err);
}

ARENA_TEST(a_review_is_a_call) {
    ReviewOutcome outcome;
    Heard heard = {0};
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

ARENA_TEST(a_listener_ends_it) {
    ReviewOutcome outcome;
    Heard heard = {.refuses = true};
    wall_write_files(request_text, arena);
    assert_fails_as(run_request(&heard, NULL, &arena, &outcome, &err), ERROR_OUTPUT,
                    "the disk is full");
    assert_int_equal(heard.scenes, 1);
}

/* ---- what was kept ----------------------------------------------------------------------- */

/* Of two conditions, each with a variant: scenes that were opened. */
static int run_kept(Arena *arena, ReviewOutcome *out) {
    Heard heard = {0};
    assert_done(run_request(&heard, arena_format(arena, "%s", in_folder(".")), arena, out, &err));
    return heard.scenes;
}

static char *text_of(const Review *review) {
    json_t *document = review_json(review);
    char *text = json_dumps(document, JSON_REAL_PRECISION(17));
    json_decref(document);
    return text;
}

/* A condition that is kept is not read again, and is the same to the last digit. */
ARENA_TEST(a_review_goes_on_with_the_next_condition) {
    ReviewOutcome first, again;
    wall_write_files(request_text, arena);
    assert_int_equal(run_kept(&arena, &first), 4);
    char *wanted = text_of(&first.review);
    assert_int_equal(run_kept(&arena, &again), 0);
    char *found = text_of(&again.review);
    assert_string_equal(found, wanted);
    free(found);
    assert_int_equal(unlink(in_folder("2-bright.condition")), 0);
    assert_int_equal(run_kept(&arena, &again), 2);
    found = text_of(&again.review);
    assert_string_equal(found, wanted);
    free(found);
    free(wanted);
}

/* Of another request, or another file of the scene. */
ARENA_TEST(what_is_no_longer_so_is_read_again) {
    ReviewOutcome out;
    wall_write_files(request_text, arena);
    run_kept(&arena, &out);
    wall_write("r.json", arena_format(&arena, "%s ", request_text), arena);
    assert_int_equal(run_kept(&arena, &out), 4);
}

/* Words all over a file are others in turn, and its checksum fits: it is refused, or does no
 * harm. */
ARENA_TEST(conditions_with_any_bytes_do_no_harm) {
    static const uint32_t words[] = {0, 1, 0xffffffffu, 0x7fffffffu, 0x7fc00000u};
    ReviewOutcome first, again;
    FileBytes file;
    size_t words_most = all_laws() ? 400 : 24;
    const char *path = arena_format(&arena, "%s", in_folder("2-bright.condition"));
    wall_write_files(request_text, arena);
    run_kept(&arena, &first);
    assert_done(file_read(path, 1 << 26, &arena, &file, &err));
    for (size_t at = 32; at + 12 <= file.size; at += 4 * (1 + file.size / words_most)) {
        Arena room = arena;
        unsigned char *bytes = ARENA_NEW(&room, unsigned char, file.size);
        memcpy(bytes, file.data, file.size);
        memcpy(bytes + at, &words[at / 4 % COUNT_OF(words)], 4);
        uint64_t sum = XXH3_64bits(bytes, file.size - 8);
        memcpy(bytes + file.size - 8, &sum, sizeof sum);
        write_bytes(path, bytes, file.size);
        run_kept(&room, &again);
        assert_int_equal(again.review.case_count, first.review.case_count);
    }
}

TEST_PROGRAM(make_folder, clear_folder)
