/* SPDX-License-Identifier: Apache-2.0 */
/* emission_model.h -- what the steps before the tree have fixed of an emission: components,
 * smooth part, everything as it will be read again from the file.
 *
 * Threads  pure functions of a constant model; one fits it. Fails: where it says so.
 */
#pragma once
#include "base/vec.h"
#include "panel/fit/emission/emission_rank.h"
#include "panel/shape/panel_spline.h"

typedef struct EmissionModel {
    const EmissionSamples *samples;
    EmissionRank *rank; /* means and loadings are rounded */
    const void *spline_bytes;
    size_t spline_size;
    PanelSpline spline;
    float *step;                /* per component: what rounding may cost */
    float *score_noise;         /* per component, of a row's score */
    const EmissionNoise *noise; /* of every table */
    double tolerance;           /* relative to M */
    bool is_scattered;          /* the samples have no rings */
    bool is_noisy;              /* between rows a surface is read that noise does not bend */
    bool has_edges;             /* the light jumps between samples: there is no smooth part */
} EmissionModel;

/* Adds the spline to components (PANEL_COMPONENTS_MAX floats). */
void emission_model_add_smooth(const EmissionModel *model, Vec3 direction, float *components);

/* M of all channels from components. */
void emission_model_totals(const EmissionModel *model, const float *components, Vec3 direction,
                           float *m);

/* ---- the smooth part: cubic B-splines in theta times harmonics of the azimuth ------------ */

/* Fits the scores, into the model; nothing where there are edges. False: it cannot be stored. */
bool emission_model_fit_smooth(EmissionModel *model, Arena *arena);
