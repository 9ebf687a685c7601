/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/causes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "review/chain/chains.h"
#include "review/judge.h"

#define LEAST_PART 0.01 /* of what is reflected: a part that is worth a word */
#define COATED 0.25 /* of a mirror's light that a usual anti-reflection coating leaves */

/* ---- causes ------------------------------------------------------------------------------ */

static const CaseRay *rays_of(const Chain *chain, int most, int *count, Arena *arena)
{
    *count = chain->ray_count < most ? chain->ray_count : most;
    CaseRay *rays = ARENA_NEW(arena, CaseRay, *count);
    for (int i = 0; i < *count; i++) {
        const ChainRay *from = &chain->rays[i];
        Vec3           *points = ARENA_NEW(arena, Vec3, from->count);
        for (int k = 0; k < from->count; k++) points[k] = from->point[k];
        rays[i] = (CaseRay){points, from->count};
    }
    return rays;
}

static CaseCause cause_of(ChainFigure figure, const Chains *chains, const ReviewCase *c)
{
    const CaseLuminances *l = &c->luminance_cd_m2;
    double all = chains->all.cd_m2;
    double left = fmax(l->reflected - figure.cd_m2, 0);
    return (CaseCause){.share = all > 0 ? figure.cd_m2 / all : 0, .cd_m2 = figure.cd_m2,
                       .low = figure.low, .high = figure.high,
                       .contrast_without =
                           luminance_contrast(l->foreground, l->background, left)};
}

static CaseCause all_other(const Chains *chains, const ReviewCase *c, Arena *arena)
{
    CaseCause    cause = cause_of(chains->rest, chains, c);
    const char **words = ARENA_NEW(arena, const char *, 1);
    words[0] = "all other ways";
    cause.chain = words;
    cause.links = 1;
    return cause;
}

/* Adds the surface or (of_panes) the pane by which most light comes. */
static void add_part(const Chains *chains, bool of_panes, CauseFacts *facts, Arena *arena)
{
    const Scene *scene = chains->scene;
    int          most = NO_ID;
    for (int i = 0; i < scene->part_count; i++) {
        const Material *m = &scene->materials[scene->parts[i].material_id];
        if (m->lets_light_through != of_panes || m->display_id != NO_ID) continue;
        if (most == NO_ID || chains->by_part[i] > chains->by_part[most]) most = i;
    }
    if (most == NO_ID || !(chains->by_part[most] > LEAST_PART * chains->all.cd_m2)) return;
    const char *name = chain_part_words(scene, most, arena);
    facts->parts[facts->part_count++] =
        (CausePart){arena_format(arena, of_panes ? "%s covered, in black"
                                                 : "%s black, without gloss", name),
                    chains->by_part[most]};
}

static CauseFacts facts_of(const Chains *chains, Arena *arena)
{
    CauseFacts facts = {.own_cd_m2 = chains->own, .all = chains->all,
                        .mirror = chains->mirror};
    add_part(chains, true, &facts, arena);
    add_part(chains, false, &facts, arena);
    return facts;
}

/* ---- groups ------------------------------------------------------------------------------ */

/* The greatest are listed up to this share of the light, and up to this count. */
#define GROUP_LISTED 0.97
#define GROUP_MOST 24

/* A group that grows. */
typedef struct Growing {
    CaseShare *list;
    int        count;
    double     all; /* cd m^-2 */
    Arena     *arena;
} Growing;

/* Things of the same name count as one: a row of street lamps. */
static void add(Growing *to, const char *what, double cd_m2)
{
    int i = 0;
    if (!(cd_m2 > 0)) return;
    while (i < to->count && strcmp(to->list[i].what, what) != 0) i++;
    if (i == to->count) to->list[to->count++] = (CaseShare){what, 0, 0};
    to->list[i].cd_m2 += cd_m2;
    to->list[i].share = to->list[i].cd_m2 / to->all;
}

static Growing grow(const Chains *chains, Arena *arena)
{
    int most = chains->scene->part_count + chains->scene->light_count + LIGHT_SETS + 1;
    return (Growing){ARENA_NEW(arena, CaseShare, most), 0, chains->all.cd_m2, arena};
}

static void add_parts(Growing *to, const Scene *scene, const double *by_part)
{
    for (int i = 0; i < scene->part_count; i++)
        if (by_part[i] > 0) add(to, chain_part_words(scene, i, to->arena), by_part[i]);
}

static Growing by_light(const Chains *chains, Arena *arena)
{
    const ChainGroups *groups = &chains->groups;
    const Scene       *scene = chains->scene;
    Growing            light = grow(chains, arena);
    add(&light, "sun", groups->by_set[LIGHTS_SUN]);
    add(&light, "sky", groups->by_set[LIGHTS_SKY]);
    add_parts(&light, scene, groups->by_emitter);
    for (int i = 0; i < scene->light_count; i++)
        if (groups->by_lamp[i] > 0)
            add(&light, chain_source_words(scene, LIGHTS_PUNCTUAL, i, arena),
                groups->by_lamp[i]);
    return light;
}

static Growing by_opening(const Chains *chains, Arena *arena)
{
    Growing opening = grow(chains, arena);
    add_parts(&opening, chains->scene, chains->groups.by_pane);
    add(&opening, "through no pane", chains->groups.by_no_pane);
    return opening;
}

static Growing by_surface(const Chains *chains, Arena *arena)
{
    const double *straight = chains->groups.straight;
    Growing       surface = grow(chains, arena);
    add_parts(&surface, chains->scene, chains->groups.by_surface);
    add(&surface, "the sun itself", straight[LIGHTS_SUN]);
    add(&surface, "the sky itself", straight[LIGHTS_SKY]);
    add(&surface, "lamps themselves", straight[LIGHTS_PUNCTUAL]);
    return surface;
}

static int compare(const void *a, const void *b)
{
    const CaseShare *x = a, *y = b;
    if (x->cd_m2 != y->cd_m2) return x->cd_m2 > y->cd_m2 ? -1 : 1;
    return strcmp(x->what, y->what);
}

/* A single one that is left is listed by its name, not as "other". */
static CaseGroup listed(Growing *group)
{
    double sum = 0, other = 0;
    int    count = 0;
    if (group->count) qsort(group->list, (size_t)group->count, sizeof *group->list, compare);
    while (count < group->count && count < GROUP_MOST && sum < GROUP_LISTED)
        sum += group->list[count++].share;
    if (count == group->count - 1) count++;
    for (int i = count; i < group->count; i++) other += group->list[i].cd_m2;
    if (count < group->count)
        group->list[count++] = (CaseShare){"other", other / group->all, other};
    return (CaseGroup){group->list, count};
}

static void set_groups(const Chains *chains, ReviewCase *c, Arena *arena)
{
    Growing of[CAUSE_GROUPS] = {[GROUP_LIGHT] = by_light(chains, arena),
                                [GROUP_OPENING] = by_opening(chains, arena),
                                [GROUP_SURFACE] = by_surface(chains, arena)};
    for (int i = 0; i < CAUSE_GROUPS; i++) c->groups[i] = listed(&of[i]);
    double all = chains->all.cd_m2;
    c->without_data_share = all > 0 ? chains->groups.without_data / all : 0;
}

/* ---- all of it --------------------------------------------------------------------------- */

static void set_luminances(const Chains *chains, CaseLuminances *l)
{
    l->reflected = chains->all.cd_m2;
    l->mirror = chains->mirror.cd_m2;
    l->scattered = l->reflected - l->mirror;
}

CauseFacts case_causes(const CauseAsk *ask, ReviewCase *c, Arena *arena)
{
    CaseCause *causes = ARENA_NEW(arena, CaseCause, CAUSES_MOST + 1);
    Arena    scratch = arena_reserve((size_t)1 << 28);
    ChainAsk chain_ask = {.aim = ask->aim, .tools = ask->tools, .paths = ask->paths,
                          .most = CAUSES_MOST, .with_direct = ask->with_direct};
    Chains   chains = chains_find(&chain_ask, &scratch);
    if (ask->sets_luminances) set_luminances(&chains, &c->luminance_cd_m2);
    for (int i = 0; i < chains.count; i++) {
        const Chain *chain = &chains.list[i];
        causes[i] = cause_of(chain->figure, &chains, c);
        causes[i].chain = chain_words(chains.scene, &chain->key, &causes[i].links, arena);
        causes[i].rays = rays_of(chain, ask->rays, &causes[i].ray_count, arena);
    }
    c->causes = causes;
    c->cause_count = chains.count;
    if (chains.others) causes[c->cause_count++] = all_other(&chains, c, arena);
    set_groups(&chains, c, arena);
    CauseFacts facts = facts_of(&chains, arena);
    arena_release(&scratch);
    return facts;
}

/* ---- what hides it ----------------------------------------------------------------------- */

static int compare_hiders(const void *a, const void *b)
{
    const CaseHider *x = a, *y = b;
    if (x->share != y->share) return x->share > y->share ? -1 : 1;
    return strcmp(x->what, y->what);
}

static void add_hider(CaseHider *list, int *count, const char *what, double share)
{
    int i = 0;
    if (!(share > 0)) return;
    while (i < *count && strcmp(list[i].what, what) != 0) i++;
    if (i == *count) list[(*count)++] = (CaseHider){what, 0};
    list[i].share += share;
}

void case_hiders(const SymbolSurface *surface, const PathContext *context, Vec3 eye,
                 ReviewCase *c, Arena *arena)
{
    const Scene *scene = context->scene;
    SymbolHiding hiding = symbol_hiding(surface, context, eye, arena);
    CaseHider   *list = ARENA_NEW(arena, CaseHider, scene->part_count + 1);
    c->hider_count = 0;
    add_hider(list, &c->hider_count, "its own back, which is turned to the eye",
              hiding.turned_away);
    for (int i = 0; i < scene->part_count; i++)
        if (hiding.by_part[i] > 0)
            add_hider(list, &c->hider_count, chain_part_words(scene, i, arena),
                      hiding.by_part[i]);
    qsort(list, (size_t)c->hider_count, sizeof *list, compare_hiders);
    c->hiders = list;
}

/* ---- remedies ---------------------------------------------------------------------------- */

/* What a remedy changes: factors on what the display emits and on its own light that comes back
 * to it, and on all that it reflects else. */
typedef struct Remedied {
    double brighter, reflected; /* reflected: cd m^-2 beside its own light, after */
} Remedied;

/* The case with so much light, judged again; the doubt is that of its reading, in proportion. */
static ReviewCase judged_with(const CauseFacts *facts, const Profile *profile,
                              const ReviewCase *c, Remedied with, Arena *arena)
{
    ReviewCase      out = *c;
    CaseLuminances *l = &out.luminance_cd_m2;
    double before = l->reflected, own = fmin(facts->own_cd_m2, before);
    l->foreground *= with.brighter;
    l->background *= with.brighter;
    l->reflected = with.reflected + with.brighter * own;
    double scale = before > 0 ? l->reflected / before : 1;
    out.level *= with.brighter;
    judge_contrasts(&out, (MeanInterval){scale * c->reflected_range.low,
                                         scale * c->reflected_range.high});
    judge_case(&out, profile, arena);
    return out;
}

/* Of the limits of contrast that count and are missed the one that is missed by most; -1. */
static int limit_to_mend(const ReviewCase *c)
{
    int worst = -1;
    for (int i = 0; i < c->limit_count; i++) {
        const LimitVerdict *limit = &c->limits[i];
        LimitKind           kind = limit_kind_named(limit->kind);
        bool is_missed = !limit->is_advice && limit->margin < 0 &&
                         (limit->verdict == VERDICT_FAIL || limit->verdict == VERDICT_TOO_CLOSE);
        if (!is_missed || !limit_kinds[kind].is_contrast) continue;
        if (worst < 0 || limit->margin < c->limits[worst].margin) worst = i;
    }
    return worst;
}

/* By how much the display must be brighter, or darker, for a contrast,
 * (H x + R + O x) / (L x + R + O x) = C, O its own light that is reflected, R all other;
 * NaN: no brightness does it. */
static double brighter_for(const CaseLuminances *l, double own, double other, double wanted)
{
    double high = fmax(l->foreground, l->background), low = fmin(l->foreground, l->background);
    double gain = high + own - wanted * (low + own);
    return gain > 0 ? other * (wanted - 1) / gain : (double)NAN;
}

/* To three digits, away from 1. */
static double rounded_out(double factor)
{
    double digit = pow(10, floor(log10(factor)) - 2);
    return digit * (factor > 1 ? ceil(factor / digit) : floor(factor / digit));
}

typedef struct Remedies {
    const CauseFacts *facts;
    const Profile    *profile;
    ReviewCase       *c;
    int               limit; /* that they are for */
    CaseRemedy       *list;
    Arena            *arena;
} Remedies;

/* Nothing that leaves the figure within its interval. */
static void add_remedy(Remedies *to, const char *what, const ReviewCase *then)
{
    const LimitVerdict *before = &to->c->limits[to->limit], *after = &then->limits[to->limit];
    bool helps = before->is_upper ? after->found < before->low : after->found > before->high;
    if (then->limit_count != to->c->limit_count || !helps) return;
    to->list[to->c->remedy_count++] =
        (CaseRemedy){what, then->contrast_ratio, then->level, *after, then->verdict};
}

#define BRIGHTER_TRIES 40
#define BRIGHTER_STEP 1.05 /* the panel's errors are in the interval, too */

/* The least brightness with which the limit is judged to be kept although as much more is
 * reflected as the interval is wide. */
static void add_brightness(Remedies *to)
{
    const ReviewCase   *c = to->c;
    const LimitVerdict *limit = &c->limits[to->limit];
    CaseLuminances l = c->luminance_cd_m2;
    double veil = to->profile->uses_veil && l.veil > 0 ? l.veil : 0;
    double own = fmin(to->facts->own_cd_m2, l.reflected), other = l.reflected - own;
    double wide = c->reflected_range.high - c->reflected_range.low;
    double doubt = limit->is_upper ? -0.5 * wide : 0.5 * wide;
    double wanted = ratio_from_contrast(limit_kind_named(limit->kind), limit->value);
    double x = brighter_for(&l, own, fmax(other + veil + 2 * doubt, 0), wanted);
    for (int i = 0; i < BRIGHTER_TRIES && x > 0 && isfinite(x); i++) {
        double     factor = rounded_out(x);
        ReviewCase sure = judged_with(to->facts, to->profile, c,
                                      (Remedied){factor, fmax(other + doubt, 0)}, to->arena);
        ReviewCase then = judged_with(to->facts, to->profile, c, (Remedied){factor, other},
                                      to->arena);
        bool keeps = sure.limit_count == c->limit_count &&
                     sure.limits[to->limit].verdict == VERDICT_PASS;
        x *= limit->is_upper ? 1 / BRIGHTER_STEP : BRIGHTER_STEP;
        if (!keeps) continue;
        add_remedy(to, arena_format(to->arena, "the display %.3g times as bright", factor),
                   &then);
        return;
    }
}

static void add_less_light(Remedies *to, const char *what, double cd_m2)
{
    const CaseLuminances *l = &to->c->luminance_cd_m2;
    double own = fmin(to->facts->own_cd_m2, l->reflected);
    Remedied   with = {1, fmax(l->reflected - cd_m2 - own, 0)};
    ReviewCase then = judged_with(to->facts, to->profile, to->c, with, to->arena);
    add_remedy(to, what, &then);
}

void case_remedies(const CauseFacts *facts, const Profile *profile, ReviewCase *c,
                   Arena *arena)
{
    const CaseLuminances *l = &c->luminance_cd_m2;
    Remedies to = {facts, profile, c, limit_to_mend(c), ARENA_NEW(arena, CaseRemedy, 4), arena};
    if (c->verdict == VERDICT_UNJUDGED || to.limit < 0) return;
    c->remedies = to.list;
    add_brightness(&to);
    if (l->mirror > 0)
        add_less_light(&to, "a coating that leaves a quarter of the mirror's light",
                       (1 - COATED) * l->mirror);
    for (int i = 0; i < facts->part_count; i++) {
        const CausePart *part = &facts->parts[i];
        add_less_light(&to,
                       arena_format(arena, "%s (%.0f %% of what is reflected comes by it)",
                                    part->what, 100 * fmin(part->cd_m2 / l->reflected, 1)),
                       part->cd_m2);
    }
}
