/* SPDX-License-Identifier: Apache-2.0 */
/* mirror_change.h -- the whole scene is mirrored at the vehicle's middle plane: a right-hand
 * drive of a left-hand one.
 *
 * Plane    vertical, along where the vehicle points; `middle_m` to the right of the origin. All
 *          nodes of all files are mirrored, cameras, lamps and luminaires among them, after all
 *          other changes. Sun and sky stay: they belong to no node.
 * Displays their panels and contents are not mirrored: who faces one reads its text, and sees
 *          the panel as measured. On each node the content's U is mirrored at the middle of the
 *          range that the node shows of it.
 * Memory   the loader's.
 * Threads  one at a time. Fails: never.
 */
#pragma once
#include "scene/gltf/loader.h"

/* After nodes_change. In scene coordinates: at a plane through the scene's origin, which goes
 * along when all files are built. */
void nodes_mirror(GltfFile *file);
void mirror_scene_origin(Loader *load);

/* Makes the displays readable again. After all parts stand and displays are known. */
void displays_mirror(Loader *load);
