/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/emission/emission_edges.h"

#include <math.h>

#include "base/mathd.h"
#include "base/mathf.h"

#define LEAST_SHARE 1e-3  /* of the largest: ratios count above it, or the floor's if less */
#define LEAST_LEAST 1e-5
#define LEAST_AZIMUTHS 4  /* that one can be left out of */

/* E of every channel at the rows, by the components. */
static float *light_of_rows(const EmissionModel *model, Arena *arena)
{
    const EmissionSamples *s = model->samples;
    size_t channels = (size_t)s->channels, n = (size_t)model->rank->components;
    float *out = ARENA_NEW(arena, float, (size_t)s->rows * channels);
    for (size_t i = 0; i < (size_t)s->rows; i++) {
        emission_rank_logs(model->rank, s->channels, model->rank->score + i * n,
                           emission_rank_fall(model->rank->cosine_power, s->direction[i]),
                           out + i * channels);
        for (size_t c = 0; c < channels; c++) out[i * channels + c] =
            exp_f(out[i * channels + c]);
    }
    return out;
}

/* Cells of the grid, NULL: it is none. */
static const float *start(const EmissionModel *model, Arena *arena, EmissionEdges *out)
{
    const EmissionSamples *s = model->samples;
    *out = (EmissionEdges){.share = fmin(LEAST_SHARE, fmax(LEAST_LEAST, s->floor_share))};
    direction_grid_build(s->master, false, arena, &out->grid);
    if (out->grid.is_scattered || !out->grid.has_pole || out->grid.thetas < 3) return NULL;
    const float *cells = direction_grid_cells(&out->grid, light_of_rows(model, arena),
                                              s->channels, arena);
    PanelAxes axes = {out->grid.thetas, out->grid.phis, out->grid.theta, out->grid.phi};
    panel_profiles_start(&axes, s->channels, cells, out->share, arena, &out->profiles);
    if (s->black >= 0) out->profiles.lit = s->black;
    out->are_there = panel_profiles_jump(&out->profiles, cells);
    return cells;
}

bool emission_edges_are_there(const EmissionModel *model, Arena scratch)
{
    EmissionEdges edges;
    start(model, &scratch, &edges);
    return edges.are_there;
}

/* Three channels of all cells: the brightest table. */
static const float *brightest(const EmissionEdges *e, const float *cells, Arena *arena)
{
    int    count = e->grid.thetas * e->grid.phis, channels = e->profiles.channels;
    float *out = ARENA_NEW(arena, float, 3 * count);
    for (int i = 0; i < 3 * count; i++)
        out[i] = cells[i / 3 * channels + e->profiles.bright - 1 + i % 3];
    return out;
}

/* A channel's relative noise where there is light. */
static double noise_of(const EmissionSamples *s, int channel)
{
    double least = INFINITY;
    for (int i = channel; i < s->rows * s->channels; i += s->channels)
        if (s->total[i] > 0) least = fmin(least, (double)(s->sigma[i] / s->total[i]));
    return least;
}

bool emission_edges_find(const EmissionModel *model, double rest, bool is_small, Arena *arena,
                         EmissionEdges *out)
{
    const float *cells = start(model, arena, out);
    if (!cells) return false;
    out->peak = emission_peaks_find(&out->profiles.grid, cells, out->profiles.channels,
                                    out->profiles.bright,
                                    noise_of(model->samples, out->profiles.bright));
    if (!is_small && !out->are_there) {
        PanelAxes axes = out->profiles.grid;
        cells = brightest(out, cells, arena);
        panel_profiles_start(&axes, 3, cells, out->share, arena, &out->profiles);
    }
    panel_profiles_make(&out->profiles, cells, rest, arena);
    if (out->grid.phis >= LEAST_AZIMUTHS)
        out->following = panel_profiles_follow(&out->profiles, *arena);
    out->cell = direction_grid_cells(&out->grid, model->rank->score, model->rank->components,
                                     arena);
    return true;
}

PanelGridCells emission_edges_cells(const EmissionEdges *e, const EmissionModel *model,
                                    int level)
{
    PanelGridHead head = {.level = (uint8_t)level,
                          .components = (uint32_t)model->rank->components,
                          .thetas = (uint16_t)e->grid.thetas, .phis = (uint16_t)e->grid.phis,
                          .rest = (float)e->profiles.rest, .least_share = (float)e->share,
                          .tolerance = (float)model->tolerance};
    return (PanelGridCells){head, e->profiles.grid, e->cell, e->profiles.follows};
}

void emission_edges_note(const EmissionEdges *e, FitNotes *notes)
{
    bool has_azimuths = e->grid.phis >= LEAST_AZIMUTHS;
    if (e->are_there)
        fit_note(notes, "the light ends sharply: between samples it is interpolated as it is, "
                 "not as its logarithm%s", !has_azimuths ? "" : e->following.intervals
                     ? ", and edges are followed from azimuth to azimuth" : "");
    if (has_azimuths)
        fit_note(notes, "between azimuths: each one left out, its neighbours miss %.2g %% of "
                 "its light (%.2g %% without following edges; in %d of %d intervals they are)",
                 100 * e->following.missed, 100 * e->following.missed_still,
                 e->following.intervals, e->grid.phis);
}
