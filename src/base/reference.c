/* SPDX-License-Identifier: Apache-2.0 */
#include "base/reference.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"

/* Both are absolute and free of links. */
static bool is_below(const char *path, const char *folder)
{
    size_t length = strlen(folder);
    if (length == 1) return true; /* the root of all */
    return strncmp(path, folder, length) == 0 && (path[length] == '/' || !path[length]);
}

/* The parent of the folder of `from`; where it cannot be found out nothing may be read. */
static bool lies_near(const char *target, const char *from, Arena scratch)
{
    char parent[PATH_MAX];
    const char *above = path_beside(from, "./..", &scratch);
    return realpath(above, parent) && is_below(target, parent);
}

static bool lies_below_root(const char *target, const char *root)
{
    char folder[PATH_MAX];
    return root && realpath(root, folder) && is_below(target, folder);
}

static bool leaves(const char *relative, const char *by, Error *err)
{
    return error_set(err, ERROR_INPUT,
                     "\"%.200s\" leaves the parent of the folder of the file that names it%s; "
                     "only what is there and below is read — another folder is added by "
                     "--root DIR",
                     relative, by);
}

bool reference_resolve(const char *from, const char *relative, const char *root, Arena *arena,
                       const char **out, Error *err)
{
    char target[PATH_MAX];
    if (!relative[0] || relative[0] == '/' || relative[0] == '\\')
        return error_set(err, ERROR_INPUT,
                         "\"%.200s\" is %s; a path relative to the file that names it is "
                         "wanted",
                         relative, relative[0] ? "an absolute path" : "empty");
    if (strchr(relative, '\\'))
        return error_set(err, ERROR_INPUT,
                         "\"%.200s\" holds a backslash; / is wanted between folders", relative);
    if (path_climb(relative) > 1 && !root) return leaves(relative, "", err);
    const char *path = path_beside(from, relative, arena);
    if (realpath(path, target) && !lies_near(target, from, *arena) &&
        !lies_below_root(target, root))
        return leaves(relative, path_climb(relative) > 1 ? "" : " by a symbolic link", err);
    *out = path;
    return true;
}

bool reference_check_root(const char *root, Error *err)
{
    struct stat info;
    if (!root || (!stat(root, &info) && S_ISDIR(info.st_mode))) return true;
    return error_at(err, ERROR_INPUT, root, "", "--root wants a folder: %s",
                    strerror(stat(root, &info) ? errno : ENOTDIR));
}
