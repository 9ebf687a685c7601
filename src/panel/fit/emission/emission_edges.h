/* SPDX-License-Identifier: Apache-2.0 */
/* emission_edges.h -- an emission with sharp edges, read between its samples.
 *
 * Logarithms of a beam that ends between two samples fall by ten and more: a smooth surface
 * through them rings, and between samples it shines many times too bright. Where tables have
 * such jumps the light itself is interpolated instead, azimuth by azimuth a profile over theta.
 * Between azimuths profiles are mixed either at the same theta, or at places that belong
 * together (below), whichever predicts measured azimuths better from those beside them.
 *
 * An edge that turns with the azimuth stands at another theta in each profile. With
 * V(theta) = integral of |dL / dtheta| from the pole, over its whole, places of equal V belong
 * together: both the thetas and the light there are interpolated, so that the edge moves
 * instead of becoming stairs. In one dimension this is what transport of |dL / dtheta| does
 * (displacement interpolation: R. J. McCann, A convexity principle for interacting gases,
 * Advances in Mathematics 128 (1997)).
 *
 * Units    radians, cd m^-2. Memory: the arena's. Threads: const once found. Fails: never.
 */
#pragma once
#include "panel/fit/common/direction_grid.h"
#include "panel/fit/common/fit_options.h"
#include "panel/fit/emission/emission_model.h"

typedef struct EmissionEdges {
    const EmissionModel *model;
    DirectionGrid grid;
    int           channels, bright; /* bright: the channel of Y whose edges count */
    double        rest;      /* radians: so near a sample its value stands */
    int           nodes;     /* of a profile */
    double       *theta;     /* nodes */
    float        *light;     /* azimuths x nodes x channels: E, cd m^-2 */
    double       *variation; /* azimuths x nodes: V, and a little of theta; rising, 0 to 1 */
    bool         *follows;   /* azimuths: between this and the next edges move */
    double       *least;     /* channels: errors count relative to no less, cd m^-2 */
    double        seen;      /* what shines less bounds no edge, cd m^-2 */
    double       *normal;    /* components^2: factor of the loadings' normal equations */
    int           following;
    double        missed, missed_still; /* shares of an azimuth's light that its neighbours
                                           miss: as chosen; all at the same theta */
} EmissionEdges;

/* Do neighbouring samples of the brightest table jump? False also where they are no grid with
 * a pole. */
bool emission_edges_are_there(const EmissionModel *model, Arena scratch);

/* False: neighbouring samples nowhere jump, or are no grid with a pole. */
bool emission_edges_find(const EmissionModel *model, double rest, Arena *arena,
                         EmissionEdges *out);

/* The components at a direction, smooth part and all (PANEL_COMPONENTS_MAX floats). Beyond
 * the last ring they stay what they are there. */
void emission_edges_components(const EmissionEdges *edges, Vec3 direction, float *components);

void emission_edges_note(const EmissionEdges *edges, FitNotes *notes);
