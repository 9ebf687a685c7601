/* SPDX-License-Identifier: Apache-2.0 */
/* panel join: the states of one display, each a panel file, become one file. */
#include <string.h>

#include "base/count.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/panel/panel_commands.h"
#include "panel/fit/panel_states.h"
#include "panel/query/panel_info.h"

/* NAME=FILE.panel */
static bool split(const char *argument, Arena *arena, PanelStateFile *out, Error *err)
{
    const char *sign = strchr(argument, '=');
    size_t      length = sign ? (size_t)(sign - argument) : 0;
    if (!length || length > PANEL_INFO_STATE_NAME_MAX || !sign[1])
        return error_set(err, ERROR_USAGE, "\"%.80s\", required: NAME=FILE.panel, with a name "
                         "of 1 to %d letters, digits, '-' and '_'", argument,
                         PANEL_INFO_STATE_NAME_MAX);
    *out = (PanelStateFile){arena_string(arena, argument, length), sign + 1};
    return true;
}

/* Names as the file has them, each another. */
static bool check_names(const PanelStateFile *states, int count, Error *err)
{
    for (int i = 0; i < count; i++) {
        if (!panel_info_is_state_name(states[i].name))
            return error_set(err, ERROR_USAGE, "state '%s', required: a name of letters, "
                             "digits, '-' and '_'", states[i].name);
        for (int k = 0; k < i; k++)
            if (!strcmp(states[i].name, states[k].name))
                return error_set(err, ERROR_USAGE, "two states '%s', required: another name",
                                 states[i].name);
    }
    return true;
}

static Outcome run_join(int argc, char **argv, Arena *arena, Error *err)
{
    Cli            cli;
    const char    *output = NULL, *paths[PANEL_INFO_STATES_MAX];
    PanelStateFile states[PANEL_INFO_STATES_MAX];
    const Option options[] = {
        {"-o", OPTION_TEXT, "X.panel", "the file of all states", &output,
         .file = OPTION_OUTPUT},
    };
    const CliCommand command = {"panel join", "the states of one display to one panel file",
        "NAME=FILE.panel NAME=FILE.panel ... -o X.panel",
        "parhelion panel join shared=open.panel private=narrow.panel -o screen.panel", options,
        COUNT_OF(options), 2, PANEL_INFO_STATES_MAX};
    if (!cli_parse(&command, argc, argv, arena, &cli, err)) return OUTCOME_FAILED;
    if (cli.help_shown) return OUTCOME_DONE;
    if (!output) return outcome_of(error_set(err, ERROR_USAGE, "panel join wants -o X.panel"));
    int count = cli.argument_count;
    for (int i = 0; i < count; i++) {
        if (!split(cli.arguments[i], arena, &states[i], err)) return OUTCOME_FAILED;
        paths[i] = states[i].path;
    }
    return outcome_of(check_names(states, count, err) &&
                      outputs_spare(&cli.outputs, paths, count, err) &&
                      panel_states_join(states, count, output, arena, err));
}

const Command command_panel_join = {
    "join", "the states of one display to one panel file", run_join};
