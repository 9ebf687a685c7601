/* SPDX-License-Identifier: Apache-2.0 */
/* reading_fixture.h -- what readings are taken with, and a question that ends them. */
#pragma once
#include "review/light/reading.h"
#include "world_fixture.h"

static inline const Kernel *kernel(void) {
    const Kernel *chosen;
    assert_done(kernel_choose(NULL, &chosen, &err));
    return chosen;
}

static inline ProbeTools reading_tools(int threads) {
    return (ProbeTools){.kernel = kernel(), .threads = threads};
}

/* user: a limit. */
static inline bool is_clear_of(void *user, MeanInterval in, Arena scratch) {
    (void)scratch;
    const double *limit = user;
    return in.low > *limit || in.high < *limit;
}
