/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/worst_frames.h"

#include <string.h>

#include "base/file.h"
#include "camera/camera.h"
#include "review/chain/outlook.h"
#include "review/keep/goes_on.h"
#include "review/light/setup_eyes.h"
#include "review/review_names.h"
#include "review/review_decide.h"
#include "review/run/explain.h"
#include "review/run/frames.h"
#include "review/run/sweep.h"
#include "review/run/symbols.h"

#define RIM_STEPS 8 /* points along a side of a symbol's rectangle */
#define SETUP_BYTES ((size_t)1 << 36) /* address space: what is not touched costs nothing */

/* ---- which ------------------------------------------------------------------------------- */

/* A case that may be rendered: of a moment, or the worst of a sweep. */
typedef struct Candidate {
    ReviewCase       *of;
    const SweepTable *table; /* NULL: a moment */
} Candidate;

/* `of`: null where nothing is seen. */
static Candidate candidate_of(ReviewOutcome *outcome, const ReviewCase *c)
{
    Review *review = &outcome->review;
    for (int i = 0; i < review->case_count; i++)
        if (c == &review->cases[i])
            return (Candidate){
                review_is_seen(c->visible_share) ? &review->cases[i] : NULL, NULL};
    for (int i = 0; i < outcome->table_count; i++) {
        const SweepTable *table = &outcome->tables[i];
        ReviewCase       *worst = &review->sweeps[table->sweep_id].worst;
        if (c == worst && table->figures.worst >= 0) return (Candidate){worst, table};
    }
    return (Candidate){NULL, NULL};
}

/* In the order of the page, so that its first screen has a picture. */
static Candidate *candidates(ReviewOutcome *outcome, int *count, Arena *arena)
{
    int                all = review_case_count(&outcome->review);
    const ReviewCase **ranked = review_rank(&outcome->review, arena);
    Candidate         *list = ARENA_NEW(arena, Candidate, all);
    *count = 0;
    for (int i = 0; i < all; i++) {
        Candidate found = candidate_of(outcome, ranked[i]);
        if (found.of) list[(*count)++] = found;
    }
    return list;
}

/* Are they seen in one frame: the same eye under the same light? */
static bool is_one_view(const Candidate *a, const Candidate *b)
{
    return a->table == b->table && !strcmp(a->of->eye, b->of->eye) &&
           !strcmp(a->of->condition, b->of->condition);
}

static bool find_middle(const Setup *setup, const char *symbol, Arena scratch, Vec3 *out,
                        Error *err)
{
    SetupSymbol *symbols;
    int          count;
    if (!setup_symbols(setup, &scratch, &symbols, &count, err)) return false;
    for (int i = 0; i < count; i++)
        if (!strcmp(symbols[i].name, symbol)) *out = symbol_middle(&symbols[i]).position;
    return true;
}

/* ---- what is drawn beside it ------------------------------------------------------------- */

static CaseView view_of(const Camera *camera)
{
    const Transform *t = &camera->world_from_camera;
    return (CaseView){t->origin, t->x, t->y, vec3_neg(t->z), camera->is_perspective,
                      (double)camera->half_width, (double)camera->half_height, camera->width,
                      camera->height};
}

/* From corner to corner; a curved display bends between them. */
static void add_rim(const SetupSymbol *symbol, ReviewCase *c, Arena *arena)
{
    const double *uv = symbol->uv;
    const double  corner[5][2] = {{uv[0], uv[1]}, {uv[2], uv[1]}, {uv[2], uv[3]},
                                  {uv[0], uv[3]}, {uv[0], uv[1]}};
    Vec3 *rim = ARENA_NEW(arena, Vec3, 4 * RIM_STEPS);
    for (int i = 0; i < 4 * RIM_STEPS; i++) {
        const double *a = corner[i / RIM_STEPS], *b = corner[i / RIM_STEPS + 1];
        double      t = (double)(i % RIM_STEPS) / RIM_STEPS;
        double      at[2] = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
        SymbolPoint point;
        if (symbol_surface_at(&symbol->surface, at, &point))
            rim[c->rim_count++] = point.position;
    }
    c->rim = rim;
}

static bool add_outlook(const FrameAsk *ask, const SetupSymbol *symbol, ReviewCase *c,
                        Arena *arena, Error *err)
{
    Arena       scratch = arena_reserve((size_t)1 << 28);
    Vec3        eye = scene_from_world(ask->setup->scene->origin, c->eye_m);
    Outlook     outlook = setup_outlook(ask->setup, symbol, eye, &scratch);
    Picture     picture = outlook_picture(&outlook, &scratch);
    PictureFile file = {.bits = 8, .is_srgb = true};
    c->outlook_words = outlook_words(&outlook, arena);
    c->outlook = arena_format(arena, "frames/%s-outlook.png", ask->name);
    file.description = c->outlook_words;
    const char *path = arena_format(arena, "%s/%s", ask->folder, c->outlook);
    bool        ok = picture_write(path, &picture, file, scratch, err);
    arena_release(&scratch);
    return ok;
}

/* Where its causes' rays lie in the frame, and what the display sees from the symbol. */
static bool add_sights(const FrameAsk *ask, ReviewCase *c, Arena *arena, Error *err)
{
    Arena        own = arena_reserve((size_t)1 << 34);
    SceneCamera  camera;
    SetupSymbol *symbols;
    int          count;
    bool         ok = frame_camera(ask, &camera, own, err) &&
              setup_symbols(ask->setup, &own, &symbols, &count, err);
    if (ok) {
        const ReviewFrames *frames = &ask->setup->request->frames;
        Camera    seen = camera_from_scene(&camera, frames->width, frames->height);
        CaseView *view = ARENA_NEW(arena, CaseView, 1);
        *view = view_of(&seen);
        c->view = view;
        for (int i = 0; i < count && ok; i++) {
            if (strcmp(symbols[i].name, c->symbol)) continue;
            add_rim(&symbols[i], c, arena);
            ok = add_outlook(ask, &symbols[i], c, arena, err);
        }
    }
    arena_release(&own);
    return ok;
}

/* ---- one frame --------------------------------------------------------------------------- */

/* A frame to make: its eye and its light. */
typedef struct FrameWork {
    const ReviewRun *run; /* of the review, or of a variant of it */
    const Candidate *of;
    const char      *name, *exposure; /* FrameAsk's */
} FrameWork;

/* A variant keeps the review's view, wherever its symbol is; a mirrored one mirrors it. */
static bool aim(const FrameWork *work, const Setup *setup, FrameAsk *ask, Arena scratch,
                Error *err)
{
    const CaseView *view = work->of->of->view;
    double          ahead[3];
    Vec3            from;
    if (!work->exposure)
        return find_middle(setup, work->of->of->symbol, scratch, &ask->look_at, err);
    if (!setup_eye_middle(setup, ask->eye, scratch, &from, err)) return false;
    ahead[0] = (double)view->forward.x;
    ahead[1] = (double)view->forward.y;
    ahead[2] = (double)view->forward.z;
    review_mirror_direction(ask->eye->mirror, ahead);
    ask->look_at = vec3_add(from, vec3_from_doubles(ahead));
    return true;
}

static bool make_lit(const FrameWork *work, Setup *setup, FrameAsk *ask, Arena *scratch,
                     const char **made, Error *err)
{
    const Candidate       *of = work->of;
    const ReviewCondition *c = setup->condition;
    Environment sky;
    if (of->table) sky = sweep_environment(setup, &of->table->worst_sun);
    else if (c->has_environment) sky = c->environment;
    return setup_light(setup, of->table || c->has_environment ? &sky : NULL, scratch, err) &&
           aim(work, setup, ask, *scratch, err) &&
           frame_make(ask, scratch, made, err);
}

/* *made: the picture's name, in the arena. of: gets what the frame shows; NULL: not
 * requested. */
static bool make_frame(const FrameWork *work, ReviewCase *of, Arena *arena, const char **made,
                       Error *err)
{
    const ReviewRun       *run = work->run;
    const ReviewCondition *c = review_condition_named(run->request, work->of->of->condition);
    SetupOptions options = {run->request, c, run->means};
    Problems     so_far = problems_start(arena);
    Arena scratch = arena_reserve(SETUP_BYTES);
    Setup setup;
    options.means.inherited = NULL;
    bool  ok = setup_open(&options, &scratch, &so_far, &setup, err);
    if (ok) {
        FrameAsk ask = {&setup, review_eye_named(run->request, work->of->of->eye),
                        vec3(0, 0, 0), run->folder, run->unfinished, work->name,
                        work->exposure, run->work};
        ok = make_lit(work, &setup, &ask, &scratch, made, err);
        if (ok) *made = arena_string(arena, *made, strlen(*made));
        ok = ok && (!of || add_sights(&ask, of, arena, err));
        setup_close(&setup);
    }
    arena_release(&scratch);
    return ok;
}

static bool make_worst(const ReviewRun *run, const Candidate *of, int number, Arena *arena,
                       Error *err)
{
    FrameWork work = {run, of, NULL, NULL};
    work.name = words_file_name(arena_format(arena, "%d-%s-%s", number, of->of->condition,
                                          of->of->eye), arena);
    return make_frame(&work, of->of, arena, &of->of->frame, err);
}

/* ---- of variants ------------------------------------------------------------------------- */

/* "1-noon-driver" of "frames/1-noon-driver.png". */
static const char *name_of(const char *frame, Arena *arena)
{
    const char *name = path_name(frame);
    return arena_string(arena, name, (size_t)(path_ending(name) - name));
}

/* The same view with the change made, beside that of the review. */
static bool make_pair(const FrameWork *before, int number, ReviewVariantFound *variant,
                      Arena *arena, Error *err)
{
    const char   *name = before->name;
    ReviewRequest request = review_request_variant(
        before->run->request, &before->run->request->variants[number], arena);
    ReviewRun own = *before->run;
    FrameWork work = *before;
    own.request = &request;
    work.run = &own;
    work.name = arena_format(arena, "%s-variant-%d-%s", name, number + 1,
                             words_file_name(variant->name, arena));
    if (!make_frame(&work, NULL, arena, &variant->frame, err))
        return !err->code ? false
                               : error_prefix(err, "variant '%.100s'", variant->name);
    variant->frame_before = work.of->of->frame;
    variant->seen = work.of->of;
    return true;
}

static bool make_pairs(const ReviewRun *run, const Candidate *of, Review *review, Arena *arena,
                       Error *err)
{
    FrameWork work = {run, of, name_of(of->of->frame, arena), NULL};
    Arena     scratch = arena_reserve(SETUP_BYTES);
    bool      ok = !review->variant_count ||
              frame_exposure(arena_format(&scratch, "%s/frames/%s.exr", run->folder, work.name),
                             &scratch, &work.exposure, err);
    for (int i = 0; i < review->variant_count && ok; i++)
        ok = review_goes_on(run->means.journal, err) &&
             make_pair(&work, i, &review->variants[i], arena, err);
    arena_release(&scratch);
    return ok;
}

/* ---- all of them ------------------------------------------------------------------------- */

bool review_frames(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena, Error *err)
{
    int        count, made = 0;
    Candidate *list = candidates(outcome, &count, arena);
    for (int i = 0; i < count; i++) {
        int same = 0;
        while (same < i && !(list[same].of->frame && is_one_view(&list[same], &list[i])))
            same++;
        if (same < i) {
            list[i].of->frame = list[same].of->frame;
            list[i].of->view = list[same].of->view;
        } else if (made < run->request->frames.worst &&
                 (!review_goes_on(run->means.journal, err) ||
                  !make_worst(run, &list[i], ++made, arena, err)))
            return false;
    }
    return !made || make_pairs(run, &list[0], &outcome->review, arena, err);
}
