/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/worst_part.h"

#include <math.h>
#include <string.h>

#include "base/units.h"
#include "review/light/response_suns.h"

#define CELLS_MOST 1024
#define SUN_PATHS 2048   /* the direct sun's, of all cells together */
#define FIELD_PATHS 2048 /* where the direct sun tells parts apart; else */
#define SHADE_PATHS 8192 /* they show a rise of about 15 % in the shipped car, by day */
#define FIELD_SEED 0x6669656cu /* whatever the review's: all seeds judge the same part */
#define LIT_POINTS 4096  /* that show the share in the sun: within half a percent */

/* The direct sun of each cell that is seen, and its mean by the display's mirror. */
static double add_sun(const Setup *setup, const LightParts *parts, double *known, Arena scratch)
{
    Vec3  towards;
    float bands[LIGHT_BANDS];
    if (!setup_sun_coloured(setup, parts->aim.colour, &towards, bands)) return 0;
    ProbeSuns sun = {&towards, 1, (float)radians_from_degrees(SUN_MEAN_RADIUS_DEG), false};
    ResponseOptions options = {setup->tools.kernel, 0, SUN_PATHS, setup->tools.threads, 0};
    return sun_parts_light(parts, &options, &sun, bands, known, scratch);
}

static bool is_shade(const double *known, int targets)
{
    for (int i = 0; i < targets; i++)
        if (known[i] > 0) return false;
    return true;
}

/* The part, and the mean of all that paths find. The sun's image is not known by itself as a
 * polariser sees it: paths find it then. */
static int read_all(const Setup *setup, const LightParts *parts, CaseWhole *whole,
                    Arena scratch)
{
    int          targets = parts->aim.target_count;
    double      *known = ARENA_NEW(&scratch, double, targets);
    TargetLight *found = ARENA_NEW(&scratch, TargetLight, targets);
    double       sun = add_sun(setup, parts, known, scratch);
    double       mirror = parts->aim.context->eye ? 0 : sun;
    PathContext  without = *parts->aim.context;
    ProbeAim     aim = parts->aim;
    without.without_mirrored_sun = mirror > 0;
    aim.context = &without;
    aim.seed = FIELD_SEED;
    long    paths = is_shade(known, targets) ? SHADE_PATHS : FIELD_PATHS;
    Reading mean = setup_field(setup, &aim, paths, mirror, found, scratch);
    whole->reflected = mean.reflected;
    whole->reflected_range = mean.interval;
    return light_parts_choose(parts, found, known, scratch);
}

static int part_by_sun(const Setup *setup, const LightParts *parts, Arena scratch)
{
    double *known = ARENA_NEW(&scratch, double, parts->aim.target_count);
    TargetLight *none = ARENA_NEW(&scratch, TargetLight, parts->aim.target_count);
    add_sun(setup, parts, known, scratch);
    return light_parts_choose(parts, none, known, scratch);
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
    symbol_visibility(&surface, &setup->context, ask->aim->eye, is_visible);
    return symbol_lit_share(&surface, is_visible, &setup->context, towards);
}

/* At what is seen of a part. */
static void aim_at(const SymbolSurface *surface, ProbeAim *aim, Arena *arena)
{
    bool is_visible[SYMBOL_POINTS];
    symbol_visibility(surface, aim->context, aim->eye, is_visible);
    symbol_aim(surface, is_visible, arena, aim);
}

/* False: nothing of it is seen, or some of it is not shown. */
static bool aim_at_box(const SymbolSurface *all, const double uv[4], WorstPart *out,
                       Arena *arena)
{
    SymbolSurface surface;
    Error         ignored;
    memcpy(&out->whole.part, uv, sizeof out->whole.part);
    out->aim.target_count = 0;
    if (symbol_surface_within(all, uv, SYMBOL_POINTS, arena, &surface, &ignored))
        aim_at(&surface, &out->aim, arena);
    return out->aim.target_count > 0;
}

static void aim_at_all(const SymbolSurface *all, WorstPart *out, Arena *arena)
{
    memcpy(&out->whole.part, all->uv, sizeof out->whole.part);
    aim_at(all, &out->aim, arena);
}

WorstPart worst_part_find(const Setup *setup, const PartAsk *ask, Arena *arena)
{
    const SymbolSurface *all = &ask->symbol->surface;
    WorstPart out = {*ask->aim, case_whole_unknown()};
    Arena     scratch = arena_reserve((size_t)1 << 28);
    double    uv[4];
    LightParts parts = symbol_parts(ask->symbol, ask->aim, CELLS_MOST, &scratch);
    memcpy(uv, all->uv, sizeof uv);
    if (parts.aim.target_count) {
        int part = ask->is_coarse ? part_by_sun(setup, &parts, scratch)
                                  : read_all(setup, &parts, &out.whole, scratch);
        if (part != LIGHT_PARTS_ALL) symbol_part_box(ask->symbol, &parts, part, uv);
        if (!ask->is_coarse) out.whole.lit_share = lit_share(setup, ask, scratch);
    }
    arena_release(&scratch);
    if (!aim_at_box(all, uv, &out, arena)) aim_at_all(all, &out, arena);
    return out;
}

/* ---- the mean in its place --------------------------------------------------------------- */

bool worst_part_is_better(const CaseWhole *whole, MeanInterval reading)
{
    return reading.high < whole->reflected_range.low; /* not where the mean is not known */
}

void worst_part_take_all(const SetupSymbol *symbol, WorstPart *part, Arena *arena)
{
    aim_at_all(&symbol->surface, part, arena);
}
