/* SPDX-License-Identifier: Apache-2.0 */
/* environment.h -- the scene's PARHELION_environment: sky, sun, surroundings.
 *
 * Its members may stand in another JSON file than a scene's: they are checked and read exactly
 * as there.
 */
#pragma once
#include "scene/gltf/loader.h"

void environment_build(GltfFile *file, const GltfValue *extension);

typedef struct EnvironmentText {
    const char *file;  /* as the user named it: URIs are relative to it */
    const char *place; /* where it stands there, a JSON pointer */
    const char *text;  /* the object's JSON */
    const char *root;  /* as SceneOptions.root */
} EnvironmentText;

typedef struct EnvironmentFound {
    Environment environment;
    const char *picture;   /* the file of an HDRI; NULL: none */
    uint64_t picture_hash; /* XXH3 64 */
} EnvironmentFound;

/* What it keeps lies in the arena; one at a time. Fails with the file, the JSON pointer, what
 * was found and what was required; warnings go to the caller's problems. */
bool environment_text_read(const EnvironmentText *text, Arena *arena, Problems *problems,
                           EnvironmentFound *out, Error *err);
