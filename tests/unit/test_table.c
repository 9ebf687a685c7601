/* SPDX-License-Identifier: Apache-2.0 */
/* Rows and their views: what people read is the same text in every view, and closed forms of how
 * a figure is written. */
#include "fixture.h"
#include "json_fixture.h"

#include "table/table.h"
#include "text/json_text.h"

/* ---- figures ----------------------------------------------------------------------------- */

static const char *shown(Column column, double value, Arena *arena) {
    TableKind *kind = ARENA_NEW(arena, TableKind, 1);
    Column *own = ARENA_NEW(arena, Column, 1);
    *own = column;
    *kind = (TableKind){.columns = own, .column_count = 1};
    Table *table = table_new(kind, arena);
    table_row(table);
    table_number(table, value);
    return table_cell_text(table, 0, 0);
}

ARENA_TEST(a_figure_has_the_digits_of_its_column) {
    const struct {
        Column column;
        double value;
        const char *text;
    } cases[] = {{COLUMN_DIGITS("k", "w", NULL, 4), 905.905, "905.9"},
                 {COLUMN_DIGITS("k", "w", NULL, 4), 112345, "112345"},
                 {COLUMN_DIGITS("k", "w", NULL, 4), 0.0299994, "0.03000"},
                 {COLUMN_DIGITS("k", "w", NULL, 4), 0.00001234, "1.234e-05"},
                 {COLUMN_DIGITS("k", "w", NULL, 4), 0, "0.000"},
                 {COLUMN_DIGITS("k", "w", NULL, 0), 8, "8"},
                 {COLUMN_DIGITS("k", "w", NULL, 0), 2.5e6, "2500000"},
                 {COLUMN_FIXED("k", "w", NULL, 2), -0.001, "0.00"},
                 {COLUMN_FIXED("k", "w", NULL, 1), -12.34, "-12.3"},
                 {COLUMN_SHARE("k", "w"), 0.01234, "1.23"},
                 {COLUMN_DIGITS("k", "w", NULL, 4), INFINITY, "infinite"},
                 {COLUMN_DIGITS("k", "w", NULL, 4), NAN, "–"},
                 {{.key = "k", .words = "w", .none = "not measured"}, NAN, "not measured"}};
    for (int i = 0; i < COUNT_OF(cases); i++)
        assert_string_equal(shown(cases[i].column, cases[i].value, &arena), cases[i].text);
}

/* ---- one text in every view -------------------------------------------------------------- */

enum { COLUMNS = 6, ROWS = 40 };

static const Column RANDOM[COLUMNS] = {COLUMN_TEXT("name", "name"),
                                       COLUMN_DIGITS("digits", "digits", "cd/m2", 4),
                                       COLUMN_FIXED("fixed", "fixed", "°", 2),
                                       COLUMN_SHARE("share", "share"),
                                       COLUMN_DIGITS("plain", "plain", NULL, 0),
                                       COLUMN_FIXED("whole", "whole", "lx", 0)};
static const TableKind RANDOM_KIND = TABLE_KIND("random", "Random", RANDOM);

static Table *random_table(unsigned seed, Arena *arena) {
    static const char *const NAMES[] = {"plain", "with, comma", "μ and “quotes”", "=1+1", ""};
    Table *table = table_new(&RANDOM_KIND, arena);
    srand(seed);
    for (int r = 0; r < ROWS; r++) {
        table_row(table);
        table_text(table, NAMES[rand() % COUNT_OF(NAMES)]);
        for (int c = 1; c < COLUMNS; c++) {
            double size = pow(10, rand() % 13 - 6), value = size * (rand() % 2001 - 1000) / 100;
            table_number(table, rand() % 8 ? value : (double)NAN);
        }
    }
    return table;
}

/* The cells of a line of the console stand in order. */
static void assert_stands_in(const char *line, const char *words) {
    const char *end = strchr(line, '\n'), *at = strstr(line, words);
    assert_true(at && at < end);
}

ARENA_TEST(text_json_csv_and_page_have_the_same_cells) {
    for (unsigned seed = 1; seed <= 50; seed++) {
        Table *table = random_table(seed, &arena);
        Text text = {.arena = &arena}, csv = {.arena = &arena};
        json_auto_t *json = table_json(table), *page = table_page(table);
        table_add_text(table, &text);
        table_add_csv(table, &csv);
        const char *line = text.data, *rows = strchr(csv.data, '\n') + 1;
        for (int skip = 0; skip < 2; skip++) line = strchr(line, '\n') + 1;
        for (int r = 0; r < ROWS; r++) {
            const json_t *cells =
                json_object_get(json_array_get(json_object_get(page, "rows"), (size_t)r), "cells");
            for (int c = 0; c < COLUMNS; c++) {
                const char *words = table_cell_text(table, r, c);
                Text cell = {.arena = &arena};
                text_add_cell(&cell, words);
                assert_memory_equal(rows, cell.data, cell.size);
                rows += cell.size + 1;
                assert_stands_in(line, words);
                assert_string_equal(json_text_at(json_array_get(cells, (size_t)c), "text"), words);
                const json_t *value =
                    json_object_get(json_array_get(json, (size_t)r), RANDOM[c].key);
                if (json_is_number(value)) assert_close(json_number_value(value), atof(words), 0);
                else assert_string_equal(json_string_value(value), words);
            }
            line = strchr(line, '\n') + 1;
        }
        assert_true(*rows == 0 && *line == 0);
    }
}

/* ---- of a document ----------------------------------------------------------------------- */

static const Column ITEMS[] = {COLUMN_TEXT("name", "item"),
                               {.key = "share",
                                .words = "share",
                                .unit = "%",
                                .places = 3,
                                .times = 100,
                                .interval = "range"}};
static const TableKind ITEMS_KIND = TABLE_KIND("items", NULL, ITEMS);
static const Column ANSWER[] = {
    {.key = "light.cd_m2", .words = "luminance", .unit = "cd/m2", .interval = "light.interval"},
    {.key = "open.value", .words = "contrast", .unit = ": 1", .interval = "open.interval"},
    {.key = "none", .words = "without", .unit = ": 1", .interval = "none_interval"},
    {.key = "cone",
     .words = "half",
     .unit = "deg",
     .is_fixed = true,
     .places = 1,
     .parts = "right|up",
     .none = "beyond"},
    {.key = "xy.1", .words = "y", .is_fixed = true, .places = 3},
    {.key = "gone.of.it", .words = "gone", .none = "no layer"},
    {.key = "absent", .words = "absent", .none = "no layer"},
    {.key = "nothing", .words = "left out", .hides_zero = true},
    {.key = "notes", .words = "note"},
    {.key = "names", .words = "names", .parts = ""},
    {.key = "choices", .words = "choices"},
    {.key = "is_up", .words = "up"},
    {.key = "items", .of = &ITEMS_KIND}};
static const TableKind ANSWER_KIND = TABLE_KIND("answer", NULL, ANSWER);

ARENA_TEST(a_document_is_read_by_its_columns) {
    json_auto_t *document =
        json_loads("{\"light\": {\"cd_m2\": 41.234, \"interval\": [41.0, 41.468]},"
                   "\"open\": {\"value\": 12, \"interval\": [9.5, null]},"
                   "\"none\": null, \"none_interval\": [7, null],"
                   "\"cone\": [60.04, null], \"xy\": [0.31, 0.3289], \"gone\": null,"
                   "\"nothing\": 0, \"notes\": [\"one\", \"two\"], \"names\": [\"a\", \"b\"],"
                   "\"choices\": {\"tree_level\": 7, \"basis\": \"haar\", \"of\": {\"x\": 1}},"
                   "\"is_up\": true, \"items\": [{\"name\": \"sun\", \"share\": 0.5}]}",
                   0, NULL);
    Text text = {.arena = &arena};
    table_add_document(&ANSWER_KIND, document, &text);
    assert_string_equal(text.data, "luminance  41.23 +- 0.23 cd/m2\n"
                                   "contrast   at least 9.5 : 1\n"
                                   "without    at least 7 : 1\n"
                                   "half       right 60.0, up beyond deg\n"
                                   "y          0.329\n"
                                   "gone       no layer\n"
                                   "note       one\n"
                                   "note       two\n"
                                   "names      a, b\n"
                                   "choices    tree level 7; basis haar\n"
                                   "up         yes\n"
                                   "\n"
                                   "item  share, %\n"
                                   "sun       50.0\n");
}

/* Every column, those of its rows in its list's place, as what made it says. */
ARENA_TEST(a_kind_lists_its_columns) {
    json_auto_t *list = table_kind_json(&ANSWER_KIND);
    const char *const ROW_KEYS[] = {"items[].name", "items[].share"};
    int plain = ANSWER_KIND.column_count - 1;
    assert_int_equal(json_array_size(list), plain + COUNT_OF(ROW_KEYS));
    for (int c = 0; c < plain; c++) {
        const json_t *row = json_array_get(list, (size_t)c);
        const Column *column = &ANSWER[c];
        const char *const texts[][2] = {{"key", column->key},
                                        {"words", column->words},
                                        {"unit", column->unit},
                                        {"interval", column->interval},
                                        {"none", column->none}};
        for (int i = 0; i < COUNT_OF(texts); i++)
            if (texts[i][1]) assert_string_equal(json_text_at(row, texts[i][0]), texts[i][1]);
            else assert_null(json_object_get(row, texts[i][0]));
    }
    for (int i = 0; i < COUNT_OF(ROW_KEYS); i++)
        assert_string_equal(json_text_at(json_array_get(list, (size_t)(plain + i)), "key"),
                            ROW_KEYS[i]);
    const json_t *share = json_array_get(list, (size_t)plain + 1);
    assert_string_equal(json_text_at(share, "unit"), "share");
    assert_string_equal(json_text_at(share, "interval"), "items[].range");
}

/* Lists that stand side by side are rows; documents that have rows stand one below the other, a
 * blank line between. */
ARENA_TEST(lists_side_by_side_are_rows) {
    static const Column SPECTRUM[] = {COLUMN_FIXED("nm", "wavelength", "nm", 0),
                                      COLUMN_FIXED("value", "value", NULL, 1)};
    static const TableKind SPECTRUM_KIND = TABLE_KIND("spectrum", NULL, SPECTRUM);
    static const Column OF[] = {COLUMN_TEXT("name", "name"),
                                {.key = "is_far", .words = "far", .hides_zero = true},
                                {.key = "nm", .lists = &SPECTRUM_KIND}};
    static const TableKind OF_KIND = TABLE_KIND("of", NULL, OF);
    json_auto_t *document = json_loads("[{\"name\": \"a\", \"is_far\": false,"
                                       "  \"nm\": [400, 500], \"value\": [0.25, 1.0]},"
                                       " {\"name\": \"b\", \"is_far\": true, \"nm\": []}]",
                                       0, NULL);
    Text text = {.arena = &arena};
    table_add_document(&OF_KIND, document, &text);
    assert_string_equal(text.data, "name  a\n\n"
                                   "wavelength, nm  value\n"
                                   "           400    0.2\n"
                                   "           500    1.0\n\n"
                                   "name  b\n"
                                   "far   yes\n");
    json_auto_t *list = table_kind_json(&OF_KIND);
    assert_int_equal(json_array_size(list), 4);
    assert_string_equal(json_text_at(list, "3/key"), "value");
}

/* ---- rows in rows ------------------------------------------------------------------------ */

static const Column STEPS[] = {COLUMN_TEXT("what", "what"), COLUMN_TEXT("node", "node"),
                               COLUMN_FIXED("at", "at", "m", 1)};
static const TableKind STEPS_KIND = TABLE_KIND("steps", NULL, STEPS);
static const Column WAYS[] = {COLUMN_SHARE("share", "share"),
                              {.key = "is_cut", .words = "further", .hides_zero = true},
                              {.key = "without", .words = "without", .hides_zero = true},
                              {.key = "steps|names", .words = "via", .of = &STEPS_KIND}};
static const TableKind WAYS_KIND = TABLE_KIND("ways", NULL, WAYS);
static const Column BANDS[] = {COLUMN_TEXT("of.nm", "nm"),
                               COLUMN_DIGITS("of.power", "power", "W", 3),
                               {.key = "of.power", .words = "", .is_bar = true}};
static const TableKind BANDS_KIND = TABLE_KIND("bands", NULL, BANDS);
static const Column LIGHT[] = {{.key = "all", .words = "of a region", .unless = "pixel"},
                               {.key = "all", .words = "of a pixel", .unless = "region"},
                               COLUMN_MEASURED("absent", "absent", NULL, "interval"),
                               {.key = "ways", .of = &WAYS_KIND},
                               {.key = "of.nm", .lists = &BANDS_KIND}};
static const TableKind LIGHT_KIND = TABLE_KIND("light", NULL, LIGHT);

ARENA_TEST(a_row_holds_lines) {
    json_auto_t *document = json_loads(
        "{\"all\": 3, \"pixel\": [1, 2], \"interval\": [1, 2], \"ways\": ["
        "{\"share\": 0.75, \"is_cut\": false, \"without\": null, \"steps\": ["
        "{\"what\": \"mirror\", \"node\": \"ball\", \"at\": [1.0, 2.55, 3.0]},"
        "{\"what\": \"passes\", \"node\": \"a\\nb\", \"at\": 4.0}], \"names\": [\"unused\"]},"
        "{\"share\": 0.25, \"is_cut\": false, \"without\": null,"
        " \"names\": [\"all\", \"others\"]}],"
        "\"of\": {\"unit\": \"W\", \"nm\": [365, 375], \"power\": [2.0, 0.5]}}",
        0, NULL);
    Text text = {.arena = &arena};
    table_add_document(&LIGHT_KIND, document, &text);
    assert_string_equal(text.data, "of a pixel  3\n"
                                   "\n"
                                   "share, %  via\n"
                                   "    75.0  mirror  ball      1.0, 2.5, 3.0 m\n"
                                   "          passes  a\\u000Ab            4.0 m\n"
                                   "    25.0  all\n"
                                   "          others\n"
                                   "\n"
                                   " nm  power, W\n"
                                   "365      2.00  ########################################\n"
                                   "375     0.500  ##########\n");
    json_auto_t *list = table_kind_json(&WAYS_KIND), *bands = table_kind_json(&BANDS_KIND);
    assert_string_equal(json_text_at(list, "5/key"), "steps[].at");
    assert_string_equal(json_text_at(list, "6/key"), "names");
    assert_int_equal(json_array_size(bands), 2);
}

ARENA_TEST(what_has_nothing_to_say_says_nothing) {
    json_auto_t *empty = json_object(), *none = json_loads("{\"items\": []}", 0, NULL);
    Text text = {.arena = &arena};
    table_add_document(&ANSWER_KIND, empty, &text);
    table_add_document(&ANSWER_KIND, none, &text);
    assert_int_equal(text.size, 0);
    json_auto_t *list = json_loads("[7, {\"name\": 3}, null]", 0, NULL); /* of another's making */
    table_add_document(&ITEMS_KIND, list, &text);
    assert_string_equal(text.data, "item\n\n   3\n\n");
}

/* A control character of a foreign text is no line's end. */
ARENA_TEST(what_a_terminal_would_obey_is_shown) {
    json_auto_t *document = json_pack("{s:s}", "absent", "a\nb");
    Text text = {.arena = &arena};
    table_add_document(&ANSWER_KIND, document, &text);
    assert_string_equal(text.data, "absent  a\\u000Ab\n");
}

TEST_PROGRAM(make_folder, remove_folder)
