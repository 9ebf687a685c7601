/* SPDX-License-Identifier: Apache-2.0 */
/* What was packed is taken back as it was; bytes that are none of it are refused. */
#include "fixture.h"

#include "base/count.h"
#include "keep/pack.h"

typedef struct Leg {
    float point[3];
    const char *name;
} Leg;

typedef struct Table {
    double weight;
    int color;
    bool is_round;
    const char *name;
    const char *const *words;
    int word_count;
    Leg first;
    const Leg *drawer;
    const Leg *legs;
    int leg_count;
} Table;

enum { COLOR_LOW = -1, COLOR_HIGH = 4, AT_COLOR = sizeof(double), AT_ROUND = AT_COLOR + 4 };

static const PackRow leg_rows[] = {
    {.kind = PACK_FLOATS, .offset = offsetof(Leg, point), .size = sizeof(float[3])},
    {.kind = PACK_TEXT, .offset = offsetof(Leg, name)}};
static const PackFormat leg = {sizeof(Leg), leg_rows, COUNT_OF(leg_rows), NULL};

static const PackRow table_rows[] = {
    {.kind = PACK_NUMBERS, .offset = offsetof(Table, weight), .size = sizeof(double)},
    {.kind = PACK_INT, .offset = offsetof(Table, color), .low = COLOR_LOW, .high = COLOR_HIGH},
    {.kind = PACK_FLAG, .offset = offsetof(Table, is_round)},
    {.kind = PACK_PART, .offset = offsetof(Table, first), .of = &leg},
    {.kind = PACK_TEXT, .offset = offsetof(Table, name)},
    {.kind = PACK_TEXTS, .offset = offsetof(Table, words), .count = offsetof(Table, word_count)},
    {.kind = PACK_ONE, .offset = offsetof(Table, drawer), .of = &leg},
    {.kind = PACK_LIST,
     .offset = offsetof(Table, legs),
     .count = offsetof(Table, leg_count),
     .of = &leg}};
static const PackFormat table = {sizeof(Table), table_rows, COUNT_OF(table_rows), NULL};

static const char *const words[] = {"oak", ""};
static const Leg legs[] = {{{1, 2, 3}, NULL}, {{-0.0f, 5, 6}, "short"}};

static Table a_table(void) {
    return (Table){.weight = 1.0 / 3,
                   .color = COLOR_HIGH,
                   .is_round = true,
                   .name = "desk",
                   .words = words,
                   .word_count = COUNT_OF(words),
                   .first = {{7, 8, 9}, "first"},
                   .drawer = &legs[1],
                   .legs = legs,
                   .leg_count = COUNT_OF(legs)};
}

static Text packed(const Table *item, Arena *arena) {
    Text text = {.arena = arena};
    pack_add(&text, &table, item);
    return text;
}

static bool taken(const char *data, size_t size, Table *out, Arena *arena) {
    PackBytes bytes = {(const unsigned char *)data, (const unsigned char *)data + size};
    return pack_take(&bytes, &table, out, arena) && bytes.at == bytes.end;
}

/* Of the bytes of a table, where `size` of them are others. */
static bool taken_with(size_t at, const void *others, size_t size, Arena arena) {
    Table item = a_table();
    Text text = packed(&item, &arena);
    memcpy(text.data + at, others, size);
    return taken(text.data, text.size, &item, &arena);
}

static void assert_same_legs(const Leg *a, const Leg *b) {
    assert_memory_equal(a->point, b->point, sizeof a->point);
    assert_int_equal(!a->name, !b->name);
    if (a->name) assert_string_equal(a->name, b->name);
}

ARENA_TEST(what_was_packed_is_taken_back) {
    Table wanted = a_table(), found;
    Text text = packed(&wanted, &arena);
    assert_true(taken(text.data, text.size, &found, &arena));
    assert_true(found.weight == wanted.weight);
    assert_int_equal(found.color, wanted.color);
    assert_int_equal(found.is_round, wanted.is_round);
    assert_string_equal(found.name, wanted.name);
    assert_int_equal(found.word_count, wanted.word_count);
    for (int i = 0; i < found.word_count; i++) assert_string_equal(found.words[i], words[i]);
    assert_same_legs(&found.first, &wanted.first);
    assert_same_legs(found.drawer, wanted.drawer);
    assert_int_equal(found.leg_count, wanted.leg_count);
    for (int i = 0; i < found.leg_count; i++) assert_same_legs(&found.legs[i], &legs[i]);
}

ARENA_TEST(what_is_empty_is_taken_back) {
    Table wanted = {0}, found = a_table();
    Text text = packed(&wanted, &arena);
    assert_true(taken(text.data, text.size, &found, &arena));
    assert_null(found.name);
    assert_null(found.drawer);
    assert_int_equal(found.word_count, 0);
    assert_int_equal(found.leg_count, 0);
}

ARENA_TEST(bytes_that_are_cut_off_are_refused) {
    Table item = a_table();
    Text text = packed(&item, &arena);
    for (size_t size = 0; size < text.size; size++) {
        Arena room = arena;
        assert_false(taken(text.data, size, &item, &room));
    }
}

ARENA_TEST(an_int_is_within_its_range) {
    for (int color = COLOR_LOW - 2; color <= COLOR_HIGH + 2; color++)
        assert_int_equal(taken_with(AT_COLOR, &color, sizeof color, arena),
                         color >= COLOR_LOW && color <= COLOR_HIGH);
}

ARENA_TEST(a_flag_is_0_or_1) {
    for (int flag = 0; flag < 256; flag++) {
        unsigned char byte = (unsigned char)flag;
        assert_int_equal(taken_with(AT_ROUND, &byte, 1, arena), flag < 2);
    }
}

ARENA_TEST(floats_are_finite) {
    const float infinite = INFINITY, none = NAN, large = 1e38f;
    for (size_t at = AT_ROUND + 1; at < AT_ROUND + 1 + sizeof legs[0].point; at += 4) {
        assert_false(taken_with(at, &infinite, 4, arena));
        assert_false(taken_with(at, &none, 4, arena));
        assert_true(taken_with(at, &large, 4, arena));
    }
}

/* Wherever it stands, a count of more than is there takes no memory: each word in turn. */
ARENA_TEST(counts_are_not_believed) {
    static const unsigned counts[] = {0x7fffffffu, 0x80000000u, 0xffffffffu, 0x01000000u};
    Table item = a_table();
    Text text = packed(&item, &arena);
    size_t before = AT_ROUND + 1 + sizeof legs[0].point;
    for (size_t at = before; at + 4 <= text.size; at++)
        for (int i = 0; i < COUNT_OF(counts); i++) taken_with(at, &counts[i], 4, arena);
    for (int i = 0; i < COUNT_OF(counts); i++)
        assert_false(taken_with(before, &counts[i], 4, arena));
}

TEST_PROGRAM(make_arena, drop_arena)
