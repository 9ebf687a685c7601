#include "shaders/bsdf.h"

Spectrum bsdf_eval(const Bsdf *bsdf, Vec3 wo, Vec3 wi, float *pdf)
{
    switch (bsdf->kind) {
    case BSDF_METALLIC_ROUGHNESS:
        return metallic_roughness_eval(&bsdf->metallic_roughness, wo, wi, pdf);
    case BSDF_DIELECTRIC: return dielectric_eval(&bsdf->dielectric, wo, wi, pdf);
    case BSDF_DISPLAY: return display_eval(&bsdf->display, wo, wi, pdf);
    case BSDF_THIN_WINDOW:
    case BSDF_BLACK: break;
    }
    *pdf = 0;
    return spectrum_all(0);
}

bool bsdf_sample(const Bsdf *bsdf, Vec3 wo, const float u[3], BsdfSample *sample)
{
    switch (bsdf->kind) {
    case BSDF_METALLIC_ROUGHNESS:
        return metallic_roughness_sample(&bsdf->metallic_roughness, wo, u, sample);
    case BSDF_THIN_WINDOW: return thin_window_sample(&bsdf->thin_window, wo, u, sample);
    case BSDF_DIELECTRIC: return dielectric_sample(&bsdf->dielectric, wo, u, sample);
    case BSDF_DISPLAY: return display_sample(&bsdf->display, wo, u, sample);
    case BSDF_BLACK: break;
    }
    return false;
}

Spectrum bsdf_pass(const Bsdf *bsdf, Vec3 wo)
{
    switch (bsdf->kind) {
    case BSDF_METALLIC_ROUGHNESS: return metallic_roughness_pass(&bsdf->metallic_roughness, wo);
    case BSDF_THIN_WINDOW: return thin_window_transmittance(&bsdf->thin_window, fabsf(wo.z));
    case BSDF_DIELECTRIC:
    case BSDF_DISPLAY:
    case BSDF_BLACK: break;
    }
    return spectrum_all(0);
}

bool bsdf_scatters(const Bsdf *bsdf)
{
    switch (bsdf->kind) {
    case BSDF_METALLIC_ROUGHNESS: return metallic_roughness_scatters(&bsdf->metallic_roughness);
    case BSDF_DIELECTRIC: return dielectric_scatters(&bsdf->dielectric);
    case BSDF_DISPLAY: return display_scatters(&bsdf->display);
    case BSDF_THIN_WINDOW:
    case BSDF_BLACK: break;
    }
    return false;
}

Spectrum bsdf_albedo(const Bsdf *bsdf, Vec3 wo)
{
    switch (bsdf->kind) {
    case BSDF_METALLIC_ROUGHNESS:
        return metallic_roughness_albedo(&bsdf->metallic_roughness, wo);
    case BSDF_THIN_WINDOW:
        return thin_window_reflectance(&bsdf->thin_window, fabsf(wo.z)) +
               thin_window_transmittance(&bsdf->thin_window, fabsf(wo.z));
    case BSDF_DIELECTRIC: return spectrum_all(1);
    case BSDF_DISPLAY: return display_albedo(&bsdf->display, wo);
    case BSDF_BLACK: break;
    }
    return spectrum_all(0);
}
