/* SPDX-License-Identifier: Apache-2.0 */
/* emission_edges.h -- an emission's grid of measured directions: has it sharp edges? Then it is
 * read between its samples by panel_profiles.h, and kept as panel_grid.h's cells. So is a small
 * table whose smooth fit would need more numbers than were measured.
 *
 * Memory   the arena's. Threads: const once found. Fails: never.
 */
#pragma once
#include "panel/fit/common/direction_grid.h"
#include "panel/fit/common/fit_options.h"
#include "panel/fit/emission/emission_model.h"
#include "panel/query/panel_grid.h"
#include "panel/shape/panel_profiles.h"

typedef struct EmissionPeak {
    double estimate; /* what the panel may miss there, relative; 0: no sample stands out */
    double missed;   /* the sample, by its neighbours */
    double theta, phi;
    double step;     /* to the next sample, radians of theta or of azimuth */
    bool is_azimuth; /* the neighbours are those on the ring */
} EmissionPeak;

typedef struct EmissionEdges {
    DirectionGrid grid;
    const float *cell; /* thetas x phis x components */
    PanelProfiles profiles;
    bool are_there;           /* edges */
    double share;             /* of a channel's largest value: ratios count above it */
    PanelFollowing following; /* of four azimuths or more */
    EmissionPeak peak;        /* of the brightest table */
} EmissionEdges;

/* Do neighbouring samples of the brightest table jump? False also where they are no grid with
 * a pole. */
bool emission_edges_are_there(const EmissionModel *model, Arena scratch);

/* False: the samples are no grid with a pole. rest: radians, so near a sample its value
 * stands. Of tables that are neither small nor have edges the profiles are those of the
 * brightest one alone. */
bool emission_edges_find(const EmissionModel *model, double rest, bool is_small, Arena *arena,
                         EmissionEdges *out);

/* What is to be stored, for a tree of a level. */
PanelGridCells emission_edges_cells(const EmissionEdges *edges, const EmissionModel *model,
                                    int level);

void emission_edges_note(const EmissionEdges *edges, FitNotes *notes);
