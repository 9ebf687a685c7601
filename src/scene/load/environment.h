/* SPDX-License-Identifier: Apache-2.0 */
/* environment.h -- the scene's PARHELION_environment: sky, sun, surroundings. */
#pragma once
#include "scene/gltf/loader.h"

void environment_build(GltfFile *file, const GltfValue *extension);
