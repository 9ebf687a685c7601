/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_model.h -- what the steps of a reflection's fit hand to each other.
 *
 * Places     where the stored functions are read: vertices of the lattice, or the centres of
 *            the triangles (Haar), in the specular-following frame (specular_frame.h).
 * Values     ln (f / F(theta_i)), f without mirror; rows of `wavelengths` numbers.
 * Threads    the steps use options->threads; results do not depend on how many.
 */
#pragma once
#include "base/mathd.h"
#include "base/vec.h"
#include "hemisphere/specular_frame.h"
#include "hemisphere/tree/vertex_tree.h"
#include "panel/fit/common/direction_grid.h"
#include "panel/fit/common/scatter_surface.h"
#include "panel/fit/reflection/reflection_parts.h"
#include "panel/query/panel_file.h"
#include "spectrum/wavelengths.h"

/* How a table goes on between its rows where they are too far apart for the peak: like the haze
 * that was fitted under the mirror's image. What is read between rows is then the logarithm
 * over the guide's, which is nearly even. A table whose rows are close enough has no guide. */
typedef struct ReflectionGuide {
    bool is_used;
    double incidence;
    double width, power, a, lambertian; /* a (1 + b2 / width^2)^-power + lambertian */
    double reach; /* radians: so far from the mirror direction it was fitted */
    double miss;  /* of reading without it: the largest difference between rows, relative */
} ReflectionGuide;

typedef struct ReflectionModel {
    const Measurement *set;
    const FitOptions *options;
    ReflectionParts *parts;
    Arena *arena;
    int tables, wavelengths;
    double bound;          /* relative error allowed at every sample, noise apart */
    float k;               /* of the frame */
    VertexLattice lattice; /* level and octants, of the triangles when Haar */
    const Geodesic *geodesic;
    int places;
    Vec3 *direction;
    DirectionGrid *grid;            /* per table */
    float **cells;                  /* per table: ln f of the grid's cells */
    ReflectionGuide *guide;         /* per table: how it goes on between its rows */
    const ScatterSurface **scatter; /* per table: of ln f, instead of its grid; NULL: none */
    PanelReachStored *reach;        /* per table: what its samples surround */
    bool has_reach;                 /* some do not surround their cone */
    double *least_value;            /* per table: f is held above it */
    int masked;                     /* values below it, which count nowhere */
    float *value;                   /* places x tables x wavelengths */
    bool *is_free;                  /* places x tables: nobody measured there */
    float *tolerance;               /* places x tables, of the logarithm */
    float mean_scale;
    float *mean; /* tables x wavelengths, as a query will read it */
    int coefficients, components;
    float *basis; /* coefficients x wavelengths, as stored times basis_scale */
    float basis_scale[PANEL_COEFFICIENTS_MAX];
    float loading_scale[PANEL_REFLECTION_COMPONENTS_MAX];
    float *loading;     /* tables x coefficients x components */
    float *score;       /* places x components */
    int padded;         /* wavelengths, rounded up to four */
    float *padded_mean; /* tables x padded */
    float *matrix;      /* tables x components x padded: loadings times basis */
    const void *tree;   /* as in the file */
    TreeReport tree_report;
} ReflectionModel;

/* Which channel of the values a table begins at, at a place. */
static inline float *reflection_model_row(const ReflectionModel *model, float *values, int place,
                                          int table) {
    return values +
           ((size_t)place * (size_t)model->tables + (size_t)table) * (size_t)model->wavelengths;
}

static inline double reflection_model_incidence(const ReflectionModel *model, int table) {
    return model->set->incidence[table % model->set->incidence_count];
}

/* F of a table's incidence. */
static inline double reflection_model_fresnel(const ReflectionModel *model, int table) {
    return reflection_fresnel(cos_d(reflection_model_incidence(model, table)));
}

/* Where a table's light comes from, in the display's frame. */
Vec3 reflection_model_light(const Measurement *set, int table);

/* 16 of the measured wavelengths from `first` on; the last one repeats. */
Wavelengths reflection_model_wavelengths(const Measurement *set, int first);

/* ---- one table in the coordinates and over the reference in which its logarithm is stored  */

/* Outer directions are the table's: the mirror direction at azimuth 0. */
typedef struct ReflectionView {
    SpecularFrame frame;
    double fresnel; /* F of its incidence */
} ReflectionView;

ReflectionView reflection_view(const ReflectionModel *model, int table);
