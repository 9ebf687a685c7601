/* SPDX-License-Identifier: Apache-2.0 */
/* panel_level.h -- --level of the commands that evaluate a panel. */
#pragma once
#include <stdbool.h>
#include <stdio.h>

#include <jansson.h>

#include "base/error.h"
#include "panel/set/panel_coarse.h"
#include "table/table.h"

/* A row of Options; the variable is a PanelLevel. */
#define PANEL_LEVEL_OPTION(level) \
    {"--level", \
     OPTION_INTEGER, \
     "N", \
     "read the trees down to level N only, and state the error (default: all of them)", \
     .out = &(level).asked, \
     .given = &(level).is_asked}

#define PANEL_LEVEL_ABOUT \
    "with `--level`: `level` as asked, and of what was asked and is there `emission` and " \
    "`reflection` as `panel info --levels` has them"

typedef struct PanelLevel {
    long asked;
    bool is_asked;     /* false: the whole panel */
    unsigned parts;    /* which trees, PANEL_COARSE_... */
    PanelCoarse found; /* by panel_level_open */
} PanelLevel;

/* Opens a panel at the level that is requested. */
bool panel_level_open(const char *path, PanelLevel *level, Arena *arena, Panel **out, Error *err);

/* "read down to level 3", for titles; NULL: the panel is whole. */
const char *panel_level_words(const PanelLevel *level, Arena *arena);

/* One line a part: how far it is off. Nothing where the panel is whole. */
void panel_level_print(const PanelLevel *level, FILE *to);

/* Adds the same as "level" to an answer. */
void panel_level_add(const PanelLevel *level, json_t *answer);

/* All levels of a panel: a new list, and what people read of it. */
json_t *panel_level_list(const Panel *panel, Arena *arena);
extern const TableKind panel_level_kind;
