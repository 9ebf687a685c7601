/* SPDX-License-Identifier: Apache-2.0 */
#include "equip/usual_material.h"

#define CAR "stated, as the shipped car's (scenes/car_dashboard.gltf)"
#define CLOTH "stated, as assets/spectra has it"
#define METAL ", Fresnel at the normal, D65; roughness stated"

/* Metals are computed from the tables of constants that the program ships. The windscreen is
 * two sheets of assets/spectra/glass_green.csv under D65: with its faces it passes 77 %. */
const UsualMaterial usual_materials[] = {
    {"leather, black", {0.040, 0.040, 0.042}, 0.55, 0, 0, 1.5, CAR},
    {"leather, brown", {0.215, 0.090, 0.037}, 0.55, 0, 0, 1.5, CAR},
    {"trim, black plastic", {0.045, 0.045, 0.047}, 0.58, 0, 0, 1.5, CAR},
    {"trim, grey plastic", {0.18, 0.18, 0.18}, 0.58, 0, 0, 1.5, "stated: a middle grey"},
    {"gloss black", {0.004, 0.004, 0.004}, 0.05, 0, 0, 1.5, CAR ", piano black"},
    {"cloth, dark", {0.05, 0.05, 0.05}, 1, 0, 0, 1.5, CLOTH ", cloth_dark.csv"},
    {"cloth, grey", {0.4, 0.4, 0.4}, 1, 0, 0, 1.5, CLOTH ", cloth_grey.csv"},
    {"headliner, light", {0.6, 0.6, 0.58}, 1, 0, 0, 1.5, "stated: light woven cloth"},
    {"carpet, black", {0.030, 0.030, 0.032}, 1, 0, 0, 1.5, CAR},
    {"rubber",
     {0.036, 0.036, 0.036},
     0.8,
     0,
     0,
     1.5,
     "Filament's sheet of material properties: sRGB 53; roughness stated"},
    {"chrome", {0.550, 0.556, 0.554}, 0.1, 1, 0, 1.5, "assets/coatings/chromium.csv" METAL},
    {"chrome, satin", {0.550, 0.556, 0.554}, 0.3, 1, 0, 1.5, "assets/coatings/chromium.csv" METAL},
    {"aluminium, brushed",
     {0.907, 0.916, 0.922},
     0.3,
     1,
     0,
     1.5,
     "assets/coatings/aluminium.csv" METAL},
    {"mirror", {0.9, 0.9, 0.9}, 0.02, 1, 0, 1.5, CAR},
    {"paint, white", {0.8, 0.8, 0.8}, 0.3, 0, 0, 1.5, "stated: a white lacquer"},
    {"glass, clear", {1, 1, 1}, 0, 0, 1, 1.52, "soda-lime glass, n 1.52; absorbs nothing"},
    {"glass, windscreen",
     {0.752, 0.863, 0.797},
     0,
     0,
     1,
     1.52,
     "two sheets of assets/spectra/glass_green.csv; n 1.52"},
    {"acrylic, clear", {1, 1, 1}, 0, 0, 1, 1.49, "PMMA, n 1.49; absorbs nothing"},
    {0}};

json_t *usual_material_json(void) {
    json_t *list = json_array();
    for (const UsualMaterial *m = usual_materials; m->name; m++) {
        json_array_append_new(list, json_pack("{s:s, s:[f,f,f], s:f, s:f, s:f, s:f, s:s}", "name",
                                              m->name, "base_color", m->base_color[0],
                                              m->base_color[1], m->base_color[2], "roughness",
                                              m->roughness, "metallic", m->metallic, "transmission",
                                              m->transmission, "ior", m->ior, "source", m->source));
    }
    return list;
}
