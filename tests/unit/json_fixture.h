/* SPDX-License-Identifier: Apache-2.0 */
/* json_fixture.h -- what stands in a report: json_number_at(report, "tables/5/noise"). */
#pragma once
#include "fixture.h"

#include <jansson.h>

/* What stands at a path: keys of objects and numbers in lists, with slashes between. */
static inline json_t *json_at(const json_t *json, const char *path) {
    char key[128];
    for (int length; json && *path; path += length + (path[length] == '/')) {
        length = (int)strcspn(path, "/");
        snprintf(key, sizeof key, "%.*s", length, path);
        json = json_is_array(json) ? json_array_get(json, (size_t)atoi(key))
                                   : json_object_get(json, key);
    }
    return (json_t *)json;
}

static inline double json_number_at(const json_t *json, const char *path) {
    const json_t *found = json_at(json, path);
    if (!json_is_number(found)) fail_msg("no number at %s", path);
    return json_number_value(found);
}

static inline const char *json_text_at(const json_t *json, const char *path) {
    const json_t *found = json_at(json, path);
    if (!json_is_string(found)) fail_msg("no text at %s", path);
    return json_string_value(found);
}
