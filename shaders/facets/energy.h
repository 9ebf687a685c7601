/* SPDX-License-Identifier: Apache-2.0 */
/* energy.h -- how much light a rough reflecting boundary sends back in all, tabulated.
 *
 * For the GGX boundary of one index of refraction: the directional albedo with reflectance 1
 * (`all`), and with the exact Fresnel curve's shape s = (F - F0) / (1 - F0) (`shape`). A
 * boundary whose reflectance is F0 + (F90 - F0) s then returns F0 all + (F90 - F0) shape.
 *
 * Memory   about 31 KiB in the caller's arena. Building takes about a tenth of a second.
 * Threads  const once built.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"
#include "base/mathf.h"

#define ENERGY_COSINES 64   /* spaced evenly in sqrt(cosine), 0..1 */
#define ENERGY_OCTAVES 10   /* of alpha, from 2^-10 to 1 */
#define ENERGY_PER_OCTAVE 6 /* rows, spaced evenly within an octave */
#define ENERGY_ALPHAS (ENERGY_OCTAVES * ENERGY_PER_OCTAVE + 1)

/* Shares of the light; each in [0, 1]. */
typedef struct Energy {
    float all, shape;
} Energy;

/* Of a layer over facets (layers/overlay.h): what it sends, and what it takes of their energy;
 * each in [0, 1]. */
typedef struct OverlayShare {
    float albedo, all, shape;
} OverlayShare;

typedef struct EnergyTable {
    float ior;
    Energy average[ENERGY_ALPHAS]; /* over the hemisphere, weighted by the cosine */
    Energy directional[ENERGY_ALPHAS][ENERGY_COSINES];
} EnergyTable;

/* Of glTF's default index of refraction, CLEARCOAT_IOR, which nearly every material has and a
 * lacquer always. Made with the program (tables/make_tables.c), with the bits of a run. */
extern const EnergyTable common_energy_table;

/* ior: of the inside against the outside, 1 or more; 0 means a perfect reflector (glTF). */
const EnergyTable *energy_table_build(float ior, Arena *arena);

static inline Energy energy_mix(Energy a, Energy b, float t) {
    return (Energy){lerpf(a.all, b.all, t), lerpf(a.shape, b.shape, t)};
}

/* Between four neighbours: low[0] and low[1], and those `width` behind them, by s. */
static inline Energy energy_between(const Energy *low, int width, float s, float t) {
    const Energy *high = low + width;
    return energy_mix(energy_mix(low[0], low[1], t), energy_mix(high[0], high[1], t), s);
}

/* cosine in [0, 1]; alpha in [0, 1]. Below SMOOTH_ALPHA (microfacet.h) as if smooth. */
Energy energy_directional(const EnergyTable *table, float cosine, float alpha);
Energy energy_average(const EnergyTable *table, float alpha);

/* ---- for tables on the same nodes (coat.h) ----------------------------------------------- */

/* A place between two neighbours of an axis; energy_knot: of one of `count` nodes, place 0 to
 * count - 1. */
typedef struct EnergyKnot {
    int low;
    float t;
} EnergyKnot;

static inline EnergyKnot energy_knot(float place, int count) {
    int low = (int)place;
    if (low > count - 2) low = count - 2;
    return (EnergyKnot){low, clampf(place - (float)low, 0, 1)};
}

/* Of nodes that are spaced evenly in sqrt(cosine). */
static inline EnergyKnot energy_cosine_knot(float cosine, int count) {
    return energy_knot(safe_sqrtf(cosine) * (float)(count - 1), count);
}

/* The cosine of a node of ENERGY_COSINES; of node 0 nearly none. */
static inline float energy_cosine_of_node(int node) {
    float root = (float)node / (ENERGY_COSINES - 1);
    return node > 0 ? root * root : 1e-5f;
}

/* Row 0 is every smooth boundary; rows stand per_octave to an octave of alpha. */
EnergyKnot energy_alpha_knot(float alpha, int per_octave);

/* The alpha of a row; of row 0 none. */
static inline float energy_alpha_of_row(int row, int per_octave) {
    float octave = (float)(1 << row / per_octave) * 0x1p-10f;
    return row > 0 ? octave * (1 + (float)(row % per_octave) / (float)per_octave) : 0;
}

#define ENERGY_LOBE_POINTS 768

/* One of the points of an integral over the lobe of reflectance 1 about a direction. */
typedef struct EnergyLobe {
    float cosine; /* of where the light goes */
    float weight; /* share of the light, times ENERGY_LOBE_POINTS */
    float shape;  /* of the Fresnel curve there */
    float facet;  /* cosine to the facet that sends it there */
} EnergyLobe;

/* point: 0 to ENERGY_LOBE_POINTS - 1. False: its light is lost. */
bool energy_lobe_point(float ior, float cosine, float alpha, int point, EnergyLobe *out);
