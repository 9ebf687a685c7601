/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/fit_judge.h"

#include <math.h>
#include <string.h>

#include "panel/fit/judge_limits.h"
#include "panel/fit/judge_reach.h"
#include "panel/fit/judge_set.h"

static const char *const words[] = {"good", "usable with care", "not usable"};

static void add_figure(Judge *judge, const char *key, double value)
{
    json_object_set_new(judge->figures, key, json_real(value));
}

/* ---- errors ----------------------------------------------------------------------------- */

/* One kind of tables, emission or reflection. */
typedef struct JudgedKind {
    const char      *name, *advice;
    const FitErrors *errors;
    double           bound;
} JudgedKind;

static double excess_rms(const FitErrors *e)
{
    return sqrt(e->excess_squares / fmax(1, e->count));
}

/* Samples that all miss by little (a white that reads 1.02 and is held to what it got) are no
 * other panel. */
static void judge_beyond(Judge *judge, const JudgedKind *kind)
{
    const FitErrors *e = kind->errors;
    double share = e->beyond / fmax(1, e->count);
    JudgeGrade grade = judge_reason_grade(share, JUDGE_BEYOND_CARE, JUDGE_BEYOND_UNUSABLE);
    if (grade == JUDGE_UNUSABLE && excess_rms(e) < JUDGE_RMS_CARE) grade = JUDGE_CARE;
    if (grade > JUDGE_GOOD)
        judge_reason_add(judge, grade, "%s: %.3g %% of the samples (%.0f of %.0f) miss the "
                         "bound of %.2g %% beside the noise: %s", kind->name, 100 * share,
                         e->beyond, e->count, 100 * fmax(kind->bound, JUDGE_LEAST_BOUND),
                         kind->advice);
}

static void judge_rms(Judge *judge, const JudgedKind *kind)
{
    const FitErrors *e = kind->errors;
    double rms = excess_rms(e);
    JudgeGrade grade = judge_reason_grade(rms, JUDGE_RMS_CARE, JUDGE_RMS_UNUSABLE);
    if (grade > JUDGE_GOOD)
        judge_reason_add(judge, grade, "%s: the error is %.3g %% rms beside the noise, wanted "
                         "at most %.0f %%: %s", kind->name, 100 * rms, 100 * JUDGE_RMS_CARE,
                         kind->advice);
}

static void judge_kind(Judge *judge, const JudgedKind *kind)
{
    const FitErrors *e = kind->errors;
    if (!(e->count > 0)) return;
    judge_beyond(judge, kind);
    judge_rms(judge, kind);
    json_object_set_new(judge->figures, kind->name, json_pack("{s:f, s:f}", "beyond_share",
        e->beyond / e->count, "rms_beside_noise", sqrt(e->excess_squares / e->count)));
}

static void judge_errors(Judge *judge, const FitParts *parts, const FitDeviations *all)
{
    if (parts->emission) {
        JudgedKind kind = {"emission", "measure steep parts in finer steps of theta and phi or "
            "see with panel plot --measured which tables disagree", &all->emission,
            parts->emission->tolerance};
        judge_kind(judge, &kind);
    }
    if (parts->reflection) {
        JudgedKind kind = {"reflection", "measure the peak in finer steps, declare the "
            "instrument's width (instrument_fwhm_deg), or give more azimuths of the light",
            &all->reflection, parts->reflection->bound};
        judge_kind(judge, &kind);
    }
}

static void judge_integral(Judge *judge, const FitTable *total)
{
    JudgeGrade grade = judge_reason_grade(total->integral_error, JUDGE_INTEGRAL_CARE,
                                JUDGE_INTEGRAL_UNUSABLE);
    add_figure(judge, "integral_error", total->integral_error);
    if (grade > JUDGE_GOOD)
        judge_reason_add(judge, grade, "a table's hemispherical integral (luminous flux or "
                         "albedo) is missed by %.3g %%, wanted at most %.0f %%: see which "
                         "table in panel info, and check its unit and its outliers "
                         "(--mask-outliers)", 100 * total->integral_error, 100 *
                         JUDGE_INTEGRAL_CARE);
}

/* ---- noise, outliers, energy ------------------------------------------------------------- */

static void judge_noise(Judge *judge, const FitTable *total)
{
    JudgeGrade grade = judge_reason_grade(total->noise, JUDGE_NOISE_CARE, JUDGE_NOISE_UNUSABLE);
    add_figure(judge, "noise", total->noise);
    if (grade > JUDGE_GOOD)
        judge_reason_add(judge, grade, "the noisiest table has %.3g %% of noise, wanted at "
                         "most %.0f %%: measure longer or average repeated measurements", 100 *
                         total->noise, 100 * JUDGE_NOISE_CARE);
}

static void judge_outliers(Judge *judge, const FitParts *parts)
{
    double rows = 0;
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < parts->set->primary[p].level_count; i++)
            rows += parts->set->primary[p].table[i].rows;
    double share = parts->emission->outlier_count / fmax(1, rows);
    JudgeGrade grade = judge_reason_grade(share, JUDGE_OUTLIERS_CARE, JUDGE_OUTLIERS_UNUSABLE);
    if (grade > JUDGE_GOOD)
        judge_reason_add(judge, grade, "emission: %.3g %% of the samples stand out of their "
                         "neighbours and are not followed: a noisy instrument, or columns "
                         "that are mixed up", 100 * share);
}

static void judge_zeros(Judge *judge, const FitParts *parts)
{
    const ReflectionResult *r = parts->reflection;
    double values = 0;
    for (int t = 0; t < r->parts.tables; t++)
        values += (double)r->parts.kept[t].rows * r->parts.kept[t].channels;
    double share = r->masked / fmax(1, values);
    JudgeGrade grade = judge_reason_grade(share, JUDGE_ZEROS_CARE, JUDGE_ZEROS_UNUSABLE);
    if (grade > JUDGE_GOOD)
        judge_reason_add(judge, grade, "reflection: %.3g %% of the values are zero or "
                         "negative and say nothing: check the sign and the dark measurement",
                         100 * share);
}

static void judge_albedo(Judge *judge, const FitParts *parts)
{
    double albedo = parts->reflection->section.largest_albedo;
    JudgeGrade grade = judge_reason_grade(albedo, JUDGE_ALBEDO_CARE, JUDGE_ALBEDO_UNUSABLE);
    add_figure(judge, "largest_albedo", albedo);
    if (grade > JUDGE_GOOD)
        judge_reason_add(judge, grade, "reflection: the tables say that %.4g times the light "
                         "comes back (albedo; cut to 0.995), wanted at most 1: check the unit "
                         "(panel import --unit brdf, brdf-cos or factor)", albedo);
    if (albedo < JUDGE_ALBEDO_LEAST)
        judge_reason_add(judge, JUDGE_CARE, "reflection: at most %.2g of the light comes back "
                         "(albedo), less than from the blackest coatings: check the unit "
                         "(panel import --unit brdf, brdf-cos or factor)", albedo);
}

/* ---- the verdict ------------------------------------------------------------------------- */

static void start(Judge *judge, Arena *arena)
{
    *judge = (Judge){.figures = json_object(), .arena = arena};
    for (int g = 0; g < 3; g++) judge->reasons[g] = json_array();
}

/* The measurement could not see what it was asked for. */
static bool has_coarse(const json_t *reasons)
{
    size_t  i;
    json_t *one;
    json_array_foreach((json_t *)reasons, i, one)
        if (!strncmp(json_string_value(one), JUDGE_COARSE, strlen(JUDGE_COARSE))) return true;
    return false;
}

/* The worst first. */
static void finish(Judge *judge, json_t *report)
{
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
               json_t *report)
{
    Arena scratch = *parts->notes->arena;
    Judge judge;
    start(&judge, &scratch);
    if (parts->emission) {
        judge_set_levels(&judge, parts->set);
        judge_outliers(&judge, parts);
    }
    if (parts->reflection) {
        judge_albedo(&judge, parts);
        judge_zeros(&judge, parts);
        judge_reach(&judge, parts);
    }
    judge_errors(&judge, parts, all);
    judge_integral(&judge, total);
    judge_noise(&judge, total);
    judge_set_azimuths(&judge, parts->set);
    finish(&judge, report);
}

JudgeGrade fit_judge_grade(const json_t *report)
{
    const char *verdict = json_string_value(json_object_get(report, "verdict"));
    for (int g = JUDGE_UNUSABLE; verdict && g > JUDGE_GOOD; g--)
        if (!strcmp(verdict, words[g])) return (JudgeGrade)g;
    return JUDGE_GOOD;
}
