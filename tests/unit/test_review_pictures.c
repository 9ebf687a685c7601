/* SPDX-License-Identifier: Apache-2.0 */
/* Pictures of a review's page: in it or beside it, once each, and the lines over them. */
#include "review/output/review_words.h"
#include "review_page_fixture.h"

TEST(pictures_go_into_the_page_as_they_stand) {
    Review review = fixture_review(&arena);
    const char *file = fresh_name(".png");
    ReviewPicture shown = {.of = &review.sweeps[1].worst, .title = "frame", .file = file};
    ReviewPage page = {.review = &review, .pictures = &shown, .picture_count = 1};
    assert_done(file_write(file, "Man", 3, &err));
    const char *text = page_of(&page);
    assert_int_equal(count_of(text, "src=\"data:image/png;base64,TWFu\""), 1);
    assert_true(strstr(text, "TWFu") > strstr(text, "id=\"s1\""));
    remove(file);
    const char *path = fresh_name(".html");
    assert_false(review_page_write(&page, path, why()));
    assert_string_equal(why()->file, file);
    remove(path);
}

/* Of two cases, the second time as another that shows the same. */
static void show_twice(ReviewPicture shown[2], const Review *review, const char *file,
                       const char *beside) {
    Picture picture = picture_create(3, 2, &arena);
    assert_done(picture_write(file, &picture, (PictureFile){.bits = 8}, arena, &err));
    shown[0] = shown[1] = (ReviewPicture){
        .of = &review->cases[0], .title = "frame", .file = file, .id = "p0", .beside = beside};
    shown[1].of = &review->sweeps[1].worst;
    shown[1].is_again = true;
}

/* It is named, with its size; several cards name it alike. One that is not there is an error
 * all the same. */
TEST(pictures_beside_the_page_are_named) {
    Review review = fixture_review(&arena);
    const char *file = fresh_name(".png");
    ReviewPicture shown[2];
    ReviewPage page = {.review = &review, .pictures = shown, .picture_count = 2};
    show_twice(shown, &review, file, "frames/a&b.png");
    const char *text = page_of(&page), *path = fresh_name(".html");
    assert_int_equal(count_of(text, "<img loading=\"lazy\" alt=\"frame\" width=\"3\" "
                                    "height=\"2\" src=\"frames/a&amp;b.png\">"),
                     2);
    assert_int_equal(count_of(text, "data:image/png"), 0);
    remove(file);
    assert_false(review_page_write(&page, path, why()));
    assert_string_equal(why()->file, file);
    remove(path);
}

/* Without and with the change: the first stands in the page already, or is a file like the
 * second. */
TEST(a_variants_pair_stands_before_its_cases) {
    Review review = fixture_review(&arena);
    const char *file = fresh_name(".png");
    const char *changes[] = {"display 3 degrees back"};
    Review changed = review;
    ReviewDifference all = {.after = &review.cases[0], .before = &review.cases[0]};
    ReviewVariantFound variant = {.name = "leaning & back",
                                  .words = changes,
                                  .word_count = 1,
                                  .review = &changed,
                                  .differences = &all,
                                  .difference_count = 1,
                                  .worst = all};
    Picture picture = picture_create(3, 2, &arena);
    ReviewPicture pair[2] = {
        {.title = "As it stands", .caption = "noon", .file = file, .beside = "frames/a.png"},
        {.title = "leaning & back",
         .caption = "noon",
         .file = file,
         .beside = "frames/a-variant-1.png"}};
    review.variants = &variant;
    review.variant_count = 1;
    assert_done(picture_write(file, &picture, (PictureFile){.bits = 8}, arena, &err));
    ReviewPage page = {.review = &review, .pairs = pair};
    const char *text = page_of(&page), *first = strstr(text, "src=\"frames/a.png\"");
    assert_non_null(first);
    const char *second = strstr(first, "src=\"frames/a-variant-1.png\"");
    assert_non_null(second);
    assert_non_null(strstr(second, "<th>Case</th>"));
    assert_int_equal(count_of(text, "<h4>leaning &amp; back</h4>"), 1);
    pair[1].file = NULL;
    assert_int_equal(count_of(page_of(&page), "frames/a"), 0);
    remove(file);
    pair[1].file = file;
    const char *path = fresh_name(".html");
    assert_false(review_page_write(&page, path, why()));
    assert_string_equal(why()->file, file);
    remove(path);
}

/* One display is lifted from 24 to 114 : 1 and is first of all cases, another has the least margin
 * and stays: the row shows it, in the limit's quantity, and how often its worst sweep fails. */
TEST(a_variant_shows_its_least_margin_and_what_moves_most_first) {
    Review review = fixture_review(&arena), changed = fixture_review(&arena);
    const char *changes[] = {"hood of 40 mm"};
    ReviewCase *before = &review.cases[4], *after = &changed.cases[4];
    LimitVerdict limits[2] = {before->limits[0], after->limits[0]};
    limits[0].found = limits[0].low = limits[0].high = 24;
    limits[1].found = limits[1].low = limits[1].high = 114;
    before->limits = &limits[0];
    after->limits = &limits[1];
    before->limit_count = after->limit_count = 1;
    ReviewDifference all[3] = {
        {&review.cases[3], &changed.cases[3], NULL, NULL, 0, {0, 0}, false},
        {before, after, NULL, NULL, 0.5, {0.49, 0.51}, false},
        {&review.cases[1], &changed.cases[1], NULL, NULL, -0.1, {-0.11, -0.09}, false}};
    ReviewVariantFound variant = {.name = "hood",
                                  .words = changes,
                                  .word_count = 1,
                                  .review = &changed,
                                  .differences = all,
                                  .difference_count = 3,
                                  .worst = all[0]};
    const char *least =
        arena_format(&arena, "%s : 1", words_figure(review.cases[3].limits[0].found, &arena));
    changed.sweeps[0].longest_failure_minutes = NAN;
    changed.sweeps[0].failed_share = 0.005;
    changed.sweeps[1].longest_failure_minutes = 4;
    changed.sweeps[1].failed_share = 0.02;
    for (int i = 0; i < 2; i++) changed.sweeps[i].worst.eye_failed_share = NAN;
    review.variants = &variant;
    review.variant_count = 1;
    const char *page = page_of(&(ReviewPage){.review = &review});
    const char *row = strstr(page, "<b>hood</b>"), *first = strstr(page, "<th>Case</th>");
    row = arena_string(&arena, row, (size_t)(strstr(row, "</table>") - row));
    const char *moved = strstr(first, "24.0 → 114 : 1</td>");
    assert_true(moved && strstr(first, words_case(after, &arena)) < moved);
    assert_non_null(strstr(row, arena_format(&arena, "→ %s</b>", least)));
    assert_non_null(strstr(row, words_case(&changed.cases[3], &arena)));
    assert_non_null(strstr(row, "176 of 35232 tested sun positions"));
    after->unjudged = UNJUDGED_HIDDEN;
    after->visible_share = 0; /* it moves more than any figure can */
    after->verdict = VERDICT_UNJUDGED;
    all[2].margin = -9;
    assert_non_null(strstr(page_of(&(ReviewPage){.review = &review}), "24.0 : 1 → hidden</td>"));
    after->unjudged = UNJUDGED_NOT; /* another quantity's name stands once */
    limits[0].kind = limits[1].kind = "luminance_contrast";
    all[2].margin = -0.1;
    page = page_of(&(ReviewPage){.review = &review});
    assert_non_null(strstr(page, "luminance contrast 24.0 → 114</td>"));
}

/* The eye at the origin looks along -z, a right angle wide. */
static const CaseView VIEW = {.right = {1, 0, 0},
                              .up = {0, 1, 0},
                              .forward = {0, 0, -1},
                              .is_perspective = true,
                              .half_width = 1,
                              .half_height = 0.5,
                              .width = 200,
                              .height = 100};

TEST(rays_of_a_cause_lie_over_its_frame) {
    static const Vec3 AHEAD[] = {{0, 0, 0}, {0, 0, -1}, {0.5f, 0.25f, -1}, {1, 0, -1}};
    static const Vec3 BEHIND[] = {{0, 0, 0}, {-0.5f, 0, -1}, {-0.5f, 0, 1}};
    static const CaseRay RAYS[] = {{AHEAD, 4}, {BEHIND, 3}};
    Review review = fixture_review(&arena);
    ReviewCase *c = &review.cases[3];
    CaseCause causes[2] = {c->causes[0], c->causes[1]};
    const char *file = fresh_name(".png");
    ReviewPicture shown = {.of = c, .title = "frame", .file = file, .view = &VIEW};
    ReviewPage page = {.review = &review, .pictures = &shown, .picture_count = 1};
    assert_done(file_write(file, "Man", 3, &err));
    causes[0].rays = RAYS;
    causes[0].ray_count = 2;
    c->causes = causes;
    c->cause_count = 2;
    c->frame = file;
    c->view = &VIEW;
    const char *text = page_of(&page);
    assert_int_equal(count_of(text, "<a href=\"#c3-way1\">"), 1);
    assert_int_equal(count_of(text, "<g id=\"c3-way1\""), 1);
    assert_int_equal(count_of(text, "c3-way2"), 0); /* it has no rays */
    assert_int_equal(count_of(text, "d=\"M100 50L150 25M150 25L200 50M50 50L0 50\""), 2);
    assert_int_equal(count_of(text, "<circle cx=\"50\" cy=\"50\""), 1);
    remove(file);
}

/* A symbol a tenth of the picture wide: its line runs a hundredth of that further out. */
TEST(the_first_screen_has_a_line_around_its_symbol) {
    static const Vec3 RIM[] = {
        {-0.1f, -0.05f, -1}, {0.1f, -0.05f, -1}, {0.1f, 0.05f, -1}, {-0.1f, 0.05f, -1}};
    static const Vec3 BEHIND[] = {{-0.1f, -0.05f, -1}, {0.1f, -0.05f, -1}, {0.1f, 0.05f, 1}};
    Review review = fixture_review(&arena);
    ReviewCase *c = (ReviewCase *)(void *)review_worst(&review, arena);
    const char *file = fresh_name(".png");
    ReviewPicture shown = {
        .of = c, .title = "frame", .file = file, .view = &VIEW, .is_frame = true};
    ReviewPage page = {.review = &review, .pictures = &shown, .picture_count = 1};
    assert_done(file_write(file, "Man", 3, &err));
    c->view = &VIEW;
    assert_int_equal(count_of(page_of(&page), "class=\"rim\""), 0);
    c->rim = RIM;
    c->rim_count = 4;
    assert_int_equal(count_of(page_of(&page), "d=\"M88.0 57.0L112.0 57.0L112.0 43.0L88.0 43.0Z\""),
                     2);
    assert_int_equal(count_of(page_of(&page), "class=\"close-up\""), 0);
    shown.beside = "frames/a.png";
    assert_int_equal(count_of(page_of(&page), "d=\"M88.0 57.0L112.0 57.0L112.0 43.0L88.0 43.0Z\""),
                     4);
    c->rim = BEHIND;
    c->rim_count = 3;
    assert_int_equal(count_of(page_of(&page), "class=\"rim\""), 0);
    remove(file);
}

/* Beside the frame, from the same picture: its viewBox has the frame's proportions, lies within
 * it and is about the symbol, wherever in the frame that is. */
TEST(the_first_screen_has_the_symbol_close_up) {
    static const double MIDDLES[][2] = {{0, 0}, {0.9, 0.4}, {-0.95, -0.45}, {0.3, -0.2}};
    static const double SIZES[] = {0.001, 0.03, 0.5};
    for (int i = 0; i < 12; i++) {
        const double *middle = MIDDLES[i % 4], size = SIZES[i / 4];
        Review review = fixture_review(&arena);
        ReviewCase *c = (ReviewCase *)(void *)review_worst(&review, arena);
        const char *file = fresh_name(".png");
        Vec3 rim[4];
        for (int k = 0; k < 4; k++) {
            double x = middle[0] + (k % 3 ? size : -size) / 2;
            double y = middle[1] + (k < 2 ? -size : size) / 4;
            rim[k] = vec3((float)x, (float)y, -1);
        }
        c->view = &VIEW;
        c->rim = rim;
        c->rim_count = 4;
        ReviewPicture shown = {.of = c,
                               .title = "frame",
                               .file = file,
                               .view = &VIEW,
                               .is_frame = true,
                               .beside = "frames/a&b.png"};
        assert_done(file_write(file, "Man", 3, &err));
        const char *at = strstr(
            page_of(&(ReviewPage){.review = &review, .pictures = &shown, .picture_count = 1}),
            "\"close-up\"");
        double box[4];
        assert_non_null(at);
        assert_int_equal(sscanf(strstr(at, "viewBox"), "viewBox=\"%lf %lf %lf %lf\"", &box[0],
                                &box[1], &box[2], &box[3]),
                         4);
        double x = 100 * (1 + middle[0]), y = 50 * (1 - 2 * middle[1]);
        assert_near(box[2], 2 * box[3], 0.11);
        assert_true(box[2] >= 24 && box[2] <= 80);
        assert_true(box[0] >= 0 && box[1] >= 0 && box[0] + box[2] <= 200.06 &&
                    box[1] + box[3] <= 100.06);
        assert_true(box[0] < x && x < box[0] + box[2] && box[1] < y && y < box[1] + box[3]);
        assert_non_null(strstr(at, "<image width=\"200\" height=\"100\" "
                                   "href=\"frames/a&amp;b.png\"/>"));
        remove(file);
    }
}

TEST(a_picture_of_several_cards_stands_once) {
    Review review = fixture_review(&arena);
    const char *file = fresh_name(".png");
    ReviewPicture shown[2];
    show_twice(shown, &review, file, NULL);
    const char *text =
        page_of(&(ReviewPage){.review = &review, .pictures = shown, .picture_count = 2});
    assert_int_equal(count_of(text, "data:image/png;base64,"), 1);
    assert_int_equal(count_of(text, "<svg viewBox=\"0 0 3 2\" "), 2);
    assert_int_equal(count_of(text, "<image id=\"p0\" width=\"3\" height=\"2\""), 1);
    assert_non_null(strstr(strstr(text, "id=\"s1\""), "<use href=\"#p0\"/>"));
    remove(file);
}

TEST_PROGRAM(page_begin, clear_folder)
