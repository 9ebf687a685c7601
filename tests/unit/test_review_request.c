/* SPDX-License-Identifier: Apache-2.0 */
/* test_review_request.c -- what REVIEW.json says arrives in the request; no bytes do harm. */
#include "review_fixture.h"

#include "base/units.h"

static int start(void **state) {
    if (make_folder(state)) return -1;
    review_files();
    return 0;
}

static ReviewRequest good(Arena *arena) {
    ReviewRequest request = {0};
    assert_done(review_read(review_changed(review_good, NULL, NULL, arena), arena, &request, &err));
    return request;
}

/* ---- what arrives ------------------------------------------------------------------------ */

ARENA_TEST(eyes_and_where_they_look_arrive) {
    ReviewRequest r = good(&arena);
    assert_string_equal(r.title, "All of it");
    assert_int_equal(r.scene_count, 2);
    assert_string_equal(r.scenes[1], in_folder("b c.gltf")); /* percent-decoded */
    assert_int_equal(r.eye_count, 4);
    assert_true(r.eyes[0].kind == EYE_CAMERA && !strcmp(r.eyes[0].camera, "eye"));
    assert_true(r.eyes[1].kind == EYE_CAMERA && !r.eyes[1].camera && r.eyes[1].camera_id == 1);
    assert_true(r.eyes[2].kind == EYE_POINT && r.eyes[2].position_m[2] == 3);
    assert_true(r.eyes[3].kind == EYE_BOX && review_eye_count(&r.eyes[3]) == 6);
    assert_near(r.forward[2], -1, 1e-15);
    assert_true(r.observer.age_years == 60 && r.observer.pigment == 1);
    assert_true(r.gazes[0].at_symbols && r.gazes[0].for_eye[0] && r.gazes[0].for_eye[3]);
    assert_string_equal(r.gazes[0].name, "symbols");
    assert_near(r.gazes[1].direction[2], -1, 1e-15);
    assert_true(r.gazes[1].for_eye[0] && r.gazes[1].for_eye[2]);
    assert_false(r.gazes[1].for_eye[1] || r.gazes[1].for_eye[3]);
}

ARENA_TEST(symbols_levels_and_the_rest_arrive) {
    ReviewRequest r = good(&arena);
    assert_int_equal(r.symbol_count, 3);
    assert_string_equal(r.symbols[0].content, in_folder("p.png"));
    assert_true(r.symbols[0].has_uv && r.symbols[0].uv[3] == 0.4);
    assert_int_equal(r.symbols[0].polarity, POLARITY_LIGHT_ON_DARK);
    assert_true(r.symbols[1].find_text && !r.symbols[1].has_uv && r.symbols[1].uv[2] == 1);
    assert_null(r.symbols[1].content);
    assert_string_equal(r.symbols[1].display, "node:screen");
    assert_non_null(r.symbols[2].mask);
    assert_int_equal(r.level_count, 2);
    assert_true(r.levels[0].fixed_count == 2 && !r.levels[0].is_curve);
    assert_true(r.levels[1].is_curve && r.levels[1].point_count == 3);
    assert_near(r.levels[1].normal[1], 0.6, 1e-15);
    assert_string_equal(r.profile, "iso-15008");
    assert_true(r.precision_clear == 0.05 && r.precision_paths == 10000);
    assert_true(r.seed == 7 && review_seed(&r, 3) != 3 && review_seed(&r, 4) != 3);
    assert_true(r.precision_contrast == 0.02 && r.frames.width == 640 && r.frames.worst == 2);
    assert_int_equal(r.input_count, 1); /* the file */
    assert_string_equal(r.inputs[0].path, r.file);
}

ARENA_TEST(conditions_arrive) {
    ReviewRequest r = good(&arena);
    const ReviewCondition *noon = &r.conditions[0], *night = &r.conditions[1];
    assert_int_equal(r.condition_count, 4);
    assert_true(noon->kind == CONDITION_MOMENT && noon->has_environment);
    assert_int_equal(noon->environment.kind, ENVIRONMENT_SKY);
    assert_true(noon->environment.daylight.has_time);
    assert_true(noon->has_heading && noon->heading_deg == 30);
    assert_close((double)noon->environment.heading, radians_from_degrees(30), 1e-6);
    assert_true(noon->environment.forward.z == -1);
    assert_true(noon->level_id == 1 && noon->with_id == 0 && noon->content_count == 1);
    for (int i = 0; i < 3; i++) assert_int_equal(noon->polarity[i], POLARITY_DARK_ON_LIGHT);
    assert_true(!night->has_environment && night->light_count == 1);
    assert_true(night->has_heading && night->heading_deg == -20 && night->with_id == NO_ID);
    assert_int_equal(night->polarity[0], POLARITY_LIGHT_ON_DARK); /* the symbol's own */
    assert_int_equal(night->polarity[1], POLARITY_DARK_ON_LIGHT);
    assert_int_equal(night->polarity[2], POLARITY_AUTO);
}

/* A deck of clouds is there, its synthetic billows are not. */
ARENA_TEST(a_clouds_relief_is_nothing_to_judge_by) {
    ReviewRequest r = {0};
    char *text = review_changed(review_good, "'heading_deg':30}",
                                "'heading_deg':30,'ground':'cloud','cloud_top_m':200,"
                                "'cloud_relief_m':500}",
                                &arena);
    assert_done(review_read(text, &arena, &r, &err));
    assert_int_equal(r.conditions[0].environment.daylight.floor, FLOOR_CLOUD);
    assert_true(r.conditions[0].environment.daylight.cloud_relief_m == 0);
}

ARENA_TEST(sweeps_arrive) {
    ReviewRequest r = good(&arena);
    const ReviewCondition *suns = &r.conditions[2], *year = &r.conditions[3];
    assert_int_equal(year->weather_id, NO_ID);
    assert_int_equal(suns->kind, CONDITION_SUN_SWEEP);
    assert_int_equal(suns->azimuth_deg.count, 5); /* both ends in */
    assert_int_equal(suns->elevation_deg.count, 1);
    for (int i = 0; i < 5; i++)
        assert_near(review_range_value(&suns->azimuth_deg, i), 90 * i, 1e-12);
    assert_false(suns->has_heading || suns->has_environment);
    assert_true(year->kind == CONDITION_YEAR_SWEEP && year->year == 2026 && year->with_night);
    assert_true(year->where.latitude_deg == 48 && year->where.altitude_m == 0);
    assert_true(year->step_minutes == 30 && year->heading_count == 2);
    assert_true(year->has_environment && year->environment.daylight.turbidity == 4);
}

ARENA_TEST(what_is_not_said_has_defaults) {
    ReviewRequest r;
    char *text = review_changed(
        "{'scene':['a.gltf'],'eyes':{'e':{'camera':0}},'profile':'p',"
        "'symbols':{'s':{'display':'d','uv':[0,0,1,1]}},'conditions':[{'name':'n'}]}",
        NULL, NULL, &arena);
    assert_done(review_read(text, &arena, &r, &err));
    assert_string_equal(r.title, "t.review.json");
    assert_true(r.forward[0] == 0 && r.forward[1] == 0 && r.forward[2] == -1);
    assert_true(r.observer.age_years == 50 && r.observer.pigment == 0.5);
    assert_true(r.gaze_count == 1 && r.gazes[0].at_symbols && r.gazes[0].for_eye[0]);
    assert_int_equal(r.symbols[0].polarity, POLARITY_AUTO);
    assert_true(r.seed == 0 && review_seed(&r, 3) == 3);
    assert_true(r.precision_contrast == 0.01 && r.frames.width == 960 && r.frames.worst == 2);
    const ReviewCondition *c = &r.conditions[0];
    assert_true(c->kind == CONDITION_MOMENT && !c->has_environment && !c->has_heading);
    assert_true(c->level_id == NO_ID && c->with_id == NO_ID && c->weather_id == NO_ID);
    assert_true(r.with_count == 0 && r.level_count == 0 && c->light_count == 0);
}

/* ---- a box of eyes ----------------------------------------------------------------------- */

/* Its points are symmetric about the centre, reach the faces, and are all different. */
TEST(an_eye_box_is_a_grid_with_both_ends) {
    ReviewEye eye = {.kind = EYE_BOX,
                     .position_m = {1, 2, 3},
                     .half_size_m = {0.1, 0.2, 0.3},
                     .grid = {3, 1, 2}};
    double sum[3] = {0}, low[3] = {9, 9, 9}, high[3] = {-9, -9, -9};
    int count = review_eye_count(&eye);
    assert_int_equal(count, 6);
    for (int i = 0; i < count; i++) {
        double point[3], other[3];
        review_eye_point(&eye, i, point);
        for (int k = 0; k < 3; k++) {
            sum[k] += point[k] / count;
            low[k] = fmin(low[k], point[k]);
            high[k] = fmax(high[k], point[k]);
        }
        for (int j = 0; j < i; j++) {
            review_eye_point(&eye, j, other);
            assert_true(memcmp(point, other, sizeof point) != 0);
        }
    }
    for (int k = 0; k < 3; k++) assert_near(sum[k], eye.position_m[k], 1e-12);
    assert_near(low[0], 0.9, 1e-12);
    assert_near(high[0], 1.1, 1e-12);
    assert_near(low[1], 2, 1e-12); /* one point: the middle */
    assert_near(high[2], 3.3, 1e-12);
}

/* Its points lie on an ellipsoid about its middle, whose front is down by the tilt. */
ARENA_TEST(an_ellipse_of_eyes_has_its_axes) {
    ReviewRequest r;
    char *text = review_changed(review_good, "'half_size_m':[0.1,0.2,0],'grid':[2,3,1]",
                                "'ellipse_m':[0.4,0.2,0.1],'tilt_deg':30", &arena);
    assert_done(review_read(text, &arena, &r, &err));
    const ReviewEye *eye = &r.eyes[3];
    double c = sqrt(0.75), s = 0.5, middle[3], sum[3] = {0};
    assert_int_equal(review_eye_count(eye), ELLIPSE_POINTS);
    review_eye_point(eye, 0, middle);
    for (int k = 0; k < 3; k++) assert_near(middle[k], k + 1, 1e-12);
    for (int i = 0; i < ELLIPSE_POINTS; i++) {
        double p[3];
        review_eye_point(eye, i, p);
        for (int k = 0; k < 3; k++) sum[k] += p[k] - middle[k];
        /* forward is -z: ahead (0, -s, -c), across x, up (0, c, -s) */
        double ahead = -s * (p[1] - middle[1]) - c * (p[2] - middle[2]);
        double up = c * (p[1] - middle[1]) - s * (p[2] - middle[2]);
        double radius = hypot(hypot(ahead / 0.2, (p[0] - middle[0]) / 0.1), up / 0.05);
        assert_near(radius, i ? 1 : 0, 1e-12);
    }
    for (int k = 0; k < 3; k++) assert_near(sum[k], 0, 1e-12);
}

/* ---- any bytes --------------------------------------------------------------------------- */

ARENA_TEST(every_prefix_is_refused_in_one_line) {
    char *text = review_changed(review_good, NULL, NULL, &arena);
    size_t length = strlen(text);
    for (size_t n = 0; n < length; n++) {
        ReviewRequest r;
        Arena scratch = arena;
        char *part = arena_string(&scratch, text, n);
        assert_false(review_read(part, &scratch, &r, why()));
        assert_int_equal(why()->code, ERROR_INPUT);
        assert_true(why()->text[0] && !strchr(why()->text, '\n'));
        assert_text_has(why()->file, "t.review.json");
    }
}

ARENA_TEST(damaged_bytes_do_no_harm) {
    static const char damage[] = " 9\"{}[],:-e\\\xff\x01";
    char *text = review_changed(review_good, NULL, NULL, &arena);
    size_t length = strlen(text);
    unsigned random = 7;
    int refused = 0;
    for (size_t n = 0; n < length; n++) {
        ReviewRequest r;
        Arena scratch = arena;
        char *part = arena_string(&scratch, text, length);
        random = random * 1664525u + 1013904223u;
        part[n] = damage[(random >> 16) % (sizeof damage - 1)];
        if (review_read(part, &scratch, &r, why())) continue;
        refused++;
        assert_true(why()->text[0] && !strchr(why()->text, '\n'));
    }
    assert_true(refused > (int)length / 3);
}

/* ---- memory ------------------------------------------------------------------------------ */

/* As a process of its own: running out is an exit, as in the program, or an error that says so
 * of the file. */
static int status_with(size_t bytes, const char *file) {
    pid_t child = fork();
    if (child == 0) {
        ReviewRequest r;
        Arena arena = arena_reserve((size_t)1 << 22);
        if (arena.end > arena.next + bytes) arena.end = arena.next + bytes;
        arena.on_full = leave_when_full;
        Problems problems = problems_start(&arena);
        bool is_read = review_request_read(file, NULL, &arena, &problems, &r, why());
        _exit(is_read ? 0 : why()->code == ERROR_MEMORY ? FULL_STATUS : 3);
    }
    return status_of(child);
}

ARENA_TEST(running_out_of_memory_is_a_clean_end) {
    const char *file = in_folder("t.review.json");
    int full = 0, status = FULL_STATUS;
    write_text(file, review_changed(review_good, NULL, NULL, &arena));
    for (size_t bytes = 64; status == FULL_STATUS && bytes < (size_t)1 << 22;
         bytes += bytes / 16 + 8) {
        status = status_with(bytes, file);
        if (status != 0 && status != FULL_STATUS) fail_msg("%zu bytes: %d", bytes, status);
        full += status == FULL_STATUS;
    }
    assert_int_equal(status, 0);
    assert_true(full > 20); /* else the test would test nothing */
}

TEST_PROGRAM(start, clear_folder)
