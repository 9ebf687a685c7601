/* SPDX-License-Identifier: Apache-2.0 */
/* Texts that grow, escapes, characters of UTF-8, base64 and the nearest word. */
#include "fixture.h"

#include "base/count.h"
#include "base/number.h"
#include "print/utf8.h"
#include "text/base64.h"
#include "text/json_text.h"
#include "text/nearest_word.h"
#include "text/text.h"

ARENA_TEST(a_text_grows_where_it_stands) {
    Text text = {.arena = &arena};
    text_format(&text, "%d", 1);
    const char *place = text.data;
    for (int i = 0; i < 100000; i++) text_format(&text, "%d", i % 10);
    assert_int_equal(text.size, 100001);
    assert_ptr_equal(text.data, place);
    assert_string_equal(text.data + 99992, "123456789");
}

ARENA_TEST(a_text_moves_when_something_lies_behind_it) {
    Text a = {.arena = &arena}, b = {.arena = &arena};
    char line[3001];
    memset(line, 'x', 3000);
    line[3000] = 0;
    for (int i = 0; i < 5; i++) {
        text_format(&a, "%s%d", line, i);
        text_add(&b, line);
        text_add_bytes(&b, line, 0);
    }
    assert_int_equal(a.size, 5 * 3001);
    assert_int_equal(strlen(a.data), a.size);
    assert_int_equal(strlen(b.data), 5 * 3000);
    assert_int_equal(a.data[4 * 3001 - 1], '3');
    assert_int_equal(strspn(b.data, "x"), b.size);
}

ARENA_TEST(a_text_becomes_a_file) {
    Text text = {.arena = &arena};
    FileBytes bytes;
    const char *path = in_folder("text");
    assert_done(text_write(&text, path, &err));
    assert_done(file_read(path, 100, &arena, &bytes, &err));
    assert_int_equal(bytes.size, 0);
    text_add(&text, "line\n");
    assert_done(text_write(&text, path, &err));
    assert_done(file_read(path, 100, &arena, &bytes, &err));
    assert_string_equal((const char *)bytes.data, "line\n");
    unlink(path);
    assert_false(text_write(&text, "/nowhere/at/all", why()));
}

ARENA_TEST(texts_are_escaped) {
    Text text = {.arena = &arena};
    escape_markup(&text, "a<b>&\"c'");
    escape_markup(&text, NULL);
    assert_string_equal(text.data, "a&lt;b&gt;&amp;&quot;c&#39;");
    text = (Text){.arena = &arena};
    escape_markup(&text, "é\t\x01\x7f\xff\xef\xbf\xbf.");
    assert_string_equal(text.data, "é\\u0009\\u0001\\u007F\\xFF\\uFFFF.");
}

TEST(characters_make_the_round_trip) {
    static const unsigned CODES[] = {0,      0x41,   0x7f,   0x80,    0x7ff,   0x800,
                                     0xd7ff, 0xe000, 0xffff, 0x10000, 0x10ffff};
    for (size_t i = 0; i < sizeof CODES / sizeof *CODES; i++) {
        char bytes[UTF8_BYTES_MAX];
        unsigned code = 1;
        int length = utf8_encode(CODES[i], bytes);
        assert_int_equal(utf8_decode(bytes, (size_t)length, &code), length);
        assert_int_equal(code, CODES[i]);
        assert_int_equal(utf8_decode(bytes, (size_t)length - 1, &code), 0);
        for (int j = 0; j < length; j++) assert_int_equal(utf8_continues(bytes[j]), j > 0);
    }
}

TEST(any_text_becomes_json) {
    json_auto_t *good = json_text("é"), *bad = json_text("a\xc3\xa9\xff");
    assert_string_equal(json_string_value(good), "é");
    assert_string_equal(json_string_value(bad), "aé\\xFF");
}

/* What jansson leaves as it is (RFC 8259 requires C0 alone) is escaped, and read as it was. */
ARENA_TEST(a_document_gives_a_terminal_no_commands) {
    static const char NAME[] = "\x1b[2K\x7f\xc2\x9b\xe2\x80\xae\xe2\x80\xa8\\ \"é";
    json_auto_t *document = json_pack("{s:s, s:i}", NAME, NAME, "b", 1);
    Text text = {.arena = &arena};
    assert_true(json_dump_text(&text, document, JSON_INDENT(1)));
    assert_string_equal(text.data,
                        "{\n \"\\u001B[2K\\u007F\\u009B\\u202E\\u2028\\\\ \\\"é\": "
                        "\"\\u001B[2K\\u007F\\u009B\\u202E\\u2028\\\\ \\\"é\",\n \"b\": 1\n}");
    json_auto_t *again = json_loads(text.data, 0, NULL);
    assert_true(json_equal(document, again));
    assert_false(json_dump_text(&text, NULL, 0));
}

/* RFC 4648, section 10. */
ARENA_TEST(base64_makes_the_round_trip) {
    static const char *const DIGITS[] = {"",         "Zg==",     "Zm8=",    "Zm9v",
                                         "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
    for (size_t i = 0; i < 7; i++) {
        Text text = {.arena = &arena};
        unsigned char bytes[8];
        size_t size;
        base64_encode(&text, "foobar", i);
        assert_string_equal(text.data, DIGITS[i]);
        assert_done(base64_decode(text.data, text.size, bytes, &size, &err));
        assert_int_equal(size, i);
        assert_memory_equal(bytes, "foobar", i);
    }
}

TEST(the_nearest_word_is_found) {
    static const char *const words[] = {"wavelengths", "incidence_deg", "files"};
    assert_string_equal(nearest_word("file", words, 3), "files");
    assert_string_equal(nearest_word("incidence", words, 3), "incidence_deg");
    assert_null(nearest_word_within("zebra", words, 3, 3));
    assert_string_equal(nearest_word_within("fules", words, 3, 1), "files");
    char word[200] = "";
    memset(word, 'w', sizeof word - 1);
    assert_null(nearest_word_within(word, words, 3, 150));
}

TEST(the_word_that_is_meant_is_near_or_there_is_none) {
    static const char *const words[] = {"render", "develop", "panel", "check", "measure"};
    assert_string_equal(nearest_word_meant("rendr", words, 5), "render");
    assert_string_equal(nearest_word_meant("mesure", words, 5), "measure");
    assert_string_equal(nearest_word_meant("deve", words, 5), "develop");
    assert_null(nearest_word_meant("zebra", words, 5));
    assert_null(nearest_word_meant("", words, 5));
}

TEST(advice_names_the_near_one_and_as_many_as_fit) {
    static const char *const words[] = {"cluster", "leather black", "a,b", "", "centre"};
    char text[400];
    assert_string_equal(nearest_word_advice("clster", words, 5, text, 400),
                        "did you mean cluster? There are cluster, \"leather black\", \"a,b\", "
                        "\"\", centre");
    assert_string_equal(nearest_word_advice("zebra", words, 1, text, 400), "there are cluster");
    assert_string_equal(nearest_word_advice("zebra", words, 0, text, 400), "there are none");
    for (int size = 64; size <= 400; size++) { /* never too long, and none is forgotten */
        static const char *const many[] = {"one",   "two two", "three", "four", "five",   "six",
                                           "seven", "eight",   "nine",  "ten",  "eleven", "twelve"};
        memset(text, 'x', sizeof text);
        nearest_word_advice("ten ", many, 12, text, size);
        const char *more = strstr(text, " and "), *list = strstr(text, "here are");
        int listed = 1, left = more ? atoi(more + 5) : 0;
        assert_non_null(list);
        for (const char *at = list; *at && at != more; at++) listed += *at == ',';
        assert_true((int)strlen(text) < size && listed + left == 12);
    }
}

ARENA_TEST(a_cell_is_no_formula) {
    static const char *const cells[][2] = {{"", ""},
                                           {"a", "a"},
                                           {"a,b", "\"a,b\""},
                                           {"5\"", "\"5\"\"\""},
                                           {"=1+1", "'=1+1"},
                                           {"=", "'="},
                                           {"@SUM(A1)", "'@SUM(A1)"},
                                           {"+1-1", "'+1-1"},
                                           {"-", "'-"},
                                           {"-a", "'-a"},
                                           {"-5", "-5"},
                                           {"+5.5e3", "+5.5e3"},
                                           {"-.5", "-.5"},
                                           {"-inf", "-inf"},
                                           {"-nan", "-nan"},
                                           {"-0x10", "'-0x10"},
                                           {"+49 170", "'+49 170"},
                                           {"=\"a\",b", "\"'=\"\"a\"\",b\""},
                                           {"-1,5", "\"'-1,5\""},
                                           {"'=1", "'=1"},
                                           {" =1", " =1"},
                                           {"a=1", "a=1"},
                                           {"@", "'@"},
                                           {"\t=1", "\\u0009=1"},
                                           {"-infinity", "'-infinity"},
                                           {"==", "'=="}};
    for (int i = 0; i < COUNT_OF(cells); i++) {
        Text text = {.arena = &arena};
        text_add_cell(&text, cells[i][0]);
        assert_string_equal(text.data ? text.data : "", cells[i][1]);
    }
}

/* ---- numbers ----------------------------------------------------------------------------- */

TEST(numbers_end_where_their_letters_do) {
    static const struct {
        const char *text, *rest; /* NULL: it begins with none */
        double value;
    } cases[] = {
        {"0", "", 0},         {"-0", "", 0},          {"+5", "", 5},        {"1.5", "", 1.5},
        {".5", "", 0.5},      {"5.", "", 5},          {"-.25e2", "", -25},  {"1e3", "", 1000},
        {"1E+3", "", 1000},   {"1e-3x", "x", 1e-3},   {"180,5", ",5", 180}, {"1e", "e", 1},
        {"1e+", "e+", 1},     {"1.2.3", ".3", 1.2},   {"007", "", 7},       {"1 2", " 2", 1},
        {"10x20", "x20", 10}, {"1e-400", "", 0},      {"2%", "%", 2},       {"1d3", "d3", 1},
        {"3f", "f", 3},       {"1_000", "_000", 1},   {"1'000", "'000", 1}, {"0e5x", "x", 0},
        {"", NULL, 0},        {" 1", "", 1},          {" \t-1 ", " ", -1},  {"\n1", NULL, 0},
        {"- 1", NULL, 0},     {"x", NULL, 0},         {".", NULL, 0},       {"-", NULL, 0},
        {"+", NULL, 0},       {"--1", NULL, 0},       {"-.e1", NULL, 0},    {"0x1p7", NULL, 0},
        {"0X10", NULL, 0},    {"-0x1", NULL, 0},      {"nan", NULL, 0},     {"NaN(1)", NULL, 0},
        {"inf", NULL, 0},     {"-Infinity", NULL, 0}, {"1e999", NULL, 0},   {"-1e999", NULL, 0},
        {"e5", NULL, 0},      {",5", NULL, 0},        {"\xD9\xA1", NULL, 0}};
    for (int i = 0; i < COUNT_OF(cases); i++) {
        double value = 7, whole = 7;
        float single = 7;
        const char *text = cases[i].text, *rest = cases[i].rest;
        const char *end = number_read(text, &value), *end_single = number_read_float(text, &single);
        if (!rest != !end || end != end_single || (rest && strcmp(end, rest) != 0) ||
            value != (rest ? cases[i].value : 7) || single != (float)value ||
            number_is(text, &whole) != (rest && !*rest))
            fail_msg("'%s': %g, then '%s'", text, value, end ? end : "none");
    }
    double value;
    float single;
    assert_non_null(number_read("1e39", &value)); /* beyond a float alone */
    assert_null(number_read_float("1e39", &single));
}

TEST(counts_are_digits_alone) {
    static const char *const none[] = {"", "-1", "+1", " 1", "x", "18446744073709551616", "0x"};
    uint64_t count = 0;
    assert_string_equal(number_read_count("18446744073709551615:x", &count), ":x");
    assert_true(count == UINT64_MAX);
    assert_string_equal(number_read_count("007", &count), "");
    assert_true(count == 7);
    for (int i = 0; i < COUNT_OF(none) - 1; i++) assert_null(number_read_count(none[i], &count));
    assert_string_equal(number_read_count(none[COUNT_OF(none) - 1], &count), "x");
}

TEST_PROGRAM(make_folder, remove_folder)
