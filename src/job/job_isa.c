/* SPDX-License-Identifier: Apache-2.0 */
#include "job/job_isa.h"

#include <string.h>
#include <strings.h>

#include "base/count.h"
#include "job/job_manifest.h"
#include "job/slurm.h"
#include "render/identity.h"

typedef enum IsaLevel { ISA_SSE2, ISA_AVX2, ISA_AVX512, ISA_LEVELS } IsaLevel;

static const char *const names[ISA_LEVELS] = {"sse2", "avx2", "avx512"};

/* How a node's features begin that name an instruction set; the first that fits counts. */
static const struct {
    const char *begin;
    IsaLevel    level;
} features[] = {{"avx512", ISA_AVX512}, {"x86-64-v4", ISA_AVX512}, {"x86_64_v4", ISA_AVX512},
                {"avx2", ISA_AVX2},     {"x86-64-v3", ISA_AVX2},   {"x86_64_v3", ISA_AVX2},
                {"avx", ISA_SSE2},      {"sse", ISA_SSE2},         {"x86-64", ISA_SSE2},
                {"x86_64", ISA_SSE2}};

/* Of "gpu,avx512f,ib". A node that names none has AVX2, as servers of the last ten years. */
static IsaLevel level_of(const char *line)
{
    int best = -1;
    for (const char *word = line; word;) {
        for (int i = 0; i < COUNT_OF(features); i++) {
            if (strncasecmp(word, features[i].begin, strlen(features[i].begin)) != 0) continue;
            if ((int)features[i].level > best) best = (int)features[i].level;
            break;
        }
        word = strpbrk(word, ",\n");
        word = word && *word == ',' ? word + 1 : NULL;
    }
    return best < 0 ? ISA_AVX2 : (IsaLevel)best;
}

/* The best that all nodes and this machine have; NULL: Slurm names no node. */
static const char *least_of_nodes(Arena *arena)
{
    Error         ignored;
    const Kernel *kernel;
    const char   *lines;
    int           least = ISA_LEVELS;
    if (!slurm_features(arena, &lines, &ignored)) return NULL;
    for (const char *line = lines; line && *line; line = strchr(line, '\n'), line += !!line)
        if (*line != '\n' && (int)level_of(line) < least) least = (int)level_of(line);
    for (int i = least == ISA_LEVELS ? -1 : least; i >= 0; i--)
        if (kernel_choose(names[i], &kernel, &ignored)) return names[i];
    return NULL;
}

/* NULL: there is none, or this machine cannot plan it. */
static const char *of_job(const char *dir, Arena *arena)
{
    SharedJob     there;
    Error         ignored;
    const Kernel *kernel;
    return job_manifest_is_there(dir, *arena) &&
                   job_manifest_read(dir, arena, &there, &ignored) &&
                   kernel_choose(there.isa, &kernel, &ignored)
               ? there.isa
               : NULL;
}

bool job_isa_choose(const char *typed, const char *dir, Arena *arena, const char **out,
                    Error *err)
{
    const Kernel *kernel;
    if (!typed) typed = of_job(dir, arena);
    if (!typed) typed = least_of_nodes(arena);
    if (!kernel_choose(typed, &kernel, err)) return false;
    *out = kernel->isa;
    return true;
}
