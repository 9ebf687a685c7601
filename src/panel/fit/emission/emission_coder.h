/* SPDX-License-Identifier: Apache-2.0 */
/* emission_coder.h -- vertex values by least squares, coded so that every channel of every
 * table keeps the tolerance at every sample.
 *
 * Memory   the arena's. Threads: coder->threads; the bytes do not depend on how many. Fails:
 *          with what the coder cannot store (ERROR_INPUT).
 */
#pragma once
#include "base/error.h"
#include "hemisphere/vertex/vertex.h"
#include "panel/fit/common/fit_options.h"
#include "panel/fit/emission/emission_edges.h"

#define EMISSION_LEVEL_MOST 9

/* An emission as it is kept. */
typedef struct EmissionTree {
    const void *bytes; /* as in the file */
    TreeReport report;
    int level;
    int missed; /* samples beyond tolerance and noise */
    bool has_grid;
    EmissionEdges edges; /* of a grid */
} EmissionTree;

/* Where a tree is coded and what it is held to. */
typedef struct EmissionCoder {
    EmissionModel *model;
    const Geodesic *geodesic;
    VertexLattice lattice;
    uint32_t vertices;
    Vec3 *direction; /* of vertices */
    float *smooth;   /* vertices x stride: the spline there */
    float *value;    /* vertices x components: the rest */
    float *wanted;   /* vertices x channels: M in cd m^-2 */
    float *limit;    /* vertices: relative; INFINITY: anything will do */
    float *least;    /* channels: errors count relative to no less than this */
    float *work;     /* channels */
    double pardon;   /* sigmas of noise that a sample may miss by besides */
    int threads;
} EmissionCoder;

/* Scores less the smooth part, rows x components. */
float *emission_coder_rest(const EmissionModel *model, Arena *arena);

/* About how wide a triangle of a level is, radians. */
double emission_coder_cell(int level);

/* M and limits of all vertices, from their values. */
void emission_coder_find_wanted(EmissionCoder *coder);

/* The level below which an error of a channel counts relative to it: about where it is noise
 * anyway, and the floor. */
void emission_coder_least(const EmissionModel *model, float *least);

/* A coder without values. */
EmissionCoder emission_coder_make(EmissionModel *model, int level, Arena *arena);

/* One with values that fit what is left of the rows. */
bool emission_coder_start(EmissionModel *model, int level, const float *rest, Arena *arena,
                          EmissionCoder *out, Error *err);

/* The largest relative error of a row's channels, beyond so many sigmas of noise. */
float emission_coder_excess(const EmissionCoder *coder, int row, const float *components,
                            float sigmas);

/* Over all rows: what no tightening corrects. *row: where. */
double emission_coder_uncoded(const EmissionCoder *coder, int *row);

/* Fits again with more weight on dark rows that the surface passes far above. */
bool emission_coder_settle(EmissionCoder *coder, const float *rest, Arena scratch, Error *err);

/* The coded tree's components at a row. */
void emission_coder_components(const EmissionModel *model, const Tree *tree, Vec3 d,
                               float *components);

/* The tree's bytes, by the options' basis. */
bool emission_coder_code(EmissionCoder *coder, const FitOptions *options, Arena *arena,
                         EmissionTree *out, Error *err);
