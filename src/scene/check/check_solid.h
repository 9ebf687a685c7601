/* SPDX-License-Identifier: Apache-2.0 */
/* check_solid.h -- what of a glTF material is not shown where it is a clear solid. */
#pragma once
#include "scene/check/check.h"

/* A warning for each member that asks for something else. */
void check_clear_solid(const DocumentCheck *check, const GltfValue *material);
