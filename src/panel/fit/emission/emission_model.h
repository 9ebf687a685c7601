/* SPDX-License-Identifier: Apache-2.0 */
/* emission_model.h -- what the steps before the tree have fixed of an emission: components,
 * smooth part and beams, everything as it will be read again from the file.
 *
 * Threads  pure functions of a constant model; one fits it. Fails: where it says so.
 */
#pragma once
#include "base/vec.h"
#include "panel/fit/emission/emission_rank.h"
#include "panel/shape/panel_beam.h"
#include "panel/shape/panel_spline.h"

/* A beam as stored, and as it will be read again. */
typedef struct EmissionBeam {
    const void *bytes;
    size_t size;
    PanelBeam view;
    double half_width; /* radians: where the logarithm is down by half */
} EmissionBeam;

typedef struct EmissionModel {
    const EmissionSamples *samples;
    EmissionRank *rank; /* means and loadings are rounded */
    const void *spline_bytes;
    size_t spline_size;
    PanelSpline spline;
    int beams;
    EmissionBeam beam[PANEL_BEAMS_MAX];
    float *step;            /* per component: what rounding may cost */
    float *score_noise;     /* per component, of a row's score */
    const double (*dim)[3]; /* noise without light of every table's X, Y, Z, cd m^-2 */
    double tolerance;       /* relative to M */
    bool is_scattered;      /* the samples have no rings */
    double noise;           /* of the channels after the components pooled it, a median */
} EmissionModel;

/* Adds spline and beams to components (PANEL_COMPONENTS_MAX floats). */
void emission_model_add_smooth(const EmissionModel *model, Vec3 direction, float *components);

/* A row's scores without the beams (PANEL_COMPONENTS_MAX floats). */
void emission_model_bare_scores(const EmissionModel *model, int row, float *out);

/* M of all channels from components. */
void emission_model_totals(const EmissionModel *model, const float *components, Vec3 direction,
                           float *m);

/* ---- the smooth part: cubic B-splines in theta times harmonics of the azimuth ------------ */

/* Fits the scores less the beams, into the model. False: it cannot be stored. */
bool emission_model_fit_smooth(EmissionModel *model, Arena *arena);

/* No smooth part. False: that cannot be stored. */
bool emission_model_clear_smooth(EmissionModel *model, Arena *arena);
