/* SPDX-License-Identifier: Apache-2.0 */
#include "text/removed.h"

#include <stddef.h>
#include <string.h>

const RemovedWord removed_words[] = {
    {"render", "--tev", "write --live FILE.exr and open it by `tev --watch FILE.exr`, which "
                        "reads it again by itself"},
    {"road", "twilight_steps", "write a condition an hour, and name them in 'conditions' of "
                               "the road"},
    {"road", "sky_cd_m2_per_lx", "add the sky's part to 'luminance_cd_m2' of the road"},
    {"help", "--man", "the build makes the pages: man parhelion-COMMAND; help --json has all that "
                      "they say"},
    {"help", "--completion", "an installation has it for bash; help --json lists options and "
                             "their values"},
    {"condition", "route", "write its points as conditions with 'when', 'where' and "
                           "'heading_deg'; `parhelion help glare-review` has a script for GPX"},
    {"condition", "when", "state it in 'environment'"},
    {"condition", "weather", "state it in 'sweep' of a year"},
    {"condition", "weather_lux", "state it in 'sweep' of a year"},
    {"review", "--decide", "lower \"contrast\" and raise \"paths\" of the request's \"precision\""},
    {"review", "--decide-times", "raise \"paths\" of the request's \"precision\""},
    {"review", "--watch", "run the same command again: responses of its sweeps are kept"},
    {NULL, NULL, NULL},
};

const char *removed_instead(const char *where, const char *word)
{
    for (const RemovedWord *row = removed_words; row->word; row++)
        if (!strcmp(row->where, where) && !strcmp(row->word, word)) return row->instead;
    return NULL;
}
