#include "path/lead.h"

#include "base/sampler.h"

#define GUIDE_SHARE 0.5f /* of the directions of a surface's wide lobes */

/* How often lights are asked where no guide knows it. */
static void ask_as_side(const PathContext *context, const Surface *surface, Vec3 wo, int bounce,
                        Lead *lead)
{
    bool is_back = vec3_dot(wo, surface->ng) < 0;
    lead->asked = light_selection_of_side(&context->selection, surface->part_id, is_back);
    lead->often = bounce < DEEP_BOUNCE ? 1 : DEEP_SHARE;
}

void lead_at(const PathContext *context, const Surface *surface, Vec3 wo, int bounce,
             Lead *lead)
{
    const LightGuide *guide = context->guide;
    lead->mix = 0;
    lead->is_wide = false;
    ask_as_side(context, surface, wo, bounce, lead);
    if (!guide || bounce >= context->max_bounces) return;
    BsdfLobes lobes = bsdf_lobes(&surface->bsdf, frame_to_local(&surface->frame, wo));
    if (!(lobes.prob > 0)) return;
    GuideSurface seen = {surface->frame.z, wo, lobes.diffuse, lobes.f0, lobes.f90, lobes.alpha};
    uint32_t     cell = guide_cell_at(guide, surface->position);
    lead->is_wide = true;
    if (guide->asks) {
        lead->asked = guide->cells[cell].asked;
        lead->often = 1;
    }
    guide_view(guide, cell, &seen, &lead->view);
    if (lead->view.sum > 0) lead->mix = GUIDE_SHARE * lobes.prob;
}

float lead_pdf(const Lead *lead, Vec3 wi, float bsdf_pdf)
{
    if (!(lead->mix > 0)) return bsdf_pdf;
    return lerpf(bsdf_pdf, guide_pdf(&lead->view, wi), lead->mix);
}

/* The surface's own choice. A mirror's is no density: it becomes rarer by the guide's share. */
static bool sample_surface(const Lead *lead, const Surface *surface, Vec3 local_wo,
                           const float u[3], BsdfSample *next)
{
    if (!bsdf_sample(&surface->bsdf, local_wo, u, next)) return false;
    if (!(lead->mix > 0)) return true;
    if (next->is_delta || next->passes) {
        next->weight /= spectrum_all(1 - lead->mix);
        return true;
    }
    float pdf = lead_pdf(lead, frame_to_world(&surface->frame, next->wi), next->pdf);
    next->weight *= spectrum_all(next->pdf / pdf);
    next->pdf = pdf;
    return true;
}

bool lead_sample(const Lead *lead, const Surface *surface, Vec3 local_wo, const float u[3],
                 BsdfSample *next)
{
    float v[3] = {u[0], u[1], u[2]};
    if (!unit_choose(&v[0], lead->mix)) return sample_surface(lead, surface, local_wo, v, next);
    Vec3  wi = guide_sample(&lead->view, v[0], v[1]);
    float bsdf_pdf;
    *next = (BsdfSample){.wi = frame_to_local(&surface->frame, wi)};
    if (!(next->wi.z > 0)) return false;
    Spectrum f = bsdf_eval(&surface->bsdf, local_wo, next->wi, &bsdf_pdf);
    next->pdf = lead_pdf(lead, wi, bsdf_pdf);
    next->weight = f * spectrum_all(next->wi.z / next->pdf);
    return next->pdf > 0;
}
