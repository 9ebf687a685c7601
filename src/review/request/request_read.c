/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_read.h"

#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/mathd.h"
#include "review/request/request_format.h"

#define MUST RECORD_REQUIRED
#define INPUT_BYTES_MAX ((size_t)1 << 30)
#define CLEAR_USUAL 0.05 /* precision of readings whose verdict is clear */
#define UPRIGHT 1e-6     /* horizontal length of a unit vector: less is vertical */

/* ---- the observer ------------------------------------------------------------------------ */

static const RecordRow OBSERVER[] = {
    RECORD_NUMBER_ROW("age_years", HumanEye, age_years, 10, 100, NULL),
    RECORD_NUMBER_ROW("pigment", HumanEye, pigment, 0, 1.2,
                      "Of the iris: 0 black, 0.5 brown, 1.2 very light."),
    {0}};

static const RecordFormat observer_format = {"observer", sizeof(HumanEye), OBSERVER,
                                             .doc = NULL};

static const RecordRow GLARE[] = {
    RECORD_NUMBER_ROW("threshold_cd_m2", GlareSettings, threshold_cd_m2, 1e-3, 1e9,
                      "What is brighter is a source. Not beside task_factor."),
    RECORD_NUMBER_ROW("task_factor", GlareSettings, task_factor, 1, 1e6,
                      "The threshold is this times the task's mean luminance."),
    RECORD_NUMBER_ROW("task_deg", GlareSettings, task_deg, 1, 180,
                      "Full width of the cone about the line of sight that is the task."),
    RECORD_NUMBER_ROW("peak_cd_m2", GlareSettings, peak_cd_m2, 1, 1e12,
                      "What is brighter is a source apart from what surrounds it."),
    {"low_light_factor", RECORD_FLAG, RECORD_AT(GlareSettings, low_light),
     .doc = "DGP is multiplied by its factor below 1000 lx."},
    {"small_source_rule", RECORD_FLAG, RECORD_AT(GlareSettings, small_sources),
     .doc = "UGR counts sources below 0.005 m2 by CIE 147's rule."},
    {0}};

/* A fixed threshold or a task's: not both. */
static bool check_glare(const JsonView *view, void *item, Error *err)
{
    (void)item;
    return !json_object_get(view->object, "threshold_cd_m2") ||
           !json_object_get(view->object, "task_factor") ||
           record_fails(view, "threshold_cd_m2", err,
                        "stands beside 'task_factor', required: one of the two");
}

static const RecordFormat glare_format = {
    "glare", sizeof(GlareSettings), GLARE, .check = check_glare,
    .rules = "{\"not\": {\"required\": [\"threshold_cd_m2\", \"task_factor\"]}}"};

/* ---- how well it is read ----------------------------------------------------------------- */

#define OWNER ReviewRequest

static const RecordRow PRECISION[] = {
    RECORD_NUMBER_ROW("contrast", OWNER, precision_contrast, 1e-6, 1,
                      "Relative standard error: readings end there, whatever the verdict."),
    RECORD_NUMBER_ROW("clear", OWNER, precision_clear, 1e-6, 1,
                      "Where the verdict is clear before: of contrast and reflected light. At "
                      "least contrast, which is the default where it is more."),
    {"paths", RECORD_INTEGER, RECORD_AT(OWNER, precision_paths), RECORD_RANGE(8192, 1 << 30),
     .doc = "Of one reading at most: what is not sure then has a wider interval."},
    {"seed", RECORD_INTEGER, RECORD_AT(OWNER, seed), RECORD_RANGE(0, INT32_MAX),
     .doc = "Of the random numbers: another one shows what of a figure is luck."},
    {0}};

static bool check_precision(const JsonView *view, void *item, Error *err)
{
    ReviewRequest *r = item;
    if (!json_object_get(view->object, "clear"))
        r->precision_clear = fmax(r->precision_clear, r->precision_contrast);
    return r->precision_clear >= r->precision_contrast ||
           record_fails(view, "clear", err, "is %g, required: at least 'contrast', %g",
                        r->precision_clear, r->precision_contrast);
}

static const RecordFormat precision_format = {"precision", sizeof(OWNER), PRECISION,
                                              .check = check_precision};

static const RecordRow FRAMES[] = {
    {"size", RECORD_WHOLES, RECORD_AT(ReviewFrames, width), RECORD_RANGE(1, 16384),
     RECORD_COUNT(2, 2), .doc = "Pixels."},
    RECORD_NUMBER_ROW("noise", ReviewFrames, noise, 1e-4, 1, "Relative error."),
    {"worst", RECORD_INTEGER, RECORD_AT(ReviewFrames, worst), RECORD_RANGE(0, 1000),
     .doc = "How many of the worst cases are rendered."},
    {0}};
_Static_assert(offsetof(ReviewFrames, height) == offsetof(ReviewFrames, width) + sizeof(int),
               "a pair");

static const RecordFormat frames_format = {"frames", sizeof(ReviewFrames), FRAMES,
                                           .doc = NULL};

/* ---- all of it --------------------------------------------------------------------------- */

/* In the order in which they need each other: names before who uses them. */
static const RecordRow REVIEW[] = {
    RECORD_TEXT_ROW("title", OWNER, title, "Default: the file's name."),
    {"scene", RECORD_LIST, MUST, RECORD_MANY(OWNER, scenes, scene_count), RECORD_COUNT(1, 256),
     .of = &record_files, .doc = "The first holds the displays."},
    {"profile", RECORD_TEXT, MUST | RECORD_FILLED, RECORD_AT(OWNER, profile),
     .doc = "A list of limits: NAME of assets/profiles/NAME.json."},
    {"eyes", RECORD_MAP, MUST, RECORD_MANY(OWNER, eyes, eye_count), RECORD_COUNT(1, 256),
     .of = &review_eye_format, .doc = "Who looks, by name."},
    {"forward", RECORD_NUMBERS, RECORD_UNIT, RECORD_AT(OWNER, forward), RECORD_RANGE(-1e6, 1e6),
     RECORD_COUNT(3, 3), .doc = "Where the vehicle points to; not vertical."},
    {"observer", RECORD_OBJECT, RECORD_AT(OWNER, observer), .of = &observer_format},
    {"gaze", RECORD_LIST, RECORD_MANY(OWNER, gazes, gaze_count), RECORD_COUNT(1, 256),
     .of = &review_gaze_format, .doc = "Default: at the symbols."},
    {"with", RECORD_MAP, RECORD_MANY(OWNER, withs, with_count), RECORD_COUNT(1, 100),
     .of = &review_with_format, .doc = "More of the scene by name: occupants."},
    {"symbols", RECORD_MAP, MUST, RECORD_MANY(OWNER, symbols, symbol_count),
     RECORD_COUNT(1, 1000), .of = &review_symbol_format, .doc = "What is to be read, by name."},
    RECORD_NUMBER_ROW("max_level", OWNER, max_level, 1, 100,
                      "How far panels can be driven, in times of what was measured: levels "
                      "above 1 have to say so."),
    {"levels", RECORD_MAP, RECORD_MANY(OWNER, levels, level_count), RECORD_COUNT(1, 1000),
     .of = &review_level_format,
     .doc = "How bright displays are set, 1 as measured: by display (* all others), or all by "
            "a sensor. None above max_level."},
    {"precision", RECORD_OBJECT, .of = &precision_format},
    {"glare", RECORD_OBJECT, RECORD_AT(OWNER, glare), .of = &glare_format,
     .doc = "How discomfort is read: UGR, DGP, DGI."},
    {"frames", RECORD_OBJECT, RECORD_AT(OWNER, frames), .of = &frames_format},
    {"conditions", RECORD_LIST, MUST, RECORD_MANY(OWNER, conditions, condition_count),
     RECORD_COUNT(1, 10000), .of = &review_condition_format},
    {"variants", RECORD_MAP, RECORD_MANY(OWNER, variants, variant_count), RECORD_COUNT(1, 100),
     .of = &review_variant_format,
     .doc = "The same review with something changed, by name: each is held against the review "
            "itself."},
    {"sensitivity", RECORD_MAP, RECORD_MANY(OWNER, parameters, parameter_count),
     RECORD_COUNT(1, 100), .of = &review_parameter_format,
     .doc = "Numbers that may be turned, by name: how margins hang on them; --mend NAME seeks "
            "the smallest change that makes everything pass."},
    {0}};

static void start_review(void *item)
{
    *(ReviewRequest *)item = (ReviewRequest){
        .title = "", .forward = {0, 0, -1}, .observer = {50, 0.5},
        .glare = GLARE_SETTINGS_DEFAULT, .max_level = 1, .precision_contrast = 0.01,
        .precision_clear = CLEAR_USUAL, .precision_paths = 262144,
        .frames = {960, 540, 0.1, 2}};
}

static bool check_review(const JsonView *view, void *item, Error *err)
{
    ReviewRequest *request = item;
    if (!(hypot_d(request->forward[0], request->forward[2]) > UPRIGHT))
        return record_fails(view, "forward", err,
                            "is vertical, required: where the vehicle points");
    request_turn_ellipses(request);
    if (!request->gaze_count) request_look_at_symbols(request, view->arena);
    request->is_compared = review_is_compared(request);
    return true;
}

const RecordFormat review_format = {
    "review", sizeof(OWNER), REVIEW, .start = start_review, .check = check_review,
    .doc = "Files are relative to this one. Every name that is used (levels, with, eyes, "
           "symbols) is defined in it; displays and cameras are the scene's."};

const RecordNames review_eye_names = {"eyes", "eye", offsetof(OWNER, eyes),
                                      offsetof(OWNER, eye_count), sizeof(ReviewEye)};
const RecordNames review_symbol_names = {"symbols", "symbol", offsetof(OWNER, symbols),
                                         offsetof(OWNER, symbol_count), sizeof(ReviewSymbol)};
const RecordNames review_level_names = {"levels", "level", offsetof(OWNER, levels),
                                        offsetof(OWNER, level_count), sizeof(ReviewLevel)};
const RecordNames review_with_names = {"with", "with", offsetof(OWNER, withs),
                                       offsetof(OWNER, with_count), sizeof(ReviewWith)};

/* ---- files that are read ----------------------------------------------------------------- */

void request_note_input(const JsonView *view, const char *path, uint64_t hash)
{
    ReviewRequest *request = view->whole;
    int            count = request->input_count;
    for (int i = 0; i < count; i++)
        if (!strcmp(request->inputs[i].path, path)) return;
    if (!(count & (count - 1))) /* full: it doubles */
        request->inputs = ARENA_GROW(view->arena, ReviewInput, request->inputs, count,
                                     count ? 2 * count : 1);
    const char *kept = arena_string(view->arena, path, strlen(path));
    request->inputs[request->input_count++] = (ReviewInput){kept, hash};
}

bool request_note_file(const JsonView *view, const char *path, Error *err)
{
    FileBytes bytes;
    Arena     scratch = *view->arena;
    if (!file_read(path, INPUT_BYTES_MAX, &scratch, &bytes, err)) return false;
    request_note_input(view, path, XXH3_64bits(bytes.data, bytes.size));
    return true;
}

bool review_request_read(const char *file, const char *root, Arena *arena, Problems *problems,
                         ReviewRequest *out, Error *err)
{
    JsonView      view;
    ReviewRequest request;
    if (!json_view_open(file, arena, &view, err)) return false;
    start_review(&request);
    request.file = view.file;
    request.title = path_name(view.file);
    view.root = root;
    view.problems = problems;
    view.whole = &request;
    request_note_input(&view, view.file, view.hash);
    bool ok = record_read(&view, &review_format, &request, err);
    json_view_close(&view);
    if (ok) *out = request;
    return ok;
}
