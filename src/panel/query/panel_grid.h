/* SPDX-License-Identifier: Apache-2.0 */
/* panel_grid.h -- an emission kept as its measured directions, and the tree that a panel makes
 * of it when it is opened. Private to src/panel.
 *
 * Where light ends sharply between few directions, a tree stores what the interpolation made
 * up: many times the numbers that were measured. Such an emission is stored as cells of rings
 * and azimuths instead; panel_profiles.h reads between them, and the result at a lattice's
 * vertices is the tree that queries read. Fit and queries make it by the same code.
 *
 * Stored   PanelGridHead | float theta[thetas], phi[phis], scale[components] | int16
 *          cell[components] of the pole, then of ring 1, 2, ... azimuth by azimuth: multiples
 *          of the scale; the components of panel_file.h, nothing smooth beside them | uint8
 *          follows[phis], 0 or 1 | zeros to a multiple of 8.
 * Memory   the arena's. Threads: pure functions. Fails: panel_grid_expand.
 */
#pragma once
#include "hemisphere/tree.h"
#include "panel/query/panel_opened.h"
#include "panel/shape/panel_profiles.h"

#define PANEL_GRID_MAGIC 0x44495247u /* "GRID" */
#define PANEL_GRID_VERSION 1u
#define PANEL_GRID_SIDE_MAX 4096 /* rings, azimuths */
#define PANEL_GRID_LEVEL_MAX 9

/* Begins as TreeHeader does. */
typedef struct PanelGridHead {
    uint32_t magic, version;
    uint64_t size; /* of the whole, bytes */
    uint8_t level; /* of the tree */
    uint8_t zero[3];
    uint32_t components;
    uint16_t thetas, phis;
    float rest;        /* radians: so near a sample its value stands */
    float least_share; /* of a channel's largest value: ratios count above it */
    float tolerance;   /* of logarithms at cells */
} PanelGridHead;

static inline bool panel_grid_is(const void *data, size_t size) {
    return size >= sizeof(PanelGridHead) &&
           ((const PanelGridHead *)data)->magic == PANEL_GRID_MAGIC;
}

/* What is to be stored. cell: thetas x phis x components. */
typedef struct PanelGridCells {
    PanelGridHead head; /* without magic, version, size */
    PanelAxes axes;
    const float *cell;
    const bool *follows; /* phis */
} PanelGridCells;

/* Of components, thetas and phis alone. */
size_t panel_grid_bytes(const PanelGridHead *head);

/* Its bytes, head.size of them, at a multiple of 8. */
const void *panel_grid_pack(const PanelGridCells *in, Arena *arena);

/* The tree. Of *emission the channels, components, means, loadings and the cosine's power
 * count. False: the bytes are not such a grid. */
bool panel_grid_expand(const void *data, size_t size, const PanelEmission *emission,
                       const Geodesic *geodesic, Arena *arena, Tree *out);
