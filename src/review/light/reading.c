/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/reading.h"

#include <math.h>
#include <stddef.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/count.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/sampler.h"
#include "estimate/estimate.h"
#include "estimate/estimate_plan.h"
#include "guide/guide_file.h"
#include "render/identity.h"
#include "render/signals.h"
#include "review/light/reading_batch.h"
#include "review/light/response_suns.h"

/* ---- x ----------------------------------------------------------------------------------- */

static void add_floats(XXH3_state_t *state, Vec3 v)
{
    const float values[3] = {v.x, v.y, v.z};
    XXH3_128bits_update(state, values, sizeof values);
}

static void add_count(XXH3_state_t *state, int64_t count)
{
    XXH3_128bits_update(state, &count, sizeof count);
}

static void add_polariser(XXH3_state_t *state, const PolarisedEye *eye)
{
    add_floats(state, eye->right);
    add_floats(state, vec3(eye->axis[0], eye->axis[1], eye->lets));
    add_floats(state, vec3(eye->blocks, 0, 0));
}

static void add_aim(XXH3_state_t *state, const ProbeAim *aim)
{
    add_count(state, aim->seed);
    add_count(state, aim->meter ? 1 + aim->meter->both_sides : 0);
    if (aim->meter) {
        add_floats(state, aim->meter->position);
        add_floats(state, aim->meter->ns);
        return;
    }
    add_floats(state, aim->eye);
    if (aim->colour) XXH3_128bits_update(state, aim->colour, sizeof *aim->colour);
    if (aim->context->eye) add_polariser(state, aim->context->eye);
    add_count(state, aim->target_count);
    XXH3_128bits_update(state, aim->targets, (size_t)aim->target_count * sizeof *aim->targets);
    if (aim->patches)
        XXH3_128bits_update(state, aim->patches,
                            (size_t)aim->target_count * sizeof *aim->patches);
}

uint64_t question_aim(const ProbeAim *aim)
{
    XXH3_state_t state;
    XXH3_128bits_reset(&state);
    add_aim(&state, aim);
    return XXH3_128bits_digest(&state).low64;
}

/* The light that shines now: surroundings and displays. */
static void add_light(XXH3_state_t *state, const PathContext *context, Arena scratch)
{
    const Scene *scene = context->scene;
    Text         text = {.arena = &scratch};
    identity_add_environment(&text, scene);
    XXH3_128bits_update(state, text.data, text.size);
    for (int i = 0; i < scene->display_count; i++)
        XXH3_128bits_update(state, &scene->displays[i].level, sizeof(float));
    add_count(state, context->max_bounces);
    add_count(state, (int64_t)context->strategy);
    add_count(state, context->without_mirrored_sun);
    add_count(state, context->guide ? (int64_t)guide_hash(context->guide) : 0);
}

JournalKey question_key(const Question *question, const ProbeAim *aim, Arena scratch)
{
    XXH3_state_t state;
    XXH3_128bits_reset(&state);
    XXH3_128bits_update(&state, &question->base, sizeof question->base);
    XXH3_128bits_update(&state, question->kind, strlen(question->kind));
    add_light(&state, aim->context, scratch);
    add_aim(&state, aim);
    add_count(&state, question->number_count);
    XXH3_128bits_update(&state, question->numbers,
                        (size_t)question->number_count * sizeof *question->numbers);
    add_count(&state, question->towards_count);
    if (question->towards_count)
        XXH3_128bits_update(&state, question->towards,
                            (size_t)question->towards_count * sizeof *question->towards);
    XXH128_hash_t hash = XXH3_128bits_digest(&state);
    return (JournalKey){hash.low64, hash.high64};
}

#define BATCHES READING_BATCHES
#define PILOT_REACH 4 /* estimate_plan.h */
#define PILOT_SEED 0x70696c6fu
#define PIECE 64 /* paths that are looked at together */

/* Paths that go on where they ended. */
typedef struct Stream {
    ProbeAim      aim;
    const Kernel *kernel;
    int           threads;
    int           first, end; /* paths of every batch */
    Batch        *batches;
    TargetLight  *targets;    /* of each batch; NULL: they are not kept apart */
} Stream;

static void add_targets(TargetLight *to, const ProbeLook *looks, int count)
{
    for (int i = 0; i < count; i++) {
        if (!looks[i].is_found) continue;
        TargetLight *target = &to[looks[i].target];
        target->paths++;
        target->sum += looks[i].reflected[1];
        target->squares += looks[i].reflected[1] * looks[i].reflected[1];
    }
}

static void read_batch(void *user, int item, int worker)
{
    (void)worker;
    const Stream  *stream = user;
    ProbeLook      looks[PIECE];
    PathStatistics statistics = {0};
    ProbeAim       aim = stream->aim;
    aim.seed = hash_combine(hash_u32(aim.seed), (uint32_t)item);
    aim.is_spread = true;
    for (int first = stream->first; first < stream->end; first += PIECE) {
        if (signals_stop_requested()) return;
        int end = first + PIECE < stream->end ? first + PIECE : stream->end;
        stream->kernel->look(&aim, first, end, looks, &statistics);
        reading_batch_add(&stream->batches[item], looks, end - first, aim.by_display);
        if (stream->targets)
            add_targets(stream->targets + (size_t)item * (size_t)aim.target_count, looks,
                        end - first);
    }
    stream->batches[item].sky_finds += (long)statistics.sky_finds;
    stream->batches[item].sent_on += statistics.sent_on;
}

/* Where no ray of the sun was seen to come in, a beam as wide as the map's pixels may. */
static double unseen_by(const ProbeAim *aim)
{
    return (double)sunlit_map_unseen(&aim->context->sunlit);
}

static Estimate estimate_in(const Reading *reading, const ProbeAim *aim, double known)
{
    return (Estimate){.mean = reading->reflected, .sigma = reading->sigma,
                      .interval = reading->interval, .bright = reading->bright,
                      .counted = (double)reading->paths * reading->found_share,
                      .unseen = unseen_by(aim),
                      .known_sigma = RESPONSE_MIRROR_ERROR * known};
}

static void put_estimate(const Estimate *estimate, Reading *to)
{
    to->reflected = estimate->mean;
    to->sigma = estimate->sigma;
    to->interval = estimate->interval;
}

/* What the sky may send although no path met it: it may be seen through openings that one path
 * in so many would meet. By which of the surface's ways they would does not matter: a path that
 * goes out there brings what the surface sends on of a sky as bright as the mean. */
static double sky_unmet(const ProbeAim *aim, const Batch batches[BATCHES], double found)
{
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
                          double known)
{
    EstimateSums sums = {.batches = BATCHES, .paths = (long)paths * BATCHES, .piece = 1,
                         .unseen = unseen_by(aim)};
    Reading      reading = {.paths = sums.paths};
    double       mirror = 0, found = 0;
    for (int i = 0; i < BATCHES; i++) {
        sums.batch[i] = batches[i].reflected;
        mirror += batches[i].mirror;
        found += (double)batches[i].found;
        sums.bright.squares += batches[i].bright.squares;
        sums.bright.fourths += batches[i].bright.fourths;
    }
    reading.bright = sums.bright;
    if (!(found > 0)) return reading;
    sums.share = reading.found_share = found / (double)reading.paths;
    sums.unmet += sky_unmet(aim, batches, found);
    Estimate estimate = estimate_of(&sums);
    estimate_add_known(&estimate, known, RESPONSE_MIRROR_ERROR * known);
    put_estimate(&estimate, &reading);
    reading.mirror = mirror / found + known;
    for (int i = 0; i < BATCHES; i++)
        reading.batches[i] = estimate_batch(&sums, i) + known;
    return reading;
}

static double relative_error(const Reading *reading)
{
    return reading->reflected > 0 ? reading->sigma / reading->reflected : 0;
}

/* By how much of itself one standard error moves what counts. */
static double uncertainty(const Reading *reading, const ReadingGoal *goal)
{
    double r = fmax(reading->reflected, 0);
    if (goal->brighter <= 0 && goal->darker <= 0) return relative_error(reading);
    double bright = goal->brighter + r, dark = goal->darker + r;
    if (!(dark > 0)) return reading->sigma > 0 ? (double)INFINITY : 0;
    return fabs(1 / bright - 1 / dark) * reading->sigma;
}

static bool is_sure(const Reading *reading, const ReadingGoal *goal)
{
    return uncertainty(reading, goal) <= goal->precision;
}

static bool is_decided(const Reading *reading, const ReadingGoal *goal, Arena scratch)
{
    const ReadingQuestion *question = goal->question;
    return question && uncertainty(reading, goal) <= question->precision &&
           relative_error(reading) <= question->precision &&
           question->is_decided(question->user, reading->interval, scratch);
}

/* ---- under other levels ------------------------------------------------------------------ */

/* All that a shared reading is made of. */
typedef struct ReadingParts {
    Batch  pilot[BATCHES], fresh[BATCHES];
    int    pilot_paths, paths; /* in every batch */
    double seconds;
} ReadingParts;

/* ---- one stream -------------------------------------------------------------------------- */

static Stream stream_start(const ProbeAim *aim, const ReadingTools *tools, Arena *arena)
{
    return (Stream){*aim, tools->kernel, tools->threads, 0, 0,
                    ARENA_NEW(arena, Batch, BATCHES), NULL};
}

/* All of its paths, up to so many. */
static Reading stream_read(Stream *stream, long paths, const ReadingGoal *goal)
{
    stream->end = (int)(paths / BATCHES);
    parallel_for(stream->threads, BATCHES, read_batch, stream);
    stream->first = stream->end;
    return reading_of(&stream->aim, stream->batches, stream->end, goal->known);
}

static void keep_stream(const Stream *stream, Batch *batches, int *paths)
{
    memcpy(batches, stream->batches, BATCHES * sizeof *batches);
    *paths = stream->end;
}

/* ---- a pilot, and what it requires ------------------------------------------------------- */

/* A pilot, and what would do. */
typedef struct PilotWork {
    Stream             stream;
    const ReadingGoal *goal;
    Reading            reading;
    Arena              scratch;
} PilotWork;

static void read_pilot(void *user, long paths)
{
    PilotWork *work = user;
    work->reading = stream_read(&work->stream, paths, work->goal);
}

static bool will_do(void *user, long pilot, long paths)
{
    PilotWork *work = user;
    Estimate   now = estimate_in(&work->reading, &work->stream.aim, work->goal->known);
    Estimate   then = estimate_expected(&now, (double)paths / (double)pilot);
    Reading    fresh = work->reading;
    put_estimate(&then, &fresh);
    return is_sure(&fresh, work->goal) || is_decided(&fresh, work->goal, work->scratch);
}

/* A number of paths that nothing decides is the least and the most. */
static EstimatePlan plan_of(PilotWork *work)
{
    const ReadingGoal *goal = work->goal;
    bool is_given = !goal->question && !(goal->precision > 0);
    long most = is_given ? goal->most / BATCHES * BATCHES : goal->most;
    long least = is_given ? most : goal->question ? READING_ASKED_LEAST : READING_LEAST;
    return (EstimatePlan){.pilot = least / 2, .least = least, .most = most,
                          .reach = PILOT_REACH, .user = work, .read_pilot = read_pilot,
                          .will_do = will_do};
}

static Reading take_planned(const ProbeAim *aim, const ReadingGoal *goal,
                            const ReadingTools *tools, ReadingParts *parts, Arena scratch)
{
    Stream    fresh = stream_start(aim, tools, &scratch);
    PilotWork work = {.stream = stream_start(aim, tools, &scratch), .goal = goal};
    work.stream.aim.seed = hash_combine(hash_u32(aim->seed), PILOT_SEED);
    work.scratch = scratch;
    EstimatePlan plan = plan_of(&work);
    long         paths = estimate_plan(&plan);
    if (goal->times > 1) paths *= goal->times;
    Reading reading = stream_read(&fresh, paths > goal->least ? paths : goal->least, goal);
    if (!parts) return reading;
    keep_stream(&work.stream, parts->pilot, &parts->pilot_paths);
    keep_stream(&fresh, parts->fresh, &parts->paths);
    return reading;
}

/* parts: NULL: not requested. */
static Reading take(const ProbeAim *aim, const ReadingGoal *goal, const ReadingTools *tools,
                    ReadingParts *parts, Arena scratch)
{
    double   start = monotonic_seconds();
    ProbeAim own = *aim;
    own.by_display = parts != NULL;
    Reading reading = take_planned(&own, goal, tools, parts, scratch);
    reading.reached = uncertainty(&reading, goal);
    reading.seconds = monotonic_seconds() - start;
    if (parts) parts->seconds = reading.seconds;
    return reading;
}

/* ---- what is kept ------------------------------------------------------------------------ */

/* Where a stop was requested a reading may be cut off: nobody goes on with it
 * (review_goes_on). */
static void keep(Journal *journal, JournalKey key, const void *answer, size_t size)
{
    if (!signals_stop_requested()) journal_add(journal, key, answer, size);
}

static JournalKey key_of(const ProbeAim *aim, const ReadingGoal *goal,
                         const ReadingTools *tools, Arena scratch)
{
    const ReadingQuestion *asked = goal->question;
    double   numbers[] = {goal->brighter, goal->darker, goal->precision, (double)goal->most,
                          goal->known, asked ? asked->precision : 0,
                          (double)goal->times, (double)goal->least};
    Question question = {.base = tools->base, .kind = asked ? asked->name : "reading",
                         .numbers = numbers, .number_count = COUNT_OF(numbers)};
    return question_key(&question, aim, scratch);
}

/* Without emitted light and number of paths, in which shared readings differ. */
static JournalKey parts_key(const ProbeAim *aim, const ReadingGoal *goal,
                            const ReadingTools *tools, Arena scratch)
{
    const ReadingQuestion *asked = goal->question;
    double   numbers[] = {goal->precision, (double)goal->most, goal->known,
                          asked ? asked->precision : 0};
    Question question = {.base = tools->base,
                         .kind = arena_format(&scratch, "parts, %s",
                                              asked ? asked->name : "reading"),
                         .numbers = numbers, .number_count = COUNT_OF(numbers)};
    return question_key(&question, aim, scratch);
}

static int displays_of(const ProbeAim *aim)
{
    return aim->context->scene->display_count;
}

/* No plan requires more: whoever kept it took no more. */
static long most_paths(const ReadingGoal *goal)
{
    long most = goal->most > READING_ASKED_LEAST ? goal->most : READING_ASKED_LEAST;
    if (goal->times > 1) most *= goal->times;
    return most > goal->least ? most : goal->least;
}

/* Whether it may have been taken for that goal: a checksum can be made to fit. */
static bool is_sound(const Reading *reading, const ReadingGoal *goal)
{
    bool ok = reading->paths > 0 && reading->paths <= most_paths(goal) &&
              isfinite(reading->reflected) && isfinite(reading->mirror) &&
              reading->sigma >= 0 && reading->interval.low <= reading->interval.high &&
              reading->found_share >= 0 && reading->found_share <= 1 &&
              reading->bright.squares >= 0 && reading->bright.fourths >= 0;
    for (int i = 0; i < BATCHES; i++) ok = ok && isfinite(reading->batches[i]);
    return ok;
}

static size_t parts_bytes(int displays)
{
    return 2 * BATCHES * reading_batch_bytes(displays) + 2 * sizeof(int) + sizeof(double);
}

static void keep_parts(Journal *journal, JournalKey key, const ReadingParts *parts,
                       int displays, Arena scratch)
{
    unsigned char *bytes = ARENA_NEW(&scratch, unsigned char, parts_bytes(displays));
    unsigned char *to = bytes;
    const int      paths[2] = {parts->pilot_paths, parts->paths};
    reading_batches_pack(parts->pilot, displays, &to);
    reading_batches_pack(parts->fresh, displays, &to);
    memcpy(to, paths, sizeof paths);
    memcpy(to + sizeof paths, &parts->seconds, sizeof parts->seconds);
    keep(journal, key, bytes, parts_bytes(displays));
}

/* Who was given a number of paths had no pilot. */
static bool find_parts(const Journal *journal, JournalKey key, int displays, long most,
                       ReadingParts *parts, Arena scratch)
{
    unsigned char       *bytes = ARENA_NEW(&scratch, unsigned char, parts_bytes(displays));
    const unsigned char *from = bytes;
    int                  paths[2];
    if (!journal_find(journal, key, bytes, parts_bytes(displays))) return false;
    reading_batches_unpack(&from, displays, parts->pilot);
    reading_batches_unpack(&from, displays, parts->fresh);
    memcpy(paths, from, sizeof paths);
    memcpy(&parts->seconds, from + sizeof paths, sizeof parts->seconds);
    parts->pilot_paths = paths[0];
    parts->paths = paths[1];
    return paths[0] >= 0 && paths[0] <= most / BATCHES && paths[1] > 0 &&
           paths[1] <= most / BATCHES &&
           reading_batches_are_sound(parts->pilot, paths[0], displays) &&
           reading_batches_are_sound(parts->fresh, paths[1], displays);
}

static bool find_reading(const Journal *journal, JournalKey key, const ReadingGoal *goal,
                         Reading *out)
{
    return journal_find(journal, key, out, sizeof *out) && is_sound(out, goal);
}

/* A reading that was kept before anybody shared it is taken again, with the same result. */
static Reading take_shared(const ProbeAim *aim, const ReadingGoal *goal,
                           const ReadingTools *tools, Arena scratch)
{
    Reading       reading;
    ReadingParts *parts = ARENA_NEW(&scratch, ReadingParts, 1);
    JournalKey key = key_of(aim, goal, tools, scratch);
    JournalKey shared = parts_key(aim, goal, tools, scratch);
    if (find_reading(tools->journal, key, goal, &reading) &&
        find_parts(tools->journal, shared, displays_of(aim), most_paths(goal), parts, scratch))
        return reading;
    reading = take(aim, goal, tools, parts, scratch);
    keep_parts(tools->journal, shared, parts, displays_of(aim), scratch);
    keep(tools->journal, key, &reading, sizeof reading);
    return reading;
}

Reading reading_take(const ProbeAim *aim, const ReadingGoal *goal, const ReadingTools *tools,
                     Arena scratch)
{
    Reading reading;
    if (!tools->journal) return take(aim, goal, tools, NULL, scratch);
    if (goal->is_shared && displays_of(aim) <= PROBE_DISPLAYS)
        return take_shared(aim, goal, tools, scratch);
    JournalKey key = key_of(aim, goal, tools, scratch);
    if (find_reading(tools->journal, key, goal, &reading)) return reading;
    reading = take(aim, goal, tools, NULL, scratch);
    keep(tools->journal, key, &reading, sizeof reading);
    return reading;
}

/* Would the reading have been taken by as many paths? */
static bool is_enough(const ProbeAim *aim, const ReadingParts *parts, const Reading *reading,
                      const ReadingGoal *goal, Arena scratch)
{
    PilotWork    work = {.stream.aim = *aim, .goal = goal, .scratch = scratch,
                         .reading = reading_of(aim, parts->pilot, parts->pilot_paths,
                                               goal->known)};
    EstimatePlan plan = plan_of(&work);
    return estimate_paths(&plan, work.reading.paths) <= reading->paths;
}

bool reading_scaled(const ProbeAim *aim, const ReadingGoal *goal, const double *scale,
                    const ReadingTools *tools, Arena scratch, Reading *out)
{
    int           displays = displays_of(aim);
    ReadingParts *parts = ARENA_NEW(&scratch, ReadingParts, 1);
    if (!tools->journal || displays > PROBE_DISPLAYS ||
        !find_parts(tools->journal, parts_key(aim, goal, tools, scratch), displays,
                    most_paths(goal), parts, scratch))
        return false;
    reading_batches_scale(parts->pilot, scale, displays);
    reading_batches_scale(parts->fresh, scale, displays);
    Reading reading = reading_of(aim, parts->fresh, parts->paths, goal->known);
    if (!is_enough(aim, parts, &reading, goal, scratch)) return false;
    reading.reached = uncertainty(&reading, goal);
    reading.seconds = parts->seconds;
    *out = reading;
    return true;
}

/* ---- target by target -------------------------------------------------------------------- */

static size_t targets_bytes(const ProbeAim *aim)
{
    return (size_t)aim->target_count * sizeof(TargetLight);
}

static void trace_field(const ProbeAim *aim, const FieldArgs *args, const ReadingTools *tools,
                        Batch *batches, TargetLight *targets, Arena scratch)
{
    ReadingGoal goal = {.known = 0};
    size_t      count = (size_t)aim->target_count;
    Stream      stream = stream_start(aim, tools, &scratch);
    stream.aim.by_display = args->is_shared;
    stream.targets = ARENA_NEW(&scratch, TargetLight, BATCHES * count);
    stream_read(&stream, args->paths, &goal);
    for (size_t i = 0; i < BATCHES * count; i++) {
        TargetLight *to = &targets[i % count];
        to->paths += stream.targets[i].paths;
        to->sum += stream.targets[i].sum;
        to->squares += stream.targets[i].squares;
    }
    memcpy(batches, stream.batches, BATCHES * sizeof *batches);
}

static JournalKey field_key(const ProbeAim *aim, const FieldArgs *args,
                            const ReadingTools *tools, Arena scratch)
{
    double   numbers[] = {(double)args->paths, args->is_shared};
    Question question = {.base = tools->base, .kind = "field", .numbers = numbers,
                         .number_count = COUNT_OF(numbers)};
    return question_key(&question, aim, scratch);
}

static bool field_is_sound(const ProbeAim *aim, const FieldArgs *args,
                           const TargetLight *targets, const Batch *batches, int displays)
{
    bool ok = reading_batches_are_sound(batches, args->paths / BATCHES, displays);
    for (int i = 0; i < aim->target_count; i++)
        ok = ok && targets[i].paths >= 0 && isfinite(targets[i].paths) &&
             isfinite(targets[i].sum) && isfinite(targets[i].squares);
    return ok;
}

/* Kept: the targets, then the batches. */
static void find_field(const ProbeAim *aim, const FieldArgs *args, const ReadingTools *tools,
                       Batch *batches, TargetLight *targets, Arena scratch)
{
    int            displays = args->is_shared ? displays_of(aim) : 0;
    size_t         bytes = targets_bytes(aim) + BATCHES * reading_batch_bytes(displays);
    unsigned char *kept = ARENA_NEW(&scratch, unsigned char, bytes);
    unsigned char *to = kept + targets_bytes(aim);
    const unsigned char *from = to;
    JournalKey     key = field_key(aim, args, tools, scratch);
    if (journal_find(tools->journal, key, kept, bytes)) {
        memcpy(targets, kept, targets_bytes(aim));
        reading_batches_unpack(&from, displays, batches);
        if (field_is_sound(aim, args, targets, batches, displays)) return;
        memset(targets, 0, targets_bytes(aim));
    }
    trace_field(aim, args, tools, batches, targets, scratch);
    memcpy(kept, targets, targets_bytes(aim));
    reading_batches_pack(batches, displays, &to);
    keep(tools->journal, key, kept, bytes);
}

Reading reading_field(const ProbeAim *aim, const FieldArgs *asked, const ReadingTools *tools,
                      TargetLight *targets, Arena scratch)
{
    FieldArgs args = *asked;
    Batch   *batches = ARENA_NEW(&scratch, Batch, BATCHES);
    args.is_shared = args.is_shared && displays_of(aim) <= PROBE_DISPLAYS;
    if (tools->journal) find_field(aim, &args, tools, batches, targets, scratch);
    else trace_field(aim, &args, tools, batches, targets, scratch);
    if (args.scale) reading_batches_scale(batches, args.scale, displays_of(aim));
    return reading_of(aim, batches, (int)(args.paths / BATCHES), args.known);
}
