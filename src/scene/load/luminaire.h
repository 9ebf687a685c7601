/* SPDX-License-Identifier: Apache-2.0 */
/* luminaire.h -- the nodes that --light or EXT_lights_ies makes lamps of measured intensity.
 *
 * A lamp shines out of the opening that its file states, about its node's origin; a file that
 * states none makes it a point. Its axis gamma = 0 is the node's -Z, C = 0 its +X, C = 90 its
 * +Y, as EXT_lights_ies has it; scale changes neither intensities nor opening, and a mirrored
 * node mirrors them. Factors for tilted lamps (TILT=) count with the scene's -Y as down.
 *
 * --light makes all nodes of the name lamps, in the place of any light that the file gives
 * them; EXT_lights_ies in the place of KHR_lights_punctual's on the same node, since exporters
 * write both for one lamp. The light has the file's colour temperature, else D65, times the
 * color.
 *
 * Fails    into load->problems, naming the option, or the file and its line.
 */
#pragma once
#include "scene/gltf/loader.h"

/* Before the first file. */
void luminaires_start(Loader *load);

/* True when the node became a lamp. */
bool luminaire_place(GltfFile *file, const GltfValue *node, const Transform *world);

/* Behind the last file: names that no node has, levels and colour temperatures. */
void luminaires_finish(Loader *load);
