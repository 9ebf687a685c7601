#include "panel/fit/fit.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file_write.h"
#include "base/parallel.h"
#include "base/units.h"
#include "panel/fit/fit_parts.h"
#include "panel/query/panel_report.h"

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
        fit_note(notes, "white only: XYZ split into %s, level curve 2.2, black 0",
                 set->white_miss > 0 ? "constant shares of three primaries"
                                     : "non-negative amounts of the Rec.709 primaries");
    if (set->white_miss > 0)
        fit_note(notes, "white only: the colour lies outside Rec.709, by %.1f %% of X + Y + Z: "
                 "the primaries share the table's own colour instead; is it the table of a "
                 "white pattern?", 100 * set->white_miss);
    for (int p = 0; p < 3; p++)
        if (set->primary[p].level_count &&
            set->primary[p].level[set->primary[p].level_count - 1] < 255)
            fit_note(notes, "%s is measured up to level %g only; above, its power law goes on",
                     p == 0 ? "red" : p == 1 ? "green" : "blue",
                     set->primary[p].level[set->primary[p].level_count - 1]);
    if (set->incidence_count)
        fit_note(notes, "reflection beyond %.0f degrees of incidence is extrapolated: the haze "
                 "moves in the panel's plane, its height follows Fresnel's formula",
                 degrees_from_radians(set->incidence[set->incidence_count - 1]));
}

/* The file with its report: the long lists stay out of it, figures are packed. Its own size
 * is one of the figures. */
static void *reported_bytes(const FitParts *parts, json_t *document, Arena *arena, size_t *size)
{
    static const char *const apart[] = {"tables", "total", "outliers", "holes"};
    FitParts whole = *parts;
    json_t  *rows = json_copy(json_object_get(document, "tables"));
    json_t  *meta = json_copy(document);
    void    *bytes = NULL;
    json_array_append(rows, json_object_get(document, "total"));
    for (int i = 0; i < 4; i++) json_object_del(meta, apart[i]);
    char *text = panel_report_text(meta);
    for (int pass = 0; pass < 2 && text; pass++) {
        whole.figures_size = panel_report_pack_tables(rows, arena, &whole.figures);
        bytes = fit_file_bytes(&whole, text, arena, size);
        fit_report_size(json_object_get(document, "total"), *size);
    }
    free(text);
    json_decref(rows);
    json_decref(meta);
    return bytes;
}

/* Errors are measured on the file's own bytes. */
static bool finish_file(const FitParts *parts, const char *path, Arena *arena, json_t **report,
                        Error *err)
{
    size_t size;
    Panel *panel;
    void  *bytes = fit_file_bytes(parts, "{}", arena, &size);
    if (!panel_from_bytes(bytes, size, path, arena, &panel, err)) return false;
    json_t *document = fit_measure(parts, panel, size);
    bytes = reported_bytes(parts, document, arena, &size);
    if (!bytes) error_set(err, ERROR_MEMORY, "the report does not fit into memory");
    if (!bytes || !file_write(path, bytes, size, err)) {
        json_decref(document);
        return false;
    }
    *report = document;
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
           fit_sampling(panel, arena, reflection, err);
}

/* Haze, floor and mirror of parts->set into *reflection. */
static bool fit_all_reflection(FitParts *parts, FitReflection *reflection, Arena *arena,
                               Error *err)
{
    parts->reflection = reflection;
    fit_separate(parts->set, parts->options, arena, parts->notes, reflection);
    return fit_reflection(parts->set, parts->options, arena, parts->notes, reflection, err) &&
           sample_reflection(parts, reflection, arena, err);
}

bool panel_fit(const Measurement *measurement, const FitOptions *options, const char *path,
               Arena *arena, json_t **report, Error *err)
{
    FitNotes        notes = {.arena = arena};
    FitEmission    *emission = ARENA_NEW(arena, FitEmission, 1);
    FitReflection  *reflection = ARENA_NEW(arena, FitReflection, 1);
    FitParts parts = {.set = measurement, .options = options, .notes = &notes};
    Progress progress = progress_start(options->progress, "fit", "steps", 4);
    if (!file_check_writable(path, err)) return false; /* a fit takes a while */
    note_limits(measurement, &notes);
    if (measurement->primary[0].level_count) {
        parts.emission = emission;
        if (!fit_emission(measurement, options, arena, &notes, emission, err)) return false;
    }
    progress_update(&progress, 1);
    if (parts.emission)
        parts.primaries = fit_spectra(measurement, &notes, arena, &parts.primaries_size);
    progress_update(&progress, 2);
    if (measurement->incidence_count && !fit_all_reflection(&parts, reflection, arena, err))
        return false;
    progress_update(&progress, 3);
    bool ok = finish_file(&parts, path, arena, report, err);
    progress_end(&progress, 4);
    return ok;
}
