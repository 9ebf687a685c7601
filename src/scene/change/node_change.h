/* SPDX-License-Identifier: Apache-2.0 */
/* node_change.h -- nodes are turned and moved once their places are known.
 *
 * A change names one node, which it turns about the middle of its surface, and others of the
 * same file that move along: a display with its glass and its rim. All that hangs below a moved
 * node, lights and cameras among it, moves with it.
 *
 * Frame    the surface's: its normal is the mean of the surface (right-handed triangles, each
 *          by its area), `up` is the world's +Y. Of a surface that faces nowhere (a closed
 *          body) or straight up or down the normal is taken as against where the vehicle
 *          points.
 *          roll turns it clockwise as seen by who faces it, then turn to their right about the
 *          vertical, then tilt up about the surface's own level axis as it stood before.
 * Units    radians, m.
 * Memory   in the loader's scratch.
 * Threads  one at a time.
 * Fails    into the loader's problems: a node is missing, not the only one of its name, or has
 *          no surface to turn about.
 */
#pragma once
#include "scene/gltf/loader.h"

/* All changes of nodes that the file has; counts them in load->change_uses. After
 * nodes_enter_scene (load/nodes.h). */
void nodes_change(GltfFile *file);
