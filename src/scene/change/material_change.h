/* SPDX-License-Identifier: Apache-2.0 */
/* material_change.h -- JSON is merged into a material before the document is checked.
 *
 * As a merge patch (RFC 7396): objects are merged member by member, null takes a member away,
 * everything else takes its place. Extensions that come in so are added to extensionsUsed.
 * URIs count from the scene's file, as all of that file do.
 *
 * Memory   in the loader's scratch.
 * Threads  one at a time.
 * Fails    into the loader's problems: the change's own text is no JSON object.
 */
#pragma once
#include "scene/gltf/loader.h"

/* All changes of materials that the file has; counts them in load->change_uses. Before the
 * document is checked. */
void materials_change(GltfFile *file);
