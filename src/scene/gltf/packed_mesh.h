/* SPDX-License-Identifier: Apache-2.0 */
/* packed_mesh.h -- the accessors of meshes that are packed (KHR_draco_mesh_compression).
 *
 * A primitive that is packed states which buffer view holds the packed bytes and which
 * attribute of them is which of its own; its accessors state the counts and types. Unpacked,
 * each of these accessors reads a view of its own behind the document's; what they read without
 * the extension is not looked at. The corners are those of triangles, in any mode.
 *
 * Source   github.com/KhronosGroup/glTF, extensions/2.0/Khronos/KHR_draco_mesh_compression
 * Memory   unpacked bytes lie in the loader's scratch.
 * Fails    into the loader's problems, with the primitive.
 * Threads  one at a time.
 */
#pragma once
#include "scene/gltf/loader.h"

/* Unpacks all packed primitives: file->data and file->views change. The document was checked,
 * its views are built. */
void packed_meshes_build(GltfFile *file);
