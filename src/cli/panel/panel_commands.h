/* panel_commands.h -- the sub-commands of `parhelion panel`.
 *
 * argv[0] is the sub-command's name. True: exit status 0; else the status of err->code.
 */
#pragma once
#include <stdbool.h>

#include "base/error.h"

bool cmd_panel_import(int argc, char **argv, Error *err);
bool cmd_panel_fit(int argc, char **argv, Error *err);
bool cmd_panel_info(int argc, char **argv, Error *err);
bool cmd_panel_eval(int argc, char **argv, Error *err);
bool cmd_panel_export(int argc, char **argv, Error *err);
bool cmd_panel_plot(int argc, char **argv, Error *err);
bool cmd_panel_simulate(int argc, char **argv, Error *err);

/* The report of a fit as a table on stdout. */
struct json_t;
void panel_print_report(const struct json_t *report);
