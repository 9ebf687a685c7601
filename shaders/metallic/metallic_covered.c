/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/metallic/metallic_covered.h"

#include "base/units.h"
#include "shaders/metallic/metallic_base.h"
#include "shaders/metallic/metallic_coat.h"

/* Share that fibres send out of the light that the coat let in along w. */
static float open_fibres(const MetallicRoughness *m, float cosine)
{
    if (!has_sheen(m)) return 0;
    return sheen_most(m) * sheen_albedo(&common_sheen_table, cosine, m->sheen_alpha) *
           sheen_open(&common_sheen_table, cosine, m->sheen_alpha, m->clearcoat_alpha);
}

static Spectrum face_at(const MetallicView *view, float cosine)
{
    const MetallicRoughness *m = view->m;
    if (coated_face(m))
        return coating_at(m->coating->face->front, m->wavelengths, cosine) *
               spectrum_all(m->specular);
    return facet_reflectance(m, &view->boundary, cosine);
}

static Spectrum sent_by_face(const CoveredBase *covered, const LobeFacets *facets)
{
    Spectrum sum = spectrum_all(0);
    for (int i = 0; i < LOBE_FACETS; i++)
        sum += covered->face[i] * spectrum_all(facets->weight[i]);
    return sum;
}

CoveredRest covered_rest(const MetallicView *view, Vec3 w)
{
    const MetallicRoughness *m = view->m;
    const CoveredBase *covered = &view->covered;
    float    open = coat_open(m, w), kept = sheen_kept(m, w.z);
    float    above = 1 - open_fibres(m, w.z);
    Spectrum face;
    if (is_smooth(m->alpha)) {
        face = face_at(view, w.z) * spectrum_all(open * kept);
        return (CoveredRest){(spectrum_all(above) - face) * spectrum_all(open),
                          open * (above - kept)};
    }
    CoveredLobe lobe = covered_lobe(&covered->cover, w);
    face = sent_by_face(covered, &lobe.facets);
    return (CoveredRest){spectrum_max(spectrum_all(above) - face, spectrum_all(0)) *
                      spectrum_all(open),
                  open * (above - kept) + lobe.lost};
}

static void set_cover(const MetallicRoughness *m, Cover *cover)
{
    cover->normal = m->clearcoat_normal;
    cover->has_sheen = has_sheen(m);
    cover->alpha = is_smooth(m->alpha) ? (Vec2){SMOOTH_ALPHA, SMOOTH_ALPHA} : facet_alphas(m);
    for (int i = 0; i < ENERGY_COSINES; i++) {
        float root = (float)i / (ENERGY_COSINES - 1), cosine = fmaxf(root * root, 1e-5f);
        cover->open[i] =
            1 - coat_reflectance(m->clearcoat_energy, cosine, m->clearcoat_alpha);
        if (cover->has_sheen) cover->kept[i] = sheen_kept(m, cosine);
    }
}

/* Over the hemisphere, weighted by the cosine, by the trapezoid rule: what fibres take of the
 * light that the coat let in, and what they send out through it. */
static void mean_of_fibres(const MetallicRoughness *m, const Cover *cover, float *taken,
                           float *sent)
{
    *taken = *sent = 0;
    if (!has_sheen(m)) return;
    for (int i = 0; i < ENERGY_COSINES; i++) {
        float root = (float)i / (ENERGY_COSINES - 1), cosine = fmaxf(root * root, 1e-5f);
        float open = 4 * root * root * root * cover->open[i] / (ENERGY_COSINES - 1);
        if (i == ENERGY_COSINES - 1) open *= 0.5f;
        *taken += open * (1 - cover->kept[i]);
        *sent += open * open_fibres(m, cosine);
    }
}

void covered_set(MetallicView *view)
{
    const MetallicRoughness *m = view->m;
    CoveredBase *covered = &view->covered;
    float    taken, sent;
    set_cover(m, &covered->cover);
    mean_of_fibres(m, &covered->cover, &taken, &sent);
    for (int i = 0; i < LOBE_FACETS; i++)
        covered->face[i] =
            m->metallic < 1 ? face_at(view, facet_cosine[i]) : spectrum_all(0);
    CoveredLobe mean = covered_mean(&covered->cover);
    covered->mean.base = spectrum_max(spectrum_all(view->coat_mean.open - sent) -
                                          sent_by_face(covered, &mean.facets),
                                      spectrum_all(1e-3f));
    covered->mean.metal = taken - sent + (is_smooth(m->alpha) ? 0 : mean.lost);
    covered->rest = covered_rest(view, view->wo);
}

Spectrum covered_lambert(const MetallicView *view, Spectrum albedo,
                         const CoveredRest *in)
{
    const MetallicRoughness *m = view->m;
    float share = (1 - m->metallic) * (1 - m->transmission);
    return albedo * coat_turns(view->coat_mean.open, base_lambert_albedo(m)) *
           view->covered.rest.base * in->base * spectrum_all(share * INV_PI_F) /
           view->covered.mean.base;
}

float covered_rebound_lobe(const MetallicView *view, const CoveredRest *in)
{
    const CoveredBase *c = &view->covered;
    if (!(c->mean.metal > 1e-6f)) return 0;
    return c->rest.metal * in->metal / c->mean.metal * INV_PI_F;
}

Spectrum covered_rebound(const MetallicView *view, const CoveredRest *in)
{
    const MetallicRoughness *m = view->m;
    const CoveredBase *c = &view->covered;
    Spectrum sum = spectrum_all(0);
    if (m->metallic > 0 && c->mean.metal > 1e-6f)
        sum = base_metal_rebound(m) * coat_turns(view->coat_mean.open, energy_metal_mean(m)) *
              spectrum_all(c->rest.metal * in->metal / c->mean.metal * INV_PI_F);
    if (clear_share(m) > 0)
        sum += coat_sheet_rebound(view).back * spectrum_all(covered_rebound_lobe(view, in));
    return sum;
}
