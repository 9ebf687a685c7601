/* SPDX-License-Identifier: Apache-2.0 */
#include "base/mathf.h"
#include "panel/fit/emission/emission_model.h"
#include "panel/query/panel_components.h"

#include <string.h>

static void add_beams(const EmissionModel *model, Vec3 direction, float *components)
{
    for (int b = 0; b < model->beams; b++)
        panel_components_add_beam(&model->beam[b].view, direction, components);
}

void emission_model_add_smooth(const EmissionModel *model, Vec3 d, float *components)
{
    panel_components_add_spline(&model->spline, d, log_f(clampf(d.z, PANEL_LEAST_COS, 1)),
                                components);
    add_beams(model, d, components);
}

void emission_model_bare_scores(const EmissionModel *model, int row, float *out)
{
    size_t n = (size_t)model->rank->components;
    memset(out, 0, sizeof *out * PANEL_COMPONENTS_MAX);
    add_beams(model, model->samples->direction[row], out);
    for (size_t k = 0; k < n; k++) out[k] = model->rank->score[(size_t)row * n + k] - out[k];
}

void emission_model_totals(const EmissionModel *model, const float *components, Vec3 direction,
                           float *m)
{
    const EmissionSamples *s = model->samples;
    emission_rank_logs(model->rank, s->channels, components,
                       emission_rank_fall(model->rank->cosine_power, direction), m);
    for (int c = 0; c < s->channels; c++) m[c] = exp_f(m[c]);
    for (int c = 0; c < s->black; c++) m[c] += m[s->black + c % 3];
}
