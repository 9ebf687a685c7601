/* SPDX-License-Identifier: Apache-2.0 */
#include "kernel/kernel.h"

#include <stdio.h>
#include <string.h>

extern const Kernel kernel_base; /* tile.c, as the rest of the program is built */

#ifdef PARHELION_KERNELS
extern const Kernel kernel_avx2, kernel_avx512;

static bool processor_has(const Kernel *kernel) {
    if (kernel == &kernel_avx512)
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
               __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx2");
    if (kernel == &kernel_avx2)
        return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") &&
               __builtin_cpu_supports("fma");
    return true;
}

static const Kernel *const kernels[] = {&kernel_avx512, &kernel_avx2, &kernel_base};
#else
static bool processor_has(const Kernel *kernel) {
    return kernel != NULL;
}

static const Kernel *const kernels[] = {&kernel_base};
#endif

#define KERNEL_COUNT (int)(sizeof kernels / sizeof *kernels)

/* Has another machine it? */
static bool is_known(const char *isa) {
    return !strcmp(isa, "sse2") || !strcmp(isa, "avx2") || !strcmp(isa, "avx512");
}

bool kernel_choose(const char *isa, const Kernel **out, Error *err) {
    char there[64] = "";
    for (int i = 0; i < KERNEL_COUNT; i++) {
        if (!processor_has(kernels[i])) continue;
        if (!isa || !strcmp(isa, kernels[i]->isa)) {
            *out = kernels[i];
            return true;
        }
        snprintf(there + strlen(there), sizeof there - strlen(there), "%s%s", there[0] ? ", " : "",
                 kernels[i]->isa);
    }
    return error_set(err, is_known(isa) ? ERROR_MACHINE : ERROR_USAGE,
                     "--isa %s: this processor and program have %s", isa, there);
}
