/* SPDX-License-Identifier: Apache-2.0 */
#include "review/folder/live.h"

#include <math.h>
#include <string.h>

#include "base/calendar.h"
#include "base/file.h"
#include "base/mathd.h"
#include "base/parallel.h"
#include "base/units.h"
#include "denoise/denoise.h"
#include "image/develop.h"
#include "image/exposure.h"
#include "image/false_colour.h"
#include "review/review_decide.h"
#include "text/base64.h"
#include "text/text.h"
#include "vision/eye_filter.h"

/* ---- a frame as a sum -------------------------------------------------------------------- */

static LivePlanes planes_new(int width, int height, Arena *arena)
{
    LivePlanes planes = {.width = width, .height = height};
    for (int c = 0; c < 3; c++)
        planes.rgb[c] = ARENA_NEW(arena, float, (size_t)width * (size_t)height);
    return planes;
}

bool live_frame_split(const FrameImage *frame, Arena *arena, LiveFrame *out, Error *err)
{
    const float *all[3], *emitted[3];
    const float *coverage = frame_channel(frame, "display.coverage");
    size_t       count = frame_pixel_count(frame);
    int          width = frame->data.x1 - frame->data.x0;
    int          height = frame->data.y1 - frame->data.y0;
    if (!frame_rgb(frame, "", all) || !frame_rgb(frame, "display.emitted", emitted) ||
        !coverage)
        return error_set(err, ERROR_INPUT,
                         "required: channels R, G, B, display.emitted and display.coverage");
    out->scene = planes_new(width, height, arena);
    out->displays = planes_new(width, height, arena);
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < count; i++) {
            /* emitted is the mean over the samples that saw a display: NaN without any */
            float shown = coverage[i] > 0 ? coverage[i] * emitted[c][i] : 0;
            out->displays.rgb[c][i] = shown;
            out->scene.rgb[c][i] = all[c][i] - shown;
        }
    return true;
}

bool live_clean_split(const FrameImage *denoised, Arena *arena, LiveFrame *out, Error *err)
{
    const float *all[3], *fine[3];
    if (!live_frame_split(denoised, arena, out, err)) return false;
    const float *coverage = frame_channel(denoised, "display.coverage");
    size_t       count = frame_pixel_count(denoised);
    bool         has_fine = frame_rgb(denoised, "display.fine", fine);
    frame_rgb(denoised, "", all);
    for (size_t i = 0; i < count; i++) {
        bool is_fine = has_fine && coverage[i] > 0 && isfinite(fine[0][i]) &&
                       isfinite(fine[1][i]) && isfinite(fine[2][i]);
        for (int c = 0; c < 3; c++) {
            if (is_fine) out->displays.rgb[c][i] = fine[c][i];
            out->scene.rgb[c][i] = fmaxf(all[c][i] - out->displays.rgb[c][i], 0);
        }
    }
    return true;
}

/* ---- smaller ----------------------------------------------------------------------------- */

/* Mean of `from` values `step` apart over each of `count` equal parts. */
static void shrink_line(const float *values, int from, size_t step, float *out, int count)
{
    double scale = (double)from / count;
    for (int i = 0; i < count; i++) {
        double low = i * scale, high = fmin((i + 1) * scale, from), sum = 0;
        for (int j = (int)low; j < high; j++)
            sum += (fmin(j + 1, high) - fmax(j, low)) * (double)values[(size_t)j * step];
        out[(size_t)i * step] = (float)(sum / (high - low));
    }
}

LivePlanes live_frame_shrink(const LivePlanes *planes, int width, int height, Arena *arena)
{
    double     ratio = fmax((double)planes->width / width, (double)planes->height / height);
    if (ratio <= 1) return *planes;
    int        w = (int)fmax(1, floor(planes->width / ratio + 0.5));
    int        h = (int)fmax(1, floor(planes->height / ratio + 0.5));
    LivePlanes out = planes_new(w, h, arena);
    Arena      scratch = *arena;
    size_t     across = (size_t)planes->width;
    float     *narrow = ARENA_NEW(&scratch, float, across * (size_t)planes->height);
    float     *column = ARENA_NEW(&scratch, float, across * (size_t)planes->height);
    for (int c = 0; c < 3; c++) {
        for (int y = 0; y < planes->height; y++)
            shrink_line(planes->rgb[c] + (size_t)y * across, planes->width, 1,
                        narrow + (size_t)y * across, w);
        for (int x = 0; x < w; x++)
            shrink_line(narrow + x, planes->height, across, column + x, h);
        for (int y = 0; y < h; y++)
            memcpy(out.rgb[c] + (size_t)y * (size_t)w, column + (size_t)y * across,
                   (size_t)w * sizeof(float));
    }
    return out;
}

/* ---- in the eye -------------------------------------------------------------------------- */

static EyeLayer layer_of(const LivePlanes *from, const LivePlanes *to)
{
    EyeLayer layer;
    for (int c = 0; c < 3; c++) {
        layer.rgb[c] = from->rgb[c];
        layer.out[c] = to->rgb[c];
    }
    return layer;
}

bool live_frame_spread(LiveFrame *frame, double yfov_deg, HumanEye eye, int threads,
                       Arena *arena, Error *err)
{
    int       width = frame->scene.width, height = frame->scene.height;
    LiveFrame out = {planes_new(width, height, arena), planes_new(width, height, arena)};
    double    high = 2 * tan_d(radians_from_degrees(yfov_deg) / 2);
    const EyeFilter filter = {
        .view = {.width = width, .height = height, .axis_x = width / 2.0,
                 .axis_y = height / 2.0, .pixel = high / height},
        .eye = eye, .threads = threads};
    const EyeLayer layers[] = {layer_of(&frame->scene, &out.scene),
                               layer_of(&frame->displays, &out.displays)};
    if (!eye_filter(&filter, layers, 2, *arena, err)) return false;
    *frame = out;
    return true;
}

#define LIVE_BYTES ((size_t)1 << 36)        /* address space: what is not touched is free */
#define PICTURES_BYTES ((size_t)15 << 20)   /* of packed layers: more frames stay as they are */

/* ---- pictures ---------------------------------------------------------------------------- */

static double field_of_view(const FrameImage *frame)
{
    const ExrAttribute *said = frame_attribute(frame, "parhelion:yfov_deg");
    return said && said->kind != EXR_STRING ? said->values[0] : (double)NAN;
}

static void look_at(const FrameImage *frame, LivePicture *out, Arena scratch)
{
    const float *rgb[3];
    size_t       count = frame_pixel_count(frame);
    float       *luminance = ARENA_NEW(&scratch, float, count);
    ExposureRequest usual = {.kind = EXPOSURE_AUTO};
    if (frame_rgb(frame, "", rgb))
        for (size_t i = 0; i < count; i++)
            luminance[i] = 0.2126f * rgb[0][i] + 0.7152f * rgb[1][i] + 0.0722f * rgb[2][i];
    ScaleRange range = scale_range_of(luminance, count, true, scratch);
    out->grey_cd_m2 = exposure_grey(usual, luminance, count, scratch);
    out->low = (double)range.low;
    out->high = (double)range.high;
}

/* Both parts of a frame, packed beside each other. */
typedef struct Packing {
    const LivePlanes *planes[2];
    Arena             room[2];
    const char       *packed[2];
} Packing;

static bool pack_part(void *context, int part, Error *err)
{
    Packing          *packing = context;
    const LivePlanes *planes = packing->planes[part];
    const float      *rgb[3] = {planes->rgb[0], planes->rgb[1], planes->rgb[2]};
    packing->packed[part] =
        live_layer_pack(rgb, (size_t)planes->width * (size_t)planes->height,
                        &packing->room[part], err);
    return packing->packed[part] != NULL;
}

static bool pack(const LiveFrame *frame, int threads, const char **scene, const char **displays,
                 Arena *arena, Error *err)
{
    Packing      packing = {.planes = {&frame->scene, &frame->displays}};
    const char **out[2] = {scene, displays};
    for (int i = 0; i < 2; i++) packing.room[i] = arena_reserve(LIVE_BYTES);
    bool ok = parallel_try(threads, 2, pack_part, &packing, *arena, err);
    for (int i = 0; i < 2; i++) {
        const char *packed = packing.packed[i];
        *out[i] = packed ? arena_string(arena, packed, strlen(packed)) : NULL;
        arena_release(&packing.room[i]);
    }
    return ok;
}

static void shrink(LiveFrame *split, Arena *arena)
{
    split->scene = live_frame_shrink(&split->scene, LIVE_WIDTH, LIVE_HEIGHT, arena);
    split->displays = live_frame_shrink(&split->displays, LIVE_WIDTH, LIVE_HEIGHT, arena);
}

/* The picture that the frame's own file shows. */
static bool make_clean(const LiveArgs *args, const FrameImage *frame, LivePicture *out,
                       Arena *arena, Error *err)
{
    Arena         scratch = arena_reserve(LIVE_BYTES);
    FrameImage    denoised;
    DenoiseReport unused;
    LiveFrame     split;
    bool ok = denoise_frame(frame, args->threads, &scratch, &denoised, &unused, err) &&
              live_clean_split(&denoised, &scratch, &split, err);
    if (ok) {
        shrink(&split, &scratch);
        out->label = DENOISED_WORDS;
        ok = pack(&split, args->threads, &out->clean_scene, &out->clean_displays, arena, err);
    }
    arena_release(&scratch);
    return ok;
}

static bool make_layers(const LiveArgs *args, const FrameImage *frame, LivePicture *out,
                        Arena *arena, Error *err)
{
    Arena     scratch = arena_reserve(LIVE_BYTES);
    LiveFrame split = {0};
    double    yfov = field_of_view(frame);
    HumanEye  eye = args->request->observer;
    bool      ok = live_frame_split(frame, &scratch, &split, err);
    if (ok) {
        shrink(&split, &scratch);
        out->width = split.scene.width;
        out->height = split.scene.height;
        ok = pack(&split, args->threads, &out->scene, &out->displays, arena, err);
    }
    if (ok && yfov > 0) {
        ok = live_frame_spread(&split, yfov, eye, args->threads, &scratch, err) &&
             pack(&split, args->threads, &out->eye_scene, &out->eye_displays, arena, err);
        out->age_years = eye.age_years;
        out->pigment = eye.pigment;
    }
    arena_release(&scratch);
    return ok;
}

/* The frame lies beside its picture. */
static bool make_picture(const LiveArgs *args, const char *name, LivePicture *out, Arena *arena,
                         Error *err)
{
    Arena       scratch = arena_reserve(LIVE_BYTES);
    int         stem = (int)(path_ending(name) - name);
    const char *path = arena_format(&scratch, "%s/%.*s.exr", args->folder, stem, name);
    FrameImage  frame;
    *out = (LivePicture){.frame = name};
    bool ok = frame_read(path, &scratch, &frame, err);
    if (ok) {
        look_at(&frame, out, scratch);
        ok = (make_layers(args, &frame, out, arena, err) &&
              (!args->request->frames.is_denoised ||
               make_clean(args, &frame, out, arena, err))) ||
             error_in_file(err, path);
    }
    arena_release(&scratch);
    return ok;
}

static size_t packed_size(const LivePicture *p)
{
    const char *layers[6] = {p->scene,        p->displays,    p->eye_scene,
                             p->eye_displays, p->clean_scene, p->clean_displays};
    size_t      size = 0;
    for (int i = 0; i < 6; i++) size += layers[i] ? strlen(layers[i]) : 0;
    return size;
}

static bool is_new(const LivePicture *pictures, int count, const char *frame)
{
    for (int i = 0; i < count; i++)
        if (!strcmp(pictures[i].frame, frame)) return false;
    return true;
}

static bool make_pictures(const LiveArgs *args, Arena *arena, ReviewLive *out, Error *err)
{
    const Review *review = &args->outcome->review;
    int           most = review_case_count(review), made = 0;
    size_t        size = 0;
    LivePicture  *pictures = ARENA_NEW(arena, LivePicture, most);
    for (int i = 0; i < most && size < PICTURES_BYTES; i++) {
        const ReviewCase *c = review_case_at(review, i);
        if (!c->frame || !is_new(pictures, made, c->frame)) continue;
        if (!make_picture(args, c->frame, &pictures[made], arena, err)) return false;
        size += packed_size(&pictures[made++]);
    }
    out->pictures = pictures;
    out->picture_count = made;
    return true;
}

static const char *false_colours(Arena *arena)
{
    unsigned char codes[256][3];
    Text          text = {.arena = arena};
    for (int i = 0; i < 256; i++) {
        float srgb[3];
        false_colour_of((float)i / 255, srgb);
        for (int c = 0; c < 3; c++) codes[i][c] = (unsigned char)(srgb[c] * 255 + 0.5f);
    }
    base64_encode(&text, codes, sizeof codes);
    return text.data;
}

/* ---- sweeps ------------------------------------------------------------------------------ */

static const LiveSky *make_sky(const SweepSuns *suns, const ReviewCondition *condition,
                               Arena *arena)
{
    LiveSun *list = ARENA_NEW(arena, LiveSun, suns->count);
    LiveSky *sky = ARENA_NEW(arena, LiveSky, 1);
    for (int i = 0; i < suns->count; i++) {
        const SweepSun *sun = &suns->list[i];
        list[i] = (LiveSun){sun->azimuth_deg, sun->elevation_deg, sun->step, sun->heading_id};
    }
    bool is_year = condition && condition->kind == CONDITION_YEAR_SWEEP;
    *sky = (LiveSky){.suns = list, .count = suns->count};
    if (is_year) {
        sky->year = condition->year;
        sky->step_minutes = suns->step_minutes;
        sky->headings_deg = condition->headings_deg;
        sky->heading_count = condition->heading_count;
    }
    return sky;
}

static void make_sweeps(const LiveArgs *args, Arena *arena, ReviewLive *out)
{
    const ReviewOutcome *outcome = args->outcome;
    LiveSweep       *sweeps = ARENA_NEW(arena, LiveSweep, outcome->table_count);
    const SweepSuns *last = NULL;
    const LiveSky   *sky = NULL;
    for (int i = 0; i < outcome->table_count; i++) {
        const SweepTable *t = &outcome->tables[i];
        const char *condition = outcome->review.sweeps[t->sweep_id].condition;
        if (t->suns != last)
            sky = make_sky(t->suns, review_condition_named(args->request, condition), arena);
        last = t->suns;
        const SunFigures *f = &t->figures;
        sweeps[i] = (LiveSweep){t->sweep_id, sky, f->worst, f->reflected, f->mirror, f->level,
                                f->lux, f->verdict, f->ambient, t->foreground, t->background,
                                t->asked};
    }
    out->sweeps = sweeps;
    out->sweep_count = outcome->table_count;
}

/* ---- all of it --------------------------------------------------------------------------- */

bool live_make(const LiveArgs *args, Arena *arena, ReviewLive *out, Error *err)
{
    *out = (ReviewLive){.colours = false_colours(arena)};
    make_sweeps(args, arena, out);
    return make_pictures(args, arena, out, err);
}

/* ---- x ----------------------------------------------------------------------------------- */

#define MINUTES_A_DAY 1440

/* ---- the table --------------------------------------------------------------------------- */

static void add_time(Text *text, const SweepTable *table, const ReviewCondition *c,
                     const SweepSun *sun)
{
    if (c->kind == CONDITION_YEAR_SWEEP) {
        double minutes = (sun->step + 0.5) * table->suns->step_minutes;
        text_format(text, "%d,%d,%.4g,", (int)(minutes / MINUTES_A_DAY) + 1, c->year,
                 fmod(minutes, MINUTES_A_DAY) / 60);
    }
}

static const char *head_of(const ReviewCondition *c)
{
    return c->kind == CONDITION_YEAR_SWEEP ? "day_of_year,year,hour_utc," : "";
}

bool sweep_table_write(const SweepTable *table, const ReviewCondition *condition,
                       const char *path, Error *err)
{
    Arena own = arena_reserve((size_t)1 << 32);
    Text  text = {.arena = &own};
    const SunFigures *f = &table->figures;
    text_format(&text, "%ssun_azimuth_deg,sun_elevation_deg,heading_deg,vehicle_azimuth_deg,"
                       "minutes,level,display_lx,reflected_cd_m2,sun_by_mirror_cd_m2,"
                       "contrast_ratio,contrast_low,contrast_high,margin,verdict\n",
                head_of(condition));
    for (int i = 0; i < table->suns->count; i++) {
        const SweepSun *sun = &table->suns->list[i];
        add_time(&text, table, condition, sun);
        text_format(&text, "%.2f,%.2f,%g,%.2f,%g,%.4g,%.5g,%.5g,%.5g,%.5g,%.5g,%.5g,",
                    sun->compass_deg, sun->elevation_deg, sun->heading_deg, sun->azimuth_deg,
                    sun->minutes, (double)f->level[i], (double)f->lux[i],
                    (double)f->reflected[i], (double)f->mirror[i], (double)f->contrast[i],
                    (double)f->low[i], (double)f->high[i]);
        if (!isnan(f->margin[i])) text_format(&text, "%.4g", (double)f->margin[i]);
        text_format(&text, ",%s\n", verdict_names[f->verdict[i]]);
    }
    bool ok = text_write(&text, path, err);
    arena_release(&own);
    return ok;
}

/* ---- the map ----------------------------------------------------------------------------- */

typedef struct MapCells {
    float         *contrast, *margin;
    unsigned char *verdict;
} MapCells;

static ReviewMap empty_map(const ReviewSweep *sweep, ReviewAxis azimuth, ReviewAxis elevation,
                           MapCells *cells, Arena *arena)
{
    size_t count = (size_t)azimuth.count * (size_t)elevation.count;
    cells->contrast = ARENA_NEW(arena, float, count);
    cells->margin = ARENA_NEW(arena, float, count);
    cells->verdict = ARENA_NEW(arena, unsigned char, count);
    for (size_t i = 0; i < count; i++) cells->contrast[i] = cells->margin[i] = NAN;
    return (ReviewMap){.of = sweep, .is_of_vehicle = true, .azimuth_deg = azimuth,
                       .elevation_deg = elevation, .contrast = cells->contrast,
                       .margin = cells->margin, .verdict = cells->verdict};
}

static void put_worst(const SweepTable *table, int sun, MapCells *cells, size_t at)
{
    float found = table->figures.contrast[sun], before = cells->contrast[at]; /* NaN: none */
    if (table->figures.is_private ? found <= before : found >= before) return;
    cells->contrast[at] = table->figures.contrast[sun];
    cells->margin[at] = table->figures.margin[sun];
    cells->verdict[at] = table->figures.verdict[sun];
}

/* ---- between the steps of a year --------------------------------------------------------- */

/* A step's answer stands for half a step of time before it and after it. Where the sun passes
 * in that time, cells without a step of their own get the answer of the step nearest in time:
 * no other answer is made, and cells that the sun does not pass stay empty. */

typedef struct SunWay {
    const SweepTable *table;
    const ReviewMap  *map;
    MapCells         *cells;
    float            *apart; /* [cell] part of a step's time from its answer's; 0: its own */
} SunWay;

static int cell_at(const ReviewMap *map, double azimuth_deg, double elevation_deg)
{
    const ReviewAxis *across = &map->azimuth_deg, *up = &map->elevation_deg;
    int a = (int)floor((azimuth_deg - across->first) / across->step + 0.5);
    int e = (int)floor((elevation_deg - up->first) / up->step + 0.5);
    a = (a % across->count + across->count) % across->count;
    return e < 0 || e >= up->count ? -1 : e * across->count + a;
}

static void direction_of(const SweepSun *sun, double out[3])
{
    double turn = radians_from_degrees(sun->azimuth_deg);
    double up = radians_from_degrees(sun->elevation_deg);
    out[0] = cos(up) * sin(turn);
    out[1] = cos(up) * cos(turn);
    out[2] = sin(up);
}

/* The answer of `sun`, `apart` of a step away. */
static void offer(const SunWay *way, int sun, int at, float apart)
{
    if (at < 0 || apart > way->apart[at]) return;
    if (apart < way->apart[at]) way->cells->contrast[at] = NAN;
    way->apart[at] = apart;
    put_worst(way->table, sun, way->cells, (size_t)at);
}

/* From one step to the next, by the straight way, which is within 0.3 degrees of the sun's. */
static void walk(const SunWay *way, int from, int to)
{
    double a[3], b[3], at[3], cosine = 0;
    direction_of(&way->table->suns->list[from], a);
    direction_of(&way->table->suns->list[to], b);
    for (int i = 0; i < 3; i++) cosine += a[i] * b[i];
    double angle = degrees_from_radians(acos(fmin(fmax(cosine, -1), 1)));
    int    parts = 2 * (int)ceil(2 * angle / way->map->azimuth_deg.step);
    for (int k = 1; k < parts; k++) {
        double t = (double)k / parts;
        for (int i = 0; i < 3; i++) at[i] = a[i] + t * (b[i] - a[i]);
        int cell = cell_at(way->map, degrees_from_radians(atan2(at[0], at[1])),
                           degrees_from_radians(atan2(at[2], hypot(at[0], at[1]))));
        if (2 * k <= parts) offer(way, from, cell, (float)t);
        if (2 * k >= parts) offer(way, to, cell, (float)(1 - t));
    }
}

/* Steps of one heading, where the sun is up at both. */
static void fill_between(const SunWay *way, Arena scratch)
{
    const SweepSuns *suns = way->table->suns;
    int  headings = 0;
    int *before;
    for (int i = 0; i < suns->count; i++)
        if (suns->list[i].heading_id >= headings) headings = suns->list[i].heading_id + 1;
    before = ARENA_NEW(&scratch, int, headings + 1);
    for (int h = 0; h < headings; h++) before[h] = -1;
    for (int i = 0; i < suns->count; i++) {
        int *last = &before[suns->list[i].heading_id];
        if (*last >= 0 && suns->list[*last].step + 1 == suns->list[i].step) walk(way, *last, i);
        *last = i;
    }
}

static ReviewMap grid_map(const SweepTable *table, const ReviewSweep *sweep, Arena *arena)
{
    const SweepSuns *suns = table->suns;
    MapCells  cells;
    ReviewAxis azimuth = {suns->list[0].azimuth_deg, suns->azimuth_deg.step,
                          suns->azimuth_deg.count};
    ReviewAxis elevation = {suns->elevation_deg.first, suns->elevation_deg.step,
                            suns->elevation_deg.count};
    ReviewMap map = empty_map(sweep, azimuth, elevation, &cells, arena);
    for (int i = 0; i < suns->count; i++) put_worst(table, i, &cells, (size_t)i);
    return map;
}

ReviewMap sweep_map(const SweepTable *table, const ReviewSweep *sweep, double step_deg,
                    Arena *arena)
{
    const SweepSuns *suns = table->suns;
    MapCells  cells;
    if (!suns->has_time) return grid_map(table, sweep, arena);
    ReviewAxis azimuth = {0, step_deg, (int)(360 / step_deg)};
    ReviewAxis elevation = {0.5 * step_deg, step_deg, (int)(90 / step_deg)};
    ReviewMap map = empty_map(sweep, azimuth, elevation, &cells, arena);
    SunWay    way = {table, &map, &cells,
                     ARENA_NEW(arena, float, azimuth.count * elevation.count)};
    for (int i = 0; i < azimuth.count * elevation.count; i++) way.apart[i] = 1;
    for (int i = 0; i < suns->count; i++) {
        const SweepSun *sun = &suns->list[i];
        offer(&way, i, cell_at(&map, sun->azimuth_deg, sun->elevation_deg), 0);
    }
    map.is_between_steps = suns->step_minutes > 0;
    if (map.is_between_steps) fill_between(&way, *arena);
    return map;
}

/* ---- the calendar ------------------------------------------------------------------------ */

ReviewCalendar sweep_calendar(const SweepTable *table, const ReviewSweep *sweep,
                              const ReviewCondition *condition, Arena *arena)
{
    const SweepSuns *suns = table->suns;
    int    steps = (int)floor(MINUTES_A_DAY / suns->step_minutes + 0.5);
    int    year = condition->year;
    int    days = 365 + calendar_is_leap(year);
    float *share = ARENA_NEW(arena, float, (size_t)days * (size_t)steps);
    int   *asked = ARENA_NEW(arena, int, (size_t)days * (size_t)steps);
    for (int i = 0; i < suns->count; i++) {
        int at = suns->list[i].step;
        if (at >= days * steps) continue;
        asked[at]++;
        share[at] += table->figures.verdict[i] == VERDICT_FAIL;
    }
    for (int i = 0; i < days * steps; i++)
        share[i] = asked[i] ? share[i] / (float)asked[i] : NAN;
    return (ReviewCalendar){sweep, year, days, steps, "UTC", condition->heading_count,
                            share};
}
