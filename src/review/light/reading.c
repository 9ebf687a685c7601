/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/reading.h"

#include <math.h>
#include <stddef.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/count.h"
#include "base/sampler.h"
#include "estimate/estimate.h"
#include "estimate/estimate_plan.h"
#include "guide/guide_file.h"
#include "render/identity.h"
#include "review/light/response_suns.h"

static void add_floats(XXH3_state_t *state, Vec3 v) {
    const float values[3] = {v.x, v.y, v.z};
    XXH3_128bits_update(state, values, sizeof values);
}

static void add_count(XXH3_state_t *state, int64_t count) {
    XXH3_128bits_update(state, &count, sizeof count);
}

static void add_aim(XXH3_state_t *state, const ProbeAim *aim) {
    add_count(state, aim->seed);
    add_count(state, aim->meter ? 1 + aim->meter->both_sides : 0);
    if (aim->meter) {
        add_floats(state, aim->meter->position);
        add_floats(state, aim->meter->ns);
        return;
    }
    add_floats(state, aim->eye);
    if (aim->colour) XXH3_128bits_update(state, aim->colour, sizeof *aim->colour);
    const PolarisedEye *eye = aim->context->eye;
    if (eye) {
        add_floats(state, eye->right);
        add_floats(state, vec3(eye->axis[0], eye->axis[1], eye->lets));
        add_floats(state, vec3(eye->blocks, 0, 0));
    }
    add_count(state, aim->target_count);
    XXH3_128bits_update(state, aim->targets, (size_t)aim->target_count * sizeof *aim->targets);
    if (aim->patches)
        XXH3_128bits_update(state, aim->patches, (size_t)aim->target_count * sizeof *aim->patches);
}

uint64_t reading_aim_hash(const ProbeAim *aim) {
    XXH3_state_t state;
    XXH3_128bits_reset(&state);
    add_aim(&state, aim);
    return XXH3_128bits_digest(&state).low64;
}

#define BATCHES READING_BATCHES
#define PILOT_REACH 4 /* estimate_plan.h */
#define PILOT_SEED 0x70696c6fu
#define SPLIT 8 /* parts of a batch's paths, each of which a thread takes: work for 256 */
#define PARTS (BATCHES * SPLIT)

/* The sums of one batch of a reading's paths, or of a part of one. */
typedef struct Batch {
    double reflected, mirror;
    double beside[2]; /* X and Z of what is reflected */
    long found;
    BrightSamples bright;
    long sky_finds;    /* PathStatistics', */
    double lost, rare; /* its, too */
    double sent_on;
    TargetLight *targets; /* of a part; NULL: they are not kept apart */
} Batch;

/* Paths that go on where they ended. */
typedef struct Stream {
    ProbeAim aim;
    const ProbeTools *tools;
    int first, end; /* paths of every batch */
    Batch *batches;
    TargetLight *targets; /* [PARTS][target]; NULL: they are not kept apart */
} Stream;

static int part_begin(const Stream *stream, int part) {
    return stream->first + (int)((long)(stream->end - stream->first) * part / SPLIT);
}

static void begin_part(ProbePart *to, Arena *arena) {
    (void)arena;
    const Stream *stream = to->user;
    ProbePiece *piece = to->piece;
    int split = piece->id / BATCHES;
    piece->first = part_begin(stream, split);
    piece->end = part_begin(stream, split + 1);
    if (stream->targets)
        ((Batch *)to->own)->targets = stream->targets + (size_t)(piece->stream * SPLIT + split) *
                                                            (size_t)stream->aim.target_count;
}

static void add_look(const ProbePart *sums, const ProbeLook *look) {
    Batch *to = sums->own;
    double y = (double)look->reflected[1];
    to->reflected += y;
    to->mirror += (double)look->mirror[1];
    for (int k = 0; k < 2; k++) to->beside[k] += (double)look->reflected[2 * k];
    bright_add(&to->bright, y);
    to->found += look->is_found;
    if (!to->targets || !look->is_found) return;
    TargetLight *target = &to->targets[look->target];
    target->paths++;
    target->sum += y;
    target->squares += look->reflected[1] * look->reflected[1];
}

static void merge_part(const ProbePart *from) {
    const Batch *part = from->own;
    const PathStatistics *statistics = &from->piece->statistics;
    Batch *to = &((const Stream *)from->user)->batches[from->piece->stream];
    to->reflected += part->reflected;
    to->mirror += part->mirror;
    for (int k = 0; k < 2; k++) to->beside[k] += part->beside[k];
    to->found += part->found;
    to->sky_finds += (long)statistics->sky_finds;
    to->lost += statistics->lost;
    to->rare += statistics->rare;
    to->sent_on += statistics->sent_on;
    bright_merge(&to->bright, &part->bright);
}

static Estimate estimate_in(const Reading *reading, double known) {
    return (Estimate){.mean = reading->reflected,
                      .sigma = reading->sigma,
                      .interval = reading->interval,
                      .bright = reading->bright,
                      .counted = (double)reading->paths * reading->found_share,
                      .unseen = reading->unseen,
                      .known_sigma = RESPONSE_MIRROR_ERROR * known};
}

static void put_estimate(const Estimate *estimate, Reading *to) {
    to->reflected = estimate->mean;
    to->sigma = estimate->sigma;
    to->interval = estimate->interval;
}

/* What the sky may send although no path met it: it may be seen through openings that one path
 * in so many would meet. By which of the surface's ways they would does not matter: a path that
 * goes out there brings what the surface sends on of a sky as bright as the mean. */
static double sky_unmet(const ProbeAim *aim, const Batch batches[BATCHES], double found) {
    double sent_on = 0;
    for (int i = 0; i < BATCHES; i++) {
        if (batches[i].sky_finds) return 0;
        sent_on += batches[i].sent_on;
    }
    double share = aim->meter ? PI : sent_on / found;
    return estimate_unmet(share * (double)aim->context->selection.sky_cd_m2, found);
}

/* paths: in each batch. Those count that found the display. */
static Reading reading_of(const ProbeAim *aim, const Batch batches[BATCHES], int paths,
                          const ReadingGoal *goal) {
    double known = goal->known;
    EstimateSums sums = {.batches = BATCHES, .paths = (long)paths * BATCHES, .piece = 1};
    /* where no ray of the sun was seen to come in, a beam as wide as the map's pixels may */
    sums.unseen = (double)sunlit_map_unseen(&aim->context->sunlit);
    Reading reading = {.paths = sums.paths, .unseen = sums.unseen};
    double mirror = 0, found = 0, lost = 0, rare = 0;
    for (int i = 0; i < BATCHES; i++) {
        sums.batch[i] = batches[i].reflected;
        mirror += batches[i].mirror;
        found += (double)batches[i].found;
        lost += batches[i].lost;
        rare += batches[i].rare;
        bright_merge(&sums.bright, &batches[i].bright);
    }
    reading.bright = sums.bright;
    if (!(found > 0)) return reading;
    sums.share = reading.found_share = found / (double)reading.paths;
    sums.unmet += sky_unmet(aim, batches, found);
    reading.unseen = sums.unseen += (lost + fmax(rare, 0)) / found;
    Estimate estimate = estimate_of(&sums);
    estimate_add_known(&estimate, known, RESPONSE_MIRROR_ERROR * known);
    put_estimate(&estimate, &reading);
    reading.mirror = mirror / found + known;
    for (int i = 0; i < BATCHES; i++) {
        reading.batches[i] = estimate_batch(&sums, i) + known;
        for (int k = 0; k < 2; k++)
            reading.beside[i][k] =
                batches[i].beside[k] / (paths * sums.share) + goal->known_beside[k];
    }
    return reading;
}

static double relative_error(const Reading *reading) {
    return reading->reflected > 0 ? reading->sigma / reading->reflected : 0;
}

/* By how much of itself one standard error moves what counts. */
static double uncertainty(const Reading *reading, const ReadingGoal *goal) {
    double r = fmax(reading->reflected, 0);
    if (goal->brighter <= 0 && goal->darker <= 0) return relative_error(reading);
    double bright = goal->brighter + r, dark = goal->darker + r;
    if (!(dark > 0)) return reading->sigma > 0 ? (double)INFINITY : 0;
    return fabs(1 / bright - 1 / dark) * reading->sigma;
}

static bool is_decided(const Reading *reading, const ReadingGoal *goal, Arena scratch) {
    const ReadingQuestion *question = goal->question;
    return question && uncertainty(reading, goal) <= question->precision &&
           relative_error(reading) <= question->precision &&
           question->is_decided(question->user, reading->interval, scratch);
}

/* ---- one stream -------------------------------------------------------------------------- */

static Stream stream_start(const ProbeAim *aim, const ProbeTools *tools, Arena *arena) {
    return (Stream){.aim = *aim, .tools = tools, .batches = ARENA_NEW(arena, Batch, BATCHES)};
}

/* All of its paths, up to so many. */
static Reading stream_read(Stream *stream, long paths, const ReadingGoal *goal, Arena scratch) {
    ProbeGoal parts = {.pieces = PARTS, .streams = BATCHES};
    ProbeFold fold = {.user = stream,
                      .bytes = sizeof(Batch),
                      .begin = begin_part,
                      .look = add_look,
                      .merge = merge_part};
    stream->end = (int)(paths / BATCHES);
    probe_read(&stream->aim, &parts, stream->tools, &fold, 1, scratch);
    stream->first = stream->end;
    return reading_of(&stream->aim, stream->batches, stream->end, goal);
}

/* ---- a pilot, and what it requires ------------------------------------------------------- */

/* A pilot, and what would do. */
typedef struct PilotWork {
    Stream stream;
    const ReadingGoal *goal;
    Reading reading;
    Arena scratch;
} PilotWork;

static void read_pilot(void *user, long paths) {
    PilotWork *work = user;
    work->reading = stream_read(&work->stream, paths, work->goal, work->scratch);
}

static bool will_do(void *user, long pilot, long paths) {
    PilotWork *work = user;
    Estimate now = estimate_in(&work->reading, work->goal->known);
    Estimate then = estimate_expected(&now, (double)paths / (double)pilot);
    Reading fresh = work->reading;
    put_estimate(&then, &fresh);
    return uncertainty(&fresh, work->goal) <= work->goal->precision ||
           is_decided(&fresh, work->goal, work->scratch);
}

/* A number of paths that nothing decides is the least and the most. */
static EstimatePlan plan_of(PilotWork *work) {
    const ReadingGoal *goal = work->goal;
    bool is_given = !goal->question && !(goal->precision > 0);
    long most = is_given ? goal->most / BATCHES * BATCHES : goal->most;
    long least = is_given ? most : goal->question ? READING_ASKED_LEAST : READING_LEAST;
    return (EstimatePlan){.pilot = least / 2,
                          .least = least,
                          .most = most,
                          .reach = PILOT_REACH,
                          .user = work,
                          .read_pilot = read_pilot,
                          .will_do = will_do};
}

static Reading take_planned(const ProbeAim *aim, const ReadingGoal *goal, const ProbeTools *tools,
                            Arena scratch) {
    Stream fresh = stream_start(aim, tools, &scratch);
    PilotWork work = {.stream = stream_start(aim, tools, &scratch), .goal = goal};
    work.stream.aim.seed = hash_combine(hash_u32(aim->seed), PILOT_SEED);
    work.scratch = scratch;
    EstimatePlan plan = plan_of(&work);
    long paths = estimate_plan(&plan);
    if (goal->times > 1) paths *= goal->times;
    return stream_read(&fresh, paths > goal->least ? paths : goal->least, goal, scratch);
}

Reading reading_take(const ProbeAim *aim, const ReadingGoal *goal, const ProbeTools *tools,
                     Arena scratch) {
    Reading reading = take_planned(aim, goal, tools, scratch);
    reading.reached = uncertainty(&reading, goal);
    return reading;
}

/* ---- target by target -------------------------------------------------------------------- */

Reading reading_field(const ProbeAim *aim, long paths, double known, const ProbeTools *tools,
                      TargetLight *targets, Arena scratch) {
    ReadingGoal goal = {.known = known};
    size_t count = (size_t)aim->target_count;
    Stream stream = stream_start(aim, tools, &scratch);
    stream.targets = ARENA_NEW(&scratch, TargetLight, PARTS * count);
    Reading reading = stream_read(&stream, paths, &goal, scratch);
    for (size_t i = 0; i < PARTS * count; i++) {
        TargetLight *to = &targets[i % count];
        to->paths += stream.targets[i].paths;
        to->sum += stream.targets[i].sum;
        to->squares += stream.targets[i].squares;
    }
    return reading;
}
