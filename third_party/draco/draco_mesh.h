/* SPDX-License-Identifier: Apache-2.0 */
/* draco_mesh.h -- a packed triangle mesh, unpacked. The only C view of Draco.
 *
 * Format   Draco bitstream 2.2, which KHR_draco_mesh_compression is made of.
 * Memory   draco_mesh_decode owns C++ memory until draco_mesh_destroy.
 * Threads  no shared state; any number may read one DracoMesh.
 * Fails    on bytes that are no such mesh, or larger than the caller is ready for: its counts
 *          are looked at before anything is unpacked. No C++ exception crosses.
 */
#pragma once
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct DracoMesh DracoMesh;

/* most_triangles, most_vertices: refused where there are more. */
bool draco_mesh_decode(const void *bytes, size_t size, size_t most_triangles, size_t most_vertices,
                       DracoMesh **out, Error *err);

size_t draco_mesh_vertices(const DracoMesh *mesh);
size_t draco_mesh_triangles(const DracoMesh *mesh);

/* out: three vertices a triangle; each is below the number of vertices. */
bool draco_mesh_corners(const DracoMesh *mesh, uint32_t *out, Error *err);

/* An attribute by its unique id, in glTF's component type (5120 ... 5126): out holds
 * `components` such numbers a vertex, without gaps. False: it is not there, has another number
 * of components, or values that the type cannot hold. */
bool draco_mesh_values(const DracoMesh *mesh, uint32_t id, int component_type, int components,
                       void *out, Error *err);

void draco_mesh_destroy(DracoMesh *mesh); /* NULL is fine */

#ifdef __cplusplus
}
#endif
