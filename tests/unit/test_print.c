/* SPDX-License-Identifier: Apache-2.0 */
/* What may be shown of a foreign text, and how it is printed. */
#include "fixture.h"

#include "print/print.h"
#include "print/printable.h"
#include "print/utf8.h"

/* ---- what is obeyed ---------------------------------------------------------------------- */

/* Unicode's general category Cc, Zl and Zp, the characters of UAX 9's tables 1 to 3, and of
 * category Cf what shows nothing and joins no letters. */
static bool is_escaped(unsigned code) {
    static const unsigned LISTED[] = {0x61c,  0x200e, 0x200f, 0x2028, 0x2029, 0x202a, 0x202b,
                                      0x202c, 0x202d, 0x202e, 0x2066, 0x2067, 0x2068, 0x2069,
                                      0xfffe, 0xffff, 0xad,   0x180e, 0x200b, 0x2060, 0x2061,
                                      0x2062, 0x2063, 0x2064, 0x206a, 0x206b, 0x206c, 0x206d,
                                      0x206e, 0x206f, 0xfeff, 0xfff9, 0xfffa, 0xfffb};
    bool is = code < 0x20 || (code >= 0x7f && code < 0xa0);
    for (size_t i = 0; i < sizeof LISTED / sizeof *LISTED; i++) is = is || code == LISTED[i];
    return is;
}

ARENA_TEST(a_character_is_itself_or_its_escape) {
    for (unsigned code = 1; code < 0x11000; code++) {
        char bytes[UTF8_BYTES_MAX + 1] = "", escape[16];
        if (code >> 11 == 0x1b) continue; /* surrogates are no characters */
        utf8_encode(code, bytes);
        snprintf(escape, sizeof escape, "\\u%04X", code);
        Arena scratch = arena;
        assert_string_equal(arena_printable(&scratch, bytes), is_escaped(code) ? escape : bytes);
    }
}

ARENA_TEST(bytes_that_are_no_character_are_escaped) {
    assert_string_equal(arena_printable(&arena, "display é µ ₂ 𝄞"), "display é µ ₂ 𝄞");
    assert_string_equal(arena_printable(&arena, "a\xff\xc3(\xe2\x82"
                                                "b\xc0\x80"),
                        "a\\xFF\\xC3(\\xE2\\x82b\\xC0\\x80");
    assert_string_equal(arena_printable(&arena, "\xed\xa0\x80"), "\\xED\\xA0\\x80");
    assert_string_equal(arena_printable(&arena, "\xf0\x9d"), "\\xF0\\x9D"); /* cut short */
}

ARENA_TEST(what_is_escaped_stays) {
    const char *once = arena_printable(&arena, "\x1b]8;;x\a\\u001B\xff\xe2\x80\xae");
    assert_string_equal(once, "\\u001B]8;;x\\u0007\\u001B\\xFF\\u202E");
    assert_string_equal(arena_printable(&arena, once), once);
    assert_int_equal(printable_size(once), strlen(once) + 1);
}

/* Never within an escape or a character. */
TEST(a_copy_is_cut_between_characters) {
    static const char *const CUT[] = {NULL, "",   "a",  "a",  "aé",        "aé",
                                      "aé", "aé", "aé", "aé", "aé\\u001B", "aé\\u001Bb"};
    char to[16];
    for (size_t size = 1; size < sizeof CUT / sizeof *CUT; size++) {
        printable_copy(to, size,
                       "aé\x1b"
                       "b");
        assert_string_equal(to, CUT[size]);
    }
}

/* ---- printing ---------------------------------------------------------------------------- */

static char printed[512];

#define PRINT(...) \
    (fflush(to), rewind(to), memset(printed, 0, sizeof printed), print_to(to, __VA_ARGS__))

/* What is no text is the C library's. */
TEST(numbers_are_those_of_printf) {
    char wanted[256];
    FILE *to = fmemopen(printed, sizeof printed, "w");
#define SAME(...) \
    do { \
        int count = PRINT(__VA_ARGS__); \
        fflush(to); \
        assert_int_equal(count, snprintf(wanted, sizeof wanted, __VA_ARGS__)); \
        assert_string_equal(printed, wanted); \
    } while (0)
    SAME("%d|%5d|%-5d|%05d|%+d|% d|%.3d|%*d|%-*d|%u", -1, 2, 3, 4, 5, 6, 7, 8, 9, -8, 1, 12u);
    SAME("%ld|%lld|%zu|%lu|%llu|%016llx|%02x|%#x|%X|%o|%hhd", -1L, -2LL, (size_t)3, 4UL, 5ULL, 6ULL,
         7u, 8u, 255u, 8u, (signed char)9);
    SAME("%g|%.4g|%-12.3g|%+.2f|%12.6e|%.*g|%*.*f|%g|%g", 0.1, 1.0 / 3, 2.5, 3.25, 4e10, 3, 1.5, 9,
         2, 7.125, NAN, INFINITY);
    SAME("%s|%10s|%-10s|%.2s|%*s|%-*.*s|%c|%%", "a", "b", "c", "def", 4, "g", 5, 1, "hi", 'j');
    fclose(to);
}

TEST(texts_are_escaped_and_counted_as_they_are_shown) {
    FILE *to = fmemopen(printed, sizeof printed, "w");
    int count = PRINT("%s\n\r%-8s|%8s|%c", "a\npass\r\x1b[2K", "é\n", "\xff", '\x9b');
    fflush(to);
    assert_string_equal(printed, "a\\u000Apass\\u000D\\u001B[2K\n\ré\\u000A |    \\xFF|\\x9B");
    assert_int_equal(count, 50);
    fclose(to);
}

TEST_PROGRAM(make_arena, drop_arena)
