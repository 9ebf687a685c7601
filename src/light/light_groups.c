/* SPDX-License-Identifier: Apache-2.0 */
#include "light/light_groups.h"

#include <string.h>

#define NAME_BYTES 64

typedef enum GroupKind { GROUP_SUN, GROUP_SKY, GROUP_LAMP, GROUP_DISPLAY } GroupKind;

typedef struct GroupList {
    GroupKind *kinds;
    const char **names, **said;
    int count;
    Arena *arena;
} GroupList;

/* ---- names ------------------------------------------------------------------------------- */

static bool stays(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '+' || (unsigned char)c >= 0x80;
}

/* No character of UTF-8 is cut in two. */
static size_t kept_bytes(const char *name) {
    size_t length = strlen(name);
    if (length <= NAME_BYTES) return length;
    for (length = NAME_BYTES; length && ((unsigned char)name[length] & 0xc0) == 0x80;) length--;
    return length;
}

static const char *clean(const char *said, Arena *arena) {
    size_t length = kept_bytes(said);
    char *name = ARENA_NEW(arena, char, length + 1);
    for (size_t i = 0; i < length; i++) name[i] = stays(said[i]) ? said[i] : '_';
    return length ? name : "unnamed";
}

static bool is_taken(const GroupList *list, const char *name) {
    for (int i = 0; i < list->count; i++)
        if (!strcmp(list->names[i], name)) return true;
    return false;
}

static const char *free_name(const GroupList *list, const char *said, Problems *problems) {
    const char *wanted = clean(said, list->arena), *name = wanted;
    for (int i = 2; is_taken(list, name); i++) name = arena_format(list->arena, "%s_%d", wanted, i);
    if (name != wanted)
        problems_add(problems, SEVERITY_WARNING, "", "",
                     "the light of \"%s\" is the layer light.%s: another light has light.%s", said,
                     name, wanted);
    return name;
}

/* ---- groups ------------------------------------------------------------------------------ */

static int find_or_add(GroupList *list, GroupKind kind, const char *said, Problems *problems) {
    for (int i = 0; i < list->count; i++)
        if (list->kinds[i] == kind && !strcmp(list->said[i], said)) return i;
    list->names[list->count] = free_name(list, said, problems);
    list->said[list->count] = said;
    list->kinds[list->count] = kind;
    return list->count++;
}

static const int *groups_of_lights(const Scene *scene, GroupList *list, Problems *problems) {
    int *group = ARENA_NEW(list->arena, int, scene->light_count);
    for (int i = 0; i < scene->light_count; i++)
        group[i] = find_or_add(list, GROUP_LAMP, scene->lights[i].name, problems);
    return group;
}

static const int *groups_of_parts(const Scene *scene, GroupList *list, Problems *problems) {
    int *group = ARENA_NEW(list->arena, int, scene->part_count);
    for (int i = 0; i < scene->part_count; i++) {
        const Material *m = &scene->materials[scene->parts[i].material_id];
        GroupKind kind = m->display_id == NO_ID ? GROUP_LAMP : GROUP_DISPLAY;
        group[i] = m->is_emitter ? find_or_add(list, kind, m->name, problems) : NO_ID;
    }
    return group;
}

LightGroups light_groups_build(const Scene *scene, const Lights *lights, Arena *arena,
                               Problems *problems) {
    int most = 2 + scene->light_count + scene->part_count;
    const char *sun_name = lights_sun_is_moon(lights) ? "moon" : "sun";
    GroupList list = {ARENA_NEW(arena, GroupKind, most), ARENA_NEW(arena, const char *, most),
                      ARENA_NEW(arena, const char *, most), 0, arena};
    LightGroups out = {.sun = NO_ID, .sky = NO_ID, .names = list.names, .said = list.said};
    if (lights_has(lights, LIGHTS_SUN)) out.sun = find_or_add(&list, GROUP_SUN, sun_name, problems);
    if (lights_has(lights, LIGHTS_SKY)) out.sky = find_or_add(&list, GROUP_SKY, "sky", problems);
    out.of_light = groups_of_lights(scene, &list, problems);
    out.of_part = groups_of_parts(scene, &list, problems);
    out.count = list.count;
    return out;
}
