/* SPDX-License-Identifier: Apache-2.0 */
/* Pages are templates over values: what each tag does, what is wrong with a template, and that
 * a page is whole, escaped, without a network, one file of its parts. */
#include "fixture.h"

#include <zlib.h>

#include "base/count.h"
#include "page/page.h"
#include "text/base64.h"

static const char WILD[] = "a<b>&\"c'\xff";
static const char TAME[] = "a&lt;b&gt;&amp;&quot;c&#39;\\xFF";

static const char *doubled(double value, Arena *arena) {
    return isnan(value) ? "none" : arena_format(arena, "%g", 2 * value);
}

static const PageFormat FORMATS[] = {{"doubled", doubled}, {NULL, NULL}};

static const char VALUES[] =
    "{'text': 'a<b', 'empty': '', 'null': null, 'yes': true, 'no': false, 'one': 1, 'zero': 0,"
    " 'real': 0.0, 'pi': 3.14159, 'list': [{'name': 'x'}, {'name': 'y'}], 'none': [],"
    " 'mixed': [{'text': 't'}, {}],"
    " 'words': ['p', 'q'], 'object': {'inner': {'name': 'deep'}}, 'name': 'outer',"
    " 'raw': '<b>&</b>'}";

static json_t *values_of(const char *text) {
    json_error_t error;
    char *json = arena_string(test_memory(), text, strlen(text));
    for (char *c = json; *c; c++)
        if (*c == '\'') *c = '"';
    json_t *values = json_loads(json, 0, &error);
    assert_non_null(values);
    return values;
}

/* A template of a test is one that no page has: it is rendered as a text. */
static bool rendered(const char *template, Text *page, Error *error) {
    json_t *values = values_of(VALUES);
    *page = (Text){.arena = test_memory()};
    bool ok = page_render_text(page, (PageFile){"test.html", template}, values, FORMATS,
                               arena_reserve(1 << 20), error);
    json_decref(values);
    return ok;
}

TEST(a_template_shows_its_values) {
    static const struct {
        const char *template, *page;
    } ROWS[] = {
        {"<p>{{text}}|{{empty}}|{{null}}|{{one}}|{{pi}}</p>", "<p>a&lt;b|||1|3.14159</p>"},
        {"{{{raw}}}{{raw}}", "<b>&</b>&lt;b&gt;&amp;&lt;/b&gt;"},
        {"{{pi|f2}} {{pi|g2}} {{one|doubled}} {{null|doubled}} {{text|doubled}}",
         "3.14 3.1 2 none a&lt;b"},
        {"{{zero}} day{{zero|s}}, {{one}} day{{one|s}}", "0 days, 1 day"},
        {"{{#list}}{{name}};{{/list}}", "x;y;"},
        {"{{#words}}[{{.}}]{{/words}}", "[p][q]"},
        {"{{#mixed}}{{#text}}{{text}}{{/text}}{{^text}}-{{/text}}{{name}};{{/mixed}}",
         "touter;-outer;"},
        {"{{#object}}{{inner.name}} {{name}}{{/object}}", "deep outer"},
        {"{{object.inner.name}}{{#object.inner}}-{{name}}{{/object.inner}}", "deep-deep"},
        {"{{#yes}}1{{/yes}}{{#text}}2{{/text}}{{#one}}3{{/one}}{{#real}}4{{/real}}", "1234"},
        {"{{#no}}1{{/no}}{{#empty}}2{{/empty}}{{#null}}3{{/null}}{{#zero}}4{{/zero}}"
         "{{#none}}5{{/none}}{{#absent}}6{{/absent}}",
         ""},
        {"{{^no}}1{{/no}}{{^none}}2{{/none}}{{^absent}}3{{/absent}}{{^yes}}4{{/yes}}", "123"},
        {"{{#list}}{{#list}}{{name}}{{/list}}{{/list}}", "xyxy"},
        {"<ul>\n  {{#words}}\n  <li>{{.}}</li>\n  {{/words}}\n</ul>\n",
         "<ul>\n<li>p</li>\n<li>q</li>\n</ul>\n"},
        {"a<!-- not\nshown -->b <link rel=\"stylesheet\" href=\"{{one}}\">",
         "ab "
         "<link rel=\"stylesheet\" href=\"1\">"},
        {"{{list.1.name}}{{list.7.name}}{{null.any}}{{words| > }}", "yp &gt; q"},
        {"{ {a} {{text}} }}", "{ {a} a&lt;b }}"}};
    for (int i = 0; i < COUNT_OF(ROWS); i++) {
        Text page;
        if (!rendered(ROWS[i].template, &page, why()))
            fail_msg("%s: %s", ROWS[i].template, why()->text);
        assert_string_equal(page.data ? page.data : "", ROWS[i].page);
    }
}

/* Lines and cells as RFC 4180 has them. */
TEST(a_template_of_csv_quotes_its_cells) {
    Text page = {.arena = test_memory()};
    json_t *values = values_of("{'rows': [{'a': 'x, y', 'b': 1.23456789},"
                               " {'a': '5\\u0022', 'b': null}]}");
    assert_done(page_render_text(&page,
                                 (PageFile){"t.csv", "a,b\n{{#rows}}\n{{a}},{{b}}\n"
                                                     "{{/rows}}\n"},
                                 values, NULL, arena_reserve(1 << 20), &err));
    assert_string_equal(page.data, "a,b\r\n\"x, y\",1.23457\r\n\"5\"\"\",\r\n");
    json_decref(values);
}

TEST(a_fault_of_a_template_is_named) {
    static const struct {
        const char *template, *text;
    } ROWS[] = {{"{{absent}}", "has no value for 'absent'"},
                {"{{{absent}}}", "has no value for 'absent'"},
                {"{{object.absent}}", "has no value for 'object.absent'"},
                {"{{#words}}{{name.x}}{{/words}}", "has no value for 'name.x'"},
                {"{{#mixed}}{{text}}{{/mixed}}", "has no value for 'text'"},
                {"{{pi|odd}}", "has no such format: 'pi'"},
                {"{{pi|f10}}", "has no such format: 'pi'"},
                {"{{#yes}}", "has no end of 'yes'"},
                {"{{#yes}}{{/no}}", "has no end of 'yes'"},
                {"{{/yes}}", "has no beginning of 'yes'"},
                {"{{>absent}}", "has no part 'absent'"},
                {"<link rel=\"stylesheet\" href=\"a.css\">", "has no file 'a.css'"}};
    for (int i = 0; i < COUNT_OF(ROWS); i++) {
        Text page;
        assert_false(
            rendered(arena_format(test_memory(), "first\n%s", ROWS[i].template), &page, why()));
        assert_string_equal(why()->text, ROWS[i].text);
        assert_string_equal(why()->file, "test.html");
        assert_string_equal(why()->path, "line 2");
    }
}

/* head.html, page.css and page.js, as every page has them. */
static const char FRAME[] =
    "<!DOCTYPE html>\n<html><head>\n{{>head}}\n<link rel=\"stylesheet\" href=\"page.css\">\n"
    "</head><body>\n<footer>{{command}}</footer>\n"
    "<script src=\"page.js\"></script>\n</body></html>\n";

static const char *small_page(void) {
    Text page = {.arena = test_memory()};
    json_t *values = json_object();
    assert_done(page_set_head(values, WILD, WILD, &err));
    assert_done(page_render_text(&page, (PageFile){"frame.html", FRAME}, values, NULL,
                                 arena_reserve(1 << 20), &err));
    json_decref(values);
    return page.data;
}

TEST(a_page_is_whole_and_asks_nobody) {
    const char *page = small_page();
    static const char *const ONCE[] = {
        "<!DOCTYPE html>",           "<style>",     "</style>", "<script>", "</script>", "</html>",
        "prefers-color-scheme:dark", "@media print"};
    for (size_t i = 0; i < sizeof ONCE / sizeof *ONCE; i++)
        if (count_of(page, ONCE[i]) != 1) fail_msg("not once: %s", ONCE[i]);
    static const char *const NEVER[] = {
        "http:", "https:", "src=", "@import", "<link", "<!-- ", "http-equiv=\"refresh\""};
    for (size_t i = 0; i < sizeof NEVER / sizeof *NEVER; i++)
        if (strstr(page, NEVER[i])) fail_msg("there is %s", NEVER[i]);
    assert_int_equal(count_of(page, TAME), 2);
}

/* Behind the style of every page; CSS alone. */
TEST(a_firm_has_a_style_of_its_own) {
    const char *path = in_folder("firm.css");
    json_t *values = json_object();
    setenv(PAGE_STYLE_VARIABLE, path, 1);
    write_text(path, "h1{color:teal}");
    assert_done(page_set_head(values, "t", "c", &err));
    assert_string_equal(json_string_value(json_object_get(values, "style")), "h1{color:teal}");
    write_text(path, "</style><script>");
    assert_false(page_set_head(values, "t", "c", why()));
    assert_string_equal(why()->file, path);
    assert_string_equal(why()->text, "$PARHELION_STYLE: has \"</\" in it, required: CSS alone");
    remove(path);
    assert_false(page_set_head(values, "t", "c", why()));
    unsetenv(PAGE_STYLE_VARIABLE);
    json_decref(values);
}

/* Every page and part: its files and parts are there, and sections nest. */
TEST(all_templates_are_whole) {
    for (int i = 0; i < page_file_count; i++) {
        const char *name = page_file_table[i].name, *at = page_file_table[i].text, *open[32];
        int depth = 0;
        if (!strstr(name, ".html")) continue;
        if (strstr(at, "<!DOCTYPE html>") == at)
            assert_true(strstr(at, "{{>head}}") < strstr(at, "<style>{{{style}}}</style>"));
        for (; (at = strstr(at, "{{")); at += 2) {
            if (at[2] == '#' || at[2] == '^') open[depth++] = at + 3;
            if (at[2] != '/') continue;
            size_t length = strcspn(at + 3, "}");
            if (!depth || strncmp(open[--depth], at + 3, length + 1) != 0)
                fail_msg("%s: %.30s", name, at);
        }
        if (depth) fail_msg("%s: no end of %.20s", name, open[depth - 1]);
    }
}

TEST(pictures_lie_in_the_page) {
    Picture picture = picture_create(2, 2, test_memory());
    json_t *png = page_picture(&picture, false, arena_reserve(1 << 24), why());
    assert_non_null(png);
    assert_non_null(strstr(json_string_value(png), "data:image/png;base64,iVBORw0KGgo"));
    json_decref(png);
}

TEST(parts_become_one_file) {
    Arena *arena = test_memory();
    Text a = {.arena = arena}, b = {.arena = arena}, none = {.arena = arena};
    const Text *parts[] = {&a, &none, &b};
    const char *path = in_folder("page");
    text_add(&a, "one ");
    text_add(&b, "two");
    assert_done(page_write(parts, 3, path, &err));
    assert_string_equal(read_text(path, test_memory()), "one two");
    assert_false(page_write(parts, 3, "/nowhere/at/all", why()));
}

/* ---- packed numbers ---------------------------------------------------------------------- */

/* As page.h says it, back again. */
static uint32_t *unpacked(const char *text, size_t count, int bytes, Arena *arena) {
    size_t size;
    uLong room = (uLong)(count * (size_t)bytes);
    unsigned char *packed = ARENA_NEW(arena, unsigned char, strlen(text));
    unsigned char *planes = ARENA_NEW(arena, unsigned char, room);
    uint32_t *out = ARENA_NEW(arena, uint32_t, count);
    assert_done(base64_decode(text, strlen(text), packed, &size, &err));
    assert_int_equal(uncompress(planes, &room, packed, (uLong)size), Z_OK);
    assert_int_equal(room, count * (size_t)bytes);
    for (int plane = 0; plane < bytes; plane++) {
        unsigned char value = 0;
        for (size_t i = 0; i < count; i++) {
            value = (unsigned char)(value + planes[(size_t)plane * count + i]);
            out[i] |= (uint32_t)value << 8 * plane;
        }
    }
    return out;
}

TEST(numbers_come_back) {
    uint32_t values[1000];
    for (int bytes = 1; bytes <= 4; bytes++) {
        for (uint32_t i = 0; i < 1000; i++) values[i] = i * i * 2654435761u;
        const char *packed = page_packed(values, 1000, bytes, test_memory(), why());
        assert_non_null(packed);
        uint32_t *back = unpacked(packed, 1000, bytes, test_memory());
        uint32_t mask = (uint32_t)(((uint64_t)1 << 8 * bytes) - 1);
        for (int i = 0; i < 1000; i++) assert_int_equal(back[i], values[i] & mask);
    }
}

TEST_PROGRAM(make_folder, clear_folder)
