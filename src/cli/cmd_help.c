/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion help: the commands and the guides, or one of them. */
#include "cli/cmd_help.h"

#include "base/count.h"
#include "print/print.h"
#include "base/program.h"
#include "cli/commands.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/completion.h"
#include "cli/options/guide_index.h"
#include "cli/options/guides.h"
#include "cli/options/man_page.h"
#include "text/nearest_word.h"

#define WORDS_MAX 8   /* of a command's name: "panel fit" */
#define NAMES_MAX 128 /* commands and guides */
#define SUMMARY "physically correct frames of dashboards with measured displays"

/* The command line of `help`. */
typedef struct HelpWords {
    Cli      cli;
    HelpForm form;
} HelpWords;

/* A checkout has them two folders above the program that was built in it. */
static bool find_scenes(char path[static PATH_MAX])
{
    const ProgramPart scenes = {"the folder of scenes", "../../scenes",
                                INSTALLED_SHARE "/scenes"};
    Error             none;
    return program_find(&scenes, path, &none);
}

void cmd_help_print(FILE *out)
{
    char scenes[PATH_MAX];
    print_to(out, "parhelion: " SUMMARY "\n\n"
                  "usage: parhelion COMMAND ... | help [NAME] | -h | -V\n\n");
    for (int i = 0; i < command_count; i++)
        print_to(out, "  %-18s %s\n", command_table[i]->name, command_table[i]->summary);
    print_to(out, "\nparhelion COMMAND --help tells the options of each, with an example.\n"
                  "Guides, shown by parhelion help NAME:\n\n");
    for (int i = 0; i < guide_count; i++) {
        const char *title;
        int         length = guide_title(&guide_table[i], &title);
        print_to(out, "  %-18s %.*s\n", guide_table[i].name, length, title);
    }
    print_to(out, "\nscenes/ of the examples: %s\n",
             find_scenes(scenes) ? scenes : "not installed (the package parhelion-scenes)");
}

#define HITS 5

/* The sections that are about a word; false: no page has it. */
static bool print_word(const char *word, const Cli *cli, bool *prints, Error *err)
{
    GuideHit hits[HITS];
    int      count = guide_index_find(word, hits, HITS);
    *prints = true;
    if (!count) return false;
    if (cli->json) {
        json_t *list = json_array();
        for (int i = 0; i < count; i++)
            json_array_append_new(list, json_pack("{s:s, s:s%, s:s%}", "guide",
                                                  hits[i].guide->name, "section",
                                                  hits[i].heading, (size_t)hits[i].length,
                                                  "line", hits[i].line,
                                                  (size_t)hits[i].line_length));
        *prints = cli_print_json(json_pack("{s:s, s:o}", "word", word, "pages", list), err);
        return true;
    }
    print("%s is in these pages (parhelion help NAME shows one):\n\n", word);
    for (int i = 0; i < count; i++)
        print("  %-18s %.*s\n                     %.*s\n", hits[i].guide->name,
              hits[i].length, hits[i].heading, hits[i].line_length, hits[i].line);
    return true;
}

static bool unknown_name(const char *name, Error *err)
{
    const char *names[NAMES_MAX];
    char        advice[700];
    int         count = 0;
    for (int i = 0; i < command_count; i++) names[count++] = command_table[i]->name;
    for (int i = 0; i < guide_count && count < NAMES_MAX; i++)
        names[count++] = guide_table[i].name;
    nearest_word_advice(name, names, count, advice, (int)sizeof advice);
    return error_set(err, ERROR_USAGE, "there is no command or guide %s — %s", name, advice);
}

static const char *const help_words[] = {
    [HELP_TEXT] = "--help", [HELP_MAN] = "--help=man", [HELP_COMPLETION] = "--help=completion"};

/* `help panel fit` is `panel fit --help`; every word behind a command is one of its own. */
static bool print_command(const Command *command, const HelpWords *words, Arena *arena,
                          Error *err)
{
    const Cli *cli = &words->cli;
    char      *line[] = {(char *)cli->arguments[0], (char *)help_words[words->form], NULL};
    for (int i = 1; i < cli->argument_count; i++) {
        const char *word = cli->arguments[i];
        if (!command->sub)
            return error_set(err, ERROR_USAGE, "help %s: %s has no commands of its own", word,
                             command->name);
        command = command_find(command->sub, command->sub_count, command->name, word, err);
        if (!command) return false;
        line[0] = (char *)word;
    }
    return command->run(2, line, arena, err) == OUTCOME_DONE;
}

static bool print_guide(const Guide *guide, const HelpWords *words, Error *err)
{
    if (words->form == HELP_MAN) return man_guide_print(guide), true;
    if (!words->cli.json) return print_own(stdout, guide->text), true;
    const char *title;
    int         length = guide_title(guide, &title);
    return cli_print_json(json_pack("{s:s, s:s%, s:s}", "name", guide->name, "title", title,
                                    (size_t)length, "text", guide->text), err);
}

static json_t *commands_json(const Command *const *list, int count)
{
    json_t *all = json_array();
    for (int i = 0; i < count; i++) {
        json_t *row = json_pack("{s:s, s:s}", "name", list[i]->name, "summary",
                                list[i]->summary);
        if (list[i]->sub)
            json_object_set_new(row, "commands", commands_json(list[i]->sub,
                                                               list[i]->sub_count));
        json_array_append_new(all, row);
    }
    return all;
}

static bool print_json(Error *err)
{
    char    scenes[PATH_MAX];
    json_t *guides = json_array();
    for (int i = 0; i < guide_count; i++) {
        const char *title;
        int         length = guide_title(&guide_table[i], &title);
        json_array_append_new(guides, json_pack("{s:s, s:s%}", "name", guide_table[i].name,
                                                "title", title, (size_t)length));
    }
    return cli_print_json(json_pack("{s:o, s:o, s:s?}", "commands",
                                    commands_json(command_table, command_count), "guides",
                                    guides, "scenes", find_scenes(scenes) ? scenes : NULL),
                          err);
}

static bool print_list(const HelpWords *words, Error *err)
{
    if (words->form == HELP_MAN)
        return man_page_print_program(SUMMARY, command_table, command_count), true;
    if (words->cli.json) return print_json(err);
    return cmd_help_print(stdout), true;
}

/* A row for every command, by its own help. */
static bool print_rows(const Command *const *list, int count, Arena *arena, Error *err)
{
    char *line[] = {NULL, (char *)help_words[HELP_COMPLETION], NULL};
    for (int i = 0; i < count; i++) {
        line[0] = (char *)list[i]->name;
        if (list[i]->run(2, line, arena, err) != OUTCOME_DONE ||
            !print_rows(list[i]->sub, list[i]->sub_count, arena, err))
            return false;
    }
    return true;
}

static bool print_completion(Arena *arena, Error *err)
{
    completion_print_head();
    completion_print_group("", command_table, command_count);
    if (!print_rows(command_table, command_count, arena, err)) return false;
    completion_print_tail();
    return true;
}

static bool help(const HelpWords *words, Arena *arena, Error *err)
{
    const Cli *cli = &words->cli;
    if (words->form == HELP_COMPLETION) return print_completion(arena, err);
    if (!cli->argument_count) return print_list(words, err);
    Error          no_command;
    const Command *command =
        command_find(command_table, command_count, NULL, cli->arguments[0], &no_command);
    const Guide   *guide = guide_named(cli->arguments[0]);
    if (command) return print_command(command, words, arena, err);
    if (guide && cli->argument_count > 1)
        return error_set(err, ERROR_USAGE, "help %s: %s is one page", cli->arguments[1],
                         cli->arguments[0]);
    if (guide) return print_guide(guide, words, err);
    if (cli->argument_count > 1)
        return error_set(err, ERROR_USAGE, "help %s: behind %s, which is no command; required: "
                         "one word", cli->arguments[1], cli->arguments[0]);
    bool prints, is_word = print_word(cli->arguments[0], cli, &prints, err);
    return is_word ? prints : unknown_name(cli->arguments[0], err);
}

static Outcome run_help(int argc, char **argv, Arena *arena, Error *err)
{
    bool         is_man = false;
    int          shell = -1;
    const Option options[] = {
        {"--man", OPTION_FLAG, NULL, "the page as source of a manual page (man -l FILE)",
         &is_man},
        {"--completion", OPTION_CHOICE, "bash",
         "what completes commands, options and files in a shell, which is to read it", &shell},
    };
    const CliCommand command = {
        "help", "the commands and the guides, or one of them", "[COMMAND|GUIDE]",
        "parhelion help comparing", options, COUNT_OF(options), 0, WORDS_MAX};
    HelpWords words = {.form = HELP_TEXT};
    if (!cli_parse(&command, argc, argv, arena, &words.cli, err)) return OUTCOME_FAILED;
    if (words.cli.help_shown) return OUTCOME_DONE;
    if (is_man + (shell >= 0) + words.cli.json > 1)
        return error_set(err, ERROR_USAGE, "--man, --completion and --json exclude each other");
    if (shell >= 0 && words.cli.argument_count)
        return error_set(err, ERROR_USAGE, "--completion knows all commands: %s is too much",
                         words.cli.arguments[0]);
    if (is_man) words.form = HELP_MAN;
    if (shell >= 0) words.form = HELP_COMPLETION;
    return outcome_of(help(&words, arena, err));
}

const Command command_help = {"help", "the commands and the guides, or one of them", run_help};
