/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/fit_report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/parallel.h"
#include "base/units.h"
#include "hemisphere/geodesic.h"
#include "hemisphere/tree/tree_open.h"
#include "panel/fit/common/table_rows.h"
#include "panel/fit/fit_judge.h"
#include "panel/fit/reflection/reflection_model.h"
#include "panel/fit/reflection/reflection_read.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_opened.h"
#include "panel/query/panel_reflection.h"

/* A table that the emission is held against. */
typedef struct EmissionCheck {
    const EmissionResult *emission;
    const AngleTable *table;
    int index; /* of the table */
    float rgb[3];
    double least[3]; /* errors are relative to no less, cd m^-2 */
    double bound;
    FitErrors errors;
} EmissionCheck;

/* 20 times what is noise even without light, what no meter sees, or a share of the channel's
 * largest value. */
static void find_least(EmissionCheck *check) {
    const EmissionResult *e = check->emission;
    for (int j = 0; j < 3; j++)
        check->least[j] = fmax(20 * e->noise[check->index].dim[j],
                               emission_samples_floor(check->table, j, e->outlier[check->index],
                                                      e->model->samples->floor_share));
}

static void add_emission_row(EmissionCheck *check, int i, const float xyz[3]) {
    const EmissionResult *e = check->emission;
    const EmissionNoise *noise = &e->noise[check->index];
    const float *m = check->table->value + 3 * i;
    double weight = table_row_weight(check->table, i);
    bool is_followed = !e->outlier[check->index][i];
    double worst = 0;
    int of = 0; /* the channel that misses most */
    for (int j = 0; j < 3; j++) {
        double wanted = (double)m[j], scale = fmax(check->least[j], wanted);
        double sigma = emission_noise_sigma(noise, j, wanted);
        double error = fabs((double)xyz[j] - wanted) / scale;
        if (error > worst) worst = error, of = j;
        if (!is_followed) continue;
        fit_table_add_error(&check->errors, (double)xyz[j], wanted, scale, j == 1 ? weight : 0);
        fit_table_add_excess(&check->errors, error - 5 * sigma / scale,
                             fmax(check->bound, JUDGE_LEAST_BOUND));
    }
    if (!is_followed)
        fit_table_leave_out(&check->errors, (double)xyz[of], (double)m[of],
                            fmax(check->least[of], (double)m[of]));
}

/* Relative to the measured value itself, or to the least that counts. */
static void measure_emission(EmissionCheck *check, const Panel *panel, FitTable *out) {
    for (int i = 0; i < check->table->rows; i++) {
        float xyz[3];
        Vec3 d = table_row_direction(check->table, i);
        if (!(d.z > 0)) continue;
        panel_emission_xyz(panel, d, check->rgb, xyz);
        add_emission_row(check, i, xyz);
    }
    fit_table_finish(&check->errors, out);
    out->extrapolated = (double)panel->emission->cone_cos; /* share of the hemisphere's sr */
}

static size_t emission_bytes(const EmissionResult *e) {
    return e->section_size + tree_size(e->tree.bytes);
}

static void add_emission_tables(const FitParts *parts, const Panel *panel, json_t *tables,
                                FitTable *total, FitErrors *all) {
    const EmissionResult *e = parts->emission;
    for (int i = 0; i < e->table_count; i++) {
        EmissionTable of = emission_samples_table(parts->set, true, i);
        const AngleTable *from = of.table;
        EmissionCheck check = {.emission = e,
                               .table = from,
                               .index = i,
                               .bound = fit_required_bound(parts->options, e->model->tolerance)};
        if (of.primary < 3) check.rgb[of.primary] = of.code;
        find_least(&check);
        FitTable one = {.name = from->name,
                        .text_bytes = from->text_bytes,
                        .float32_bytes = parts->set->is_white_only && i
                                             ? 0
                                             : 3 * sizeof(float) * (size_t)from->rows,
                        .stored_values = (double)e->tree.report.stored_values / e->table_count,
                        .bytes = (double)emission_bytes(e) / e->table_count,
                        .noise = e->noise[i].relative[1]};
        measure_emission(&check, panel, &one);
        fit_table_merge(all, &check.errors);
        fit_table_append(tables, total, &one);
    }
}

#define FALLING_LEVEL 3 /* of the directions that are evaluated */

/* Whole codes that give less light than the code below, over directions and primaries. */
static int count_falling(const Panel *panel) {
    int count = 0;
    for (uint32_t i = 0; i < geodesic_count(FALLING_LEVEL); i++) {
        Vec3 d = geodesic_center(FALLING_LEVEL, i);
        if (d.z < panel->emission->cone_cos) continue;
        for (int p = 0; p < 3; p++) {
            float rgb[3] = {0, 0, 0}, xyz[3], before[3];
            panel_emission_xyz(panel, d, rgb, before);
            for (int code = 1; code < 256; code++) {
                rgb[p] = (float)code;
                panel_emission_xyz(panel, d, rgb, xyz);
                count += xyz[1] < before[1] * (1 - 1e-6f);
                memcpy(before, xyz, sizeof before);
            }
        }
    }
    return count;
}

#define FEW_AZIMUTHS 8

/* The azimuths of a table where they are so few that most lie between them: [] where they are
 * more, or nowhere further than 45 degrees apart. Degrees, rising. */
static json_t *few_azimuths(const AngleTable *table) {
    double found[FEW_AZIMUTHS + 1], widest = 0;
    int count = 0;
    for (int i = 0; i < table->rows && count <= FEW_AZIMUTHS; i++) {
        double phi = degrees_from_radians((double)table->phi[i]);
        phi -= 360 * floor(phi / 360 + 1e-6);
        int at = 0;
        while (at < count && found[at] < phi - 0.5) at++;
        if (!(table->theta[i] > 1e-4f) || (at < count && found[at] < phi + 0.5)) continue;
        memmove(found + at + 1, found + at, sizeof *found * (size_t)(count - at));
        found[at] = phi;
        count++;
    }
    json_t *out = json_array();
    for (int i = 0; i < count; i++)
        widest = fmax(widest, (i + 1 < count ? found[i + 1] : found[0] + 360) - found[i]);
    for (int i = 0; i < count && count <= FEW_AZIMUTHS && widest > 45.5; i++)
        json_array_append_new(out, json_real(round(100 * found[i]) / 100));
    return out;
}

/* The emission's parameters, and its size in bytes. */
static json_t *describe_emission(const FitParts *parts, const FitTable *total, double bound,
                                 int falling) {
    const EmissionResult *e = parts->emission;
    double bytes = (double)emission_bytes(e);
    return json_pack(
        "{s:s, s:i, s:i, s:f, s:f, s:f, s:f, s:b, s:b, s:b, s:I, s:I, s:f, s:i,"
        " s:i, s:i, s:f, s:s*}",
        "basis", parts->options->basis == FIT_HAAR ? "haar" : "vertex", "level", e->tree.level,
        "components", e->model->rank->components, "tolerance",
        fit_required_bound(parts->options, e->model->tolerance), "bound", bound, "rank_error",
        e->model->rank->worst, "cone_deg", degrees_from_radians(e->model->samples->cone), "black",
        (int)e->has_black, "white_only", (int)parts->set->is_white_only, "levels_measured",
        !parts->set->is_white_only || parts->set->levels, "bytes", (json_int_t)emission_bytes(e),
        "source_bytes_float32", (json_int_t)total->float32_bytes, "share_of_source",
        bytes / fmax(1, (double)total->float32_bytes), "outliers", e->outlier_count, "holes",
        e->hole_count, "falling_codes", falling, "error_floor", e->model->samples->floor_share,
        "spectra_assumed", parts->spectra_assumed);
}

/* ---- the reflection ---------------------------------------------------------------------- */

/* The azimuth of a table's mirror direction. */
static double mirror_azimuth(const Measurement *set, int table) {
    return set->azimuth_count > 1 ? set->azimuth[table / set->incidence_count] - PI : 0;
}

/* A row's direction in the display's frame. */
static Vec3 row_direction(const AngleTable *table, int row, double mirror) {
    return table_direction((double)table->theta[row], (double)table->phi[row] + mirror);
}

/* One table in the report; values below the least one that zeros are held above do not
 * count. */
typedef struct TableWork {
    const Measurement *set;
    const ReflectionResult *reflection;
    const Panel *panel;
    double bound;
    FitErrors *errors; /* per table */
} TableWork;

static void add_deviation(TableWork *work, int t, int row, double found, double wanted) {
    const ReflectionResult *r = work->reflection;
    double weight = table_row_weight(&r->parts.haze[t], row);
    double noise = 5 * reflection_parts_noise(&r->parts, t, wanted);
    double miss = fabs(found - wanted) / wanted - noise;
    fit_table_add_error(&work->errors[t], found, wanted, wanted, weight);
    fit_table_add_excess(&work->errors[t], miss, fmax(work->bound, JUDGE_LEAST_BOUND));
}

static void measure_table(void *context, int t, int worker) {
    TableWork *work = context;
    const Measurement *set = work->set;
    const AngleTable *table = &work->reflection->parts.haze[t];
    double least = reflection_read_least(table), mirror = mirror_azimuth(set, t);
    Vec3 wi = reflection_model_light(set, t);
    (void)worker;
    for (int first = 0; first < set->wavelength_count; first += SPECTRUM_LANES) {
        Wavelengths wavelengths = reflection_model_wavelengths(set, first);
        int lanes = set->wavelength_count - first;
        for (int i = 0; i < table->rows; i++) {
            const float *m = table->value + (size_t)i * (size_t)table->channels + first;
            Vec3 wo = row_direction(table, i, mirror);
            Spectrum f = panel_brdf(work->panel, wo, wi, &wavelengths);
            if (!(wo.z > 0)) continue; /* along the panel nothing leaves it */
            for (int k = 0; k < lanes && k < SPECTRUM_LANES; k++)
                if ((double)m[k] >= least) add_deviation(work, t, i, (double)f[k], (double)m[k]);
        }
    }
}

/* Of the hemisphere's solid angle, under a table's light. */
#define SHARE_THETAS 60
#define SHARE_PHIS 72
static double extrapolated_share(const TableWork *work, int t) {
    Vec3 wi = reflection_model_light(work->set, t);
    int count = 0;
    if (!work->reflection->model->has_reach) return (double)work->panel->reflection->cone_cos;
    for (int i = 0; i < SHARE_THETAS; i++)
        for (int k = 0; k < SHARE_PHIS; k++) {
            double theta = acos_d(1 - (i + 0.5) / SHARE_THETAS);
            Vec3 wo = table_direction(theta, 2 * PI * (k + 0.5) / SHARE_PHIS);
            count += !panel_brdf_is_measured(work->panel, wo, wi);
        }
    return (double)count / (SHARE_THETAS * SHARE_PHIS);
}

static size_t reflection_bytes(const ReflectionResult *r) {
    return r->section.size + tree_size(r->model->tree) + r->sampling_size;
}

static void add_reflection_tables(const FitParts *parts, const Panel *panel, json_t *tables,
                                  FitTable *total, FitErrors *all) {
    const ReflectionResult *r = parts->reflection;
    Arena scratch = *parts->notes->arena;
    TableWork work = {.set = parts->set,
                      .reflection = r,
                      .panel = panel,
                      .bound = fit_required_bound(parts->options, r->model->bound)};
    double bytes = (double)reflection_bytes(r) / r->parts.tables;
    double values =
        (double)r->model->tree_report.stored_rows * r->model->components / r->parts.tables;
    work.errors = ARENA_NEW(&scratch, FitErrors, r->parts.tables);
    parallel_for(parts->options->threads, r->parts.tables, measure_table, &work);
    for (int t = 0; t < r->parts.tables; t++) {
        const AngleTable *from = &r->parts.haze[t];
        FitTable one = {.name = from->name,
                        .text_bytes = from->text_bytes,
                        .float32_bytes =
                            (size_t)from->channels * sizeof(float) * (size_t)from->rows,
                        .stored_values = values,
                        .bytes = bytes,
                        .noise = r->parts.noise[t]};
        fit_table_finish(&work.errors[t], &one);
        fit_table_merge(all, &work.errors[t]);
        one.extrapolated = extrapolated_share(&work, t);
        fit_table_append(tables, total, &one);
    }
}

/* rms of |f(i, o) - f(o, i)| / mean over pairs of measured incidences, at 550 nm or next. */
static double reciprocity_defect(const Measurement *set, const Panel *panel) {
    double squares = 0, count = 0;
    Wavelengths wavelengths = reflection_model_wavelengths(set, set->wavelength_count / 2);
    for (int a = 0; a < set->incidence_count; a++)
        for (int b = 0; b < a; b++)
            for (int p = 0; p < 36; p++) {
                double t = set->incidence[a], u = set->incidence[b], phi = PI * p / 36;
                Vec3 i = vec3((float)-sin_d(t), 0, (float)cos_d(t));
                Vec3 o = table_direction(u, phi);
                double f = (double)panel_brdf(panel, o, i, &wavelengths)[0];
                double g = (double)panel_brdf(panel, i, o, &wavelengths)[0];
                squares += 4 * (f - g) * (f - g) / ((f + g) * (f + g));
                count++;
            }
    return count > 0 ? sqrt(squares / count) : 0;
}

/* The three parts at every incidence, luminous. */
static json_t *parts_json(const FitParts *parts, const Panel *panel) {
    const ReflectionResult *r = parts->reflection;
    json_t *list = json_array();
    for (int i = 0; i < parts->set->incidence_count; i++) {
        double theta = parts->set->incidence[i];
        double haze = (double)panel_haze_albedo(panel, (float)cos_d(theta));
        double lambertian = r->section.lambertian_y[i];
        json_t *one =
            json_pack("{s:f, s:f, s:f, s:f}", "incidence_deg", degrees_from_radians(theta),
                      "luminous_reflectance", r->parts.mirror_y[i], "haze",
                      fmax(0, haze - lambertian), "floor", fmin(haze, lambertian));
        json_array_append_new(list, one);
    }
    return list;
}

/* The parameters, and the parts at every incidence, as "reflection". */
static void add_reflection(const FitParts *parts, const Panel *panel, double bound, json_t *out) {
    const ReflectionResult *r = parts->reflection;
    int last = parts->set->incidence_count - 1;
    json_object_set_new(
        out, "reflection",
        json_pack(
            "{s:s, s:i, s:i, s:i, s:i, s:f, s:f, s:f, s:f, s:I, s:i, s:f, s:f, s:f, s:o}", "basis",
            parts->options->basis == FIT_VERTEX ? "vertex" : "haar", "level",
            r->model->lattice.level, "azimuths", parts->set->azimuth_count, "spectral_coefficients",
            r->model->coefficients, "components", r->model->components, "frame_exponent",
            (double)r->model->k, "tolerance", fit_required_bound(parts->options, r->model->bound),
            "bound", bound, "largest_error_over_bound", r->worst, "bytes",
            (json_int_t)reflection_bytes(r), "zeros_masked", r->model->masked, "reciprocity_defect",
            reciprocity_defect(parts->set, panel), "largest_albedo", r->section.largest_albedo,
            "extrapolated_beyond_deg", degrees_from_radians(parts->set->incidence[last]), "mirror",
            parts_json(parts, panel)));
}

static json_t *flags_json(const EmissionFlags *flags, bool has_values) {
    json_t *list = json_array();
    for (int i = 0; i < flags->count && i < EMISSION_FLAGS_MAX; i++) {
        const EmissionFlag *f = &flags->flag[i];
        json_t *one =
            json_pack("{s:s, s:f, s:f}", "table", f->table, "theta_deg",
                      degrees_from_radians(f->theta), "phi_deg", degrees_from_radians(f->phi));
        if (has_values) {
            json_object_set_new(one, "value", json_real(f->value));
            json_object_set_new(one, "expected", json_real(f->expected));
        }
        json_array_append_new(list, one);
    }
    return list;
}

static json_t *notes_json(const FitNotes *notes) {
    json_t *list = json_array();
    for (int i = 0; i < notes->count; i++) json_array_append_new(list, json_string(notes->text[i]));
    return list;
}

static void hash_table(XXH3_state_t *hash, const AngleTable *table) {
    size_t rows = (size_t)table->rows;
    XXH3_64bits_update(hash, table->theta, sizeof(float) * rows);
    XXH3_64bits_update(hash, table->phi, sizeof(float) * rows);
    XXH3_64bits_update(hash, table->value, sizeof(float) * rows * (size_t)table->channels);
}

/* Distinguishes sets of the same name by what was measured at their first place. */
static uint64_t source_hash(const Measurement *set) {
    XXH3_state_t hash;
    XXH3_64bits_reset(&hash);
    if (set->has_black) hash_table(&hash, &set->black);
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < set->primary[p].level_count; i++)
            hash_table(&hash, &set->primary[p].table[i]);
    for (int i = 0; i < set->incidence_count * set->azimuth_count; i++)
        hash_table(&hash, &set->brdf[i]);
    if (set->has_spectra) XXH3_64bits_update(&hash, set->spectrum, sizeof set->spectrum);
    return XXH3_64bits_digest(&hash);
}

json_t *fit_report_measure(const FitParts *parts, const Panel *panel) {
    const Measurement *set = parts->set;
    json_t *tables = json_array();
    FitTable total = {.name = "total"};
    FitDeviations all = {0};
    char hash[32];
    json_t *out = json_pack("{s:s, s:s, s:s*, s:s*, s:s*, s:s, s:s, s:[f,f], s:[f,f], s:s}",
                            "panel", set->panel, "instrument", set->instrument, "date", set->date,
                            "operator", set->operator_name, "conditions", set->conditions, "note",
                            set->note, "source", path_name(set->file), "pixels", set->pixels[0],
                            set->pixels[1], "size_mm", set->size_mm[0], set->size_mm[1], "basis",
                            parts->options->basis == FIT_HAAR ? "haar" : "vertex");
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)source_hash(set));
    json_object_set_new(out, "source_hash_xxh3", json_string(hash));
    if (parts->emission) {
        add_emission_tables(parts, panel, tables, &total, &all.emission);
        int falling = count_falling(panel);
        if (falling)
            fit_note(parts->notes,
                     "%d codes, over directions and primaries, give less light "
                     "than the code below",
                     falling);
        json_t *emission = describe_emission(parts, &total, all.emission.excess, falling);
        json_t *azimuths = few_azimuths(emission_samples_table(set, true, 0).table);
        if (json_array_size(azimuths)) json_object_set(emission, "azimuths_deg", azimuths);
        json_decref(azimuths);
        json_object_set_new(out, "emission", emission);
        json_object_set_new(out, "outliers", flags_json(&parts->emission->outliers, true));
        json_object_set_new(out, "holes", flags_json(&parts->emission->holes, false));
    }
    if (parts->reflection) {
        add_reflection_tables(parts, panel, tables, &total, &all.reflection);
        add_reflection(parts, panel, all.reflection.excess, out);
    }
    if (json_array_size(parts->spots)) json_object_set(out, "spots", (json_t *)parts->spots);
    json_object_set_new(out, "tables", tables);
    json_object_set_new(out, "total", fit_table_json(&total));
    json_object_set_new(out, "notes", notes_json(parts->notes));
    fit_judge(parts, &all, &total, out);
    return out;
}
