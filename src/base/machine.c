/* SPDX-License-Identifier: Apache-2.0 */
#include "base/machine.h"

#include <stdint.h>
#include <stdio.h>
#include <sys/resource.h>
#include <unistd.h>

size_t machine_memory_bytes(void)
{
    size_t        machine = (size_t)sysconf(_SC_PHYS_PAGES) * (size_t)sysconf(_SC_PAGESIZE);
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) || limit.rlim_cur == RLIM_INFINITY) return machine;
    return limit.rlim_cur / 2 < machine ? (size_t)limit.rlim_cur / 2 : machine;
}

double machine_peak_bytes(void)
{
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) ? 0 : 1024.0 * (double)usage.ru_maxrss;
}

/* proc(5): the first number of statm counts the pages that are mapped. */
static size_t mapped_bytes(void)
{
    size_t pages = 0;
    FILE  *file = fopen("/proc/self/statm", "r");
    if (file && fscanf(file, "%zu", &pages) != 1) pages = 0;
    if (file) fclose(file);
    return pages * (size_t)sysconf(_SC_PAGESIZE);
}

size_t machine_address_space_left(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) || limit.rlim_cur == RLIM_INFINITY) return SIZE_MAX;
    size_t mapped = mapped_bytes();
    return mapped < limit.rlim_cur ? (size_t)limit.rlim_cur - mapped : 0;
}
