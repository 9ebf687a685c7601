/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/frames.h"

#include <string.h>

#include "base/file.h"
#include "base/file_write.h"
#include "base/mathf.h"
#include "base/parallel.h"
#include "base/units.h"
#include "camera/camera.h"
#include "denoise/denoise.h"
#include "film/film_frame.h"
#include "image/develop.h"
#include "render/identity.h"
#include "render/render.h"
#include "render/signals.h"
#include "render/train.h"
#include "review/keep/frame_kept.h"
#include "review/light/setup.h"
#include "review/request/request_check.h"
#include "review/review_decide.h"
#include "review/run/cases.h"
#include "review/run/explain.h"
#include "review/run/sweep.h"
#include "review/run/symbols.h"
#include "scene/load/material_data.h"

/* Read on from review_frames, which is the first function. The worst cases are rendered in the
 * order of the page, one frame for all that are seen in one view (candidates, make_worst); of the
 * first one each variant's frame stands beside it (make_pairs). A frame is made by make_frame:
 * the condition's setup is opened and lit, the eye aimed (aim), the frame rendered or found whole
 * (frame_make), and the case told where its symbol and rays lie in it (add_sights). A merge takes
 * the frames that its parts have made (take_frame).
 */

#define YFOV_DEG 35                   /* of an eye that is no camera */
#define WORDS 16                      /* of a frame's metadata, at most */
#define FILES_BYTES ((size_t)1 << 36) /* address space: what is not touched costs nothing */
#define RIM_STEPS 8                   /* points along a side of a symbol's rectangle */
#define SETUP_BYTES ((size_t)1 << 36) /* address space: what is not touched costs nothing */

/* A case that may be rendered: of a moment, or the worst of a sweep. */
typedef struct Candidate {
    ReviewCase *of;
    const SweepTable *table; /* NULL: a moment */
    ReviewCase made;         /* of a merge: with the frame that its part has */
} Candidate;

/* A frame to make: its eye and its light. */
typedef struct FrameWork {
    const ReviewRun *run; /* of the review, or of a variant of it */
    const Candidate *of;
    const char *name, *exposure; /* FrameArgs's */
} FrameWork;

/* What is rendered, of a setup that is lit. */
typedef struct FrameArgs {
    const Setup *setup;
    const ReviewEye *eye;
    Vec3 look_at;              /* m, scene: of an eye that is no camera */
    const SetupSymbol *symbol; /* that is judged; NULL: it is not there */
    const char *folder;
    const char *unfinished; /* folder of its checkpoint */
    const char *name;       /* without an ending */
    const char *exposure;   /* of a frame to stand beside (exposure_of): this one is
                               smaller, and its picture alone is made; NULL: by itself */
    Progress *progress;     /* of which the frame is a step */
} FrameArgs;

static Candidate *candidates(ReviewOutcome *outcome, int *count, Arena *arena);
static bool is_one_view(const Candidate *a, const Candidate *b);
static bool make_pairs(const ReviewRun *run, const Candidate *of, Review *review, Arena *arena,
                       Error *err);
static bool make_frame(const FrameWork *work, ReviewCase *of, Arena *arena, const char **made,
                       Error *err);
static bool make_worst(const ReviewRun *run, const Candidate *of, int number, Arena *arena,
                       Error *err);
static bool exposure_of(const FrameImage *frame, const char *exr, Arena *arena, const char **out,
                        Error *err);
static bool find_symbol(const Setup *setup, const char *name, Arena *arena, const SetupSymbol **out,
                        Error *err);
static bool frame_make(const FrameArgs *args, Arena *arena, const char **out, Error *err);
static bool frame_camera(const FrameArgs *args, SceneCamera *out, Arena scratch, Error *err);

/* ---- all of them ------------------------------------------------------------------------- */

bool review_frames(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena, Error *err) {
    int count, made = 0;
    Candidate *list = candidates(outcome, &count, arena);
    for (int i = 0; i < count; i++) {
        ReviewCase *c = list[i].of;
        c->frame = NULL;
        c->view = NULL;
        c->rim = NULL;
        c->rim_count = 0;
    }
    for (int i = 0; i < count; i++) {
        int same = 0;
        while (same < i && !(list[same].of->frame && is_one_view(&list[same], &list[i]))) same++;
        if (same < i) {
            list[i].of->frame = list[same].of->frame;
            list[i].of->view = list[same].of->view;
        } else if (made < run->request->frames.worst &&
                   (!review_goes_on(err) || !make_worst(run, &list[i], ++made, arena, err)))
            return false;
    }
    return !made || make_pairs(run, &list[0], &outcome->review, arena, err);
}

/* ---- which ------------------------------------------------------------------------------- */

/* `of`: null where nothing is seen. */
static Candidate candidate_of(ReviewOutcome *outcome, const ReviewCase *c) {
    Review *review = &outcome->review;
    for (int i = 0; i < review->case_count; i++)
        if (c == &review->cases[i])
            return (Candidate){case_is_seen(c) ? &review->cases[i] : NULL, NULL, *c};
    for (int i = 0; i < outcome->table_count; i++) {
        const SweepTable *table = &outcome->tables[i];
        ReviewCase *worst = &review->sweeps[table->sweep_id].worst;
        if (c == worst && table->figures.worst >= 0) return (Candidate){worst, table, *c};
    }
    return (Candidate){.of = NULL};
}

/* In the order of the page, so that its first screen has a picture. */
static Candidate *candidates(ReviewOutcome *outcome, int *count, Arena *arena) {
    int all = review_case_count(&outcome->review);
    const ReviewCase **ranked = review_rank(&outcome->review, arena);
    Candidate *list = ARENA_NEW(arena, Candidate, all);
    *count = 0;
    for (int i = 0; i < all; i++) {
        Candidate found = candidate_of(outcome, ranked[i]);
        if (found.of) list[(*count)++] = found;
    }
    return list;
}

/* Are they seen in one frame: the same eye under the same light? */
static bool is_one_view(const Candidate *a, const Candidate *b) {
    return a->table == b->table && !strcmp(a->of->eye, b->of->eye) &&
           !strcmp(a->of->condition, b->of->condition);
}

/* ---- the worst cases, rendered or of a merge ----------------------------------------------- */

/* The folder of the review that has a condition: DIR of DIR/conditions/NAME. */
static const char *part_of(const ReviewRun *run, const char *condition, Arena *arena) {
    const ReviewRequest *request = run->request;
    int id = (int)(review_condition_named(request, condition) - request->conditions);
    const char *path = run->merged[id];
    const char *folder = arena_string(arena, path, (size_t)(path_name(path) - path));
    return arena_format(arena, "%s..", folder);
}

static bool copy_file(const char *from, const char *to, Arena scratch, Error *err) {
    FileBytes bytes;
    return file_read(from, SIZE_MAX, &scratch, &bytes, err) &&
           file_write(to, bytes.data, bytes.size, err);
}

/* A frame's file and its views, under another name. */
typedef struct FrameCopy {
    const char *part;      /* folder of the review that has it */
    const char *from, *to; /* pictures, within the folders */
    int views;
} FrameCopy;

static bool take_frame(const ReviewRun *run, FrameCopy copy, Arena scratch, Error *err) {
    const char *from = arena_format(&scratch, "%s/%s", copy.part, copy.from);
    const char *to = arena_format(&scratch, "%s/%s", run->folder, copy.to);
    int from_stem = (int)(path_ending(from) - from);
    int to_stem = (int)(path_ending(to) - to);
    if (!copy_file(arena_format(&scratch, "%.*s.exr", from_stem, from),
                   arena_format(&scratch, "%.*s.exr", to_stem, to), scratch, err))
        return false;
    for (FrameView view = FRAME_PICTURE; (int)view < copy.views; view++)
        if (!copy_file(frame_view(from, view, &scratch), frame_view(to, view, &scratch), scratch,
                       err))
            return false;
    return true;
}

static bool take_worst(const ReviewRun *run, const Candidate *of, const char *name, Arena *arena,
                       Error *err) {
    ReviewCase *c = of->of;
    const ReviewCase *made = &of->made;
    const char *part = part_of(run, c->condition, arena);
    if (!made->frame)
        return error_at(err, ERROR_INPUT, part, "", "has no frame of %.200s, seen by %.100s",
                        c->symbol, c->eye);
    c->frame = arena_format(arena, "frames/%s.png", name);
    c->view = made->view;
    c->rim = made->rim;
    c->rim_count = made->rim_count;
    return take_frame(run, (FrameCopy){part, made->frame, c->frame, FRAME_VIEWS}, *arena, err);
}

static bool make_worst(const ReviewRun *run, const Candidate *of, int number, Arena *arena,
                       Error *err) {
    FrameWork work = {run, of, NULL, NULL};
    work.name = words_file_name(
        arena_format(arena, "%d-%s-%s", number, of->of->condition, of->of->eye), arena);
    return run->merged ? take_worst(run, of, work.name, arena, err)
                       : make_frame(&work, of->of, arena, &of->of->frame, err);
}

/* ---- of variants ------------------------------------------------------------------------- */

/* "1-noon-driver" of "frames/1-noon-driver.png". */
static const char *name_of(const char *frame, Arena *arena) {
    const char *name = path_name(frame);
    return arena_string(arena, name, (size_t)(path_ending(name) - name));
}

/* The same view with the change made, beside that of the review. */
static bool make_pair(const FrameWork *before, int number, ReviewVariantFound *variant,
                      Arena *arena, Error *err) {
    const char *name = before->name;
    ReviewRequest request = review_request_variant(before->run->request,
                                                   &before->run->request->variants[number], arena);
    ReviewRun own = *before->run;
    FrameWork work = *before;
    own.request = &request;
    work.run = &own;
    work.name = arena_format(arena, "%s-variant-%d-%s", name, number + 1,
                             words_file_name(variant->name, arena));
    if (own.merged) {
        FrameCopy copy = {part_of(&own, work.of->of->condition, arena),
                          arena_format(arena, "frames/%s%s.png",
                                       name_of(work.of->made.frame, arena),
                                       work.name + strlen(name)),
                          arena_format(arena, "frames/%s.png", work.name), 1};
        variant->frame = copy.to;
        if (!take_frame(&own, copy, *arena, err)) return false;
    } else if (!make_frame(&work, NULL, arena, &variant->frame, err))
        return !err->code ? false : error_prefix(err, "variant '%.100s'", variant->name);
    variant->frame_before = work.of->of->frame;
    variant->seen = work.of->of;
    return true;
}

static bool make_pairs(const ReviewRun *run, const Candidate *of, Review *review, Arena *arena,
                       Error *err) {
    FrameWork work = {run, of, name_of(of->of->frame, arena), NULL};
    if (!run->request->frames.has_variants) return true;
    Arena scratch = arena_reserve(SETUP_BYTES);
    const char *exr = arena_format(&scratch, "%s/frames/%s.exr", run->folder, work.name);
    FrameImage frame;
    bool ok = !review->variant_count || run->merged ||
              (frame_read(exr, &scratch, &frame, err) &&
               exposure_of(&frame, exr, &scratch, &work.exposure, err));
    for (int i = 0; i < review->variant_count && ok; i++)
        ok = review_goes_on(err) && make_pair(&work, i, &review->variants[i], arena, err);
    arena_release(&scratch);
    return ok;
}

/* ---- what is drawn beside it ------------------------------------------------------------- */

static CaseView view_of(const Camera *camera) {
    const Transform *t = &camera->world_from_camera;
    return (CaseView){t->origin,
                      t->x,
                      t->y,
                      vec3_neg(t->z),
                      camera->is_perspective,
                      (double)camera->half_width,
                      (double)camera->half_height,
                      camera->width,
                      camera->height};
}

/* From corner to corner; a curved display bends between them. */
static void add_rim(const SetupSymbol *symbol, ReviewCase *c, Arena *arena) {
    const double *uv = symbol->uv;
    const double corner[5][2] = {
        {uv[0], uv[1]}, {uv[2], uv[1]}, {uv[2], uv[3]}, {uv[0], uv[3]}, {uv[0], uv[1]}};
    Vec3 *rim = ARENA_NEW(arena, Vec3, 4 * RIM_STEPS);
    for (int i = 0; i < 4 * RIM_STEPS; i++) {
        const double *a = corner[i / RIM_STEPS], *b = corner[i / RIM_STEPS + 1];
        double t = (double)(i % RIM_STEPS) / RIM_STEPS;
        double at[2] = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
        SymbolPoint point;
        if (symbol_surface_at(&symbol->surface, at, &point)) rim[c->rim_count++] = point.position;
    }
    c->rim = rim;
}

/* Where its causes' rays and its symbol lie in the frame. */
static bool add_sights(const FrameArgs *args, Arena scratch, ReviewCase *c, Arena *arena,
                       Error *err) {
    const ReviewFrames *frames = &args->setup->request->frames;
    SceneCamera camera;
    if (!frame_camera(args, &camera, scratch, err)) return false;
    Camera seen = camera_from_scene(&camera, frames->width, frames->height);
    CaseView *view = ARENA_NEW(arena, CaseView, 1);
    *view = view_of(&seen);
    c->view = view;
    if (args->symbol) add_rim(args->symbol, c, arena);
    return true;
}

/* ---- one frame --------------------------------------------------------------------------- */

/* A variant keeps the review's view, wherever its symbol is; a mirrored one mirrors it. */
static bool aim(const FrameWork *work, const Setup *setup, FrameArgs *args, Arena *arena,
                Error *err) {
    const CaseView *view = work->of->of->view;
    double ahead[3];
    Vec3 from;
    if (!find_symbol(setup, work->of->of->symbol, arena, &args->symbol, err)) return false;
    if (!work->exposure) {
        if (args->symbol) args->look_at = symbol_middle(args->symbol).position;
        return true;
    }
    if (!setup_eye_middle(setup, args->eye, *arena, &from, err)) return false;
    ahead[0] = (double)view->forward.x;
    ahead[1] = (double)view->forward.y;
    ahead[2] = (double)view->forward.z;
    review_mirror_direction(args->eye->mirror, ahead);
    args->look_at = vec3_add(from, vec3_from_doubles(ahead));
    return true;
}

static bool make_lit(const FrameWork *work, Setup *setup, FrameArgs *args, Arena *scratch,
                     const char **made, Error *err) {
    const Candidate *of = work->of;
    Environment sky;
    if (of->table) sky = sweep_environment(setup, &of->table->worst_sun);
    return setup_light(setup, of->table ? &sky : NULL, scratch, err) &&
           aim(work, setup, args, scratch, err) && frame_make(args, scratch, made, err);
}

/* *made: the picture's name, in the arena. of: gets what the frame shows; NULL: not
 * requested. */
static bool make_frame(const FrameWork *work, ReviewCase *of, Arena *arena, const char **made,
                       Error *err) {
    const ReviewRun *run = work->run;
    const ReviewCondition *c = review_condition_named(run->request, work->of->of->condition);
    SetupOptions options = {run->request, c, run->means};
    Problems so_far = problems_start(arena);
    Arena scratch = arena_reserve(SETUP_BYTES);
    Setup setup;
    bool ok = setup_open(&options, &scratch, &so_far, &setup, err);
    if (ok) {
        FrameArgs args = {.setup = &setup,
                          .eye = review_eye_named(run->request, work->of->of->eye),
                          .folder = run->folder,
                          .unfinished = run->unfinished,
                          .name = work->name,
                          .exposure = work->exposure,
                          .progress = run->progress};
        ok = make_lit(work, &setup, &args, &scratch, made, err);
        if (ok) *made = arena_string(arena, *made, strlen(*made));
        ok = ok && (!of || add_sights(&args, scratch, of, arena, err));
        setup_close(&setup);
    }
    arena_release(&scratch);
    return ok;
}

/* *out: NULL: the setup has none of that name. */
static bool find_symbol(const Setup *setup, const char *name, Arena *arena, const SetupSymbol **out,
                        Error *err) {
    SetupSymbol *symbols;
    int count;
    *out = NULL;
    if (!setup_symbols(setup, arena, &symbols, &count, err)) return false;
    for (int i = 0; i < count; i++)
        if (!strcmp(symbols[i].name, name)) *out = &symbols[i];
    return true;
}

/* ---- making it --------------------------------------------------------------------------- */

/* From where the frame is seen. */
static bool frame_camera(const FrameArgs *args, SceneCamera *out, Arena scratch, Error *err) {
    const Scene *scene = args->setup->scene;
    int id;
    Vec3 from;
    if (!setup_eye_middle(args->setup, args->eye, scratch, &from, err)) return false;
    if (args->eye->kind == EYE_CAMERA) {
        if (!review_camera_find(scene, args->eye, scratch, &id, err)) return false;
        *out = scene->cameras[id];
        out->world_from_camera.origin = from;
        return true;
    }
    *out = camera_look_at(from, args->look_at, (float)radians_from_degrees(YFOV_DEG));
    return true;
}

/* What the pictures, and the page's scripts, need of a frame. */
static unsigned layers_of(const FrameArgs *args) {
    enum {
        DENOISE =
            LAYER_NORMAL | LAYER_ALBEDO | LAYER_DISPLAY_EMITTED | LAYER_DISPLAY_FINE | LAYER_EMITTED
    }; /* DENOISE_LAYERS without halves: of so few samples no texture comes back */
    unsigned layers = args->exposure ? LAYER_VARIANCE : LAYER_VARIANCE | LAYER_ID | LAYER_DISPLAYS;
    if (args->setup->request->frames.is_denoised) layers |= DENOISE;
    return render_layers(args->setup->scene, layers);
}

static RenderOptions options_of(const FrameArgs *args) {
    const ReviewRequest *request = args->setup->request;
    int by = args->exposure ? FRAMES_PAIR : 1;
    int width = request->frames.width / by, height = request->frames.height / by;
    bool is_preview = !(request->frames.noise < 1); /* no error is required */
    FilmRect all = {0, 0, width > 1 ? width : 1, height > 1 ? height : 1};
    return (RenderOptions){.width = all.x1,
                           .height = all.y1,
                           .crop = all,
                           .end_sample = is_preview ? FRAMES_PREVIEW_SAMPLES : FRAMES_SAMPLES,
                           .guided_samples = is_preview ? 1 : 0, /* what most pixels take */
                           .noise = is_preview ? 0 : request->frames.noise,
                           .max_bounces = SETUP_BOUNCES,
                           .noise_area = {all, FILM_ALL_PIXELS},
                           .layers = layers_of(args),
                           .threads = args->setup->tools.threads,
                           .stops_at_once = true,
                           .within = args->progress,
                           .within_weight = 1};
}

/* The attributes of a rendered frame, as far as they are known here. */
static void set_words(FrameImage *frame, const FrameArgs *args, const SceneCamera *camera,
                      const RenderResult *result, Arena *arena) {
    frame_set_string(frame, "software", "parhelion " PARHELION_VERSION, arena);
    frame_set_string(frame, "parhelion:unit", "cd/m2", arena);
    const char *assumed = displays_assumed(args->setup->scene, arena);
    if (assumed) frame_set_string(frame, "parhelion:assumed", assumed, arena);
    frame_set_string(frame, "parhelion:review", args->setup->request->file, arena);
    frame_set_string(frame, "parhelion:condition", args->setup->condition->name, arena);
    frame_set_string(frame, "parhelion:camera", args->eye->name, arena);
    if (camera->is_perspective)
        frame_set_number(frame, "parhelion:yfov_deg", degrees_from_radians((double)camera->yfov),
                         arena);
    frame_set_string(frame, "parhelion:samples", arena_format(arena, "0:%u", result->samples),
                     arena);
    frame_set_number(frame, "parhelion:relativeError", result->error.frame, arena);
    frame_set_whole(frame, "parhelion:complete", result->complete, arena);
    frame_set_whole(frame, "parhelion:unbiased", 1, arena);
}

const char *frame_view(const char *frame, FrameView view, Arena *arena) {
    static const char *const ENDS[] = {"", "-luminance", "-contrast"};
    int before_ending = (int)(path_ending(frame) - frame);
    return arena_format(arena, "%.*s%s.png", before_ending, frame, ENDS[view]);
}

/* *out: how a frame is exposed (image/exposure.h), for others to be compared with it. */
static bool exposure_of(const FrameImage *frame, const char *exr, Arena *arena, const char **out,
                        Error *err) {
    Picture picture;
    DevelopReport report;
    DevelopOptions look = {.own_config = true, .frame_name = exr};
    if (!develop_picture(frame, &look, arena, &picture, &report, err)) return false;
    *out = arena_format(arena, "%.9g", report.ev);
    return true;
}

/* The frame's file and its views, written beside each other. */
typedef struct FrameFiles {
    const FrameImage *frame;
    FrameImage shown; /* as a picture: the frame, or its light filtered */
    bool is_denoised;
    const char *exr, *exposure; /* NULL: the frame's own */
} FrameFiles;

/* All frames have one scale of contrast, so that they can be compared. */
static DevelopOptions look_of(FrameView view, const FrameFiles *files) {
    const char *exr = files->exr;
    const DevelopOptions looks[] = {
        [FRAME_PICTURE] = {.own_config = true,
                           .exposure = files->exposure,
                           .frame_name = exr,
                           .adapt = DEVELOP_ADAPT_NONE, /* as the page shows a moved sun */
                           .is_denoised = files->is_denoised},
        [FRAME_LUMINANCE] = {.false_colour = true, .frame_name = exr},
        [FRAME_CONTRAST] = {
            .layer = "display.contrast", .frame_name = exr, .range = {1, FRAMES_CONTRAST}}};
    return looks[view];
}

/* Metered on the frame itself, as the page does: a filtered picture is exposed as one that is
 * not. */
static bool set_shown(const FrameArgs *args, FrameFiles *files, Arena *arena, Error *err) {
    DenoiseReport unused;
    files->shown = *files->frame;
    files->exposure = args->exposure;
    files->is_denoised = args->setup->request->frames.is_denoised;
    return !files->is_denoised || ((files->exposure || exposure_of(files->frame, files->exr, arena,
                                                                   &files->exposure, err)) &&
                                   denoise_frame(files->frame, args->setup->tools.threads, arena,
                                                 &files->shown, &unused, err));
}

static bool write_file(void *context, int item, Error *err) {
    const FrameFiles *files = context;
    if (item == 0) return frame_write(files->exr, files->frame, err);
    FrameView view = (FrameView)(item - 1);
    DevelopOptions look = look_of(view, files);
    Arena own = arena_reserve(FILES_BYTES);
    bool ok = develop_frame(view == FRAME_PICTURE ? &files->shown : files->frame, &look,
                            frame_view(files->exr, view, &own), own, NULL, err);
    arena_release(&own);
    return ok;
}

/* A pair has the picture alone. */
static int views_of(const FrameArgs *args) {
    return args->exposure ? 1 : FRAME_VIEWS;
}

static const char *exr_of(const FrameArgs *args, Arena *arena) {
    return arena_format(arena, "%s/frames/%s.exr", args->folder, args->name);
}

static bool write_frame(const FrameArgs *args, const SceneCamera *camera,
                        const RenderResult *result, Arena scratch, Error *err) {
    const char *exr = exr_of(args, &scratch);
    FrameImage frame = film_to_frame(result->film, WORDS, &scratch);
    set_words(&frame, args, camera, result, &scratch);
    FrameFiles files = {.frame = &frame, .exr = exr};
    return set_shown(args, &files, &scratch, err) &&
           parallel_try(args->setup->tools.threads, 1 + views_of(args), write_file, &files, scratch,
                        err);
}

/* ---- of all that decides it -------------------------------------------------------------- */

static const char *identity_of(const FrameArgs *args, const SceneCamera *camera,
                               const RenderOptions *options, Arena *arena) {
    const Scene *scene = args->setup->scene;
    Text text = {.arena = arena};
    text_add(&text, args->setup->identity);
    text_add(&text, args->setup->files); /* pictures of skies, too */
    identity_line(&text, "name", "%s", args->name);
    identity_line(&text, "condition", "%s", args->setup->condition->name);
    identity_line(&text, "review", "%s", args->setup->request->file);
    identity_line(&text, "size", "%dx%d", options->width, options->height);
    identity_line(&text, "layers", "%u", options->layers);
    identity_line(&text, "samples", "%u", options->end_sample);
    if (args->exposure) identity_line(&text, "exposure", "%s", args->exposure);
    if (args->setup->request->frames.is_denoised) identity_line(&text, "picture", "denoised");
    identity_number(&text, "noise", options->noise);
    identity_line(&text, "eye", "%s", args->eye->name);
    for (int i = 0; i < scene->display_count; i++)
        identity_float(&text, arena_format(arena, "level %d", i), scene->displays[i].level);
    identity_add_environment(&text, scene);
    identity_add_camera(&text, camera);
    return text.data;
}

/* About the display, through whatever it is seen; all pixels where none of it can be told. */
static FilmRect pixels_about(const Scene *scene, const ReviewDisplay *display,
                             const Camera *camera) {
    const Transform *t = &camera->world_from_camera;
    float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < display->part_count; i++) {
        Vec3 box[2];
        scene_part_box(scene, &scene->parts[display->part_ids[i]], &box[0], &box[1]);
        for (int k = 0; k < 8; k++) {
            Vec3 corner = {box[k & 1].x, box[k >> 1 & 1].y, box[k >> 2].z};
            Vec3 d = vec3_sub(corner, t->origin);
            float ahead = camera->is_perspective ? -vec3_dot(d, t->z) : 1;
            if (camera->fisheye || !(ahead > 0))
                return (FilmRect){0, 0, camera->width, camera->height};
            Vec2 at = {vec3_dot(d, t->x) / (ahead * camera->half_width),
                       -vec3_dot(d, t->y) / (ahead * camera->half_height)};
            low[0] = min_f(low[0], at.x);
            low[1] = min_f(low[1], at.y);
            high[0] = max_f(high[0], at.x);
            high[1] = max_f(high[1], at.y);
        }
    }
    float x = 0.5f * (float)camera->width, y = 0.5f * (float)camera->height;
    return (FilmRect){(int)(x * clampf(1 + low[0], 0, 2)), (int)(y * clampf(1 + low[1], 0, 2)),
                      (int)ceilf(x * clampf(1 + high[0], 0, 2)),
                      (int)ceilf(y * clampf(1 + high[1], 0, 2))};
}

static bool render(const FrameArgs *args, FrameKept *kept, const SceneCamera *camera,
                   RenderOptions *options, RenderResult *result, Error *err) {
    const Setup *setup = args->setup;
    RenderSetup render = {
        .kernel = setup->tools.kernel, .bvh = setup->bvh, .context = setup->context};
    const double pixels = (double)options->width * (double)options->height;
    TrainOptions train = {setup->tools.kernel, options->threads, true,
                          pixels * options->guided_samples};
    Arena *arena = kept->arena;
    if (!frame_kept_begin(kept, options, err)) return false;
    render.camera = camera_from_scene(camera, options->width, options->height);
    FilmArea judged = {options->crop, FILM_ALL_PIXELS};
    if (args->symbol)
        judged.rect = pixels_about(setup->scene, &args->symbol->display, &render.camera);
    if (options->guided_samples) options->favoured = &judged;
    render.context.guide =
        train_guide(&setup->context, &render.camera, &train, arena, &render.training);
    if (!review_goes_on(err) || !render_prepared(&render, options, arena, result, err))
        return false;
    if (!result->stopped_by) return true;
    return signals_stopped(err);
}

/* *out: the picture's name within the folder. */
static bool frame_make(const FrameArgs *args, Arena *arena, const char **out, Error *err) {
    RenderOptions options = options_of(args);
    SceneCamera camera;
    RenderResult result;
    const char *name = arena_format(arena, "frames/%s.png", args->name);
    const char *exr = exr_of(args, arena);
    Arena scratch = *arena;
    if (!frame_camera(args, &camera, scratch, err)) return false;
    FrameKept kept = {.unfinished = args->unfinished,
                      .identity = identity_of(args, &camera, &options, &scratch),
                      .arena = &scratch};
    kept.files[kept.file_count++] = exr;
    for (FrameView view = FRAME_PICTURE; (int)view < views_of(args); view++)
        kept.files[kept.file_count++] = frame_view(exr, view, &scratch);
    if (!frame_kept_is_whole(&kept) &&
        (!render(args, &kept, &camera, &options, &result, err) ||
         !write_frame(args, &camera, &result, scratch, err) || !frame_kept_end(&kept, err)))
        return false;
    *out = name;
    return true;
}
