/* SPDX-License-Identifier: Apache-2.0 */
/* Where a content shows text. */
#include "symbol_fixture.h"

#include "review/symbol/text_find.h"

enum { MOST = 40 };

typedef struct Proposals {
    TextProposal *list;
    int count;
} Proposals;

static Proposals proposals_in(Easel *easel, const Image *content, const double uv[4], int most) {
    ContentLight light;
    Proposals found;
    assert_done(content_light(easel->panel, content, uv, &easel->arena, &light, &err));
    found.count = text_find(&light, most, &easel->arena, &found.list);
    return found;
}

static const double ALL[4] = {0, 0, 1, 1};

static Image content_of(Easel *easel, const char *name) {
    Image image;
    assert_done(image_read(arena_format(&easel->arena, PROJECT_DIR "/assets/content/%s", name),
                           &easel->arena, &image, &err));
    return image;
}

/* A proposal that holds the first box of pixels and stays within the second; its place in the
 * list, or -1. */
static int place_of(const Proposals *found, const Image *image, const double inner[4],
                    const double outer[4]) {
    for (int i = 0; i < found->count; i++) {
        const double *uv = found->list[i].uv;
        double box[4] = {uv[0] * image->width, uv[1] * image->height, uv[2] * image->width,
                         uv[3] * image->height};
        if (box[0] <= inner[0] && box[1] <= inner[1] && box[2] >= inner[2] && box[3] >= inner[3] &&
            box[0] >= outer[0] && box[1] >= outer[1] && box[2] <= outer[2] && box[3] <= outer[3])
            return i;
    }
    return -1;
}

/* ---- made texts -------------------------------------------------------------------------- */

/* Letters H of two posts and a bar: at x, y, of a height; as many as there is room for. */
static void add_word(Boxes *boxes, double x, double y, double height, int letters) {
    for (int i = 0; i < letters; i++) {
        double left = x + 0.9 * height * i, w = 0.15 * height;
        double parts[3][4] = {{left, y, left + w, y + height},
                              {left + 4 * w, y, left + 5 * w, y + height},
                              {left + w, y + 0.45 * height, left + 4 * w, y + 0.55 * height}};
        memcpy(boxes->box[boxes->count], parts, sizeof parts);
        boxes->count += 3;
    }
}

EASEL_TEST(words_are_proposed_tallest_first) {
    for (int polarity = 0; polarity < 2; polarity++) {
        Boxes boxes = {0};
        const double ink_ground[2][2] = {{0.8, 0.05}, {0.05, 0.8}};
        add_word(&boxes, 20, 30, 20, 2);
        add_word(&boxes, 120, 100, 40, 3);
        Image image = easel_draw(easel, 300, 200, ink_ground[polarity], boxes_coverage, &boxes);
        Proposals found = proposals_in(easel, &image, ALL, MOST);
        assert_int_equal(found.count, 2);
        const double tall[2][4] = {{120, 100, 222, 140}, {110, 90, 232, 150}};
        const double small[2][4] = {{20, 30, 53, 50}, {14, 24, 59, 56}};
        assert_int_equal(place_of(&found, &image, tall[0], tall[1]), 0);
        assert_int_equal(place_of(&found, &image, small[0], small[1]), 1);
        for (int i = 0; i < 2; i++) {
            assert_int_equal(found.list[i].characters, 3 - i);
            assert_int_equal(found.list[i].height_px, i ? 20 : 40);
            assert_true(found.list[i].is_light_on_dark == (polarity == 0));
        }
        assert_int_equal(proposals_in(easel, &image, ALL, 1).count, 1);
        easel->arena = easel->fresh;
    }
}

/* Of a rectangle the proposals lie in the whole content's uv. */
EASEL_TEST(a_rectangle_has_its_own_texts_alone) {
    Boxes boxes = {0};
    const double ink_ground[2] = {1, 0}, left_half[4] = {0, 0, 0.35, 1};
    add_word(&boxes, 20, 30, 20, 2);
    add_word(&boxes, 120, 100, 40, 3);
    Image image = easel_draw(easel, 300, 200, ink_ground, boxes_coverage, &boxes);
    Proposals found = proposals_in(easel, &image, left_half, MOST);
    assert_int_equal(found.count, 1);
    const double small[2][4] = {{20, 30, 53, 50}, {14, 24, 59, 56}};
    assert_int_equal(place_of(&found, &image, small[0], small[1]), 0);
}

static void add_frame(Boxes *boxes, double left, double top, double right, double bottom) {
    double bars[4][4] = {{left, top, right, top + 4},
                         {left, bottom - 4, right, bottom},
                         {left, top + 4, left + 4, bottom - 4},
                         {right - 4, top + 4, right, bottom - 4}};
    memcpy(boxes->box[boxes->count], bars, sizeof bars);
    boxes->count += 4;
}

/* Two buttons beside each other: their frames, and the grounds within, would be lines of two
 * large letters. */
EASEL_TEST(words_win_over_the_frames_about_them) {
    Boxes boxes = {0};
    const double ink_ground[2] = {1, 0};
    add_frame(&boxes, 40, 80, 190, 150);
    add_frame(&boxes, 200, 80, 350, 150);
    add_word(&boxes, 65, 100, 30, 4);
    add_word(&boxes, 225, 100, 30, 4);
    Image image = easel_draw(easel, 400, 260, ink_ground, boxes_coverage, &boxes);
    Proposals found = proposals_in(easel, &image, ALL, MOST);
    assert_int_equal(found.count, 2);
    for (int i = 0; i < 2; i++) {
        double x = 65 + 160 * i;
        const double word[2][4] = {{x, 100, x + 103, 130}, {x - 8, 92, x + 111, 138}};
        assert_int_equal(place_of(&found, &image, word[0], word[1]), i);
    }
}

EASEL_TEST(a_point_belongs_to_its_number) {
    Boxes boxes = {2, {{160, 134, 166, 140}, {250, 134, 256, 140}}}; /* near; far away */
    const double ink_ground[2] = {1, 0};
    add_word(&boxes, 80, 100, 40, 2);
    Image image = easel_draw(easel, 300, 200, ink_ground, boxes_coverage, &boxes);
    Proposals found = proposals_in(easel, &image, ALL, MOST);
    const double number[2][4] = {{80, 100, 166, 140}, {70, 90, 176, 150}};
    assert_int_equal(found.count, 1);
    assert_int_equal(found.list[0].characters, 2);
    assert_int_equal(place_of(&found, &image, number[0], number[1]), 0);
}

/* Two zeros of 24 x 40 with strokes of 8, on a ground that is darkest inside them. */
static double zeros(const void *drawing, int x, int y) {
    (void)drawing;
    int in_x = (x - 100) % 26, in_y = y - 80;
    if (x < 100 || x >= 152 || in_x >= 24 || in_y < 0 || in_y >= 40) return 0.01;
    return in_x >= 8 && in_x < 16 && in_y >= 8 && in_y < 32 ? 0 : 1;
}

EASEL_TEST(the_holes_of_letters_are_no_text) {
    const double ink_ground[2] = {1, 0};
    Image image = easel_draw(easel, 300, 200, ink_ground, zeros, NULL);
    Proposals found = proposals_in(easel, &image, ALL, MOST);
    assert_int_equal(found.count, 1);
    assert_true(found.list[0].is_light_on_dark);
    assert_int_equal(found.list[0].height_px, 40);
}

/* A word of 2 % of the light of the brightest thing there. */
static double faint(const void *drawing, int x, int y) {
    return x > 280 && y > 180 ? 1 : 0.02 * boxes_coverage(drawing, x, y);
}

/* A slope has no edges, one colour no parts. */
static double slope(const void *drawing, int x, int y) {
    (void)drawing;
    return (x + y) / 500.0;
}

static double nothing(const void *drawing, int x, int y) {
    (void)drawing;
    return 0 * (x + y);
}

EASEL_TEST(where_there_is_no_text_none_is_proposed) {
    const double ink_ground[2] = {1, 0};
    Image image = easel_draw(easel, 300, 200, ink_ground, slope, NULL);
    assert_int_equal(proposals_in(easel, &image, ALL, MOST).count, 0);
    Boxes boxes = {0};
    add_word(&boxes, 120, 100, 40, 3);
    image = easel_draw(easel, 300, 200, ink_ground, faint, &boxes);
    assert_int_equal(proposals_in(easel, &image, ALL, MOST).count, 0);
    image = easel_draw(easel, 300, 200, ink_ground, nothing, NULL);
    assert_int_equal(proposals_in(easel, &image, ALL, MOST).count, 0);
    assert_int_equal(proposals_in(easel, NULL, ALL, MOST).count, 0);
}

/* ---- shipped contents -------------------------------------------------------------------- */

/* Pixels of what the eye reads there; the proposal may be larger by the margin. */
typedef struct Readable {
    const char *content;
    double box[4];
    bool is_light_on_dark;
} Readable;

static const Readable READABLE[] = {
    {"cluster.png", {335, 312, 507, 420}, true},   /* 48, the speed */
    {"cluster.png", {1418, 318, 1548, 404}, true}, /* 78 */
    {"cluster.png", {399, 570, 443, 597}, false},  /* 50, black on the sign */
    {"cluster.png", {182, 641, 240, 663}, true},   /* ABS, dark grey */
    {"centre.png", {445, 909, 684, 968}, true},    /* 350 m */
    {"centre.png", {740, 1346, 860, 1376}, true},  /* AUTO, on blue */
    {"pfd.png", {347, 41, 493, 67}, true},         /* ALT CRZ, in a frame */
    {"pfd.png", {461, 375, 492, 398}, true},       /* 10, on the sky's slope */
    {"engine.png", {267, 212, 355, 243}, true},    /* 85.3 */
    {"engine.png", {53, 1065, 409, 1093}, true},   /* LDG LT RETRACTED */
};

EASEL_TEST(what_the_shipped_contents_say_is_proposed) {
    Image image = {0};
    Proposals found = {0};
    for (size_t i = 0; i < sizeof READABLE / sizeof *READABLE; i++) {
        const Readable *r = &READABLE[i];
        if (i == 0 || strcmp(r->content, r[-1].content) != 0) {
            easel->arena = easel->fresh;
            image = content_of(easel, r->content);
            found = proposals_in(easel, &image, ALL, MOST);
        }
        double more = 0.4 * (r->box[3] - r->box[1]);
        double outer[4] = {r->box[0] - more, r->box[1] - more, r->box[2] + more, r->box[3] + more};
        int at = place_of(&found, &image, r->box, outer);
        if (at < 0) fail_msg("%s: nothing at %g, %g", r->content, r->box[0], r->box[1]);
        assert_true(found.list[at].is_light_on_dark == r->is_light_on_dark);
    }
}

EASEL_TEST(the_same_content_gives_the_same_list) {
    Image image = content_of(easel, "cluster.png");
    Proposals a = proposals_in(easel, &image, ALL, MOST);
    Proposals b = proposals_in(easel, &image, ALL, MOST);
    assert_int_equal(a.count, b.count);
    for (int i = 0; i < a.count; i++)
        assert_memory_equal(a.list[i].uv, b.list[i].uv, sizeof a.list[i].uv);
    for (int i = 1; i < a.count; i++) assert_true(a.list[i].height_px <= a.list[i - 1].height_px);
}

TEST_PROGRAM(easel_open, easel_close)
