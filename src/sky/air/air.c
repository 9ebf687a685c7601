/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/air/air.h"

#include <math.h>
#include <stdbool.h>

#include "base/mathd.h"
#include "base/units.h"

const float AIR_NM[SPECTRUM_LANES] = {360, 380, 400, 420, 445, 470, 500, 530,
                                      560, 590, 620, 650, 680, 715, 760, 830};

#define STRATOSPHERIC_DEPTH 0.006 /* of aerosol at 500 nm, years after an eruption */
#define AEROSOL_SCALE_M 1500.0
#define LAYER_M 20000.0
#define LAYER_WIDTH_M 3000.0

/* SPECTRL2's ozone absorption, (atm cm)^-1, at AIR_NM. */
static const double ozone_absorption[SPECTRUM_LANES] = {
    0,      0,      0,     0,      0.0015, 0.009,  0.03,   0.063,
    0.1025, 0.1191, 0.105, 0.0696, 0.0382, 0.0161, 0.0065, 0};

AirOptics air_optics(const Air *air) {
    AirOptics o = {{spectrum_all(0)}, {spectrum_all(0)}, 0, AIR_TOP_M};
    double layer = fmin(STRATOSPHERIC_DEPTH, air->aerosol_depth);
    o.aerosol_low = air->aerosol_depth > 0 ? 1 - layer / air->aerosol_depth : 0;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        double nm = (double)AIR_NM[i], um2 = nm * nm * 1e-6, ln = log_d(nm / 400);
        double molecules = air->pressure_mbar / 1013 / (um2 * um2 * (115.6406 - 1.3366 / um2));
        double aerosol = air->aerosol_depth * pow_d(nm / 500, -air->aerosol_power);
        o.depth[AIR_MOLECULES][i] = o.scattering[AIR_MOLECULES][i] = (float)molecules;
        o.depth[AIR_AEROSOL][i] = (float)aerosol;
        o.scattering[AIR_AEROSOL][i] = (float)(aerosol * 0.945 * exp_d(-0.095 * ln * ln));
        o.depth[AIR_OZONE][i] = (float)(ozone_absorption[i] * air->ozone_atm_cm);
    }
    return o;
}

/* ---- over altitude ----------------------------------------------------------------------- */

/* Pressure over sea-level pressure by the layers of ISO 2533; the column above an altitude is
 * proportional to it (gravity taken as constant). */
static double pressure_share(double altitude_m) {
    static const struct {
        double base_m, kelvin, lapse;
        double share; /* at the base: the product of those of the layers below, to the bit */
    } layers[] = {{0, 288.15, -0.0065, 1},
                  {11000, 216.65, 0, 0x1.c97185201380cp-3},
                  {20000, 216.65, 0.001, 0x1.baa34228e175cp-5},
                  {32000, 228.65, 0.0028, 0x1.18b67433d4c94p-7},
                  {47000, 270.65, 0, 0x1.1eee9c290d73dp-10},
                  {51000, 270.65, -0.0028, 0x1.5a5cdee988f52p-11},
                  {71000, 214.65, -0.002, 0x1.478c4e4948516p-15},
                  {84852, 186.946, 0, 0x1.ee97b8130849fp-19}};
    const double g_over_r = 0.0341632; /* K m^-1 */
    int i = 0;
    while (i < 7 && altitude_m > layers[i + 1].base_m) i++;
    double rise = altitude_m - layers[i].base_m, t = layers[i].kelvin;
    return layers[i].share * (layers[i].lapse == 0 ? exp_d(-g_over_r * rise / t)
                                                   : pow_d(1 + layers[i].lapse * rise / t,
                                                           -g_over_r / layers[i].lapse));
}

static double tent_above(double altitude_m) {
    double x = fmax(-1, fmin(1, (altitude_m - 25000) / 15000));
    return x < 0 ? 1 - 0.5 * (1 + x) * (1 + x) : 0.5 * (1 - x) * (1 - x);
}

/* Share of a part's column that lies above an altitude. */
static double share_above(const AirOptics *optics, AirPart part, double altitude_m) {
    if (altitude_m >= optics->top_m) return 0;
    switch (part) {
    case AIR_MOLECULES: {
        double top = pressure_share(optics->top_m);
        return (pressure_share(altitude_m) - top) / (1 - top);
    }
    case AIR_AEROSOL: {
        double layer = 0.5 * erfc_d((altitude_m - LAYER_M) / (LAYER_WIDTH_M * sqrt(2)));
        return optics->aerosol_low * exp_d(-altitude_m / AEROSOL_SCALE_M) +
               (1 - optics->aerosol_low) * layer;
    }
    default: return tent_above(altitude_m);
    }
}

double air_density(const AirOptics *optics, AirPart part, double altitude_m) {
    double h = 5; /* central difference, m */
    return (share_above(optics, part, altitude_m - h) - share_above(optics, part, altitude_m + h)) /
           (2 * h);
}

void air_vertical(const AirOptics *optics, double from_m, double to_m, double column[AIR_PARTS]) {
    for (int p = 0; p < AIR_PARTS; p++)
        column[p] = share_above(optics, (AirPart)p, from_m) - share_above(optics, (AirPart)p, to_m);
}

AirShells air_shells(const AirOptics *optics, double from_m) {
    AirShells shells = {.from_m = from_m};
    double low = from_m, above[AIR_PARTS];
    for (int p = 0; p < AIR_PARTS; p++) above[p] = share_above(optics, (AirPart)p, low);
    for (int i = 1; low < optics->top_m; i++) {
        AirShell *shell = &shells.shell[shells.count++];
        double high = fmin(optics->top_m, from_m + 2.0 * i * i * i + 40.0 * i);
        shell->low_m = low;
        shell->high_m = high;
        for (int p = 0; p < AIR_PARTS; p++) {
            double over = share_above(optics, (AirPart)p, high);
            shell->column[p] = above[p] - over;
            above[p] = over;
        }
        low = high;
    }
    return shells;
}

/* The vertical column of each shell, times its slant, ds/dz = r / sqrt(r^2 - p^2) with the
 * perigee p, averaged over the shell exactly. */
static void add_shells(const AirShells *shells, double perigee, double column[AIR_PARTS]) {
    for (int i = 0; i < shells->count; i++) {
        const AirShell *shell = &shells->shell[i];
        double a = AIR_EARTH_M + shell->low_m, b = AIR_EARTH_M + shell->high_m;
        double path =
            sqrt(fmax(0, b * b - perigee * perigee)) - sqrt(fmax(0, a * a - perigee * perigee));
        for (int p = 0; p < AIR_PARTS; p++)
            column[p] += shell->column[p] * path / (shell->high_m - shell->low_m);
    }
}

bool air_column_over(const AirOptics *optics, const AirShells *over, double cosine, double floor_m,
                     double column[AIR_PARTS]) {
    double r = AIR_EARTH_M + over->from_m, perigee = r * sqrt(fmax(0, 1 - cosine * cosine));
    for (int p = 0; p < AIR_PARTS; p++) column[p] = 0;
    if (cosine >= 0) {
        add_shells(over, perigee, column);
        return true;
    }
    if (perigee < AIR_EARTH_M + floor_m) return false;
    double below[AIR_PARTS] = {0, 0, 0};
    AirShells whole = air_shells(optics, perigee - AIR_EARTH_M);
    add_shells(&whole, perigee, column);
    add_shells(over, perigee, below); /* from here up on the far side */
    for (int p = 0; p < AIR_PARTS; p++) column[p] = 2 * column[p] - below[p];
    return true;
}

bool air_column(const AirOptics *optics, double altitude_m, double cosine, double floor_m,
                double column[AIR_PARTS]) {
    AirShells over = air_shells(optics, altitude_m);
    return air_column_over(optics, &over, cosine, floor_m, column);
}

/* ---- scattering ------------------------------------------------------------------------- */

float air_phase_molecules(float cosine) {
    return 3 / (16 * PI_F) * (1 + cosine * cosine);
}

float air_phase_aerosol(float cosine) {
    float g = AIR_ASYMMETRY, d = 1 + g * g - 2 * g * cosine;
    return (1 - g * g) / (4 * PI_F * d * safe_sqrtf(d));
}
