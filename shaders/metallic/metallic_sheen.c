/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/metallic/metallic_sheen.h"

#include "shaders/metallic/metallic_energy.h"

Spectrum sheen_tint(const MetallicRoughness *m)
{
    Spectrum tint = spectrum_from_rgb(m->wavelengths, m->sheen_color);
    return spectrum_clamp(tint, 0, sheen_most(m));
}

SheenShare sheen_towards(const MetallicRoughness *m, Vec3 w)
{
    return sheen_share(&common_sheen_table, fabsf(w.z), m->sheen_alpha, energy_own_alpha(m, w));
}

float sheen_leaves(const MetallicView *view, Vec3 wi)
{
    const MetallicRoughness *m = view->m;
    float in = sheen_albedo(&common_sheen_table, fabsf(wi.z), m->sheen_alpha);
    return 1 - sheen_most(m) * fmaxf(view->sheen.albedo, in);
}

Energy sheen_lets_through(const MetallicRoughness *m, Energy e, SheenShare share)
{
    float most = sheen_most(m);
    return (Energy){e.all * (1 - most * share.all), e.shape * (1 - most * share.shape)};
}

float sheen_kept(const MetallicRoughness *m, float cosine)
{
    if (!has_sheen(m)) return 1;
    return 1 - sheen_most(m) * sheen_albedo(&common_sheen_table, cosine, m->sheen_alpha);
}

Spectrum sheen_fibres(const MetallicView *view, Vec3 wi)
{
    const MetallicRoughness *m = view->m;
    float lobe = sheen_lobe(&common_sheen_table, view->wo, wi, m->sheen_alpha);
    return sheen_tint(m) * spectrum_all(lobe);
}
