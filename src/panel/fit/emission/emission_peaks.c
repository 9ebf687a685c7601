/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/emission/emission_peaks.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"

#define SEEN 0.25     /* of the largest value: as the gaps of scattered samples */
#define RESOLVED 2.5  /* what a left-out sample is missed by, over what the panel misses */
#define NOISES 2.0
#define AZIMUTHS 4    /* fewer cannot be left out of */

/* A cell, the two before it, the two behind it. */
typedef struct Five {
    double x[5], y[5]; /* y: ln */
} Five;

typedef struct PeakCells {
    const PanelAxes *grid;
    const float     *value;
    int              channels, channel;
} PeakCells;

static double value_at(const PeakCells *c, int ring, int azimuth)
{
    return (double)c->value[(ring * c->grid->phis + azimuth) * c->channels + c->channel];
}

/* Along the meridian: through the pole to the opposite azimuth, straight on at the end. */
static Five five_rings(const PeakCells *c, int ring, int azimuth)
{
    const PanelAxes *g = c->grid;
    int  last = g->thetas - 1, across = panel_profiles_opposite(g, azimuth);
    Five f;
    for (int i = 0; i < 5; i++) {
        int  at = ring + i - 2, inside = at > last ? last : at < 0 ? -at : at;
        f.x[i] = (at < 0 ? -1 : 1) * (double)g->theta[inside];
        if (at > last) f.x[i] += (double)(g->theta[last] - g->theta[last - 1]) * (at - last);
        f.y[i] = log_d(fmax(1e-9, value_at(c, inside, at < 0 ? across : azimuth)));
    }
    return f;
}

static Five five_azimuths(const PeakCells *c, int ring, int azimuth)
{
    int  n = c->grid->phis;
    Five f;
    for (int i = 0; i < 5; i++) {
        int at = azimuth + i - 2, turn = at < 0 ? -1 : at >= n ? 1 : 0;
        f.x[i] = (double)c->grid->phi[at - turn * n] + 2 * PI * turn;
        f.y[i] = log_d(fmax(1e-9, value_at(c, ring, at - turn * n)));
    }
    return f;
}

/* ln of prediction over value; 0: the cell lies between its neighbours. */
static double missed_by(const Five *f)
{
    double low = fmin(f->y[1], f->y[3]), high = fmax(f->y[1], f->y[3]);
    double x[4] = {f->x[0], f->x[1], f->x[3], f->x[4]};
    double y[4] = {f->y[0], f->y[1], f->y[3], f->y[4]};
    if (f->y[2] >= low && f->y[2] <= high) return 0;
    return panel_profiles_cubic(x, y, f->x[2]) - f->y[2];
}

/* The sample in the middle, as what its neighbours say of it. */
static EmissionPeak peak_of(const Five *f, double noise)
{
    double log = fabs(missed_by(f));
    return (EmissionPeak){.estimate = exp_d(fmax(0, log - NOISES * noise) / RESOLVED) - 1,
                          .missed = 1 - exp_d(-log),
                          .step = fmax(f->x[3] - f->x[2], f->x[2] - f->x[1])};
}

EmissionPeak emission_peaks_find(const PanelAxes *grid, const float *cells, int channels,
                                 int channel, double noise)
{
    PeakCells        c = {grid, cells, channels, channel};
    EmissionPeak worst = {0};
    double       most = 0;
    int          count = (grid->thetas - 1) * grid->phis; /* nothing is behind the last ring */
    for (int i = 0; i < count; i++)
        most = fmax(most, value_at(&c, i / grid->phis, i % grid->phis));
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
