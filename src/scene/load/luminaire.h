/* luminaire.h -- the nodes that --light or EXT_lights_ies makes lamps of measured intensity.
 *
 * A lamp is a point at its node's origin: what the file says of its opening's size is not used,
 * which is right from about five times that size on. Its axis gamma = 0 is the node's -Z, C = 0
 * its +X, C = 90 its +Y, as EXT_lights_ies has it; scale does not change the intensities, and a
 * mirrored node mirrors them. --light makes all nodes of the name lamps, in the place of
 * whatever light the file gives them; EXT_lights_ies in the place of KHR_lights_punctual's on
 * the same node, since exporters write both for one lamp. The light has the
 * file's colour temperature, else D65, times the color.
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
