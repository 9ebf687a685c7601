/* SPDX-License-Identifier: Apache-2.0 */
/* guides.h -- the pages of assets/guides, which the program carries: `parhelion help NAME`.
 *
 * A page begins with its title; a paragraph `Commands: render, merge.` names the commands whose
 * --help points to it. assets/embed_folder.cmake makes the table at build time, so a new page
 * needs no code.
 *
 * Memory   constant; nothing to free. Threads: any. Fails: never.
 */
#pragma once
#include <stdbool.h>

typedef struct Guide {
    const char *name; /* of its file, without the ending */
    const char *text; /* Markdown, lines of 96 columns at most */
} Guide;

extern const Guide guide_table[]; /* in the order of their names */
extern const int guide_count;

/* NULL: there is none of this name. */
const Guide *guide_named(const char *name);

/* The first guide that names the command ("panel fit"); NULL: none does. */
const Guide *guide_of_command(const char *command);

/* Its title as a line of its own: the length of the text that *title points to. */
int guide_title(const Guide *guide, const char **title);
