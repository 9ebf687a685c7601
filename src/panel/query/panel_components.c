/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: the components of an emission at a direction. No allocation, no lock, no libm. */
#include "panel/query/panel_components.h"

#include "hemisphere/tree/tree_query.h"

/* Position in the spline's table over tan(theta / 2): *t in [0, 1] from node to node + 1. */
static inline int spline_node(float tan_half, float *t)
{
    float at = clampf(tan_half, 0, 1) * (PANEL_SPLINE_ANGLES - 1);
    int   node = (int)at;
    if (node > PANEL_SPLINE_ANGLES - 2) node = PANEL_SPLINE_ANGLES - 2;
    *t = at - (float)node;
    return node;
}

void panel_components_add_spline(const PanelSpline *spline, Vec3 d, float log_cos, float *out)
{
    float t, s = safe_sqrtf(d.x * d.x + d.y * d.y);
    float cos_1 = s > 0 ? d.x / s : 1, sin_1 = s > 0 ? d.y / s : 0;
    float angle[PANEL_SPLINE_TERMS_MAX + 1] = {1, cos_1, sin_1};
    int   node = spline_node(s / (1 + d.z), &t), row = spline->terms * spline->stride;
    const float *near = spline->table + node * row, *power = spline->power;
    for (int m = 2; m <= spline->harmonics; m++) {
        float c = angle[2 * m - 3], e = angle[2 * m - 2];
        angle[2 * m - 1] = c * cos_1 - e * sin_1;
        angle[2 * m] = e * cos_1 + c * sin_1;
    }
    for (int i = 0; i < spline->terms; i++, near += spline->stride, power += spline->stride) {
        float factor = angle[spline->term[i]];
        float a = factor * (1 - t), b = factor * t, c = factor * log_cos;
        for (int k = 0; k < spline->stride; k += 4)
            *(PanelFloat4 *)(out + k) += *(const PanelFloat4 *)(near + k) * a +
                                         *(const PanelFloat4 *)(near + row + k) * b +
                                         *(const PanelFloat4 *)(power + k) * c;
    }
}

float panel_components_beam_place(const PanelBeam *beam, Vec3 direction)
{
    Vec3  v = vec3_sub(direction, beam->centre); /* a cosine near 1 would be too coarse */
    float along = vec3_dot(beam->narrow, v);
    float squares = vec3_dot(v, v) + along * along;
    return log_f(1 + squares * beam->core_squares) * (1 / PANEL_BEAM_STEP);
}

void panel_components_add_beam(const PanelBeam *beam, Vec3 direction, float *out)
{
    float at = panel_components_beam_place(beam, direction), weight[4];
    if (!(at >= 0 && at < (float)beam->knots)) return;
    int knot = (int)at, stride = beam->stride;
    if (knot > beam->knots - 1) knot = beam->knots - 1;
    const float *row = beam->coefficient + knot * stride;
    panel_beam_weights(at - (float)knot, weight);
    for (int k = 0; k < stride; k += 4)
        *(PanelFloat4 *)(out + k) +=
            *(const PanelFloat4 *)(row + k) * weight[0] +
            *(const PanelFloat4 *)(row + stride + k) * weight[1] +
            *(const PanelFloat4 *)(row + 2 * stride + k) * weight[2] +
            *(const PanelFloat4 *)(row + 3 * stride + k) * weight[3];
}

float panel_components(const Panel *panel, Vec3 direction, float *components)
{
    const PanelEmission *e = panel->emission;
    for (int k = e->components & ~3; k < e->stride; k++) components[k] = 0;
    tree_interpolate(&panel->emission_tree, direction, components);
    float log_cos = log_f(clampf(direction.z, PANEL_LEAST_COS, 1));
    panel_components_add_spline(&e->spline, direction, log_cos, components);
    for (int b = 0; b < e->beams; b++)
        panel_components_add_beam(&e->beam[b], direction, components);
    return e->cosine_power * log_cos;
}
