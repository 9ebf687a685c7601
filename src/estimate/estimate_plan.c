/* SPDX-License-Identifier: Apache-2.0 */
#include "estimate/estimate_plan.h"

/* Paths that will do, the fewest; the most there are, where none will. */
static long estimate_paths(const EstimatePlan *plan, long pilot) {
    long paths = plan->least;
    while (2 * paths <= plan->most && !plan->will_do(plan->user, pilot, paths)) paths *= 2;
    return paths;
}

long estimate_plan(const EstimatePlan *plan) {
    long pilot = plan->pilot, paths;
    if (2 * plan->least > plan->most) return plan->least;
    plan->read_pilot(plan->user, pilot);
    while ((paths = estimate_paths(plan, pilot)) > plan->reach * pilot) {
        pilot *= 2;
        plan->read_pilot(plan->user, pilot);
    }
    return paths;
}
