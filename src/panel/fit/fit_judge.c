/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/fit_judge.h"

#include <math.h>
#include <string.h>

#include "base/units.h"
#include "panel/fit/judge_reason.h"
#include "panel/fit/judge_set.h"

static const char *const words[] = {"good", "usable with care", "not usable"};

static void add_figure(Judge *judge, const char *key, double value) {
    json_object_set_new(judge->figures, key, json_real(value));
}

/* ---- errors ----------------------------------------------------------------------------- */

/* One kind of tables, emission or reflection. */
typedef struct JudgedKind {
    const char *name, *advice;
    const FitErrors *errors;
    double bound;
} JudgedKind;

static double excess_rms(const FitErrors *e) {
    return sqrt(e->excess_squares / fmax(1, e->count));
}

/* Samples that all miss by little (a white that reads 1.02 and is held to what it got) are no
 * other panel. */
static void judge_beyond(Judge *judge, const JudgedKind *kind) {
    const FitErrors *e = kind->errors;
    double share = e->beyond / fmax(1, e->count);
    JudgeGrade grade = judge_reason_grade(share, JUDGE_BEYOND_CARE, JUDGE_BEYOND_UNUSABLE);
    if (grade == JUDGE_UNUSABLE && excess_rms(e) < JUDGE_RMS_CARE) grade = JUDGE_CARE;
    judge_reason_add(judge, grade,
                     "%s: %.3g %% of the samples (%.0f of %.0f) miss the bound "
                     "of %.2g %% beside the noise: %s",
                     kind->name, 100 * share, e->beyond, e->count,
                     100 * fmax(kind->bound, JUDGE_LEAST_BOUND), kind->advice);
}

static void judge_rms(Judge *judge, const JudgedKind *kind) {
    const FitErrors *e = kind->errors;
    double rms = excess_rms(e);
    JudgeGrade grade = judge_reason_grade(rms, JUDGE_RMS_CARE, JUDGE_RMS_UNUSABLE);
    judge_reason_add(judge, grade,
                     "%s: the error is %.3g %% rms beside the noise, required: "
                     "at most %.0f %%: %s",
                     kind->name, 100 * rms, 100 * JUDGE_RMS_CARE, kind->advice);
}

static void judge_kind(Judge *judge, const JudgedKind *kind) {
    const FitErrors *e = kind->errors;
    if (!(e->count > 0)) return;
    judge_beyond(judge, kind);
    judge_rms(judge, kind);
    json_object_set_new(judge->figures, kind->name,
                        json_pack("{s:f, s:f}", "beyond_share", e->beyond / e->count,
                                  "rms_beside_noise", excess_rms(e)));
}

static void judge_errors(Judge *judge, const FitParts *parts, const FitDeviations *all) {
    if (parts->emission) {
        JudgedKind kind = {"emission",
                           "measure steep parts in finer steps of theta and phi or "
                           "see with panel plot --measured which tables disagree",
                           &all->emission,
                           fit_required_bound(parts->options, parts->emission->model->tolerance)};
        judge_kind(judge, &kind);
    }
    if (parts->reflection) {
        JudgedKind kind = {
            "reflection",
            "measure the peak in finer steps, declare the "
            "instrument's width (--instrument-fwhm), or give more azimuths of the light",
            &all->reflection, fit_required_bound(parts->options, parts->reflection->model->bound)};
        judge_kind(judge, &kind);
    }
}

static void judge_integral(Judge *judge, const FitTable *total) {
    JudgeGrade grade =
        judge_reason_grade(total->integral_error, JUDGE_INTEGRAL_CARE, JUDGE_INTEGRAL_UNUSABLE);
    add_figure(judge, "integral_error", total->integral_error);
    judge_reason_add(judge, grade,
                     "a table's hemispherical integral (luminous flux or "
                     "albedo) is missed by %.3g %%, required: at most %.0f %%: see which "
                     "table in panel info, and check its unit and its "
                     "outliers",
                     100 * total->integral_error, 100 * JUDGE_INTEGRAL_CARE);
}

/* ---- noise, outliers, energy ------------------------------------------------------------- */

static void judge_noise(Judge *judge, const FitTable *total) {
    JudgeGrade grade = judge_reason_grade(total->noise, JUDGE_NOISE_CARE, JUDGE_NOISE_UNUSABLE);
    add_figure(judge, "noise", total->noise);
    judge_reason_add(judge, grade,
                     "the noisiest table has %.3g %% of noise, required: at "
                     "most %.0f %%: measure longer or average repeated measurements",
                     100 * total->noise, 100 * JUDGE_NOISE_CARE);
}

static void judge_outliers(Judge *judge, const FitParts *parts) {
    double rows = 0;
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < parts->set->primary[p].level_count; i++)
            rows += parts->set->primary[p].table[i].rows;
    double share = parts->emission->outlier_count / fmax(1, rows);
    JudgeGrade grade = judge_reason_grade(share, JUDGE_OUTLIERS_CARE, JUDGE_OUTLIERS_UNUSABLE);
    judge_reason_add(judge, grade,
                     "emission: %.3g %% of the samples stand out of their "
                     "neighbours and are not followed: a noisy instrument, or columns "
                     "that are mixed up",
                     100 * share);
    if (!parts->emission->shared) return;
    const EmissionFlag *at = &parts->emission->shared_first;
    judge_reason_add(
        judge, JUDGE_CARE,
        JUDGE_COARSE "emission: %d %s in every table far from "
                     "all neighbours (theta %.4g, phi %.4g%s) and %s not followed: a defect of "
                     "the instrument, or a peak narrower than the samples are apart: measure "
                     "there again in finer steps",
        parts->emission->shared, parts->emission->shared == 1 ? "direction is" : "directions are",
        degrees_from_radians(at->theta), degrees_from_radians(at->phi),
        parts->emission->shared == 1 ? "" : " and others",
        parts->emission->shared == 1 ? "is" : "are");
}

static void judge_zeros(Judge *judge, const FitParts *parts) {
    const ReflectionResult *r = parts->reflection;
    double values = 0;
    for (int t = 0; t < r->parts.tables; t++)
        values += (double)r->parts.haze[t].rows * r->parts.haze[t].channels;
    double share = r->model->masked / fmax(1, values);
    JudgeGrade grade = judge_reason_grade(share, JUDGE_ZEROS_CARE, JUDGE_ZEROS_UNUSABLE);
    judge_reason_add(judge, grade,
                     "reflection: %.3g %% of the values are zero or "
                     "negative and say nothing: check the sign and the dark measurement",
                     100 * share);
}

static void judge_albedo(Judge *judge, const FitParts *parts) {
    double albedo = parts->reflection->section.largest_albedo;
    JudgeGrade grade = judge_reason_grade(albedo, JUDGE_ALBEDO_CARE, JUDGE_ALBEDO_UNUSABLE);
    add_figure(judge, "largest_albedo", albedo);
    judge_reason_add(judge, grade,
                     "reflection: the tables say that %.4g times the light "
                     "comes back (albedo; cut to 0.995), required: at most 1: check the unit "
                     "(panel import --unit brdf, brdf-cos or factor)",
                     albedo);
    if (albedo < JUDGE_ALBEDO_LEAST)
        judge_reason_add(judge, JUDGE_CARE,
                         "reflection: at most %.2g of the light comes back "
                         "(albedo), less than from the blackest coatings: check the unit "
                         "(panel import --unit brdf, brdf-cos or factor)",
                         albedo);
}

/* ---- what the instrument could not see --------------------------------------------------- */

/* Mirrors and lobes narrower than its image and the steps of its directions. Every reason
 * begins with "coarse: " and ends with what to measure; the report's "judged" has the ranges as
 * "coarse". */

#define NAMED 8 /* incidences that a reason names */

/* Tables of one kind of doubt, and what they leave open together. */
typedef struct Doubt {
    int count;
    double incidence[MEASUREMENT_INCIDENCES_MAX]; /* degrees, each once */
    double mirror[2], haze[2], fwhm[2], step;
    bool has_model;
} Doubt;

static Doubt no_doubt(void) {
    return (Doubt){.mirror = {1, 0}, .haze = {1e30, 0}, .fwhm = {1e30, 0}, .has_model = true};
}

static void widen(double range[2], const double other[2]) {
    range[0] = fmin(range[0], other[0]);
    range[1] = fmax(range[1], other[1]);
}

static void add_table(Doubt *doubt, double incidence, const PeakMirror *peak) {
    double degrees = degrees_from_radians(incidence);
    bool is_new = true;
    for (int i = 0; i < doubt->count; i++) is_new &= fabs(doubt->incidence[i] - degrees) > 1e-6;
    if (is_new && doubt->count < MEASUREMENT_INCIDENCES_MAX)
        doubt->incidence[doubt->count++] = degrees;
    widen(doubt->mirror, peak->range.mirror);
    doubt->has_model &= peak->range.has_model;
    if (peak->range.has_model) {
        widen(doubt->haze, peak->range.haze);
        widen(doubt->fwhm, peak->range.fwhm);
    }
    doubt->step = fmax(doubt->step, peak->spacing.widest);
}

/* "10, 20 and 30 degrees". */
static const char *incidences_text(const Doubt *doubt, Arena *arena) {
    const char *text = "";
    int shown = doubt->count < NAMED ? doubt->count : NAMED;
    for (int i = 0; i < shown; i++)
        text = arena_format(arena, "%s%s%.4g", text,
                            !i                      ? ""
                            : i + 1 == doubt->count ? " and "
                                                    : ", ",
                            doubt->incidence[i]);
    return arena_format(arena, "%s%s degrees", text, doubt->count > shown ? " and more" : "");
}

/* How far apart rows should be, and how far around the mirror direction: three in the width of
 * what is looked for, and never more than three in that of the image. */
static const char *advice_text(double width, double fwhm, Arena *arena) {
    double step = fmax(0.05, fmin(width, fwhm) / 3);
    return arena_format(arena,
                        "the BRDF every %.1g degrees within %.2g degrees of the mirror "
                        "direction",
                        step, 4 * fwhm);
}

static void judge_mirror(Judge *judge, const Doubt *doubt, double fwhm_deg, bool has_specular) {
    Arena arena = *judge->arena;
    judge_reason_add(
        judge, JUDGE_CARE,
        JUDGE_COARSE "with light from %s the samples, "
                     "%.2g degrees apart, do not tell the mirror's image (%.2g degrees wide) "
                     "from what is narrow in the haze: mirrors of %.2g to %.2g are possible%s: "
                     "measure %s%s",
        incidences_text(doubt, &arena), degrees_from_radians(doubt->step), fwhm_deg,
        doubt->mirror[0], doubt->mirror[1], has_specular ? " also by the specular measurement" : "",
        has_specular ? "" : "the specular reflectance there, or ",
        advice_text(fwhm_deg, fwhm_deg, &arena));
}

static void judge_haze(Judge *judge, const Doubt *doubt, double fwhm_deg) {
    Arena arena = *judge->arena;
    double width = degrees_from_radians(doubt->fwhm[0]);
    if (!doubt->has_model) return;
    judge_reason_add(judge, JUDGE_CARE,
                     JUDGE_COARSE
                     "with light from %s the haze may be "
                     "%.3g to %.3g sr^-1 in the mirror direction and %.2g to %.2g degrees "
                     "wide at half of it, for the samples are %.2g degrees apart and the "
                     "instrument's image is %.2g wide: measure %s",
                     incidences_text(doubt, &arena), doubt->haze[0], doubt->haze[1], width,
                     degrees_from_radians(doubt->fwhm[1]), degrees_from_radians(doubt->step),
                     fwhm_deg, advice_text(width, fwhm_deg, &arena));
}

static json_t *range_json(const double range[2]) {
    return json_pack("[f,f]", range[0], range[1]);
}

static void keep_figures(Judge *judge, const Measurement *set, const PeakMirror *peak) {
    json_t *list = json_array();
    for (int i = 0; i < set->incidence_count; i++) {
        const PeakRange *range = &peak[i].range;
        if (peak[i].source != PEAK_OPEN && !peak[i].has_haze_open) continue;
        json_t *one = json_pack(
            "{s:f, s:f, s:o}", "incidence_deg", degrees_from_radians(set->incidence[i]), "step_deg",
            degrees_from_radians(peak[i].spacing.widest), "mirror", range_json(range->mirror));
        if (range->has_model) {
            double fwhm[2] = {degrees_from_radians(range->fwhm[0]),
                              degrees_from_radians(range->fwhm[1])};
            json_object_set_new(one, "haze_sr", range_json(range->haze));
            json_object_set_new(one, "haze_fwhm_deg", range_json(fwhm));
        }
        json_array_append_new(list, one);
    }
    if (json_array_size(list)) json_object_set(judge->figures, "coarse", list);
    json_decref(list);
}

/* What was measured is taken, or the status says that it was not. */
static void judge_specular(Judge *judge, const FitParts *parts) {
    const Measurement *set = parts->set;
    Arena arena = *judge->arena;
    Twice worst;
    if (reflection_parts_twice(set, &parts->reflection->parts, &worst) && twice_differ(&worst))
        judge_reason_add(judge, JUDGE_CARE,
                         "%s: check the aperture (--specular-aperture), the unit and the "
                         "instrument's width (--instrument-fwhm)",
                         twice_text(&worst, &arena));
    if (!set->specular || parts->reflection->parts.peak) return;
    json_object_set_new(judge->figures, JUDGE_LEFT_OUT, json_true());
    judge_reason_add(judge, JUDGE_CARE,
                     JUDGE_COARSE
                     "the specular measurement is not used: the samples may hold the mirror's "
                     "image, which cannot be taken out of them without the instrument's width: "
                     "give it as --instrument-fwhm DEG, to panel import or panel fit");
}

/* ---- rows left out ----------------------------------------------------------------------- */

static void judge_held_out(Judge *judge, const FitParts *parts) {
    const ReflectionResult *r = parts->reflection;
    const Measurement *set = parts->set;
    int worst = 0;
    for (int t = 1; t < r->parts.tables; t++)
        if (r->held_out[t].estimate > r->held_out[worst].estimate) worst = t;
    const HeldOut *most = &r->held_out[worst];
    if (!(most->estimate > JUDGE_HELD_OUT_CARE)) return;
    double incidence = set->incidence[worst % set->incidence_count];
    double degrees = degrees_from_radians(incidence);
    PeakSpacing spacing = peak_window_spacing(&r->parts.haze[worst], incidence, *judge->arena);
    double widest = degrees_from_radians(spacing.widest);
    judge_reason_add(judge, JUDGE_CARE,
                     JUDGE_COARSE
                     "every second ring or azimuth left out "
                     "near the mirror direction is missed by %s %% (light from %.4g degrees, "
                     "theta %.4g, phi %.4g): with all of them, %s degrees apart, the panel may "
                     "miss by %s %% between them, required <= %.0f %%: measure the BRDF every "
                     "%s degrees there",
                     judge_rounded(judge, 100 * most->error), degrees,
                     degrees_from_radians(most->theta), degrees_from_radians(most->phi),
                     judge_rounded(judge, widest), judge_rounded(judge, 100 * most->estimate),
                     100 * JUDGE_HELD_OUT_CARE, judge_rounded(judge, 0.5 * widest));
    json_object_set_new(judge->figures, "held_out_error", json_real(most->error));
}

/* Samples that are no grid. key: of the figures; what: which table. */
static void judge_gaps(Judge *judge, const char *key, const char *what, const ScatterGaps *gaps) {
    double light = gaps->light / JUDGE_HELD_OUT_CARE, worst = gaps->worst / JUDGE_GAP_CARE;
    double most = fmin(JUDGE_GAP_CARE, gaps->worst / fmax(1, light));
    double phi = degrees_from_radians(gaps->phi) + (gaps->phi < 0 ? 360 : 0);
    json_object_set_new(judge->figures, key,
                        json_pack("{s:f, s:f}", "light", gaps->light, "worst", gaps->worst));
    if (!(fmax(light, worst) > 1)) return;
    judge_reason_add(
        judge, JUDGE_CARE,
        JUDGE_COARSE "%s: no sample lies within %s degrees of "
                     "theta %.4g, phi %.4g, and values around it change so much that the panel "
                     "may miss by %s %% there, required <= %.0f %%, and by %s %% of the light "
                     "over all gaps, required <= %.0f %% (as samples are missed that others "
                     "predict): measure every %s degrees there",
        what, judge_rounded(judge, degrees_from_radians(gaps->gap)),
        degrees_from_radians(gaps->theta), phi, judge_rounded(judge, 100 * gaps->worst),
        100 * JUDGE_GAP_CARE, judge_rounded(judge, 100 * gaps->light), 100 * JUDGE_HELD_OUT_CARE,
        judge_rounded(judge, degrees_from_radians(scatter_gaps_step(gaps, most))));
}

/* Of tables that are no grid: the one that may be missed most. */
static void judge_scattered(Judge *judge, const FitParts *parts) {
    const HeldOut *held_out = parts->reflection->held_out;
    const Measurement *set = parts->set;
    Arena arena = *judge->arena;
    int worst = -1;
    double most = -1;
    for (int t = 0; t < parts->reflection->parts.tables; t++) {
        const ScatterGaps *gaps = &held_out[t].gaps;
        double cost = fmax(gaps->worst, gaps->light * JUDGE_GAP_CARE / JUDGE_HELD_OUT_CARE);
        if (held_out[t].is_scattered && cost > most) most = cost, worst = t;
    }
    if (worst < 0) return;
    double incidence = degrees_from_radians(set->incidence[worst % set->incidence_count]);
    Judge behind = *judge;
    behind.arena = &arena;
    const char *what = arena_format(&arena, "light from %.4g degrees", incidence);
    judge_gaps(&behind, "reflection_between_samples", what, &held_out[worst].gaps);
    judge->grade = behind.grade;
}

/* Noise of a table's samples, relative, rms. */
static double table_spread(const ReflectionParts *parts, int t, int wavelengths) {
    const AngleTable *table = &parts->haze[t];
    double squares = 0;
    int count = 0;
    for (int i = 0; i < table->rows; i++) {
        double f = (double)table->value[(size_t)i * (size_t)wavelengths + (size_t)wavelengths / 2];
        double noise = reflection_parts_noise(parts, t, f);
        if (!(f > 0) || noise > 1) continue; /* dark: held above a floor */
        squares += noise * noise;
        count++;
    }
    return sqrt(squares / fmax(1, count));
}

/* What looks like noise in scattered samples is pardoned: structure that is finer than the
 * samples cannot be told from it. */
static void judge_spread(Judge *judge, const FitParts *parts) {
    const ReflectionResult *r = parts->reflection;
    const Measurement *set = parts->set;
    double most = -1;
    int worst = 0;
    for (int t = 0; t < r->parts.tables; t++) {
        double spread =
            r->held_out[t].is_scattered ? table_spread(&r->parts, t, set->wavelength_count) : -1;
        if (spread > most) most = spread, worst = t;
    }
    if (most < 0) return;
    add_figure(judge, "reflection_spread", most);
    if (!(most > JUDGE_SPREAD_CARE)) return;
    judge_reason_add(judge, JUDGE_CARE,
                     JUDGE_COARSE
                     "light from %.4g degrees: the samples "
                     "scatter by %.2g %% rms about what their neighbours say, required <= "
                     "%.0f %%; errors within that are taken for noise, and may be structure "
                     "finer than the samples: measure in half the steps (structure is then "
                     "followed), or again (repeated directions show the noise)",
                     degrees_from_radians(set->incidence[worst % set->incidence_count]), 100 * most,
                     100 * JUDGE_SPREAD_CARE);
}

/* With none left out the steps of the light's azimuth are half as wide. A pattern that neighbours
 * nearly resolve is then missed by a quarter, one that they do not by a half. */
static void judge_light_azimuths(Judge *judge, const FitParts *parts) {
    double missed = reflection_held_out_azimuths(parts->reflection->model);
    double estimate = missed / (missed > 0.5 ? 2 : 4);
    if (!(estimate > JUDGE_HELD_OUT_CARE)) return;
    judge_reason_add(judge, JUDGE_CARE,
                     JUDGE_COARSE
                     "reflection: each azimuth of the light left out, its neighbours miss %s %% "
                     "of what is sent back: with all of them, %.3g degrees apart, the panel may "
                     "miss by %s %% between them, required <= %.0f %%: measure at more azimuths "
                     "of the light",
                     judge_rounded(judge, 100 * missed), 360.0 / parts->set->azimuth_count,
                     judge_rounded(judge, 100 * estimate), 100 * JUDGE_HELD_OUT_CARE);
}

static void judge_reach(Judge *judge, const FitParts *parts) {
    const Measurement *set = parts->set;
    const ReflectionParts *of = &parts->reflection->parts;
    Doubt mirror = no_doubt(), haze = no_doubt();
    judge_specular(judge, parts);
    judge_held_out(judge, parts);
    judge_scattered(judge, parts);
    judge_light_azimuths(judge, parts);
    if (!of->peak) return;
    for (int t = 0; t < of->tables; t++) {
        double incidence = set->incidence[t % set->incidence_count];
        if (of->peak[t].source == PEAK_OPEN) add_table(&mirror, incidence, &of->peak[t]);
        if (of->peak[t].has_haze_open) add_table(&haze, incidence, &of->peak[t]);
    }
    if (mirror.count) judge_mirror(judge, &mirror, set->instrument_fwhm_deg, set->specular);
    if (haze.count) judge_haze(judge, &haze, set->instrument_fwhm_deg);
    keep_figures(judge, set, of->peak);
}

/* ---- the verdict ------------------------------------------------------------------------- */

static void start(Judge *judge, Arena *arena) {
    *judge = (Judge){.figures = json_object(), .arena = arena};
    for (int g = 0; g < 3; g++) judge->reasons[g] = json_array();
}

/* The measurement could not see what is required of it. */
static bool has_coarse(const json_t *reasons) {
    size_t i;
    json_t *one;
    json_array_foreach((json_t *)reasons, i, one) if (!strncmp(json_string_value(one), JUDGE_COARSE,
                                                               strlen(JUDGE_COARSE))) return true;
    return false;
}

/* The worst first. */
static void finish(Judge *judge, json_t *report) {
    json_array_extend(judge->reasons[JUDGE_UNUSABLE], judge->reasons[JUDGE_CARE]);
    json_object_set_new(report, "verdict", json_string(words[judge->grade]));
    json_object_set_new(report, "reasons", judge->reasons[JUDGE_UNUSABLE]);
    json_object_set_new(report, "judged", judge->figures);
    if (has_coarse(json_object_get(report, "reasons")))
        json_object_set_new(report, "coarse", json_true());
    json_decref(judge->reasons[JUDGE_GOOD]);
    json_decref(judge->reasons[JUDGE_CARE]);
}

void fit_judge(const FitParts *parts, const FitDeviations *all, const FitTable *total,
               json_t *report) {
    Arena scratch = *parts->notes->arena;
    Judge judge;
    start(&judge, &scratch);
    if (parts->emission) {
        judge_set_levels(&judge, parts->set);
        judge_outliers(&judge, parts);
        judge_gaps(&judge, "emission_between_samples", "emission", &parts->emission->gaps);
    }
    if (parts->reflection) {
        judge_albedo(&judge, parts);
        judge_zeros(&judge, parts);
        judge_reach(&judge, parts);
        judge_spread(&judge, parts);
    }
    judge_errors(&judge, parts, all);
    judge_integral(&judge, total);
    judge_noise(&judge, total);
    judge_set_azimuths(&judge, parts->set);
    finish(&judge, report);
}

JudgeGrade fit_judge_grade(const json_t *report) {
    const char *verdict = json_string_value(json_object_get(report, "verdict"));
    for (int g = JUDGE_UNUSABLE; verdict && g > JUDGE_GOOD; g--)
        if (!strcmp(verdict, words[g])) return (JudgeGrade)g;
    return JUDGE_GOOD;
}
