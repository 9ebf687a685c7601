/* check_coating.h -- what tables cannot say about coatings and measured metals. */
#pragma once
#include "scene/check/check.h"

void check_layer(const DocumentCheck *check, const GltfValue *layer);
void check_coating(const DocumentCheck *check, const GltfValue *coating);

/* Whether a coating or a conductor fits the material that has it. */
void check_coated_material(const DocumentCheck *check, const GltfValue *material);
