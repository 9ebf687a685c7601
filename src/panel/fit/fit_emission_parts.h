/* fit_emission_parts.h -- the steps of fitting the emission. Private to fit_emission*.c.
 *
 * Samples (all tables at common directions) -> rank (few components a direction) -> smooth part
 * -> tree of the rest. A channel is one of X, Y, Z of one table, in PanelEmission's order.
 */
#pragma once
#include "panel/fit/fit_parts.h"

/* Every table's totals M at the rows of the table that has the most. */
typedef struct EmissionSamples {
    const Measurement *set;
    const AngleTable  *master;
    int     rows, channels;
    int     black;    /* the black pattern's first channel, -1: none */
    Vec3   *direction;
    double *area;     /* of a row, up to a factor */
    float  *total;    /* rows x channels, cd m^-2 */
    float  *sigma;    /* rows x channels: what a deviation is measured in; INFINITY: unknown */
    double  cone;     /* radians: the narrowest table's */
    double  step_deg; /* about how far apart neighbours are */
    int     azimuths; /* on a ring */
    double  tolerance; /* relative to M */
} EmissionSamples;

/* Table `index` of a set in the order of channels; NULL beyond the last. *primary: 3: black. */
const AngleTable *emission_table(const Measurement *set, bool has_black, int index,
                                 int *primary, int *level);

/* outlier[table]: rows that are not to be believed, or NULL. */
void emission_gather(const Measurement *set, bool has_black, uint8_t *const *outlier,
                     Arena *arena, FitNotes *notes, EmissionSamples *out);

/* ln E[channel] = mean[channel] + fall + sum_k loading[channel][k] score[row][k]; E is M less
 * the black pattern, fall = cosine_power ln cos theta. */
typedef struct EmissionRank {
    int    components;
    float  cosine_power;
    float *mean, *loading; /* channels; channels x components */
    float *score;          /* rows x components, variance about 1 */
    float *belief;         /* rows: weight of a row's scores, 0..1 */
    double worst;          /* |M - model| / M beyond the noise, at the worst sample */
} EmissionRank;

void emission_rank(const EmissionSamples *samples, Arena *arena, EmissionRank *out);

/* Scores anew; of rows within a chord of a direction for what they measure alone: those of a
 * narrow beam are far above the variance that the rank expects. */
void emission_free_scores(const EmissionSamples *samples, Vec3 centre, double chord,
                          Arena scratch, EmissionRank *rank);

/* ln E of all channels from components; fall included. */
void emission_logs(const EmissionRank *rank, int channels, const float *components, float fall,
                   float *logs);

/* cosine_power ln cos theta as queries have it. */
float emission_fall(float cosine_power, Vec3 direction);

/* A beam as stored, and as it will be read again. */
typedef struct EmissionBeam {
    const void *bytes;
    size_t      size;
    PanelBeam   view;
    double      half_width; /* radians: where the logarithm is down by half */
} EmissionBeam;

/* What the stages before the tree have fixed. Everything is as it will be read again. */
typedef struct EmissionModel {
    const EmissionSamples *samples;
    EmissionRank *rank;      /* means and loadings are rounded */
    const void   *spline_bytes;
    size_t        spline_size;
    PanelSpline   spline;
    int           beams;
    EmissionBeam  beam[PANEL_BEAMS_MAX];
    float        *step;      /* per component: what rounding may cost */
    float        *score_noise; /* per component, of a row's score */
    double        tolerance; /* relative to M */
    double        noise;     /* of the channels after the components pooled it, a median */
} EmissionModel;

/* The smooth part of what the beams leave of the scores, into the model. False: it cannot be
 * stored. */
bool emission_smooth(EmissionModel *model, Arena *arena);

/* A narrow beam on or near a row, into the model, if there is one. reach: degrees from its
 * centre to where it ends. Scores change: they need no longer be near a variance of 1. */
bool emission_find_beam(EmissionModel *model, int row, double reach, Arena *arena);
void emission_note_beams(const EmissionModel *model, FitNotes *notes);

/* Adds the beams to components (PANEL_COMPONENTS_MAX floats). */
void emission_add_beams(const EmissionModel *model, Vec3 direction, float *components);

/* Rounds means and loadings to what the section holds. */
void emission_round(EmissionModel *model);

/* The section's bytes. */
const void *emission_section(const EmissionModel *model, Arena *arena, size_t *size);

/* The tree of what the smooth part leaves, coded so that the tolerance holds at every sample
 * that it can hold at. */
bool emission_tree(EmissionModel *model, const FitOptions *options, Arena *arena,
                   FitNotes *notes, FitEmission *out, Error *err);
