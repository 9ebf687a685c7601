/* SPDX-License-Identifier: Apache-2.0 */
#include "base/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* With its slash. */
static bool program_folder(char path[static PATH_MAX], Error *err) {
    ssize_t length = readlink("/proc/self/exe", path, PATH_MAX - 1);
    while (length > 0 && path[length - 1] != '/') length--;
    path[length > 0 ? length : 0] = 0;
    return length > 0 || error_set(err, ERROR_LIBRARY, "/proc/self/exe does not name the program");
}

static bool is_there(const char *folder, const char *place, char path[static PATH_MAX]) {
    char joined[2 * PATH_MAX];
    snprintf(joined, sizeof joined, "%s%s", folder, place);
    return realpath(joined, path) != NULL;
}

bool program_find(const ProgramPart *part, char path[static PATH_MAX], Error *err) {
    char folder[PATH_MAX];
    if (!program_folder(folder, err)) return false;
    return is_there(folder, part->built, path) || is_there(folder, part->installed, path) ||
           error_set(err, ERROR_LIBRARY,
                     "%s is missing: neither %s nor %s lies beside the "
                     "program, in %s — install it again",
                     part->what, part->built, part->installed, folder);
}
