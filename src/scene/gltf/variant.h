/* SPDX-License-Identifier: Apache-2.0 */
/* variant.h -- which material a primitive wears (KHR_materials_variants).
 *
 * A file offers variants by name; the loader's options choose at most one of a file. What no
 * mapping of the chosen variant names keeps its own material, as without any.
 *
 * Source   github.com/KhronosGroup/glTF, extensions/2.0/Khronos/KHR_materials_variants
 * Fails    into the loader's problems where two variants of one file are chosen.
 * Threads  one at a time.
 */
#pragma once
#include "scene/gltf/loader.h"

/* Notes the names of the file's variants and sets file->variant_id. The document need not have
 * been checked. */
void variant_choose(GltfFile *file);

/* The place among the document's materials; NO_ID: glTF's default material. */
int variant_material(const GltfFile *file, const GltfValue *primitive);
