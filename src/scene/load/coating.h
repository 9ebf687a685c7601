/* coating.h -- a material's thin layers, and the optical constants of its metal.
 *
 * Memory   in the loader's arena.
 * Fails    into the loader's problems, with the place in the file.
 */
#pragma once
#include "scene/gltf/loader.h"

/* Of a PARHELION_coating that the check has found well formed; NULL: none, or reported. */
const LayerStack *coating_read(GltfFile *file, const GltfValue *extension);

/* A URI of a file of rows nm,n,k; NULL: none, or reported. */
const OpticalConstants *coating_read_index(GltfFile *file, const GltfValue *uri);
