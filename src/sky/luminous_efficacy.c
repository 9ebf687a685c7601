/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/luminous_efficacy.h"

#include <math.h>

#include "base/mathd.h"

/* a, b, c, d for eight ranges of clearness. */
static const double direct_table[8][4] = {
    {57.20, -4.55, -2.98, 117.12}, {98.99, -3.46, -1.21, 12.38},  {109.83, -4.90, -1.71, -8.81},
    {110.34, -5.84, -1.99, -4.56}, {106.36, -3.97, -1.75, -6.16}, {107.19, -1.25, -1.51, -26.73},
    {105.75, 0.77, -1.26, -34.44}, {101.18, 1.58, -1.10, -8.29}};
static const double diffuse_table[8][4] = {
    {97.24, -0.46, 12.00, -8.91},   {107.22, 1.15, 0.59, -3.95},    {104.97, 2.96, -5.53, -8.77},
    {102.39, 5.59, -13.95, -13.90}, {100.71, 5.94, -22.75, -23.74}, {106.42, 3.83, -36.15, -28.83},
    {141.88, 1.90, -53.24, -14.03}, {152.23, 0.35, -45.27, -7.98}};
static const double global_table[8][4] = {
    {96.63, -0.47, 11.50, -9.16}, {107.54, 0.79, 1.79, -1.19}, {98.73, 0.70, 4.40, -6.95},
    {92.72, 0.56, 8.36, -8.31},   {86.73, 0.98, 7.10, -10.94}, {88.34, 1.39, 6.06, -7.60},
    {78.63, 1.47, 4.93, -11.37},  {99.65, 1.86, -4.46, -3.15}};

static double horizontal(const double row[4], const PerezState *state, double sun_zenith,
                         double water_cm) {
    return row[0] + row[1] * water_cm + row[2] * cos_d(sun_zenith) +
           row[3] * log_d(state->brightness);
}

LuminousEfficacy luminous_efficacy(const PerezState *state, double sun_zenith, double water_cm) {
    int bin = state->bin - 1;
    const double *beam = direct_table[bin];
    double direct = beam[0] + beam[1] * water_cm + beam[2] * exp_d(5.73 * sun_zenith - 5) +
                    beam[3] * state->brightness;
    return (LuminousEfficacy){fmax(0, direct),
                              horizontal(diffuse_table[bin], state, sun_zenith, water_cm),
                              horizontal(global_table[bin], state, sun_zenith, water_cm)};
}

double water_from_dew_point_cm(double celsius) {
    return exp_d(0.07 * celsius - 0.075);
}
