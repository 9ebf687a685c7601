/* fit_reflect.h -- what the steps of a reflection's fit hand to each other. Private to
 * src/panel.
 *
 * Tables     one a measured incidence and azimuth of the light: azimuth * incidences + i.
 * Places     where the stored functions are read: vertices of the lattice, or the centres of
 *            the triangles (Haar), in the specular-following frame.
 * Values     ln (f / F(theta_i)), f without mirror and lobe; rows of `wavelengths` numbers.
 * Threads    the steps use options->threads; results do not depend on how many.
 */
#pragma once
#include "hemisphere/vertex_tree.h"
#include "panel/fit/direction_grid.h"
#include "panel/fit/fit_parts.h"

typedef struct ReflectionFit {
    const Measurement *set;
    const FitOptions  *options;
    FitReflection     *out;
    Arena             *arena;
    int    tables, wavelengths;
    bool   is_trial; /* only to compare frames: nothing is mended */
    bool   is_last;  /* no finer level follows: everything is tried */
    double bound;  /* relative error allowed at every sample, noise apart */
    float  k;      /* of the frame */
    VertexLattice lattice; /* level and octants, of the triangles when Haar */
    const Geodesic *geodesic;
    int    places;
    Vec3  *direction;
    DirectionGrid *grid;   /* per table */
    float        **cells;  /* per table: ln f of the grid's cells */
    double        *value_floor; /* per table: f is held above it */
    float *value;          /* places x tables x wavelengths */
    bool  *is_free;        /* places x tables: nobody measured there */
    float *tolerance;      /* places x tables, of the logarithm */
    float  mean_scale;
    float *mean;           /* tables x wavelengths, as a query will read it */
    int    coefficients, components;
    float *basis;          /* coefficients x wavelengths, as stored times basis_scale */
    float  basis_scale[PANEL_COEFFICIENTS_MAX];
    float  loading_scale[PANEL_REFLECTION_COMPONENTS_MAX];
    float *loading;        /* tables x coefficients x components */
    float *score;          /* places x components */
    int    padded;         /* wavelengths, rounded up to four */
    float *padded_mean;    /* tables x padded */
    float *matrix;         /* tables x components x padded: loadings times basis */
} ReflectionFit;

/* Which channel of the values a table begins at, at a place. */
static inline float *reflect_row(const ReflectionFit *fit, float *values, int place, int table)
{
    return values + ((size_t)place * (size_t)fit->tables + (size_t)table) *
                        (size_t)fit->wavelengths;
}

static inline double reflect_incidence(const ReflectionFit *fit, int table)
{
    return fit->set->incidence[table % fit->set->incidence_count];
}

/* The grids of all tables and the logarithms on their cells: once. */
void reflect_read_tables(ReflectionFit *fit);

/* Places of a level, and all tables' values there. */
void reflect_read_places(ReflectionFit *fit, int level);

/* ln f of a table at an outer direction; how far that lies beyond the last ring, radians. */
float reflect_read(const ReflectionFit *fit, int table, Vec3 outer, float *logs);

/* Relative noise of a table's value f. */
double reflect_noise(const FitReflection *out, int table, double f);

/* Means, spectral basis and loadings, all rounded to what the file holds. */
void reflect_choose_spectra(ReflectionFit *fit);

/* ln (f / F) of a table from the tree's components. */
void reflect_logs(const ReflectionFit *fit, int table, const float *component, float *logs);

/* Is that within the tolerance of `wanted` at every wavelength? */
bool reflect_is_near(const ReflectionFit *fit, int table, const float *component,
                     const float *wanted, float tolerance);

/* The tree; what samples and places miss by is mended as far as the level lets it be. */
typedef struct ReflectionMisses {
    int    samples, misses; /* samples beyond their bound */
    double worst;           /* largest error over its bound */
} ReflectionMisses;
bool reflect_code(ReflectionFit *fit, ReflectionMisses *misses, Error *err);

/* The section's bytes, with integrals as measured and energy held. */
bool reflect_finish(ReflectionFit *fit, FitNotes *notes, Error *err);
