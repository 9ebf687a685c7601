/* HOT: how a panel's reflection is sampled. No allocation, no lock, no libm. */
#include "hemisphere/specular_frame.h"
#include "panel/panel_slices.h"

float panel_pdf(const Panel *panel, Vec3 wo, Vec3 wi)
{
    const PanelReflection *r = panel->reflection;
    if (!r || !(wo.z > 0) || !(wi.z > 0)) return 0;
    float         theta = panel_polar_angle(wo), pdf = 0;
    SpecularFrame frame = specular_frame(theta, r->frame_exponent);
    float         jacobian;
    Vec3          stored = specular_frame_stored_jacobian(&frame, panel_turned(wo, wi),
                                                          &jacobian);
    SliceMix      mix = panel_linear_mix(r, theta);
    for (int s = 0; s < mix.count; s++)
        if (mix.weight[s] > 0)
            pdf += mix.weight[s] * sampling_tree_pdf(&panel->sampling[mix.first + s], stored);
    return jacobian > 0 ? pdf / jacobian : 0;
}

bool panel_sample(const Panel *panel, Vec3 wo, const float u[3], Vec3 *wi)
{
    const PanelReflection *r = panel->reflection;
    if (!r || !(wo.z > 0)) return false;
    float         theta = panel_polar_angle(wo);
    SpecularFrame frame = specular_frame(theta, r->frame_exponent);
    SliceMix      mix = panel_linear_mix(r, theta);
    int           slice = mix.first + (mix.count == 2 && u[2] >= mix.weight[0]);
    SamplingResult drawn = sampling_tree_sample(&panel->sampling[slice], u[0], u[1]);
    Vec3 local = specular_frame_outer(&frame, drawn.direction);
    if (!(local.z > 0)) return false;
    *wi = panel_turned_back(wo, local);
    return true;
}
