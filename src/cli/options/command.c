#include "cli/options/command.h"

#include <string.h>

#include "cli/options/cli.h"

const Command *command_find(const Command *const *list, int count, const char *name,
                            const char **nearest)
{
    const char *names[COMMANDS_MAX];
    for (int i = 0; i < count; i++) {
        names[i] = list[i]->name;
        if (!strcmp(name, names[i])) return list[i];
    }
    *nearest = cli_nearest(name, names, count);
    return NULL;
}
