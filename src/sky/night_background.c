/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/night_background.h"

#include <math.h>

#include "base/count.h"
#include "base/units.h"
#include "spectrum/photometry.h"

#define ZENITH_CD_M2 2.3e-4
#define LAYER 0.96    /* (R / (R + h))^2 of van Rhijn's layer, 130 km high */
#define AIRGLOW 145.0 /* of 220 */
#define OTHERS 75.0
#define LINE_HALF_NM 15.0
#define CONTINUUM 0.5 /* of the airglow's luminance */
#define STEPS 2000

static const struct {
    double nm, rayleigh;
} lines[] = {{557.7, 250}, {589.3, 50}, {630, 60}};

static void scale_to_luminance(Curve *curve, double wanted) {
    double found = luminance_cd_m2(curve->value, CURVE_COUNT, CURVE_FIRST_NM, 1);
    for (int i = 0; i < CURVE_COUNT; i++) curve->value[i] *= (float)(wanted / found);
}

/* Triangles of equal photons per rayleigh: energy goes as one over the wavelength. */
static void add_lines(Curve *out) {
    for (int k = 0; k < COUNT_OF(lines); k++)
        for (int i = 0; i < CURVE_COUNT; i++) {
            double apart = fabs(CURVE_FIRST_NM + i - lines[k].nm) / LINE_HALF_NM;
            out->value[i] += (float)(fmax(0, 1 - apart) * lines[k].rayleigh / lines[k].nm);
        }
}

static Curve spectrum_of(const Curve *sun) {
    Curve glow = {{0}}, even, out = *sun;
    add_lines(&glow);
    for (int i = 0; i < CURVE_COUNT; i++) even.value[i] = 1;
    double share = AIRGLOW / (AIRGLOW + OTHERS);
    scale_to_luminance(&glow, share * (1 - CONTINUUM));
    scale_to_luminance(&even, share * CONTINUUM);
    scale_to_luminance(&out, 1 - share);
    for (int i = 0; i < CURVE_COUNT; i++) out.value[i] += glow.value[i] + even.value[i];
    return out;
}

static float sky_luminance(const NightBackground *b, float cosine) {
    float thick = 1 / sqrtf(1 - (float)LAYER * (1 - cosine * cosine));
    return b->zenith_cd_m2 * thick * exp_f(-b->depth * thick);
}

NightBackground night_background(const NightBackgroundInput *input) {
    NightBackground b = {.zenith_cd_m2 = (float)ZENITH_CD_M2,
                         .depth = (float)input->depth,
                         .horizon = (float)input->horizon,
                         .curve = spectrum_of(input->sun)};
    for (int i = 0; i < STEPS; i++) {
        double cosine = (i + 0.5) / STEPS;
        b.horizontal_lx += 2 * PI * cosine / STEPS * (double)sky_luminance(&b, (float)cosine);
    }
    b.floor_cd_m2 = (float)(input->floor_albedo / PI * b.horizontal_lx);
    return b;
}

float night_background_luminance(const NightBackground *background, float elevation) {
    float sine, cosine;
    if (elevation < background->horizon) return background->floor_cd_m2;
    sincos_turns(elevation * (0.5f * INV_PI_F), &sine, &cosine);
    return sky_luminance(background, sine > 0 ? sine : 0);
}
