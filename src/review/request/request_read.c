/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_read.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "review/request/request_conditions.h"
#include "review/request/request_eyes.h"
#include "review/request/request_levels.h"
#include "review/request/request_parameters.h"
#include "review/request/request_variants.h"
#include "tinygltf/gltf_json.h"

#define PATHS_USUAL 262144
#define CLEAR_USUAL 0.05 /* precision of readings whose verdict is clear */

static const char *const KEYS[] = {"title",  "scene",     "eyes",       "forward",
                                   "gaze",   "observer",  "with",       "symbols",
                                   "levels", "profile",   "conditions", "precision",
                                   "frames", "variants",   "sensitivity", "glare", "max_level"};

static bool read_title(RequestReading *reading, Error *err)
{
    ReviewRequest *request = reading->request;
    request->title = path_name(request->file);
    return json_view_text(&reading->root, "title", &request->title, err) &&
           field_wanted(&reading->root, "scene", err) &&
           field_files(&reading->root, "scene", &request->scenes, &request->scene_count, err) &&
           field_name(&reading->root, "profile", &request->profile, err);
}

static bool read_precision(RequestReading *reading, Error *err)
{
    static const char *const keys[] = {"contrast", "clear", "paths", "seed"};
    JsonView view;
    int     *paths = &reading->request->precision_paths, seed = 0;
    double  *contrast = &reading->request->precision_contrast;
    double  *clear = &reading->request->precision_clear;
    *contrast = 0.01;
    *clear = (double)NAN;
    *paths = PATHS_USUAL;
    if (!json_view_child(&reading->root, "precision", false, &view, err) ||
        !json_view_check_keys(&view, keys, COUNT_OF(keys), err) ||
        !json_view_number(&view, "contrast", 1e-6, 1, contrast, err) ||
        !json_view_number(&view, "clear", 1e-6, 1, clear, err) ||
        !field_integer(&view, "paths", (FieldBounds){8192, 1 << 30}, paths, err) ||
        !field_integer(&view, "seed", (FieldBounds){0, INT32_MAX}, &seed, err))
        return false;
    reading->request->seed = (uint32_t)seed;
    if (isnan(*clear)) *clear = fmax(CLEAR_USUAL, *contrast);
    return *clear >= *contrast ||
           field_fails(&view, "clear", err, "is %g, required: at least 'contrast', %g", *clear,
                       *contrast);
}

/* A fixed threshold or a task's: not both. */
static bool read_glare(RequestReading *reading, Error *err)
{
    static const char *const keys[] = {"threshold_cd_m2", "task_factor", "task_deg",
                                       "peak_cd_m2", "low_light_factor", "small_source_rule"};
    JsonView       view;
    GlareSettings *glare = &reading->request->glare;
    double         fixed = (double)NAN;
    *glare = (GlareSettings)GLARE_SETTINGS_DEFAULT;
    if (!json_view_child(&reading->root, "glare", false, &view, err) ||
        !json_view_check_keys(&view, keys, COUNT_OF(keys), err) ||
        !json_view_number(&view, "threshold_cd_m2", 1e-3, 1e9, &fixed, err) ||
        !json_view_number(&view, "task_factor", 1, 1e6, &glare->task_factor, err) ||
        !json_view_number(&view, "task_deg", 1, 180, &glare->task_deg, err) ||
        !json_view_number(&view, "peak_cd_m2", 1, 1e12, &glare->peak_cd_m2, err) ||
        !field_boolean(&view, "low_light_factor", &glare->low_light, err) ||
        !field_boolean(&view, "small_source_rule", &glare->small_sources, err))
        return false;
    if (isnan(fixed)) return true;
    glare->threshold_cd_m2 = fixed;
    return !(glare->task_factor > 0) ||
           field_fails(&view, "threshold_cd_m2", err,
                       "stands beside 'task_factor', required: one of the two");
}

static bool read_size(const JsonView *view, ReviewFrames *frames, Error *err)
{
    double size[2] = {frames->width, frames->height};
    if (!field_numbers(view, "size", (JsonRange){1, 16384, 2}, size, NULL, err))
        return false;
    frames->width = (int)size[0];
    frames->height = (int)size[1];
    return (frames->width == size[0] && frames->height == size[1]) ||
           field_fails(view, "size", err, "is [%g, %g], required: whole numbers of pixels",
                       size[0], size[1]);
}

static bool read_frames(RequestReading *reading, Error *err)
{
    static const char *const keys[] = {"size", "noise", "worst"};
    JsonView      view;
    ReviewFrames *frames = &reading->request->frames;
    *frames = (ReviewFrames){960, 540, 0.1, 2};
    return json_view_child(&reading->root, "frames", false, &view, err) &&
           json_view_check_keys(&view, keys, COUNT_OF(keys), err) &&
           read_size(&view, frames, err) &&
           json_view_number(&view, "noise", 1e-4, 1, &frames->noise, err) &&
           field_integer(&view, "worst", (FieldBounds){0, 1000}, &frames->worst, err);
}

/* The document once more, as scenes have theirs: environments are read as there. */
static bool read_tree(RequestReading *reading, Error *err)
{
    FileBytes   bytes;
    const char *file = reading->request->file;
    if (!file_read(file, JSON_FILE_BYTES_MAX, reading->root.arena, &bytes, err)) return false;
    return gltf_json_parse((const char *)bytes.data, bytes.size, reading->root.arena,
                           &reading->tree, err) ||
           error_in_file(err, file);
}

static bool read_all(RequestReading *reading, Error *err)
{
    return json_view_check_keys(&reading->root, KEYS, COUNT_OF(KEYS), err) &&
           read_tree(reading, err) && read_title(reading, err) &&
           request_eyes_read(reading, err) && request_withs_read(reading, err) &&
           request_symbols_read(reading, err) && request_levels_read(reading, err) &&
           read_precision(reading, err) && read_glare(reading, err) &&
           read_frames(reading, err) &&
           request_conditions_read(reading, err) && request_variants_read(reading, err) &&
           request_parameters_read(reading, err);
}

bool review_request_read(const char *file, const char *root, Arena *arena, Problems *problems,
                         ReviewRequest *out, Error *err)
{
    ReviewRequest  request = {.file = arena_string(arena, file, strlen(file))};
    RequestReading reading = {.problems = problems, .request = &request};
    if (!json_view_open(file, arena, &reading.root, err)) return false;
    reading.root.root = root;
    request_note_input(&reading, file, reading.root.hash);
    bool ok = read_all(&reading, err);
    request.is_compared = review_is_compared(&request);
    json_view_close(&reading.root);
    if (ok) *out = request;
    return ok;
}
