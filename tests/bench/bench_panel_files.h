/* SPDX-License-Identifier: Apache-2.0 */
/* bench_panel_files.h -- a synthetic panel's closed form and the panel that was fitted to it.
 *
 * Memory   both come from the arena; the panel is closed by its caller.
 * Failure  one line to stderr, with the program's name, and false.
 */
#pragma once
#include <stdio.h>

#include "panel/query/panel_open.h"
#include "panel/set/synthetic_format.h"

static inline bool bench_panel_files(const char *program, char *const paths[2], Arena *arena,
                                     SyntheticPanel *recipe, Panel **panel) {
    Error err = {0};
    char line[2048];
    if (synthetic_panel_read(paths[0], arena, recipe, &err) &&
        panel_open(paths[1], arena, panel, &err))
        return true;
    error_line(&err, line, sizeof line);
    fprintf(stderr, "%s: %s\n", program, line);
    return false;
}
