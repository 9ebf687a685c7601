/* SPDX-License-Identifier: Apache-2.0 */
/* Between the samples: the stated bound, which a fit guarantees at the samples, plus what the
 * source's own grid leaves open holds at a million random directions inside the cone, by day a
 * quarter of them.
 *
 * What a grid leaves open: the error of linear interpolation of the logarithm between the
 * source's samples, the largest one found within the same 2 degrees of theta. */
#include "panel_fixture.h"
#include "panel/query/panel_emission.h"

#define BOUND 0.02
#define BANDS 45
#define THETA_STEP 2
#define PHI_STEP 6

/* A broad lobe, black leaks at 45 degrees of azimuth, a narrower one of 24 degrees: at least
 * four samples a width. */
#define RECIPE \
    "{\"panel\": \"to probe\", \"emission\": {" FIXTURE_SPECTRA \
    "\"black_cd_m2\": 0.5, \"leak\": 2, \"cosine_power\": [1.1, 1.6], \"levels\": [127, 255]," \
    "\"lobe\": {\"theta_deg\": 40, \"phi_deg\": 60, \"width_deg\": 12, \"gain\": 0.5}}," \
    "\"instrument\": {\"theta_step_deg\": 2, \"phi_step_deg\": 6}}"

static Fixture fixture;

static int start(void **state) {
    *state = &fixture;
    FitOptions options = fit_options_default();
    options.bound = (float)BOUND;
    fixture_start(&fixture, RECIPE, &options);
    return 0;
}

/* XYZ of what is shown: 0 black, 1 a full white, 2 level 127 of red. */
static void truth(int colour, double theta, double phi, double xyz[3]) {
    double angles[2] = {theta, phi}, add[3];
    closed_form_black_xyz(&fixture.recipe, angles, xyz);
    for (int p = 0; p < 3; p++) {
        if (colour == 0 || (colour == 2 && p > 0)) continue;
        closed_form_emission_xyz(&fixture.recipe, p, colour == 1 ? 255 : 127, angles, add);
        for (int j = 0; j < 3; j++) xyz[j] += add[j];
    }
}

/* Bilinear over the source's grid, in logarithms. */
static void interpolated(int colour, double theta_deg, double phi_deg, double xyz[3]) {
    int t = (int)(theta_deg / THETA_STEP), p = (int)(phi_deg / PHI_STEP);
    double x = theta_deg / THETA_STEP - t, y = phi_deg / PHI_STEP - p;
    double sum[3] = {0, 0, 0};
    for (int c = 0; c < 4; c++) {
        double corner[3], weight = (c / 2 ? x : 1 - x) * (c % 2 ? y : 1 - y);
        truth(colour, radians_from_degrees((t + c / 2) * THETA_STEP),
              radians_from_degrees((p + c % 2) * PHI_STEP), corner);
        for (int j = 0; j < 3; j++) sum[j] += weight * log(corner[j]);
    }
    for (int j = 0; j < 3; j++) xyz[j] = exp(sum[j]);
}

static double largest_error(const double found[3], const double wanted[3]) {
    double largest = 0;
    for (int j = 0; j < 3; j++) largest = fmax(largest, fabs(found[j] / wanted[j] - 1));
    return largest;
}

TEST(the_bound_holds_between_the_samples) {
    static const float codes[3][3] = {{0, 0, 0}, {255, 255, 255}, {127, 0, 0}};
    double fit[3][BANDS] = {{0}}, grid[3][BANDS] = {{0}};
    uint32_t random = 1;
    int directions = all_laws() ? 1000000 : 250000;
    for (int i = 0; i < directions; i++) {
        double z = 1 - steady_random(&random) * (1 - cos(radians_from_degrees(87.99)));
        double theta_deg = degrees_from_radians(acos(z));
        double phi_deg = 360 * steady_random(&random);
        int colour = i % 3, band = (int)(theta_deg / 2);
        double wanted[3], by_grid[3], found[3];
        float xyz[3];
        assert_true(panel_emission_xyz(fixture.panel, direction_deg(theta_deg, phi_deg),
                                       codes[colour], xyz));
        truth(colour, radians_from_degrees(theta_deg), radians_from_degrees(phi_deg), wanted);
        for (int j = 0; j < 3; j++) found[j] = (double)xyz[j];
        fit[colour][band] = fmax(fit[colour][band], largest_error(found, wanted));
        if (i % 16 > 2) continue; /* every 16th of each colour shows the grid's own error */
        interpolated(colour, theta_deg, phi_deg, by_grid);
        grid[colour][band] = fmax(grid[colour][band], largest_error(by_grid, wanted));
    }
    for (int colour = 0; colour < 3; colour++)
        for (int b = 0; b < BANDS; b++)
            if (!(fit[colour][b] <= BOUND + grid[colour][b]))
                fail_msg("colour %d, theta %d to %d: error %.4f, bound %.4f and the grid's own "
                         "%.4f",
                         colour, 2 * b, 2 * b + 2, fit[colour][b], BOUND, grid[colour][b]);
}

TEST_PROGRAM(start, fixture_group_end)
