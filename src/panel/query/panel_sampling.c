/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: how a panel's reflection is sampled. No allocation, no lock, no libm. */
#include "panel/query/panel_sampling.h"

#include "base/units.h"
#include "hemisphere/specular_frame.h"
#include "panel/query/panel_turn.h"

#define EDGE 4e-3f /* of a cell */

/* Position among rising nodes: *t in [0, 1] from node to node + 1. */
static int node_below(const float *node, int count, float x, float *t) {
    int i = 0;
    *t = 0;
    if (count < 2) return 0;
    while (i + 2 < count && node[i + 1] <= x) i++;
    *t = clampf((x - node[i]) / (node[i + 1] - node[i]), 0, 1);
    return i;
}

/* The same for the azimuth of wo: nodes stand evenly over the turn, the first at 0. */
static int azimuth_below(int azimuths, Vec3 wo, float *t) {
    bool is_normal = wo.x * wo.x + wo.y * wo.y < 1e-12f; /* panel_turned takes 180 degrees */
    float turn = is_normal ? 0.5f : atan2_f(wo.y, wo.x) * (0.5f / PI_F);
    float at = (turn < 0 ? turn + 1 : turn) * (float)azimuths;
    int i = (int)at;
    *t = clampf(at - (float)i, 0, 1);
    return i < azimuths ? i : 0;
}

/* The functions of the sampling tree that a leaving direction mixes. */
static SamplingMix mix_of(const PanelSampling *s, Vec3 wo, float theta) {
    float t;
    int i = node_below(s->theta, s->incidences, theta, &t);
    int next = i + (s->incidences > 1);
    SamplingMix mix = {2, {i, next}, {1 - t, t}};
    if (s->azimuths == 1) return mix;
    float turn;
    int a = azimuth_below(s->azimuths, wo, &turn), b = a + 1 < s->azimuths ? a + 1 : 0;
    int here = a * s->incidences, there = b * s->incidences;
    return (SamplingMix){4,
                         {here + i, here + next, there + i, there + next},
                         {(1 - t) * (1 - turn), t * (1 - turn), (1 - t) * turn, t * turn}};
}

float panel_pdf(const Panel *panel, Vec3 wo, Vec3 wi) {
    if (!panel->sampling.incidences || !(wo.z > 0) || !(wi.z > 0)) return 0;
    float theta = panel_polar_angle(wo), jacobian;
    SpecularFrame frame = specular_frame(theta, PANEL_SAMPLING_EXPONENT);
    SamplingMix mix = mix_of(&panel->sampling, wo, theta);
    Vec3 stored = specular_frame_stored_jacobian(&frame, panel_turned(wo, wi), &jacobian);
    float pdf = sampling_tree_pdf(&panel->sampling.tree, &mix, stored);
    return jacobian > 0 ? pdf / jacobian : 0;
}

bool panel_sample(const Panel *panel, Vec3 wo, const float u[3], Vec3 *wi, float *pdf) {
    if (!panel->sampling.incidences || !(wo.z > 0)) return false;
    float theta = panel_polar_angle(wo), jacobian;
    SpecularFrame frame = specular_frame(theta, PANEL_SAMPLING_EXPONENT);
    SamplingMix mix = mix_of(&panel->sampling, wo, theta);
    SamplingResult drawn = sampling_tree_sample(&panel->sampling.tree, &mix, u);
    Vec3 local = specular_frame_outer_jacobian(&frame, drawn.direction, &jacobian);
    if (!(local.z > 0) || !(jacobian > 0)) return false;
    *wi = panel_turned_back(wo, local);
    *pdf = drawn.pdf / jacobian;
    /* so near an edge that the way back may end in the next cell: as panel_pdf sees it */
    if (drawn.margin < EDGE) *pdf = panel_pdf(panel, wo, *wi);
    return *pdf > 0;
}
