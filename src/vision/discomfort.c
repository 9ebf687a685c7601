/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/discomfort.h"

#include <math.h>
#include <stddef.h>

#include "base/mathd.h"
#include "base/units.h"

#define DGP_LOW_LIGHT_BELOW_LX 1000.0

/* ---- sources ----------------------------------------------------------------------------- */

double glare_threshold(const GlareSettings *settings, double task_cd_m2) {
    return settings->task_factor > 0 ? settings->task_factor * task_cd_m2
                                     : settings->threshold_cd_m2;
}

void glare_sum_add(GlareSum *sum, double luminance_cd_m2, double sr, double right, double up,
                   double forward) {
    double p = position_index(right, up, forward);
    if (!(forward > 0)) return;
    sum->sr += sr;
    sum->cd_sr_m2 += luminance_cd_m2 * sr;
    sum->lx += luminance_cd_m2 * sr * forward;
    sum->weight_sr += sr / (p * p);
}

GlareSource glare_sum_source(const GlareSum *sum) {
    return (GlareSource){sum->cd_sr_m2 / sum->sr, sum->sr, sqrt(sum->sr / sum->weight_sr)};
}

/* ---- figures ----------------------------------------------------------------------------- */

static double squared(const GlareSource *source) {
    return source->luminance_cd_m2 * source->luminance_cd_m2 * source->solid_angle_sr;
}

/* NaN when an index is none. */
static double over_index(const GlareSource *source, double value) {
    double p = source->position_index;
    return p >= 1 ? value / (p * p) : NAN;
}

double discomfort_ugr(double background_cd_m2, const GlareSource *sources, int count) {
    double sum = 0;
    if (!(background_cd_m2 > 0)) return NAN;
    for (int i = 0; i < count; i++) sum += over_index(&sources[i], squared(&sources[i]));
    return 8 * log10_d(0.25 / background_cd_m2 * sum);
}

double discomfort_dgp_low_light(double vertical_lx) {
    if (vertical_lx >= DGP_LOW_LIGHT_BELOW_LX) return 1;
    return 1 / (1 + exp_d(4 - 0.024 * vertical_lx)); /* the same with one exponential */
}

double discomfort_dgp(double vertical_lx, const GlareSource *sources, int count) {
    double sum = 0;
    if (!(vertical_lx > 0)) return NAN;
    for (int i = 0; i < count; i++) sum += over_index(&sources[i], squared(&sources[i]));
    double adapted = pow_d(vertical_lx, 1.87);
    double dgp = 5.87e-5 * vertical_lx + 0.092 * log10_d(1 + sum / adapted) + 0.159;
    return dgp < 1 || isnan(dgp) ? dgp : 1;
}

double discomfort_dgi(double background_cd_m2, const GlareSource *sources, int count) {
    double sum = 0;
    for (int i = 0; i < count; i++) {
        const GlareSource *s = &sources[i];
        double behind = background_cd_m2 + 0.07 * sqrt(s->solid_angle_sr) * s->luminance_cd_m2;
        double seen = pow_d(over_index(s, s->solid_angle_sr), 0.8);
        sum += 0.478 * pow_d(s->luminance_cd_m2, 1.6) * seen / behind;
    }
    return 10 * log10_d(sum);
}

static GlareNone none_of(const GlareView *view) {
    if (!(view->source_lx + view->background_lx > 0)) return GLARE_NO_LIGHT;
    if (!view->count) return GLARE_NO_SOURCE;
    return view->background_lx > 0 ? GLARE_HAS_UGR : GLARE_NO_BACKGROUND;
}

GlareFigures discomfort_figures(const GlareSettings *settings, const GlareView *view) {
    double lux = view->source_lx + view->background_lx;
    GlareFigures f = {none_of(view), view->background_lx / PI, NAN, NAN, NAN};
    if (f.none == GLARE_NO_LIGHT) return f;
    f.dgp = discomfort_dgp(lux, view->sources, view->count);
    if (settings->low_light) f.dgp *= discomfort_dgp_low_light(lux);
    if (f.none == GLARE_NO_SOURCE) return f;
    f.dgi = discomfort_dgi(f.background_cd_m2, view->sources, view->count);
    f.ugr = discomfort_ugr(f.background_cd_m2, view->sources, view->count);
    return f;
}

const char *discomfort_none_words(GlareNone none) {
    static const char *const WORDS[] = {
        [GLARE_HAS_UGR] = NULL,
        [GLARE_NO_SOURCE] = "no source is brighter than the threshold",
        [GLARE_NO_BACKGROUND] = "all light comes from sources: there is no background",
        [GLARE_NO_LIGHT] = "no light comes to the eye"};
    return WORDS[none];
}

/* ---- the position index ------------------------------------------------------------------ */

static double limited(double index) {
    return index < POSITION_INDEX_MAX ? index : POSITION_INDEX_MAX;
}

double position_index_above(double tau_deg, double sigma_deg) {
    double t = tau_deg, s = sigma_deg;
    double linear = (35.2 - 0.31889 * t - 1.22 * exp_d(-2 * t / 9)) * 1e-3;
    double square = (21 + 0.26667 * t - 0.002963 * t * t) * 1e-5;
    return limited(exp_d(linear * s + square * s * s));
}

double position_index_below(double sigma_deg) {
    double ratio = sigma_deg < 90 ? tan_d(radians_from_degrees(sigma_deg)) : 3;
    if (ratio > 3) ratio = 3;
    return 1 + (ratio < 0.6 ? 0.8 : 1.2) * ratio;
}

double position_index(double right, double up, double forward) {
    double beside = hypot_d(right, up);
    if (!(forward > 0)) return POSITION_INDEX_MAX;
    double sigma = degrees_from_radians(atan2_d(beside, forward));
    if (up < 0) return position_index_below(sigma);
    return position_index_above(degrees_from_radians(atan2_d(fabs(right), up)), sigma);
}
