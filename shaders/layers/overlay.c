/* SPDX-License-Identifier: Apache-2.0 */
/* The one kind of such a layer: the fibres of sheen.h. */
#include "shaders/layers/overlay.h"

#include "base/mathf.h"
#include "shaders/layers/sheen.h"

float overlay_alpha(float roughness) {
    return max_f(roughness * roughness, SHEEN_LEAST_ALPHA);
}

Spectrum overlay_tint(const Overlay *overlay, const Wavelengths *wavelengths) {
    Spectrum tint = spectrum_from_rgb(wavelengths, overlay->color);
    return spectrum_clamp(tint, 0, overlay_most(overlay));
}

float overlay_albedo(const Overlay *overlay, float cosine) {
    return sheen_albedo(&common_sheen_table, cosine, overlay->alpha);
}

float overlay_lobe(const Overlay *overlay, Vec3 wo, Vec3 wi) {
    return sheen_lobe(&common_sheen_table, wo, wi, overlay->alpha);
}

OverlayShare overlay_share(const Overlay *overlay, float cosine, float base) {
    return sheen_share(&common_sheen_table, cosine, overlay->alpha, base);
}

OverlayShare overlay_mean(const Overlay *overlay, float base) {
    return sheen_mean(&common_sheen_table, overlay->alpha, base);
}

Energy overlay_passes(const Overlay *overlay, Energy e, OverlayShare share) {
    float most = overlay_most(overlay);
    return (Energy){e.all * (1 - most * share.all), e.shape * (1 - most * share.shape)};
}

float overlay_open(const Overlay *overlay, float cosine, float coat_alpha) {
    return sheen_open(&common_sheen_table, cosine, overlay->alpha, coat_alpha);
}
