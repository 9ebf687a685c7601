/* SPDX-License-Identifier: Apache-2.0 */
#include "import/set/word_list.h"

#include <stddef.h>
#include <strings.h>

int word_list_find(const char *const *list, const char *word)
{
    for (int i = 0; list[i]; i++)
        if (!strcasecmp(list[i], word)) return i;
    return -1;
}
