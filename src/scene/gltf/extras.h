/* SPDX-License-Identifier: Apache-2.0 */
/* extras.h -- our extensions where a tool that writes no extensions put them: `extras`.
 *
 * A member PARHELION_* of a material's or scene's extras is read as the extension of that name
 * is; tree_extension finds it there, with the place where it stands. It is an object, or a text
 * that holds the object as JSON, as custom properties of modelling programs are.
 *
 * Memory   what a text holds lies in the loader's scratch.
 * Fails    into the loader's problems, at the text.
 */
#pragma once
#include "scene/gltf/loader.h"

/* Puts what the texts hold in their place, and the names among the scene's extensions.
 * After document_read, before anything is checked. */
void extras_unfold(GltfFile *file);

/* Whether a member of extras is one of ours, by its name. */
bool extras_is_ours(const GltfValue *member);
