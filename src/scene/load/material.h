/* SPDX-License-Identifier: Apache-2.0 */
/* material.h -- a file's materials. */
#pragma once
#include "scene/gltf/loader.h"

/* All of them, with the displays among them. */
void materials_build(GltfFile *file);

/* The id of glTF's default material, which the file gets when it first needs it. */
int material_default(GltfFile *file);

/* The id of a new material that only scatters: linear Rec.709 of all three, 0..1. */
int material_add_matt(Loader *load, const char *name, float reflectance);

/* Sets what follows from the other members; after the last change of these. */
void material_derive_flags(Material *material);
