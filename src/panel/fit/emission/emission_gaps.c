/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/emission/emission_gaps.h"

#include <math.h>

#include "base/mathd.h"
#include "hemisphere/tree/tree_open.h"

typedef struct LightRead {
    const EmissionModel  *model;
    const ScatterSurface *surface;
    Tree                  tree;
    int                   channel;
    float                *total; /* of all channels */
} LightRead;

static double log_of(const LightRead *read, float value)
{
    return log_d(fmax((double)value, fmax(read->model->samples->floor[read->channel],
                                          1e-9)));
}

static double read_gap(void *context, Vec3 at, double *off)
{
    const LightRead *read = context;
    float components[PANEL_COMPONENTS_MAX], log;
    emission_coder_components(read->model, &read->tree, at, components);
    emission_model_totals(read->model, components, at, read->total);
    scatter_surface_read(read->surface, at, &log);
    double panel = log_of(read, read->total[read->channel]);
    *off = (double)log - panel;
    return panel;
}

static int brightest(const EmissionSamples *s)
{
    double most = -1;
    int    out = 0;
    for (int c = 0; c < s->channels; c++) {
        double sum = 0;
        for (int i = 0; i < s->rows; i++) sum += (double)s->total[i * s->channels + c];
        if (sum > most) most = sum, out = c;
    }
    return out;
}

bool emission_gaps_find(const EmissionModel *model, const EmissionTree *tree, Arena scratch,
                        ScatterGaps *out, Error *err)
{
    const EmissionSamples *s = model->samples;
    LightRead read = {.model = model, .channel = brightest(s),
                    .total = ARENA_NEW(&scratch, float, s->channels)};
    float *log = ARENA_NEW(&scratch, float, s->rows);
    for (int i = 0; i < s->rows; i++)
        log[i] = (float)log_of(&read, s->total[i * s->channels + read.channel]);
    read.surface = scatter_surface_make(s->master, false, log, 1, &scratch);
    if (!tree_open(tree->bytes, tree_size(tree->bytes), geodesic_create(tree->level, &scratch),
                   &read.tree, err))
        return false;
    ScatterAsked asked = {read.surface, read_gap, &read};
    *out = scatter_gaps_find(&asked, scratch);
    return true;
}
