/* SPDX-License-Identifier: Apache-2.0 */
/* equip_patch.h -- a model's document with displays, eyes and materials put into it.
 *
 * A display is a node of its own with a unit rectangle before the face that was picked: its
 * scale is width and height, so that a text editor can still move it. Right of the picture is
 * the node's +X, up its +Y; it is seen from its +Z. An eye is a node with a camera.
 *
 * Memory   the document's (jansson); texts in the arena. Threads: one at a time.
 * Fails    ERROR_INPUT where the file was made for another model, or a name is taken, with the
 *          JSON path in the equip file.
 */
#pragma once
#include <jansson.h>

#include "equip/equip_file.h"

/* As the new file has it. */
typedef struct EquipNames {
    const char *panel, *content; /* URIs; content NULL: none */
} EquipNames;

/* names: one a display. */
bool equip_patch(json_t *document, const Equip *equip, const EquipNames *names, Arena scratch,
                 Error *err);
