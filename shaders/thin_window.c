/* SPDX-License-Identifier: Apache-2.0 */
/* thin_window -- clear sheets without thickness: windscreens, side windows, instrument covers.
 *
 * Light passes straight (shadow rays pass too), and a mirror image shows on it.
 *   ior    1 and up, glTF's default 1.5; window glass 1.52
 *   tint   0..1 a wavelength; green-tinted laminated glass about 0.85 at 550 nm
 *   coating  a stack of thin layers on one face or both (PARHELION_coating)
 * Per polarisation R = 2r/(1+r) and T = (1-r)/(1+r) with r one face's exact Fresnel
 * reflectance, both averaged over the polarisations: all reflections between the faces are in
 * it, interference is not. The tint multiplies T once and does not act on R. A coating
 * interferes with itself (spectrum/thin_film.h), the two faces do not.
 *
 * Polarised light is followed exactly where glass is bare; coated glass is taken as bare for
 * how it polarises.
 */
#include "shaders/thin_window.h"

#include "spectrum/fresnel.h"
#include "shaders/polarisation.h"

static Fresnel window_face(const ThinWindow *window, float cosine)
{
    return fresnel_dielectric(clampf(cosine, 0, 1), window->ior, NULL);
}

Spectrum thin_window_reflectance(const ThinWindow *window, float cosine)
{
    if (window->reflectance)
        return coating_at(window->reflectance, window->wavelengths, clampf(cosine, 0, 1));
    return spectrum_all(fresnel_slab(window_face(window, cosine)));
}

Spectrum thin_window_transmittance(const ThinWindow *window, float cosine)
{
    if (window->transmittance)
        return window->tint *
               coating_at(window->transmittance, window->wavelengths, clampf(cosine, 0, 1));
    return window->tint * spectrum_all(1 - fresnel_slab(window_face(window, cosine)));
}

/* Straight on, or mirrored. */
static bool send(bool passes, Vec3 wo, float prob, Spectrum weight, BsdfSample *sample)
{
    *sample = (BsdfSample){.wi = vec3(-wo.x, -wo.y, passes ? -wo.z : wo.z), .pdf = prob,
                           .is_delta = true, .passes = passes, .weight = weight};
    return true;
}

static bool coated_window_sample(const ThinWindow *window, Vec3 wo, float u, BsdfSample *sample)
{
    Spectrum reflected = thin_window_reflectance(window, fabsf(wo.z));
    Spectrum through = thin_window_transmittance(window, fabsf(wo.z));
    float    share = spectrum_mean(reflected), all = share + spectrum_mean(through);
    if (!(all > 0)) return false;
    float prob = share / all;
    if (u < prob) return send(false, wo, prob, reflected / spectrum_all(prob), sample);
    return prob < 1 && send(true, wo, 1 - prob, through / spectrum_all(1 - prob), sample);
}

static bool window_sample(const void *parameters, Vec3 wo, const float u[3], BsdfSample *sample)
{
    const ThinWindow *window = parameters;
    if (window->reflectance) return coated_window_sample(window, wo, u[2], sample);
    float cosine = fabsf(wo.z);
    float reflected = fresnel_slab(window_face(window, cosine));
    float through = (1 - reflected) * spectrum_mean(window->tint);
    if (!(reflected + through > 0)) return false;
    float prob = reflected / (reflected + through);
    if (u[2] < prob) return send(false, wo, prob, spectrum_all(reflected / prob), sample);
    if (!(through > 0)) return false;
    return send(true, wo, 1 - prob, window->tint * spectrum_all((1 - reflected) / (1 - prob)),
                sample);
}

static Spectrum window_pass(const void *parameters, Vec3 wo)
{
    return thin_window_transmittance(parameters, fabsf(wo.z));
}

static Spectrum window_mirror(const void *parameters, Vec3 wo)
{
    return thin_window_reflectance(parameters, fabsf(wo.z));
}

static Spectrum window_albedo(const void *parameters, Vec3 wo)
{
    return thin_window_reflectance(parameters, fabsf(wo.z)) +
           thin_window_transmittance(parameters, fabsf(wo.z));
}

static bool window_polarise(const void *parameters, Vec3 wo, const BsdfSample *way,
                            BsdfPolarisation *out)
{
    const ThinWindow *window = parameters;
    Waves face = waves_reflected(clampf(fabsf(wo.z), 0, 1), window->ior);
    *out = polarised_by(way->passes ? waves_sheet_through(face) : waves_sheet_reflected(face));
    return true;
}

const BsdfModel thin_window_model = {.traits = BSDF_IS_SHEET, .sample = window_sample,
                                     .pass = window_pass,
                                     .mirror = window_mirror, .albedo = window_albedo,
                                     .polarise = window_polarise};
