#include "panel/fit/common/fit_options.h"

FitOptions fit_options_default(void)
{
    return (FitOptions){.max_error = 0.003f, .wavelet = WAVELET_CDF53, .weights = HAAR_AREA,
                        .threads = 1, .progress = PROGRESS_NONE};
}
