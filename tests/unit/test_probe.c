/* SPDX-License-Identifier: Apache-2.0 */
/* What becomes of a probe's paths: a scene's closed forms; and, with a stand-in for the kernel,
 * whose paths find light by a known law, which paths are followed, in which order they are
 * merged, and that a stop ends them. */
#include "fixture.h"

#include <math.h>
#include <signal.h>

#include "base/sampler.h"
#include "base/units.h"
#include "probe/path_kinds.h"
#include "render/signals.h"
#include "world_fixture.h"

/* ---- closed forms ------------------------------------------------------------------------ */

#define REFLECTANCE 0.2f
#define SUN_LX 80000.0f
#define SUN_DEG 40.0
#define LUX ((double)SUN_LX * sin(radians_from_degrees(SUN_DEG)))

/* A floor in the sun. */
static World sunny_floor(void) {
    World world = world_start();
    world.scene->environment.has_sun = true;
    world.scene->environment.sun_elevation = (float)radians_from_degrees(SUN_DEG);
    world.scene->environment.sun_illuminance_lx = SUN_LX;
    builder_part(world.scene, builder_material(REFLECTANCE));
    builder_quad(world.scene, vec3(0, 0, 0), vec3(10, 0, 0), vec3(0, 0, -10));
    world_ready(&world, 16);
    return world;
}

static ProbeTools tools_of(int threads) {
    ProbeTools tools = {.threads = threads};
    assert_done(kernel_choose(NULL, &tools.kernel, &err));
    return tools;
}

static void add_light(const ProbePart *to, const PathHistory *history, const float xyz[3]) {
    (void)history;
    *(double *)to->own += (double)xyz[1];
}

static void merge_sum(const ProbePart *from) {
    *(double *)from->user += *(const double *)from->own;
}

static ProbeFold sum_into(double *sum) {
    *sum = 0;
    return (ProbeFold){
        .user = sum, .bytes = sizeof *sum, .on_light = add_light, .merge = merge_sum};
}

/* rho E / pi to an eye, E to a luxmeter. */
TEST(a_folds_sum_is_the_closed_form) {
    SCOPED_WORLD world = sunny_floor();
    Vec3 target = vec3(0, 0, -1);
    LitPoint meter = {vec3(0, 1, 0), vec3(0, 1, 0), false};
    ProbeAim aim = {
        .context = &world.context, .eye = vec3(0, 1, 0), .targets = &target, .target_count = 1};
    ProbeGoal goal = {.pieces = 64, .paths = 64, .streams = 32};
    ProbeTools tools = tools_of(2);
    double sum;
    ProbeFold fold = sum_into(&sum);
    probe_read(&aim, &goal, &tools, &fold, 1, world.arena);
    assert_close(sum / 4096, (double)REFLECTANCE * LUX / PI, 0.005);
    fold = sum_into(&sum);
    aim.meter = &meter;
    probe_read(&aim, &goal, &tools, &fold, 1, world.arena);
    assert_close(sum / 4096, LUX, 0.005);
}

/* The last bit of a sum of doubles tells in which order it was made. */
TEST(threads_and_pieces_at_once_change_no_bit) {
    static const int threads[] = {1, 2, 5}, at_once[] = {0, 1, 7};
    SCOPED_WORLD world = sunny_floor();
    Vec3 targets[3] = {{0, 0, -1}, {1, 0, -1}, {0, 0, -2}};
    ProbeAim aim = {
        .context = &world.context, .eye = vec3(0, 1, 0), .targets = targets, .target_count = 3};
    double first = 0;
    for (int i = 0; i < 9; i++) {
        ProbeGoal goal = {.pieces = 50,
                          .paths = 33,
                          .streams = 8,
                          .at_once = at_once[i / 3],
                          .together = 10 * (i % 2)};
        ProbeTools tools = tools_of(threads[i % 3]);
        double sum, twice;
        ProbeFold folds[2] = {sum_into(&sum), sum_into(&twice)};
        probe_read(&aim, &goal, &tools, folds, 1 + i % 2, world.arena);
        if (i == 0) first = sum;
        assert_memory_equal(&sum, &first, sizeof sum);
        if (i % 2) assert_memory_equal(&twice, &first, sizeof twice);
    }
}

/* ---- which paths ------------------------------------------------------------------------- */

#define STREAMS 8
#define SEED 7u

/* The stand-in's light tells which path it is of. */
static void look(const ProbeAim *aim, int first, int end, ProbeLook *out,
                 PathStatistics *statistics) {
    for (int i = first; i < end; i++) {
        float bits = (float)(hash_combine(hash_u32(aim->seed), (uint32_t)i) >> 8);
        out[i - first] = (ProbeLook){.reflected = {bits, bits, bits}, .is_found = aim->is_spread};
        statistics->lost += 1;
    }
}

typedef struct Merged {
    int pieces, paths, next[STREAMS]; /* of all; the path that a stream goes on with */
    bool is_wrong;
} Merged;

typedef struct Followed {
    int next;
    bool is_wrong;
} Followed;

static void begin_followed(ProbePart *to, Arena *arena) {
    (void)arena;
    Followed *own = to->own;
    own->is_wrong = own->next != 0; /* zeros, also where an earlier round was */
    own->next = to->piece->first;
}

static void take_look(const ProbePart *to, const ProbeLook *found) {
    Followed *own = to->own;
    int path = to->piece->path;
    float bits = (float)(hash_combine(hash_u32(to->piece->aim.seed), (uint32_t)path) >> 8);
    own->is_wrong |= path != own->next || found->reflected[1] != bits || !found->is_found;
    own->next++;
}

static void merge_followed(const ProbePart *from) {
    const Followed *own = from->own;
    const ProbePiece *piece = from->piece;
    Merged *to = from->user;
    uint32_t seed = hash_combine(hash_u32(SEED), (uint32_t)piece->stream);
    to->is_wrong |= own->is_wrong || piece->id != to->pieces || piece->aim.seed != seed ||
                    piece->stream != piece->id % STREAMS || own->next != piece->end ||
                    piece->first != to->next[piece->stream] ||
                    piece->statistics.lost != piece->end - piece->first;
    to->next[piece->stream] = piece->end;
    to->paths += piece->end - piece->first;
    to->pieces++;
}

static const Kernel stand_in = {.look = look};
static const ProbeAim no_aim = {.seed = SEED};

TEST(every_path_is_followed_once_and_merged_in_order) {
    ProbeTools tools = {&stand_in, 3};
    for (int at_once = 0; at_once < 20; at_once += 3) {
        ProbeGoal goal = {
            .pieces = 27, .paths = 100, .first = 5, .streams = STREAMS, .at_once = at_once};
        Merged merged = {.next = {5, 5, 5, 5, 5, 5, 5, 5}};
        ProbeFold fold = {.user = &merged,
                          .bytes = sizeof(Followed),
                          .begin = begin_followed,
                          .look = take_look,
                          .merge = merge_followed};
        probe_read(&no_aim, &goal, &tools, &fold, 1, *test_memory());
        assert_false(merged.is_wrong);
        assert_int_equal(merged.pieces, 27);
        assert_int_equal(merged.paths, 2700);
    }
}

/* A path's light comes between. */
typedef struct Between {
    int count;
    bool is_open, is_wrong;
} Between;

static void before(const ProbePart *to) {
    Between *between = to->user;
    between->is_wrong |= between->is_open || to->piece->path != between->count;
    between->is_open = true;
}

static void count_look(const ProbePart *to, const ProbeLook *found) {
    (void)found;
    Between *between = to->user;
    between->is_wrong |= !between->is_open;
    between->count++;
}

static void after(const ProbePart *to) {
    Between *between = to->user;
    between->is_wrong |= !between->is_open || to->piece->path + 1 != between->count;
    between->is_open = false;
}

TEST(a_path_is_between_before_and_after) {
    ProbeTools tools = {&stand_in, 1};
    ProbeGoal goal = {.pieces = 3, .paths = 100};
    Between between = {.count = 0};
    ProbeFold fold = {.user = &between, .before = before, .look = count_look, .after = after};
    probe_read(&no_aim, &goal, &tools, &fold, 1, *test_memory());
    assert_false(between.is_wrong);
    assert_int_equal(between.count, 300);
}

/* ---- a stop ------------------------------------------------------------------------------ */

#define STOPS_AT 1000

static void stop(const ProbePart *to, const ProbeLook *found) {
    (void)found;
    if (++*(int *)to->user == STOPS_AT) raise(SIGTERM);
}

TEST(a_stop_ends_it_at_once) {
    ProbeTools tools = {&stand_in, 1};
    for (int at_once = 0; at_once < 2; at_once++) {
        ProbeGoal goal = {.pieces = 100, .paths = 300, .at_once = at_once};
        int count = 0;
        ProbeFold fold = {.user = &count, .look = stop};
        signals_watch();
        probe_read(&no_aim, &goal, &tools, &fold, 1, *test_memory());
        assert_int_equal(count, STOPS_AT);
        signals_watch();
        count = STOPS_AT;
        probe_read(&no_aim, &goal, &tools, &fold, 1, *test_memory());
        assert_int_equal(count, STOPS_AT + 30000);
    }
}

/* ---- two kinds --------------------------------------------------------------------------- */

static Vec3 straight_down(KindBatch *batch, double u, double v) {
    (void)batch, (void)u, (void)v;
    return vec3(0, -1, 0);
}

static void add_kind(const ProbePart *to, const PathHistory *history, const float xyz[3]) {
    KindBatch *batch = to->own;
    if (path_is_by_mirrors(history) == batch->paths->by_mirrors) batch->path[0] += (double)xyz[1];
}

/* Both kinds together are all light, of as many paths as are allowed where none will do. */
TEST(two_kinds_add_up_to_the_closed_form) {
    SCOPED_WORLD world = sunny_floor();
    ProbeTools tools = tools_of(2);
    KindPaths like = {.tools = &tools,
                      .context = &world.context,
                      .eye = vec3(0, 1, 0),
                      .towards = straight_down,
                      .on_light = add_kind,
                      .most = 1 << 14,
                      .precision = -1};
    PathKinds found;
    path_kinds_read(&like, 1, &world.arena, &found);
    assert_int_equal(found.whole.end * ESTIMATE_BATCHES, 1 << 14);
    assert_close(path_kinds_figure(&found, 0).mean, (double)REFLECTANCE * LUX / PI, 0.005);
    assert_true(path_kind_estimate(&found.mirrors, 0).mean == 0);
}

TEST_PROGRAM(make_arena, drop_arena)
