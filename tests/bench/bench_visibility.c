/* SPDX-License-Identifier: Apache-2.0 */
/* bench_visibility.c -- thresholds of vision/visibility.h, for a script.
 *
 * usage: bench_visibility < LINES > THRESHOLDS
 * A line: size in arc minutes, adaptation in cd/m2, years, seconds, 1 of a darker target or 0.
 * Prints cd/m2, "nan" outside of the formula's range.
 */
#include <stdio.h>

#include "vision/visibility.h"

int main(void) {
    VisibilityTarget t;
    int darker, got;
    while ((got = scanf("%lf %lf %lf %lf %d", &t.size_arcmin, &t.adapted_cd_m2, &t.age_years,
                        &t.glance_s, &darker)) == 5) {
        t.is_darker = darker;
        printf("%.17g\n", visibility_threshold(&t));
    }
    if (got == EOF) return 0;
    fprintf(stderr, "bench_visibility: a line without five numbers\n");
    return 2;
}
