/* SPDX-License-Identifier: Apache-2.0 */
/* The walk: what a set shines, what it sends back, how that is drawn, what the finished bytes
 * miss, the verdict, the places, the file. */
#include "panel/fit/fit.h"

#include "base/file_write.h"
#include "base/units.h"
#include "panel/fit/fit_file.h"
#include "panel/fit/fit_judge.h"
#include "panel/fit/fit_report.h"
#include "panel/fit/sampling_make.h"
#include "spectrum/curve.h"

/* ---- what the set leaves open ------------------------------------------------------------ */

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

/* ---- one panel --------------------------------------------------------------------------- */

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

static bool fit_emission(FitRun *run, FitParts *parts) {
    EmissionResult *emission = ARENA_NEW(run->arena, EmissionResult, 1);
    EmissionPrimaries primaries;
    FitNotes last = {.arena = run->arena}; /* after the fit's own */
    emission_fit_primaries(parts->set, &last, run->arena, &primaries);
    parts->primaries = primaries.bytes;
    parts->primaries_size = primaries.size;
    parts->spectra_assumed = primaries.assumed;
    if (!emission_fit(parts->set, run->options, run->arena, parts->notes, emission, run->err))
        return false;
    parts->emission = emission;
    for (int i = 0; i < last.count; i++) fit_note(parts->notes, "%s", last.text[i]);
    return true;
}

/* The sampling follows from the reflection's answers to queries. */
static bool fit_reflection(FitRun *run, FitParts *parts) {
    ReflectionResult *reflection = ARENA_NEW(run->arena, ReflectionResult, 1);
    SamplingSection made;
    if (!reflection_fit(parts->set, run->options, run->arena, parts->notes, reflection, run->err))
        return false;
    parts->reflection = reflection;
    Panel *panel = fit_file_open(parts, "panel", run->arena, run->err);
    if (!panel || !sampling_make(panel, run->arena, &made, run->err)) return false;
    reflection->sampling = made.bytes;
    reflection->sampling_size = made.size;
    return true;
}

/* Everything of a panel but its report and its places. */
static bool fit_parts(FitRun *run, const Measurement *set, FitParts *parts) {
    FitNotes *notes = ARENA_NEW(run->arena, FitNotes, 1);
    *notes = (FitNotes){.arena = run->arena};
    *parts = (FitParts){.set = set, .options = run->options, .notes = notes};
    note_limits(set, notes);
    if (set->primary[0].level_count && !fit_emission(run, parts)) return false;
    step(run);
    step(run);
    if (set->incidence_count && !fit_reflection(run, parts)) return false;
    step(run);
    return true;
}

/* A file's bytes. */
typedef struct FitBytes {
    const void *bytes;
    size_t size;
} FitBytes;

static bool refuse(const json_t *report, const char *path, Error *err) {
    const json_t *reasons = json_object_get(report, "reasons");
    const char *reason = json_string_value(json_array_get(reasons, 0));
    return error_at(err, ERROR_UNUSABLE, path, "",
                    "is not written, for the panel would not "
                    "be usable: %s; --force writes it all the same",
                    reason ? reason : "");
}

/* Errors are measured on the file's own bytes; then the report goes into them. It comes also
 * of what is not written for being not usable. */
static bool finish_panel(FitRun *run, FitParts *parts, FitBytes *out, json_t **report) {
    Panel *panel = fit_file_open(parts, run->path, run->arena, run->err);
    if (!panel) return false;
    *report = fit_report_measure(parts, panel);
    out->bytes = fit_file_bytes(parts, *report, run->arena, &out->size);
    if (!out->bytes) {
        json_decref(*report);
        *report = NULL;
        return error_set(run->err, ERROR_MEMORY, "the report does not fit into memory");
    }
    return run->options->force || fit_judge_grade(*report) != JUDGE_UNUSABLE ||
           refuse(*report, run->path, run->err);
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
    FitBytes file;
    json_t *report = NULL;
    const MeasuredSpot *spot = &whole->spot[places->spot_of_panel[k]];
    bool ok =
        fit_parts(run, &places->of_panel[k], &parts) && finish_panel(run, &parts, &file, &report);
    if (ok) {
        places->bytes[k] = file.bytes;
        places->sizes[k] = file.size;
        json_array_append_new(list, spot_report(spot, report, file.size));
    }
    json_decref(report);
    step(run);
    return ok || error_prefix(run->err, "the spot at %g, %g", spot->at[0], spot->at[1]);
}

static bool add_map(FitRun *run, const Measurement *set, const FitParts *parts, FitPlaces *places) {
    if (!set->map) return true;
    const Panel *panel = fit_file_open(parts, run->path, run->arena, run->err);
    return panel && fit_places_add_map(set, panel, run->arena, places, run->err);
}

/* ---- the walk ---------------------------------------------------------------------------- */

static bool fit_whole(FitRun *run, const Measurement *set, FitPlaces *places, FitBytes *out,
                      json_t **report) {
    FitParts parts;
    json_t *spots = json_array();
    bool ok = true;
    for (int k = 0; ok && k < places->panels; k++) ok = fit_spot(run, set, places, k, spots);
    ok = ok && fit_parts(run, &places->own, &parts);
    if (ok) {
        parts.places = places;
        parts.spots = spots;
        ok = add_map(run, set, &parts, places) && finish_panel(run, &parts, out, report);
    }
    json_decref(spots);
    return ok;
}

bool panel_fit(const Measurement *measurement, const FitOptions *options, const char *path,
               Arena *arena, json_t **report, Error *err) {
    FitRun run = {.options = options, .path = path, .arena = arena, .err = err};
    FitBytes file;
    FitPlaces places;
    *report = NULL;
    if (!file_check_writable(path, err)) return false; /* a fit takes a while */
    fit_places_plan(measurement, arena, &places);
    int steps = STEPS * (1 + places.panels);
    run.progress = progress_start(options->progress, "fit", "steps", steps);
    bool ok = fit_whole(&run, measurement, &places, &file, report);
    if (ok) progress_end(&run.progress, steps);
    else progress_clear(&run.progress);
    if (!ok || file_write(path, file.bytes, file.size, err)) return ok;
    json_decref(*report);
    *report = NULL;
    return false;
}
