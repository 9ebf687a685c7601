/* SPDX-License-Identifier: Apache-2.0 */
#include "review/chain/causes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "estimate/estimate.h"
#include "review/chain/chains.h"
#include "spectrum/spectral_table.h"

#define SEAT_LEAST 0.1 /* of the light: an empty seat's back that is worth a word */

/* ---- causes ------------------------------------------------------------------------------ */

static const CaseRay *rays_of(const Chain *chain, int most, int *count, Arena *arena) {
    *count = chain->ray_count < most ? chain->ray_count : most;
    CaseRay *rays = ARENA_NEW(arena, CaseRay, *count);
    for (int i = 0; i < *count; i++) {
        const ChainRay *from = &chain->rays[i];
        Vec3 *points = ARENA_NEW(arena, Vec3, from->count);
        for (int k = 0; k < from->count; k++) points[k] = from->point[k];
        rays[i] = (CaseRay){points, from->count};
    }
    return rays;
}

static CaseCause cause_of(ChainFigure figure, const Chains *chains, const ReviewCase *c) {
    const CaseLuminances *l = &c->luminance_cd_m2;
    double all = chains->all.cd_m2;
    double left = fmax(l->reflected - figure.cd_m2, 0);
    return (CaseCause){.share = all > 0 ? figure.cd_m2 / all : 0,
                       .cd_m2 = figure.cd_m2,
                       .low = figure.low,
                       .high = figure.high,
                       .contrast_without = luminance_contrast(l->foreground, l->background, left)};
}

static CaseCause all_other(const Chains *chains, const ReviewCase *c, Arena *arena) {
    CaseCause cause = cause_of(chains->rest, chains, c);
    const char **words = ARENA_NEW(arena, const char *, 1);
    words[0] = "all other ways";
    cause.chain = words;
    cause.links = 1;
    return cause;
}

/* What comes straight off the seat's back, by its part that sends most. */
static void set_seat(const Chains *chains, ReviewCase *c, Arena *arena) {
    const double *by_seat = chains->by_seat;
    double all = chains->all.cd_m2;
    int most = 0;
    if (!by_seat) return;
    for (int i = 1; i < chains->scene->part_count; i++)
        if (by_seat[i] > by_seat[most]) most = i;
    if (!(by_seat[most] > 0) || !(by_seat[most] / all >= SEAT_LEAST)) return;
    c->empty_seat = chain_part_words(chains->scene, most, arena);
    c->empty_seat_share = fmin(by_seat[most] / all, 1);
}

/* ---- groups ------------------------------------------------------------------------------ */

/* The greatest are listed up to this share of the light, and up to this count. */
#define GROUP_LISTED 0.97
#define GROUP_MOST 24

/* A group that grows. */
typedef struct Growing {
    CaseShare *list;
    int count;
    double all; /* cd m^-2 */
    Arena *arena;
} Growing;

/* Things of the same name count as one: a row of street lamps. */
static void add(Growing *to, const char *what, double cd_m2) {
    int i = 0;
    if (!(cd_m2 > 0)) return;
    while (i < to->count && strcmp(to->list[i].what, what) != 0) i++;
    if (i == to->count) to->list[to->count++] = (CaseShare){what, 0, 0};
    to->list[i].cd_m2 += cd_m2;
    to->list[i].share = to->list[i].cd_m2 / to->all;
}

static Growing grow(const Chains *chains, Arena *arena) {
    int most = chains->scene->part_count + chains->scene->light_count + LIGHT_SETS + 1;
    return (Growing){ARENA_NEW(arena, CaseShare, most), 0, chains->all.cd_m2, arena};
}

static void add_parts(Growing *to, const Scene *scene, const double *by_part) {
    for (int i = 0; i < scene->part_count; i++)
        if (by_part[i] > 0) add(to, chain_part_words(scene, i, to->arena), by_part[i]);
}

static Growing by_light(const Chains *chains, Arena *arena) {
    const ChainGroups *groups = &chains->groups;
    const Scene *scene = chains->scene;
    Growing light = grow(chains, arena);
    add(&light, "sun", groups->by_set[LIGHTS_SUN]);
    add(&light, "sky", groups->by_set[LIGHTS_SKY]);
    add_parts(&light, scene, groups->by_emitter);
    for (int i = 0; i < scene->light_count; i++)
        if (groups->by_lamp[i] > 0)
            add(&light, chain_source_words(scene, LIGHTS_PUNCTUAL, i, arena), groups->by_lamp[i]);
    return light;
}

static Growing by_opening(const Chains *chains, Arena *arena) {
    Growing opening = grow(chains, arena);
    add_parts(&opening, chains->scene, chains->groups.by_pane);
    add(&opening, "through no pane", chains->groups.by_no_pane);
    return opening;
}

static Growing by_surface(const Chains *chains, Arena *arena) {
    const double *straight = chains->groups.straight;
    Growing surface = grow(chains, arena);
    add_parts(&surface, chains->scene, chains->groups.by_surface);
    add(&surface, "the sun itself", straight[LIGHTS_SUN]);
    add(&surface, "the sky itself", straight[LIGHTS_SKY]);
    add(&surface, "lamps themselves", straight[LIGHTS_PUNCTUAL]);
    return surface;
}

static int compare(const void *a, const void *b) {
    const CaseShare *x = a, *y = b;
    if (x->cd_m2 != y->cd_m2) return x->cd_m2 > y->cd_m2 ? -1 : 1;
    return strcmp(x->what, y->what);
}

/* A single one that is left is listed by its name, not as "other". */
static CaseGroup listed(Growing *group) {
    double sum = 0, other = 0;
    int count = 0;
    if (group->count) qsort(group->list, (size_t)group->count, sizeof *group->list, compare);
    while (count < group->count && count < GROUP_MOST && sum < GROUP_LISTED)
        sum += group->list[count++].share;
    if (count == group->count - 1) count++;
    for (int i = count; i < group->count; i++) other += group->list[i].cd_m2;
    if (count < group->count)
        group->list[count++] = (CaseShare){"other", other / group->all, other};
    return (CaseGroup){group->list, count};
}

static double without_data(const Chains *chains) {
    double all = chains->all.cd_m2;
    return all > 0 ? chains->groups.without_data / all : 0;
}

static void set_groups(const Chains *chains, ReviewCase *c, Arena *arena) {
    Growing of[CAUSE_GROUPS] = {[GROUP_LIGHT] = by_light(chains, arena),
                                [GROUP_OPENING] = by_opening(chains, arena),
                                [GROUP_SURFACE] = by_surface(chains, arena)};
    for (int i = 0; i < CAUSE_GROUPS; i++) c->groups[i] = listed(&of[i]);
    double all = chains->all.cd_m2;
    c->without_data_share = without_data(chains);
    c->guessed_share = all > 0 ? chains->groups.guessed / all : 0;
    c->extrapolated_share = all > 0 ? chains->groups.extrapolated / all : 0;
}

/* ---- all of it --------------------------------------------------------------------------- */

void case_causes_of(const Chains *chains, int rays, ReviewCase *c, Arena *arena) {
    CaseCause *causes = ARENA_NEW(arena, CaseCause, chains->count + 1);
    for (int i = 0; i < chains->count; i++) {
        const Chain *chain = &chains->list[i];
        causes[i] = cause_of(chain->figure, chains, c);
        if (!chain->key.count) causes[i].contrast_without = (double)NAN; /* the display's own */
        causes[i].chain = chain_words(chains->scene, &chain->key, &causes[i].links, arena);
        causes[i].rays = rays_of(chain, rays, &causes[i].ray_count, arena);
    }
    c->causes = causes;
    c->cause_count = chains->count;
    if (chains->others) causes[c->cause_count++] = all_other(chains, c, arena);
    set_groups(chains, c, arena);
    c->own_reflected = chains->own;
    set_seat(chains, c, arena);
}

void case_causes(const CauseArgs *args, ReviewCase *c, Arena *arena) {
    Arena scratch = arena_reserve((size_t)1 << 28);
    ChainArgs chain_args = {.aim = args->aim,
                            .tools = args->tools,
                            .paths = args->paths,
                            .most = CAUSES_MOST,
                            .seat = args->seat};
    Chains chains = chains_find(&chain_args, &scratch);
    case_causes_of(&chains, args->rays, c, arena);
    arena_release(&scratch);
}

double case_data_share(const CauseArgs *args, Arena scratch) {
    ChainArgs chains = {
        .aim = args->aim, .tools = args->tools, .paths = args->paths, .most = CAUSES_MOST};
    Chains found = chains_find(&chains, &scratch);
    return without_data(&found);
}

/* ---- what hides it ----------------------------------------------------------------------- */

static int compare_hiders(const void *a, const void *b) {
    const CaseHider *x = a, *y = b;
    if (x->share != y->share) return x->share > y->share ? -1 : 1;
    return strcmp(x->what, y->what);
}

static void add_hider(CaseHider *list, int *count, const char *what, double share) {
    int i = 0;
    if (!(share > 0)) return;
    while (i < *count && strcmp(list[i].what, what) != 0) i++;
    if (i == *count) list[(*count)++] = (CaseHider){what, 0};
    list[i].share += share;
}

void case_hiders(const SymbolSurface *surface, const PathContext *context, Vec3 eye, ReviewCase *c,
                 Arena *arena) {
    const Scene *scene = context->scene;
    SymbolHiding hiding = symbol_hiding(surface, context, eye, arena);
    CaseHider *list = ARENA_NEW(arena, CaseHider, scene->part_count + 1);
    c->hider_count = 0;
    add_hider(list, &c->hider_count, "the display's own back", hiding.turned_away);
    for (int i = 0; i < scene->part_count; i++)
        if (hiding.by_part[i] > 0)
            add_hider(list, &c->hider_count, chain_part_words(scene, i, arena), hiding.by_part[i]);
    qsort(list, (size_t)c->hider_count, sizeof *list, compare_hiders);
    c->hiders = list;
}

/* ---- a pixel's light --------------------------------------------------------------------- */

_Static_assert(PIXEL_FIRST_NM == SPECTRAL_FIRST_NM &&
                   PIXEL_BANDS * PIXEL_BAND_NM == SPECTRAL_COUNT - 1,
               "the bands are those that paths carry");

/* Weight of a lane's radiance in its band: wavelength_steps is the integral of the
 * density, in 2^-24, and the density constant within a nanometre (wavelengths.c). */
static double lane_weight(double nm, int *band) {
    int cell = (int)nm - SPECTRAL_FIRST_NM;
    if (cell < 0) cell = 0;
    if (cell > SPECTRAL_COUNT - 2) cell = SPECTRAL_COUNT - 2;
    double density =
        ((double)wavelength_steps[cell + 1] - (double)wavelength_steps[cell]) * 0x1p-24;
    *band = cell / PIXEL_BAND_NM;
    return 1 / (SPECTRUM_LANES * density * PIXEL_BAND_NM);
}

static void on_light(const ProbePart *to, const PathHistory *history, const float xyz[3]) {
    double *sums = to->own;
    const float *nm = (const float *)&history->wavelengths->nm;
    for (int i = 0; i < 3; i++) sums[i] += (double)xyz[i];
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        int band;
        double weight = lane_weight((double)nm[i], &band);
        sums[3 + band] += weight * (double)history->lanes[i];
    }
}

static void merge_light(const ProbePart *from) {
    PixelLightSums *to = from->user;
    const double *sums = from->own;
    for (int k = 0; k < PIXEL_FIGURES; k++)
        to->batch[k][from->piece->id % CHAIN_BATCHES] += sums[k];
    to->chunks++;
}

ProbeFold pixel_light_fold(PixelLightSums *to) {
    return (ProbeFold){.user = to,
                       .bytes = PIXEL_FIGURES * sizeof(double),
                       .on_light = on_light,
                       .merge = merge_light};
}

/* Batches as those of chains: an error of Y is that of their sum. */
static PixelFigure figure_of(const PixelLightSums *light, int k) {
    EstimateSums sums = {.batches = light->chunks < CHAIN_BATCHES ? light->chunks : CHAIN_BATCHES,
                         .paths = (long)light->chunks * CHAIN_CHUNK,
                         .piece = CHAIN_CHUNK,
                         .share = 1};
    memcpy(sums.batch, light->batch[k], sizeof light->batch[k]);
    Estimate estimate = estimate_of(&sums);
    return (PixelFigure){estimate.mean, estimate.sigma};
}

PixelLight pixel_light_of(const PixelLightSums *sums) {
    PixelLight out;
    for (int i = 0; i < 3; i++) out.xyz[i] = figure_of(sums, i);
    for (int i = 0; i < PIXEL_BANDS; i++) out.radiance[i] = figure_of(sums, 3 + i);
    return out;
}
