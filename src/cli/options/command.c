/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/command.h"

#include <string.h>

#include "text/nearest_word.h"
#include "text/removed.h"

const Command *command_find(const Command *const *list, int count, const char *within,
                            const char *name, Error *err) {
    const char *names[COMMANDS_MAX];
    char advice[512];
    for (int i = 0; i < count; i++) {
        names[i] = list[i]->name;
        if (!strcmp(name, names[i])) return list[i];
    }
    const char *instead = removed_instead(within ? within : "parhelion", name);
    if (instead) {
        error_set(err, ERROR_USAGE, "the command %s was removed — %s", name, instead);
        return NULL;
    }
    nearest_word_advice(name, names, count, advice, (int)sizeof advice);
    if (within && !*name) error_set(err, ERROR_USAGE, "%s wants a command — %s", within, advice);
    else if (within) error_set(err, ERROR_USAGE, "%s has no command %s — %s", within, name, advice);
    else
        error_set(err, ERROR_USAGE,
                  "unknown command %s — %s; `parhelion --help` tells what "
                  "they do",
                  name, advice);
    return NULL;
}
