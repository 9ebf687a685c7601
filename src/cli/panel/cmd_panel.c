/* SPDX-License-Identifier: Apache-2.0 */
/* panel -- measured displays: the table of its own sub-commands. */
#include <string.h>

#include "base/count.h"
#include "print/print.h"
#include "cli/options/cli.h"
#include "cli/options/completion.h"
#include "cli/options/man_page.h"
#include "cli/panel/panel_commands.h"

static const Command *const commands[] = {
    &command_panel_import,
    &command_panel_fit,
    &command_panel_join,
    &command_panel_info,
    &command_panel_eval,
    &command_panel_export,
    &command_panel_plot,
    &command_panel_report,
    &command_panel_show,
    &command_panel_simulate,
    &command_panel_wavelets,
};

enum { COMMAND_COUNT = COUNT_OF(commands) };

static void print_text(void)
{
    print("parhelion panel COMMAND ... -- measured display panels\n\ncommands:\n");
    for (int i = 0; i < COMMAND_COUNT; i++)
        print("  %-10s %s\n", commands[i]->name, commands[i]->summary);
    print("\nexample: parhelion panel info assets/panels/ips_cluster.panel\n");
    cli_print_guide("panel");
}

static void print_help(HelpForm form)
{
    if (form == HELP_MAN) man_page_print_group(&command_panel);
    else if (form == HELP_COMPLETION)
        completion_print_group(command_panel.name, commands, COMMAND_COUNT);
    else print_text();
}

static Outcome run_panel(int argc, char **argv, Arena *arena, Error *err)
{
    const char *word = argc > 1 ? argv[1] : "";
    if (cli_is_version(word)) return version_print(), OUTCOME_DONE;
    HelpForm form = strcmp(word, "help") ? cli_help_form(word) : HELP_TEXT;
    if (form) return print_help(form), OUTCOME_DONE;
    const Command *command = command_find(commands, COMMAND_COUNT, "panel", word, err);
    return command ? command->run(argc - 1, argv + 1, arena, err) : OUTCOME_FAILED;
}

const Command command_panel = {"panel", "fit, look into and evaluate a measured display panel",
                               run_panel, commands, COMMAND_COUNT};
