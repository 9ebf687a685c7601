/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/gaze_reading.h"

#include <math.h>

#include "base/count.h"
#include "base/parallel.h"
#include "base/units.h"
#include "review/light/question.h"

#define CHUNK 64
#define LEAST (32 * CHUNK)
#define TARGETS 4096 /* directions in the cone; more paths begin again */
#define SEED 0x67617a65u

/* One over the root of x^3 = x + 1, and its square: points that fill a square evenly, however
 * many (M. Roberts' sequence). */
#define STEP_U 0.7548776662466927
#define STEP_V 0.5698402909980532

/* ---- the cone ---------------------------------------------------------------------------- */

static double fraction(double x)
{
    return x - floor(x);
}

/* Even over the cone's solid angle. */
static void aim_at_cone(const GazeGoal *goal, Vec3 *targets)
{
    Frame  frame = frame_from_z(vec3_normalize(goal->towards));
    double narrow = 1 - cos(radians_from_degrees(GAZE_CONE_DEG));
    for (int i = 0; i < TARGETS; i++) {
        double cosine = 1 - narrow * fraction(0.5 + STEP_U * i);
        double sine = sqrt(1 - cosine * cosine), phi = 2 * PI * fraction(STEP_V * i);
        Vec3   d = vec3((float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)cosine);
        targets[i] = vec3_add(goal->eye, frame_to_world(&frame, d));
    }
}

/* ---- what paths find --------------------------------------------------------------------- */

static bool is_pane(const Scene *scene, int part_id)
{
    return scene->materials[scene->parts[part_id].material_id].transmission > 0;
}

/* The step at which a pane mirrors what the eye sees there; NO_ID: none does. */
static int mirroring_step(const Scene *scene, const PathHistory *history)
{
    int kept = path_steps_kept(history), i = 0;
    while (i < kept && history->step[i].event == PATH_TRANSMITS) i++;
    bool mirrors = i < kept && history->step[i].event == PATH_REFLECTS &&
                   is_pane(scene, history->step[i].part_id);
    return mirrors ? i : NO_ID;
}

/* Straight, or through panes with a thickness. */
static bool is_suns_disc(const PathHistory *history)
{
    for (int i = 0; i < path_steps_kept(history); i++)
        if (history->step[i].event != PATH_TRANSMITS) return false;
    return history->source == LIGHTS_SUN;
}

/* Sums over a chunk of paths. */
typedef struct GazeChunk {
    const Scene *scene;
    double       through, mirrored;
} GazeChunk;

static void on_light(void *user, const PathHistory *history, const float xyz[3])
{
    GazeChunk *chunk = user;
    bool       is_mirrored = mirroring_step(chunk->scene, history) != NO_ID;
    if (!is_suns_disc(history))
        *(is_mirrored ? &chunk->mirrored : &chunk->through) += (double)xyz[1];
}

/* ---- how much ---------------------------------------------------------------------------- */

typedef struct GazeRound {
    const Setup *setup;
    ProbeAim     aim;
    int          first; /* chunk */
    GazeChunk   *chunks;
} GazeRound;

static void read_chunk(void *user, int item, int worker)
{
    (void)worker;
    const GazeRound *round = user;
    PathStatistics   statistics = {0};
    GazeChunk       *chunk = &round->chunks[item];
    PathListener     listener = {.on_light = on_light, .user = chunk};
    int              first = (round->first + item) * CHUNK;
    *chunk = (GazeChunk){.scene = round->setup->scene};
    round->setup->tools.kernel->trace(&round->aim, first, first + CHUNK, &listener,
                                      &statistics);
}

/* One figure over the chunks so far. */
typedef struct GazeSum {
    double sum, squares; /* of the chunks' means */
} GazeSum;

static void add_mean(GazeSum *to, double sum)
{
    to->sum += sum / CHUNK;
    to->squares += sum / CHUNK * (sum / CHUNK);
}

static double mean_of(const GazeSum *sum, int chunks, double *sigma)
{
    double mean = sum->sum / chunks;
    *sigma = sqrt(fmax(sum->squares / chunks - mean * mean, 0) / (chunks - 1));
    return mean;
}

static bool is_sure(const GazeReading *reading, double precision)
{
    return reading->through_sigma <= precision * reading->through &&
           reading->mirrored_sigma <= precision * reading->mirrored;
}

/* As many paths again as there were before, until both figures are sure. */
static void read_cone(const Setup *setup, const GazeGoal *goal, const ProbeAim *aim,
                      GazeReading *out, Arena scratch)
{
    GazeSum   through = {0}, mirrored = {0};
    GazeRound round = {setup, *aim, 0, NULL};
    int       chunks = LEAST / CHUNK;
    do {
        Arena room = scratch;
        round.chunks = ARENA_NEW(&room, GazeChunk, chunks);
        parallel_for(setup->tools.threads, chunks, read_chunk, &round);
        for (int i = 0; i < chunks; i++) {
            add_mean(&through, round.chunks[i].through);
            add_mean(&mirrored, round.chunks[i].mirrored);
        }
        chunks = round.first += chunks;
        out->through = mean_of(&through, chunks, &out->through_sigma);
        out->mirrored = mean_of(&mirrored, chunks, &out->mirrored_sigma);
    } while (!is_sure(out, goal->precision) && 2 * chunks * CHUNK <= goal->most);
}

/* ---- from where -------------------------------------------------------------------------- */

/* Mirrored light by scene part: the pane's, and that of the part it shows; behind the parts one
 * place for each set of lights. */
typedef struct GazeTally {
    const Scene *scene;
    double      *panes, *shown;
} GazeTally;

static int place_shown(const Scene *scene, const PathHistory *history, int from)
{
    for (int i = from + 1; i < path_steps_kept(history); i++)
        if (!is_pane(scene, history->step[i].part_id)) return history->step[i].part_id;
    return history->source == LIGHTS_EMITTERS ? history->source_id
                                           : scene->part_count + (int)history->source;
}

static void add_place(void *user, const PathHistory *history, const float xyz[3])
{
    GazeTally *tally = user;
    int        step = mirroring_step(tally->scene, history);
    if (step == NO_ID) return;
    tally->panes[history->step[step].part_id] += (double)xyz[1];
    tally->shown[place_shown(tally->scene, history, step)] += (double)xyz[1];
}

/* NO_ID: all are 0. */
static int greatest(const double *values, int count)
{
    int at = NO_ID;
    for (int i = 0; i < count; i++)
        if (values[i] > (at == NO_ID ? 0 : values[at])) at = i;
    return at;
}

static GazeMirrored find_mirrored(const Setup *setup, const ProbeAim *aim, Arena scratch)
{
    int            parts = setup->scene->part_count;
    GazeTally      tally = {setup->scene, ARENA_NEW(&scratch, double, parts),
                            ARENA_NEW(&scratch, double, parts + LIGHT_SETS)};
    PathListener   listener = {.on_light = add_place, .user = &tally};
    PathStatistics statistics = {0};
    setup->tools.kernel->trace(aim, 0, LEAST, &listener, &statistics);
    int shown = greatest(tally.shown, parts + LIGHT_SETS);
    return (GazeMirrored){greatest(tally.panes, parts), shown < parts ? shown : NO_ID,
                          shown < parts ? LIGHTS_SUN : (LightSet)(shown - parts)};
}

static GazeReading read_gaze(const Setup *setup, const GazeGoal *goal, Arena scratch)
{
    GazeReading out = {.most = {NO_ID, NO_ID, LIGHTS_SUN}};
    Vec3       *targets = ARENA_NEW(&scratch, Vec3, TARGETS);
    ProbeAim    aim = {.context = &setup->context, .eye = goal->eye, .targets = targets,
                       .target_count = TARGETS, .seed = review_seed(setup->request, SEED)};
    aim_at_cone(goal, targets);
    read_cone(setup, goal, &aim, &out, scratch);
    if (out.mirrored > 0) out.most = find_mirrored(setup, &aim, scratch);
    return out;
}

GazeReading gaze_read(const Setup *setup, const GazeGoal *goal, Arena scratch)
{
    const ReadingTools *tools = &setup->tools;
    GazeReading reading;
    if (!tools->journal) return read_gaze(setup, goal, scratch);
    ProbeAim   aim = {.context = &setup->context, .eye = goal->eye, .targets = &goal->towards,
                      .target_count = 1, .seed = review_seed(setup->request, SEED)};
    double     numbers[] = {goal->precision, goal->most};
    Question   question = {.base = tools->base, .kind = "gaze", .numbers = numbers,
                           .number_count = COUNT_OF(numbers)};
    JournalKey key = question_key(&question, &aim, scratch);
    if (journal_find(tools->journal, key, &reading, sizeof reading)) return reading;
    reading = read_gaze(setup, goal, scratch);
    journal_add(tools->journal, key, &reading, sizeof reading);
    return reading;
}
