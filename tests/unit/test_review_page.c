/* SPDX-License-Identifier: Apache-2.0 */
/* The page of a review: well formed whatever the names are, nothing loaded from anywhere;
 * test_review_drawn.c has its drawings. */
#include <ctype.h>
#include <string.h>

#include "review/output/review_json.h"
#include "review/output/review_link.h"
#include "review/output/review_words.h"
#include "pane_fixture.h"
#include "review_page_fixture.h"
#include "road_fixture.h"

/* ---- well formed ------------------------------------------------------------------------ */

typedef struct Tag {
    char name[24];
    bool is_end, is_empty;
    const char *after;
} Tag;

/* Reads a tag at '<': a name, attributes name="value" without '<' in them, or '>' at once. */
static Tag read_tag(const char *at) {
    static const char *const EMPTY[] = {"meta", "img", "br"};
    Tag tag = {.is_end = at[1] == '/'};
    size_t length = 0;
    at += 1 + tag.is_end;
    for (; isalnum((unsigned char)at[length]); length++) assert_true(length < 23);
    if (length == 0) fail_msg("a stray '<': %.60s", at - 1);
    memcpy(tag.name, at, length);
    for (at += length; *at == ' ';) {
        size_t name = strspn(at += 1, "abcdefghijklmnopqrstuvwxyz-ABCDEFGHIJKLMNOPQRSTUVWXYZ");
        at += name;
        if (*at != '=') continue; /* open */
        size_t value = strcspn(at + 2, "\"<");
        if (name == 0 || at[1] != '"' || at[2 + value] != '"') fail_msg("at %.60s", at);
        at += value + 3;
    }
    tag.is_empty = *at == '/';
    at += tag.is_empty;
    if (*at != '>') fail_msg("a tag does not end: %.60s", at);
    for (size_t i = 0; i < 3; i++) tag.is_empty |= !strcmp(tag.name, EMPTY[i]);
    tag.after = at + 1;
    return tag;
}

/* Every tag has its end, in order; style and script hold what they like. */
static void assert_well_formed(const char *page) {
    static Tag open[64];
    int depth = 0;
    assert_int_equal(strncmp(page, "<!DOCTYPE html>", 15), 0);
    for (const char *at = strchr(page + 1, '<'); at; at = strchr(at, '<')) {
        Tag tag = read_tag(at);
        at = tag.after;
        if (tag.is_end) {
            if (depth == 0 || strcmp(open[--depth].name, tag.name) != 0)
                fail_msg("</%s> at %.60s", tag.name, at);
        } else if (!strcmp(tag.name, "style") || !strcmp(tag.name, "script")) {
            at = strstr(at, arena_format(&arena, "</%s>", tag.name));
            assert_non_null(at);
            at = strchr(at, '>');
        } else if (!tag.is_empty) {
            assert_true(depth < 64);
            open[depth++] = tag;
        }
    }
    assert_int_equal(depth, 0);
}

/* The value of an attribute at `at`, behind its quote. */
static const char *value_at(const char *at) {
    return arena_string(&arena, at, strcspn(at, "\""));
}

/* Pictures are data, links stay in the page and lead somewhere, ids are unique. */
static void assert_self_contained(const char *page) {
    static const char *const NEVER[] = {"src=\"http", "href=\"http", "url(",  "@import",
                                        "<link",      "<iframe",     "<base", "srcset"};
    for (size_t i = 0; i < sizeof NEVER / sizeof *NEVER; i++)
        if (strstr(page, NEVER[i])) fail_msg("there is %s", NEVER[i]);
    for (const char *at = page; (at = strstr(at, " src=\"")); at++)
        assert_int_equal(strncmp(at + 6, "data:image/", 11), 0);
    for (const char *at = page; (at = strstr(at, " href=\"")); at++) {
        const char *to = value_at(at + 7);
        if (!strncmp(to, "data:image/png;", 15)) continue;
        assert_int_equal(to[0], '#');
        if (count_of(page, arena_format(&arena, " id=\"%s\"", to + 1)) != 1)
            fail_msg("%s leads nowhere", to);
    }
    for (const char *at = page; (at = strstr(at, " id=\"")); at++)
        assert_int_equal(count_of(page, arena_format(&arena, " id=\"%s\"", value_at(at + 5))), 1);
}

/* ---- pages ------------------------------------------------------------------------------ */

static const char *full_page(const Review *review) {
    ReviewMap map = fixture_map(&arena, &review->sweeps[0]);
    ReviewCalendar calendar = fixture_calendar(&arena, &review->sweeps[0]);
    Review before = fixture_review(&arena);
    ReviewDiff diff = review_diff(&before, review, WILD_NAME, "now", &arena);
    const char *file = in_folder("full.png");
    Picture picture = picture_create(3, 2, &arena);
    ReviewPicture shown = {
        .of = &review->cases[0], .title = WILD_NAME, .caption = WILD_NAME, .file = file};
    assert_done(picture_write(file, &picture, (PictureFile){.bits = 8}, arena, &err));
    return page_of(&(ReviewPage){.review = review,
                                 .pictures = &shown,
                                 .picture_count = 1,
                                 .maps = &map,
                                 .map_count = 1,
                                 .calendars = &calendar,
                                 .calendar_count = 1,
                                 .sources = WILD_NAME,
                                 .command = WILD_NAME,
                                 .diff = &diff});
}

TEST(a_page_is_well_formed_whatever_the_names_are) {
    static const char *const NOT_NUMBERS[] = {">nan", "\"nan", "nan%", "nan "};
    Review reviews[] = {fixture_odd_review(&arena), fixture_review(&arena)};
    for (int i = 0; i < 2; i++) {
        const char *page = full_page(&reviews[i]);
        assert_well_formed(page);
        assert_self_contained(page);
        assert_null(strstr(page, WILD_NAME));
        assert_null(strstr(page, "<a b="));
        for (int k = 0; k < 4; k++) assert_null(strstr(page, NOT_NUMBERS[k]));
    }
}

/* ---- names ------------------------------------------------------------------------------ */

/* Counts every key of a document. */
static void add_keys(json_t *keys, const json_t *value) {
    size_t i;
    const char *key;
    json_t *member;
    json_object_foreach((json_t *)value, key, member) {
        json_object_set_new(keys, key, json_true());
        add_keys(keys, member);
    }
    json_array_foreach(value, i, member) add_keys(keys, member);
}

/* Every name in a template and its parts: of "a.b" both. */
static void add_names(json_t *names, const char *template) {
    int i = 0;
    while (i < page_file_count && strcmp(page_file_table[i].name, template)) i++;
    assert_true(i < page_file_count);
    for (const char *at = page_file_table[i].text; (at = strstr(at, "{{"));) {
        at += strspn(at, "{");
        bool is_part = *at == '>';
        const char *name = at + strspn(at, "#^/>");
        size_t length = strcspn(name, "|}");
        if (is_part) add_names(names, arena_format(&arena, "%.*s.html", (int)length, name));
        for (const char *end = name + length; !is_part && name < end; name++) {
            size_t one = strcspn(name, ".|}");
            if (one && *name != '0')
                json_object_set_new(names, arena_string(&arena, name, one), json_true());
            name += one;
        }
    }
}

/* Of a review that has all there is, at least once. own: the keys of its review.json. */
static json_t *all_values(json_t *own) {
    static const Vec3 RIM[] = {{-0.1f, 0, -1}, {0.1f, 0, -1}, {0.1f, 0.1f, -1}};
    static const CaseView VIEW = {.right = {1, 0, 0},
                                  .up = {0, 1, 0},
                                  .forward = {0, 0, -1},
                                  .is_perspective = true,
                                  .half_width = 1,
                                  .half_height = 0.5,
                                  .width = 200,
                                  .height = 100};
    Review before = fixture_review(&arena), *review = ARENA_NEW(&arena, Review, 1);
    *review = fixture_review(&arena);
    fixture_add_levels(&arena, review);
    before.gaze_count = 2; /* one is new */
    ReviewDiff diff = review_diff(&before, review, "a", "b", &arena);
    ReviewMap map = fixture_map(&arena, &review->sweeps[0]);
    ReviewCalendar calendar = fixture_calendar(&arena, &review->sweeps[0]);
    ReviewCase *worst = (ReviewCase *)(size_t)review_worst(review, arena);
    const char *file = fresh_name(".png"), *change = "x";
    Picture picture = picture_create(3, 2, &arena);
    ReviewDifference d = {
        .before = worst, .after = worst, .margin = 0.5, .margin_range = {0.4, 0.6}};
    ReviewVariantFound variant = {.name = "v",
                                  .words = &change,
                                  .word_count = 1,
                                  .review = &before,
                                  .differences = &d,
                                  .difference_count = 1,
                                  .worst = d};
    ReviewPicture shown = {.of = worst,
                           .title = "t",
                           .caption = "c",
                           .file = file,
                           .beside = "b.png",
                           .view = &VIEW,
                           .is_frame = true};
    ReviewPicture pair[2] = {shown, {.title = "t", .file = file}};
    worst->view = &VIEW;
    worst->rim = RIM;
    worst->rim_count = 3;
    review->variants = &variant;
    review->variant_count = 1;
    PaneFinding panes[] = {fixture_pane("near"), fixture_pane_hidden()};
    fixture_pane_judge(&panes[0], 10); /* the worst is the case */
    review->pane_images = panes;
    review->pane_image_count = 2;
    review->gazes[2].road = fixture_road(&arena, 30, 1);
    fixture_dimming(review->gazes[2].road);
    assert_done(picture_write(file, &picture, (PictureFile){.bits = 8}, arena, &err));
    json_t *values = review_page_values(&(ReviewPage){.review = review,
                                                      .pictures = &shown,
                                                      .picture_count = 1,
                                                      .pairs = pair,
                                                      .maps = &map,
                                                      .map_count = 1,
                                                      .calendars = &calendar,
                                                      .calendar_count = 1,
                                                      .sources = change,
                                                      .command = change,
                                                      .diff = &diff},
                                        0, &arena, why());
    json_t *record = review_json(review);
    remove(file);
    add_keys(own, record);
    json_decref(record);
    assert_non_null(values);
    return values;
}

/* Every name of a template has a value, and every value beyond review.json's a name. */
TEST(templates_and_values_know_the_same_names) {
    static const char *const PAGES[] = {"review.html", "summary.html", "cases.html"};
    json_t *keys = json_object(), *names = json_object(), *own = json_object(), *unused;
    json_t *values = all_values(own);
    const char *name;
    for (int i = 0; i < 3; i++) add_names(names, PAGES[i]);
    add_keys(keys, values);
    json_object_foreach(names, name, unused) if (!json_object_get(keys, name))
        fail_msg("no value is called %s", name);
    json_object_foreach(keys, name,
                        unused) if (!json_object_get(own, name) && !json_object_get(names, name))
        fail_msg("no template names %s", name);
    json_decref(keys);
    json_decref(names);
    json_decref(own);
    json_decref(values);
}

/* Of every age, with its doubt; who asked for none finds no word of it. */
TEST(a_card_tells_the_levels) {
    Review review = fixture_review(&arena);
    const char *plain = page_of(&(ReviewPage){.review = &review});
    assert_null(strstr(plain, "isibility level"));
    fixture_add_levels(&arena, &review);
    const char *page = page_of(&(ReviewPage){.review = &review});
    assert_well_formed(page);
    assert_non_null(strstr(page, "<dt>Visibility level at 50 years, the observer</dt>"));
    assert_non_null(strstr(page, "<dt>Visibility level at 70 years</dt><dd>3.0, 95 % "
                                 "interval 2.8 to 3.2; doubtful: a &lt;doubt&gt;"));
    assert_non_null(strstr(page, "one of its strokes, 2.25 arc minutes wide"));
}

TEST(a_page_of_nothing_says_so) {
    Review none = {.pass = true};
    const char *page = page_of(&(ReviewPage){.review = &none});
    assert_well_formed(page);
    assert_self_contained(page);
    assert_non_null(strstr(page, "<b>Passes</b>: nothing is required"));
    assert_non_null(strstr(page, "No limit applies"));
}

TEST(a_page_holds_every_case) {
    enum { CASES = 200 };
    Review one = fixture_review(&arena), many = one;
    many.cases = ARENA_NEW(&arena, ReviewCase, CASES);
    many.case_count = CASES;
    for (int i = 0; i < CASES; i++) {
        many.cases[i] = one.cases[i % 20];
        many.cases[i].condition = arena_format(&arena, "light %d", i / 5);
    }
    review_decide(&many);
    const char *page = page_of(&(ReviewPage){.review = &many});
    assert_well_formed(page);
    assert_self_contained(page);
    /* a sweep has a line of its own, and the card of its worst within */
    assert_int_equal(count_of(page, "<details class=\"case "), CASES + 2 * many.sweep_count);
    assert_true(strlen(page) < 2000000);
}

/* Every link to a card leads to one that is there, on this page or the other. */
static int check_links(const char *page, const char *other, const char *name) {
    const char *begin = arena_format(&arena, "<a href=\"%s#", name);
    int count = 0;
    for (const char *at = page; (at = strstr(at, begin)); count++) {
        at += strlen(begin);
        const char *id = arena_format(&arena, " id=\"%.*s\"", (int)strcspn(at, "\""), at);
        if (!strstr(other, id)) fail_msg("%s#%s leads nowhere", name, id);
    }
    return count;
}

static const char *summary_of(const Review *review, const char *symbol) {
    const char *path = fresh_name(".html");
    ReviewPage page = {.review = review};
    assert_done(review_page_write_summary(&page, symbol, path, &err));
    return taken(path);
}

TEST(many_cases_take_two_pages) {
    enum { CASES = 9, HERE = 4 };
    Review review = fixture_review(&arena), both;
    ReviewCase *cases = ARENA_NEW(&arena, ReviewCase, CASES);
    for (int i = 0; i < CASES; i++) {
        cases[i] = review.cases[i % review.case_count];
        cases[i].symbol = arena_format(&arena, "sign %d", i);
    }
    review.cases = cases;
    review.case_count = CASES;
    review.main_cards = HERE;
    both = review;
    both.is_beside = true;
    const char *page = page_of(&(ReviewPage){.review = &review});
    const char *rest = page_of(&(ReviewPage){.review = &both});
    int all = CASES + review.sweep_count, here = 0;
    assert_well_formed(page);
    assert_well_formed(rest);
    for (int i = 0; i < all; i++) {
        const ReviewCase *c = i < CASES ? &cases[i] : &review.sweeps[i - CASES].worst;
        const char *id = arena_format(&arena, " id=\"%s\"", review_card_id(&review, c, &arena));
        int found = count_of(page, id), beside = count_of(rest, id);
        assert_int_equal(found + beside, 1);
        assert_int_equal(found, review_card_is_here(&review, c, arena));
        here += found;
    }
    assert_int_equal(here, HERE);
    assert_true(check_links(page, page, "") > 0 && check_links(page, rest, "cases.html") > 0);
    check_links(rest, rest, "");
    check_links(rest, page, "index.html");
    for (int i = 0; i < CASES; i++) {
        const char *one = summary_of(&review, cases[i].symbol);
        assert_well_formed(one);
        assert_int_equal(check_links(one, page, "index.html") +
                             check_links(one, rest, "cases.html"),
                         7); /* the grid, the list, what it rests on */
        assert_non_null(strstr(one, cases[i].symbol));
        assert_null(strstr(one, cases[(i + 1) % CASES].symbol));
    }
}

/* What fails is open, what passes lies in a fold. */
TEST(sweeps_that_fail_come_first) {
    Review review = fixture_review(&arena);
    review.sweeps[0].failed_share = 0;
    review.sweeps[0].worst.verdict = VERDICT_PASS;
    const char *page = page_of(&(ReviewPage){.review = &review});
    const char *link = strstr(page, "Every sun, every hour");
    const char *fails = strstr(link, " open><summary><span class=\"chip bad\">");
    const char *fold = strstr(fails, "Passing: 1");
    assert_true(strstr(fails, " id=\"s1\"") < fold && strstr(page, " id=\"s0\"") > fold);
    review.sweeps[1].failed_share = 0;
    review.sweeps[1].worst.eye_failed_share = NAN; /* one eye */
    assert_string_equal(words_how_often(&review.sweeps[0], &arena), "never");
    assert_string_equal(words_how_often(&review.sweeps[1], &arena), "at its worst");
    review.sweeps[1].failed_share = 0.04;
    review.sweeps[1].longest_failure_minutes = 7;
    assert_string_equal(words_how_often(&review.sweeps[1], &arena),
                        "4.0 % of the time, 7 min at a stretch");
    review.sweeps[1].failed_minutes = 340;
    assert_string_equal(words_how_often(&review.sweeps[1], &arena),
                        "340 minutes a year, 7 min at a stretch");
    review.sweeps[1].headings = "heading 90°";
    assert_string_equal(words_how_often(&review.sweeps[1], &arena),
                        "340 minutes a year (heading 90°), 7 min at a stretch");
    assert_string_equal(words_sweep_colour(&review.sweeps[1]), "");
    review.sweeps[1].worst.colour_count = 1;
    assert_string_equal(words_sweep_colour(&review.sweeps[1]),
                        "; colour judged at their worst alone");
    review.sweeps[1].worst.colour_count = 0;
    review.sweeps[1].failed_minutes = review.sweeps[1].longest_failure_minutes = NAN;
    review.sweeps[1].cases = 175; /* directions alone */
    assert_string_equal(words_how_often(&review.sweeps[1], &arena),
                        "7 of 175 tested sun positions");
}

/* The share of eyes at the worst moment, and that of time of the middle one, each by its name;
 * no share stands without one. */
TEST(an_eye_box_names_whose_share_it_is) {
    static const struct {
        double eyes, failed, minutes, middle;
        const char *how_often;
    } BOX[] = {
        {0.44, 0.012, 30, 1.69,
         "44 % of eyes at its worst; middle eye: 1.2 % of the time, 30 min at a stretch, at its "
         "worst 1.69 : 1"},
        {0.44, 0, 0, 3.25,
         "44 % of eyes at its worst; middle eye: never, at its worst "
         "3.25 : 1"},
        {0.44, 0, 0, NAN, "44 % of eyes at its worst; middle eye: never"}, /* older */
        {1, 0.5, NAN, NAN,
         "100 % of eyes at its worst; middle eye: 17616 of 35232 tested sun positions"}};
    for (int i = 0; i < 4; i++) {
        Review review = fixture_review(&arena);
        ReviewSweep *s = &review.sweeps[0];
        s->worst.eye_failed_share = BOX[i].eyes;
        s->failed_share = BOX[i].failed;
        s->longest_failure_minutes = BOX[i].minutes;
        s->middle_contrast = BOX[i].middle;
        assert_string_equal(words_how_often(s, &arena), BOX[i].how_often);
        review.sweep_count = 1;
        const char *page = page_of(&(ReviewPage){.review = &review});
        const char *card = strstr(page, "<h2>Every sun, every hour");
        Text shown = {.arena = &arena};
        escape_markup(&shown, BOX[i].how_often);
        assert_non_null(strstr(card, shown.data));
    }
}

/* Top: the answer, the worst symbol, when, why; the limit that nobody read is marked. */
TEST(the_first_screen_says_it_all) {
    Review review = fixture_review(&arena);
    const ReviewCase *worst = review_worst(&review, arena);
    const char *page = page_of(&(ReviewPage){.review = &review});
    const char *line = strstr(page, "<h1>");
    Text text = {.arena = &arena};
    assert_non_null(line);
    text_add_bytes(&text, line, (size_t)(strstr(line, "</section>") - line));
    assert_int_equal(worst->verdict, VERDICT_FAIL);
    const char *parts[] = {
        "<b>Fails</b>", worst->symbol, worst->eye, worst->condition, words_judged(worst, &arena),
        "62 %",         "→ sky",       "✗",        "When",           "What to do"};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        if (!strstr(text.data, parts[i])) fail_msg("no %s in %s", parts[i], text.data);
    assert_int_equal(count_of(page, "not read in the standard"), 3); /* three limits */
}

TEST(the_worst_gaze_comes_first) {
    Review review = fixture_review(&arena);
    const char *page = page_of(&(ReviewPage){.review = &review});
    const char *worst = strstr(page, "Worst: driver, looking at road");
    assert_non_null(strstr(page, "Looking elsewhere"));
    assert_non_null(worst);
    const char *share = words_share(review.gazes[1].contrast_left, &arena);
    const char *told = strstr(worst, share);
    assert_true(told && told < strstr(worst, "</p>"));
    assert_true(strstr(worst, "sun 8° from the gaze") < strstr(worst, "sun 65° from the gaze"));
    assert_non_null(strstr(worst, "mostly the sun"));
    review.gaze_count = 0;
    assert_null(strstr(page_of(&(ReviewPage){.review = &review}), "Looking elsewhere"));
}

TEST(what_changed_is_on_the_page) {
    Review before = fixture_review(&arena), after = fixture_review(&arena);
    LimitVerdict limits[3];
    for (int i = 0; i < 3; i++) limits[i] = after.cases[3].limits[i];
    after.cases[3].contrast_ratio = 77.5;
    after.cases[3].contrast_low = after.cases[3].contrast_high = 77.5;
    limits[0].found = limits[0].low = limits[0].high = 77.5;
    after.cases[3].limits = limits;
    after.gazes[0].mirrored = 123;
    after.gazes[0].contrast_range = (MeanInterval){0, 0.1};
    ReviewDiff diff = review_diff(&before, &after, "old", "new", &arena);
    const char *page = page_of(&(ReviewPage){.review = &after, .diff = &diff});
    assert_non_null(strstr(page, "→ 77.5 : 1"));
    assert_non_null(strstr(page, "share of contrast left "));
    assert_non_null(strstr(page, "Before: old. Now: new."));
    assert_int_equal(count_of(page, ">better</span>"), 1);
}

TEST(a_page_that_cannot_be_written_is_an_error) {
    Review none = {0};
    assert_false(review_page_write(&(ReviewPage){.review = &none}, "/nowhere/at/all", why()));
    assert_int_equal(why()->code, ERROR_OUTPUT);
}

TEST_PROGRAM(page_begin, clear_folder)
