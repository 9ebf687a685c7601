/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/missed_answer.h"

#include "text/json_text.h"

json_t *missed_pairs_json(const Scene *scene, const MissedLight *missed) {
    json_t *list = json_array();
    for (int i = 0; i < missed->count; i++) {
        const MissedPair *pair = &missed->pairs[i];
        const MissedEye *eye = &missed->eyes[pair->eye];
        const char *then = pair->way.then_id == NO_ID ? NULL : scene->parts[pair->way.then_id].name;
        json_array_append_new(
            list, json_pack("{s:s, s:o, s:s, s:o, s:o, s:b, s:s, s:o, s:f, s:f}", "light",
                            missed_kind(pair->way.from), "name",
                            json_text(missed_name(scene, &pair->way)), "by",
                            pair->way.is_solid ? "solid" : "mirror", "part",
                            json_text(scene->parts[pair->way.part_id].name), "then",
                            json_text_or_null(then), "is_lost", pair->way.from == CHAIN_LAMP, "eye",
                            eye->camera ? "camera" : "display", "eye_name", json_text(eye->name),
                            eye->camera ? "cd_m2" : "lx", pair->light, "share", pair->share));
    }
    return list;
}
