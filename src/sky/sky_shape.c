/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/sky_shape.h"

#include <math.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/units.h"

SkyShape sky_shape_cie(int type) {
    static const double table[15][5] = {
        {4, -0.7, 0, -1, 0},        {4, -0.7, 2, -1.5, 0.15},  {1.1, -0.8, 0, -1, 0},
        {1.1, -0.8, 2, -1.5, 0.15}, {0, -1, 0, -1, 0},         {0, -1, 2, -1.5, 0.15},
        {0, -1, 5, -2.5, 0.3},      {0, -1, 10, -3, 0.45},     {-1, -0.55, 2, -1.5, 0.15},
        {-1, -0.55, 5, -2.5, 0.3},  {-1, -0.55, 10, -3, 0.45}, {-1, -0.32, 10, -3, 0.45},
        {-1, -0.32, 16, -3, 0.3},   {-1, -0.15, 16, -3, 0.3},  {-1, -0.15, 24, -2.8, 0.15}};
    if (type == 16) return (SkyShape){.linear = 2};
    const double *row = table[type - 1];
    return (SkyShape){row[0], row[1], row[2], row[3], row[4], exp_d(row[3] * PI / 2), 0};
}

/* Coefficients of a, b, c, d, e for eight ranges of clearness. */
static const double perez_table[8][5][4] = {{{1.3525, -0.2576, -0.2690, -1.4366},
                                             {-0.7670, 0.0007, 1.2734, -0.1233},
                                             {2.8000, 0.6004, 1.2375, 1.0000},
                                             {1.8734, 0.6297, 0.9738, 0.2809},
                                             {0.0356, -0.1246, -0.5718, 0.9938}},
                                            {{-1.2219, -0.7730, 1.4148, 1.1016},
                                             {-0.2054, 0.0367, -3.9128, 0.9156},
                                             {6.9750, 0.1774, 6.4477, -0.1239},
                                             {-1.5798, -0.5081, -1.7812, 0.1080},
                                             {0.2624, 0.0672, -0.2190, -0.4285}},
                                            {{-1.1000, -0.2515, 0.8952, 0.0156},
                                             {0.2782, -0.1812, -4.5000, 1.1766},
                                             {24.7219, -13.0812, -37.7000, 34.8438},
                                             {-5.0000, 1.5218, 3.9229, -2.6204},
                                             {-0.0156, 0.1597, 0.4199, -0.5562}},
                                            {{-0.5484, -0.6654, -0.2672, 0.7117},
                                             {0.7234, -0.6219, -5.6812, 2.6297},
                                             {33.3389, -18.3000, -62.2500, 52.0781},
                                             {-3.5000, 0.0016, 1.1477, 0.1062},
                                             {0.4659, -0.3296, -0.0876, -0.0329}},
                                            {{-0.6000, -0.3566, -2.5000, 2.3250},
                                             {0.2937, 0.0496, -5.6812, 1.8415},
                                             {21.0000, -4.7656, -21.5906, 7.2492},
                                             {-3.5000, -0.1554, 1.4062, 0.3988},
                                             {0.0032, 0.0766, -0.0656, -0.1294}},
                                            {{-1.0156, -0.3670, 1.0078, 1.4051},
                                             {0.2875, -0.5328, -3.8500, 3.3750},
                                             {14.0000, -0.9999, -7.1406, 7.5469},
                                             {-3.4000, -0.1078, -1.0750, 1.5702},
                                             {-0.0672, 0.4016, 0.3017, -0.4844}},
                                            {{-1.0000, 0.0211, 0.5025, -0.5119},
                                             {-0.3000, 0.1922, 0.7023, -1.6317},
                                             {19.0000, -5.0000, 1.2438, -1.9094},
                                             {-4.0000, 0.0250, 0.3844, 0.2656},
                                             {1.0468, -0.3788, -2.4517, 1.4656}},
                                            {{-1.0500, 0.0289, 0.4260, 0.3590},
                                             {-0.3250, 0.1156, 0.7781, 0.0025},
                                             {31.0625, -14.5000, -46.1148, 55.3750},
                                             {-7.2312, 0.4050, 13.3500, 0.6234},
                                             {1.5000, -0.6426, 1.8564, 0.5636}}};

static int clearness_bin(double clearness) {
    static const double upper[7] = {1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2};
    int bin = 0;
    while (bin < 7 && clearness >= upper[bin]) bin++;
    return bin;
}

/* Earth's distance (Spencer 1971, as in SPECTRL2). */
static double distance_factor(int day) {
    double b = 2 * PI * (day - 1) / 365;
    return 1.00011 + 0.034221 * cos_d(b) + 0.00128 * sin_d(b) + 0.000719 * cos_d(2 * b) +
           0.000077 * sin_d(2 * b);
}

static PerezState perez_state(const PerezInput *in) {
    double z = in->sun_zenith, k = 1.041 * z * z * z;
    PerezState s = {.air_mass =
                        1 / (cos_d(z) + 0.15 * pow_d(93.885 - degrees_from_radians(z), -1.253))};
    s.clearness =
        ((in->diffuse_horizontal_w_m2 + in->direct_normal_w_m2) / in->diffuse_horizontal_w_m2 + k) /
        (1 + k);
    s.clearness = fmin(12.0099, fmax(1, s.clearness));
    s.brightness = in->diffuse_horizontal_w_m2 * s.air_mass / (1367 * distance_factor(in->day));
    s.brightness = fmin(0.6, fmax(0.01, s.brightness));
    s.bin = clearness_bin(s.clearness) + 1;
    return s;
}

bool sky_shape_perez(const PerezInput *input, SkyShape *out, PerezState *state, Error *err) {
    if (!(input->diffuse_horizontal_w_m2 > 0) || !(input->direct_normal_w_m2 >= 0))
        return error_set(err, ERROR_INPUT,
                         "a Perez sky wants a diffuse irradiance above 0 and a "
                         "direct one of at least 0 W/m2, found %g and %g",
                         input->diffuse_horizontal_w_m2, input->direct_normal_w_m2);
    PerezState s = perez_state(input);
    bool is_between = s.clearness > 1.065 && s.clearness < 2.8;
    double z = input->sun_zenith, v[5];
    double delta = is_between ? fmax(0.2, s.brightness) : s.brightness;
    const double(*row)[4] = perez_table[s.bin - 1];
    for (int i = 0; i < 5; i++)
        v[i] = row[i][0] + row[i][1] * z + delta * (row[i][2] + row[i][3] * z);
    if (s.bin == 1) {
        v[2] = exp_d(pow_d(delta * (row[2][0] + row[2][1] * z), row[2][2])) - row[2][3];
        v[3] = -exp_d(delta * (row[3][0] + row[3][1] * z)) + row[3][2] + delta * row[3][3];
    }
    /* An infinite luminance at the horizon, of a bright sun within its last degrees: the fit's
     * range is left, its gradation held flat. */
    bool is_sky = v[1] <= 0 || 1 + v[0] > 0.1;
    v[1] = fmin(0, v[1]);
    if (state) *state = s;
    *out = (SkyShape){v[0], v[1], v[2], v[3], v[4], 0, 0};
    return is_sky || error_set(err, ERROR_INPUT,
                               "the irradiances %g and %g W/m2 are outside of Perez's skies: "
                               "their luminance has no finite gradation",
                               input->direct_normal_w_m2, input->diffuse_horizontal_w_m2);
}

static double gradation(const SkyShape *shape, double cos_theta) {
    return 1 + shape->a * exp_d(shape->b / fmax(cos_theta, 1e-6));
}

static double indicatrix(const SkyShape *shape, double gamma) {
    double c = cos_d(gamma);
    return 1 + shape->c * (exp_d(shape->d * gamma) - shape->offset) + shape->e * c * c;
}

double sky_shape_value(const SkyShape *shape, double cos_theta, double gamma) {
    if (shape->linear > 0) return (1 + shape->linear * cos_theta) / 3;
    return fmax(0, gradation(shape, cos_theta) * indicatrix(shape, gamma));
}

float sky_shape_at(const SkyShape *shape, float cos_theta, float gamma) {
    float sine, c;
    if (shape->linear > 0) return (1 + (float)shape->linear * cos_theta) * (1 / 3.0f);
    sincos_turns(gamma * (0.5f * INV_PI_F), &sine, &c);
    float gradation = 1 + (float)shape->a * exp_f((float)shape->b / max_f(cos_theta, 1e-6f));
    float indicatrix = 1 +
                       (float)shape->c * (exp_f((float)shape->d * gamma) - (float)shape->offset) +
                       (float)shape->e * c * c;
    return max_f(0, gradation * indicatrix);
}

/* Over half a turn of azimuth at one zenith angle; what is the same all along, found once. */
static double ring_integral(const SkyShape *shape, double theta, double sun_zenith, int steps) {
    double sum = 0, turn = PI / steps, cos_theta = cos_d(theta);
    double along = cos_theta * cos_d(sun_zenith), across = sin_d(theta) * sin_d(sun_zenith);
    double graded = shape->linear > 0 ? 0 : gradation(shape, cos_theta);
    for (int j = 0; j < steps; j++) {
        double cosine = along + across * cos_d((j + 0.5) * turn);
        double gamma = acos_d(fmax(-1, fmin(1, cosine)));
        sum += shape->linear > 0 ? sky_shape_value(shape, cos_theta, gamma)
                                 : fmax(0, graded * indicatrix(shape, gamma));
    }
    return sum;
}

/* Midpoints; the azimuth over half a turn, since the sky is symmetric about the sun's. */
double sky_shape_integral(const SkyShape *shape, double sun_zenith, int steps) {
    double sum = 0, step = PI / 2 / steps, turn = PI / steps;
    for (int i = 0; i < steps; i++) {
        double theta = (i + 0.5) * step, ring = ring_integral(shape, theta, sun_zenith, steps);
        sum += ring * cos_d(theta) * (sin_d(theta) * 2 * sin_d(step / 2)) * 2 * turn;
    }
    return sum;
}
