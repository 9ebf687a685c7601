/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/look_options.h"

/* Before anything is filtered. */
static bool check_denoise(const DevelopOptions *look, Error *err)
{
    if (look->is_denoised && look->false_colour)
        return error_set(err, ERROR_USAGE, "--denoise and --false-colour exclude each other: "
                         "colours that stand for figures show the frame as it is");
    if (look->is_denoised && look->layer)
        return error_set(err, ERROR_USAGE, "--denoise and --layer exclude each other: the "
                         "frame is filtered, its layers are not");
    return true;
}

static bool check_eye(const DevelopOptions *look, Error *err)
{
    return !look->layer ||
           error_set(err, ERROR_USAGE, "--eye and --layer exclude each other: the frame's own "
                     "light is spread, its layers are not");
}

bool look_options_develop(const LookRequest *request, Arena scratch, LookReport *report,
                          Error *err)
{
    DevelopOptions look = *request->look;
    FrameImage     filtered = *request->frame;
    LookReport     made = {0};
    bool           has_eye = request->eye && request->eye->words;
    if (!check_denoise(&look, err) || (has_eye && !check_eye(&look, err))) return false;
    if (look.is_denoised && !denoise_frame(request->frame, request->threads, &scratch,
                                           &filtered, &made.denoise, err))
        return error_in_file(err, look.frame_name);
    if (has_eye) {
        if (!eye_option_apply(request->eye, &filtered, request->threads, &scratch, &filtered,
                              err))
            return error_in_file(err, look.frame_name);
        look.eye = eye_option_words(request->eye, &scratch);
        made.eye = request->eye->eye;
    }
    if (!develop_frame(&filtered, &look, request->path, scratch, &made.develop, err))
        return false;
    *report = made;
    return true;
}

const char *look_options_words(const LookReport *report, Arena *arena)
{
    const DenoiseReport *denoise = &report->denoise;
    const char          *words = "";
    if (report->develop.is_denoised)
        words = arena_format(arena, ", denoised (%.4g of the light, %ld fireflies spread%s)",
                             denoise->energy_ratio, denoise->fireflies,
                             denoise->has_halves ? "" : "; better from 24 samples on");
    if (report->develop.is_adapted) words = arena_format(arena, "%s, locally adapted", words);
    return report->develop.eye[0] ? arena_format(arena, "%s, %s", words, report->develop.eye)
                                  : words;
}

void look_options_json(const LookReport *report, json_t *answer)
{
    const DenoiseReport *denoise = &report->denoise;
    json_object_set_new(answer, "denoised",
                        report->develop.is_denoised
                            ? json_pack("{s:b, s:I, s:f}", "halves", denoise->has_halves,
                                        "fireflies", (json_int_t)denoise->fireflies,
                                        "energy_ratio", denoise->energy_ratio)
                            : json_null());
    json_object_set_new(answer, "adapt",
                        report->develop.is_adapted ? json_string("local") : json_null());
    json_object_set_new(answer, "eye",
                        report->develop.eye[0]
                            ? json_pack("{s:f, s:f}", "age_years", report->eye.age_years,
                                        "pigment", report->eye.pigment)
                            : json_null());
}
