/* SPDX-License-Identifier: Apache-2.0 */
/* Drawings of a review's page say what the figures say: bars, maps, calendars. */
#include <string.h>
#include <zlib.h>

#include "image/plain/plain_png.h"
#include "page/page.h"
#include "review/output/review_map.h"
#include "review/output/review_words.h"
#include "text/base64.h"
#include "review_page_fixture.h"

/* The value of an attribute at `at`, behind its quote. */
static const char *value_at(const char *at) {
    return arena_string(&arena, at, strcspn(at, "\""));
}

/* ---- drawings --------------------------------------------------------------------------- */

/* The number behind `name` in the first element of the class. */
static double attribute_of(const char *svg, const char *class, const char *name) {
    const char *at = strstr(svg, arena_format(&arena, "class=\"%s\"", class));
    at = at ? strstr(at, arena_format(&arena, " %s=\"", name)) : NULL;
    assert_non_null(at);
    return strtod(strchr(at, '"') + 1, NULL);
}

/* The bright part's bar ends beyond the mark exactly where the contrast keeps the limit: the
 * end over the mark is the contrast over the limit. */
TEST(the_bright_bar_reaches_the_mark_when_contrast_does) {
    Review review = fixture_review(&arena);
    for (int i = 0; i < 20; i++) {
        bool has_veil;
        const ReviewCase *c = &review.cases[i];
        const char *svg = review_bar_luminances(c, &has_veil, &arena);
        double end = attribute_of(svg, "emit", "x") + attribute_of(svg, "emit", "width");
        double mark = attribute_of(svg, "mark", "x");
        assert_close(end / mark, c->contrast_ratio / c->limits[0].value, 2e-3);
    }
}

TEST(the_mark_follows_the_kind_of_the_limit) {
    static const struct {
        const char *kind, *words;
        double found, value, ratio;
    } FORMS[] = {{"contrast_ratio", "minimum 2 : 1", 3, 2, 2},
                 {"luminance_contrast", "luminance contrast minimum 1.5", 2, 1.5, 2.5},
                 {"modulation", "modulation minimum 0.6", 0.5, 0.6, 4},
                 {"contrast_ratio", "minimum 2 : 1", 2.5, 2, 2}}; /* the last with the veil */
    for (int i = 0; i < 4; i++) {
        LimitVerdict limit = {.kind = FORMS[i].kind,
                              .value = FORMS[i].value,
                              .found = FORMS[i].found,
                              .has_veil = i == 3};
        ReviewCase c = {.luminance_cd_m2 = {300, 0, 100, 60, 40, 100.0 / 3},
                        .contrast_ratio = i < 3 ? 3 : 4,
                        .contrast_with_veil = 2.5,
                        .limits = &limit,
                        .limit_count = 1,
                        .limit_id = 0};
        bool has_veil;
        c.luminance_cd_m2.foreground = i < 3 ? 200 : 300;
        const char *svg = review_bar_luminances(&c, &has_veil, &arena);
        assert_non_null(strstr(svg, arena_format(&arena, ">%s<", FORMS[i].words)));
        double dark = 100 + (i == 3 ? 100.0 / 3 : 0);
        double most = dark + c.luminance_cd_m2.foreground;
        most = fmax(most, 1.02 * FORMS[i].ratio * dark);
        double mark = attribute_of(svg, "mark", "x") / 100;
        assert_near(mark, FORMS[i].ratio * dark / most, 2e-3);
    }
}

/* Where the upper bar ends, of the scale's 100. */
static double bright_end(const char *svg) {
    double end = 0;
    for (const char *at = svg; (at = strstr(at, " y=\"18\" width=\"")); at++)
        end += strtod(at + 15, NULL);
    return end;
}

/* Whatever veil lies over it, and however its two reflections were estimated: the bright bar is
 * as far beyond the mark as the judged contrast is beyond its limit. */
TEST(no_bar_passes_its_mark_under_a_fail) {
    static const double VEILS[] = {0, 5, 80, 1000}, LIMITS[] = {1.5, 2, 3, 10};
    for (int i = 0; i < 32; i++) {
        double veil = VEILS[i % 4], value = LIMITS[i / 4 % 4], added = 100 + veil * (i / 16);
        ReviewCase c = {.luminance_cd_m2 = {91, 2, 100, 55, 35, veil},
                        .contrast_ratio = 191 / 102.0,
                        .contrast_with_veil = (191 + veil) / (102 + veil),
                        .limit_count = 1};
        LimitVerdict limit = {.kind = "contrast_ratio",
                              .unit = "1",
                              .value = value,
                              .found = (91 + added) / (2 + added),
                              .has_veil = i >= 16 && veil > 0};
        bool has_veil;
        c.limits = &limit;
        const char *svg = review_bar_luminances(&c, &has_veil, &arena);
        assert_close(bright_end(svg) / attribute_of(svg, "mark", "x"), limit.found / value, 1e-4);
        assert_int_equal(has_veil, i >= 16 && veil > 0);
    }
}

/* From full wash-out at the left end, by the logarithm of the contrast. */
TEST(margins_have_one_scale) {
    static const double MARGINS[] = {1.5, 1, 0.5, 0, -0.5, -1};
    static const double PLACES[] = {88, 88, 66, 44, 22, 0};
    for (int i = 0; i < 6; i++) {
        double found = pow(2, 1 + MARGINS[i]);
        LimitVerdict limit = {.kind = "contrast_ratio",
                              .value = 2,
                              .found = found,
                              .low = found,
                              .high = found,
                              .margin = MARGINS[i],
                              .verdict = MARGINS[i] < 0 ? VERDICT_FAIL : VERDICT_PASS};
        const char *class = MARGINS[i] < 0 ? "bad" : "good";
        const char *svg = review_bar_margin(&limit, &arena);
        double x = attribute_of(svg, class, "x");
        double width = attribute_of(svg, class, "width");
        assert_near(MARGINS[i] < 0 ? x : x + width, PLACES[i], 0.06);
    }
}

static const char *html_of(const char *template, json_t *values) {
    Text html = {.arena = &arena};
    ENDS_BY(arena_release) Arena scratch = arena_reserve(1 << 20);
    assert_non_null(values);
    assert_done(page_render(&html, template, values, NULL, scratch, &err));
    json_decref(values);
    return html.data;
}

static const char *map_of(const ReviewMap *map) {
    ENDS_BY(arena_release) Arena scratch = arena_reserve((size_t)1 << 26);
    return html_of("map.html", review_map_values(map, true, scratch, why()));
}

static const char *calendar_of(const ReviewCalendar *calendar) {
    ENDS_BY(arena_release) Arena scratch = arena_reserve((size_t)1 << 26);
    return html_of("calendar.html", review_calendar_values(calendar, scratch, why()));
}

/* One failing cell of three by three has a border of four edges; a failing corner too, for
 * nothing fails outside. */
TEST(the_border_encloses_what_fails) {
    static const struct {
        int cell;
        const char *path;
    } CASES[] = {{4, "d=\"M1 2H2M1 1H2M1 2V1M2 2V1\""}, {0, "d=\"M0 3H1M0 2H1M0 3V2M1 3V2\""}};
    for (int i = 0; i < 2; i++) {
        ReviewStep cells[9] = {0};
        cells[CASES[i].cell].verdict = VERDICT_FAIL;
        ReviewMap map = {.azimuth_deg = {0, 10, 3}, .elevation_deg = {0, 10, 3}, .cells = cells};
        const char *html = map_of(&map);
        if (!strstr(html, CASES[i].path)) fail_msg("%s", strstr(html, "border"));
    }
}

typedef struct Cells {
    PlainPng png;
    const unsigned char *rows;
} Cells;

static Cells cells_of(const char *html) {
    Cells out;
    size_t size = 0;
    const char *text = value_at(strstr(html, "base64,") + 7);
    unsigned char *bytes = ARENA_NEW(&arena, unsigned char, strlen(text)), *rows;
    assert_done(base64_decode(text, strlen(text), bytes, &size, &err));
    assert_true(plain_png_open(bytes, size, &out.png));
    rows = ARENA_NEW(&arena, unsigned char, 4 * (size_t)out.png.width * (size_t)out.png.height);
    assert_true(plain_png_read(&out.png, rows));
    out.rows = rows;
    return out;
}

/* What fails is red, all else is not. */
static void assert_red_at(const Cells *cells, int column, int row) {
    for (int y = 0; y < cells->png.height; y++)
        for (int x = 0; x < cells->png.width; x++) {
            const unsigned char *c = cells->rows + 4 * (y * cells->png.width + x);
            assert_int_equal(c[0] > c[2], x == column && y == row);
        }
}

/* Azimuths run to the right and elevations upwards; days to the right and hours upwards. */
TEST(cells_lie_where_their_axes_say) {
    int failing[12] = {0};
    ReviewStep steps[12] = {0};
    steps[11].verdict = VERDICT_FAIL; /* azimuth 3, elevation 2 of 4 x 3 */
    failing[7] = 1;                   /* day 1, step 3 of 3 x 4 */
    Cells map = cells_of(
        map_of(&(ReviewMap){.azimuth_deg = {0, 1, 4}, .elevation_deg = {0, 1, 3}, .cells = steps}));
    Cells calendar = cells_of(calendar_of(&(ReviewCalendar){
        .year = 2026, .days = 3, .steps_a_day = 4, .headings = 1, .failing = failing}));
    assert_int_equal(map.png.width * 100 + map.png.height, 403);
    assert_int_equal(calendar.png.width * 100 + calendar.png.height, 304);
    assert_red_at(&map, 3, 0);
    assert_red_at(&calendar, 1, 0);
}

/* A year's map says whose answer stands between its steps, and an eye box's whose eye it is;
 * a map of directions says neither. */
TEST(a_map_says_what_its_cells_are) {
    Review review = fixture_review(&arena);
    for (int i = 0; i < 4; i++) {
        ReviewMap map = fixture_map(&arena, &review.sweeps[0]);
        map.is_between_steps = i & 1;
        review.sweeps[0].worst.eye_failed_share = i & 2 ? 0.25 : (double)NAN;
        const char *html = map_of(&map);
        assert_int_equal(strstr(html, "the nearer one's answer is shown") != NULL, i & 1);
        assert_int_equal(strstr(html, "As the middle eye of the box sees it") != NULL, i / 2);
    }
}

/* What the script gets, unpacked as it does it. */
static json_t *values_of(const char *html) {
    enum { ROOM = 1 << 23 };
    size_t size = 0;
    uLong room = ROOM;
    const char *text = value_at(strstr(html, "data-values=\"") + 13);
    unsigned char *packed = ARENA_NEW(&arena, unsigned char, strlen(text));
    unsigned char *bytes = ARENA_NEW(&arena, unsigned char, ROOM);
    assert_done(base64_decode(text, strlen(text), packed, &size, &err));
    assert_int_equal(uncompress(bytes, &room, packed, (uLong)size), Z_OK);
    json_t *values = json_loadb((const char *)bytes, room, 0, NULL);
    assert_non_null(values);
    return values;
}

static void assert_cell(const json_t *values, const char *list, int cell, const char *words) {
    const char *found =
        json_string_value(json_array_get(json_object_get(values, list), (size_t)cell));
    if (words) assert_string_equal(found, words);
    else assert_null(found);
}

/* The row of each cell's step, in the words of all else; of what was not evaluated none. */
TEST(the_pointer_reads_what_was_judged) {
    ReviewMap map = fixture_map(&arena, NULL);
    json_auto_t *v = values_of(map_of(&map));
    for (int i = 0; i < map.azimuth_deg.count * map.elevation_deg.count; i++) {
        const ReviewStep *s = &map.cells[i];
        bool is_known = !isnan(s->contrast);
        assert_cell(v, "verdict", i, is_known ? words_verdict(s->verdict) : NULL);
        assert_cell(v, "contrast", i,
                    is_known ? words_within(s->contrast, s->low, s->high, &arena) : NULL);
        assert_cell(v, "margin", i, is_known ? words_margin(s->margin, &arena) : NULL);
        assert_cell(v, "lux", i, is_known ? words_figure(s->lux, &arena) : NULL);
        assert_cell(v, "when", i, NULL);
    }
    ReviewCalendar calendar = fixture_calendar(&arena, NULL);
    json_auto_t *said = values_of(calendar_of(&calendar));
    assert_int_equal(json_array_size(said), 365 * 24);
    for (int day = 0; day < 365; day++)
        for (int step = 0; step < 24; step++) {
            const json_t *found = json_array_get(said, (size_t)(step * 365 + day));
            int failing = calendar.failing[day * 24 + step];
            if (failing < 0) assert_true(json_is_null(found));
            else assert_int_equal(json_integer_value(found), failing);
        }
}

TEST_PROGRAM(page_begin, clear_folder)
