/* SPDX-License-Identifier: Apache-2.0 */
/* A review's figures as people read them. */
#include "base/count.h"
#include "review/output/review_facts.h"
#include "review/output/review_todo.h"
#include "review/output/review_words.h"
#include "review/pane_verdict.h"
#include "review_page_fixture.h"

TEST(figures_are_said_in_words) {
    LimitVerdict ratio = {.kind = "contrast_ratio", .unit = "1", .value = 2};
    LimitVerdict height = {.kind = "character_height", .unit = "arcmin", .value = 12};
    assert_string_equal(words_figure(NAN, &arena), "–");
    assert_string_equal(words_figure(INFINITY, &arena), "∞");
    assert_string_equal(words_margin(-0.18, &arena), "−18 %");
    assert_string_equal(words_margin(0.042, &arena), "+4.2 %");
    assert_string_equal(words_margin(NAN, &arena), "–");
    static const struct {
        double found;
        const char *words;
    } FROM[] = {{1.59, "20 % below the minimum"},
                {2.1, "5.0 % above the minimum"},
                {2, "on the minimum"},
                {2.001, "less than 0.1 % above the minimum"},
                {206, "103 times the minimum"},
                {INFINITY, "far above the minimum"},
                {0, "100 % below the minimum"},
                {-0.5, "far below the minimum"},
                {NAN, "–"}};
    for (int i = 0; i < COUNT_OF(FROM); i++)
        assert_string_equal(
            words_from_limit(&(LimitVerdict){.found = FROM[i].found, .value = 2}, &arena),
            FROM[i].words);
    assert_string_equal(words_share(0.62, &arena), "62 %");
    assert_string_equal(words_share(0.0001, &arena), "less than 0.1 %");
    assert_string_equal(words_share(0, &arena), "0 %");
    assert_string_equal(words_share(0.996, &arena), "99.6 %");
    assert_string_equal(words_share(0.9999, &arena), "more than 99.9 %");
    assert_string_equal(words_share(1, &arena), "100 %");
    assert_string_equal(words_minutes(85, &arena), "1 h 25 min");
    assert_string_equal(words_minutes(120, &arena), "2 h");
    assert_string_equal(words_minutes(NAN, &arena), "–");
    assert_string_equal(words_required(&ratio, &arena), ">= 2 : 1");
    height.is_upper = height.is_advice = true;
    assert_string_equal(words_required(&height, &arena), "<= 12 arc min (advice)");
}

TEST(what_is_not_visible_says_what_hides_it) {
    Review review = fixture_review(&arena);
    const ReviewCase *hidden = &review.cases[20];
    assert_string_equal(words_reason(hidden, &arena),
                        "nothing of it is seen; hidden by wheel <rim> (leather) 75 %, stalk "
                        "(satin) 12 %, driver's hand (skin) 6.2 %, others 6.2 %");
    assert_string_equal(words_hiders(&review.cases[0], &arena), "");
    assert_string_equal(words_contrast(hidden, &arena), "–");
}

/* One sentence for each of what it rests on, and a few words; shares are the greatest of its
 * cases, and of a part of it those of that part. */
TEST(what_it_rests_on_is_one_line) {
    Review review = fixture_review(&arena);
    review.cases[0].panel = (CasePanel){
        "usable with care", "coarse: steps of 5 degrees", true, false, 0.02, 0.04, NULL};
    review.cases[3].guessed_share = 0.25;
    review.cases[5].guessed_share = 0.625;
    assert_string_equal(
        review_rests_words(&review, false, &arena),
        "panel of cluster: measured (PX-9; conoscope, lab <B>), usable with care, coarse "
        "(coarse: steps of 5 degrees), fit error 2.0 % in emission, 4.0 % in reflection; centre: "
        "synthetic; 2 guessed materials (up to 62 % of the light on a symbol); eyes as given; no "
        "occupant named, unless the model itself has somebody; limits as quoted, 1 of 5 read in "
        "the standard");
    assert_string_equal(review_rests_words(&review, true, &arena),
                        "1 panel: measured, 1 panel: synthetic; 2 guessed materials; eyes as "
                        "given; no occupant; limits: 1 read, 4 quoted");
    review.cases[0].panel.assumed = "spectra of the primaries assumed: bands";
    for (int i = 0; i < review.case_count; i++)
        review.cases[i].extrapolated_share =
            words_same(review.cases[i].display, "centre") ? 0.004 : 0.001 * i;
    assert_non_null(strstr(review_rests_words(&review, false, &arena),
                           "4.0 % in reflection, spectra of the primaries assumed: bands, up to "
                           "2.3 % of its reflected light extrapolated; centre: synthetic; 2 "));
    review.cases[5].eye = "driver";
    review.cases[5].empty_seat = "back";
    assert_non_null(strstr(review_rests_words(&review, false, &arena),
                           "has somebody; empty seats: driver; limits"));
    review.case_count = 4;
    review.sweep_count = 0;
    assert_non_null(strstr(review_rests_words(&review, false, &arena), "up to 25 %"));
    Review older = {.title = ""};
    assert_string_equal(review_rests_words(&older, false, &arena), "");
}

TEST(no_guess_no_proposal_no_quote_is_told_where_there_is_none) {
    ReviewRest rests[] = {{REST_PANEL, REST_NOT_STATED, "a", NULL, 1, 1},
                          {REST_PANEL, REST_NOT_STATED, "b", NULL, 1, 1},
                          {REST_MATERIAL, REST_WITHOUT_DATA, "grey", "perfectly white", 1, 1},
                          {REST_EYE, REST_GIVEN, "driver", NULL, 1, 1},
                          {REST_EYE, REST_PROPOSED, "co-driver", "before the seat", 1, 1},
                          {REST_OCCUPANT, REST_NOBODY, NULL, NULL, 1, 3},
                          {REST_OCCUPANT, REST_PRESENT, "in white", NULL, 2, 3},
                          {REST_LIMITS, REST_READ, "house", NULL, 4, 4}};
    Review review = {.rests_on = rests, .rests_on_count = 8};
    assert_string_equal(
        review_rests_words(&review, false, &arena),
        "panel of a: no measurement stated; b: no measurement stated; 1 material without optical "
        "data, taken as white (up to 0 % of the light on a symbol); proposed eye (co-driver), the "
        "others as given; occupants: in white (none under 1 of 3 conditions); limits as read "
        "in the standard");
}

/* What no limit was held against is in the same words as the verdict, everywhere. */
TEST(the_outcome_hides_nothing_that_was_not_judged) {
    Review review = fixture_review(&arena);
    review.sweep_count = 0;
    review.case_count = 4;
    for (int i = 0; i < 4; i++) {
        review.cases[i].verdict = VERDICT_PASS;
        review.cases[i].unjudged = UNJUDGED_NOT;
        review.cases[i].ambient = i < 2 ? AMBIENT_DAY : AMBIENT_NIGHT;
    }
    review_decide(&review);
    assert_string_equal(review_outcome_words(&review, &arena), "Passes");
    review.cases[3].verdict = VERDICT_UNJUDGED;
    review.cases[3].unjudged = UNJUDGED_LIMIT;
    assert_string_equal(review_outcome_words(&review, &arena),
                        "Passes at night and by day; 1 of 2 cases at night has no limit in this "
                        "profile");
    review.cases[2].verdict = VERDICT_UNJUDGED;
    review.cases[2].unjudged = UNJUDGED_LIMIT;
    assert_string_equal(review_outcome_words(&review, &arena),
                        "Passes by day; night has no limit in this profile");
    review.cases[0].verdict = VERDICT_FAIL;
    review_decide(&review);
    assert_string_equal(review_outcome_words(&review, &arena),
                        "Fails by day; night has no limit in this profile");
}

TEST(an_empty_seat_is_named_with_its_share) {
    ReviewCase c = {.eye = "driver", .empty_seat = "Lehne (Stoff)", .empty_seat_share = 0.96};
    assert_non_null(strstr(words_empty_seat(&c, &arena),
                           "its back, Lehne (Stoff): 96 % of the reflected light; add an occupant: "
                           "`equip`"));
    c.empty_seat = NULL;
    assert_string_equal(words_empty_seat(&c, &arena), "");
}

/* No more digits than the interval allows, and four at most. */
TEST(digits_follow_the_interval) {
    assert_string_equal(words_within(417.486, 380, 455, &arena), "420");
    assert_string_equal(words_interval(380.2, 455.1, &arena), "380 to 460");
    assert_string_equal(words_within(94.5257, 94.52, 94.53, &arena), "94.53");
    assert_string_equal(words_within(2.951, 2.931, 2.971, &arena), "2.95");
    assert_string_equal(words_within(12.345, NAN, NAN, &arena), words_figure(12.345, &arena));
    LimitVerdict limit = {
        .kind = "luminance", .unit = "cd/m2", .found = 417.486, .low = 380, .high = 455};
    assert_string_equal(words_found(&limit, &arena), "420 cd/m²");
}

static const char *fact(const ReviewFacts *facts, const char *name) {
    for (int i = 0; i < facts->count; i++)
        if (!strcmp(facts->list[i].name, name)) return facts->list[i].value;
    return "";
}

/* For each reason: what, why, and what to do; a figure that decides nothing is not reported. */
TEST(what_cannot_be_judged_says_what_would_have_it_judged) {
    static const struct {
        Unjudged why;
        const char *reason, *mend;
    } ROWS[] = {{UNJUDGED_HIDDEN, "nothing of it is seen", "\"visible\": \"optional\""},
                {UNJUDGED_PANEL, "not usable, by its own file: 63 % of the samples", "fitted anew"},
                {UNJUDGED_DATA, "without optical data", "`equip`"},
                {UNJUDGED_LIMIT, "no limit", "a profile"},
                {UNJUDGED_FIGURE, "could not be found out", "background"}};
    for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
        Review review = fixture_review(&arena);
        ReviewCase *c = &review.cases[0];
        c->verdict = VERDICT_UNJUDGED;
        c->unjudged = ROWS[i].why;
        c->visible_share = ROWS[i].why != UNJUDGED_HIDDEN;
        c->panel = (CasePanel){
            .verdict = "not usable", .reason = "63 % of the samples", .is_unusable = true};
        ReviewFacts facts =
            review_facts_of(&review, &(Finding){.c = c, .verdict = c->verdict}, NULL, &arena);
        assert_non_null(strstr(fact(&facts, "Not judged"), words_case(c, &arena)));
        assert_non_null(strstr(fact(&facts, "Why"), ROWS[i].reason));
        assert_non_null(strstr(fact(&facts, "What to do"), ROWS[i].mend));
        assert_string_equal(fact(&facts, "How often"), "");
        bool is_long = strstr(words_headline(c, &arena), "samples") != NULL;
        assert_false(is_long); /* the first line has room for the reason alone */
    }
}

/* Each by its closed form: (200 + 97)/(2 + 97) is 3; 10 minutes of arc times 1.2 are 12; an
 * image is as bright as its display. */
TEST(every_failure_says_what_to_do) {
    LimitVerdict limit = {.name = "x",
                          .kind = "contrast_ratio",
                          .unit = "1",
                          .value = 3,
                          .found = 1.98,
                          .low = 1.9,
                          .high = 2,
                          .margin = -0.3,
                          .verdict = VERDICT_FAIL};
    ReviewCase c = {.luminance_cd_m2 = {.foreground = 100, .background = 1, .reflected = 100},
                    .level = 0.5,
                    .contrast_ratio = 1.98,
                    .limits = &limit,
                    .limit_count = 1,
                    .verdict = VERDICT_FAIL};
    assert_string_equal(
        todo_of_case(&c, &arena),
        "no brightness level up to 100 % is enough; reflected light: 97 cd/m² at most (now "
        "100): hood, tilt or coating");
    limit.value = 200;
    assert_string_equal(todo_of_case(&c, &arena),
                        "no light or level matters: the content itself has 100 : 1");
    CaseRemedy remedy = {.what = "raise the brightness level from 50 % to 80 %",
                         .then = {.name = "x",
                                  .kind = "contrast_ratio",
                                  .unit = "1",
                                  .value = 2,
                                  .found = 2.1,
                                  .low = 2,
                                  .high = 2.2,
                                  .verdict = VERDICT_PASS},
                         .verdict = VERDICT_PASS};
    c.remedies = &remedy;
    c.remedy_count = 1;
    assert_string_equal(
        todo_of_case(&c, &arena),
        "raise the brightness level from 50 % to 80 %: contrast 2.1 : 1 (minimum 2 : 1)");
    c.remedy_count = 0;
    c.luminance_cd_m2.reflected = 50; /* enough by the mean at 100 %, not for sure */
    limit.value = 3;
    assert_non_null(
        strstr(todo_of_case(&c, &arena), "no brightness level up to 100 % is surely enough"));
    limit.is_upper = true;
    assert_string_equal(todo_of_case(&c, &arena), "softer colours of the content");
    limit.is_upper = false;
    limit.kind = "visual_security";
    c.must_not_be_read = true;
    assert_string_equal(todo_of_case(&c, &arena), "no level hides it: a privacy state or film");
    c.must_not_be_read = false;
    limit.kind = "visibility_level";
    assert_string_equal(todo_of_case(&c, &arena),
                        "larger or bolder characters, purer colours, or less reflected light");
    limit.kind = "character_height";
    limit.value = 12;
    limit.found = 10;
    assert_string_equal(todo_of_case(&c, &arena), "characters 1.2 times as high");
    c.verdict = limit.verdict = VERDICT_PASS;
    assert_string_equal(todo_of_case(&c, &arena), "");
    PaneFinding pane = {.display = "screen",
                        .image = 1,
                        .contrast_range = {0.2, 0.25},
                        .has_limit = true,
                        .limit = {.value = 0.1, .verdict = VERDICT_FAIL}};
    assert_string_equal(
        todo_of_finding(&(Finding){.pane = &pane, .worst = &pane.limit, .verdict = VERDICT_FAIL},
                        &arena),
        "dim screen to 40 % of its present brightness level");
    pane.image = 0.02; /* what is left of it nobody sees */
    assert_string_equal(
        todo_of_finding(&(Finding){.pane = &pane, .worst = &pane.limit, .verdict = VERDICT_FAIL},
                        &arena),
        "no level is enough: move, tilt or shade screen");
}

/* A polariser may take the display's light and leave the reflections: then that is why. 100 and
 * 5 cd/m2 over 40 are 3.11 : 1. */
TEST(sunglasses_are_named_with_what_they_take) {
    Review review = fixture_review(&arena);
    ReviewCase *c = &review.cases[0];
    c->glasses = "grey sunglasses of 20 %";
    ReviewFacts facts =
        review_facts_of(&review, &(Finding){.c = c, .verdict = c->verdict}, NULL, &arena);
    assert_string_equal(fact(&facts, "Seen through"), c->glasses);
    c->glasses_display_loss = 0.95;
    c->luminance_cd_m2.foreground = 5;
    c->luminance_cd_m2.background = 0.25;
    c->luminance_cd_m2.reflected = 40;
    facts = review_facts_of(&review, &(Finding){.c = c, .verdict = c->verdict}, NULL, &arena);
    assert_non_null(strstr(fact(&facts, "Seen through"),
                           "they pass 5.0 % as much of the display's own light as of any "
                           "other, passed alike it has 3.11 : 1"));
}

/* Columns of a telephone that do not hold the longest word stand below each other; each cell
 * has its eye's name for that. */
TEST(long_names_are_stacked_on_a_telephone) {
    static const struct {
        const char *eye, *condition;
        bool is_stacked;
    } ROWS[] = {{"driver", "noon", false},
                {"Kraftfahrzeugfuehrers", "noon", true},
                {"driver", "Nachtfahrtbeleuchtung", true}};
    for (int i = 0; i < 3; i++) {
        Review review = fixture_review(&arena);
        review.sweep_count = 0;
        review.case_count = 3;
        for (int k = 0; k < 3; k++) {
            review.cases[k].eye = k ? arena_format(&arena, "eye %d", k) : ROWS[i].eye;
            review.cases[k].condition = ROWS[i].condition;
        }
        const char *page = page_of(&(ReviewPage){.review = &review});
        assert_int_equal(strstr(page, "<div class=\"grid stacked\">") != NULL, ROWS[i].is_stacked);
        assert_non_null(strstr(page, arena_format(&arena, "<i>%s</i>", ROWS[i].eye)));
    }
}

TEST(the_sun_is_named_by_its_direction) {
    static const struct {
        double azimuth;
        const char *world, *vehicle;
    } SUNS[] = {{0, "north", "ahead"},
                {359, "north", "ahead"},
                {-46, "north-west", "ahead on the left"},
                {135, "south-east", "behind on the right"},
                {180, "south", "behind"}};
    for (int i = 0; i < 5; i++) {
        ReviewCase c = {
            .has_sun = true, .sun_azimuth_deg = SUNS[i].azimuth, .sun_elevation_deg = 30};
        assert_non_null(strstr(words_sun(&c, words_directions(false), &arena), SUNS[i].world));
        assert_non_null(strstr(words_sun(&c, words_directions(true), &arena), SUNS[i].vehicle));
    }
    ReviewCase nobody_knows = {.has_sun = true, .sun_azimuth_deg = 90, .sun_elevation_deg = 30};
    assert_string_equal(words_sun(&nobody_knows, NULL, &arena), "sun 30.0° high, azimuth 90.0°");
    assert_string_equal(words_sun(&(ReviewCase){0}, NULL, &arena), "no sun above the horizon");
}

TEST_PROGRAM(page_begin, clear_folder)
