/* SPDX-License-Identifier: Apache-2.0 */
#include "missed/missed_words.h"

const char *missed_kind(ChainLight from) {
    static const char *const KINDS[] = {
        [CHAIN_SUN] = "sun", [CHAIN_LAMP] = "lamp", [CHAIN_EMITTER] = "emitter"};
    return KINDS[from];
}

const char *missed_name(const Scene *scene, const MissedPair *pair) {
    switch (pair->from) {
    case CHAIN_SUN: break;
    case CHAIN_LAMP: return scene->lights[pair->light_id].name;
    case CHAIN_EMITTER: return scene->parts[pair->light_id].name;
    }
    return "";
}

/* `sun through solid "lens", then "visor"`. */
static const char *way_words(const Scene *scene, const MissedPair *pair, const char *verb,
                             Arena *arena) {
    const char *then = "";
    const char *light = pair->from == CHAIN_SUN
                            ? "sun"
                            : arena_format(arena, "%s \"%.60s\"", missed_kind(pair->from),
                                           missed_name(scene, pair));
    if (pair->then_id == pair->part_id) then = ", then by it again";
    else if (pair->then_id != NO_ID)
        then = arena_format(arena, ", then \"%.60s\"", scene->parts[pair->then_id].name);
    return arena_format(arena, "%s%s %s \"%.60s\"%s", light, verb,
                        pair->is_solid ? "through solid" : "by mirror",
                        scene->parts[pair->part_id].name, then);
}

static const char *where(const MissedEye *eye, double light, Arena *arena) {
    if (eye->camera)
        return arena_format(arena, "%.3g cd/m2 of the mean of what %s%s%s sees", light,
                            eye->name[0] ? "camera \"" : "the camera", eye->name,
                            eye->name[0] ? "\"" : "");
    return arena_format(arena, "%.3g lx on display \"%.60s\"", light, eye->name);
}

const char *missed_pair_words(const Scene *scene, const MissedLight *missed, int index,
                              Arena *arena) {
    const MissedPair *pair = &missed->pairs[index];
    return arena_format(arena, "%s: this light is %s (about %s, %.2g %% of the light there)",
                        way_words(scene, pair, " shines", arena),
                        pair->from == CHAIN_LAMP ? "not followed, it is missing"
                                                 : "left to chance, which hardly finds it",
                        where(&missed->eyes[pair->eye], pair->light, arena), 100 * pair->share);
}

const char *missed_words(const Scene *scene, const MissedLight *missed, Arena *arena) {
    const char *list = "";
    int named = missed->count < MISSED_LINES ? missed->count : MISSED_LINES;
    if (!(missed->share >= MISSED_SHARE)) return NULL;
    for (int i = 0; i < named; i++)
        list = arena_format(arena, "%s%s%s", list, i ? "; " : ": ",
                            way_words(scene, &missed->pairs[i], "", arena));
    if (missed->count > named)
        list = arena_format(arena, "%s; and %d more", list, missed->count - named);
    return arena_format(arena, "about %.3g cd/m2, %.2g %% of the light with it%s", missed->light,
                        100 * missed->share, list);
}
