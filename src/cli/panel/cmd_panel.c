/* panel -- measured displays: the table of its own sub-commands. */
#include <stdio.h>
#include <string.h>

#include "cli/options/cli.h"
#include "cli/panel/panel_commands.h"

typedef struct PanelCommand {
    const char *name, *summary;
    bool (*run)(int argc, char **argv, Error *err);
} PanelCommand;

static const PanelCommand commands[] = {
    {"import", "the files that laboratories have as one measurement set", cmd_panel_import},
    {"fit", "measurement files to one compressed panel file", cmd_panel_fit},
    {"info", "what a panel file holds, its sizes and errors", cmd_panel_info},
    {"eval", "what a panel emits or reflects in one direction", cmd_panel_eval},
    {"export", "a panel's tables written back, readable by fit", cmd_panel_export},
    {"plot", "pictures of a panel, one by one or all in a report", cmd_panel_plot},
    {"simulate", "a virtual instrument writes a synthetic measurement set", cmd_panel_simulate},
};

#define COMMAND_COUNT ((int)(sizeof commands / sizeof *commands))

static void print_help(void)
{
    printf("parhelion panel COMMAND ... -- measured display panels\n\ncommands:\n");
    for (int i = 0; i < COMMAND_COUNT; i++)
        printf("  %-10s %s\n", commands[i].name, commands[i].summary);
    printf("\nexample: parhelion panel info assets/panels/ips_cluster.panel\n");
    cli_print_guide("panel");
}

bool cmd_panel(int argc, char **argv, Error *err)
{
    const char *names[COMMAND_COUNT];
    if (argc < 2)
        return error_set(err, ERROR_USAGE, 
                         "panel wants a command: fit, info, eval or simulate");
    if (!strcmp(argv[1], "--help") || !strcmp(argv[1], "help")) {
        print_help();
        return true;
    }
    for (int i = 0; i < COMMAND_COUNT; i++) {
        names[i] = commands[i].name;
        if (!strcmp(argv[1], commands[i].name))
            return commands[i].run(argc - 1, argv + 1, err);
    }
    const char *near = cli_nearest(argv[1], names, COMMAND_COUNT);
    return error_set(err, ERROR_USAGE, "panel has no command '%s'%s%s%s", argv[1],
                     near ? "; did you mean '" : ", wanted fit, info, eval or simulate",
                     near ? near : "", near ? "'?" : "");
}
