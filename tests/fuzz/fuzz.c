/* SPDX-License-Identifier: Apache-2.0 */
/* fuzz.c -- libFuzzer's view of one target: fuzz --target=NAME [libFuzzer's options] CORPUS...
 *
 * Without --target the names of all targets are listed, each with the largest input that makes
 * sense for it. (libFuzzer leaves options that begin with two dashes alone.)
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness.h"

int    LLVMFuzzerInitialize(int *argc, char ***argv);
int    LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed);
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max_size);

static const FuzzTarget *target;

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    for (int i = 1; i < *argc; i++)
        if (!strncmp((*argv)[i], "--target=", 9)) target = fuzz_target_named((*argv)[i] + 9);
    if (target) return 0;
    for (const FuzzTarget *t = fuzz_targets; t->name; t++)
        printf("%s %zu\n", t->name, t->max_size);
    exit(0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_run(target, data, size);
    return 0;
}

size_t fuzz_mutate_bytes(uint8_t *data, size_t size, size_t max_size)
{
    return LLVMFuzzerMutate(data, size, max_size);
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    return target->mutate ? target->mutate(data, size, max_size, seed)
                          : LLVMFuzzerMutate(data, size, max_size);
}
