#include "base/machine.h"

#include <sys/resource.h>
#include <unistd.h>

size_t machine_memory_bytes(void)
{
    size_t        machine = (size_t)sysconf(_SC_PHYS_PAGES) * (size_t)sysconf(_SC_PAGESIZE);
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) || limit.rlim_cur == RLIM_INFINITY) return machine;
    return limit.rlim_cur / 2 < machine ? (size_t)limit.rlim_cur / 2 : machine;
}
