/* SPDX-License-Identifier: Apache-2.0 */
/* The verdict on reflection tables of scattered samples: it names the hole that they leave at a
 * peak, and what they scatter by. */
#include <string.h>

#include "scatter_fixture.h"

/* ---- holes ------------------------------------------------------------------------------- */

#define HOLE_DEG 8.0

/* 1200 directions; none near the mirror direction. */
static void holed(double theta_i, Layout *out) {
    for (int i = 0; i < 1200; i++) {
        Vec3 d = around(0, degrees_from_radians(acos(1 - (i + 0.5) / 1200)), 137.50776 * i);
        if (off_mirror(theta_i, d) > radians_from_degrees(HOLE_DEG)) add(out, d);
    }
}

/* The hole filled in steps. */
static double step_deg;

static void filled(double theta_i, Layout *out) {
    holed(theta_i, out);
    add(out, around(theta_i, 0, 0));
    for (double ring = step_deg; ring < HOLE_DEG; ring += step_deg)
        for (double t = 0; t < 359; t += degrees_from_radians(step_deg / ring))
            add(out, around(theta_i, ring, t));
}

static double between(const Fitted *f) {
    return json_number_at(f->fit.report, "judged/reflection_between_samples/worst");
}

/* The verdict names a hole at a narrow peak; what it says to measure there is enough. */
TEST(a_hole_at_a_peak_wants_care_and_its_advice_works) {
    Lobe lobe = {12, 0.2, 0.01, 0};
    ENDS_BY(fitted_end) Fitted f = fit_layout(holed, &lobe);
    const char *reason =
        json_string_value(json_array_get(json_object_get(f.fit.report, "reasons"), 0));
    const char *step = reason ? strstr(reason, "measure every ") : NULL;
    assert_true(between(&f) > 0.15);
    assert_non_null(step);
    assert_non_null(strstr(reason, "no sample lies within "));
    step_deg = strtod(step + strlen("measure every "), NULL);
    assert_true(step_deg > 0.5 && step_deg < HOLE_DEG);
    ENDS_BY(fitted_end) Fitted whole = fit_layout(filled, &lobe);
    assert_true(between(&whole) < 0.15);
    assert_string_equal(json_string_value(json_object_get(whole.fit.report, "verdict")), "good");
}

/* What may be noise or fine structure is no "good" panel: the sentence says how much. */
TEST(samples_that_scatter_want_care) {
    Lobe steady = {25, 0.03, 0.006, 0.005}, unsteady = {25, 0.03, 0.006, 0.06};
    ENDS_BY(fitted_end) Fitted good = fit_layout(scattered, &steady);
    ENDS_BY(fitted_end) Fitted poor = fit_layout(scattered, &unsteady);
    double spread = json_number_at(poor.fit.report, "judged/reflection_spread");
    char *reasons = json_dumps(json_object_get(poor.fit.report, "reasons"), 0);
    assert_true(json_number_at(good.fit.report, "judged/reflection_spread") < 0.02);
    assert_true(spread > 0.03 && spread < 0.12);
    assert_non_null(strstr(reasons, "the samples scatter by "));
    assert_non_null(strstr(reasons, "measure in half the steps"));
    free(reasons);
}

TEST_PROGRAM(NULL, NULL)
