/* SPDX-License-Identifier: Apache-2.0 */
/* wearer.h -- the material that "node:NAME" or "mesh:NAME" means on the command line, where two
 * screens share one.
 *
 * Memory   a material of its own joins the loader's lists.
 * Fails    into the loader's problems, with the option.
 */
#pragma once
#include "scene/gltf/loader.h"

#define WEARER_NODE "node:"

/* Adds a name to a list for messages, once and as long as there is room. */
enum { WEARER_NAMES_MAX = 480 };
void wearer_list_name(char names[WEARER_NAMES_MAX], const char *name);

/* Whether `word` has one of the two forms. */
bool wearer_is_named(const char *word);

/* The id of the material that the named node or mesh wears, and nothing else does: where others
 * wear it too, a copy is made, named after the wearer, with a display of its own where the
 * material is one. NO_ID, and reported: nothing has the name, several nodes have it, or they
 * wear several materials of which not exactly one glows with a texture or is a display. */
int wearer_material(Loader *load, const char *option, const char *word);

/* A warning where a material that is to become a display is worn by several nodes. */
void wearer_warn_of_sharing(Loader *load, const char *option, int material_id);
