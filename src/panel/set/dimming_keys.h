/* SPDX-License-Identifier: Apache-2.0 */
/* dimming_keys.h -- the key "local_dimming" of manifests and recipes.
 *
 * Units    dimming_zones.h's. Fails: with file, JSON path, found and required.
 */
#pragma once
#include <jansson.h>

#include "panel/zones/dimming_zones.h"
#include "record/record.h"

extern const RecordFormat dimming_format; /* of a DimmingZones */

/* What rows cannot say, once they are read. size_mm: the document's, which becomes the zones';
 * 0: not stated. */
bool dimming_keys_check(const JsonView *root, const double size_mm[2], DimmingZones *zones,
                        Error *err);

/* As a manifest has it; the caller owns the object. */
json_t *dimming_keys_json(const DimmingZones *zones);
