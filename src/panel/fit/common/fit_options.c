/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/common/fit_options.h"

FitOptions fit_options_default(void)
{
    return (FitOptions){.max_error = 0.003f, .error_floor = 0.001f, .wavelet = WAVELET_CDF53,
                        .weights = HAAR_AREA, .threads = 1, .progress = PROGRESS_NONE};
}
