/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/query/panel_open_sampling.h"

#include <string.h>

#include "base/units.h"
#include "hemisphere/sampling/sampling_tree_build.h"
#include "hemisphere/sampling/sampling_tree_open.h"
#include "panel/query/sampling_make.h"

static bool check_nodes(const PanelBytes *at, const PanelSampling *s)
{
    if (s->incidences < 1 || s->azimuths < 1 ||
        s->incidences * s->azimuths != s->tree.functions)
        return panel_refuse(at, "sampling", "counts do not fit the tree's functions");
    if ((s->azimuths > 1) != (s->tree.octants == 4))
        return panel_refuse(at, "sampling", "the tree's octants do not fit the azimuths");
    return true;
}

static bool check_thetas(const PanelBytes *at, const PanelSampling *s)
{
    for (int i = 0; i < s->incidences; i++)
        if (!(s->theta[i] >= 0 && s->theta[i] <= 0.5f * PI_F))
            return panel_refuse(at, "sampling", "an incidence is out of range");
    return panel_rising(s->theta, (uint32_t)s->incidences) ||
           panel_refuse(at, "sampling", "incidences do not rise");
}

/* Makes the section that the file omits. */
static bool make_section(const Panel *panel, Arena *arena, PanelBytes *at)
{
    SamplingSection made;
    if (!panel_makes_sampling(panel->reflection))
        return panel_refuse(at, "sampling", "is empty beside several tables");
    if (!sampling_make(panel, arena, &made, at->err)) return error_in_file(at->err, at->name);
    at->data = made.bytes;
    at->size = made.size;
    return true;
}

bool panel_open_sampling(const PanelBytes *bytes, const Geodesic *geodesic, Arena *arena,
                         Panel *panel)
{
    PanelBytes at;
    bool       found;
    uint16_t   counts[2];
    if (!panel_find_section(bytes, PANEL_SAMPLING, 0, &at, &found)) return false;
    if (!found) return true;
    if (at.size == 0 && !make_section(panel, arena, &at)) return false;
    PanelSampling s = {0};
    if (!sampling_tree_open(at.data, at.size, geodesic, arena, &s.tree, bytes->err))
        return error_prefix(bytes->err, "sampling") || error_in_file(bytes->err, bytes->name);
    size_t behind = panel_sampling_tree_bytes(sampling_tree_size(at.data));
    if (at.size < behind + sizeof counts) return panel_refuse(&at, "sampling", "is too short");
    memcpy(counts, at.data + behind, sizeof counts);
    s.incidences = counts[0];
    s.azimuths = counts[1];
    s.theta = (const float *)(const void *)(at.data + behind + sizeof counts);
    if (!check_nodes(&at, &s)) return false;
    if (at.size != behind + sizeof counts + (size_t)s.incidences * sizeof(float))
        return panel_refuse(&at, "sampling", "has another size than its counts say");
    if (!check_thetas(&at, &s)) return false;
    panel->sampling = s;
    return true;
}
