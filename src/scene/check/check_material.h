/* check_material.h -- what tables cannot say about materials and textures. */
#pragma once
#include "scene/check/check.h"

void check_texture(const DocumentCheck *check, const GltfValue *texture);
void check_material(const DocumentCheck *check, const GltfValue *material);

/* Has the primitive what its material needs: texture coordinates, tangents? */
void check_material_fits(const DocumentCheck *check, const GltfValue *primitive);
