/* parhelion help: the commands and the guides, or one of them. */
#include "cli/cmd_help.h"

#include <string.h>

#include "cli/commands.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/guides.h"
#include "text/nearest_word.h"

#define WORDS_MAX 8   /* of a command's name: "panel fit" */
#define NAMES_MAX 128 /* commands and guides */

void cmd_help_print(FILE *out)
{
    fprintf(out, "parhelion: physically correct frames of dashboards with measured displays\n\n"
                 "usage: parhelion COMMAND ... | help [NAME] | -h | -V\n\n");
    for (int i = 0; i < command_count; i++)
        fprintf(out, "  %-18s %s\n", command_table[i]->name, command_table[i]->summary);
    fprintf(out, "\nparhelion COMMAND --help tells the options of each, with an example.\n"
                 "Guides, shown by parhelion help NAME:\n\n");
    for (int i = 0; i < guide_count; i++) {
        const char *title;
        int         length = guide_title(&guide_table[i], &title);
        fprintf(out, "  %-18s %.*s\n", guide_table[i].name, length, title);
    }
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

/* `help panel fit` is `panel fit --help`; every word behind a command is one of its own. */
static bool print_command(const Command *command, const Cli *cli, Arena *arena, Error *err)
{
    char  option[] = "--help";
    char *line[] = {(char *)cli->arguments[0], option, NULL};
    for (int i = 1; i < cli->argument_count; i++) {
        const char *word = cli->arguments[i];
        if (!command->sub)
            return error_set(err, ERROR_USAGE, "help %s: %s has no commands of its own", word,
                             command->name);
        command = command_find(command->sub, command->sub_count, command->name, word, err);
        if (!command) return false;
        line[0] = (char *)word;
    }
    return command->run(2, line, arena, err);
}

static bool print_guide(const Guide *guide, const Cli *cli, Error *err)
{
    if (!cli->json) return fputs(guide->text, stdout), true;
    const char *title;
    int         length = guide_title(guide, &title);
    return cli_print_json(json_pack("{s:s, s:s%, s:s}", "name", guide->name, "title", title,
                                    (size_t)length, "text", guide->text), err);
}

static bool print_list(const Cli *cli, Error *err)
{
    if (!cli->json) return cmd_help_print(stdout), true;
    json_t *commands = json_array(), *guides = json_array();
    for (int i = 0; i < command_count; i++)
        json_array_append_new(commands, json_pack("{s:s, s:s}", "name", command_table[i]->name,
                                                  "summary", command_table[i]->summary));
    for (int i = 0; i < guide_count; i++) {
        const char *title;
        int         length = guide_title(&guide_table[i], &title);
        json_array_append_new(guides, json_pack("{s:s, s:s%}", "name", guide_table[i].name,
                                                "title", title, (size_t)length));
    }
    return cli_print_json(json_pack("{s:o, s:o}", "commands", commands, "guides", guides), err);
}

static bool help(const Cli *cli, Arena *arena, Error *err)
{
    if (!cli->argument_count) return print_list(cli, err);
    const Command *command =
        command_find(command_table, command_count, NULL, cli->arguments[0], err);
    const Guide   *guide = guide_named(cli->arguments[0]);
    if (command) return print_command(command, cli, arena, err);
    return guide ? print_guide(guide, cli, err) : unknown_name(cli->arguments[0], err);
}

static bool run_help(int argc, char **argv, Arena *arena, Error *err)
{
    const CliCommand command = {
        .name = "help", .summary = "the commands and the guides, or one of them",
        .usage = "[COMMAND|GUIDE]", .example = "parhelion help comparing",
        .max_arguments = WORDS_MAX};
    Cli   cli;
    return cli_parse(&command, argc, argv, arena, &cli, err) &&
           (cli.help_shown || help(&cli, arena, err));
}

const Command command_help = {"help", "the commands and the guides, or one of them", run_help};
