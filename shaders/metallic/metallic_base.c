/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/metallic/metallic_base.h"

#include "base/units.h"

Spectrum base_lambert_across(const MetallicRoughness *m)
{
    return spectrum_from_rgb(m->wavelengths, m->across_color) * spectrum_all(m->across);
}

Spectrum base_lambert_albedo(const MetallicRoughness *m)
{
    return m->across > 0 ? lambert_back(m) + base_lambert_across(m) : m->base_color;
}

/* ---- what comes to the Lambert base ------------------------------------------------------ */

/* Share that comes to the Lambert base, sent neither by the sheen nor by facets. reflected:
 * what a coated or filmed face sends back in all, without the sheen. */
static Spectrum enters_below_sheen(const MetallicView *view, Spectrum reflected, Energy e,
                                   SheenShare share)
{
    const MetallicRoughness *m = view->m;
    float    most = sheen_most(m);
    Spectrum in = let_in(&view->boundary, sheen_lets_through(m, e, share));
    if (coated_face(m) || has_film(m))
        in = spectrum_all(1) - reflected * spectrum_all(1 - most * share.all);
    return spectrum_clamp(in - spectrum_all(most * share.albedo), 0, 1);
}

/* reflected: what a coated or filmed face sends back in all. */
static Spectrum enters_layers(const MetallicView *view, Spectrum reflected, Energy e,
                              const SheenShare *sheen)
{
    const MetallicRoughness *m = view->m;
    if (has_sheen(m)) return enters_below_sheen(view, reflected, e, *sheen);
    if (coated_face(m) || has_film(m)) return spectrum_all(1) - reflected;
    return let_in(&view->boundary, e);
}

Spectrum base_enters_layers(const MetallicView *view, Vec3 w, Energy e)
{
    const MetallicRoughness *m = view->m;
    SheenShare sheen;
    Spectrum   reflected = coated_face(m) ? energy_coated(m, w) :
                           has_film(m)    ? energy_filmed(view, w) :
                                            spectrum_all(0);
    if (has_sheen(m)) sheen = sheen_towards(m, w);
    return enters_layers(view, reflected, e, &sheen);
}

static Spectrum enters_layers_on_average(const MetallicView *view)
{
    const MetallicRoughness *m = view->m;
    Spectrum reflected = coated_face(m) ? energy_coated_average(m) * spectrum_all(m->specular) :
                         has_film(m)    ? energy_filmed_average(view, m->alpha) :
                                          spectrum_all(0);
    return enters_layers(view, reflected, base_average(m), &view->sheen_mean);
}

Spectrum base_lambert_towards(const MetallicView *view)
{
    const MetallicRoughness *m = view->m;
    Spectrum share = spectrum_all((1 - m->metallic) * (1 - m->transmission) * INV_PI_F);
    Spectrum in, mean;
    if (has_layers(m)) {
        in = enters_layers(view, view->coated, view->energy, &view->sheen);
        mean = enters_layers_on_average(view);
    } else {
        in = let_in(&view->boundary, view->energy);
        mean = let_in(&view->boundary, base_average(m));
    }
    return in * share / spectrum_max(mean, spectrum_all(1e-3f));
}

/* ---- what facets hide -------------------------------------------------------------------- */

/* Light that one facet hides from the eye meets others and comes out in the end, spread like
 * the missing albedo on both sides (Kulla and Conty 2017): sr^-1, for reflectance 1. */
static float bare_rebound_lobe(const MetallicView *view, Energy in)
{
    float missing = 1 - base_average(view->m).all;
    if (!(missing > 1e-6f)) return 0;
    return (1 - view->energy.all) * (1 - in.all) / missing * INV_PI_F;
}

/* Share of the light that gets past the sheen and that facets hide. */
static float hidden_below_sheen(const MetallicRoughness *m, Energy e, SheenShare share)
{
    return fmaxf(1 - sheen_most(m) * share.albedo - sheen_lets_through(m, e, share).all, 0);
}

static float rebound_below_sheen(const MetallicView *view, Vec3 wi, Energy in)
{
    const MetallicRoughness *m = view->m;
    float missing = hidden_below_sheen(m, base_average(m), view->sheen_mean);
    if (!(missing > 1e-6f)) return 0;
    return hidden_below_sheen(m, view->energy, view->sheen) *
           hidden_below_sheen(m, in, sheen_towards(m, wi)) / missing * INV_PI_F;
}

float base_rebound_lobe(const MetallicView *view, Vec3 wi, Energy in)
{
    return has_sheen(view->m) ? rebound_below_sheen(view, wi, in) :
                                bare_rebound_lobe(view, in);
}

Spectrum base_metal_rebound(const MetallicRoughness *m)
{
    float    mean = base_average(m).all;
    Spectrum one = spectrum_all(1), f = energy_metal_mean(m);
    return f * f * spectrum_all(mean * m->metallic) / (one - f * spectrum_all(1 - mean));
}

Spectrum base_pane_mean(const MetallicView *view)
{
    const MetallicFace *b = &view->boundary;
    if (coated_sheet(view->m)) /* of either side: they differ by what the coating absorbs */
        return curve_lookup(&view->m->coating->sheet->front_mean, view->m->wavelengths);
    if (has_film(view->m)) return sheet_reflectance(energy_filmed_average(view, 0));
    float shape = energy_average(view->m->energy, 0).shape;
    return sheet_reflectance(b->f0 + b->rise * spectrum_all(shape));
}

Spectrum base_pane_through(const MetallicView *view)
{
    const MetallicRoughness *m = view->m;
    if (coated_sheet(m)) return curve_lookup(&m->coating->sheet->through_mean, m->wavelengths);
    return spectrum_all(1) - base_pane_mean(view);
}

Spectrum base_rebound(const MetallicView *view, Vec3 wi, Energy in)
{
    const MetallicRoughness *m = view->m;
    Spectrum sum = spectrum_all(0);
    float    clear = clear_share(m);
    float    lobe = base_rebound_lobe(view, wi, in);
    if (!(lobe > 0)) return sum;
    if (m->metallic > 0) sum = base_metal_rebound(m);
    if (clear > 0) sum += base_pane_mean(view) * spectrum_all(clear);
    return sum * spectrum_all(lobe);
}
