/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_parts.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/parallel.h"
#include "base/units.h"
#include "panel/fit/common/table_rows.h"
#include "panel/fit/reflection/reflection_peak.h"
#include "panel/query/panel_reflection_layout.h"

double reflection_parts_noise(const ReflectionParts *parts, int table, double f) {
    double dim = f > 0 ? parts->dim_noise[table] / f : 0;
    return sqrt(parts->noise[table] * parts->noise[table] + dim * dim);
}

double reflection_parts_most_noise(const ReflectionParts *parts) {
    double most = 0;
    for (int t = 0; t < parts->tables; t++) most = fmax(most, parts->noise[t]);
    return most;
}

static void luminous_weights(const Measurement *set, double *luminous) {
    double total = 0;
    for (int w = 0; w < set->wavelength_count; w++)
        total += luminous[w] = panel_luminous_weight(set->wavelength_nm[w]);
    for (int w = 0; w < set->wavelength_count; w++) luminous[w] /= total;
}

static void note_mirror(const Measurement *set, const ReflectionParts *out, FitNotes *notes) {
    int last = set->incidence_count - 1;
    if (out->is_apart)
        fit_note(notes,
                 "the samples hold no image of the mirror: it is the specular measurement (%s) "
                 "less the haze in its aperture: luminous reflectance %.4f at %g deg, %.4f at %g "
                 "deg",
                 path_name(set->specular->file), out->mirror_y[0],
                 degrees_from_radians(set->incidence[0]), out->mirror_y[last],
                 degrees_from_radians(set->incidence[last]));
    else if (out->has_mirror)
        fit_note(notes,
                 "a mirror image as wide as the instrument (%g deg) was moved to the "
                 "mirror part: luminous reflectance %.4f at %g deg, %.4f at %g deg",
                 set->instrument_fwhm_deg, out->mirror_y[0],
                 degrees_from_radians(set->incidence[0]), out->mirror_y[last],
                 degrees_from_radians(set->incidence[last]));
    else if (set->instrument_fwhm_deg > 0)
        fit_note(notes,
                 "no image as narrow as the instrument (%g deg) stands out of the haze: "
                 "no mirror part",
                 set->instrument_fwhm_deg);
    else
        fit_note(notes, "the instrument's width is not declared (--instrument-fwhm): no "
                        "mirror part was separated");
}

#define REACH_DEG 10.0 /* beyond a specular table's incidences: nearer ones go without a word */

/* Beyond its incidences it goes on as plain glass does (specular_table.c). */
static void note_reach(const Measurement *set, FitNotes *notes) {
    const SpecularTable *table = set->specular;
    double low = degrees_from_radians(table->incidence[0]);
    double high = degrees_from_radians(table->incidence[table->rows - 1]);
    double first = degrees_from_radians(set->incidence[0]);
    double last = degrees_from_radians(set->incidence[set->incidence_count - 1]);
    if (low - first > REACH_DEG || last - high > REACH_DEG)
        fit_note(notes,
                 "the specular measurement (%s) reaches from %.3g to %.3g degrees, the "
                 "tables from %.3g to %.3g: beyond, its mirror goes on as plain glass's does",
                 path_name(table->file), low, high, first, last);
}

bool reflection_parts_twice(const Measurement *set, const ReflectionParts *parts, Twice *worst) {
    double apart = -1;
    if (!set->specular || !parts->peak) return false;
    for (int t = 0; t < parts->tables; t++)
        if (parts->peak[t].source != PEAK_APART || parts->peak[t].specular_miss > 0)
            apart = fmax(apart, parts->peak[t].specular_miss);
    if (apart < 0) return false;
    *worst = (Twice){"the mirror",
                     {set->specular->is_gloss ? "the gloss" : "the specular measurement",
                      "what the BRDF has in its aperture"},
                     100 * apart,
                     set->specular->is_gloss ? 100 * GLOSS_MISS : 100 * SPECULAR_MISS,
                     " %"};
    return true;
}

/* Where the specular measurement was needed, and where it disagrees. */
static void note_specular(const Measurement *set, const ReflectionParts *out, FitNotes *notes) {
    int used = 0, apart = out->is_apart ? out->tables : 0;
    for (int t = 0; t < out->tables; t++) used += out->peak[t].source == PEAK_SPECULAR;
    if (used)
        fit_note(notes,
                 "of %d of %d tables of reflection the mirror follows from the %s "
                 "(%s)",
                 used, out->tables,
                 set->specular->is_gloss
                     ? "gloss, taken as the specular reflectance in a round aperture, the same at "
                       "all wavelengths"
                     : "specular measurement",
                 path_name(set->specular->file));
    if (used || apart) note_reach(set, notes);
    Twice worst;
    if (reflection_parts_twice(set, out, &worst))
        fit_note(notes, "%s", twice_text(&worst, notes->arena));
}

/* ---- one table after the other ----------------------------------------------------------- */

typedef struct PartsPass {
    const Measurement *set;
    ReflectionParts *out;
    AngleTable *table; /* of the next part */
    bool *is_apart;
    Arena *arena; /* per table */
} PartsPass;

#define TABLE_BYTES ((size_t)4 << 30) /* address space of one table's scratch */

static double *row_of(double *all, const Measurement *set, int table) {
    return all + table * set->wavelength_count;
}

static double incidence_of(const Measurement *set, int table) {
    return set->incidence[table % set->incidence_count];
}

#define GLOSS_WEIGHT 0.25 /* a gloss meter is taken for one of twice the error of a row */

/* The specular measurement at a table's incidence and wavelengths. */
static PeakSpecular specular_of(const Measurement *set, int t, Arena *arena) {
    PeakSpecular out = {.weight = set->specular->is_gloss ? GLOSS_WEIGHT : 1};
    double *value = ARENA_NEW(arena, double, set->wavelength_count);
    for (int w = 0; w < set->wavelength_count; w++) {
        value[w] = specular_table_at(set->specular, incidence_of(set, t),
                                     (double)set->wavelength_nm[w], &out.aperture);
        out.mean += value[w] / set->wavelength_count;
    }
    out.value = value;
    return out;
}

static PeakTask task_of(const PartsPass *pass, int t, PeakSpecular *specular, Arena *arena) {
    const Measurement *set = pass->set;
    PeakTask task = {&set->brdf[t], incidence_of(set, t),
                     radians_from_degrees(set->instrument_fwhm_deg), pass->out->noise[t], NULL};
    if (!set->specular) return task;
    *specular = specular_of(set, t, arena);
    task.specular = specular;
    return task;
}

static void look_at_table(void *context, int t, int worker) {
    PartsPass *pass = context;
    const Measurement *set = pass->set;
    ReflectionParts *out = pass->out;
    Arena scratch = pass->arena[t];
    PeakSpecular specular;
    (void)worker;
    out->noise[t] = table_noise_relative(&set->brdf[t], set->wavelength_count / 2, scratch);
    out->dim_noise[t] = table_noise_dim(&set->brdf[t], set->wavelength_count / 2, scratch);
    PeakTask task = task_of(pass, t, &specular, &scratch);
    pass->is_apart[t] = set->specular && reflection_peak_is_apart(&task, scratch);
}

/* One instrument made all tables: most of them decide. */
static bool is_apart(const PartsPass *pass) {
    int count = 0;
    for (int t = 0; t < pass->out->tables; t++) count += pass->is_apart[t];
    return 2 * count > pass->out->tables;
}

static void find_mirror(void *context, int t, int worker) {
    PartsPass *pass = context;
    const Measurement *set = pass->set;
    ReflectionParts *out = pass->out;
    (void)worker;
    pass->table[t] = set->brdf[t];
    if (!out->peak) return;
    PeakSpecular specular;
    PeakTask task = task_of(pass, t, &specular, &pass->arena[t]);
    out->peak[t].reflectance = row_of(out->reflectance, set, t);
    (out->is_apart ? reflection_peak_take_apart : reflection_peak_take_mirror)(
        &task, &pass->arena[t], &out->peak[t], &pass->table[t]);
}

/* Copies what the passes made into the fit's arena. */
static void keep_table(AngleTable *to, const AngleTable *from, const AngleTable *before,
                       Arena *arena) {
    size_t count = (size_t)from->rows * (size_t)from->channels;
    *to = *from;
    if (from->value == before->value) return;
    float *value = ARENA_NEW(arena, float, count);
    memcpy(value, from->value, sizeof *value * count);
    to->value = value;
}

static double luminous_mean(const ReflectionParts *out, const Measurement *set, double *all,
                            int t) {
    double sum = 0;
    for (int w = 0; w < set->wavelength_count; w++)
        sum += out->luminous[w] * row_of(all, set, t)[w];
    return sum;
}

static void separate_mirror(PartsPass *pass, int threads, Arena *arena) {
    ReflectionParts *out = pass->out;
    parallel_for(threads, out->tables, find_mirror, pass);
    for (int t = 0; t < out->tables; t++) {
        keep_table(&out->haze[t], &pass->table[t], &pass->set->brdf[t], arena);
        out->has_mirror |= luminous_mean(out, pass->set, out->reflectance, t) > 0;
        if (t < pass->set->incidence_count)
            out->mirror_y[t] = luminous_mean(out, pass->set, out->reflectance, t);
    }
}

void reflection_parts_separate(const Measurement *set, const FitOptions *options, Arena *arena,
                               FitNotes *notes, ReflectionParts *out) {
    int tables = set->incidence_count * (set->azimuth_count > 1 ? set->azimuth_count : 1);
    size_t rows = (size_t)tables * (size_t)set->wavelength_count;
    PartsPass pass = {.set = set, .out = out};
    out->tables = tables;
    out->haze = ARENA_NEW(arena, AngleTable, tables);
    out->noise = ARENA_NEW(arena, double, tables);
    out->dim_noise = ARENA_NEW(arena, double, tables);
    out->reflectance = ARENA_NEW(arena, double, rows);
    pass.table = ARENA_NEW(arena, AngleTable, tables);
    pass.is_apart = ARENA_NEW(arena, bool, tables);
    pass.arena = ARENA_NEW(arena, Arena, tables);
    luminous_weights(set, out->luminous);
    for (int t = 0; t < tables; t++) pass.arena[t] = arena_reserve(TABLE_BYTES);
    parallel_for(options->threads, tables, look_at_table, &pass);
    out->is_apart = is_apart(&pass);
    if (set->instrument_fwhm_deg > 0 || out->is_apart)
        out->peak = ARENA_NEW(arena, PeakMirror, tables);
    separate_mirror(&pass, options->threads, arena);
    for (int t = 0; t < tables; t++) arena_release(&pass.arena[t]);
    note_mirror(set, out, notes);
    if (set->specular && out->peak) note_specular(set, out, notes);
}
