/* SPDX-License-Identifier: Apache-2.0 */
/* display.h -- materials that are displays. */
#pragma once
#include "scene/gltf/loader.h"

/* The material's PARHELION_display. */
void display_build(GltfFile *file, const GltfValue *extension, int material_id);

/* The command line's --panel, --content and --display-level. */
void displays_override(Loader *load);

/* Changes that are finishes; counts the displays that they found. After displays_override. */
void displays_change(Loader *load);

/* After all files are read: opens the panels, sets what follows from them, and checks that no
 * coordinates are mirrored. */
void displays_finish(Loader *load);
