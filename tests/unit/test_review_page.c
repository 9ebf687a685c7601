/* SPDX-License-Identifier: Apache-2.0 */
/* The page of a review: well formed whatever the names are, nothing loaded from anywhere, and
 * drawings that say what the figures say. */
#include <ctype.h>
#include <string.h>

#include "image/plain/plain_png.h"
#include "review/output/review_bar.h"
#include "review/output/review_words.h"
#include "text/base64.h"
#include "review_page_fixture.h"

/* ---- well formed ------------------------------------------------------------------------ */

typedef struct Tag {
    char        name[24];
    bool        is_end, is_empty;
    const char *after;
} Tag;

/* Reads a tag at '<': a name, attributes name="value" without '<' in them, or '>' at once. */
static Tag read_tag(const char *at)
{
    static const char *const EMPTY[] = {"meta", "img", "br"};
    Tag    tag = {.is_end = at[1] == '/'};
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
static void assert_well_formed(const char *page)
{
    static Tag open[64];
    int        depth = 0;
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
static const char *value_at(const char *at)
{
    return arena_string(&arena, at, strcspn(at, "\""));
}

/* Pictures are data, links stay in the page and lead somewhere, ids are unique. */
static void assert_self_contained(const char *page)
{
    static const char *const NEVER[] = {"src=\"http", "href=\"http", "url(", "@import", "<link",
                                        "<iframe", "<base", "srcset"};
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
        assert_int_equal(count_of(page, arena_format(&arena, " id=\"%s\"", value_at(at + 5))),
                         1);
}

/* ---- pages ------------------------------------------------------------------------------ */

static const char *full_page(const Review *review)
{
    static const ReviewFact  FACTS[] = {{WILD_NAME, WILD_NAME}};
    static const char *const COMMANDS[] = {WILD_NAME, "parhelion review x.json -o y"};
    ReviewMap      map = fixture_map(&arena, &review->sweeps[0]);
    SunPath        path = fixture_path(&arena, WILD_NAME, 23.4);
    ReviewCalendar calendar = fixture_calendar(&arena, &review->sweeps[0]);
    Review         before = fixture_review(&arena);
    ReviewDiff     diff = review_diff(&before, review, WILD_NAME, "now", &arena);
    Picture        picture = picture_create(3, 2, &arena);
    ReviewPicture  shown = {.of = &review->cases[0], .title = WILD_NAME, .caption = WILD_NAME,
                            .picture = &picture};
    map.paths = &path;
    map.path_count = 1;
    calendar.clock = WILD_NAME;
    return page_of(&(ReviewPage){.review = review, .pictures = &shown, .picture_count = 1,
                                 .maps = &map, .map_count = 1, .calendars = &calendar,
                                 .calendar_count = 1, .facts = FACTS, .fact_count = 1,
                                 .commands = COMMANDS, .command_count = 2, .diff = &diff});
}

TEST(a_page_is_well_formed_whatever_the_names_are)
{
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

TEST(a_page_of_nothing_says_so)
{
    Review      none = {.pass = true};
    const char *page = page_of(&(ReviewPage){.review = &none});
    assert_well_formed(page);
    assert_self_contained(page);
    assert_non_null(strstr(page, "<b>Passes</b>: nothing is required"));
    assert_non_null(strstr(page, "No limit applies"));
}

TEST(a_page_holds_every_case)
{
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
static int check_links(const char *page, const char *other, const char *name)
{
    const char *begin = arena_format(&arena, "<a href=\"%s#", name);
    int         count = 0;
    for (const char *at = page; (at = strstr(at, begin)); count++) {
        at += strlen(begin);
        const char *id = arena_format(&arena, " id=\"%.*s\"", (int)strcspn(at, "\""), at);
        if (!strstr(other, id)) fail_msg("%s#%s leads nowhere", name, id);
    }
    return count;
}

static const char *summary_of(const Review *review, const char *symbol)
{
    const char *path = fresh_name(".html");
    ReviewPage  page = {.review = review};
    assert_done(review_page_write_summary(&page, symbol, path, &err));
    return taken(path);
}

TEST(many_cases_take_two_pages)
{
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
    int         all = CASES + review.sweep_count, here = 0;
    assert_well_formed(page);
    assert_well_formed(rest);
    for (int i = 0; i < all; i++) {
        const ReviewCase *c = i < CASES ? &cases[i] : &review.sweeps[i - CASES].worst;
        const char *id = arena_format(&arena, " id=\"%s\"", review_card_id(&review, c, &arena));
        int         found = count_of(page, id), beside = count_of(rest, id);
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
                             check_links(one, rest, "cases.html"), 2); /* the grid, the list */
        assert_non_null(strstr(one, cases[i].symbol));
        assert_null(strstr(one, cases[(i + 1) % CASES].symbol));
    }
}

/* Behind a table that leads to each. What fails is open, what passes lies in a fold. */
TEST(sweeps_that_fail_come_first)
{
    Review review = fixture_review(&arena);
    review.sweeps[0].failed_share = 0;
    review.sweeps[0].worst.verdict = VERDICT_PASS;
    const char *page = page_of(&(ReviewPage){.review = &review});
    const char *link = strstr(strstr(page, "Every sun, every hour"), "<a href=\"#s0\"");
    const char *fails = strstr(link, " open><summary><span class=\"chip bad\">");
    const char *fold = strstr(fails, "1 that passes");
    assert_true(strstr(fails, " id=\"s1\"") < fold && strstr(page, " id=\"s0\"") > fold);
    review.sweeps[1].failed_share = 0;
    review.sweeps[1].worst.eye_failed_share = NAN; /* one eye */
    assert_string_equal(words_often(&review.sweeps[0], &arena), "never");
    assert_string_equal(words_often(&review.sweeps[1], &arena), "at worst");
    review.sweeps[1].failed_share = 0.04;
    review.sweeps[1].longest_failure_minutes = 7;
    assert_string_equal(words_how_often(&review.sweeps[1], &arena), "4.0 % of the time");
    review.sweeps[1].longest_failure_minutes = NAN; /* directions alone */
    assert_string_equal(words_how_often(&review.sweeps[1], &arena),
                        "4.0 % of the sun's directions");
}

/* The share of eyes at the worst moment, and that of time of the middle one, each by its name;
 * no share stands without one. */
TEST(an_eye_box_names_whose_share_it_is)
{
    static const struct {
        double eyes, failed, minutes, middle;
        const char *often, *how_often;
    } BOX[] = {
        {0.44, 0.012, 30, 1.69, "44 % of eyes",
         "44 % of eyes at its worst, the middle eye 1.2 % of the time, at its own worst "
         "1.69 : 1"},
        {0.44, 0, 0, 3.25, "44 % of eyes",
         "44 % of eyes at its worst, the middle eye never, at its own worst 3.25 : 1"},
        {0.44, 0, 0, NAN, "44 % of eyes", /* of an older review */
         "44 % of eyes at its worst, the middle eye never"},
        {1, 0.5, NAN, NAN, "100 % of eyes",
         "100 % of eyes at its worst, the middle eye 50 % of the sun's directions"}};
    for (int i = 0; i < 4; i++) {
        Review       review = fixture_review(&arena);
        ReviewSweep *s = &review.sweeps[0];
        s->worst.eye_failed_share = BOX[i].eyes;
        s->failed_share = BOX[i].failed;
        s->longest_failure_minutes = BOX[i].minutes;
        s->middle_contrast = BOX[i].middle;
        assert_string_equal(words_often(s, &arena), BOX[i].often);
        assert_string_equal(words_how_often(s, &arena), BOX[i].how_often);
        review.sweep_count = 1;
        const char *page = page_of(&(ReviewPage){.review = &review});
        const char *card = strstr(page, "<h2>Every sun, every hour");
        assert_non_null(strstr(card, BOX[i].how_often));
        assert_non_null(strstr(card, "of eyes fail at its worst"));
        assert_non_null(strstr(card, "the middle eye fails"));
        bool tells_worst = strstr(card, "of the middle eye at its own worst") != NULL;
        assert_true(tells_worst == !isnan(BOX[i].middle));
        assert_null(strstr(card, "of the time it fails"));
        assert_null(strstr(card, "directions it fails"));
    }
}

/* Top: the answer, the worst symbol, when, why; the limit that nobody read is marked. */
TEST(the_first_screen_says_it_all)
{
    Review            review = fixture_review(&arena);
    const ReviewCase *worst = review_worst(&review, arena);
    const char       *page = page_of(&(ReviewPage){.review = &review});
    const char       *line = strstr(page, "<h1>");
    Text              text = {.arena = &arena};
    assert_non_null(line);
    text_add_bytes(&text, line, (size_t)(strstr(line, "</section>") - line));
    assert_int_equal(worst->verdict, VERDICT_FAIL);
    const char *parts[] = {"<b>Fails</b>", worst->symbol, worst->eye, worst->condition,
                           words_judged(worst, &arena), "62 %", "→ sky",
                           "✗", "When", "Remedy"};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        if (!strstr(text.data, parts[i])) fail_msg("no %s in %s", parts[i], text.data);
    assert_int_equal(count_of(page, "not read in the standard"), 3); /* three limits */
}

TEST(the_worst_gaze_comes_first)
{
    Review      review = fixture_review(&arena);
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

TEST(what_changed_is_on_the_page)
{
    Review     before = fixture_review(&arena), after = fixture_review(&arena);
    LimitVerdict limits[3];
    for (int i = 0; i < 3; i++) limits[i] = after.cases[3].limits[i];
    after.cases[3].contrast_ratio = 77.5;
    after.cases[3].contrast_low = after.cases[3].contrast_high = 77.5;
    limits[0].found = limits[0].low = limits[0].high = 77.5;
    after.cases[3].limits = limits;
    after.gazes[0].mirrored = 123;
    after.gazes[0].contrast_range = (MeanInterval){0, 0.1};
    ReviewDiff  diff = review_diff(&before, &after, "old", "new", &arena);
    const char *page = page_of(&(ReviewPage){.review = &after, .diff = &diff});
    assert_non_null(strstr(page, "→ 77.5 : 1"));
    assert_non_null(strstr(page, "310 → 123"));
    assert_non_null(strstr(page, "Before: old. Now: new."));
    assert_int_equal(count_of(page, "more contrast"), 1);
}

TEST(a_page_that_cannot_be_written_is_an_error)
{
    Review none = {0};
    assert_false(review_page_write(&(ReviewPage){.review = &none}, "/nowhere/at/all", why()));
    assert_int_equal(why()->code, ERROR_OUTPUT);
}

/* ---- drawings --------------------------------------------------------------------------- */

/* The number behind `name` in the first element of the class. */
static double attribute_of(const char *svg, const char *class, const char *name)
{
    const char *at = strstr(svg, arena_format(&arena, "class=\"%s\"", class));
    at = at ? strstr(at, arena_format(&arena, " %s=\"", name)) : NULL;
    assert_non_null(at);
    return strtod(strchr(at, '"') + 1, NULL);
}

/* The bright part's bar ends beyond the mark exactly where the contrast keeps the limit: the
 * end over the mark is the contrast over the limit. */
TEST(the_bright_bar_reaches_the_mark_when_contrast_does)
{
    Review review = fixture_review(&arena);
    for (int i = 0; i < 20; i++) {
        Text              html = {.arena = &arena};
        const ReviewCase *c = &review.cases[i];
        review_bar_add_luminances(&html, c, &arena);
        double end = attribute_of(html.data, "emit", "x") +
                     attribute_of(html.data, "emit", "width");
        double mark = attribute_of(html.data, "mark", "x");
        assert_close(end / mark, c->contrast_ratio / c->limits[0].value, 2e-3);
    }
}

TEST(the_mark_follows_the_kind_of_the_limit)
{
    static const struct { const char *kind, *words; double found, value, ratio; } FORMS[] = {
        {"contrast_ratio", "2 : 1", 3, 2, 2},
        {"luminance_contrast", "luminance contrast 1.5", 2, 1.5, 2.5},
        {"modulation", "modulation 0.6", 0.5, 0.6, 4},
        {"contrast_ratio", "2 : 1", 2.5, 2, 2}}; /* the last with the veil */
    for (int i = 0; i < 4; i++) {
        LimitVerdict limit = {.kind = FORMS[i].kind, .value = FORMS[i].value,
                              .found = FORMS[i].found};
        ReviewCase   c = {.luminance_cd_m2 = {300, 0, 100, 60, 40, 100.0 / 3},
                          .contrast_ratio = i < 3 ? 3 : 4, .contrast_with_veil = 2.5,
                          .limits = &limit, .limit_count = 1, .limit_id = 0};
        Text         html = {.arena = &arena};
        c.luminance_cd_m2.foreground = i < 3 ? 200 : 300;
        review_bar_add_luminances(&html, &c, &arena);
        assert_non_null(strstr(html.data, arena_format(&arena, ">%s needs", FORMS[i].words)));
        double dark = 100 + (i == 3 ? 100.0 / 3 : 0);
        double most = dark + c.luminance_cd_m2.foreground;
        most = fmax(most, 1.02 * FORMS[i].ratio * dark);
        double mark = attribute_of(html.data, "mark", "x") / 100;
        assert_near(mark, FORMS[i].ratio * dark / most, 2e-3);
    }
}

/* Where the upper bar ends, of the scale's 100. */
static double bright_end(const char *svg)
{
    double end = 0;
    for (const char *at = svg; (at = strstr(at, " y=\"18\" width=\"")); at++)
        end += strtod(at + 15, NULL);
    return end;
}

/* Whatever veil lies over it, and however its two reflections were estimated: the bright bar is
 * as far beyond the mark as the judged contrast is beyond its limit. */
TEST(no_bar_passes_its_mark_under_a_fail)
{
    static const double VEILS[] = {0, 5, 80, 1000}, LIMITS[] = {1.5, 2, 3, 10};
    for (int i = 0; i < 32; i++) {
        double veil = VEILS[i % 4], value = LIMITS[i / 4 % 4], added = 100 + veil * (i / 16);
        ReviewCase   c = {.luminance_cd_m2 = {91, 2, 100, 55, 35, veil},
                          .contrast_ratio = 191 / 102.0,
                          .contrast_with_veil = (191 + veil) / (102 + veil),
                          .limit_count = 1};
        LimitVerdict limit = {.kind = "contrast_ratio", .unit = "1", .value = value,
                              .found = (91 + added) / (2 + added)};
        Text         html = {.arena = &arena};
        c.limits = &limit;
        review_bar_add_luminances(&html, &c, &arena);
        assert_close(bright_end(html.data) / attribute_of(html.data, "mark", "x"),
                     limit.found / value, 1e-4);
        bool is_told = strstr(html.data, "in the eye, not in this contrast") != NULL;
        assert_int_equal(is_told, i < 16 || veil == 0);
    }
}

/* From full wash-out at the left end, by the logarithm of the contrast. */
TEST(margins_have_one_scale)
{
    static const double MARGINS[] = {1.5, 1, 0.5, 0, -0.5, -1};
    static const double PLACES[] = {88, 88, 66, 44, 22, 0};
    for (int i = 0; i < 6; i++) {
        double       found = pow(2, 1 + MARGINS[i]);
        LimitVerdict limit = {.kind = "contrast_ratio", .value = 2, .found = found,
                              .low = found, .high = found,
                              .margin = MARGINS[i],
                              .verdict = MARGINS[i] < 0 ? VERDICT_FAIL : VERDICT_PASS};
        const char  *class = MARGINS[i] < 0 ? "bad" : "good";
        Text         html = {.arena = &arena};
        review_bar_add_margin(&html, &limit);
        double x = attribute_of(html.data, class, "x"), width = attribute_of(html.data, class,
                                                                             "width");
        assert_near(MARGINS[i] < 0 ? x : x + width, PLACES[i], 0.06);
    }
}

/* One failing cell of three by three has a border of four edges; a failing corner too, for
 * nothing fails outside. */
TEST(the_border_encloses_what_fails)
{
    static const struct { int cell; const char *path; } CASES[] = {
        {4, "d=\"M1 2H2M1 1H2M1 2V1M2 2V1\""}, {0, "d=\"M0 3H1M0 2H1M0 3V2M1 3V2\""}};
    static const float contrast[9] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
    for (int i = 0; i < 2; i++) {
        unsigned char verdict[9] = {0};
        Text          html = {.arena = &arena};
        verdict[CASES[i].cell] = VERDICT_FAIL;
        ReviewMap map = {.azimuth_deg = {0, 10, 3}, .elevation_deg = {0, 10, 3},
                         .contrast = contrast, .margin = contrast, .verdict = verdict};
        ENDS_BY(arena_release) Arena more = arena_reserve((size_t)1 << 24);
        assert_done(review_map_add(&html, &map, &more, &err));
        if (!strstr(html.data, CASES[i].path)) fail_msg("%s", strstr(html.data, "border"));
    }
}

typedef struct Cells {
    PlainPng             png;
    const unsigned char *rows;
} Cells;

static Cells cells_of(const char *html)
{
    Cells          out;
    size_t         size = 0;
    const char    *text = value_at(strstr(html, "base64,") + 7);
    unsigned char *bytes = ARENA_NEW(&arena, unsigned char, strlen(text)), *rows;
    assert_done(base64_decode(text, strlen(text), bytes, &size, &err));
    assert_true(plain_png_open(bytes, size, &out.png));
    rows = ARENA_NEW(&arena, unsigned char, 4 * (size_t)out.png.width * (size_t)out.png.height);
    assert_true(plain_png_read(&out.png, rows));
    out.rows = rows;
    return out;
}

/* What fails is red, all else is not. */
static void assert_red_at(const Cells *cells, int column, int row)
{
    for (int y = 0; y < cells->png.height; y++)
        for (int x = 0; x < cells->png.width; x++) {
            const unsigned char *c = cells->rows + 4 * (y * cells->png.width + x);
            assert_int_equal(c[0] > c[2], x == column && y == row);
        }
}

/* Azimuths run to the right and elevations upwards; days to the right and hours upwards. */
TEST(cells_lie_where_their_axes_say)
{
    float         ratio[12], share[12];
    unsigned char verdict[12] = {0};
    Text          html = {.arena = &arena}, more = {.arena = &arena};
    ENDS_BY(arena_release) Arena scratch = arena_reserve((size_t)1 << 24);
    for (int i = 0; i < 12; i++) ratio[i] = 1, share[i] = 0;
    verdict[11] = VERDICT_FAIL; /* azimuth 3, elevation 2 of 4 x 3 */
    share[7] = 1;               /* day 1, step 3 of 3 x 4 */
    assert_done(review_map_add(&html, &(ReviewMap){.azimuth_deg = {0, 1, 4}, .elevation_deg =
                                                   {0, 1, 3}, .contrast = ratio, .margin =
                                                   ratio, .verdict = verdict}, &scratch,
                               &err));
    assert_done(review_map_add_calendar(&more, &(ReviewCalendar){.year = 2026, .days = 3,
                                                                 .steps_a_day = 4, .clock =
                                                                 "UTC", .headings = 1,
                                                                 .failed_share = share},
                                        &scratch, &err));
    Cells map = cells_of(html.data), calendar = cells_of(more.data);
    assert_int_equal(map.png.width * 100 + map.png.height, 403);
    assert_int_equal(calendar.png.width * 100 + calendar.png.height, 304);
    assert_red_at(&map, 3, 0);
    assert_red_at(&calendar, 1, 0);
}

/* The bytes of the first data-values behind `at`: 16 bits a cell, low byte first. */
static const unsigned char *values_behind(const char *at, size_t cells)
{
    size_t         size = 0;
    const char    *text = value_at(strstr(at, "data-values=\"") + 13);
    unsigned char *bytes = ARENA_NEW(&arena, unsigned char, strlen(text));
    assert_done(base64_decode(text, strlen(text), bytes, &size, &err));
    assert_int_equal(size, 2 * cells);
    return bytes;
}

/* A year's map says whose answer stands between its steps, and an eye box's whose eye it is;
 * a map of directions says neither. */
TEST(a_map_says_what_its_cells_are)
{
    Review review = fixture_review(&arena);
    for (int i = 0; i < 4; i++) {
        Text      html = {.arena = &arena};
        ReviewMap map = fixture_map(&arena, &review.sweeps[0]);
        ENDS_BY(arena_release) Arena scratch = arena_reserve((size_t)1 << 26);
        map.is_between_steps = i & 1;
        review.sweeps[0].worst.eye_failed_share = i & 2 ? 0.25 : (double)NAN;
        assert_done(review_map_add(&html, &map, &scratch, &err));
        assert_int_equal(strstr(html.data, "the nearer one&#39;s answer is shown") != NULL,
                         i & 1);
        assert_int_equal(strstr(html.data, "As the middle eye of the box sees it") != NULL,
                         i / 2);
    }
}

/* What script tells at the pointer is the map's contrast within 0.06 %, and its verdict. */
TEST(the_pointer_reads_what_the_map_shows)
{
    ReviewMap      map = fixture_map(&arena, NULL);
    ReviewCalendar calendar = fixture_calendar(&arena, NULL);
    Text           html = {.arena = &arena}, more = {.arena = &arena};
    int            cells = map.azimuth_deg.count * map.elevation_deg.count;
    ENDS_BY(arena_release) Arena scratch = arena_reserve((size_t)1 << 26);
    assert_done(review_map_add(&html, &map, &scratch, &err));
    assert_done(review_map_add_calendar(&more, &calendar, &scratch, &err));
    const unsigned char *v = values_behind(html.data, (size_t)cells);
    for (int i = 0; i < cells; i++) {
        unsigned code = v[2 * i] + 256u * v[2 * i + 1];
        if (isnan(map.contrast[i])) assert_int_equal(code, 0);
        else assert_int_equal(code >> 14, map.verdict[i]);
        if (!isnan(map.contrast[i]))
            assert_close(pow(1e4, ((code & 16383) - 1) / 16382.0), map.contrast[i], 6e-4);
    }
    v = values_behind(more.data, 365 * 24);
    for (int day = 0; day < 365; day++)
        for (int step = 0; step < 24; step++) {
            unsigned code = v[2 * (step * 365 + day)] + 256u * v[2 * (step * 365 + day) + 1];
            float    share = calendar.failed_share[day * 24 + step];
            if (isnan(share)) assert_int_equal(code, 0);
            else assert_near((code - 1) / 1e4, share, 1e-4);
        }
}

TEST_PROGRAM(page_begin, clear_folder)
