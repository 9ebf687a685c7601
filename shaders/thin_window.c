/* SPDX-License-Identifier: Apache-2.0 */
/* thin_window -- clear sheets without thickness: windscreens, side windows, instrument covers.
 *
 * Light passes straight (shadow rays pass too), and a mirror image shows on it.
 *   ior    1 and up, glTF's default 1.5; window glass 1.52
 *   tint   0..1 a wavelength, what the body lets through once along the normal (no faces):
 *          green-tinted laminated glass about 0.85 at 550 nm
 *   coating  a stack of thin layers on one face or both (PARHELION_coating)
 * Two faces and one absorbing body, as every thin pane: layers/pane.h. At an angle the way
 * through the body is longer, tint^(1 / cos t'), t' the refracted angle. A coating interferes
 * with itself (spectrum/thin_film.h), the two faces do not.
 *
 * Polarised light is followed exactly where glass is bare; coated glass is taken as bare for
 * how it polarises.
 */
#include "shaders/thin_window.h"

#include "shaders/polarisation.h"

static PaneLight meet(const ThinWindow *window, float cosine) {
    cosine = clampf(cosine, 0, 1);
    Spectrum t = pane_body(window->tint, cosine, window->ior);
    if (window->coating) {
        PaneMeeting meeting = {window->coating, window->wavelengths, cosine, window->front_is_met,
                               t};
        return pane_coated(&meeting);
    }
    Fresnel face = fresnel_dielectric(cosine, window->ior, NULL);
    return pane_between(spectrum_all(face.s), spectrum_all(face.p), t);
}

Spectrum thin_window_reflectance(const ThinWindow *window, float cosine) {
    return meet(window, cosine).reflected;
}

Spectrum thin_window_transmittance(const ThinWindow *window, float cosine) {
    return meet(window, cosine).passed;
}

/* Straight on, or mirrored. */
static bool send(bool passes, Vec3 wo, float prob, Spectrum weight, BsdfSample *sample) {
    *sample = (BsdfSample){.wi = vec3(-wo.x, -wo.y, passes ? -wo.z : wo.z),
                           .pdf = prob,
                           .is_delta = true,
                           .passes = passes,
                           .weight = weight};
    return true;
}

static bool window_sample(const void *parameters, Vec3 wo, const float u[3], BsdfSample *sample) {
    PaneLight light = meet(parameters, fabsf(wo.z));
    float share = spectrum_mean(light.reflected), all = share + spectrum_mean(light.passed);
    if (!(all > 0)) return false;
    float prob = share / all;
    if (u[2] < prob) return send(false, wo, prob, light.reflected / spectrum_all(prob), sample);
    return prob < 1 && send(true, wo, 1 - prob, light.passed / spectrum_all(1 - prob), sample);
}

static Spectrum window_pass(const void *parameters, Vec3 wo) {
    return thin_window_transmittance(parameters, fabsf(wo.z));
}

static Spectrum window_mirror(const void *parameters, Vec3 wo) {
    return thin_window_reflectance(parameters, fabsf(wo.z));
}

static Spectrum window_albedo(const void *parameters, Vec3 wo) {
    PaneLight light = meet(parameters, fabsf(wo.z));
    return light.reflected + light.passed;
}

static bool window_polarise(const void *parameters, Vec3 wo, const BsdfSample *way,
                            BsdfPolarisation *out) {
    const ThinWindow *window = parameters;
    float cosine = clampf(fabsf(wo.z), 0, 1);
    PolarisedParts parts = {spectrum_all(0), spectrum_all(0), spectrum_all(0), spectrum_all(0)};
    PolarisedPane pane = {waves_reflected(cosine, window->ior),
                          pane_body(window->tint, cosine, window->ior), way->passes};
    polarised_add_pane(&parts, &pane, spectrum_all(1));
    *out = polarised_of(&parts, spectrum_all(1));
    return true;
}

const BsdfModel thin_window_model = {
    .traits = BSDF_IS_SHEET,
    .scatter = {.sample = window_sample, .albedo = window_albedo},
    .boundary = {.mirror = window_mirror, .pass = window_pass},
    .polarise = window_polarise,
};
