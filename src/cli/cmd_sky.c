/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion sky: draws a sky and prints its figures. */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "base/parallel.h"
#include "print/print.h"
#include "base/reference.h"
#include "base/units.h"
#include "cli/commands.h"
#include "cli/options/answer.h"
#include "cli/options/environment_options.h"
#include "cli/options/outputs.h"
#include "cli/options/scene_warnings.h"
#include "image/frame.h"
#include "light/sky.h"
#include "plot/sky_plot.h"
#include "scene/load/scene_load.h"
#include "sky/weather_light.h"
#include "spectrum/photometry.h"
#include "text/json_text.h"

#define LANE_SETS 8    /* of 16 wavelengths: enough for smooth spectra */
#define PATH_STEPS 145 /* every 10 minutes of a day */

/* One run of the command. */
typedef struct SkyRun {
    Cli cli;
    EnvironmentChange change;
    const char *output;
    int size[2]; /* of the EXR */
    bool is_fisheye;
    const char *root; /* --root, or NULL */
    Arena *arena;
    Problems problems;
    Scene *scene;
    Sky sky;
    double turn; /* compass azimuth of the scene's -Z */
    float *rgb[3];
    Wavelengths lanes[LANE_SETS];
} SkyRun;

/* ---- the sky, direction by direction ----------------------------------------------------- */

/* A direction of the compass in the scene. */
static Vec3 scene_direction(const SkyRun *work, double azimuth, double elevation) {
    double a = azimuth - work->turn, c = cos(elevation);
    return vec3((float)(c * sin(a)), (float)sin(elevation), (float)(-c * cos(a)));
}

static void sky_rgb(const SkyRun *work, Vec3 direction, float rgb[3]) {
    float xyz[3] = {0, 0, 0};
    for (int k = 0; k < LANE_SETS; k++) {
        SkySample seen = sky_seen(&work->sky, direction, direction, &work->lanes[k]);
        spectrum_add_xyz(&work->lanes[k], seen.radiance, xyz);
    }
    for (int i = 0; i < 3; i++) xyz[i] *= 1.0f / LANE_SETS;
    rgb_from_xyz(xyz, rgb);
}

/* False outside a fisheye's disc. */
static bool pixel_direction(const SkyRun *work, int x, int y, double *azimuth, double *elevation) {
    double u = (x + 0.5) / work->size[0], v = (y + 0.5) / work->size[1];
    if (!work->is_fisheye) {
        *azimuth = 2 * PI * u;
        *elevation = PI * (0.5 - v);
        return true;
    }
    double dx = 2 * u - 1, dy = 1 - 2 * v, r = sqrt(dx * dx + dy * dy);
    *azimuth = atan2(dx, dy);
    *elevation = PI / 2 * (1 - r);
    return r <= 1;
}

static void draw_row(void *context, int y, int worker) {
    SkyRun *work = context;
    (void)worker;
    for (int x = 0; x < work->size[0]; x++) {
        double azimuth, elevation;
        float rgb[3] = {0, 0, 0};
        if (pixel_direction(work, x, y, &azimuth, &elevation))
            sky_rgb(work, scene_direction(work, azimuth, elevation), rgb);
        for (int i = 0; i < 3; i++)
            work->rgb[i][(size_t)y * (size_t)work->size[0] + (size_t)x] = rgb[i];
    }
}

static void choose_lanes(SkyRun *work) {
    for (int k = 0; k < LANE_SETS; k++)
        wavelengths_sample(((float)k + 0.5f) / LANE_SETS, &work->lanes[k]);
}

static void draw(SkyRun *work) {
    size_t count = (size_t)work->size[0] * (size_t)work->size[1];
    for (int i = 0; i < 3; i++) work->rgb[i] = ARENA_NEW(work->arena, float, count);
    parallel_for(work->cli.threads, work->size[1], draw_row, work);
}

/* ---- figures ----------------------------------------------------------------------------- */

/* The sky above the horizontal, for a picture or a constant sky, which have no model. */
static double horizontal_lux(const SkyRun *work) {
    double sum = 0;
    int rows = 180, columns = 360;
    for (int j = 0; j < rows; j++) {
        double low = PI / 2 * j / rows, high = PI / 2 * (j + 1) / rows, middle = (low + high) / 2;
        double weight = 0.5 * (sin(high) * sin(high) - sin(low) * sin(low)) * 2 * PI / columns;
        for (int i = 0; i < columns; i++) {
            float rgb[3];
            sky_rgb(work, scene_direction(work, 2 * PI * (i + 0.5) / columns, middle), rgb);
            sum += weight * (double)luminance_from_rgb(rgb);
        }
    }
    return sum;
}

static DaylightMetrics figures_of(const SkyRun *work) {
    float rgb[3];
    if (work->sky.model) return work->sky.model->daylight->metrics;
    DaylightMetrics f = {.diffuse_horizontal_lx = horizontal_lux(work)};
    const Environment *environment = &work->scene->environment;
    sky_rgb(work, vec3(0, 1, 0), rgb);
    f.zenith_cd_m2 = (double)luminance_from_rgb(rgb);
    f.is_sun_up = work->sky.has_sun;
    if (work->sky.has_sun) {
        f.sun_azimuth_deg = degrees_from_radians((double)environment->sun_azimuth);
        f.sun_elevation_deg = degrees_from_radians((double)environment->sun_elevation);
        f.sun_zenith_deg = 90 - f.sun_elevation_deg;
        f.direct_normal_lx = (double)environment->sun_illuminance_lx;
    }
    f.global_horizontal_lx =
        f.diffuse_horizontal_lx +
        f.direct_normal_lx * fmax(0, sin(radians_from_degrees(f.sun_elevation_deg)));
    return f;
}

static json_t *moon_json(const NightMetrics *m) {
    if (!m->has_moon) return json_null();
    return json_pack("{s:f, s:f, s:b, s:b, s:f, s:f, s:f, s:f, s:f, s:f}", "azimuth_deg",
                     m->moon_azimuth_deg, "elevation_deg", m->moon_elevation_deg, "is_up",
                     (int)m->is_moon_up, "is_in_light", (int)m->is_moon_lit, "illuminated_fraction",
                     m->illuminated, "phase_angle_deg", m->phase_angle_deg, "elongation_deg",
                     m->elongation_deg, "distance_km", m->moon_distance_km, "direct_normal_lx",
                     m->moon_normal_lx, "diffuse_horizontal_lx", m->moon_sky_lx);
}

static json_t *efficacy_number(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

/* null: a sky that has no measured irradiance. */
static json_t *efficacy_json(const SkyRun *work, const DaylightMetrics *f) {
    const DaylightInput *in = &work->scene->environment.daylight;
    if (work->sky.kind != ENVIRONMENT_PEREZ) return json_null();
    json_t *document = json_pack(
        "{s:s, s:o, s:o, s:o}", "rule",
        weather_lux_text(in->has_lux ? WEATHER_LUX_FILE : WEATHER_LUX_PEREZ), "direct_lm_w",
        efficacy_number(f->efficacy.direct), "diffuse_lm_w", efficacy_number(f->efficacy.diffuse),
        "global_lm_w", efficacy_number(f->efficacy.global));
    if (in->has_lux) return document;
    json_object_set_new(document, "water_cm", json_real(in->water_cm));
    json_object_set_new(document, "water_source",
                        json_string(weather_water_text(in->water_source)));
    return document;
}

/* The relief of the cloud deck that is drawn, m; 0: none. */
static double relief_of(const SkyRun *work) {
    const Daylight *daylight = work->sky.model ? work->sky.model->daylight : NULL;
    bool has_relief =
        daylight && daylight->input.kind == DAYLIGHT_CLEAR && daylight->sunlight.atmosphere.relief;
    return has_relief ? daylight->input.cloud_relief_m : 0;
}

static json_t *answer_of(const SkyRun *work, const DaylightMetrics *f) {
    json_t *sun = work->sky.model || work->sky.has_sun
                      ? json_pack("{s:f, s:f, s:f, s:f, s:b, s:f, s:f}", "azimuth_deg",
                                  f->sun_azimuth_deg, "zenith_deg", f->sun_zenith_deg,
                                  "elevation_deg", f->sun_elevation_deg, "distance_au",
                                  f->distance_au, "is_up", (int)f->is_sun_up, "true_elevation_deg",
                                  f->true_elevation_deg, "refraction_deg", f->refraction_deg)
                      : json_null();
    json_t *document = json_pack(
        "{s:o, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:[f,f], s:[f,f], s:f, s:f}", "sun", sun,
        "direct_normal_lx", f->direct_normal_lx, "diffuse_horizontal_lx", f->diffuse_horizontal_lx,
        "global_horizontal_lx", f->global_horizontal_lx, "zenith_cd_m2", f->zenith_cd_m2,
        "direct_normal_w_m2", f->direct_normal_w_m2, "diffuse_horizontal_w_m2",
        f->diffuse_horizontal_w_m2, "ground_cd_m2", f->floor_cd_m2, "sun_xy", f->sun_xy[0],
        f->sun_xy[1], "zenith_xy", f->zenith_xy[0], f->zenith_xy[1], "horizon_deg", f->horizon_deg,
        "air_mass", f->air_mass);
    json_object_set_new(document, "moon", moon_json(&f->night));
    json_object_set_new(document, "night_background_lx", json_real(f->night.background_lx));
    json_object_set_new(document, "luminous_efficacy", efficacy_json(work, f));
    json_object_set_new(document, "weather", weather_option_json(&work->scene->environment));
    if (relief_of(work) > 0)
        json_object_set_new(document, "synthetic_cloud_relief_m", json_real(relief_of(work)));
    if (work->output) json_object_set_new(document, "output", json_text(work->output));
    return document;
}

/* ---- what people read -------------------------------------------------------------------- */

#define FIGURE(key_, words_, unit_, places_) \
    {.key = key_, .words = words_, .unit = unit_, .places = places_, .hides_zero = true}
#define WATTS(key_, words_) \
    {.key = key_, \
     .words = words_, \
     .unit = "W/m²", \
     .is_fixed = true, \
     .places = 1, \
     .hides_zero = true}
#define XY(key_, words_) \
    {.key = key_, .words = words_, .is_fixed = true, .places = 4, .hides_zero = true}

static const Column FIGURES[] = {
    COLUMN_FIXED("sun.azimuth_deg", "sun's azimuth", "°", 3),
    COLUMN_FIXED("sun.elevation_deg", "sun's elevation", "°", 3),
    FIGURE("direct_normal_lx", "direct normal", "lx", 4),
    COLUMN_DIGITS("diffuse_horizontal_lx", "diffuse horizontal", "lx", 4),
    COLUMN_DIGITS("global_horizontal_lx", "global horizontal", "lx", 4),
    COLUMN_DIGITS("zenith_cd_m2", "zenith", "cd/m²", 4),
    FIGURE("ground_cd_m2", "ground below", "cd/m²", 4),
    XY("zenith_xy", "zenith x, y"),
    XY("sun_xy", "sun x, y"),
    WATTS("direct_normal_w_m2", "direct normal"),
    WATTS("diffuse_horizontal_w_m2", "diffuse horizontal"),
    FIGURE("luminous_efficacy.direct_lm_w", "efficacy, direct", "lm/W", 4),
    FIGURE("luminous_efficacy.diffuse_lm_w", "efficacy, diffuse", "lm/W", 4),
    COLUMN_TEXT("luminous_efficacy.rule", "lux by"),
    FIGURE("luminous_efficacy.water_cm", "with water of", "cm", 3),
    {.key = "synthetic_cloud_relief_m",
     .words = "cloud relief, synthetic",
     .unit = "m",
     .places = 4,
     .hides_zero = true,
     .about =
         "of a picture, no measured weather; absent without; other figures are an even deck's"},
    FIGURE("horizon_deg", "horizon", "°", 3),
    COLUMN_TEXT("weather.file", "weather file"),
    COLUMN_TEXT("weather.line", "its line"),
    FIGURE("night_background_lx", "night background", "lx", 4),
    /* at night: */
    COLUMN_FIXED("moon.azimuth_deg", "moon's azimuth", "°", 3),
    COLUMN_FIXED("moon.elevation_deg", "moon's elevation", "°", 3),
    COLUMN_SHARE("moon.illuminated_fraction", "moon lit"),
    FIGURE("moon.direct_normal_lx", "moon direct normal", "lx", 4),
};
static const TableKind FIGURES_KIND = TABLE_KIND("sky", NULL, FIGURES);
#define OF_THE_MOON 4 /* by day it stands in JSON alone */

static TableKind figures_kind(const DaylightMetrics *f) {
    TableKind kind = FIGURES_KIND;
    if (!(f->night.background_lx > 0)) kind.column_count -= OF_THE_MOON;
    return kind;
}

/* Those of JSON alone. */
static const Column KEYS[] = {
    COLUMN_KEY("sun.zenith_deg", "from straight up"),
    COLUMN_KEY("sun.true_elevation_deg", "without refraction"),
    COLUMN_KEY("sun.refraction_deg", NULL),
    COLUMN_KEY("sun.distance_au", NULL),
    COLUMN_KEY("sun.is_up", NULL),
    COLUMN_KEY("air_mass", "along the beam over straight up; 0: the sun is down"),
    COLUMN_KEY("luminous_efficacy", "of a Perez sky; else null. `rule`: `perez 1990` or `file`"),
    COLUMN_KEY("luminous_efficacy.global_lm_w", "a fit of its own; of `file` the ratio"),
    COLUMN_KEY("luminous_efficacy.water_source", "`dew point`, `given`, `assumed`"),
    COLUMN_KEY("moon", "null without a time; `is_in_light`: the frame has its light; "
                       "`direct_normal_lx` and `diffuse_horizontal_lx` by its light in the air"),
    COLUMN_KEY("weather",
               "of `--weather` the row taken, else null: `month`, `day`, `label_h`, "
               "`instant_minus_when_min`; where its instant lies: `offset_h`, `offset_source`; how "
               "well the file fits the sun: `closes`, `closure_rows`, `closure_w_m2`, "
               "`closure_hour_means_w_m2`, `best_offset_h`, `best_closure_w_m2`; "
               "`file_direct_normal_lx`, `file_diffuse_horizontal_lx`: its own columns, null where "
               "they are missing"),
    COLUMN_KEY("output", "the picture; absent without `-o`"),
};
static const TableKind KEYS_KIND = TABLE_KIND("sky", NULL, KEYS);

/* ---- pictures ---------------------------------------------------------------------------- */

static bool write_exr(const SkyRun *work, Error *err) {
    ExrWindow data = {0, 0, work->size[0], work->size[1]};
    FrameImage frame = frame_create(work->size[0], work->size[1], data, 3, 8, work->arena);
    for (int i = 0; i < 3; i++) {
        char name[2] = {"RGB"[i], 0};
        memcpy(frame_add_channel(&frame, name, false, work->arena), work->rgb[i],
               sizeof(float) * frame_pixel_count(&frame));
    }
    frame_set_string(&frame, "comments",
                     work->is_fisheye
                         ? "sky without the sun's disc, cd/m2; plan: north on top, east right, "
                           "equidistant, the rim is the horizontal"
                         : "sky without the sun's disc, cd/m2; equirectangular: left edge north, "
                           "then east, as --environment hdri: takes it",
                     work->arena);
    return frame_write(work->output, &frame, err);
}

static const char *kind_text(const SkyRun *work) {
    const DaylightInput *in = &work->scene->environment.daylight;
    switch (work->sky.kind) {
    case ENVIRONMENT_NONE: return "No sky";
    case ENVIRONMENT_CONSTANT: return "Uniform sky";
    case ENVIRONMENT_HDRI: return "Pictured sky";
    case ENVIRONMENT_CIE: return arena_format(work->arena, "CIE sky %d", in->cie_type);
    case ENVIRONMENT_PEREZ:
        return arena_format(work->arena, "Perez sky of %.0f W/m² direct, %.0f W/m² diffuse",
                            in->direct_w_m2, in->diffuse_w_m2);
    case ENVIRONMENT_SKY: break;
    }
    return in->visibility_km > 0
               ? arena_format(work->arena, "Clear sky, visibility %.0f km", in->visibility_km)
               : arena_format(work->arena, "Clear sky, turbidity %.2g", in->turbidity);
}

static const char *moment_text(const SkyRun *work) {
    const DaylightInput *in = &work->scene->environment.daylight;
    if (work->sky.kind < ENVIRONMENT_CIE || !in->has_time) return "";
    double zone = fabs(in->when.zone_h);
    return arena_format(work->arena,
                        "%04d-%02d-%02d %02d:%02d UTC%c%02d:%02d  ·  latitude %.4f°, "
                        "longitude %.4f°, %.0f m",
                        in->when.year, in->when.month, in->when.day, in->when.hour, in->when.minute,
                        in->when.zone_h < 0 ? '-' : '+', (int)zone,
                        (int)((zone - (int)zone) * 60 + 0.5), in->where.latitude_deg,
                        in->where.longitude_deg, in->where.altitude_m);
}

/* The sun through the day of the moment, on the clock of its zone. */
static int sun_path(const SkyRun *work, SkyPlotSun *path) {
    const DaylightInput *in = &work->scene->environment.daylight;
    double pressure, celsius;
    if (work->sky.kind < ENVIRONMENT_CIE || !in->has_time) return 0;
    SkyTime midnight = in->when;
    midnight.hour = midnight.minute = 0;
    midnight.second = 0;
    double day = sky_julian_day(&midnight);
    standard_atmosphere(in->where.altitude_m, &pressure, &celsius);
    for (int i = 0; i < PATH_STEPS; i++) {
        double now = day + i / 144.0;
        SunPosition p = sun_position(now, sky_delta_t_s(now), &in->where);
        double lift = sun_refraction_deg(p.elevation_deg, pressure, celsius);
        path[i] = (SkyPlotSun){radians_from_degrees(p.azimuth_deg),
                               radians_from_degrees(p.elevation_deg + lift), NULL};
        if (i % 12 == 0 && i < 144) path[i].label = arena_format(work->arena, "%02d", i / 6);
    }
    return PATH_STEPS;
}

static bool write_picture(const SkyRun *work, const DaylightMetrics *f, bool is_svg, Error *err) {
    size_t count = (size_t)work->size[0] * (size_t)work->size[1];
    float *luminance = ARENA_NEW(work->arena, float, count);
    const TableKind kind = figures_kind(f);
    json_t *answer = answer_of(work, f);
    SkyPlotSun path[PATH_STEPS];
    PlotBytes bytes;
    for (size_t i = 0; i < count; i++)
        luminance[i] =
            luminance_from_rgb((float[3]){work->rgb[0][i], work->rgb[1][i], work->rgb[2][i]});
    SkyPlot plot = {.luminance = luminance,
                    .width = work->size[0],
                    .height = work->size[1],
                    .horizon = radians_from_degrees(f->horizon_deg),
                    .has_sun = f->is_sun_up,
                    .sun = {radians_from_degrees(f->sun_azimuth_deg),
                            radians_from_degrees(f->sun_elevation_deg), NULL},
                    .has_moon = f->night.moon_normal_lx > 0,
                    .moon = {radians_from_degrees(f->night.moon_azimuth_deg),
                             radians_from_degrees(f->night.moon_elevation_deg), NULL},
                    .path = path,
                    .path_count = sun_path(work, path),
                    .has_heading =
                        work->change.has_heading || work->scene->environment.heading != 0,
                    .heading = (double)work->scene->environment.heading,
                    .title = kind_text(work),
                    .subtitle = moment_text(work)};
    plot.line = table_lines(&kind, answer, work->arena, &plot.line_count);
    bool ok = sky_plot_draw(&plot, is_svg, 0, work->arena, &bytes, err) &&
              file_write(work->output, bytes.data, bytes.size, err);
    json_decref(answer);
    return ok;
}

/* ---- the command ------------------------------------------------------------------------- */

typedef enum OutputKind {
    OUTPUT_NONE,
    OUTPUT_EXR,
    OUTPUT_PNG,
    OUTPUT_SVG,
    OUTPUT_WRONG
} OutputKind;

static OutputKind output_kind(const char *path) {
    static const char *const endings[] = {".exr", ".png", ".svg"};
    if (!path) return OUTPUT_NONE;
    for (int i = 0; i < 3; i++)
        if (!strcasecmp(path_ending(path), endings[i])) return (OutputKind)(OUTPUT_EXR + i);
    return OUTPUT_WRONG;
}

static bool build(SkyRun *work, Error *err) {
    SceneOptions files = {
        .paths = work->cli.arguments, .path_count = work->cli.argument_count, .root = work->root};
    Scene *none = ARENA_NEW(work->arena, Scene, 1);
    none->environment =
        (Environment){.color = {1, 1, 1}, .forward = vec3(0, 0, -1), .hdri_scale = 1};
    work->problems = problems_start(work->arena);
    work->scene = none;
    if (!reference_check_root(work->root, err)) return false;
    if (files.path_count &&
        (!scene_load(&files, work->arena, &work->problems, &work->scene, err) ||
         !outputs_spare(&work->cli.outputs, work->scene->inputs, work->scene->input_count, err)))
        return false;
    if (!environment_change(&work->change, work->scene, work->arena, &work->problems, err))
        return false;
    const Environment *environment = &work->scene->environment;
    hdri_warn(environment, &work->problems);
    cli_print_warnings(&work->problems);
    if (environment->kind == ENVIRONMENT_NONE && !environment->has_sun)
        return error_set(err, ERROR_USAGE,
                         "sky wants a sky: --environment sky:clear --when TIME "
                         "--where LAT,LON, or a scene that has one");
    work->turn = (double)environment->heading -
                 atan2((double)environment->forward.x, -(double)environment->forward.z);
    return sky_build(environment, work->arena, &work->sky, err);
}

static bool run(SkyRun *work, OutputKind kind, Error *err) {
    if (!build(work, err)) return false;
    if (kind != OUTPUT_EXR) work->is_fisheye = false;
    choose_lanes(work);
    if (kind != OUTPUT_NONE) draw(work);
    DaylightMetrics figures = figures_of(work);
    bool ok = kind == OUTPUT_NONE  ? true
              : kind == OUTPUT_EXR ? write_exr(work, err)
                                   : write_picture(work, &figures, kind == OUTPUT_SVG, err);
    if (!ok) return false;
    const TableKind figures_read = figures_kind(&figures);
    return cli_print_answer(&figures_read, answer_of(work, &figures), work->cli.json, err);
}

static Outcome run_sky(int argc, char **argv, Arena *arena, Error *err) {
    SkyRun work = {.arena = arena, .size = {0, 0}};
    int projection = 0;
    const Option options[] = {
        {"-o", OPTION_TEXT, "SKY.exr|.png|.svg",
         "linear light in cd/m2, or a chart in false colours with the sun's way", &work.output,
         .file = OPTION_OUTPUT},
        ENVIRONMENT_OPTIONS(&work.change),
        {"--projection", OPTION_CHOICE, "equirectangular|fisheye", "of an EXR (charts show both)",
         &projection},
        {"--size", OPTION_SIZE, "WxH", "pixels of an EXR (default 1024x512, fisheye 1024x1024)",
         work.size},
        {"--root", OPTION_TEXT, "DIR", ROOT_HELP, &work.root},
    };
    const CliCommand command = {
        "sky",
        command_sky.summary,
        "[SCENE.gltf ...] [-o SKY.exr|.png|.svg]",
        "parhelion sky --environment sky:clear --when 2026-06-21T08:30+02:00 "
        "--where 48.14,11.58,520 -o sky.png",
        options,
        COUNT_OF(options),
        0,
        -1,
        .answers = (const Answer[]){{"", &FIGURES_KIND}, {"", &KEYS_KIND}, {0}}};
    if (!cli_parse(&command, argc, argv, arena, &work.cli, err)) return OUTCOME_FAILED;
    if (work.cli.help_shown) return OUTCOME_DONE;
    OutputKind kind = output_kind(work.output);
    if (kind == OUTPUT_WRONG)
        return error_set(err, ERROR_USAGE, "-o %s: required: an ending .exr, .png or .svg",
                         work.output);
    work.is_fisheye = projection == 1;
    if (!work.size[0]) {
        work.size[0] = 1024;
        work.size[1] = work.is_fisheye && kind == OUTPUT_EXR ? 1024 : 512;
    }
    bool ok = run(&work, kind, err);
    if (work.scene && work.cli.argument_count) scene_close(work.scene);
    return outcome_of(ok);
}

const Command command_sky = {"sky", "draw the sky of a place and time, and print its figures",
                             run_sky};
