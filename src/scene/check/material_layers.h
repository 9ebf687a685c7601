/* SPDX-License-Identifier: Apache-2.0 */
/* material_layers.h -- the layers of a glTF material, a row each: the checks, the loader and
 * the places of textures go over the rows, and name no layer.
 *
 * Threads  const data; pure functions.
 */
#pragma once
#include "scene/check/rule.h"
#include "scene/scene.h"

/* A layer of a material: the extension that brings it, and all that the checks and the loader
 * need to know of it. Its keys, with their fields, are the schema's; the first is how much
 * there is of it. */
typedef struct MaterialLayer {
    ExtensionRule rule;
    size_t size, at;              /* of a layer with a struct of its own: its bytes, and where
                                     Material points to it; 0: its keys fill Material itself */
    const char *const *hidden_by; /* extensions beside which it has no effect; a NULL ends them;
                                     NULL: none */
    const char *on_solid;         /* the warning where the material is a clear solid; NULL: none */
} MaterialLayer;

/* Begins what is said of layers that a closed solid does not show. */
#define ON_CLOSED_SOLID "has no effect: KHR_materials_volume makes the material a closed solid, "

/* In the order in which their textures take the two sets of coordinates, and in which what
 * hides them is reported. */
extern const MaterialLayer material_layers[];
extern const int material_layer_count;

/* Whether a material with this extension, which may be NULL, has the layer: its first key, or
 * one of that key's numbers, is above 0. Only of layers whose first key is 0 by default. */
bool material_layer_shows(const MaterialLayer *layer, const GltfValue *extension);

/* The struct that its keys fill; NULL: the material does not have it. */
void *material_layer_struct(const MaterialLayer *layer, Material *material);

/* Of the objects that name a texture. */
extern const Schema SCHEMA_TEXTURE_INFO;
extern const Schema SCHEMA_NORMAL_TEXTURE_INFO;
