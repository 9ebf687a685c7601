/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/fit.h"

#include <math.h>
#include <stdlib.h>

#include "base/file_write.h"
#include "base/units.h"
#include "hemisphere/tree/tree_open.h"
#include "hemisphere/vertex/vertex_pack.h"
#include "panel/fit/fit_file.h"
#include "panel/fit/fit_judge.h"
#include "panel/fit/fit_report.h"
#include "panel/fit/fit_table.h"
#include "panel/query/panel_opened.h"
#include "panel/query/panel_report.h"
#include "panel/query/sampling_make.h"
#include "spectrum/curve.h"

/* ---- the bound -------------------------------------------------------------------------- */

/* Emission and reflection to the bound that a user requires.
 *
 * Coders are greedy: a tighter bound may take another tree and end up worse. So a required
 * bound is approached via looser ones (0.05, 0.02, 0.01 and so on): the next fit is kept only
 * where its largest error and its rms are no larger, nor its integrals' beyond what the
 * rounding of means leaves. Where the last one keeps a bound already, no fit is made for it. */

#define ROUNDED 5e-4 /* of an integral: what means, as stored, leave open */
#define GAIN 0.98    /* a bound that lowers neither error so far is the last one tried */

/* One fit of emission or reflection, and what it leaves. */
typedef struct FitAttempt {
    FitParts parts;
    FitNotes notes;
    FitTable errors;
    double integral[EMISSION_TABLES_MAX]; /* errors of the emission's tables, signed */
} FitAttempt;

typedef bool FitPart(FitAttempt *attempt, Arena *arena, Error *err);

/* Errors as they will be printed. */
static bool measure(FitAttempt *attempt, Arena scratch, Error *err) {
    size_t size, i;
    FitNotes unheard = {.arena = &scratch};
    FitParts parts = attempt->parts;
    parts.notes = &unheard;
    const Panel *panel = fit_file_open(&parts, "panel", &scratch, &size, err);
    if (!panel) return false;
    json_t *tables = json_array(), *table;
    attempt->errors = fit_report_errors(&parts, panel, tables);
    json_array_foreach(tables, i, table) if (parts.emission) attempt->integral[i] =
        json_number_value(json_object_get(table, "integral_error"));
    json_decref(tables);
    return true;
}

/* Every table as bright on the whole as it was measured, unless that costs the bound. */
static bool scale(FitAttempt *attempt, Arena *arena, Error *err) {
    FitAttempt scaled = *attempt;
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

static bool fit_emission(FitAttempt *attempt, Arena *arena, Error *err) {
    FitParts *parts = &attempt->parts;
    EmissionResult *emission = ARENA_NEW(arena, EmissionResult, 1);
    if (!emission_fit(parts->set, parts->options, arena, &attempt->notes, emission, err))
        return false;
    parts->emission = emission;
    if (!(parts->options->bound > 0)) return true;
    return measure(attempt, *arena, err) && scale(attempt, arena, err);
}

static bool fit_reflection(FitAttempt *attempt, Arena *arena, Error *err) {
    FitParts *parts = &attempt->parts;
    ReflectionResult *reflection = ARENA_NEW(arena, ReflectionResult, 1);
    if (!reflection_fit(parts->set, parts->options, arena, &attempt->notes, reflection, err))
        return false;
    parts->reflection = reflection;
    return !(parts->options->bound > 0) || measure(attempt, *arena, err);
}

/* A fit of one part alone to this bound; 0: what the fit chooses. */
static bool attempt_bound(const FitParts *start, float bound, FitPart *fit, Arena *arena,
                          FitAttempt *out, Error *err) {
    FitOptions *options = ARENA_NEW(arena, FitOptions, 1);
    *options = *start->options;
    options->bound = bound;
    *out = (FitAttempt){.parts = {.set = start->set,
                                  .options = options,
                                  .primaries = start->primaries,
                                  .primaries_size = start->primaries_size},
                        .notes = *start->notes};
    return fit(out, arena, err);
}

static bool is_no_worse(const FitTable *a, const FitTable *b) {
    return a->max_error <= b->max_error && a->rms_error <= b->rms_error &&
           a->integral_error <= fmax(b->integral_error, ROUNDED);
}

static bool gains(const FitTable *a, const FitTable *b) {
    return a->max_error < GAIN * b->max_error || a->rms_error < GAIN * b->rms_error;
}

/* The part as the tightest bound has it that is not worse than a looser one. */
static bool approach(const FitParts *start, FitPart *fit, Arena *arena, FitAttempt *held,
                     Error *err) {
    static const float bounds[] = {0.05f, 0.02f, 0.01f, 5e-3f, 2e-3f, 1e-3f,
                                   5e-4f, 2e-4f, 1e-4f, 5e-5f, 2e-5f, 0};
    float required = start->options->bound;
    if (!attempt_bound(start, required > 0 ? fmaxf(required, bounds[0]) : 0, fit, arena, held, err))
        return false;
    for (int i = 1; required > 0 && bounds[i - 1] > required; i++) {
        Error unheard;
        FitAttempt next;
        Arena before = *arena;
        float bound = fmaxf(bounds[i], required);
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

/* Fill a part of the panel, and its notes. */
static bool fit_bound_emission(FitParts *parts, Arena *arena, Error *err) {
    FitAttempt held;
    FitNotes last = {.arena = arena}; /* after the fit's own */
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

static void take_reflection(const FitAttempt *held, FitParts *parts) {
    *parts->notes = held->notes;
    parts->reflection = held->parts.reflection;
}

static bool fit_bound_reflection(FitParts *parts, Arena *arena, Error *err) {
    FitAttempt held;
    if (!approach(parts, fit_reflection, arena, &held, err)) return false;
    take_reflection(&held, parts);
    return true;
}

/* The reflection once more, to a bound that nobody required; replaces it and its notes. */
static bool fit_bound_loosened(FitParts *parts, float bound, Arena *arena, Error *err) {
    FitAttempt held;
    if (!attempt_bound(parts, bound, fit_reflection, arena, &held, err)) return false;
    take_reflection(&held, parts);
    return true;
}

/* Wavelengths are few in many real measurements (one, or three): said, not refused. */
static void note_wavelengths(const Measurement *set, FitNotes *notes) {
    double first = (double)set->wavelength_nm[0];
    double last = (double)set->wavelength_nm[set->wavelength_count - 1];
    double beyond = curve_beyond(first, last, (CurveEnds){false, false});
    if (beyond > 0 && last > first)
        fit_note(notes,
                 "reflection is measured from %g to %g nm: %.3g %% of V(lambda) is "
                 "extrapolated, the end values stand there",
                 first, last, 100 * beyond);
    else if (beyond > 0)
        fit_note(notes,
                 "reflection is measured at %g nm alone, which stands for all "
                 "wavelengths",
                 first);
}

static void note_limits(const Measurement *set, FitNotes *notes) {
    if (set->is_white_only)
        fit_note(notes, "white only: XYZ split into %s%s",
                 set->white_miss > 0 ? "constant shares of three primaries"
                                     : "non-negative amounts of the Rec.709 primaries",
                 set->levels ? "" : ", level curve 2.2, black 0");
    if (set->levels) fit_note(notes, "%s", level_table_note(set->levels, notes->arena));
    if (set->white_miss > 0)
        fit_note(notes,
                 "white only: the colour lies outside Rec.709, by %.1f %% of X + Y + Z: "
                 "the primaries share the table's own colour instead; is it the table of a "
                 "white pattern?",
                 100 * set->white_miss);
    for (int p = 0; p < 3; p++)
        if (set->primary[p].level_count &&
            set->primary[p].level[set->primary[p].level_count - 1] < 255)
            fit_note(notes, "%s is measured up to level %g only; above, its power law goes on",
                     primary_names[p], set->primary[p].level[set->primary[p].level_count - 1]);
    if (set->spectra_beyond > 0)
        fit_note(notes,
                 "%.3g %% of V(lambda) lies beyond the primaries' spectra, which end in "
                 "light: dark is taken",
                 100 * set->spectra_beyond);
    if (set->incidence_count) note_wavelengths(set, notes);
    if (set->incidence_count)
        fit_note(notes,
                 "reflection beyond %.0f degrees of incidence is that of the two "
                 "directions exchanged where they were measured, else extrapolated: the haze "
                 "moves in the panel's plane, its height follows Fresnel's formula, the "
                 "lambertian part stays",
                 degrees_from_radians(set->incidence[set->incidence_count - 1]));
}

static size_t places_bytes(const FitParts *parts) {
    return parts->places ? fit_places_bytes(parts->places) : 0;
}

/* The file with its report: the long lists stay out of it, its tables are packed. Its own
 * size is one of the numbers. */
static void *reported_bytes(const FitParts *parts, json_t *document, Arena *arena, size_t *size) {
    static const char *const apart[] = {"tables", "total", "outliers", "holes"};
    FitParts whole = *parts;
    json_t *rows = json_copy(json_object_get(document, "tables"));
    json_t *meta = json_copy(document);
    void *bytes = NULL;
    json_array_append(rows, json_object_get(document, "total"));
    for (int i = 0; i < 4; i++) json_object_del(meta, apart[i]);
    whole.meta_size = panel_report_pack(meta, arena, &whole.meta);
    for (int pass = 0; pass < 2 && whole.meta_size; pass++) {
        whole.tables_size = panel_report_pack_tables(rows, parts->saves, arena, &whole.tables);
        bytes = fit_file_bytes(&whole, arena, size);
        fit_table_set_file_size(json_object_get(document, "total"), *size - places_bytes(parts));
    }
    json_decref(rows);
    json_decref(meta);
    return bytes;
}

static bool refuse(const json_t *report, const char *path, Error *err) {
    const json_t *reasons = json_object_get(report, "reasons");
    const char *reason = json_string_value(json_array_get(reasons, 0));
    return error_at(err, ERROR_UNUSABLE, path, "",
                    "is not written, for the panel would not "
                    "be usable: %s; --force writes it all the same",
                    reason ? reason : "");
}

#define MANY_VALUES 20000
#define REPORT_BYTES 700 /* about */
#define MADE_ANEW 0.25   /* from this share of the other bytes on, opening makes the sampling */

/* A file's bytes, to be; what messages call it. */
typedef struct FitTarget {
    const char *path;
    const void *bytes;
    size_t size;
} FitTarget;

/* The law of sizes: a file has at most the bytes of its samples as 32-bit numbers, of many
 * samples a tenth of them. */
static double most_bytes(double values) {
    return sizeof(float) * values * (values > MANY_VALUES ? 0.1 : 1);
}

static double values_of(const json_t *report) {
    const json_t *total = json_object_get(report, "total");
    return json_number_value(json_object_get(total, "source_bytes_float32")) / sizeof(float);
}

/* By how many bytes a panel is larger than that; 0: it is not. */
static double excess(const FitParts *parts, const FitTarget *target, const json_t *report) {
    double size = (double)(target->size - places_bytes(parts));
    return fmax(0, size - most_bytes(values_of(report)));
}

/* Errors are measured on the file's own bytes. */
static bool measured_bytes(const FitParts *parts, FitTarget *out, Arena *arena, json_t **report,
                           Error *err) {
    size_t size;
    Panel *panel = fit_file_open(parts, out->path, arena, &size, err);
    if (!panel) return false;
    *report = fit_report_measure(parts, panel, size - places_bytes(parts));
    out->bytes = reported_bytes(parts, *report, arena, &out->size);
    if (out->bytes) return true;
    json_decref(*report);
    *report = NULL;
    return error_set(err, ERROR_MEMORY, "the report does not fit into memory");
}

/* What a file that is too large does without: first a plain report, then its sampling. False:
 * nothing is left. */
static bool save(FitParts *parts, Arena *arena) {
    ReflectionResult *reflection;
    bool had_plain_report = !parts->saves;
    parts->saves = true;
    if (had_plain_report) return true;
    if (!parts->reflection || !parts->reflection->sampling_size) return false;
    reflection = ARENA_NEW(arena, ReflectionResult, 1);
    *reflection = *parts->reflection;
    reflection->sampling_size = 0;
    parts->reflection = reflection;
    return true;
}

/* A report comes also of what is not written for being not usable. */
static bool finish_bytes(FitParts *parts, FitTarget *out, Arena *arena, json_t **report,
                         Error *err) {
    json_t *document;
    if (!measured_bytes(parts, out, arena, &document, err)) return false;
    while (excess(parts, out, document) > 0 && save(parts, arena)) {
        json_decref(document);
        if (!measured_bytes(parts, out, arena, &document, err)) return false;
    }
    *report = document;
    return parts->options->force || fit_judge_grade(document) != JUDGE_UNUSABLE ||
           refuse(document, out->path, err);
}

/* A file would take more than its reflection may: its tree is packed, which opening pays
 * for. */
static void pack_tree(ReflectionResult *r, size_t file_size, Arena *arena) {
    const void *blob = r->model->tree;
    double values = 0;
    for (int t = 0; t < r->parts.tables; t++)
        values += (double)r->parts.haze[t].rows * r->model->wavelengths;
    if ((double)(file_size + REPORT_BYTES) > most_bytes(values) && vertex_can_pack(blob))
        r->packed = vertex_pack(blob, arena, &r->packed_size);
}

/* The sampling follows from the reflection's answers to queries. It is a section of the file,
 * or empty where it would be much of that: then opening makes it. */
static bool finish_reflection(FitParts *parts, Arena *arena, Error *err) {
    ReflectionResult *reflection = ARENA_NEW(arena, ReflectionResult, 1);
    size_t size;
    SamplingSection made;
    Panel *panel = fit_file_open(parts, "panel", arena, &size, err);
    if (!panel || !sampling_make(panel, false, arena, &made, err)) return false;
    bool is_made_anew =
        panel->reflection->azimuths == 1 && (double)made.size > MADE_ANEW * (double)size;
    *reflection = *parts->reflection;
    reflection->sampling = made.bytes;
    reflection->sampling_size = is_made_anew ? 0 : made.size;
    pack_tree(reflection, size + reflection->sampling_size, arena);
    parts->reflection = reflection;
    return true;
}

/* ---- a looser bound ---------------------------------------------------------------------- */

#define LOOSEST 0.05 /* of a reflection, for the sake of its size */
#define LOOSER 1.26  /* from one bound to the next */

static bool may_loosen(const FitParts *parts, double too_many) {
    const FitOptions *options = parts->options;
    const ReflectionResult *r = parts->reflection;
    return too_many > 0 && r && !options->bound && !options->level &&
           options->basis == FIT_VERTEX &&
           (double)(r->packed ? r->packed_size : tree_size(r->model->tree)) > too_many;
}

typedef struct LooserBound {
    double own, bound;
    bool is_tenth; /* of its source: what the file may take */
} LooserBound;

/* The panel as it is, with a reflection to a looser bound. */
static bool loosened(const FitParts *parts, LooserBound to, Arena *arena, FitParts *out,
                     Error *err) {
    FitNotes *notes = ARENA_NEW(arena, FitNotes, 1);
    *notes = *parts->notes;
    notes->count = parts->notes_before_reflection;
    *out = *parts;
    out->notes = notes;
    if (!fit_bound_loosened(out, (float)to.bound, arena, err) ||
        !finish_reflection(out, arena, err))
        return false;
    fit_note(notes,
             "reflection: the bound was loosened from %.3g %% to %.3g %%, so that the "
             "file is at most %s its source as 32-bit numbers; --max-error %.3g keeps the "
             "tighter bound",
             100 * to.own, 100 * to.bound, to.is_tenth ? "10 % of" : "as large as", to.own);
    return true;
}

/* Where all savings leave a file too large, its reflection has the tightest of some looser
 * bounds that is enough; where none is, its own. From the loosest on, so that a file for which
 * none is enough costs one fit. */
static void loosen(FitParts *parts, FitTarget *out, Arena *arena, json_t **report) {
    double too_many = excess(parts, out, *report);
    double own = parts->reflection ? parts->reflection->model->bound : LOOSEST;
    bool keeps = may_loosen(parts, too_many), is_many = values_of(*report) > MANY_VALUES;
    for (double bound = LOOSEST; keeps && bound > 1.001 * own; bound /= LOOSER) {
        Error unheard;
        FitTarget target = *out;
        Arena before = *arena;
        json_t *document = NULL, *other;
        FitParts next;
        keeps = loosened(parts, (LooserBound){own, bound, is_many}, arena, &next, &unheard) &&
                finish_bytes(&next, &target, arena, &document, &unheard) &&
                excess(&next, &target, document) == 0;
        other = keeps ? *report : document;
        if (keeps) *parts = next, *out = target, *report = document;
        else *arena = before;
        json_decref(other);
    }
}

/* A panel's bytes, and what is reported of it. */
static bool finish_panel(FitParts *parts, FitTarget *out, Arena *arena, json_t **report,
                         Error *err) {
    if (!finish_bytes(parts, out, arena, report, err)) return false;
    loosen(parts, out, arena, report);
    return true;
}

/* ---- the steps --------------------------------------------------------------------------- */

#define STEPS 4 /* of a panel */

/* State of a fit of one panel or of several. */
typedef struct FitRun {
    const FitOptions *options;
    const char *path; /* of the file to be */
    Arena *arena;
    Progress progress;
    int steps; /* done */
    Error *err;
} FitRun;

static void step(FitRun *run) {
    progress_update(&run->progress, ++run->steps);
}

/* Everything of a panel but its report and its places. */
static bool fit_parts(FitRun *run, const Measurement *set, FitParts *parts) {
    Arena *arena = run->arena;
    FitNotes *notes = ARENA_NEW(arena, FitNotes, 1);
    *notes = (FitNotes){.arena = arena};
    *parts = (FitParts){.set = set, .options = run->options, .notes = notes};
    note_limits(set, notes);
    if (set->primary[0].level_count && !fit_bound_emission(parts, arena, run->err)) return false;
    step(run);
    step(run);
    parts->notes_before_reflection = notes->count;
    if (set->incidence_count && (!fit_bound_reflection(parts, arena, run->err) ||
                                 !finish_reflection(parts, arena, run->err)))
        return false;
    step(run);
    return true;
}

/* ---- spots ------------------------------------------------------------------------------- */

/* A spot's entry in the whole file's report. */
static json_t *spot_report(const MeasuredSpot *spot, const json_t *report, size_t bytes) {
    const json_t *total = json_object_get(report, "total");
    return json_pack("{s:[f,f], s:b, s:b, s:I, s:O, s:O}", "position", spot->at[0], spot->at[1],
                     "emission", (int)spot->has_emission, "reflection", (int)spot->has_reflection,
                     "bytes", (json_int_t)bytes, "max_error", json_object_get(total, "max_error"),
                     "verdict", json_object_get(report, "verdict"));
}

static bool fit_spot(FitRun *run, const Measurement *whole, FitPlaces *places, int k,
                     json_t *list) {
    FitParts parts;
    FitTarget target = {.path = run->path};
    json_t *report = NULL;
    const MeasuredSpot *spot = &whole->spot[places->spot_of_panel[k]];
    bool ok = fit_parts(run, &places->of_panel[k], &parts) &&
              finish_panel(&parts, &target, run->arena, &report, run->err);
    if (ok) {
        places->bytes[k] = target.bytes;
        places->sizes[k] = target.size;
        json_array_append_new(list, spot_report(spot, report, target.size));
    }
    json_decref(report);
    step(run);
    return ok || error_prefix(run->err, "the spot at %g, %g", spot->at[0], spot->at[1]);
}

static bool fit_spots(FitRun *run, const Measurement *whole, FitPlaces *places, json_t *list) {
    for (int k = 0; k < places->panels; k++)
        if (!fit_spot(run, whole, places, k, list)) return false;
    return true;
}

static bool add_map(FitRun *run, const Measurement *set, const FitParts *parts, FitPlaces *places) {
    size_t size;
    if (!set->map) return true;
    const Panel *panel = fit_file_open(parts, run->path, run->arena, &size, run->err);
    return panel && fit_places_add_map(set, panel, run->arena, places, run->err);
}

static bool fit_whole(FitRun *run, const Measurement *set, FitPlaces *places, FitTarget *out,
                      json_t **report) {
    FitParts parts;
    json_t *spots = json_array();
    if (!fit_spots(run, set, places, spots) || !fit_parts(run, &places->own, &parts)) {
        json_decref(spots);
        return false;
    }
    parts.places = places;
    parts.spots = spots;
    bool ok = add_map(run, set, &parts, places) &&
              finish_panel(&parts, out, run->arena, report, run->err);
    json_decref(spots);
    return ok;
}

bool panel_fit(const Measurement *measurement, const FitOptions *options, const char *path,
               Arena *arena, json_t **report, Error *err) {
    FitRun run = {.options = options, .path = path, .arena = arena, .err = err};
    FitTarget target = {.path = path};
    FitPlaces places;
    *report = NULL;
    if (!file_check_writable(path, err)) return false; /* a fit takes a while */
    fit_places_plan(measurement, arena, &places);
    int steps = STEPS * (1 + places.panels);
    run.progress = progress_start(options->progress, "fit", "steps", steps);
    bool ok = fit_whole(&run, measurement, &places, &target, report);
    if (ok) progress_end(&run.progress, steps);
    else progress_clear(&run.progress);
    if (!ok || file_write(path, target.bytes, target.size, err)) return ok;
    json_decref(*report);
    *report = NULL;
    return false;
}
