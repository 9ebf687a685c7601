/* SPDX-License-Identifier: Apache-2.0 */
/* short_memory.c PANEL... -- a host with little memory: every open gives a panel, or none with
 * a status and a message; the host goes on, keeps no byte and no file of what failed, and can
 * open again. Prints one line at the end; all else comes from the library, and must not. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <parhelion_panel.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static long failing = -1; /* this mapping is refused; -1: none */
static long mappings;

/* The library's, too. */
void *mmap(void *at, size_t size, int rights, int flags, int file, off_t from) {
    static void *(*real)(void *, size_t, int, int, int, off_t);
    if (!real) *(void **)&real = dlsym(RTLD_NEXT, "mmap");
    if (mappings++ == failing) return MAP_FAILED;
    return real(at, size, rights, flags, file, from);
}

static size_t mapped_bytes(void) {
    char line[100];
    size_t pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file && fgets(line, sizeof line, file)) pages = strtoul(line, NULL, 10);
    if (file) fclose(file);
    return pages * (size_t)sysconf(_SC_PAGESIZE);
}

/* The lowest number that a file would get. */
static int next_file(void) {
    int file = dup(0);
    close(file);
    return file;
}

/* 0: opened; 1: no memory, as it should be said; 2: something else. */
static int open_once(const char *path, const void *bytes, size_t size) {
    char error[300] = "";
    ParhelionPanel *panel = NULL;
    int status = bytes ? parhelion_panel_open_memory(bytes, size, &panel, error, sizeof error)
                       : parhelion_panel_open(path, &panel, error, sizeof error);
    int out = status == PARHELION_PANEL_OK && panel && !error[0]                         ? 0
              : status == PARHELION_PANEL_NO_MEMORY && !panel && strstr(error, "memory") ? 1
                                                                                         : 2;
    if (out == 2) fprintf(stderr, "%s: status %d: %s\n", path, status, error);
    parhelion_panel_close(panel);
    return out;
}

static void limit_addresses(size_t bytes) {
    struct rlimit limit;
    getrlimit(RLIMIT_AS, &limit);
    limit.rlim_cur = bytes ? bytes : limit.rlim_max;
    if (setrlimit(RLIMIT_AS, &limit)) _exit(9);
}

/* In a process of its own: refused within `bytes` more than it has, then opened without. */
static int try_limit(const char *path, const void *bytes, size_t size, size_t more) {
    pid_t child = fork();
    int status;
    if (child == 0) {
        size_t before = mapped_bytes();
        int file = next_file();
        limit_addresses(before + more);
        int found = open_once(path, bytes, size);
        limit_addresses(0);
        if (mapped_bytes() != before || next_file() != file) _exit(3);
        _exit(found == 2 || open_once(path, bytes, size) != 0 ? 4 : found);
    }
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

static int try_limits(const char *path, const void *bytes, size_t size, int *refused) {
    int status = 1;
    for (size_t more = 0; status == 1 && more < (size_t)4 << 30; more += more / 8 + 200000) {
        status = try_limit(path, bytes, size, more);
        *refused += status == 1;
    }
    if (status) fprintf(stderr, "%s: status %d with little address space\n", path, status);
    return status != 0;
}

/* Every mapping of an open fails once. */
static int try_mappings(const char *path) {
    int faults = 0, found = 1;
    for (long n = 0; found == 1; n++) {
        size_t before = mapped_bytes();
        mappings = 0, failing = n;
        found = open_once(path, NULL, 0);
        failing = -1;
        faults += found == 2 || mapped_bytes() != before || (n == 0 && found != 1);
    }
    if (faults) fprintf(stderr, "%s: %d faults where a mapping fails\n", path, faults);
    return faults;
}

int main(int count, char **arguments) {
    int faults = 0, refused = 0;
    for (int i = 1; i < count; i++) {
        static char bytes[1 << 22];
        FILE *file = fopen(arguments[i], "rb");
        size_t size = file ? fread(bytes, 1, sizeof bytes, file) : 0;
        if (file) fclose(file);
        if (open_once(arguments[i], NULL, 0)) return 5; /* libc's own buffers are there now */
        faults += try_limits(arguments[i], NULL, 0, &refused);
        faults += try_limits(arguments[i], bytes, size, &refused);
        faults += try_mappings(arguments[i]);
    }
    printf("%d faults, %d refused\n", faults, refused);
    return faults != 0;
}
