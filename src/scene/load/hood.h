/* SPDX-License-Identifier: Apache-2.0 */
/* hood.h -- a hood over a display, to be tried out: a plate along its upper edge and a cheek on
 * each side, which narrows to nothing at the lower edge.
 *
 * The plate reaches `depth_m` out of the display's plane, along the mean normal of its surface;
 * `up` is the world's, within that plane. All three are 2 mm thick, stand 2 mm beside the
 * display, and are matt, of a reflectance of 4 %. A curved display counts by the box about it.
 *
 * Memory   the loader's.
 * Threads  one at a time.
 * Fails    into the loader's problems: the display lies flat, so that no edge is the upper one.
 */
#pragma once
#include "scene/gltf/loader.h"

/* All changes that are hoods; counts the displays that they found. After displays_override. */
void hoods_build(Loader *load);
