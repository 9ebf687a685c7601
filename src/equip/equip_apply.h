/* SPDX-License-Identifier: Apache-2.0 */
/* equip_apply.h -- a model, and what it is equipped with, become a scene and a request for its
 * review.
 *
 * Written are the scene, a .bin beside it where the model was a .glb, copies of files that the
 * scene may not name where they lie, and NAME.review.json. The scene is loaded before it gets
 * its name: what is wrong with it leaves nothing behind.
 *
 * Memory   the arena's. Threads: one at a time.
 * Fails    as equip_file.h, equip_patch.h, equip_files.h and scene_load do.
 */
#pragma once
#include "base/problems.h"
#include "equip/equip_file.h"

typedef struct EquipOrder {
    const char *model, *with, *output;
    const char *root; /* whose files it may name besides its own folder's; NULL: none */
    bool overwrites;  /* files with the outputs' names */
} EquipOrder;

typedef struct EquipResult {
    const char *scene, *bin, *review; /* NULL: no .bin; no display shows content to read */
    const char *occupant;             /* NULL: nobody sits there */
    const char **copies;              /* beside the scene */
    int copy_count;
    int display_count, eye_count, material_count;
    const char *first_eye;    /* a camera of the scene */
    double forward[3];        /* where the vehicle points */
    bool forward_is_proposed; /* from where the first eye looks */
    int without_data;         /* materials that still have none */
} EquipResult;

/* Warnings of the new scene go to *problems. */
bool equip_apply(const EquipOrder *order, Arena *arena, Problems *problems, EquipResult *out,
                 Error *err);
