/* SPDX-License-Identifier: Apache-2.0 */
/* equip_model.h -- a model's document as it stands in its file, to be changed and written.
 *
 * Memory   bytes in the arena; the document is released by equip_model_close.
 * Threads  one at a time.
 * Fails    ERROR_INPUT with the file.
 */
#pragma once
#include <jansson.h>

#include "base/file.h"

typedef struct EquipModel {
    const char *path;
    json_t     *document;
    FileBytes   bin; /* a .glb's BIN chunk; data NULL: none */
} EquipModel;

/* path: a file that scene_load took. */
bool equip_model_read(const char *path, Arena *arena, EquipModel *out, Error *err);

/* NULL documents are fine. */
void equip_model_close(EquipModel *model);
