/* SPDX-License-Identifier: Apache-2.0 */
/* replay.c -- every input of the corpora once, without libFuzzer: fuzz_replay FOLDER...
 *
 * A folder holds one folder a target (tests/fuzz/corpus, tests/fuzz/found). Each input is also
 * mutated a few times by the target's own mutator, so that this code is run as well. A failed
 * claim or a sanitizer's report ends the process; every input is named before it is run. Each
 * target has a good input, which its reader takes; and no reader ends the process unseen.
 */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "harness.h"

enum { MUTATIONS = 2, ROOM = 2, MADE_MUTATIONS = 200 };

/* What a mutator makes beyond its own changes: here nothing. */
size_t fuzz_mutate_bytes(uint8_t *data, size_t size, size_t max_size) {
    (void)data;
    return size < max_size ? size : max_size;
}

static int good_inputs; /* of the target in hand */
static bool is_at_the_end;

static void claim_the_end(void) {
    if (is_at_the_end) return;
    fprintf(stderr, "the last input ended the process\n");
    _exit(1);
}

/* In a block of exactly its size, so that the address sanitizer sees a step beyond. */
static void run_exact(const FuzzTarget *target, const uint8_t *data, size_t size) {
    uint8_t *exact = malloc(size + !size);
    memcpy(exact, data, size);
    fuzz_run(target, exact, size);
    free(exact);
}

static void run_good(const FuzzTarget *target, const uint8_t *data, size_t size) {
    long before = fuzz_refusals();
    run_exact(target, data, size);
    good_inputs += fuzz_refusals() == before;
}

static int replay_file(const FuzzTarget *target, const char *path, Arena arena) {
    Error err = {0};
    FileBytes bytes;
    if (!file_read(path, FUZZ_ARENA_BYTES, &arena, &bytes, &err)) return 0;
    fprintf(stderr, "%s\n", path);
    run_good(target, bytes.data, bytes.size);
    for (unsigned i = 0; target->mutate && i < MUTATIONS; i++) {
        size_t room = ROOM * bytes.size + 64;
        uint8_t *changed = ARENA_NEW(&arena, uint8_t, room);
        memcpy(changed, bytes.data, bytes.size);
        run_exact(target, changed, target->mutate(changed, bytes.size, room, i));
    }
    return 1;
}

static int replay_folder(const FuzzTarget *target, const char *folder, Arena arena) {
    int count = 0;
    DIR *inputs = opendir(arena_format(&arena, "%s/%s", folder, target->name));
    if (!inputs) return 0;
    for (struct dirent *e; (e = readdir(inputs));)
        if (e->d_name[0] != '.')
            count += replay_file(
                target, arena_format(&arena, "%s/%s/%s", folder, target->name, e->d_name), arena);
    closedir(inputs);
    return count;
}

/* What the target makes itself, and many mutations of it: no corpus holds them. */
static int replay_made(const FuzzTarget *target, Arena arena) {
    int count = 0;
    size_t size;
    uint8_t *made = ARENA_NEW(&arena, uint8_t, target->max_size);
    uint8_t *changed = ARENA_NEW(&arena, uint8_t, target->max_size);
    for (; (size = fuzz_make(target, made, (unsigned)count)) > 0; count++) {
        fprintf(stderr, "%s: made %d\n", target->name, count);
        run_good(target, made, size);
        for (unsigned i = 0; target->mutate && i < MADE_MUTATIONS; i++) {
            memcpy(changed, made, size);
            run_exact(target, changed, target->mutate(changed, size, target->max_size, i));
        }
    }
    return count;
}

int main(int argc, char **argv) {
    int count = 0, without = 0;
    atexit(claim_the_end);
    Arena arena = arena_reserve(FUZZ_ARENA_BYTES);
    for (const FuzzTarget *target = fuzz_targets; target->name; target++) {
        good_inputs = 0;
        count += replay_made(target, arena);
        for (int i = 1; i < argc; i++) count += replay_folder(target, argv[i], arena);
        without += !good_inputs;
        if (!good_inputs) fprintf(stderr, "%s: no good input\n", target->name);
    }
    arena_release(&arena);
    printf("[  PASSED  ] %d inputs.\n", count); /* as tests/steps.sh counts */
    is_at_the_end = true;
    return without ? 1 : 0;
}
