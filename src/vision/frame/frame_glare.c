/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/frame/frame_glare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/confidence.h"
#include "base/mathd.h"
#include "base/units.h"
#include "image/layer_view.h"

enum { NO_SOURCE = -1 };

/* The pixels of the display window; one that is not seen has no solid angle. */
typedef struct Pixels {
    FrameView view;
    int width, height;
    const float *y;                 /* cd m^-2 */
    const float *halves, *variance; /* |half the halves' difference|, square; NULL: none */
    double *sr, *projected_sr;
    int32_t *source; /* its place in the list; NO_SOURCE */
    bool *is_core;   /* of that source */
    double *share;   /* of y, its source's; the rest is background */
} Pixels;

static size_t count_of(const Pixels *pixels) {
    return (size_t)pixels->width * (size_t)pixels->height;
}

/* ---- what the frame has ------------------------------------------------------------------ */

static const float *find_plane(const FrameImage *frame, const char *layer, Arena *arena) {
    LayerView view;
    Error unused;
    const float *rgb[3];
    if (!frame_rgb(frame, layer, rgb)) return NULL;
    return layer_view_find(frame, layer, arena, &view, &unused) ? view.planes[0] : NULL;
}

static bool find_pixels(const FrameImage *frame, Arena *arena, Pixels *out, Error *err) {
    LayerView light;
    if (!frame_view_find(frame, &out->view, err)) return false;
    if (!out->view.is_perspective)
        return error_set(err, ERROR_INPUT, "is an orthographic view: no eye sees one");
    if (!layer_view_find(frame, NULL, arena, &light, err)) return false;
    out->width = light.width;
    out->height = light.height;
    out->y = layer_view_luminance(&light, arena);
    out->halves = find_plane(frame, "halves", arena);
    out->variance = find_plane(frame, "variance", arena);
    out->sr = ARENA_NEW(arena, double, count_of(out));
    out->projected_sr = ARENA_NEW(arena, double, count_of(out));
    out->source = ARENA_NEW(arena, int32_t, count_of(out));
    out->is_core = ARENA_NEW(arena, bool, count_of(out));
    out->share = ARENA_NEW(arena, double, count_of(out));
    return true;
}

static ViewPixel pixel_at(const Pixels *pixels, size_t i) {
    return frame_view_pixel(&pixels->view, (int)(i % (size_t)pixels->width),
                            (int)(i / (size_t)pixels->width));
}

static void find_solid_angles(const Pixels *pixels, FrameGlare *out) {
    for (size_t i = 0; i < count_of(pixels); i++) {
        int x = (int)(i % (size_t)pixels->width), y = (int)(i / (size_t)pixels->width);
        if (!isfinite(pixels->y[i]) || !frame_view_sees(&pixels->view, x, y)) continue;
        ViewPixel p = frame_view_pixel(&pixels->view, x, y);
        pixels->sr[i] = p.sr;
        pixels->projected_sr[i] = p.projected_sr;
        out->solid_angle_sr += p.sr;
        out->seen += p.projected_sr / PI;
    }
}

/* A layer of too few samples has none. */
static bool is_known(const Pixels *pixels, const float *plane) {
    for (size_t i = 0; plane && i < count_of(pixels); i++)
        if (pixels->projected_sr[i] > 0 && isfinite(plane[i])) return true;
    return false;
}

static double task_luminance(const Pixels *pixels, double task_deg) {
    double cosine = cos_d(radians_from_degrees(task_deg) / 2), sum = 0, sr = 0;
    for (size_t i = 0; i < count_of(pixels); i++) {
        if (!(pixels->sr[i] > 0) || pixel_at(pixels, i).direction[2] < cosine) continue;
        sum += (double)pixels->y[i] * pixels->sr[i];
        sr += pixels->sr[i];
    }
    return sr > 0 ? sum / sr : 0;
}

/* ---- areas ------------------------------------------------------------------------------- */

typedef enum PixelClass { CLASS_BACKGROUND, CLASS_SOURCE, CLASS_PEAK } PixelClass;

/* What an area is gathered by. */
typedef struct Area {
    const Pixels *pixels;
    const GlareSettings *settings;
    double threshold;
    size_t *list; /* of the area in hand */
    size_t count;
    PixelClass class;
} Area;

static PixelClass class_of(const Area *area, size_t i) {
    double y = (double)area->pixels->y[i];
    if (!(area->pixels->projected_sr[i] > 0) || !(y > area->threshold)) return CLASS_BACKGROUND;
    return y > area->settings->peak_cd_m2 ? CLASS_PEAK : CLASS_SOURCE;
}

/* May an area grow over the pixel? One of peaks over half their luminance, so that noise does
 * not cut what is about as bright as they have to be. */
static bool grows_over(const Area *area, size_t i, PixelClass class) {
    PixelClass own = class_of(area, i);
    if (class == CLASS_SOURCE) return own == CLASS_SOURCE;
    return own != CLASS_BACKGROUND && (double)area->pixels->y[i] > 0.5 * area->settings->peak_cd_m2;
}

/* Takes pixel x, y into the area in hand, if areas of that class grow over it; false: not. */
static bool take(Area *area, int x, int y, PixelClass class, int32_t id) {
    const Pixels *p = area->pixels;
    size_t i = (size_t)y * (size_t)p->width + (size_t)x;
    if (x < 0 || y < 0 || x >= p->width || y >= p->height || !grows_over(area, i, class))
        return false;
    if (p->source[i] != NO_SOURCE) return true;
    p->source[i] = id;
    area->list[area->count++] = i;
    return true;
}

/* All neighbours of the list's pixel k, with itself; how many of them the area grows over. */
static int take_around(Area *area, size_t k, PixelClass class, int32_t id) {
    size_t width = (size_t)area->pixels->width;
    int x = (int)(area->list[k] % width), y = (int)(area->list[k] / width), found = 0;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) found += take(area, x + dx, y + dy, class, id);
    return found;
}

/* The list grows while it is gone through. A peak's edge is below the peaks' luminance: what is
 * a source and touches a peak belongs to it. */
static void gather(Area *area, size_t first, int32_t id) {
    const Pixels *p = area->pixels;
    p->source[first] = id;
    area->list[0] = first;
    area->count = 1;
    for (size_t k = 0; k < area->count; k++)
        p->is_core[area->list[k]] = take_around(area, k, area->class, id) == 9;
    size_t inner = area->count;
    for (size_t k = 0; k < inner && area->class == CLASS_PEAK; k++)
        take_around(area, k, CLASS_SOURCE, id);
}

#define ABOVE_SIGMAS 3 /* that an area's mean is above the threshold */

/* One half of the samples where the other is above the threshold, and the other way round:
 * selected by noise of its own, the mean is without bias. Few pixels may be above by both
 * halves' chance: their noise decides. */
static bool is_above(const Area *area) {
    const Pixels *p = area->pixels;
    double sum = 0, sr = 0, noise = 0, all = 0;
    for (size_t k = 0; k < area->count; k++) {
        size_t i = area->list[k];
        double half = p->halves && isfinite(p->halves[i]) ? (double)p->halves[i] : 0;
        double most = (double)p->y[i] + half, least = (double)p->y[i] - half;
        double spread = p->variance ? (double)p->variance[i] : 0;
        if (most > area->threshold) sum += least * p->sr[i], sr += p->sr[i];
        if (least > area->threshold) sum += most * p->sr[i], sr += p->sr[i];
        if (isfinite(spread)) noise += fmax(spread, half * half) * p->sr[i] * p->sr[i];
        all += p->sr[i];
    }
    return sum / sr - ABOVE_SIGMAS * sqrt(noise) / all > area->threshold;
}

/* Azimuth and elevation from the line of sight. */
static void set_place(const double direction[3], FrameSource *out) {
    double flat = hypot_d(direction[0], direction[2]);
    out->right_deg = degrees_from_radians(atan2_d(direction[0], direction[2]));
    out->up_deg = degrees_from_radians(atan2_d(direction[1], flat));
}

/* Of its core, as much of space as gives its light. */
static void set_luminance(const GlareSum *sum, FrameSource *out) {
    double squares = out->squares, l;
    out->has_core = out->core_sr > 0;
    l = out->has_core ? out->core_cd_sr_m2 / out->core_sr : squares / sum->cd_sr_m2;
    out->source = glare_sum_source(sum);
    out->light = sum->cd_sr_m2;
    out->source.luminance_cd_m2 = l;
    out->source.solid_angle_sr = sum->cd_sr_m2 / l;
}

static FrameSource source_of(const Area *area) {
    const Pixels *p = area->pixels;
    GlareSum sum = {0};
    FrameSource out = {.pixels = (long)area->count};
    double middle[3] = {0, 0, 0}, light = 0;
    for (size_t k = 0; k < area->count; k++) {
        size_t i = area->list[k];
        ViewPixel seen = pixel_at(p, i);
        double y = (double)p->y[i], weight = y * p->sr[i], *d = seen.direction;
        glare_sum_add(&sum, y, p->sr[i], d[0], d[1], d[2]);
        out.lx += y * p->projected_sr[i];
        out.x += weight * ((double)(i % (size_t)p->width) + 0.5);
        out.y += weight * ((double)(i / (size_t)p->width) + 0.5);
        for (int c = 0; c < 3; c++) middle[c] += weight * d[c];
        out.greatest_cd_m2 = fmax(out.greatest_cd_m2, y);
        out.squares += y * weight;
        if (p->is_core[i]) out.core_cd_sr_m2 += weight, out.core_sr += p->sr[i];
        light += weight;
    }
    out.x /= light;
    out.y /= light;
    set_luminance(&sum, &out);
    set_place(middle, &out);
    return out;
}

#define REFUTED INT32_MAX /* background in the end, but not to be met again */

static void find_of_class(Area *area, Arena *arena, int *room, FrameGlare *out) {
    const Pixels *p = area->pixels;
    for (size_t i = 0; i < count_of(p); i++) {
        if (p->source[i] != NO_SOURCE || class_of(area, i) != area->class) continue;
        gather(area, i, out->source_count);
        if (!is_above(area)) {
            for (size_t k = 0; k < area->count; k++) p->source[area->list[k]] = REFUTED;
            out->doubtful++;
            continue;
        }
        if (out->source_count == *room) {
            *room = 2 * *room + 64;
            out->sources = ARENA_GROW(arena, FrameSource, out->sources, out->source_count, *room);
        }
        out->sources[out->source_count++] = source_of(area);
    }
}

static void find_sources(Area *area, Arena *arena, FrameGlare *out) {
    const Pixels *p = area->pixels;
    int room = 0;
    for (size_t i = 0; i < count_of(p); i++) p->source[i] = NO_SOURCE;
    for (area->class = CLASS_PEAK; area->class > CLASS_BACKGROUND; area->class --)
        find_of_class(area, arena, &room, out);
    for (size_t i = 0; i < count_of(p); i++)
        if (p->source[i] == REFUTED) p->source[i] = NO_SOURCE;
}

/* ---- rims -------------------------------------------------------------------------------- */

#define AROUND 2 /* pixels to each side in which the background about a rim is looked for */

/* Pixel i's neighbour; -1: outside. */
static long beside(const Pixels *p, size_t i, int dx, int dy) {
    int x = (int)(i % (size_t)p->width) + dx, y = (int)(i / (size_t)p->width) + dy;
    return x < 0 || y < 0 || x >= p->width || y >= p->height ? -1 : (long)y * p->width + x;
}

/* The brightest source that a background pixel touches, of those with a core. */
static int32_t touched(const Pixels *p, const FrameGlare *found, size_t i) {
    int32_t best = NO_SOURCE;
    for (int k = 0; k < 9; k++) {
        long at = beside(p, i, k % 3 - 1, k / 3 - 1);
        int32_t id = at < 0 ? NO_SOURCE : p->source[at];
        if (id == NO_SOURCE || !found->sources[id].has_core) continue;
        double l = found->sources[id].source.luminance_cd_m2;
        if (best == NO_SOURCE || l > found->sources[best].source.luminance_cd_m2) best = id;
    }
    return best;
}

/* Mean luminance of the background near pixel i that touches no source; NaN: there is none. */
static double behind_rim(const Pixels *p, const int32_t *rim, size_t i) {
    double sum = 0, sr = 0;
    for (int dy = -AROUND; dy <= AROUND; dy++)
        for (int dx = -AROUND; dx <= AROUND; dx++) {
            long at = beside(p, i, dx, dy);
            if (at < 0 || p->source[at] != NO_SOURCE || rim[at] != NO_SOURCE) continue;
            if (!(p->projected_sr[at] > 0)) continue;
            sum += (double)p->y[at] * p->sr[at];
            sr += p->sr[at];
        }
    return sr > 0 ? sum / sr : (double)NAN;
}

/* Of a rim's luminance y, source and background in part: y = f l + (1 - f) b. At most all of it
 * is the source's; noise of a pixel may leave it less than nothing. */
static double share_of(double y, double l, double b) {
    return y < l ? l * (y - b) / (l - b) : y;
}

/* Every pixel of an edge has its part of the source, whether that makes it brighter than the
 * threshold or not. Then source[i] is that of rims, too. */
static void share_rims(const Pixels *p, const FrameGlare *found, Arena scratch) {
    int32_t *rim = ARENA_NEW(&scratch, int32_t, count_of(p));
    for (size_t i = 0; i < count_of(p); i++) {
        bool is_behind = p->projected_sr[i] > 0 && p->source[i] == NO_SOURCE;
        rim[i] = is_behind ? touched(p, found, i) : NO_SOURCE;
    }
    for (size_t i = 0; i < count_of(p); i++) {
        int32_t id = p->source[i] == NO_SOURCE ? rim[i] : p->source[i];
        p->share[i] = id != NO_SOURCE ? (double)p->y[i] : 0;
        if (id == NO_SOURCE || !found->sources[id].has_core || p->is_core[i]) continue;
        double b = behind_rim(p, rim, i);
        if (!isnan(b))
            p->share[i] = share_of((double)p->y[i], found->sources[id].source.luminance_cd_m2, b);
        else if (p->source[i] == NO_SOURCE) p->share[i] = 0;
    }
    for (size_t i = 0; i < count_of(p); i++)
        if (rim[i] != NO_SOURCE) p->source[i] = rim[i];
}

/* Sources get the light of their shares. */
static void add_shares(const Pixels *p, FrameGlare *found) {
    for (int i = 0; i < found->source_count; i++)
        found->sources[i].light = found->sources[i].lx = 0;
    for (size_t i = 0; i < count_of(p); i++) {
        if (p->source[i] == NO_SOURCE) continue;
        FrameSource *s = &found->sources[p->source[i]];
        s->light += p->share[i] * p->sr[i];
        s->lx += p->share[i] * p->projected_sr[i];
    }
    for (int i = 0; i < found->source_count; i++) {
        FrameSource *s = &found->sources[i];
        s->source.solid_angle_sr = s->light / s->source.luminance_cd_m2;
    }
}

/* ---- figures ----------------------------------------------------------------------------- */

/* What the figures are made of. */
typedef struct GlareSums {
    GlareView view;
    double lux, squares; /* all light; the sum of L^2 w/P^2 */
} GlareSums;

static double weight_of(const GlareSource *s) {
    return s->solid_angle_sr / (s->position_index * s->position_index);
}

static bool sum_up(const Pixels *pixels, const GlareRequest *request, const FrameGlare *found,
                   Arena *arena, GlareSums *out, Error *err) {
    GlareSource *list = ARENA_NEW(arena, GlareSource, found->source_count + 1);
    *out = (GlareSums){.view = {.sources = list, .count = found->source_count}};
    for (int i = 0; i < found->source_count; i++) {
        const GlareSource *s = &found->sources[i].source;
        list[i] = *s;
        out->squares += s->luminance_cd_m2 * s->luminance_cd_m2 * weight_of(s);
        out->view.source_lx += found->sources[i].lx;
    }
    for (size_t i = 0; i < count_of(pixels); i++)
        if (pixels->projected_sr[i] > 0)
            out->view.background_lx +=
                ((double)pixels->y[i] - pixels->share[i]) * pixels->projected_sr[i];
    if (request->has_lux) out->view.background_lx = request->vertical_lx - out->view.source_lx;
    out->lux = out->view.source_lx + out->view.background_lx;
    return out->view.background_lx >= 0 ||
           error_set(err, ERROR_USAGE,
                     "--vertical-lux %g: the sources in the frame alone give "
                     "%.6g lx",
                     request->vertical_lx, out->view.source_lx);
}

/* How a figure grows with the sum of squares, with all light and with the background's. */
typedef struct Slopes {
    double squares, lux, background_lx;
} Slopes;

typedef enum Figure {
    FIGURE_LUX,
    FIGURE_BACKGROUND,
    FIGURE_UGR,
    FIGURE_DGP,
    FIGURE_DGI,
    FIGURES
} Figure;

static Slopes dgp_slopes(const GlareSettings *settings, const GlareSums *sums, double dgp) {
    double ratio = sums->squares / pow_d(sums->lux, 1.87);
    double factor = settings->low_light ? discomfort_dgp_low_light(sums->lux) : 1;
    double by_log = factor * 0.092 / log_d(10) * ratio / (1 + ratio);
    double rest = factor < 1 ? 0.024 * (1 - factor) * dgp : 0; /* of the factor itself */
    return (Slopes){sums->squares > 0 ? by_log / sums->squares : 0,
                    factor * 5.87e-5 - 1.87 * by_log / sums->lux + rest, 0};
}

/* DGI is no function of the sum of squares, but of each source's L^2 w: */
typedef struct DgiSlopes {
    double *of_source;
    double background_lx;
} DgiSlopes;

static DgiSlopes dgi_slopes(const GlareSums *sums, Arena *arena) {
    DgiSlopes out = {ARENA_NEW(arena, double, sums->view.count + 1), 0};
    double behind = sums->view.background_lx / PI, total = 0;
    for (int i = 0; i < sums->view.count; i++) {
        const GlareSource *s = &sums->view.sources[i];
        double l = s->luminance_cd_m2, square = l * l * s->solid_angle_sr;
        double by = behind + 0.07 * sqrt(square);
        double t = 0.478 * pow_d(l, 1.6) * pow_d(weight_of(s), 0.8) / by;
        total += t;
        out.of_source[i] = t * (0.8 - 0.035 * sqrt(square) / by) / square;
        out.background_lx -= t / by / PI;
    }
    double scale = total > 0 ? 10 / log_d(10) / total : 0;
    for (int i = 0; i < sums->view.count; i++) out.of_source[i] *= scale;
    out.background_lx *= scale;
    return out;
}

/* ---- intervals --------------------------------------------------------------------------- */

/* GlareSums over pixels of a figure's variance and of its square: of pixels whose light raises
 * it, and of those whose light lowers it. */
typedef struct FigureNoise {
    BrightSamples of[2][FIGURES];
} FigureNoise;

/* Half an interval's width, and what bright samples that are missing may add to its ends. */
typedef struct FigureWidth {
    double half, above, below;
} FigureWidth;

typedef struct SlopeTable {
    Slopes of[FIGURES];
    DgiSlopes dgi;
    bool lux_is_given;
} SlopeTable;

static SlopeTable find_slopes(const GlareRequest *request, const GlareSums *sums, double dgp,
                              Arena *arena) {
    double to_log = 8 / log_d(10);
    SlopeTable table = {.dgi = dgi_slopes(sums, arena), .lux_is_given = request->has_lux};
    table.of[FIGURE_LUX] = (Slopes){0, 1, 0};
    table.of[FIGURE_BACKGROUND] = (Slopes){0, 0, 1 / PI};
    table.of[FIGURE_UGR] = (Slopes){to_log / sums->squares, 0, -to_log / sums->view.background_lx};
    table.of[FIGURE_DGP] = dgp_slopes(&request->settings, sums, dgp);
    return table;
}

/* By how much L^2 w of its source grows with the luminance of pixel i: the source's luminance
 * times its light, which is without a core the sum of the pixels' own squares. */
static double square_slope(const Pixels *pixels, const FrameSource *s, size_t i) {
    double sr = pixels->sr[i];
    if (!s->has_core) return 2 * (double)pixels->y[i] * sr;
    return s->source.luminance_cd_m2 * sr + (pixels->is_core[i] ? s->light * sr / s->core_sr : 0);
}

/* By how much each figure grows with the luminance of pixel i. */
static void pixel_slopes(const Pixels *pixels, const FrameGlare *found, const SlopeTable *table,
                         size_t i, double out[FIGURES]) {
    int32_t id = pixels->source[i];
    double lux = pixels->projected_sr[i], behind = id == NO_SOURCE ? lux : 0, square = 0;
    double squares = 0;
    if (id != NO_SOURCE) {
        const FrameSource *s = &found->sources[id];
        square = square_slope(pixels, s, i);
        squares = square / (s->source.position_index * s->source.position_index);
    }
    if (table->lux_is_given) behind = id == NO_SOURCE ? 0 : -lux, lux = 0;
    for (int f = 0; f < FIGURE_DGI; f++)
        out[f] = table->of[f].squares * squares + table->of[f].lux * lux +
                 table->of[f].background_lx * behind;
    out[FIGURE_DGI] = table->dgi.background_lx * behind;
    if (id != NO_SOURCE) out[FIGURE_DGI] += table->dgi.of_source[id] * square;
}

static void add_noise(const double slopes[FIGURES], double variance, FigureNoise *to) {
    for (int f = 0; f < FIGURES; f++) {
        double square = slopes[f] * slopes[f] * variance;
        BrightSamples *of = &to->of[slopes[f] < 0][f];
        of->squares += square;
        of->fourths += square * square;
    }
}

#define HALVES_FREEDOM 16 /* of the halves' squares, at least */

/* By halves where they are enough, else by the samples' spread. Half the difference of a
 * pixel's halves, or the root of its variance, is what one bright sample makes of it
 * (measure/measure.c). */
static FigureWidth width_of(const FigureNoise *halves, const FigureNoise *spread, Figure f) {
    double square = halves->of[0][f].squares + halves->of[1][f].squares;
    double fourth = halves->of[0][f].fourths + halves->of[1][f].fourths;
    double freedom = fourth > 0 ? 3 * square * square / fourth : 0;
    const FigureNoise *by = freedom >= HALVES_FREEDOM ? halves : spread;
    double all = spread->of[0][f].squares + spread->of[1][f].squares;
    return (FigureWidth){by == halves ? student_quantile(freedom) * sqrt(square)
                                      : NORMAL_QUANTILE * sqrt(all),
                         bright_missing(&by->of[0][f], 1, 1), bright_missing(&by->of[1][f], 1, 1)};
}

/* widths: NaN where the frame has no word of its noise. */
static void find_widths(const Pixels *pixels, const FrameGlare *found, const SlopeTable *table,
                        FigureWidth widths[FIGURES]) {
    FigureNoise halves = {.of = {{{0}}}}, spread = {.of = {{{0}}}};
    for (size_t i = 0; i < count_of(pixels); i++) {
        double slopes[FIGURES];
        if (!(pixels->projected_sr[i] > 0)) continue;
        double half = pixels->halves ? (double)pixels->halves[i] : (double)NAN;
        double variance = pixels->variance ? (double)pixels->variance[i] : (double)NAN;
        pixel_slopes(pixels, found, table, i, slopes);
        add_noise(slopes, half * half, &halves);
        add_noise(slopes, variance, &spread);
    }
    for (int f = 0; f < FIGURES; f++) widths[f] = width_of(&halves, &spread, (Figure)f);
}

/* ---- all of it --------------------------------------------------------------------------- */

static int compare_sources(const void *a, const void *b) {
    const GlareSource *x = &((const FrameSource *)a)->source;
    const GlareSource *y = &((const FrameSource *)b)->source;
    double first = x->luminance_cd_m2 * x->luminance_cd_m2 * weight_of(x);
    double second = y->luminance_cd_m2 * y->luminance_cd_m2 * weight_of(y);
    return (first < second) - (first > second);
}

static bool check_seen(const GlareRequest *request, const FrameGlare *found, Error *err) {
    if (request->has_lux || found->seen >= GLARE_SEEN_LEAST) return true;
    return error_set(err, ERROR_INPUT,
                     "sees %.1f %% of the light that comes to the eye from an even half space, "
                     "required all: a fisheye (render --projection fisheye), or the "
                     "illuminance at the eye (--vertical-lux LX)",
                     100 * found->seen);
}

static Measured figure_of(double value, FigureWidth width, bool is_given) {
    if (is_given) return measured_about(value, (double)NAN);
    return (Measured){value, value - width.half - width.below, value + width.half + width.above};
}

static void set_figures(const GlareFigures *f, const GlareSums *sums,
                        const FigureWidth widths[FIGURES], const GlareRequest *request,
                        FrameGlare *out) {
    out->none = f->none;
    out->has_intervals = !isnan(widths[FIGURE_BACKGROUND].half);
    out->vertical_lx = figure_of(sums->lux, widths[FIGURE_LUX], request->has_lux);
    out->background_cd_m2 = figure_of(f->background_cd_m2, widths[FIGURE_BACKGROUND], false);
    out->ugr = figure_of(f->ugr, widths[FIGURE_UGR], false);
    out->dgp = figure_of(f->dgp, widths[FIGURE_DGP], false);
    out->dgi = figure_of(f->dgi, widths[FIGURE_DGI], false);
}

bool frame_glare_measure(const FrameImage *frame, const GlareRequest *request, Arena *arena,
                         FrameGlare *out, Error *err) {
    const GlareSettings *settings = &request->settings;
    FrameGlare found = {.task_cd_m2 = (double)NAN};
    Pixels pixels = {.width = 0};
    GlareSums sums;
    FigureWidth widths[FIGURES];
    if (!find_pixels(frame, arena, &pixels, err)) return false;
    find_solid_angles(&pixels, &found);
    if (!check_seen(request, &found, err)) return false;
    if (settings->task_factor > 0) found.task_cd_m2 = task_luminance(&pixels, settings->task_deg);
    found.threshold_cd_m2 = glare_threshold(settings, found.task_cd_m2);
    found.has_noise = is_known(&pixels, pixels.halves) || is_known(&pixels, pixels.variance);
    Area area = {.pixels = &pixels,
                 .settings = settings,
                 .threshold = found.threshold_cd_m2,
                 .list = ARENA_NEW(arena, size_t, count_of(&pixels))};
    find_sources(&area, arena, &found);
    share_rims(&pixels, &found, *arena);
    add_shares(&pixels, &found);
    if (!sum_up(&pixels, request, &found, arena, &sums, err)) return false;
    GlareFigures figures = discomfort_figures(settings, &sums.view);
    SlopeTable table = find_slopes(request, &sums, figures.dgp, arena);
    find_widths(&pixels, &found, &table, widths);
    set_figures(&figures, &sums, widths, request, &found);
    qsort(found.sources, (size_t)found.source_count, sizeof *found.sources, compare_sources);
    *out = found;
    return true;
}
