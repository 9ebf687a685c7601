/* SPDX-License-Identifier: Apache-2.0 */
/* folders.h -- two folders matched by the names of the pictures in them.
 *
 * Memory   names come from the arena that is passed in. Threads: one thread at a time.
 * Fails    when a folder cannot be read, and when neither holds a picture.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

/* Whoever cannot make a picture leaves NAME.failed, whose first line says why: then the pair
 * cannot be compared, whatever else lies there. */
#define FOLDERS_FAILED ".failed"

typedef struct FolderPair {
    const char *name;             /* of the picture, relative to both folders */
    const char *reference, *test; /* whole paths; NULL where there is none */
    const char *failed;           /* the same of NAME.failed, of either folder */
} FolderPair;

typedef struct FolderPairs {
    FolderPair *list; /* sorted by name */
    int count;
} FolderPairs;

bool is_folder(const char *path);

/* Every file below either folder whose ending is a picture's; hidden files are left out. */
bool folders_match(const char *reference, const char *test, Arena *arena, FolderPairs *out,
                   Error *err);
