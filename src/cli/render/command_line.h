/* SPDX-License-Identifier: Apache-2.0 */
/* command_line.h -- command lines as a shell would take them again: frames record how they were
 * made, and a merged frame how one run would have made it.
 *
 * Memory   the arena's.  Threads  no shared state.  Fails  never.
 */
#pragma once
#include "film/film_part.h"

/* "parhelion " and all words; without idle ones are left out that change no pixel: names of
 * outputs, what concerns the picture beside the frame, threads, progress, checkpoints. */
const char *command_line_join(int argc, char **argv, bool with_idle, Arena *arena);

/* The `parhelion render` of a part, changed to render `whole`: of one that was dealt --part goes
 * out; else the range and the crop go in, or out where they are those of a whole frame. NULL
 * where one run would not make the same, since noise decides when to stop. */
const char *command_line_of_whole(const char *line, const FilmPart *whole, Arena *arena);
