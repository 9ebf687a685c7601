/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/metallic/metallic_coat.h"

#include "base/units.h"
#include "shaders/metallic/metallic_base.h"

/* ---- its own lobe ------------------------------------------------------------------------ */

float coat_tilt(const MetallicRoughness *m, Vec3 wo, Vec3 wi)
{
    float out = vec3_dot(m->clearcoat_normal, wo), in = vec3_dot(m->clearcoat_normal, wi);
    if (!(out > 0 && in > 0 && wo.z > 0 && wi.z > 0)) return 0;
    return (out > wo.z ? 1 : out / wo.z) * (in > wi.z ? 1 : in / wi.z);
}

Frame coat_frame(const MetallicRoughness *m)
{
    return frame_from_z(m->clearcoat_normal);
}

float coat_eval(const MetallicRoughness *m, Vec3 wo, Vec3 wi, float *pdf)
{
    *pdf = 0;
    float tilt = coat_tilt(m, wo, wi);
    if (!(tilt > 0)) return 0;
    Frame frame = coat_frame(m);
    Vec3  out = frame_to_local(&frame, wo), in = frame_to_local(&frame, wi);
    Vec3  half = vec3_normalize(vec3_add(out, in));
    *pdf = ggx_reflection_pdf(out, half, m->clearcoat_alpha);
    return m->clearcoat * tilt * coat_facet(vec3_dot(out, half)) *
           ggx_reflection(out, in, half, m->clearcoat_alpha);
}

/* ---- the base through it ----------------------------------------------------------------- */

Spectrum coat_on_metal(const MetallicRoughness *m, const ThroughCoat *out,
                       const ThroughCoat *in)
{
    Spectrum r = energy_metal_mean(m), one = spectrum_all(1), product;
    float    stays[2], t[2] = {out->open, in->open}, u[2] = {out->share.boost, in->share.boost};
    for (int i = 0; i < 2; i++) {
        float p = u[i] > 0 ? t[i] / u[i] : 1;
        stays[i] = 1 - fminf(p * p, 1);
    }
    product = (one - r * spectrum_all(stays[0])) * (one - r * spectrum_all(stays[1]));
    for (int i = 0; i < SPECTRUM_LANES; i++)
        product[i] = t[0] * t[1] / sqrtf(fmaxf(product[i], 1e-12f));
    return product;
}

Spectrum coat_on_mirror(Spectrum r, float t)
{
    return spectrum_all(t * t) / (spectrum_all(1) - r * spectrum_all(1 - t));
}

CoatOnSheet coat_on_sheet(const MetallicRoughness *m, const ThroughCoat *out,
                          const ThroughCoat *in)
{
    float pass = out->open * in->open, boost = out->share.boost * in->share.boost;
    float least = fminf(out->open, in->open);
    if (is_covered(m) || is_smooth(m->alpha)) return (CoatOnSheet){least * least, 1 - least};
    return (CoatOnSheet){pass, boost > pass ? 1 - pass / boost : 0};
}

SheetLight coat_sheet(const MetallicView *view, float cosine,
                      const ThroughCoat *below)
{
    const MetallicRoughness *m = view->m;
    CoatOnSheet coat = coat_on_sheet(m, &view->through, below);
    SheetFaces  faces = facet_sheet(m, &view->boundary, cosine);
    SheetLight  light = sheet_turns(&faces, coat.held);
    Spectrum    share = spectrum_all(clear_share(m) * coat.pass);
    return (SheetLight){light.back * share, light.through * share};
}

SheetLight coat_sheet_rebound(const MetallicView *view)
{
    const MetallicRoughness *m = view->m;
    float      open = view->coat_mean.open;
    Spectrum   mean = base_pane_mean(view), share = spectrum_all(clear_share(m) * open);
    SheetFaces faces = {mean, mean, base_pane_through(view) * m->base_color};
    SheetLight light = sheet_turns(&faces, 1 - open);
    return (SheetLight){light.back * share, light.through * share};
}

/* Share that both boundaries let into the Lambert base. */
static inline Spectrum let_in_coated(const MetallicFace *b, Energy e, const ThroughCoat *t)
{
    return let_in(b, (Energy){e.all - t->share.all, e.shape - t->share.shape}) *
           spectrum_all(t->open);
}

Spectrum coat_diffuse(const MetallicView *view, Spectrum albedo, Energy in,
                      const ThroughCoat *below)
{
    const MetallicRoughness *m = view->m;
    const MetallicFace *b = &view->boundary;
    float    share = (1 - m->metallic) * (1 - m->transmission);
    if (!(share > 0)) return spectrum_all(0);
    Spectrum mean = spectrum_all(view->coat_mean.open) -
                    b->f0 * spectrum_all(view->coat_mean.all) -
                    b->rise * spectrum_all(view->coat_mean.shape);
    return albedo * coat_turns(view->coat_mean.open, base_lambert_albedo(m)) *
           let_in_coated(b, view->energy, &view->through) * let_in_coated(b, in, below) *
           spectrum_all(share * INV_PI_F) / spectrum_max(mean, spectrum_all(1e-3f));
}

float coat_rebound_lobe(const MetallicView *view, Energy in)
{
    float missing = view->coat_mean.open - view->coat_mean.lobe;
    if (!(missing > 1e-6f)) return 0;
    return (1 - view->energy.all) * (1 - in.all) / missing * INV_PI_F;
}

Spectrum coat_rebound(const MetallicView *view, Energy in, const ThroughCoat *below)
{
    const MetallicRoughness *m = view->m;
    float    both = view->through.open * below->open, clear = clear_share(m);
    float    missing = view->coat_mean.open - view->coat_mean.lobe;
    Spectrum sum = spectrum_all(0);
    if (m->metallic > 0 && missing > 1e-6f)
        sum = base_metal_rebound(m) * coat_turns(view->coat_mean.open, energy_metal_mean(m)) *
              spectrum_all((1 - view->energy.all) * (1 - in.all) / missing * INV_PI_F);
    if (clear > 0)
        sum += coat_sheet_rebound(view).back * spectrum_all(coat_rebound_lobe(view, in));
    return sum * spectrum_all(both);
}
