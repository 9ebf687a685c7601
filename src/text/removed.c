/* SPDX-License-Identifier: Apache-2.0 */
#include "text/removed.h"

#include <stddef.h>
#include <string.h>

const RemovedWord removed_words[] = {
    {"render", "--tev", "write --live FILE.exr and open that file in tev: it reads it again by "
                        "itself"},
    {NULL, NULL, NULL},
};

const char *removed_instead(const char *where, const char *word)
{
    for (const RemovedWord *row = removed_words; row->word; row++)
        if (!strcmp(row->where, where) && !strcmp(row->word, word)) return row->instead;
    return NULL;
}
