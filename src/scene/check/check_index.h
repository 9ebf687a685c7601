/* SPDX-License-Identifier: Apache-2.0 */
/* check_index.h -- rules that tables cannot express, on indices of refraction by wavelength. */
#pragma once
#include "scene/check/check.h"

/* Whether dispersion, or a measured index, fits the material that has it. */
void check_index(const DocumentCheck *check, const GltfValue *material);
