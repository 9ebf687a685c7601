/* SPDX-License-Identifier: Apache-2.0 */
#include "path/guiding.h"

#include "base/sampler.h"

#define GUIDE_SHARE 0.4f /* of the directions of a surface's wide lobes */
#define SKY_SHARE 0.9f   /* of the samples of a sky that is seen from the cell */

/* prob: that the surface samples its wide lobes. */
static void look(const LightGuide *guide, uint32_t cell, const GuideSurface *surface, float prob,
                 Guiding *guiding) {
    guide_view(guide, cell, surface, &guiding->view);
    if (guiding->view.towards[GUIDE_LIGHT].sum > 0) guiding->mix = GUIDE_SHARE * prob;
    if (guiding->view.towards[GUIDE_SKY].sum > 0) guiding->sky_mix = SKY_SHARE;
}

static void know_lamps(const GuideLamps *from, PunctualKnown *lamps) {
    lamps->count = from->count;
    lamps->others = from->others;
    for (int i = 0; i < from->count; i++) {
        lamps->id[i] = from->id[i];
        lamps->arrives[i] = from->arrives[i];
    }
}

void guiding_none(const PathContext *context, Guiding *guiding) {
    guiding->mix = guiding->sky_mix = 0;
    guiding->is_wide = false;
    guiding->lamps.count = 0;
    guiding->asked = context->selection.all;
    guiding->often = 1;
}

void guiding_at(const PathContext *context, const Surface *surface, Vec3 wo, int bounce,
                Guiding *guiding) {
    const LightGuide *guide = context->guide;
    bool is_back = vec3_dot(wo, surface->ng) < 0;
    guiding_none(context, guiding);
    guiding->asked = light_selection_of_side(&context->selection, surface->part_id, is_back);
    if (bounce >= DEEP_BOUNCE) guiding->often = DEEP_SHARE;
    if (!guide || bounce >= context->max_bounces) return;
    BsdfLobes lobes = bsdf_lobes(&surface->bsdf, surface->local_wo);
    guiding->often = 1; /* what guided paths meet is bright */
    if (!(lobes.prob > 0)) return;
    GuideSurface seen = {surface->frame.z, wo, lobes.diffuse, lobes.f0, lobes.f90, lobes.alpha};
    uint32_t cell = guide_cell_at(guide, surface->position);
    guiding->is_wide = true;
    if (guide->asks) guiding->asked = guide->cells[cell].asked;
    know_lamps(&guide->cells[cell].lamps, &guiding->lamps);
    look(guide, cell, &seen, lobes.prob, guiding);
}

void guiding_of_white(const PathContext *context, uint32_t cell, Vec3 ns, Guiding *guiding) {
    guiding_none(context, guiding);
    look(context->guide, cell, &(GuideSurface){ns, ns, 1, 0, 0, 0}, 1, guiding);
}

float guiding_sky_pdf(const Guiding *guiding, Vec3 wi, float own) {
    if (!(guiding->sky_mix > 0)) return own;
    return lerpf(own, guide_pdf(&guiding->view.towards[GUIDE_SKY], wi), guiding->sky_mix);
}

bool guiding_choose_light(const Guiding *guiding, const Lights *lights, LightSet set,
                          LitPoint point, const float u[3], LightSample *sample) {
    float v[3] = {u[0], u[1], u[2]};
    if (set == LIGHTS_PUNCTUAL && guiding->lamps.count)
        return lights_sample_known(lights, &guiding->lamps, point, u, sample);
    if (set != LIGHTS_SKY || !(guiding->sky_mix > 0))
        return lights_sample(lights, set, point, u, sample);
    if (!unit_choose(&v[0], guiding->sky_mix)) return lights_sample(lights, set, point, v, sample);
    *sample = (LightSample){.set = set, .distance = INFINITY};
    sample->wi = guide_sample(&guiding->view.towards[GUIDE_SKY], v[0], v[1]);
    return true;
}

/* The guide's choice has a pdf of 0 until now. */
void guiding_weigh_light(const Guiding *guiding, const Lights *lights, LitPoint point,
                         LightSample *sample) {
    if (sample->set != LIGHTS_SKY) return;
    if (!(sample->pdf > 0)) lights_sky_towards(lights, sample->wi, point.ns, sample);
    sample->pdf = guiding_sky_pdf(guiding, sample->wi, sample->pdf);
}

float guiding_pdf(const Guiding *guiding, Vec3 wi, float bsdf_pdf) {
    if (!(guiding->mix > 0)) return bsdf_pdf;
    return lerpf(bsdf_pdf, guide_pdf(&guiding->view.towards[GUIDE_LIGHT], wi), guiding->mix);
}

/* The surface's own choice. A mirror's is no density: it becomes rarer by the guide's share. */
static bool sample_surface(const Guiding *guiding, const Surface *surface, const float u[3],
                           BsdfSample *next) {
    if (!bsdf_sample(&surface->bsdf, surface->local_wo, u, next)) return false;
    if (!(guiding->mix > 0)) return true;
    if (next->is_delta || next->passes) {
        next->weight /= spectrum_all(1 - guiding->mix);
        return true;
    }
    float pdf = guiding_pdf(guiding, frame_to_world(&surface->frame, next->wi), next->pdf);
    next->weight *= spectrum_all(next->pdf / pdf);
    next->pdf = pdf;
    return true;
}

bool guiding_sample(const Guiding *guiding, const Surface *surface, const float u[3],
                    BsdfSample *next) {
    float v[3] = {u[0], u[1], u[2]};
    if (!unit_choose(&v[0], guiding->mix)) return sample_surface(guiding, surface, v, next);
    Vec3 wi = guide_sample(&guiding->view.towards[GUIDE_LIGHT], v[0], v[1]);
    float bsdf_pdf;
    *next = (BsdfSample){.wi = frame_to_local(&surface->frame, wi)};
    if (!(next->wi.z > 0)) return false;
    Spectrum f = bsdf_eval(&surface->bsdf, surface->local_wo, next->wi, &bsdf_pdf);
    next->pdf = guiding_pdf(guiding, wi, bsdf_pdf);
    next->weight = f * spectrum_all(next->wi.z / next->pdf);
    return next->pdf > 0;
}
