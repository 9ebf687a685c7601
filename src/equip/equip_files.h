/* SPDX-License-Identifier: Apache-2.0 */
/* equip_files.h -- files that a new .gltf names: by a URI where they lie in its folder or
 * below, else as a copy beside it, so that the folder can be sent to somebody.
 *
 * The model is somebody else's, and the copies may go to a third: it reaches its own folder
 * alone (base/reference.h), and of what it names only that is renamed or copied which was
 * decoded as what it is named for.
 *
 * A copy keeps its name unless another file has it already: then the new file's name stands
 * before it. Nothing that is there is written over.
 *
 * Memory   the arena that it was opened with.
 * Threads  one at a time.
 * Fails    ERROR_INPUT for what cannot be read, ERROR_OUTPUT for what cannot be written.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"
#include "base/error.h"
#include "scene/scene.h"

typedef struct EquipCopy {
    const char *source, *name; /* absolute; beside the new file */
    bool is_there;             /* the same bytes already */
    bool is_written;
} EquipCopy;

typedef struct EquipFiles {
    const char *model, *output, *root; /* root: --root, or the shipped assets, or NULL */
    const Scene *decoded;              /* the model as it was loaded; NULL: it ships, and is
                                          trusted */
    const char *folder;                /* the new file's, absolute: "/a/b/" */
    EquipCopy *copies;
    int count, capacity;
    Arena *arena;
} EquipFiles;

/* model, output: as the user named them; they must outlive it. */
bool equip_files_open(const char *model, const char *output, const char *root, Arena *arena,
                      EquipFiles *out, Error *err);

/* The new file's name without its ending, with another one: "car" + ".bin". */
const char *equip_files_beside(const EquipFiles *files, const char *ending);

/* The URI by which the new file names the file at `path`. */
bool equip_files_take(EquipFiles *files, const char *path, const char **uri, Error *err);

/* Every file that the model's document names is called as the new file has to: those of buffers
 * and pictures, and what our extensions and EXT_lights_ies name, in extras too. A buffer that
 * no view reads names none any more. */
bool equip_files_refer(EquipFiles *files, json_t *document, Error *err);

bool equip_files_write(EquipFiles *files, Error *err);

/* Takes back the copies that equip_files_write made. */
void equip_files_undo(const EquipFiles *files);
