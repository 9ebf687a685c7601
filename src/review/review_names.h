/* SPDX-License-Identifier: Apache-2.0 */
/* review_names.h -- what a review calls a case, and the files that are named by its texts.
 *
 * Memory   the arena's. Threads: pure. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "review/verdict.h"

/* "speed, seen by driver, low sun". */
const char *words_case(const ReviewCase *c, Arena *arena);

/* A part of a file's name from texts of any kind: letters and digits stay, each other character
 * becomes '-', and what is longer is cut. Texts that differ may give the same. */
#define WORDS_FILE_NAME_MOST 80
const char *words_file_name(const char *text, Arena *arena);
