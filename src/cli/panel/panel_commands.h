/* SPDX-License-Identifier: Apache-2.0 */
/* panel_commands.h -- `parhelion panel` and its own sub-commands, which cmd_panel.c lists. */
#pragma once
#include "cli/options/command.h"

#define INSTRUMENT_FWHM_HELP \
    "how wide the instrument of the reflection sees the image of a point in a mirror: full " \
    "width at half maximum, degrees"

extern const Command command_panel;

extern const Command command_panel_import;
extern const Command command_panel_fit;
extern const Command command_panel_info;
extern const Command command_panel_eval;
extern const Command command_panel_plot;
extern const Command command_panel_report;
extern const Command command_panel_show;
extern const Command command_panel_simulate;
