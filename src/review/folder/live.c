/* SPDX-License-Identifier: Apache-2.0 */
#include "review/folder/live.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/parallel.h"
#include "base/units.h"
#include "image/exposure.h"
#include "image/false_colour.h"
#include "review/pace/work.h"
#include "review/review_decide.h"
#include "text/base64.h"
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
#define PICTURES_BYTES ((size_t)10 << 20)   /* of packed layers: more frames stay as they are */

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

static bool make_layers(const LiveAsk *ask, const FrameImage *frame, LivePicture *out,
                        Arena *arena, Error *err)
{
    Arena     scratch = arena_reserve(LIVE_BYTES);
    LiveFrame split = {0};
    double    yfov = field_of_view(frame);
    HumanEye  eye = ask->request->observer;
    bool      ok = live_frame_split(frame, &scratch, &split, err);
    if (ok) {
        split.scene = live_frame_shrink(&split.scene, LIVE_WIDTH, LIVE_HEIGHT, &scratch);
        split.displays = live_frame_shrink(&split.displays, LIVE_WIDTH, LIVE_HEIGHT, &scratch);
        out->width = split.scene.width;
        out->height = split.scene.height;
        ok = pack(&split, ask->threads, &out->scene, &out->displays, arena, err);
    }
    if (ok && yfov > 0) {
        ok = live_frame_spread(&split, yfov, eye, ask->threads, &scratch, err) &&
             pack(&split, ask->threads, &out->eye_scene, &out->eye_displays, arena, err);
        out->age_years = eye.age_years;
        out->pigment = eye.pigment;
    }
    arena_release(&scratch);
    return ok;
}

/* The frame lies beside its picture. */
static bool make_picture(const LiveAsk *ask, const char *name, LivePicture *out, Arena *arena,
                         Error *err)
{
    Arena       scratch = arena_reserve(LIVE_BYTES);
    int         stem = (int)(path_ending(name) - name);
    const char *path = arena_format(&scratch, "%s/%.*s.exr", ask->folder, stem, name);
    FrameImage  frame;
    *out = (LivePicture){.frame = name};
    bool ok = frame_read(path, &scratch, &frame, err);
    if (ok) {
        look_at(&frame, out, scratch);
        ok = make_layers(ask, &frame, out, arena, err) || error_in_file(err, path);
    }
    arena_release(&scratch);
    return ok;
}

static size_t packed_size(const LivePicture *p)
{
    const char *layers[4] = {p->scene, p->displays, p->eye_scene, p->eye_displays};
    size_t      size = 0;
    for (int i = 0; i < 4; i++) size += layers[i] ? strlen(layers[i]) : 0;
    return size;
}

static bool is_new(const LivePicture *pictures, int count, const char *frame)
{
    for (int i = 0; i < count; i++)
        if (!strcmp(pictures[i].frame, frame)) return false;
    return true;
}

static bool make_pictures(const LiveAsk *ask, Arena *arena, ReviewLive *out, Error *err)
{
    const Review *review = &ask->outcome->review;
    int           most = review_case_count(review), made = 0;
    size_t        size = 0;
    LivePicture  *pictures = ARENA_NEW(arena, LivePicture, most);
    for (int i = 0; i < most && size < PICTURES_BYTES; i++) {
        const ReviewCase *c = review_case_at(review, i);
        if (!c->frame || !is_new(pictures, made, c->frame)) continue;
        if (!make_picture(ask, c->frame, &pictures[made], arena, err)) return false;
        size += packed_size(&pictures[made++]);
        work_add(ask->work, WORK_LAYERS, work_of_frame(ask->request, WORK_LAYERS));
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
    *sky = (LiveSky){.suns = list, .count = suns->count,
                     .is_route = condition && condition->kind == CONDITION_ROUTE};
    if (is_year) {
        sky->year = condition->year;
        sky->step_minutes = suns->step_minutes;
        sky->headings_deg = condition->headings_deg;
        sky->heading_count = condition->heading_count;
    }
    return sky;
}

static void make_sweeps(const LiveAsk *ask, Arena *arena, ReviewLive *out)
{
    const ReviewOutcome *outcome = ask->outcome;
    LiveSweep       *sweeps = ARENA_NEW(arena, LiveSweep, outcome->table_count);
    const SweepSuns *last = NULL;
    const LiveSky   *sky = NULL;
    for (int i = 0; i < outcome->table_count; i++) {
        const SweepTable *t = &outcome->tables[i];
        const char *condition = outcome->review.sweeps[t->sweep_id].condition;
        if (t->suns != last)
            sky = make_sky(t->suns, review_condition_named(ask->request, condition), arena);
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

bool live_make(const LiveAsk *ask, Arena *arena, ReviewLive *out, Error *err)
{
    *out = (ReviewLive){.colours = false_colours(arena)};
    make_sweeps(ask, arena, out);
    return make_pictures(ask, arena, out, err);
}
