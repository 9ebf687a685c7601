/* SPDX-License-Identifier: Apache-2.0 */
#include "review/pane_verdict.h"

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
