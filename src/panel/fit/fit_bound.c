/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/fit_bound.h"

#include <math.h>

#include "panel/fit/fit_report.h"

#define ROUNDED 5e-4 /* of an integral: what means, as stored, leave open */
#define GAIN 0.98    /* a bound that lowers neither error so far is the last one tried */

/* One fit of emission or reflection, and what it leaves. */
typedef struct FitAttempt {
    FitParts parts;
    FitNotes notes;
    FitTable errors;
    double   integral[EMISSION_TABLES_MAX]; /* errors of the emission's tables, signed */
} FitAttempt;

typedef bool FitPart(FitAttempt *attempt, Arena *arena, Error *err);

/* Errors as they will be printed. */
static bool measure(FitAttempt *attempt, Arena scratch, Error *err)
{
    size_t   size, i;
    FitNotes unheard = {.arena = &scratch};
    FitParts parts = attempt->parts;
    parts.notes = &unheard;
    const Panel *panel = fit_file_open(&parts, "panel", &scratch, &size, err);
    if (!panel) return false;
    json_t *tables = json_array(), *table;
    attempt->errors = fit_report_errors(&parts, panel, tables);
    json_array_foreach(tables, i, table)
        if (parts.emission)
            attempt->integral[i] = json_number_value(json_object_get(table, "integral_error"));
    json_decref(tables);
    return true;
}

/* Every table as bright on the whole as it was measured, unless that costs the bound. */
static bool scale(FitAttempt *attempt, Arena *arena, Error *err)
{
    FitAttempt      scaled = *attempt;
    EmissionResult *emission = ARENA_NEW(arena, EmissionResult, 1);
    *emission = *attempt->parts.emission;
    if (!emission_fit_scale(emission, attempt->integral, arena)) return true;
    scaled.parts.emission = emission;
    if (!measure(&scaled, *arena, err)) return false;
    double most = fmax((double)attempt->parts.options->bound, attempt->errors.max_error);
    if (scaled.errors.max_error <= most &&
        scaled.errors.integral_error < attempt->errors.integral_error)
        *attempt = scaled;
    return true;
}

static bool fit_emission(FitAttempt *attempt, Arena *arena, Error *err)
{
    FitParts       *parts = &attempt->parts;
    EmissionResult *emission = ARENA_NEW(arena, EmissionResult, 1);
    if (!emission_fit(parts->set, parts->options, arena, &attempt->notes, emission, err))
        return false;
    parts->emission = emission;
    if (!(parts->options->bound > 0)) return true;
    return measure(attempt, *arena, err) && scale(attempt, arena, err);
}

static bool fit_reflection(FitAttempt *attempt, Arena *arena, Error *err)
{
    FitParts         *parts = &attempt->parts;
    ReflectionResult *reflection = ARENA_NEW(arena, ReflectionResult, 1);
    if (!reflection_fit(parts->set, parts->options, arena, &attempt->notes, reflection, err))
        return false;
    parts->reflection = reflection;
    return !(parts->options->bound > 0) || measure(attempt, *arena, err);
}

/* A fit of one part alone to this bound; 0: what the fit chooses. */
static bool attempt_bound(const FitParts *start, float bound, FitPart *fit, Arena *arena,
                          FitAttempt *out, Error *err)
{
    FitOptions *options = ARENA_NEW(arena, FitOptions, 1);
    *options = *start->options;
    options->bound = bound;
    *out = (FitAttempt){.parts = {.set = start->set, .options = options,
                                   .primaries = start->primaries,
                                   .primaries_size = start->primaries_size},
                        .notes = *start->notes};
    return fit(out, arena, err);
}

static bool is_no_worse(const FitTable *a, const FitTable *b)
{
    return a->max_error <= b->max_error && a->rms_error <= b->rms_error &&
           a->integral_error <= fmax(b->integral_error, ROUNDED);
}

static bool gains(const FitTable *a, const FitTable *b)
{
    return a->max_error < GAIN * b->max_error || a->rms_error < GAIN * b->rms_error;
}

/* The part as the tightest bound has it that is not worse than a looser one. */
static bool approach(const FitParts *start, FitPart *fit, Arena *arena, FitAttempt *held,
                     Error *err)
{
    static const float bounds[] = {0.05f, 0.02f, 0.01f, 5e-3f, 2e-3f, 1e-3f, 5e-4f, 2e-4f,
                                   1e-4f, 5e-5f, 2e-5f, 0};
    float required = start->options->bound;
    if (!attempt_bound(start, required > 0 ? fmaxf(required, bounds[0]) : 0, fit, arena, held,
                       err))
        return false;
    for (int i = 1; required > 0 && bounds[i - 1] > required; i++) {
        Error      unheard;
        FitAttempt next;
        Arena      before = *arena;
        float      bound = fmaxf(bounds[i], required);
        if (held->errors.max_error <= (double)bound) continue;
        if (!attempt_bound(start, bound, fit, arena, &next, &unheard)) {
            *arena = before; /* finer than the coder can */
            return true;
        }
        bool is_last = !gains(&next.errors, &held->errors);
        if (is_no_worse(&next.errors, &held->errors)) *held = next;
        else *arena = before;
        if (is_last) return true;
    }
    return true;
}

bool fit_bound_emission(FitParts *parts, Arena *arena, Error *err)
{
    FitAttempt        held;
    FitNotes          last = {.arena = arena}; /* after the fit's own */
    EmissionPrimaries primaries;
    emission_fit_primaries(parts->set, &last, arena, &primaries);
    parts->primaries = primaries.bytes;
    parts->primaries_size = primaries.size;
    parts->spectra_assumed = primaries.assumed;
    if (!approach(parts, fit_emission, arena, &held, err)) return false;
    *parts->notes = held.notes;
    parts->emission = held.parts.emission;
    for (int i = 0; i < last.count; i++) fit_note(parts->notes, "%s", last.text[i]);
    return true;
}

static void take_reflection(const FitAttempt *held, FitParts *parts)
{
    *parts->notes = held->notes;
    parts->reflection = held->parts.reflection;
}

bool fit_bound_reflection(FitParts *parts, Arena *arena, Error *err)
{
    FitAttempt held;
    if (!approach(parts, fit_reflection, arena, &held, err)) return false;
    take_reflection(&held, parts);
    return true;
}

bool fit_bound_loosened(FitParts *parts, float bound, Arena *arena, Error *err)
{
    FitAttempt held;
    if (!attempt_bound(parts, bound, fit_reflection, arena, &held, err)) return false;
    take_reflection(&held, parts);
    return true;
}
