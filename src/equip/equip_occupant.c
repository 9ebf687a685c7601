/* SPDX-License-Identifier: Apache-2.0 */
#include "equip/equip_occupant.h"

#include <math.h>

#include "equip/equip_shipped.h"
#include "text/json_text.h"
#include "text/text.h"

#define DIGITS 9

/* The quaternion of the turn about +Y that brings -Z to where the vehicle points: half of the
 * angle atan2(-x, -z). */
static json_t *turn_of(const double forward[3]) {
    double half = 0.5 * atan2(-forward[0], -forward[2]);
    return json_pack("[i,f,i,f]", 0, sin(half) + 0.0, 0, cos(half));
}

/* Its only root is moved: only turns about +Y, so that its eyes stay above its node. */
static void seat(const Equip *equip, json_t *document) {
    const double *eye = equip->eyes[equip->occupant.eye_id].position_m;
    json_t *node = json_array_get(json_object_get(document, "nodes"), 0);
    json_object_set_new(node, "translation",
                        json_pack("[f,f,f]", eye[0], eye[1] - OCCUPANT_EYE_M, eye[2]));
    json_object_set_new(node, "rotation", turn_of(equip->forward));
}

/* `from`, without what it holds of another order. */
static EquipFiles files_of(const EquipFiles *from, const char *model) {
    EquipFiles files = *from;
    files.model = model;
    files.root = NULL;
    files.decoded = NULL;
    return files;
}

bool equip_occupant_write(const Equip *equip, EquipFiles *files, const char *path, Error *err) {
    const char *source;
    json_error_t fault;
    if (!equip_shipped_find(&shipped_scenes, equip->occupant.scene, files->arena, &source, err))
        return false;
    json_t *document = json_load_file(source, 0, &fault);
    if (!document) return error_at(err, ERROR_INPUT, source, "", "%s", fault.text);
    EquipFiles own = files_of(files, source);
    Text text = {.arena = files->arena};
    bool ok = equip_files_refer(&own, document, err);
    seat(equip, document);
    json_print(&text, document, (JsonDigits){DIGITS, false});
    json_decref(document);
    files->copies = own.copies, files->count = own.count, files->capacity = own.capacity;
    return ok && text_write(&text, path, err);
}
