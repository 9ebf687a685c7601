/* SPDX-License-Identifier: Apache-2.0 */
/* panel -- measured displays: the table of its own sub-commands. */
#include <string.h>

#include "base/count.h"
#include "print/print.h"
#include "cli/options/cli.h"
#include "cli/options/guides.h"
#include "cli/options/help_json.h"
#include "cli/panel/panel_commands.h"

static const Command *const commands[] = {
    &command_panel_import, &command_panel_fit,    &command_panel_info, &command_panel_eval,
    &command_panel_plot,   &command_panel_report, &command_panel_show, &command_panel_simulate,
};

enum { COMMAND_COUNT = COUNT_OF(commands) };

static void print_text(void) {
    print("parhelion panel COMMAND ... -- measured display panels\n\ncommands:\n");
    for (int i = 0; i < COMMAND_COUNT; i++)
        print("  %-10s %s\n", commands[i]->name, commands[i]->summary);
    print("\nexample: parhelion panel info assets/panels/ips_cluster.panel\n");
    cli_print_guide("panel");
}

static bool print_json(Arena *arena, Error *err) {
    json_t *head = json_pack("{s:s, s:s, s:s}", "name", command_panel.name, "summary",
                             command_panel.summary, "guide", guide_of_command("panel")->name);
    return help_json_group(head, commands, COMMAND_COUNT, arena, err);
}

static Outcome run_panel(int argc, char **argv, Arena *arena, Error *err) {
    const char *word = argc > 1 ? argv[1] : "";
    if (cli_is_version(word)) return version_print(), OUTCOME_DONE;
    if (cli_is_help(word) || !strcmp(word, "help")) {
        bool wants_json = argc > 2 && !strcmp(argv[2], "--json");
        return wants_json ? outcome_of(print_json(arena, err)) : (print_text(), OUTCOME_DONE);
    }
    const Command *command = command_find(commands, COMMAND_COUNT, "panel", word, err);
    return command ? command->run(argc - 1, argv + 1, arena, err) : OUTCOME_FAILED;
}

const Command command_panel = {"panel", "fit, look into and evaluate a measured display panel",
                               run_panel, commands, COMMAND_COUNT};
