/* SPDX-License-Identifier: Apache-2.0 */
/* profile_table.h -- the texts of assets/profiles, which the program carries.
 *
 * assets/embed_folder.cmake makes the table at build time, so a new profile needs no code.
 *
 * Memory   constant; nothing to free. Threads: any. Fails: never.
 */
#pragma once

typedef struct ProfileText {
    const char *name; /* of its file, without the ending */
    const char *text; /* JSON */
} ProfileText;

extern const ProfileText profile_table[]; /* in the order of their names */
extern const int profile_count;
