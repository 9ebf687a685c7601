/* SPDX-License-Identifier: Apache-2.0 */
/* profiles.h -- the light profiles of a file: IES files that EXT_lights_ies lists.
 *
 * Extension https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_lights_ies
 *
 * Memory   profiles lie in the loader's scratch, what lamps keep of them in its arena.
 * Fails    into load->problems, with file and JSON pointer, and the profile's line.
 */
#pragma once
#include "import/luminaire/luminaire.h"
#include "scene/gltf/loader.h"

typedef struct LightProfile {
    const char *name;        /* "light profile N" where the file has none */
    const char *file;        /* its path; of one inside the scene: the scene's, and where in it */
    const IntensityWeb *web; /* NULL: could not be read, which was reported */
    LuminousOpening opening;
    LuminaireTilt tilt;
    float cct_k;          /* 0: not stated */
    const char *cct_text; /* the file's text about it; "": none */
} LightProfile;

/* Reads a profile's bytes; out->file names them in messages, and with has_folder it is a path,
 * beside which a file that TILT= names may stand. */
bool profile_read(Loader *load, FileBytes bytes, bool has_folder, LightProfile *out, Error *err);

/* Reads all of them: a file that is named must be there, whether a node shows it or not. */
void profiles_load(GltfFile *file);

/* NULL where there is no such profile. */
const LightProfile *profile_at(const GltfFile *file, int index);
