#include "review/run/causes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/count.h"

#define PATHS 8192
#define ROOM 4096 /* ways that are told apart; a power of two */
#define COATED 0.25 /* of a mirror's light that a usual anti-reflection coating leaves */

/* ---- ways -------------------------------------------------------------------------------- */

/* All but the display itself; zeroed behind count, so that bytes may be compared. */
typedef struct WayKey {
    PathStep step[CAUSE_STEPS];
    int      first_event; /* of the display */
    int      count, is_longer, pane_id, source, source_id;
} WayKey;

typedef struct CauseWay {
    WayKey key;
    double sum, squares; /* cd m^-2 over paths */
    bool   is_used;
} CauseWay;

typedef struct CauseWays {
    const Scene *scene;
    CauseWay   *list;  /* [ROOM], a hash table */
    int    count;
    CauseWay    other; /* when the table is full */
    double sum;
} CauseWays;

/* Parts of one node and material count as one: the first of them stands for all. */
static int first_alike(const Scene *scene, int part_id)
{
    const Part *part = &scene->parts[part_id];
    for (int i = 0; i < part_id; i++) {
        const Part *other = &scene->parts[i];
        if (other->material_id == part->material_id && !strcmp(other->name, part->name))
            return i;
    }
    return part_id;
}

static WayKey key_of(const Scene *scene, const PathTale *tale)
{
    WayKey key;
    memset(&key, 0, sizeof key);
    int told = tale->count < PATH_STEPS_TOLD ? tale->count : PATH_STEPS_TOLD;
    key.first_event = (int)tale->step[0].event;
    for (int i = 1; i < told && key.count < CAUSE_STEPS; i++)
        key.step[key.count++] = (PathStep){first_alike(scene, tale->step[i].part_id),
                                           tale->step[i].event};
    key.is_longer = tale->count - 1 > key.count;
    key.pane_id = tale->pane_id == NO_ID ? NO_ID : first_alike(scene, tale->pane_id);
    key.source = (int)tale->source;
    key.source_id = tale->source == LIGHTS_EMITTERS ? first_alike(scene, tale->source_id)
                                                    : tale->source_id;
    return key;
}

static uint32_t hash_key(const WayKey *key)
{
    const unsigned char *bytes = (const unsigned char *)key;
    uint32_t hash = 2166136261u;
    for (size_t i = 0; i < sizeof *key; i++) hash = (hash ^ bytes[i]) * 16777619u;
    return hash;
}

static CauseWay *way_of(CauseWays *ways, const WayKey *key)
{
    for (uint32_t i = hash_key(key), tries = 0; tries < ROOM; i++, tries++) {
        CauseWay *way = &ways->list[i & (ROOM - 1)];
        if (way->is_used && !memcmp(&way->key, key, sizeof *key)) return way;
        if (way->is_used) continue;
        if (ways->count == ROOM / 2) return &ways->other;
        way->is_used = true;
        way->key = *key;
        ways->count++;
        return way;
    }
    return &ways->other;
}

static void hear(void *user, const PathTale *tale, const float xyz[3])
{
    CauseWays *ways = user;
    if (tale->count == 0) return; /* the display's own light */
    WayKey key = key_of(ways->scene, tale);
    CauseWay   *way = way_of(ways, &key);
    double y = (double)xyz[1];
    way->sum += y;
    way->squares += y * y;
    ways->sum += y;
}

static int by_sum(const void *a, const void *b)
{
    double x = (*(CauseWay *const *)a)->sum, y = (*(CauseWay *const *)b)->sum;
    return (x < y) - (x > y);
}

static CauseWay **greatest_first(const CauseWays *ways, Arena *arena)
{
    CauseWay **list = ARENA_NEW(arena, CauseWay *, ways->count);
    int   count = 0;
    for (int i = 0; i < ROOM; i++)
        if (ways->list[i].is_used) list[count++] = &ways->list[i];
    qsort(list, (size_t)count, sizeof *list, by_sum);
    return list;
}

/* ---- words ------------------------------------------------------------------------------- */

static const char *event_word(PathEvent event)
{
    static const char *const words[] = {"scatters", "reflects", "transmits"};
    return words[event];
}

static const char *part_words(const Scene *scene, int part_id, Arena *arena)
{
    const Part *part = &scene->parts[part_id];
    return arena_format(arena, "%s (%s)", part->name, scene->materials[part->material_id].name);
}

static const char *source_words(const Scene *scene, const WayKey *key, Arena *arena)
{
    switch ((LightSet)key->source) {
    case LIGHTS_SUN: return "sun";
    case LIGHTS_SKY: return "sky";
    case LIGHTS_EMITTERS:
        return arena_format(arena, "%s: emits", part_words(scene, key->source_id, arena));
    case LIGHTS_PUNCTUAL:
        return arena_format(arena, "lamp %s", scene->lights[key->source_id].name);
    default: return "";
    }
}

static const char **chain_of(const Scene *scene, const char *display, const WayKey *key,
                             int *links, Arena *arena)
{
    const char **chain = ARENA_NEW(arena, const char *, CAUSE_STEPS + 4);
    *links = 0;
    chain[(*links)++] = arena_format(arena, "display %s: %s", display,
                                     event_word((PathEvent)key->first_event));
    for (int i = 0; i < key->count; i++)
        chain[(*links)++] =
            arena_format(arena, "%s: %s", part_words(scene, key->step[i].part_id, arena),
                         event_word(key->step[i].event));
    if (key->is_longer) chain[(*links)++] = "further surfaces";
    if (key->pane_id != NO_ID)
        chain[(*links)++] =
            arena_format(arena, "%s: through", part_words(scene, key->pane_id, arena));
    chain[(*links)++] = source_words(scene, key, arena);
    return chain;
}

/* ---- causes ------------------------------------------------------------------------------ */

static CaseCause cause_of(double sum, double squares, double all)
{
    double mean = sum / PATHS;
    double sigma = sqrt(fmax(squares / PATHS - mean * mean, 0) / PATHS);
    double half = INTERVAL_SIGMAS * sigma;
    return (CaseCause){.share = all > 0 ? sum / all : 0, .cd_m2 = mean,
                       .low = fmax(mean - half, 0), .high = mean + half};
}

static CaseCause all_other(const CauseWays *ways, CauseWay *const *list, int from, Arena *arena)
{
    double sum = ways->other.sum, squares = ways->other.squares;
    for (int i = from; i < ways->count; i++) {
        sum += list[i]->sum;
        squares += list[i]->squares;
    }
    CaseCause    cause = cause_of(sum, squares, ways->sum);
    const char **chain = ARENA_NEW(arena, const char *, 1);
    chain[0] = "all other ways";
    cause.chain = chain;
    cause.links = 1;
    return cause;
}

void case_causes(const Stage *stage, const ProbeAim *aim, ReviewCase *c, Arena *arena)
{
    CaseCause *causes = ARENA_NEW(arena, CaseCause, CAUSES_MOST + 1);
    Arena      own = arena_reserve((size_t)1 << 24);
    CauseWays       ways = {.scene = stage->scene, .list = ARENA_NEW(&own, CauseWay, ROOM)};
    PathListener   listener = {hear, &ways};
    PathStatistics statistics = {0};
    stage->tools.kernel->hear(aim, 0, PATHS, &listener, &statistics);
    CauseWay **list = greatest_first(&ways, &own);
    int   count = ways.count < CAUSES_MOST ? ways.count : CAUSES_MOST;
    for (int i = 0; i < count; i++) {
        causes[i] = cause_of(list[i]->sum, list[i]->squares, ways.sum);
        causes[i].chain =
            chain_of(stage->scene, c->display, &list[i]->key, &causes[i].links, arena);
    }
    if (ways.count > count) {
        causes[count] = all_other(&ways, list, count, arena);
        count++;
    }
    c->causes = causes;
    c->cause_count = count;
    arena_release(&own);
}

/* ---- remedies ---------------------------------------------------------------------------- */

static double contrast(const CaseLuminances *l, double brighter, double reflected)
{
    return luminance_contrast(brighter * l->foreground, brighter * l->background, reflected);
}

/* By how much the display must be brighter for a contrast, (H x + R) / (L x + R) = C; NaN: no
 * brightness does it. */
static double brighter_for(const CaseLuminances *l, double wanted)
{
    double high = fmax(l->foreground, l->background), low = fmin(l->foreground, l->background);
    double gain = high - wanted * low;
    return gain > 0 ? l->reflected * (wanted - 1) / gain : (double)NAN;
}

void case_remedies(ReviewCase *c, Arena *arena)
{
    const CaseLuminances *l = &c->luminance_cd_m2;
    CaseRemedy *list = ARENA_NEW(arena, CaseRemedy, 3);
    if (c->limit_id < 0 || !(c->margin < 0) || !(c->visible_share > 0)) return;
    double wanted = c->limits[c->limit_id].value, brighter = brighter_for(l, wanted);
    if (brighter > 1)
        list[c->remedy_count++] = (CaseRemedy){
            arena_format(arena, "the display %.3g times as bright", brighter),
            contrast(l, brighter, l->reflected), c->level * brighter};
    if (l->mirror > 0)
        list[c->remedy_count++] = (CaseRemedy){
            "a coating that leaves a quarter of the mirror's light",
            contrast(l, 1, l->reflected - (1 - COATED) * l->mirror), c->level};
    if (c->cause_count && c->causes[0].links > 1)
        list[c->remedy_count++] = (CaseRemedy){
            arena_format(arena, "without the first cause (%.0f %% of what is reflected)",
                         100 * c->causes[0].share),
            contrast(l, 1, l->reflected * (1 - c->causes[0].share)), c->level};
    c->remedies = list;
}
