/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/sun_parts.h"

#include <math.h>
#include <string.h>

#include "review/light/light_bands.h"

#define BLOCK 4096 /* suns whose targets are kept apart together */

static bool is_any(const float shares[RESPONSE_BANDS])
{
    for (int b = 0; b < RESPONSE_BANDS; b++)
        if (shares[b] > 0) return true;
    return false;
}

/* Of one sun, by its targets; what all of them send on the average becomes the worst part's. */
static void take_worst(const LightParts *parts, const double *by_target,
                       float shares[RESPONSE_BANDS], Arena scratch)
{
    double *means = ARENA_NEW(&scratch, double, light_parts_count(parts));
    double  all = 0;
    int     worst = light_parts_worst(parts, by_target, means, NULL, scratch);
    for (int i = 0; i < parts->aim.target_count; i++) all += by_target[i];
    if (worst < 0 || !(all > 0)) return;
    double ratio = means[worst] * parts->aim.target_count / all;
    for (int b = 0; b < RESPONSE_BANDS; b++) shares[b] *= (float)ratio;
}

/* shares: [sun][band], set. */
static void ask_block(const LightParts *parts, const ResponseOptions *options,
                      const ProbeSuns *suns, float *shares, Arena scratch)
{
    size_t  targets = (size_t)parts->aim.target_count;
    double *by_target = ARENA_NEW(&scratch, double, (size_t)suns->count * targets);
    float   white[RESPONSE_BANDS];
    light_bands_white(white);
    const float *all =
        response_suns_by_target(&parts->aim, options, suns, white, by_target, &scratch);
    memcpy(shares, all, (size_t)suns->count * RESPONSE_BANDS * sizeof *shares);
    for (int i = 0; i < suns->count; i++)
        if (is_any(shares + (size_t)i * RESPONSE_BANDS))
            take_worst(parts, by_target + (size_t)i * targets,
                       shares + (size_t)i * RESPONSE_BANDS, scratch);
}

static void ask_blocks(const LightParts *parts, const ResponseOptions *options,
                       const ProbeSuns *suns, float *shares, Arena scratch)
{
    for (int first = 0; first < suns->count; first += BLOCK) {
        ProbeSuns block = *suns;
        block.towards += first;
        block.count = suns->count - first < BLOCK ? suns->count - first : BLOCK;
        ask_block(parts, options, &block, shares + (size_t)first * RESPONSE_BANDS, scratch);
    }
}

/* Few suns of many have their image in what is looked at: those alone are asked by target. */
static void ask_mirrored(const LightParts *parts, const ResponseOptions *options,
                         const ProbeSuns *suns, float *shares, Arena scratch)
{
    const float *all = response_suns(&parts->aim, options, suns, &scratch);
    int         *list = ARENA_NEW(&scratch, int, suns->count);
    Vec3        *towards = ARENA_NEW(&scratch, Vec3, suns->count);
    ProbeSuns    some = *suns;
    some.towards = towards;
    some.count = 0;
    for (int i = 0; i < suns->count; i++) {
        if (!is_any(all + (size_t)i * RESPONSE_BANDS)) continue;
        towards[some.count] = suns->towards[i];
        list[some.count++] = i;
    }
    float *of_some = ARENA_NEW(&scratch, float, (size_t)some.count * RESPONSE_BANDS);
    ask_blocks(parts, options, &some, of_some, scratch);
    for (int i = 0; i < some.count; i++)
        memcpy(shares + (size_t)list[i] * RESPONSE_BANDS, of_some + (size_t)i * RESPONSE_BANDS,
               RESPONSE_BANDS * sizeof *shares);
}

const float *sun_parts_worst(const ProbeAim *aim, const LightParts *parts,
                             const ResponseOptions *options, const ProbeSuns *suns,
                             Arena *arena)
{
    if (!parts) return response_suns(aim, options, suns, arena);
    float *shares = ARENA_NEW(arena, float, (size_t)suns->count * RESPONSE_BANDS);
    (suns->by_mirror ? ask_mirrored : ask_blocks)(parts, options, suns, shares, *arena);
    return shares;
}

static double add_light(const LightParts *parts, const ResponseOptions *options,
                        const ProbeSuns *sun, const float bands[RESPONSE_BANDS], double *of,
                        Arena scratch)
{
    double *by_target = ARENA_NEW(&scratch, double, parts->aim.target_count), sum = 0;
    response_suns_by_target(&parts->aim, options, sun, bands, by_target, &scratch);
    for (int i = 0; i < parts->aim.target_count; i++) {
        of[i] += by_target[i];
        sum += by_target[i];
    }
    return sum / parts->aim.target_count;
}

void sun_parts_light(const LightParts *parts, const ResponseOptions *options,
                     const ProbeSuns *sun, const float bands[RESPONSE_BANDS], double *of,
                     double *mirror, Arena scratch)
{
    ProbeSuns       once = *sun;
    ResponseOptions by_mirror = *options;
    once.by_mirror = false;
    add_light(parts, options, &once, bands, of, scratch);
    once.by_mirror = true;
    by_mirror.paths = response_mirror_paths(&parts->aim, sun->radius);
    *mirror = add_light(parts, &by_mirror, &once, bands, of, scratch);
}
