#include "panel/fit.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/parallel.h"
#include "base/units.h"
#include "panel/fit_parts.h"

#define TRIAL_BYTES ((size_t)32 << 30) /* address space; pages cost nothing until touched */

FitOptions fit_options_default(void)
{
    return (FitOptions){.max_error = 0.003f, .wavelet = WAVELET_CDF53, .weights = HAAR_AREA,
                        .threads = 1, .progress = PROGRESS_NONE};
}

void fit_note(FitNotes *notes, const char *format, ...)
{
    char    text[512];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if (notes->count < 32)
        notes->text[notes->count++] = arena_string(notes->arena, text, strlen(text));
}

static void note_limits(const Measurement *set, FitNotes *notes)
{
    if (set->is_white_only)
        fit_note(notes, "white only: XYZ split into non-negative amounts of the Rec.709 "
                 "primaries, level curve 2.2, black 0");
    for (int p = 0; p < 3; p++)
        if (set->primary[p].level[set->primary[p].level_count - 1] < 255)
            fit_note(notes, "%s is measured up to level %g only; above, its power law goes on",
                     p == 0 ? "red" : p == 1 ? "green" : "blue",
                     set->primary[p].level[set->primary[p].level_count - 1]);
    if (set->incidence_count)
        fit_note(notes, "reflection beyond %.0f degrees of incidence is extrapolated: the haze "
                 "moves in the panel's plane, its height follows Fresnel's formula",
                 degrees_from_radians(set->incidence[set->incidence_count - 1]));
}

/* The report's text, then the file with it; errors are measured on the file's own bytes. */
static bool finish_file(const FitParts *parts, const char *path, Arena *arena, json_t **report,
                        Error *err)
{
    size_t size;
    Panel *panel;
    void  *bytes = fit_file_bytes(parts, "{}", arena, &size);
    if (!panel_from_bytes(bytes, size, path, arena, &panel, err)) return false;
    json_t *document = fit_measure(parts, panel, size);
    char   *text = json_dumps(document, JSON_COMPACT | JSON_REAL_PRECISION(6));
    if (!text) {
        json_decref(document);
        return error_set(err, ERROR_MEMORY, "the report does not fit into memory");
    }
    bytes = fit_file_bytes(parts, text, arena, &size);
    free(text);
    if (!file_write(path, bytes, size, err)) {
        json_decref(document);
        return false;
    }
    *report = document;
    return true;
}

/* One frame exponent and how well the haze came out with it. */
typedef struct FrameTrial {
    const FitParts *parts;
    float  exponent;
    double error; /* fit_reflection_error */
    bool   has_failed;
    Error  err;
} FrameTrial;

static bool try_frame(FrameTrial *trial, Arena *arena)
{
    FitNotes       unheard = {.arena = arena};
    FitOptions     options = *trial->parts->options;
    FitReflection *reflection = ARENA_NEW(arena, FitReflection, 1);
    FitParts       parts = *trial->parts;
    Panel         *panel;
    size_t         size;
    *reflection = *parts.reflection;
    options.frame_exponent = trial->exponent;
    parts.reflection = reflection;
    if (!fit_reflection(parts.set, &options, arena, &unheard, reflection, &trial->err))
        return false;
    void *bytes = fit_file_bytes(&parts, "{}", arena, &size);
    if (!panel_from_bytes(bytes, size, "trial", arena, &panel, &trial->err)) return false;
    trial->error = fit_reflection_error(parts.set, reflection, panel, 5);
    return true;
}

static void run_trial(void *context, int item, int worker)
{
    FrameTrial *trial = (FrameTrial *)context + item;
    Arena       arena = arena_reserve(TRIAL_BYTES);
    (void)worker;
    trial->has_failed = !try_frame(trial, &arena);
    arena_release(&arena);
}

/* The frame exponent with the least error: wide haze likes 1, narrow haze 2. */
static bool choose_frame(const FitParts *parts, FitOptions *options, Error *err)
{
    FrameTrial trials[3] = {{parts, 2, 0, false, {0}}, {parts, 1.5f, 0, false, {0}},
                            {parts, 1, 0, false, {0}}};
    int        best = 0, threads = options->level > 7 ? 1 : options->threads;
    if (options->frame_exponent > 0) return true;
    parallel_for(threads, 3, run_trial, trials);
    for (int i = 0; i < 3; i++) {
        if (trials[i].has_failed) {
            *err = trials[i].err;
            return false;
        }
        if (trials[i].error < trials[best].error) best = i;
    }
    options->frame_exponent = trials[best].exponent;
    return true;
}

/* How the reflection is sampled follows from what it says when it is queried. */
static bool sample_reflection(const FitParts *parts, FitReflection *reflection, Arena *arena,
                              Error *err)
{
    size_t size;
    Panel *panel;
    void  *bytes = fit_file_bytes(parts, "{}", arena, &size);
    return panel_from_bytes(bytes, size, "panel", arena, &panel, err) &&
           fit_sampling(panel, arena, parts->notes, reflection, err);
}

/* Haze, floor and mirror of parts->set into *reflection. */
static bool fit_all_reflection(FitParts *parts, FitReflection *reflection, Arena *arena,
                               Error *err)
{
    FitOptions options = *parts->options;
    parts->reflection = reflection;
    fit_separate(parts->set, arena, parts->notes, reflection);
    return choose_frame(parts, &options, err) &&
           fit_reflection(parts->set, &options, arena, parts->notes, reflection, err) &&
           sample_reflection(parts, reflection, arena, err);
}

/* A fit takes a while: whether its file can be made is found out first. */
static bool check_output(const char *path, Arena scratch, Error *err)
{
    const char *temporary = file_temporary_name(path, &scratch);
    FILE       *file = fopen(temporary, "wbx");
    if (!file)
        return error_at(err, ERROR_OUTPUT, path, "", "cannot be created: %s", strerror(errno));
    fclose(file);
    file_discard(temporary);
    return true;
}

bool panel_fit(const Measurement *measurement, const FitOptions *options, const char *path,
               Arena *arena, json_t **report, Error *err)
{
    FitNotes        notes = {.arena = arena};
    FitEmission    *emission = ARENA_NEW(arena, FitEmission, 1);
    FitReflection  *reflection = ARENA_NEW(arena, FitReflection, 1);
    PanelPrimaries *primaries = ARENA_NEW(arena, PanelPrimaries, 1);
    FitParts parts = {measurement, options, emission, primaries,
                      NULL, &notes};
    Progress progress = progress_start(options->progress, "fit", "steps", 4);
    if (!check_output(path, *arena, err)) return false;
    note_limits(measurement, &notes);
    if (!fit_emission(measurement, options, arena, &notes, emission, err)) return false;
    progress_update(&progress, 1);
    fit_spectra(measurement, emission, &notes, primaries);
    progress_update(&progress, 2);
    if (measurement->incidence_count && !fit_all_reflection(&parts, reflection, arena, err))
        return false;
    progress_update(&progress, 3);
    bool ok = finish_file(&parts, path, arena, report, err);
    progress_end(&progress, 4);
    return ok;
}

bool panel_report(const Panel *panel, json_t **report, Error *err)
{
    json_error_t fault;
    *report = json_loadb(panel->meta, panel->meta_size, 0, &fault);
    if (*report) return true;
    return error_set(err, ERROR_INPUT, "the panel's report is no JSON: %s", fault.text);
}
