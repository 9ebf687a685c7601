/* command_line.h -- command lines as a shell would take them again: frames tell how they were
 * made, and a frame that was merged tells how one run would have made it.
 *
 * Memory   the arena's.  Threads  no shared state.  Fails  never.
 */
#pragma once
#include "film/film_part.h"

/* "parhelion " and all words; without idle ones are left out that change no pixel: names of
 * outputs, what concerns the picture beside the frame, threads, progress, checkpoints. */
const char *command_line_join(int argc, char **argv, bool with_idle, Arena *arena);

/* The `parhelion render` of a part, changed to render `whole`: its range and crop go in, or out
 * where they are those of a whole frame. NULL where one run would not make the same, since
 * noise decides when to stop. */
const char *command_line_of_whole(const char *line, const FilmPart *whole, Arena *arena);
