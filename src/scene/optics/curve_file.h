/* SPDX-License-Identifier: Apache-2.0 */
/* curve_file.h -- the CSV files of measured curves that a scene names.
 *
 * Memory   what is returned lies in the loader's arena, the files' bytes in its scratch.
 * Fails    into the loader's problems, with the file, its line, and the place in the scene.
 */
#pragma once
#include "scene/gltf/loader.h"

/* Rows nm,value within the range. False: reported; *out is undefined. */
bool curve_file_read(GltfFile *file, const GltfValue *uri, CurveRange range, Curve *out);

/* Rows nm,n,k. NULL: uri is, or reported. */
const OpticalConstants *curve_file_index(GltfFile *file, const GltfValue *uri);
