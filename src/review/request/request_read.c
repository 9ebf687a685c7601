/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_read.h"

#include <math.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/units.h"
#include "record/rows.h"
#include "review/request/request_format.h"
#include "vision/visibility.h"

#define CLEAR_USUAL 0.05 /* precision of readings whose verdict is clear */
#define UPRIGHT 1e-6     /* horizontal length of a unit vector: less is vertical */

/* ---- the observer ------------------------------------------------------------------------ */

#define OWNER HumanEye

static const RecordRow OBSERVER[] = {
    NUMBER("age_years", 0, age_years, 10, 100, NULL),
    NUMBER("pigment", 0, pigment, 0, 1.2, "Of the iris: 0 black, 0.5 brown, 1.2 very light."),
    {0}};

static const RecordFormat observer_format = {"observer", sizeof(OWNER), OBSERVER, .doc = NULL};
#undef OWNER
#define OWNER ReviewVisibility

static const RecordRow VISIBILITY[] = {
    FIGURES("ages", 0, ages, age_count, 0, REVIEW_AGES_MOST, VISIBILITY_AGE_MIN, VISIBILITY_AGE_MAX,
            "Years; besides the observer's own age."),
    NUMBER("glance_s", 0, glance_s, 0.01, 100,
           "How long the symbol is looked at; 2 and more: as long as it takes."),
    {0}};

static const RecordFormat visibility_format = {"visibility", sizeof(OWNER), VISIBILITY,
                                               .doc = NULL};

#undef OWNER

/* ---- what must not be read --------------------------------------------------------------- */

#define OWNER ReviewPrivacy

static const RecordRow PRIVACY[] = {NUMBER("security_min_s", MUST | RECORD_ABOVE, security_min, 0,
                                           10,
                                           "The least visual security S of what must not be read."),
                                    {0}};

static const RecordFormat privacy_format = {
    "privacy", sizeof(OWNER), PRIVACY,
    .doc = "In place of the profile's limits of visual security; where neither has one, an S "
           "of 1 is assumed."};
#undef OWNER

/* ---- how well it is read ----------------------------------------------------------------- */

#define OWNER ReviewRequest

static const RecordRow PRECISION[] = {
    NUMBER("contrast", 0, precision_contrast, 1e-6, 1,
           "Relative standard error: readings end there, whatever the verdict."),
    NUMBER("clear", 0, precision_clear, 1e-6, 1,
           "Where the verdict is clear before: of contrast and reflected light. At least "
           "contrast, which is the default where it is more."),
    WHOLE("paths", 0, precision_paths, 8192, 1 << 30,
          "Of one reading at most: what is not sure then has a wider interval."),
    WHOLE("seed", 0, seed, 0, INT32_MAX,
          "Of the random numbers: another one shows what of a figure is luck."),
    {0}};

static bool check_precision(const JsonView *view, void *item, Error *err) {
    ReviewRequest *r = item;
    if (!record_has(view, "clear"))
        r->precision_clear = fmax(r->precision_clear, r->precision_contrast);
    return r->precision_clear >= r->precision_contrast ||
           record_fails(view, "clear", err, "is %g, required: at least 'contrast', %g",
                        r->precision_clear, r->precision_contrast);
}

static const RecordFormat precision_format = {"precision", sizeof(OWNER), PRECISION,
                                              .check = check_precision};

#undef OWNER
#define OWNER ReviewFrames

static const RecordRow FRAMES[] = {
    WHOLES("size", 0, width, 2, 1, 16384, "Pixels."),
    NUMBER("noise", 0, noise, 1e-4, 1,
           "Relative error; 1: that of 4 samples about what is judged, of 1 elsewhere."),
    WHOLE("worst", 0, worst, 0, 1000, "How many of the worst cases are rendered."),
    FLAG("denoise", 0, is_denoised,
         "Whether they are shown without most of their noise: pictures alone, never figures. "
         "Default: true."),
    FLAG("variants", 0, has_variants,
         "Whether the worst is rendered with each variant, too. Default: true."),
    {0}};
_Static_assert(offsetof(OWNER, height) == offsetof(OWNER, width) + sizeof(int), "a pair");

static const RecordFormat frames_format = {"frames", sizeof(OWNER), FRAMES, .doc = NULL};
#undef OWNER

/* ---- the report -------------------------------------------------------------------------- */

#define OWNER ReviewDocument

static const RecordRow DOCUMENT[] = {TEXT("number", 0, number, "The document's."),
                                     TEXT("revision", 0, revision, NULL),
                                     TEXT("date", 0, date, "As it is to be printed."),
                                     TEXT("author", 0, author, NULL),
                                     {0}};

static const RecordFormat document_format = {"document", sizeof(OWNER), DOCUMENT, .doc = NULL};
#undef OWNER

/* ---- all of it --------------------------------------------------------------------------- */

#define OWNER ReviewRequest

/* A name, or a path as seen from the request's folder. */
static bool read_profile(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    ReviewRequest *request = item;
    const RecordRow text = {row->key, RECORD_TEXT, row->flags, RECORD_AT(OWNER, profile)};
    if (!record_read_value(view, &text, item, err)) return false;
    if (strchr(request->profile, '/') || !strcmp(path_ending(request->profile), ".json"))
        request->profile = path_beside(view->file, request->profile, view->arena);
    return true;
}

/* In the order in which they need each other: names before who uses them. */
static const RecordRow REVIEW[] = {
    TEXT("title", 0, title, "Default: the file's name."),
    OBJECT("document", 0, document, document_format,
           "What the report's head says besides, on the page and on paper."),
    FILES("scene", MUST, scenes, scene_count, 256, "The first holds the displays."),
    {"profile", RECORD_TEXT, MUST | RECORD_FILLED, RECORD_AT(OWNER, profile), .read = read_profile,
     .doc = "A list of limits: NAME of assets/profiles/NAME.json, or the path of a file, which "
            "holds a '/' or ends in .json."},
    MAP("eyes", MUST, eyes, eye_count, 256, review_eye_format, "Who looks, by name."),
    VECTOR("forward", RECORD_UNIT, forward, 3, -1e6, 1e6,
           "Where the vehicle points to; not vertical."),
    OBJECT("observer", 0, observer, observer_format, NULL),
    PART("visibility", visibility, visibility.is_asked, visibility_format,
         "How far symbols stand above what people of these ages just see: visibility levels."),
    LIST("gaze", 0, gazes, gaze_count, 1, 256, review_gaze_format, "Default: at the symbols."),
    MAP("with", 0, withs, with_count, 100, review_with_format,
        "More of the scene by name: occupants."),
    MAP("symbols", MUST, symbols, symbol_count, 1000, review_symbol_format,
        "What is to be read, by name."),
    NUMBER("max_level", 0, max_level, 1, 100,
           "How far panels can be driven, in times of what was measured: levels above 1 have "
           "to say so."),
    MAP("levels", 0, levels, level_count, 1000, review_level_format,
        "How bright displays are set, 1 as measured: by display (* all others), or all by a "
        "sensor. None above max_level."),
    {"privacy", RECORD_OBJECT, RECORD_AT(OWNER, privacy), .of = &privacy_format,
     .count = offsetof(OWNER, privacy.is_given)},
    {"precision", RECORD_OBJECT, .of = &precision_format},
    OBJECT("frames", 0, frames, frames_format, NULL),
    OBJECT("pane_images", RECORD_APART, pane_images, review_panes_format,
           "Displays as glass shows them to each eye, in moments: where, how bright."),
    LIST("conditions", MUST, conditions, condition_count, 1, 10000, review_condition_format, NULL),
    MAP("variants", 0, variants, variant_count, 100, review_variant_format,
        "The same review with something changed, by name: each is held against the review "
        "itself."),
    {0}};

static void start_review(void *item) {
    *(ReviewRequest *)item = (ReviewRequest){.title = "",
                                             .forward = {0, 0, -1},
                                             .observer = {50, 0.5},
                                             .visibility = {.glance_s = VISIBILITY_GLANCE_LONG},
                                             .max_level = 1,
                                             .precision_contrast = 0.01,
                                             .precision_clear = CLEAR_USUAL,
                                             .precision_paths = 262144,
                                             .frames = {960, 540, 0.1, 2, true, true}};
}

/* Ahead on the horizontal, its front down by the tilt; across; upright on both. */
static void turn_ellipse(const double forward[3], ReviewEye *eye) {
    double level = hypot_d(forward[0], forward[2]);
    double ahead[3] = {forward[0] / level, 0, forward[2] / level};
    double across[3] = {-ahead[2], 0, ahead[0]};
    double tilt = radians_from_degrees(eye->tilt_deg), c = cos_d(tilt), s = sin_d(tilt);
    for (int k = 0; k < 3; k++) {
        double up = k == 1;
        eye->half_axes_m[0][k] = 0.5 * eye->axes_m[0] * (c * ahead[k] - s * up);
        eye->half_axes_m[1][k] = 0.5 * eye->axes_m[1] * across[k];
        eye->half_axes_m[2][k] = 0.5 * eye->axes_m[2] * (s * ahead[k] + c * up);
    }
}

static void turn_ellipses(ReviewRequest *request) {
    for (int i = 0; i < request->eye_count; i++)
        if (request->eyes[i].kind == EYE_ELLIPSE) turn_ellipse(request->forward, &request->eyes[i]);
}

/* Where no gaze is given: at the symbols. One that names no eyes is of all. */
static void look(ReviewRequest *request, Arena *arena) {
    if (!request->gaze_count) {
        request->gazes = ARENA_NEW(arena, ReviewGaze, 1);
        request->gaze_count = 1;
        request->gazes[0] = (ReviewGaze){.name = "symbols", .at_symbols = true};
    }
    for (int g = 0; g < request->gaze_count; g++) {
        ReviewGaze *gaze = &request->gazes[g];
        if (gaze->for_eye) continue;
        gaze->for_eye = ARENA_NEW(arena, bool, request->eye_count);
        for (int i = 0; i < request->eye_count; i++) gaze->for_eye[i] = true;
    }
}

/* A road of which nothing would be evaluated is no road. */
static bool check_road(const JsonView *view, const ReviewRequest *request, const ReviewGaze *gaze,
                       Error *err) {
    const ReviewRoad *road = gaze->road;
    bool is_any = false;
    for (int i = 0; i < road->condition_count; i++) {
        if (!review_condition_named(request, road->conditions[i]))
            return record_fails(view, "gaze", err,
                                "'%.60s' has a road in '%.60s', which is none; required: the "
                                "name of a condition",
                                gaze->name, road->conditions[i]);
        is_any = true;
    }
    for (int i = 0; i < request->condition_count; i++)
        is_any |= request->conditions[i].kind == CONDITION_MOMENT;
    return is_any || record_fails(view, "gaze", err,
                                  "'%.60s' has a road, which is evaluated in moments, and "
                                  "there is none; required: one, or the names of sweeps in "
                                  "its 'conditions'",
                                  gaze->name);
}

static bool check_roads(const JsonView *view, const ReviewRequest *request, Error *err) {
    for (int i = 0; i < request->gaze_count; i++)
        if (request->gazes[i].road && !check_road(view, request, &request->gazes[i], err))
            return false;
    return true;
}

static bool check_review(const JsonView *view, void *item, Error *err) {
    ReviewRequest *request = item;
    if (!(hypot_d(request->forward[0], request->forward[2]) > UPRIGHT))
        return record_fails(view, "forward", err,
                            "is vertical, required: where the vehicle points");
    turn_ellipses(request);
    look(request, view->arena);
    request->is_compared = review_is_compared(request);
    return check_roads(view, request, err);
}

const RecordFormat review_format = {
    "review",
    sizeof(OWNER),
    REVIEW,
    .start = start_review,
    .check = check_review,
    .doc = "Files are relative to this one. Every name that is used (levels, with, eyes, "
           "symbols) is defined in it; displays and cameras are the scene's."};

/* ---- a file ------------------------------------------------------------------------------ */

bool review_request_read(const char *file, const char *root, Arena *arena, Problems *problems,
                         ReviewRequest *out, Error *err) {
    JsonView view;
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
