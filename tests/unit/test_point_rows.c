/* SPDX-License-Identifier: Apache-2.0 */
/* Points that face somewhere, from text. */
#include "fixture.h"

#include "base/count.h"
#include "text/point_rows.h"

/* A file of that text. */
static const char *file_of(const char *text) {
    const char *path = in_folder("points.txt");
    write_text(path, text);
    return path;
}

ARENA_TEST(rows_of_any_kind_are_points) {
    const char *path = file_of("\xEF\xBB\xBFX, Y, Z, NX, NY, NZ\r\n"
                               "1 2 3 0 0 2\r\n"
                               "# a remark\n\n"
                               " 1.5;-2;\t3e-1 0 -1e-30 0 # behind\n"
                               "1\t2\t3\t3\t0\t4");
    static const double wanted[][6] = {
        {1, 2, 3, 0, 0, 1}, {1.5, -2, 0.3, 0, -1, 0}, {1, 2, 3, 0.6, 0, 0.8}};
    FacingPoint *list;
    int count;
    assert_done(point_rows_read(path, &arena, &list, &count, &err));
    assert_int_equal(count, 3);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            assert_near(list[i].place[k], wanted[i][k], 1e-15);
            assert_near(list[i].normal[k], wanted[i][3 + k], 1e-15);
        }
}

ARENA_TEST(a_header_gives_the_order) {
    const char *path = file_of("nx ny nz x y z\n0 1 0 7 8 9\n");
    FacingPoint *list;
    int count;
    assert_done(point_rows_read(path, &arena, &list, &count, &err));
    assert_near(list[0].place[0], 7, 0);
    assert_near(list[0].normal[1], 1, 0);
}

ARENA_TEST(what_is_no_point_is_refused_with_its_line) {
    static const struct {
        const char *text, *line, *says;
    } cases[] = {
        {"0 0 0 0 0 1\n0 0 0 0 0 0\n", "line 2", "the normal (0, 0, 0) has no direction"},
        {"0 0 0 0 1\n", "line 1", "has 5 numbers, required X Y Z NX NY NZ"},
        {"0 0 0 0 0 1 2\n", "line 1", "has more than 6 numbers"},
        {"\n0 0 nan 0 0 1\n", "line 2", "'nan'"},
        {"nan 0 0 0 0 1\n", "line 1", "'nan'"},
        {"0 0 inf 0 0 1\n", "line 1", "'inf'"},
        {"0 0 1e400 0 0 1\n", "line 1", "'1e400'"},
        {"0 0 2e9 0 0 1\n", "line 1", "'2e9'"},
        {"0 0 1x 0 0 1\n", "line 1", "'1x'"},
        {"0 0 0x1p7 0 0 1\n", "line 1", "'0x1p7'"},
        {"0 0 1e 0 0 1\n", "line 1", "'1e'"},
        {"0,,0,0,0,1\n", "line 1", "has no number before ','"},
        {",0,0,0,0,1\n", "line 1", "has no number before ','"},
        {"0,0,0,0,0,1,\n", "line 1", "ends with ','"},
        {"0,5 0,5 0,7\n", "line 1", "has commas, and others between its numbers"},
        {"0;5,0;5,0;7\n", "line 1", "has commas, and others between its numbers"},
        {"0 0 0 0,1 0 1\n", "line 1", "has commas, and others between its numbers"},
        {"x y z nx ny\n", "line 1", "its header ends with 'ny'"},
        {"x y z nx ny nx\n", "line 1", "names twice 'nx'"},
        {"x y z u v w\n", "line 1", "its header names 'u'"},
        {"x y z nx ny nz w\n", "line 1", "its header names 'w'"},
        {"0 0 0 0 0 1\nx y z nx ny nz\n", "line 2", "'x'"},
        {"", "", "has no points"},
        {"x y z nx ny nz\n", "", "has no points"},
    };
    for (int i = 0; i < COUNT_OF(cases); i++) {
        const char *path = file_of(cases[i].text);
        FacingPoint *list;
        int count;
        Error err = {0};
        assert_false(point_rows_read(path, &arena, &list, &count, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        if (!strstr(err.text, cases[i].says) || strcmp(err.path, cases[i].line) != 0)
            fail_msg("case %d: %s (%s)", i, err.text, err.path);
    }
}

ARENA_TEST(a_zero_byte_ends_no_number) {
    static const char text[] = "0 0 1\0garbage 0 0 1\n";
    FacingPoint *list;
    int count;
    const char *path = in_folder("points.txt");
    assert_done(file_write(path, text, sizeof text - 1, &err));
    assert_fails(point_rows_read(path, &arena, &list, &count, &err), "has a zero byte behind '1'");
}

TEST_PROGRAM(make_folder, clear_folder)
