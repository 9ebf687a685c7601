/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/guides.h"

#include <string.h>

#define COMMANDS "\nCommands: "

const Guide *guide_named(const char *name) {
    for (int i = 0; i < guide_count; i++)
        if (!strcmp(guide_table[i].name, name)) return &guide_table[i];
    return NULL;
}

/* Is the word among the names of the paragraph? Commas lie between, a full stop ends it. */
static bool names_command(const char *names, const char *command) {
    size_t length = strlen(command);
    while (*names && *names != '.') {
        size_t size = strcspn(names, ",.");
        if (size == length && !memcmp(names, command, length)) return true;
        names += size;
        names += strspn(names, ", \n");
    }
    return false;
}

const Guide *guide_of_command(const char *command) {
    for (int i = 0; i < guide_count; i++) {
        const char *names = strstr(guide_table[i].text, COMMANDS);
        if (names && names_command(names + strlen(COMMANDS), command)) return &guide_table[i];
    }
    return NULL;
}

int guide_title(const Guide *guide, const char **title) {
    *title = guide->text + strspn(guide->text, "# ");
    return (int)strcspn(*title, "\n");
}
