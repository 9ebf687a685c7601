/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_fit.h"

#include "base/parallel.h"
#include "base/units.h"
#include "hemisphere/tree/tree_open.h"
#include "panel/fit/reflection/reflection_read.h"
#include "panel/fit/reflection/reflection_spectra.h"
#include "panel/fit/reflection/reflection_surface.h"
#include "panel/fit/reflection/reflection_tree.h"

#define DEFAULT_BOUND 0.02
#define NOISY_BOUND 0.025
#define NOISY 0.0005       /* relative: tables below it count as without noise */
#define FIRST_LEVEL 6
#define LAST_LEVEL 9
#define HELPED 0.8         /* a level that leaves more misses than this share did not help */
#define NARROWEST 2.0f     /* the largest frame exponent that is tried */
#define PLACES_BYTES ((size_t)5 << 29) /* of values at most: memory is bounded */
#define TRIAL_BYTES ((size_t)32 << 30) /* address space; pages cost nothing until touched */

/* The user's bound; else 2 %, and 2.5 % where there is noise. */
static double choose_bound(const FitOptions *options, const ReflectionParts *parts)
{
    if (options->bound > 0) return (double)options->bound;
    return reflection_parts_most_noise(parts) > NOISY ? NOISY_BOUND : DEFAULT_BOUND;
}

static ReflectionModel *start_model(const Measurement *set, const FitOptions *options,
                                    ReflectionParts *parts, Arena *arena)
{
    ReflectionModel *model = ARENA_NEW(arena, ReflectionModel, 1);
    *model = (ReflectionModel){.set = set, .options = options, .parts = parts, .arena = arena,
                               .tables = parts->tables, .wavelengths = set->wavelength_count,
                               .bound = choose_bound(options, parts),
                               .k = options->frame_exponent};
    model->lattice.octants = set->azimuth_count > 1 ? 4 : 2;
    return model;
}

/* ---- the frame --------------------------------------------------------------------------- */

/* One frame exponent and how well it does at the first level. */
typedef struct FrameTrial {
    const ReflectionModel *model;
    float                  exponent;
    ReflectionMisses       misses;
    size_t                 bytes;
    bool                   has_failed;
    Error                  err;
} FrameTrial;

static void run_trial(void *context, int item, int worker)
{
    FrameTrial     *trial = (FrameTrial *)context + item;
    Arena           arena = arena_reserve(TRIAL_BYTES);
    ReflectionModel model = *trial->model;
    FitOptions      options = *model.options;
    (void)worker;
    options.threads = 1;
    model.options = &options, model.arena = &arena, model.k = trial->exponent;
    model.is_trial = true;
    reflection_read_places(&model, FIRST_LEVEL);
    reflection_spectra_choose(&model);
    trial->has_failed = !reflection_tree_build(&model, &trial->misses, &trial->err);
    if (!trial->has_failed) trial->bytes = tree_size(model.tree);
    arena_release(&arena);
}

/* The frame exponent that leaves the fewest samples outside the bound, and of those that are
 * about as good the one with the smallest tree: wide haze likes 1, narrow peaks 2. */
static bool choose_frame(ReflectionModel *model, Error *err)
{
    FrameTrial trials[3] = {{.model = model, .exponent = 1}, {.model = model, .exponent = 1.5f},
                            {.model = model, .exponent = NARROWEST}};
    int best = 0;
    if (model->k > 0) return true;
    parallel_for(model->options->threads, 3, run_trial, trials);
    for (int i = 0; i < 3; i++) {
        if (trials[i].has_failed) {
            *err = trials[i].err;
            return false;
        }
        int room = trials[i].misses.samples / 5000;
        int more = trials[i].misses.misses - trials[best].misses.misses;
        if (more < -room || (more <= room && trials[i].bytes < trials[best].bytes)) best = i;
    }
    model->k = trials[best].exponent;
    return true;
}

/* ---- the level --------------------------------------------------------------------------- */

static size_t value_bytes(const ReflectionModel *model, int level)
{
    size_t side = (size_t)1 << level;
    return 2 * side * side * (size_t)model->lattice.octants / 4 * sizeof(float) *
           (size_t)model->tables * (size_t)model->wavelengths;
}

/* Deeper while samples are missed and the last step helped; one that did not is taken back. */
static bool code_levels(ReflectionModel *model, ReflectionMisses *misses, Error *err)
{
    int first = model->options->level > 0 ? model->options->level : FIRST_LEVEL;
    int last = model->options->level > 0 ? first : LAST_LEVEL;
    for (int level = first;; level++) {
        ReflectionMisses now;
        ReflectionModel  before = *model;
        reflection_read_places(model, level);
        reflection_spectra_choose(model);
        model->is_last = level == last;
        if (!reflection_tree_build(model, &now, err)) return false;
        if (level > first && now.misses > (int)(HELPED * misses->misses)) {
            *model = before;
            return true;
        }
        *misses = now;
        if (!now.misses || level == last || value_bytes(model, level + 1) > PLACES_BYTES)
            return true;
    }
}

/* The cone that all tables reach. */
static float least_edge(const ReflectionModel *model)
{
    float edge = model->parts->haze[0].theta_max;
    for (int t = 1; t < model->tables; t++)
        edge = model->parts->haze[t].theta_max < edge ? model->parts->haze[t].theta_max : edge;
    return edge;
}

static void note_outcome(const ReflectionModel *model, const ReflectionMisses *misses,
                         FitNotes *notes)
{
    if (model->masked)
        fit_note(notes, "%d zeros or negative values of reflection were held above a floor "
                 "(1e-6 of their table's largest value); their errors do not count",
                 model->masked);
    if (model->has_reach)
        fit_note(notes, "reflection: at some incidences the samples do not surround all "
                 "directions up to %.4g degrees: outside of them the value on their edge is "
                 "held, and called extrapolated (extrapolated_share says how much)",
                 degrees_from_radians((double)least_edge(model)));
    if (misses->misses)
        fit_note(notes, "reflection: %d of %d samples lie beyond the bound of %.2g %%, the "
                 "worst by a factor of %.2g", misses->misses, misses->samples,
                 100 * model->bound, misses->worst);
}

/* A peak that is missed at the finest level gets the frame that spreads it most. */
static bool code_frames(ReflectionModel *model, ReflectionMisses *misses, Error *err)
{
    Arena            before = *model->arena;
    float            chosen = model->k;
    ReflectionMisses other;
    if (!code_levels(model, misses, err)) return false;
    if (!misses->misses || chosen >= NARROWEST || model->options->frame_exponent > 0 ||
        model->surface.stored.frame != PANEL_FRAME_SPECULAR)
        return true;
    model->k = NARROWEST;
    if (!code_levels(model, &other, err)) return false;
    if (other.misses < misses->misses) {
        *misses = other;
        return true;
    }
    *model->arena = before;
    model->k = chosen;
    return code_levels(model, misses, err);
}

/* ---- what was left out ------------------------------------------------------------------- */

typedef struct HeldOutPass {
    const ReflectionModel *model;
    HeldOut               *held_out;
} HeldOutPass;

static void hold_out(void *context, int t, int worker)
{
    HeldOutPass *pass = context;
    Arena        arena = arena_reserve(TRIAL_BYTES);
    (void)worker;
    pass->held_out[t] = reflection_held_out(pass->model, t, arena);
    arena_release(&arena);
}

static void look_between(void *context, int t, int worker)
{
    HeldOutPass *pass = context;
    Arena        arena = arena_reserve(TRIAL_BYTES);
    (void)worker;
    pass->held_out[t].between = reflection_held_out_between(pass->model, t, arena);
    arena_release(&arena);
}

bool reflection_fit(const Measurement *set, const FitOptions *options, Arena *arena,
                    FitNotes *notes, ReflectionResult *out, Error *err)
{
    reflection_parts_separate(set, options, arena, notes, &out->parts);
    ReflectionModel *model = start_model(set, options, &out->parts, arena);
    ReflectionMisses misses = {0};
    reflection_read_tables(model);
    model->bound = choose_bound(options, model->parts); /* scattered tables show noise now */
    reflection_surface_choose(model, notes);
    HeldOutPass pass = {model, ARENA_NEW(arena, HeldOut, model->tables)};
    parallel_for(options->threads, model->tables, hold_out, &pass);
    reflection_held_out_peaks(model, pass.held_out);
    if (!choose_frame(model, err) || !code_frames(model, &misses, err)) return false;
    parallel_for(options->threads, model->tables, look_between, &pass);
    out->held_out = pass.held_out;
    out->model = model;
    out->worst = misses.worst;
    note_outcome(model, &misses, notes);
    return reflection_section_write(model, notes, &out->section, err);
}
