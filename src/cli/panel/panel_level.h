/* SPDX-License-Identifier: Apache-2.0 */
/* panel_level.h -- --level of the commands that ask a panel. */
#pragma once
#include <stdbool.h>
#include <stdio.h>

#include <jansson.h>

#include "base/error.h"
#include "panel/set/panel_coarse.h"

#define PANEL_LEVEL_HELP \
    "read the trees down to level N only; the error of that is stated (default: all of them)"

/* Opens a panel at a level; below 0: as it is. */
bool panel_level_open(const char *path, long level, Arena *arena, Panel **out,
                      PanelCoarse *coarse, Error *err);

/* One line a part: how far it is off. */
void panel_level_print(const PanelCoarse *coarse, FILE *to);

json_t *panel_level_json(const PanelCoarse *coarse);
