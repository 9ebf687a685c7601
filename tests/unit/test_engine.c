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

/* ---- scenes that stay -------------------------------------------------------------------- */

static const char levels_text[] =
    "{'scene':['a.gltf'],'forward':[0,0,-1],'eyes':{'driver':{'camera':'eye'}},"
    "'symbols':{'speed':{'display':'cluster','content':'c.png','uv':[0.167,0.408,0.27,0.609]}},"
    "'profile':'iso-15008','levels':{'auto':{'sensor':{'position_m':[0,0.2,0.2],'normal':[0,3,4]},"
    "'table_lx':[[0,0.02],[100000,1]]},'low':{'*':0.1}},"
    "'variants':{'brighter':{'brightness':{'*':2}}},"
    "'conditions':[{'name':'grey','level':'auto'},{'name':'set','level':'low'}]}";

/* What a meter before the display reads. */
static double lit_lux(const SetupOptions *options, const Environment *sky, Arena arena) {
    Setup setup;
    Problems problems = problems_start(&arena);
    const LitPoint head = {{0, 0, 0.2f}, {0, 0.6f, -0.8f}, false};
    const ReadingGoal goal = {.precision = 0.01, .most = 4096};
    assert_done(setup_open(options, &arena, &problems, &setup, &err) &&
                setup_light(&setup, sky, &arena, &err));
    double lux = setup_meter(&setup, head, 1, &goal, arena).reflected;
    setup_close(&setup);
    return lux;
}

/* One that stays, whatever it was lit by before, is lit as one that is loaded for it. */
ARENA_TEST(a_scene_is_lit_as_if_it_were_new) {
    ReviewRequest request;
    ScenesKept scenes = {NULL};
    Problems problems = problems_start(&arena);
    Environment skies[2] = {{.kind = ENVIRONMENT_CONSTANT,
                             .luminance_cd_m2 = 100,
                             .color = {1, 1, 1},
                             .has_sun = true,
                             .sun_elevation = 0.5f,
                             .sun_illuminance_lx = 20000,
                             .sun_angular_radius = 0.005f,
                             .forward = {0, 0, -1}}};
    double before = 0;
    wall_write_files(levels_text, arena);
    assert_done(review_request_read(in_folder("r.json"), NULL, &arena, &problems, &request, &err));
    ReviewRequest brighter = review_request_variant(&request, &request.variants[0], &arena);
    skies[1] = skies[0];
    skies[1].sun_azimuth = 1;
    for (int i = 0; i < 16; i++) {
        const SetupMeans means = {.threads = 2};
        SetupOptions own = {i & 1 ? &brighter : &request, &request.conditions[i >> 1 & 1], means};
        double wanted = lit_lux(&own, &skies[i >> 2 & 1], arena);
        own.means.scenes = &scenes;
        for (int again = 0; again < 2; again++)
            assert_true(lit_lux(&own, &skies[i >> 2 & 1], arena) == wanted);
        assert_true(wanted != before);
        before = wanted;
    }
    scenes_kept_close(&scenes, NO_ID);
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
