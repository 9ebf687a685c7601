/* SPDX-License-Identifier: Apache-2.0 */
/* folders.h -- two folders matched by the names of the pictures in them.
 *
 * Memory   names come from the arena that is passed in. Threads: one thread at a time.
 * Fails    when a folder cannot be read, and when neither holds a picture.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

typedef struct FolderPair {
    const char *name;             /* relative to both folders */
    const char *reference, *test; /* whole paths; NULL where there is none */
} FolderPair;

typedef struct FolderPairs {
    FolderPair *list; /* sorted by name */
    int         count;
} FolderPairs;

bool is_folder(const char *path);

/* Every file below either folder whose ending is a picture's; hidden files are left out. */
bool folders_match(const char *reference, const char *test, Arena *arena, FolderPairs *out,
                   Error *err);
