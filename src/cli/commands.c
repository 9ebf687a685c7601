#include "cli/commands.h"

#include "cli/options/cli.h"

const Command command_table[] = {
    {"render", "render a scene to a linear, photometric EXR", cmd_render},
    {"develop", "make a picture of a frame", cmd_develop},
    {"panel", "fit, look into and evaluate a measured display panel", cmd_panel},
    {"sky", "draw the sky of a place and time, and print its figures", cmd_sky},
    {"check", "what is in a scene, and everything that is wrong with it", cmd_check},
    {"compare", "are two frames, pictures or folders the same, given their noise?",
     cmd_compare},
    {"merge", "make one frame of parts of it, with the bits of one run", cmd_merge},
    {"measure", "luminance, colour and contrast of a part of a frame", cmd_measure},
    {"help", "the commands and the guides, or one of them", cmd_help},
};
const int command_count = (int)(sizeof command_table / sizeof *command_table);
