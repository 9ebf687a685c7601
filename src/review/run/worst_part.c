/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/worst_part.h"

#include <math.h>
#include <string.h>

#include "base/sampler.h"
#include "base/units.h"
#include "review/light/sun_parts.h"

#define CELLS_MOST 1024
#define SUN_PATHS 2048   /* the direct sun's, of all cells together */
#define FIELD_PATHS 2048
#define FIELD_SEED 0x6669656cu
#define LIT_POINTS 4096  /* that tell the share in the sun: within half a percent */

/* The direct sun of each cell that is seen, and its mean by the display's mirror. */
static double add_sun(const Setup *setup, const LightParts *parts, double *known, Arena scratch)
{
    Vec3   towards;
    float  bands[LIGHT_BANDS];
    double mirror = 0;
    if (!setup_sun(setup, &towards, bands)) return 0;
    ProbeSuns sun = {&towards, 1, (float)radians_from_degrees(SUN_MEAN_RADIUS_DEG), false};
    ResponseOptions options = {setup->tools.kernel, 0, SUN_PATHS, setup->tools.threads, 0};
    sun_parts_light(parts, &options, &sun, bands, known, &mirror, scratch);
    return mirror;
}

/* The part, and the mean of all that paths find. */
static int read_all(const Setup *setup, const LightParts *parts, CaseWhole *whole,
                    Arena scratch)
{
    int          targets = parts->aim.target_count;
    double      *known = ARENA_NEW(&scratch, double, targets);
    TargetLight *found = ARENA_NEW(&scratch, TargetLight, targets);
    double       mirror = add_sun(setup, parts, known, scratch);
    PathContext  without = *parts->aim.context;
    ProbeAim     aim = parts->aim;
    without.without_mirrored_sun = mirror > 0;
    aim.context = &without;
    aim.seed = hash_combine(hash_u32(aim.seed), FIELD_SEED);
    Reading mean = setup_field(setup, &aim, FIELD_PATHS, mirror, found, scratch);
    whole->reflected = mean.reflected;
    whole->reflected_range = mean.interval;
    return light_parts_choose(parts, found, known, scratch);
}

static int part_by_sun(const Setup *setup, const LightParts *parts, Arena scratch)
{
    double *known = ARENA_NEW(&scratch, double, parts->aim.target_count);
    double *means = ARENA_NEW(&scratch, double, light_parts_count(parts));
    add_sun(setup, parts, known, scratch);
    return light_parts_worst(parts, known, means, NULL, scratch);
}

/* NaN: there is no sun. */
static double lit_share(const Setup *setup, const PartAsk *ask, Arena scratch)
{
    Vec3          towards;
    float         bands[LIGHT_BANDS];
    SymbolSurface surface;
    Error         ignored;
    bool *is_visible = ARENA_NEW(&scratch, bool, LIT_POINTS);
    if (!setup_sun(setup, &towards, bands) ||
        !symbol_surface_within(&ask->symbol->surface, ask->symbol->split.box, LIT_POINTS,
                               &scratch, &surface, &ignored))
        return (double)NAN;
    symbol_visibility(&surface, &setup->context, ask->eye, is_visible);
    return symbol_lit_share(&surface, is_visible, &setup->context, towards);
}

/* At what is seen of a part. */
static void aim_at(const SymbolSurface *surface, ProbeAim *aim, Arena *arena)
{
    bool is_visible[SYMBOL_POINTS];
    symbol_visibility(surface, aim->context, aim->eye, is_visible);
    symbol_aim(surface, is_visible, arena, aim);
}

/* At all of it where nothing of the part is seen, or some of it is not shown. */
static void aim_at_part(const SymbolSurface *all, WorstPart *out, Arena *arena)
{
    SymbolSurface surface;
    Error         ignored;
    double        uv[4];
    memcpy(uv, &out->whole.part, sizeof uv);
    if (symbol_surface_within(all, uv, SYMBOL_POINTS, arena, &surface, &ignored))
        aim_at(&surface, &out->aim, arena);
    if (out->aim.target_count) return;
    memcpy(&out->whole.part, all->uv, sizeof uv);
    aim_at(all, &out->aim, arena);
}

WorstPart worst_part_find(const Setup *setup, const PartAsk *ask, Arena *arena)
{
    const double nan = (double)NAN;
    WorstPart    out = {.whole = {.reflected = nan, .reflected_range = {nan, nan},
                                  .contrast_ratio = nan, .lit_share = nan}};
    Arena scratch = arena_reserve((size_t)1 << 28);
    out.aim = (ProbeAim){.context = &setup->context, .eye = ask->eye, .seed = ask->seed};
    LightParts parts = symbol_parts(ask->symbol, &out.aim, CELLS_MOST, &scratch);
    memcpy(&out.whole.part, ask->symbol->surface.uv, sizeof out.whole.part);
    if (parts.aim.target_count) {
        double uv[4];
        int    part = ask->is_coarse ? part_by_sun(setup, &parts, scratch)
                                     : read_all(setup, &parts, &out.whole, scratch);
        symbol_part_box(ask->symbol, &parts, part, uv);
        memcpy(&out.whole.part, uv, sizeof uv);
        if (!ask->is_coarse) out.whole.lit_share = lit_share(setup, ask, scratch);
    }
    arena_release(&scratch);
    aim_at_part(&ask->symbol->surface, &out, arena);
    return out;
}
