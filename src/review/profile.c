/* SPDX-License-Identifier: Apache-2.0 */
#include "review/profile.h"

#include <jansson.h>
#include <string.h>

#include "base/file.h"
#include "review/profile_format.h"
#include "review/profile_table.h"

/* ---- where it stands --------------------------------------------------------------------- */

const char *profile_names(Arena *arena)
{
    const char *names = "";
    for (int i = 0; i < profile_count; i++)
        names = arena_format(arena, "%s%s%s", names, i ? ", " : "", profile_table[i].name);
    return names;
}

/* One of the program's own, as if it were a file. */
static bool open_shipped(const char *name, Arena *arena, JsonView *out, Error *err)
{
    for (int i = 0; i < profile_count; i++) {
        if (strcmp(name, profile_table[i].name)) continue;
        json_error_t fault;
        json_t *root = json_loads(profile_table[i].text, JSON_REJECT_DUPLICATES, &fault);
        const char *file = arena_format(arena, "assets/profiles/%s.json", name);
        if (!root)
            return error_at(err, ERROR_INPUT, file, "", "not valid JSON: %s", fault.text);
        *out = (JsonView){root, file, "", arena, NULL, NULL, 0};
        return true;
    }
    return error_set(err, ERROR_INPUT, "there is no profile \"%s\"; required: %s, or a file by a "
                     "path that holds '/' or ends in .json", name, profile_names(arena));
}

bool profile_load(const char *name_or_path, Arena *arena, const Profile **out, Error *err)
{
    JsonView root;
    bool     is_path = strchr(name_or_path, '/') || !strcmp(path_ending(name_or_path), ".json");
    bool     ok = is_path ? json_view_open(name_or_path, arena, &root, err)
                          : open_shipped(name_or_path, arena, &root, err);
    if (!ok) return false;
    Profile *profile = ARENA_NEW(arena, Profile, 1);
    profile->id = arena_string(arena, name_or_path, strlen(name_or_path));
    profile->file_hash = root.hash;
    ok = record_read(&root, &profile_format, profile, err);
    json_view_close(&root);
    if (ok) *out = profile;
    return ok;
}

Ambient profile_ambient(const Profile *profile, double display_lux, bool sun_on_display)
{
    if (sun_on_display) return AMBIENT_SUN;
    if (display_lux < profile->night_below_lx) return AMBIENT_NIGHT;
    return display_lux < profile->twilight_below_lx ? AMBIENT_TWILIGHT : AMBIENT_DAY;
}
