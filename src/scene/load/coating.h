/* SPDX-License-Identifier: Apache-2.0 */
/* coating.h -- a material's thin layers.
 *
 * Memory   in the loader's arena.
 * Fails    into the loader's problems, with the place in the file.
 */
#pragma once
#include "scene/gltf/loader.h"

/* Reads a PARHELION_coating, or the coating of a pane's face, that the check has found well
 * formed; NULL: there is none, or an error was reported. */
const LayerStack *coating_read(GltfFile *file, const GltfValue *extension);
