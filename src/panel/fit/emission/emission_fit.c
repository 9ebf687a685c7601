/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/emission/emission_fit.h"

#include <math.h>

#include "base/mathd.h"
#include "base/sort.h"
#include "panel/fit/common/table_noise.h"
#include "panel/fit/emission/emission_beam.h"
#include "panel/fit/emission/emission_section.h"
#include "panel/fit/emission/emission_smooth.h"

#define TOLERANCE 0.0025 /* relative, where the noise does not ask for more */
#define SIGMAS 4.0      /* of the noise that the components have left */

/* ---- what is known of the tables -------------------------------------------------------- */

/* A black pattern whose light is below every meter's reach is a true black. */
static bool black_shines(const Measurement *set)
{
    double sum = 0, noise = 0;
    if (!set->has_black) return false;
    for (int i = 0; i < set->black.rows; i++) {
        sum += (double)set->black.value[3 * i + 1];
        noise += fabs((double)set->black.value[3 * i + 1]);
    }
    return sum > 0.5 * noise && sum / set->black.rows > 1e-4;
}

static void survey_tables(const Measurement *set, const FitOptions *options, Arena *arena,
                          EmissionResult *out)
{
    const AngleTable *table;
    out->outliers.flag = ARENA_NEW(arena, EmissionFlag, EMISSION_FLAGS_MAX);
    out->holes.flag = ARENA_NEW(arena, EmissionFlag, EMISSION_FLAGS_MAX);
    out->is_masked = options->mask_outliers;
    for (int i = 0; (table = emission_samples_table(set, out->has_black, i).table); i++) {
        out->table_count = i + 1;
        out->noise[i] = table_noise_relative(table, 1, *arena);
        for (int j = 0; j < 3; j++) out->dim[i][j] = table_noise_dim(table, j, *arena);
        out->outlier[i] = ARENA_NEW(arena, uint8_t, table->rows);
        out->outlier_count += emission_outliers_find(table, out->outlier[i], &out->outliers,
                                                     *arena);
        out->hole_count += emission_outliers_find_holes(table, &out->holes, *arena);
    }
}

static void note_flags(const EmissionResult *e, FitNotes *notes)
{
    if (e->outlier_count)
        fit_note(notes, "%d emission samples stand out of their neighbours and are not "
                 "followed; the errors %s", e->outlier_count, e->is_masked ? "leave them out"
                 : "count them, unless --mask-outliers leaves them out");
    if (e->hole_count)
        fit_note(notes, "%d directions of the emission tables' grids are not measured; the "
                 "other tables and their neighbours fill them", e->hole_count);
}

/* ---- the model ------------------------------------------------------------------------- */

/* Noise of every component's score at a row, from differences of neighbours. */
static void find_score_noise(EmissionModel *model, Arena *arena)
{
    const EmissionSamples *s = model->samples;
    int        n = model->rank->components;
    AngleTable table = *s->master;
    table.channels = n;
    table.value = model->rank->score;
    model->score_noise = ARENA_NEW(arena, float, n);
    for (int k = 0; k < n; k++)
        model->score_noise[k] = (float)table_noise_plain(&table, k, *arena);
}

/* Noise of a channel due to the scores' noise; the median of all. */
static double channel_noise(const EmissionModel *model, Arena scratch)
{
    const EmissionRank *rank = model->rank;
    int     n = rank->components, channels = model->samples->channels;
    double *list = ARENA_NEW(&scratch, double, channels);
    for (int c = 0; c < channels; c++) {
        for (int k = 0; k < n; k++)
            list[c] +=
                pow_d((double)rank->loading[c * n + k] * (double)model->score_noise[k], 2);
        list[c] = sqrt(list[c]);
    }
    return sort_median(list, channels);
}

static double choose_tolerance(const EmissionModel *model, const FitOptions *options)
{
    if (options->bound > 0) return (double)options->bound;
    return fmax(TOLERANCE, SIGMAS * model->noise);
}

/* Rounding steps of the components: together they may cost a sixth of the tolerance. */
static void choose_steps(EmissionModel *model, Arena *arena)
{
    const EmissionRank *rank = model->rank;
    int n = rank->components;
    model->step = ARENA_NEW(arena, float, n);
    for (int k = 0; k < n; k++) {
        float most = 1e-6f;
        for (int c = 0; c < model->samples->channels; c++)
            most = fmaxf(most, fabsf(rank->loading[c * n + k]));
        model->step[k] = (float)(2 * model->tolerance / (6 * sqrt((double)n))) / most;
    }
}

/* A logarithm follows darkness without end: nothing goes below this share of the floor. A
 * smooth surface pays for depth, one with edges does not. */
#define HELD 0.01
#define HELD_EDGED 0.0015

static void gather(EmissionModel *model, const Measurement *set, const EmissionResult *out,
                   EmissionSamples *samples, Arena *arena)
{
    emission_samples_gather(set, out->has_black, out->outlier, arena, samples);
    emission_rank_find(samples, arena, model->rank);
}

static bool build_model(const Measurement *set, const FitOptions *options, Arena *arena,
                        FitNotes *notes, EmissionResult *out, EmissionModel *model)
{
    EmissionSamples *samples = ARENA_NEW(arena, EmissionSamples, 1);
    samples->tolerance = options->bound > 0 ? (double)options->bound : TOLERANCE;
    samples->floor_share = (double)options->error_floor;
    EmissionRank    *rank = ARENA_NEW(arena, EmissionRank, 1);
    samples->held_share = HELD;
    *model = (EmissionModel){.samples = samples, .rank = rank,
                             .dim = (const double (*)[3])out->dim,
                             .tolerance = samples->tolerance};
    gather(model, set, out, samples, arena);
    if (emission_edges_are_there(model, *arena)) {
        samples->held_share = HELD_EDGED;
        gather(model, set, out, samples, arena);
    }
    emission_samples_note(samples, *arena, notes);
    find_score_noise(model, arena);
    model->noise = channel_noise(model, *arena);
    model->tolerance = choose_tolerance(model, options);
    emission_section_round(model);
    choose_steps(model, arena);
    return emission_smooth_fit(model, arena);
}

bool emission_fit(const Measurement *set, const FitOptions *options, Arena *arena,
                  FitNotes *notes, EmissionResult *out, Error *err)
{
    EmissionModel model;
    out->has_black = black_shines(set);
    survey_tables(set, options, arena, out);
    note_flags(out, notes);
    if (set->has_black && !out->has_black)
        fit_note(notes, "the black pattern is below 0.0001 cd/m2 or noise: black is 0");
    if (!build_model(set, options, arena, notes, out, &model))
        return error_set(err, ERROR_INPUT, "emission: the smooth part cannot be stored");
    if (!emission_tree_build(&model, options, arena, &out->tree, err)) return false;
    emission_beam_note(&model, notes);
    if (out->tree.has_edges) emission_edges_note(&out->tree.edges, notes);
    if (out->tree.missed)
        fit_note(notes, "emission: %d of %d directions miss %.2g%% beyond 5 sigma of noise",
                 out->tree.missed, model.samples->rows, 100 * model.tolerance);
    out->section = emission_section_write(&model, arena, &out->section_size);
    out->components = model.rank->components;
    out->cone = model.samples->cone;
    out->tolerance = model.tolerance;
    out->floor_share = model.samples->floor_share;
    out->rank_worst = model.rank->worst;
    return true;
}
