/* SPDX-License-Identifier: Apache-2.0 */
#include "text/json_text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

json_t *json_text(const char *text)
{
    json_t *string = json_string(text);
    if (string) return string;
    char *plain = strdup(text);
    for (char *c = plain; c && *c; c++)
        if ((unsigned char)*c >= 0x80) *c = '?';
    string = json_string(plain ? plain : "");
    free(plain);
    return string;
}

json_t *json_texts(const char *const *texts, int count)
{
    json_t *list = json_array();
    for (int i = 0; i < count; i++) json_array_append_new(list, json_text(texts[i]));
    return list;
}

json_t *json_figure(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}
