/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/metrics/deltae.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"
#include "compare/metrics/lab.h"
#include "compare/metrics/rank.h"

/* c^7 / (c^7 + 25^7) */
static double seventh_power_share(double c) {
    double c2 = c * c, c7 = c2 * c2 * c2 * c;
    return c7 / (c7 + 6103515625.0);
}

typedef struct Polar {
    double chroma, hue_deg; /* 0 <= hue < 360 */
} Polar;

static Polar polar_of(double a, double b) {
    double degrees = degrees_from_radians(atan2_d(b, a));
    return (Polar){sqrt(a * a + b * b), degrees < 0 ? degrees + 360 : degrees};
}

static double cos_deg(double degrees) {
    return cos_d(radians_from_degrees(degrees));
}

static double sin_deg(double degrees) {
    return sin_d(radians_from_degrees(degrees));
}

/* From the first hue to the second by the shorter way, -180 .. 180. */
static double hue_step_deg(Polar first, Polar second) {
    double step = second.hue_deg - first.hue_deg;
    return step > 180 ? step - 360 : step < -180 ? step + 360 : step;
}

/* Half way along the shorter arc. */
static double mean_hue_deg(Polar first, Polar second) {
    double sum = first.hue_deg + second.hue_deg;
    if (fabs(first.hue_deg - second.hue_deg) <= 180) return sum / 2;
    return sum < 360 ? (sum + 360) / 2 : (sum - 360) / 2;
}

/* Sharma, Wu, Dalal, equations 2 to 22. Hues 180 degrees apart are where the formula jumps.
 * A grey has no hue; none of the terms with one is left then, since dh is 0. */
double deltae_2000(const double reference[3], const double test[3]) {
    const double *r = reference, *t = test;
    double mean_chroma = (sqrt(r[1] * r[1] + r[2] * r[2]) + sqrt(t[1] * t[1] + t[2] * t[2])) / 2;
    double stretch = 1 + 0.5 * (1 - sqrt(seventh_power_share(mean_chroma)));
    Polar pr = polar_of(stretch * r[1], r[2]), pt = polar_of(stretch * t[1], t[2]);

    double lightness = (r[0] + t[0]) / 2, chroma = (pr.chroma + pt.chroma) / 2;
    double hue = mean_hue_deg(pr, pt);
    double dl = t[0] - r[0], dc = pt.chroma - pr.chroma;
    double dh = 2 * sqrt(pr.chroma * pt.chroma) * sin_deg(hue_step_deg(pr, pt) / 2);

    double from_grey = (lightness - 50) * (lightness - 50);
    double hue_shape = 1 - 0.17 * cos_deg(hue - 30) + 0.24 * cos_deg(2 * hue) +
                       0.32 * cos_deg(3 * hue + 6) - 0.20 * cos_deg(4 * hue - 63);
    dl /= 1 + 0.015 * from_grey / sqrt(20 + from_grey);
    dc /= 1 + 0.045 * chroma;
    dh /= 1 + 0.015 * chroma * hue_shape;

    double from_blue = (hue - 275) / 25;
    double turn =
        -2 * sqrt(seventh_power_share(chroma)) * sin_deg(60 * exp_d(-from_blue * from_blue));
    return sqrt(dl * dl + dc * dc + dh * dh + turn * dc * dh);
}

static double pixel_difference(const ColourMatrix *from_rgb, const float reference[3],
                               const float test[3]) {
    double lab_reference[3], lab_test[3];
    if (!memcmp(reference, test, 3 * sizeof *test)) return 0;
    lab_from_rgb(from_rgb, reference, lab_reference);
    lab_from_rgb(from_rgb, test, lab_test);
    return deltae_2000(lab_reference, lab_test);
}

void deltae_map(const Planes *reference, const Planes *test, float *map) {
    const ColourMatrix from_rgb = relative_to_white(xyz_from_primaries(REC709_CHROMATICITIES));
    for (size_t i = 0; i < planes_pixel_count(reference); i++) {
        const float r[3] = {reference->rgb[0][i], reference->rgb[1][i], reference->rgb[2][i]};
        const float t[3] = {test->rgb[0][i], test->rgb[1][i], test->rgb[2][i]};
        map[i] = (float)pixel_difference(&from_rgb, r, t);
    }
}

MapSummary deltae_pictures(const Planes *reference, const Planes *test, PixelMask mask,
                           float *map) {
    deltae_map(reference, test, map);
    return map_summary(map, planes_pixel_count(reference), mask);
}
