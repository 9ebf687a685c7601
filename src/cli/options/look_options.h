/* look_options.h -- the options that say how a frame becomes a picture, for the commands that
 * develop one.
 *
 * The rows only name where the words go; develop.h says what they mean and checks them.
 */
#pragma once
#include "cli/options/cli.h"
#include "image/develop.h"

/* Rows of an option table; `look` is a DevelopOptions *. */
#define LOOK_OPTIONS(look)                                                                     \
    {"--exposure", OPTION_TEXT, "auto|EV|white:CD_M2",                                         \
     "auto (default: the cabin looks well), an exposure value at ISO 100 (15: full sun; "      \
     "one more is half as bright), or the luminance that becomes white",                       \
     .out = &(look)->exposure},                                                                \
    {"--display", OPTION_TEXT, "NAME", "sRGB (default), Display P3, Rec.1886",                 \
     .out = &(look)->display},                                                                 \
    {"--view", OPTION_TEXT, "NAME", "photographic (default), ACES SDR, untonemapped, raw",     \
     .out = &(look)->view},                                                                    \
    {"--config", OPTION_TEXT, "FILE",                                                          \
     "OpenColorIO configuration; else $OCIO, else the program's own", .out = &(look)->config}
