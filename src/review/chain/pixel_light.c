/* SPDX-License-Identifier: Apache-2.0 */
#include "review/chain/pixel_light.h"

#include "base/parallel.h"
#include "estimate/estimate.h"
#include "spectrum/spectral_table.h"

#define FIGURES (3 + PIXEL_BANDS)

_Static_assert(PIXEL_FIRST_NM == SPECTRAL_FIRST_NM &&
                   PIXEL_BANDS * PIXEL_BAND_NM == SPECTRAL_COUNT - 1,
               "the bands are those that paths carry");

/* Sums over a chunk's paths: XYZ, then the bands. */
typedef struct ChunkLight {
    double sum[FIGURES];
} ChunkLight;

typedef struct LightSearch {
    const ChainAsk *ask;
    ChunkLight     *chunks;
} LightSearch;

/* Weight of a lane's radiance in its band: wavelength_steps is the integral of the
 * density, in 2^-24, and the density constant within a nanometre (wavelengths.c). */
static double lane_weight(double nm, int *band)
{
    int cell = (int)nm - SPECTRAL_FIRST_NM;
    if (cell < 0) cell = 0;
    if (cell > SPECTRAL_COUNT - 2) cell = SPECTRAL_COUNT - 2;
    double density = ((double)wavelength_steps[cell + 1] - (double)wavelength_steps[cell]) *
                     0x1p-24;
    *band = cell / PIXEL_BAND_NM;
    return 1 / (SPECTRUM_LANES * density * PIXEL_BAND_NM);
}

static void on_light(void *user, const PathHistory *history, const float xyz[3])
{
    ChunkLight  *to = user;
    const float *nm = (const float *)&history->wavelengths->nm;
    for (int i = 0; i < 3; i++) to->sum[i] += (double)xyz[i];
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        int    band;
        double weight = lane_weight((double)nm[i], &band);
        to->sum[3 + band] += weight * (double)history->lanes[i];
    }
}

static void trace_chunk(void *user, int item, int worker)
{
    (void)worker;
    const LightSearch *search = user;
    PathListener   listener = {.on_light = on_light, .user = &search->chunks[item],
                               .with_lanes = true};
    PathStatistics statistics = {0};
    search->ask->tools->kernel->trace(search->ask->aim, item * CHAIN_CHUNK,
                                     (item + 1) * CHAIN_CHUNK, &listener, &statistics);
}

/* Batches as those of chains: an error of Y is that of their sum. */
static PixelFigure figure_of(const ChunkLight *chunks, int count, int k)
{
    EstimateSums sums = {.batches = count < CHAIN_BATCHES ? count : CHAIN_BATCHES,
                         .paths = (long)count * CHAIN_CHUNK, .piece = CHAIN_CHUNK, .share = 1};
    for (int i = 0; i < count; i++) sums.batch[i % sums.batches] += chunks[i].sum[k];
    Estimate estimate = estimate_of(&sums);
    return (PixelFigure){estimate.mean, estimate.sigma};
}

PixelLight pixel_light_find(const ChainAsk *ask)
{
    int         count = (int)((ask->paths + CHAIN_CHUNK - 1) / CHAIN_CHUNK);
    Arena       own = arena_reserve((size_t)1 << 30);
    LightSearch search = {ask, ARENA_NEW(&own, ChunkLight, count)};
    PixelLight  out;
    parallel_for(ask->tools->threads, count, trace_chunk, &search);
    for (int i = 0; i < 3; i++) out.xyz[i] = figure_of(search.chunks, count, i);
    for (int i = 0; i < PIXEL_BANDS; i++)
        out.radiance[i] = figure_of(search.chunks, count, 3 + i);
    arena_release(&own);
    return out;
}
