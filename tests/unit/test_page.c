/* SPDX-License-Identifier: Apache-2.0 */
/* The shared page of all reports: whole, escaped, without a network, one file of its parts. */
#include "fixture.h"

#include "page/page.h"

static const char WILD[] = "a<b>&\"c'\xff";
static const char TAME[] = "a&lt;b&gt;&amp;&quot;c&#39;\\xFF";

static Text small_page(bool is_dark)
{
    static const PageColumn COLUMNS[] = {{"name", false, NULL}, {"value", true, WILD}};
    Text page = {.arena = test_memory()};
    page_begin(&page, &(PageHead){WILD, ".own{}\n", is_dark, 0});
    page_element(&page, "h1 class=\"x\"", WILD);
    page_list(&page, "notes", (const char *const[]){WILD, "b"}, 2);
    page_keys_begin(&page);
    page_key(&page, WILD, WILD, true);
    page_keys_end(&page);
    page_table_begin(&page, WILD, "", COLUMNS, 2);
    page_row_begin(&page, "same");
    page_cell(&page, "", WILD);
    page_cell_format(&page, "n", "%d %s", 7, WILD);
    page_cell_long(&page, WILD);
    page_row_end(&page);
    page_table_end(&page);
    page_more_begin(&page, WILD);
    page_more_end(&page);
    page_end(&page, WILD, (const char *const[]){"var own=1;\n", NULL});
    return page;
}

TEST(every_text_is_escaped)
{
    Text page = small_page(false);
    assert_int_equal(count_of(page.data, "<b>&\""), 0);
    assert_int_equal(count_of(page.data, TAME), 12);
    assert_non_null(strstr(page.data, "<h1 class=\"x\">a&lt;"));
    assert_non_null(strstr(page.data, "<td class=\"n\">7 a&lt;"));
    assert_non_null(strstr(page.data, "<th class=\"n\" title=\"a&lt;"));
}

TEST(a_page_is_whole_and_asks_nobody)
{
    const char *page = small_page(false).data;
    static const char *const ONCE[] = {"<!DOCTYPE html>", "<style>", "</style>", "<script>",
                                       "</script>", "</html>", ".own{}", "var own=1;",
                                       "prefers-color-scheme:dark", "@media print"};
    for (size_t i = 0; i < sizeof ONCE / sizeof *ONCE; i++)
        if (count_of(page, ONCE[i]) != 1) fail_msg("not once: %s", ONCE[i]);
    static const char *const NEVER[] = {"http:", "https:", "src=", "@import", "<link"};
    for (size_t i = 0; i < sizeof NEVER / sizeof *NEVER; i++)
        if (strstr(page, NEVER[i])) fail_msg("there is %s", NEVER[i]);
    assert_null(strstr(page, "<html lang=\"en\" class=\"dark\">"));
    assert_non_null(strstr(small_page(true).data, "<html lang=\"en\" class=\"dark\">"));
}

TEST(pictures_lie_in_the_page)
{
    Text    page = {.arena = test_memory()};
    Picture picture = picture_create(2, 2, test_memory());
    assert_done(page_picture(&page, WILD, &picture, false, arena_reserve(1 << 24), &err));
    assert_ptr_equal(strstr(page.data, "<img alt=\"a&lt;"), page.data);
    assert_non_null(strstr(page.data, " src=\"data:image/png;base64,iVBORw0KGgo"));
}

TEST(parts_become_one_file)
{
    Arena      *arena = test_memory();
    Text        a = {.arena = arena}, b = {.arena = arena}, none = {.arena = arena};
    const Text *parts[] = {&a, &none, &b};
    const char *path = in_folder("page");
    text_add(&a, "one ");
    text_add(&b, "two");
    assert_done(page_write(parts, 3, path, &err));
    assert_string_equal(read_text(path, test_memory()), "one two");
    assert_false(page_write(parts, 3, "/nowhere/at/all", why()));
}

TEST_PROGRAM(make_folder, clear_folder)
