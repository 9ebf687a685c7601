/* SPDX-License-Identifier: Apache-2.0 */
#include "spectrum/illuminant.h"

#include "spectrum/photometry.h"

/* CIE 15, daylight components every 10 nm from 360 nm on. */
static const double daylight[][3] = {
    {61.5, 38.0, 5.3},   {68.8, 42.4, 6.1},   {63.4, 38.5, 3.0},   {65.8, 35.0, 1.2},
    {94.8, 43.4, -1.1},  {104.8, 46.3, -0.5}, {105.9, 43.9, -0.7}, {96.8, 37.1, -1.2},
    {113.9, 36.7, -2.6}, {125.6, 35.9, -2.9}, {125.5, 32.6, -2.8}, {121.3, 27.9, -2.6},
    {121.3, 24.3, -2.6}, {113.5, 20.1, -1.8}, {113.1, 16.2, -1.5}, {110.8, 13.2, -1.3},
    {106.5, 8.6, -1.2},  {108.8, 6.1, -1.0},  {105.3, 4.2, -0.5},  {104.4, 1.9, -0.3},
    {100.0, 0.0, 0.0},   {96.0, -1.6, 0.2},   {95.1, -3.5, 0.5},   {89.1, -3.5, 2.1},
    {90.5, -5.8, 3.2},   {90.3, -7.2, 4.1},   {88.4, -8.6, 4.7},   {84.0, -9.5, 5.1},
    {85.1, -10.9, 6.7},  {81.9, -10.7, 7.3},  {82.6, -12.0, 8.6},  {84.9, -14.0, 9.8},
    {81.3, -13.6, 10.2}, {71.9, -12.0, 8.3},  {74.3, -13.3, 9.6},  {76.4, -12.9, 8.5},
    {63.3, -10.6, 7.0},  {71.7, -11.6, 7.6},  {77.0, -12.2, 8.0},  {65.2, -10.2, 6.7},
    {47.7, -7.8, 5.2},   {68.6, -11.2, 7.4},  {65.0, -10.4, 6.8},  {66.0, -10.6, 7.0},
    {61.0, -9.7, 6.4},   {53.3, -8.3, 5.5},   {58.9, -9.3, 6.1},   {61.9, -9.8, 6.5}};

enum { ROWS = sizeof daylight / sizeof *daylight };

/* CIE 15: the chromaticity of daylight, and how much of S1 and S2 it takes. */
static void daylight_weights(double kelvin, double m[3]) {
    double t = 1000 / kelvin;
    double x = kelvin <= 7000 ? 0.244063 + t * (0.09911 + t * (2.9678 - t * 4.6070))
                              : 0.237040 + t * (0.24748 + t * (1.9018 - t * 2.0064));
    double y = -3.000 * x * x + 2.870 * x - 0.275;
    double below = 0.0241 + 0.2562 * x - 0.7341 * y;
    m[0] = 1;
    m[1] = (-1.3515 - 1.7703 * x + 5.9114 * y) / below;
    m[2] = (0.0300 - 31.4424 * x + 30.0717 * y) / below;
}

static void daylight_curve(double kelvin, Curve *out) {
    double m[3], nm[ROWS], value[ROWS];
    daylight_weights(kelvin, m);
    for (int i = 0; i < ROWS; i++) {
        nm[i] = CURVE_FIRST_NM + 10 * i;
        value[i] = m[0] * daylight[i][0] + m[1] * daylight[i][1] + m[2] * daylight[i][2];
    }
    curve_from_points(nm, value, ROWS, out);
}

void cct_curve(double kelvin, Curve *out) {
    if (kelvin >= CCT_DAYLIGHT_K) daylight_curve(kelvin, out);
    else
        for (int i = 0; i < CURVE_COUNT; i++)
            out->value[i] = (float)black_body_radiance(CURVE_FIRST_NM + i, kelvin);
    double luminance = luminance_cd_m2(out->value, CURVE_COUNT, CURVE_FIRST_NM, 1);
    for (int i = 0; i < CURVE_COUNT; i++)
        out->value[i] = (float)((double)out->value[i] / luminance);
}
