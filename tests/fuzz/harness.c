/* SPDX-License-Identifier: Apache-2.0 */
#include "harness.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* So many files are made before the folder is emptied. */
#define FILES_KEPT 4096
/* More than this is given back to the system after a run. */
#define ARENA_KEPT_BYTES ((size_t)1 << 25)

static Arena whole;
static char folder[512];
static int files_made;
static const FuzzTarget *running;
static long refusals;

/* ---- claims ------------------------------------------------------------------------------ */

void fuzz_claim(bool holds, const char *what) {
    if (holds) return;
    fprintf(stderr, "claim failed: %s\n", what);
    abort();
}

long fuzz_refusals(void) {
    return refusals;
}

void fuzz_claim_refusal(const Error *err) {
    refusals++;
    char line[4096];
    error_line(err, line, sizeof line);
    bool is_ours = err->code == ERROR_INPUT || err->code == ERROR_USAGE ||
                   err->code == ERROR_LIBRARY || err->code == ERROR_MEMORY;
    if (!is_ours || !err->text[0] || strchr(line, '\n')) fprintf(stderr, "%s\n", line);
    fuzz_claim(is_ours, "a refusal's code is that of bad input");
    fuzz_claim(err->text[0] != 0, "a refusal has a text");
    fuzz_claim(!strchr(line, '\n'), "a refusal is one line");
}

/* ---- files ------------------------------------------------------------------------------- */

static int remove_one(const char *path, const struct stat *status, int kind, struct FTW *walk) {
    (void)status, (void)kind;
    return walk->level ? remove(path) : 0;
}

static void empty_folder(void) {
    nftw(folder, remove_one, 16, FTW_DEPTH | FTW_PHYS);
    files_made = 0;
}

static void remove_folder(void) {
    empty_folder();
    rmdir(folder);
}

static void make_folder(void) {
    const char *base = getenv("TMPDIR");
    if (!base) base = !access("/dev/shm", W_OK) ? "/dev/shm" : P_tmpdir;
    snprintf(folder, sizeof folder, "%s/parhelion_fuzz_XXXXXX", base);
    fuzz_claim(mkdtemp(folder) != NULL, "a temporary folder can be made");
    atexit(remove_folder);
}

const char *fuzz_path(const char *name, Arena *arena) {
    if (!folder[0]) make_folder();
    files_made++;
    return arena_format(arena, "%s/%s", folder, name);
}

const char *fuzz_file(const char *name, const void *data, size_t size, Arena *arena) {
    const char *path = fuzz_path(name, arena);
    FILE *file = fopen(path, "wb");
    fuzz_claim(file && fwrite(data, 1, size, file) == size && fclose(file) == 0,
               "a temporary file can be written");
    return path;
}

char *fuzz_text(const uint8_t *data, size_t size, Arena *arena) {
    return arena_string(arena, (const char *)data, size);
}

/* ---- running ----------------------------------------------------------------------------- */

const FuzzTarget *fuzz_target_named(const char *name) {
    for (const FuzzTarget *target = fuzz_targets; target->name; target++)
        if (!strcmp(target->name, name)) return target;
    return NULL;
}

const char *fuzz_more(void) {
    return running->more;
}

static void arena_is_full(size_t bytes_wanted, size_t bytes_left) {
    fprintf(stderr, "%zu bytes required, %zu left\n", bytes_wanted, bytes_left);
    fuzz_claim(false, "a small input needs little memory");
}

static Arena start_run(void) {
    if (!whole.begin) {
        whole = arena_reserve(FUZZ_ARENA_BYTES);
        whole.on_full = arena_is_full;
    }
    if (files_made > FILES_KEPT) empty_folder();
    return whole;
}

size_t fuzz_make(const FuzzTarget *target, uint8_t *data, unsigned number) {
    Arena arena = start_run();
    return target->make ? target->make(data, target->max_size, number, &arena) : 0;
}

void fuzz_run(const FuzzTarget *target, const uint8_t *data, size_t size) {
    Arena arena = start_run();
    running = target;
    target->run(data, size, &arena);
    if ((size_t)(arena.next - whole.next) > ARENA_KEPT_BYTES)
        madvise(whole.begin + (1 << 16), (size_t)(whole.end - whole.begin) - (1 << 16),
                MADV_DONTNEED);
}
