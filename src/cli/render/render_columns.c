/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/render_columns.h"

#include "base/count.h"
#include "cli/options/answer.h"
#include "cli/options/look_options.h"

static const Column PICTURES[] = {LOOK_COLUMNS};
static const TableKind PICTURES_KIND = TABLE_KIND("pictures", NULL, PICTURES);

#define RATE(key_, words_) \
    {.key = key_, .words = words_, .unit = "million", .places = 3, .times = 1e-6}
static const Column ANSWER[] = {
    COLUMN_TEXT("output", "frame"),
    COLUMN_TEXT("size", "pixels"),
    {.key = "samples", .words = "samples a pixel", .about = "at most"},
    COLUMN_TEXT("for.area", "all of them for"),
    {.key = "for.pixels", .words = "its pixels", .about = "that take all samples"},
    {.key = "for.samples_of_others", .words = "samples of the others", .about = "null for `noise`"},
    COLUMN_KEY("for.others", "the share of the rest, null for `noise`"),
    {.key = "for.mean_samples",
     .words = "samples, mean",
     .is_fixed = true,
     .places = 1,
     .about = "`for` is null without `--for`; a pilot's samples and rays are in no count"},
    COLUMN_TEXT("complete", "complete"),
    COLUMN_FIXED("seconds", "time", "s", 1),
    RATE("samples_per_s", "samples a second"),
    RATE("rays_per_s", "rays a second"),
    {.key = "peak_memory_bytes",
     .words = "peak memory",
     .unit = "MB",
     .is_fixed = true,
     .times = 1e-6},
    {.key = "build_peak_memory_bytes",
     .words = "while building",
     .unit = "MB",
     .is_fixed = true,
     .times = 1e-6,
     .about = "until rendering began"},
    ERROR_COLUMN("relative_error", "relative error", "unknown"),
    {.key = "noise.area", .words = "required of", .about = "`noise` is null without `--noise`"},
    ERROR_COLUMN("noise.required", "relative error, required", NULL),
    ERROR_COLUMN("noise.relative_error", "relative error there", NULL),
    {.key = "noise.rare_light",
     .words = "rare light: not yet known",
     .hides_zero = true,
     .about = "the error there is not yet known"},
    COLUMN_KEY("noise.reached", NULL),
    COLUMN_KEY("noise.error_may_be", "if the light of single samples is everywhere in the area"),
    COLUMN_KEY("noise.pilot", "what decided how many samples: `pixels` of the area, their "
                              "`relative_error`, `paths`, `seconds`"),
    RARE_COLUMN,
    {.key = "may_miss.words",
     .words = "may miss light",
     .about = "`may_miss` is null: no light that no path connects, or too little to matter"},
    COLUMN_KEY("may_miss.cd_m2", "in the mean of the picture"),
    COLUMN_KEY("may_miss.share", "of its light with it"),
    COLUMN_KEY("may_miss.lights", "below"),
    {.key = "notes", .words = "note"},
    {.key = "pictures", .of = &PICTURES_KIND},
    COLUMN_KEY("rays", NULL),
    COLUMN_KEY("rays_by_class", "`camera`, `bounce`, `shadow`"),
    COLUMN_KEY("build_seconds", NULL),
    COLUMN_KEY("nonfinite_samples", "left out"),
    COLUMN_KEY("relative_error_displays", NULL),
    COLUMN_KEY("warnings", "`file`, `path`, `severity`, `message`"),
    COLUMN_KEY("projection", "`camera`: as it is, `equidistant`, `equisolid`"),
    COLUMN_KEY("isa", NULL),
    COLUMN_KEY("training", "null with `--no-guiding`; else `field`, the hash of what was learnt, "
                           "`seconds`, `paths`"),
    COLUMN_KEY("resumed_samples", NULL),
    COLUMN_KEY("worst_pixels", "`x`, `y`, `luminance_cd_m2`, `relative_error`"),
    COLUMN_KEY("live_seconds", "what `--live` took"),
};
const TableKind render_answer_kind = TABLE_KIND("render", NULL, ANSWER);

static const Column REPLAY[] = {
    {.key = "x", .words = "pixel, x", .about = "`finite` false: the sample is left out of a frame"},
    COLUMN_TEXT("y", "y"),
    COLUMN_TEXT("sample", "sample"),
    COLUMN_TEXT("finite", "finite"),
    COLUMN_DIGITS("XYZ", "XYZ", "cd/m2", 9),
    COLUMN_DIGITS("RGB", "RGB", NULL, 9),
    COLUMN_TEXT("part", "first surface"),
    COLUMN_TEXT("display", "display"),
    COLUMN_DIGITS("depth_m", "at", "m", 0),
};
const TableKind render_replay_kind = TABLE_KIND("replay", NULL, REPLAY);
