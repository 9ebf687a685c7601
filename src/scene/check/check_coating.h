/* SPDX-License-Identifier: Apache-2.0 */
/* check_coating.h -- rules that tables cannot express, on coatings and measured metals. */
#pragma once
#include "scene/check/check.h"

void check_layer(const DocumentCheck *check, const GltfValue *layer);
void check_coating(const DocumentCheck *check, const GltfValue *coating);

/* Refracts: KHR_materials_volume with a thickness, and KHR_materials_transmission. */
bool material_is_clear_solid(const GltfValue *material);

/* Whether a coating or a conductor fits the material that has it. */
void check_coated_material(const DocumentCheck *check, const GltfValue *material);
