/* SPDX-License-Identifier: Apache-2.0 */
/* check_blender.h -- what Blender's glTF exporter leaves out or writes in units of its own. */
#pragma once
#include "scene/check/check.h"

/* Of a whole document; only one that Blender wrote is looked at. */
void check_blender(const DocumentCheck *check, const GltfValue *root);
