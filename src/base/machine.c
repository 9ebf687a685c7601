/* SPDX-License-Identifier: Apache-2.0 */
#include "base/machine.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#define PATH_BYTES 4096

/* ---- control groups ---------------------------------------------------------------------- */

static size_t limit_in(const char *folder, const char *name) {
    char path[PATH_BYTES];
    size_t limit = SIZE_MAX;
    if (snprintf(path, sizeof path, "%s/%s", folder, name) >= (int)sizeof path) return limit;
    FILE *file = fopen(path, "r");
    if (file && fscanf(file, "%zu", &limit) != 1) limit = SIZE_MAX; /* "max" */
    if (file) fclose(file);
    return limit;
}

/* group: "/a/b", below root. What holds a group limits it, too; inside a container the group's
 * own name may not be there, but what its root is, is. */
static size_t least_limit(const char *root, const char *group, const char *name) {
    char folder[PATH_BYTES];
    size_t least = SIZE_MAX, length = strlen(root);
    int written = snprintf(folder, sizeof folder, "%s%s", root, group);
    if (written >= (int)sizeof folder) return least;
    for (;;) {
        size_t limit = limit_in(folder, name);
        if (limit < least) least = limit;
        char *last = strrchr(folder + length, '/');
        if (!last) return least;
        *last = '\0';
    }
}

/* cgroups(7): lines "number:controllers:/group"; version 2 has no controllers in it. */
size_t machine_group_bytes(const char *own_groups, const char *root) {
    char line[PATH_BYTES + 256], of_memory[PATH_BYTES];
    size_t least = SIZE_MAX;
    FILE *file = fopen(own_groups, "r");
    if (!file) return least;
    snprintf(of_memory, sizeof of_memory, "%s/memory", root);
    while (fgets(line, sizeof line, file)) {
        char *controllers = strchr(line, ':');
        char *group = controllers ? strchr(controllers + 1, ':') : NULL;
        if (!group) continue;
        *group++ = '\0';
        group[strcspn(group, "\n")] = '\0';
        bool is_new = !controllers[1], has_it = strstr(controllers, "memory") != NULL;
        size_t limit = is_new   ? least_limit(root, group, "memory.max")
                       : has_it ? least_limit(of_memory, group, "memory.limit_in_bytes")
                                : SIZE_MAX;
        if (limit < least) least = limit;
    }
    fclose(file);
    return least;
}

/* ---- all --------------------------------------------------------------------------------- */

size_t machine_installed_bytes(void) {
    size_t machine = (size_t)sysconf(_SC_PHYS_PAGES) * (size_t)sysconf(_SC_PAGESIZE);
    size_t group = machine_group_bytes("/proc/self/cgroup", "/sys/fs/cgroup");
    return group < machine ? group : machine;
}

size_t machine_memory_bytes(void) {
    size_t machine = machine_installed_bytes();
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) || limit.rlim_cur == RLIM_INFINITY) return machine;
    return limit.rlim_cur / 2 < machine ? (size_t)limit.rlim_cur / 2 : machine;
}

double machine_peak_bytes(void) {
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) ? 0 : 1024.0 * (double)usage.ru_maxrss;
}

/* proc(5): statm counts pages that are mapped, those in memory, and those of them that are of
 * files. 0 where it cannot be read. */
typedef struct OwnBytes {
    size_t mapped, resident, of_files;
} OwnBytes;

static OwnBytes own_bytes(void) {
    size_t page = (size_t)sysconf(_SC_PAGESIZE), pages[3] = {0, 0, 0};
    FILE *file = fopen("/proc/self/statm", "re");
    if (file && fscanf(file, "%zu %zu %zu", &pages[0], &pages[1], &pages[2]) != 3)
        pages[0] = pages[1] = pages[2] = 0;
    if (file) fclose(file);
    return (OwnBytes){pages[0] * page, pages[1] * page, pages[2] * page};
}

size_t machine_memory_left(void) {
    OwnBytes own = own_bytes();
    size_t installed = machine_installed_bytes(), taken = own.resident - own.of_files;
    return taken < installed ? installed - taken : 0;
}

size_t machine_address_space_left(void) {
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) || limit.rlim_cur == RLIM_INFINITY) return SIZE_MAX;
    size_t mapped = own_bytes().mapped;
    return mapped < limit.rlim_cur ? (size_t)limit.rlim_cur - mapped : 0;
}

/* A quarter of it was enough for every command (tests/hostile/fault_machine.py). */
#define STACK_KILOBYTES 512

bool machine_check_stack(Error *err) {
    struct rlimit stack;
    if (getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur >= STACK_KILOBYTES * 1024)
        return true;
    return error_set(err, ERROR_MACHINE,
                     "a stack may have %llu kB here, required: %d — ulimit -s %d",
                     (unsigned long long)stack.rlim_cur / 1024, STACK_KILOBYTES, STACK_KILOBYTES);
}
