/* SPDX-License-Identifier: Apache-2.0 */
/* check_material.h -- rules that tables cannot express, on materials. */
#pragma once
#include "scene/check/check.h"

void check_material(const DocumentCheck *check, const GltfValue *material);
void check_glazing(const DocumentCheck *check, const GltfValue *glazing);
void check_glazing_layer(const DocumentCheck *check, const GltfValue *layer);

/* Has the primitive what its material needs: texture coordinates, tangents? */
void check_material_fits(const DocumentCheck *check, const GltfValue *primitive);
