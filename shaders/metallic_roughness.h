/* metallic_roughness.h -- glTF's surface: paint, plastic, cloth, leather, chrome, lacquer.
 *
 * The user page is on top of metallic_roughness.c. Frame and units: bsdf.h.
 */
#pragma once
#include "shaders/bsdf_sample.h"
#include "shaders/energy.h"

/* All members are set by whoever builds it; metallic_roughness_default() is a start. */
typedef struct MetallicRoughness {
    Spectrum base_color;       /* [0, 1]: albedo; of metals, reflectance at normal incidence */
    Spectrum specular_color;   /* >= 0: multiplies the dielectric's F0 */
    float    metallic;         /* [0, 1] */
    float    alpha;            /* GGX, [0, 1]; below SMOOTH_ALPHA a perfect mirror */
    float    specular;         /* [0, 1]: strength of the dielectric's reflection */
    float    transmission;     /* [0, 1]: share of the non-metal that is a thin clear sheet */
    float    clearcoat;        /* [0, 1]: share that carries a lacquer of index 1.5 */
    float    clearcoat_alpha;  /* GGX, [0, 1] */
    Vec3     clearcoat_normal; /* unit, local frame; z > 0 */
    const EnergyTable *energy;           /* of the material's index of refraction */
    const EnergyTable *clearcoat_energy; /* of 1.5; may be NULL when clearcoat is 0 */
} MetallicRoughness;

/* glTF's default material, but for energy, which the caller owns: white metal, alpha 1. */
MetallicRoughness metallic_roughness_default(const EnergyTable *energy);

Spectrum metallic_roughness_eval(const MetallicRoughness *m, Vec3 wo, Vec3 wi, float *pdf);
bool     metallic_roughness_sample(const MetallicRoughness *m, Vec3 wo, const float u[3],
                                   BsdfSample *sample);
Spectrum metallic_roughness_pass(const MetallicRoughness *m, Vec3 wo);
bool     metallic_roughness_scatters(const MetallicRoughness *m);
Spectrum metallic_roughness_albedo(const MetallicRoughness *m, Vec3 wo);
