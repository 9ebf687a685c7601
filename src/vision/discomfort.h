/* SPDX-License-Identifier: Apache-2.0 */
/* discomfort.h -- figures of glare that disturbs without hiding anything. Secondary ones here:
 * they were fitted to rooms with windows and luminaires, not to cockpits in the sun.
 *
 * All weigh luminance more than solid angle, so that small bright sources (the sun, its glints)
 * count for more than people report. Print them with the smallest solid angle among the
 * sources; never let them decide.
 *
 * A source     is what is brighter than a threshold and hangs together. Its luminance is the
 *              mean over it, its position index the root of the mean of 1/P^2 (GlareSum). A
 *              source of one luminance may be cut into pieces: UGR and DGP stay the same, DGI,
 *              which is not linear in the solid angle, rises. Sources of different luminances
 *              that are counted as one give less than apart.
 * Background   is all light that comes from elsewhere: its vertical illuminance over pi.
 * None         see GlareNone.
 *
 * Units    cd m^-2, sr, lx.
 * Threads  pure functions; sources are only read.
 * Fails    never: NaN where a figure has no meaning.
 */
#pragma once
#include <stdbool.h>

/* What counts as a source, and which corrections apply. */
typedef struct GlareSettings {
    double threshold_cd_m2; /* what is brighter is a source; */
    double task_factor;     /* above 0: the threshold is this times the task's luminance */
    double task_deg;        /* full width of the cone about the line of sight that is it */
    double peak_cd_m2;      /* what is brighter is a source apart from what surrounds it */
    bool low_light;         /* DGP times discomfort_dgp_low_light */
} GlareSettings;

/* evalglare's (NREL/Radiance): -b 2000, peaks of 50,000 cd/m2; but the low-light factor is on,
 * which evalglare applies on request alone from version 2.14 on. CIE 147's rule for small
 * sources does not apply, as CIE 117 and evalglare do without. The task's width counts with a
 * task factor only. */
#define GLARE_THRESHOLD_CD_M2 2000.0
#define GLARE_TASK_DEG 40.0
#define GLARE_PEAK_CD_M2 50000.0
#define GLARE_SETTINGS_DEFAULT {GLARE_THRESHOLD_CD_M2, 0, GLARE_TASK_DEG, GLARE_PEAK_CD_M2, true}

/* task_cd_m2: the task's mean luminance; not used without a task factor. */
double glare_threshold(const GlareSettings *settings, double task_cd_m2);

typedef struct GlareSource {
    double luminance_cd_m2;
    double solid_angle_sr;
    double position_index; /* position_index, at least 1 */
} GlareSource;

/* ---- a source from its pieces ------------------------------------------------------------ */

/* Start with zeros. */
typedef struct GlareSum {
    double sr;
    double cd_sr_m2;  /* luminance over it */
    double lx;        /* on the pupil's plane */
    double weight_sr; /* of 1/P^2 */
} GlareSum;

/* A piece so small that luminance and direction are those of its middle; right, up, forward: of
 * length 1, position_index's axes. What lies behind the pupil's plane adds nothing. */
void glare_sum_add(GlareSum *sum, double luminance_cd_m2, double sr, double right, double up,
                   double forward);

/* The sum has a solid angle. */
GlareSource glare_sum_source(const GlareSum *sum);

/* ---- figures ----------------------------------------------------------------------------- */

/* What an eye sees. */
typedef struct GlareView {
    const GlareSource *sources;
    int count;
    double source_lx;     /* of the sources on the pupil's plane, */
    double background_lx; /* and of all else: both are sums of their own, no difference */
} GlareView;

/* Why UGR is NaN. */
typedef enum GlareNone {
    GLARE_HAS_UGR,
    GLARE_NO_SOURCE,     /* nothing is brighter than the threshold: UGR and DGI are NaN; DGP is
                            the illuminance's alone */
    GLARE_NO_BACKGROUND, /* all light comes from sources, as from an even field above the
                            threshold or from a lamp in the dark: nothing for UGR to compare
                            with; DGP and DGI are there */
    GLARE_NO_LIGHT       /* all three are NaN */
} GlareNone;

typedef struct GlareFigures {
    GlareNone none;
    double background_cd_m2;
    double ugr, dgp, dgi; /* UGR and DGI of weak sources may be below 0 */
} GlareFigures;

GlareFigures discomfort_figures(const GlareSettings *settings, const GlareView *view);

/* "no source is brighter than the threshold", ...; NULL of GLARE_HAS_UGR. */
const char *discomfort_none_words(GlareNone none);

/* Unified Glare Rating, CIE 117-1995: 8 log10(0.25/Lb sum L^2 w/P^2). background_cd_m2: Lb, the
 * vertical illuminance at the eye without that of the sources, over pi. Without any source
 * -infinity; NaN without a background. */
double discomfort_ugr(double background_cd_m2, const GlareSource *sources, int count);

/* Daylight Glare Probability: 5.87e-5 Ev + 0.092 log10(1 + sum L^2 w/(Ev^1.87 P^2)) + 0.159, at
 * most 1. Ev: vertical illuminance at the eye, all light. J. Wienold and J. Christoffersen,
 * Energy and Buildings 38 (2006) 743. Below 0.35 imperceptible, 0.40 perceptible, 0.45
 * disturbing, above it intolerable. */
double discomfort_dgp(double vertical_lx, const GlareSource *sources, int count);

/* The factor of evalglare (NREL/Radiance) on it below 1000 lx:
 * exp(0.024 Ev - 4)/(1 + exp(0.024 Ev - 4)); 1 from there on. */
double discomfort_dgp_low_light(double vertical_lx);

/* Daylight Glare Index, R. G. Hopkinson, "Glare from daylighting in buildings", Applied
 * Ergonomics 3 (1972) 206, as evalglare has it:
 * 10 log10 sum 0.478 L^1.6 Omega^0.8/(Lb + 0.07 w^0.5 L), Omega = w/P^2. 16 just perceptible,
 * 20 just acceptable, 24 just uncomfortable, 28 just intolerable. Without any source
 * -infinity; a background of 0 is allowed. */
double discomfort_dgi(double background_cd_m2, const GlareSource *sources, int count);

/* ---- how much less a source disturbs that is not looked at -------------------------------
 *
 * 1 on the line of sight, more away from it, at most 16. Angles in degrees.
 *
 * Source   above the line of sight S. K. Guth, "A method for the evaluation of discomfort
 *          glare", Illum. Eng. 58 (1963) 351; below it T. Iwata and M. Tokura, "Position index
 *          for a glare source located below the line of vision", Light. Res. Technol. 29 (1997)
 *          172. Both as evalglare of NREL's Radiance has them.
 *          They do not meet at the horizontal: at 30 degrees beside the line of sight 1.468
 *          from above and 1.462 from below, at 50 degrees 2.340 and 2.430. Nor is the second
 *          without a jump of its own, at R/D = 0.6, from 1.48 to 1.72. */

#define POSITION_INDEX_MAX 16.0

/* Guth. tau_deg: angle of the plane through line of sight and source from the vertical, 0 above
 * to 90 beside; sigma_deg: angle of the source from the line of sight, 0 to 90. */
double position_index_above(double tau_deg, double sigma_deg);

/* Iwata and Tokura. R is how far the source lies from the line of sight, D how far away it is
 * along it: R/D = tan sigma, counted as 3 where it is more. sigma_deg: 0 to 180. */
double position_index_below(double sigma_deg);

/* The index of a source in a direction of any length, in the head's axes: `forward` along the
 * line of sight, `up` perpendicular to it. At the height of the line of sight it counts as
 * above; what lies behind the eyes has POSITION_INDEX_MAX. */
double position_index(double right, double up, double forward);
