/* SPDX-License-Identifier: Apache-2.0 */
#include "onetbb/task_threads.h"

#include <oneapi/tbb/global_control.h>

#include "guarded/guarded.hpp"

extern "C" bool task_threads_limit(int most, Error *err) {
    return guarded(err, ERROR_LIBRARY, "limiting oneTBB's threads", [&] {
        using oneapi::tbb::global_control;
        new global_control(global_control::max_allowed_parallelism, (size_t)most); // for good
        return true;
    });
}
