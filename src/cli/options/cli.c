/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/cli.h"

#include <assert.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "base/number.h"
#include "base/parallel.h"
#include "print/print.h"
#include "bvh/bvh.h"
#include "cli/options/guides.h"
#include "cli/options/help_json.h"
#include "cli/options/outputs.h"
#include "render/render.h"
#include "text/nearest_word.h"
#include "text/removed.h"

#define NUMBERS_MAX 8
#define SIZE_MAX_PIXELS 65536
#define NAMES_MAX 128 /* options of one command, the common ones included */

/* One run of cli_parse. */
typedef struct Parser {
    const CliCommand *command;
    const Option *common;
    int common_count;
    int argc, next; /* next: the first argument that is not read yet */
    char **argv;
    const char *first[NAMES_MAX]; /* what each option was given first; NULL: not yet */
    Arena *arena;
    Error *err;
} Parser;

/* ---- one value --------------------------------------------------------------------------- */

bool cli_numbers(const char *text, int count, double *out) {
    double values[NUMBERS_MAX];
    for (int i = 0; i < count; i++) {
        const char *end = number_read(text, &values[i]);
        if (!end || *text == ' ' || *text == '\t' || *end != (i + 1 < count ? ',' : '\0'))
            return false;
        text = end + 1;
    }
    memcpy(out, values, sizeof *out * (size_t)count);
    return true;
}

/* Names may have signs of equality as well. */
static const char *find_equals(const char *text) {
    const char *last = strrchr(text, '=');
    double number;
    for (const char *at = strchr(text, '='); at; at = strchr(at + 1, '='))
        if (at > text && at[1] && file_exists(at + 1)) return at;
    return last && cli_numbers(last + 1, 1, &number) ? last : strchr(text, '=');
}

bool cli_name_value(const char *option, const char *text, Arena *arena, const char **name,
                    const char **value, Error *err) {
    const char *equals = find_equals(text);
    if (!equals || equals == text || !equals[1])
        return error_set(err, ERROR_USAGE,
                         "%s %s: required: NAME=VALUE, both not "
                         "empty",
                         option, text);
    *name = arena_string(arena, text, (size_t)(equals - text));
    *value = equals + 1;
    return true;
}

bool cli_is_option(const char *word, const char *name) {
    size_t length = strcspn(word, "=");
    return strlen(name) == length && !strncmp(word, name, length);
}

int cli_option_words(const char *word, bool has_value) {
    return has_value && !strchr(word, '=') ? 2 : 1;
}

static bool has_limits(const Option *option) {
    return option->low != 0 || option->high != 0;
}

static bool bad_value(const Parser *in, const Option *option, const char *text,
                      const char *wanted) {
    return error_set(in->err, ERROR_USAGE,
                     "%s %s: required: %s "
                     "(%s)",
                     option->name, text, wanted, option->value);
}

/* "2147483647", "0.5", "1e-06": whole numbers in full. */
static void print_number(char buffer[32], double value) {
    bool is_whole = value == floor(value) && fabs(value) < 1e15;
    snprintf(buffer, 32, is_whole ? "%.0f" : "%.9g", value);
}

static bool inside_limits(const Parser *in, const Option *option, double value) {
    char found[32], low[32], high[32];
    if (!has_limits(option) || (value >= option->low && value <= option->high)) return true;
    print_number(found, value);
    print_number(low, option->low);
    print_number(high, option->high);
    if (isinf(option->high))
        return error_set(in->err, ERROR_USAGE, "%s: %s is out of range, required: at least %s",
                         option->name, found, low);
    return error_set(in->err, ERROR_USAGE, "%s: %s is out of range, required: %s to %s",
                     option->name, found, low, high);
}

static bool read_numbers(const Parser *in, const Option *option, const char *text, int count) {
    double values[NUMBERS_MAX];
    char wanted[64] = "a number";
    if (count > 1) snprintf(wanted, sizeof wanted, "%d numbers with commas between", count);
    if (!cli_numbers(text, count, values)) return bad_value(in, option, text, wanted);
    for (int i = 0; i < count; i++)
        if (!inside_limits(in, option, values[i])) return false;
    memcpy(option->out, values, sizeof *values * (size_t)count);
    return true;
}

static bool read_integer(const Parser *in, const Option *option, const char *text) {
    uint64_t count;
    bool is_below = *text == '-';
    const char *end = number_read_count(text + (is_below || *text == '+'), &count);
    if (!end || *end || count > LONG_MAX) return bad_value(in, option, text, "a whole number");
    long value = is_below ? -(long)count : (long)count;
    if (!inside_limits(in, option, (double)value)) return false;
    *(long *)option->out = value;
    return true;
}

static bool read_size(const Parser *in, const Option *option, const char *text) {
    uint64_t width, height;
    const char *at = number_read_count(text, &width);
    at = at && *at == 'x' ? number_read_count(at + 1, &height) : NULL;
    if (!at || *at || width < 1 || height < 1 || width > SIZE_MAX_PIXELS ||
        height > SIZE_MAX_PIXELS)
        return bad_value(in, option, text, "a size in pixels such as 1280x720, each 1 to 65536");
    ((int *)option->out)[0] = (int)width;
    ((int *)option->out)[1] = (int)height;
    return true;
}

static bool refuse_choice(const Parser *in, const Option *option, const char *text) {
    const char *instead = removed_instead(option->name, text);
    if (!instead) return bad_value(in, option, text, "one of these");
    return error_set(in->err, ERROR_USAGE, "%s %s was removed — %s", option->name, text, instead);
}

static bool read_choice(const Parser *in, const Option *option, const char *text) {
    const char *name = option->value;
    for (int index = 0;; index++) {
        size_t length = strcspn(name, "|");
        if (strlen(text) == length && !strncmp(text, name, length)) {
            *(int *)option->out = index;
            return true;
        }
        if (!name[length]) return refuse_choice(in, option, text);
        name += length + 1;
    }
}

static void append_text(CliTexts *texts, const char *text, Arena *arena) {
    if (texts->count == texts->capacity) {
        texts->capacity = 2 * texts->capacity + 8;
        texts->list = ARENA_GROW(arena, const char *, texts->list, texts->count, texts->capacity);
    }
    texts->list[texts->count++] = text;
}

static bool read_value(const Parser *in, const Option *option, const char *text) {
    switch (option->kind) {
    case OPTION_FLAG: *(bool *)option->out = true; return true;
    case OPTION_TEXT:
        if (!*text) return bad_value(in, option, "''", "a text that is not empty");
        *(const char **)option->out = text;
        return true;
    case OPTION_NUMBER: return read_numbers(in, option, text, 1);
    case OPTION_NUMBERS: return read_numbers(in, option, text, option->count);
    case OPTION_INTEGER: return read_integer(in, option, text);
    case OPTION_SIZE: return read_size(in, option, text);
    case OPTION_CHOICE: return read_choice(in, option, text);
    case OPTION_TEXTS: append_text(option->out, text, in->arena); return true;
    }
    return false;
}

/* ---- the whole line ---------------------------------------------------------------------- */

static const Option *option_at(const Parser *in, int i) {
    int own = in->command->option_count;
    return i < own ? &in->command->options[i] : &in->common[i - own];
}

/* Its place among all options, or -1. */
static int find_place(const Parser *in, const char *name, size_t length) {
    for (int i = 0; i < in->command->option_count + in->common_count; i++) {
        const Option *option = option_at(in, i);
        if (strlen(option->name) == length && !strncmp(option->name, name, length)) return i;
    }
    return -1;
}

static const Option *find_option(const Parser *in, const char *name, size_t length) {
    int place = find_place(in, name, length);
    return place < 0 ? NULL : option_at(in, place);
}

/* What other renderers call an option, and its name here. */
static const struct {
    const char *theirs, *ours;
} called[] = {
    {"--max-depth", "--max-bounces"},
    {"--maxdepth", "--max-bounces"},
    {"--bounces", "--max-bounces"},
    {"-ab", "--max-bounces"},
    {"--nthreads", "--threads"},
    {"--jobs", "--threads"},
    {"--cores", "--threads"},
    {"-j", "--threads"},
    {"-t", "--threads"},
    {"-n", "--threads"},
    {"--output", "-o"},
    {"--outfile", "-o"},
    {"--out", "-o"},
    {"--samples-per-pixel", "--spp"},
    {"--sample-count", "--spp"},
    {"-s", "--spp"},
    {"--spp", "--paths"},
    {"--resolution", "--size"},
    {"--width", "--size"},
    {"--height", "--size"},
    {"--film", "--size"},
    {"--falsecolor", "--false-colour"},
    {"--falsecolour", "--false-colour"},
    {"--false-color", "--false-colour"},
    {"--envmap", "--environment"},
    {"--sky", "--environment"},
    {"--hdri", "--environment"},
    {"--origin", "--eye"},
    {"--viewpoint", "--eye"},
    {"--vp", "--eye"},
    {"-vp", "--eye"},
    {"--target", "--look-at"},
    {"--lookat", "--look-at"},
    {"-vd", "--look-at"},
    {"--vfov", "--fov"},
    {"-vv", "--fov"},
    {"--date", "--when"},
    {"--datetime", "--when"},
    {"--location", "--where"},
    {"--epw", "--weather"},
    {"--denoiser", "--denoise"},
    {"--cropwindow", "--crop"},
    {"--region", "--crop"},
    {"--ev", "--exposure"},
    {"--tonemap", "--view"},
    {"--ocio", "--config"},
    {"--continue", "--resume"},
    {"--interactive", "--live"},
    {"--limits", "--profile"},
    {"--standard", "--profile"},
};

static bool unknown_option(const Parser *in, const char *name, size_t length) {
    const char *names[NAMES_MAX];
    int count = 0;
    for (int i = 0; i < COUNT_OF(called); i++)
        if (strlen(called[i].theirs) == length && !strncmp(called[i].theirs, name, length) &&
            find_place(in, called[i].ours, strlen(called[i].ours)) >= 0)
            return error_set(in->err, ERROR_USAGE,
                             "unknown option %s — here it is called %s; "
                             "`parhelion %s --help` lists what there is",
                             called[i].theirs, called[i].ours, in->command->name);
    for (; count < in->command->option_count + in->common_count; count++)
        names[count] = option_at(in, count)->name;
    char word[64];
    snprintf(word, sizeof word, "%.*s", (int)length, name);
    const char *instead = removed_instead(in->command->name, word);
    if (instead) return error_set(in->err, ERROR_USAGE, "%s was removed — %s", word, instead);
    const char *nearest = nearest_word_meant(word, names, count);
    return error_set(in->err, ERROR_USAGE,
                     "unknown option %.*s — %s%s%s`parhelion %s --help` lists what there is",
                     (int)length, name, nearest ? "did you mean " : "", nearest ? nearest : "",
                     nearest ? "? " : "", in->command->name);
}

/* Only lists may be repeated: of two values one would be dropped. */
static bool stands_once(Parser *in, int place, const char *value) {
    const Option *option = option_at(in, place);
    const char *before = in->first[place];
    in->first[place] = value ? value : "";
    if (!before || option->kind == OPTION_TEXTS) return true;
    if (!value)
        return error_set(in->err, ERROR_USAGE, "%s is given twice: required at most once",
                         option->name);
    return error_set(in->err, ERROR_USAGE,
                     "%s is given twice, %.200s and %.200s: required at most once", option->name,
                     before, value);
}

/* The option at in->argv[in->next], and its value. */
static bool read_option(Parser *in) {
    const char *text = in->argv[in->next++];
    size_t length = strcspn(text, "=");
    int place = find_place(in, text, length);
    if (place < 0) return unknown_option(in, text, length);
    const Option *option = option_at(in, place);
    const char *value = text[length] ? text + length + 1 : NULL;
    if (option->kind == OPTION_FLAG) {
        if (value)
            return error_set(in->err, ERROR_USAGE, "%s takes no value, found %s", option->name,
                             value);
    } else if (!value) {
        if (in->next == in->argc)
            return error_set(in->err, ERROR_USAGE, "%s needs a value: %s, %s", option->name,
                             option->value, option->help);
        value = in->argv[in->next++];
    }
    if (!stands_once(in, place, value) || !read_value(in, option, value)) return false;
    if (option->given) *option->given = true;
    return true;
}

static bool count_arguments(const Parser *in, int count) {
    const CliCommand *command = in->command;
    if (count < command->min_arguments)
        return error_set(in->err, ERROR_USAGE, "too few arguments — usage: parhelion %s %s",
                         command->name, command->usage);
    if (command->max_arguments >= 0 && count > command->max_arguments)
        return error_set(in->err, ERROR_USAGE, "too many arguments — usage: parhelion %s %s",
                         command->name, command->usage);
    return true;
}

static void print_options(const Option *options, int count) {
    for (int i = 0; i < count; i++) {
        const Option *option = &options[i];
        char left[256];
        snprintf(left, sizeof left, "%s%s%s", option->name, option->value ? " " : "",
                 option->value ? option->value : "");
        if (strlen(left) <= 30) print("  %-30s", left);
        else print("  %s\n  %-30s", left, "");
        print("  %s%s\n", option->help, option->kind == OPTION_TEXTS ? "; repeatable" : "");
    }
}

void cli_print_guide(const char *command) {
    const Guide *guide = guide_of_command(command);
    if (guide) print("\nguide: parhelion help %s\n", guide->name);
}

static void print_row(void *user, const char *name, const char *text) {
    (void)user;
    print("  %-12s %s\n", name, text);
}

static void print_help(const Parser *in) {
    const CliCommand *command = in->command;
    print("parhelion %s: %s\n\nusage: parhelion %s %s\n\n", command->name, command->summary,
          command->name, command->usage);
    print_options(command->options, command->option_count);
    if (command->option_count) print("\n");
    print_options(in->common, in->common_count);
    print("\nexample:\n  %s\n", command->example);
    if (command->each_row) {
        print("\n%s:\n", command->rows_title);
        command->each_row(print_row, NULL);
    }
    cli_print_guide(command->name);
}

static bool read_line(Parser *in, CliTexts *arguments) {
    bool only_arguments = false;
    while (in->next < in->argc) {
        const char *text = in->argv[in->next];
        if (!only_arguments && !strcmp(text, "--")) {
            only_arguments = true;
            in->next++;
        } else if (!only_arguments && text[0] == '-' && text[1]) {
            if (!read_option(in)) return false;
        } else {
            append_text(arguments, in->argv[in->next++], in->arena);
        }
    }
    return true;
}

bool cli_is_help(const char *word) {
    return !strcmp(word, "--help") || !strcmp(word, "-h");
}

bool cli_is_version(const char *word) {
    return !strcmp(word, "--version") || !strcmp(word, "-V");
}

/* Help or the version is requested somewhere before `--`, and not as the value of an option:
 * then nothing else counts but --json. Help goes first. *prints: false: it cannot be printed. */
static bool asks_for_help(const Parser *in, bool *prints) {
    bool wants_help = false, wants_version = false, wants_json = false;
    *prints = true;
    for (int i = 1; i < in->argc && strcmp(in->argv[i], "--"); i++) {
        const char *word = in->argv[i];
        const Option *option = word[0] == '-' ? find_option(in, word, strlen(word)) : NULL;
        wants_help = wants_help || cli_is_help(word);
        wants_json = wants_json || !strcmp(word, "--json");
        wants_version = wants_version || cli_is_version(word);
        if (option && option->kind != OPTION_FLAG) i++;
    }
    if (wants_help && wants_json)
        *prints = help_json_command(in->command, in->common, in->common_count, in->err);
    else if (wants_help) print_help(in);
    else if (wants_version) version_print();
    return wants_help || wants_version;
}

/* Outputs are noted; every other text may name a file that is read. */
static bool check_outputs(const Parser *in, const CliTexts *arguments, Cli *cli) {
    CliTexts words = {0};
    append_text(&words, getenv("OCIO"), in->arena);
    for (int i = 0; i < arguments->count; i++) append_text(&words, arguments->list[i], in->arena);
    for (int i = 0; i < in->command->option_count; i++) {
        const Option *option = option_at(in, i);
        const CliTexts *list = option->out;
        bool is_list = option->kind == OPTION_TEXTS;
        if (!in->first[i] || (option->kind != OPTION_TEXT && !is_list)) continue;
        if (option->file) outputs_note(&cli->outputs, option->name, *(const char **)option->out);
        for (int k = 0; is_list && k < list->count; k++)
            append_text(&words, list->list[k], in->arena);
        if (!is_list && option->file != OPTION_OUTPUT)
            append_text(&words, *(const char **)option->out, in->arena);
    }
    return outputs_spare_words(&cli->outputs, &words, in->err);
}

static bool is_help_alone(const Parser *in) {
    return in->argc == 2 && !strcmp(in->argv[1], "help") && !file_exists("help");
}

bool cli_parse(const CliCommand *command, int argc, char **argv, Arena *arena, Cli *out,
               Error *err) {
    Cli cli = {0};
    int progress = PROGRESS_AUTO;
    long threads = parallel_default_threads();
    const Option common[] = {
        {"--json", OPTION_FLAG, NULL, "the answer as one JSON document on stdout", &cli.json},
        {"--quiet", OPTION_FLAG, NULL, "no progress", &cli.quiet},
        {"--progress", OPTION_CHOICE, "auto|bar|plain|json|none",
         "how progress is shown on stderr (default auto)", &progress},
        {"--threads", OPTION_INTEGER, "N", "threads (default: what the scheduler allows)", &threads,
         .low = 1, .high = PARALLEL_THREADS_MAX},
        {"--help", OPTION_FLAG, NULL, "this text; also -h", &cli.help_shown},
        {"--version", OPTION_FLAG, NULL, "of the program and its libraries; also -V",
         &cli.help_shown},
    };
    Parser in = {.command = command,
                 .common = common,
                 .common_count = COUNT_OF(common),
                 .argc = argc,
                 .next = 1,
                 .argv = argv,
                 .arena = arena,
                 .err = err};
    assert(command->option_count + COUNT_OF(common) <= NAMES_MAX);
    CliTexts arguments = {0};
    bool prints;
    cli.help_shown = asks_for_help(&in, &prints);
    if (!prints) return false;
    if (!cli.help_shown) {
        if (!read_line(&in, &arguments)) return false;
        cli.help_shown = is_help_alone(&in);
        if (cli.help_shown) print_help(&in);
        else if (!count_arguments(&in, arguments.count) || !check_outputs(&in, &arguments, &cli))
            return false;
    }
    cli.progress = cli.quiet ? PROGRESS_NONE : (ProgressMode)progress;
    cli.threads = (int)threads;
    cli.arguments = arguments.list;
    cli.argument_count = arguments.count;
    *out = cli;
    return true;
}

void version_print(void) {
    const Kernel *kernel;
    Error err;
    bool chosen = kernel_choose(NULL, &kernel, &err);
    print("parhelion %s\nsources: %s\ninstruction set: %s\nlibraries: %s, %s\n", PARHELION_VERSION,
          SOURCES_HASH, chosen ? kernel->isa : "none", bvh_library(), LIBRARY_VERSIONS);
}
