/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/convolution.h"

Convolve *convolution_choose(void)
{
#ifdef PARHELION_KERNELS
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512cd"))
        return convolve_avx512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
        __builtin_cpu_supports("bmi2"))
        return convolve_avx2;
#endif
    return convolve_base;
}
