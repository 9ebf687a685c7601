/* SPDX-License-Identifier: Apache-2.0 */
/* guide.h -- from where light comes, trained for parts of the space: a field of directions that
 * guides paths.
 *
 * The scene's box is cut into cells by a tree of halves. A cell knows the radiance that arrives
 * from each of 256 bins of direction, for the sky that is seen there and for all other light
 * separately. Bins are squares of the octahedral map of the whole sphere, on which a direction
 * d has the coordinates d / (|x| + |y| + |z|), the lower half turned up into the corners
 * (Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors").
 * A piece dA of the map is the solid angle (|x| + |y| + |z|)^3 dA.
 * Besides, a cell knows how often a surface in it should sample each set of lights, and which
 * lamps light it.
 * A surface's own density is the product of that with what it scatters, bin by bin.
 *
 * Units    metres and world directions; densities in sr^-1.
 * Threads  const once built (guide_training.h).
 */
#pragma once
#include <stdint.h>

#include "base/vec.h"
#include "spectrum/spectrum.h"

#define GUIDE_SIDE SPECTRUM_LANES
#define GUIDE_BINS (GUIDE_SIDE * GUIDE_SIDE)

#define GUIDE_LIGHTS 5 /* sets of lights, and sunlit surfaces, that a surface may sample */

/* Light that a surface looks for: by other surfaces, or from the sky, also through windows. */
typedef enum GuideAim { GUIDE_LIGHT, GUIDE_SKY, GUIDE_AIMS } GuideAim;

/* Whole numbers: a view reads all bins, and floats would be twice as many bytes to fetch. */
typedef uint16_t GuideRow __attribute__((vector_size(2 * GUIDE_SIDE), aligned(32)));

/* Lamps that light a cell, and how much of their light arrives in it. */
#define GUIDE_LAMPS 8
typedef struct GuideLamps {
    int32_t count; /* 0: the cell knows of none */
    int32_t id[GUIDE_LAMPS];
    float arrives[GUIDE_LAMPS]; /* share, in (0, 1]; 0 of those not used */
    float others;               /* share of the samples that go to all other lamps */
} GuideLamps;

typedef struct GuideCell {
    GuideRow light[GUIDE_AIMS][GUIDE_SIDE]; /* through each bin, in any unit: lane x of row y */
    float asked[GUIDE_LIGHTS];              /* with which probability a surface samples each set */
    GuideLamps lamps;
    float is_lit; /* 1: it was trained; else 0 */
} GuideCell;

/* An inner node parts its box at `plane` along `axis`; its children stand at child and
 * behind it. */
typedef struct GuideNode {
    float plane;
    int axis;
    uint32_t child; /* 0: a leaf, whose cell this is: */
    uint32_t cell;
} GuideNode;

#define GUIDE_CELLS_MAX 4096u

typedef struct LightGuide {
    GuideNode *nodes; /* the first is the root */
    GuideCell *cells;
    uint32_t node_count, cell_count;
    bool asks;                   /* the cells know how often to sample the lights */
    Spectrum bin[3][GUIDE_SIDE]; /* x, y, z of every bin's middle, a unit vector */
} LightGuide;

/* Directions to choose from. */
typedef struct GuideChoice {
    Spectrum weight[GUIDE_SIDE]; /* of every bin */
    Spectrum column;             /* their sums */
    float sum;                   /* 0: there are none */
} GuideChoice;

/* The guide as one surface sees it. */
typedef struct GuideView {
    GuideChoice towards[GUIDE_AIMS];
} GuideView;

/* Id of the cell in which a point lies; points outside belong to a cell at the edge. */
uint32_t guide_cell_at(const LightGuide *guide, Vec3 position);

/* A simplified surface and the eye's direction: its light from every direction to wo. */
typedef struct GuideSurface {
    Vec3 ns, wo;          /* unit, world, on the same side */
    float diffuse;        /* Lambert's albedo */
    float f0, f90, alpha; /* of GGX facets */
} GuideSurface;

void guide_view(const LightGuide *guide, uint32_t cell, const GuideSurface *surface,
                GuideView *view);

/* The density with which guide_sample chooses a unit direction. */
float guide_pdf(const GuideChoice *choice, Vec3 wi);

/* u0, u1 in [0, 1). The choice's sum must be above 0. */
Vec3 guide_sample(const GuideChoice *choice, float u0, float u1);

/* Sets the middles of all bins. */
void guide_place_bins(LightGuide *guide);

/* A direction in a bin, for u0, u1 in [0, 1): its place in the square. */
Vec3 guide_bin_direction(int bin, float u0, float u1);
