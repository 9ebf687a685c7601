/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion help: the commands and the guides, or one of them. */
#include "cli/cmd_help.h"

#include "print/print.h"
#include "base/program.h"
#include "cli/commands.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/guides.h"
#include "cli/options/help_json.h"
#include "text/nearest_word.h"

#define WORDS_MAX 8   /* of a command's name: "panel fit" */
#define NAMES_MAX 128 /* commands and guides */
#define SUMMARY "physically correct frames of dashboards with measured displays"

/* A checkout has them two folders above the program that was built in it. */
static bool find_scenes(char path[static PATH_MAX]) {
    const ProgramPart scenes = {"the folder of scenes", "../../scenes", INSTALLED_SHARE "/scenes"};
    Error none;
    return program_find(&scenes, path, &none);
}

void cmd_help_print(FILE *out) {
    char scenes[PATH_MAX];
    print_to(out, "parhelion: " SUMMARY "\n\n"
                  "usage: parhelion COMMAND ... | help [NAME] | -h | -V\n\n");
    for (int i = 0; i < command_count; i++)
        print_to(out, "  %-18s %s\n", command_table[i]->name, command_table[i]->summary);
    print_to(out, "\nparhelion COMMAND --help tells the options of each, with an example.\n"
                  "Guides, shown by parhelion help NAME:\n\n");
    for (int i = 0; i < guide_count; i++) {
        const char *title;
        int length = guide_title(&guide_table[i], &title);
        print_to(out, "  %-18s %.*s\n", guide_table[i].name, length, title);
    }
    print_to(out, "\nscenes/ of the examples: %s\n",
             find_scenes(scenes) ? scenes : "not installed (the package parhelion-scenes)");
}

static bool unknown_name(const char *name, Error *err) {
    const char *names[NAMES_MAX];
    char advice[700];
    int count = 0;
    for (int i = 0; i < command_count; i++) names[count++] = command_table[i]->name;
    for (int i = 0; i < guide_count && count < NAMES_MAX; i++) names[count++] = guide_table[i].name;
    nearest_word_advice(name, names, count, advice, (int)sizeof advice);
    return error_set(err, ERROR_USAGE, "there is no command or guide %s — %s", name, advice);
}

/* `help panel fit` is `panel fit --help`; every word behind a command is one of its own. */
static bool print_command(const Command *command, const Cli *cli, Arena *arena, Error *err) {
    char *line[] = {(char *)cli->arguments[0], (char *)"--help",
                    cli->json ? (char *)"--json" : NULL, NULL};
    for (int i = 1; i < cli->argument_count; i++) {
        const char *word = cli->arguments[i];
        if (!command->sub)
            return error_set(err, ERROR_USAGE, "help %s: %s has no commands of its own", word,
                             command->name);
        command = command_find(command->sub, command->sub_count, command->name, word, err);
        if (!command) return false;
        line[0] = (char *)word;
    }
    return command->run(2 + cli->json, line, arena, err) == OUTCOME_DONE;
}

static bool print_guide(const Guide *guide, const Cli *cli, Error *err) {
    if (!cli->json) return print_own(stdout, guide->text), true;
    const char *title;
    int length = guide_title(guide, &title);
    return cli_print_json(json_pack("{s:s, s:s%, s:s}", "name", guide->name, "title", title,
                                    (size_t)length, "text", guide->text),
                          err);
}

static bool print_json(Arena *arena, Error *err) {
    char scenes[PATH_MAX];
    json_t *guides = json_array();
    for (int i = 0; i < guide_count; i++) {
        const char *title;
        int length = guide_title(&guide_table[i], &title);
        json_array_append_new(guides, json_pack("{s:s, s:s%}", "name", guide_table[i].name, "title",
                                                title, (size_t)length));
    }
    json_t *head = json_pack("{s:s, s:s, s:s, s:s?, s:o}", "name", "parhelion", "version",
                             PARHELION_VERSION, "summary", SUMMARY, "scenes",
                             find_scenes(scenes) ? scenes : NULL, "guides", guides);
    return help_json_group(head, command_table, command_count, arena, err);
}

static bool help(const Cli *cli, Arena *arena, Error *err) {
    if (!cli->argument_count && cli->json) return print_json(arena, err);
    if (!cli->argument_count) return cmd_help_print(stdout), true;
    Error no_command;
    const char *name = cli->arguments[0];
    const Command *command = command_find(command_table, command_count, NULL, name, &no_command);
    const Guide *guide = guide_named(name);
    if (command) return print_command(command, cli, arena, err);
    if (!guide) return unknown_name(name, err);
    if (cli->argument_count > 1)
        return error_set(err, ERROR_USAGE, "help %s: %s is one page", cli->arguments[1], name);
    return print_guide(guide, cli, err);
}

static Outcome run_help(int argc, char **argv, Arena *arena, Error *err) {
    const CliCommand command = {
        "help",   command_help.summary, "[COMMAND|GUIDE]", "parhelion help comparing", NULL, 0, 0,
        WORDS_MAX};
    Cli cli;
    if (!cli_parse(&command, argc, argv, arena, &cli, err)) return OUTCOME_FAILED;
    return outcome_of(cli.help_shown || help(&cli, arena, err));
}

const Command command_help = {"help", "the commands and the guides, or one of them", run_help};
