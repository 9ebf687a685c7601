/* SPDX-License-Identifier: Apache-2.0 */
/* fuzz.c -- libFuzzer's view of one target: fuzz --target=NAME [libFuzzer's options] CORPUS...
 *
 * With --make=FOLDER the inputs that the target makes itself are written there instead.
 * Without --target the names of all targets are listed, each with the largest input that makes
 * sense for it. (libFuzzer leaves options that begin with two dashes alone.)
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness.h"

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed);
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max_size);

static const FuzzTarget *target;

static void make_inputs(const char *to) {
    uint8_t *data = malloc(target->max_size);
    char path[4096];
    size_t size;
    for (unsigned i = 0; (size = fuzz_make(target, data, i)) > 0; i++) {
        snprintf(path, sizeof path, "%s/made-%u", to, i);
        FILE *file = fopen(path, "wb");
        fuzz_claim(file && fwrite(data, 1, size, file) == size && fclose(file) == 0,
                   "an input can be written");
    }
    free(data);
    exit(0);
}

int LLVMFuzzerInitialize(int *argc, char ***argv) {
    for (int i = 1; i < *argc; i++)
        if (!strncmp((*argv)[i], "--target=", 9)) target = fuzz_target_named((*argv)[i] + 9);
    for (int i = 1; i < *argc && target; i++)
        if (!strncmp((*argv)[i], "--make=", 7)) make_inputs((*argv)[i] + 7);
    if (target) return 0;
    for (const FuzzTarget *t = fuzz_targets; t->name; t++) printf("%s %zu\n", t->name, t->max_size);
    exit(0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    fuzz_run(target, data, size);
    return 0;
}

size_t fuzz_mutate_bytes(uint8_t *data, size_t size, size_t max_size) {
    return LLVMFuzzerMutate(data, size, max_size);
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    return target->mutate ? target->mutate(data, size, max_size, seed)
                          : LLVMFuzzerMutate(data, size, max_size);
}
