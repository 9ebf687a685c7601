/* SPDX-License-Identifier: Apache-2.0 */
/* environment_text.h -- the members of a PARHELION_environment in another JSON file than a
 * scene's: checked and read exactly as there.
 *
 * Memory   what it keeps lies in the arena. Threads: one at a time.
 * Fails    with the file, the JSON pointer, what was found and what was wanted. Warnings go to
 *          the caller's problems.
 */
#pragma once
#include "base/problems.h"
#include "scene/gltf/tree.h"
#include "scene/scene.h"

typedef struct EnvironmentText {
    const char      *file;  /* as the user named it: URIs are relative to it */
    const GltfValue *value; /* the object, in its document's tree */
    const char      *root;  /* as SceneOptions.root */
} EnvironmentText;

typedef struct EnvironmentFound {
    Environment environment;
    const char *picture;      /* the file of an HDRI; NULL: none */
    uint64_t    picture_hash; /* XXH3 64 */
} EnvironmentFound;

bool environment_text_read(const EnvironmentText *text, Arena *arena, Problems *problems,
                           EnvironmentFound *out, Error *err);
