/* SPDX-License-Identifier: Apache-2.0 */
/* check_mesh.h -- primitives: formats, counts and names of their attributes. */
#pragma once
#include "scene/check/check.h"

void check_primitive(const DocumentCheck *check, const GltfValue *primitive);
