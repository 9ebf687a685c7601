/* SPDX-License-Identifier: Apache-2.0 */
/* coating_library.h -- the coatings of assets/coatings, which the program carries.
 *
 * assets/embed_folder.cmake makes the tables at build time, so a new coating needs no code.
 *
 * Memory   constant; nothing to free. Threads: any. Fails: never.
 */
#pragma once

typedef struct CoatingText {
    const char *name; /* of its file, without the ending */
    const char *text;
} CoatingText;

/* In the order of their names. */
extern const CoatingText coating_stack_table[]; /* JSON: {"source", "layers"} */
extern const int coating_stack_count;
extern const CoatingText coating_index_table[]; /* rows nm,n,k, named by those layers */
extern const int coating_index_count;
