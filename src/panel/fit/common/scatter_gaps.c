/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/common/scatter_gaps.h"

#include <math.h>

#include "base/mathd.h"
#include "hemisphere/tree/vertex.h"

#define LEVEL 5 /* of the lattice: 2.8 degrees between its directions */
#define SIGMAS 2.0
#define SEEN 0.25    /* of the largest value: where a miss is a miss of the peak */
#define MOST_LOG 2.3 /* a doubt of more than tenfold is no other one */

static double relative(double log) {
    return exp_d(fmin(MOST_LOG, log)) - 1;
}

double scatter_gaps_miss(double sigma) {
    return relative(SIGMAS * sigma);
}

ScatterGaps scatter_gaps_find(const ScatterAsked *asked, Arena scratch) {
    VertexLattice lattice = {LEVEL, 4};
    ScatterGaps out = {0};
    int count = (int)vertex_count(lattice);
    double total = 0, missed = 0, largest = -INFINITY;
    Vec3 *at = ARENA_NEW(&scratch, Vec3, count);
    double *log = ARENA_NEW(&scratch, double, count);
    double *off = ARENA_NEW(&scratch, double, count);
    ScatterDoubt *doubt = ARENA_NEW(&scratch, ScatterDoubt, count);
    vertex_directions(lattice, at);
    scatter_surface_doubt(asked->surface, at, count, doubt, scratch);
    for (int i = 0; i < count; i++) {
        if (!doubt[i].is_between) continue;
        log[i] = asked->read(asked->context, at[i], &off[i]);
        double sigma = scatter_doubt_sigma(&doubt[i]);
        double light = exp_d(log[i]) * (double)at[i].z;
        total += light;
        missed += light * relative(sigma + fabs(off[i]));
        largest = fmax(largest, log[i]);
    }
    for (int i = 0; i < count; i++) {
        double sigma = scatter_doubt_sigma(&doubt[i]);
        double miss = relative(SIGMAS * sigma + fabs(off[i]));
        if (!doubt[i].is_between || log[i] < largest + log_d(SEEN) || miss <= out.worst) continue;
        out.worst = miss;
        out.gap = doubt[i].gap;
        out.theta = acos_d(fmin(1, (double)at[i].z));
        out.phi = atan2_d((double)at[i].y, (double)at[i].x);
    }
    out.light = total > 0 ? missed / total : 0;
    return out;
}

double scatter_gaps_step(const ScatterGaps *gaps, double most) {
    return gaps->gap * fmin(1, pow_d(most / fmax(most, gaps->worst), 2.0 / 3));
}
