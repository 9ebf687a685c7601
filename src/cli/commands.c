/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/commands.h"

#include "base/count.h"
#include "cli/explain/cmd_explain.h"
#include "cli/panel/panel_commands.h"
#include "cli/render/cmd_render.h"
#include "cli/review/cmd_review.h"

const Command *const command_table[] = {
    &command_render,  &command_develop, &command_panel,   &command_sky,    &command_check,
    &command_compare, &command_merge,   &command_measure, &command_review, &command_explain,
    &command_equip,   &command_schema,  &command_help,
};
const int command_count = COUNT_OF(command_table);
