/* SPDX-License-Identifier: Apache-2.0 */
#include "base/reference.h"

#include <errno.h>
#include <limits.h>
#include <pwd.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"

/* Both are absolute and free of links. */
static bool is_below(const char *path, const char *folder) {
    size_t length = strlen(folder);
    if (length == 1) return true; /* the root of all */
    return strncmp(path, folder, length) == 0 && (path[length] == '/' || !path[length]);
}

static bool is_home_or_above(const char *folder, const char *home) {
    char whole[PATH_MAX];
    return home && realpath(home, whole) && is_below(whole, folder);
}

/* Everything lies in "/", and everything of a user in the home folder: by the environment, and
 * by the system's list where that differs. */
static bool holds_all(const char *folder) {
    char text[4096];
    struct passwd user, *found = NULL;
    if (!folder[1] || is_home_or_above(folder, getenv("HOME"))) return true;
    getpwuid_r(getuid(), &user, text, sizeof text, &found);
    return found && is_home_or_above(folder, user.pw_dir);
}

static bool lies_beside(const char *target, const char *folder) {
    const char *name = path_name(target);
    const size_t length = strlen(folder);
    return name[0] != '.' && !strncmp(target, folder, length) &&
           name == target + length + (folder[1] != '\0');
}

/* How far a file of one folder reaches. */
typedef enum Near { NEAR_PARENT, NEAR_FOLDER, NEAR_FILES } Near;

/* Where the file's folder cannot be found out nothing may be read. */
static bool lies_near(const char *target, const char *from, bool own_folder, Arena scratch,
                      Near *near) {
    char folder[PATH_MAX], parent[PATH_MAX];
    *near = NEAR_FILES;
    if (!realpath(path_beside(from, "./", &scratch), folder) ||
        !realpath(path_beside(from, "./..", &scratch), parent))
        return false;
    if (holds_all(folder)) return lies_beside(target, folder);
    *near = own_folder || holds_all(parent) ? NEAR_FOLDER : NEAR_PARENT;
    return is_below(target, *near == NEAR_FOLDER ? folder : parent);
}

static bool lies_below_root(const char *target, const char *root) {
    char folder[PATH_MAX];
    return root && realpath(root, folder) && is_below(target, folder);
}

static bool leaves(const char *relative, Near near, const char *by, Error *err) {
    static const char *const places[] = {
        [NEAR_PARENT] = "the parent of the folder of the file that names it",
        [NEAR_FOLDER] = "the folder of the file that names it",
        [NEAR_FILES] = "the files beside the one that names it, in the home folder or above"};
    return error_set(err, ERROR_INPUT,
                     "\"%.200s\" leaves %s%s; only what is there%s is read — another folder is "
                     "added by --root DIR",
                     relative, places[near], by, near == NEAR_FILES ? "" : " and below");
}

bool reference_resolve(const char *from, const char *relative, ReferenceReach reach, Arena *arena,
                       const char **out, Error *err) {
    Near near;
    char target[PATH_MAX];
    if (!relative[0] || relative[0] == '/' || relative[0] == '\\')
        return error_set(err, ERROR_INPUT,
                         "\"%.200s\" is %s; a path relative to the file that names it is "
                         "required",
                         relative, relative[0] ? "an absolute path" : "empty");
    if (strchr(relative, '\\'))
        return error_set(err, ERROR_INPUT,
                         "\"%.200s\" holds a backslash; / is required between "
                         "folders",
                         relative);
    int climb = path_climb(relative);
    if (climb > 1 && !reach.root)
        return leaves(relative, reach.own_folder ? NEAR_FOLDER : NEAR_PARENT, "", err);
    const char *path = path_beside(from, relative, arena);
    if (realpath(path, target) && !lies_near(target, from, reach.own_folder, *arena, &near) &&
        !lies_below_root(target, reach.root))
        return leaves(relative, near,
                      climb > (near == NEAR_PARENT) ? ""
                      : near == NEAR_FILES          ? ""
                                                    : " by a symbolic link",
                      err);
    *out = path;
    return true;
}

bool reference_check_root(const char *root, Error *err) {
    struct stat info;
    if (!root || (!stat(root, &info) && S_ISDIR(info.st_mode))) return true;
    return error_at(err, ERROR_INPUT, root, "", "--root wants a folder: %s",
                    strerror(stat(root, &info) ? errno : ENOTDIR));
}
