/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/judge_reach.h"

#include <math.h>

#include "base/units.h"
#include "panel/fit/judge_limits.h"

#define NAMED 8 /* incidences that a reason names */

/* Tables of one kind of doubt, and what they leave open together. */
typedef struct Doubt {
    int    count;
    double incidence[MEASUREMENT_INCIDENCES_MAX]; /* degrees, each once */
    double mirror[2], haze[2], fwhm[2], step;
    bool   has_model;
} Doubt;

static Doubt no_doubt(void)
{
    return (Doubt){.mirror = {1, 0}, .haze = {1e30, 0}, .fwhm = {1e30, 0}, .has_model = true};
}

static void widen(double range[2], const double other[2])
{
    range[0] = fmin(range[0], other[0]);
    range[1] = fmax(range[1], other[1]);
}

static void add_table(Doubt *doubt, double incidence, const PeakMirror *peak)
{
    double degrees = degrees_from_radians(incidence);
    bool   is_new = true;
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
static const char *incidences_text(const Doubt *doubt, Arena *arena)
{
    const char *text = "";
    int shown = doubt->count < NAMED ? doubt->count : NAMED;
    for (int i = 0; i < shown; i++)
        text = arena_format(arena, "%s%s%.4g", text,
                            !i ? "" : i + 1 == doubt->count ? " and " : ", ",
                            doubt->incidence[i]);
    return arena_format(arena, "%s%s degrees", text, doubt->count > shown ? " and more" : "");
}

/* How far apart rows should be, and how far around the mirror direction: three in the width of
 * what is looked for, and never more than three in that of the image. */
static const char *advice_text(double width, double fwhm, Arena *arena)
{
    double step = fmax(0.05, fmin(width, fwhm) / 3);
    return arena_format(arena, "the BRDF every %.1g degrees within %.2g degrees of the mirror "
                        "direction", step, 4 * fwhm);
}

static void judge_mirror(Judge *judge, const Doubt *doubt, double fwhm_deg)
{
    Arena arena = *judge->arena;
    judge_reason_add(judge, JUDGE_CARE, JUDGE_COARSE "with light from %s the samples, "
                     "%.2g degrees apart, do not tell the mirror's image (%.2g degrees wide) "
                     "from what is narrow in the haze: mirrors of %.2g to %.2g are possible: "
                     "measure the specular reflectance there, or %s",
                     incidences_text(doubt, &arena), degrees_from_radians(doubt->step),
                     fwhm_deg, doubt->mirror[0], doubt->mirror[1],
                     advice_text(fwhm_deg, fwhm_deg, &arena));
}

static void judge_haze(Judge *judge, const Doubt *doubt, double fwhm_deg)
{
    Arena  arena = *judge->arena;
    double width = degrees_from_radians(doubt->fwhm[0]);
    if (!doubt->has_model) return;
    judge_reason_add(judge, JUDGE_CARE, JUDGE_COARSE "with light from %s the haze may be "
                     "%.3g to %.3g sr^-1 in the mirror direction and %.2g to %.2g degrees "
                     "wide at half of it, for the samples are %.2g degrees apart and the "
                     "instrument's image is %.2g wide: measure %s",
                     incidences_text(doubt, &arena), doubt->haze[0], doubt->haze[1], width,
                     degrees_from_radians(doubt->fwhm[1]), degrees_from_radians(doubt->step),
                     fwhm_deg, advice_text(width, fwhm_deg, &arena));
}

static json_t *range_json(const double range[2])
{
    return json_pack("[f,f]", range[0], range[1]);
}

static void keep_figures(Judge *judge, const Measurement *set, const PeakMirror *peak)
{
    json_t *list = json_array();
    for (int i = 0; i < set->incidence_count; i++) {
        const PeakRange *range = &peak[i].range;
        if (peak[i].source != PEAK_OPEN && !peak[i].has_haze_open) continue;
        json_t *one = json_pack("{s:f, s:f, s:o}", "incidence_deg",
                                degrees_from_radians(set->incidence[i]), "step_deg",
                                degrees_from_radians(peak[i].spacing.widest), "mirror",
                                range_json(range->mirror));
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

static void judge_specular(Judge *judge, const Measurement *set)
{
    if (set->specular && !(set->instrument_fwhm_deg > 0))
        judge_reason_add(judge, JUDGE_CARE, JUDGE_COARSE "the specular measurement is not "
                         "used, for without the instrument's width the mirror's image cannot "
                         "be taken out of the samples: declare it (instrument_fwhm_deg)");
}

/* ---- rows left out ----------------------------------------------------------------------- */

static void judge_held_out(Judge *judge, const FitParts *parts)
{
    const ReflectionResult *r = parts->reflection;
    const Measurement      *set = parts->set;
    int worst = 0;
    for (int t = 1; t < r->parts.tables; t++)
        if (r->held_out[t].estimate > r->held_out[worst].estimate) worst = t;
    const HeldOut *most = &r->held_out[worst];
    if (!(most->estimate > JUDGE_HELD_OUT_CARE)) return;
    double degrees = degrees_from_radians(set->incidence[worst % set->incidence_count]);
    PeakSpacing spacing = peak_spacing_find(&r->parts.haze[worst],
                                            set->incidence[worst % set->incidence_count],
                                            *judge->arena);
    judge_reason_add(judge, JUDGE_CARE, JUDGE_COARSE "every second ring or azimuth left out "
                     "near the mirror direction is missed by %.2g %% (light from %.4g degrees, "
                     "theta %.4g, phi %.4g): with all of them, %.2g degrees apart, the panel "
                     "may miss by %.2g %% between them, wanted at most %.0f %%: measure the "
                     "BRDF every %.1g degrees there", 100 * most->error, degrees,
                     degrees_from_radians(most->theta), degrees_from_radians(most->phi),
                     degrees_from_radians(spacing.widest), 100 * most->estimate,
                     100 * JUDGE_HELD_OUT_CARE, 0.5 * degrees_from_radians(spacing.widest));
    json_object_set_new(judge->figures, "held_out_error", json_real(most->error));
}

/* Compares the panel with the fitted haze between the tables' rows. */
static void judge_between(Judge *judge, const FitParts *parts)
{
    const ReflectionResult *r = parts->reflection;
    const Measurement      *set = parts->set;
    int worst = 0;
    for (int t = 1; t < r->parts.tables; t++)
        if (r->held_out[t].between > r->held_out[worst].between) worst = t;
    if (!(r->held_out[worst].between > JUDGE_HELD_OUT_CARE)) return;
    judge_reason_add(judge, JUDGE_CARE, JUDGE_COARSE "between the samples near the mirror "
                     "direction the panel differs from the fitted haze by %.2g %% (light from "
                     "%.4g degrees), wanted at most %.0f %%: measure the BRDF in finer steps "
                     "there, or ask for a smaller bound (--max-error)",
                     100 * r->held_out[worst].between,
                     degrees_from_radians(set->incidence[worst % set->incidence_count]),
                     100 * JUDGE_HELD_OUT_CARE);
}

void judge_reach(Judge *judge, const FitParts *parts)
{
    const Measurement     *set = parts->set;
    const ReflectionParts *of = &parts->reflection->parts;
    Doubt mirror = no_doubt(), haze = no_doubt();
    judge_specular(judge, set);
    judge_held_out(judge, parts);
    judge_between(judge, parts);
    if (!of->peak) return;
    for (int t = 0; t < of->tables; t++) {
        double incidence = set->incidence[t % set->incidence_count];
        if (of->peak[t].source == PEAK_OPEN) add_table(&mirror, incidence, &of->peak[t]);
        if (of->peak[t].has_haze_open) add_table(&haze, incidence, &of->peak[t]);
    }
    if (mirror.count) judge_mirror(judge, &mirror, set->instrument_fwhm_deg);
    if (haze.count) judge_haze(judge, &haze, set->instrument_fwhm_deg);
    keep_figures(judge, set, of->peak);
}
