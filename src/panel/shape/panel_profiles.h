/* SPDX-License-Identifier: Apache-2.0 */
/* panel_profiles.h -- an emission with sharp edges, read between the cells of its grid.
 * Private to src/panel.
 *
 * Logarithms of a beam that ends between two samples fall by ten and more: a smooth surface
 * through them rings, and between samples it shines many times too bright. Where tables have
 * such jumps the light itself is interpolated instead, azimuth by azimuth a profile over theta.
 * Between azimuths profiles are mixed either at the same theta, or at places that belong
 * together (below), whichever predicts measured azimuths better from those beside them.
 *
 * Colour   all channels of a direction go one way, which the brightest Y decides: over a jump
 *          each is a mean of both ends by the same weights; else its ratio to that Y goes by a
 *          cubic that stays between those of both ends. Where edges are followed (below) that
 *          Y and the black pattern's move, and all ratios to them are those of the same theta.
 *          So no colour appears between samples that none of those around has.
 *
 * An edge that turns with the azimuth stands at another theta in each profile. With
 * V(theta) = integral of |dL / dtheta| from the pole, over its whole, places of equal V belong
 * together: both the thetas and the light there are interpolated, so that the edge moves
 * instead of becoming stairs. In one dimension this is what transport of |dL / dtheta| does
 * (displacement interpolation: R. J. McCann, A convexity principle for interacting gases,
 * Advances in Mathematics 128 (1997)).
 *
 * Units    radians, cd m^-2. Memory: the arena's. Threads: const once made. Fails: never.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"

/* Rings from the pole (theta[0] = 0) and azimuths, rising. A cell is ring * phis + azimuth. */
typedef struct PanelAxes {
    int thetas, phis;         /* at least 3 rings */
    const float *theta, *phi; /* phi in [0, 2 pi) */
} PanelAxes;

/* The azimuth opposite to one, or the nearest to it. */
int panel_profiles_opposite(const PanelAxes *grid, int azimuth);

/* Hermite's cubic between the middle two of four rising places; slopes of parabolas. */
double panel_profiles_cubic(const double x[4], const double y[4], double at);

typedef struct PanelProfiles {
    PanelAxes grid;
    int channels, bright; /* bright: the channel of Y whose edges count */
    int lit;              /* channels of the primaries; three of a black pattern may follow */
    double rest;          /* radians: so near a sample its value stands */
    int nodes;            /* of a profile */
    double *theta;        /* nodes */
    float *light;         /* azimuths x nodes x channels: E, cd m^-2 */
    double *variation;    /* azimuths x nodes: V, and a little of theta; rising, 0 to 1 */
    bool *follows;        /* azimuths: between this and the next edges move */
    double *least;        /* channels: ratios count above this, cd m^-2 */
    double seen;          /* what shines less bounds no edge, cd m^-2 */
} PanelProfiles;

/* What counts as light. cells: thetas x phis x channels, above 0, three channels a table;
 * least_share: of a channel's largest value. No profiles yet, and no black pattern (lit). */
void panel_profiles_start(const PanelAxes *grid, int channels, const float *cells,
                          double least_share, Arena *arena, PanelProfiles *out);

/* Does the brightest table jump between neighbouring cells? */
bool panel_profiles_jump(const PanelProfiles *started, const float *cells);

/* The profiles of a started one; edges are followed nowhere yet. */
void panel_profiles_make(PanelProfiles *started, const float *cells, double rest, Arena *arena);

/* Leaves every azimuth out once (of four or more), and chooses where edges are followed.
 * Shares of an azimuth's light that its neighbours miss, the mean: as chosen; all at the same
 * theta. */
typedef struct PanelFollowing {
    int intervals;
    double missed, missed_still;
    double shared; /* by how many of the azimuths, as a share: 1, all miss as much */
} PanelFollowing;
PanelFollowing panel_profiles_follow(PanelProfiles *profiles, Arena scratch);

/* E of every channel at a direction, above 0. Beyond the last ring it stays what it is
 * there. */
void panel_profiles_light(const PanelProfiles *profiles, double theta, double phi, float *light);
