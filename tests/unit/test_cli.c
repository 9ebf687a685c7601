/* SPDX-License-Identifier: Apache-2.0 */
/* The option parser: values, and the text of every error. */
#include "fixture.h"

#include "cli/options/cli.h"
#include "base/count.h"
#include "base/parallel.h"
#include "cli/options/answer.h"

/* Everything that an option can be. */
typedef struct Values {
    bool flag, number_given;
    const char *text;
    double number, numbers[3];
    long integer;
    int size[2], choice;
    CliTexts texts;
    Cli cli;
    Error err;
} Values;

/* The words after the command's name, parsed; up to eight. */
static bool parse(const char *const *words, Arena *arena, Values *out) {
    char *argv[10] = {(char *)"try"};
    int argc = 1;
    while (words[argc - 1]) {
        argv[argc] = (char *)(uintptr_t)words[argc - 1];
        argc++;
    }
    *out = (Values){.text = "unset", .number = 7, .integer = 7, .choice = 7};
    const Option options[] = {
        {.name = "--flag", .kind = OPTION_FLAG, .help = "a flag", .out = &out->flag},
        {.name = "--text", .kind = OPTION_TEXT, .value = "TEXT", .help = "t", .out = &out->text},
        {.name = "--number",
         .kind = OPTION_NUMBER,
         .value = "X",
         .help = "a number",
         .out = &out->number,
         .low = -1,
         .high = 2,
         .given = &out->number_given},
        {.name = "--numbers",
         .kind = OPTION_NUMBERS,
         .value = "X,Y,Z",
         .help = "n",
         .out = out->numbers,
         .count = 3},
        {.name = "--integer",
         .kind = OPTION_INTEGER,
         .value = "N",
         .help = "i",
         .out = &out->integer,
         .low = 0,
         .high = 4294967295.0},
        {.name = "--size", .kind = OPTION_SIZE, .value = "WxH", .help = "s", .out = out->size},
        {.name = "--choice",
         .kind = OPTION_CHOICE,
         .value = "red|green|blue",
         .help = "c",
         .out = &out->choice},
        {.name = "--pair", .kind = OPTION_TEXTS, .value = "A=B", .help = "p", .out = &out->texts},
    };
    const CliCommand command = {"try",
                                "tries",
                                "ARGUMENT [MORE]",
                                "parhelion try x",
                                options,
                                (int)(sizeof options / sizeof *options),
                                1,
                                2,
                                NULL,
                                NULL,
                                NULL};
    return cli_parse(&command, argc, argv, arena, &out->cli, &out->err);
}

#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})

MEMORY_TEST(values_come_after_the_option_or_after_an_equals_sign) {
    Values v;
    assert_true(parse(WORDS("file", "--number", "-0.5", "--size=640x480", "--flag"), arena, &v));
    assert_true(v.flag && v.number_given && v.number == -0.5);
    assert_int_equal(v.size[0], 640);
    assert_int_equal(v.size[1], 480);
    assert_int_equal(v.cli.argument_count, 1);
    assert_string_equal(v.cli.arguments[0], "file");
    assert_true(parse(WORDS("file", "--text=a=b", "--choice", "blue", "--integer", "4294967295"),
                      arena, &v));
    assert_string_equal(v.text, "a=b");
    assert_int_equal(v.choice, 2);
    assert_true(v.integer == 4294967295);
    assert_true(parse(WORDS("file", "--numbers", "1,-2e1,.5"), arena, &v));
    assert_true(v.numbers[0] == 1 && v.numbers[1] == -20 && v.numbers[2] == 0.5);
}

MEMORY_TEST(what_is_left_out_keeps_its_value) {
    Values v;
    assert_true(parse(WORDS("file"), arena, &v));
    assert_true(!v.flag && !v.number_given && v.number == 7 && v.integer == 7 && v.choice == 7);
    assert_string_equal(v.text, "unset");
    assert_int_equal(v.texts.count, 0);
    assert_int_equal(v.cli.threads, parallel_default_threads());
    assert_int_equal(v.cli.progress, PROGRESS_AUTO);
    assert_false(v.cli.json);
}

MEMORY_TEST(every_command_has_the_common_options) {
    Values v;
    assert_true(parse(WORDS("file", "--json", "--threads", "3", "--progress", "plain"), arena, &v));
    assert_true(v.cli.json);
    assert_int_equal(v.cli.threads, 3);
    assert_int_equal(v.cli.progress, PROGRESS_PLAIN);
    assert_true(parse(WORDS("file", "--quiet", "--progress=bar"), arena, &v));
    assert_int_equal(v.cli.progress, PROGRESS_NONE);
}

MEMORY_TEST(repeatable_options_keep_their_order) {
    Values v;
    assert_true(parse(WORDS("--pair", "a=1", "--pair=b=2", "--pair", "c=3", "x"), arena, &v));
    assert_int_equal(v.texts.count, 3);
    assert_string_equal(v.texts.list[0], "a=1");
    assert_string_equal(v.texts.list[1], "b=2");
    assert_string_equal(v.texts.list[2], "c=3");
}

MEMORY_TEST(two_dashes_end_the_options_and_one_dash_is_an_argument) {
    Values v;
    assert_true(parse(WORDS("-", "--", "--flag"), arena, &v));
    assert_false(v.flag);
    assert_int_equal(v.cli.argument_count, 2);
    assert_string_equal(v.cli.arguments[0], "-");
    assert_string_equal(v.cli.arguments[1], "--flag");
}

MEMORY_TEST(errors_name_the_option_the_value_and_what_is_wanted) {
    static const struct {
        const char *words[4], *text;
    } cases[] = {
        {{"x", "--nuber", "1"},
         "unknown option --nuber — did you mean --number? `parhelion try --help` lists what "
         "there is"},
        {{"--flag", "--flag", "x"}, "--flag is given twice: required at most once"},
        {{"x", "--number=1", "--number", "2"},
         "--number is given twice, 1 and 2: required at most once"},
        {{"x", "--json", "--json"}, "--json is given twice: required at most once"},
        {{"x", "--zoom", "1"},
         "unknown option --zoom — `parhelion try --help` lists what there is"},
        {{"x", "--numb=1"},
         "unknown option --numb — did you mean --number? `parhelion try --help` lists what "
         "there "
         "is"},
        {{"x", "--nthreads", "2"},
         "unknown option --nthreads — here it is called --threads; `parhelion try --help` "
         "lists what there is"},
        {{"x", "-q"}, "unknown option -q — `parhelion try --help` lists what there is"},
        {{"x", "--number"}, "--number needs a value: X, a number"},
        {{"x", "--flag=1"}, "--flag takes no value, found 1"},
        {{"x", "--number", "3"}, "--number: 3 is out of range, required: -1 to 2"},
        {{"x", "--number", "1x"}, "--number 1x: required: a number (X)"},
        {{"x", "--number", "nan"}, "--number nan: required: a number (X)"},
        {{"x", "--number", " 1"}, "--number  1: required: a number (X)"},
        {{"x", "--integer", "1.5"}, "--integer 1.5: required: a whole number (N)"},
        {{"x", "--integer", "4294967296"},
         "--integer: 4294967296 is out of range, required: 0 to 4294967295"},
        {{"x", "--integer", "99999999999999999999"},
         "--integer 99999999999999999999: required: a whole number (N)"},
        {{"x", "--numbers", "1,2"},
         "--numbers 1,2: required: 3 numbers with commas between (X,Y,Z)"},
        {{"x", "--numbers", "1,2,3,4"},
         "--numbers 1,2,3,4: required: 3 numbers with commas between (X,Y,Z)"},
        {{"x", "--size", "640"},
         "--size 640: required: a size in pixels such as 1280x720, each 1 to 65536 (WxH)"},
        {{"x", "--size", "0x4"},
         "--size 0x4: required: a size in pixels such as 1280x720, each 1 to 65536 (WxH)"},
        {{"x", "--size", "4x70000"},
         "--size 4x70000: required: a size in pixels such as 1280x720, each 1 to 65536 (WxH)"},
        {{"x", "--choice", "re"}, "--choice re: required: one of these (red|green|blue)"},
        {{"x", "--text", ""}, "--text '': required: a text that is not empty (TEXT)"},
        {{NULL}, "too few arguments — usage: parhelion try ARGUMENT [MORE]"},
        {{"x", "y", "z"}, "too many arguments — usage: parhelion try ARGUMENT [MORE]"},
        {{"x", "--threads", "0"}, "--threads: 0 is out of range, required: 1 to 1024"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Values v;
        assert_false(parse(cases[i].words, arena, &v));
        assert_int_equal(v.err.code, ERROR_USAGE);
        assert_string_equal(v.err.text, cases[i].text);
    }
}

MEMORY_TEST(help_wins_over_everything_else_on_the_line) {
    Values v;
    assert_true(parse(WORDS("--nonsense", "--help"), arena, &v));
    assert_true(v.cli.help_shown);
}

MEMORY_TEST(pairs_are_cut_at_the_first_equals_sign) {
    const char *name, *value;
    assert_done(cli_name_value("--content", "map=a=b.png", arena, &name, &value, &err));
    assert_string_equal(name, "map");
    assert_string_equal(value, "a=b.png");
    assert_fails_with(cli_name_value("--content", "map", arena, &name, &value, &err),
                      "--content map: required: NAME=VALUE, both not empty");
    assert_fails(cli_name_value("--content", "=x", arena, &name, &value, &err), "");
    assert_fails(cli_name_value("--content", "x=", arena, &name, &value, &err), "");
}

TEST(an_error_line_puts_the_place_before_the_advice) {
    Error err;
    char line[512];
    error_at(&err, ERROR_INPUT, "a.gltf", "/materials/3", "no panel named 'x' — did you mean 'y'?");
    cli_error_line(&err, line, (int)sizeof line);
    assert_string_equal(line,
                        "parhelion: a.gltf: no panel named 'x' (/materials/3) — did you mean 'y'?");
    error_at(&err, ERROR_INPUT, "a.gltf", "line 7", "bad number");
    cli_error_line(&err, line, (int)sizeof line);
    assert_string_equal(line, "parhelion: a.gltf: bad number (line 7)");
    error_set(&err, ERROR_USAGE, "no output");
    cli_error_line(&err, line, (int)sizeof line);
    assert_string_equal(line, "parhelion: no output");
}

MEMORY_TEST(warnings_are_listed_once_each) {
    Problems problems = problems_start(arena);
    problems_add(&problems, SEVERITY_WARNING, "a", "/b", "odd");
    problems_add(&problems, SEVERITY_WARNING, "a", "/b", "odd");
    problems_add(&problems, SEVERITY_WARNING, "a", "/c", "odd");
    problems_add(&problems, SEVERITY_ERROR, "a", "/b", "bad \xff bytes");
    json_t *warnings = cli_json_problems(&problems, SEVERITY_WARNING);
    json_t *errors = cli_json_problems(&problems, SEVERITY_ERROR);
    assert_int_equal(json_array_size(warnings), 2);
    assert_int_equal(json_array_size(errors), 1);
    assert_string_equal(json_string_value(json_object_get(json_array_get(errors, 0), "message")),
                        "bad \\xFF bytes");
    json_decref(warnings);
    json_decref(errors);
}

TEST_PROGRAM(make_arena, drop_arena)
