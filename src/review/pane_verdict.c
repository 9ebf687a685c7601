/* SPDX-License-Identifier: Apache-2.0 */
#include "review/pane_verdict.h"

#include <math.h>

#include "base/mathd.h"

#define SEEN_CD_M2 0.01 /* of an image: what is darker hardly anybody sees */

static double over(const double *at, const void *user) {
    (void)user;
    return at[0] > 0 ? at[0] / at[1] : 0;
}

void pane_set_contrast(PaneFinding *f) {
    const IntervalInput in[2] = {{f->image, f->image_range.low, f->image_range.high},
                                 {f->against, f->against_range.high, f->against_range.low}};
    FigureInterval range = interval_of(over, NULL, in, 2);
    f->contrast = over((double[2]){f->image, f->against}, NULL);
    f->contrast_range = (MeanInterval){range.low < 0 ? 0 : range.low, range.high};
}

double pane_level_share(const PaneFinding *f) {
    double share = f->limit.value / f->contrast_range.high;
    if (!(share > 0 && share < 1 && share * f->image >= SEEN_CD_M2)) return (double)NAN;
    double digit = pow_d(10, floor(log10_d(share)) - 2);
    return digit * floor(share / digit + 1e-9);
}
