/* SPDX-License-Identifier: Apache-2.0 */
/* What the program keeps for itself of a review: every member that a row has, to the last bit. */
#include "fixture.h"

#include <jansson.h>
#include <math.h>

#include "base/count.h"
#include "record/record_write.h"
#include "review/output/review_json.h"

static uint64_t luck;

static uint32_t draw(void) {
    luck = luck * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(luck >> 33);
}

static double draw_figure(const RecordRow *row) {
    const double special[] = {INFINITY, -INFINITY, (double)NAN, 0, -0.0, 5e-324, 0.1, 1e300};
    uint32_t i = draw() % 32;
    bool is_special = i < COUNT_OF(special) && row->high == HUGE_VAL && row->flags & RECORD_NULL;
    return is_special ? special[i] : row->low > 0 ? row->low : (double)draw() * 1.23456789e-7;
}

static const char *draw_text(bool may_be_null) {
    static const char *const texts[] = {NULL,  "", "inf", "n\xc3\xa4her", "no UTF-8 \xff\xfe",
                                        "\n\""};
    uint32_t i = draw() % COUNT_OF(texts);
    return i || may_be_null ? texts[i] : "a";
}

static void put(void *at, const void *value, size_t size) {
    memcpy(at, value, size);
}

static void fill(const RecordFormat *format, void *item, Arena *arena);

static void fill_numbers(const RecordRow *row, void *at, int count) {
    for (int i = 0; i < count; i++)
        if (row->flags & RECORD_FLOAT) ((float *)at)[i] = (float)draw() / 7;
        else ((double *)at)[i] = draw_figure(row);
}

static void fill_pointer(const RecordRow *row, char *item, Arena *arena) {
    int count = row->count ? (int)(draw() % 3) : row->most;
    void *list = NULL;
    if (row->kind == RECORD_FIGURES)
        fill_numbers(row, list = ARENA_NEW(arena, double, count), count);
    if (row->kind == RECORD_FLOATS) {
        float *floats = list = ARENA_NEW(arena, float, count * row->most);
        for (int i = 0; i < count * row->most; i++) floats[i] = (float)draw() / 7;
    }
    if (row->kind == RECORD_TEXTS) {
        const char **texts = list = ARENA_NEW(arena, const char *, count);
        for (int i = 0; i < count; i++) texts[i] = draw_text(false);
    }
    if (row->kind == RECORD_LIST) {
        char *items = list = arena_alloc(arena, row->of->size, 16, (size_t)count);
        for (int i = 0; i < count; i++) fill(row->of, items + (size_t)i * row->of->size, arena);
    }
    if (row->kind == RECORD_OBJECT)
        fill(row->of, list = arena_alloc(arena, row->of->size, 16, 1), arena);
    put(item + row->offset, &list, sizeof list);
    if (row->count) put(item + row->count, &count, sizeof count);
}

static void fill_row(const RecordRow *row, char *item, Arena *arena) {
    void *at = item + row->offset;
    const char *text = draw_text(row->flags & RECORD_NULL);
    const long number = (long)draw();
    const int small = (int)(draw() % 100);
    int words = row->flags & RECORD_NULL ? 1 : 0;
    switch (row->kind) {
    case RECORD_NUMBER: fill_numbers(row, at, 1); return;
    case RECORD_NUMBERS: fill_numbers(row, at, row->most); return;
    case RECORD_INTEGER:
        if (row->flags & RECORD_LONG) put(at, &number, sizeof number);
        else put(at, &small, sizeof small);
        return;
    case RECORD_FLAG: *(bool *)at = draw() & 1; return;
    case RECORD_TEXT: put(at, &text, sizeof text); return;
    case RECORD_CHOICE:
        while (record_word(row, words)) words++;
        words = (int)draw() % words;
        put(at, &words, sizeof words);
        return;
    case RECORD_OBJECT:
        if (row->flags & RECORD_APART) break;
        fill(row->of, at, arena);
        if (row->count) *(bool *)(void *)(item + row->count) = true;
        return;
    default: break;
    }
    fill_pointer(row, item, arena);
}

static void fill(const RecordFormat *format, void *item, Arena *arena) {
    for (const RecordRow *row = format->rows; row->key; row++)
        if (record_is_read(row, true)) fill_row(row, item, arena);
}

static char *kept(const Review *review, size_t flags) {
    json_t *document = record_keep(&review_rows, review);
    char *text = json_dumps(document, flags | JSON_REAL_PRECISION(17));
    json_decref(document);
    assert_non_null(text);
    return text;
}

static Review read_kept(const char *text, Arena *arena) {
    const FileBytes bytes = {(const unsigned char *)text, strlen(text)};
    Review out = {0};
    JsonView view;
    assert_done(json_view_parse("kept", bytes, arena, &view, &err));
    view.is_kept = true;
    assert_done(record_read(&view, &review_rows, &out, &err));
    json_view_close(&view);
    return out;
}

ARENA_TEST(all_of_a_review_is_kept_to_the_last_bit) {
    for (uint64_t i = 0; i < 100; i++) {
        Arena room = arena;
        Review review = {0}, again;
        luck = i;
        fill(&review_rows, &review, &room);
        char *first = kept(&review, 0);
        again = read_kept(first, &room);
        char *second = kept(&again, 0);
        assert_string_equal(first, second);
        free(first);
        free(second);
    }
}

/* Of figures and texts, what JSON has not; and none of it in review.json. */
ARENA_TEST(what_json_has_not_is_kept) {
    ReviewCase c = review_case_unknown();
    const double batches[CASE_BATCHES] = {-0.0, INFINITY};
    c.condition = "a\xff";
    c.contrast_ratio = INFINITY;
    c.margin = -INFINITY;
    c.batches = batches;
    c.sun_azimuth_deg = 7;
    const Review review = {.cases = &c, .case_count = 1};
    char *text = kept(&review, 0);
    const ReviewCase *found = read_kept(text, &arena).cases;
    free(text);
    assert_string_equal(found->condition, c.condition);
    assert_true(found->contrast_ratio == INFINITY && found->margin == -INFINITY);
    assert_true(isnan(found->visibility) && !found->symbol && !found->has_sun);
    assert_true(found->sun_azimuth_deg == 7 && found->batches[1] == INFINITY);
    assert_true(signbit(found->batches[0]) && found->batches[0] == 0);
    const char *path = arena_format(&arena, "%s", in_folder("review.json"));
    Review published;
    json_t *document = review_json(&review),
           *written = json_array_get(json_object_get(document, "cases"), 0);
    assert_null(json_object_get(written, "batches"));
    assert_true(json_is_null(json_object_get(written, "contrast_ratio")));
    json_object_set_new(written, "contrast_ratio", json_string("inf"));
    assert_done(review_json_write(document, path, &err));
    assert_fails_as(review_json_read(path, &arena, &published, &err), ERROR_INPUT,
                    "is a text, required: a number");
}

TEST_PROGRAM(make_folder, clear_folder)
