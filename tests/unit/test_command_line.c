/* SPDX-License-Identifier: Apache-2.0 */
/* The command line of a part becomes that of the whole. */
#include "fixture.h"

#include "base/count.h"
#include "cli/render/command_line.h"
#include "text/text.h"

static FilmPart box(FilmRect crop, uint32_t first, uint32_t end) {
    return (FilmPart){.width = 64,
                      .height = 48,
                      .crop = crop,
                      .first_sample = first,
                      .end_sample = end,
                      .asked_end = end};
}

ARENA_TEST(words_are_quoted_as_a_shell_needs_it) {
    static const char *const words[][2] = {
        {"plain-1.exr", "plain-1.exr"}, {"", "''"},       {"a b", "'a b'"},  {"$HOME", "'$HOME'"},
        {"it's", "'it'\\''s'"},         {"'", "''\\'''"}, {"*=50", "'*=50'"}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        assert_string_equal(escape_shell(words[i][0], &arena), words[i][1]);
}

ARENA_TEST(idle_words_are_left_out_on_request) {
    char *words[] = {"render",       "a b.gltf",
                     "--threads",    "3",
                     "--quiet",      "--progress=none",
                     "--spp",        "8",
                     "-o",           "f.exr",
                     "--png=f.png",  "--exposure",
                     "auto",         "--checkpoint",
                     "x y",          "--resume",
                     "--live=l.exr", "--",
                     "--quiet"};
    assert_string_equal(command_line_join(COUNT_OF(words), words, false, &arena),
                        "parhelion render 'a b.gltf' --spp 8 -- --quiet");
    assert_string_equal(command_line_join(COUNT_OF(words), words, true, &arena),
                        "parhelion render 'a b.gltf' --threads 3 --quiet --progress=none "
                        "--spp 8 -o f.exr --png=f.png --exposure auto --checkpoint 'x y' "
                        "--resume --live=l.exr -- --quiet");
}

ARENA_TEST(a_part_s_line_becomes_the_whole_s) {
    static const FilmRect all = {0, 0, 64, 48}, half = {0, 0, 32, 48};
    const struct {
        const char *line;
        FilmRect crop;
        uint32_t first, end;
        const char *expected;
    } cases[] = {
        {"parhelion render s.gltf -o a.exr --samples 4:8 --seed 3", all, 0, 8,
         "parhelion render s.gltf --spp 8 --seed 3"},
        {"parhelion render s.gltf -o a.exr --samples 4:8", all, 4, 16,
         "parhelion render s.gltf --samples 4:16"},
        {"parhelion render s.gltf --spp=8 --crop 0,0,5,5 -o=a.exr", all, 0, 8,
         "parhelion render s.gltf --spp 8"},
        {"parhelion render s.gltf --spp 8 --crop=0,0,5,5 -o a.exr", half, 0, 8,
         "parhelion render s.gltf --spp 8 --crop 0,0,32,48"},
        {"parhelion render 'a  b.gltf' -o 'it'\\''s.exr' --samples 0:4 --camera 'x --crop y'", all,
         0, 4, "parhelion render 'a  b.gltf' --spp 4 --camera 'x --crop y'"},
        {"parhelion render s.gltf -o a.exr --png a.png --exposure 3 --view v --display d "
         "--config=c --false-colour luminance --display-level '*=50' --crop 1,1,2,2",
         all, 0, 256, "parhelion render s.gltf --display-level '*=50'"},
        {"parhelion render --isa avx2 --part 3/8 --resume --spp=16 -o a.exr s.gltf", all, 0, 16,
         "parhelion render --isa avx2 --spp=16 s.gltf"},
        {"parhelion render s.gltf --part=3/8 --crop 0,0,32,48 -o a.exr", half, 0, 256,
         "parhelion render s.gltf --crop 0,0,32,48"},
        {"parhelion render -o a.exr --samples 0:4 -- --part -o", all, 0, 4,
         "parhelion render --spp 4 -- --part -o"},
        {"parhelion render -o a.exr --samples 0:4 -- --crop -o", all, 0, 4,
         "parhelion render --spp 4 -- --crop -o"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        FilmPart whole = box(cases[i].crop, cases[i].first, cases[i].end);
        const char *line = command_line_of_whole(cases[i].line, &whole, &arena);
        assert_string_equal(line, cases[i].expected);
    }
    FilmPart whole = box(all, 0, 8);
    assert_string_equal(command_line_of_whole("parhelion render -o a", &whole, &arena),
                        "parhelion render");
    assert_null(command_line_of_whole("parhelion render s.gltf --noise 0.1 --crop 0,0,1,1", &whole,
                                      &arena));
}

TEST_PROGRAM(make_arena, drop_arena)
