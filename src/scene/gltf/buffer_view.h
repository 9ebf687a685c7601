/* SPDX-License-Identifier: Apache-2.0 */
/* buffer_view.h -- the bytes of buffer views, also of packed ones (EXT_meshopt_compression).
 *
 * A view that is packed states where the packed bytes lie, in which buffer, and what the
 * unpacked ones are: `count` elements of `byteStride` bytes. The bytes in its own place, for
 * readers without the extension, are not looked at.
 *
 * Source   github.com/KhronosGroup/glTF, extensions/2.0/Vendor/EXT_meshopt_compression; that
 *          its numbers fit each other is checked by check/schema_extensions.c
 * Memory   unpacked bytes lie in the loader's scratch.
 * Fails    into the loader's problems, with the view.
 * Threads  one at a time.
 */
#pragma once
#include "scene/gltf/loader.h"

/* Fills file->views. The document was checked, its buffers are loaded, file->data is read. */
void buffer_views_build(GltfFile *file);
