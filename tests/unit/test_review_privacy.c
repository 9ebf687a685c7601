/* SPDX-License-Identifier: Apache-2.0 */
/* What is written of symbols that must not be read: words, JSON, CSV, JUnit, page, diff. */
#include "base/count.h"
#include "base/mathd.h"
#include "review/export/review_junit.h"
#include "review/judge.h"
#include "review/output/review_json.h"
#include "review/output/review_words.h"
#include "review/private_image.h"
#include "review_page_fixture.h"
#include "vision/privacy.h"

/* As the plausible review has it, but that the driver must not read it; judged afresh. */
static void forbid(ReviewCase *c, double reflected, double doubt) {
    Profile profile = {.security = {.name = "visual security",
                                    .kind = LIMIT_VISUAL_SECURITY,
                                    .ambients = {true, true, true, true},
                                    .value = 1,
                                    .source = "assumed"}};
    c->must_not_be_read = true;
    c->remedy_count = 0;
    if (c->visible_share > 0) {
        c->luminance_cd_m2.reflected = reflected;
        judge_contrasts(c, (MeanInterval){reflected * (1 - doubt), reflected * (1 + doubt)});
    }
    judge_case(c, &profile, &arena);
}

/* The first fails, the second passes, the third is too close, and one is hidden. */
static Review private_review(void) {
    Review review = fixture_review(&arena);
    double white = 0;
    for (int i = 0; i < 3; i++) {
        ReviewCase *c = &review.cases[i];
        white = c->luminance_cd_m2.foreground;
        forbid(c, (i == 0 ? 0.5 : i == 1 ? 30 : 9) * white, i == 2 ? 0.1 : 0.01);
    }
    review.cases[20].luminance_cd_m2.reflected = NAN; /* as of what is hidden */
    forbid(&review.cases[20], 1, 0);
    review_decide(&review);
    return review;
}

TEST(its_words_say_what_is_forbidden) {
    static const char *const BEGIN[] = {
        "must not be read, but can: visual security S 0.17",
        "must not be read, and surely cannot: visual security S 1.49",
        "must not be read, and perhaps can: visual security S 1",
        ("must not be read, and surely cannot: nothing of it is seen; hidden by wheel <rim> "
         "(leather) 75 %")};
    static const int PLACES[] = {0, 1, 2, 20};
    static const Verdict VERDICTS[] = {VERDICT_FAIL, VERDICT_PASS, VERDICT_TOO_CLOSE, VERDICT_PASS};
    Review review = private_review();
    for (int i = 0; i < COUNT_OF(PLACES); i++) {
        const ReviewCase *c = &review.cases[PLACES[i]];
        const char *reason = words_reason(c, &arena);
        assert_int_equal(c->verdict, VERDICTS[i]);
        if (strncmp(reason, BEGIN[i], strlen(BEGIN[i])) != 0) fail_msg("%s", reason);
        assert_int_equal(strstr(reason, "; contrast ") != NULL, i < 3);
        assert_int_equal(strstr(reason, "(minimum 1)") != NULL, i < 3);
    }
    assert_string_equal(words_judged(&review.cases[20], &arena), "hidden");
}

static json_t *member(const json_t *object, const char *key) {
    json_t *found = json_object_get(object, key);
    if (!found) fail_msg("there is no %s", key);
    return found;
}

/* V and S with their intervals, of the luminances beside them; nobody else has the key. */
TEST(json_has_its_figures_and_is_read_back) {
    Review review = private_review(), again;
    json_t *root = review_json(&review), *cases = member(root, "cases");
    for (int i = 0; i < review.case_count; i++) {
        const ReviewCase *c = &review.cases[i];
        json_t *of = json_object_get(json_array_get(cases, (size_t)i), "must_not_be_read");
        assert_int_equal(of != NULL, c->must_not_be_read);
        if (i > 2) continue;
        const CaseLuminances *l = &c->luminance_cd_m2;
        double r = l->reflected, doubt = i == 2 ? 0.1 : 0.01;
        double v = privacy_security(l->foreground, l->background, r);
        double low = privacy_security(l->foreground, l->background, r * (1 - doubt));
        double high = privacy_security(l->foreground, l->background, r * (1 + doubt));
        json_t *v_range = member(of, "visual_security_interval");
        json_t *s_range = member(of, "s_interval");
        assert_close(json_real_value(member(of, "visual_security")), v, 1e-9);
        assert_close(json_real_value(json_array_get(v_range, 0)), low, 1e-9);
        assert_close(json_real_value(json_array_get(v_range, 1)), high, 1e-9);
        assert_close(json_real_value(member(of, "s")), log10_d(v), 1e-9);
        assert_close(json_real_value(json_array_get(s_range, 0)), log10_d(low), 1e-9);
        assert_close(json_real_value(json_array_get(s_range, 1)), log10_d(high), 1e-9);
        assert_close(json_real_value(member(of, "s")), c->limits[0].found, 1e-12);
        const char *by = json_string_value(member(of, "kept_by"));
        assert_true(i == 1 ? by && !strcmp(by, "visual security") : !by);
    }
    json_t *hidden = member(json_array_get(cases, 20), "must_not_be_read");
    assert_string_equal(json_string_value(member(hidden, "kept_by")), "hidden");
    assert_true(json_is_null(member(hidden, "s")));
    const char *path = fresh_name(".json");
    assert_done(review_json_write(json_incref(root), path, &err));
    assert_done(review_json_read(path, &arena, &again, &err));
    remove(path);
    for (int i = 0; i < review.case_count; i++) {
        assert_int_equal(again.cases[i].must_not_be_read, review.cases[i].must_not_be_read);
        assert_int_equal(case_kept_by(&again.cases[i]), case_kept_by(&review.cases[i]));
        assert_int_equal(again.cases[i].verdict, review.cases[i].verdict);
    }
    json_t *twice = review_json(&again); /* files have 6 digits */
    for (int i = 0; i < 3; i++) {
        json_t *one = json_array_get(member(twice, "cases"), (size_t)i);
        assert_close(json_real_value(member(member(one, "must_not_be_read"), "s")),
                     review.cases[i].limits[0].found, 1e-5);
    }
    json_decref(twice);
    json_decref(root);
}

static int columns_of(const char *csv) {
    int count = 1;
    for (const char *at = csv; *at && *at != '\n'; at++) count += *at == ',';
    return count;
}

/* Its columns stand behind all others, and are there for a review that has any. */
TEST(csv_has_columns_of_its_own) {
    static const char HEAD[] = "lit_share,must_not_be_read,kept_by,visual_security,security_s,"
                               "security_s_low,security_s_high\r\n";
    Review plain = fixture_review(&arena), review = private_review();
    const char *path = in_folder("t.csv");
    assert_done(review_csv_write(&plain, path, &err));
    const char *without = taken(path);
    assert_done(review_csv_write(&review, path, &err));
    const char *with = taken(path), *head = strstr(with, HEAD);
    assert_int_equal(columns_of(with), columns_of(without) + 6);
    assert_null(strstr(without, "must_not_be_read"));
    assert_non_null(head);
    const char *end = strchr(strchr(head, '\n') + 1, '\r'); /* of the first row */
    assert_non_null(strstr(head, ",true,,1.5"));
    assert_true(strstr(head, ",true,,1.5") < end);
    assert_non_null(strstr(end + 2, ",true,visual security,31."));
    assert_non_null(strstr(end + 2, ",true,hidden,,,,\r\n"));
    assert_non_null(strstr(end + 2, ",,,,,,\r\n")); /* what may be read */
}

TEST(junit_and_page_say_it) {
    Review review = private_review();
    const char *path = in_folder("t.xml");
    assert_done(review_junit_write(&review, path, &err));
    const char *xml = taken(path);
    assert_non_null(strstr(xml, "message=\"Fails: must not be read, but can: "));
    assert_non_null(strstr(xml, "Passes: must not be read, and surely cannot: nothing"));
    const char *page = page_of(&(ReviewPage){.review = &review});
    assert_non_null(strstr(page, "<dt>Visual security</dt><dd>V 1.5"));
    assert_non_null(strstr(page, "<dt>visual security, V and S</dt>"));
    Review plain = fixture_review(&arena);
    page = page_of(&(ReviewPage){.review = &plain});
    assert_null(strstr(page, "<dt>Visual security"));
    assert_null(strstr(page, "V and S</dt>"));
}

/* More contrast is worse: the reverse of what is to be read. */
TEST(a_difference_counts_the_other_way) {
    Review before = private_review(), after = private_review();
    for (int i = 0; i < 2; i++) {
        after.cases[i].contrast_low *= i ? 0.5 : 2;
        after.cases[i].contrast_ratio *= i ? 0.5 : 2;
        after.cases[i].contrast_high *= i ? 0.5 : 2;
    }
    ReviewDiff diff = review_diff(&before, &after, "a", "b", &arena);
    assert_int_equal(diff.count[DIFF_WORSE], 1);
    assert_int_equal(diff.count[DIFF_BETTER], 1);
    assert_ptr_equal(diff.list[0].after->c, &after.cases[0]);
    assert_int_equal(diff.list[0].kind, DIFF_WORSE);
}

/* Of an eye box those places count from which it cannot be read; what is told is the share that
 * can. */
TEST(places_that_can_read_it) {
    Review review = private_review();
    int count;
    json_t *root, *places;
    review.cases[0].eye_failed_share = 0.75;
    root = review_json(&review);
    places = member(root, "eye_places");
    ReviewPlaces *list = review_places(&review, &count, &arena);
    assert_ptr_equal(list[0].at, &review.cases[0]);
    assert_near(list[0].passing_share, 0.25, 0);
    json_t *first = json_array_get(places, 0);
    assert_near(json_real_value(member(first, "read_share")), 0.75, 1e-12);
    assert_true(json_is_true(member(first, "must_not_be_read")));
    assert_null(json_object_get(json_array_get(places, 1), "must_not_be_read"));
    json_decref(root);
}

/* From where it can be read: in the document and back, and drawn, a plan for each height. */
TEST(places_are_kept_and_drawn) {
    Review review = private_review(), again;
    const CasePlace places[] = {{{0.1, 1.2, -0.3}, VERDICT_FAIL, 1, 3, 2.9, 3.1},
                                {{0.2, 1.2, -0.3}, VERDICT_PASS, 1, 1.02, 1.01, 1.03},
                                {{0.1, 1.1, -0.3}, VERDICT_TOO_CLOSE, 1, 1.1, 1.05, 1.15},
                                {{0.2, 1.1, -0.2}, VERDICT_PASS, 0, NAN, NAN, NAN}};
    review.cases[0].places = places;
    review.cases[0].place_count = COUNT_OF(places);
    const char *path = fresh_name(".json");
    assert_done(review_json_write(review_json(&review), path, &err));
    assert_done(review_json_read(path, &arena, &again, &err));
    remove(path);
    assert_int_equal(again.cases[0].place_count, COUNT_OF(places));
    for (int i = 0; i < COUNT_OF(places); i++) {
        const CasePlace *one = &again.cases[0].places[i];
        assert_int_equal(one->verdict, places[i].verdict);
        assert_near(one->eye_m[2], places[i].eye_m[2], 1e-9);
        assert_same(one->contrast_high, places[i].contrast_high);
    }
    const char *page = page_of(&(ReviewPage){.review = &review});
    assert_int_equal(count_of(page, "<circle "), 4);
    assert_non_null(strstr(page, ">y 1.2 m</text>"));
    assert_non_null(strstr(page, "0.10, 1.20, -0.30 m: fail, S 0.17"));
    assert_non_null(strstr(page, "0.20, 1.10, -0.20 m: pass, hidden"));
    assert_true(strstr(page, ">y 1.1 m</text>") > strstr(page, ">y 1.2 m</text>"));
    assert_null(strstr(strstr(page, ": fail, S 0.17"), "<circle ")); /* it lies on top */
}

/* ---- in glass ---------------------------------------------------------------------------- */

/* The first case, which passes itself, with two images: that in the side window can be read. */
static Review mirrored_review(void) {
    Review review = private_review();
    CaseImage *images = ARENA_NEW(&arena, CaseImage, 2);
    for (int i = 0; i < 2; i++) {
        images[i] = (CaseImage){.pane = i ? "side <glass>" : "windscreen (glass)",
                                .eye_m = {0.1, 1.2, -0.3},
                                .shown_share = i ? 0.5 : 1,
                                .height_arcmin = 12,
                                .sent_foreground = 10,
                                .sent_background = 0.1,
                                .reflectance = i ? 0.1 : 1e-3,
                                .against = 1,
                                .against_range = {0.9, 1.1}};
        images[i].reflectance_range.low = 0.9 * images[i].reflectance;
        images[i].reflectance_range.high = 1.1 * images[i].reflectance;
        case_image_set_contrast(&images[i], 0.01);
    }
    review.cases[1].images = images;
    review.cases[1].image_count = 2;
    forbid(&review.cases[1], 30 * review.cases[1].luminance_cd_m2.foreground, 0.01);
    review_decide(&review);
    return review;
}

static const char IN_PANE[] = "must not be read, but can: visual security S 0.31 in side "
                              "<glass> by day (minimum 1); contrast 2.0 : 1, reversed left to "
                              "right";

/* What is said of a case is its worst image's, by the same figures everywhere. */
TEST(a_case_that_glass_lets_read_says_by_which_pane) {
    Review review = mirrored_review();
    const ReviewCase *c = &review.cases[1];
    const LimitVerdict *limit = case_worst_limit(c);
    const char *reason = words_reason(c, &arena);
    assert_int_equal(c->verdict, VERDICT_FAIL);
    assert_int_equal(c->limits[0].verdict, VERDICT_PASS);
    assert_string_equal(limit->by_pane, "side <glass>");
    if (strcmp(reason, IN_PANE) != 0) fail_msg("%s", reason);
    assert_done(review_csv_write(&review, in_folder("t.csv"), &err));
    assert_non_null(strstr(taken(in_folder("t.csv")), ",side <glass>,"));
    assert_done(review_junit_write(&review, in_folder("t.xml"), &err));
    assert_non_null(
        strstr(taken(in_folder("t.xml")), "0.31 in side &lt;glass&gt; by day (minimum"));
    const char *page = page_of(&(ReviewPage){.review = &review});
    assert_non_null(strstr(page, "<dt>… in windscreen (glass)</dt><dd>surely cannot be read"));
    assert_non_null(strstr(page, "<dt>… in side &lt;glass&gt;</dt><dd>can be read, reversed"));
    assert_non_null(strstr(page, "12.0 arc minutes high, 50 % shown"));
}

TEST(json_has_its_images_and_reads_them_back) {
    Review review = mirrored_review(), again;
    const char *path = fresh_name(".json");
    json_t *root = review_json(&review), *cases = member(root, "cases");
    json_t *of = member(json_array_get(cases, 1), "must_not_be_read");
    json_t *list = member(of, "images");
    assert_null(json_object_get(member(json_array_get(cases, 0), "must_not_be_read"), "images"));
    for (int i = 0; i < 2; i++) {
        const CaseImage *image = &review.cases[1].images[i];
        json_t *one = json_array_get(list, (size_t)i);
        double s = log10_d(privacy_security(image->foreground, image->background, 1));
        assert_close(json_real_value(member(one, "s")), s, 1e-9);
        double low = json_real_value(json_array_get(member(one, "s_interval"), 0));
        double high = json_real_value(json_array_get(member(one, "s_interval"), 1));
        assert_true(low < s && s < high);
        assert_string_equal(json_string_value(member(one, "verdict")), i ? "fail" : "pass");
    }
    assert_done(review_json_write(root, path, &err));
    assert_done(review_json_read(path, &arena, &again, &err));
    remove(path);
    const ReviewCase *c = &again.cases[1];
    assert_int_equal(c->image_count, 2);
    assert_string_equal(case_worst_limit(c)->by_pane, "side <glass>");
    assert_close(c->images[1].reflectance_range.high, 0.11, 1e-6);
    assert_int_equal(c->images[1].verdict, VERDICT_FAIL);
    assert_int_equal(case_kept_by(c), KEPT_NOT);
}

/* An image that is brighter in one review is worse there, whatever the symbol itself is. */
TEST(a_difference_counts_images) {
    Review before = mirrored_review(), after = mirrored_review();
    CaseImage *images = ARENA_NEW(&arena, CaseImage, 2);
    memcpy(images, after.cases[1].images, 2 * sizeof *images);
    images[0].contrast_low *= 2;
    images[0].contrast_ratio *= 2;
    images[0].contrast_high *= 2;
    after.cases[1].images = images;
    ReviewDiff diff = review_diff(&before, &after, "a", "b", &arena);
    assert_int_equal(diff.count[DIFF_WORSE], 1);
    assert_ptr_equal(diff.list[0].after->c, &after.cases[1]);
}

TEST_PROGRAM(page_begin, clear_folder)
