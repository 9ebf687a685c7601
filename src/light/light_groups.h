/* SPDX-License-Identifier: Apache-2.0 */
/* light_groups.h -- which lights of a scene count as one where light is kept apart by source.
 *
 * A group is the sun (or the moon), the sky, the lamps of one name, the emitting surfaces whose
 * materials have one name, or the displays whose materials do. Lamps and surfaces of one name
 * are one group: a lamp may have a body that shines.
 *
 * Names    for channels of a file: letters, digits, "_", "-", "+" and all that is not ASCII
 *          stay, the rest becomes "_", and 64 bytes are kept. Of groups whose names become the
 *          same the later ones get "_2", "_3" ... and a warning. A light without a name in its
 *          file is "light N" or "material N" (scene.h), and so "light_N" here.
 * Memory   everything lives in the arena.
 * Threads  const once built.
 */
#pragma once
#include "base/problems.h"
#include "light/light.h"

typedef struct LightGroups {
    int count;
    const char *const *names; /* [count]: of channels, no two the same */
    const char *const *said;  /* [count]: as the scene has them */
    int sun, sky;             /* NO_ID: there is none */
    const int *of_part;       /* [part_count]; NO_ID: emits nothing */
    const int *of_light;      /* [light_count]: of punctual lights */
} LightGroups;

LightGroups light_groups_build(const Scene *scene, const Lights *lights, Arena *arena,
                               Problems *problems);

/* source_id: of emitters the scene's part, of punctual lights which. NO_ID: there is no such
 * light. */
static inline int light_group_of(const LightGroups *groups, LightSet set, int source_id) {
    if (set == LIGHTS_SUN) return groups->sun;
    if (set == LIGHTS_SKY) return groups->sky;
    return set == LIGHTS_EMITTERS ? groups->of_part[source_id] : groups->of_light[source_id];
}
