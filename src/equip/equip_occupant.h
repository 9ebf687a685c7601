/* SPDX-License-Identifier: Apache-2.0 */
/* equip_occupant.h -- the car's driver (scenes/README.md) as a scene of its own, seated so that
 * the eyes are where a model's eye is.
 *
 * Its size and pose are as modelled: feet and hands may miss the model's floor and wheel.
 *
 * Memory   texts in the files' arena. Threads: one at a time.
 * Fails    as equip_shipped.h and equip_files.h.
 */
#pragma once
#include "equip/equip_file.h"
#include "equip/equip_files.h"

/* Where the shipped driver's eyes are, as its node has it, metres; it looks along -Z. */
#define OCCUPANT_EYE_M 1.3

/* Writes it to `path` beside the new scene; what it names is copied with `files` later. */
bool equip_occupant_write(const Equip *equip, EquipFiles *files, const char *path, Error *err);
