#include "panel/fit/fit.h"

#include <stdlib.h>
#include <string.h>

#include "base/file_write.h"
#include "base/units.h"
#include "panel/fit/emission/emission_spectra.h"
#include "panel/fit/fit_judge.h"
#include "panel/fit/fit_report.h"
#include "panel/fit/fit_table.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_opened.h"
#include "panel/query/panel_report.h"
#include "panel/query/sampling_make.h"

static void note_limits(const Measurement *set, FitNotes *notes)
{
    if (set->is_white_only)
        fit_note(notes, "white only: XYZ split into %s%s",
                 set->white_miss > 0 ? "constant shares of three primaries"
                                     : "non-negative amounts of the Rec.709 primaries",
                 set->levels ? "" : ", level curve 2.2, black 0");
    if (set->levels) fit_note(notes, "%s", level_table_note(set->levels, notes->arena));
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

/* The file with its report: the long lists stay out of it, its tables are packed. Its own
 * size is one of the numbers. */
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
        whole.tables_size = panel_report_pack_tables(rows, arena, &whole.tables);
        bytes = fit_file_bytes(&whole, text, arena, size);
        fit_table_set_file_size(json_object_get(document, "total"), *size);
    }
    free(text);
    json_decref(rows);
    json_decref(meta);
    return bytes;
}

static bool refuse(const json_t *report, const char *path, Error *err)
{
    const json_t *reasons = json_object_get(report, "reasons");
    const char   *reason = json_string_value(json_array_get(reasons, 0));
    return error_at(err, ERROR_DIFFERENT, path, "", "is not written, for the panel would not "
                    "be usable: %s; --force writes it all the same", reason ? reason : "");
}

/* Errors are measured on the file's own bytes. A report comes also of what is not written for
 * being not usable. */
static bool finish_file(const FitParts *parts, const char *path, Arena *arena, json_t **report,
                        Error *err)
{
    size_t size;
    Panel *panel;
    void  *bytes = fit_file_bytes(parts, "{}", arena, &size);
    if (!panel_from_bytes(bytes, size, path, arena, &panel, err)) return false;
    json_t *document = fit_report_measure(parts, panel, size);
    bytes = reported_bytes(parts, document, arena, &size);
    if (!bytes) error_set(err, ERROR_MEMORY, "the report does not fit into memory");
    bool is_refused = bytes && !parts->options->force &&
                      fit_judge_grade(document) == JUDGE_UNUSABLE;
    if (is_refused) refuse(document, path, err);
    bool ok = bytes && !is_refused && file_write(path, bytes, size, err);
    if (ok || is_refused) *report = document;
    else json_decref(document);
    return ok;
}

/* The sampling, a section of the file or the promise that opening makes it, follows from what
 * the reflection says when it is queried. */
static bool sample_reflection(const FitParts *parts, ReflectionResult *reflection, Arena *arena,
                              Error *err)
{
    size_t size;
    Panel *panel;
    SamplingSection made = {.bytes = ""};
    void  *bytes = fit_file_bytes(parts, "{}", arena, &size);
    if (!panel_from_bytes(bytes, size, "panel", arena, &panel, err)) return false;
    if (!panel_makes_sampling(panel->reflection) && !sampling_make(panel, arena, &made, err))
        return false;
    reflection->sampling = made.bytes;
    reflection->sampling_size = made.size;
    return true;
}

bool panel_fit(const Measurement *measurement, const FitOptions *options, const char *path,
               Arena *arena, json_t **report, Error *err)
{
    FitNotes          notes = {.arena = arena};
    EmissionResult   *emission = ARENA_NEW(arena, EmissionResult, 1);
    ReflectionResult *reflection = ARENA_NEW(arena, ReflectionResult, 1);
    FitParts          parts = {.set = measurement, .options = options, .notes = &notes};
    Progress          progress = progress_start(options->progress, "fit", "steps", 4);
    if (!file_check_writable(path, err)) return false; /* a fit takes a while */
    note_limits(measurement, &notes);
    if (measurement->primary[0].level_count) {
        parts.emission = emission;
        if (!emission_fit(measurement, options, arena, &notes, emission, err)) return false;
    }
    progress_update(&progress, 1);
    if (parts.emission)
        parts.primaries = emission_spectra_write(measurement, &notes, arena,
                                                 &parts.primaries_size);
    progress_update(&progress, 2);
    if (measurement->incidence_count) {
        parts.reflection = reflection;
        if (!reflection_fit(measurement, options, arena, &notes, reflection, err) ||
            !sample_reflection(&parts, reflection, arena, err))
            return false;
    }
    progress_update(&progress, 3);
    bool ok = finish_file(&parts, path, arena, report, err);
    progress_end(&progress, 4);
    return ok;
}
