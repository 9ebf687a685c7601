/* SPDX-License-Identifier: Apache-2.0 */
#include "review/chain/chains.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sampler.h"
#include "scene/load/material_data.h"

#define ROUND 64          /* chunks at a time */
#define CHUNK_ROOM 512    /* places in a chunk's table: a power of two */
#define CHUNK_CHAINS 400  /* that one chunk keeps apart */
#define ROOM 16384        /* places in the table of all: a power of two */
#define CHAINS_KEPT 10000 /* that are kept apart */

/* ---- one chunk of paths ------------------------------------------------------------------ */

typedef struct ChunkChain {
    ChainKey key;
    double sum;
    BrightSamples bright;
    double draw; /* the ray's: the least is kept */
    ChainRay ray;
    bool is_used;
} ChunkChain;

/* Shared by all chunks. */
typedef struct ChainSearch {
    const ChainArgs *args;
    const Scene *scene;
    const int *alike;
    const bool *lacks_data, *is_guessed; /* [part] */
    float far_m;                         /* length of a ray drawn towards a distant source */
    int chunks, batches;
    struct FoundChains *found;
    Chains *out;
    Arena *own; /* of what is found */
} ChainSearch;

typedef struct ChainChunk {
    const ChainSearch *search;
    ChunkChain *table; /* [CHUNK_ROOM] */
    int id, count;
    double all, mirror, own, reflected;
    BrightSamples bright, bright_reflected; /* as all, as reflected */
    ChainGroups groups;
    double *by_seat; /* NULL: none is requested */
    uint32_t draws;
} ChainChunk;

static int alike_or_none(const int *alike, int part_id) {
    return part_id == NO_ID ? NO_ID : alike[part_id];
}

static ChainKey key_of(const ChainSearch *search, const PathHistory *history) {
    const int *alike = search->alike;
    bool with_first = search->args->with_first_pane;
    ChainKey key;
    memset(&key, 0, sizeof key);
    for (int i = 0; i < path_steps_kept(history) && i < CHAIN_STEPS; i++) {
        const PathStep *step = &history->step[i];
        key.link[key.count++] =
            (ChainLink){alike[step->part_id], (int)step->event,
                        i || with_first ? alike_or_none(alike, step->pane_id) : NO_ID};
    }
    key.is_longer = history->count > key.count;
    key.pane_id = alike_or_none(alike, history->pane_id);
    key.source = (int)history->source;
    key.source_id = key.source == LIGHTS_EMITTERS ? alike[history->source_id] : history->source_id;
    return key;
}

static uint32_t hash_key(const ChainKey *key) {
    const unsigned char *bytes = (const unsigned char *)key;
    uint32_t hash = 2166136261u;
    for (size_t i = 0; i < sizeof *key; i++) hash = (hash ^ bytes[i]) * 16777619u;
    return hash;
}

/* NULL: the table is full. */
static ChunkChain *chunk_chain(ChainChunk *sums, const ChainKey *key) {
    for (uint32_t i = hash_key(key);; i++) {
        ChunkChain *chain = &sums->table[i & (CHUNK_ROOM - 1)];
        if (chain->is_used && !memcmp(&chain->key, key, sizeof *key)) return chain;
        if (chain->is_used) continue;
        if (sums->count == CHUNK_CHAINS) return NULL;
        chain->is_used = true;
        chain->key = *key;
        chain->draw = (double)INFINITY;
        sums->count++;
        return chain;
    }
}

static ChainRay ray_of(const ChainSearch *search, const PathHistory *history) {
    ChainRay ray = {.count = 0};
    int kept = path_steps_kept(history);
    ray.point[ray.count++] = search->args->aim->eye;
    for (int i = 0; i < kept; i++) ray.point[ray.count++] = history->step[i].position;
    ray.is_cut = history->count > kept;
    if (!ray.is_cut)
        ray.point[ray.count] =
            history->is_distant ? vec3_along(ray.point[ray.count - 1], history->from, search->far_m)
                                : history->from;
    ray.count += !ray.is_cut;
    return ray;
}

/* Rays with a chance that goes with their light, one pass, any order: the least of
 * -ln(u) / light (Efraimidis and Spirakis 2006). */
static void draw_ray(ChainChunk *to, ChunkChain *chain, const PathHistory *history, double y) {
    uint32_t bits = hash_combine(hash_u32((uint32_t)to->id), to->draws++);
    double draw = -log((bits + 0.5) * 0x1p-32) / y;
    if (!(draw < chain->draw)) return;
    chain->draw = draw;
    chain->ray = ray_of(to->search, history);
}

/* Beyond a pane is outside. */
static void add_seat(ChainChunk *to, const PathHistory *history, double y) {
    const PathStep *next = &history->step[1];
    if (history->count < 2 || next->pane_id != NO_ID) return;
    if (seat_is_back(to->search->args->seat, next->position))
        to->by_seat[to->search->alike[next->part_id]] += y;
}

static bool is_off_any(const PathHistory *history, const bool *is_any) {
    for (int i = 0; i < path_steps_kept(history); i++)
        if (is_any[history->step[i].part_id]) return true;
    return false;
}

static bool is_through_any(const PathHistory *history, const bool *is_any) {
    for (int i = 0; i < path_steps_kept(history); i++) {
        int pane = history->step[i].pane_id;
        if (pane != NO_ID && is_any[pane]) return true;
    }
    return history->pane_id != NO_ID && is_any[history->pane_id];
}

static void add_groups(ChainChunk *to, const PathHistory *history, double y) {
    ChainGroups *groups = &to->groups;
    const int *alike = to->search->alike;
    groups->by_set[history->source] += y;
    if (history->source == LIGHTS_EMITTERS) groups->by_emitter[alike[history->source_id]] += y;
    if (history->source == LIGHTS_PUNCTUAL) groups->by_lamp[history->source_id] += y;
    if (history->pane_id == NO_ID) groups->by_no_pane += y;
    else groups->by_pane[alike[history->pane_id]] += y;
    if (history->count >= 2) groups->by_surface[alike[history->step[1].part_id]] += y;
    else if (history->source == LIGHTS_EMITTERS) /* counts as a surface that is met */
        groups->by_surface[alike[history->source_id]] += y;
    else groups->straight[history->source] += y;
    if (is_off_any(history, to->search->lacks_data)) groups->without_data += y;
    if (is_off_any(history, to->search->is_guessed) ||
        is_through_any(history, to->search->is_guessed))
        groups->guessed += y;
    if (history->is_extrapolated) groups->extrapolated += y;
}

static int display_of(const Scene *scene, int part_id) {
    return scene->materials[scene->parts[part_id].material_id].display_id;
}

static void on_light(const ProbePart *sums, const PathHistory *history, const float xyz[3]) {
    ChainChunk *to = sums->own;
    const Scene *scene = to->search->scene;
    double y = (double)xyz[1];
    if (!(y > 0) || (history->count == 0 && !to->search->args->with_direct)) return;
    ChainKey key = key_of(to->search, history);
    ChunkChain *chain = chunk_chain(to, &key);
    int display = history->count ? display_of(scene, history->step[0].part_id) : NO_ID;
    to->all += y;
    if (history->count) {
        to->reflected += y;
        bright_add(&to->bright_reflected, y);
    }
    bright_add(&to->bright, y);
    if (display != NO_ID && history->step[0].event == PATH_REFLECTS) to->mirror += y;
    if (display != NO_ID && history->source == LIGHTS_EMITTERS &&
        display_of(scene, history->source_id) == display)
        to->own += y;
    add_groups(to, history, y);
    if (display != NO_ID && to->search->args->seat) add_seat(to, history, y);
    if (!chain) return;
    chain->sum += y;
    bright_add(&chain->bright, y);
    draw_ray(to, chain, history, y);
}

/* ---- all chunks -------------------------------------------------------------------------- */

typedef struct FoundChain {
    Chain chain;
    double draw[CHAIN_RAYS]; /* its rays', rising */
    EstimateSums sums;       /* batches, brightness, what is unseen */
    double sure;             /* its mean less one standard error: one lucky path has 0 */
    int id;
    bool is_kept;
} FoundChain;

typedef struct FoundChains {
    FoundChain **table; /* [ROOM] */
    FoundChain **by_id;
    int count;
    EstimateSums all, mirror, reflected;
    double own, lost, rare; /* PathStatistics' */
} FoundChains;

/* NULL: the table is full. */
static FoundChain *found_chain(FoundChains *found, const ChainKey *key, Arena *own) {
    for (uint32_t i = hash_key(key);; i++) {
        FoundChain **place = &found->table[i & (ROOM - 1)], *f = *place;
        if (f && !memcmp(&f->chain.key, key, sizeof *key)) return f;
        if (f) continue;
        if (found->count == CHAINS_KEPT) return NULL;
        *place = f = ARENA_NEW(own, FoundChain, 1);
        f->chain.key = *key;
        f->id = found->count;
        found->by_id[found->count++] = f;
        return f;
    }
}

static void keep_ray(FoundChain *f, const ChunkChain *from) {
    int count = f->chain.ray_count;
    int at = count < CHAIN_RAYS ? count : CHAIN_RAYS - 1;
    if (count == CHAIN_RAYS && !(from->draw < f->draw[at])) return;
    for (; at > 0 && f->draw[at - 1] > from->draw; at--) {
        f->draw[at] = f->draw[at - 1];
        f->chain.rays[at] = f->chain.rays[at - 1];
    }
    f->draw[at] = from->draw;
    f->chain.rays[at] = from->ray;
    if (count < CHAIN_RAYS) f->chain.ray_count++;
}

static ChainGroups fresh_groups(const Scene *scene, Arena *arena) {
    return (ChainGroups){.by_emitter = ARENA_NEW(arena, double, scene->part_count),
                         .by_lamp = ARENA_NEW(arena, double, scene->light_count),
                         .by_pane = ARENA_NEW(arena, double, scene->part_count),
                         .by_surface = ARENA_NEW(arena, double, scene->part_count)};
}

static void add_all(double *to, const double *from, int count, double scale) {
    for (int i = 0; i < count; i++) to[i] += scale * from[i];
}

static void merge_groups(ChainGroups *to, const ChainGroups *from, const Scene *scene,
                         double scale) {
    add_all(to->by_set, from->by_set, LIGHT_SETS, scale);
    add_all(to->straight, from->straight, LIGHT_SETS, scale);
    add_all(to->by_emitter, from->by_emitter, scene->part_count, scale);
    add_all(to->by_lamp, from->by_lamp, scene->light_count, scale);
    add_all(to->by_pane, from->by_pane, scene->part_count, scale);
    add_all(to->by_surface, from->by_surface, scene->part_count, scale);
    to->by_no_pane += scale * from->by_no_pane;
    to->without_data += scale * from->without_data;
    to->guessed += scale * from->guessed;
    to->extrapolated += scale * from->extrapolated;
}

/* A batch's chunks follow each other in a random stream of its own. */
static void merge_chunk(const ProbePart *of) {
    const ChainSearch *search = of->user;
    const ChainChunk *sums = of->own;
    FoundChains *found = search->found;
    int batch = of->piece->id % search->batches, parts = search->scene->part_count;
    double share = 1.0 / CHAIN_CHUNK / search->chunks;
    found->all.batch[batch] += sums->all;
    bright_merge(&found->all.bright, &sums->bright);
    found->mirror.batch[batch] += sums->mirror;
    found->reflected.batch[batch] += sums->reflected;
    bright_merge(&found->reflected.bright, &sums->bright_reflected);
    found->lost += of->piece->statistics.lost;
    found->rare += of->piece->statistics.rare;
    found->own += sums->own;
    for (int i = 0; i < CHUNK_ROOM; i++) {
        const ChunkChain *from = &sums->table[i];
        FoundChain *to = from->is_used ? found_chain(found, &from->key, search->own) : NULL;
        if (!to) continue;
        to->sums.batch[batch] += from->sum;
        bright_merge(&to->sums.bright, &from->bright);
        keep_ray(to, from);
    }
    merge_groups(&search->out->groups, &sums->groups, search->scene, share);
    if (sums->by_seat) add_all(search->out->by_seat, sums->by_seat, parts, share);
}

static void begin_chunk(ProbePart *to, Arena *arena) {
    const ChainSearch *search = to->user;
    int parts = search->scene->part_count;
    ChainChunk *sums = to->own;
    sums->search = search;
    sums->id = to->piece->id;
    sums->table = ARENA_NEW(arena, ChunkChain, CHUNK_ROOM);
    sums->groups = fresh_groups(search->scene, arena);
    if (search->args->seat) sums->by_seat = ARENA_NEW(arena, double, parts);
}

static ChainFigure figure_of(const EstimateSums *found, const ChainSearch *search) {
    EstimateSums sums = *found;
    sums.batches = search->batches;
    sums.paths = (long)search->chunks * CHAIN_CHUNK;
    sums.piece = CHAIN_CHUNK;
    sums.share = 1;
    Estimate estimate = estimate_of(&sums);
    return (ChainFigure){estimate.mean, estimate.sigma, estimate.interval.low,
                         estimate.interval.high};
}

/* Greatest first; of equals the one that was found first. */
static int compare(double x, double y, const FoundChain *a, const FoundChain *b) {
    if (x != y) return x < y ? 1 : -1;
    return (a->id > b->id) - (a->id < b->id);
}

static int by_sum(const void *a, const void *b) {
    const FoundChain *x = *(FoundChain *const *)a, *y = *(FoundChain *const *)b;
    return compare(x->chain.figure.cd_m2, y->chain.figure.cd_m2, x, y);
}

static int by_sureness(const void *a, const void *b) {
    const FoundChain *x = *(FoundChain *const *)a, *y = *(FoundChain *const *)b;
    return compare(x->sure, y->sure, x, y);
}

/* Light by chains that are not kept. */
static ChainFigure rest_of(const FoundChains *found, const ChainSearch *search) {
    EstimateSums rest = found->all;
    for (int k = 0; k < search->batches; k++) {
        for (int i = 0; i < found->count; i++)
            if (found->by_id[i]->is_kept) rest.batch[k] -= found->by_id[i]->sums.batch[k];
        rest.batch[k] = fmax(rest.batch[k], 0);
    }
    for (int i = 0; i < found->count; i++) {
        const BrightSamples *kept = &found->by_id[i]->sums.bright;
        if (!found->by_id[i]->is_kept) continue;
        rest.bright.squares = fmax(rest.bright.squares - kept->squares, 0);
        rest.bright.fourths = fmax(rest.bright.fourths - kept->fourths, 0);
    }
    return figure_of(&rest, search);
}

static void keep_greatest(const FoundChains *found, const ChainSearch *search, Arena own,
                          Chains *out) {
    FoundChain **list = ARENA_NEW(&own, FoundChain *, found->count);
    int most = search->args->most;
    for (int i = 0; i < found->count; i++) {
        list[i] = found->by_id[i];
        list[i]->chain.figure = figure_of(&list[i]->sums, search);
        list[i]->sure = list[i]->chain.figure.cd_m2 - list[i]->chain.figure.sigma;
    }
    qsort(list, (size_t)found->count, sizeof *list, by_sureness);
    out->count = found->count < most ? found->count : most;
    out->others = found->count - out->count;
    qsort(list, (size_t)out->count, sizeof *list, by_sum);
    for (int i = 0; i < out->count; i++) {
        list[i]->is_kept = true;
        out->list[i] = list[i]->chain;
    }
    out->rest = rest_of(found, search);
}

static const int *alike_parts(const Scene *scene, Arena *arena) {
    int *alike = ARENA_NEW(arena, int, scene->part_count);
    for (int i = 0; i < scene->part_count; i++) {
        const Part *part = &scene->parts[i];
        int first = 0;
        while (scene->parts[first].material_id != part->material_id ||
               strcmp(scene->parts[first].name, part->name) != 0)
            first++;
        alike[i] = first;
    }
    return alike;
}

#define FAR_LEAST 0.5f
#define FAR_MOST 20.0f

static float far_length(const Scene *scene) {
    float size = vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
    return fminf(fmaxf(0.5f * size, FAR_LEAST), FAR_MOST);
}

/* Address space: what is not touched costs nothing. */
#define OWN_BYTES ((size_t)1 << 32)

Chains chains_find(const ChainArgs *args, Arena *arena) {
    const Scene *scene = args->aim->context->scene;
    int chunks = (int)((args->paths + CHAIN_CHUNK - 1) / CHAIN_CHUNK);
    Arena own = arena_reserve(OWN_BYTES);
    Chains out = {.scene = scene,
                  .list = ARENA_NEW(arena, Chain, args->most),
                  .by_seat = args->seat ? ARENA_NEW(arena, double, scene->part_count) : NULL,
                  .groups = fresh_groups(scene, arena),
                  .alike = alike_parts(scene, arena),
                  .paths = (long)chunks * CHAIN_CHUNK};
    bool *lacks_data = ARENA_NEW(&own, bool, scene->part_count);
    bool *is_guessed = ARENA_NEW(&own, bool, scene->part_count);
    for (int i = 0; i < scene->part_count; i++) {
        lacks_data[i] = !part_has_data(scene, i);
        is_guessed[i] = scene->materials[scene->parts[i].material_id].guessed_as != NULL;
    }
    FoundChains found = {.table = ARENA_NEW(&own, FoundChain *, ROOM),
                         .by_id = ARENA_NEW(&own, FoundChain *, CHAINS_KEPT)};
    ChainSearch search = {.args = args,
                          .scene = scene,
                          .alike = out.alike,
                          .lacks_data = lacks_data,
                          .is_guessed = is_guessed,
                          .chunks = chunks,
                          .batches = chunks < CHAIN_BATCHES ? chunks : CHAIN_BATCHES,
                          .far_m = far_length(scene),
                          .found = &found,
                          .out = &out,
                          .own = &own};
    Arena rounds = arena_reserve(OWN_BYTES);
    ProbeGoal goal = {.pieces = chunks,
                      .paths = CHAIN_CHUNK,
                      .streams = args->aim->pixel ? 0 : search.batches,
                      .at_once = ROUND,
                      .together = CHAIN_CHUNK,
                      .like = {.with_extrapolated = true, .with_lanes = args->beside != NULL}};
    ProbeFold folds[2] = {{.user = &search,
                           .bytes = sizeof(ChainChunk),
                           .begin = begin_chunk,
                           .on_light = on_light,
                           .merge = merge_chunk}};
    if (args->beside) folds[1] = *args->beside;
    probe_read(args->aim, &goal, args->tools, folds, args->beside ? 2 : 1, rounds);
    found.all.unseen = found.reflected.unseen =
        (found.lost + fmax(found.rare, 0)) / (double)out.paths;
    out.all = figure_of(&found.all, &search);
    out.mirror = figure_of(&found.mirror, &search);
    out.reflected = figure_of(&found.reflected, &search);
    out.own = found.own / (double)out.paths;
    keep_greatest(&found, &search, own, &out);
    arena_release(&rounds);
    arena_release(&own);
    return out;
}

/* ---- words ------------------------------------------------------------------------------- */

static const char *event_word(int event) {
    static const char *const words[] = {"scatters", "reflects", "transmits"};
    return words[event];
}

const char *chain_part_words(const Scene *scene, int part_id, Arena *arena) {
    const Part *part = &scene->parts[part_id];
    return arena_format(arena, "%s (%s)", part->name, scene->materials[part->material_id].name);
}

const char *chain_source_words(const Scene *scene, int source, int source_id, Arena *arena) {
    switch ((LightSet)source) {
    case LIGHTS_SUN: return "sun";
    case LIGHTS_SKY: return "sky";
    case LIGHTS_EMITTERS: return chain_part_words(scene, source_id, arena);
    case LIGHTS_PUNCTUAL: return arena_format(arena, "lamp %s", scene->lights[source_id].name);
    default: return "";
    }
}

static const char *first_words(const Scene *scene, int part_id, Arena *arena) {
    int display_id = scene->materials[scene->parts[part_id].material_id].display_id;
    return display_id == NO_ID
               ? chain_part_words(scene, part_id, arena)
               : arena_format(arena, "display %s", scene->displays[display_id].name);
}

const char *const *chain_words(const Scene *scene, const ChainKey *key, int *links, Arena *arena) {
    const char **out = ARENA_NEW(arena, const char *, 2 * CHAIN_STEPS + 3);
    const char *source = chain_source_words(scene, key->source, key->source_id, arena);
    int count = 0;
    for (int i = 0; i < key->count; i++) {
        const ChainLink *link = &key->link[i];
        const char *what = i ? chain_part_words(scene, link->part_id, arena)
                             : first_words(scene, link->part_id, arena);
        if (link->pane_id != NO_ID)
            out[count++] =
                arena_format(arena, "%s: through", chain_part_words(scene, link->pane_id, arena));
        out[count++] = arena_format(arena, "%s: %s", what, event_word(link->event));
    }
    if (key->is_longer) out[count++] = "further surfaces";
    if (key->pane_id != NO_ID)
        out[count++] =
            arena_format(arena, "%s: through", chain_part_words(scene, key->pane_id, arena));
    out[count++] =
        key->source == LIGHTS_EMITTERS ? arena_format(arena, "%s: emits", source) : source;
    *links = count;
    return out;
}
