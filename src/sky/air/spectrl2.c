/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/air/spectrl2.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"

typedef struct Band {
    double nm, outside;         /* W m^-2 nm^-1 at 1 au */
    double water, ozone, mixed; /* absorption coefficients */
} Band;

static const Band bands[SPECTRL2_COUNT] = {
    {300, 0.5359, 0, 10, 0},          {305, 0.5583, 0, 4.8, 0},
    {310, 0.622, 0, 2.7, 0},          {315, 0.6927, 0, 1.35, 0},
    {320, 0.7151, 0, 0.8, 0},         {325, 0.8329, 0, 0.38, 0},
    {330, 0.9619, 0, 0.16, 0},        {335, 0.9319, 0, 0.075, 0},
    {340, 0.9006, 0, 0.04, 0},        {345, 0.9113, 0, 0.019, 0},
    {350, 0.9755, 0, 0.007, 0},       {360, 0.9759, 0, 0, 0},
    {370, 1.1199, 0, 0, 0},           {380, 1.1038, 0, 0, 0},
    {390, 1.0338, 0, 0, 0},           {400, 1.4791, 0, 0, 0},
    {410, 1.7013, 0, 0, 0},           {420, 1.7404, 0, 0, 0},
    {430, 1.5872, 0, 0, 0},           {440, 1.837, 0, 0, 0},
    {450, 2.005, 0, 0.003, 0},        {460, 2.043, 0, 0.006, 0},
    {470, 1.987, 0, 0.009, 0},        {480, 2.027, 0, 0.014, 0},
    {490, 1.896, 0, 0.021, 0},        {500, 1.909, 0, 0.03, 0},
    {510, 1.927, 0, 0.04, 0},         {520, 1.831, 0, 0.048, 0},
    {530, 1.891, 0, 0.063, 0},        {540, 1.898, 0, 0.075, 0},
    {550, 1.892, 0, 0.085, 0},        {570, 1.84, 0, 0.12, 0},
    {593, 1.768, 0.075, 0.119, 0},    {610, 1.728, 0, 0.12, 0},
    {630, 1.658, 0, 0.09, 0},         {656, 1.524, 0, 0.065, 0},
    {667.6, 1.531, 0, 0.051, 0},      {690, 1.42, 0.016, 0.028, 0.15},
    {710, 1.399, 0.0125, 0.018, 0},   {718, 1.374, 1.8, 0.015, 0},
    {724.4, 1.373, 2.5, 0.012, 0},    {740, 1.298, 0.061, 0.01, 0},
    {752.5, 1.269, 0.0008, 0.008, 0}, {757.5, 1.245, 0.0001, 0.007, 0},
    {762.5, 1.223, 1e-05, 0.006, 4},  {767.5, 1.205, 1e-05, 0.005, 0.35},
    {780, 1.183, 0.0006, 0, 0},       {800, 1.148, 0.036, 0, 0},
    {816, 1.091, 1.6, 0, 0},          {823.7, 1.062, 2.5, 0, 0},
    {831.5, 1.038, 0.5, 0, 0},        {840, 1.022, 0.155, 0, 0},
    {860, 0.9987, 1e-05, 0, 0},       {880, 0.9472, 0.0026, 0, 0},
    {905, 0.8932, 7, 0, 0},           {915, 0.8682, 5, 0, 0},
    {925, 0.8297, 5, 0, 0},           {930, 0.8303, 27, 0, 0},
    {937, 0.814, 55, 0, 0},           {948, 0.7869, 45, 0, 0},
    {965, 0.7683, 4, 0, 0},           {980, 0.767, 1.48, 0, 0},
    {993.5, 0.7576, 0.1, 0, 0},       {1040, 0.6881, 1e-05, 0, 0},
    {1070, 0.6407, 0.001, 0, 0},      {1100, 0.6062, 3.2, 0, 0},
    {1120, 0.5859, 115, 0, 0},        {1130, 0.5702, 70, 0, 0},
    {1145, 0.5641, 75, 0, 0},         {1161, 0.5442, 10, 0, 0},
    {1170, 0.5334, 5, 0, 0},          {1200, 0.5016, 2, 0, 0},
    {1240, 0.4775, 0.002, 0, 0.05},   {1270, 0.4427, 0.002, 0, 0.3},
    {1290, 0.44, 0.1, 0, 0.02},       {1320, 0.4168, 4, 0, 0.0002},
    {1350, 0.3914, 200, 0, 0.00011},  {1395, 0.3589, 1000, 0, 1e-05},
    {1442.5, 0.3275, 185, 0, 0.05},   {1462.5, 0.3175, 80, 0, 0.011},
    {1477, 0.3073, 80, 0, 0.005},     {1497, 0.3004, 12, 0, 0.0006},
    {1520, 0.2928, 0.16, 0, 0},       {1539, 0.2755, 0.002, 0, 0.005},
    {1558, 0.2721, 0.0005, 0, 0.13},  {1578, 0.2593, 0.0001, 0, 0.04},
    {1592, 0.2469, 1e-05, 0, 0.06},   {1610, 0.244, 0.0001, 0, 0.13},
    {1630, 0.2435, 0.001, 0, 0.001},  {1646, 0.2348, 0.01, 0, 0.0014},
    {1678, 0.2205, 0.036, 0, 0.0001}, {1740, 0.1908, 1.1, 0, 1e-05},
    {1800, 0.1711, 130, 0, 1e-05},    {1860, 0.1445, 1000, 0, 0.0001},
    {1920, 0.1357, 500, 0, 0.001},    {1960, 0.123, 100, 0, 4.3},
    {1985, 0.1238, 4, 0, 0.2},        {2005, 0.113, 2.9, 0, 21},
    {2035, 0.1085, 1, 0, 0.13},       {2065, 0.0975, 0.4, 0, 1},
    {2100, 0.0924, 0.22, 0, 0.08},    {2148, 0.0824, 0.25, 0, 0.001},
    {2198, 0.0746, 0.33, 0, 0.00038}, {2270, 0.0683, 0.5, 0, 0.001},
    {2360, 0.0638, 4, 0, 0.0005},     {2450, 0.0495, 80, 0, 0.00015},
    {2500, 0.0485, 310, 0, 0.00014},  {2600, 0.0386, 15000, 0, 0.00066},
    {2700, 0.0366, 22000, 0, 100},    {2800, 0.032, 8000, 0, 150},
    {2900, 0.0281, 650, 0, 0.13},     {3000, 0.0248, 240, 0, 0.0095},
    {3100, 0.0221, 230, 0, 0.001},    {3200, 0.0196, 100, 0, 0.8},
    {3300, 0.0175, 120, 0, 1.9},      {3400, 0.0157, 19.5, 0, 1.3},
    {3500, 0.0141, 3.6, 0, 0.075},    {3600, 0.0127, 3.1, 0, 0.01},
    {3700, 0.0115, 2.5, 0, 0.00195},  {3800, 0.0104, 1.4, 0, 0.004},
    {3900, 0.0095, 0.17, 0, 0.29},    {4000, 0.0086, 0.0045, 0, 0.025}};

double spectrl2_nm(int i) {
    return bands[i].nm;
}

double spectrl2_read(const double *value, double nm) {
    int i = 0;
    if (nm <= bands[0].nm || nm >= bands[SPECTRL2_COUNT - 1].nm)
        return nm < bands[0].nm || nm > bands[SPECTRL2_COUNT - 1].nm
                   ? 0
                   : value[nm > bands[0].nm ? SPECTRL2_COUNT - 1 : 0];
    while (bands[i + 1].nm < nm) i++;
    return value[i] +
           (value[i + 1] - value[i]) * (nm - bands[i].nm) / (bands[i + 1].nm - bands[i].nm);
}

double air_mass(double apparent_zenith_deg) {
    return 1 / (cos_d(radians_from_degrees(apparent_zenith_deg)) +
                0.50572 * pow_d(96.07995 - apparent_zenith_deg, -1.6364));
}

double aerosol_depth_from_turbidity(double turbidity) {
    double beta = 0.04608365822050 * turbidity - 0.04586025928522;
    return fmax(0, beta) * pow_d(0.5, -1.3);
}

/* Transmittances of a path of relative air mass m. */
typedef struct Passing {
    double rayleigh, water, ozone, mixed;
    double aerosol, scattered, absorbed; /* of aerosol: all, by scattering alone, absorption */
} Passing;

static Passing passing(const Band *band, const Air *air, double m, double ozone_mass) {
    double um = band->nm / 1000, um2 = um * um, pressed = m * air->pressure_mbar / 1013;
    double depth = air->aerosol_depth * pow_d(band->nm / 500, -air->aerosol_power);
    double ln = log_d(band->nm / 400), albedo = 0.945 * exp_d(-0.095 * ln * ln);
    double water = band->water * air->water_cm * m, mixed = band->mixed * pressed;
    return (Passing){.rayleigh = exp_d(-pressed / (um2 * um2 * (115.6406 - 1.3366 / um2))),
                     .water = exp_d(-0.2385 * water / pow_d(1 + 20.07 * water, 0.45)),
                     .ozone = exp_d(-band->ozone * air->ozone_atm_cm * ozone_mass),
                     .mixed = exp_d(-1.41 * mixed / pow_d(1 + 118.3 * mixed, 0.45)),
                     .aerosol = exp_d(-depth * m),
                     .scattered = exp_d(-albedo * depth * m),
                     .absorbed = exp_d(-(1 - albedo) * depth * m)};
}

/* Share of aerosol scattering that goes down, for the sun's cosine (asymmetry 0.65). */
static double downward_share(double cosine) {
    double g = log_d(1 - 0.65);
    double a = g * (1.459 + g * (0.1595 + 0.4129 * g));
    double b = g * (0.0783 + g * (-0.3824 - 0.5874 * g));
    return 1 - 0.5 * exp_d((a + b * cosine) * cosine);
}

/* Reflectance of the air for light from below: everything at air mass 1.8. */
static double air_reflectance(const Band *band, const Air *air) {
    Passing p = passing(band, air, 1.8, 1.8);
    return p.mixed * p.water * p.absorbed *
           (0.5 * (1 - p.rayleigh) +
            (1 - downward_share(1 / 1.8)) * p.rayleigh * (1 - p.scattered));
}

static double diffuse_at(const Band *band, const Air *air, const Passing *p, double cosine,
                         double outside, double direct) {
    double share = downward_share(cosine),
           common = outside * cosine * p->ozone * p->mixed * p->water * p->absorbed;
    double rayleigh = common * 0.5 * (1 - pow_d(p->rayleigh, 0.95));
    double aerosol = common * pow_d(p->rayleigh, 1.5) * (1 - p->scattered) * share;
    double back = air_reflectance(band, air) * air->ground_albedo;
    double ground = (direct * cosine + rayleigh + aerosol) * back / (1 - back);
    double lift = band->nm <= 450 ? pow_d((band->nm + 550) / 1000, 1.8) : 1;
    return (rayleigh + aerosol + ground) * lift;
}

Spectrl2 spectrl2(const Air *air, double apparent_zenith_deg, double distance_factor) {
    Spectrl2 out = {{0}, {0}, {0}};
    double cosine = cos_d(radians_from_degrees(apparent_zenith_deg));
    double m = air_mass(fmin(apparent_zenith_deg, 90));
    double layer = 22 / 6370.0; /* ozone stands 22 km high */
    double ozone_mass = (1 + layer) / sqrt(cosine * cosine + 2 * layer);
    for (int i = 0; i < SPECTRL2_COUNT; i++) {
        out.outside[i] = bands[i].outside * distance_factor;
        if (cosine <= 0) continue;
        Passing p = passing(&bands[i], air, m, ozone_mass);
        out.direct[i] = out.outside[i] * p.rayleigh * p.aerosol * p.water * p.ozone * p.mixed;
        out.diffuse[i] = diffuse_at(&bands[i], air, &p, cosine, out.outside[i], out.direct[i]);
    }
    return out;
}

void spectrl2_gases(const Air *air, double apparent_zenith_deg,
                    double passing_gases[SPECTRL2_COUNT]) {
    double m = air_mass(fmin(apparent_zenith_deg, 90));
    for (int i = 0; i < SPECTRL2_COUNT; i++) {
        Passing p = passing(&bands[i], air, m, m);
        passing_gases[i] = p.water * p.mixed;
    }
}

double spectrl2_total(const double *value) {
    double sum = 0;
    for (int i = 1; i < SPECTRL2_COUNT; i++)
        sum += 0.5 * (value[i] + value[i - 1]) * (bands[i].nm - bands[i - 1].nm);
    return sum;
}
