/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/emission/emission_edges.h"

#include <math.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/units.h"
#include "panel/shape/panel_profiles.h"

/* ---- peaks ------------------------------------------------------------------------------ */

/* Does one sample of a grid alone show a peak or a hole? Then samples do
 * not resolve it: how high and how wide it is between them, nobody measured.
 *
 * A sample that is above both its neighbours on the meridian (on the ring), or below both, is
 * predicted without it: by a cubic through the logarithms of the two samples on either side. Of
 * Gaussian lobes on smooth light (tests/image/foreign_layouts.py: 400 grids, lobes of 0.5 to 20
 * degrees) panels miss between samples what ln of that prediction misses over 1 to 6; 2.5 found
 * all 12 that miss more than 15 %, and called 4 of 86 coarse that do not.
 *
 * Units    radians, cd m^-2. Memory: none of its own. Threads: pure functions. Fails: never. */

#define SEEN 0.25    /* of the largest value: as the gaps of scattered samples */
#define RESOLVED 2.5 /* what a left-out sample is missed by, over what the panel misses */
#define NOISES 2.0
#define AZIMUTHS 4 /* fewer cannot be left out of */

/* A cell, the two before it, the two behind it. */
typedef struct Five {
    double x[5], y[5]; /* y: ln */
} Five;

typedef struct PeakCells {
    const PanelAxes *grid;
    const float *value;
    int channels, channel;
} PeakCells;

static double value_at(const PeakCells *c, int ring, int azimuth) {
    return (double)c->value[(ring * c->grid->phis + azimuth) * c->channels + c->channel];
}

/* Along the meridian: through the pole to the opposite azimuth, straight on at the end. */
static Five five_rings(const PeakCells *c, int ring, int azimuth) {
    const PanelAxes *g = c->grid;
    int last = g->thetas - 1, across = panel_profiles_opposite(g, azimuth);
    Five f;
    for (int i = 0; i < 5; i++) {
        int at = ring + i - 2, inside = at > last ? last : at < 0 ? -at : at;
        f.x[i] = (at < 0 ? -1 : 1) * (double)g->theta[inside];
        if (at > last) f.x[i] += (double)(g->theta[last] - g->theta[last - 1]) * (at - last);
        f.y[i] = log_d(fmax(1e-9, value_at(c, inside, at < 0 ? across : azimuth)));
    }
    return f;
}

static Five five_azimuths(const PeakCells *c, int ring, int azimuth) {
    int n = c->grid->phis;
    Five f;
    for (int i = 0; i < 5; i++) {
        int at = azimuth + i - 2, turn = at < 0 ? -1 : at >= n ? 1 : 0;
        f.x[i] = (double)c->grid->phi[at - turn * n] + 2 * PI * turn;
        f.y[i] = log_d(fmax(1e-9, value_at(c, ring, at - turn * n)));
    }
    return f;
}

/* ln of prediction over value; 0: the cell lies between its neighbours. */
static double missed_by(const Five *f) {
    double low = fmin(f->y[1], f->y[3]), high = fmax(f->y[1], f->y[3]);
    double x[4] = {f->x[0], f->x[1], f->x[3], f->x[4]};
    double y[4] = {f->y[0], f->y[1], f->y[3], f->y[4]};
    if (f->y[2] >= low && f->y[2] <= high) return 0;
    return panel_profiles_cubic(x, y, f->x[2]) - f->y[2];
}

/* The sample in the middle, as what its neighbours say of it. */
static EmissionPeak peak_of(const Five *f, double noise) {
    double log = fabs(missed_by(f));
    return (EmissionPeak){.estimate = exp_d(fmax(0, log - NOISES * noise) / RESOLVED) - 1,
                          .missed = 1 - exp_d(-log),
                          .step = fmax(f->x[3] - f->x[2], f->x[2] - f->x[1])};
}

/* The peak that costs most, of a channel of thetas x phis x channels. noise: relative; what it
 * explains (twice) is none. Samples below a quarter of the largest are left out. */
static EmissionPeak emission_peaks_find(const PanelAxes *grid, const float *cells, int channels,
                                        int channel, double noise) {
    PeakCells c = {grid, cells, channels, channel};
    EmissionPeak worst = {0};
    double most = 0;
    int count = (grid->thetas - 1) * grid->phis; /* nothing is behind the last ring */
    for (int i = 0; i < count; i++) most = fmax(most, value_at(&c, i / grid->phis, i % grid->phis));
    for (int i = 0; i < count; i++) {
        int ring = i / grid->phis, azimuth = i % grid->phis;
        if (value_at(&c, ring, azimuth) < SEEN * most) continue;
        for (int on_ring = 0; on_ring < (ring && grid->phis >= AZIMUTHS ? 2 : 1); on_ring++) {
            Five f = on_ring ? five_azimuths(&c, ring, azimuth) : five_rings(&c, ring, azimuth);
            EmissionPeak one = peak_of(&f, noise);
            if (!(one.estimate > worst.estimate)) continue;
            worst = one;
            worst.theta = (double)grid->theta[ring], worst.phi = (double)grid->phi[azimuth];
            worst.is_azimuth = on_ring;
        }
    }
    return worst;
}

#define LEAST_SHARE 1e-3 /* of the largest: ratios count above it, or the floor's if less */
#define LEAST_LEAST 1e-5
#define LEAST_AZIMUTHS 4 /* that one can be left out of */

/* E of every channel at the rows, by the components. */
static float *light_of_rows(const EmissionModel *model, Arena *arena) {
    const EmissionSamples *s = model->samples;
    size_t channels = (size_t)s->channels, n = (size_t)model->rank->components;
    float *out = ARENA_NEW(arena, float, (size_t)s->rows *channels);
    for (size_t i = 0; i < (size_t)s->rows; i++) {
        emission_rank_logs(model->rank, s->channels, model->rank->score + i * n,
                           emission_rank_fall(model->rank->cosine_power, s->direction[i]),
                           out + i * channels);
        for (size_t c = 0; c < channels; c++) out[i * channels + c] = exp_f(out[i * channels + c]);
    }
    return out;
}

/* Cells of the grid, NULL: it is none. */
static const float *start(const EmissionModel *model, Arena *arena, EmissionEdges *out) {
    const EmissionSamples *s = model->samples;
    *out = (EmissionEdges){.share = fmin(LEAST_SHARE, fmax(LEAST_LEAST, s->floor_share))};
    direction_grid_build(s->master, false, arena, &out->grid);
    if (out->grid.is_scattered || !out->grid.has_pole || out->grid.thetas < 3) return NULL;
    const float *cells =
        direction_grid_cells(&out->grid, light_of_rows(model, arena), s->channels, arena);
    PanelAxes axes = {out->grid.thetas, out->grid.phis, out->grid.theta, out->grid.phi};
    panel_profiles_start(&axes, s->channels, cells, out->share, arena, &out->profiles);
    if (s->black >= 0) out->profiles.lit = s->black;
    out->are_there = panel_profiles_jump(&out->profiles, cells);
    return cells;
}

bool emission_edges_are_there(const EmissionModel *model, Arena scratch) {
    EmissionEdges edges;
    start(model, &scratch, &edges);
    return edges.are_there;
}

/* Three channels of all cells: the brightest table. */
static const float *brightest(const EmissionEdges *e, const float *cells, Arena *arena) {
    int count = e->grid.thetas * e->grid.phis, channels = e->profiles.channels;
    float *out = ARENA_NEW(arena, float, 3 * count);
    for (int i = 0; i < 3 * count; i++)
        out[i] = cells[i / 3 * channels + e->profiles.bright - 1 + i % 3];
    return out;
}

/* A channel's relative noise where there is light. */
static double noise_of(const EmissionSamples *s, int channel) {
    double least = INFINITY;
    for (int i = channel; i < s->rows * s->channels; i += s->channels)
        if (s->total[i] > 0) least = fmin(least, (double)(s->sigma[i] / s->total[i]));
    return least;
}

bool emission_edges_find(const EmissionModel *model, double rest, bool is_small, Arena *arena,
                         EmissionEdges *out) {
    const float *cells = start(model, arena, out);
    if (!cells) return false;
    out->peak =
        emission_peaks_find(&out->profiles.grid, cells, out->profiles.channels,
                            out->profiles.bright, noise_of(model->samples, out->profiles.bright));
    if (!is_small && !out->are_there) {
        PanelAxes axes = out->profiles.grid;
        cells = brightest(out, cells, arena);
        panel_profiles_start(&axes, 3, cells, out->share, arena, &out->profiles);
    }
    panel_profiles_make(&out->profiles, cells, rest, arena);
    if (out->grid.phis >= LEAST_AZIMUTHS)
        out->following = panel_profiles_follow(&out->profiles, *arena);
    out->cell =
        direction_grid_cells(&out->grid, model->rank->score, model->rank->components, arena);
    return true;
}

PanelGridCells emission_edges_cells(const EmissionEdges *e, const EmissionModel *model, int level) {
    PanelGridHead head = {.level = (uint8_t)level,
                          .components = (uint32_t)model->rank->components,
                          .thetas = (uint16_t)e->grid.thetas,
                          .phis = (uint16_t)e->grid.phis,
                          .rest = (float)e->profiles.rest,
                          .least_share = (float)e->share,
                          .tolerance = (float)model->tolerance};
    return (PanelGridCells){head, e->profiles.grid, e->cell, e->profiles.follows};
}

void emission_edges_note(const EmissionEdges *e, FitNotes *notes) {
    bool has_azimuths = e->grid.phis >= LEAST_AZIMUTHS;
    if (e->are_there)
        fit_note(notes,
                 "the light ends sharply: between samples it is interpolated as it is, "
                 "not as its logarithm%s",
                 !has_azimuths            ? ""
                 : e->following.intervals ? ", and edges are followed from azimuth to azimuth"
                                          : "");
    if (has_azimuths)
        fit_note(notes,
                 "between azimuths: each one left out, its neighbours miss %.2g %% of "
                 "its light (%.2g %% without following edges; in %d of %d intervals they are)",
                 100 * e->following.missed, 100 * e->following.missed_still, e->following.intervals,
                 e->grid.phis);
}
