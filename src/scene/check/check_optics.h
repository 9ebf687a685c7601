/* SPDX-License-Identifier: Apache-2.0 */
/* check_optics.h -- rules that tables cannot express, on coatings and measured metals, on
 * indices of refraction by wavelength, and on what is not shown of a clear solid.
 */
#pragma once
#include "scene/check/check.h"

void check_layer(const DocumentCheck *check, const GltfValue *layer);
void check_coating(const DocumentCheck *check, const GltfValue *coating);

/* A warning for each member that requires what a clear solid does not have. */
void check_clear_solid(const DocumentCheck *check, const GltfValue *material);

/* Whether a coating or a conductor fits the material that has it. */
void check_coated_material(const DocumentCheck *check, const GltfValue *material);

/* Whether dispersion, or a measured index, fits the material that has it. */
void check_index(const DocumentCheck *check, const GltfValue *material);
