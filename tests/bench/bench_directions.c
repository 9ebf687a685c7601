/* SPDX-License-Identifier: Apache-2.0 */
/* bench_directions.c -- errors between a panel's samples, at random directions.
 *
 *     bench_directions COUNT BOUND RECIPE.json X.panel
 *
 * X.panel was fitted to the recipe's set, measured without noise, with --max-error BOUND. COUNT
 * directions, even in solid angle up to the cone, are evaluated for every case: X, Y and Z of
 * some colours (black only if it is not dark), the BRDF at 550 nm at every measured incidence.
 * A line says the largest and the rms relative error against the closed form, the largest error
 * of the source's own grid (bilinear in logarithms) and how many directions lie beyond the
 * bound plus the grid's largest error in the same 2 degrees of theta.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/sampler.h"
#include "base/units.h"
#include "bench_panel_files.h"
#include "panel/query/panel.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_reflection.h"
#include "panel/set/synthetic_panel.h"

#define BANDS 46
#define GRID_EVERY 4 /* directions that show the grid's own error */

/* One case: a colour, or an incidence. */
typedef struct Case {
    const SyntheticPanel *recipe;
    const Panel *panel;
    float code[3];
    double incidence;            /* radians; negative: emission */
    double theta_step, phi_step; /* degrees */
} Case;

static Vec3 direction_of(double theta, double phi) {
    return vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)), (float)cos(theta));
}

/* Returns how many values there are: 3, or 1 of a BRDF. */
static int truth(const Case *c, double theta, double phi, double values[3]) {
    double angles[2] = {theta, phi}, add[3];
    if (c->incidence >= 0) {
        values[0] = closed_form_brdf(c->recipe, c->incidence, theta, phi, 550);
        return 1;
    }
    closed_form_black_xyz(c->recipe, angles, values);
    for (int p = 0; p < 3; p++) {
        if (c->code[p] <= 0) continue;
        closed_form_emission_xyz(c->recipe, p, (double)c->code[p], angles, add);
        for (int j = 0; j < 3; j++) values[j] += add[j];
    }
    return 3;
}

static void found(const Case *c, double theta, double phi, float values[3]) {
    Vec3 wo = direction_of(theta, phi);
    if (c->incidence < 0) {
        panel_emission_xyz(c->panel, wo, c->code, values);
        return;
    }
    Wavelengths w;
    for (int i = 0; i < SPECTRUM_LANES; i++) w.nm[i] = 550;
    values[0] = panel_brdf(c->panel, wo, direction_of(c->incidence, PI), &w)[0];
}

/* The largest relative error of the source's grid there. */
static double grid_error(const Case *c, double theta, double phi, const double wanted[3]) {
    double row = floor(degrees_from_radians(theta) / c->theta_step);
    double column = floor(degrees_from_radians(phi) / c->phi_step);
    double x = degrees_from_radians(theta) / c->theta_step - row;
    double y = degrees_from_radians(phi) / c->phi_step - column;
    double sum[3] = {0, 0, 0}, corner[3], largest = 0;
    int count = 0;
    for (int k = 0; k < 4; k++) {
        double w = (k / 2 ? x : 1 - x) * (k % 2 ? y : 1 - y);
        count = truth(c, radians_from_degrees((row + k / 2) * c->theta_step),
                      radians_from_degrees((column + k % 2) * c->phi_step), corner);
        for (int j = 0; j < count; j++) sum[j] += w * log(corner[j]);
    }
    for (int j = 0; j < count; j++) largest = fmax(largest, fabs(exp(sum[j]) / wanted[j] - 1));
    return largest;
}

static void measure(const char *name, const Case *c, int count, double bound) {
    static float error[1 << 22], at[1 << 22];
    double grid[BANDS] = {0}, largest = 0, squares = 0, own = 0, where = 0;
    double cone = radians_from_degrees(c->recipe->instrument.theta_max_deg - 0.01);
    uint32_t seed = 1;
    int beyond = 0;
    for (int i = 0; i < count; i++) {
        double u = (double)unit_float(hash_u32(seed++));
        double theta = acos(1 - u * (1 - cos(cone))), wanted[3], worst = 0;
        double phi = 2 * PI * (double)unit_float(hash_u32(seed++));
        float values[3];
        int values_count = truth(c, theta, phi, wanted);
        found(c, theta, phi, values);
        for (int j = 0; j < values_count; j++)
            worst = fmax(worst, fabs((double)values[j] / wanted[j] - 1));
        error[i] = (float)worst;
        at[i] = (float)degrees_from_radians(theta);
        squares += worst * worst;
        if (worst > largest) largest = worst, where = (double)at[i];
        if (i % GRID_EVERY) continue;
        int band = (int)(at[i] / 2);
        grid[band] = fmax(grid[band], grid_error(c, theta, phi, wanted));
        own = fmax(own, grid[band]);
    }
    for (int i = 0; i < count; i++) beyond += (double)error[i] > bound + grid[(int)(at[i] / 2)];
    printf("%-20s %d directions: max %.3f%% at theta %.1f, rms %.3f%%; the grid's own max "
           "%.3f%%; beyond the bound: %d\n",
           name, count, 100 * largest, where, 100 * sqrt(squares / count), 100 * own, beyond);
    fflush(stdout);
}

static void measure_all(const SyntheticPanel *recipe, const Panel *panel, int count, double bound) {
    static const float codes[][3] = {{0, 0, 0},   {255, 255, 255}, {255, 0, 0},
                                     {0, 255, 0}, {0, 0, 255},     {31, 127, 223}};
    const SyntheticInstrument *tool = &recipe->instrument;
    char name[64];
    for (int i = recipe->emission.black_cd_m2 > 0 ? 0 : 1; i < 6; i++) {
        Case c = {recipe,
                  panel,
                  {codes[i][0], codes[i][1], codes[i][2]},
                  -1,
                  tool->theta_step_deg,
                  tool->phi_step_deg};
        snprintf(name, sizeof name, "colour %g,%g,%g", (double)codes[i][0], (double)codes[i][1],
                 (double)codes[i][2]);
        measure(name, &c, count, bound);
    }
    for (int i = 0; panel_reflects(panel) && i < recipe->reflection.incidence_count; i++) {
        double deg = recipe->reflection.incidence_deg[i];
        Case c = {recipe,
                  panel,
                  {0, 0, 0},
                  radians_from_degrees(deg),
                  tool->brdf_theta_step_deg,
                  tool->brdf_phi_step_deg};
        snprintf(name, sizeof name, "BRDF, incidence %g", deg);
        measure(name, &c, count, bound);
    }
}

int main(int argc, char **argv) {
    if (argc != 5 || atoi(argv[1]) < 1 || atoi(argv[1]) > 1 << 22 || atof(argv[2]) <= 0) {
        fprintf(stderr, "bench_directions COUNT BOUND RECIPE.json X.panel\n");
        return 2;
    }
    Arena arena = arena_reserve((size_t)1 << 30);
    SyntheticPanel recipe;
    Panel *panel = NULL;
    if (!bench_panel_files("bench_directions", argv + 3, &arena, &recipe, &panel)) return 3;
    measure_all(&recipe, panel, atoi(argv[1]), atof(argv[2]));
    panel_close(panel);
    arena_release(&arena);
    return 0;
}
