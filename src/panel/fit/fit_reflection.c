/* Reflection: all tables in the specular-following frame, in one tree. */
#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/units.h"
#include "panel/fit/fit_reflect.h"

#define DEFAULT_BOUND 0.02
#define NOISY_BOUND 0.025
#define NOISY 0.0005       /* relative: tables below it count as without noise */
#define FIRST_LEVEL 6
#define LAST_LEVEL 9
#define HELPED 0.8         /* a level that leaves more misses than this share did not help */
#define NARROWEST 2.0f     /* the largest frame exponent that is tried */
#define PLACES_BYTES ((size_t)5 << 29) /* of values at most: memory is bounded */
#define TRIAL_BYTES ((size_t)32 << 30) /* address space; pages cost nothing until touched */

static double largest_noise(const FitReflection *out)
{
    double most = 0;
    for (int t = 0; t < out->tables; t++) most = fmax(most, out->noise[t]);
    return most;
}

/* What the user asked for; else 2 %, and 2.5 % where there is noise. */
static double choose_bound(const FitOptions *options, const FitReflection *out)
{
    if (options->bound > 0) return (double)options->bound;
    return largest_noise(out) > NOISY ? NOISY_BOUND : DEFAULT_BOUND;
}

static ReflectionFit *start_fit(const Measurement *set, const FitOptions *options, Arena *arena,
                                FitReflection *out)
{
    ReflectionFit *fit = ARENA_NEW(arena, ReflectionFit, 1);
    *fit = (ReflectionFit){.set = set, .options = options, .out = out, .arena = arena,
                           .tables = out->tables, .wavelengths = set->wavelength_count,
                           .bound = choose_bound(options, out), .k = options->frame_exponent};
    fit->lattice.octants = set->azimuth_count > 1 ? 4 : 2;
    return fit;
}

/* ---- the frame --------------------------------------------------------------------------- */

/* One frame exponent and how well it does at the first level. */
typedef struct FrameTrial {
    const ReflectionFit *fit;
    float            exponent;
    ReflectionMisses misses;
    size_t           bytes;
    bool             has_failed;
    Error            err;
} FrameTrial;

static void run_trial(void *context, int item, int worker)
{
    FrameTrial   *trial = (FrameTrial *)context + item;
    Arena         arena = arena_reserve(TRIAL_BYTES);
    ReflectionFit fit = *trial->fit;
    FitReflection out = *fit.out;
    FitOptions    options = *fit.options;
    (void)worker;
    options.threads = 1;
    fit.out = &out, fit.options = &options, fit.arena = &arena, fit.k = trial->exponent;
    fit.is_trial = true;
    reflect_read_places(&fit, FIRST_LEVEL);
    reflect_choose_spectra(&fit);
    trial->has_failed = !reflect_code(&fit, &trial->misses, &trial->err);
    if (!trial->has_failed) trial->bytes = tree_size(out.tree);
    arena_release(&arena);
}

/* The frame exponent that leaves the fewest samples outside the bound, and of those that are
 * about as good the one with the smallest tree: wide haze likes 1, narrow peaks 2. */
static bool choose_frame(ReflectionFit *fit, Error *err)
{
    FrameTrial trials[3] = {{.fit = fit, .exponent = 1}, {.fit = fit, .exponent = 1.5f},
                            {.fit = fit, .exponent = NARROWEST}};
    int best = 0;
    if (fit->k > 0) return true;
    parallel_for(fit->options->threads, 3, run_trial, trials);
    for (int i = 0; i < 3; i++) {
        if (trials[i].has_failed) {
            *err = trials[i].err;
            return false;
        }
        int room = trials[i].misses.samples / 5000;
        int more = trials[i].misses.misses - trials[best].misses.misses;
        if (more < -room || (more <= room && trials[i].bytes < trials[best].bytes)) best = i;
    }
    fit->k = trials[best].exponent;
    return true;
}

/* ---- the level --------------------------------------------------------------------------- */

static size_t value_bytes(const ReflectionFit *fit, int level)
{
    size_t side = (size_t)1 << level;
    return 2 * side * side * (size_t)fit->lattice.octants / 4 * sizeof(float) *
           (size_t)fit->tables * (size_t)fit->wavelengths;
}

/* Deeper while samples are missed and the last step helped; one that did not is taken back. */
static bool code_levels(ReflectionFit *fit, ReflectionMisses *misses, Error *err)
{
    int first = fit->options->level > 0 ? fit->options->level : FIRST_LEVEL;
    int last = fit->options->level > 0 ? first : LAST_LEVEL;
    for (int level = first;; level++) {
        ReflectionMisses now;
        ReflectionFit    before = *fit;
        const void      *tree = fit->out->tree;
        TreeReport       report = fit->out->tree_report;
        reflect_read_places(fit, level);
        reflect_choose_spectra(fit);
        fit->is_last = level == last;
        if (!reflect_code(fit, &now, err)) return false;
        if (level > first && now.misses > (int)(HELPED * misses->misses)) {
            *fit = before;
            fit->out->tree = tree;
            fit->out->tree_report = report;
            return true;
        }
        *misses = now;
        if (!now.misses || level == last || value_bytes(fit, level + 1) > PLACES_BYTES)
            return true;
    }
}

static void note_outcome(const ReflectionFit *fit, const ReflectionMisses *misses,
                         FitNotes *notes)
{
    if (fit->options->keep_share > 0 && fit->options->basis == FIT_VERTEX)
        fit_note(notes, "reflection: the vertex basis keeps what its bound needs; a share to "
                 "keep is for the Haar basis");
    if (fit->out->masked)
        fit_note(notes, "%d zeros or negative values of reflection were held above a floor "
                 "(1e-6 of their table's largest value); their errors do not count",
                 fit->out->masked);
    if (misses->misses)
        fit_note(notes, "reflection: %d of %d samples lie beyond the bound of %.2g %%, the "
                 "worst by a factor of %.2g", misses->misses, misses->samples,
                 100 * fit->bound, misses->worst);
}

/* A peak that is missed at the finest level gets the frame that spreads it most. */
static bool code_frames(ReflectionFit *fit, ReflectionMisses *misses, Error *err)
{
    Arena            before = *fit->arena;
    float            chosen = fit->k;
    ReflectionMisses other;
    if (!code_levels(fit, misses, err)) return false;
    if (!misses->misses || chosen >= NARROWEST || fit->options->frame_exponent > 0) return true;
    fit->k = NARROWEST;
    if (!code_levels(fit, &other, err)) return false;
    if (other.misses < misses->misses) {
        *misses = other;
        return true;
    }
    *fit->arena = before;
    fit->k = chosen;
    return code_levels(fit, misses, err);
}

bool fit_reflection(const Measurement *set, const FitOptions *options, Arena *arena,
                    FitNotes *notes, FitReflection *out, Error *err)
{
    ReflectionFit   *fit = start_fit(set, options, arena, out);
    ReflectionMisses misses = {0};
    reflect_read_tables(fit);
    if (!choose_frame(fit, err) || !code_frames(fit, &misses, err)) return false;
    out->bound = fit->bound;
    out->worst = misses.worst;
    out->level = fit->lattice.level;
    out->frame_exponent = fit->k;
    out->components = fit->components;
    out->coefficients = fit->coefficients;
    note_outcome(fit, &misses, notes);
    return reflect_finish(fit, notes, err);
}
