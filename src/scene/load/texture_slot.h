/* SPDX-License-Identifier: Apache-2.0 */
/* texture_slot.h -- the textures of a material, and the coordinates that each is read with.
 *
 * A file may have many sets of coordinates; a Part has SCENE_UV_SETS of them.
 */
#pragma once
#include "scene/gltf/loader.h"

TextureSlot texture_slot_none(void);

/* Reads {"index", "texCoord", KHR_texture_transform}; none where `info` is NULL. The uv_set is
 * still the file's TEXCOORD number. */
TextureSlot texture_slot(GltfFile *file, const GltfValue *info);

/* Turns the TEXCOORD numbers of the material's slots (and of a display's content, which may be
 * NULL) into places in Part.uv; sets[i]: which number uv[i] holds. More than two are an error
 * at `value`. */
void texture_slots_place(GltfFile *file, const GltfValue *value, Material *material,
                         TextureSlot *content, int sets[SCENE_UV_SETS]);

/* Which of Part.uv a placed material uses: the first always, since frames show it
 * (the uv layer), the second where a slot has it. */
void texture_slots_used(const Loader *load, const Material *material, bool uses_set[SCENE_UV_SETS]);
