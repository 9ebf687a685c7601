/* SPDX-License-Identifier: Apache-2.0 */
#include "review/chain/chain_words.h"

static const char *event_word(int event)
{
    static const char *const words[] = {"scatters", "reflects", "transmits"};
    return words[event];
}

const char *chain_part_words(const Scene *scene, int part_id, Arena *arena)
{
    const Part *part = &scene->parts[part_id];
    return arena_format(arena, "%s (%s)", part->name, scene->materials[part->material_id].name);
}

const char *chain_source_words(const Scene *scene, int source, int source_id, Arena *arena)
{
    switch ((LightSet)source) {
    case LIGHTS_SUN: return "sun";
    case LIGHTS_SKY: return "sky";
    case LIGHTS_EMITTERS: return chain_part_words(scene, source_id, arena);
    case LIGHTS_PUNCTUAL:
        return arena_format(arena, "lamp %s", scene->lights[source_id].name);
    default: return "";
    }
}

static const char *first_words(const Scene *scene, int part_id, Arena *arena)
{
    int display_id = scene->materials[scene->parts[part_id].material_id].display_id;
    return display_id == NO_ID
               ? chain_part_words(scene, part_id, arena)
               : arena_format(arena, "display %s", scene->displays[display_id].name);
}

const char *const *chain_words(const Scene *scene, const ChainKey *key, int *links,
                               Arena *arena)
{
    const char **out = ARENA_NEW(arena, const char *, 2 * CHAIN_STEPS + 3);
    const char  *source = chain_source_words(scene, key->source, key->source_id, arena);
    int          count = 0;
    for (int i = 0; i < key->count; i++) {
        const ChainLink *link = &key->link[i];
        const char *what = i ? chain_part_words(scene, link->part_id, arena)
                             : first_words(scene, link->part_id, arena);
        if (link->pane_id != NO_ID)
            out[count++] = arena_format(arena, "%s: through",
                                        chain_part_words(scene, link->pane_id, arena));
        out[count++] = arena_format(arena, "%s: %s", what, event_word(link->event));
    }
    if (key->is_longer) out[count++] = "further surfaces";
    if (key->pane_id != NO_ID)
        out[count++] = arena_format(arena, "%s: through",
                                    chain_part_words(scene, key->pane_id, arena));
    out[count++] = key->source == LIGHTS_EMITTERS ? arena_format(arena, "%s: emits", source)
                                                  : source;
    *links = count;
    return out;
}
