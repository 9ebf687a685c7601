/* SPDX-License-Identifier: Apache-2.0 */
/* reference.h -- resolves a path that stands inside a file, and limits where it may point.
 *
 * The sender of a scene or a measurement set must not be able to make the program read what
 * they cannot see themselves. So a file may name only what lies, symbolic links followed, in
 * the parent of its own folder or below; where that file is somebody else's, or its parent is
 * the root of all, the home folder or above that, in its own folder or below; where its own
 * folder is such a one, files beside it that are not hidden. The user may add one more folder
 * (--root DIR). What the user names on the command line is not limited.
 *
 * Memory   paths lie in the arena.
 * Threads  no shared state.
 * Fails    ERROR_INPUT with the path as it was written and what is required; file and place are
 *          the caller's to add. What does not exist passes: opening it fails later.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

typedef struct ReferenceReach {
    const char *root; /* a folder whose files may be named as well; NULL: none */
    bool own_folder;  /* of the file: its parent is out of reach */
} ReferenceReach;

/* `relative`, decoded, as it stands in the file `from`. */
bool reference_resolve(const char *from, const char *relative, ReferenceReach reach, Arena *arena,
                       const char **out, Error *err);

/* That the folder of --root is there. NULL is fine. */
bool reference_check_root(const char *root, Error *err);
