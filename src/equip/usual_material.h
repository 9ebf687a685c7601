/* SPDX-License-Identifier: Apache-2.0 */
/* usual_material.h -- usual materials of a cabin's surfaces, for models that lack them.
 *
 * Figures as glTF's metallic-roughness takes them: linear Rec.709 reflectances, glTF's own
 * roughness. They are typical, none is measured on the user's part: each names its source.
 *
 * Memory   constant; nothing to free. Threads: any. Fails: never.
 */
#pragma once
#include <jansson.h>

typedef struct UsualMaterial {
    const char *name;
    double base_color[3], roughness, metallic;
    double transmission; /* 0 or 1 */
    double ior;          /* above 1 */
    const char *source;
} UsualMaterial;

extern const UsualMaterial usual_materials[]; /* one without a name ends them */

/* As glTF has it, for the page: [{"name", "base_color", "roughness", ..., "source"}]. */
json_t *usual_material_json(void);
