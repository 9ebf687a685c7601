/* SPDX-License-Identifier: Apache-2.0 */
/* program.h -- what belongs to the program and lies in files: where, seen from the program.
 *
 * A build keeps it beside the program, an installation in folders of its own; either may be
 * moved as a whole, so every place is relative to the program's file, however it was started.
 *
 * Threads  no shared state.
 * Fails    ERROR_LIBRARY with every place that was looked at.
 */
#pragma once
#include <limits.h>

#include "base/error.h"

/* Relative places of one thing, looked at in this order. */
typedef struct ProgramPart {
    const char *what; /* "the part for pictures" */
    const char *built, *installed;
} ProgramPart;

/* The first place where the part lies, without links and "..". */
bool program_find(const ProgramPart *part, char path[static PATH_MAX], Error *err);
